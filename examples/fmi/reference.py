"""The Reference FMUs of the Modelica Association as blocks of a diagram: python reference.py PATH/TO/sincro CHECKOUT

CHECKOUT is a checkout of https://github.com/modelica/Reference-FMUs. The FMUs are built with the C compiler, put into a
scene as blocks, and their outputs compared with the files `*_out.csv` that are published beside them: in co-simulation,
and in model exchange with explicit Euler at the step of the FMU's own solver (`FIXED_SOLVER_STEP` of its `config.h`),
which made those files. Clocks, for which nothing is published, against the ticks in its description. By hand: nothing of
them is part of this project.
"""

import csv
import math
import platform
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SCENE = """
[[joint]]
name = "hinge"
kind = "revolute"
axis = [0, 1, 0]
[[body]]
name = "bob"
parent = "/hinge"
mass = 1
center_of_mass = [0, 0, -1]
inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }
"""
# model, base step, duration
MODELS = [
    ("BouncingBall", 0.01, 3.0), ("Dahlquist", 0.1, 10.0), ("Feedthrough", 0.1, 2.0), ("Resource", 1.0, 1.0),
    ("Stair", 0.2, 10.0), ("VanDerPol", 0.01, 20.0), ("StateSpace", 1.0, 10.0), ("Clocks", 1.0, 10.0),
]


def build(checkout, model, version, work):
    description = checkout / model / f"FMI{version}.xml"
    if not description.exists():
        return None
    folder = work / f"{model}-{version}"
    machine = platform.machine()
    binaries = folder / "binaries" / ("linux64" if version == 2 else f"{machine}-linux")
    binaries.mkdir(parents=True)
    subprocess.run(["cc", "-shared", "-fPIC", "-w", f"-DFMI_VERSION={version}", "-DDISABLE_PREFIX",
                    f"-I{checkout / 'include'}",
                    f"-I{checkout / model}", "-o", binaries / f"{model}.so", checkout / f"src/fmi{version}Functions.c",
                    checkout / model / "model.c", checkout / "src/cosimulation.c", "-lm"], check=True)
    shutil.copy(description, folder / "modelDescription.xml")
    (folder / "resources").mkdir()
    for file in (checkout / model).glob("*.txt"):
        shutil.copy(file, folder / "resources")
    packed = shutil.make_archive(str(work / f"{model}-{version}"), "zip", folder)
    return Path(packed)


def run(sincro, fmu, outputs, settings, duration, work, more=("inputs = []", "", [])):
    """Rows of the outputs; `outputs` are names with the number of their components."""
    host = Path(tempfile.mkdtemp(dir=work))
    shutil.copy(fmu, host / "reference.fmu")
    (host / "scene.toml").write_text(SCENE)
    inputs, blocks, wires = more
    of_block, of_experiment = settings
    names = ", ".join(f'"{name}"' for name in outputs)
    (host / "diagram.toml").write_text(
        f"wires = {wires}\n[[block]]\nname = \"fmu\"\ntype = \"fmu\"\nfile = \"reference.fmu\"\n{of_block}\n"
        f"{inputs}\noutputs = [{names}]\n{blocks}\n")
    signals, columns = [], []
    for name, width in outputs.items():
        # a block with one output goes by its own name
        signal = f"fmu.{name}" if len(outputs) > 1 else "fmu"
        for k in range(width):
            signals.append(signal if width == 1 else f"{signal}[{k}]")
            columns.append((name, k))
    record = ", ".join(f'"{name}"' for name in signals)
    (host / "experiment.toml").write_text(
        f'title = "t"\nscene = "scene.toml"\ndiagram = "diagram.toml"\nduration = {duration}\n{of_experiment}\n'
        f'error_bar = "none"\nrecord = [{record}]\n')
    done = subprocess.run([sincro, "run", host, "--out", host / "out"], capture_output=True, text=True)
    if not (host / "out/signals.csv").exists():
        return None, re.sub(r"\s+", " ", done.stderr)
    with open(host / "out/signals.csv", newline="") as file:
        _, *rows = list(csv.reader(file))
    return [dict(zip(["time", *columns], map(float, row))) for row in rows], done.stderr


