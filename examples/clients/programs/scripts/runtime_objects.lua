-- scene: arm, object: /base, duration: 0.2
-- Makes points and shapes, hangs them on each other, measures and removes them.
sim = require 'sim'

function sysCall_init()
    local box = sim.createPrimitiveShape(sim.primitiveshape_cuboid, { 0.2, 0.2, 0.2 })
    local copy = sim.copyPasteObjects({ box }, 0)[1]
    sim.setObjectPosition(copy, { 1, 0, 0 })
    local point = sim.createDummy(0.01)
    sim.setObjectAlias(point, 'mark')
    sim.setObjectParent(point, copy, false)
    sim.setObjectPosition(point, { 0, 0, 0.5 }, sim.handle_parent)
    sim.setObjectOrientation(copy, { 0, math.pi / 2, 0 })
    local p = sim.getObjectPosition(point)
    assert(math.abs(p[1] - 1.5) < 1e-12 and math.abs(p[3]) < 1e-12)
    local size = sim.getShapeBB(box)
    assert(math.abs(size[1] - 0.2) < 1e-12)
    local _, data = sim.checkDistance(box, copy)
    assert(math.abs(data[7] - 0.8) < 1e-9)
    assert(sim.getObjectsInTree(copy)[2] == point)
    sim.removeObjects { box, copy, point }
    assert(not sim.isHandle(box))
    print('passed')
end
