-- Where the line is under the five sensors, and what the wheels do about it. Lost lines are looked for on the side where they were last seen.
local places = {0.016, 0.008, 0.0, -0.008, -0.016}   -- [m], to the left

local function offset(u, memory)
    local sum, count = 0, 0
    for i, seen in ipairs(u.seen) do
        if seen > 0.5 then sum, count = sum + places[i], count + 1 end
    end
    if count > 0 then return sum / count end
    if memory.last > 0 then return 0.02 else return -0.02 end
end

function output(t, u, memory)
    local turn = gain * offset(u, memory)            -- [rad/s]
    return {(speed - turn * track / 2) / r, (speed + turn * track / 2) / r}
end

function update(t, u, memory)
    memory.last = offset(u, memory)
end
