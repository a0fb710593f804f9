# scene: arm
"""Makes dummies, hangs them on the arm, moves and removes them; collision and distance of bodies."""

import sys
import pathlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import simx as vrep  # noqa: E402

vrep.simxFinish(-1)
client = vrep.simxStart("127.0.0.1", int(sys.argv[1]), True, True, 5000, 5)
assert client != -1, "no connection"
wait = vrep.simx_opmode_blocking

_, tip = vrep.simxGetObjectHandle(client, 'tip', wait)
_, cube = vrep.simxGetObjectHandle(client, 'cube', wait)
_, fore = vrep.simxGetObjectHandle(client, 'fore', wait)
code, dummy = vrep.simxCreateDummy(client, 0.02, None, wait)
assert code == 0
assert vrep.simxSetObjectParent(client, dummy, tip, False, wait) == 0
vrep.simxSetObjectPosition(client, dummy, vrep.sim_handle_parent, [0, 0, 0.1], wait)
vrep.simxSetObjectOrientation(client, dummy, vrep.sim_handle_parent, [0, 0, 1.0], wait)
code, angles = vrep.simxGetObjectOrientation(client, dummy, tip, wait)
assert code == 0 and abs(angles[2] - 1.0) < 1e-5
assert vrep.simxSetObjectQuaternion(client, dummy, -1, [0, 0, 0, 1], wait) == 0
code, distance = vrep.simxCheckDistance(client, fore, cube, wait)
assert code == 0 and 0.0 < distance < 1.0
assert vrep.simxCheckCollision(client, fore, cube, wait) == (0, 0)
assert vrep.simxRemoveObject(client, dummy, wait) == 0
assert vrep.simxGetObjectPosition(client, dummy, -1, wait)[0] == 8

vrep.simxFinish(client)
