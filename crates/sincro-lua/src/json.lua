-- Module `dkjson`, also `json`: texts of JSON (RFC 8259) from tables and back, called as the module of that name.
local type, tostring, tonumber, pairs, rawget, getmetatable, setmetatable, error, select, pcall =
  type, tostring, tonumber, pairs, rawget, getmetatable, setmetatable, error, select, pcall
local find, match, sub, byte, char, format, gsub, rep, concat = string.find, string.match, string.sub, string.byte, string.char, string.format,
  string.gsub, string.rep, table.concat
local math_type, utf8_char = math.type, utf8.char

local json = { version = 'dkjson 2.5' }
local object_meta, array_meta = { __jsontype = 'object' }, { __jsontype = 'array' }
json.null = setmetatable({}, { __tojson = function() return 'null' end })

-- texts

local short = { ['"'] = '\\"', ['\\'] = '\\\\', ['\b'] = '\\b', ['\f'] = '\\f', ['\n'] = '\\n', ['\r'] = '\\r', ['\t'] = '\\t' }

local function escaped(c) return short[c] or format('\\u%04x', byte(c)) end

function json.quotestring(text)
  text = gsub(text, '[%c"\\\127]', escaped)
  -- ends of lines in JavaScript
  text = gsub(text, '\226\128\168', '\\u2028')
  text = gsub(text, '\226\128\169', '\\u2029')
  return '"' .. text .. '"'
end

-- number of elements of a list; nil for what is none: other keys, or more holes than elements
local function length(t)
  local most, n = 0, 0
  for k, v in pairs(t) do
    if k == 'n' and math_type(v) == 'integer' then
      if v > most then most = v end
    elseif math_type(k) == 'integer' and k > 0 then
      if k > most then most = k end
      n = n + 1
    else
      return nil
    end
  end
  if most > 10 and most > 2 * n then return nil end
  return most
end

local encode

