"""Aerial manipulator, integrated independently of sincro: plant, rotors, wind and controllers in numpy.

    python reference.py                 writes reference.csv (about three minutes; numpy and scipy)

Plant: the vehicle's pose and the angles q of the arm's links (q = γ + δ: motor and spring behind it, between them nothing that has mass),
ten degrees of freedom in all. Newton-Euler equations in world axes, mass matrix from the links' Jacobians. Motors are ideal: γ' = u, held
over a sample. Rotors: blade elements and momentum, first-order lag. Solved with DOP853 over every sample, rtol = 1e-11.
Everything is written down from the equations in the README; nothing is taken from sincro.
"""
import csv
import math
import os
import sys

import numpy as np
from scipy.integrate import solve_ivp

TS, G, RHO = 0.02, 9.81, 1.225
E3 = np.eye(3)

# ---- plant [SI]
M0, I0 = 10.305, 9.5 * np.diag([7.643e-3, 7.643e-3, 1.525e-2])
BASE = np.array([0.36, -0.102, -0.05])
L = np.array([0.102, 0.125, 0.125, 0.27])
MASS = np.array([0.101, 0.121, 0.110, 0.052])
K, D = np.array([2.93, 2.1, 0.8, 1.48]), 0.02
AXIS = [1, 0, 2, 1]
ALONG = np.array([[0, 1, 0], [0, 0, -1], [0, 0, -1], [1, 0, 0]], dtype=float)
COM = ALONG * (L / 2)[:, None]         # centres of mass of the links, their axes
RADIUS = 0.01
INERTIA = []
for i in range(4):
    across, along = MASS[i] * (L[i] ** 2 / 12 + RADIUS ** 2 / 4), MASS[i] * RADIUS ** 2 / 2
    INERTIA.append(across * (E3 - np.outer(ALONG[i], ALONG[i])) + along * np.outer(ALONG[i], ALONG[i]))
DD = 0.5 / math.sqrt(2)
HUBS = DD * np.array([[1, 1, 0], [-1, 1, 0], [-1, -1, 0], [1, -1, 0]])
SPIN = np.array([1, -1, 1, -1])
TAU = 0.136535884
AREA_DRAG, LINEAR_DRAG = np.array([0.05, 0.05, 0.08]), np.array([0.3, 0.3, 0.0])


def cross(a, b):
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def rot(axis, angle):
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[[1, 0, 0], [0, c, -s], [0, s, c]], [[c, 0, s], [0, 1, 0], [-s, 0, c]], [[c, -s, 0], [s, c, 0], [0, 0, 1]]][axis])


def matrix(h):
    w, x, y, z = h / np.linalg.norm(h)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def euler(r):
    return np.array([math.atan2(r[2, 1], r[2, 2]), math.asin(-r[2, 0]), math.atan2(r[1, 0], r[0, 0])])


# ---- rotor: blade elements in the flow of momentum theory
R_BLADE, CHORD, N_BLADES, SLOPE, PITCH, CD0, KCD = 0.2032, 0.025, 4, 5.7, 0.1412, 0.0087, 0.4
DISC = math.pi * R_BLADE ** 2
SIGMA = N_BLADES * CHORD / (math.pi * R_BLADE)
K1 = SIGMA * SLOPE / 8


def rotor(speed, v):
    """Thrust and shaft torque at a speed [rad/s] and the hub's velocity in the air, body axes [m/s]."""
    vt, vh2, vz = speed * R_BLADE, v[0] ** 2 + v[1] ** 2, v[2]
    s = K1 * PITCH * (2 / 3 * vt ** 2 + vh2)
    f = lambda w: (w - vz) * math.sqrt(w * w + vh2) + K1 * vt * w - s
    low, high = max(vz, 0.0), max(vz, 0.0) + 1.0
    while f(high) < 0:
        high *= 2
    w = 0.5 * (low + high)
    for _ in range(100):                    # Newton within the bracket: f is monotone above max(v_z, 0)
        y = f(w)
        low, high = (w, high) if y < 0 else (low, w)
        root = math.sqrt(w * w + vh2)
        new = w - y / (root + (w - vz) * w / root + K1 * vt)
        new = new if low < new < high else 0.5 * (low + high)
        if abs(new - w) < 1e-15 * (1 + abs(w)):
            w = new
            break
        w = new
    thrust = 2 * RHO * DISC * (s - K1 * vt * w)
    torque = RHO * DISC * R_BLADE * (SIGMA * (CD0 + KCD * PITCH ** 2) * (vt ** 2 + vh2) / 8
                                     + 4 * K1 * w * (vt * PITCH / 3 - w / 2) + SIGMA * KCD * w * (w - 4 * PITCH * vt / 3) / 4)
    return thrust, torque


