function [tip, J, g] = stiff_arm(q, up)
  % Tip [m], its Jacobian [m], and what carries the weight, of the arm with straight springs, in the axes of its base.
  %
  % q: angles of the joints [rad]; up: direction against gravity, [0; 0; 1] unless given. g: torques of the joints [N m], then the force
  % [N] and the moment about the base [N m] that the base must give.

  if nargin < 2, up = [0; 0; 1]; end
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
  g = zeros(10, 1);
  for i = 1:4
    J(:, i) = cross(axis(:, i), tip - origin(:, i));
    weight = masses(i) * 9.81 * up;
    for n = 1:i
      g(n) = g(n) + cross(axis(:, n), middle(:, i) - origin(:, n))' * weight;
    end
    g(5:10) = g(5:10) + [weight; cross(middle(:, i), weight)];
  end
end

function R = turn(a, angle)
  K = [0, -a(3), a(2); a(3), 0, -a(1); -a(2), a(1), 0];
  R = eye(3) + sin(angle) * K + (1 - cos(angle)) * K * K;
end
