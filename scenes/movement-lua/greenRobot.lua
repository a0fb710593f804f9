-- The target goes up and down, turns about x and back; the arm's own script brings the tip there.
function sysCall_thread()
    local target = sim.getObject('.')
    local start = sim.getObjectPose(target)
    local up = { table.unpack(start) }
    up[3] = up[3] + 0.2
    local turned = sim.rotateAroundAxis(start, { 1, 0, 0 }, { start[1], start[2], start[3] }, math.pi / 2)
    for _, goal in ipairs { up, start, turned, start } do
        sim.moveToPose {
            object = target, targetPose = goal,
            maxVel = { 0.5, 0.5, 0.5, 0.5 }, maxAccel = { 0.1, 0.1, 0.1, 1 }, maxJerk = { 3, 3, 3, 3 },
        }
        print(string.format('there after %.2f s', sim.getSimulationTime()))
    end
end
