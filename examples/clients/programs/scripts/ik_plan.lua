-- scene: arm, object: /base, duration: 6
-- Plans a configuration and a path with a validation function, then moves along it in a thread.
sim = require 'sim'
simIK = require 'simIK'

function isFree(config, data)
    return config[3] < data
end

function sysCall_thread()
    local tip, target = sim.getObject('./tip'), sim.getObject('/target')
    local joints = {}
    for k = 1, 3 do joints[k] = sim.getObject('./joint' .. k) end
    local env = simIK.createEnvironment()
    local group = simIK.createGroup(env)
    simIK.addElementFromScene(env, group, sim.getObject('.'), tip, target, simIK.constraint_position)
    local config = simIK.findConfig(env, group, joints, 0.1, 1, { 1, 1, 1, 0.1 }, isFree, 0)
    assert(config and config[3] < 0, 'no configuration')
    local limits = { 2, 2, 2 }
    sim.moveToConfig { joints = joints, targetPos = config, maxVel = limits, maxAccel = limits, maxJerk = { 20, 20, 20 } }
    sim.wait(0.5)
    local a, b = sim.getObjectPosition(tip), sim.getObjectPosition(target)
    local gap = math.sqrt((a[1] - b[1]) ^ 2 + (a[2] - b[2]) ^ 2 + (a[3] - b[3]) ^ 2)
    simIK.syncFromSim(env, { group })
    sim.setObjectPosition(target, { b[1], b[2], b[3] - 0.1 })
    local path = simIK.generatePath(env, group, joints, tip, 20)
    if gap < 0.01 and path and #path == 60 then print('passed') end
end
