# scene: arm
"""Drives a joint along a sine with position control, one step at a time."""

import sys

from coppeliasim_zmqremoteapi_client import RemoteAPIClient

client = RemoteAPIClient(port=int(sys.argv[1]))
sim = client.require("sim")

import math  # noqa: E402

joint = sim.getObject('/joint1')
sim.setStepping(True)
sim.startSimulation()
worst = 0.0
while (t := sim.getSimulationTime()) < 6:
    wanted = 0.6 * math.sin(t)
    sim.setJointTargetPosition(joint, wanted)
    if t > 2:
        worst = max(worst, abs(sim.getJointPosition(joint) - wanted))
    sim.step()
assert worst < 0.1, worst
sim.stopSimulation()
while sim.getSimulationState() != sim.simulation_stopped:
    pass
