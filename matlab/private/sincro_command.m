function line = sincro_command(parts)
% Command line that runs sincro with these arguments, each of them quoted.
  program = getenv('SINCRO');
  if isempty(program), program = 'sincro'; end
  quoted = cellfun(@quote, [{program}, parts], 'UniformOutput', false);
  line = strjoin(quoted, ' ');
end

function text = quote(text)
  if ~ischar(text)
    error('sincro:argument', 'a text is expected, not %s', class(text));
  end
  if ispc
    text = ['"' strrep(text, '"', '\"') '"'];
  else
    text = ['''' strrep(text, '''', '''\''''') ''''];
  end
end
