"""Position control of the arm in scenes/two-dof-remote, from Python over the ZeroMQ remote API.

    pip install coppeliasim-zmqremoteapi-client
    sincro serve scenes/two-dof-remote          # in another terminal
    python3 examples/clients/python/two_dof.py [PORT]

The loop of the thesis: read the joints, compute, set the speeds, step. The run is the one that `sincro run scenes/two-dof-remote` makes
with the same law as a diagram: both print the same trace hash.
"""

import math
import sys

from coppeliasim_zmqremoteapi_client import RemoteAPIClient

K_POS = 2.03  # position gain [1/s]
GOAL = (1.0, -0.5)  # [rad]
DURATION = 6.0  # [s]


def rounded(speed):
    """To 1/1024 rad/s, halves away from zero."""
    return math.copysign(math.floor(abs(speed) * 1024 + 0.5), speed) / 1024


def main():
    port = int(sys.argv[1]) if len(sys.argv) > 1 else 23000
    sim = RemoteAPIClient(port=port).require('sim')
    joints = [sim.getObject('/shoulder'), sim.getObject('/shoulder/elbow')]

    sim.setStepping(True)  # before every run: it ends with the run
    sim.startSimulation()  # time stays 0 until the first step
    step = sim.getSimulationTimeStep()
    for _ in range(round(DURATION / step)):
        for joint, goal in zip(joints, GOAL):
            position = sim.getJointPosition(joint)
            sim.setJointTargetVelocity(joint, rounded(K_POS * (goal - position)))
        sim.step()  # returns when the step is done
    positions = [sim.getJointPosition(joint) for joint in joints]
    print(f'{sim.getSimulationTime():.3f} s: {positions[0]:.9f} {positions[1]:.9f} rad')
    sim.stopSimulation()


if __name__ == '__main__':
    main()
