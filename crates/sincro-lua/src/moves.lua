-- Motions that wait: what the session knows of one step (`host.init`, `step`, `cleanup` of each) goes on from step to step of the thread that calls.
-- Callbacks and their data stay here: functions cannot leave the script.
local host = ...
local callbacks = setmetatable({}, { __mode = 'k' })
local forms = {}

-- a copy without what stays here
local function plain(t)
  local copy = {}
  for k, v in pairs(t) do
    if k ~= 'callback' and k ~= 'auxData' then copy[k] = v end
  end
  return copy
end

for _, stem in ipairs { 'moveToConfig', 'moveToPose' } do
  local raw = host[stem]
  local form = {}
  forms[stem] = form

  function form.init(params)
    if type(params) ~= 'table' then error('a table of parameters is expected (in function \'sim.' .. stem .. '_init\')', 2) end
    local callback = params.callback
    if type(callback) == 'string' then
      if type(_G[callback]) ~= 'function' then error('there is no function `' .. callback .. '` to call back', 2) end
      callback = _G[callback]
    end
    local data = raw.init(plain(params))
    data.auxData = params.auxData
    callbacks[data] = callback
    return data
  end

  function form.step(data)
    local callback, aux = callbacks[data], data.auxData
    local result, now = raw.step(plain(data), callback ~= nil)
    for k, v in pairs(now) do data[k] = v end
    if callback then
      local stop
      if data.legacyFunc then
        local place = data.pos
        if data.pose then place = data.useMatrices and data.matrix or data.pose end
        stop = callback(place, data.vel, data.accel, aux)
      else
        stop = callback(data)
      end
      if stop then result = 2 end
    end
    return result, data
  end

  function form.cleanup(data)
    callbacks[data] = nil
    if data.ruckigObj then raw.cleanup(plain(data)) end
    data.ruckigObj, data.ik = nil, nil
  end
end

-- callback and data of the older forms, by their places
local places = { moveToConfig = { 10, 11 }, moveToPose = { 7, 8 } }

local function waiting(name, stem)
  local form = forms[stem]
  return function(...)
    if not host.yieldable() then
      error('sim.' .. name .. ' waits for the simulation: call it in a thread (sysCall_thread), or use sim.' .. stem
        .. '_init, _step and _cleanup', 2)
    end
    local given, n = { ... }, select('#', ...)
    local callback, aux
    if type(given[1]) == 'table' and places[name] then
      callback, aux = given[1].callback, given[1].auxData
      given = { plain(given[1]) }
      n = 1
    elseif places[name] then
      callback, aux = given[places[name][1]], given[places[name][2]]
      given[places[name][1]], given[places[name][2]] = nil, nil
    end
    local params = host.parameters(name, table.unpack(given, 1, n))
    params.callback, params.auxData = callback, aux
    local level = host.stepping(true)
    local data = form.init(params)
    local result
    repeat
      result = form.step(data)
      host.switch()
    until result ~= 0
    form.cleanup(data)
    host.stepping(level)
    data.auxData = nil
    local results = table.pack(host.results(name, data))
    if results.n == 1 and type(results[1]) == 'table' and not data.legacyFunc then
      data.auxData = aux
      return data
    end
    return table.unpack(results, 1, results.n)
  end
end

-- V-REP's motion along a path object: from a share of its length on to its end, or with a negative velocity back to its
-- start; the velocity grows by the acceleration
local function follow_path(object, path, what, from, velocity, acceleration)
  if not host.yieldable() then
    error('sim.followPath waits for the simulation: call it in a thread (sysCall_thread)', 2)
  end
  if not (velocity ~= 0 and velocity == velocity) then error('sim.followPath: the velocity is 0', 2) end
  local back = velocity < 0
  velocity, acceleration = math.abs(velocity), math.abs(acceleration or 0)
  local sim, along = host.sim, host.path
  local total, dt = along.length(path), sim.getSimulationTimeStep()
  local way = (back and from or 1 - from) * total
  local s, v = 0, acceleration > 0 and 0 or velocity
  local level = host.stepping(true)
  repeat
    v = math.min(velocity, v + acceleration * dt)
    s = math.min(way, s + v * dt)
    local share = back and 0 or 1
    if s < way then share = (back and way - s or total - way + s) / total end
    if what ~= 2 then sim.setObjectPosition(object, -1, along.position(path, share)) end
    if what == nil or what == 2 or what == 3 then sim.setObjectOrientation(object, -1, along.orientation(path, share)) end
    host.switch()
  until s >= way
  host.stepping(level)
  return 0
