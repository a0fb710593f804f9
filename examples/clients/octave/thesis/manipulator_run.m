function p = manipulator_run(task, options)
  % Flies the aerial manipulator of scenes/aerial-manipulator-hover under backstepping and arm_law; the arm's weight is known in advance.
  %
  % task: where the tip is to be, rows of a time [s] and a place [m] that stands from then on. options: structure with any of
  %   n            steps of 20 ms                                          waypoints    of the vehicle, rows like those of task
  %   world        true: task in the world; false: axes of the arm's base   deeper       rows of a time [s] and a depth along x [m]
  %   omega_t      filter of the task [rad/s]                              gripper      rows of a time [s], speed of the left finger [m/s]
  %   clik         factor of Kp of the inverse kinematics                               and force of the right one [N]
  %   z_integral   factor of Ki of the height
  % p: place of the vehicle at the last sample [m].

  o = struct('n', 2000, 'world', false, 'omega_t', 1.5, 'clik', 1, 'z_integral', 1, 'waypoints', [0, 0, 0, 1.5], 'deeper', [0, 0], 'gripper', []);
  names = fieldnames(options);
  for i = 1:numel(names), o.(names{i}) = options.(names{i}); end

  motors = {'motor1#', 'motor2#', 'motor3#', 'motor4#'};
  joints = [motors, {'spring1#', 'spring2#', 'spring3#', 'spring4#'}];
  SINCRO = start_run([{'rotor1#', 'rotor2#', 'rotor3#', 'rotor4#'}, motors], joints);
  vrep = remApi('remoteApi');  id = SINCRO.id;  Ts = 0.02;
  [code, vehicle] = vrep.simxGetObjectHandle(id, 'vehicle#', vrep.simx_opmode_blocking);  assert(code, 0);
  if ~isempty(o.gripper)
    [code, left] = vrep.simxGetObjectHandle(id, 'left#', vrep.simx_opmode_blocking);  assert(code, 0);
    [code, right] = vrep.simxGetObjectHandle(id, 'right#', vrep.simx_opmode_blocking);  assert(code, 0);
  end
  gains = struct('Ts', Ts, 'm', 10.689, 'I', [0.0856; 0.1416; 0.2012], 'Kp', [9.81; 9.81; 1] .* (2.3 * [0.3; 0.3; 4]), ...
                 'Kd', [9.81; 9.81; 1] .* (2 / 3 * [0.4; 0.4; 5]), 'Ki', [9.81; 9.81; o.z_integral] .* (0.03 * [1.2; 1.2; 0.05]), ...
                 'Gamma1', [8; 8; 1.8], 'Gamma2', [18; 18; 0.9]);
  b = 1.9468e-4 / 4;  k_Q = 8.756372e-07;  d = 0.35355339059327373;  base = [0.36; -0.102; -0.05];
  goal = task(1, 2:4)';  goal_rate = zeros(3, 1);
  flight = o.waypoints(1, 2:4)';  arm = [-0.023504; 0; 0; -0.046531];   % where vehicle and motors are at the start
  q = zeros(8, 1);
  for n = 0:o.n - 1
    now = @(rows) rows(find(rows(:, 1) <= n * Ts + 1e-9, 1, 'last'), 2:end)';
    for i = 1:8, [~, q(i)] = vrep.simxGetJointPosition(id, SINCRO.joints(i), vrep.simx_opmode_streaming); end
    [code, p] = vrep.simxGetObjectPosition(id, vehicle, -1, vrep.simx_opmode_streaming);
    [code(2), angles] = vrep.simxGetObjectOrientation(id, vehicle, -1, vrep.simx_opmode_streaming);
    [code(3), v, w] = vrep.simxGetObjectVelocity(id, vehicle, vrep.simx_opmode_streaming);
    assert(all(code == 0));
    R = rotation_of(angles);
    target = goal;
    if o.world, target = R' * (goal - p(:)) - base; end
    [u, arm] = arm_law(arm, q(1:4), q(5:8), target, o.clik);
    [T, tau, flight] = backstepping(flight, gains, now(o.waypoints), p, R, v, w);
    [~, ~, g] = stiff_arm(q(1:4) + q(5:8), R' * [0; 0; 1]);  % the arm's weight about the vehicle's origin, in advance
    tau = tau + g(8:10) + cross(base, g(5:7));
    squares = T / (4 * b) + [tau(1) - tau(2); tau(1) + tau(2); tau(2) - tau(1); -tau(1) - tau(2)] / (4 * b * d) + [-1; 1; -1; 1] * tau(3) / (4 * k_Q);
    speeds = round(8192 * sqrt(max(0, min(1200 ^ 2, squares)))) / 8192;
    send(vrep, SINCRO, [speeds; u]);
    if ~isempty(o.gripper)                                   % a force has the direction of the target velocity, as in V-REP
      finger = now(o.gripper);
      vrep.simxPauseCommunication(id, true);
      vrep.simxSetJointTargetVelocity(id, left, finger(1), vrep.simx_opmode_oneshot);
      vrep.simxSetJointTargetVelocity(id, right, sign(finger(2)), vrep.simx_opmode_oneshot);
      vrep.simxSetJointForce(id, right, abs(finger(2)), vrep.simx_opmode_oneshot);
      vrep.simxPauseCommunication(id, false);
    end
    assert(vrep.simxSynchronousTrigger(id), 0);
    e = goal - now(task) - [now(o.deeper); 0; 0];  lead = goal_rate + o.omega_t * e;   % the task's filter, critically damped
    decay = exp(-o.omega_t * Ts);
    goal = goal - e + decay * (e + Ts * lead);
    goal_rate = decay * (goal_rate - o.omega_t * Ts * lead);
  end
  stop_run(SINCRO);
  fprintf('vehicle %.6f %.6f %.6f m\n', p);
end
