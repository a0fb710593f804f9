function r = sincro_stop(s)
% SINCRO_STOP  End a run of `sincro_start` and return its result.
%
%   r = sincro_stop(s)
%
%   r is the structure that `sincro_run` describes, without r.verdict; error bars are NaN, since the run cannot be
%   repeated. It is [] if the server is not one of its own (option 'port'): `sincro_read` reads the folder that the
%   server names.
%
%   See also SINCRO_START, SINCRO_STEP, SINCRO_READ.
  r = s.stop();
end
