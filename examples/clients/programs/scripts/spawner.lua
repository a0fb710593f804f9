-- scene: table, object: /ball, duration: 1.0
-- Copies a ball every tenth of a second, removes some, and loads a robot.
sim = require 'sim'

function sysCall_init()
    original = sim.getObject('/core')
    copies = {}
end

function sysCall_actuation()
    local n = math.floor(sim.getSimulationTime() / 0.1 + 0.5)
    if #copies < 4 and n > #copies then
        local copy = sim.copyPasteObjects({ original }, 0)[1]
        sim.setObjectPosition(copy, { 3 + #copies, 0, 0.12 })
        copies[#copies + 1] = copy
    end
    if n == 5 and not cube then
        cube = sim.createPureShape(0, 8, { 0.2, 0.2, 0.2 }, 2)
        sim.setObjectPosition(cube, { 5, 5, 0.1 })
        sim.removeObjects { copies[1] }
    end
end

function sysCall_cleanup()
    assert(#copies == 4 and not sim.isHandle(copies[1]))
    for k = 2, 3 do
        local p = sim.getObjectPosition(copies[k])
        assert(math.abs(p[3] - 0.1) < 1e-6, p[3])
    end
    assert(math.abs(sim.getObjectPosition(cube)[3] - 0.1) < 1e-6)
    print('passed')
end
