# scene: arm
"""The synchronous loop of a position controller: streamed readings, blocking commands, one trigger a step."""

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
_, joint = vrep.simxGetObjectHandle(client, 'joint1', wait)
vrep.simxSetObjectIntParameter(client, joint, vrep.sim_jointintparam_ctrl_enabled, 0, wait)
code, q = vrep.simxGetJointPosition(client, joint, vrep.simx_opmode_streaming)
assert code in (vrep.simx_return_ok, vrep.simx_return_novalue_flag)
for k in range(100):
    code, q = vrep.simxGetJointPosition(client, joint, vrep.simx_opmode_buffer)
    assert code == 0
    vrep.simxSetJointTargetVelocity(client, joint, 2.0 * (0.8 - q), wait)
    vrep.simxSynchronousTrigger(client)
    assert vrep.simxGetLastCmdTime(client) == 50 * (k + 1)
assert abs(q - 0.8) < 1e-3, q
vrep.simxGetJointPosition(client, joint, vrep.simx_opmode_discontinue)
assert vrep.simxGetJointPosition(client, joint, vrep.simx_opmode_buffer)[0] == vrep.simx_return_novalue_flag
vrep.simxStopSimulation(client, wait)

vrep.simxFinish(client)
