-- Functions that the Lua library of CoppeliaSim adds to `sim`, or that V-REP had for configurations: over functions of the session.
local sim = ...
local functions = {}

-- a copy of a table with all that is in it; `seen` has the tables that were copied
local function copy(value, seen)
  if type(value) ~= 'table' then return value end
  if seen[value] then return seen[value] end
  local result = {}
  seen[value] = result
  for k, v in pairs(value) do result[copy(k, seen)] = copy(v, seen) end
  return setmetatable(result, getmetatable(value))
end

function functions.copyTable(value) return copy(value, {}) end

function functions.copyMatrix(matrix)
  local result = {}
  for k = 1, 12 do result[k] = matrix[k] end
  return result
end

-- positions of joints, and the pose in its parent of the object at the top: what a configuration of V-REP has
local function configuration_of(objects)
  local configuration = { object = objects[1], pose = sim.getObjectPose(objects[1], sim.handle_parent), joints = {}, positions = {} }
  for _, object in ipairs(objects) do
    if sim.getObjectType(object) == sim.object_joint_type and sim.getJointType(object) ~= sim.joint_spherical_subtype then
      table.insert(configuration.joints, object)
      table.insert(configuration.positions, sim.getJointPosition(object))
    end
  end
  return configuration
end

-- where it is already the object at the top is not put: what is fixed in a model cannot be
local function configure(configuration)
  local object, pose = configuration.object, sim.getObjectPose(configuration.object, sim.handle_parent)
  for k = 1, 7 do
    if math.abs(pose[k] - configuration.pose[k]) > 1e-9 then
      sim.setObjectPose(object, configuration.pose, sim.handle_parent)
      break
    end
  end
  for k, joint in ipairs(configuration.joints) do sim.setJointPosition(joint, configuration.positions[k]) end
  return 1
end

function functions.getConfigurationTree(object)
  return sim.packTable(configuration_of(sim.getObjectsInTree(object, sim.handle_all, 0)))
end

function functions.getObjectConfiguration(object)
  return sim.packTable(configuration_of({ object }))
end

local function set_configuration(packed) return configure(sim.unpackTable(packed)) end
functions.setConfigurationTree = set_configuration
functions.setObjectConfiguration = set_configuration

return functions
