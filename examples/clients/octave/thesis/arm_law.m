function [u, law] = arm_law(law, gamma, delta, goal)
  % Adaptive compliant inverse kinematics of sections 5.2 and 5.3, one sample; equations: scenes/alexandros-position/README.md.
  %
  % law: memory, [] at the start. gamma, delta: angles of motors and springs [rad]; goal: where the tip is to go [m]. u: speeds [rad/s].

  Ts = 0.02;  Gamma = 800 * [10; 10; 0.1; 1; 1; 1; 0.1; 1];  Kp = 40 * [0.75; 0.8; 0.9; 0.55];  Ks = 0.32 * [1; 0.8; 0.7; 0.9];
  lambda = 0.5;  maxgdot = 5;
  if isempty(law)
    law = struct('q_r', zeros(4, 1), 'before', zeros(4, 1), 'wanted', zeros(4, 1), 'theta', [0; 0; 0; 0; 1 / 3; 1 / 2; 1; 1 / 1.5]);
  end
  limited = @(x) max(-maxgdot, min(maxgdot, x));
  q = gamma(:) + delta(:);

  [~, ~, g] = stiff_arm(q);                                  % deflection q = gamma + Phi theta, Phi = [I, -diag(g)]
  x = (q - law.before) ./ (1 + Gamma(1:4) + Gamma(5:8) .* g .^ 2);
  law.theta = law.theta + lambda * Ts * [Gamma(1:4) .* x; -Gamma(5:8) .* g .* x];
  assert(law.theta' * law.theta < 6, 'the projection onto the ellipsoid is not written here: it is never needed in these experiments');

  wanted = law.q_r - (law.theta(1:4) - g .* law.theta(5:8)); % where the motors must be
  u = limited((wanted - law.wanted) / Ts + Ks / Ts .* (law.wanted - gamma(:)));
  law.wanted = wanted;  law.before = law.q_r;

  [tip, J] = stiff_arm(law.q_r);                             % transpose inverse kinematics
  law.q_r = law.q_r + Ts * limited(Kp .* (J' * (goal(:) - tip)));
  u = round(65536 * u) / 65536;                              % single precision carries it
end

function [tip, J, g] = stiff_arm(q)
  % Tip [m], its Jacobian [m], and the torques that carry the weight [N m], of the arm with straight springs.
  axes = [0, 1, 0; 1, 0, 0; 0, 0, 1; 0, 1, 0]';              % modeR = [2 1 3 2]
  links = [0, 0.102, 0; 0, 0, -0.125; 0, 0, -0.125; 0.27, 0, 0]';
  masses = [0.101, 0.121, 0.11, 0.052];
  R = eye(3);  tip = zeros(3, 1);
  for i = 1:4
    origin(:, i) = tip;  axis(:, i) = R * axes(:, i);
    R = R * turn(axes(:, i), q(i));
    middle(:, i) = tip + R * links(:, i) / 2;
    tip = tip + R * links(:, i);
  end
  g = zeros(4, 1);
  for i = 1:4
    J(:, i) = cross(axis(:, i), tip - origin(:, i));
    for n = i:4
      lever = cross(axis(:, i), middle(:, n) - origin(:, i));
      g(i) = g(i) + masses(n) * 9.81 * lever(3);
    end
  end
end

function R = turn(a, angle)
  K = [0, -a(3), a(2); a(3), 0, -a(1); -a(2), a(1), 0];
  R = eye(3) + sin(angle) * K + (1 - cos(angle)) * K * K;
end
