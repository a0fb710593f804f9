% Calls remApi's functions against scenes/two-dof-remote on port 19997, without a run: check.py starts the server.

vrep = remApi('remoteApi');
vrep.simxFinish(-1);
assert(vrep.simxStart('127.0.0.1', 9, true, true, 1000, 5), -1);
id = vrep.simxStart('127.0.0.1', 19997, true, true, 5000, 5);
assert(id > -1 && vrep.simxGetConnectionId(id) ~= -1);
wait = vrep.simx_opmode_blocking;

% objects, by names and paths; another object of the class has the same connections
[code, shoulder] = vrep.simxGetObjectHandle(id, 'shoulder#', wait);  assert(code, 0);
again = remApi('remoteApi');
[code, elbow] = again.simxGetObjectHandle(id, '/shoulder/elbow', wait);  assert(code, 0);
[code, joints] = vrep.simxGetObjects(id, vrep.sim_object_joint_type, wait);
assert(code == 0 && all(ismember([shoulder, elbow], joints)));
[code, none] = vrep.simxGetObjectHandle(id, 'nothing', wait);  assert([code, none], [8, -1]);
[~, errors] = vrep.simxGetLastErrors(id, wait);  assert(~isempty(strfind(errors{1}, 'nothing')));
[code, parent] = vrep.simxGetObjectParent(id, shoulder, wait);  assert([code, parent], [0, -1]);
[~, child] = vrep.simxGetObjectChild(id, shoulder, 0, wait);
[~, parent] = vrep.simxGetObjectParent(id, child, wait);  assert(parent, shoulder);

% poses: a point that is put somewhere is there
[code, point] = vrep.simxCreateDummy(id, 0.01, [], wait);  assert(code, 0);
assert(vrep.simxSetObjectPosition(id, point, -1, [1, 2, 3], wait), 0);
assert(vrep.simxSetObjectOrientation(id, point, -1, [0.1, 0.2, 0.3], wait), 0);
[~, p] = vrep.simxGetObjectPosition(id, point, -1, wait);  assert(p, [1, 2, 3]);
[~, angles] = vrep.simxGetObjectOrientation(id, point, -1, wait);  assert(angles, [0.1, 0.2, 0.3], 1e-6);
assert(vrep.simxSetObjectQuaternion(id, point, -1, [0, 0, 1, 0], wait), 0);
[~, q] = vrep.simxGetObjectQuaternion(id, point, -1, wait);  assert(abs(q), [0, 0, 1, 0], 1e-6);
[code, v, w] = vrep.simxGetObjectVelocity(id, elbow, wait);  assert(code == 0 && all([v, w] == 0));
assert(vrep.simxSetObjectParent(id, point, elbow, true, wait), 0);
assert(vrep.simxRemoveObject(id, point, wait), 0);

% joints
assert(vrep.simxSetJointPosition(id, shoulder, 0.5, wait), 0);
[code, x] = vrep.simxGetJointPosition(id, shoulder, wait);  assert([code, x], [0, 0.5]);
assert(vrep.simxSetJointPosition(id, shoulder, 0, wait), 0);
[code, m] = vrep.simxGetJointMatrix(id, elbow, wait);  assert(code == 0 && numel(m) == 12);
[code, x] = vrep.simxGetObjectFloatParameter(id, elbow, vrep.sim_jointfloatparam_velocity, wait);  assert([code, x], [0, 0]);

% signals and parameters
assert(vrep.simxSetFloatSignal(id, 'height', 1.5, wait), 0);
[code, x] = vrep.simxGetFloatSignal(id, 'height', wait);  assert([code, x], [0, 1.5]);
assert(vrep.simxClearFloatSignal(id, 'height', wait), 0);
assert(vrep.simxGetFloatSignal(id, 'height', wait), 8);
vrep.simxSetIntegerSignal(id, 'count', -7, wait);
[~, x] = vrep.simxGetIntegerSignal(id, 'count', wait);  assert(x, -7);
vrep.simxClearIntegerSignal(id, 'count', wait);
long = char(repmat('0123456789', 1, 1000));                  % many packets
vrep.simxSetStringSignal(id, 'text', long, wait);
[~, x] = vrep.simxGetStringSignal(id, 'text', wait);  assert(x, long);
vrep.simxClearStringSignal(id, 'text', wait);
[code, dt] = vrep.simxGetFloatingParameter(id, vrep.sim_floatparam_simulation_time_step, wait);  assert([code, dt], [0, 0.005], 1e-8);
[code, g] = vrep.simxGetArrayParameter(id, vrep.sim_arrayparam_gravity, wait);  assert(code == 0 && numel(g) == 3);
[code, version] = vrep.simxGetIntegerParameter(id, vrep.sim_intparam_program_version, wait);  assert(code == 0 && version > 30000);
assert(vrep.simxAddStatusbarMessage(id, 'hello', wait), 0);
[code, ms] = vrep.simxGetPingTime(id);  assert(code == 0 && ms >= 0);

% commands that are held back go together
assert(vrep.simxPauseCommunication(id, true), 0);
vrep.simxSetFloatSignal(id, 'a', 1, vrep.simx_opmode_oneshot);
vrep.simxSetFloatSignal(id, 'b', 2, vrep.simx_opmode_oneshot);
assert(vrep.simxPauseCommunication(id, false), 0);
[~, x] = vrep.simxGetFloatSignal(id, 'b', wait);  assert(x, 2);
vrep.simxClearFloatSignal(id, 'a', wait);  vrep.simxClearFloatSignal(id, 'b', wait);

% streams, until they are ended
[code, ~] = vrep.simxGetJointPosition(id, elbow, vrep.simx_opmode_streaming);  assert(code, 0);
[code, ~] = vrep.simxGetJointPosition(id, elbow, vrep.simx_opmode_buffer);  assert(code, 0);
assert(vrep.simxGetJointPosition(id, elbow, vrep.simx_opmode_discontinue), 0);
assert(vrep.simxGetJointPosition(id, elbow, vrep.simx_opmode_buffer), 1);

vrep.simxFinish(id);
assert(vrep.simxGetJointPosition(id, elbow, wait), 64);
