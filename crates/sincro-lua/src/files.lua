-- Files that the scene gives a script, read when it was loaded, and files that scripts write into the results of the
-- run: io.open and io.lines, as Lua has them.
local text_of, keep, has_files = ...
local type, error, tonumber, tostring, select, math_type = type, error, tonumber, tostring, select, math.type
local find, sub, match, gsub = string.find, string.sub, string.match, string.gsub
local setmetatable, getmetatable, unpack, concat = setmetatable, getmetatable, table.unpack, table.concat

local File = {}
File.__index = File

local function line(file, keep)
  local from, text = file.at, file.text
  if from > #text then return nil end
  local to = find(text, '\n', from, true)
  file.at = (to or #text) + 1
  return sub(text, from, to and (keep and to or to - 1) or #text)
end

local function number(file)
  local from, to = find(file.text, '^%s*[%w.+-]+', file.at)
  if not from then return nil end
  file.at = to + 1
  return tonumber((gsub(sub(file.text, from, to), '%s', '')))
end

local function bytes(file, n)
  if file.at > #file.text then return nil end
  local from = file.at
  file.at = from + n
  return sub(file.text, from, from + n - 1)
end

local function one(file, format)
  if math_type(format) == 'integer' then return bytes(file, format) end
  local kind = type(format) == 'string' and match(format, '^%*?([alLn])')
  if kind == 'a' then return bytes(file, #file.text) or '' end
  if kind == 'l' then return line(file, false) end
  if kind == 'L' then return line(file, true) end
  if kind == 'n' then return number(file) end
  error("a file is read by 'a', 'l', 'L', 'n' or a number of bytes", 3)
end

function File:read(...)
  if self.is_closed then error('the file is closed', 2) end
  if select('#', ...) == 0 then return line(self, false) end
  local results = {}
  for k = 1, select('#', ...) do results[k] = one(self, (select(k, ...))) end
  return unpack(results, 1, select('#', ...))
end

function File:lines(format)
  return function() return self:read(format or 'l') end
end

function File:seek(whence, offset)
  offset = offset or 0
  local start = ({ set = 0, cur = self.at - 1, ['end'] = #self.text })[whence or 'cur']
  if not start or start + offset < 0 then return nil, 'no such place' end
  self.at = start + offset + 1
  return start + offset
end

function File:close()
  self.is_closed = true
  return true
end

local Written = {}
Written.__index = Written

function Written:write(...)
  if self.is_closed then error('the file is closed', 2) end
  local parts = {}
  for k = 1, select('#', ...) do
    local part = select(k, ...)
    if type(part) ~= 'string' and type(part) ~= 'number' then
      error('a file is written by texts and numbers, argument ' .. k .. ' is a ' .. type(part), 2)
    end
    parts[k] = tostring(part)
  end
  keep(self.name, concat(parts), true)
  return self
end

function Written:flush() return self end

function Written:setvbuf() return true end

function Written:read() return nil, self.name .. ' is open for writing' end

function Written:seek(whence, offset)
  if (whence or 'cur') == 'set' or (offset or 0) ~= 0 then
    error('what is written goes to the end of a file: there is no going back', 2)
  end
  return #(text_of(self.name) or '')
end

function Written:close()
  self.is_closed = true
  return true
end

local function open(name, mode)
  local text, is_given = text_of(name)
  if mode and match(mode, '^[wa]b?$') then
    if is_given then return nil, name .. ': for reading only, it is a file of the scene' end
    keep(name, '', sub(mode, 1, 1) == 'a')
    return setmetatable({ name = name }, Written)
  end
  if mode and not match(mode, '^rb?$') then
    return nil, name .. ': a file is opened to be read, written or written on: r, w or a'
  end
  if text then return setmetatable({ text = text, at = 1 }, File) end
  if has_files then return nil, name .. ": not among the script's `files` in the scene" end
  error('io.open is not allowed: scripts read no files but those under `files` in the scene, and what they wrote', 2)
end

local function lines(name, format)
  local file, why = open(name)
  if not file then error(why, 2) end
  return file:lines(format)
end

local function kind(value)
  local class = getmetatable(value)
  if class ~= File and class ~= Written then return nil end
  return value.is_closed and 'closed file' or 'file'
end

return open, lines, kind
