"""Errors of mechanisms that switch, close and collide, against their error bars: python3 error_bars.py SINCRO WORK [SIGNALS [SEED]].

Draws mechanisms at random: arms with limited motors, joint friction (Coulomb and Stribeck) and joint limits, arms above a
floor, robots on wheels, blocks that slide, four-bar linkages in any orientation. Each is run as a user would, at the default
accuracy with its error bars; the truth is a run at the accuracy 1e-13, and counts where a run with the integrator `stiff` (for
the explicit method, else `dormand-prince`) at 1e-12 confirms it. Ends with 0 if no more than 1 % of the signals are beyond
three error bars, and none beyond ten in a run without a finding or a warning.

Only the standard library is needed. Lengths in m, angles in rad.
"""

import csv
import json
import math
import pathlib
import random
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

# a row of the run is a truth if two integrators differ by less than this part of the error bar
CONFIRMED = 0.3


def vector(x):
    return '[' + ', '.join(f'{a:.17g}' for a in x) + ']'


def unit(r):
    x = [r.gauss(0, 1) for _ in range(3)]
    n = math.sqrt(sum(a * a for a in x))
    return [a / n for a in x]


def decade(r, low, high):
    return 10 ** r.uniform(low, high)


def friction(r):
    limit = decade(r, -2, 0.5)
    if r.random() < 0.5:
        return f'friction = {limit:.6g}\n'
    return f'friction = {{ sliding = {limit:.6g}, static = {limit * r.uniform(1, 2):.6g}, stribeck_velocity = {decade(r, -2, 0):.6g} }}\n'


def command(r):
    kind = r.randrange(3)
    if kind == 0:
        return f'{r.uniform(-3, 3):.5g}'
    if kind == 1:
        return f'{{ sine = {{ amplitude = {r.uniform(0.5, 3):.5g}, frequency_hz = {r.uniform(0.2, 2):.5g} }} }}'
    return f'{{ step = {{ time = {r.uniform(0.1, 0.6):.5g}, from = 0.0, to = {r.uniform(-2, 2):.5g} }} }}'


def body(name, parent, mass, size, more=''):
    inertia = mass * size * size / 12
    return (f'[[body]]\nname = "{name}"\nparent = "{parent}"\nmass = {mass:.6g}\n'
            f'inertia = {{ xx = {inertia:.6g}, yy = {1.2 * inertia:.6g}, zz = {0.9 * inertia:.6g} }}\n{more}\n')


def links(r, n, height, motor, tip=''):
    """A chain of revolute joints; returns text and paths of the joints."""
    text, paths, parent, at = '', [], '', [0, 0, height]
    for k in range(n):
        axis = r.choice([[0, 1, 0], [0, 1, 0], [1, 0, 0], unit(r)])
        text += f'[[joint]]\nname = "j{k}"\n' + (f'parent = "{parent}"\n' if parent else '')
        text += f'kind = "revolute"\naxis = {vector(axis)}\nposition = {vector(at)}\ninitial = {{ position = {r.uniform(-0.4, 0.4):.6g} }}\n'
        if r.random() < 0.4:
            text += f'limits = {{ lower = {r.uniform(-1.5, -0.5):.6g}, upper = {r.uniform(0.5, 1.5):.6g}, restitution = {r.choice([0, 0.4])} }}\n'
        if r.random() < 0.3:
            text += friction(r)
        if motor:
            text += f'motor = {{ mode = "velocity", max_torque = {decade(r, -1, 2):.6g}, command = {command(r)} }}\n'
        parent += f'/j{k}'
        paths.append(parent)
        length = r.uniform(0.2, 0.4)
        more = f'center_of_mass = [{length / 2:.6g}, 0, 0]\n' + (tip.replace('LENGTH', f'{length:.6g}') if k == n - 1 else '')
        text += body(f'b{k}', parent, decade(r, -0.5, 0.7), length, more)
        parent += f'/b{k}'
        at = [length, 0, 0]
    return text, paths


def floor(mu, e):
    return f'[[body]]\nname = "floor"\nshape = [{{ plane = {{}} }}]\ncontact = {{ friction = {mu}, restitution = {e} }}\n'


