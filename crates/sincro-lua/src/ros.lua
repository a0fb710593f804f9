-- `simROS`, `simROS2` and `simB0`: topics between the scripts of the scene. There is no ROS: nothing leaves the program.
local sim, advertise, subscribe, publish, shut_down, take, refuse = ...
local callbacks = {}
-- messages of nodes of BlueZero, which wait until the node spins
local waiting, is_node = {}, {}

local function topic_of(name, f)
  if type(name) ~= 'string' then error("argument 1 is no name of a topic (in function '" .. f .. "')", 3) end
  return name
end

-- a function, or the name of one that is there when a message comes
local function listen(name, callback, capacity, f)
  local handle = subscribe(topic_of(name, f), capacity)
  callbacks[handle] = callback
  return handle
end

local function hand(message)
  local f = callbacks[message[1]]
  if type(f) == 'string' then
    local name = f
    f = _G[name]
    if type(f) ~= 'function' then error('there is no function `' .. name .. '` to call with a message') end
  end
  if f then f(message[2]) end
end

local function deliver()
  for _, message in ipairs(take()) do
    if is_node[message[1]] then waiting[#waiting + 1] = message else hand(message) end
  end
end

local function spin()
  deliver()
  local messages = waiting
  waiting = {}
  for _, message in ipairs(messages) do hand(message) end
end

local function close(handle)
  shut_down(handle)
  callbacks[handle] = nil
end

-- what changes how strings are converted: here strings are bytes already
local function nothing() end

local function picture(data, width, height, frame)
  return {
    header = { frame_id = frame or '' }, width = width, height = height, encoding = 'rgb8', is_bigendian = 0,
    step = 3 * width, data = data,
  }
end

local function transforms(list)
  local handle = advertise('tf', false)
  publish(handle, { transforms = list })
  shut_down(handle)
end

local common = {
  publish = publish, shutdownPublisher = close, publisherTreatUInt8ArrayAsString = nothing,
  imageTransportPublish = function(handle, data, width, height, frame)
    publish(handle, picture(data, width, height, frame))
  end,
  imageTransportShutdownPublisher = close,
  sendTransform = function(transform) transforms({ transform }) end,
  sendTransforms = transforms,
}

local ros = {
  advertise = function(name, _, _, latches)
    return advertise(topic_of(name, 'simROS.advertise'), latches and latches ~= 0 or false)
  end,
  subscribe = function(name, _, callback, capacity) return listen(name, callback, capacity or 1, 'simROS.subscribe') end,
  shutdownSubscriber = close, subscriberTreatUInt8ArrayAsString = nothing,
  imageTransportAdvertise = function(name)
    return advertise(topic_of(name, 'simROS.imageTransportAdvertise'), false)
  end,
  imageTransportSubscribe = function(name, callback, capacity)
    return listen(name, callback, capacity or 1, 'simROS.imageTransportSubscribe')
  end,
  imageTransportShutdownSubscriber = close,
  getTime = function() return sim.getSimulationTime() end,
}

-- ten messages, as ROS 2 keeps them unless told otherwise
local function stamp()
  local t = sim.getSimulationTime()
  local seconds = math.floor(t)
  return { sec = seconds, nanosec = math.floor((t - seconds) * 1e9) }
end
local ros2 = {
  createPublisher = function(name) return advertise(topic_of(name, 'simROS2.createPublisher'), false) end,
  createSubscription = function(name, _, callback) return listen(name, callback, 10, 'simROS2.createSubscription') end,
  shutdownSubscription = close, subscriptionTreatUInt8ArrayAsString = nothing,
  imageTransportCreatePublisher = function(name)
    return advertise(topic_of(name, 'simROS2.imageTransportCreatePublisher'), false)
  end,
  imageTransportCreateSubscription = function(name, callback)
    return listen(name, callback, 10, 'simROS2.imageTransportCreateSubscription')
  end,
  imageTransportShutdownSubscription = close, spinSome = deliver,
  getTime = stamp, getSystemTime = stamp, getSimulationTime = stamp,
}

-- a node is no more than a number: its publishers and subscribers are those of the script
local n_nodes = 0
local b0 = {
  nodeCreate = function()
    n_nodes = n_nodes + 1
    return n_nodes
  end,
  nodeInit = nothing, nodeCleanup = nothing, nodeDestroy = nothing, nodeSpinOnce = spin,
  publisherCreate = function(_, name) return advertise(topic_of(name, 'simB0.publisherCreate'), false) end,
  publisherPublish = publish, publisherInit = nothing, publisherCleanup = nothing, publisherDestroy = close,
  subscriberCreate = function(_, name, callback)
    local handle = listen(name, callback, 100, 'simB0.subscriberCreate')
    is_node[handle] = true
    return handle
  end,
  subscriberSpinOnce = spin, subscriberInit = nothing, subscriberCleanup = nothing, subscriberDestroy = close,
  pingResolver = function() return true end,
}
for old, present in pairs {
  create = 'nodeCreate', init = 'nodeInit', cleanup = 'nodeCleanup', destroy = 'nodeDestroy', spinOnce = 'nodeSpinOnce',
  createPublisher = 'publisherCreate', destroyPublisher = 'publisherDestroy',
  createSubscriber = 'subscriberCreate', destroySubscriber = 'subscriberDestroy',
} do
  b0[old] = b0[present]
end

local function finish(module, name, prefix)
  for function_name, f in pairs(common) do module[function_name] = module[function_name] or f end
  if prefix then
    for function_name, f in pairs(module) do _G[prefix .. function_name] = f end
  end
  _G[name] = setmetatable(module, {
    __index = function(_, key) return function() refuse(name .. '.' .. tostring(key)) end end,
  })
end
-- the second is the name of V-REP 3.3 and 3.4
finish(ros, 'simROS', 'simExtRosInterface_')
finish(ros2, 'simROS2')
finish(b0, 'simB0')
return ros, ros2, b0, deliver
