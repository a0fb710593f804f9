function s = sincro_start(scene, settings, varargin)
% SINCRO_START  Begin a run that `sincro_step` advances: MATLAB or Octave is the controller, in lock-step.
%
%   s = sincro_start(scene, settings, 'reads', reads, 'writes', writes)
%   s = sincro_start('', {}, 'port', port, 'reads', reads, 'writes', writes)
%
%   scene     folder of the scene. It is served by a `sincro serve` of its own, which `sincro_stop` ends.
%   settings  as for `sincro_run`
%
%   option    value
%   'reads'   cell array of the signals that `sincro_step` returns, in this order
%   'writes'  cell array of the joints and rotors that it commands, in this order
%   'step'    time of one step [s], a whole number of base steps; `simulation_step` of the experiment unless given
%   'out'     folder of the runs; a temporary one unless given, which is removed
%   'port'    WebSocket port of a server that is running, `sincro serve SCENE` say, in place of one of its own
%
%   reads                              unit
%   '/joint.position', '.velocity'     rad, rad/s; m, m/s for a prismatic joint
%   '/joint.motor_torque', '.motor_force'  N m, N: mean over the last step; NaN before the first
%   '/rotor.speed'                     rad/s
%   '/frame.position.x', '.y', '.z'    m, world axes, of a body, frame, sensor or camera
%   'float_signal.NAME'                of the scripts
%
%   A command is what the motor's mode makes of it: velocity [rad/s, m/s], position [rad, m], torque [N m, N]; for a
%   rotor its speed [rad/s]. Values travel as doubles: the run has the bits of the same controller elsewhere.
%   What is recorded does not depend on `reads`: `sincro_stop` returns all signals of the experiment.
%
%   s is used by `sincro_step` and `sincro_stop`; s.call(name, ...) calls any function of the API of CoppeliaSim,
%   s.call('sim.getObject', '/arm') say (docs/remote.md). Octave needs its package instrument-control.
%
%   Example
%     s = sincro_start('scenes/two-dof-remote', {}, 'reads', {'/shoulder.position', '/shoulder/elbow.position'}, ...
%                      'writes', {'/shoulder', '/shoulder/elbow'});
%     y = s.y;
%     for k = 1:1200
%       y = sincro_step(s, 2 * ([1; -0.5] - y));
%     end
%     r = sincro_stop(s);
%
%   See also SINCRO_STEP, SINCRO_STOP, SINCRO_RUN.
  if nargin < 2, settings = {}; end
  s = sincro_session(scene, settings, varargin);
end
