% Beyond the thesis, scenes/aerial-manipulator-grasp-remote: it takes a box from a shelf and puts it down 0.3 m beside.
%
%     sincro serve scenes/aerial-manipulator-grasp-remote
%     octave-cli --path .. manipulator_grasp.m

speed = 1 / 256;  force = 15 / 32;                           % of the fingers [m/s], [N]
options = struct('n', 2500, 'world', true, 'omega_t', 1, 'clik', 1.75, 'z_integral', 200, ...
                 'waypoints', [0, 0, 0, 1.5; 1, 0.3, 0, 1.5; 22, 0.3, 0.3, 1.5], ...
                 'gripper', [0, 0, -force / 2; 14, speed, force; 16.56, 0, force; 40, -speed, -force / 2; 42.56, 0, -force / 2]);
task = [0, 0.63, 0, 1.2; 1, 0.86, 0, 1.2; 8, 0.93, 0, 1.2; 17, 0.93, 0, 1.26; 22, 0.93, 0.3, 1.26; 32, 0.93, 0.3, 1.197; 42, 0.84, 0.3, 1.197];
p = manipulator_run(task, options);
assert(norm(p(:) - [0.3; 0.3; 1.5]) < 0.02);
