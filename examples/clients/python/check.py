"""Runs the Python examples against a server on free ports: python3 check.py SINCRO [SCENES].

Needs coppeliasim-zmqremoteapi-client. Ends with 0 if the run of the client has the trace hash of `sincro run`.
"""

import asyncio
import json
import pathlib
import re
import subprocess
import sys
import tempfile

from coppeliasim_zmqremoteapi_client import RemoteAPIClient
from coppeliasim_zmqremoteapi_client.asyncio import RemoteAPIClient as AsyncClient

HERE = pathlib.Path(__file__).resolve().parent


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


def main():
    sincro = sys.argv[1]
    scenes = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else HERE.parents[2] / 'scenes')
    scene = scenes / 'two-dof-remote'
    with tempfile.TemporaryDirectory() as out:
        subprocess.run([sincro, 'run', scene, '--out', f'{out}/run'], check=True, stdout=subprocess.DEVNULL)
        expected = json.loads(pathlib.Path(f'{out}/run/run.json').read_text())['trace_hash']
        # a port below this one's is not needed: the one after it is the step counter's
        ports = ['--legacy-port', '0', '--zmq-port', '0', '--ws-port', '0']
        server = subprocess.Popen([sincro, 'serve', scene, *ports, '--out', f'{out}/served'], stdout=subprocess.PIPE, text=True)
        try:
            port = None
            while port is None:
                line = server.stdout.readline()
                assert line, 'the server has ended'
                found = re.search(r'ZeroMQ.* [\d.]+:(\d+) ', line)
                port = found and int(found[1])
            sim = RemoteAPIClient(port=port).require('sim')
            points(sim)
            runs(sim)
            asyncio.run(many(port))
            subprocess.run([sys.executable, HERE / 'two_dof.py', str(port)], check=True)
            for line in server.stdout:
                found = re.search(r'run (\d+) .* trace (\w+)', line)
                if found and found[1] == '3':
                    assert found[2] == expected, f'{found[2]} is not the hash of `sincro run`, {expected}'
                    break
            else:
                raise AssertionError('the run was not reported')
        finally:
            server.terminate()
            server.wait()
    print(f'the client and the diagram have the same trace: {expected}')


if __name__ == '__main__':
    main()
