% Section 5.2, scenes/thesis-arm: the tip goes to three places.
%
%     sincro serve scenes/thesis-arm
%     octave-cli --path .. arm.m

start = [0.27, 0.102, -0.25];
places = [0, 0, 0; -0.03, 0.05, 0.05; 0.04, -0.05, 0.03];
p = arm_run(@(k) start + places(1 + (k >= 200) + (k >= 900), :), 1600);
miss = norm(p(end, :) - start - places(3, :));
fprintf('tip %.6f %.6f %.6f m, %.3g m from its place\n', p(end, :), miss);
assert(miss < 5e-5);
