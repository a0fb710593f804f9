"""Holds the problems of third parties against their truths: python3 accuracy.py SINCRO WORK [--markdown PAGE] [--only NAME …]

Runs every folder of `scenes/third-party` at its own settings and at a tight accuracy, and the same problem in MuJoCo where its
package is installed (`accuracy_mujoco.py` says which). Of each problem the check counts whose error is the largest beside
its error bar and the uncertainty of the reference. Ends with 1 if an error at the scene's settings is beyond three error bars and the
uncertainty of the reference together, or if a run or a check of it fails. With `--markdown` it writes the table between the
markers of the page anew.

Only the standard library is needed; MuJoCo is optional.
"""

import argparse
import csv
import json
import math
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[4]
SCENES = ROOT / 'scenes/third-party'
BEGIN, END = '<!-- begin third-party problems -->', '<!-- end third-party problems -->'

# accuracy of the tight run, and the part of the step that it takes with a fixed one
TIGHT, TIGHT_STEP = '1e-13', 4
# half a unit of the sixteenth digit: values printed with all digits of double precision
ROUNDING = 2e-16


class Failure(Exception):
    """A problem that could not be judged."""


def sincro(program, *arguments):
    result = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)
    if result.returncode not in (0, 1):
        raise Failure(f'sincro {" ".join(map(str, arguments))}: {result.stderr.strip()[-400:]}')
    return result.stdout


# ---- reference values

def read_table(path):
    """Heads (`# key: text`) and columns, as texts, of a table of reference values."""
    lines = path.read_text().splitlines()
    heads = dict(re.match(r'# (\w+): (.*)', line).groups() for line in lines if re.match(r'# \w+: ', line))
    rows = list(csv.DictReader(line for line in lines if not line.startswith('#')))
    return heads, {key: [row[key] for row in rows] for key in rows[0]}


def half_digit(text):
    """Half a unit of the last digit of a number as it is printed."""
    mantissa, _, exponent = text.lower().partition('e')
    digits = len(mantissa.partition('.')[2])
    return 0.5 * 10.0 ** (int(exponent or 0) - digits)


class Reference:
    """Expected values of a check: label, source, times, values and their uncertainty in the unit of the signal."""

    def __init__(self, folder, check):
        given = check['reference']
        heads, table = read_table(folder / given['file'])
        scale, offset = given.get('scale', 1.0), given.get('offset', 0.0)
        self.label, self.source = heads['label'], heads['source']
        self.times = [float(t) for t in table[given.get('time', 't')]]
        texts = table[given['column']]
        self.values = [float(x) * scale + offset for x in texts]
        self.stated = heads.get('uncertainty', '')
        stated = float(re.split(r'[ ,]', self.stated)[0]) if self.stated else None
        if stated is None:
            self.uncertainty = max(map(half_digit, texts)) * abs(scale)
        else:
            self.uncertainty = stated * (max(map(abs, self.values)) if ' relative' in self.stated else abs(scale))
        self.uncertainty = max(self.uncertainty, ROUNDING * max(map(abs, self.values)))


def references(folder, experiment):
    """Checks of the main run against third parties by name. A relative uncertainty counts for all components of a vector alike."""
    found = {c['name']: (c['signal'], Reference(folder, c)) for c in experiment['check'] if 'reference' in c}
    for signal, reference in found.values():
        if ' relative' in reference.stated:
            vector = signal.rsplit('.', 1)[0] if re.search(r'\.[xyz]$', signal) else signal
            alike = [r for s, r in found.values() if s == signal or s.rsplit('.', 1)[0] == vector]
            largest = max(abs(x) for r in alike for x in r.values)
            reference.uncertainty = max(reference.uncertainty, float(reference.stated.split()[0]) * largest)
    return found


# ---- runs

def run(program, folder, out, *more):
    """`run.json` of the main run."""
    sincro(program, 'run', folder, '--only', 'main', '--quiet', '--out', out, *more)
    return json.loads((out / 'run.json').read_text())


def measured(report, name, signal):
    """Largest error of a check, error bar of its signal, and the unit."""
    check = next(c for c in report['checks'] if c['name'] == name)
    column = next(c for c in report['columns'] if c['path'] == signal)
    if check['deviation'] is None:
        raise Failure(f'{report["scene"]}: the check "{name}" was skipped: {check["reason"]}')
    return check['deviation'], column['error_bar'], column['unit']


