# scene: quadricopter
"""Leads the quadricopter along a square by moving its target."""

import sys
import pathlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import simx as vrep  # noqa: E402

vrep.simxFinish(-1)
client = vrep.simxStart("127.0.0.1", int(sys.argv[1]), True, True, 5000, 5)
assert client != -1, "no connection"
wait = vrep.simx_opmode_blocking

vrep.simxSynchronous(client, True)
vrep.simxStartSimulation(client, wait)
_, copter = vrep.simxGetObjectHandle(client, 'base', wait)
_, target = vrep.simxGetObjectHandle(client, 'target', wait)
assert vrep.simxGetObjectParent(client, target, wait) == (0, -1), 'the script has hung it on the world'
vrep.simxGetObjectPosition(client, copter, -1, vrep.simx_opmode_streaming)
for corner in ([0.5, 0.0, 0.8], [0.5, 0.5, 0.8], [0.0, 0.5, 0.8]):
    assert vrep.simxSetObjectPosition(client, target, -1, corner, wait) == 0
    for _ in range(100):
        vrep.simxSynchronousTrigger(client)
    _, at = vrep.simxGetObjectPosition(client, copter, -1, vrep.simx_opmode_buffer)
    assert max(abs(a - b) for a, b in zip(at, corner)) < 0.05, (corner, at)
_, linear, angular = vrep.simxGetObjectVelocity(client, copter, wait)
assert max(map(abs, linear)) < 0.1, linear
vrep.simxStopSimulation(client, wait)

vrep.simxFinish(client)
