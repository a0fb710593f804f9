# scene: arm
"""Two clients step the simulation together, each with its own joint."""

import sys

from coppeliasim_zmqremoteapi_client import RemoteAPIClient

client = RemoteAPIClient(port=int(sys.argv[1]))
sim = client.require("sim")

import threading  # noqa: E402


def drive(number, goal):
    own = RemoteAPIClient(port=int(sys.argv[1])).require('sim')
    joint = own.getObject(f'/joint{number}')
    own.setStepping(True)
    ready.wait()
    if number == 1:
        own.startSimulation()
    ready.wait()
    while (t := own.getSimulationTime()) < 3:
        own.setJointTargetPosition(joint, goal)
        own.step()
        times[number].append(t)
    results[number] = own.getJointPosition(joint)


ready, times, results = threading.Barrier(2), {1: [], 2: []}, {}
threads = [threading.Thread(target=drive, args=pair) for pair in ((1, 0.4), (2, 1.0))]
[thread.start() for thread in threads]
[thread.join(60) for thread in threads]
assert times[1] == times[2] and len(times[1]) == 60, (len(times[1]), len(times[2]))
assert abs(results[1] - 0.4) < 1e-3 and abs(results[2] - 1.0) < 1e-3, results
sim.stopSimulation()
