-- scene: arm, object: /base, duration: 0.5
-- Writes joint angles into a file on somebody's desk and reads them again at the end, as logging scripts do.
function sysCall_init()
    sim = require('sim')
    joint = sim.getObject('/joint2')
    path = 'C:/Users/somebody/Desktop/angles.csv'
    local file = io.open(path, 'w')
    file:write('time,angle\n')
    file:close()
end

function sysCall_sensing()
    local file = io.open(path, 'a')
    file:write(string.format('%.3f', sim.getSimulationTime()), ',', sim.getJointPosition(joint), '\n')
    file:close()
end

function sysCall_cleanup()
    local n, last = 0, nil
    for line in io.open(path):lines() do
        n, last = n + 1, line
    end
    if n == 11 and last:match('^0%.450') then print('passed') else print(n, last) end
end
