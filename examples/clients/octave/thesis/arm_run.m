function p = arm_run(goal, n)
  % n steps of the arm under arm_law, its tip sent to goal(k) [m] from step k = 0 on. Result: places of the object obj, n rows [m].

  motors = {'motor1#', 'motor2#', 'motor3#', 'motor4#'};
  SINCRO = start_run(motors, [motors, {'muelle1#', 'muelle2#', 'muelle3#', 'muelle4#'}]);
  vrep = remApi('remoteApi');  id = SINCRO.id;
  [~, obj] = vrep.simxGetObjectHandle(id, 'obj#', vrep.simx_opmode_blocking);
  q = zeros(1, 8);  p = zeros(n, 3);  law = [];
  for i = 1:8, [~, q(i)] = vrep.simxGetJointPosition(id, SINCRO.joints(i), vrep.simx_opmode_streaming); end
  for k = 0:n - 1
    [u, law] = arm_law(law, q(1:4), q(5:8), goal(k));
    send(vrep, SINCRO, u);
    assert(vrep.simxSynchronousTrigger(id), 0);              % triggered before it is read: no sample of delay
    for i = 1:8, [~, q(i)] = vrep.simxGetJointPosition(id, SINCRO.joints(i), vrep.simx_opmode_buffer); end
    [~, p(k + 1, :)] = vrep.simxGetObjectPosition(id, obj, -1, vrep.simx_opmode_streaming);
  end
  stop_run(SINCRO);
end
