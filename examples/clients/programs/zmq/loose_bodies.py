# scene: table
"""A loose body as a loose shape: its parent, alias, flags and place, text of signals, and the entity of a sensor."""

import sys

from coppeliasim_zmqremoteapi_client import RemoteAPIClient

client = RemoteAPIClient(port=int(sys.argv[1]))
sim = client.require("sim")

brick, cart = sim.getObject('/brick'), sim.getObject('/rail/cart')
assert sim.getObject('/space/brick') == brick
assert sim.getObjectParent(brick) == -1
assert sim.getObjectAlias(brick, 1) == '/brick' and sim.getObjectAlias(brick, 2) == '/brick'
assert sim.getObject('/space') not in sim.getObjectsInTree(sim.handle_scene)
sim.setObjectPosition(brick, [0.2, 2.0, 1.5], sim.handle_parent)
assert sim.getObjectPosition(brick) == [0.2, 2.0, 1.5]

# what the stock robots do: all objects but those of the robot itself
sensor = sim.createProximitySensor(sim.proximitysensor_ray_subtype, 16, 0, [0] * 8, [0.0, 2.0] + [0.0] * 8)
sim.setObjectPosition(sensor, [0.2, 2.0, 0.5])
others = sim.createCollection(0)
sim.addItemToCollection(others, sim.handle_all, -1, 0)
sim.addItemToCollection(others, sim.handle_tree, brick, 1)
assert sim.getObjectInt32Param(sensor, sim.proxintparam_entity_to_detect) == -1
assert sim.handleProximitySensor(sensor)[0] == 1
sim.setObjectInt32Param(sensor, sim.proxintparam_entity_to_detect, others)
assert sim.getObjectInt32Param(sensor, sim.proxintparam_entity_to_detect) == others
assert sim.handleProximitySensor(sensor)[0] == 0
sim.setObjectInt32Param(sensor, sim.proxintparam_entity_to_detect, -1)
flags = sim.getObjectSpecialProperty(brick)
sim.setObjectSpecialProperty(brick, flags & ~sim.objectspecialproperty_detectable_all)
assert sim.handleProximitySensor(sensor)[0] == 0
sim.setBoolProperty(brick, 'detectable', True)
assert sim.handleProximitySensor(sensor)[0] == 1
try:
    sim.setModelProperty(brick, sim.modelproperty_not_dynamic)
    raise SystemExit('a model was made static without a word')
except Exception as error:
    assert 'not dynamic' in str(error), error

sim.setStringSignal('word', 'forward')
assert sim.getStringSignal('word') == 'forward' and sim.getBufferSignal('word') == b'forward'
sim.setStringSignal('packed', sim.packFloatTable([1.0, 0.5]))
assert sim.unpackFloatTable(sim.getStringSignal('packed')) == [1.0, 0.5]
assert isinstance(sim.getStringSignal('packed'), bytes)

# hung on a cart, put elsewhere there, and let go
sim.setObjectParent(brick, cart, True)
assert sim.getObjectParent(brick) == cart and brick in sim.getObjectsInTree(cart)
sim.setObjectPosition(brick, [0, 0, 0.4], cart)
assert max(abs(a - b) for a, b in zip(sim.getObjectPosition(brick, cart), [0, 0, 0.4])) < 1e-12
sim.setObjectParent(brick, -1, True)
assert sim.getObjectParent(brick) == -1
