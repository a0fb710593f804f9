% Section 5.3, scenes/thesis-arm-force: a force on the wall by Hooke's law, without a force sensor.
%
%     sincro serve scenes/thesis-arm-force
%     octave-cli --path .. arm_force.m

if ~exist('F_d', 'var'), F_d = 0.15; end                     % [N]
if ~exist('K', 'var'), K = 10; end                           % of the wall, as the program assumes it [N/m]
start = [0.27, 0.102, -0.25];
p = arm_run(@(k) start + [F_d / K, 0, 0] * (k >= 300), 1500);
force = 10 * (p(end, 1) - start(1));                         % what the spring of the wall, 10 N/m, gives
fprintf('force on the wall %.6f N\n', force);
assert(force, 10 * F_d / K, 5e-5);
