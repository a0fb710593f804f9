"""The rigid part of reference.py against MuJoCo: mass matrix and forces of motion and gravity at random states.

    python compare_mujoco.py        (numpy, scipy, mujoco)
"""
import mujoco
import numpy as np

import reference as ours


def numbers(values):
    return " ".join(repr(float(value)) for value in values)


def inertia(mass, place, matrix):
    full = [matrix[0, 0], matrix[1, 1], matrix[2, 2], matrix[0, 1], matrix[0, 2], matrix[1, 2]]
    return f'<inertial pos="{numbers(place)}" mass="{mass!r}" fullinertia="{numbers(full)}"/>'


def model():
    text, place = "", ours.BASE
    for i in range(4):
        axis = np.eye(3)[ours.AXIS[i]]
        text += f'<body pos="{numbers(place)}"><joint axis="{numbers(axis)}"/>'
        text += inertia(float(ours.MASS[i]), ours.ALONG[i] * ours.L[i] / 2, ours.INERTIA[i])
        place = ours.ALONG[i] * ours.L[i]
    vehicle = f'<body><freejoint/>{inertia(ours.M0, np.zeros(3), ours.I0)}{text}{"</body>" * 5}'
    option = f'<option gravity="0 0 {-ours.G}"/>'
    return mujoco.MjModel.from_xml_string(f"<mujoco>{option}<worldbody>{vehicle}</worldbody></mujoco>")


def main():
    model_, random, worst = model(), np.random.default_rng(1), np.zeros(2)
    data = mujoco.MjData(model_)
    for _ in range(200):
        p, h, w, v, q, qd = random.normal(size=3), random.normal(size=4), *random.normal(size=(2, 3)), *random.normal(size=(2, 4))
        h /= np.linalg.norm(h)
        r = ours.matrix(h)
        data.qpos[:], data.qvel[:] = np.r_[p, h, q], np.r_[v, r.T @ w, qd]
        mujoco.mj_forward(model_, data)
        theirs = np.zeros((10, 10))
        mujoco.mj_fullM(model_, data, theirs)      # since 4.0; before, (model, matrix, data.qM)
        # MuJoCo: velocity in the world, then angular velocity in the body; ours: both in the world, angular first
        change = np.zeros((10, 10))
        change[:3, 3:6], change[3:6, :3], change[6:, 6:] = np.eye(3), r.T, np.eye(4)
        worst[0] = max(worst[0], np.abs(change.T @ theirs @ change - ours.mass_matrix(p, r, q)).max())
        zero = np.zeros(3)
        bias = ours.inverse_dynamics(p, r, w, v, q, qd, zero, zero, np.zeros(4))
        worst[1] = max(worst[1], np.abs(change.T @ data.qfrc_bias - bias).max())
    print(f"200 random states: mass matrix off by {worst[0]:.1e}, forces of motion and gravity by {worst[1]:.1e}")


if __name__ == "__main__":
    main()
