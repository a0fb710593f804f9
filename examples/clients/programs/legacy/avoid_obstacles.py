# scene: rover
"""A rover that drives until its sensors see the wall, then turns away: the loop of most course work with V-REP."""

import sys
import pathlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import simx as vrep  # noqa: E402

vrep.simxFinish(-1)
client = vrep.simxStart("127.0.0.1", int(sys.argv[1]), True, True, 5000, 5)
assert client != -1, "no connection"
wait = vrep.simx_opmode_blocking

handle = {name: vrep.simxGetObjectHandle(client, name, wait)[1] for name in ('leftMotor', 'rightMotor', 'front', 'left', 'right', 'chassis', 'wall')}
for name in ('front', 'left', 'right'):
    vrep.simxReadProximitySensor(client, handle[name], vrep.simx_opmode_streaming)
vrep.simxSynchronous(client, True)
vrep.simxStartSimulation(client, wait)
nearest, seen = 9.0, False
for _ in range(130):
    vrep.simxSynchronousTrigger(client)
    code, state, point, found, normal = vrep.simxReadProximitySensor(client, handle['front'], vrep.simx_opmode_buffer)
    if state:
        assert found == handle['wall'] and abs(normal[2]) <= 1.0
        nearest, seen = min(nearest, point[2]), True
    left, right = (-2.0, 2.0) if state and point[2] < 0.6 else (6.0, 6.0)
    vrep.simxSetJointTargetVelocity(client, handle['leftMotor'], left, vrep.simx_opmode_oneshot)
    vrep.simxSetJointTargetVelocity(client, handle['rightMotor'], right, vrep.simx_opmode_oneshot)
_, place = vrep.simxGetObjectPosition(client, handle['chassis'], -1, wait)
assert seen and 0.2 < nearest < 0.6, nearest
assert place[0] < 2.7, place
vrep.simxStopSimulation(client, wait)

vrep.simxFinish(client)
