# scene: arm
"""An asynchronous program: it starts the simulation, looks now and then, pauses, resumes, stops."""

import sys
import pathlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import simx as vrep  # noqa: E402

vrep.simxFinish(-1)
client = vrep.simxStart("127.0.0.1", int(sys.argv[1]), True, True, 5000, 5)
assert client != -1, "no connection"
wait = vrep.simx_opmode_blocking

import time  # noqa: E402

_, joint = vrep.simxGetObjectHandle(client, 'joint1', wait)
vrep.simxStartSimulation(client, wait)
vrep.simxGetJointPosition(client, joint, vrep.simx_opmode_streaming)
vrep.simxSetJointTargetPosition(client, joint, 0.5, vrep.simx_opmode_oneshot)
limit = time.monotonic() + 20
while True:
    vrep.simxGetPingTime(client)
    code, q = vrep.simxGetJointPosition(client, joint, vrep.simx_opmode_buffer)
    if code == 0 and abs(q - 0.5) < 1e-2:
        break
    assert time.monotonic() < limit, q
vrep.simxPauseSimulation(client, wait)
vrep.simxGetPingTime(client)
vrep.simxGetPingTime(client)
first = vrep.simxGetLastCmdTime(client)
vrep.simxGetPingTime(client)
assert vrep.simxGetLastCmdTime(client) == first, 'time stands while paused'
vrep.simxStartSimulation(client, wait)
vrep.simxStopSimulation(client, wait)
assert vrep.simxGetConnectionId(client) != -1

vrep.simxFinish(client)
