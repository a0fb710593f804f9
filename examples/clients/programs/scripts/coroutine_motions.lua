-- scene: arm, object: /base, duration: 4
-- Motions that wait, called in a coroutine of the script itself; the callback and the other phases go on meanwhile.
sim = require 'sim'

function coroutineMain()
    local joints = { sim.getObject('./joint1'), sim.getObject('/joint2') }
    local calls = 0
    sim.moveToConfig {
        joints = joints, targetPos = { 0.5, 0.8 }, maxVel = { 1, 1 }, maxAccel = { 2, 2 }, maxJerk = { 10, 10 },
    }
    local first = sim.getSimulationTime()
    sim.setThreadAutomaticSwitch(false)
    for _ = 1, 5 do sim.switchThread() end
    sim.setThreadAutomaticSwitch(true)
    for _ = 1, 3000000 do calls = calls + 1 end
    if first > 0.5 and sim.getSimulationTime() > first + 0.3 and steps > 10 then print('passed') end
end

function sysCall_init()
    steps = 0
    corout = coroutine.create(coroutineMain)
end

function sysCall_actuation()
    steps = steps + 1
    if coroutine.status(corout) ~= 'dead' then
        local ok, message = coroutine.resume(corout)
        if message then error(debug.traceback(corout, message), 2) end
    end
end
