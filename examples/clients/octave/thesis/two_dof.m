% Section 4.1, scenes/thesis-two-dof: position loop on two ideal motors, one sample late.
%
%     sincro serve scenes/thesis-two-dof
%     octave-cli --path .. two_dof.m

k_pos = 2;
SINCRO = start_run({'joint1#', 'joint2#'}, {'joint1#', 'joint2#'});
q = [0, 0];
for k = 0:1599
  r = [1, -0.5];
  if k >= 800, r = [0.2, 0.8]; end
  q = step(SINCRO, k_pos * (r - q));
end
stop_run(SINCRO);
fprintf('%.9f %.9f rad\n', q);
assert(q, r, 1e-3);
