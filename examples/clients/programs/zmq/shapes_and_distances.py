# scene: arm
"""Shapes made at run time, their boxes, collisions and distances, collections, a sensor that sees them."""

import sys

from coppeliasim_zmqremoteapi_client import RemoteAPIClient

client = RemoteAPIClient(port=int(sys.argv[1]))
sim = client.require("sim")

box = sim.createPrimitiveShape(sim.primitiveshape_cuboid, [0.1, 0.2, 0.3])
sim.setObjectPosition(box, [1.5, 0, 0.15])
sim.setShapeColor(box, None, sim.colorcomponent_ambient_diffuse, [0, 0, 1])
size, pose = sim.getShapeBB(box)
assert max(abs(a - b) for a, b in zip(size, [0.1, 0.2, 0.3])) < 1e-12
ball = sim.createPrimitiveShape(sim.primitiveshape_spheroid, [0.2, 0.2, 0.2])
sim.setObjectPosition(ball, [1.9, 0, 0.15])
result, data, objects = sim.checkDistance(box, ball)
assert result == 1 and abs(data[6] - 0.25) < 1e-9, data
assert sim.checkCollision(box, ball)[0] == 0
sim.setObjectPosition(ball, [1.6, 0, 0.15])
assert sim.checkCollision(box, ball)[0] == 1
both = sim.createCollection(0)
for shape in (box, ball):
    sim.addItemToCollection(both, sim.handle_single, shape, 0)
assert sorted(sim.getCollectionObjects(both)) == sorted([box, ball])
sensor = sim.createProximitySensor(sim.proximitysensor_ray, 16, 0, 8 * [0], [0.0, 2.0] + 13 * [0.0])
sim.setObjectPosition(sensor, [1.5, 0, 1.0])
sim.setObjectOrientation(sensor, [3.141592653589793, 0, 0])
result, distance, *_ = sim.checkProximitySensor(sensor, box)
assert result == 1 and abs(distance - 0.7) < 1e-9, distance
sim.removeObjects([box, ball, sensor])
