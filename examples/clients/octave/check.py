"""Runs the Octave programs of the legacy remote API against servers that it starts and ends: python3 check.py SINCRO [SCENES].

Needs Octave with its package instrument-control, and the port 19997. Ends with 0 if every run has the trace hash of `sincro run`.
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent

# scene, programs, statement before them, variant whose trace hash the run has; None: none is claimed, because the
# program does what no run in process does
RUNS = [
    ('two-dof-remote', ['check.m', 'two_dof.m'], '', 'main'),
    ('thesis-motor', ['thesis/motor.m'], '', 'main'),
    ('thesis-spring', ['thesis/rod.m'], '', 'main'),
    ('thesis-spring', ['thesis/static.m'], '', None),
    ('thesis-two-dof', ['thesis/two_dof.m'], '', 'main'),
    ('thesis-flexible', ['thesis/flexible.m'], '', 'main'),
    ('thesis-flexible', ['thesis/flexible.m'], 'speed = 0.5;', 'velocity-step'),
    ('thesis-arm', ['thesis/arm.m'], '', 'main'),
    ('thesis-arm-force', ['thesis/arm_force.m'], '', 'main'),
    ('thesis-arm-force', ['thesis/arm_force.m'], 'F_d = 0.25; K = 12;', 'F025-K12'),
    ('stock-propeller', ['thesis/stock_propeller.m'], '', None),
    ('propeller-lua', ['thesis/propeller.m'], '', None),
    ('thesis-quadrotor', ['thesis/quadrotor.m'], '', 'main'),
    ('thesis-quadrotor', ['thesis/quadrotor.m'], 'waypoints = [0, 0, 1; 0.1, 0, 1; 0.2, 0, 1];', 'flight-2'),
    ('thesis-quadrotor', ['thesis/open_loop.m'], '', 'open-loop'),
    ('thesis-quadrotor-lua', ['thesis/quadrotor.m'], '', 'main'),
    ('aerial-manipulator-remote', ['thesis/manipulator.m'], '', 'main'),
    ('aerial-manipulator-contact-remote', ['thesis/manipulator_contact.m'], '', 'main'),
    ('aerial-manipulator-grasp-remote', ['thesis/manipulator_grasp.m'], '', 'main'),
]


def hashes(sincro, scene, out):
    """Trace hashes of the scene's own run and of its variants."""
    if not (out / 'run.json').is_file():
        subprocess.run([sincro, 'run', scene, '--out', out], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    run = json.loads((out / 'run.json').read_text())
    return {'main': run['trace_hash'], **{variant['name']: variant['trace_hash'] for variant in run['variants']}}


def served(sincro, scene, programs, before, out):
    """Trace hash of the run that the programs make."""
    ports = ['--legacy-port', '19997', '--zmq-port', '0', '--ws-port', '0']
    command = [sincro, 'serve', scene, *ports, '--record', 'signals', '--out', out]
    server = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    environment = {**os.environ, 'SINCRO_PORT': '19997'}
    try:
        if not any('Ctrl-C' in line for line in server.stdout):
            raise SystemExit('the server has ended before it listened')
        for program in programs:
            octave = ['octave-cli', '--no-gui', '--path', HERE, '--path', HERE / 'thesis']
            subprocess.run([*octave, '--eval', f"{before} source('{HERE / program}')"], check=True, env=environment)
        return next(found[1] for found in (re.search(r'run 1 .* trace (\w+)', line) for line in server.stdout) if found)
    finally:
        server.terminate()
        server.wait()


def main():
    sincro = sys.argv[1]
    scenes = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else HERE.parents[2] / 'scenes')
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder)
        for number, (name, programs, before, variant) in enumerate(RUNS):
            found = served(sincro, scenes / name, programs, before, out / f'served-{number}')
            if variant is None:
                print(f'Octave, legacy: {name} has run, trace {found}')
                continue
            expected = hashes(sincro, scenes / name, out / name)[variant]
            assert found == expected, f'{name}: {found} is not the hash of `sincro run`, {expected} ({variant})'
            print(f'Octave, legacy: client and diagram of {name}, {variant}, have the same trace, {expected}')


if __name__ == '__main__':
    main()
