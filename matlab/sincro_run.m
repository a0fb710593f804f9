function r = sincro_run(scene, settings, varargin)
% SINCRO_RUN  Run a scene as `sincro run` does, and return its result.
%
%   r = sincro_run(scene)
%   r = sincro_run(scene, settings)
%   r = sincro_run(scene, settings, option, value, ...)
%
%   scene     folder of the scene, or a robot file (URDF, SDF, MJCF)
%   settings  numbers to set first, as after --set: a cell array with one row a setting,
%             {'/shoulder.spring.stiffness', 10; 'parameters.m', 3}; {} for none.
%             A value is a number, a vector or a text in TOML.
%
%   option        value
%   'until'       end of the run [s]
%   'step'        base step [s]
%   'seed'        seed of all random generators, a whole number
%   'integrator'  'auto', 'semi-implicit-euler', 'rk4', 'implicit', 'dormand-prince',
%                 'dormand-prince-8' or 'stiff'
%   'accuracy'    local tolerance of the variable-step integrators
%   'only'        'main', or the name of one variant
%   'out'         folder of the result: absent, empty or an earlier result, which is replaced.
%                 A temporary one unless given, which is removed.
%
%   The result is a structure; n rows were recorded of m signals, times excluded:
%   r.t               n x 1  times [s]
%   r.signals         n x m  values, column k in r.units{k}; `sincro_signal` takes one by its name
%   r.names, r.units  m x 1  names and SI units
%   r.error_bars      m x 1  estimated integration errors in the units; NaN where there is none
%   r.error_bar_methods  m x 1  how they were estimated, or why they were not
%   r.trace_hash      hash of the states of all ticks: the same bits give the same hash
%   r.status          'completed', 'ended', 'stopped' or 'interrupted'
%   r.verdict         'holds', 'fails' or 'stopped', over all checks, variants and audits
%   r.audit, r.checks, r.warnings  of the run
%   r.report          all of run.json
%   r.folder          folder of the result, '' if it was removed
%
%   What sincro refuses is an error `sincro:refused` with sincro's text. Checks that fail, and runs that stop, are
%   results. The program is `sincro` of the path, or the environment variable SINCRO.
%
%   Example
%     r = sincro_run('scenes/spring-dynamic', {'/shoulder.spring.stiffness', 10}, 'until', 1);
%     plot(r.t, sincro_signal(r, '/shoulder.position'))
%
%   See also SINCRO_SIGNAL, SINCRO_READ, SINCRO_START.
  if nargin < 2, settings = {}; end
  [options, out] = run_options(varargin);
  is_temporary = isempty(out);
  if is_temporary, out = tempname(); end
  parts = [{'run', scene, '--format', 'mat', '--out', out}, sincro_settings(settings), options];
  [code, text] = sincro_call(parts);
  if code > 3 || code == 2 || ~exist(fullfile(out, 'run.json'), 'file')
    error('sincro:refused', '%s', text);
  end
  r = sincro_read(out);
  verdicts = {'holds', 'fails', '', 'stopped'};
  r.verdict = verdicts{code + 1};
  if is_temporary
    sincro_remove(out);
    r.folder = '';
  end
end

function [parts, out] = run_options(given)
  known = {'until', 'step', 'seed', 'integrator', 'accuracy', 'only', 'out'};
  parts = {};
  out = '';
  if mod(numel(given), 2) ~= 0
    error('sincro:argument', 'sincro_run: an option has no value');
  end
  for k = 1:2:numel(given)
    if ~any(strcmp(given{k}, known))
      error('sincro:argument', 'sincro_run: there is no option `%s`; options: %s', given{k}, strjoin(known, ', '));
    end
    if strcmp(given{k}, 'out')
      out = given{k + 1};
    else
      parts = [parts, {['--' given{k}], sincro_value(given{k + 1})}];
    end
  end
end
