# scene: arm
"""A proportional law on a velocity motor, its force limit set."""

import sys

from coppeliasim_zmqremoteapi_client import RemoteAPIClient

client = RemoteAPIClient(port=int(sys.argv[1]))
sim = client.require("sim")

joint = sim.getObject('/joint1')
sim.setObjectInt32Param(joint, sim.jointintparam_dynctrlmode, sim.jointdynctrl_velocity)
sim.setJointTargetForce(joint, 100)
assert sim.getJointTargetForce(joint) == 100
sim.setStepping(True)
sim.startSimulation()
while sim.getSimulationTime() < 4:
    error = -1.0 - sim.getJointPosition(joint)
    sim.setJointTargetVelocity(joint, 3 * error)
    sim.step()
assert abs(error) < 1e-3 and abs(sim.getJointVelocity(joint)) < 1e-2, error
sim.stopSimulation()
