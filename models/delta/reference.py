"""Reference of this scene: a Delta in six coordinates, three angles of arms and the place of a platform that cannot turn, with three constraints.

Needs NumPy, SciPy. Writes reference.csv.
"""
import math
import os

import numpy as np
from scipy.integrate import solve_ivp

G, TS = 9.81, 0.001
R_BASE, ARM, ROD, R_PLATFORM, THETA = 0.14, 0.565, 1.26, 0.075, 0.5     # [m], [rad]
M_ARM, M_ROD, M_PLATFORM = 4.0, 0.5, 2.0
RADIUS, PERIOD, KP, KD = 0.25, 0.8, 4000.0, 120.0
DIRECTIONS = [0.0, 2 * math.pi / 3, 4 * math.pi / 3]
OUT = np.array([[math.cos(p), math.sin(p), 0] for p in DIRECTIONS])
UP = np.array([0, 0, 1.0])
HEIGHT = -ARM * math.sin(THETA) - math.sqrt(ROD**2 - (R_BASE + ARM * math.cos(THETA) - R_PLATFORM)**2)

# kinetic energy of a slender rod between points of velocities a and b: m/6·(a·a + a·b + b·b); an arm has two of them
MASS_PLATFORM = M_PLATFORM + 3 * 2 * M_ROD / 3
INERTIA_ARM = M_ARM * ARM**2 / 3 + 2 * M_ROD * ARM**2 / 3


def accelerations(s, torque):
    theta, x, rate, v = s[:3], s[3:6], s[6:9], s[9:12]
    mass, force, rows, drift = np.zeros((6, 6)), np.zeros(6), np.zeros((3, 6)), np.zeros(3)
    mass[3:, 3:] = MASS_PLATFORM * np.eye(3)
    force[5] = -(M_PLATFORM + 3 * M_ROD) * G           # of each rod one half
    for i in range(3):
        along = OUT[i] * math.cos(theta[i]) - UP * math.sin(theta[i])
        turn = -OUT[i] * math.sin(theta[i]) - UP * math.cos(theta[i])       # derivative; that of `turn` is −along
        mass[i, i] = INERTIA_ARM
        mass[i, 3:] = mass[3:, i] = M_ROD / 3 * ARM * turn
        force[3:] += M_ROD / 3 * ARM * along * rate[i]**2
        force[i] = torque[i] + (M_ARM * ARM / 2 + M_ROD * ARM) * G * math.cos(theta[i])
        d = x + R_PLATFORM * OUT[i] - R_BASE * OUT[i] - ARM * along
        rows[i, i], rows[i, 3:] = -d @ turn * ARM, d
        w = v - ARM * turn * rate[i]
        drift[i] = w @ w + d @ along * ARM * rate[i]**2
    kkt = np.block([[mass, rows.T], [rows, np.zeros((3, 3))]])
    return np.linalg.solve(kkt, np.r_[force, -drift])[:6]


def wanted(t):
    """Angles of the arms that put the platform on its path."""
    s = min(t, 1.0)
    radius = RADIUS * s**3 * (10 - 15 * s + 6 * s * s)
    p = np.array([radius * math.cos(2 * math.pi * t / PERIOD), radius * math.sin(2 * math.pi * t / PERIOD), HEIGHT])
    angles = []
    for u in OUT:
        a = p @ u + R_PLATFORM - R_BASE
        side = p @ np.cross(UP, u)
        k = (a * a + side * side + p[2]**2 + ARM**2 - ROD**2) / (2 * ARM)
        angles.append(math.atan2(-p[2], a) - math.acos(k / math.hypot(a, p[2])))
    return np.array(angles)


def run(duration=3.0):
    s = np.r_[np.full(3, THETA), 0, 0, HEIGHT, np.zeros(6)]
    before = np.full(3, THETA)
    for k in range(round(duration / TS) + 1):
        target = wanted(k * TS)
        torque = KP * (target - s[:3]) + KD * ((target - before) / TS - s[6:9])
        before = target
        if k % 10 == 0:
            yield k * TS, *s[3:6], *s[:3], *torque
        rates = lambda _, s: np.r_[s[6:], accelerations(s, torque)]
        s = solve_ivp(rates, (0, TS), s, method="DOP853", rtol=1e-11, atol=1e-13).y[:, -1]


if __name__ == "__main__":
    folder = os.path.dirname(os.path.abspath(__file__))
    with open(os.path.join(folder, "reference.csv"), "w") as file:
        file.write("# by reference.py: platform [m], arms [rad], torques [N·m]\n")
        file.write("t,x,y,z,theta1,theta2,theta3,tau1,tau2,tau3\n")
        for row in run():
            file.write(",".join(f"{value:.12g}" for value in row) + "\n")
