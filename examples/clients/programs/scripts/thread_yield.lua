-- scene: arm, object: /base, duration: 3
-- A thread in stepping mode counts the steps that it makes; another script function is called meanwhile.
sim = require 'sim'

function sysCall_thread()
    sim.setStepping(true)
    local n, joint = 0, sim.getObject('./joint1')
    while sim.getSimulationTime() < 2 do
        sim.setJointTargetPosition(joint, 0.2 * math.sin(sim.getSimulationTime()))
        n = n + 1
        sim.step()
    end
    if n == 40 then print('passed') end
end
