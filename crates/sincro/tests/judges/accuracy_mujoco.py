"""Problems of third parties in MuJoCo, at its default settings: Euler's method with 2 ms, default solver and contacts.

`values(name, wanted)` runs the problem of that name, if it stands here, and returns the values of its signals at the wanted times
(signal → times). Models are written as plainly as those of the scenes; nothing is tuned. Lengths in m, angles in rad.
"""

import math

import mujoco
import numpy as np

OPTION = '<option gravity="{0}"/>'
BOX_INERTIA = '0.808333333333333 0.683333333333333 0.141666666666667'


def words():
    return f'MuJoCo {mujoco.__version__}: default settings, Euler\'s method with 2 ms; the error of the same quantity, or of the one in brackets. Empty: the problem was not written for it.'


def model(world, gravity='0 0 -9.81', more=''):
    text = f'<mujoco><compiler angle="radian"/>{OPTION.format(gravity)}<worldbody>{world}</worldbody>{more}</mujoco>'
    return mujoco.MjModel.from_xml_string(text)


def simulate(m, start, signals, wanted, push=None):
    """Values of those wanted signals that have a counterpart, which is a function of the data."""
    wanted = {signal: times for signal, times in wanted.items() if signal in signals}
    d = mujoco.MjData(m)
    start(d)
    steps = sorted({round(t / m.opt.timestep) for times in wanted.values() for t in times})
    found, k = {}, 0
    for n in steps:
        for _ in range(n - k):
            if push:
                push(d)
            mujoco.mj_step(m, d)
        k = n
        mujoco.mj_forward(m, d)
        found[n] = {signal: signals[signal](d) for signal in wanted}
    return {signal: [float(found[round(t / m.opt.timestep)][signal]) for t in times] for signal, times in wanted.items()}


def at(path, get):
    """Signals of a body's position, velocity and angular velocity in world axes, by component."""
    kinds = {'position': lambda d: get(d).xipos, 'angular_velocity': lambda d: velocity(d, get(d).id)[:3], 'velocity': lambda d: velocity(d, get(d).id)[3:]}
    return {f'{path}.{kind}.{c}': (lambda d, f=f, i=i: f(d)[i]) for kind, f in kinds.items() for i, c in enumerate('xyz')}


def velocity(d, body):
    """Angular and linear velocity of a body's centre of mass in world axes."""
    found = np.zeros(6)
    mujoco.mj_objectVelocity(d.model, d, mujoco.mjtObj.mjOBJ_BODY, body, found, 0)
    return found


def still(d):
    pass


# ---- mechanisms

def pendulum(wanted):
    m = model('<body><joint name="pivot" axis="0 0 1"/><inertial pos="0 -1 0" mass="1" diaginertia="1e-12 1e-12 1e-12"/></body>', '0 -9.81 0')

    def start(d):
        d.qpos[0] = -math.pi / 2
    return simulate(m, start, at('/pivot/bob', lambda d: d.body(1)), wanted)


def four_bar(n):
    def run(wanted):
        rod = '<body name="rod{0}" pos="{0} 0 0"><joint axis="0 0 -1"/><inertial pos="0 0.5 0" mass="1" diaginertia="0.0833333333 1e-4 0.0833333333"/><site name="top{0}" pos="0 1 0"/>{1}</body>'
        bar = '<body name="bar{0}" pos="0 1 0"><joint axis="0 0 -1"/><inertial pos="0.5 0 0" mass="1" diaginertia="1e-4 0.0833333333 0.0833333333"/></body>'
        pins = ''.join(f'<connect body1="bar{i}" body2="rod{i + 1}" anchor="1 0 0"/>' for i in range(n))
        m = model(''.join(rod.format(i, bar.format(i) if i < n else '') for i in range(n + 1)), '0 -9.81 0', f'<equality>{pins}</equality>')

        def start(d):
            for i in range(n + 1):
                d.qvel[m.body(f'rod{i}').dofadr] = 1.0
            for i in range(n):
                d.qvel[m.body(f'bar{i}').dofadr] = -1.0
        signals = {f'/link1/rod/top.position.{c}': (lambda d, i=i: d.site('top0').xpos[i]) for i, c in enumerate('xyz')}
        return simulate(m, start, signals, wanted)
    return run


def bar(joint, path, inertia='0.04 0.1 0.1', pos='0 0 0', com='2 0 0', more=''):
    # the sites that a tendon needs
    eye, ground = (f'<site name="eye" pos="{com}"/>', '<site name="ground"/>') if more else ('', '')

    def run(wanted):
        m = model(f'<body name="bar" pos="{pos}">{joint}<inertial pos="{com}" mass="1" diaginertia="{inertia}"/>{eye}</body>{ground}', '0 0 -9.80665', more)
        return simulate(m, still, at(path, lambda d: d.body('bar')), wanted)
    return run


# ---- free bodies

def free_box(gravity, w, v, inertia=BOX_INERTIA, mass=10, path='/air/box', joint='/air'):
    def run(wanted):
        m = model(f'<body><freejoint/><inertial pos="0 0 0" mass="{mass}" diaginertia="{inertia}"/></body>', gravity)

        def start(d):
            d.qvel[:] = [*v, *w]
        signals = at(path, lambda d: d.body(1))
        signals.update({f'{joint}.angular_velocity.{c}': (lambda d, i=i: d.qvel[3 + i]) for i, c in enumerate('xyz')})
        signals.update({f'{joint}.quaternion.{c}': (lambda d, i=i: d.qpos[3 + i]) for i, c in enumerate('wxyz')})
        return simulate(m, start, signals, wanted)
    return run