# ---- wind: mean, gusts, Dryden turbulence as a sum of 64 cosines a component (the numbers drawn are those of SplitMix64)
class Wind:
    def __init__(self, mean=(0, 0, 0), gusts=(), deviation=(0, 0, 0), length=(1, 1, 1), seed=0):
        self.mean, self.gusts = np.array(mean, dtype=float), gusts
        horizontal = math.hypot(mean[0], mean[1])
        self.along = (mean[0] / horizontal, mean[1] / horizontal) if horizontal else (1.0, 0.0)
        self.parts, state = [], seed
        speed = float(np.linalg.norm(self.mean))

        def unit():
            nonlocal state
            mask = (1 << 64) - 1
            state = (state + 0x9E3779B97F4A7C15) & mask
            z = state
            z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & mask
            z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & mask
            return ((z ^ (z >> 31)) >> 11) / 2 ** 53

        for k in range(3):
            area = (lambda x: 2 / math.pi * math.atan(x)) if k == 0 else (lambda x: (2 * math.atan(x) - x / (1 + x * x)) / math.pi)
            harmonics = []
            for i in range(64):
                wanted, low, high = area(100.0) / 64 * (i + unit()), 0.0, 100.0
                for _ in range(60):
                    middle = 0.5 * (low + high)
                    low, high = (middle, high) if area(middle) < wanted else (low, middle)
                harmonics.append((0.5 * (low + high) * (speed / length[k]), 2 * math.pi * unit()))
            self.parts.append((deviation[k] * math.sqrt(2 / 64), np.array(harmonics)))

    def __call__(self, t):
        u, v, w = (a * np.sum(np.cos(h[:, 0] * t + h[:, 1])) if a else 0.0 for a, h in self.parts)
        c, s = self.along
        total = self.mean + np.array([c * u - s * v, s * u + c * v, w])
        for start, rise, peak in self.gusts:
            total = total + 0.5 * (1 - math.cos(math.pi * min(max((t - start) / rise, 0.0), 2.0))) * np.array(peak)
        return total


# ---- kinematics and dynamics, world axes
def chain(p, r, q):
    """Origins, axes, rotations, centres of mass of the links, and the tip."""
    o, origins, axes, rotations, centres = p + r @ BASE, [], [], [], []
    for i in range(4):
        origins.append(o)
        axes.append(r[:, AXIS[i]].copy())
        r = r @ rot(AXIS[i], q[i])
        rotations.append(r)
        centres.append(o + r @ COM[i])
        o = o + r @ ALONG[i] * L[i]
    return origins, axes, rotations, centres, o


def inverse_dynamics(p, r, w, v, q, qd, wd, vd, qdd, links_only=False):
    """Moment about p, force, joint torques that accelerations take (wd, vd of the base; world axes), gravity included."""
    origins, axes, rotations, centres, _ = chain(p, r, q)
    moment, force, tau = np.zeros(3), np.zeros(3), np.zeros(4)
    up = np.array([0, 0, G])
    if not links_only:
        iw = r @ I0 @ r.T
        force = force + M0 * (vd + up)
        moment = moment + iw @ wd + cross(w, iw @ w)
    wi, al = w.copy(), wd.copy()
    o, a = p, vd + up
    for i in range(4):
        arm = origins[i] - o
        a = a + cross(al, arm) + cross(wi, cross(wi, arm))
        o = origins[i]
        al = al + axes[i] * qdd[i] + cross(wi, axes[i] * qd[i])
        wi = wi + axes[i] * qd[i]
        arm = centres[i] - o
        f = MASS[i] * (a + cross(al, arm) + cross(wi, cross(wi, arm)))
        iw = rotations[i] @ INERTIA[i] @ rotations[i].T
        n = iw @ al + cross(wi, iw @ wi)
        force = force + f
        moment = moment + n + cross(centres[i] - p, f)
        for j in range(i + 1):
            tau[j] += axes[j] @ (n + cross(centres[i] - origins[j], f))
    return np.r_[moment, force, tau]


