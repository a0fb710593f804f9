# scene: arm
"""Data blocks, buffers, tables and named parameters that programs leave with objects."""

import sys

from coppeliasim_zmqremoteapi_client import RemoteAPIClient

client = RemoteAPIClient(port=int(sys.argv[1]))
sim = client.require("sim")

base = sim.getObject('/base')
sim.writeCustomDataBlock(base, 'blob', b'\x00\x01\xff')
assert sim.readCustomDataBlock(base, 'blob') == b'\x00\x01\xff' and sim.readCustomDataBlock(base, 'none') == b''
sim.writeCustomBufferData(base, 'text', sim.packTable({'k': [1, 2.5, 'three']}))
assert sim.unpackTable(sim.readCustomBufferData(base, 'text')) == {'k': [1, 2.5, 'three']}
sim.writeCustomTableData(sim.handle_scene, 'all', {'n': 3})
assert sim.readCustomTableData(sim.handle_scene, 'all') == {'n': 3}
assert sim.readCustomDataTags(base) == ['blob', 'text']
sim.setBufferSignal('buffer', sim.packFloatTable([1.5, -2]))
assert sim.unpackFloatTable(sim.getBufferSignal('buffer')) == [1.5, -2]
sim.setNamedStringParam('user', 'name')
assert sim.getNamedStringParam('user') == b'name'
