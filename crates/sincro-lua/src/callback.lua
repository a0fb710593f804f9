-- Function of a script from what it gives as a callback: a function, or the name of a global one; none for no name.
return function(f)
  if f == '' then return nil end
  if type(f) ~= 'string' then return f end
  if type(_G[f]) ~= 'function' then error('there is no function `' .. f .. '` to call back', 3) end
  return _G[f]
end
