-- `simROS` and `simROS2`: topics between the scripts of the scene. There is no ROS: nothing leaves the program.
local sim, advertise, subscribe, publish, shut_down, take, refuse = ...
local callbacks = {}

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

local function deliver()
  for _, message in ipairs(take()) do
    local f = callbacks[message[1]]
    if type(f) == 'string' then
      local name = f
      f = _G[name]
      if type(f) ~= 'function' then error('there is no function `' .. name .. '` to call with a message') end
    end
    if f then f(message[2]) end
  end
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
  imageTransportShutdownSubscription = close,
  getTime = stamp, getSystemTime = stamp, getSimulationTime = stamp,
}

local function finish(module, name, prefix)
  for function_name, f in pairs(common) do module[function_name] = f end
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
return ros, ros2, deliver
