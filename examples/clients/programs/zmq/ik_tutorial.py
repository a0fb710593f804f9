# scene: arm
"""Inverse kinematics as in the tutorials: a group that follows a target, undamped first and damped where that fails."""

import sys

from coppeliasim_zmqremoteapi_client import RemoteAPIClient

client = RemoteAPIClient(port=int(sys.argv[1]))
sim = client.require("sim")

import math  # noqa: E402

simIK = client.require('simIK')
base, tip, target = sim.getObject('/base'), sim.getObject('/tip'), sim.getObject('/target')
env = simIK.createEnvironment()
undamped, damped = simIK.createGroup(env), simIK.createGroup(env)
simIK.setGroupCalculation(env, undamped, simIK.method_pseudo_inverse, 0, 20)
simIK.setGroupCalculation(env, damped, simIK.method_damped_least_squares, 0.1, 99)
element, to_ik, to_sim = simIK.addElementFromScene(env, undamped, base, tip, target, simIK.constraint_position)
simIK.addElementFromScene(env, damped, base, tip, target, simIK.constraint_position)
assert to_ik[tip] == tip and to_sim[target] == target
sim.setStepping(True)
sim.startSimulation()
for k in range(120):
    angle = 2 * math.pi * k / 120
    sim.setObjectPosition(target, [0.5 + 0.1 * math.cos(angle), 0.15 * math.sin(angle), 0.45])
    result, *_ = simIK.handleGroup(env, undamped, {'syncWorlds': True})
    if result != simIK.result_success:
        simIK.handleGroup(env, damped, {'syncWorlds': True, 'allowError': True})
    sim.step()
for _ in range(20):
    simIK.handleGroup(env, undamped, {'syncWorlds': True})
    sim.step()
a, b = sim.getObjectPosition(tip), sim.getObjectPosition(target)
assert math.dist(a, b) < 5e-3, (a, b)
sim.stopSimulation()
# out of reach: nothing is applied unless errors are allowed
sim.setObjectPosition(target, [3, 0, 0])
assert simIK.applyIkEnvironmentToScene(env, damped, True)[0] == simIK.result_fail
simIK.eraseEnvironment(env)
