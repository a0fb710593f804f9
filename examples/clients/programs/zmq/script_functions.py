# scene: arm
"""Calls functions of a child script; waits for what it says by signals."""

import sys

from coppeliasim_zmqremoteapi_client import RemoteAPIClient

client = RemoteAPIClient(port=int(sys.argv[1]))
sim = client.require("sim")

script = sim.getScript(sim.scripttype_childscript, sim.getObject('/base'))
sim.setStepping(True)
sim.startSimulation()
sim.step()
assert sim.callScriptFunction('add', script, 2, 3) == (5, 'done')
assert sim.callScriptFunction('add@base', sim.scripttype_childscript, 'a'.count('a'), 1)[0] == 2
for _ in range(9):
    sim.step()
assert sim.getInt32Signal('steps') == 10 and abs(sim.getFloatSignal('time') - 0.45) < 1e-9
assert sim.testCB(21, lambda a, b: a + b, 21) == 42
sim.stopSimulation()
