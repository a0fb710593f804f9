# scene: quadricopter
"""Moves the target of a quadricopter and waits until it is there, by a signal of its script too."""

import sys

from coppeliasim_zmqremoteapi_client import RemoteAPIClient

client = RemoteAPIClient(port=int(sys.argv[1]))
sim = client.require("sim")

import math  # noqa: E402

sim.setStepping(True)
sim.startSimulation()
sim.step()
drone, target = sim.getObject('/Quadricopter/base'), sim.getObject('/target')
assert sim.getObjectParent(target) == -1
for goal in ([0, 0, 1.0], [0.4, -0.3, 1.2]):
    sim.setObjectPosition(target, sim.handle_world, goal)
    for _ in range(120):
        sim.step()
    assert math.dist(sim.getObjectPosition(drone, sim.handle_world), goal) < 0.05
assert abs(sim.getFloatSignal('height') - 1.2) < 0.05
propellers = [sim.getObject(f'./propeller[{k}]/respondable') for k in range(4)]
assert len(set(propellers)) == 4
image, resolution = sim.getVisionSensorImg(sim.getObject('/floorCamera'))
assert resolution == [32, 32] and len(image) == 3 * 32 * 32
sim.stopSimulation()
