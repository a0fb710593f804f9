# scene: table
"""Reads a collision and a distance object of V-REP 3 over the legacy API while a ball falls, as learning programs do."""

import sys
import pathlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import simx as vrep  # noqa: E402

client = vrep.simxStart("127.0.0.1", int(sys.argv[1]), True, True, 5000, 5)
assert client != -1, "no connection"
wait = vrep.simx_opmode_blocking

# handles are asked for before the run, as V-REP has them in the scene
code, touch = vrep.simxGetCollisionHandle(client, 'ball#', wait)
assert code == 0
code, gap = vrep.simxGetDistanceHandle(client, 'gap', wait)
assert code == 0
code, _ = vrep.simxGetCollisionHandle(client, 'cube', wait)
assert code == 8
assert 'createCollisionObject' in vrep.simxGetLastErrors(client, wait)[1][0]

vrep.simxSynchronous(client, True)
vrep.simxStartSimulation(client, wait)
vrep.simxReadCollision(client, touch, vrep.simx_opmode_streaming)
vrep.simxReadDistance(client, gap, vrep.simx_opmode_streaming)
states, distances = [], []
for _ in range(60):
    vrep.simxSynchronousTrigger(client)
    states.append(vrep.simxReadCollision(client, touch, vrep.simx_opmode_buffer)[1])
    distances.append(vrep.simxReadDistance(client, gap, vrep.simx_opmode_buffer)[1])
# it falls for 0.29 s from 0.4 m above the floor, and the brick falls freely beside it
assert not any(states[:25]) and all(states[30:]), states
assert 1.5 < distances[0] < 2.3 and len(set(distances)) > 10, distances[:3]
vrep.simxStopSimulation(client, wait)

vrep.simxFinish(client)
