function SINCRO = start_run(motors, joints)
  % Connects to the server and starts a run in synchronous mode, with the calls of the thesis's programs in their order.
  %
  % motors, joints: names of the joints that are commanded and of those that are read, as in the scene. Result: the structure that
  % step.m and stop_run.m take: the connection and the handles.

  port = 19997;                                              % V-REP's; another one in the environment
  if ~isempty(getenv('SINCRO_PORT')), port = str2double(getenv('SINCRO_PORT')); end
  vrep = remApi('remoteApi');
  vrep.simxFinish(-1);                                       % close what an earlier program has left open
  id = vrep.simxStart('127.0.0.1', port, true, true, 5000, 5);
  assert(id > -1, 'no server: start `sincro serve SCENE`');
  vrep.simxSynchronous(id, true);                            % nothing moves without a trigger
  vrep.simxStartSimulation(id, vrep.simx_opmode_blocking);   % time is 0
  SINCRO = struct('id', id, 'motors', handles(vrep, id, motors), 'joints', handles(vrep, id, joints));
end

function found = handles(vrep, id, names)
  found = zeros(1, numel(names));
  for i = 1:numel(names)
    [code, found(i)] = vrep.simxGetObjectHandle(id, names{i}, vrep.simx_opmode_blocking);
    assert(code, 0);
  end
end
