function [speeds, law] = quadrotor_law(law, goal, position, orientation, velocity, world_rates)
  % Speeds of the four motors of the thesis's quadrotor [rad/s], one sample of backstepping.m with its gains.
  %
  % law: memory, [] at the start. goal, position [m]; orientation: Euler angles of CambioEje (forward, right, down) [rad]; velocity
  % [m/s], world_rates [rad/s]: in world axes.

  l = 0.5;  b = 1.9468e-4 / 4;  k = 9.841743337582103e-5;
  gains = struct('Ts', 0.05, 'm', 10.305, 'I', 9.5 * [2.643e-3; 2.643e-3; 1.525e-2], 'Kp', 2.3 * [0.3; 0.3; 4], ...
                 'Kd', 2 / 3 * [0.4; 0.4; 5], 'Ki', 0.03 * [1.2; 1.2; 0.05], 'Gamma1', 8 * [2; 2; 0.9], 'Gamma2', 9 * [4; 4; 2]);
  if isempty(law), law = zeros(3, 1); end
  R = rotation_of(orientation) * diag([1, -1, -1]);          % of the body
  [T, tau, law] = backstepping(law, gains, goal, position, R, velocity, world_rates);

  % rotors 1 (+x), 2 (+y), 3 (-x), 4 (-y)
  squares = T / (4 * b) + [-tau(2); tau(1); tau(2); -tau(1)] / (2 * b * l) + [-1; 1; -1; 1] * tau(3) / (4 * k);
  speeds = round(8192 * sqrt(max(0, min(1200 ^ 2, squares)))) / 8192;   % single precision carries it
end
