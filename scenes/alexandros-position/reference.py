"""The compliant arm of thesis sections 5.2 and 5.3, integrated independently of sincro: arm, wall and controller in numpy.

    python reference.py        writes reference-exact.csv here and in ../alexandros-force (about three minutes; numpy and scipy)

Coordinates are the angles q of the links (q = γ + δ: motor and spring behind it, between them nothing that has mass) and the place s of the
wall. Newton-Euler equations in world axes, mass matrix from the links' Jacobians; motors are ideal, γ' = u held over a sample. Contact is
rigid, without friction and rebound; touching and leaving are located. Solved with DOP853 over every sample, rtol = 1e-11.
"""
import os

import numpy as np
from scipy.integrate import solve_ivp

TS, UP = 0.02, np.array([0, 0, 9.81])
L, MASS = np.array([0.102, 0.125, 0.125, 0.27]), np.array([0.101, 0.121, 0.110, 0.052])
K, D, RADIUS = np.array([2.93, 2.1, 0.8, 1.48]), 0.02, 0.01
AXIS, ALONG = [1, 0, 2, 1], np.array([[0, 1, 0], [0, 0, -1], [0, 0, -1], [1, 0, 0]], dtype=float)
ACROSS, ROLL = MASS * (L ** 2 / 12 + RADIUS ** 2 / 4), MASS * RADIUS ** 2 / 2
INERTIA = [ACROSS[i] * np.eye(3) + (ROLL[i] - ACROSS[i]) * np.outer(ALONG[i], ALONG[i]) for i in range(4)]
WALL_M, WALL_K, WALL_C = 0.1, 10.0, 1.0
TIP0 = np.array([0.27, 0.102, -0.25])


def rot(axis, angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[[1, 0, 0], [0, c, -s], [0, s, c]], [[c, 0, s], [0, 1, 0], [-s, 0, c]], [[c, -s, 0], [s, c, 0], [0, 0, 1]]][axis])


def chain(q):
    """Origins, axes, rotations and centres of mass of the links, and the tip."""
    o, r, links = np.zeros(3), np.eye(3), []
    for i in range(4):
        axis, start = r[:, AXIS[i]].copy(), o
        r = r @ rot(AXIS[i], q[i])
        links.append((start, axis, r, o + r @ ALONG[i] * (L[i] / 2)))
        o = o + r @ ALONG[i] * L[i]
    return links, o


def equations(q, qd):
    """Mass matrix, torques of gravity and motion, Jacobian of the tip, and its J'q'."""
    links, tip = chain(q)
    m, bias = np.zeros((4, 4)), np.zeros(4)
    w, al, a, o = np.zeros(3), np.zeros(3), UP.copy(), np.zeros(3)
    for i, (start, axis, r, centre) in enumerate(links):
        d = start - o
        a = a + np.cross(al, d) + np.cross(w, np.cross(w, d))
        o, al = start, al + np.cross(w, axis * qd[i])
        w = w + axis * qd[i]
        d, turned = centre - o, r @ INERTIA[i] @ r.T
        f = MASS[i] * (a + np.cross(al, d) + np.cross(w, np.cross(w, d)))
        n = turned @ al + np.cross(w, turned @ w)
        jw, jv = np.zeros((3, 4)), np.zeros((3, 4))
        for j in range(i + 1):
            jw[:, j], jv[:, j] = links[j][1], np.cross(links[j][1], centre - links[j][0])
        m += MASS[i] * jv.T @ jv + jw.T @ turned @ jw
        bias += jv.T @ f + jw.T @ n
    d = tip - o
    jacobian = np.array([np.cross(axis, tip - start) for start, axis, _, _ in links]).T
    return m, bias, jacobian, a + np.cross(al, d) + np.cross(w, np.cross(w, d)) - UP


class Controller:
    """Adaptive compliant inverse kinematics; symbols as in the README."""
    KP, KS = np.array([30.0, 32, 36, 22]), np.array([0.32, 0.256, 0.224, 0.288]) / TS
    GAMMA = np.array([8000, 8000, 80, 800, 800, 800, 80, 800.0])

    def __init__(self):
        self.qr, self.before, self.gd = np.zeros(4), np.zeros(4), np.zeros(4)
        self.theta = np.array([0, 0, 0, 0, 1 / 3, 1 / 2, 1, 1 / 1.5])

    def step(self, gamma, q, target):
        phi = np.hstack([np.eye(4), np.diag(-equations(q, np.zeros(4))[1])])
        s = np.eye(4) + phi @ (self.GAMMA[:, None] * phi.T)
        theta = self.theta + TS * 0.5 * self.GAMMA * (phi.T @ np.linalg.solve(s, q - self.before))
        assert theta @ theta < 6, "the projection is not needed here, and not written"
        self.theta, self.before = theta, self.qr
        gd = self.qr - phi @ theta
        u = np.clip((gd - self.gd) / TS + self.KS * (self.gd - gamma), -5, 5)
        self.gd = gd
        _, _, jacobian, _ = equations(self.qr, np.zeros(4))
        self.qr = self.qr + TS * np.clip(self.KP * (jacobian.T @ (target - chain(self.qr)[1])), -5, 5)
        return u


