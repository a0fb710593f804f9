% Position control of the arm in scenes/two-dof-remote over the legacy remote API: the thesis's synchronisation recipe, step by step.
%
% For MATLAB and GNU Octave, with remApi.m of this folder or of a V-REP or CoppeliaSim installation in the path:
%
%     sincro serve scenes/two-dof-remote
%     octave-cli two_dof.m

k_pos = 2.03;  goal = [1, -0.5];  duration = 6;  step = 0.005;

vrep = remApi('remoteApi');
vrep.simxFinish(-1);                                         % 1 close what an earlier run has left open
id = vrep.simxStart('127.0.0.1', 19997, true, true, 5000, 1);% 2 connect; the last number is the cycle of the client in ms
assert(id > -1, 'no server: start `sincro serve scenes/two-dof-remote`');

[~, joint(1)] = vrep.simxGetObjectHandle(id, 'shoulder#', vrep.simx_opmode_blocking);
[~, joint(2)] = vrep.simxGetObjectHandle(id, 'elbow#', vrep.simx_opmode_blocking);

vrep.simxSynchronous(id, true);                              % 3 from now on nothing moves without a trigger
vrep.simxStartSimulation(id, vrep.simx_opmode_blocking);     % 4 time is 0

q = [0, 0];
for i = 1:2                                                  % 5 ask once for what is to be streamed, and wait for the first value
  code = 1;
  while code ~= 0
    [code, q(i)] = vrep.simxGetJointPosition(id, joint(i), vrep.simx_opmode_streaming);
  end
end

for k = 1:round(duration / step)
  for i = 1:2                                                % 6 compute and set
    speed = round(1024 * k_pos * (goal(i) - q(i))) / 1024;
    vrep.simxSetJointTargetVelocity(id, joint(i), speed, vrep.simx_opmode_blocking);
  end
  vrep.simxSynchronousTrigger(id);                           % 7 one step: the answer comes when it is done …
  for i = 1:2                                                % 8 … and has brought the values after it
    [~, q(i)] = vrep.simxGetJointPosition(id, joint(i), vrep.simx_opmode_buffer);
  end
end

fprintf('%.9f %.9f rad\n', q);
vrep.simxStopSimulation(id, vrep.simx_opmode_blocking);      % 9 the server writes the run and prints its trace hash
vrep.simxFinish(id);
