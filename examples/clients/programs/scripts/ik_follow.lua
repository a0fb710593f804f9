-- scene: arm, object: /base, duration: 4
-- A target on a circle, followed by inverse kinematics with a damped group for the rest.
function sysCall_init()
    sim = require('sim')
    simIK = require('simIK')
    base, tip, target = sim.getObject('.'), sim.getObject('./tip'), sim.getObject('/target')
    ikEnv = simIK.createEnvironment()
    undamped = simIK.createGroup(ikEnv)
    simIK.setGroupCalculation(ikEnv, undamped, simIK.method_pseudo_inverse, 0, 30)
    simIK.addElementFromScene(ikEnv, undamped, base, tip, target, simIK.constraint_position)
    damped = simIK.createGroup(ikEnv)
    simIK.setGroupCalculation(ikEnv, damped, simIK.method_damped_least_squares, 0.3, 99)
    simIK.addElementFromScene(ikEnv, damped, base, tip, target, simIK.constraint_position)
    worst = 0
end

function sysCall_actuation()
    local t = sim.getSimulationTime()
    sim.setObjectPosition(target, { 0.55 + 0.08 * math.cos(t), 0.1 * math.sin(t), 0.4 }, sim.handle_world)
    if simIK.handleGroup(ikEnv, undamped, { syncWorlds = true }) ~= simIK.result_success then
        simIK.handleGroup(ikEnv, damped, { syncWorlds = true, allowError = true })
    end
end

function sysCall_sensing()
    if sim.getSimulationTime() < 1 then return end
    local a, b = sim.getObjectPosition(tip), sim.getObjectPosition(target)
    worst = math.max(worst, math.sqrt((a[1] - b[1]) ^ 2 + (a[2] - b[2]) ^ 2 + (a[3] - b[3]) ^ 2))
end

function sysCall_cleanup()
    simIK.eraseEnvironment(ikEnv)
    if worst < 0.03 then print('passed') end
end
