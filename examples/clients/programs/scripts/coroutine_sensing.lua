-- scene: arm, object: /base, duration: 1
-- Two coroutines resumed in sensing: one computes for long without a yield, one waits for signals, times and steps; an iterator stays whole.
sim = require 'sim'

local function squares(n)
    return coroutine.wrap(function()
        for k = 1, n do coroutine.yield(k * k) end
    end)
end

local function compute()
    local rounds, sum = 0, 0
    while true do
        rounds = rounds + 1
        for square in squares(1000) do sum = sum + square end
        if sum ~= rounds * 333833500 then error('a value is lost') end
        sim.setInt32Signal('rounds', rounds)
    end
end

local function waiting()
    sim.waitForSignal('rounds')
    sim.switchThread()
    local start = sim.getSimulationTime()
    sim.wait(0.3)
    waited = sim.getSimulationTime() - start
    sim.step()
    rounds = sim.getInt32Signal('rounds')
end

function sysCall_init()
    threads = { coroutine.create(compute), coroutine.create(waiting) }
end

function sysCall_sensing()
    for _, thread in ipairs(threads) do
        if coroutine.status(thread) ~= 'dead' then
            local ok, message = coroutine.resume(thread)
            if not ok then error(message) end
        end
    end
end

function sysCall_cleanup()
    if coroutine.status(threads[2]) == 'dead' and math.abs(waited - 0.3) < 0.06 and rounds > 1 then print('passed') end
end
