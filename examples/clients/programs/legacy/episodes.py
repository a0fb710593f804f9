# scene: table
"""Learning in episodes: the simulation is started and stopped again and again, and begins the same way each time."""

import sys
import pathlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import simx as vrep  # noqa: E402

vrep.simxFinish(-1)
client = vrep.simxStart("127.0.0.1", int(sys.argv[1]), True, True, 5000, 5)
assert client != -1, "no connection"
wait = vrep.simx_opmode_blocking

_, hinge = vrep.simxGetObjectHandle(client, 'hinge', wait)
_, rail = vrep.simxGetObjectHandle(client, 'rail', wait)
ends = []
for episode in range(5):
    vrep.simxSynchronous(client, True)
    vrep.simxStartSimulation(client, wait)
    assert abs(vrep.simxGetJointPosition(client, hinge, wait)[1] - 0.05) < 1e-6
    for step in range(40):
        push = 10.0 if step % 4 < 2 else -10.0
        vrep.simxSetJointTargetVelocity(client, rail, push, wait)
        vrep.simxSetJointForce(client, rail, abs(push), wait)
        vrep.simxSynchronousTrigger(client)
    ends.append(vrep.simxGetJointPosition(client, hinge, wait)[1])
    vrep.simxStopSimulation(client, wait)
    vrep.simxGetPingTime(client)
assert len(set(ends)) == 1, ends

vrep.simxFinish(client)
