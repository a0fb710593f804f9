-- Module `matrix`: matrices and vectors of numbers, with the names and conventions of CoppeliaSim's module: rows and
-- columns from 1, data row by row, vectors as matrices of one column, quaternions x y z w, Euler angles and poses as
-- `sim` has them.
local sim = ...
local type, error, tostring, setmetatable, getmetatable, rawget = type, error, tostring, setmetatable, getmetatable, rawget
local math_type, sqrt, abs, sin, cos, concat = math.type, math.sqrt, math.abs, math.sin, math.cos, table.concat

local Matrix = {}
local Row = {}

local function is_matrix(x) return type(x) == 'table' and rawget(x, '_data') ~= nil and getmetatable(x) == Matrix end

local function make(rows, cols, data) return setmetatable({ _rows = rows, _cols = cols, _data = data }, Matrix) end

local function filled(rows, cols, f)
  local data = {}
  for i = 1, rows do
    for j = 1, cols do data[#data + 1] = f(i, j) end
  end
  return make(rows, cols, data)
end

local function check_size(n, what)
  if math_type(n) ~= 'integer' or n < 0 then error(what .. ' of a matrix: expected a whole number, got ' .. tostring(n), 4) end
end

local function size(m) return m._rows .. '×' .. m._cols end

-- rows of rows, a list as a column, or rows, columns and data: row by row, a function of row and column, or a number
local function construct(rows, cols, data)
  if is_matrix(rows) then return rows:copy() end
  if type(rows) == 'table' then
    if type(rows[1]) ~= 'table' then return filled(#rows, 1, function(i) return rows[i] end) end
    local n = #rows[1]
    for i, row in ipairs(rows) do
      if #row ~= n then error('row ' .. i .. ' of a matrix has ' .. #row .. ' numbers, the first one ' .. n, 3) end
    end
    return filled(#rows, n, function(i, j) return rows[i][j] end)
  end
  check_size(rows, 'rows')
  check_size(cols, 'columns')
  if type(data) == 'function' then return filled(rows, cols, data) end
  if type(data) == 'table' then
    if is_matrix(data) then data = data._data end
    if #data ~= rows * cols then error('a matrix of ' .. rows .. '×' .. cols .. ' has ' .. rows * cols .. ' numbers, got ' .. #data, 3) end
    return filled(rows, cols, function(i, j) return data[(i - 1) * cols + j] end)
  end
  return filled(rows, cols, function() return data or 0 end)
end

local methods = {}

function methods:rows() return self._rows end
function methods:cols() return self._cols end
function methods:count() return self._rows * self._cols end
function methods:get(i, j) return self._data[(i - 1) * self._cols + (j or 1)] end

function methods:set(i, j, x)
  if x == nil and self._cols == 1 then j, x = 1, j end
  if not (i >= 1 and i <= self._rows and j >= 1 and j <= self._cols) then
    error('there is no element ' .. i .. ', ' .. j .. ' in a matrix of ' .. size(self), 2)
  end
  self._data[(i - 1) * self._cols + j] = x
  return self
end

-- numbers row by row
function methods:data() return table.move(self._data, 1, #self._data, 1, {}) end

-- rows of rows
function methods:totable()
  local rows = {}
  for i = 1, self._rows do rows[i] = table.move(self._data, (i - 1) * self._cols + 1, i * self._cols, 1, {}) end
  return rows
end

function methods:copy() return make(self._rows, self._cols, self:data()) end
function methods:t() return filled(self._cols, self._rows, function(i, j) return self:get(j, i) end) end
function methods:row(i) return filled(1, self._cols, function(_, j) return self:get(i, j) end) end
function methods:col(j) return filled(self._rows, 1, function(i) return self:get(i, j) end) end

function methods:slice(from_row, from_col, to_row, to_col)
  return filled(to_row - from_row + 1, to_col - from_col + 1, function(i, j) return self:get(from_row + i - 1, from_col + j - 1) end)
end

function methods:reshape(rows, cols) return construct(rows, cols, self._data) end
function methods:applyfunc(f) return filled(self._rows, self._cols, function(i, j) return f(self:get(i, j)) end) end
function methods:abs() return self:applyfunc(abs) end

function methods:sum()
  local sum = 0
  for k = 1, #self._data do sum = sum + self._data[k] end
  return sum
end

function methods:min() return math.min(table.unpack(self._data)) end
function methods:max() return math.max(table.unpack(self._data)) end

local function dot(a, b)
  if #a._data ~= #b._data then error('the product of ' .. size(a) .. ' and ' .. size(b) .. ': expected as many numbers', 3) end
  local sum = 0
  for k = 1, #a._data do sum = sum + a._data[k] * b._data[k] end
  return sum
end

function methods:dot(other) return dot(self, other) end
function methods:norm() return sqrt(dot(self, self)) end
function methods:normalized() return self / self:norm() end

function methods:cross(other)
  local a, b = self._data, other._data
  if #a ~= 3 or #b ~= 3 then error('the cross product of ' .. size(self) .. ' and ' .. size(other) .. ': expected three numbers each', 2) end
  return make(self._rows, self._cols, { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1] })
end

function methods:trace()
  local sum = 0
  for i = 1, math.min(self._rows, self._cols) do sum = sum + self:get(i, i) end
  return sum
end

-- elimination with the largest pivot of each column, of the matrix and of what stands beside it; also the determinant
local function eliminate(m, beside)
  if m._rows ~= m._cols then error('a matrix of ' .. size(m) .. ' has no inverse and no determinant: expected a square one', 3) end
  local n, a, b, det = m._rows, m:totable(), beside:totable(), 1
  for k = 1, n do
    local p = k
    for i = k + 1, n do
      if abs(a[i][k]) > abs(a[p][k]) then p = i end
    end
    if a[p][k] == 0 then return nil, 0 end
    if p ~= k then a[k], a[p], b[k], b[p], det = a[p], a[k], b[p], b[k], -det end
    det = det * a[k][k]
    for i = 1, n do
      if i ~= k then
        local factor = a[i][k] / a[k][k]
        for j = k, n do a[i][j] = a[i][j] - factor * a[k][j] end
        for j = 1, beside._cols do b[i][j] = b[i][j] - factor * b[k][j] end
      end
    end
  end
  return filled(n, beside._cols, function(i, j) return b[i][j] / a[i][i] end), det
end

local function eye(n) return filled(n, n, function(i, j) return i == j and 1 or 0 end) end

function methods:det()
  local _, det = eliminate(self, make(self._rows, 0, {}))
  return det
end

function methods:inv()
  local inverse = eliminate(self, eye(self._rows))
  if not inverse then error('the matrix has no inverse: it is singular', 2) end
  return inverse
end

function methods:horzcat(other)
  if self._rows ~= other._rows then error('matrices of ' .. size(self) .. ' and ' .. size(other) .. ' beside each other: expected as many rows', 2) end
  local n = self._cols
  return filled(self._rows, n + other._cols, function(i, j) return j <= n and self:get(i, j) or other:get(i, j - n) end)
end

function methods:vertcat(other)
  if self._cols ~= other._cols then error('matrices of ' .. size(self) .. ' and ' .. size(other) .. ' below each other: expected as many columns', 2) end
  local n = self._rows
  return filled(n + other._rows, self._cols, function(i, j) return i <= n and self:get(i, j) or other:get(i - n, j) end)
end

-- of matrices of 3×3 and 4×4
local function twelve(m)
  if m._rows == 4 then return table.move(m._data, 1, 12, 1, {}) end
  local d = m._data
  return { d[1], d[2], d[3], 0, d[4], d[5], d[6], 0, d[7], d[8], d[9], 0 }
end

function methods:topose() return sim.matrixToPose(twelve(self)) end
function methods:toquaternion() return sim.getQuaternionFromMatrix(twelve(self)) end
function methods:toeuler() return sim.getEulerAnglesFromMatrix(twelve(self)) end
function methods:toposition() return self:slice(1, 4, 3, 4) end
function methods:torotation() return self:slice(1, 1, 3, 3) end

function Matrix.__index(m, key)
  if math_type(key) == 'integer' then
    local rows, cols, data = rawget(m, '_rows'), rawget(m, '_cols'), rawget(m, '_data')
    if cols == 1 or rows == 1 then return data[key] end
    if key < 1 or key > rows then return nil end
    return setmetatable({ _of = m, _row = key }, Row)
  end
  return methods[key]
end

function Matrix.__newindex(m, key, x)
  if math_type(key) ~= 'integer' or not (m._cols == 1 or m._rows == 1) or key < 1 or key > #m._data then
    error('a matrix of ' .. size(m) .. ' has no element ' .. tostring(key) .. ' to be set', 2)
  end
  m._data[key] = x
end

function Row.__index(row, j) return rawget(row, '_of'):get(rawget(row, '_row'), j) end
function Row.__newindex(row, j, x) rawget(row, '_of'):set(rawget(row, '_row'), j, x) end
function Row.__len(row) return rawget(row, '_of')._cols end

function Matrix.__len(m) return m._cols == 1 and m._rows or m._rows == 1 and m._cols or m._rows end

local function elementwise(name, f)
  Matrix[name] = function(a, b)
    if not is_matrix(a) then return b:applyfunc(function(x) return f(a, x) end) end
    if not is_matrix(b) then return a:applyfunc(function(x) return f(x, b) end) end
    if a._rows ~= b._rows or a._cols ~= b._cols then
      error('matrices of ' .. size(a) .. ' and ' .. size(b) .. ': expected the same size', 2)
    end
    return filled(a._rows, a._cols, function(i, j) return f(a:get(i, j), b:get(i, j)) end)
  end
end

elementwise('__add', function(x, y) return x + y end)
elementwise('__sub', function(x, y) return x - y end)

function Matrix.__mul(a, b)
  if not is_matrix(a) then return b:applyfunc(function(x) return a * x end) end
  if not is_matrix(b) then return a:applyfunc(function(x) return x * b end) end
  if a._cols ~= b._rows then error('the product of ' .. size(a) .. ' and ' .. size(b) .. ': expected as many rows as columns', 2) end
  return filled(a._rows, b._cols, function(i, j)
    local sum = 0
    for k = 1, a._cols do sum = sum + a:get(i, k) * b:get(k, j) end
    return sum
  end)
end

function Matrix.__div(m, x)
  if is_matrix(x) then return m * x:inv() end
  return m:applyfunc(function(y) return y / x end)
end

function Matrix.__unm(m) return m:applyfunc(function(x) return -x end) end

function Matrix.__eq(a, b)
  if a._rows ~= b._rows or a._cols ~= b._cols then return false end
  for k = 1, #a._data do
    if a._data[k] ~= b._data[k] then return false end
  end
  return true
end

function Matrix.__tostring(m)
  local rows = {}
  for i, row in ipairs(m:totable()) do
    for j = 1, #row do row[j] = tostring(row[j]) end
    rows[i] = m._cols == 1 and row[1] or '{' .. concat(row, ', ') .. '}'
  end
  return (m._cols == 1 and 'Vector' or 'Matrix') .. '{' .. concat(rows, ', ') .. '}'
end

-- a class: a table that is called to construct, with constructors of other names
local function class(call, constructors)
  return setmetatable(constructors, { __call = function(_, ...) return call(...) end })
end

local function of_size(rows, cols)
  return function(data)
    if is_matrix(data) then data = data._data end
    if type(data) == 'table' and type(data[1]) == 'table' then data = construct(data)._data end
    return construct(rows, cols, data)
  end
end

local function rotation(axis, angle)
  local c, s = cos(angle), sin(angle)
  if axis == 1 then return { 1, 0, 0, 0, c, -s, 0, s, c } end
  if axis == 2 then return { c, 0, s, 0, 1, 0, -s, 0, c } end
  return { c, -s, 0, s, c, 0, 0, 0, 1 }
end

local function list_of(x) return is_matrix(x) and x._data or x end

-- of 3×3 (n = 3) or 4×4 (n = 4), from the twelve numbers of `sim`
local function from_twelve(n, m)
  if n == 3 then return make(3, 3, { m[1], m[2], m[3], m[5], m[6], m[7], m[9], m[10], m[11] }) end
  return make(4, 4, { m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8], m[9], m[10], m[11], m[12], 0, 0, 0, 1 })
end

local function square(n)
  local own = of_size(n, n)
  local constructors = { eye = function() return eye(n) end, zeros = function() return construct(n, n) end }
  for axis, name in ipairs { 'rotx', 'roty', 'rotz' } do
    constructors[name] = function(_, angle)
      local r = rotation(axis, angle)
      return from_twelve(n, { r[1], r[2], r[3], 0, r[4], r[5], r[6], 0, r[7], r[8], r[9], 0 })
    end
  end
  function constructors.fromquaternion(_, q) return from_twelve(n, sim.buildMatrixQ({ 0, 0, 0 }, list_of(q))) end
  function constructors.fromeuler(_, e) return from_twelve(n, sim.buildMatrix({ 0, 0, 0 }, list_of(e))) end
  if n == 4 then
    function constructors.frompose(_, p) return from_twelve(4, sim.poseToMatrix(list_of(p))) end
    function constructors.fromposition(_, p) return from_twelve(4, sim.buildMatrixQ(list_of(p), { 0, 0, 0, 1 })) end
    function constructors.fromrotation(_, r) return from_twelve(4, twelve(r)) end
    constructors.fromrt = function(_, r, p)
      local m = twelve(r)
      m[4], m[8], m[12] = table.unpack(list_of(p), 1, 3)
      return from_twelve(4, m)
    end
  end
  return class(function(data) if data == nil then return construct(n, n) end return own(data) end, constructors)
end

local function vector(n)
  return class(of_size(n, 1), {
    zeros = function() return construct(n, 1) end,
    ones = function() return construct(n, 1, 1) end,
    random = function() return filled(n, 1, function() return math.random() end) end,
  })
end

return {
  Matrix = class(construct, {
    eye = function(_, n) return eye(n) end,
    zeros = function(_, rows, cols) return construct(rows, cols or rows) end,
    ones = function(_, rows, cols) return construct(rows, cols or rows, 1) end,
    random = function(_, rows, cols) return filled(rows, cols, function() return math.random() end) end,
    fromtable = function(_, rows) return construct(rows) end,
    ismatrix = function(_, x) return is_matrix(x) end,
  }),
  Vector = class(function(first, second)
    if type(first) == 'table' then return construct(is_matrix(first) and first:data() or first) end
    return construct(first, 1, second)
  end, {
    zeros = function(_, n) return construct(n, 1) end,
    ones = function(_, n) return construct(n, 1, 1) end,
  }),
  Vector3 = vector(3),
  Vector4 = vector(4),
  Vector7 = vector(7),
  Matrix3x3 = square(3),
  Matrix4x4 = square(4),
}
