# scene: arm
"""Puts joints somewhere while the simulation is stopped and compares the tip with the closed form; relative poses and quaternions."""

import sys
import pathlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import simx as vrep  # noqa: E402

vrep.simxFinish(-1)
client = vrep.simxStart("127.0.0.1", int(sys.argv[1]), True, True, 5000, 5)
assert client != -1, "no connection"
wait = vrep.simx_opmode_blocking

from math import cos, sin  # noqa: E402

joints = [vrep.simxGetObjectHandle(client, f'joint{k}', wait)[1] for k in (1, 2, 3)]
_, tip = vrep.simxGetObjectHandle(client, 'tip', wait)
_, base = vrep.simxGetObjectHandle(client, 'base', wait)
for a, b, c in ((0.0, 0.5, -1.0), (0.7, 0.2, 0.3), (-1.2, 1.0, -2.0)):
    for joint, q in zip(joints, (a, b, c)):
        assert vrep.simxSetJointPosition(client, joint, q, wait) == 0
    reach, height = 0.5 * cos(b) + 0.4 * cos(b + c), 0.3 + 0.5 * sin(b) + 0.4 * sin(b + c)
    _, at = vrep.simxGetObjectPosition(client, tip, -1, wait)
    expected = [reach * cos(a), reach * sin(a), height]
    assert max(abs(x - y) for x, y in zip(at, expected)) < 1e-5, (at, expected)
    _, relative = vrep.simxGetObjectPosition(client, tip, base, wait)
    assert max(abs(x - y) for x, y in zip(at, relative)) < 1e-5
    _, q = vrep.simxGetObjectQuaternion(client, tip, -1, wait)
    assert abs(sum(x * x for x in q) - 1) < 1e-5

vrep.simxFinish(client)
