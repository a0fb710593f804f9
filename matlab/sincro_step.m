function [y, t] = sincro_step(s, u, n)
% SINCRO_STEP  Advance a run of `sincro_start`: commands, n steps, measurements.
%
%   [y, t] = sincro_step(s, u)
%   [y, t] = sincro_step(s, u, n)
%
%   s  from `sincro_start`
%   u  commands, one for each of its `writes`, held over the steps; [] leaves those that are set
%   n  number of steps, 1 unless given
%   y  column of the signals `reads` after the steps, in their units; s.y has the last ones
%   t  time after the steps [s]
%
%   The commands act from the instant of the measurement that they were computed from: there is no delay.
%   A run that stops, and a value that is refused, are errors `sincro:refused` with sincro's text.
%
%   See also SINCRO_START, SINCRO_STOP.
  if nargin < 2, u = []; end
  if nargin < 3, n = 1; end
  [y, t] = s.step(u, n);
end
