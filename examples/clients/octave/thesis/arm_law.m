function [u, law] = arm_law(law, gamma, delta, goal, times)
  % Adaptive compliant inverse kinematics of sections 5.2 and 5.3, one sample; equations: scenes/alexandros-position/README.md.
  %
  % law: memory, [] at the start, or where the motors are then [rad]. gamma, delta: angles of motors and springs [rad]; goal: where the
  % tip is to go [m]; times: factor of Kp, 1 unless given. u: speeds [rad/s].

  Ts = 0.02;  Gamma = 800 * [10; 10; 0.1; 1; 1; 1; 0.1; 1];  Kp = 40 * [0.75; 0.8; 0.9; 0.55];  Ks = 0.32 * [1; 0.8; 0.7; 0.9];
  lambda = 0.5;  maxgdot = 5;
  if nargin < 5, times = 1; end
  if ~isstruct(law)
    start = zeros(4, 1);
    if ~isempty(law), start = law(:); end
    law = struct('q_r', zeros(4, 1), 'before', zeros(4, 1), 'wanted', start, 'theta', [0; 0; 0; 0; 1 / 3; 1 / 2; 1; 1 / 1.5]);
  end
  limited = @(x) max(-maxgdot, min(maxgdot, x));
  q = gamma(:) + delta(:);

  [~, ~, g] = stiff_arm(q);  g = g(1:4);                     % deflection q = gamma + Phi theta, Phi = [I, -diag(g)]
  x = (q - law.before) ./ (1 + Gamma(1:4) + Gamma(5:8) .* g .^ 2);
  law.theta = law.theta + lambda * Ts * [Gamma(1:4) .* x; -Gamma(5:8) .* g .* x];
  assert(law.theta' * law.theta < 6, 'the projection onto the ellipsoid is not written here: it is never needed in these experiments');

  wanted = law.q_r - (law.theta(1:4) - g .* law.theta(5:8)); % where the motors must be
  u = limited((wanted - law.wanted) / Ts + Ks / Ts .* (law.wanted - gamma(:)));
  law.wanted = wanted;  law.before = law.q_r;

  [tip, J] = stiff_arm(law.q_r);                             % transpose inverse kinematics
  law.q_r = law.q_r + Ts * limited(times * Kp .* (J' * (goal(:) - tip)));
  u = round(65536 * u) / 65536;                              % single precision carries it
end
