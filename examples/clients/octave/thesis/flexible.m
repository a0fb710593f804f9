% Section 4.2, scenes/thesis-flexible: position loop on two ideal motors, a spring behind the second; it is read too.
%
%     sincro serve scenes/thesis-flexible
%     octave-cli --path .. flexible.m

k_pos = 2;
SINCRO = start_run({'joint1#', 'joint2#'}, {'joint1#', 'joint2#', 'muelle#'});
q = [0, 0, 0];  peak = 0;
for k = 0:3999
  r = [0.5, -0.3];
  if k >= 2000, r = [0.1, 0.4]; end
  q = step(SINCRO, k_pos * (r - q(1:2)));
  peak = max(peak, abs(q(3)));
end
stop_run(SINCRO);
fprintf('%.9f %.9f rad, spring %.9f rad, at most %.6f rad\n', q, peak);
assert(peak, 0.28615116, 1e-6);