def numbers(text):
    """The components of a value: arrays are written with spaces."""
    words = {"true": 1.0, "false": 0.0}
    return [words[word] if word in words else float(word) for word in text.split()]


def compare(rows, expected, outputs):
    worst = 0.0
    for row in expected:
        # two rows at one instant are before and after an event: the later one counts
        own = min(reversed(rows), key=lambda r: abs(r["time"] - float(row["time"])))
        if abs(own["time"] - float(row["time"])) > 1e-6:
            return math.inf
        for name in outputs:
            for k, x in enumerate(numbers(row[name])):
                worst = max(worst, abs(own[name, k] - x) / max(1.0, abs(x)))
    return worst


def solver_step(checkout, model):
    return float(re.search(r"FIXED_SOLVER_STEP\s+(\S+)", (checkout / model / "config.h").read_text())[1])


def judge_clocks(sincro, fmu, work):
    """Ticks of the three input clocks up to each second, as the comment of the FMU's description draws them."""
    names = {"inClock1Ticks": 1, "inClock2Ticks": 1, "inClock3Ticks": 1, "totalInClockTicks": 1}
    pulse = '[[block]]\nname = "pulse"\ntype = "expression"\nsample_time = 1.0\nexpression = "if(u < 1.5, 1, if(u > 7.5, 1, 0))"\n'
    clock = '[[block]]\nname = "clock"\ntype = "clock"\n'
    more = ('inputs = ["inClock2"]', pulse + clock, '["clock -> pulse -> fmu.inClock2"]')
    rows, words = run(sincro, fmu, names, ("sample_time = 1.0", "step = 1.0"), 10.0, work, more)
    if rows is None:
        print(f"FAIL  Clocks FMI 3, scheduled execution: {words[:300]}")
        return 1
    found = [[row[name, 0] for name in names] for row in rows]
    # at a sample, clocks that tick by time have ticked; the clock of the port ticks after the outputs are read
    second = [0, 1, 2, 2, 2, 2, 2, 2, 2, 3, 4]
    expected = [[k + 1, second[k], int(k >= 4), k + 1 + second[k] + int(k >= 4)] for k in range(11)]
    print(f"{'ok' if found == expected else 'FAIL':4}  Clocks FMI 3, scheduled execution: ticks at 11 samples")
    return int(found != expected)


def main():
    sincro, checkout = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    failures = 0
    with tempfile.TemporaryDirectory() as folder:
        for model, step, duration in MODELS:
            for version in (2, 3):
                fmu = build(checkout, model, version, Path(folder))
                if fmu is None:
                    continue
                if model == "Clocks":
                    failures += judge_clocks(sincro, fmu, Path(folder))
                    continue
                table = checkout / model / f"{model}_out.csv"
                with open(table, newline="") as file:
                    expected = list(csv.DictReader(file))
                text = (fmu.parent / fmu.stem / "modelDescription.xml").read_text()
                listed = [n for n in expected[0] if n != "time" and not re.search("String|Binary", n)]
                names = [n for n in listed if re.search(rf'name="{n}"[^>]*causality="output"', text)]
                outputs = {name: len(numbers(expected[0][name])) for name in names}
                inner = solver_step(checkout, model)
                euler = ('interface = "model-exchange"', f'integrator = "semi-implicit-euler"\nstep = {inner}\n'
                         f"record_every = {round(step / inner)}")
                kinds = [("co-simulation", (f"sample_time = {step}", f"step = {step}")), ("model exchange", euler)]
                for kind, settings in kinds:
                    if kind == "model exchange" and "<ModelExchange" not in text:
                        continue
                    rows, words = run(sincro, fmu, outputs, settings, duration, Path(folder))
                    if rows is None:
                        print(f"FAIL  {model} FMI {version}, {kind}: {words[:300]}")
                        failures += 1
                        continue
                    worst = compare(rows, expected, outputs)
                    print(f"{'ok' if worst < 1e-5 else 'FAIL':4}  {model} FMI {version}, {kind}: {len(expected)} rows of "
                          f"{len(outputs)} outputs, off by {worst:.1e} at most", flush=True)
                    failures += worst >= 1e-5
    sys.exit(failures > 0)


if __name__ == "__main__":
    main()
