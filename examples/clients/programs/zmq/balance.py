# scene: table
"""State feedback that balances a pole on a cart by force control."""

import sys

from coppeliasim_zmqremoteapi_client import RemoteAPIClient

client = RemoteAPIClient(port=int(sys.argv[1]))
sim = client.require("sim")

rail, hinge = sim.getObject('/rail'), sim.getObject('/hinge')
assert sim.getObjectInt32Param(rail, sim.jointintparam_dynctrlmode) == sim.jointdynctrl_force
sim.setStepping(True)
sim.startSimulation()
assert sim.getJointForce(rail) is None, 'no force before the first step'
for _ in range(400):
    state = [sim.getJointPosition(rail), sim.getJointVelocity(rail), sim.getJointPosition(hinge), sim.getJointVelocity(hinge)]
    force = sum(k * x for k, x in zip((1.0, 2.1, 30.0, 6.0), state))
    sim.setJointTargetForce(rail, force)
    sim.step()
assert abs(state[2]) < 0.05, state
assert abs(sim.getJointForce(rail) + force) < 1e-6
sim.stopSimulation()
