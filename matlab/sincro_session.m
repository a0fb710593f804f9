classdef sincro_session < handle
  % SINCRO_SESSION  A run in lock-step: what `sincro_start` returns, and `sincro_step` and `sincro_stop` use.
  %
  % It speaks the WebSocket remote API (docs/remote.md) in CBOR: values are doubles, and every call is one exchange.
  %
  % See also SINCRO_START.

  properties (SetAccess = private)
    reads = {};               % names of the signals that a step returns
    writes = {};              % names of the joints and rotors that are commanded
    y = [];                   % last values of the signals, a column, in their units
    t = 0;                    % time of these values [s]
    folder = '';              % folder of the runs of a server of its own
  end

  properties (Access = private)
    socket = [];
    process = '';             % id of the server's process
    is_temporary = false;
    getters = {};             % function, arguments and place in the result, of each signal
    setters = {};             % function and handle of each command
  end

  methods
    function s = sincro_session(scene, settings, given)
      % Starts a server, or connects to one, and starts the run.
      options = session_options(given);
      s.reads = options.reads(:)';
      s.writes = options.writes(:)';
      try
        if isempty(options.port), options.port = s.serve(scene, settings, options); end
        s.connect(options.port);
        s.call('setStepping', true);
        s.getters = cellfun(@(name) s.getter(name), s.reads, 'UniformOutput', false);
        s.setters = cellfun(@(name) s.setter(name), s.writes, 'UniformOutput', false);
        s.call('sim.startSimulation');
        s.measure();
      catch failure
        s.finish();
        rethrow(failure);
      end
    end

    function varargout = call(s, name, varargin)
      % [a, b, ...] = s.call('sim.getObject', '/arm'): calls a function of the API of CoppeliaSim.
      if isempty(s.socket), error('sincro:closed', 'the run has ended: begin another with sincro_start'); end
      request = struct('func', name);
      request.args = varargin;
      s.send(sincro_cbor(request));
      answer = sincro_cbor_read(s.receive(), 1);
      if ~answer.success, error('sincro:refused', '%s', answer.error); end
      varargout = cell(1, nargout);
      results = answer.ret;
      if ~iscell(results), results = num2cell(results); end
      n = min(nargout, numel(results));
      varargout(1:n) = results(1:n);
    end

    function [y, t] = step(s, u, n)
      % Commands, n steps, measurements: what `sincro_step` does.
      if ~isnumeric(n) || ~isscalar(n) || n < 1 || n ~= round(n)
        error('sincro:argument', 'the number of steps is a whole number from 1 on');
      end
      if ~isempty(u)
        if ~isnumeric(u) || numel(u) ~= numel(s.writes)
          error('sincro:argument', 'u has %d numbers; there is one for each of the %d `writes`', numel(u), numel(s.writes));
        end
        if ~all(isfinite(u(:)))
          error('sincro:argument', 'the command of `%s` is not a finite number', s.writes{find(~isfinite(u(:)), 1)});
        end
        for k = 1:numel(u)
          s.call(s.setters{k}{1}, s.setters{k}{2}, double(u(k)));
        end
      end
      s.call('sim.step', int32(n));
      s.measure();
      y = s.y;
      t = s.t;
    end

    function r = stop(s)
      % Ends the run and its server, and reads the result.
      r = [];
      s.call('sim.stopSimulation');
      if ~isempty(s.process)
        place = fullfile(s.folder, 'run-1');
        for look = 1:600                                   % it is written within the next seconds
          if exist(fullfile(place, 'run.json'), 'file'), break; end
          pause(0.1);
        end
        r = sincro_read(place);
        if s.is_temporary, r.folder = ''; end
      end
      s.finish();
    end
  end

  methods
    function delete(s)
      % The server ends with the object.
      s.finish();
    end
  end

  methods (Access = private)
    function measure(s)
      values = zeros(numel(s.getters), 1);
      for k = 1:numel(s.getters)
        getter = s.getters{k};
        value = s.call(getter{1}, getter{2}{:});
        if isempty(value), value = NaN; end
        values(k) = getter{4} * value(getter{3});
      end
      s.y = values;
      s.t = s.call('sim.getSimulationTime');
    end

    function found = getter(s, name)
      % function, arguments, place in what it returns, factor
      signal = regexp(name, '^float_signal\.(.+)$', 'tokens', 'once');
      parts = regexp(name, '^(.*)\.(position|velocity|motor_torque|motor_force|speed)(\.[xyz])?$', 'tokens', 'once');
      if ~isempty(signal)
        found = {'sim.getFloatSignal', signal(1), 1, 1};
        return
      end
      if isempty(parts)
        error('sincro:argument', ['`%s` cannot be read step by step: .position, .velocity, .motor_torque of joints, ' ...
          '.speed of rotors, .position.x, .y, .z of frames and float_signal.NAME can; ' ...
          'sincro_stop returns all recorded signals'], name);
      end
      if numel(parts) < 3, parts{3} = ''; end
      object = {s.object(parts{1})};
      switch parts{2}
        case 'position'
          if isempty(parts{3})
            found = {'sim.getJointPosition', object, 1, 1};
          else
            found = {'sim.getObjectPosition', object, find(strcmp(parts{3}, {'.x', '.y', '.z'})), 1};
          end
        case {'velocity', 'speed'}
          found = {'sim.getJointVelocity', object, 1, 1};
        otherwise
          found = {'sim.getJointForce', object, 1, -1};
      end
    end

    function found = setter(s, name)
      object = s.object(regexprep(name, '\.(command|speed)$', ''));
      functions = {'sim.setJointTargetForce', 1; 'sim.setJointTargetVelocity', 4; ...
        'sim.setJointTargetPosition', 8; 'sim.setJointTargetPosition', 12};
      try
        mode = s.call('sim.getObjectInt32Param', object, int32(2039));
      catch
        mode = 4;                                          % a rotor: its speed
      end
      k = find([functions{:, 2}] == mode, 1);
      if isempty(k)
        error('sincro:refused', '`%s` takes no commands: its joint has no motor', name);
      end
      found = {functions{k, 1}, object};
    end

    function handle = object(s, path)
      handle = int32(s.call('sim.getObject', path));
    end

    function port = serve(s, scene, settings, options)
      if ispc
        error('sincro:argument', ['on Windows start `sincro serve` in a window of its own, and give its WebSocket ' ...
          'port: sincro_start('''', {}, ''port'', 23050, ...)']);
      end
      s.is_temporary = isempty(options.out);
      s.folder = options.out;
      if s.is_temporary, s.folder = tempname(); end
      parts = [{'serve', scene, '--no-legacy', '--no-zmq', '--ws-port', '0', '--out', s.folder}, sincro_settings(settings)];
      if ~isempty(options.step), parts = [parts, {'--simulation-step', sincro_value(options.step)}]; end
      log = [tempname() '.log'];
      forget = onCleanup(@() delete(log));
      % a second process ends the server should this program end without `sincro_stop`
      if exist('OCTAVE_VERSION', 'builtin'), own = getpid(); else, own = feature('getpid'); end
      watch = sprintf('(while kill -0 %d && kill -0 $p; do sleep 1; done; kill $p) > /dev/null 2>&1 & echo $p', own);
      [~, text] = system([sincro_command(parts) ' > ' log ' 2>&1 & p=$!; ' watch]);
      s.process = strtrim(text);
      port = [];
      for look = 1:600
        text = fileread(log);
        found = regexp(text, 'WebSocket\s+\S+:(\d+)\s', 'tokens', 'once');
        if ~isempty(found)
          port = str2double(found{1});
          return
        end
        if system(['kill -0 ' s.process ' 2> /dev/null']) ~= 0
          error('sincro:refused', '%s', strtrim(fileread(log)));
        end
        pause(0.05);
      end
      error('sincro:refused', 'the server does not listen: %s', strtrim(text));
    end

    function connect(s, port)
      s.socket = tcpclient('127.0.0.1', port, 'Timeout', 60);
      lines = {'GET / HTTP/1.1', sprintf('Host: 127.0.0.1:%d', port), 'Upgrade: websocket', 'Connection: Upgrade', ...
        'Sec-WebSocket-Key: c2luY3JvIGZvciBNQVRMQQ==', 'Sec-WebSocket-Version: 13', '', ''};
      write(s.socket, uint8(strjoin(lines, sprintf('\r\n'))));
      head = '';
      while numel(head) < 4 || ~strcmp(head(end - 3:end), sprintf('\r\n\r\n'))
        head = [head, char(s.take(1))];
      end
      if isempty(strfind(head, ' 101 '))
        s.socket = [];
        error('sincro:refused', 'the server refuses the connection: %s', strtrim(head));
      end
    end

    function send(s, payload)
      % one frame of RFC 6455 with the mask zero
      n = numel(payload);
      if n < 126
        size = uint8(128 + n);
      elseif n < 65536
        size = [uint8(254), fliplr(typecast(uint16(n), 'uint8'))];
      else
        size = [uint8(255), fliplr(typecast(uint64(n), 'uint8'))];
      end
      write(s.socket, [uint8(130), size, zeros(1, 4, 'uint8'), payload]);
    end

    function payload = receive(s)
      payload = uint8([]);
      is_last = false;
      while ~is_last
        head = double(s.take(2));
        is_last = head(1) >= 128;
        n = mod(head(2), 128);
        if n >= 126
          wide = double(s.take(2 + 6 * (n == 127)));
          n = sum(wide .* 256 .^ (numel(wide) - 1:-1:0));
        end
        part = s.take(n);
        switch mod(head(1), 16)
          case {0, 1, 2}
            payload = [payload, part];
          case 8
            s.socket = [];
            error('sincro:closed', 'the server has closed the connection');
          otherwise
            is_last = false;                               % a ping between two frames
        end
      end
    end

    function b = take(s, n)
      b = uint8([]);
      if n == 0, return; end
      b = reshape(uint8(read(s.socket, n)), 1, []);
      if numel(b) < n
        s.socket = [];
        error('sincro:closed', 'the server has closed the connection, or did not answer within 60 s');
      end
    end

    function finish(s)
      s.socket = [];
      if ~isempty(s.process)
        system(['kill ' s.process ' 2> /dev/null']);
        while system(['kill -0 ' s.process ' 2> /dev/null']) == 0, pause(0.02); end
        s.process = '';
        if s.is_temporary && exist(s.folder, 'dir'), sincro_remove(s.folder); end
      end
    end
  end
end

function options = session_options(given)
  options = struct('reads', {{}}, 'writes', {{}}, 'step', [], 'out', '', 'port', []);
  if mod(numel(given), 2) ~= 0
    error('sincro:argument', 'sincro_start: an option has no value');
  end
  for k = 1:2:numel(given)
    if ~isfield(options, given{k})
      error('sincro:argument', 'sincro_start: there is no option `%s`; options: %s', given{k}, ...
        strjoin(fieldnames(options)', ', '));
    end
    options.(given{k}) = given{k + 1};
  end
  for name = {'reads', 'writes'}
    if ~iscellstr(options.(name{1}))
      error('sincro:argument', 'sincro_start: `%s` is a cell array of names', name{1});
    end
  end
end
