# scene: table
"""Reads and sets parameters of the simulator: version, time step, gravity; a ball falls on the moon."""

import sys
import pathlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import simx as vrep  # noqa: E402

vrep.simxFinish(-1)
client = vrep.simxStart("127.0.0.1", int(sys.argv[1]), True, True, 5000, 5)
assert client != -1, "no connection"
wait = vrep.simx_opmode_blocking

code, version = vrep.simxGetIntegerParameter(client, vrep.sim_intparam_program_version, wait)
assert code == 0 and version > 30000
code, dt = vrep.simxGetFloatingParameter(client, vrep.sim_floatparam_simulation_time_step, wait)
assert code == 0 and abs(dt - 0.01) < 1e-6
vrep.simxSetBooleanParameter(client, vrep.sim_boolparam_display_enabled, False, wait)
assert vrep.simxSetFloatingParameter(client, vrep.sim_floatparam_simulation_time_step, 0.02, wait) == 0
assert vrep.simxSetArrayParameter(client, vrep.sim_arrayparam_gravity, [0, 0, -1.62], wait) == 0
assert abs(vrep.simxGetArrayParameter(client, vrep.sim_arrayparam_gravity, wait)[1][2] + 1.62) < 1e-6
_, brick = vrep.simxGetObjectHandle(client, 'brick', wait)
vrep.simxSynchronous(client, True)
vrep.simxStartSimulation(client, wait)
_, before = vrep.simxGetObjectPosition(client, brick, -1, wait)
for _ in range(25):
    vrep.simxSynchronousTrigger(client)
_, after = vrep.simxGetObjectPosition(client, brick, -1, wait)
assert abs(before[2] - after[2] - 0.5 * 1.62 * 0.25) < 1e-4, (before, after)
vrep.simxStopSimulation(client, wait)

vrep.simxFinish(client)
