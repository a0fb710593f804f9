% Position control of the arm in scenes/two-dof-remote over the ZeroMQ remote API, from Octave or MATLAB.
%
% Needs the client of CoppeliaSim 4.6 or later (RemoteAPIClient.m and what stands beside it) in the path; Octave its packages zeromq and
% communications as well:
%
%     sincro serve scenes/two-dof-remote
%     octave --path CLIENT examples/clients/octave/two_dof_zmq.m
%
% The run is the one that `sincro run scenes/two-dof-remote` makes: both print the same trace hash.

if exist('OCTAVE_VERSION', 'builtin')
  pkg load zeromq communications
end

k_pos = 2.03;  goal = [1, -0.5];  duration = 6;

client = RemoteAPIClient();
sim = client.require('sim');
joint = [sim.getObject('/shoulder'), sim.getObject('/shoulder/elbow')];

sim.setStepping(true);               % before every run: it ends with the run
sim.startSimulation();               % time stays 0 until the first step
for k = 1:round(duration / sim.getSimulationTimeStep())
  for i = 1:2
    q(i) = sim.getJointPosition(joint(i));
    sim.setJointTargetVelocity(joint(i), round(1024 * k_pos * (goal(i) - q(i))) / 1024);
  end
  sim.step();                        % returns when the step is done
end
fprintf('%.9f %.9f rad\n', sim.getJointPosition(joint(1)), sim.getJointPosition(joint(2)));
sim.stopSimulation();                % the server writes the run and prints its trace hash
