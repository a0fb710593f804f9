"""Runs the Octave programs of the legacy remote API against a server that it starts and ends: python3 check.py SINCRO [SCENES].

Needs Octave with its package instrument-control, and the port 19997. Ends with 0 if the run has the trace hash of `sincro run`.
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent


def main():
    sincro = sys.argv[1]
    scenes = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else HERE.parents[2] / 'scenes')
    scene = scenes / 'two-dof-remote'
    with tempfile.TemporaryDirectory() as out:
        subprocess.run([sincro, 'run', scene, '--out', f'{out}/run'], check=True, stdout=subprocess.DEVNULL)
        expected = json.loads(pathlib.Path(f'{out}/run/run.json').read_text())['trace_hash']
        ports = ['--legacy-port', '19997', '--zmq-port', '0', '--ws-port', '0']
        server = subprocess.Popen([sincro, 'serve', scene, *ports, '--out', f'{out}/served'], stdout=subprocess.PIPE, text=True)
        try:
            if not any('Ctrl-C' in line for line in server.stdout):
                raise SystemExit('the server has ended before it listened')
            for program in ['check.m', 'two_dof.m']:
                subprocess.run(['octave-cli', '--no-gui', '--path', HERE, HERE / program], check=True)
            found = next(found for found in (re.search(r'run 1 .* trace (\w+)', line) for line in server.stdout) if found)
        finally:
            server.terminate()
            server.wait()
        assert found[1] == expected, f'{found[1]} is not the hash of `sincro run`, {expected}'
    print(f'Octave, legacy: the client and the diagram have the same trace, {expected}')


if __name__ == '__main__':
    main()