local function break_line(out, state, level)
  if state.indent then out[#out + 1] = '\n' .. rep('  ', level) end
end

local function encode_list(out, t, n, state, level)
  out[#out + 1] = '['
  for k = 1, n do
    if k > 1 then out[#out + 1] = ',' end
    break_line(out, state, level + 1)
    encode(out, t[k], state, level + 1)
  end
  if n > 0 then break_line(out, state, level) end
  out[#out + 1] = ']'
end

local function encode_map(out, t, order, state, level)
  local is_first, done = true, {}
  out[#out + 1] = '{'
  local function pair(k, v)
    local kind = type(k)
    if kind ~= 'string' and kind ~= 'number' then error("type '" .. kind .. "' is not supported as a key by JSON.", 0) end
    if not is_first then out[#out + 1] = ',' end
    is_first = false
    break_line(out, state, level + 1)
    out[#out + 1] = json.quotestring(tostring(k)) .. (state.indent and ': ' or ':')
    encode(out, v, state, level + 1)
  end
  for _, k in pairs(order or {}) do
    if t[k] ~= nil and not done[k] then
      done[k] = true
      pair(k, t[k])
    end
  end
  for k, v in pairs(t) do
    if not done[k] then pair(k, v) end
  end
  if not is_first then break_line(out, state, level) end
  out[#out + 1] = '}'
end

local function encode_table(out, t, state, level)
  local meta = getmetatable(t)
  meta = type(meta) == 'table' and meta or {}
  if state.open[t] then error('reference cycle', 0) end
  state.open[t] = true
  if meta.__tojson then
    local text = meta.__tojson(t, state)
    if type(text) == 'string' then out[#out + 1] = text end
  else
    local n = length(t)
    if n == 0 and meta.__jsontype == 'object' then n = nil end
    if n then
      encode_list(out, t, n, state, level)
    else
      encode_map(out, t, meta.__jsonorder or state.keyorder, state, level)
    end
  end
  state.open[t] = nil
end

function encode(out, value, state, level)
  local kind = type(value)
  if kind == 'nil' then
    out[#out + 1] = 'null'
  elseif kind == 'boolean' then
    out[#out + 1] = tostring(value)
  elseif kind == 'number' then
    local is_finite = value == value and value ~= 1 / 0 and value ~= -1 / 0
    out[#out + 1] = is_finite and tostring(value) or 'null'
  elseif kind == 'string' then
    out[#out + 1] = json.quotestring(value)
  elseif kind == 'table' then
    encode_table(out, value, state, level)
  elseif state.exception then
    local text, why = state.exception('unsupported type', value, state, "type '" .. kind .. "' is not supported by JSON.")
    if type(text) ~= 'string' then error(why or "type '" .. kind .. "' is not supported by JSON.", 0) end
    out[#out + 1] = text
  else
    error("type '" .. kind .. "' is not supported by JSON.", 0)
  end
end

function json.encode(value, given)
  given = given or {}
  local out = {}
  local state = { indent = given.indent, keyorder = given.keyorder, exception = given.exception, open = {} }
  encode(out, value, state, given.level or 0)
  return concat(out)
end

function json.encodeexception(_, _, _, message) return json.quotestring('<' .. message .. '>') end

-- values: each reader gives the value and the place after it, or fails with place and message

local function fail(at, what) error({ at = at, message = what }, 0) end

local function where(text, at)
  local line, start = 1, 0
  for place in string.gmatch(sub(text, 1, at - 1), '()\n') do line, start = line + 1, place end
  return 'line ' .. line .. ', column ' .. (at - start)
end

-- the next place with neither blanks nor comments
local function skip(text, at)
  while true do
    at = find(text, '%S', at)
    if not at then return nil end
    local two = sub(text, at, at + 1)
    if sub(text, at, at + 2) == '\239\187\191' then
      at = at + 3
    elseif two == '//' then
      at = find(text, '[\n\r]', at + 2)
      if not at then return nil end
    elseif two == '/*' then
      local _, stop = find(text, '*/', at + 2, true)
      if not stop then return nil end
      at = stop + 1
    else
      return at
    end
  end
end

local long = { b = '\b', f = '\f', n = '\n', r = '\r', t = '\t' }

-- the number of four hexadecimal digits, if they are that
local function hex(text, at)
  local digits = match(text, '^%x%x%x%x', at)
  return digits and tonumber(digits, 16)
end

local function read_escape(text, at)
  local c = sub(text, at, at)
  if c ~= 'u' then return long[c] or c, at + 1 end
  local code = hex(text, at + 1)
  if not code then return 'u', at + 1 end
  if code >= 0xd800 and code < 0xdc00 and sub(text, at + 5, at + 6) == '\\u' then
    local low = hex(text, at + 7)
    if low and low >= 0xdc00 and low < 0xe000 then
      return utf8_char(0x10000 + (code - 0xd800) * 0x400 + (low - 0xdc00)), at + 11
    end
  end
  return utf8_char(code), at + 5
end

local function read_text(text, start)
  local out, at = {}, start + 1
  while true do
    local stop = find(text, '["\\]', at)
    if not stop then fail(start, 'unterminated string at ' .. where(text, start)) end
    out[#out + 1] = sub(text, at, stop - 1)
    if byte(text, stop) == 34 then return concat(out), stop + 1 end
    out[#out + 1], at = read_escape(text, stop + 1)
  end
end

local read

local function read_items(text, start, close, what, state, take)
  local at = start + 1
  while true do
    at = skip(text, at)
    if not at then fail(start, 'unterminated ' .. what .. ' at ' .. where(text, start)) end
    if sub(text, at, at) == close then return at + 1 end
    at = skip(text, take(at))
    if not at then fail(start, 'unterminated ' .. what .. ' at ' .. where(text, start)) end
    if sub(text, at, at) == ',' then
      at = at + 1
    elseif sub(text, at, at) ~= close then
      fail(at, "',' or '" .. close .. "' expected at " .. where(text, at))
    end
  end
end

local function read_list(text, start, state)
  local list, n = setmetatable({}, state.array_meta), 0
  local stop = read_items(text, start, ']', 'array', state, function(at)
    local value
    value, at = read(text, at, state)
    n = n + 1
    list[n] = value
    return at
  end)
  return list, stop
end

local function read_map(text, start, state)
  local map = setmetatable({}, state.object_meta)
  local stop = read_items(text, start, '}', 'object', state, function(at)
    local key, value
    key, at = read(text, at, state)
    local colon = skip(text, at)
    if not colon or sub(text, colon, colon) ~= ':' then fail(at, "':' expected at " .. where(text, at)) end
    if key == nil then fail(at, 'cannot use nil as table index (at ' .. where(text, at) .. ')') end
    value, at = read(text, colon + 1, state)
    map[key] = value
    return at
  end)
  return map, stop
end

function read(text, at, state)
  local start = skip(text, at)
  if not start then fail(#text + 1, 'no valid JSON value (reached the end)') end
  local c = sub(text, start, start)
  if c == '{' then return read_map(text, start, state) end
  if c == '[' then return read_list(text, start, state) end
  if c == '"' then return read_text(text, start) end
  local _, stop = find(text, '^%-?[%d%.]+[eE]?[%+%-]?%d*', start)
  local number = stop and tonumber(sub(text, start, stop))
  if number then return number, stop + 1 end
  local _, last = find(text, '^%a%w*', start)
  local word = last and sub(text, start, last)
  if word == 'true' then return true, last + 1 end
  if word == 'false' then return false, last + 1 end
  if word == 'null' then return state.null, last + 1 end
  fail(start, 'no valid JSON value at ' .. where(text, start))
end

-- value and the place after it; nil, a place and a message for what is no JSON
function json.decode(text, at, null, ...)
  local state = { null = null, object_meta = object_meta, array_meta = array_meta }
  if select('#', ...) > 0 then state.object_meta, state.array_meta = ... end
  local ok, value, after = pcall(read, text, at or 1, state)
  if ok then return value, after end
  if type(value) == 'table' and value.message then return nil, value.at, value.message end
  error(value, 2)
end

function json.use_lpeg() return json end

json.using_lpeg = false

return json
