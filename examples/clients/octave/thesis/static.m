% Section 3.2.2.1, scenes/thesis-spring: the angle at rest over the stiffness of the spring, which the program sets.
%
%     sincro serve scenes/thesis-spring
%     octave-cli --path .. static.m

for K = [10, 30, 50, 100]
  SINCRO = start_run({}, {'joint1#'});
  vrep = remApi('remoteApi');  id = SINCRO.id;
  assert(vrep.simxSetObjectFloatParameter(id, SINCRO.joints, 2018, K, vrep.simx_opmode_blocking), 0);   % V-REP's parameter of the spring, kc_k
  for k = 1:round(30000 / K)                                 % 15 c/K, c = 10 N m s/rad: longer than 15 time constants
    assert(vrep.simxSynchronousTrigger(id), 0);
  end
  [code, x] = vrep.simxGetJointPosition(id, SINCRO.joints, vrep.simx_opmode_blocking);  assert(code, 0);
  rest = fzero(@(x) K * x + 3.927 * 9.8 * 0.25 * cos(x), -0.3);
  fprintf('K = %3g N m/rad: %.6f rad, from the torque balance %.6f rad\n', K, x, rest);
  assert(x, rest, 1e-6);
  stop_run(SINCRO);
end
