"""Exported FMUs against `sincro run`, judged by FMPy: python check.py PATH/TO/sincro [SCENE...]

Each scene is exported for FMI 2.0 and 3.0, validated by FMPy, simulated by FMPy at the recorded instants, and every
recorded number is compared with that of `sincro run`, bit for bit. Then: rollback from a serialised state, eight
instances in eight threads, two scenes in one process, FMUs as blocks of another scene, model exchange against
co-simulation, and the time of a step.
"""

import csv
import ctypes
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import fmpy
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave
from fmpy.validation import validate_fmu

ROOT = Path(__file__).resolve().parents[2]
SCENES = [
    "two-dof-position", "two-dof-open-loop", "cart-pole-lqr", "spring-dynamic", "bouncing-ball", "rolling-sphere",
    "gripper", "four-bar", "slider-crank", "motor-ramp", "pcontroller", "movement-lua", "propeller-lua",
    "quadrotor-flight-2", "stock-propeller", "alexandros-release",
]
EXCHANGED = ["cart-pole-lqr", "spring-dynamic"]


def signal_of(variable):
    """Sincro's name of an output: it stands in the description where the structured name differs."""
    words = variable.description or ""
    return words[: -len(": signal")] if words.endswith(": signal") else variable.name


def outputs_of(description):
    return {signal_of(v): v for v in description.modelVariables if v.causality == "output"}


class Slave:
    """One instance of an FMU, of either version."""

    def __init__(self, folder, description, name="instance"):
        kind = FMU2Slave if description.fmiVersion == "2.0" else FMU3Slave
        self.is_2 = kind is FMU2Slave
        identifier = description.coSimulation.modelIdentifier
        self.fmu = kind(guid=description.guid, unzipDirectory=str(folder), modelIdentifier=identifier, instanceName=name)
        self.fmu.instantiate()

    def start(self, settings=()):
        if self.is_2:
            self.fmu.setupExperiment(startTime=0.0)
            self.fmu.enterInitializationMode()
        else:
            self.fmu.enterInitializationMode(startTime=0.0)
        self.fmu.exitInitializationMode()

    def get(self, references):
        return self.fmu.getReal(references) if self.is_2 else self.fmu.getFloat64(references)

    def step(self, t, h):
        self.fmu.doStep(currentCommunicationPoint=t, communicationStepSize=h)

    def save(self):
        state = self.fmu.getFMUstate() if self.is_2 else self.fmu.getFMUState()
        data = self.fmu.serializeFMUstate(state) if self.is_2 else self.fmu.serializeFMUState(state)
        (self.fmu.freeFMUstate if self.is_2 else self.fmu.freeFMUState)(state)
        return data

    def restore(self, data):
        state = self.fmu.deSerializeFMUstate(data) if self.is_2 else self.fmu.deserializeFMUState(data)
        (self.fmu.setFMUstate if self.is_2 else self.fmu.setFMUState)(state)
        (self.fmu.freeFMUstate if self.is_2 else self.fmu.freeFMUState)(state)

    def free(self):
        self.fmu.terminate()
        self.fmu.freeInstance()


def rows_of(folder, description, n_rows, references):
    """Rows of outputs at the recorded instants, the start included."""
    h = float(description.defaultExperiment.stepSize)
    slave = Slave(folder, description)
    slave.start()
    rows = [list(slave.get(references))]
    for k in range(n_rows - 1):
        slave.step(k * h, h)
        rows.append(list(slave.get(references)))
    slave.free()
    return rows


def same(a, b):
    return float(a).hex() == float(b).hex()


