-- As the blue one, with more acceleration and jerk.
function sysCall_thread()
    local joints = {}
    for i = 1, 7 do joints[i] = sim.getObject('./joint', { index = i - 1 }) end
    local deg = math.pi / 180
    for _, goal in ipairs { { 90, 90, 170, -90, 90, 90, 0 }, { -90, 90, 180, -90, 90, 90, 0 }, { 0, 0, 0, 0, 0, 0, 0 } } do
        for i = 1, 7 do goal[i] = goal[i] * deg end
        sim.moveToConfig { joints = joints, targetPos = goal, maxVel = 110 * deg, maxAccel = 100 * deg, maxJerk = 200 * deg }
        print(string.format('there after %.2f s', sim.getSimulationTime()))
    end
end
