-- Turns the camera after what is red in its picture.

function sysCall_init()
    eye = sim.getObject('/pole/pan/head/eye')
    pan = sim.getObject('/pole/pan')
    local angle = sim.getObjectFloatParam(eye, sim.visionfloatparam_perspective_angle)
    width, height = table.unpack(sim.getVisionSensorRes(eye))
    pixel = 2 * math.tan(angle / 2) / width
end

-- Column and row of the centroid of all red pixels, from the lower left one, and how many there are.
local function centroid(image)
    local n, columns, rows = 0, 0, 0
    for row = 0, height - 1 do
        for column = 0, width - 1 do
            local at = 3 * (row * width + column)
            local red, green = string.byte(image, at + 1, at + 2)
            if red > 3 * green then
                n, columns, rows = n + 1, columns + column, rows + row
            end
        end
    end
    if n == 0 then
        error('nothing red is in the picture')
    end
    return columns / n, rows / n, n
end

function sysCall_sensing()
    local column, row, n = centroid(sim.getVisionSensorImg(eye))
    sim.setFloatSignal('ball_column', column)
    sim.setFloatSignal('ball_row', row)
    sim.setFloatSignal('ball_pixels', n)
    -- what is to the right is reached by turning clockwise
    local right = (column - (width - 1) / 2) * pixel
    sim.setJointTargetVelocity(pan, -20 * right)
end
