-- scene: rover, object: /goal, duration: 1
-- Plans the way of a puck around a wall, both made at run time, draws it and follows it point by point.
sim = require 'sim'
simOMPL = require 'simOMPL'

function sysCall_thread()
    local puck = sim.createPrimitiveShape(sim.primitiveshape_spheroid, { 0.1, 0.1, 0.1 })
    local wall = sim.createPrimitiveShape(sim.primitiveshape_cuboid, { 0.1, 1, 0.4 })
    sim.setObjectPosition(puck, { 5, 5, 2 })
    sim.setObjectPosition(wall, { 5.5, 5, 2 })
    local obstacles = sim.createCollection(0)
    sim.addItemToCollection(obstacles, sim.handle_single, wall, 0)

    local p = sim.getObjectPosition(puck)
    local task = simOMPL.createTask('t')
    simOMPL.setAlgorithm(task, simOMPL.Algorithm.BiTRRT)
    local spaces = { simOMPL.createStateSpace('2d', simOMPL.StateSpaceType.position2d, puck,
        { p[1] - 1, p[2] - 1 }, { p[1] + 1.5, p[2] + 1 }, 1) }
    simOMPL.setStateSpace(task, spaces)
    simOMPL.setCollisionPairs(task, { puck, obstacles })
    simOMPL.setStartState(task, { p[1], p[2] })
    simOMPL.setGoalState(task, { p[1] + 1, p[2] })
    simOMPL.setStateValidityCheckingResolution(task, 0.005)
    simOMPL.setup(task)
    local path
    while not path do
        if simOMPL.solve(task, 1) then
            simOMPL.simplifyPath(task, 1)
            simOMPL.interpolatePath(task, 100)
            path = simOMPL.getPath(task)
        end
        sim.step()
    end
    local lines = sim.addDrawingObject(sim.drawing_lines, 2, 0, -1, 999, { 0.2, 0.2, 0.2 })
    for k = 1, #path - 3, 2 do
        sim.addDrawingObjectItem(lines, { path[k], path[k + 1], p[3], path[k + 2], path[k + 3], p[3] })
    end
    local collisions = 0
    for k = 1, #path, 2 do
        sim.setObjectPosition(puck, { path[k], path[k + 1], p[3] })
        if sim.checkCollision(puck, obstacles) ~= 0 then collisions = collisions + 1 end
    end
    simOMPL.destroyTask(task)
    local x = sim.getObjectPosition(puck)[1]
    if collisions == 0 and #path >= 200 and math.abs(x - p[1] - 1) < 1e-6 then print('passed') end
end
