% Beyond the thesis, scenes/aerial-manipulator-contact-remote: it flies to a wall in wind and presses with 0.15, then 0.25 N; no force sensor.
%
%     sincro serve scenes/aerial-manipulator-contact-remote
%     octave-cli --path .. manipulator_contact.m

K = 10;                                                      % of the wall, as the program assumes it [N/m]
options = struct('n', 3000, 'world', true, 'omega_t', 1, 'clik', 8, 'z_integral', 200, ...
                 'waypoints', [0, 0, 0, 1.5; 1, 0.535, 0, 1.5], 'deeper', [0, 0; 16, 0.15 / K; 36, 0.25 / K]);
p = manipulator_run([0, 0.63, 0, 1.2; 1, 1.165, 0, 1.2; 12, 1.195, 0, 1.2], options);
assert(norm(p(:) - [0.535; 0; 1.5]) < 0.05);
