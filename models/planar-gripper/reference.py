"""Reference of this scene: Pinocchio's dynamics of fingers and brick, with fingertips that roll on its faces as constraints.

Needs pin 4.1, NumPy, SciPy. Writes reference.csv.
"""
import math
import os

import numpy as np
import pinocchio as pin
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve

L1, L2, TIP, REACH, R_LINK, R_TIP = 0.085, 0.0598, 0.0713, 0.19, 0.011, 0.015   # [m]
M1, M2, DAMPING = 0.449, 0.104, 0.1
ANGLES = np.radians([60, 180, 300])
BRICK, I_BRICK, HALF = 0.028, 1.17e-5, 0.05
STIFFNESS, TS = 6.0, 0.002
# centre of each fingertip at the start, y and z; the side of the elbow
START = [(-0.065, 0.01), (0.0, -0.065), (0.065, 0.01)]
ELBOW = [-1.0, -1.0, 1.0]
FACES = [(-1.0, 0.0), (0.0, -1.0), (1.0, 0.0)]        # outward normals of the faces that they touch


def tip(i, a, b):
    """Centre of a fingertip in y and z; complex numbers may stand for angles."""
    first, both = ANGLES[i] + a, ANGLES[i] + a + b
    y = -REACH * np.sin(ANGLES[i]) + L1 * np.sin(first) + TIP * np.sin(both)
    z = REACH * np.cos(ANGLES[i]) - L1 * np.cos(first) - TIP * np.cos(both)
    return y, z


def constraints(q):
    """Matrix A of A·v = 0: q = y, z, φ of the brick, then two angles a finger."""
    rows = []
    c, s = np.cos(q[2]), np.sin(q[2])
    for i, (ny, nz) in enumerate(FACES):
        ny, nz = c * ny - s * nz, s * ny + c * nz
        ty, tz = -nz, ny
        a, b = q[3 + 2 * i], q[4 + 2 * i]
        first, both = ANGLES[i] + a, ANGLES[i] + a + b
        # of the tip's centre by the two angles
        dy = np.array([L1 * np.cos(first) + TIP * np.cos(both), TIP * np.cos(both)])
        dz = np.array([L1 * np.sin(first) + TIP * np.sin(both), TIP * np.sin(both)])
        cy, cz = tip(i, a, b)
        py, pz = cy - R_TIP * ny, cz - R_TIP * nz      # where they touch
        for uy, uz in ((ny, nz), (ty, tz)):
            row = np.zeros(9, dtype=q.dtype)
            row[0], row[1] = -uy, -uz
            row[2] = -(-(pz - q[1]) * uy + (py - q[0]) * uz)
            spin = -(pz - cz) * uy + (py - cy) * uz            # of the point that touches, about the centre
            row[3 + 2 * i:5 + 2 * i] = dy * uy + dz * uz + spin
            rows.append(row)
    return np.array(rows)


def model():
    m = pin.Model()
    m.gravity.linear = np.array([0, 0, -9.81])
    y = m.addJoint(0, pin.JointModelPY(), pin.SE3.Identity(), "y")
    z = m.addJoint(y, pin.JointModelPZ(), pin.SE3.Identity(), "z")
    turn = m.addJoint(z, pin.JointModelRX(), pin.SE3.Identity(), "turn")
    m.appendBodyToJoint(turn, pin.Inertia(BRICK, np.zeros(3), np.diag([I_BRICK, 1.9e-5, 1.9e-5])), pin.SE3.Identity())
    rod = lambda mass, length: np.diag([mass * (3 * R_LINK**2 + length**2) / 12] * 2 + [mass * R_LINK**2 / 2])
    for i, angle in enumerate(ANGLES):
        c, s = math.cos(angle), math.sin(angle)
        rotation = np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
        base = m.addJoint(0, pin.JointModelRX(), pin.SE3(rotation, rotation @ [0, 0, REACH]), f"base{i}")
        m.appendBodyToJoint(base, pin.Inertia(M1, np.array([0, 0, -L1 / 2]), rod(M1, L1)), pin.SE3.Identity())
        mid = m.addJoint(base, pin.JointModelRX(), pin.SE3(np.eye(3), np.array([0, 0, -L1])), f"mid{i}")
        m.appendBodyToJoint(mid, pin.Inertia(M2, np.array([0, 0, -L2 / 2]), rod(M2, L2)), pin.SE3.Identity())
    return m, m.createData()


def start():
    q = np.zeros(9)
    for i, (y, z) in enumerate(START):
        f = lambda x: np.array(tip(i, *x)) - (y, z)
        q[3 + 2 * i:5 + 2 * i] = fsolve(f, [-0.6 * ELBOW[i], 1.2 * ELBOW[i]], xtol=1e-14)
    return q


COMMANDS = np.array([0.46, -1.1, 0.55, -1.21, -0.46, 1.1])


def run(swing, duration=4.0, rows=10):
    m, data = model()
    q, v = start(), np.zeros(9)

    def forward(q, v, command):
        a = constraints(q)
        turned = constraints(q + 1e-30j * v)
        drift = (turned.imag / 1e-30) @ v
        mass = pin.crba(m, data, q)
        mass = np.triu(mass) + np.triu(mass, 1).T
        applied = -pin.nonLinearEffects(m, data, q, v)
        applied[3:] += STIFFNESS * (command - q[3:]) - DAMPING * v[3:]
        kkt = np.block([[mass, -a.T], [a, np.zeros((6, 6))]])
        solved = np.linalg.solve(kkt, np.r_[applied, -drift])
        return solved[:9], solved[9:]

    held = np.zeros(6)                     # a row is the state before the commands of its instant act
    for k in range(round(duration / TS) + 1):
        command = COMMANDS + swing * math.sin(math.pi * k * TS) * np.array([1, 0, 0, 0, 1, 0])
        if k % rows == 0:
            force = forward(q, v, held)[1]
            yield k * TS, *q, *force[0::2], *np.abs(force[1::2])
        held = command
        rates = lambda _, s: np.r_[s[9:], forward(s[:9], s[9:], command)[0]]
        s = solve_ivp(rates, (0, TS), np.r_[q, v], method="DOP853", rtol=1e-11, atol=1e-13).y[:, -1]
        q, v = s[:9], s[9:]


if __name__ == "__main__":
    folder = os.path.dirname(os.path.abspath(__file__))
    with open(os.path.join(folder, "reference.csv"), "w") as file:
        file.write("# by reference.py: brick [m], [rad]; fingers [rad]; normal and friction forces [N]\n")
        file.write("t,y,z,angle,base1,middle1,base2,middle2,base3,middle3,n1,n2,n3,f1,f2,f3\n")
        for row in run(0.05):
            file.write(",".join(f"{value:.12g}" for value in row) + "\n")
