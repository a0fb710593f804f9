# scene: table
"""Copies, hangs, removes bodies and loads a robot over the legacy API."""

import sys
import pathlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import simx as vrep  # noqa: E402

client = vrep.simxStart("127.0.0.1", int(sys.argv[1]), True, True, 5000, 5)
assert client != -1, "no connection"
wait = vrep.simx_opmode_blocking

vrep.simxSynchronous(client, True)
vrep.simxStartSimulation(client, wait)
_, ball = vrep.simxGetObjectHandle(client, 'core', wait)
_, brick = vrep.simxGetObjectHandle(client, 'brick', wait)
code, copies = vrep.simxCopyPasteObjects(client, [ball], wait)
assert code == 0 and len(copies) == 1
assert vrep.simxSetObjectPosition(client, copies[0], -1, [3, 0, 0.15], wait) == 0
code, robot = vrep.simxLoadModel(client, 'pioneer-p3dx', 0, wait)
assert code == 0
assert vrep.simxSetObjectPosition(client, robot, -1, [-2, 3, 0], wait) == 0
for _ in range(60):
    vrep.simxSynchronousTrigger(client)
vrep.simxGetPingTime(client)
code, place = vrep.simxGetObjectPosition(client, copies[0], -1, wait)
assert code == 0 and abs(place[2] - 0.1) < 1e-4, place
assert vrep.simxSetObjectParent(client, copies[0], brick, True, wait) == 0
for _ in range(5):
    vrep.simxSynchronousTrigger(client)
assert vrep.simxSetObjectParent(client, copies[0], -1, True, wait) == 0
assert vrep.simxRemoveObject(client, copies[0], wait) == 0
assert vrep.simxRemoveModel(client, robot, wait) == 0
assert vrep.simxGetObjectPosition(client, robot, -1, wait)[0] == 8
vrep.simxSynchronousTrigger(client)
vrep.simxStopSimulation(client, wait)

vrep.simxFinish(client)
