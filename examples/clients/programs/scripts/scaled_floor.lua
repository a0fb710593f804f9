-- scene: table, object: /core, duration: 0.5
-- Shapes scaled along each axis, a floor that is spread, random whole numbers, as programs build their surroundings.
sim = require 'sim'

function sysCall_init()
    local floor = sim.getObject('/floor')
    sim.scaleObject(floor, 15.0, 20.0, 1.0)
    math.randomseed2(3)
    walls = {}
    for k = 1, 4 do
        local wall = sim.createPrimitiveShape(sim.primitiveshape_cuboid, { 1, 1, 1 }, 0)
        sim.scaleObject(wall, 0.1, 2, math.random2(1, 3))
        sim.setObjectPosition(wall, { 4 * math.cos(k), 4 * math.sin(k), math.random2() })
        local _, _, size = sim.getShapeGeomInfo(wall)
        assert(math.abs(size[1] - 0.1) < 1e-12 and math.abs(size[2] - 2) < 1e-12)
        assert(size[3] == 1 or size[3] == 2 or size[3] == 3)
        walls[k] = wall
    end
end

function sysCall_cleanup()
    print('passed')
end
