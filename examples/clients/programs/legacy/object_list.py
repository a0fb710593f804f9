# scene: arm
"""Lists the objects of the scene, by type and by their tree, and says hello."""

import sys
import pathlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import simx as vrep  # noqa: E402

vrep.simxFinish(-1)
client = vrep.simxStart("127.0.0.1", int(sys.argv[1]), True, True, 5000, 5)
assert client != -1, "no connection"
wait = vrep.simx_opmode_blocking

code, objects = vrep.simxGetObjects(client, vrep.sim_handle_all, wait)
assert code == vrep.simx_return_ok and len(objects) > 10, objects
code, joints = vrep.simxGetObjects(client, vrep.sim_object_joint_type, wait)
assert code == 0 and len(joints) == 3, joints
code, base = vrep.simxGetObjectHandle(client, 'base', wait)
assert vrep.simxGetObjectParent(client, base, wait) == (0, -1)
assert vrep.simxGetObjectChild(client, base, 0, wait) == (0, joints[0])
code, nothing = vrep.simxGetObjectHandle(client, 'no_such_object', wait)
assert code == vrep.simx_return_remote_error_flag and nothing == -1
assert 'no_such_object' in vrep.simxGetLastErrors(client, wait)[1][0]
vrep.simxAddStatusbarMessage(client, 'Hello!', vrep.simx_opmode_oneshot)
assert vrep.simxGetPingTime(client)[0] == 0

vrep.simxFinish(client)
