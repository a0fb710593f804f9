-- Environment of a file that calls `module` of Lua 5.1, which V-REP's scripts had: from that call on its globals are entries of the module.
return function()
  local own
  local environment = setmetatable({}, {
    __index = function(_, key)
      local value = own and own[key]
      if value ~= nil then return value end
      return _G[key]
    end,
    __newindex = function(_, key, value) (own or _G)[key] = value end,
  })
  rawset(environment, 'module', function(name)
    own = package.loaded[name] or {}
    own._M, own._NAME = own, name
    package.loaded[name], _G[name] = own, own
  end)
  return environment
end