def nasa_brick(wanted):
    unit = 14.5939 / 3.28084**2
    inertia = ' '.join(f'{unit * x:.16g}' for x in (0.001894220, 0.006211019, 0.007194665))
    return free_box('0 0 0', np.radians([10, 20, 30]), (0, 0, 0), inertia=inertia, mass=0.155404754 * 14.5939)(wanted)


# ---- contacts

def free_geom(name, pos, geom, mass, more=''):
    return f'<body name="{name}" pos="{pos}" {more}><freejoint/><geom {geom} mass="{mass}"/></body>'


def incline(wanted):
    a = math.atan(0.45)
    blocks = ''.join(free_geom(n, f'0 {y} 0.05', f'type="box" size="0.1 0.075 0.05" friction="{f}"', 2) for n, y, f in (('rough', 0.3, 0.5), ('smooth', -0.3, 0.4)))
    m = model('<geom type="plane" size="0 0 1" friction="0.1"/>' + blocks, f'{9.81 * math.sin(a)} 0 {-9.81 * math.cos(a)}')
    signals = {f'/slope/{n}.position.x': (lambda d, n=n: d.body(n).xpos[0]) for n in ('rough', 'smooth')}
    signals['/slope/smooth.velocity.x'] = lambda d: d.qvel[6]
    return simulate(m, still, signals, wanted)


def capsule(wanted):
    m = model('<geom type="box" size="0.005 0.02 0.02" pos="-0.009 0 0" friction="0.7"/>'
              '<body name="pad" pos="0.009 0 0"><joint axis="-1 0 0" type="slide"/><geom type="box" size="0.005 0.02 0.02" friction="0.7" mass="0.1"/></body>'
              '<body name="capsule" quat="0.70710678118654752 0.70710678118654752 0 0"><freejoint/><geom type="capsule" size="0.004 0.01" friction="0.7" mass="0.045"/></body>')

    def push(d):
        d.qfrc_applied[0] = 12.0
    return simulate(m, still, at('/air/capsule', lambda d: d.body('capsule')), wanted, push)


def slipping_sphere(wanted):
    m = model('<geom type="plane" size="0 0 1" friction="0.3"/>' + free_geom('ball', '0 0 0.1', 'type="sphere" size="0.1" friction="0.3"', 1))

    def start(d):
        d.qvel[0] = 5.0
    return simulate(m, start, at('/air/ball', lambda d: d.body('ball')), wanted)


def bouncing(wanted):
    balls = ''.join(free_geom(f'ball{7 * j + i + 1}', f'{-1.5 + 0.5 * i} {-1.5 + 0.5 * j} 5', 'type="sphere" size="0.1"', 10) for j in range(7) for i in range(7))
    m = model('<geom type="plane" size="0 0 1"/>' + balls)
    signals = {f'/ball{k}/air/ball.position.z': (lambda d, k=k: d.body(f'ball{k}').xpos[2]) for k in (1, 25, 49)}
    return simulate(m, still, signals, wanted)


def rolling(wanted):
    balls = ''.join(free_geom(f'ball{5 * j + i + 1}', f'{-4 + 2 * i} {-4 + 2 * j} 1.5', 'type="sphere" size="0.5" friction="0.8"', 1) for j in range(5) for i in range(5))
    m = model('<geom type="plane" size="0 0 1" friction="0.4"/>' + free_geom('box', '0 0 0.5', 'type="box" size="10 10 0.5" friction="0.4"', 10) + balls)

    def push(d):
        d.body('box').xfrc_applied[:2] = 150 / math.sqrt(2)
    signals = {}
    for path, name in (('/air/box', 'box'), ('/ball1/air/ball', 'ball1'), ('/ball25/air/ball', 'ball25')):
        signals.update(at(path, lambda d, name=name: d.body(name)))
    return simulate(m, still, signals, wanted, push)


TENDON = '<tendon><spatial springlength="2" stiffness="100" damping="5"><site site="ground"/><site site="eye"/></spatial></tendon>'
PROBLEMS = {
    'a01-pendulum': pendulum,
    'a02-four-bar-2': four_bar(2),
    'a02-four-bar-40': four_bar(40),
    'adams-revolute': bar('<joint axis="0 1 0"/>', '/mount/pin/bar'),
    'adams-revolute-skew': bar('<joint axis="0 1 1"/>', '/mount/pin/bar', pos='1 2 3'),
    'adams-spherical': bar('<joint type="ball"/>', '/mount/ball/bar', pos='1 2 3'),
    'adams-prismatic': bar('<joint type="slide" axis="0 1 1"/>', '/mount/slide/bar', pos='1 2 3'),
    'adams-cylindrical': bar('<joint type="slide" axis="0 1 1"/><joint axis="0 1 1"/>', '/mount/slide/pin/bar', pos='1 2 3'),
    'adams-rotary-spring': bar('<joint axis="0 1 0" stiffness="200" damping="10"/>', '/mount/pin/bar'),
    'adams-spring': bar('<freejoint/>', '/air/bar', pos='0 2 0', com='0 0 0', more=TENDON),
    'nasa-02-tumbling-brick': nasa_brick,
    'gazebo-boxes-simple': free_box('0 0 0', (0.5, 0, 0), (-0.9, 0.4, 0.1)),
    'gazebo-boxes-complex': free_box('0 0 -9.8', (0.1, 5, 0.1), (-2, 2, 8)),
    'coulomb-incline': incline,
    'pinched-capsule': capsule,
    'sphere-slip-to-roll': slipping_sphere,
    'simbenchmark-bouncing': bouncing,
    'simbenchmark-rolling': rolling,
}


def values(name, wanted):
    """Values of the wanted signals of the problem `name`; None if it does not stand here."""
    return PROBLEMS[name](wanted) if name in PROBLEMS else None
