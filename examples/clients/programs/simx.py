"""The legacy remote API of V-REP in plain Python: functions and constants have the names of V-REP's own binding.

A connection sends one message for each call and waits for the answer, so there is no thread and no cycle to wait for. What is streamed is
kept with every answer, as the C library keeps it: `simx_opmode_buffer` reads it without a message.
"""

import socket
import struct
import time

simx_opmode_oneshot = 0x000000
simx_opmode_blocking = simx_opmode_oneshot_wait = 0x010000
simx_opmode_streaming = simx_opmode_continuous = 0x020000
simx_opmode_discontinue = 0x050000
simx_opmode_buffer = 0x060000
simx_opmode_remove = 0x070000
simx_return_ok, simx_return_novalue_flag, simx_return_remote_error_flag, simx_return_initialize_error_flag = 0, 1, 8, 64
sim_handle_all, sim_handle_parent = -2, -11
sim_object_shape_type, sim_object_joint_type, sim_object_dummy_type, sim_object_visionsensor_type = 0, 1, 4, 9
sim_scripttype_childscript = 1
sim_jointfloatparam_velocity, sim_jointintparam_ctrl_enabled, sim_jointintparam_motor_enabled = 2012, 2001, 2000
sim_floatparam_simulation_time_step, sim_intparam_program_version, sim_boolparam_display_enabled = 1, 1, 16
sim_arrayparam_gravity, sim_boolparam_realtime_simulation = 0, 25

_links = {}


class _Link:
    def __init__(self, address, port, timeout):
        self.socket = socket.create_connection((address, port), timeout)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.number = 0
        self.command_time = 0
        self.held = None
        self.inbox = {}

    def exchange(self, commands):
        message = struct.pack('<HBiiiHB', 0, 11, self.number, 0, 0, 0, 0) + b''.join(commands)
        self.number += 1
        pieces = [message[k:k + 1294] for k in range(0, len(message), 1294)]
        for left, piece in zip(range(len(pieces) - 1, -1, -1), pieces):
            self.socket.sendall(struct.pack('<hhh', 1, len(piece), left) + piece)
        answer, left = b'', 1
        while left:
            _, size, left = struct.unpack('<hhh', self._take(6))
            answer += self._take(size)
        at = 18
        while at < len(answer):
            size, _, n_ident, _, code, _, now, status, _ = struct.unpack_from('<iiHiiHiBB', answer, at)
            key = (code & 0xffff, answer[at + 26:at + 26 + n_ident])
            self.command_time = now
            if code & 0x70000 == simx_opmode_discontinue:
                self.inbox.pop(key, None)
            else:
                self.inbox[key] = (status & 1, answer[at + 26 + n_ident:at + size])
            at += size

    def _take(self, n):
        data = b''
        while len(data) < n:
            more = self.socket.recv(n - len(data))
            if not more:
                raise ConnectionError('the server has closed the connection')
            data += more
        return data

    def call(self, number, ident, data, mode):
        """Return code and data of a command."""
        key, kind = (number, ident), mode & 0x70000
        if kind == simx_opmode_remove:
            self.inbox.pop(key, None)
            return simx_return_ok, b''
        if kind != simx_opmode_buffer:
            size = 26 + len(ident) + len(data)
            command = struct.pack('<iiHiiHiBB', size, size, len(ident), 0, number | kind, mode & 0xffff, 0, 0, 0) + ident + data
            was_there = self.inbox.get(key)
            if self.held is not None:
                self.held.append(command)
            else:
                self.exchange([command])
            if kind != simx_opmode_blocking and self.held is None and was_there is None:
                # the C library has no value of a first streaming or oneshot call yet
                return simx_return_novalue_flag, b''
        if key not in self.inbox:
            return simx_return_novalue_flag, b''
        failed, reply = self.inbox.pop(key) if kind == simx_opmode_blocking else self.inbox[key]
        return (simx_return_remote_error_flag, b'') if failed else (simx_return_ok, reply)


def _call(client, number, ident, data, mode):
    link = _links.get(client)
    return link.call(number, ident, data, mode) if link else (simx_return_initialize_error_flag, b'')


def _ints(*numbers):
    return struct.pack(f'<{len(numbers)}i', *numbers)


