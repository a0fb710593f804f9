# scene: arm
"""The client of CoppeliaSim 4.3 to 4.5: stepping by a counter, strings as text."""

import sys

from coppeliasim_zmqremoteapi_client import RemoteAPIClient

client = RemoteAPIClient(port=int(sys.argv[1]), cntport=int(sys.argv[2]))
sim = client.getObject('sim')
joint = sim.getObject('/joint1')
sim.setStringSignal('words', 'as text')
assert sim.getStringSignal('words') == 'as text'
client.setStepping(True)
sim.startSimulation()
while sim.getSimulationTime() < 2:
    sim.setJointTargetPosition(joint, 0.3)
    client.step()
assert abs(sim.getJointPosition(joint) - 0.3) < 1e-3
sim.stopSimulation()
