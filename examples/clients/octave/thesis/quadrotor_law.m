function [speeds, law] = quadrotor_law(law, goal, position, orientation, velocity, world_rates)
  % Command-filtered integral backstepping of section 6.3, one sample; equations: scenes/quadrotor-flight-1/README.md.
  %
  % law: memory, [] at the start. goal, position [m]; orientation: Euler angles of CambioEje (forward, right, down), R = Rx Ry Rz [rad];
  % velocity [m/s], world_rates [rad/s]: in world axes. speeds: of the four motors [rad/s].

  Ts = 0.05;  g = 9.81;  m = 10.305;  l = 0.5;  b = 1.9468e-4 / 4;  k = 9.841743337582103e-5;
  Kp = 2.3 * [0.3; 0.3; 4];  Kd = 2 / 3 * [0.4; 0.4; 5];  Ki = 0.03 * [1.2; 1.2; 0.05];
  Gamma1 = 8 * [2; 2; 0.9];  Gamma2 = 9 * [4; 4; 2];  Gamma2i = 0.1 * Gamma2;  TOmega = 75;
  I = 9.5 * [2.643e-3; 2.643e-3; 1.525e-2];
  if isempty(law)
    z = zeros(3, 1);
    law = struct('y', z, 'rate', z, 'xi', z, 'chi2', z, 'xi1', z, 'omega_f', z);
  end
  R = euler(orientation) * diag([1, -1, -1]);                % of the body
  eta = [atan2(R(3, 2), R(3, 3)); asin(max(-1, min(1, -R(3, 1)))); atan2(R(2, 1), R(1, 1))];
  w = R' * world_rates(:);

  % a = p_c'' + Kd (v_c - v) + Kp (p_c - p) + Ki xi; the reference is filtered at 1 rad/s, critically damped, exactly
  e = law.y - goal(:);  e_p = law.y - position(:);
  a = -e - 2 * law.rate + Kd .* (law.rate - velocity(:)) + Kp .* e_p + Ki .* law.xi;
  law.xi = law.xi + Ts * e_p;
  lead = law.rate + e;
  law.y = goal(:) + exp(-Ts) * (e + Ts * lead);
  law.rate = exp(-Ts) * (law.rate - Ts * lead);

  % thrust, roll and pitch that give a
  s = sin(eta(3));  c = cos(eta(3));
  pitch = atan2(a(1) * c + a(2) * s, g + a(3));
  roll = atan2(-(a(2) * c - a(1) * s) * cos(pitch), g + a(3));
  T = m * (g + a(3)) / (cos(eta(1)) * cos(eta(2)));
  z1 = [max(-0.6, min(0.6, [roll; pitch])); 0] - eta;

  % tau = I (omega_f' + Gamma2 z2 + Gamma2i chi2 + E^-T v1) + omega x I omega
  E = [1, 0, -sin(eta(2)); 0, cos(eta(1)), sin(eta(1)) * cos(eta(2)); 0, -sin(eta(1)), cos(eta(1)) * cos(eta(2))];
  omega_c = E * (Gamma1 .* z1);
  before = law.omega_f;
  law.omega_f = before + (1 - exp(-TOmega * Ts)) * (omega_c - before);
  law.xi1 = law.xi1 - Ts * (Gamma1 .* law.xi1 + E \ (law.omega_f - omega_c));
  z2 = law.omega_f - w;
  tau = I .* ((law.omega_f - before) / Ts + Gamma2 .* z2 + Gamma2i .* law.chi2 + E' \ (z1 - law.xi1)) + cross(w, I .* w);
  law.chi2 = law.chi2 + Ts * z2;

  % rotors 1 (+x), 2 (+y), 3 (-x), 4 (-y)
  squares = T / (4 * b) + [-tau(2); tau(1); tau(2); -tau(1)] / (2 * b * l) + [-1; 1; -1; 1] * tau(3) / (4 * k);
  speeds = round(8192 * sqrt(max(0, min(1200 ^ 2, squares)))) / 8192;   % single precision carries it
end

function R = euler(angles)
  a = angles(1);  b = angles(2);  c = angles(3);
  R = [1, 0, 0; 0, cos(a), -sin(a); 0, sin(a), cos(a)] * [cos(b), 0, sin(b); 0, 1, 0; -sin(b), 0, cos(b)] * [cos(c), -sin(c), 0; sin(c), cos(c), 0; 0, 0, 1];
end
