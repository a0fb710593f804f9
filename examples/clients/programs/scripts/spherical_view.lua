-- scene: table, object: /floor, duration: 0.1
-- A picture of all directions, as the model of a spherical sensor makes it: six sensors that a passive one puts together.
function sysCall_init()
    sim = require 'sim'
    simVision = require 'simVision'
    local options = 1 + 2 -- handled by the script, perspective
    local numbers = { 0.01, 10, math.pi / 2, 0.1, 0, 0, 0.8, 0.8, 0.8, 0, 0 }
    six = {}
    -- ahead, up, back, down, left, right, from a place above everything
    local turns = { { 0, 90, 90 }, { 0, 180, 90 }, { 0, -90, -90 }, { 0, 0, 90 }, { -90, 0, 0 }, { 90, 0, 180 } }
    for k, turn in ipairs(turns) do
        six[k] = sim.createVisionSensor(options, { 32, 32, 0, 0 }, numbers)
        sim.setObjectPosition(six[k], { 0, 0, 50 }, sim.handle_world)
        sim.setObjectOrientation(six[k], { math.rad(turn[1]), math.rad(turn[2]), math.rad(turn[3]) }, sim.handle_world)
    end
    all = sim.createVisionSensor(1 + 16, { 36, 18, 0, 0 }, numbers)
    distances = sim.createVisionSensor(1 + 16, { 36, 18, 0, 0 }, numbers)
    -- a red ball in the middle of what the first one sees
    ball = sim.createPrimitiveShape(sim.primitiveshape_spheroid, { 1, 1, 1 }, 0)
    local m = sim.getObjectMatrix(six[1], sim.handle_world)
    sim.setObjectPosition(ball, { m[4] + 2 * m[3], m[8] + 2 * m[7], m[12] + 2 * m[11] }, sim.handle_world)
    sim.setShapeColor(ball, nil, sim.colorcomponent_ambient_diffuse, { 1, 0, 0 })
end

local function red(bytes, column, row)
    local r, g, b = bytes:byte(3 * (column + 36 * row) + 1, 3 * (column + 36 * row) + 3)
    return r > 2 * g + 20 and r > 2 * b + 20
end

function sysCall_sensing()
    simVision.handleSpherical(all, six, 2 * math.pi, math.pi, distances)
    local picture = sim.getVisionSensorImg(all)
    local range = sim.getVisionSensorImg(distances)
    -- the ball is ahead, and nowhere else
    local is_ahead = red(picture, 17, 9) and not (red(picture, 0, 9) or red(picture, 9, 9) or red(picture, 27, 9) or red(picture, 17, 0))
    local near, far = range:byte(3 * (17 + 36 * 9) + 1), range:byte(1)
    local is_near = near > 20 and near < 60 and far == 255
    is_right = is_ahead and is_near
    if not is_right then print(is_ahead, near, far) end
end

function sysCall_cleanup()
    if is_right then print('passed') end
end
