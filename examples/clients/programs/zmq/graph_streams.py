# scene: table
"""Streams of a graph, messages, and the time of runs: three of them, each reset."""

import sys

from coppeliasim_zmqremoteapi_client import RemoteAPIClient

client = RemoteAPIClient(port=int(sys.argv[1]))
sim = client.require("sim")

graph, ball = sim.getObject('/floor'), sim.getObject('/core')
for _ in range(3):
    sim.setStepping(True)
    sim.startSimulation()
    stream = sim.addGraphStream(graph, 'height', 'm')
    while sim.getSimulationTime() < 0.2:
        sim.setGraphStreamValue(graph, stream, sim.getObjectPosition(ball)[2])
        sim.step()
    height = sim.getObjectPosition(ball)[2]
    assert abs(height - (0.5 - 0.5 * 9.81 * sim.getSimulationTime() ** 2)) < 1e-6, height
    sim.addLog(sim.verbosity_scriptinfos, f'height {height}')
    sim.stopSimulation()
    assert sim.getSimulationTime() == 0 and abs(sim.getObjectPosition(ball)[2] - 0.5) < 1e-12
