function send(vrep, SINCRO, u)
  % Sets the speeds of the motors [rad/s] in one message.

  if isempty(u), return; end
  vrep.simxPauseCommunication(SINCRO.id, true);
  for i = 1:numel(u)
    vrep.simxSetJointTargetVelocity(SINCRO.id, SINCRO.motors(i), u(i), vrep.simx_opmode_oneshot);
  end
  vrep.simxPauseCommunication(SINCRO.id, false);
end
