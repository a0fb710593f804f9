% Section 3.2.1, scenes/thesis-motor: a step and a ramp of speed; torque over acceleration is the inertia of the link, 1e-12 kg m^2.
%
%     sincro serve scenes/thesis-motor
%     octave-cli --path .. motor.m

h = 0.005;
SINCRO = start_run({'joint1#'}, {'joint1#'});
torque = zeros(1, 300);
for k = 1:300
  t = k - 1;                                                 % of the command, in steps
  if t < 10, u = 0; elseif t < 100, u = 1; else, u = 1 + (t - 100) / 200; end
  [~, torque(k)] = step(SINCRO, u);                          % torque of the step before
end
stop_run(SINCRO);
J = -mean(torque(110:300)) / 1;                              % the API reports minus the effort of the motor; 1 rad/s^2
fprintf('J = %.6g kg m^2\n', J);
assert(J, 1e-12, -1e-5);
assert(-torque(12), 1e-12 / h, -1e-6);                       % the step of speed, in one step
