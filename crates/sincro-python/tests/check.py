"""Builds the wheel, installs it in a fresh environment and judges it there: size, time of installation and of import,
symbols, stubs, tests. Usage: check.py WORK_FOLDER [--speed]"""

import json
import subprocess
import sys
import time
import venv
from pathlib import Path

CRATE = Path(__file__).resolve().parents[1]
ROOT = CRATE.parents[1]
TOOLS = ["maturin==1.16.0", "auditwheel==6.4.0"]
JUDGES = ["pytest==9.2.0", "hypothesis==6.170.15", "gymnasium==1.4.0", "mypy==2.4.1", "matplotlib>=3.8"]

MAX_WHEEL_MB = 15
MAX_INSTALL_S = 5.0
MAX_IMPORT_S = 0.05
# the machine of the checks is shared: times are bounded by this many times what an idle one must reach
BUSY = 3


def environment(folder, packages):
    python = folder / "bin/python"
    if not python.is_file():
        venv.create(folder, with_pip=True, clear=True)
    run(python, "-m", "pip", "install", "-q", "--disable-pip-version-check", *packages)
    return python


def run(*command, **options):
    return subprocess.run([str(part) for part in command], check=True, **options)


def import_time(python):
    code = "import time, numpy; t = time.perf_counter(); import sincro; print(time.perf_counter() - t)"
    times = [float(run(python, "-c", code, capture_output=True, text=True).stdout) for _ in range(5)]
    return min(times)


def main():
    work = Path(sys.argv[1]).resolve()
    work.mkdir(parents=True, exist_ok=True)
    tools = environment(work / "tools", TOOLS)
    wheels = work / "wheels"
    for old in wheels.glob("*.whl"):
        old.unlink()
    run(tools, "-m", "maturin", "build", "--release", "--out", wheels, "--manifest-path", CRATE / "Cargo.toml", cwd=ROOT)
    (wheel,) = wheels.glob("sincro-*.whl")
    found = {"wheel_mb": wheel.stat().st_size / 1e6}
    shown = run(tools, "-m", "auditwheel", "show", wheel, capture_output=True, text=True).stdout
    found["manylinux"] = "manylinux_2_" in shown

    fresh = work / "fresh"
    venv.create(fresh, with_pip=True, clear=True)
    python = fresh / "bin/python"
    run(python, "-m", "pip", "install", "-q", "--disable-pip-version-check", "numpy")
    start = time.monotonic()
    run(python, "-m", "pip", "install", "-q", "--disable-pip-version-check", "--no-index", wheel)
    found["install_s"] = time.monotonic() - start
    found["import_s"] = import_time(python)
    print(json.dumps(found))
    assert found["wheel_mb"] <= MAX_WHEEL_MB and found["manylinux"], found
    assert found["install_s"] <= BUSY * MAX_INSTALL_S and found["import_s"] <= BUSY * MAX_IMPORT_S, found

    run(python, "-m", "pip", "install", "-q", "--disable-pip-version-check", *JUDGES)
    run(python, "-m", "mypy.stubtest", "sincro._sincro", cwd=work)
    run(python, "-m", "pytest", "-q", "-p", "no:cacheprovider", CRATE / "tests", cwd=work)
    if "--speed" in sys.argv[2:]:
        run(python, CRATE / "tests/speed.py", cwd=ROOT)


if __name__ == "__main__":
    main()
