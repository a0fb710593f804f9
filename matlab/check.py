"""Runs check.m in Octave: python3 check.py SINCRO [SCENES]. Needs Octave with its package instrument-control.

Ends with 0 if all functions do what their help says, and if no file has syntax that MATLAB does not know.
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent

# what Octave reads and MATLAB does not, outside of texts and comments
OCTAVE_ONLY = re.compile(r'"|#|!=|(\+|-|\*|/|\|)=|\+\+|\bend(if|for|function|while|switch|_try_catch)\b|\b(printf|unwind_protect|until|do)\b')


def code(line):
    """A line without its texts and its comment."""
    without_texts = re.sub(r"(?<![\w\])}'.])'(?:[^']|'')*'", "''", line)
    return without_texts.split('%')[0]


def is_running(word):
    """True if a process of this machine has the word in its command line."""
    for place in pathlib.Path('/proc').glob('[0-9]*/cmdline'):
        try:
            if word.encode() in place.read_bytes():
                return True
        except OSError:
            continue
    return False


def main():
    sincro = pathlib.Path(sys.argv[1]).resolve()
    scenes = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else HERE.parent / 'scenes').resolve()
    for file in sorted(HERE.rglob('*.m')):
        for number, line in enumerate(file.read_text().splitlines(), 1):
            assert not (found := OCTAVE_ONLY.search(code(line))), f'{file}:{number}: MATLAB does not know `{found[0]}`'
    with tempfile.TemporaryDirectory() as out:
        environment = {**os.environ, 'SINCRO': str(sincro), 'SCENES': str(scenes), 'OUT': out}
        command = ['octave-cli', '--no-gui', '--path', HERE, '--eval', 'check']
        subprocess.run(command, check=True, env=environment, timeout=600)
        # a program that ends without sincro_stop leaves no server behind
        left = f"pkg load instrument-control; sincro_start('{scenes}/two-dof-remote', {{}}, 'out', '{out}/left');"
        subprocess.run(['octave-cli', '--no-gui', '--path', HERE, '--eval', left], check=True, env=environment)
        for _ in range(100):
            if not is_running(f'{out}/left'):
                break
            time.sleep(0.2)
        else:
            raise SystemExit('a server is left behind')
    print('Octave: the functions of the folder matlab do what their help says')


if __name__ == '__main__':
    main()
