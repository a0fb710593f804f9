function stop_run(SINCRO)
  % Ends the run and the connection: the server writes the run and prints its trace hash.

  vrep = remApi('remoteApi');
  vrep.simxStopSimulation(SINCRO.id, vrep.simx_opmode_blocking);
  vrep.simxFinish(SINCRO.id);
end