def _floats(numbers):
    return struct.pack(f'<{len(numbers)}f', *numbers)


def _name(text):
    return (text.encode() if isinstance(text, str) else text) + b'\0'


def _read(reply, form, default):
    code, data = reply
    return (code, *struct.unpack_from('<' + form, data)) if code == 0 else (code, *default)


def _vector(reply, n):
    code, *numbers = _read(reply, f'{n}f', n * [0.0])
    return code, numbers


def simxStart(address, port, wait_until_connected, do_not_reconnect, timeout_ms, cycle_ms):
    try:
        link = _Link(address, port, max(1, abs(timeout_ms) / 1000))
    except OSError:
        return -1
    client = next(k for k in range(len(_links) + 1) if k not in _links)
    _links[client] = link
    return client


def simxFinish(client):
    for k in list(_links) if client == -1 else [client]:
        link = _links.pop(k, None)
        if link:
            link.socket.close()


def simxGetConnectionId(client):
    return 1 if client in _links else -1


def simxSynchronous(client, enable):
    return _call(client, 1 if enable else 2, b'', b'', simx_opmode_blocking)[0]


def simxSynchronousTrigger(client):
    return _call(client, 3, b'', b'', simx_opmode_blocking)[0]


def simxGetPingTime(client):
    start = time.monotonic()
    code, _ = _call(client, 0x1021, _ints(1), b'', simx_opmode_blocking)
    return code, round(1000 * (time.monotonic() - start))


def simxGetLastCmdTime(client):
    return _links[client].command_time


def simxPauseCommunication(client, pause):
    link = _links[client]
    held, link.held = link.held, [] if pause else None
    if held:
        link.exchange(held)
    return 0


def simxGetLastErrors(client, mode):
    code, data = _call(client, 4, b'', b'', mode)
    return code, [text.decode() for text in data[4:].split(b'\0')[:-1]]


def simxStartSimulation(client, mode):
    return _call(client, 0x1007, _ints(0), b'', mode)[0]


def simxPauseSimulation(client, mode):
    return _call(client, 0x1007, _ints(1), b'', mode)[0]


def simxStopSimulation(client, mode):
    return _call(client, 0x1007, _ints(2), b'', mode)[0]


def simxLoadScene(client, path, options, mode):
    return _call(client, 0x3002, _name(path), b'', mode)[0]


def simxAddStatusbarMessage(client, text, mode):
    return _call(client, 0x3008, _name(text), b'', mode)[0]


def simxGetObjectHandle(client, name, mode):
    return _read(_call(client, 0x3001, _name(name), b'', mode), 'i', [-1])


def simxGetObjects(client, kind, mode):
    code, data = _call(client, 0x102a, _ints(kind), b'', mode)
    return code, list(struct.unpack_from(f'<{struct.unpack_from("<i", data)[0]}i', data, 4)) if code == 0 else []


def simxGetObjectParent(client, handle, mode):
    return _read(_call(client, 0x1012, _ints(handle), b'', mode), 'i', [-1])


def simxGetObjectChild(client, handle, index, mode):
    return _read(_call(client, 0x200b, _ints(handle, index), b'', mode), 'i', [-1])


def simxSetObjectParent(client, handle, parent, keep, mode):
    return _call(client, 0x101c, _ints(handle), struct.pack('<iB', parent, keep), mode)[0]


def simxCreateDummy(client, size, colors, mode):
    return _read(_call(client, 9, b'', struct.pack('<fB12x', size, 0), mode), 'i', [-1])


def simxRemoveObject(client, handle, mode):
    return _call(client, 0x1028, _ints(handle), b'', mode)[0]


def simxRemoveModel(client, handle, mode):
    return _call(client, 0x1037, _ints(handle), b'', mode)[0]


def simxCopyPasteObjects(client, handles, mode):
    code, data = _call(client, 0x102e, b'', struct.pack(f'<{len(handles)}i', *handles), mode)
    return code, list(struct.unpack_from(f'<{struct.unpack_from("<i", data)[0]}i', data, 4)) if code == 0 else []


def simxLoadModel(client, path, options, mode):
    return _read(_call(client, 0x3003, _name(path), struct.pack('<B', options), mode), 'i', [-1])


