-- scene: table, object: /floor, duration: 1
-- A contact callback lets a ball pass through the floor for a while.
sim = require 'sim'

function sysCall_init()
    ball = sim.getObject('/core')
    passes = 0
end

function sysCall_contact(inData)
    if inData.handle1 == ball or inData.handle2 == ball then
        passes = passes + 1
        return { ignoreContact = false, collisionResponse = false }
    end
end

function sysCall_cleanup()
    if passes > 0 and sim.getObjectPosition(ball)[3] < -1 then print('passed') end
end
