# scene: arm
"""Finds a red cube in the pictures of a vision sensor."""

import sys
import pathlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import simx as vrep  # noqa: E402

vrep.simxFinish(-1)
client = vrep.simxStart("127.0.0.1", int(sys.argv[1]), True, True, 5000, 5)
assert client != -1, "no connection"
wait = vrep.simx_opmode_blocking

_, eye = vrep.simxGetObjectHandle(client, 'eye', wait)
vrep.simxSynchronous(client, True)
vrep.simxStartSimulation(client, wait)
vrep.simxGetVisionSensorImage(client, eye, 0, vrep.simx_opmode_streaming)
vrep.simxSynchronousTrigger(client)
code, size, image = vrep.simxGetVisionSensorImage(client, eye, 0, vrep.simx_opmode_buffer)
assert code == 0 and size == [64, 48] and len(image) == 64 * 48 * 3
pixels = [[x & 0xff for x in image[3 * k:3 * k + 3]] for k in range(64 * 48)]
red = [k for k, (r, g, b) in enumerate(pixels) if r > 2 * g and r > 2 * b]
column = sum(k % 64 for k in red) / len(red)
row = sum(k // 64 for k in red) / len(red)
assert 80 < len(red) < 130 and abs(column - 31.5) < 3 and abs(row - 23.5) < 3, (len(red), column, row)
code, size, grey = vrep.simxGetVisionSensorImage(client, eye, 1, wait)
assert code == 0 and len(grey) == 64 * 48
code, size, depth = vrep.simxGetVisionSensorDepthBuffer(client, eye, wait)
metres = 0.1 + depth[24 * 64 + 32] * 4.9
assert code == 0 and abs(metres - 1.8) < 1e-3, metres
vrep.simxStopSimulation(client, wait)

vrep.simxFinish(client)
