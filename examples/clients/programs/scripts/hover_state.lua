-- scene: quadricopter, object: /ground, duration: 4
-- Beside the copter's own script: another one leads its target and watches by customization of the hierarchy.
sim = require 'sim'

function sysCall_init()
    copter, target = sim.getObject('/Quadricopter/base'), sim.getObject('/Quadricopter/base/target', { noError = true })
    if target == -1 then target = sim.getObject('/target') end
    corout = coroutine.create(function()
        for _, height in ipairs { 0.8, 1.0 } do
            sim.setObjectPosition(target, { 0.2, 0, height })
            local stop = sim.getSimulationTime() + 2
            while sim.getSimulationTime() < stop do coroutine.yield() end
        end
    end)
end

function sysCall_actuation()
    if coroutine.status(corout) ~= 'dead' then
        local ok, message = coroutine.resume(corout)
        if not ok then error(debug.traceback(corout, message), 2) end
    end
end

function sysCall_cleanup()
    local p = sim.getObjectPosition(copter, sim.handle_world)
    if math.abs(p[1] - 0.2) < 0.05 and math.abs(p[3] - 1.0) < 0.05 then sim.addLog(sim.verbosity_scriptinfos, 'passed') end
end
