-- scene: arm, object: /base, duration: 4
-- The older form of moveToConfig with a callback of three parameters, and its present form with one.
sim = require('sim')

function moved(config, velocity, acceleration)
    calls = (calls or 0) + 1
    for k, joint in ipairs(joints) do sim.setJointTargetPosition(joint, config[k]) end
end

function sysCall_thread()
    joints = { sim.getObject('./joint1'), sim.getObject('./joint2'), sim.getObject('./joint3') }
    local start, zero = {}, { 0, 0, 0 }
    for k, joint in ipairs(joints) do start[k] = sim.getJointPosition(joint) end
    sim.moveToConfig(-1, start, zero, zero, { 1, 1, 1 }, { 2, 2, 2 }, { 10, 10, 10 }, { 0.3, 0.6, -0.8 }, zero, moved, nil)
    local n = 0
    sim.moveToConfig {
        joints = joints, targetPos = { 0, 0.5, -1 }, maxVel = { 1, 1, 1 }, maxAccel = { 2, 2, 2 }, maxJerk = { 10, 10, 10 },
        callback = function(data)
            n = n + 1
            for k, joint in ipairs(data.joints) do sim.setJointTargetPosition(joint, data.pos[k]) end
        end,
    }
    if calls > 10 and n > 10 then print('passed') end
end
