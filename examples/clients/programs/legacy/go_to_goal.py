# scene: rover
"""Drives to a dummy with a law in polar coordinates, poses streamed."""

import sys
import pathlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import simx as vrep  # noqa: E402

vrep.simxFinish(-1)
client = vrep.simxStart("127.0.0.1", int(sys.argv[1]), True, True, 5000, 5)
assert client != -1, "no connection"
wait = vrep.simx_opmode_blocking

from math import atan2, cos, hypot, pi, sin  # noqa: E402

_, left = vrep.simxGetObjectHandle(client, 'leftMotor', wait)
_, right = vrep.simxGetObjectHandle(client, 'rightMotor', wait)
_, rover = vrep.simxGetObjectHandle(client, 'chassis', wait)
_, goal = vrep.simxGetObjectHandle(client, 'goal', wait)
vrep.simxGetObjectPosition(client, rover, -1, vrep.simx_opmode_streaming)
vrep.simxGetObjectOrientation(client, rover, -1, vrep.simx_opmode_streaming)
vrep.simxSynchronous(client, True)
vrep.simxStartSimulation(client, wait)
_, aim = vrep.simxGetObjectPosition(client, goal, -1, wait)
for step in range(600):
    vrep.simxSynchronousTrigger(client)
    _, at = vrep.simxGetObjectPosition(client, rover, -1, vrep.simx_opmode_buffer)
    _, angles = vrep.simxGetObjectOrientation(client, rover, -1, vrep.simx_opmode_buffer)
    distance = hypot(aim[0] - at[0], aim[1] - at[1])
    if distance < 0.05:
        break
    turn = atan2(aim[1] - at[1], aim[0] - at[0]) - angles[2]
    turn = (turn + pi) % (2 * pi) - pi
    v, w = 0.4 * cos(turn), 1.5 * sin(turn)
    vrep.simxPauseCommunication(client, True)
    vrep.simxSetJointTargetVelocity(client, left, (v - 0.15 * w) / 0.1, vrep.simx_opmode_oneshot)
    vrep.simxSetJointTargetVelocity(client, right, (v + 0.15 * w) / 0.1, vrep.simx_opmode_oneshot)
    vrep.simxPauseCommunication(client, False)
assert distance < 0.05, (step, distance)
vrep.simxStopSimulation(client, wait)

vrep.simxFinish(client)
