function [value, at] = sincro_cbor_read(bytes, at)
% Value at a place of a row of bytes that are CBOR, and the place after it. Numbers are doubles, lists of numbers rows,
% other lists cell arrays, maps structures, nil [].
  first = double(bytes(at));
  major = floor(first / 32);
  low = mod(first, 32);
  at = at + 1;
  if major == 7
    [value, at] = simple(bytes, at, low);
    return
  end
  widths = [1, 2, 4, 8];
  n = low;
  if low >= 24
    width = widths(low - 23);
    n = sum(double(bytes(at:at + width - 1)) .* 256 .^ (width - 1:-1:0));
    at = at + width;
  end
  switch major
    case 0
      value = n;
    case 1
      value = -1 - n;
    case 2
      value = bytes(at:at + n - 1);
      at = at + n;
    case 3
      value = native2unicode(bytes(at:at + n - 1), 'UTF-8');
      at = at + n;
    case 4
      [value, at] = list(bytes, at, n);
    otherwise
      value = struct();
      for k = 1:n
        [name, at] = sincro_cbor_read(bytes, at);
        [value.(name), at] = sincro_cbor_read(bytes, at);
      end
  end
end

function [value, at] = list(bytes, at, n)
  value = cell(1, n);
  for k = 1:n
    [value{k}, at] = sincro_cbor_read(bytes, at);
  end
  if n > 0 && all(cellfun(@(x) isnumeric(x) && isscalar(x), value)), value = [value{:}]; end
end

function [value, at] = simple(bytes, at, low)
  switch low
    case 20
      value = false;
    case 21
      value = true;
    case 26
      value = double(typecast(fliplr(bytes(at:at + 3)), 'single'));
      at = at + 4;
    case 27
      value = typecast(fliplr(bytes(at:at + 7)), 'double');
      at = at + 8;
    otherwise
      value = [];
  end
end
