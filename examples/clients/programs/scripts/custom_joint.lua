-- scene: table, object: /rail, duration: 3
-- A callback of the joint computes its force.
sim = require 'sim'

function sysCall_init()
    hinge, rail = sim.getObject('/hinge'), sim.getObject('.')
end

function sysCall_joint(joint)
    local q, w = sim.getJointPosition(hinge), sim.getJointVelocity(hinge)
    local u = joint.currentPos + 2.1 * joint.currentVel + 30 * q + 6 * w
    return { velocity = 0, force = u }
end

function sysCall_cleanup()
    if math.abs(sim.getJointPosition(hinge)) < 0.05 then print('passed') end
end
