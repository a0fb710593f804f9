% Section 6.1.1, scenes/stock-propeller: acceleration of the pod over the velocity of the particles; the slope is the thrust of 1 m/s.
%
%     sincro serve scenes/stock-propeller
%     octave-cli --path .. stock_propeller.m

velocities = [10, 20, 30, 40];  a = zeros(size(velocities));
for i = 1:numel(velocities)
  SINCRO = start_run({'propeller#'}, {'rail#'});
  for k = 1:20, send(remApi('remoteApi'), SINCRO, velocities(i)); step(SINCRO, []); end   % 1 s: 430 particles
  vrep = remApi('remoteApi');
  [code, v] = vrep.simxGetObjectFloatParameter(SINCRO.id, SINCRO.joints, vrep.sim_jointfloatparam_velocity, vrep.simx_opmode_blocking);
  assert(code, 0);
  a(i) = v + 9.81;                                           % of the mass of 1 kg, without gravity, over 1 s
  stop_run(SINCRO);
end
slope = polyfit(velocities, a, 1);
fprintf('slope %.6f N/(m/s), intercept %.2g N\n', slope);
assert(slope(1), 0.239219191, -1e-5);