class Plant:
    """State q 0:4, q' 4:8, s 8, s' 9."""

    def __init__(self, has_wall, wall_c=WALL_C):
        self.wall_c = wall_c
        self.x, self.gamma, self.rate = np.zeros(10), np.zeros(4), np.zeros(4)
        self.has_wall, self.touching = has_wall, has_wall

    def accelerations(self, t, x, t0):
        q, qd, s, sd = x[:4], x[4:8], x[8], x[9]
        m, bias, jacobian, drift = equations(q, qd)
        rhs = -K * (q - self.gamma - self.rate * (t - t0)) - D * (qd - self.rate) - bias
        own = -WALL_K * s - self.wall_c * sd
        if not self.touching:
            return np.r_[np.linalg.solve(m, rhs), own / WALL_M], 0.0
        row = jacobian[0]
        a = np.linalg.solve(m + WALL_M * np.outer(row, row), rhs + row * (own - WALL_M * drift[0]))
        sdd = row @ a + drift[0]
        return np.r_[a, sdd], WALL_M * sdd - own

    def derivative(self, t, x, t0):
        a, _ = self.accelerations(t, x, t0)
        return np.r_[x[4:8], a[:4], x[9], a[4]]

    def gap(self, t, x, t0):
        return x[8] + TIP0[0] - chain(x[:4])[1][0]

    def advance(self, t):
        t0, end = t, t + TS
        force = lambda t, x, t0: self.accelerations(t, x, t0)[1]
        gap = lambda t, x, t0: self.gap(t, x, t0)
        force.terminal = gap.terminal = True
        force.direction = gap.direction = -1
        while t < end:
            event = None if not self.has_wall else force if self.touching else gap
            if self.touching and self.accelerations(t, self.x, t0)[1] < 0:
                self.touching = False
                continue
            done = solve_ivp(self.derivative, (t, end), self.x, "DOP853", rtol=1e-11, atol=1e-13, args=(t0,), events=event)
            t, self.x = done.t[-1], done.y[:, -1]
            if t < end and self.touching:
                self.touching = False
            elif t < end:           # touches: together from here on, momentum along the row of the tip kept
                m, _, jacobian, _ = equations(self.x[:4], self.x[4:8])
                row, qd = jacobian[0], self.x[4:8]
                v = np.linalg.solve(m + WALL_M * np.outer(row, row), m @ qd + row * (WALL_M * self.x[9]))
                self.x[4:8], self.x[9], self.touching = v, row @ v, True
        self.gamma = self.gamma + TS * self.rate


def simulate(duration, target, has_wall, wall_c=WALL_C):
    plant, controller, rows = Plant(has_wall, wall_c), Controller(), []
    for k in range(round(duration / TS) + 1):
        t, q = k * TS, plant.x[:4]
        u = controller.step(plant.gamma, q, target(t))
        force = plant.accelerations(t, plant.x, t)[1]        # a row is before the commands of its instant
        rows.append(np.r_[t, plant.gamma, q - plant.gamma, controller.theta[:4], chain(q)[1], plant.x[8], force])
        plant.rate = u
        plant.advance(t)
    return rows


def write(folder, rows, name="reference-exact.csv"):
    names = [f"{name}{i}" for name in ("gamma", "delta", "theta") for i in range(1, 5)] + ["x", "y", "z", "wall", "force"]
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), folder, name), "w") as file:
        file.write("# by alexandros-position/reference.py: [s], [rad], [m], [N]\n" + ",".join(["t"] + names) + "\n")
        file.writelines(",".join(f"{value:.12g}" for value in row) + "\n" for row in rows[::5])


if __name__ == "__main__":
    steps = [(18, (0.04, -0.05, 0.03)), (4, (-0.03, 0.05, 0.05)), (0, (0, 0, 0))]
    place = lambda t: TIP0 + np.array(next(step for start, step in steps if t > start - 1e-9))
    write(".", simulate(32.0, place, False))
    press = lambda t: TIP0 + np.array([0.15 / 10 if t > 6 - 1e-9 else 0.0, 0, 0])
    write("../alexandros-force", simulate(30.0, press, True))
    write("../alexandros-force", simulate(16.0, press, True, 0.0), "reference-chain.csv")     # the wall on its spring alone
