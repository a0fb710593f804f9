"""Aerial manipulator at a wall, integrated independently of sincro; see ../aerial-manipulator-hover/reference.py for plant and controllers.

    python reference.py                 writes reference.csv (about five minutes; numpy and scipy)

Contact is rigid and without friction. While the finger touches, the wall's place s follows from the tip, s = x_tip + r − x_wall, and its
equation m·s'' = −K_w·s − c·s' + F is put into those of the manipulator: (M + m·JᵀJ)·a = f − Jᵀ·(m·J'v + K_w·s + c·J·v), J the row of the
tip's velocity along x. Touching is located; it is inelastic. A force below zero would end the contact: it stops the program, for it must not
happen.
"""
import os
import sys

import numpy as np
from scipy.integrate import solve_ivp

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "aerial-manipulator-hover"))
import reference as hover
from reference import BASE, GAMMA0, TS, Arm, Backstepping, CommandFilter, Plant, Wind, chain, cross, euler, hold, inverse_dynamics, matrix

WALL_X, FINGER, WALL_M, WALL_K, WALL_C = 1.2, 0.005, 0.1, 10.0, 1.0
WIND = dict(mean=(-2.0, 0.7, 0.0), gusts=((24.0, 1.0, (-1.5, 0, 0)), (44.0, 1.0, (0, 1.5, 0.5))),
            deviation=(0.3, 0.3, 0.2), length=(60.0, 60.0, 10.0), seed=7)


class AtWall(Plant):
    touching = False

    def tip(self, x):
        """Place of the tip, the row of its velocity along x, and that row's J'v."""
        p, r, w, q, qd = x[:3], matrix(x[3:7]), x[7:10], x[13:17], x[17:21]
        origins, axes, _, _, tip = chain(p, r, q)
        arm = tip - p
        row = np.r_[0, arm[2], -arm[1], 1, 0, 0, [cross(axes[i], tip - origins[i])[0] for i in range(4)]]
        # acceleration of the tip without accelerations of the coordinates
        wi, al, a, o = w.copy(), np.zeros(3), np.zeros(3), p
        for i in range(4):
            d = origins[i] - o
            a = a + cross(al, d) + cross(wi, cross(wi, d))
            o = origins[i]
            al = al + cross(wi, axes[i] * qd[i])
            wi = wi + axes[i] * qd[i]
        d = tip - o
        a = a + cross(al, d) + cross(wi, cross(wi, d))
        return tip, row, a[0]

    def gap(self, t, x):
        return WALL_X - FINGER - self.tip(x)[0][0]

    def derivative(self, t, x, t0):
        if not self.touching:
            return super().derivative(t, x, t0)
        return self.rates(x, self.pressed(t, x, t0)[0])

    def pressed(self, t, x, t0):
        m, rhs = self.equations(t, x, t0)
        tip, row, bias = self.tip(x)
        s, rate = tip[0] + FINGER - WALL_X, row @ np.r_[x[7:10], x[10:13], x[17:21]]
        rest = WALL_M * bias + WALL_K * s + WALL_C * rate
        a = np.linalg.solve(m + WALL_M * np.outer(row, row), rhs - row * rest)
        return a, WALL_M * (row @ a) + rest, s

    def advance(self, t):
        t0, end = t, t + TS
        options = dict(method="DOP853", rtol=1e-11, atol=1e-12)
        while t < end:
            gap = lambda time, x, start: self.gap(time, x)
            gap.terminal, gap.direction = True, -1
            events = None if self.touching else gap
            solution = solve_ivp(self.derivative, (t, end), self.x, args=(t0,), events=events, **options)
            t, self.x = solution.t[-1], solution.y[:, -1]
            if t < end:
                m, _ = self.equations(t, self.x, t0)
                row = self.tip(self.x)[1]
                v = np.linalg.solve(m + WALL_M * np.outer(row, row), m @ np.r_[self.x[7:10], self.x[10:13], self.x[17:21]])
                self.x[7:10], self.x[10:13], self.x[17:21] = v[:3], v[3:6], v[6:]
                self.touching = True
                print(f"touches at {t:.9f} s", file=sys.stderr)
        self.x[3:7] /= np.linalg.norm(self.x[3:7])
        self.gamma = self.gamma + TS * self.rate


def simulate(duration, task, weight_only=False):
    """Rows t, p, roll, pitch, yaw, tip, place of the wall, force; with weight_only the controller knows the weight of the arm alone."""
    start = np.array([0.0, 0.0, 1.5])
    plant = AtWall(Wind(**WIND), GAMMA0.copy(), hover.start(start))
    flight, arm = Backstepping(z_integral=200.0), Arm(GAMMA0, gain=8.0)
    task_filter, place_filter = CommandFilter(1.0, task[0][1:]), CommandFilter(1.0, start)
    rows = []
    for k in range(round(duration / TS) + 1):
        t, x = k * TS, plant.x
        p, r, w, v, q, qd = x[:3], matrix(x[3:7]), x[7:10], x[10:13], x[13:17], x[17:21]
        # a row at t_k is the state there before the commands of t_k act
        force, s = plant.pressed(t, x, t)[1:] if plant.touching else (0.0, 0.0)
        if force < 0:
            sys.exit(f"contact is lost at {t} s")
        wanted = 0.25 if t > 36.0 - 1e-9 else 0.15 if t > 16.0 - 1e-9 else 0.0
        place = task_filter.step(hold(task, t) + np.array([wanted / 10.0, 0, 0]))[0]
        u, acceleration = arm.step(plant.gamma, q, r.T @ (place - p) - BASE)
        if weight_only:
            zero, still = np.zeros(3), np.zeros(4)
            ahead = r.T @ inverse_dynamics(p, r, zero, zero, q, still, zero, zero, still, links_only=True)[:3]
        else:
            ahead = r.T @ inverse_dynamics(p, r, w, v, q, qd, np.zeros(3), cross(w, v), acceleration, links_only=True)[:3]
        goal = np.array([0.535, 0.0, 1.5]) if t > 1.0 - 1e-9 else start
        plant.command = flight.step(place_filter.step(goal), p, v, euler(r), r.T @ w, ahead)
        plant.rate = u
        rows.append(np.r_[t, p, euler(r), plant.tip(x)[0], s, force])
        plant.advance(t)
        if k % 250 == 0:
            print(f"{t:6.2f} s  {np.round(p, 5)}  {force:.5f} N", file=sys.stderr)
    return rows


if __name__ == "__main__":
    folder = os.path.dirname(os.path.abspath(__file__))
    columns = "t,x,y,z,roll,pitch,yaw,tip_x,tip_y,tip_z,wall,force".split(",")
    hover.write(os.path.join(folder, "reference.csv"), simulate(60.0, hover.read_task(folder)), 10, columns,
                "by reference.py: [s], [m], [rad], [N]; tip in the world")