end

-- numbers that grow together along a straight line of a length, with a velocity that grows by the
-- acceleration: at once without one
local function go_along(name, way, velocity, acceleration, place)
  if not host.yieldable() then
    error('sim.' .. name .. ' waits for the simulation: call it in a thread (sysCall_thread)', 3)
  end
  if not (velocity > 0) then error('sim.' .. name .. ': the velocity is not positive', 3) end
  acceleration = math.abs(acceleration or math.huge)
  if not (acceleration > 0) then error('sim.' .. name .. ': the acceleration is 0: leave it out for a constant velocity', 3) end
  local dt, s = host.sim.getSimulationTimeStep(), 0
  local v = acceleration < math.huge and 0 or velocity
  local level = host.stepping(true)
  repeat
    v = math.min(velocity, v + acceleration * dt)
    s = math.min(way, s + v * dt)
    place(way > 0 and s / way or 1)
    host.switch()
  until s >= way
  host.stepping(level)
  return 0
end

-- V-REP's joints to positions, all at the same time; a turn of 1 rad counts as 0.1 m
local function move_to_joint_positions(joints, positions, velocity, acceleration, factor)
  local sim, from, way = host.sim, {}, 0
  for k, joint in ipairs(joints) do
    from[k] = sim.getJointPosition(joint)
    local turns = sim.getJointType(joint) == sim.joint_revolute_subtype
    way = math.max(way, math.abs(positions[k] - from[k]) * (turns and (factor or 0.1) or 1))
  end
  return go_along('moveToJointPositions', way, velocity or 1, acceleration, function(share)
    for k, joint in ipairs(joints) do
      local q = from[k] + share * (positions[k] - from[k])
      -- one without a motor is put there, as V-REP does with passive ones
      if sim.getJointMode(joint) == sim.jointmode_dynamic and sim.getObjectInt32Param(joint, 2000) ~= 0 then
        sim.setJointTargetPosition(joint, q)
      else
        sim.setJointPosition(joint, q)
      end
    end
  end)
end

-- V-REP's object to the pose of another one, or of a place on a path; a turn of 1 rad counts as 0.1 m
local function move_to_object(object, target, what, place, velocity, acceleration)
  local sim = host.sim
  local from, to = sim.getObjectPose(object, -1), nil
  local is_path, at = pcall(host.path.position, target, place or 0)
  if place and is_path then
    to = sim.buildPose(at, host.path.orientation(target, place))
  else
    to = sim.getObjectPose(target, -1)
  end
  what = what or 3
  if what == 1 then for k = 4, 7 do to[k] = from[k] end end
  if what == 2 then for k = 1, 3 do to[k] = from[k] end end
  local straight = math.sqrt((to[1] - from[1]) ^ 2 + (to[2] - from[2]) ^ 2 + (to[3] - from[3]) ^ 2)
  local _, angle = sim.getRotationAxis(sim.poseToMatrix(from), sim.poseToMatrix(to))
  local way = math.max(straight, 0.1 * math.abs(angle))
  return go_along('moveToObject', way, velocity or 1, acceleration, function(share)
    sim.setObjectPose(object, sim.interpolatePoses(from, to, share), -1)
  end)
end

local functions = { followPath = follow_path, moveToJointPositions = move_to_joint_positions, moveToObject = move_to_object }
for stem, form in pairs(forms) do
  functions[stem .. '_init'] = form.init
  functions[stem .. '_step'] = form.step
  functions[stem .. '_cleanup'] = form.cleanup
end
for name, stem in pairs(host.names) do functions[name] = waiting(name, stem) end
return functions