def check_scene(sincro, scene, work):
    out = work / f"run-{scene}"
    # a scene with failing checks has its numbers all the same
    subprocess.run([sincro, "run", ROOT / "scenes" / scene, "--set", 'error_bar="none"', "--out", out],
                   check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    with open(out / "signals.csv", newline="") as file:
        names, *recorded = list(csv.reader(file))
    recorded = [[float(x) for x in row] for row in recorded]
    failures = []
    for version in ["2", "3"]:
        path = work / f"{scene}-{version}.fmu"
        subprocess.run([sincro, "export", "fmu", ROOT / "scenes" / scene, "--fmi", version, "--out", path],
                       check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        problems = validate_fmu(str(path))
        description = read_model_description(str(path))
        folder = extract(str(path))
        outputs = outputs_of(description)
        columns = [(k, outputs[name]) for k, name in enumerate(names) if name in outputs]
        missing = [name for name in names[1:] if name not in outputs and not name.startswith("stream")]
        rows = rows_of(folder, description, len(recorded), [v.valueReference for _, v in columns])
        wrong = sum(not same(row[j], expected[k]) for row, expected in zip(rows, recorded)
                    for j, (k, _) in enumerate(columns))
        verdict = "ok" if not problems and not wrong and not missing else "FAIL"
        print(f"{verdict:4}  {scene} FMI {version}: {len(rows)} rows of {len(columns)} signals, {wrong} numbers differ, "
              f"{len(problems)} problems, {path.stat().st_size / 1e6:.1f} MB", flush=True)
        for problem in problems[:3]:
            print(f"      {problem}")
        for name in missing:
            print(f"      there is no output for {name}")
        if verdict == "FAIL":
            failures.append(f"{scene} FMI {version}")
        shutil.rmtree(folder)
    return failures


HOST_SCENE = """
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


def check_block(sincro, path, expected, work):
    """A sincro FMU as a block of another scene of sincro: numbers that differ from those of the run it came from."""
    description = read_model_description(str(path))
    outputs = outputs_of(description)
    h, stop = float(description.defaultExperiment.stepSize), float(description.defaultExperiment.stopTime)
    port = {name: "".join(c if c.isalnum() and c.isascii() else "_" for c in v.name).strip("_")
            for name, v in outputs.items()}
    host = work / f"host-{path.stem}"
    host.mkdir()
    shutil.copy(path, host / "whole.fmu")
    (host / "scene.toml").write_text(HOST_SCENE)
    # one output alone would have no name of its own
    record = ", ".join(f'"whole.{p}"' for p in port.values())
    (host / "experiment.toml").write_text(
        f'title = "host"\nscene = "scene.toml"\ndiagram = "diagram.toml"\nduration = {stop}\nstep = {h}\n'
        f'error_bar = "none"\nrecord = [{record}]\n')
    (host / "diagram.toml").write_text(
        f'block = [{{ name = "whole", type = "fmu", file = "whole.fmu", sample_time = {h}, inputs = [] }}]\n')
    out = work / f"run-host-{path.stem}"
    subprocess.run([sincro, "run", host, "--out", out], check=False, stdout=subprocess.DEVNULL)
    with open(out / "signals.csv", newline="") as file:
        names, *rows = list(csv.reader(file))
    with open(expected / "signals.csv", newline="") as file:
        expected_names, *expected_rows = list(csv.reader(file))
    places = [(names.index(f"whole.{port[name]}"), k) for k, name in enumerate(expected_names) if name in port]
    wrong = abs(len(rows) - len(expected_rows))
    for row, other in zip(rows, expected_rows):
        wrong += sum(not same(row[j], other[k]) for j, k in places)
    return wrong


def check_rollback(folder, description):
    references = [v.valueReference for v in outputs_of(description).values()]
    h = float(description.defaultExperiment.stepSize)
    first, other = Slave(folder, description), Slave(folder, description, "other")
    first.start()
    other.start()
    for k in range(200):
        first.step(k * h, h)
    data = first.save()
    at_save = list(first.get(references))
    rows = []
    for k in range(200, 400):
        first.step(k * h, h)
        rows.append(list(first.get(references)))
    first.restore(data)
    back = list(first.get(references))
    other.restore(data)
    good = all(map(same, at_save, back))
    for slave in (first, other):
        for k, row in zip(range(200, 400), rows):
            slave.step(k * h, h)
            good &= all(map(same, slave.get(references), row))
        slave.free()
    return good, len(data)


def check_threads(folder, description, others):
    references = [v.valueReference for v in outputs_of(description).values()]
    expected = rows_of(folder, description, 300, references)
    results = [None] * 8

    def work(k):
        results[k] = rows_of(folder, description, 300, references)

    # another scene runs in the same process meanwhile
    other_folder, other = others
    thread = threading.Thread(target=lambda: rows_of(other_folder, other, 200, []))
    threads = [threading.Thread(target=work, args=(k,)) for k in range(8)] + [thread]
    for t in threads:
        t.start()
    for t in threads:
        t.join()
    return all(result == expected for result in results)


def check_exchange(sincro, scene, work):
    """Largest difference of model exchange under CVODE from co-simulation, relative to the largest value."""
    worst = 0.0
    for version in ["2", "3"]:
        path = work / f"{scene}-both-{version}.fmu"
        subprocess.run([sincro, "export", "fmu", ROOT / "scenes" / scene, "--fmi", version, "--kind", "both", "--out", path],
                       check=True, stdout=subprocess.DEVNULL)
        problems = validate_fmu(str(path))
        description = read_model_description(str(path))
        h = float(description.defaultExperiment.stepSize)
        common = dict(output_interval=h, stop_time=float(description.defaultExperiment.stopTime))
        cs = fmpy.simulate_fmu(str(path), fmi_type="CoSimulation", **common)
        me = fmpy.simulate_fmu(str(path), fmi_type="ModelExchange", solver="CVode", relative_tolerance=1e-9, **common)
        names = [v.name for v in description.modelVariables if v.causality == "output"
                 and v.name.split(".")[-1] in ("position", "velocity")]
        times = {round(t / h): k for k, t in enumerate(cs["time"])}
        for name in names:
            for t, x in zip(me["time"], me[name]):
                k = times.get(round(t / h))
                if k is not None and abs(t - round(t / h) * h) < 1e-9:
                    worst = max(worst, abs(x - cs[name][k]))
        if problems:
            print(problems)
            worst = float("inf")
    return worst


def time_step(folder, description):
    """Microseconds of a call of doStep from Python, without FMPy's own checks; and of an instantiation, in ms."""
    library = ctypes.CDLL(str(next((Path(folder) / "binaries").rglob("*.so"))))
    step = library.fmi2DoStep
    step.argtypes = [ctypes.c_void_p, ctypes.c_double, ctypes.c_double, ctypes.c_int]
    h, best = 0.005, float("inf")
    started = time.perf_counter()
    slave = Slave(folder, description)
    instantiation = (time.perf_counter() - started) * 1e3
    for _ in range(5):
        slave.start()
        # the same library: the handle is known to it
        own = ctypes.CDLL(slave.fmu.dll._name)
        call = own.fmi2DoStep
        call.argtypes = step.argtypes
        component = slave.fmu.component
        started = time.perf_counter()
        for k in range(500):
            call(component, k * h, h, 1)
        best = min(best, (time.perf_counter() - started) / 500 * 1e6)
        slave.fmu.reset()
    slave.fmu.freeInstance()
    return best, instantiation


def main():
    sincro = Path(sys.argv[1]).resolve()
    scenes = sys.argv[2:] or SCENES
    failures = []
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        for scene in scenes:
            failures += check_scene(sincro, scene, work)
        if len(sys.argv) == 2:
            arm, ball = work / "two-dof-open-loop-2.fmu", work / "bouncing-ball-3.fmu"
            for name in ["two-dof-position-2", "two-dof-position-3", "cart-pole-lqr-2"]:
                path = work / f"{name}.fmu"
                unpacked = extract(str(path))
                good, n = check_rollback(unpacked, read_model_description(str(path)))
                print(f"{'ok' if good else 'FAIL':4}  {name}: rollback from {n} bytes, also in another instance")
                failures += [] if good else [f"rollback {name}"]
            described = extract(str(arm)), read_model_description(str(arm))
            good = check_threads(*described, (extract(str(ball)), read_model_description(str(ball))))
            print(f"{'ok' if good else 'FAIL':4}  eight instances in eight threads, beside another scene")
            failures += [] if good else ["threads"]
            for name in ["two-dof-position-2", "cart-pole-lqr-3", "bouncing-ball-2", "movement-lua-3"]:
                path = work / f"{name}.fmu"
                wrong = check_block(sincro, path, work / f"run-{name[:-2]}", work)
                print(f"{'FAIL' if wrong else 'ok':4}  {name} as a block of another scene: {wrong} numbers differ")
                failures += [f"block {name}"] if wrong else []
            step, instantiation = time_step(*described)
            print(f"      doStep {step:.1f} us, instantiation {instantiation:.1f} ms")
            for scene in EXCHANGED:
                worst = check_exchange(sincro, scene, work)
                print(f"{'ok' if worst <= 1e-6 else 'FAIL':4}  {scene}: model exchange is {worst:.1e} off co-simulation")
                failures += [] if worst <= 1e-6 else [f"model exchange {scene}"]
    if failures:
        sys.exit(f"failed: {', '.join(failures)}")


if __name__ == "__main__":
    main()
