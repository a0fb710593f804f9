% Section 3.2.2, scenes/thesis-spring: the rod falls onto its spring; nothing is commanded.
%
%     sincro serve scenes/thesis-spring
%     octave-cli --path .. rod.m

SINCRO = start_run({}, {'joint1#'});
x = zeros(1, 600);
for k = 1:600
  x(k) = step(SINCRO, []);
end
stop_run(SINCRO);
x_ss = fzero(@(x) 30 * x + 3.927 * 9.8 * 0.25 * cos(x), -0.3);   % torque balance at rest
fprintf('x(0.5 s) = %.6f rad, x(3 s) = %.6f rad, rest %.6f rad\n', x(101), x(600), x_ss);
assert(x(101), -0.248737892, 1e-7);
assert(x(600), x_ss, 1e-4);