def arm(r):
    text, paths = links(r, r.randint(2, 5), 0, True)
    return text, paths


def pendulums(r):
    return links(r, r.randint(1, 3), 0, False)


def arm_on_floor(r):
    mu, e = r.choice([0, 0.3, 0.8]), r.choice([0, 0.5])
    tip = f'shape = [{{ sphere = {{ radius = 0.05 }}, position = [LENGTH, 0, 0] }}]\ncontact = {{ friction = {mu}, restitution = {e} }}\n'
    text, paths = links(r, r.randint(2, 3), r.uniform(0.3, 0.7), True, tip)
    return floor(mu, e) + text, paths


def wheels(r):
    mu = r.choice([0.3, 0.8, 1.2])
    text = floor(mu, 0) + '[[joint]]\nname = "base"\nkind = "free"\ninitial = { position = [0, 0, 0.1, 1, 0, 0, 0] }\n'
    castor = f'shape = [{{ sphere = {{ radius = 0.05 }}, position = [-0.1, 0, -0.05] }}]\ncontact = {{ friction = 0.0 }}\ncenter_of_mass = [-0.02, 0, {r.uniform(-0.02, 0.03):.5f}]\n'
    text += body('robot', '/base', r.uniform(1, 5), 0.3, castor)
    for k in range(2):
        text += (f'[[joint]]\nname = "w{k}"\nparent = "/base/robot"\nkind = "revolute"\naxis = [0, 1, 0]\nposition = [0.08, {0.3 * k - 0.15}, 0]\n'
                 f'motor = {{ mode = "velocity", max_torque = {decade(r, -1.5, 2):.6g}, command = {r.uniform(-8, 8):.5g} }}\n')
        rim = f'shape = [{{ cylinder = {{ radius = 0.1, length = 0.03 }}, rotation_deg = [90, 0, 0] }}]\ncontact = {{ friction = {mu} }}\n'
        text += body(f'wheel{k}', f'/base/robot/w{k}', r.uniform(0.1, 0.5), 0.2, rim)
    return text, ['/base', '/base/robot/w0', '/base/robot/w1']


def blocks(r):
    mu, e = r.choice([0.1, 0.4, 0.8]), r.choice([0, 0, 0.5])
    text, paths = floor(mu, e), []
    for k in range(r.randint(1, 2)):
        speed = [r.uniform(-1, 1), r.uniform(-1, 1), 0]
        text += f'[[joint]]\nname = "f{k}"\nkind = "free"\ninitial = {{ position = [{k}, 0, {0.1 if e == 0 else 0.15}, 1, 0, 0, 0], velocity = [0, 0, {r.uniform(-2, 2):.5g}, {speed[0]:.5g}, {speed[1]:.5g}, 0] }}\n'
        text += (f'[[body]]\nname = "block{k}"\nparent = "/f{k}"\ndensity = {decade(r, 2, 3.5):.6g}\nshape = [{{ cuboid = {{ size = [0.3, 0.25, 0.2] }} }}]\n'
                 f'contact = {{ friction = {mu}, restitution = {e} }}\n')
        paths.append(f'/f{k}')
    return text, paths


