function r = sincro_read(folder)
% SINCRO_READ  Read a finished result: a folder that `sincro run` or a served run has written.
%
%   r = sincro_read('results/arm/latest')
%
%   r is the structure that `sincro_run` describes, without r.verdict: n x 1 times r.t [s], n x m values r.signals in
%   the units r.units. Signals are read from signals.mat if it is there, else from signals.csv: the same doubles.
%
%   See also SINCRO_RUN, SINCRO_SIGNAL.
  place = fullfile(folder, 'run.json');
  if ~exist(place, 'file')
    error('sincro:argument', '`%s` is no result of sincro: it has no run.json', folder);
  end
  report = jsondecode(fileread(place));
  columns = report.columns;
  n = numel(columns) - 1;                                  % the first is t
  r = struct();
  r.folder = folder;
  r.names = cell(n, 1);
  r.units = cell(n, 1);
  r.error_bars = nan(n, 1);
  r.error_bar_methods = cell(n, 1);
  for k = 1:n
    column = entry(columns, k + 1);
    r.names{k} = column.path;
    r.units{k} = column.unit;
    r.error_bar_methods{k} = column.error_bar_method;
    if ~isempty(column.error_bar), r.error_bars(k) = column.error_bar; end
  end
  if exist(fullfile(folder, 'signals.mat'), 'file')
    signals = load(fullfile(folder, 'signals.mat'));
    r.t = signals.t;
    r.signals = signals.signals;
  else
    values = csv(fullfile(folder, 'signals.csv'), n + 1);
    r.t = values(:, 1);
    r.signals = values(:, 2:end);
  end
  r.trace_hash = report.trace_hash;
  r.status = report.status.state;
  r.audit = report.audit;
  r.checks = report.checks;
  r.warnings = report.warnings;
  r.report = report;
end

function one = entry(list, k)
  % jsondecode gives structures of the same fields as an array, others as cells
  if iscell(list), one = list{k}; else, one = list(k); end
end

function values = csv(place, n)
  % `sscanf` reads every digit, `textscan` does not
  text = fileread(place);
  text = text(find(text == char(10), 1) + 1:end);
  values = sscanf(strrep(text, ',', ' '), '%f', [n, Inf])';
end