def simxGetObjectPosition(client, handle, against, mode):
    return _vector(_call(client, 0x200e, _ints(handle, against), b'', mode), 3)


def simxGetObjectOrientation(client, handle, against, mode):
    return _vector(_call(client, 0x200d, _ints(handle, against), b'', mode), 3)


def simxGetObjectQuaternion(client, handle, against, mode):
    return _vector(_call(client, 0x2801, _ints(handle, against), b'', mode), 4)


def simxSetObjectPosition(client, handle, against, position, mode):
    return _call(client, 0x101b, _ints(handle), _ints(against) + _floats(position), mode)[0]


def simxSetObjectOrientation(client, handle, against, angles, mode):
    return _call(client, 0x101a, _ints(handle), _ints(against) + _floats(angles), mode)[0]


def simxSetObjectQuaternion(client, handle, against, quaternion, mode):
    return _call(client, 0x1801, _ints(handle), _ints(against) + _floats(quaternion), mode)[0]


def simxGetObjectVelocity(client, handle, mode):
    code, numbers = _vector(_call(client, 0x1036, _ints(handle), b'', mode), 6)
    return code, numbers[:3], numbers[3:]


def simxGetJointPosition(client, joint, mode):
    return _read(_call(client, 0x1001, _ints(joint), b'', mode), 'f', [0.0])


def simxSetJointPosition(client, joint, position, mode):
    return _call(client, 0x1002, _ints(joint), _floats([position]), mode)[0]


def simxSetJointTargetVelocity(client, joint, velocity, mode):
    return _call(client, 0x1008, _ints(joint), _floats([velocity]), mode)[0]


def simxSetJointTargetPosition(client, joint, position, mode):
    return _call(client, 0x100c, _ints(joint), _floats([position]), mode)[0]


def simxGetJointForce(client, joint, mode):
    return _read(_call(client, 0x100d, _ints(joint), b'', mode), 'f', [0.0])


def simxSetJointMaxForce(client, joint, force, mode):
    return _call(client, 0x100e, _ints(joint), _floats([force]), mode)[0]


simxJointGetForce, simxSetJointForce = simxGetJointForce, simxSetJointMaxForce


def simxReadForceSensor(client, sensor, mode):
    code, state, *six = _read(_call(client, 0x100f, _ints(sensor), b'', mode), 'B6f', [0] + 6 * [0.0])
    return code, state, six[:3], six[3:]


def simxReadProximitySensor(client, sensor, mode):
    default = [0, 0.0, 0.0, 0.0, -1, 0.0, 0.0, 0.0]
    code, state, x, y, z, found, u, v, w = _read(_call(client, 0x1009, _ints(sensor), b'', mode), 'B3fi3f', default)
    return code, state != 0, [x, y, z], found, [u, v, w]


def simxGetVisionSensorImage(client, sensor, grey, mode):
    code, data = _call(client, 0x1003 if grey else 0x1004, _ints(sensor), b'', mode)
    if code:
        return code, [], []
    return code, list(struct.unpack_from('<ii', data)), list(struct.unpack_from(f'<{len(data) - 8}b', data, 8))


def simxGetVisionSensorDepthBuffer(client, sensor, mode):
    code, data = _call(client, 0x1017, _ints(sensor), b'', mode)
    if code:
        return code, [], []
    return code, list(struct.unpack_from('<ii', data)), list(struct.unpack_from(f'<{(len(data) - 8) // 4}f', data, 8))


def simxCheckCollision(client, one, other, mode):
    return _read(_call(client, 0x200f, _ints(one, other), b'', mode), 'i', [0])


def simxCheckDistance(client, one, other, mode):
    return _read(_call(client, 0x2010, _ints(one, other), b'', mode), 'f', [0.0])


def simxGetCollisionHandle(client, name, mode):
    return _read(_call(client, 0x300a, _name(name), b'', mode), 'i', [-1])


def simxReadCollision(client, handle, mode):
    code, state = _read(_call(client, 0x1026, _ints(handle), b'', mode), 'i', [0])
    return code, state != 0


def simxGetDistanceHandle(client, name, mode):
    return _read(_call(client, 0x300b, _name(name), b'', mode), 'i', [-1])