def four_bar(r):
    """A crank, a coupler and a rocker in a plane of any orientation, closed by a hinge."""
    a, c = r.uniform(0.2, 0.4), r.uniform(0.6, 0.9)
    b, ground = r.uniform(0.6, 0.9), r.uniform(0.5, 0.8)
    angle = r.uniform(0.6, 2.4)
    tip = [a * math.cos(angle), a * math.sin(angle)]
    reach = math.hypot(ground - tip[0], -tip[1])
    if not abs(b - c) + 0.05 < reach < b + c - 0.05:
        return four_bar(r)
    towards = math.atan2(-tip[1], ground - tip[0])
    coupler = towards + math.acos((b * b + reach * reach - c * c) / (2 * b * reach))
    pin = [tip[0] + b * math.cos(coupler), tip[1] + b * math.sin(coupler)]
    rocker = math.atan2(pin[1], pin[0] - ground)
    turn = [r.uniform(-180, 180) for _ in range(3)]
    motor = f'motor = {{ mode = "velocity", max_torque = {decade(r, -0.5, 1.5):.6g}, command = {command(r)} }}\n' if r.random() < 0.7 else ''
    text = f'[[frame]]\nname = "g"\nrotation_deg = {vector(turn)}\n'

    def bar(name, parent, at, q, length, more=''):
        joint = f'[[joint]]\nname = "{name}"\nparent = "{parent}"\nkind = "revolute"\naxis = [0, 0, 1]\nposition = {vector(at)}\ninitial = {{ position = {q:.17g} }}\n{more}'
        return joint + body(f'b{name}', f'{parent}/{name}', decade(r, -0.5, 0.5), length, f'center_of_mass = [{length / 2:.6g}, 0, 0]\n')

    text += bar('crank', '/g', [0, 0, 0], angle, a, motor + (friction(r) if r.random() < 0.3 else ''))
    text += bar('coupler', '/g/crank/bcrank', [a, 0, 0], coupler - angle, b)
    text += bar('rocker', '/g', [ground, 0, 0], rocker, c)
    text += f'[[frame]]\nname = "p"\nparent = "/g/crank/bcrank/coupler/bcoupler"\nposition = [{b:.17g}, 0, 0]\n'
    text += f'[[frame]]\nname = "p"\nparent = "/g/rocker/brocker"\nposition = [{c:.17g}, 0, 0]\n'
    text += '[[closure]]\nname = "pin"\nkind = "hinge"\nbetween = ["/g/crank/bcrank/coupler/bcoupler/p", "/g/rocker/brocker/p"]\n'
    return text, ['/g/crank', '/g/crank/bcrank/coupler', '/g/rocker']


KINDS = [arm, pendulums, arm_on_floor, wheels, blocks, four_bar]


def record(text, path):
    if f'name = "{path[1:]}"\nkind = "free"' in text:
        return [f'{path}.position.{c}' for c in 'xyz'] + [f'{path}.velocity.{c}' for c in 'xyz']
    return [f'{path}.position', f'{path}.velocity']


def experiment(signals, **settings):
    text = 'format = 2\ntitle = "Random mechanism"\nscene = "scene.toml"\nduration = 1.0\nstep = 0.005\n'
    text += ''.join(f'{key} = {json.dumps(value)}\n' for key, value in settings.items())
    return text + 'record = ' + json.dumps(signals) + '\n'


