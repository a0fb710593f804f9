# scene: rover
"""A rover stops before a wall by its proximity sensor."""

import sys

from coppeliasim_zmqremoteapi_client import RemoteAPIClient

client = RemoteAPIClient(port=int(sys.argv[1]))
sim = client.require("sim")

left, right, front = sim.getObject('/leftMotor'), sim.getObject('/rightMotor'), sim.getObject('/front')
sim.setStepping(True)
sim.startSimulation()
stopped = False
for _ in range(250):
    result, distance, point, handle, normal = sim.readProximitySensor(front)
    speed = 0.0 if result > 0 and distance < 0.5 else 5.0
    stopped = speed == 0.0
    sim.setJointTargetVelocity(left, speed)
    sim.setJointTargetVelocity(right, speed)
    sim.step()
assert stopped and handle == sim.getObject('/wall') and 0.3 < distance < 0.55, distance
linear, angular = sim.getObjectVelocity(sim.getObject('/chassis'))
assert max(map(abs, linear)) < 0.02
sim.stopSimulation()
