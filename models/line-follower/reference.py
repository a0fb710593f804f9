"""Reference of this scene: the nonholonomic equations of a differential drive, and sensors that are points over rectangles.

Needs NumPy, SciPy. Writes reference.csv.
"""
import math
import os

import numpy as np
from scipy.integrate import solve_ivp

R, WIDTH, TRACK, BALL, BALL_AT = 0.016, 0.007, 0.084, 0.005, 0.03        # [m]
M, M_WHEEL, M_BALL = 0.131, 0.003, 0.001                                # [kg]
M_CHASSIS, COM, I_CHASSIS = M - 2 * M_WHEEL - M_BALL, 0.008, 8e-5
I_SPIN, I_TURN = M_WHEEL * R**2 / 2, M_WHEEL * (3 * R**2 + WIDTH**2) / 12
TORQUE, TS, SPEED, GAIN, K_WHEEL = 0.003, 0.005, 0.3, 250.0, 0.0008
EYES, AHEAD = [0.016, 0.008, 0.0, -0.008, -0.016], 0.038
# centre x, y and length [m], direction [°] of the pieces of the line
LINE = [(0.6455, 0.0725, 0.1682, 115.45), (0.5175, 0.207, 0.232, 146.45), (0.2985, 0.31, 0.2717, 161.91),
          (0.0465, 0.3655, 0.2623, 173.46), (-0.183, 0.3655, 0.2156, -171.99), (-0.355, 0.31, 0.1681, -149.28),
          (-0.461, 0.207, 0.152, -120.83), (-0.509, 0.0725, 0.1543, -98.63), (-0.509, -0.0725, 0.1543, -81.37),
          (-0.461, -0.207, 0.152, -59.17), (-0.355, -0.31, 0.1681, -30.72), (-0.183, -0.3655, 0.2156, -8.01),
          (0.0465, -0.3655, 0.2623, 6.54), (0.2985, -0.31, 0.2717, 18.09), (0.5175, -0.207, 0.232, 33.55),
          (0.6455, -0.0725, 0.1682, 64.55)]
HALF = 0.019 / 2

# Σ m·x of what is fixed to the chassis, and its moment of inertia about the middle of the axle, wheels as points on it
FIRST = M_CHASSIS * COM + M_BALL * BALL_AT
I_AXLE = I_CHASSIS + M_CHASSIS * COM**2 + 0.4 * M_BALL * BALL**2 + M_BALL * BALL_AT**2 + 2 * (I_TURN + M_WHEEL * TRACK**2 / 4)


def rates(_, s, left, right):
    """s = x, y, θ, v, ω of the middle of the axle, wheels rolling."""
    _, _, theta, v, w = s
    acceleration = ((left + right) / R + FIRST * w**2) / (M + 2 * I_SPIN / R**2)
    turn = ((right - left) * TRACK / (2 * R) - FIRST * v * w) / (I_AXLE + I_SPIN * TRACK**2 / (2 * R**2))
    return [v * math.cos(theta), v * math.sin(theta), w, acceleration, turn]


def sees(x, y):
    for cx, cy, length, degrees in LINE:
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        if abs(c * (x - cx) + s * (y - cy)) < length / 2 and abs(c * (y - cy) - s * (x - cx)) < HALF:
            return True
    return False


def run(duration=12.0):
    start = LINE[12]
    s, last = np.array([start[0], start[1], math.radians(start[3]), 0, 0]), 0.0
    for k in range(round(duration / TS) + 1):
        x, y, yaw, v, w = s
        seen = [sees(x + AHEAD * math.cos(yaw) - e * math.sin(yaw), y + AHEAD * math.sin(yaw) + e * math.cos(yaw)) for e in EYES]
        places = [e for e, is_seen in zip(EYES, seen) if is_seen]
        last = sum(places) / len(places) if places else (0.02 if last > 0 else -0.02)
        turn = GAIN * last
        wheels = np.array([v - w * TRACK / 2, v + w * TRACK / 2]) / R
        wanted = np.array([SPEED - turn * TRACK / 2, SPEED + turn * TRACK / 2]) / R
        if k % 4 == 0:
            yield k * TS, x, y, math.remainder(yaw, 2 * math.pi), *wheels, *(float(is_seen) for is_seen in seen)
        torque = np.clip(K_WHEEL * (wanted - wheels), -TORQUE, TORQUE)
        s = solve_ivp(rates, (0, TS), s, method="DOP853", rtol=1e-12, atol=1e-14, args=tuple(torque)).y[:, -1]


if __name__ == "__main__":
    folder = os.path.dirname(os.path.abspath(__file__))
    with open(os.path.join(folder, "reference.csv"), "w") as file:
        file.write("# by reference.py: [s], [m], [rad], wheels [rad/s], sensors\n")
        file.write("t,x,y,yaw,left,right,eye1,eye2,eye3,eye4,eye5\n")
        for row in run():
            file.write(",".join(f"{value:.12g}" for value in row) + "\n")
