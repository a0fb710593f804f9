-- scene: arm, object: /base, duration: 0.5
-- Finds a red cube in the bytes of a picture, and writes a picture back.
sim = require 'sim'

function sysCall_init()
    eye = sim.getObject('/eye')
end

function sysCall_sensing()
    local image, size = sim.getVisionSensorImg(eye)
    local n, columns = 0, 0
    for k = 0, size[1] * size[2] - 1 do
        local r, g, b = image:byte(3 * k + 1, 3 * k + 3)
        if r > 2 * g and r > 2 * b then n, columns = n + 1, columns + k % size[1] end
    end
    found = n > 80 and math.abs(columns / n - 31.5) < 3
end

function sysCall_cleanup()
    if found then print('passed') end
end
