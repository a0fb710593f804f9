-- MessagePack (the published format) for scripts: pack(value, ...) and unpack(text). Whole numbers in the shortest form, other
-- numbers with 64 bits, tables whose keys are 1 .. n as arrays, others as maps in the order of `pairs`.
local pack_text, unpack_text = string.pack, string.unpack
local MAX_DEPTH = 64

local encode

-- head of a string, array or map: short form up to `most`, then forms of 8 (if there is one), 16 and 32 bits
local function head(n, short, most, forms)
  if n <= most then return string.char(short + n) end
  if forms[1] and n < 0x100 then return pack_text('>BB', forms[1], n) end
  if n < 0x10000 then return pack_text('>BI2', forms[2], n) end
  return pack_text('>BI4', forms[3], n)
end

local function whole(n)
  if n >= 0 then
    if n < 0x80 then return string.char(n) end
    if n < 0x100 then return pack_text('>BB', 0xcc, n) end
    if n < 0x10000 then return pack_text('>BI2', 0xcd, n) end
    if n < 0x100000000 then return pack_text('>BI4', 0xce, n) end
    return pack_text('>Bi8', 0xd3, n)
  end
  if n >= -0x20 then return pack_text('>b', n) end
  if n >= -0x80 then return pack_text('>Bb', 0xd0, n) end
  if n >= -0x8000 then return pack_text('>Bi2', 0xd1, n) end
  if n >= -0x80000000 then return pack_text('>Bi4', 0xd2, n) end
  return pack_text('>Bi8', 0xd3, n)
end

local function of_table(t, depth)
  if depth > MAX_DEPTH then error('messagePack: tables are nested too deeply', 0) end
  local n, is_array, parts = 0, true, {}
  for _ in pairs(t) do n = n + 1 end
  for k in pairs(t) do is_array = is_array and math.type(k) == 'integer' and k >= 1 and k <= n end
  if is_array then
    parts[1] = head(n, 0x90, 15, { false, 0xdc, 0xdd })
    for i = 1, n do parts[i + 1] = encode(t[i], depth + 1) end
  else
    parts[1] = head(n, 0x80, 15, { false, 0xde, 0xdf })
    for k, v in pairs(t) do
      parts[#parts + 1] = encode(k, depth + 1)
      parts[#parts + 1] = encode(v, depth + 1)
    end
  end
  return table.concat(parts)
end

function encode(value, depth)
  local kind = type(value)
  if kind == 'nil' then return '\xc0' end
  if kind == 'boolean' then return value and '\xc3' or '\xc2' end
  if kind == 'number' then
    if math.type(value) == 'integer' then return whole(value) end
    return pack_text('>Bd', 0xcb, value)
  end
  if kind == 'string' then return head(#value, 0xa0, 31, { 0xd9, 0xda, 0xdb }) .. value end
  if kind == 'table' then return of_table(value, depth) end
  error('messagePack: a ' .. kind .. ' cannot be packed', 0)
end

local decode

local function array(text, at, n, depth)
  local t = {}
  for i = 1, n do t[i], at = decode(text, at, depth + 1) end
  return t, at
end

local function map(text, at, n, depth)
  local t = {}
  for _ = 1, n do
    local key, value
    key, at = decode(text, at, depth + 1)
    value, at = decode(text, at, depth + 1)
    if key == nil or key ~= key then error('messagePack: a map has a key that is none', 0) end
    t[key] = value
  end
  return t, at
end

local function raw(text, at, n)
  if at + n - 1 > #text then error('messagePack: the data end too early', 0) end
  return text:sub(at, at + n - 1), at + n
end

-- format of the number or length behind each first byte
local numbers = {
  [0xca] = '>f', [0xcb] = '>d', [0xcc] = '>B', [0xcd] = '>I2', [0xce] = '>I4', [0xcf] = '>i8', [0xd0] = '>b', [0xd1] = '>i2', [0xd2] = '>i4', [0xd3] = '>i8',
}
local lengths = {
  [0xc4] = { '>B', raw }, [0xc5] = { '>I2', raw }, [0xc6] = { '>I4', raw }, [0xd9] = { '>B', raw }, [0xda] = { '>I2', raw }, [0xdb] = { '>I4', raw },
  [0xdc] = { '>I2', array }, [0xdd] = { '>I4', array }, [0xde] = { '>I2', map }, [0xdf] = { '>I4', map },
}

function decode(text, at, depth)
  if depth > MAX_DEPTH then error('messagePack: the data are nested too deeply', 0) end
  local first = text:byte(at)
  if not first then error('messagePack: the data end too early', 0) end
  at = at + 1
  if first < 0x80 then return first, at end
  if first < 0x90 then return map(text, at, first - 0x80, depth) end
  if first < 0xa0 then return array(text, at, first - 0x90, depth) end
  if first < 0xc0 then return raw(text, at, first - 0xa0) end
  if first >= 0xe0 then return first - 0x100, at end
  if first == 0xc0 then return nil, at end
  if first == 0xc2 or first == 0xc3 then return first == 0xc3, at end
  local form = numbers[first] or lengths[first] and lengths[first][1]
  if not form then error(('messagePack: byte 0x%02x is not understood'):format(first), 0) end
  if at + string.packsize(form) - 1 > #text then error('messagePack: the data end too early', 0) end
  local n
  n, at = unpack_text(form, text, at)
  if numbers[first] then return n, at end
  return lengths[first][2](text, at, n, depth)
end

local module = {}

function module.pack(...)
  local parts = {}
  for i = 1, select('#', ...) do parts[i] = encode((select(i, ...)), 0) end
  return table.concat(parts)
end

function module.unpack(text)
  if type(text) ~= 'string' then error('messagePack: text is expected', 2) end
  return (decode(text, 1, 0))
end

return module
