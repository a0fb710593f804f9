"""Runs the acceptance programs and scripts: python3 run.py SINCRO [--v2 PYTHON] [--v1 PYTHON] [NAME …].

Programs are started one after the other against `sincro serve` of the scene that their first line names; scripts are put on an object of
their scene and run by `sincro run`. A program passes if it ends with status 0, a script if it says `passed`. `--v2` and `--v1` name the
interpreters that have CoppeliaSim's client 2.0.4 and 0.0.5; without one, its programs are left out. Prints a table; ends with 1 if one failed.
"""

import argparse
import collections
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import time

HERE = pathlib.Path(__file__).resolve().parent
SCENES = HERE / 'scenes'
TIME_LIMIT = 60


def header(path):
    """Keys of the first line: `# scene: arm` or `-- scene: arm, object: /base`."""
    first = path.read_text().splitlines()[0].lstrip('#- ')
    return dict(part.split(': ', 1) for part in first.split(', ') if ': ' in part)


def serve(sincro, scene, out):
    """A server on free ports: the process, and its ports by API."""
    ports = ['--legacy-port', '0', '--zmq-port', '0', '--ws-port', '0']
    command = [sincro, 'serve', scene, *ports, '--record', 'none', '--out', out]
    server = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    found, lines = {}, []
    for line in server.stdout:
        lines.append(line)
        for key, pattern in (('legacy', r'legacy.* [\d.]+:(\d+)'), ('zmq', r'ZeroMQ.* [\d.]+:(\d+) .*:(\d+)\)')):
            match = re.search(pattern, line)
            if match:
                found[key] = match.groups()
        if len(found) == 2 and 'ends' in line:
            # what the server says later is read and dropped: a full pipe would stop it
            threading.Thread(target=collections.deque, args=(server.stdout, 0), daemon=True).start()
            return server, found
    server.wait()
    raise SystemExit('the server has ended: ' + ''.join(lines))


def run_program(sincro, command, path, api):
    """Reason of the failure of a program, none if it passed."""
    with tempfile.TemporaryDirectory() as out:
        server, ports = serve(sincro, SCENES / header(path)['scene'], f'{out}/served')
        try:
            done = subprocess.run([*command, path, *ports[api]], capture_output=True, text=True, timeout=TIME_LIMIT)
        except subprocess.TimeoutExpired:
            return f'not done after {TIME_LIMIT} s'
        finally:
            server.terminate()
            server.wait()
    return None if done.returncode == 0 else (done.stderr or done.stdout).strip()[-600:]


def run_script(sincro, path):
    """Reason of the failure of a script, none if it passed."""
    keys = header(path)
    with tempfile.TemporaryDirectory() as folder:
        scene = pathlib.Path(folder) / 'scene'
        shutil.copytree(SCENES / keys['scene'], scene)
        shutil.copy(path, scene / 'acceptance.lua')
        more = [f'object = "{keys["object"]}"', 'file = "acceptance.lua"']
        if keys.get('threaded'):
            more.append('threaded = true')
        if keys.get('parameters'):
            more.append('parameters = { ' + keys['parameters'] + ' }')
        text = (scene / 'scene.toml').read_text()
        if keys['object'] == '/base':
            # an object has one child script
            text = text.split('\n[[script]]')[0] + '\n'
        (scene / 'scene.toml').write_text(text + '\n[[script]]\n' + '\n'.join(more) + '\n')
        command = [sincro, 'run', scene, '--set', f'duration={keys["duration"]}', '--quiet', '--out', f'{folder}/out']
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=TIME_LIMIT)
        except subprocess.TimeoutExpired:
            return f'not done after {TIME_LIMIT} s'
        results = pathlib.Path(folder) / 'out' / 'run.json'
        if done.returncode != 0 or not results.exists():
            return (done.stderr + done.stdout).strip()[-600:]
        said = [message['text'] for message in json.loads(results.read_text()).get('messages', [])]
    return None if 'passed' in said else f'it said {said[-3:]}'


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('sincro')
    parser.add_argument('--v2')
    parser.add_argument('--v1')
    parser.add_argument('names', nargs='*')
    options = parser.parse_intermixed_args()
    sincro = str(pathlib.Path(options.sincro).resolve())
    groups = [
        ('legacy', [sys.executable], '*.py', 'legacy'),
        ('zmq', options.v2 and [options.v2], '*.py', 'zmq'),
        ('zmq1', options.v1 and [options.v1], '*.py', 'zmq'),
        ('scripts', None, '*.lua', None),
    ]
    known = {path.stem for folder, _, pattern, _ in groups for path in (HERE / folder).glob(pattern)}
    if unknown := sorted(set(options.names) - known):
        parser.error(f'there is no program or script {", ".join(unknown)}: {", ".join(sorted(known))}')
    table, start = [], time.monotonic()
    for folder, command, pattern, api in groups:
        for path in sorted((HERE / folder).glob(pattern)):
            if options.names and path.stem not in options.names:
                continue
            if command is None and api:
                table.append((folder, path.stem, 'left out'))
                continue
            why = run_program(sincro, command, path, api) if api else run_script(sincro, path)
            table.append((folder, path.stem, 'passed' if why is None else 'FAILED'))
            print(f'{folder + "/" + path.stem:32} {table[-1][2]}', flush=True)
            if why:
                print('    ' + why.replace('\n', '\n    '), flush=True)
    print()
    for folder, *_ in groups:
        rows = [row for row in table if row[0] == folder]
        counts = {word: sum(row[2] == word for row in rows) for word in ('passed', 'FAILED', 'left out')}
        if rows:
            print(f'{folder:8} {counts["passed"]} of {len(rows)} passed, {counts["left out"]} left out')
    print(f'{time.monotonic() - start:.0f} s')
    sys.exit(any(row[2] == 'FAILED' for row in table))


if __name__ == '__main__':
    main()
