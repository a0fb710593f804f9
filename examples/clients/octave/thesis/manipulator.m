% Beyond the thesis, scenes/aerial-manipulator-remote: its quadrotor carries its arm; the arm works while the vehicle holds its place.
%
%     sincro serve scenes/aerial-manipulator-remote
%     octave-cli --path .. manipulator.m

p = manipulator_run([0, 0.27, 0.102, -0.25; 5, 0.16, 0.24, -0.18; 14, 0.33, 0, -0.17; 23, 0.12, 0.12, -0.33; 32, 0.27, 0.102, -0.25], struct());
assert(norm(p(:) - [0; 0; 1.5]) < 5e-3);
