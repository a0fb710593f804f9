# scene: arm
"""Weighs a lamp with a force sensor."""

import sys
import pathlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import simx as vrep  # noqa: E402

vrep.simxFinish(-1)
client = vrep.simxStart("127.0.0.1", int(sys.argv[1]), True, True, 5000, 5)
assert client != -1, "no connection"
wait = vrep.simx_opmode_blocking

_, hook = vrep.simxGetObjectHandle(client, 'hook', wait)
vrep.simxSynchronous(client, True)
vrep.simxStartSimulation(client, wait)
vrep.simxReadForceSensor(client, hook, vrep.simx_opmode_streaming)
vrep.simxSynchronousTrigger(client)
code, state, force, torque = vrep.simxReadForceSensor(client, hook, vrep.simx_opmode_buffer)
assert code == 0 and state & 1 and abs(abs(force[2]) - 2 * 9.81) < 1e-3, force
assert max(map(abs, torque)) < 1e-6
vrep.simxStopSimulation(client, wait)

vrep.simxFinish(client)
