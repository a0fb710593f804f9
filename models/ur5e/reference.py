"""Reference of this scene: Pinocchio's dynamics, the arm built from the tables of the manufacturer, integrated between the controller's samples.

Needs pin 4.1, NumPy, SciPy. Writes reference.csv.
"""
import os

import numpy as np
import pinocchio as pin
from scipy.integrate import solve_ivp

# a, d [m], α [rad] (rows of Denavit and Hartenberg), mass [kg], centre of mass [m], Ixx Ixy Iyy Ixz Iyz Izz [kg·m²]
LINKS = [
    (0, 0.1625, np.pi / 2, 3.761, (0, -0.02561, 0.00193), (0.00700210, 7.3e-7, 0.00648091, -1.053e-5, 4.9994e-4, 0.00657286)),
    (-0.425, 0, 0, 8.058, (0.2125, 0, 0.11336), (0.01505885, -5.4e-5, 0.33388086, 5.63e-6, -1.81e-6, 0.33247207)),
    (-0.3922, 0, 0, 2.846, (0.15, 0, 0.0265), (0.00399632, -1.365e-5, 0.07879254, 1.37272e-3, -6.6e-6, 0.0784851)),
    (0, 0.1333, np.pi / 2, 1.37, (0, -0.0018, 0.01634), (0.00165491, -2.82e-6, 0.00135962, -4.38e-6, 1.0157e-4, 0.00126279)),
    (0, 0.0997, -np.pi / 2, 1.3, (0, 0.0018, 0.01634), (0.00135617, -2.74e-6, 0.00127827, 4.44e-6, -5.048e-5, 0.00096614)),
    (0, 0.0996, 0, 0.365, (0, 0, -0.001159), (1.8694e-4, 6e-8, 1.8908e-4, -1.7e-7, -9.2e-7, 2.5756e-4)),
]
TIMES = [0.0, 0.2, 0.8, 2.0, 2.6]
POINTS = np.array([[0.2452, -1.1299, 2.1170, -2.5579, -1.5708, 1.8160], [0.2452, -1.1299, 2.1170, -2.5579, -1.5708, 1.8160],
                   [0.2452, -1.4716, 1.9081, -2.0073, -1.5708, 1.8160], [-1.4404, -1.4166, 1.8448, -1.9990, -1.5708, 0.1304],
                   [-1.4404, -1.0925, 2.0478, -2.5260, -1.5708, 0.1304]])
TS, FILTER, OMEGA = 0.002, 12.0, 40.0


def arm(block):
    model = pin.Model()
    model.gravity.linear = np.array([0, 0, -9.81])
    joint, place = 0, pin.SE3.Identity()
    for a, d, alpha, mass, com, inertia in LINKS:
        joint = model.addJoint(joint, pin.JointModelRZ(), place, f"joint{model.njoints}")
        c, s = np.cos(alpha), np.sin(alpha)
        place = pin.SE3(np.array([[1, 0, 0], [0, c, -s], [0, s, c]]), np.array([a, 0, d]))
        xx, xy, yy, xz, yz, zz = inertia
        tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        model.appendBodyToJoint(joint, pin.Inertia(mass, np.array(com), tensor), place)
    if block:
        mass = 2700 * 0.08**3
        cube = pin.Inertia(mass, np.array([0, 0, 0.04]), np.eye(3) * mass * 0.08**2 / 6)
        model.appendBodyToJoint(joint, cube, place)
    return model, model.createData(), joint, place


def run(known, duration=4.0):
    plant, data, last, tool = arm(True)
    model, of_model, _, _ = arm(known)
    q, v = POINTS[0].copy(), np.zeros(6)
    y, r = POINTS[0].copy(), np.zeros(6)
    for k in range(round(duration / TS) + 1):
        t = k * TS
        u = np.array([np.interp(t, TIMES, column) for column in POINTS.T])
        acceleration = -FILTER**2 * (y - u) - 2 * FILTER * r
        wanted = acceleration + 2 * OMEGA * (r - v) + OMEGA**2 * (y - q)
        torque = pin.rnea(model, of_model, q, v, wanted)
        if k % 10 == 0:
            pin.forwardKinematics(plant, data, q)
            yield t, *q, *v, *torque, *(data.oMi[last] * tool).translation
        # the filter, exactly over one sample
        c, d = y - u, r + FILTER * (y - u)
        e = np.exp(-FILTER * TS)
        y, r = u + (c + d * TS) * e, (d - FILTER * (c + d * TS)) * e
        rates = lambda _, x: np.r_[x[6:], pin.aba(plant, data, x[:6], x[6:], torque)]
        x = solve_ivp(rates, (0, TS), np.r_[q, v], method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
        q, v = x[:6], x[6:]


if __name__ == "__main__":
    names = ["q", "v", "tau"]
    columns = [f"{n}{i}" for n in names for i in range(1, 7)] + ["x", "y", "z"]
    folder = os.path.dirname(os.path.abspath(__file__))
    with open(os.path.join(folder, "reference.csv"), "w") as file:
        file.write("# by reference.py: [s], [rad], [rad/s], [N·m], flange [m]; known_: the controller knows of the block\n")
        file.write(",".join(["t"] + columns + ["known_" + c for c in columns]) + "\n")
        for row, known in zip(run(False), run(True)):
            file.write(",".join(f"{value:.12g}" for value in (*row, *known[1:])) + "\n")
