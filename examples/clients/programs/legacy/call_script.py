# scene: arm
"""Calls a function of a child script with whole numbers, numbers, texts and bytes."""

import sys
import pathlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import simx as vrep  # noqa: E402

vrep.simxFinish(-1)
client = vrep.simxStart("127.0.0.1", int(sys.argv[1]), True, True, 5000, 5)
assert client != -1, "no connection"
wait = vrep.simx_opmode_blocking

vrep.simxStartSimulation(client, wait)
code, ints, floats, strings, data = vrep.simxCallScriptFunction(
    client, 'base', vrep.sim_scripttype_childscript, 'sum', [1, 2, 3], [0.5, 0.25], ['words'], b'\x01\x02', wait)
assert code == 0 and ints == [3, 2] and floats == [6.75] and strings == ['got words'] and data == b'\x01\x02', (code, ints, floats)
code, *_ = vrep.simxCallScriptFunction(client, 'base', vrep.sim_scripttype_childscript, 'missing', [], [], [], b'', wait)
assert code == vrep.simx_return_remote_error_flag
vrep.simxStopSimulation(client, wait)

vrep.simxFinish(client)
