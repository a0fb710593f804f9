# scene: arm
"""Signals between a program and scripts: numbers, packed floats, a stream of text."""

import sys
import pathlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import simx as vrep  # noqa: E402

vrep.simxFinish(-1)
client = vrep.simxStart("127.0.0.1", int(sys.argv[1]), True, True, 5000, 5)
assert client != -1, "no connection"
wait = vrep.simx_opmode_blocking

assert vrep.simxGetFloatSignal(client, 'unset', wait)[0] == vrep.simx_return_remote_error_flag
vrep.simxSetIntegerSignal(client, 'mode', 3, wait)
vrep.simxSetFloatSignal(client, 'speed', 1.5, wait)
vrep.simxSetStringSignal(client, 'table', vrep.simxPackFloats([1.0, 2.5, -3.0]), wait)
assert vrep.simxGetIntegerSignal(client, 'mode', wait) == (0, 3)
assert vrep.simxGetFloatSignal(client, 'speed', wait) == (0, 1.5)
code, packed = vrep.simxGetStringSignal(client, 'table', wait)
assert vrep.simxUnpackFloats(packed) == [1.0, 2.5, -3.0]
vrep.simxAppendStringSignal(client, 'stream', b'one ', wait)
vrep.simxAppendStringSignal(client, 'stream', b'two', wait)
assert vrep.simxReadStringStream(client, 'stream', wait) == (0, b'one two')
assert vrep.simxReadStringStream(client, 'stream', wait) == (0, b'')
vrep.simxClearFloatSignal(client, 'speed', wait)
assert vrep.simxGetFloatSignal(client, 'speed', wait)[0] == 8
vrep.simxSynchronous(client, True)
vrep.simxStartSimulation(client, wait)
vrep.simxGetIntegerSignal(client, 'steps', vrep.simx_opmode_streaming)
for k in range(10):
    vrep.simxSynchronousTrigger(client)
    assert vrep.simxGetIntegerSignal(client, 'steps', vrep.simx_opmode_buffer) == (0, k + 1)
assert abs(vrep.simxGetFloatSignal(client, 'time', wait)[1] - 0.45) < 1e-6
vrep.simxStopSimulation(client, wait)

vrep.simxFinish(client)
