function parts = sincro_settings(settings)
% Arguments of the command line for settings, a cell array with a path and a value in each row.
  parts = {};
  if isempty(settings), return; end
  if ~iscell(settings) || size(settings, 2) ~= 2
    error('sincro:argument', 'settings are a cell array with a path and a value in each row: {''/link.mass'', 2}');
  end
  for k = 1:size(settings, 1)
    parts = [parts, {'--set', [settings{k, 1} '=' sincro_value(settings{k, 2})]}];
  end
end
