-- Searches of `simIK` with a function that says which configurations are good: all that are found are tried here.
local ik, of = ...
local find_config, find_configs, generate_path = ik.findConfig, ik.findConfigs, ik.generatePath

function ik.findConfig(env, group, joints, dist, time, metric, valid, aux)
  valid = of(valid)
  if not valid then return find_config(env, group, joints, dist, time, metric) end
  local all = find_configs(env, group, joints, { maxTime = time or 0.5, findMultiple = true })
  for _, config in ipairs(all) do
    if valid(config, aux) then return config end
  end
end

function ik.getConfigForTipPose(env, group, joints, dist, iterations, metric, valid, aux)
  return ik.findConfig(env, group, joints, dist, math.abs(iterations or 1000) / 1000, metric, valid, aux)
end

function ik.findConfigs(env, group, joints, params, others)
  local plain = {}
  for k, v in pairs(params or {}) do
    if k ~= 'cb' and k ~= 'auxData' then plain[k] = v end
  end
  local valid = params and of(params.cb)
  if valid then plain.findMultiple = true end
  local good = {}
  for _, config in ipairs(find_configs(env, group, joints, plain)) do
    if not valid or valid(config, params.auxData) then good[#good + 1] = config end
  end
  if valid and not params.findMultiple then good = { good[1] } end
  for _, config in ipairs(others or {}) do good[#good + 1] = config end
  return good
end

function ik.generatePath(env, group, joints, tip, n, valid, aux)
  valid = of(valid)
  local path = generate_path(env, group, joints, tip, n)
  if path and valid then
    for point = 0, n - 1 do
      local config = table.move(path, point * #joints + 1, (point + 1) * #joints, 1, {})
      if not valid(config, aux) then return nil end
    end
  end
  return path
end
