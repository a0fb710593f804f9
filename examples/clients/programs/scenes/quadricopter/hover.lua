-- Height, then tilt, then yaw: proportional and derivative laws on the position of the target, mixed onto four propellers.
sim = require('sim')

function sysCall_init()
    base = sim.getObject('.')
    target = sim.getObject('./target')
    sim.setObjectParent(target, -1, true)
    propellers = {}
    joints = {}
    for i = 1, 4 do
        propellers[i] = sim.getObject('./propeller[' .. (i - 1) .. ']/respondable')
        joints[i] = sim.getObject('./propeller[' .. (i - 1) .. ']/joint')
    end
    local kind = sim.particle_roughspheres + sim.particle_cyclic + sim.particle_respondable1to4 + sim.particle_ignoresgravity
    jet = sim.addParticleObject(kind, 0.005, 8500, { 2, 1, 0.2, 3, 0.4 }, 0.5, 50, { 0.3, 0.7, 1 })
    shadow = sim.addDrawingObject(sim.drawing_discpts + sim.drawing_cyclic + sim.drawing_itemsizes, 0.2, 0, -1, 1)
    view = sim.floatingViewAdd(0.9, 0.9, 0.2, 0.2, 0)
    sim.adjustView(view, sim.getObject('./floorCamera'), 64)
    mass = sim.getShapeMass(base)
    for _, propeller in ipairs(propellers) do mass = mass + sim.getShapeMass(propeller) + 0.0001 end
end

function sysCall_actuation()
    local position = sim.getObjectPosition(base, sim.handle_world)
    sim.addDrawingObjectItem(shadow, { position[1], position[2], 0.002, 0, 0, 0, 1, 0.2 * sim.getObjectSizeFactor(base) })
    local velocity, rates = sim.getVelocity(base)
    local matrix = sim.getObjectMatrix(base, sim.handle_world)
    local goal = sim.getObjectPosition(target, sim.handle_world)
    local wanted = {}
    for k = 1, 3 do wanted[k] = 4 * (goal[k] - position[k]) - 3.5 * velocity[k] end
    for k = 1, 2 do wanted[k] = math.max(-2, math.min(2, wanted[k])) end
    wanted[3] = math.max(0, 9.81 + wanted[3])
    -- the propellers' axis is to point along the wanted force
    local length = math.sqrt(wanted[1] ^ 2 + wanted[2] ^ 2 + wanted[3] ^ 2)
    local axis = { matrix[3], matrix[7], matrix[11] }
    local error = {
        (axis[2] * wanted[3] - axis[3] * wanted[2]) / length,
        (axis[3] * wanted[1] - axis[1] * wanted[3]) / length,
    }
    local inverse = sim.getMatrixInverse(matrix)
    inverse[4], inverse[8], inverse[12] = 0, 0, 0
    local tilt = sim.multiplyVector(inverse, { error[1], error[2], 0 })
    local rate = sim.multiplyVector(inverse, rates)
    local lift = mass * (axis[1] * wanted[1] + axis[2] * wanted[2] + axis[3] * wanted[3]) / 4
    local roll = 0.0008 * (40 * tilt[1] - 9 * rate[1]) / 0.52
    local pitch = 0.0008 * (40 * tilt[2] - 9 * rate[2]) / 0.52
    -- places of the propellers: ++, -+, --, +-
    local signs = { { 1, -1 }, { 1, 1 }, { -1, 1 }, { -1, -1 } }
    local turned = sim.getObjectMatrix(base, sim.handle_world)
    turned[4], turned[8], turned[12] = 0, 0, 0
    for i, propeller in ipairs(propellers) do
        sim.setJointPosition(joints[i], 10 * sim.getSimulationTime())
        local thrust = lift + signs[i][1] * roll + signs[i][2] * pitch
        sim.addForceAndTorque(propeller, sim.multiplyVector(turned, { 0, 0, math.max(0, thrust) }), { 0, 0, 0 })
    end
    sim.setFloatSignal('height', position[3])
end

function sysCall_cleanup()
    sim.removeParticleObject(jet)
    sim.removeDrawingObject(shadow)
    sim.floatingViewRemove(view)
end
