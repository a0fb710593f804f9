# scene: table
"""A ball lands on a floor: contacts, masses, forces, velocities; a push in free fall."""

import sys

from coppeliasim_zmqremoteapi_client import RemoteAPIClient

client = RemoteAPIClient(port=int(sys.argv[1]))
sim = client.require("sim")

ball, floor, brick = sim.getObject('/core'), sim.getObject('/floor'), sim.getObject('/brick')
sim.setShapeMass(brick, 3.0)
assert abs(sim.getShapeMass(brick) - 3.0) < 1e-12
sim.setStepping(True)
sim.startSimulation()
for _ in range(150):
    sim.step()
objects, point, force, normal = sim.getContactInfo(sim.handle_all, ball, 0)
assert sorted(objects) == sorted([ball, floor]) and abs(abs(force[2]) - 9.81) < 0.5, (objects, force)
assert abs(sim.getObjectPosition(ball)[2] - 0.1) < 1e-3
before, _ = sim.getVelocity(brick)
sim.addForceAndTorque(brick, [30, 0, 0], [0, 0, 0])
sim.step()
after, _ = sim.getVelocity(brick)
assert abs(after[0] - before[0] - 30 / 3.0 * 0.01) < 1e-9
mass, inertia, com = sim.getShapeMassAndInertia(brick)
assert abs(mass - 3.0) < 1e-12 and len(inertia) == 9 and len(com) == 3
sim.stopSimulation()
