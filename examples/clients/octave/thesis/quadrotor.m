% Sections 6.3 and 6.4, scenes/thesis-quadrotor and thesis-quadrotor-lua: a flight test, 1 m up, then to the side (waypoints) or ahead.
%
%     sincro serve scenes/thesis-quadrotor
%     octave-cli --path .. quadrotor.m

if ~exist('waypoints', 'var'), waypoints = [0, 0, 1; 0, 0.1, 1; 0, -0.1, 1]; end   % [m], from 0, 20 and 40 s on
% the first Motor bears the name itself, its copies a number
SINCRO = start_run({'Motor#', 'Motor#0', 'Motor#1', 'Motor#2'}, {});
vrep = remApi('remoteApi');  id = SINCRO.id;
[code, axes] = vrep.simxGetObjectHandle(id, 'CambioEje#', vrep.simx_opmode_blocking);  assert(code, 0);
[code, body] = vrep.simxGetObjectHandle(id, 'quadrotor#', vrep.simx_opmode_blocking);  assert(code, 0);
law = [];  p = [];
for k = 0:1199
  [code, p] = vrep.simxGetObjectPosition(id, axes, -1, vrep.simx_opmode_streaming);
  [code(2), angles] = vrep.simxGetObjectOrientation(id, axes, -1, vrep.simx_opmode_streaming);
  [code(3), v, w] = vrep.simxGetObjectVelocity(id, body, vrep.simx_opmode_streaming);
  assert(all(code == 0));
  [speeds, law] = quadrotor_law(law, waypoints(1 + (k >= 400) + (k >= 800), :), p, angles, v, w);
  send(vrep, SINCRO, speeds);
  assert(vrep.simxSynchronousTrigger(id), 0);
end
stop_run(SINCRO);
fprintf('place %.6f %.6f %.6f m\n', p);
assert(norm(p(:)' - waypoints(3, :)) < 2e-3);
