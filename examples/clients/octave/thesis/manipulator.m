% Beyond the thesis, scenes/aerial-manipulator-remote: its quadrotor carries its arm; the arm works while the vehicle holds its place.
%
%     sincro serve scenes/aerial-manipulator-remote
%     octave-cli --path .. manipulator.m

names = {'motor1#', 'motor2#', 'motor3#', 'motor4#'};
joints = [names, {'spring1#', 'spring2#', 'spring3#', 'spring4#'}];
SINCRO = start_run([{'rotor1#', 'rotor2#', 'rotor3#', 'rotor4#'}, names], joints);
vrep = remApi('remoteApi');  id = SINCRO.id;
[code, vehicle] = vrep.simxGetObjectHandle(id, 'vehicle#', vrep.simx_opmode_blocking);  assert(code, 0);
gains = struct('Ts', 0.02, 'm', 10.689, 'I', [0.0856; 0.1416; 0.2012], 'Kp', [9.81; 9.81; 1] .* (2.3 * [0.3; 0.3; 4]), ...
               'Kd', [9.81; 9.81; 1] .* (2 / 3 * [0.4; 0.4; 5]), 'Ki', [9.81; 9.81; 1] .* (0.03 * [1.2; 1.2; 0.05]), ...
               'Gamma1', [8; 8; 1.8], 'Gamma2', [18; 18; 0.9]);
b = 1.9468e-4 / 4;  k_Q = 8.756372e-07;  d = 0.35355339059327373;
base = [0.36; -0.102; -0.05];  place = [0; 0; 1.5];
task = [0, 0.27, 0.102, -0.25; 5, 0.16, 0.24, -0.18; 14, 0.33, 0, -0.17; 23, 0.12, 0.12, -0.33; 32, 0.27, 0.102, -0.25];
goal = task(1, 2:4)';  goal_rate = zeros(3, 1);
flight = place;  arm = [-0.023504; 0; 0; -0.046531];         % where the motors are at the start
q = zeros(8, 1);
for n = 0:1999
  for i = 1:8, [~, q(i)] = vrep.simxGetJointPosition(id, SINCRO.joints(i), vrep.simx_opmode_streaming); end
  [code, p] = vrep.simxGetObjectPosition(id, vehicle, -1, vrep.simx_opmode_streaming);
  [code(2), angles] = vrep.simxGetObjectOrientation(id, vehicle, -1, vrep.simx_opmode_streaming);
  [code(3), v, w] = vrep.simxGetObjectVelocity(id, vehicle, vrep.simx_opmode_streaming);
  assert(all(code == 0));
  R = rotation_of(angles);
  [u, arm] = arm_law(arm, q(1:4), q(5:8), goal);
  [T, tau, flight] = backstepping(flight, gains, place, p, R, v, w);
  [~, ~, g] = stiff_arm(q(1:4) + q(5:8), R' * [0; 0; 1]);    % the arm's weight about the vehicle's origin, in advance
  tau = tau + g(8:10) + cross(base, g(5:7));
  squares = T / (4 * b) + [tau(1) - tau(2); tau(1) + tau(2); tau(2) - tau(1); -tau(1) - tau(2)] / (4 * b * d) + [-1; 1; -1; 1] * tau(3) / (4 * k_Q);
  speeds = round(8192 * sqrt(max(0, min(1200 ^ 2, squares)))) / 8192;
  send(vrep, SINCRO, [speeds; u]);
  assert(vrep.simxSynchronousTrigger(id), 0);
  wanted = task(find(task(:, 1) <= n * 0.02 + 1e-9, 1, 'last'), 2:4)';
  e = goal - wanted;  lead = goal_rate + 1.5 * e;            % the task is filtered at 1.5 rad/s, critically damped
  goal = wanted + exp(-0.03) * (e + 0.02 * lead);
  goal_rate = exp(-0.03) * (goal_rate - 0.03 * lead);
end
stop_run(SINCRO);
fprintf('vehicle %.6f %.6f %.6f m\n', p);
assert(norm(p(:) - place) < 5e-3);
