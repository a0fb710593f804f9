-- scene: rover, object: /rover, duration: 1
-- Words of Lua 5.1, which V-REP and CoppeliaSim up to 4.1 ran: `goto` is a name there, and table.getn counts.
function sysCall_init()
    motors = { sim.getObjectHandle('leftMotor'), sim.getObjectHandle('rightMotor') }
    target = { 1, 0 }
    n_calls = 0
end

-- Drives towards a point: a name that Lua 5.2 made a keyword.
function goto(point, speed)
    local place = sim.getObjectPosition(sim.getObjectHandle(sim.handle_self), -1)
    local ahead = math.mod(math.atan2(point[2] - place[2], point[1] - place[1]), math.pi)
    n_calls = n_calls + 1
    return speed - ahead, speed + ahead
end

function sysCall_actuation()
    local speeds = { goto(target, 2) }
    for k = 1, table.getn(motors) do sim.setJointTargetVelocity(motors[k], speeds[k]) end
end

function sysCall_sensing()
    -- others find it by the name that it has in the text
    if sim.getSimulationTime() > 0.5 and not called then
        called = sim.callScriptFunction('goto@rover', sim.scripttype_childscript, { 1, 0 }, 3)
    end
end

function sysCall_cleanup()
    if n_calls == 21 and called and math.abs(called - 3) < 0.1 then print('passed') else print(n_calls, called) end
end
