"""Reference of this scene: Pinocchio's dynamics of Solo 12, with feet that roll on the floor as constraints.

Needs pin 4.1, NumPy, SciPy. Writes reference.csv.
"""
import math
import os

import numpy as np
import pinocchio as pin
from scipy.integrate import solve_ivp

HIP, R_FOOT, SWAY, TS = 0.8, 0.016, 1.0, 0.002
STIFFNESS, DAMPING = 6.0, 0.1
# front or hind, left or right; amplitude of the hip [rad], of which the knee has twice
LEGS = {"FL": (1, 1, 0.3), "FR": (1, -1, 0.3), "HL": (-1, 1, 0.2), "HR": (-1, -1, 0.2)}
CROUCH_HZ, SIDEWAYS, SIDEWAYS_HZ = 0.5, 0.1, 0.8
# where the springs of abduction, hip and knee pull, beyond the pose at the start [rad]
PRELOAD = (-0.0466, 0.0163, -0.1128)


def tensor(xx, yy, zz, xy=0.0, yz=0.0):
    return np.array([[xx, xy, 0], [xy, yy, yz], [0, yz, zz]])


def place(*p):
    return pin.SE3(np.eye(3), np.array(p, dtype=float))


def solo():
    model = pin.Model()
    model.gravity.linear = np.array([0, 0, -9.81])
    trunk = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "air")
    model.appendBodyToJoint(trunk, pin.Inertia(1.16115091, np.zeros(3), np.diag([0.00578574, 0.01938108, 0.02476124])), place(0, 0, 0))
    feet = []
    for name, (x, y, _) in LEGS.items():
        haa = model.addJoint(trunk, pin.JointModelRX(), place(x * 0.1946, y * 0.0875, 0), name + "_HAA")
        model.appendBodyToJoint(haa, pin.Inertia(0.14853845, np.array([-x * 0.078707, y * 0.01, 0]), tensor(3.024e-5, 4.1193e-4, 4.1107e-4, xy=y * 4.671e-5)), place(0, 0, 0))
        hfe = model.addJoint(haa, pin.JointModelRY(), place(0, y * 0.014, 0), name + "_HFE")
        model.appendBodyToJoint(hfe, pin.Inertia(0.14853845, np.array([y * 1.377e-5, y * 0.01935853, -0.078707]), tensor(4.1107e-4, 4.1193e-4, 3.024e-5, yz=y * 4.671e-5)), place(0, 0, 0))
        kfe = model.addJoint(hfe, pin.JointModelRY(), place(0, y * 0.03745, -0.16), name + "_KFE")
        model.appendBodyToJoint(kfe, pin.Inertia(0.03070001, np.array([0, y * 0.00787644, -0.08928215]), tensor(1.2024e-4, 1.2029e-4, 2.16e-6, yz=y * 3.05e-6)), place(0, 0, 0))
        foot = place(0, y * 0.008, -0.16)
        model.appendBodyToJoint(kfe, pin.Inertia(0.00693606, np.array([0, 0, 3.5767e-4]), np.diag([5.7e-7, 8.4e-7, 5.3e-7])), foot)
        feet.append(model.addFrame(pin.Frame(name + "_FOOT", kfe, 0, foot, pin.FrameType.OP_FRAME)))
    return model, model.createData(), feet


MODEL, DATA, FEET = solo()
ORDER = [MODEL.joints[MODEL.getJointId(f"{leg}_{joint}")].idx_v for leg in LEGS for joint in ("HAA", "HFE", "KFE")]


def constraints(q, v):
    """Matrix A of A·v = 0, the velocities of the lowest points of the feet, and Ȧ·v."""
    pin.forwardKinematics(MODEL, DATA, q, v, np.zeros(MODEL.nv))
    pin.computeJointJacobians(MODEL, DATA, q)
    pin.updateFramePlacements(MODEL, DATA)
    down = np.array([0, 0, -R_FOOT])
    rows, drift = [], []
    for foot in FEET:
        j = pin.getFrameJacobian(MODEL, DATA, foot, pin.LOCAL_WORLD_ALIGNED)
        a = pin.getFrameClassicalAcceleration(MODEL, DATA, foot, pin.LOCAL_WORLD_ALIGNED)
        # the point that touches: ċ + ω × down, and down does not change
        rows.append(j[:3] - pin.skew(down) @ j[3:])
        drift.append(a.linear + np.cross(a.angular, down))
    return np.vstack(rows), np.concatenate(drift)


