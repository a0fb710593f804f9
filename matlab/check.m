function check()
  % Calls the functions of this folder on the scenes of the repository, whose folder is SCENES; check.py runs it.

  if exist('OCTAVE_VERSION', 'builtin'), pkg('load', 'instrument-control'); end
  scenes = getenv('SCENES');
  scene = fullfile(scenes, 'two-dof-remote');

  % every function has a help text with its shapes
  for name = {'sincro_run', 'sincro_read', 'sincro_signal', 'sincro_start', 'sincro_step', 'sincro_stop', 'sincro_session'}
    text = help(name{1});
    assert(~isempty(strfind(text, upper(name{1}))) && ~isempty(strfind(text, 'See also')));
  end

  % a run: the hash of the command line, signals with units and error bars
  lqr = fullfile(scenes, 'cart-pole-lqr');
  r = sincro_run(lqr);
  [~, text] = system([getenv('SINCRO') ' run ' lqr ' --json --out ' fullfile(getenv('OUT'), 'lqr')]);
  said = jsondecode(text);
  assert(strcmp(r.trace_hash, said.trace_hash) && strcmp(r.status, 'completed') && strcmp(r.verdict, 'holds'));
  [x, unit, bar] = sincro_signal(r, '/rail.position');
  assert(isequal(size(x), size(r.t)) && strcmp(unit, 'm') && bar > 0 && bar < 1e-9);
  assert(r.t(end) == 10 && r.audit.ok && isempty(r.folder) && iscell(r.error_bar_methods));

  % the formats of a result have the same doubles
  a = sincro_read(fullfile(getenv('OUT'), 'lqr'));
  assert(isequal(a.signals, r.signals) && isequal(a.t, r.t) && isequaln(a.error_bars, r.error_bars));

  % settings and options
  stiff = sincro_run(fullfile(scenes, 'spring-dynamic'), {'/shoulder.spring.stiffness', 10}, 'until', 1, ...
    'out', fullfile(getenv('OUT'), 'spring'));
  assert(stiff.t(end) == 1 && exist(fullfile(stiff.folder, 'report.html'), 'file') == 2);
  assert(~strcmp(stiff.trace_hash, getfield(sincro_run(fullfile(scenes, 'spring-dynamic'), {}, 'until', 1), 'trace_hash')));

  % what is refused says why, in sincro's words
  fails(@() sincro_run(lqr, {'/rail.mas', 3}), 'sincro:refused', '`/rail` has no `mas`');
  fails(@() sincro_run(fullfile(scenes, 'nothing')), 'sincro:refused', 'nothing');
  fails(@() sincro_run(lqr, {}, 'util', 1), 'sincro:argument', 'until');
  fails(@() sincro_run(lqr, {'/rail.mass', struct()}), 'sincro:argument', 'struct');
  fails(@() sincro_signal(r, '/rail.positon'), 'sincro:unknown', '/rail.position');
  fails(@() sincro_start(fullfile(scenes, 'nothing')), 'sincro:refused', 'nothing');
  fails(@() sincro_start(scene, {}, 'reads', {'/shoulder.positon'}), 'sincro:argument', 'float_signal');
  fails(@() sincro_start(scene, {}, 'writes', {'/elbo'}), 'sincro:refused', '/elbo');

  % a controller in lock-step: the trace of the same law as a block diagram, and of no other
  s = sincro_start(scene, {}, 'reads', {'/shoulder.position', '/shoulder/elbow.position'}, 'writes', {'/shoulder', '/shoulder/elbow'});
  fails(@() sincro_step(s, 1), 'sincro:argument', '2 `writes`');
  fails(@() sincro_step(s, [1, NaN]), 'sincro:argument', '/shoulder/elbow');
  fails(@() sincro_step(s, [0, 0], 0.5), 'sincro:argument', 'whole number');
  fails(@() s.call('sim.getJointPosition', int32(12345)), 'sincro:refused', '12345');
  q = s.y;
  for k = 1:1200
    [q, t] = sincro_step(s, round(1024 * 2.03 * ([1; -0.5] - q)) / 1024);
  end
  remote = sincro_stop(s);
  local = sincro_run(scene);
  assert(t == 6 && strcmp(remote.trace_hash, local.trace_hash));
  assert(q(1) == remote.signals(end, 1) && q(2) == remote.signals(end, 2) && isempty(remote.folder));
  fails(@() sincro_step(s, [0, 0]), 'sincro:closed', 'sincro_start');

  % what is read between steps is what is recorded
  reads = {'/rail.position', '/rail/cart/hinge.velocity', '/rail.motor_torque', '/rail/cart/hinge/pole.position.x'};
  s = sincro_start(lqr, {}, 'reads', reads, 'out', fullfile(getenv('OUT'), 'steps'));
  seen = s.y';
  for k = 1:50
    y = sincro_step(s);
    seen(k + 1, :) = y';
  end
  served = sincro_stop(s);
  assert(isequal(seen(:, 1), sincro_signal(served, reads{1})) && isequal(seen(:, 2), sincro_signal(served, reads{2})));
  torque = sincro_signal(served, reads{3});
  assert(isnan(seen(1, 3)) && max(abs(seen(2:end, 3) - torque(2:end))) < 1e-13);
  assert(isequal(seen(:, 4), seen(:, 1)));                 % the pole's frame is on the cart
  assert(strcmp(served.folder, fullfile(getenv('OUT'), 'steps', 'run-1')));

  % rotors: their speeds are commands, several steps at once
  drone = '/air/quadrotor';
  speeds = arrayfun(@(k) sprintf('%s/rotor%d.speed', drone, k), 1:4, 'UniformOutput', false);
  s = sincro_start(fullfile(scenes, 'quadrotor-remote'), {}, 'reads', [speeds, {[drone '.position.z']}], 'writes', speeds);
  [y, t] = sincro_step(s, 600 * [1, 1, 1, 1], 5);
  served = sincro_stop(s);
  assert(abs(t - served.t(end)) < 1e-12);
  assert(isequal(y(1:4)', served.signals(end, 10:13)) && y(5) == served.signals(end, 3) && y(1) < 720);

  fprintf('run %s\nserved %s\n', local.trace_hash, remote.trace_hash);
end

function fails(call, identifier, words)
  % holds if the call fails with this identifier and these words in its message
  try
    call();
  catch failure
    assert(strcmp(failure.identifier, identifier), '%s', [failure.identifier ': ' failure.message]);
    assert(~isempty(strfind(failure.message, words)), '%s', failure.message);
    return
  end
  error('nothing fails where this was expected: %s', words);
end
