"""Runs the Python examples against a server on free ports: python3 check.py SINCRO [SCENES].

Needs coppeliasim-zmqremoteapi-client. Ends with 0 if the runs of the clients have the trace hashes of `sincro run`.
"""

import asyncio
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import time

from coppeliasim_zmqremoteapi_client import RemoteAPIClient
from coppeliasim_zmqremoteapi_client.asyncio import RemoteAPIClient as AsyncClient

HERE = pathlib.Path(__file__).resolve().parent

PROGRAMS = {'two-dof-remote': 'two_dof.py', 'quadrotor-remote': 'quadrotor.py', 'alexandros-remote': 'alexandros.py'}


def points(sim):
    """Fifty points are made, moved and removed; callbacks are called; errors are raised."""
    handles = [sim.createDummy(0.01, 12 * [0]) for _ in range(50)]
    for k, handle in enumerate(handles):
        sim.setObjectPosition(handle, -1, [0.01 * k, 0.01 * k, 0.01 * k])
    assert sim.getObjectPosition(handles[7], -1) == [0.07, 0.07, 0.07]
    for handle in handles:
        sim.removeObject(handle)
    assert sim.testCB(21, lambda a, b: a + b, 21) == 42
    try:
        sim.getObject('/nothing')
        raise AssertionError('an object that is not there was found')
    except Exception as error:
        assert 'Object does not exist' in str(error), error


def runs(sim):
    """A free run, then a stepped one."""
    sim.startSimulation()
    while sim.getSimulationTime() < 1:
        pass
    sim.stopSimulation()
    assert sim.getSimulationState() == sim.simulation_stopped
    sim.setStepping(True)
    sim.startSimulation()
    assert sim.getSimulationTime() == 0
    sim.step()
    assert sim.getSimulationTime() == sim.getSimulationTimeStep()
    sim.stopSimulation()


async def many(port):
    """Fifty calls at once, on fifty sockets."""
    async with AsyncClient(port=port) as client:
        sim = await client.require('sim')
        handles = await asyncio.gather(*[sim.createDummy(0.01, 12 * [0]) for _ in range(50)])
        assert len(set(handles)) == 50
        await asyncio.gather(*[sim.removeObject(handle) for handle in handles])


STEPPER = """
import sys
from coppeliasim_zmqremoteapi_client import RemoteAPIClient
sim = RemoteAPIClient(port=int(sys.argv[1])).require('sim')
sim.setStepping(True)
print('ready', flush=True)
while True:
    sim.step()
"""


def together(sim, port):
    """Time advances when both clients have stepped; when one is killed, the other goes on."""
    other = subprocess.Popen([sys.executable, '-c', STEPPER, str(port)], stdout=subprocess.PIPE, text=True)
    assert other.stdout.readline() == 'ready\n'
    sim.setStepping(True)
    sim.startSimulation()
    for k in range(5):
        sim.step()
        assert abs(sim.getSimulationTime() - (k + 1) * sim.getSimulationTimeStep()) < 1e-12
    other.kill()
    other.wait()
    start = time.monotonic()
    sim.step()
    sim.step()
    assert time.monotonic() - start < 1, 'a client that was killed holds the others'
    sim.stopSimulation()


def serve(sincro, scene, out):
    """A server on free ports, and the port for this client; the ports of others are free ones too."""
    ports = ['--legacy-port', '0', '--zmq-port', '0', '--ws-port', '0']
    server = subprocess.Popen([sincro, 'serve', scene, *ports, '--out', out], stdout=subprocess.PIPE, text=True)
    for line in server.stdout:
        found = re.search(r'ZeroMQ.* [\d.]+:(\d+) ', line)
        if found:
            return server, int(found[1])
    raise AssertionError('the server has ended')


def expect_trace(server, run, expected):
    """Waits for the report of a run, which must have the trace of `sincro run`."""
    for line in server.stdout:
        found = re.search(r'run (\d+) .* trace (\w+)', line)
        if found and int(found[1]) == run:
            assert found[2] == expected, f'{found[2]} is not the hash of `sincro run`, {expected}'
            return
    raise AssertionError('the run was not reported')


def main():
    sincro = sys.argv[1]
    scenes = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else HERE.parents[2] / 'scenes')
    for name, program in PROGRAMS.items():
        with tempfile.TemporaryDirectory() as out:
            scene = scenes / name
            subprocess.run([sincro, 'run', scene, '--out', f'{out}/run'], check=True, stdout=subprocess.DEVNULL)
            expected = json.loads(pathlib.Path(f'{out}/run/run.json').read_text())['trace_hash']
            server, port = serve(sincro, scene, f'{out}/served')
            try:
                n_before = 0
                if name == 'two-dof-remote':
                    sim = RemoteAPIClient(port=port).require('sim')
                    points(sim)
                    runs(sim)
                    together(sim, port)
                    n_before = 3
                    asyncio.run(many(port))
                subprocess.run([sys.executable, HERE / program, str(port)], check=True)
                expect_trace(server, n_before + 1, expected)
            finally:
                server.terminate()
                server.wait()
        print(f'{name}: the client and the diagram have the same trace, {expected}')


if __name__ == '__main__':
    main()
