% Section 4.2, scenes/thesis-flexible: position loop on two ideal motors, a spring behind the second; it is read too.
%
%     sincro serve scenes/thesis-flexible
%     octave-cli --path .. flexible.m

k_pos = 2;
if ~exist('speed', 'var'), speed = []; end                   % [rad/s]: both motors at that speed in place of the loop
SINCRO = start_run({'joint1#', 'joint2#'}, {'joint1#', 'joint2#', 'muelle#'});
q = [0, 0, 0];  peak = 0;
for k = 0:3999
  r = [0.5, -0.3];
  if k >= 2000, r = [0.1, 0.4]; end
  u = k_pos * (r - q(1:2));
  if ~isempty(speed), u = [speed, speed]; end
  q = step(SINCRO, u);
  peak = max(peak, abs(q(3)));
end
stop_run(SINCRO);
fprintf('%.9f %.9f rad, spring %.9f rad, at most %.6f rad\n', q, peak);
if isempty(speed), assert(peak, 0.28615116, 1e-6); elseif speed == 0.5, assert(peak, 0.29027, 1e-5); end
