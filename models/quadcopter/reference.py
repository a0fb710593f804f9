"""Reference of this scene: the equations of a rigid body with four rotors, integrated between the controller's samples.

Needs NumPy, SciPy. Writes reference.csv.
"""
import math
import os

import numpy as np
from scipy.integrate import solve_ivp

G, MASS, ARM, LAG, TS = 9.81, 0.027, 0.046, 0.03, 0.002
INERTIA = np.array([[16.6, 0.83, 0.72], [0.83, 16.6, 1.8], [0.72, 1.8, 29.3]]) * 1e-6
K_THRUST = 3.16e-10 * (30 / math.pi)**2
RATIO = 0.005964552
HUBS = ARM / math.sqrt(2) * np.array([[1, -1], [-1, -1], [-1, 1], [1, 1]])
SPIN = np.array([1, -1, 1, -1])
HOVER = math.sqrt(MASS * G / (4 * K_THRUST))
K_P, K_D, K_ANGLE, K_RATE, FILTER = 4.0, 3.2, 120.0, 18.0, 3.5
TIMES = [0.0, 0.5, 2.5, 4.5, 6.5, 8.5, 10.5]
CORNERS = np.array([[0, 0, 0.5], [0, 0, 1], [0.8, 0, 1], [0.8, 0.8, 1], [0, 0.8, 1.2], [0, 0, 1], [0, 0, 0.5]])


def matrix(h):
    w, x, y, z = h
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def angles(r):
    return np.array([math.atan2(r[2, 1], r[2, 2]), math.asin(-r[2, 0]), math.atan2(r[1, 0], r[0, 0])])


def rates(_, s, command):
    """s: place 0:3, quaternion 3:7, velocity 7:10, angular velocity in body axes 10:13, rotors 13:17."""
    h, w, speed = s[3:7], s[10:13], s[13:17]
    r = matrix(h / np.linalg.norm(h))
    thrust = K_THRUST * speed**2
    moment = np.array([HUBS[:, 1] @ thrust, -HUBS[:, 0] @ thrust, -SPIN @ thrust * RATIO])
    hd = 0.5 * np.r_[-w @ h[1:], h[0] * w + np.cross(h[1:], w)]
    acceleration = r[:, 2] * thrust.sum() / MASS - [0, 0, G]
    turn = np.linalg.solve(INERTIA, moment - np.cross(w, INERTIA @ w))
    return np.r_[s[7:10], hd, acceleration, turn, (command - speed) / LAG]


def controller(s, y, r, a):
    rotation = matrix(s[3:7])
    roll, pitch, _ = angles(rotation)
    ax, ay, az = a + K_D * (r - s[7:10]) + K_P * (y - s[:3]) + [0, 0, G]
    thrust = MASS * az / (math.cos(roll) * math.cos(pitch))
    wanted = np.array([math.atan2(-ay * math.cos(pitch), az), math.atan2(ax, az), 0])
    moment = np.diag(INERTIA) * (K_ANGLE * (wanted - angles(rotation)) - K_RATE * s[10:13])
    effect = np.vstack([np.ones(4), HUBS[:, 1], -HUBS[:, 0], -SPIN * RATIO])
    return np.sqrt(np.linalg.solve(effect, np.r_[thrust, moment]) / K_THRUST)


def run(duration=13.0):
    s = np.r_[CORNERS[0], 1, 0, 0, 0, np.zeros(6), np.full(4, HOVER)]
    y, r = CORNERS[0].astype(float), np.zeros(3)
    for k in range(round(duration / TS) + 1):
        t = k * TS
        u = CORNERS[np.searchsorted(np.array(TIMES), t + 1e-9, side="right") - 1]
        command = controller(s, y, r, -FILTER**2 * (y - u) - 2 * FILTER * r)
        if k % 10 == 0:
            yield t, *s[:3], *angles(matrix(s[3:7])), *s[13:17]
        c, d, e = y - u, r + FILTER * (y - u), math.exp(-FILTER * TS)
        y, r = u + (c + d * TS) * e, (d - FILTER * (c + d * TS)) * e
        s = solve_ivp(rates, (0, TS), s, method="DOP853", rtol=1e-12, atol=1e-14, args=(command,)).y[:, -1]
        s[3:7] /= np.linalg.norm(s[3:7])


if __name__ == "__main__":
    folder = os.path.dirname(os.path.abspath(__file__))
    with open(os.path.join(folder, "reference.csv"), "w") as file:
        file.write("# by reference.py: [s], [m], [rad], rotors [rad/s]\n")
        file.write("t,x,y,z,roll,pitch,yaw,rotor1,rotor2,rotor3,rotor4\n")
        for row in run():
            file.write(",".join(f"{value:.12g}" for value in row) + "\n")