def simxReadDistance(client, handle, mode):
    return _read(_call(client, 0x1027, _ints(handle), b'', mode), 'f', [0.0])


def simxGetObjectFloatParameter(client, handle, number, mode):
    return _read(_call(client, 0x2007, _ints(handle, number), b'', mode), 'f', [0.0])


def simxSetObjectFloatParameter(client, handle, number, value, mode):
    return _call(client, 0x2009, _ints(handle, number), _floats([value]), mode)[0]


def simxGetObjectIntParameter(client, handle, number, mode):
    return _read(_call(client, 0x2008, _ints(handle, number), b'', mode), 'i', [0])


def simxSetObjectIntParameter(client, handle, number, value, mode):
    return _call(client, 0x200a, _ints(handle, number), _ints(value), mode)[0]


def simxGetIntegerParameter(client, number, mode):
    return _read(_call(client, 0x1021, _ints(number), b'', mode), 'i', [0])


def simxGetFloatingParameter(client, number, mode):
    return _read(_call(client, 0x1023, _ints(number), b'', mode), 'f', [0.0])


def simxGetBooleanParameter(client, number, mode):
    return _read(_call(client, 0x101f, _ints(number), b'', mode), 'i', [0])


def simxSetBooleanParameter(client, number, value, mode):
    return _call(client, 0x1020, _ints(number), _ints(value), mode)[0]


def simxSetFloatingParameter(client, number, value, mode):
    return _call(client, 0x1024, _ints(number), _floats([value]), mode)[0]


def simxGetArrayParameter(client, number, mode):
    return _vector(_call(client, 0x101d, _ints(number), b'', mode), 3)


def simxSetArrayParameter(client, number, values, mode):
    return _call(client, 0x101e, _ints(number), _floats(values), mode)[0]


def simxSetIntegerSignal(client, name, value, mode):
    return _call(client, 0x3014, _name(name), _ints(value), mode)[0]


def simxGetIntegerSignal(client, name, mode):
    return _read(_call(client, 0x3011, _name(name), b'', mode), 'i', [0])


def simxSetFloatSignal(client, name, value, mode):
    return _call(client, 0x3013, _name(name), _floats([value]), mode)[0]


def simxGetFloatSignal(client, name, mode):
    return _read(_call(client, 0x3010, _name(name), b'', mode), 'f', [0.0])


def simxClearFloatSignal(client, name, mode):
    return _call(client, 0x300d, _name(name), b'', mode)[0]


def simxSetStringSignal(client, name, value, mode):
    return _call(client, 0x3015, _name(name), bytes(value), mode)[0]


def simxGetStringSignal(client, name, mode):
    return _call(client, 0x3012, _name(name), b'', mode)


def simxAppendStringSignal(client, name, value, mode):
    return _call(client, 0x3016, _name(name), bytes(value), mode)[0]


def simxReadStringStream(client, name, mode):
    return _call(client, 0x3018, _name(name), b'', mode)


def simxPackFloats(numbers):
    return _floats(numbers)


def simxUnpackFloats(data):
    return list(struct.unpack(f'<{len(data) // 4}f', data))


def simxCallScriptFunction(client, name, kind, function, ints, floats, strings, buffer, mode):
    texts = b''.join(_name(text) for text in strings)
    data = _ints(len(ints), len(floats), len(strings), len(buffer)) + _ints(*ints) + _floats(floats) + texts + bytes(buffer)
    code, reply = _call(client, 0x3401, _ints(kind) + _name(name) + _name(function), data, mode)
    if code:
        return code, [], [], [], b''
    n_ints, n_floats, n_strings, n_bytes = struct.unpack_from('<4i', reply)
    at = 16 + 4 * n_ints
    out_ints = list(struct.unpack_from(f'<{n_ints}i', reply, 16))
    out_floats = list(struct.unpack_from(f'<{n_floats}f', reply, at))
    rest = reply[at + 4 * n_floats:]
    out_strings = []
    for _ in range(n_strings):
        text, _, rest = rest.partition(b'\0')
        out_strings.append(text.decode())
    return code, out_ints, out_floats, out_strings, rest[:n_bytes]
