function text = sincro_value(value)
% Text of a number, a vector or a text as it stands after `--set PATH=`; all digits.
  if ischar(value)
    text = value;
  elseif (isnumeric(value) || islogical(value)) && isscalar(value)
    text = sprintf('%.17g', double(value));
  elseif isnumeric(value) && isvector(value)
    parts = arrayfun(@(x) sprintf('%.17g', x), double(value(:)'), 'UniformOutput', false);
    text = ['[' strjoin(parts, ', ') ']'];
  else
    error('sincro:argument', 'a setting is a number, a vector or a text, not %s', class(value));
  end
end
