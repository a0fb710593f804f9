-- scene: arm, object: /base, duration: 3
-- Joints in hybrid mode follow a group that each step solves; in kinematic mode they stay where they are put.
sim = require 'sim'
simIK = require 'simIK'

function sysCall_init()
    tip, target = sim.getObject('/tip'), sim.getObject('/target')
    joints = { sim.getObject('/joint1'), sim.getObject('/joint2'), sim.getObject('/joint3') }
    local environment = simIK.createEnvironment()
    local group = simIK.createGroup(environment, 'arm')
    simIK.setGroupCalculation(environment, group, simIK.method_damped_least_squares, 0.05, 50)
    simIK.addElementFromScene(environment, group, -1, tip, target, simIK.constraint_position)
    for _, joint in ipairs(joints) do sim.setJointMode(joint, sim.jointmode_ik, 1) end
    sim.setExplicitHandling(sim.getIkGroupHandle('arm'), 0)
end

function sysCall_sensing()
    if sim.getSimulationTime() > 1.9 and not reached then
        local p, q = sim.getObjectPosition(tip, -1), sim.getObjectPosition(target, -1)
        reached = math.max(math.abs(p[1] - q[1]), math.abs(p[2] - q[2]), math.abs(p[3] - q[3])) < 0.01
        sim.setExplicitHandling(sim.getIkGroupHandle('arm'), 1)
        for _, joint in ipairs(joints) do sim.setJointMode(joint, sim.jointmode_kinematic, 0) end
        sim.setJointPosition(joints[2], 0.25)
    end
end

function sysCall_cleanup()
    local mode, options = sim.getJointMode(joints[2])
    if reached and mode == 0 and options == 0 and sim.getJointPosition(joints[2]) == 0.25 then print('passed') end
end
