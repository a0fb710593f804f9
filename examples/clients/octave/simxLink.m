classdef simxLink < handle
  % A connection to a server of the legacy remote API: messages out, messages in, and what has arrived.
  %
  % Used by remApi.m; nothing here needs to be called directly. Every message is answered by exactly one message, which also brings
  % whatever is streamed; so nothing runs in the background, and no call costs more than one exchange.

  properties
    is_synchronous = false;   % between two triggers nothing moves: what has arrived is what is
    is_held = false;          % simxPauseCommunication: commands are gathered
    command_time = 0;         % simulation time of the last answer, ms
  end

  properties (Access = private)
    socket
    n_messages = 0;
    gathered = uint8([]);
    inbox                     % answers by what was asked: status, data, simulation time
    streams                   % what is streamed
  end

  methods
    function link = simxLink(address, port, timeout_s)
      link.socket = tcpclient(address, port, 'Timeout', timeout_s);
      link.inbox = containers.Map('KeyType', 'char', 'ValueType', 'any');
      link.streams = containers.Map('KeyType', 'char', 'ValueType', 'logical');
    end

    function disconnect(link)
      % Says goodbye, as far as somebody listens.
      try
        link.put(10, uint8([]), bytes(int32(0)), 0);
      catch
      end
      link.socket = [];
    end

    function [code, data] = ask(link, command, ident, data, mode)
      % Asks for a command, by number, with its identification and data as bytes: return code and bytes of the answer.
      kind = floor(mode / 65536);
      key = sprintf('%d,', command, ident);
      switch kind
        case 6                                           % buffer: what has arrived
          if ~link.is_synchronous && ~link.is_held, link.exchange(); end
        case 7                                           % remove
          link.forget(key);  code = 0;  data = uint8([]);  return
        case 2                                           % streaming: asked for once
          if ~isKey(link.streams, key)
            link.streams(key) = true;
            link.put(command, ident, data, mode);
          elseif ~link.is_synchronous && ~link.is_held
            link.exchange();
          end
        case 5                                           % discontinue
          link.put(command, ident, data, mode);
          link.forget(key);  code = 0;  data = uint8([]);  return
        otherwise
          link.put(command, ident, data, mode);
      end
      [code, data] = link.arrived(key);
      if kind < 2 && isKey(link.inbox, key) && ~isKey(link.streams, key), remove(link.inbox, key); end
    end

    function exchange(link)
      % Sends what has been gathered, takes the answer apart.
      message = [zeros(1, 2, 'uint8'), uint8(11), bytes(int32(link.n_messages)), zeros(1, 11, 'uint8'), link.gathered];
      link.n_messages = link.n_messages + 1;
      link.gathered = uint8([]);
      link.send(message);
      link.take(link.receive());
    end
  end

  methods (Access = private)
    function put(link, command, ident, data, mode)
      size = bytes(int32(26 + numel(ident) + numel(data)));
      head = [size, size, bytes(uint16(numel(ident))), zeros(1, 4, 'uint8'), bytes(uint32(command + mode)), zeros(1, 8, 'uint8')];
      link.gathered = [link.gathered, head, ident, data];
      if ~link.is_held, link.exchange(); end
    end

    function [code, data] = arrived(link, key)
      data = uint8([]);
      if ~isKey(link.inbox, key)
        code = 1;                                        % nothing has arrived yet
        return
      end
      entry = link.inbox(key);
      link.command_time = entry.time;
      code = 8 * double(entry.failed);
      if ~entry.failed, data = entry.data; end
    end

    function forget(link, key)
      if isKey(link.inbox, key), remove(link.inbox, key); end
      if isKey(link.streams, key), remove(link.streams, key); end
    end

    function send(link, message)
      most = 1294;                                       % bytes of a packet
      n = max(1, ceil(numel(message) / most));
      packets = uint8([]);
      for k = 1:n
        part = message((k - 1) * most + 1 : min(k * most, end));
        packets = [packets, bytes(int16([1, numel(part), n - k])), part];
      end
      write(link.socket, packets);
    end

    function message = receive(link)
      message = uint8([]);
      remaining = 1;
      while remaining > 0
        head = typecast(take_bytes(link.socket, 6), 'int16');
        message = [message, take_bytes(link.socket, double(head(2)))];
        remaining = double(head(3));
      end
    end

    function take(link, message)
      at = 18;                                           % what is before is the head of the message
      while at + 26 <= numel(message)
        total = double(typecast(message(at + (1:4)), 'int32'));
        n_ident = double(typecast(message(at + (9:10)), 'uint16'));
        command = double(typecast(message(at + (15:18)), 'uint32'));
        entry.failed = bitand(message(at + 25), 1) == 1;
        entry.time = double(typecast(message(at + (21:24)), 'int32'));
        ident = message(at + 26 + (1:n_ident));
        entry.data = message(at + 26 + n_ident + 1 : at + total);
        link.inbox(sprintf('%d,', mod(command, 65536), ident)) = entry;
        at = at + total;
      end
    end
  end
end

function b = bytes(numbers)
  b = typecast(numbers, 'uint8');
end

function b = take_bytes(socket, n)
  b = uint8(read(socket, n));
  if numel(b) < n, error('simxLink: the server has closed the connection or did not answer in time'); end
  b = reshape(b, 1, []);
end
