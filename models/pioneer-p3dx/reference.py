"""Reference of this scene: the nonholonomic equations of a differential drive, integrated between the controller's samples, and distances to circles.

Needs NumPy, SciPy. Writes reference.csv.
"""
import math
import os

import numpy as np
from scipy.integrate import solve_ivp

R, WIDTH, TRACK, BALL = 0.0975, 0.047, 0.33, 0.0375                     # [m]
M, M_WHEEL, M_BALL = 9.0, 0.8, 0.2                                      # [kg]
M_CHASSIS, COM, I_CHASSIS = M - 2 * M_WHEEL - M_BALL, -0.03, 0.14
I_SPIN, I_TURN = M_WHEEL * R**2 / 2, M_WHEEL * (3 * R**2 + WIDTH**2) / 12
TORQUE, TS = 0.8, 0.005
LENGTH, BREADTH, RATE = 1.5, 0.75, 2 * math.pi / 20
K_AHEAD, K_ASIDE, K_TURN, K_WHEEL = 1.0, 4.0, 3.0, 1.5
SONARS = [(0.069, 0.136, 90), (0.114, 0.119, 50), (0.148, 0.078, 30), (0.166, 0.027, 10),
          (0.166, -0.027, -10), (0.148, -0.078, -30), (0.114, -0.119, -50), (0.069, -0.136, -90)]
NEAR, FAR, HALF_BEAM = 0.1, 5.0, math.radians(15)
PILLARS, PILLAR = [(0.9, 0), (-0.9, 0), (2.1, 0.6), (-2.1, -0.6), (0.2, 1.3), (-0.2, -1.3)], 0.12

# Σ m·x, Σ m·x² of what is fixed to the chassis, about the middle of the axle; wheels by I_A
FIRST = M_CHASSIS * COM + M_BALL * -0.2
I_AXLE = I_CHASSIS + M_CHASSIS * COM**2 + 0.4 * M_BALL * BALL**2 + M_BALL * 0.2**2 + 2 * (I_TURN + M_WHEEL * TRACK**2 / 4)


def rates(_, s, left, right):
    """s = x, y, θ, v, ω: momentum along the axis and moment of momentum about the axle, wheels rolling."""
    _, _, theta, v, w = s
    acceleration = ((left + right) / R + FIRST * w**2) / (M + 2 * I_SPIN / R**2)
    turn = ((right - left) * TRACK / (2 * R) - FIRST * v * w) / (I_AXLE + I_SPIN * TRACK**2 / (2 * R**2))
    return [v * math.cos(theta), v * math.sin(theta), w, acceleration, turn]


def command(t, x, y, yaw):
    xd, yd = LENGTH * math.sin(RATE * t), BREADTH * math.sin(2 * RATE * t)
    u, v = LENGTH * RATE * math.cos(RATE * t), 2 * BREADTH * RATE * math.cos(2 * RATE * t)
    a, b = -RATE**2 * xd, -4 * RATE**2 * yd
    speed, turn = math.hypot(u, v), (u * b - v * a) / (u * u + v * v)
    ahead = math.cos(yaw) * (xd - x) + math.sin(yaw) * (yd - y)
    aside = math.cos(yaw) * (yd - y) - math.sin(yaw) * (xd - x)
    turned = math.atan2(v, u) - yaw
    return speed * math.cos(turned) + K_AHEAD * ahead, turn + speed * (K_ASIDE * aside + K_TURN * math.sin(turned))


def ray(dx, dy, angle):
    """Distance along a ray at `angle` to a circle about (dx, dy)."""
    along, across = dx * math.cos(angle) + dy * math.sin(angle), dy * math.cos(angle) - dx * math.sin(angle)
    return along - math.sqrt(PILLAR**2 - across**2) if abs(across) < PILLAR and along > 0 else math.inf


def sonar(x, y, yaw, place):
    ox, oy = x + place[0] * math.cos(yaw) - place[1] * math.sin(yaw), y + place[0] * math.sin(yaw) + place[1] * math.cos(yaw)
    axis, nearest = yaw + math.radians(place[2]), FAR
    for px, py in PILLARS:
        dx, dy = px - ox, py - oy
        off = math.remainder(math.atan2(dy, dx) - axis, 2 * math.pi)
        within = axis + max(-HALF_BEAM, min(HALF_BEAM, off))
        nearest = min(nearest, ray(dx, dy, within))
    return nearest


def run(duration=20.0):
    s = np.zeros(5)
    for k in range(round(duration / TS) + 1):
        x, y, yaw, v, w = s
        wheels = np.array([v - w * TRACK / 2, v + w * TRACK / 2]) / R
        speed, turn = command(k * TS, x, y, math.remainder(yaw, 2 * math.pi))
        wanted = np.array([speed - turn * TRACK / 2, speed + turn * TRACK / 2]) / R
        torque = np.clip(K_WHEEL * (wanted - wheels), -TORQUE, TORQUE)
        if k % 8 == 0:
            yield k * TS, x, y, math.remainder(yaw, 2 * math.pi), *wheels, *(sonar(x, y, yaw, place) for place in SONARS)
        s = solve_ivp(rates, (0, TS), s, method="DOP853", rtol=1e-12, atol=1e-14, args=tuple(torque)).y[:, -1]


if __name__ == "__main__":
    folder = os.path.dirname(os.path.abspath(__file__))
    with open(os.path.join(folder, "reference.csv"), "w") as file:
        file.write("# by reference.py: [s], [m], [rad], wheels [rad/s], sonars [m]\n")
        file.write(",".join(["t", "x", "y", "yaw", "left", "right"] + [f"s{i}" for i in range(8)]) + "\n")
        for row in run():
            file.write(",".join(f"{value:.12g}" for value in row) + "\n")
