# scene: arm
"""Points that are made, named, hung on the arm and moved with it; poses as positions, quaternions and matrices."""

import sys

from coppeliasim_zmqremoteapi_client import RemoteAPIClient

client = RemoteAPIClient(port=int(sys.argv[1]))
sim = client.require("sim")

tip = sim.getObject('/tip')
point = sim.createDummy(0.01)
sim.setObjectAlias(point, 'grip')
sim.setObjectParent(point, tip, False)
sim.setObjectPose(point, [0, 0, 0.1, 0, 0, 0, 1], sim.handle_parent)
assert sim.getObjectAlias(point) == 'grip' and sim.getObject('/tip/grip') == point
pose = sim.getObjectPose(point, sim.handle_world)
matrix = sim.getObjectMatrix(point, sim.handle_world)
assert max(abs(a - b) for a, b in zip(sim.poseToMatrix(pose), matrix)) < 1e-12
back = sim.multiplyPoses(sim.getPoseInverse(sim.getObjectPose(tip)), pose)
assert max(abs(a - b) for a, b in zip(back, [0, 0, 0.1, 0, 0, 0, 1])) < 1e-12
sim.setJointPosition(sim.getObject('/joint1'), 1.0)
assert sim.getObjectPosition(point) != pose[:3], 'it is carried by the arm'
copies = sim.copyPasteObjects([point])
assert sim.isHandle(copies[0])
sim.removeObjects([point, copies[0]])
assert not sim.isHandle(point)
assert sim.getObject('/tip/grip', {'noError': True}) == -1
