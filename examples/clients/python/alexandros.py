"""Moves the compliant arm of scenes/alexandros-remote from Python over the ZeroMQ remote API.

    pip install coppeliasim-zmqremoteapi-client
    sincro serve scenes/alexandros-remote       # in another terminal
    python3 examples/clients/python/alexandros.py [PORT]

The law is that of scenes/alexandros-remote/loop.toml, see the README there: both print the same trace hash.
"""

import math
import struct
import sys

from coppeliasim_zmqremoteapi_client import RemoteAPIClient

TS = 0.02  # sample time [s]
DURATION = 32.0  # [s]
RATE = 0.5  # of the adaptation, λ [1/s]
KP = (30.0, 32.0, 36.0, 22.0)  # of the kinematics [rad/(s·m²)]
KS = (0.32, 0.256, 0.224, 0.288)  # share of the motors' error taken back in a sample
GAMMA = (8000.0, 8000.0, 80.0, 800.0, 800.0, 800.0, 80.0, 800.0)  # of the adaptation
BOUND = 6.0  # of the sum of squares of what is learnt
MOST = 5.0  # speed of a motor [rad/s]
AXES = ((0, 1, 0), (1, 0, 0), (0, 0, 1), (0, 1, 0))  # of the joints
LINKS = ((0.0, 0.102, 0.0), (0.0, 0.0, -0.125), (0.0, 0.0, -0.125), (0.27, 0.0, 0.0))  # to the next joint or the tip [m]
MASSES = (0.101, 0.121, 0.11, 0.052)  # of the links, in their middles [kg]
G = 9.81  # [m/s²]
JOINTS = range(4)


def single(x):
    """What is left of a number in single precision: what a legacy client reads."""
    return struct.unpack('<f', struct.pack('<f', x))[0]


def target(k):
    """Where the tip is to be [m]."""
    return (0.27, 0.102, -0.25) if k < 200 else (0.24, 0.152, -0.2) if k < 900 else (0.31, 0.052, -0.22)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def turn(axis, angle, rotation):
    """The rotation followed by one about an axis of its own."""
    s, c = math.sin(angle), math.cos(angle)
    x, y, z = axis
    own = ((c + x * x * (1 - c), -z * s, y * s), (z * s, c + y * y * (1 - c), -x * s), (-y * s, x * s, c + z * z * (1 - c)))
    return [[sum(rotation[i][k] * own[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def stiff_arm(q):
    """Origins and axes of the joints, middles of the links and the tip of an arm without springs, in the world."""
    rotation, at = [[1, 0, 0], [0, 1, 0], [0, 0, 1]], (0.0, 0.0, 0.0)
    origins, axes, middles = [], [], []
    for i in JOINTS:
        origins.append(at)
        axes.append([sum(rotation[r][k] * AXES[i][k] for k in range(3)) for r in range(3)])
        rotation = turn(AXES[i], q[i], rotation)
        link = [sum(rotation[r][k] * LINKS[i][k] for k in range(3)) for r in range(3)]
        middles.append([at[r] + 0.5 * link[r] for r in range(3)])
        at = [at[r] + link[r] for r in range(3)]
    return origins, axes, middles, at


def columns(origins, axes, point, n):
    """How a point of link n moves with the joints."""
    return [cross(axes[i], [point[r] - origins[i][r] for r in range(3)]) if i <= n else (0, 0, 0) for i in JOINTS]


def gravity(q):
    """Torques that carry the stiff arm [N·m]."""
    origins, axes, middles, _ = stiff_arm(q)
    rows = [columns(origins, axes, middles[n], n) for n in JOINTS]
    return [sum(MASSES[n] * G * rows[n][i][2] for n in JOINTS) for i in JOINTS]


def limited(x):
    return max(-MOST, min(MOST, x))


def inside(theta):
    """The nearest vector of the ball of radius √BOUND, measured by Γ⁻¹."""
    mu = 0.0
    while True:
        shrunk = [x / (1 + mu * g) for x, g in zip(theta, GAMMA)]
        excess = sum(x * x for x in shrunk) - BOUND
        if excess <= 0:
            return shrunk
        later = mu + excess / (2 * sum(x * x * g / (1 + mu * g) for x, g in zip(shrunk, GAMMA)))
        if later <= mu:
            return shrunk
        mu = later


class Law:
    """Adaptive compliant inverse kinematics."""

    def __init__(self):
        self.q_r, self.q_r_before, self.wanted = [0.0] * 4, [0.0] * 4, [0.0] * 4
        self.theta = [0.0, 0.0, 0.0, 0.0, 1 / 3, 1 / 2, 1.0, 1 / 1.5]

    def speeds(self, k, gamma, delta):
        """Speeds of the motors [rad/s], from the angles of motors and springs [rad]."""
        q = [gamma[i] + delta[i] for i in JOINTS]
        g = gravity(q)
        self.learn(g, [q[i] - self.q_r_before[i] for i in JOINTS])
        wanted = [self.q_r[i] - (self.theta[i] - g[i] * self.theta[4 + i]) for i in JOINTS]
        u = [limited((wanted[i] - self.wanted[i]) / TS + KS[i] / TS * (self.wanted[i] - gamma[i])) for i in JOINTS]
        self.wanted, self.q_r_before = wanted, self.q_r
        self.q_r = self.moved(target(k))
        return [math.copysign(math.floor(abs(x) * 65536 + 0.5), x) / 65536 for x in u]

    def learn(self, g, error):
        """θ ← Π(θ + Ts·λ·Γ·Φᵀ·(I + Φ·Γ·Φᵀ)⁻¹·ε), Φ = [I, −diag(g)]."""
        # Φ·Γ·Φᵀ is diagonal
        x = [error[i] / (1 + GAMMA[i] + GAMMA[4 + i] * g[i] ** 2) for i in JOINTS]
        step = [GAMMA[i] * x[i] for i in JOINTS] + [-GAMMA[4 + i] * g[i] * x[i] for i in JOINTS]
        self.theta = inside([t + RATE * TS * s for t, s in zip(self.theta, step)])

    def moved(self, goal):
        """Transpose inverse kinematics of the stiff arm over a sample."""
        origins, axes, _, tip = stiff_arm(self.q_r)
        miss = [goal[r] - tip[r] for r in range(3)]
        rows = columns(origins, axes, tip, 3)
        return [self.q_r[i] + TS * limited(KP[i] * sum(rows[i][r] * miss[r] for r in range(3))) for i in JOINTS]


def main():
    port = int(sys.argv[1]) if len(sys.argv) > 1 else 23000
    sim = RemoteAPIClient(port=port).require('sim')
    motors = [sim.getObject(f'/motor{i}') for i in range(1, 5)]
    springs = [sim.getObject(f'/spring{i}') for i in range(1, 5)]
    tip = sim.getObject('/tip')
    law = Law()

    sim.setStepping(True)  # before every run: it ends with the run
    sim.startSimulation()  # time stays 0 until the first step
    for k in range(round(DURATION / TS)):
        gamma = [single(sim.getJointPosition(joint)) for joint in motors]
        delta = [single(sim.getJointPosition(joint)) for joint in springs]
        for motor, speed in zip(motors, law.speeds(k, gamma, delta)):
            sim.setJointTargetVelocity(motor, speed)
        sim.step()  # returns when the step is done
    print(f'{sim.getSimulationTime():.2f} s:', ' '.join(f'{x:.6f}' for x in sim.getObjectPosition(tip)), 'm')
    sim.stopSimulation()


if __name__ == '__main__':
    main()
