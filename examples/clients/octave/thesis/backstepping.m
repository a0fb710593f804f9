function [T, tau, law] = backstepping(law, gains, goal, position, R, velocity, world_rates)
  % Command-filtered integral backstepping of section 6.3, one sample; equations: scenes/quadrotor-flight-1/README.md.
  %
  % law: memory, or where the vehicle is at the start [m]. gains: structure with Ts [s], m [kg], I [kg m^2], Kp, Kd, Ki, Gamma1, Gamma2.
  % goal, position [m]; R: rotation of the body; velocity [m/s], world_rates [rad/s]: in world axes. T [N], tau [N m, body axes].

  Ts = gains.Ts;  g = 9.81;  Gamma2i = 0.1 * gains.Gamma2;  TOmega = 75;
  if ~isstruct(law)
    z = zeros(3, 1);
    law = struct('y', law(:), 'rate', z, 'xi', z, 'chi2', z, 'xi1', z, 'omega_f', z);
  end
  eta = [atan2(R(3, 2), R(3, 3)); asin(max(-1, min(1, -R(3, 1)))); atan2(R(2, 1), R(1, 1))];
  w = R' * world_rates(:);

  % a = p_c'' + Kd (v_c - v) + Kp (p_c - p) + Ki xi; the reference is filtered at 1 rad/s, critically damped, exactly
  e = law.y - goal(:);  e_p = law.y - position(:);
  a = -e - 2 * law.rate + gains.Kd .* (law.rate - velocity(:)) + gains.Kp .* e_p + gains.Ki .* law.xi;
  law.xi = law.xi + Ts * e_p;
  lead = law.rate + e;
  law.y = goal(:) + exp(-Ts) * (e + Ts * lead);
  law.rate = exp(-Ts) * (law.rate - Ts * lead);

  % thrust, roll and pitch that give a
  s = sin(eta(3));  c = cos(eta(3));
  pitch = atan2(a(1) * c + a(2) * s, g + a(3));
  roll = atan2(-(a(2) * c - a(1) * s) * cos(pitch), g + a(3));
  T = gains.m * (g + a(3)) / (cos(eta(1)) * cos(eta(2)));
  z1 = [max(-0.6, min(0.6, [roll; pitch])); 0] - eta;

  % tau = I (omega_f' + Gamma2 z2 + Gamma2i chi2 + E^-T v1) + omega x I omega
  E = [1, 0, -sin(eta(2)); 0, cos(eta(1)), sin(eta(1)) * cos(eta(2)); 0, -sin(eta(1)), cos(eta(1)) * cos(eta(2))];
  omega_c = E * (gains.Gamma1 .* z1);
  before = law.omega_f;
  law.omega_f = before + (1 - exp(-TOmega * Ts)) * (omega_c - before);
  law.xi1 = law.xi1 - Ts * (gains.Gamma1 .* law.xi1 + E \ (law.omega_f - omega_c));
  z2 = law.omega_f - w;
  demand = (law.omega_f - before) / Ts + gains.Gamma2 .* z2 + Gamma2i .* law.chi2 + E' \ (z1 - law.xi1);
  tau = gains.I .* demand + cross(w, gains.I .* w);
  law.chi2 = law.chi2 + Ts * z2;
end
