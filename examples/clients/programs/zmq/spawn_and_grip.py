# scene: table
"""Spawns boxes, loads robots, builds a pendulum and grips a body that moves."""

import math
import sys

from coppeliasim_zmqremoteapi_client import RemoteAPIClient

client = RemoteAPIClient(port=int(sys.argv[1]))
sim = client.require("sim")

ball, brick = sim.getObject('/core'), sim.getObject('/brick')
robot = sim.loadModel('pioneer-p3dx')
sim.setObjectPosition(robot, [-2, 3, 0])
sim.setStepping(True)
sim.startSimulation()

# a spawner: balls fall on the floor and rest there
balls = []
for k in range(3):
    copy = sim.copyPasteObjects([ball], 0)[0]
    sim.setObjectPosition(copy, [3 + k, 0, 0.15])
    balls.append(copy)
    for _ in range(5):
        sim.step()
assert sim.getShapeMass(balls[0]) == 1.0

# a pendulum of a joint and a shape
joint = sim.createJoint(sim.joint_revolute_subtype, sim.jointmode_dynamic, 0, [0.1, 0.02])
sim.setObjectPosition(joint, [0, 5, 1])
sim.setObjectOrientation(joint, [-math.pi / 2, 0, 0])
bob = sim.createPureShape(1, 8, [0.1, 0.1, 0.1], 0.5, None)
sim.setObjectPosition(bob, [0.4, 5, 1])
sim.setObjectParent(bob, joint, True)

# a robot beside the one that was loaded before the start, and an arm
other = sim.loadModel('models/robots/mobile/Pioneer P3DX.ttm')
sim.setObjectPosition(other, [-4, 3, 0])
arm = sim.loadModel('ur5e')
sim.setObjectPosition(arm, [-6, 0, 0])
for _ in range(60):
    sim.step()
for copy in balls:
    assert abs(sim.getObjectPosition(copy)[2] - 0.1) < 1e-4, sim.getObjectPosition(copy)
for base, x in ((robot, -2), (other, -4)):
    wheels = [h for h in sim.getObjectsInTree(base, sim.object_joint_type) if sim.getObjectAlias(h) in ('left', 'right')]
    assert len(wheels) == 2
    chassis = sim.getObjectParent(wheels[0])
    place = sim.getObjectPosition(chassis)
    assert abs(place[0] - x) < 1e-3 and abs(place[2] - 0.0975) < 1e-3, place
x, _, z = sim.getObjectPosition(bob)
assert abs(math.hypot(x, z - 1) - 0.4) < 1e-6 and sim.getJointPosition(joint) != 0

# a gripper: the brick, at rest in space but for gravity, takes a ball along and lets it go
sim.removeObjects(balls[:2])
assert not sim.isHandle(balls[0]) and sim.isHandle(balls[2])
mass = [sim.getShapeMass(brick), sim.getShapeMass(balls[2])]
v = [sim.getObjectVelocity(h)[0][2] for h in (brick, balls[2])]
sim.setObjectPosition(balls[2], [0.5, 2, sim.getObjectPosition(brick)[2]])
sim.setObjectParent(balls[2], brick, True)
before = sim.getObjectPosition(balls[2], brick)
for _ in range(10):
    sim.step()
after = sim.getObjectPosition(balls[2], brick)
assert max(abs(a - b) for a, b in zip(before, after)) < 1e-9, 'the brick carries it'
sim.setObjectParent(balls[2], -1, True)
for _ in range(10):
    sim.step()

# a model as text
text = sim.saveModel(bob)
twin = sim.loadModel(text)
assert len(sim.getObjectsInTree(twin)) == 2
sim.removeModel(arm)
assert not sim.isHandle(arm)
sim.step()
sim.stopSimulation()
