"""Steps scenes/two-dof-remote with the client of CoppeliaSim 4.3 to 4.5 (version 1): python3 check_v1.py SINCRO [SCENES].

Needs coppeliasim-zmqremoteapi-client 0.0.5. Starts a server on free ports and ends it; ends with 0 if the run has the trace hash of `sincro run`.
"""

import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

from coppeliasim_zmqremoteapi_client import RemoteAPIClient

HERE = pathlib.Path(__file__).resolve().parent


def speed(goal, position):
    """k_pos times the error, to 1/1024 rad/s, halves away from zero."""
    x = 2.03 * (goal - position)
    return math.copysign(math.floor(abs(x) * 1024 + 0.5), x) / 1024


def main():
    sincro = sys.argv[1]
    scenes = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else HERE.parents[2] / 'scenes')
    with tempfile.TemporaryDirectory() as out:
        scene = scenes / 'two-dof-remote'
        subprocess.run([sincro, 'run', scene, '--out', f'{out}/run'], check=True, stdout=subprocess.DEVNULL)
        expected = json.loads(pathlib.Path(f'{out}/run/run.json').read_text())['trace_hash']
        ports = ['--legacy-port', '0', '--zmq-port', '0', '--ws-port', '0']
        server = subprocess.Popen([sincro, 'serve', scene, *ports, '--out', f'{out}/served'], stdout=subprocess.PIPE, text=True)
        try:
            found = None
            while not found:
                line = server.stdout.readline()
                assert line, 'the server has ended'
                found = re.search(r'ZeroMQ.* [\d.]+:(\d+) .*:(\d+)\)', line)
            client = RemoteAPIClient(port=int(found[1]), cntport=int(found[2]))
            sim = client.getObject('sim')
            joints = [sim.getObject('/shoulder'), sim.getObject('/shoulder/elbow')]
            client.setStepping(True)
            sim.startSimulation()
            for _ in range(round(6 / sim.getSimulationTimeStep())):
                for joint, goal in zip(joints, (1.0, -0.5)):
                    sim.setJointTargetVelocity(joint, speed(goal, sim.getJointPosition(joint)))
                client.step()
            sim.stopSimulation()
            for line in server.stdout:
                found = re.search(r'run 1 .* trace (\w+)', line)
                if found:
                    assert found[1] == expected, f'{found[1]} is not the hash of `sincro run`, {expected}'
                    break
            else:
                raise AssertionError('the run was not reported')
        finally:
            server.terminate()
            server.wait()
    print(f'two-dof-remote: the client of version 1 and the diagram have the same trace, {expected}')


if __name__ == '__main__':
    main()