def mass_matrix(p, r, q):
    origins, axes, rotations, centres, _ = chain(p, r, q)
    m = np.zeros((10, 10))
    m[:3, :3] += r @ I0 @ r.T
    m[3:6, 3:6] += M0 * E3
    for i in range(4):
        jw, jv = np.zeros((3, 10)), np.zeros((3, 10))
        jw[:, :3] = E3
        c = centres[i] - p
        jv[:, :3] = np.array([[0, c[2], -c[1]], [-c[2], 0, c[0]], [c[1], -c[0], 0]])
        jv[:, 3:6] = E3
        for j in range(i + 1):
            jw[:, 6 + j] = axes[j]
            jv[:, 6 + j] = cross(axes[j], centres[i] - origins[j])
        m += MASS[i] * jv.T @ jv + jw.T @ (rotations[i] @ INERTIA[i] @ rotations[i].T) @ jw
    return m


class Plant:
    """State: p 0:3, quaternion 3:7, w 7:10, v 10:13 (world), q 13:17, q' 17:21, speeds of the rotors 21:25."""

    def __init__(self, wind, gamma, start):
        self.wind, self.gamma, self.rate, self.command = wind, gamma, np.zeros(4), np.zeros(4)
        self.x = start

    def forces(self, t, x, t0):
        p, r, w, v, q, qd, speed = x[:3], matrix(x[3:7]), x[7:10], x[10:13], x[13:17], x[17:21], x[21:25]
        air = self.wind(t)
        applied = np.zeros(10)
        for i in range(4):
            hub = r @ HUBS[i]
            thrust, torque = rotor(speed[i], r.T @ (v + cross(w, hub) - air))
            f = r[:, 2] * thrust
            applied[3:6] += f
            applied[:3] += cross(hub, f) - r[:, 2] * (SPIN[i] * torque)
        u = r.T @ (v - air)
        applied[3:6] += r @ (-0.5 * RHO * np.linalg.norm(u) * AREA_DRAG * u - LINEAR_DRAG * u)
        gamma = self.gamma + self.rate * (t - t0)
        applied[6:] += -K * (q - gamma) - D * (qd - self.rate)
        return applied

    def equations(self, t, x, t0):
        p, r, w, v, q, qd = x[:3], matrix(x[3:7]), x[7:10], x[10:13], x[13:17], x[17:21]
        bias = inverse_dynamics(p, r, w, v, q, qd, np.zeros(3), np.zeros(3), np.zeros(4))
        return mass_matrix(p, r, q), self.forces(t, x, t0) - bias

    def derivative(self, t, x, t0):
        m, rhs = self.equations(t, x, t0)
        return self.rates(x, np.linalg.solve(m, rhs))

    def rates(self, x, acceleration):
        w = x[7:10]
        h = x[3:7]
        hd = 0.5 * np.r_[-w @ h[1:], h[0] * w + cross(w, h[1:])]
        return np.r_[x[10:13], hd, acceleration[:3], acceleration[3:6], x[17:21], acceleration[6:10], (self.command - x[21:25]) / TAU]

    def advance(self, t):
        solution = solve_ivp(self.derivative, (t, t + TS), self.x, method="DOP853", rtol=1e-11, atol=1e-12, args=(t,))
        self.x = solution.y[:, -1]
        self.x[3:7] /= np.linalg.norm(self.x[3:7])
        self.gamma = self.gamma + TS * self.rate


# ---- controllers
class CommandFilter:
    """y'' = −ω²(y − u) − 2ω y', u held over a sample."""

    def __init__(self, omega, start):
        self.omega, self.y, self.r = omega, np.array(start, dtype=float), np.zeros(3)

    def step(self, u):
        o, y, r = self.omega, self.y.copy(), self.r.copy()
        e, c = math.exp(-o * TS), self.y - u
        d = self.r + o * c
        self.y, self.r = u + (c + d * TS) * e, (d - o * (c + d * TS)) * e
        return y, r, -o * o * (y - u) - 2 * o * r


def e_matrix(eta):
    phi, theta = eta[0], eta[1]
    return np.array([[1, 0, -math.sin(theta)], [0, math.cos(phi), math.sin(phi) * math.cos(theta)],
                     [0, -math.sin(phi), math.cos(phi) * math.cos(theta)]])


