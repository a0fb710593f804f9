# scene: table
"""Balances a pole by forces, as libraries for torque control do: the sign goes into a large target velocity, the size into the force limit;
the present force is read before the first step."""

import sys
import pathlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import simx as vrep  # noqa: E402

vrep.simxFinish(-1)
client = vrep.simxStart("127.0.0.1", int(sys.argv[1]), True, True, 5000, 5)
assert client != -1, "no connection"
wait = vrep.simx_opmode_blocking

from math import copysign  # noqa: E402

vrep.simxSynchronous(client, True)
_, rail = vrep.simxGetObjectHandle(client, 'rail', wait)
_, hinge = vrep.simxGetObjectHandle(client, 'hinge', wait)
vrep.simxStartSimulation(client, wait)
code, force = vrep.simxGetJointForce(client, rail, wait)
assert code == 0 and force == 0.0, 'before the first step the force is zero'
for _ in range(300):
    _, x = vrep.simxGetJointPosition(client, rail, wait)
    _, q = vrep.simxGetJointPosition(client, hinge, wait)
    _, v = vrep.simxGetObjectFloatParameter(client, rail, vrep.sim_jointfloatparam_velocity, wait)
    _, w = vrep.simxGetObjectFloatParameter(client, hinge, vrep.sim_jointfloatparam_velocity, wait)
    u = 1.0 * x + 2.1 * v + 30.0 * q + 6.0 * w
    code, present = vrep.simxGetJointForce(client, rail, wait)
    assert code == 0
    vrep.simxSetJointTargetVelocity(client, rail, copysign(10000.0, u), wait)
    vrep.simxSetJointForce(client, rail, abs(u), wait)
    vrep.simxSynchronousTrigger(client)
assert abs(q) < 0.05 and abs(x) < 0.5, (q, x)
assert abs(present + u) < 0.5, 'the force is minus the effort of the motor'
vrep.simxStopSimulation(client, wait)

vrep.simxFinish(client)