def run(sincro, folder, settings, signals):
    """Columns and report of a run; none if it did not come to its end."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / 'experiment.toml').write_text(experiment(signals, **settings))
    out = folder / 'out'
    shutil.rmtree(out, ignore_errors=True)
    try:
        done = subprocess.run([sincro, 'run', folder, '--out', out, '--quiet'], capture_output=True, text=True, timeout=120)
    except subprocess.TimeoutExpired:
        return None, 'took more than 120 s'
    if not (out / 'run.json').exists():
        return None, done.stderr.strip()[:300]
    report = json.loads((out / 'run.json').read_text())
    if report['status'] != {'state': 'completed'}:
        return None, json.dumps(report['status'])[:300]
    with open(out / 'signals.csv') as file:
        rows = [row for row in csv.reader(file) if row and not row[0].startswith('#')]
    names = rows[0]
    numbers = [[float(x) for x in row] for row in rows[1:] if row[0].replace('.', '').replace('e', '').replace('-', '').isdigit()]
    return {name: [row[k] for row in numbers] for k, name in enumerate(names)}, report


def draw(sincro, work, seed):
    r = random.Random(seed)
    kind = KINDS[seed % len(KINDS)]
    scene, paths = kind(r)
    signals = [name for path in paths for name in record(scene, path)] + ['energy.total']
    runs = {}
    for name, settings in [('user', {'error_bar': 'refine'}),
                           ('truth', {'error_bar': 'none', 'accuracy': 1e-13, 'integrator': 'dormand-prince'}),
                           ('second', {'error_bar': 'none', 'accuracy': 1e-12, 'integrator': 'stiff'})]:
        folder = work / str(seed) / name
        folder.mkdir(parents=True, exist_ok=True)
        (folder / 'scene.toml').write_text('format = 2\n' + scene)
        runs[name] = run(sincro, folder, settings, signals)
        if runs[name][0] is None and 'overlap at the start' in runs[name][1]:
            # rightly refused: drawn into the floor
            return None
        if runs[name][0] is None:
            return {'seed': seed, 'kind': kind.__name__, 'failed': f'{name}: {runs[name][1]}'}
    user, report = runs['user']
    truth, second = runs['truth'][0], runs['second'][0]
    bars = {column['path']: column.get('error_bar') for column in report['columns']}
    ok, warned = report['audit']['ok'], bool(report['warnings'])
    ratios, unconfirmed = [], 0
    for name in signals:
        n = min(len(user[name]), len(truth[name]), len(second[name]))
        error = max(abs(a - b) for a, b in zip(user[name][:n], truth[name][:n]))
        doubt = max(abs(a - b) for a, b in zip(second[name][:n], truth[name][:n]))
        bar = bars.get(name)
        if bar is None or doubt > CONFIRMED * max(bar, error):
            unconfirmed += 1
            continue
        # a few roundings of the largest value are no error
        rounding = 1e-15 * max(1.0, max(abs(a) for a in truth[name][:n]))
        ratios.append((max(0.0, error - rounding) / max(bar, 1e-300) if error > rounding else 0.0, name, error, bar))
    return {'seed': seed, 'kind': kind.__name__, 'ratios': ratios, 'unconfirmed': unconfirmed, 'ok': ok, 'warned': warned}


def main():
    sincro, work = sys.argv[1], pathlib.Path(sys.argv[2])
    wanted = int(sys.argv[3]) if len(sys.argv) > 3 else 2000
    seed = int(sys.argv[4]) if len(sys.argv) > 4 else 0
    shutil.rmtree(work, ignore_errors=True)
    found, ratios, unconfirmed, failed = [], [], 0, []
    with ThreadPoolExecutor(2) as pool:
        while len(ratios) < wanted:
            for one in pool.map(lambda k: draw(sincro, work, k), range(seed, seed + 24)):
                if one is None:
                    continue
                if 'failed' in one:
                    failed.append(one)
                    continue
                found.append(one)
                unconfirmed += one['unconfirmed']
                ratios += [(*ratio, one) for ratio in one['ratios']]
            seed += 24
            print(f'{len(ratios)} signals', flush=True)
    over = [entry for entry in ratios if entry[0] > 3]
    silent = [entry for entry in ratios if entry[0] > 10 and entry[4]['ok'] and not entry[4]['warned']]
    ratios.sort(key=lambda entry: entry[0])
    at = lambda share: ratios[int(share * (len(ratios) - 1))][0]
    print(f'{len(ratios)} signals of {len(found)} mechanisms; {unconfirmed} without a confirmed truth, {len(failed)} mechanisms not run')
    print(f'error over error bar: median {at(0.5):.2f}, 90 % below {at(0.9):.2f}, 99 % below {at(0.99):.2f}, largest {at(1):.3g}')
    print(f'above 3: {len(over)} ({100 * len(over) / len(ratios):.2f} %, at most 1 %); above 10 without a finding or a warning: {len(silent)}')
    print(f'audits with findings: {sum(not one["ok"] for one in found)}; runs with a warning: {sum(one["warned"] for one in found)}')
    for ratio, name, error, bar, one in sorted(over, key=lambda entry: -entry[0])[:20]:
        print(f'  {one["kind"]} {one["seed"]} {name}: {error:.2e} against {bar:.2e}, ratio {ratio:.3g}, audit {"ok" if one["ok"] else "with findings"}')
    for one in failed[:20]:
        print(f'  {one["kind"]} {one["seed"]} not run: {one["failed"]}')
    return 0 if len(over) <= 0.01 * len(ratios) and not silent and not failed else 1


if __name__ == '__main__':
    sys.exit(main())