class Backstepping:
    B, KQ = 1.9468e-4 / 4, 8.756372e-07
    G1, G2 = np.array([8, 8, 8 * 0.9 * 0.25]), np.array([18, 18, 9 * 2 * 0.05])
    I = np.array([0.0856, 0.1416, 0.2012])

    def __init__(self, xy_gain=9.81, z_integral=1.0, mass=10.689):
        xy = xy_gain
        self.kp, self.kd = np.array([xy * 0.69, xy * 0.69, 9.2]), np.array([xy * 0.8 / 3, xy * 0.8 / 3, 10 / 3])
        self.ki, self.mass = np.array([xy * 0.036, xy * 0.036, z_integral * 0.0015]), mass
        self.xi, self.chi2, self.wf, self.xi1 = np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(3)

    def acceleration(self, pc, vc, ac, p, v):
        a = ac + self.kd * (vc - v) + self.kp * (pc - p) + self.ki * self.xi
        self.xi = self.xi + TS * (pc - p)
        return a

    def attitude(self, eta_c, eta, w):
        e = e_matrix(eta)
        inv = np.linalg.inv(e)
        z1 = eta_c - eta
        wc = e @ (self.G1 * z1)
        new = self.wf + (1 - math.exp(-75 * TS)) * (wc - self.wf)
        slope, self.wf = (new - self.wf) / TS, new
        self.xi1 = self.xi1 + TS * (-self.G1 * self.xi1 - inv @ (self.wf - wc))
        z2, v1 = self.wf - w, z1 - self.xi1
        tau = self.I * (slope + self.G2 * z2 + 0.1 * self.G2 * self.chi2 + inv.T @ v1) + cross(w, self.I * w)
        self.chi2 = self.chi2 + TS * z2
        return tau

    def step(self, reference, p, v, eta, w, ahead):
        """Squares of the rotors' speeds; `ahead` is the arm's moment, body axes."""
        ax, ay, az = self.acceleration(*reference, p, v)
        c, s = math.cos(eta[2]), math.sin(eta[2])
        theta = math.atan2(ax * c + ay * s, G + az)
        phi = math.atan2(-(ay * c - ax * s) * math.cos(theta), G + az)
        eta_c = np.array([min(max(phi, -0.6), 0.6), min(max(theta, -0.6), 0.6), 0.0])
        thrust = self.mass * (G + az) / (math.cos(eta[0]) * math.cos(eta[1]))
        tau = self.attitude(eta_c, eta, w) + ahead
        b, k, d = self.B, self.KQ, DD
        squares = thrust / (4 * b) + HUBS[:, 1] / d * tau[0] / (4 * b * d) - HUBS[:, 0] / d * tau[1] / (4 * b * d) - SPIN * tau[2] / (4 * k)
        return np.sqrt(np.clip(squares, 0, 1200.0 ** 2))


def fixed_gravity(q):
    zero = np.zeros(3)
    return inverse_dynamics(zero, E3, zero, zero, q, np.zeros(4), zero, zero, np.zeros(4), links_only=True)[6:]


class Arm:
    KP, KS, LIMIT = np.array([30.0, 32.0, 36.0, 22.0]), np.array([0.32, 0.256, 0.224, 0.288]) / TS, 5.0
    GAMMA = np.array([8000, 8000, 80, 800, 800, 800, 80, 800.0])

    def __init__(self, gamma0, rate=0.5, gain=1.0):
        self.kp = gain * self.KP
        self.qr, self.before, self.gd, self.rate = np.zeros(4), np.zeros(4), gamma0.copy(), rate
        self.theta = np.array([0, 0, 0, 0, 1 / 3, 1 / 2, 1, 1 / 1.5])
        self.qr_rate = np.zeros(4)

    def step(self, gamma, q, target):
        """Velocities of the motors and the reference's joint accelerations."""
        phi = np.hstack([np.eye(4), np.diag(-fixed_gravity(q))])
        s = np.eye(4) + phi @ (self.GAMMA[:, None] * phi.T)
        theta = self.theta + TS * self.rate * self.GAMMA * (phi.T @ np.linalg.solve(s, q - self.before))
        if theta @ theta > 6.0:
            low, high = 0.0, 1e-6
            f = lambda mu: np.sum((theta / (1 + mu * self.GAMMA)) ** 2) - 6.0
            while f(high) > 0:
                high *= 2
            for _ in range(200):
                middle = 0.5 * (low + high)
                low, high = (middle, high) if f(middle) > 0 else (low, middle)
            theta = theta / (1 + high * self.GAMMA)
        self.theta, self.before = theta, self.qr.copy()
        gd = self.qr - phi @ theta
        u = np.clip((gd - self.gd) / TS + self.KS * (self.gd - gamma), -self.LIMIT, self.LIMIT)
        self.gd = gd
        origins, axes, _, _, tip = chain(-BASE, E3, self.qr)
        jacobian = np.array([cross(axes[i], tip - origins[i]) for i in range(4)]).T
        rate = np.clip(self.kp * (jacobian.T @ (target - tip)), -self.LIMIT, self.LIMIT)
        acceleration, self.qr_rate = (rate - self.qr_rate) / TS, rate
        self.qr = self.qr + TS * rate
        return u, acceleration


