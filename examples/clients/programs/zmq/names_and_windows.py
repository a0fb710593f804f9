# scene: arm
"""Constants and functions by name, drawing and user interfaces without windows, refusals with reasons."""

import sys

from coppeliasim_zmqremoteapi_client import RemoteAPIClient

client = RemoteAPIClient(port=int(sys.argv[1]))
sim = client.require("sim")

for name in ('drawing_points', 'drawing_spherepts', 'particle_cyclic', 'handle_tree', 'shapeintparam_respondable', 'object_graph_type', 'banner_left'):
    assert isinstance(getattr(sim, name), int), name
assert sum(isinstance(getattr(sim, name), int) for name in dir(sim)) > 1000
lines = sim.addDrawingObject(sim.drawing_lines, 2, 0, -1, 1000, [1, 0, 0])
sim.addDrawingObjectItem(lines, [0, 0, 0, 1, 1, 1])
sim.removeDrawingObject(lines)
simUI = client.require('simUI')
ui = simUI.create('<ui title="Speed"><hslider id="1"/></ui>')
simUI.setSliderValue(ui, 1, 30)
assert simUI.getSliderValue(ui, 1) == 30
simUI.destroy(ui)
for function, arguments in (('convexDecompose', (1, 0, [], [])), ('setShapeMaterial', (1, 2))):
    try:
        client.call(f'sim.{function}', arguments)
        raise SystemExit('it should have been refused')
    except Exception as error:
        assert 'not offered' in str(error), error
