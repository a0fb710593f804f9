function [q, torque] = step(SINCRO, u)
  % One step of the lock-step, in the order of the thesis's step.m: send the speeds, read the joints, trigger.
  %
  % What is read is what was before the step, so that a program that computes its next speeds from it is one sample late: the unit delay
  % of the thesis's Simulink model. u: speeds of the motors [rad/s]; q, torque: of the joints, in the order of start_run [rad, N m].

  vrep = remApi('remoteApi');                                % as there: the class anew, the connection the same
  id = SINCRO.id;
  send(vrep, SINCRO, u);
  q = zeros(1, numel(SINCRO.joints));  torque = q;
  for i = 1:numel(SINCRO.joints)
    [code, q(i)] = vrep.simxGetJointPosition(id, SINCRO.joints(i), vrep.simx_opmode_streaming);
    if nargout > 1
      [code(2), torque(i)] = vrep.simxGetJointForce(id, SINCRO.joints(i), vrep.simx_opmode_streaming);
    end
    assert(all(code == 0), 'a joint cannot be read: has the run been stopped?');   % the thesis's programs ignore it, and go on with zeros
  end
  assert(vrep.simxSynchronousTrigger(id), 0);                % the answer comes when the step is done
end
