-- scene: table, object: /space/brick, duration: 0.1
-- Buoyancy as public scripts of V-REP 3 compute it: the surface of a body as voxels, the hull of those under water, its mass.
if sim_call_type == sim_childscriptcall_initialization then
    voxels = simCreateOctree(0.05, 0, 1)
    points = sim.createPointCloud(0.02, 20)
    own = simGetObjectAssociatedWithScript(sim_handle_self)
    n_steps, n_right = 0, 0
end

if sim_call_type == sim_childscriptcall_actuation then
    n_steps = n_steps + 1
    simRemoveVoxelsFromOctree(voxels, 0, nil)
    local n = simInsertObjectIntoOctree(voxels, own, 0)
    local centers = simGetOctreeVoxels(voxels)
    local low, high = math.huge, -math.huge
    for k = 3, table.getn(centers), 3 do
        low, high = math.min(low, centers[k]), math.max(high, centers[k])
    end
    -- the upper half is out of the water
    local dry = {}
    for k = 3, #centers, 3 do
        if centers[k] > 0.5 * (low + high) then
            for j = k - 2, k do dry[#dry + 1] = centers[j] end
        end
    end
    local left = simRemoveVoxelsFromOctree(voxels, 1, dry)
    local corners, indices = simGetQHull(simGetOctreeVoxels(voxels))
    local hull = simCreateMeshShape(1, 20, corners, indices)
    -- points in a plane have no hull
    local flat = simGetQHull({ 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0 })
    local found = simComputeMassAndInertia(hull, 1000)
    local mass, inertia, center = simGetShapeMassAndInertia(hull)
    simComputeMassAndInertia(hull, 2000)
    local is_twice = math.abs(simGetShapeMass(hull) - 2 * mass) < 1e-9 * mass
    local is_below = center[3] < 0.5 * (low + high) and center[3] > low
    local rest = sim.subtractObjectFromOctree(voxels, own, 0)
    simRemoveObject(hull)
    local n_points = sim.insertObjectIntoPointCloud(points, own, 0, 0.05)
    local n_kept = sim.subtractObjectFromPointCloud(points, own, 0, 0.05)
    if n * 3 == #centers and n > left and left > 0 and found == 1 and mass > 0 and inertia[1] > 0 and is_twice and is_below
        and rest == 0 and n_points == n and n_kept == 0 and flat == nil then
        n_right = n_right + 1
    end
end

if sim_call_type == sim_childscriptcall_cleanup then
    if n_steps > 0 and n_right == n_steps then print('passed') else print(n_steps, n_right) end
end
