# scene: table
"""A loose body hangs on the world: its parent, the list of all objects, its place in it."""

import sys
import pathlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import simx as vrep  # noqa: E402

client = vrep.simxStart('127.0.0.1', int(sys.argv[1]), True, True, 5000, 5)
assert client != -1, 'no connection'
wait = vrep.simx_opmode_blocking

code, brick = vrep.simxGetObjectHandle(client, 'brick', wait)
code, joint = vrep.simxGetObjectHandle(client, 'space', wait)
assert code == 0, 'the joint is found by its name'
assert vrep.simxGetObjectParent(client, brick, wait) == (0, -1)
code, objects = vrep.simxGetObjects(client, vrep.sim_handle_all, wait)
assert brick in objects and joint not in objects, objects
assert vrep.simxSetObjectPosition(client, brick, -1, [0.5, 2.0, 1.5], wait) == 0
code, place = vrep.simxGetObjectPosition(client, brick, vrep.sim_handle_parent, wait)
assert max(abs(a - b) for a, b in zip(place, [0.5, 2.0, 1.5])) < 1e-6, place

vrep.simxFinish(client)
