"""The Reference FMUs of the Modelica Association as blocks of a diagram: python reference.py PATH/TO/sincro CHECKOUT

CHECKOUT is a checkout of https://github.com/modelica/Reference-FMUs. The FMUs are built with the C compiler, put into a
scene as blocks, and their outputs compared with the files `*_out.csv` that are published beside them. By hand: nothing
of them is part of this project.
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


def run(sincro, fmu, outputs, step, duration, work, more=("inputs = []", "", [])):
    host = work / f"host-{fmu.stem}-{len(more[2])}"
    host.mkdir()
    shutil.copy(fmu, host / "reference.fmu")
    (host / "scene.toml").write_text(SCENE)
    inputs, blocks, wires = more
    names = ", ".join(f'"{name}"' for name in outputs)
    (host / "diagram.toml").write_text(
        f"wires = {wires}\n[[block]]\nname = \"fmu\"\ntype = \"fmu\"\nfile = \"reference.fmu\"\nsample_time = {step}\n"
        f"{inputs}\noutputs = [{names}]\n{blocks}\n")
    # a block with one output goes by its own name
    signals = [f"fmu.{name}" for name in outputs] if len(outputs) > 1 else ["fmu"]
    record = ", ".join(f'"{name}"' for name in signals)
    (host / "experiment.toml").write_text(
        f'title = "t"\nscene = "scene.toml"\ndiagram = "diagram.toml"\nduration = {duration}\nstep = {step}\n'
        f'error_bar = "none"\nrecord = [{record}]\n')
    done = subprocess.run([sincro, "run", host, "--out", host / "out"], capture_output=True, text=True)
    if not (host / "out/signals.csv").exists():
        words = re.sub(r"\s+", " ", done.stderr)
        return None, words
    with open(host / "out/signals.csv", newline="") as file:
        names, *rows = list(csv.reader(file))
    return [dict(zip(["time", *outputs], map(float, row))) for row in rows], done.stderr


def compare(rows, expected):
    worst = 0.0
    for row in expected:
        own = min(rows, key=lambda r: abs(r["time"] - float(row["time"])))
        if abs(own["time"] - float(row["time"])) > 1e-6:
            return math.inf
        for name, value in row.items():
            if name in own and name != "time":
                x = {"true": 1.0, "false": 0.0}.get(value)
                x = float(value) if x is None else x
                worst = max(worst, abs(own[name] - x) / max(1.0, abs(x)))
    return worst


def main():
    sincro, checkout = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    failures = 0
    with tempfile.TemporaryDirectory() as folder:
        for model, step, duration in MODELS:
            for version in (2, 3):
                fmu = build(checkout, model, version, Path(folder))
                if fmu is None:
                    continue
                table = checkout / model / f"{model}_out.csv"
                if not table.exists():
                    print(f"----  {model} FMI {version}: nothing is published to compare with")
                    continue
                with open(table, newline="") as file:
                    expected = list(csv.DictReader(file))
                text = (fmu.parent / fmu.stem / "modelDescription.xml").read_text()
                listed = [n for n in expected[0] if n != "time" and not re.search("String|Binary", n)]
                outputs = [n for n in listed if re.search(rf'name="{n}"[^>]*causality="output"', text)]
                rows, words = run(sincro, fmu, outputs, step, duration, Path(folder))
                if rows is None:
                    print(f"FAIL  {model} FMI {version}: {words[:160]}")
                    failures += 1
                    continue
                worst = compare(rows, expected)
                print(f"{'ok' if worst < 1e-5 else 'FAIL':4}  {model} FMI {version}: {len(expected)} rows of "
                      f"{len(outputs)} outputs, off by {worst:.1e} at most")
                failures += worst >= 1e-5
    sys.exit(failures > 0)


if __name__ == "__main__":
    main()