GAMMA0 = np.array([-0.023504, 0, 0, -0.046531])
THRUST_START = np.array([27.1866, 25.1714, 25.2428, 27.2580])


def start(p):
    return np.r_[p, 1, 0, 0, 0, np.zeros(6), np.zeros(4), np.zeros(4), np.sqrt(THRUST_START / 4.8671167899e-5)]


def hold(table, t):
    """Row of a table that stands at t."""
    value = table[0][1:]
    for row in table:
        if row[0] <= t + 1e-9:
            value = row[1:]
    return np.array(value, dtype=float)


def read_task(folder):
    rows = [line for line in open(os.path.join(folder, "task.csv")) if not line.startswith("#")]
    return [[float(x) for x in row] for row in list(csv.reader(rows))[1:]]


def simulate(duration, compensation=1, task=None, omega_t=1.5, wind=None, p0=(0.0, 0.0, 1.5), progress=True):
    """Rows t, p, roll, pitch, yaw, tip (axes of the arm's base), δ, thrust of rotor 1."""
    plant = Plant(wind or Wind(), GAMMA0.copy(), start(np.array(p0, dtype=float)))
    flight, arm = Backstepping(), Arm(GAMMA0)
    task_filter, place_filter = CommandFilter(omega_t, task[0][1:]), CommandFilter(1.0, p0)
    rows = []
    for k in range(round(duration / TS) + 1):
        t, x = k * TS, plant.x
        p, r, w, v, q, qd = x[:3], matrix(x[3:7]), x[7:10], x[10:13], x[13:17], x[17:21]
        eta, wb = euler(r), r.T @ w
        tip = r.T @ (chain(p, r, q)[4] - p) - BASE
        rows.append(np.r_[t, p, eta, tip, q - plant.gamma])
        target = task_filter.step(hold(task, t))[0]
        u, acceleration = arm.step(plant.gamma, q, target)
        ahead = np.zeros(3)
        if compensation == 1:       # in axes of the body, where the base's v' is to be zero: ω × v in the world
            ahead = r.T @ inverse_dynamics(p, r, w, v, q, qd, np.zeros(3), cross(w, v), acceleration, links_only=True)[:3]
        elif compensation == 2:
            zero = np.zeros(3)
            ahead = r.T @ inverse_dynamics(p, r, zero, zero, q, np.zeros(4), zero, zero, np.zeros(4), links_only=True)[:3]
        plant.command = flight.step(place_filter.step(np.array(p0, dtype=float)), p, v, eta, wb, ahead)
        plant.rate = u
        plant.advance(t)
        if progress and k % 250 == 0:
            print(f"{t:6.2f} s  {np.round(x[:3], 5)}  {np.round(tip, 4)}", file=sys.stderr)
    return rows


COLUMNS = "t,x,y,z,roll,pitch,yaw,tip_x,tip_y,tip_z,delta1,delta2,delta3,delta4".split(",")


def write(path, rows, every, columns=COLUMNS, comment=""):
    with open(path, "w") as file:
        file.write(f"# {comment}\n" if comment else "")
        file.write(",".join(columns) + "\n")
        for row in rows[::every]:
            file.write(",".join(f"{value:.12g}" for value in row) + "\n")


if __name__ == "__main__":
    folder = os.path.dirname(os.path.abspath(__file__))
    write(os.path.join(folder, "reference.csv"), simulate(40.0, task=read_task(folder)), 10,
          comment="by reference.py: [s], [m], [rad]; tip in the axes of the arm's base")
