function [y, unit, error_bar] = sincro_signal(r, name)
% SINCRO_SIGNAL  One signal of a result, by its name.
%
%   [y, unit, error_bar] = sincro_signal(r, name)
%
%   r          result of `sincro_run`, `sincro_read` or `sincro_stop`
%   name       one of r.names, '/shoulder.position' say
%   y          n x 1 values at the times r.t
%   unit       SI unit, '' for a number without one
%   error_bar  estimated integration error in that unit; NaN if there is none
%
%   See also SINCRO_RUN.
  k = find(strcmp(r.names, name), 1);
  if isempty(k)
    error('sincro:unknown', '`%s` was not recorded; recorded are: %s', name, strjoin(r.names(:)', ', '));
  end
  y = r.signals(:, k);
  unit = r.units{k};
  error_bar = r.error_bars(k);
end