def tight_settings(settings):
    if settings['integrator'] in ('rk4', 'semi-implicit-euler', 'implicit'):
        rows = settings['record_every'] * TIGHT_STEP
        return ['--step', settings['step'] / TIGHT_STEP, '--set', f'record_every={rows}']
    return ['--accuracy', TIGHT]


def number(x):
    """One or two digits, as the table prints them."""
    return '–' if x is None else '0' if x == 0 else f'{x:.1e}' if not 0.01 <= abs(x) < 1000 else f'{x:.2g}'


def method(settings):
    if settings['integrator'] in ('rk4', 'semi-implicit-euler', 'implicit'):
        return f'{settings["integrator"]}, {1000 * settings["step"]:g} ms'
    return f'{settings["integrator"]}, {settings["accuracy"]:.0e}'.replace('e-0', 'e-')


def judge(program, work, folder, peer):
    """Row of the table of one problem, and what is wrong with it."""
    experiment = tomllib.loads((folder / 'experiment.toml').read_text())
    expected = references(folder, experiment)
    if not expected:
        return eigenvalues(program, folder, experiment)
    report = run(program, folder, work / 'default')
    failed = [c['name'] for c in report['checks'] if c['verdict'] != 'holds']
    wrong = [f'{folder.name}: the check "{name}" fails' for name in failed]
    if report['status']['state'] != 'completed' or not report['audit']['ok']:
        wrong.append(f'{folder.name}: the run ended or has findings')
    rated = []
    for name, (signal, reference) in expected.items():
        error, bar, unit = measured(report, name, signal)
        limit = 3 * (bar or 0) + reference.uncertainty
        rated.append((error / limit if limit > 0 else math.inf if error > 0 else 0.0, name, signal, reference, error, bar, unit))
    share, name, signal, reference, error, bar, unit = max(rated, key=lambda r: (r[0], r[4]))
    if share > 1:
        wrong.append(f'{folder.name}: {name}: error {number(error)}, error bar {number(bar)}, reference {number(reference.uncertainty)}')
    tight = run(program, folder, work / 'tight', *tight_settings(report['settings']))
    alone = run(program, folder, work / 'alone', '--set', 'error_bar="none"')
    peers = peer(folder.name, {s: r.times for s, r in expected.values()}) if peer else None
    return {
        'name': folder.name, 'title': experiment['title'], 'label': reference.label, 'quantity': name, 'unit': unit,
        'error': error, 'bar': bar, 'uncertainty': reference.uncertainty, 'tight': measured(tight, name, signal)[0],
        'method': method(report['settings']), 'wall': alone['wall_time_s'], 'duration': report['settings']['duration'],
        'problems': problems(alone), 'checks': len(expected),
        'mujoco': peers and peer_error(peers, expected, name),
    }, wrong


def peer_error(peers, expected, name):
    """Error of the other program in the quantity `name`, or in the first one that it has, with the name of that."""
    errors = {n: max(abs(a - b) for a, b in zip(peers[s], r.values)) for n, (s, r) in expected.items() if s in peers}
    if name in errors:
        return number(errors[name])
    others = sorted(errors.items(), key=lambda e: e[1] == 0)
    return next((f'{number(error)} ({other})' for other, error in others), None)


def problems(report):
    """Number of constraint problems that were solved: with closed loops one for every evaluation of the right-hand side."""
    law = next((x for x in report['audit']['laws'] if x['law'] == 'constraint-solver'), None)
    found = law and re.match(r'\d+ of (\d+) problems', law['element'])
    return found and int(found[1])


