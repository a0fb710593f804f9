classdef remApi < handle
  % The legacy remote API of V-REP and CoppeliaSim, for GNU Octave and MATLAB, without a library: existing programs run as they are.
  %
  %     vrep = remApi('remoteApi');
  %     id = vrep.simxStart('127.0.0.1', 19997, true, true, 5000, 5);
  %     [code, joint] = vrep.simxGetObjectHandle(id, 'shoulder#', vrep.simx_opmode_blocking);
  %
  % Octave needs its package instrument-control (`pkg load instrument-control`), MATLAB nothing. Every call is one exchange with the
  % server, so there is no cycle to wait for, and a value that is streamed is there at once; return codes are those of the API:
  % 0 good, 1 no value yet, 8 refused by the server, 64 not connected. Units: m, rad, s, N, N m; quaternions x, y, z, w.

  properties (Constant)
    simx_return_ok = 0;
    simx_return_novalue_flag = 1;
    simx_return_timeout_flag = 2;
    simx_return_illegal_opmode_flag = 4;
    simx_return_remote_error_flag = 8;
    simx_return_local_error_flag = 32;
    simx_return_initialize_error_flag = 64;
    simx_opmode_oneshot = 0;
    simx_opmode_blocking = 65536;
    simx_opmode_oneshot_wait = 65536;
    simx_opmode_streaming = 131072;
    simx_opmode_continuous = 131072;
    simx_opmode_discontinue = 327680;
    simx_opmode_buffer = 393216;
    simx_opmode_remove = 458752;
    sim_handle_world = -1;
    sim_handle_parent = -11;
    sim_object_shape_type = 0;
    sim_object_joint_type = 1;
    sim_object_dummy_type = 4;
    sim_object_proximitysensor_type = 5;
    sim_object_visionsensor_type = 9;
    sim_object_forcesensor_type = 12;
    sim_handle_all = -2;
    sim_scripttype_mainscript = 0;
    sim_scripttype_childscript = 1;
    sim_scripttype_customizationscript = 6;
    sim_jointintparam_motor_enabled = 2000;
    sim_jointintparam_ctrl_enabled = 2001;
    sim_jointfloatparam_velocity = 2012;
    sim_shapefloatparam_mass = 3005;
    sim_floatparam_simulation_time_step = 1;
    sim_intparam_program_version = 1;
    sim_boolparam_realtime_simulation = 25;
    sim_arrayparam_gravity = 0;
  end

  methods
    function api = remApi(varargin)
      % The name of a library and of a header may be given; none is needed.
    end

    function delete(api)
      % Connections outlive the object, as in the original: programs make one in every function.
    end

    % ---- connection and simulation

    function id = simxStart(api, address, port, wait, once, timeout_ms, cycle_ms)
      id = -1;
      known = links();
      for tries = 1:(1 + 1e6 * double(wait && ~once))
        try
          link = simxLink(address, port, max(1, abs(timeout_ms) / 1000));
          id = known.Count;
          while isKey(known, id), id = id + 1; end
          known(id) = link;
          return
        catch
          if wait && ~once, pause(0.2); end
        end
      end
    end

    function simxFinish(api, id)
      known = links();
      if id == -1, ids = cell2mat(keys(known)); else, ids = id; end
      for k = ids
        if isKey(known, k)
          link = known(k);
          remove(known, k);
          link.disconnect();
        end
      end
    end

    function code = simxGetConnectionId(api, id)
      code = double(isKey(links(), id)) - 1;
    end

    function code = simxSynchronous(api, id, enable)
      code = ask(id, 2 - double(logical(enable)), [], [], api.simx_opmode_blocking);
      if code == 0
        link = find_link(id);
        link.is_synchronous = logical(enable);
      end
    end

    function code = simxSynchronousTrigger(api, id)
      code = ask(id, 3, [], [], api.simx_opmode_blocking);
    end

    function code = simxStartSimulation(api, id, mode)
      code = ask(id, 4103, i32(0), [], mode);
    end

    function code = simxPauseSimulation(api, id, mode)
      code = ask(id, 4103, i32(1), [], mode);
    end

    function code = simxStopSimulation(api, id, mode)
      code = ask(id, 4103, i32(2), [], mode);
    end

    function [code, ms] = simxGetPingTime(api, id)
      start = tic;
      code = ask(id, 4129, i32(1), [], api.simx_opmode_blocking);
      ms = round(1000 * toc(start));
    end

    function ms = simxGetLastCmdTime(api, id)
      link = find_link(id);
      if isempty(link), ms = 0; else, ms = link.command_time; end
    end

    function code = simxPauseCommunication(api, id, hold)
      link = find_link(id);
      if isempty(link), code = 64; return, end
      code = 0;
      link.is_held = logical(hold);
      if ~link.is_held, link.exchange(); end
    end

    function [code, errors] = simxGetLastErrors(api, id, mode)
      [code, data] = ask(id, 4, [], [], mode);
      errors = cell(0, 1);
      if numel(data) > 4, errors = texts(data(5:end)).'; end
    end

    function code = simxLoadScene(api, id, path, options, mode)
      code = ask(id, 12290, text(path), [], mode);
    end

    function code = simxCloseScene(api, id, mode)
      code = ask(id, 5, [], [], mode);
    end

    function code = simxAddStatusbarMessage(api, id, message, mode)
      code = ask(id, 12296, text(message), [], mode);
    end

    function [code, ints, floats, strings, buffer] = simxCallScriptFunction(api, id, object, type, name, ints, floats, strings, buffer, mode)
      if ischar(strings) && ~isempty(strings), strings = {strings}; end
      packed = uint8([]);
      for k = 1:numel(strings), packed = [packed, text(strings{k})]; end
      data = [i32([numel(ints), numel(floats), numel(strings), numel(buffer)]), i32(ints), f32(floats), packed, uint8(buffer(:).')];
      [code, data] = ask(id, 13313, [i32(type), text(object), text(name)], data, mode);
      [ints, floats, strings, buffer] = deal([], [], {}, uint8([]));
      if isempty(data), return, end
      n = ints_of(data(1:16));
      ints = ints_of(data(16 + (1:4 * n(1))));
      floats = floats_of(data(16 + 4 * n(1) + (1:4 * n(2))));
      rest = data(16 + 4 * n(1) + 4 * n(2) + 1 : end);
      buffer = rest(end - n(4) + 1 : end);
      strings = texts(rest(1 : end - n(4)));
    end

    % ---- objects

    function [code, handle] = simxGetObjectHandle(api, id, name, mode)
      [code, handle] = whole(ask_for(id, 12289, text(name), mode), -1);
    end

    function [code, handles] = simxGetObjects(api, id, type, mode)
      [code, data] = ask(id, 4138, i32(type), [], mode);
      handles = [];
      if ~isempty(data), handles = ints_of(data(5:end)); end
    end

    function [code, p] = simxGetObjectPosition(api, id, handle, against, mode)
      [code, p] = real_list(ask_for(id, 8206, i32([handle, against]), mode), 3);
    end

    function [code, angles] = simxGetObjectOrientation(api, id, handle, against, mode)
      [code, angles] = real_list(ask_for(id, 8205, i32([handle, against]), mode), 3);
    end

    function [code, q] = simxGetObjectQuaternion(api, id, handle, against, mode)
      [code, q] = real_list(ask_for(id, 10241, i32([handle, against]), mode), 4);
    end

    function [code, v, w] = simxGetObjectVelocity(api, id, handle, mode)
      [code, both] = real_list(ask_for(id, 4150, i32(handle), mode), 6);
      v = both(1:3);  w = both(4:6);
    end

    function code = simxSetObjectPosition(api, id, handle, against, p, mode)
      code = ask(id, 4123, i32(handle), [i32(against), f32(p)], mode);
    end

    function code = simxSetObjectOrientation(api, id, handle, against, angles, mode)
      code = ask(id, 4122, i32(handle), [i32(against), f32(angles)], mode);
    end

    function code = simxSetObjectQuaternion(api, id, handle, against, q, mode)
      code = ask(id, 6145, i32(handle), [i32(against), f32(q)], mode);
    end

    function [code, parent] = simxGetObjectParent(api, id, handle, mode)
      [code, parent] = whole(ask_for(id, 4114, i32(handle), mode), -1);
    end

    function [code, child] = simxGetObjectChild(api, id, handle, index, mode)
      [code, child] = whole(ask_for(id, 8203, i32([handle, index]), mode), -1);
    end

    function code = simxSetObjectParent(api, id, handle, parent, keep, mode)
      code = ask(id, 4124, i32(handle), [i32(parent), uint8(logical(keep))], mode);
    end

    function [code, x] = simxGetObjectIntParameter(api, id, handle, parameter, mode)
      [code, x] = whole(ask_for(id, 8200, i32([handle, parameter]), mode), 0);
    end

    function code = simxSetObjectIntParameter(api, id, handle, parameter, x, mode)
      code = ask(id, 8202, i32([handle, parameter]), i32(x), mode);
    end

    function [code, x] = simxGetObjectFloatParameter(api, id, handle, parameter, mode)
      [code, x] = real_list(ask_for(id, 8199, i32([handle, parameter]), mode), 1);
    end

    function code = simxSetObjectFloatParameter(api, id, handle, parameter, x, mode)
      code = ask(id, 8201, i32([handle, parameter]), f32(x), mode);
    end

    function [code, handle] = simxCreateDummy(api, id, size, colors, mode)
      [code, data] = ask(id, 9, [], [f32(size), zeros(1, 13, 'uint8')], mode);
      [code, handle] = whole({code, data}, -1);
    end

    function code = simxRemoveObject(api, id, handle, mode)
      code = ask(id, 4136, i32(handle), [], mode);
    end

    % ---- joints

    function [code, x] = simxGetJointPosition(api, id, joint, mode)
      [code, x] = real_list(ask_for(id, 4097, i32(joint), mode), 1);
    end

    function code = simxSetJointPosition(api, id, joint, x, mode)
      code = ask(id, 4098, i32(joint), f32(x), mode);
    end

    function code = simxSetJointTargetVelocity(api, id, joint, v, mode)
      code = ask(id, 4104, i32(joint), f32(v), mode);
    end

    function code = simxSetJointTargetPosition(api, id, joint, x, mode)
      code = ask(id, 4108, i32(joint), f32(x), mode);
    end

    function [code, effort] = simxGetJointForce(api, id, joint, mode)
      [code, effort] = real_list(ask_for(id, 4109, i32(joint), mode), 1);
    end

    function [code, effort] = simxJointGetForce(api, id, joint, mode)
      [code, effort] = api.simxGetJointForce(id, joint, mode);
    end

    function [code, effort] = simxGetJointMaxForce(api, id, joint, mode)
      [code, effort] = real_list(ask_for(id, 4152, i32(joint), mode), 1);
    end

    function code = simxSetJointForce(api, id, joint, effort, mode)
      code = ask(id, 4110, i32(joint), f32(effort), mode);
    end

    function code = simxSetJointMaxForce(api, id, joint, effort, mode)
      code = api.simxSetJointForce(id, joint, effort, mode);
    end

    function [code, m] = simxGetJointMatrix(api, id, joint, mode)
      [code, m] = real_list(ask_for(id, 4106, i32(joint), mode), 12);
    end

    % ---- sensors

    function [code, state, force, torque] = simxReadForceSensor(api, id, sensor, mode)
      [code, data] = ask(id, 4111, i32(sensor), [], mode);
      [state, force, torque] = deal(0, zeros(1, 3), zeros(1, 3));
      if ~isempty(data)
        [state, force, torque] = deal(double(data(1)), floats_of(data(2:13)), floats_of(data(14:25)));
      end
    end

    function [code, state, point, object, normal] = simxReadProximitySensor(api, id, sensor, mode)
      [code, data] = ask(id, 4105, i32(sensor), [], mode);
      [state, point, object, normal] = deal(0, zeros(1, 3), -1, zeros(1, 3));
      if ~isempty(data)
        [state, point] = deal(double(data(1)), floats_of(data(2:13)));
        [object, normal] = deal(ints_of(data(14:17)), floats_of(data(18:29)));
      end
    end

    function [code, resolution, image] = simxGetVisionSensorImage2(api, id, sensor, grey, mode)
      [code, data] = ask(id, 4100 - double(logical(grey)), i32(sensor), [], mode);
      [resolution, image] = deal([0, 0], uint8([]));
      if isempty(data), return, end
      resolution = ints_of(data(1:8));
      n = 3 - 2 * double(logical(grey));
      % rows from the lowest one; as a picture of Octave: from the highest one, colours last
      image = permute(reshape(data(9:end), n, resolution(1), resolution(2)), [3, 2, 1]);
      image = image(end:-1:1, :, :);
    end

    function [code, resolution, depth] = simxGetVisionSensorDepthBuffer2(api, id, sensor, mode)
      [code, data] = ask(id, 4119, i32(sensor), [], mode);
      [resolution, depth] = deal([0, 0], []);
      if isempty(data), return, end
      resolution = ints_of(data(1:8));
      depth = reshape(floats_of(data(9:end)), resolution(1), resolution(2)).';
      depth = depth(end:-1:1, :);
    end

    function [code, hit] = simxCheckCollision(api, id, one, other, mode)
      [code, hit] = whole(ask_for(id, 8207, i32([one, other]), mode), 0);
    end

    function [code, distance] = simxCheckDistance(api, id, one, other, mode)
      [code, distance] = real_list(ask_for(id, 8208, i32([one, other]), mode), 1);
    end

    % ---- signals and parameters

    function [code, x] = simxGetFloatSignal(api, id, name, mode)
      [code, x] = real_list(ask_for(id, 12304, text(name), mode), 1);
    end

    function code = simxSetFloatSignal(api, id, name, x, mode)
      code = ask(id, 12307, text(name), f32(x), mode);
    end

    function code = simxClearFloatSignal(api, id, name, mode)
      code = ask(id, 12301, text(name), [], mode);
    end

    function [code, x] = simxGetIntegerSignal(api, id, name, mode)
      [code, x] = whole(ask_for(id, 12305, text(name), mode), 0);
    end

    function code = simxSetIntegerSignal(api, id, name, x, mode)
      code = ask(id, 12308, text(name), i32(x), mode);
    end

    function code = simxClearIntegerSignal(api, id, name, mode)
      code = ask(id, 12302, text(name), [], mode);
    end

    function [code, bytes] = simxGetStringSignal(api, id, name, mode)
      [code, bytes] = ask(id, 12306, text(name), [], mode);
      bytes = char(bytes);
    end

    function code = simxSetStringSignal(api, id, name, bytes, mode)
      code = ask(id, 12309, text(name), uint8(bytes(:).'), mode);
    end

    function code = simxClearStringSignal(api, id, name, mode)
      code = ask(id, 12303, text(name), [], mode);
    end

    function [code, x] = simxGetIntegerParameter(api, id, parameter, mode)
      [code, x] = whole(ask_for(id, 4129, i32(parameter), mode), 0);
    end

    function code = simxSetIntegerParameter(api, id, parameter, x, mode)
      code = ask(id, 4130, i32(parameter), i32(x), mode);
    end

    function [code, x] = simxGetFloatingParameter(api, id, parameter, mode)
      [code, x] = real_list(ask_for(id, 4131, i32(parameter), mode), 1);
    end

    function code = simxSetFloatingParameter(api, id, parameter, x, mode)
      code = ask(id, 4132, i32(parameter), f32(x), mode);
    end

    function [code, x] = simxGetBooleanParameter(api, id, parameter, mode)
      [code, x] = whole(ask_for(id, 4127, i32(parameter), mode), 0);
    end

    function code = simxSetBooleanParameter(api, id, parameter, x, mode)
      code = ask(id, 4128, i32(parameter), i32(double(logical(x))), mode);
    end

    function [code, x] = simxGetArrayParameter(api, id, parameter, mode)
      [code, x] = real_list(ask_for(id, 4125, i32(parameter), mode), 3);
    end

    function code = simxSetArrayParameter(api, id, parameter, x, mode)
      code = ask(id, 4126, i32(parameter), f32(x), mode);
    end

    function [code, x] = simxGetStringParameter(api, id, parameter, mode)
      [code, data] = ask(id, 4133, i32(parameter), [], mode);
      x = char(data(data ~= 0));
    end
  end
end

% ---- connections and bytes

function known = links()
  persistent all;
  if isempty(all)
    if exist('OCTAVE_VERSION', 'builtin'), pkg load instrument-control, end
    all = containers.Map('KeyType', 'double', 'ValueType', 'any');
  end
  known = all;
end

function link = find_link(id)
  known = links();
  link = [];
  if isKey(known, id), link = known(id); end
end

function [code, answer] = ask(id, command, ident, data, mode)
  answer = uint8([]);
  link = find_link(id);
  if isempty(link), code = 64; return, end
  [code, answer] = link.ask(command, uint8(ident), uint8(data), mode);
end

function both = ask_for(id, command, ident, mode)
  [code, data] = ask(id, command, ident, [], mode);
  both = {code, data};
end

function [code, x] = whole(answer, none)
  [code, x] = deal(answer{1}, none);
  if numel(answer{2}) >= 4, x = ints_of(answer{2}(1:4)); end
end

function [code, x] = real_list(answer, n)
  [code, x] = deal(answer{1}, zeros(1, n));
  if numel(answer{2}) >= 4 * n, x = floats_of(answer{2}(1:4 * n)); end
end

function b = i32(x)
  b = typecast(int32(reshape(x, 1, [])), 'uint8');
end

function b = f32(x)
  b = typecast(single(reshape(x, 1, [])), 'uint8');
end

function b = text(characters)
  b = [uint8(characters), uint8(0)];
end

function x = ints_of(data)
  x = double(typecast(data, 'int32'));
end

function x = floats_of(data)
  x = double(typecast(data, 'single'));
end

function list = texts(data)
  ends = find(data == 0);
  starts = [1, ends(1:end - 1) + 1];
  list = arrayfun(@(a, b) char(data(a:b - 1)), starts, ends, 'UniformOutput', false);
end
