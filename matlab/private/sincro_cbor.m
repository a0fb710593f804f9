function bytes = sincro_cbor(value)
% Bytes of a value as CBOR (RFC 8949): texts, numbers, truth values, cell arrays, structures. Numbers are doubles; a
% vector is a list of numbers.
  if ischar(value)
    text = unicode2native(value, 'UTF-8');
    bytes = [head(3, numel(text)), reshape(uint8(text), 1, [])];
  elseif isstruct(value)
    names = fieldnames(value);
    bytes = head(5, numel(names));
    for k = 1:numel(names)
      bytes = [bytes, sincro_cbor(names{k}), sincro_cbor(value.(names{k}))];
    end
  elseif iscell(value)
    bytes = head(4, numel(value));
    for k = 1:numel(value)
      bytes = [bytes, sincro_cbor(value{k})];
    end
  elseif islogical(value) && isscalar(value)
    bytes = uint8(244 + value);
  elseif isinteger(value) && isscalar(value)
    bytes = whole(double(value));
  elseif isnumeric(value) && isscalar(value)
    bytes = [uint8(251), swapped(double(value))];
  elseif isnumeric(value)
    bytes = sincro_cbor(num2cell(double(value(:)')));
  else
    error('sincro:argument', 'a value of class %s cannot be sent', class(value));
  end
end

function bytes = whole(n)
  if n < 0, bytes = head(1, -1 - n); else, bytes = head(0, n); end
end

function bytes = head(major, n)
  kind = 32 * major;
  if n < 24
    bytes = uint8(kind + n);
  elseif n < 65536
    bytes = [uint8(kind + 25), swapped(uint16(n))];
  else
    bytes = [uint8(kind + 26), swapped(uint32(n))];
  end
end

function bytes = swapped(number)
  % the network's order is that of the highest byte first
  bytes = fliplr(typecast(number, 'uint8'));
end
