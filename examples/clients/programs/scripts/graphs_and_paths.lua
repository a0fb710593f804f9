-- scene: table, object: /floor, duration: 0.5
-- Streams of a graph, lengths along a path, interpolation of configurations, rotations.
sim = require 'sim'

function sysCall_init()
    graph = sim.getObject('.')
    stream = sim.addGraphStream(graph, 'height', 'm', 0, { 1, 0, 0 })
    local path = { 0, 0, 1, 0, 1, 2 }
    local lengths, total = sim.getPathLengths(path, 2)
    assert(math.abs(total - 3) < 1e-12 and #lengths == 3)
    local middle = sim.getPathInterpolatedConfig(path, lengths, 2)
    assert(math.abs(middle[1] - 1) < 1e-12 and math.abs(middle[2] - 1) < 1e-12)
    local m = sim.rotateAroundAxis(sim.buildIdentityMatrix(), { 0, 0, 1 }, { 0, 0, 0 }, math.pi / 2)
    local v = sim.multiplyVector(m, { 1, 0, 0 })
    assert(math.abs(v[2] - 1) < 1e-12)
    local e = sim.getEulerAnglesFromMatrix(m)
    assert(math.abs(e[3] - math.pi / 2) < 1e-12)
end

function sysCall_sensing()
    sim.setGraphStreamValue(graph, stream, sim.getObjectPosition(sim.getObject('/core'))[3])
end

function sysCall_cleanup()
    print('passed')
end
