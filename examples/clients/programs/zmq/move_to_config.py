# scene: arm
"""Jerk-limited motions: of joints by the present and the older form, whose callback has three parameters, and of one number."""

import sys

from coppeliasim_zmqremoteapi_client import RemoteAPIClient

client = RemoteAPIClient(port=int(sys.argv[1]))
sim = client.require("sim")

joints = [sim.getObject(f'/joint{k}') for k in (1, 2, 3)]
sim.setStepping(True)
sim.startSimulation()
goal = [0.5, 0.8, -0.6]
sim.moveToConfig({'joints': joints, 'targetPos': goal, 'maxVel': [1, 1, 1], 'maxAccel': [2, 2, 2], 'maxJerk': [10, 10, 10]})
for _ in range(20):
    sim.step()
assert all(abs(sim.getJointPosition(j) - q) < 1e-2 for j, q in zip(joints, goal))
calls = []


def moved(config, velocity, acceleration):
    calls.append(config)
    for joint, q in zip(joints, config):
        sim.setJointTargetPosition(joint, q)


start, zero = [sim.getJointPosition(joint) for joint in joints], [0, 0, 0]
end, *_ = sim.moveToConfig(-1, start, zero, zero, [1, 1, 1], [2, 2, 2], [10, 10, 10], [0, 0.5, -1], zero, moved, None)
assert len(calls) > 10 and max(abs(a - b) for a, b in zip(end, [0, 0.5, -1])) < 1e-6, end
sim.stopSimulation()