def start():
    q = pin.neutral(MODEL)
    q[2] = 0.32 * math.cos(HIP) + R_FOOT
    for leg, (x, _, _) in LEGS.items():
        q[MODEL.joints[MODEL.getJointId(leg + "_HFE")].idx_q] = x * HIP
        q[MODEL.joints[MODEL.getJointId(leg + "_KFE")].idx_q] = -x * 2 * HIP
    return q


def angles(r):
    return [math.atan2(r[2, 1], r[2, 2]), math.asin(-r[2, 0]), math.atan2(r[1, 0], r[0, 0])]


def commands(t):
    c = []
    side = SWAY * SIDEWAYS * math.sin(2 * math.pi * SIDEWAYS_HZ * t)
    for x, y, amplitude in LEGS.values():
        bend = SWAY * amplitude * math.sin(2 * math.pi * CROUCH_HZ * t)
        c += [y * PRELOAD[0] + side, x * (HIP + PRELOAD[1] + bend), -x * (2 * HIP + PRELOAD[2] + 2 * bend)]
    return np.array(c)


def solve(q, v, command):
    """Accelerations, and the forces of the floor on the feet."""
    a, drift = constraints(q, v)
    applied = -pin.nonLinearEffects(MODEL, DATA, q, v)
    legs = q[[i + 1 for i in ORDER]]
    applied[ORDER] += STIFFNESS * (command - legs) - DAMPING * v[ORDER]
    mass = pin.crba(MODEL, DATA, q)
    mass = np.triu(mass) + np.triu(mass, 1).T
    n = len(drift)
    solved = np.linalg.solve(np.block([[mass, -a.T], [a, np.zeros((n, n))]]), np.r_[applied, -drift])
    return solved[:MODEL.nv], solved[MODEL.nv:]


def rates(_, s, command):
    q, v = s[:MODEL.nq], s[MODEL.nq:]
    h, w = q[3:7], v[3:6]                      # x, y, z, w; angular velocity in axes of the trunk
    r = pin.Quaternion(h / np.linalg.norm(h)).matrix()
    qd = np.empty(MODEL.nq)
    qd[:3] = r @ v[:3]
    qd[3:6] = 0.5 * (h[3] * w + np.cross(h[:3], w))
    qd[6] = -0.5 * h[:3] @ w
    qd[7:] = v[6:]
    return np.r_[qd, solve(q, v, command)[0]]


def run(duration=5.0):
    q, v = start(), np.zeros(MODEL.nv)
    held = np.zeros(12)                        # a row is the state before the commands of its instant act
    for k in range(round(duration / TS) + 1):
        if k % 10 == 0:
            force = solve(q, v, held)[1].reshape(4, 3)
            legs = q[[i + 1 for i in ORDER]]
            yield k * TS, *q[:3], *angles(pin.Quaternion(q[3:7]).matrix()), *legs, *force[:, 2], *np.hypot(force[:, 0], force[:, 1])
        held = commands(k * TS)
        s = solve_ivp(rates, (0, TS), np.r_[q, v], method="DOP853", rtol=1e-11, atol=1e-13, args=(held,)).y[:, -1]
        q, v = s[:MODEL.nq], s[MODEL.nq:]
        q[3:7] /= np.linalg.norm(q[3:7])


if __name__ == "__main__":
    names = [f"{leg}_{joint}" for leg in LEGS for joint in ("HAA", "HFE", "KFE")]
    columns = ["x", "y", "z", "roll", "pitch", "yaw"] + names + [f"n_{leg}" for leg in LEGS] + [f"f_{leg}" for leg in LEGS]
    folder = os.path.dirname(os.path.abspath(__file__))
    with open(os.path.join(folder, "reference.csv"), "w") as file:
        file.write("# by reference.py: trunk [m], [rad]; legs [rad]; normal and friction forces of the feet [N]\n")
        file.write(",".join(["t"] + columns) + "\n")
        for row in run():
            file.write(",".join(f"{value:.12g}" for value in row) + "\n")
