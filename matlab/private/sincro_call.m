function [code, text] = sincro_call(parts)
% Runs sincro to its end: exit status, and what it printed on both streams.
  line = [sincro_command(parts) ' 2>&1'];
  if ispc, line = ['"' line '"']; end                      % cmd.exe takes the outer quotes off
  [code, text] = system(line);
  text = strtrim(text);
  if code == 127 || code == 9009
    error('sincro:absent', 'the program sincro was not found: put it into the path, or its place into the variable SINCRO');
  end
end
