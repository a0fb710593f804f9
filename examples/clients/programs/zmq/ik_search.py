# scene: arm
"""Configurations that reach a pose, and a straight path to it, without moving the robot; Jacobian and manipulability."""

import sys

from coppeliasim_zmqremoteapi_client import RemoteAPIClient

client = RemoteAPIClient(port=int(sys.argv[1]))
sim = client.require("sim")

import math  # noqa: E402

simIK = client.require('simIK')
base, tip, target = sim.getObject('/base'), sim.getObject('/tip'), sim.getObject('/target')
joints = [sim.getObject(f'/joint{k}') for k in (1, 2, 3)]
env = simIK.createEnvironment()
group = simIK.createGroup(env)
element, *_ = simIK.addElementFromScene(env, group, base, tip, target, simIK.constraint_position)
simIK.setElementPrecision(env, group, element, [1e-4, 0.01])
simIK.setElementBase(env, group, element, base)
simIK.setElementConstraints(env, group, element, simIK.constraint_position)
before = [sim.getJointPosition(joint) for joint in joints]
configs = simIK.findConfigs(env, group, joints, {'maxTime': 0.5, 'findMultiple': True})
assert len(configs) >= 2, configs
goal = sim.getObjectPosition(target)
for a, b, c in configs:
    reach, height = 0.5 * math.cos(b) + 0.4 * math.cos(b + c), 0.3 + 0.5 * math.sin(b) + 0.4 * math.sin(b + c)
    assert math.dist(goal, [reach * math.cos(a), reach * math.sin(a), height]) < 1e-3
path = simIK.generatePath(env, group, joints, tip, 20)
assert len(path) == 60 and [sim.getJointPosition(joint) for joint in joints] == before
lengths, total = sim.getPathLengths(path, 3)
assert total > 0 and len(lengths) == 20
middle = sim.getPathInterpolatedConfig(path, lengths, 0.5 * total)
assert len(middle) == 3
jacobian, errors = simIK.computeGroupJacobian(env, group)
assert len(jacobian) == 9 and len(errors) == 3 and simIK.getManipulability(env, group) > 1e-3
