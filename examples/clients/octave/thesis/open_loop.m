% Section 6.2, scenes/thesis-quadrotor: all motors at 750 rad/s; the force sensor between a propeller and the body is read.
%
%     sincro serve scenes/thesis-quadrotor
%     octave-cli --path .. open_loop.m

SINCRO = start_run({'Motor#', 'Motor#0', 'Motor#1', 'Motor#2'}, {});
vrep = remApi('remoteApi');  id = SINCRO.id;
[~, body] = vrep.simxGetObjectHandle(id, 'quadrotor#', vrep.simx_opmode_blocking);
[~, sensor] = vrep.simxGetObjectHandle(id, 'sensor1#', vrep.simx_opmode_blocking);
for k = 1:120
  send(vrep, SINCRO, 750 * [1, 1, 1, 1]);
  assert(vrep.simxSynchronousTrigger(id), 0);
  [~, p] = vrep.simxGetObjectPosition(id, body, -1, vrep.simx_opmode_streaming);
  [~, ~, force] = vrep.simxReadForceSensor(id, sensor, vrep.simx_opmode_streaming);
end
stop_run(SINCRO);
fprintf('height %.6f m, force of a propeller on the body %.4f N\n', p(3), force(3));
assert(p(3), 6.0445, 1e-4);
