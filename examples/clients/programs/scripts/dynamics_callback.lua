-- scene: table, object: /space/brick, duration: 1
-- Forces at each pass of the dynamics: a brick is held in the air.
sim = require 'sim'

function sysCall_init()
    brick = sim.getObject('.')
    weight = 9.81 * sim.getShapeMass(brick)
    start = sim.getObjectPosition(brick)[3]
end

function sysCall_dyn(inData)
    if not inData.afterStep then sim.addForceAndTorque(brick, { 0, 0, weight }, { 0, 0, 0 }) end
end

function sysCall_cleanup()
    if math.abs(sim.getObjectPosition(brick)[3] - start) < 1e-9 then print('passed') end
end
