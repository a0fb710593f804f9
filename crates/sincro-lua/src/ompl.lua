-- `simOMPL` with a function of the script that says which states are good, and its names of V-REP 3.
local ompl, of, search = ...
local solve, simplify, is_valid = ompl.solve, ompl.simplifyPath, ompl.isStateValid
local valid = {}

function ompl.setStateValidationCallback(task, callback)
  ompl.getStateSpaceDimension(task)
  valid[task] = of(callback)
end

-- the function may move what it looks at: it is put back
local function put_back(task, call, ...)
  local before = ompl.readState(task)
  local results = table.pack(pcall(call, ...))
  local after = ompl.readState(task)
  for k, x in ipairs(before) do
    if x ~= after[k] then
      ompl.writeState(task, before)
      break
    end
  end
  if not results[1] then error(results[2], 0) end
  return results[2]
end

function ompl.solve(task, seconds)
  if not valid[task] then return solve(task, seconds or -1) end
  return put_back(task, search, task, 'solve', seconds or -1, valid[task])
end

function ompl.simplifyPath(task, seconds)
  if not valid[task] then return simplify(task, seconds or -1) end
  put_back(task, search, task, 'simplify', seconds or -1, valid[task])
end

function ompl.isStateValid(task, state)
  if not valid[task] then return is_valid(task, state) end
  local found = put_back(task, valid[task], state)
  return found and found ~= 0
end

local compute = ompl.compute
function ompl.compute(task, seconds, simplification, n)
  if not valid[task] then return compute(task, seconds, simplification or -1, n or 0) end
  if not ompl.solve(task, seconds) then return false, {} end
  ompl.simplifyPath(task, simplification)
  ompl.interpolatePath(task, n or 0)
  return true, ompl.getPath(task)
end

local info = ompl.printTaskInfo
function ompl.printTaskInfo(task) print(info(task)) end

-- V-REP 3: numbers for truth values, 1 where there is no result, no path where none was found
for name, f in pairs(ompl) do
  if type(f) == 'function' then
    _G['simExtOMPL_' .. name] = function(...)
      local results = table.pack(f(...))
      if results.n == 0 then return 1 end
      if name == 'compute' and not results[1] then return 0, nil end
      if type(results[1]) == 'boolean' then results[1] = results[1] and 1 or 0 end
      return table.unpack(results, 1, results.n)
    end
  end
end
