"""Reference of this scene: Pinocchio's dynamics of an arm built from the published tables, integrated between the controller's samples.

Needs pin 4.1, NumPy, SciPy. Writes reference.csv.
"""
import os

import numpy as np
import pinocchio as pin
from scipy.integrate import solve_ivp

# place [m] and α [°] of the joint's frame; mass [kg]; centre of mass [m]; Ixx Iyy Izz Ixy Ixz Iyz [kg·m²]
LINKS = [
    ((0, 0, 0.333), 0, 4.970684, (0.003875, 0.002081, -0.04762), (0.70337, 0.70661, 0.009117, -0.000139, 0.006772, 0.019169)),
    ((0, 0, 0), -90, 0.646926, (-0.003141, -0.02872, 0.003495), (0.007962, 0.02811, 0.025995, -0.003925, 0.010254, 0.000704)),
    ((0, -0.316, 0), 90, 3.228604, (0.027518, 0.039252, -0.066502), (0.037242, 0.036155, 0.01083, -0.004761, -0.011396, -0.012805)),
    ((0.0825, 0, 0), 90, 3.587895, (-0.05317, 0.104419, 0.027454), (0.025853, 0.019552, 0.028323, 0.007796, -0.001332, 0.008641)),
    ((-0.0825, 0.384, 0), -90, 1.225946, (-0.011953, 0.041065, -0.038437), (0.035549, 0.029474, 0.008627, -0.002117, -0.004037, 0.000229)),
    ((0, 0, 0), 90, 1.666555, (0.060149, -0.014117, -0.010517), (0.001964, 0.004354, 0.005433, 0.000109, -0.001158, 0.000341)),
    ((0.088, 0, 0), 90, 0.735522, (0.010517, -0.004252, 0.061597), (0.012516, 0.010027, 0.004815, -0.000428, -0.001196, -0.000741)),
]
READY = np.array([0, -np.pi / 4, 0, -3 * np.pi / 4, 0, np.pi / 2, np.pi / 4])
TS, PLACE, BEARING = 0.001, np.array([0.3069, 0, 0.4869]), 0.003
FINGER = dict(stiffness=2000.0, damping=60.0, command=0.02, bearing=0.3)
# both fingers move by the same length: velocities of the tree are S·u
S = np.vstack([np.eye(8), np.eye(8)[7]])


def rx(degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[1, 0, 0], [0, c, -s], [0, s, c]])


def arm():
    model = pin.Model()
    model.gravity.linear = np.array([0, 0, -9.81])
    joint = 0
    for place, alpha, mass, com, (xx, yy, zz, xy, xz, yz) in LINKS:
        joint = model.addJoint(joint, pin.JointModelRZ(), pin.SE3(rx(alpha), np.array(place)), f"joint{model.njoints}")
        tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        model.appendBodyToJoint(joint, pin.Inertia(mass, np.array(com), tensor), pin.SE3.Identity())
    c = np.sqrt(0.5)
    hand = pin.SE3(np.array([[c, c, 0], [-c, c, 0], [0, 0, 1]]), np.array([0, 0, 0.107]))
    model.appendBodyToJoint(joint, pin.Inertia(0.73, np.array([-0.01, 0, 0.03]), np.diag([0.001, 0.0025, 0.0017])), hand)
    for name, axis in (("left", 1.0), ("right", -1.0)):
        carriage = hand * pin.SE3(np.eye(3), np.array([0, 0, 0.0584]))
        finger = model.addJoint(joint, pin.JointModelPrismaticUnaligned(np.array([0, axis, 0])), carriage, name)
        model.appendBodyToJoint(finger, pin.Inertia(0.015, np.zeros(3), np.diag([2.375e-6, 2.375e-6, 7.5e-7])), pin.SE3.Identity())
    tool = model.addFrame(pin.Frame("tcp", joint, 0, hand * pin.SE3(np.eye(3), np.array([0, 0, 0.1034])), pin.FrameType.OP_FRAME))
    return model, model.createData(), tool


def push(t):
    return np.array([0, 20.0 if 0.5 <= t < 1.5 else 0.0, -15.0 if 2.5 <= t < 3.5 else 0.0])


def run(k, d, kq, dq, duration=5.0):
    model, data, tool = arm()
    q, u = np.r_[READY, 0.02], np.zeros(8)

    def jacobian(q):
        return pin.computeFrameJacobian(model, data, S @ q, tool, pin.LOCAL_WORLD_ALIGNED)[:3]

    for step in range(round(duration / TS) + 1):
        t = step * TS
        j = jacobian(q)
        pin.framesForwardKinematics(model, data, S @ q)
        x = data.oMf[tool].translation.copy()
        force = k * (PLACE - x) - d * (j @ S @ u)
        gravity = pin.computeGeneralizedGravity(model, data, S @ q)
        torque = (gravity + j.T @ force)[:7] + kq * (READY - q[:7]) - dq * u[:7]
        if step % 20 == 0:
            yield t, *q, *torque, *x
        pushed = push(t + 0.5 * TS)

        def rates(_, y):
            q, u = y[:8], y[8:]
            applied = np.zeros(9)
            applied[:7] = torque - BEARING * u[:7]
            applied[7] = FINGER["stiffness"] * (FINGER["command"] - q[7]) - (FINGER["damping"] + FINGER["bearing"]) * u[7]
            applied[8] = -FINGER["bearing"] * u[7]
            applied += jacobian(q).T @ pushed
            mass = pin.crba(model, data, S @ q)
            mass = np.triu(mass) + np.triu(mass, 1).T
            bias = pin.nonLinearEffects(model, data, S @ q, S @ u)
            return np.r_[u, np.linalg.solve(S.T @ mass @ S, S.T @ (applied - bias))]

        y = solve_ivp(rates, (0, TS), np.r_[q, u], method="DOP853", rtol=1e-11, atol=1e-13).y[:, -1]
        q, u = y[:8], y[8:]


if __name__ == "__main__":
    columns = [f"q{i}" for i in range(1, 8)] + ["finger"] + [f"tau{i}" for i in range(1, 8)] + ["x", "y", "z"]
    folder = os.path.dirname(os.path.abspath(__file__))
    with open(os.path.join(folder, "reference.csv"), "w") as file:
        file.write("# by reference.py: [s], [rad], [m], [N·m], tool [m]; float_: damped, without springs\n")
        file.write(",".join(["t"] + columns + ["float_" + c for c in columns]) + "\n")
        for row, floating in zip(run(400.0, 40.0, 5.0, 1.0), run(0.0, 100.0, 0.0, 1.0)):
            file.write(",".join(f"{value:.12g}" for value in (*row, *floating[1:])) + "\n")
