"""Trace hashes on emulated processors: python3 processors.py SINCRO TRACES WORK [SCENE …].

Runs scenes under user-mode emulation (`qemu-x86_64` of Debian's package `qemu-user`) on processors without AVX (`qemu64`,
`Nehalem`), with AVX and FMA (`Haswell`), and on the machine's own, and compares each trace hash with the committed one.
Ends with 0 if all are equal.

Only the standard library is needed.
"""

import json
import pathlib
import shutil
import subprocess
import sys

PROCESSORS = ['qemu64', 'Nehalem', 'Haswell']

# a spring, a robot with its controller, a flight, a closed loop, contacts
SCENES = ['spring-dynamic', 'two-dof-position', 'quadrotor-flight-1', 'slider-crank', 'gripper']

# s; emulation is 20 to 100 times slower than the machine
PATIENCE = 1800


def trace(program, processor, scene, folder):
    """Trace hash of a scene's main run; None with the reason if there is none."""
    emulator = ['qemu-x86_64', '-cpu', processor] if processor else []
    command = [*emulator, str(program), 'run', str(scene), '--only', 'main', '--quiet', '--out', str(folder)]
    shutil.rmtree(folder, ignore_errors=True)
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE)
    except subprocess.TimeoutExpired:
        return None, f'no result after {PATIENCE} s'
    result = folder / 'run.json'
    if not result.exists():
        return None, done.stderr.strip()[-300:]
    return json.loads(result.read_text())['trace_hash'], ''


def main(program, traces, work, names):
    if shutil.which('qemu-x86_64') is None:
        sys.exit('there is no qemu-x86_64: install the package qemu-user')
    committed = dict(line.split() for line in traces.read_text().splitlines() if line.strip())
    scenes = traces.resolve().parents[2] / 'scenes'
    wrong = 0
    for name in names:
        for processor in [None, *PROCESSORS]:
            found, reason = trace(program, processor, scenes / name, work / f'{name}-{processor or "own"}')
            is_equal = found is not None and committed[name] in found
            wrong += not is_equal
            words = 'same bits' if is_equal else f'{found or reason}, committed {committed[name]}'
            print(f'{name:<24} {processor or "this machine":<14} {words}', flush=True)
    print(f'{wrong} of {len(names) * (1 + len(PROCESSORS))} traces differ')
    return wrong == 0


if __name__ == '__main__':
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    program, traces, work = (pathlib.Path(x) for x in sys.argv[1:4])
    work.mkdir(parents=True, exist_ok=True)
    sys.exit(0 if main(program.resolve(), traces, work, sys.argv[4:] or SCENES) else 1)
