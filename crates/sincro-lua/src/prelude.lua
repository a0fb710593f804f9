-- What every script finds beside the libraries: errors that are texts and cannot be swallowed once a limit is reached, tables gone
-- through in an order that is the same in every run, threads, and the words of older Lua.
local host = ...
local raw_next, raw_pcall, raw_xpcall, raw_error = next, pcall, xpcall, error
local raw_resume, raw_create, yield = coroutine.resume, coroutine.create, coroutine.yield
local yieldable = coroutine.isyieldable
local type, rawget, rawlen, select, getmetatable, setmetatable = type, rawget, rawlen, select, getmetatable, setmetatable

-- errors: after a limit was reached each of these fails at once, so that nothing can go on for long
local function checked(ok, ...)
  host.check()
  if ok then return ok, ... end
  return false, host.text((...))
end

function pcall(f, ...)
  return checked(raw_pcall(f, ...))
end

function xpcall(f, handler, ...)
  -- a handler of an error that comes from the limit itself would run unwatched
  return checked(raw_xpcall(f, function(e)
    if host.is_stopped() then return host.text(e) end
    return handler(host.text(e))
  end, ...))
end

-- each coroutine has its own count of instructions, after which it yields by itself
local enter, leave = host.enter, host.leave

local function resumed(outer, ...)
  leave(outer)
  return checked(...)
end

function coroutine.resume(co, ...)
  host.check()
  return resumed(enter(), raw_resume(co, ...))
end

local function passed(outer, ok, ...)
  leave(outer)
  host.check()
  if ok then return ... end
  raw_error((host.text((...))), 0)
end

function coroutine.wrap(f)
  local co = raw_create(f)
  return function(...)
    host.check()
    return passed(enter(), raw_resume(co, ...))
  end
end

-- order: as it stands while no key is a text, else truth values, numbers and texts, each in their own order
local is_ordered = { boolean = true, number = true, string = true }

local function keys_of(t)
  local keys, n, texts, others = {}, 0, false, 0
  for k in raw_next, t do
    n = n + 1
    keys[n] = k
    local kind = type(k)
    if kind == 'string' then
      texts = true
    elseif not is_ordered[kind] then
      others = others + 1
    end
  end
  if others > 0 and n > 1 then
    raw_error('pairs: a table with tables or functions as keys has no order that is the same in every run', 3)
  end
  if texts then host.sort_keys(keys) end
  return keys, n
end

function pairs(t)
  local meta = getmetatable(t)
  local own = type(meta) == 'table' and meta.__pairs
  if own then
    local f, s, k = own(t)
    return f, s, k
  end
  if type(t) ~= 'table' then
    raw_error("bad argument #1 to 'pairs' (table expected, got " .. (t == nil and 'nil' or type(t)) .. ')', 2)
  end
  local keys, n = keys_of(t)
  local i = 0
  return function()
    while i < n do
      i = i + 1
      local v = rawget(t, keys[i])
      if v ~= nil then return keys[i], v end
    end
  end, t, nil
end

local walks = setmetatable({}, { __mode = 'k' })
function next(t, k)
  if k == nil then
    if raw_next(t) == nil then return nil end
    local keys, n = keys_of(t)
    local place = {}
    for i = 1, n do place[keys[i]] = i end
    walks[t] = { keys = keys, n = n, place = place }
  end
  local walk = walks[t]
  local i = k == nil and 0 or walk and walk.place[k]
  if not i then raw_error("invalid key to 'next'", 2) end
  while i < walk.n do
    i = i + 1
    local v = rawget(t, walk.keys[i])
    if v ~= nil then return walk.keys[i], v end
  end
end

-- tables as texts: lists as {1, 2, 3}, maps as {a=1}, what is deeper or longer than a line can show as ...
local tostring, print_texts, concat = tostring, print, table.concat
local MAX_DEPTH, MAX_ITEMS = 16, 5000

local as_text

local function table_as_text(t, state, depth)
  if depth > MAX_DEPTH or state[t] then return '{...}' end
  state[t] = true
  local out, n = {}, rawlen(t)
  local function add(text)
    state.n = state.n + 1
    if state.n > MAX_ITEMS then return false end
    out[#out + 1] = text
    return true
  end
  for i = 1, n do
    if not add(as_text(rawget(t, i), state, depth + 1)) then break end
  end
  local keys, has_others = {}, false
  for k in raw_next, t do
    local kind = type(k)
    if not is_ordered[kind] then
      has_others = true
    elseif not (math.type(k) == 'integer' and k >= 1 and k <= n) then
      keys[#keys + 1] = k
    end
  end
  host.sort_keys(keys)
  for i = 1, #keys do
    local k = keys[i]
    local name = type(k) == 'string' and k:find('^[%a_][%w_]*$') and k or '[' .. as_text(k, state, depth + 1) .. ']'
    if not add(name .. '=' .. as_text(rawget(t, k), state, depth + 1)) then break end
  end
  -- keys that are tables or functions have no order
  if has_others or state.n > MAX_ITEMS then out[#out + 1] = '...' end
  state[t] = nil
  return '{' .. concat(out, ', ') .. '}'
end

function as_text(value, state, depth)
  local kind = type(value)
  if kind == 'string' then return '"' .. value .. '"' end
  if kind ~= 'table' then return tostring(value) end
  local meta = getmetatable(value)
  if type(meta) == 'table' and (meta.__tostring or meta.__name) then return tostring(value) end
  return table_as_text(value, state, depth)
end

local function printed(value)
  if type(value) ~= 'table' then return value end
  return as_text(value, { n = 0 }, 1)
end

function print(...)
  local values, n = { ... }, select('#', ...)
  for i = 1, n do values[i] = printed(values[i]) end
  print_texts(table.unpack(values, 1, n))
end

function getAsString(...)
  local values, n = { ... }, select('#', ...)
  for i = 1, n do values[i] = tostring(printed(values[i])) end
  return concat(values, ', ', 1, n)
end

-- threads: where the script is one, it goes on at the next tick
local function switch()
  if yieldable() then
    yield()
  else
    raw_error('only a thread can wait for the next step; this script is called by the simulation', 3)
  end
end

local function wait(dt, simulated)
  local last = host.time()
  local stop = last + dt
  -- half a nanosecond: times are multiples of the step, sums of them are not
  while host.time() < stop - 5e-10 do
    switch()
    -- a thread that outlives a run waits for the rest in the next one, whose time begins anew
    local now = host.time()
    if now < last then stop = now + (stop - last) end
    last = now
  end
  return stop - host.time()
end

local function wait_for_signal(name)
  while true do
    local value = host.signal(name)
    if value ~= nil then return value end
    switch()
  end
end

-- what older Lua and V-REP's scripts call
unpack = table.unpack
loadstring = load
table.getn = function(t) return #t end
table.maxn = function(t)
  local most = 0
  for k in raw_next, t do
    if type(k) == 'number' and k > most then most = k end
  end
  return most
end

return { switch = switch, wait = wait, wait_for_signal = wait_for_signal }
