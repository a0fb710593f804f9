"""Makes the data of the examples: runs of `sincro` with the true values, every few rows, with noise of a known seed.

Usage: python make_data.py [SINCRO]
"""

import csv
import pathlib
import random
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
SCENES = HERE.parent.parent / "scenes"
SPRINGS = ["/motor1/spring1"]
for k in (2, 3, 4):
    SPRINGS.append(f"{SPRINGS[-1]}/motor{k}/spring{k}")

# file: scene, settings, every how many rows, columns as (name, signal, standard deviation of the noise)
DATA = {
    "motor.csv": (
        HERE / "motor",
        ["/shaft.motor.resistance=1.2", "/shaft.motor.inductance=0.06", "/shaft.motor.torque_constant=0.3",
         "/shaft.damping=0.01", "/shaft/flywheel.inertia.zz=0.02"],
        1,
        [("speed", "/shaft.velocity", 0.05), ("current", "/shaft.current", 0.02)],
    ),
    "ramp.csv": (SCENES / "motor-ramp", ["duration=0.5"], 2, [("torque", "/motor.motor_torque", 2e-14)]),
    "spring.csv": (SCENES / "spring-dynamic", [], 5, [("angle", "/shoulder.position", 1e-3)]),
    "spring-again.csv": (SCENES / "spring-dynamic", [], 7, [("angle", "/shoulder.position", 1e-3)]),
    "arm.csv": (
        SCENES / "alexandros-position",
        ["duration=8.0", "record=[" + ",".join(f'"{path}.position"' for path in SPRINGS) + "]", "check=[]", "plot=[]"],
        1,
        [(f"spring{k + 1}", f"{path}.position", 2e-4) for k, path in enumerate(SPRINGS)],
    ),
}


def main():
    sincro = sys.argv[1] if len(sys.argv) > 1 else "sincro"
    for seed, (name, (scene, settings, every, columns)) in enumerate(DATA.items(), start=22):
        noise = random.Random(seed)
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "run"
            arguments = [sincro, "run", str(scene), "--out", str(out), "--json"]
            for setting in settings:
                arguments += ["--set", setting]
            subprocess.run(arguments, check=False, stdout=subprocess.DEVNULL)
            with open(out / "signals.csv", newline="") as file:
                rows = list(csv.DictReader(file))
        with open(HERE / "data" / name, "w", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(["t"] + [column for column, _, _ in columns])
            for row in rows[::every]:
                values = [float(row[signal]) + noise.gauss(0.0, sigma) for _, signal, sigma in columns]
                writer.writerow([f"{float(row['t']):.6g}"] + [f"{x:.5g}" for x in values])


if __name__ == "__main__":
    main()
