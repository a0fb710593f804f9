% Section 6.1.2, scenes/propeller-lua: thrust of the propeller's script over the speed of its joint, by the force that holds the stand.
%
%     sincro serve scenes/propeller-lua
%     octave-cli --path .. propeller.m

SINCRO = start_run({'propeller_joint#'}, {'rail#', 'scale#'});
for speed = [300, 450, 600, 750, 900]
  for k = 1:3, [~, torque] = step(SINCRO, speed); end
  b = abs(torque(1)) / speed ^ 2;
  fprintf('%g rad/s: thrust %.5f N, over the square of the speed %.6g N s^2\n', speed, abs(torque(1)), b);
  assert(b, 4.8671168e-5, -1e-6);
end
stop_run(SINCRO);