def eigenvalues(program, folder, experiment):
    """Row of a problem whose truth are eigenvalues at several speeds: the largest distance of one from the nearest pole."""
    heads, table = read_table(folder / 'eigenvalues.csv')
    found, worst, uncertainty = {}, 0.0, 0.0
    for speed, re_text, im_text in zip(table['speed'], table['re'], table['im']):
        if speed not in found:
            text = sincro(program, 'linearize', folder, '--set', f'parameters.v={speed}', '--set', 'parameters.kick=0', '--json')
            found[speed] = [complex(*p['pole']) for p in json.loads(text)['poles']]
        truth = complex(float(re_text), float(im_text))
        worst = max(worst, min(abs(p - truth) for p in found[speed]))
        uncertainty = max(uncertainty, half_digit(re_text), half_digit(im_text) if '.' in im_text else 0.0)
    # the two digits of a complex pole, and rounding
    limit = 2**0.5 * uncertainty + 1e-12
    wrong = [f'{folder.name}: an eigenvalue is off by {number(worst)}'] if worst > limit else []
    return {
        'name': folder.name, 'title': experiment['title'], 'label': heads['label'], 'quantity': f'{len(table["re"])} eigenvalues', 'unit': '1/s',
        'error': worst, 'bar': None, 'uncertainty': uncertainty, 'tight': None, 'method': 'linearize', 'wall': None, 'duration': None,
        'problems': None, 'checks': 1, 'mujoco': None,
    }, wrong


# ---- the page

HEAD = '| problem | truth | quantity | error | error bar | error / bar | uncertainty of the truth | error, tight | method | s per s | constraint problems | MuJoCo |'


def row(r):
    unit = '' if r['unit'] in ('', '1') else ' ' + r['unit']
    below = r['error'] <= r['uncertainty']
    ratio = 'within the uncertainty' if below else '–' if not r['bar'] else f'{r["error"] / r["bar"]:.1f}'
    cost = '–' if r['wall'] is None else f'{r["wall"] / r["duration"]:.0e}'.replace('e-0', 'e-').replace('e+00', '')
    cells = [
        f'[{r["title"]}](../scenes/third-party/{r["name"]}/README.md)', r['label'], r['quantity'], number(r['error']) + unit, number(r['bar']), ratio,
        number(r['uncertainty']), number(r['tight']), r['method'], cost, r['problems'] and f'{r["problems"]:,}' or '–',
        r['mujoco'] or '',
    ]
    return '| ' + ' | '.join(cells) + ' |'


def table(rows, version, peer_words):
    n_quantities = sum(r['checks'] for r in rows)
    lines = [
        f'sincro {version}: {len(rows)} problems, {n_quantities} quantities. {peer_words}', '',
        HEAD, '|' + '---|' * HEAD.count(' |'),
        *(row(r) for r in rows),
    ]
    return '\n'.join(lines) + '\n'


def write_page(page, text):
    old = page.read_text()
    before, rest = old.split(BEGIN + '\n')
    after = rest.split(END)[1]
    page.write_text(before + BEGIN + '\n\n' + text + '\n' + END + after)


def find_peer():
    """The function that runs a problem in MuJoCo, and words about it; none where the package is missing."""
    try:
        import accuracy_mujoco
    except ImportError as error:
        print(f'skip  MuJoCo: {error}')
        return None, 'MuJoCo is not installed here.'
    return accuracy_mujoco.values, accuracy_mujoco.words()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('sincro')
    parser.add_argument('work', type=Path)
    parser.add_argument('--markdown', type=Path)
    parser.add_argument('--only', nargs='*')
    arguments = parser.parse_args()
    shutil.rmtree(arguments.work / 'runs', ignore_errors=True)
    arguments.work.mkdir(parents=True, exist_ok=True)
    program = str(Path(arguments.sincro).resolve())
    peer, words = find_peer()
    folders = sorted(p for p in SCENES.iterdir() if (p / 'experiment.toml').is_file())
    folders = [p for p in folders if not arguments.only or p.name in arguments.only]

    rows, wrong = [], []
    for folder in folders:
        try:
            found, complaints = judge(program, arguments.work / 'runs' / folder.name, folder, peer)
        except Failure as failure:
            wrong.append(str(failure))
            continue
        wrong += complaints
        rows.append(found)
        print(row(found), flush=True)
    for line in wrong:
        print('FAIL  ' + line)
    version = sincro(program, '--version').split()[1]
    (arguments.work / 'accuracy.json').write_text(json.dumps(rows, indent=1))
    if arguments.markdown and not arguments.only:
        write_page(arguments.markdown, table(rows, version, words))
    print(f'{len(rows)} problems, {sum(r["checks"] for r in rows)} quantities, {len(wrong)} failures')
    sys.exit(1 if wrong else 0)


if __name__ == '__main__':
    main()
