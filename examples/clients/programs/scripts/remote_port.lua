-- scene: arm, object: /base, duration: 0.1
-- The line of the tutorials that opens a port: without a server it says so, and the run goes on.
function sysCall_init()
    sim = require('sim')
    result = simRemoteApi.start(19999)
end

function sysCall_cleanup()
    if result == -1 and simExtRemoteApiStart(19999) == -1 then print('passed') end
end
