-- scene: arm, object: /base, duration: 0.1
-- The points that an arm reaches: random configurations, a cloud of points, their hull as a shape that is turned and saved.
sim = require 'sim'

function sysCall_init() done = false end

function sysCall_actuation()
    if done then return end
    done = true
    local joints = sim.getObjectsInTree(sim.getObject('.'), sim.object_joint_type)
    local tip = sim.getObjectsInTree(sim.getObject('.'), sim.object_shape_type)
    tip = tip[#tip]
    local before, points = {}, {}
    for k, joint in ipairs(joints) do before[k] = sim.getJointPosition(joint) end
    math.randomseed(1)
    for _ = 1, 200 do
        for _, joint in ipairs(joints) do sim.setJointPosition(joint, 2 * math.random() - 1) end
        for _, x in ipairs(sim.getObjectPosition(tip, -1)) do points[#points + 1] = x + 0.01 * math.random() end
    end
    for k, joint in ipairs(joints) do sim.setJointPosition(joint, before[k]) end
    local cloud = sim.addPointCloud(0, 255, sim.getObject('.'), 0, 5, points, { 255, 255, 255 })
    local vertices, indices = sim.getQHull(points)
    local hull = sim.createMeshShape(3, 0, vertices, indices)
    sim.reorientShapeBoundingBox(hull, -1)
    sim.setObjectAlias(hull, 'workspace')
    sim.exportMesh(0, '/tmp/somewhere/workspace.obj', 0, 1, vertices, indices)
    good = cloud > 0 and #vertices >= 12 and sim.getObjectInt32Param(hull, sim.shapeintparam_component_cnt) == 1
end

function sysCall_cleanup()
    if good then print('passed') end
end
