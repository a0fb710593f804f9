# scene: arm
"""Pictures and depths as arrays."""

import sys

from coppeliasim_zmqremoteapi_client import RemoteAPIClient

client = RemoteAPIClient(port=int(sys.argv[1]))
sim = client.require("sim")

import numpy as np  # noqa: E402

eye = sim.getObject('/eye')
sim.setStepping(True)
sim.startSimulation()
sim.step()
data, (width, height) = sim.getVisionSensorImg(eye)
image = np.frombuffer(data, dtype=np.uint8).reshape(height, width, 3).astype(int)
red = (image[:, :, 0] > 2 * image[:, :, 1]) & (image[:, :, 0] > 2 * image[:, :, 2])
rows, columns = np.nonzero(red)
assert 80 < red.sum() < 130 and abs(columns.mean() - 31.5) < 3 and abs(rows.mean() - 23.5) < 3
depth, size = sim.getVisionSensorDepth(eye, 1)
depth = np.frombuffer(depth, dtype=np.float32).reshape(size[1], size[0])
assert abs(depth[24, 32] - 1.8) < 1e-3 and depth.max() < 5.0 + 1e-3
old, w, h = sim.getVisionSensorCharImage(eye)
assert (w, h) == (64, 48) and len(old) == len(data)
sim.stopSimulation()
