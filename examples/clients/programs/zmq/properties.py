# scene: table
"""Properties of CoppeliaSim 4.7 and later, custom data of every kind, signals as properties."""

import sys

from coppeliasim_zmqremoteapi_client import RemoteAPIClient

client = RemoteAPIClient(port=int(sys.argv[1]))
sim = client.require("sim")

brick, rail = sim.getObject('/brick'), sim.getObject('/rail')
assert abs(sim.getFloatProperty(brick, 'mass') - 6.0) < 1e-9
assert sim.getVector3Property(brick, 'absPosition') == sim.getObjectPosition(brick)
sim.setFloatProperty(rail, 'jointPosition', 0.5)
assert sim.getJointPosition(rail) == 0.5
sim.setIntProperty(brick, 'customData.count', 5)
sim.setStringProperty(brick, 'customData.label', 'heavy')
sim.setTableProperty(brick, 'customData.table', {'a': [1, 2], 'b': 'x'})
assert sim.getIntProperty(brick, 'customData.count') == 5
assert sim.getStringProperty(brick, 'customData.label') == 'heavy'
assert sim.getTableProperty(brick, 'customData.table') == {'a': [1, 2], 'b': 'x'}
assert sim.getFloatProperty(brick, 'customData.none', {'noError': True}) is None
sim.setFloatProperty(sim.handle_app, 'signal.speed', 0.25)
assert sim.getFloatSignal('speed') == 0.25
assert sim.getVector3Property(sim.handle_scene, 'gravity') == [0, 0, -9.81]
try:
    sim.getFloatProperty(brick, 'noSuchProperty')
    raise SystemExit('a property that is not there was read')
except Exception as error:
    assert 'no property' in str(error), error
