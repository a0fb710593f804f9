"""Flies the quadrotor of scenes/quadrotor-remote from Python over the ZeroMQ remote API: flight test 1.

    pip install coppeliasim-zmqremoteapi-client
    sincro serve scenes/quadrotor-remote        # in another terminal
    python3 examples/clients/python/quadrotor.py [PORT]

The law is that of scenes/quadrotor-remote/loop.toml, see the README there: both print the same trace hash.
"""

import math
import struct
import sys

from coppeliasim_zmqremoteapi_client import RemoteAPIClient

TS = 0.05  # sample time [s]
DURATION = 60.0  # [s]
M, G = 10.305, 9.81  # [kg], [m/s²]
B, K, L = 1.9468e-4 / 4, 9.841743337582103e-5, 0.5  # thrust and torque over Ω² [N·s²/rad²], [N·m·s²/rad²]; arm [m]
KP, KD, KI = (0.69, 0.69, 9.2), (0.8 / 3, 0.8 / 3, 10 / 3), (0.036, 0.036, 0.0015)
GAMMA1, GAMMA2, GAMMA2I, T_OMEGA = (16.0, 16.0, 7.2), (36.0, 36.0, 18.0), 0.1, 75.0
INERTIA = (9.5 * 2.643e-3, 9.5 * 2.643e-3, 9.5 * 1.525e-2)  # of the controller [kg·m²]
OMEGA_R = 1.0  # of the reference filter [rad/s]
AXES = range(3)


def single(numbers):
    """What is left of numbers in single precision: what a legacy client reads."""
    return [struct.unpack('<f', struct.pack('<f', x))[0] for x in numbers]


def waypoint(k):
    """[m]: up at once, 0.10 m to the left at 20 s, 0.20 m back at 40 s."""
    return (0.0, 0.0 if k < 400 else 0.1 if k < 800 else -0.1, 1.0)


def rotation_of(alpha, beta, gamma):
    """Rx(α)·Ry(β)·Rz(γ), row by row."""
    (sa, ca), (sb, cb), (sc, cc) = [(math.sin(x), math.cos(x)) for x in (alpha, beta, gamma)]
    return [
        [cb * cc, -cb * sc, sb],
        [ca * sc + sa * sb * cc, ca * cc - sa * sb * sc, -sa * cb],
        [sa * sc - ca * sb * cc, sa * cc + ca * sb * sc, ca * cb],
    ]


def to_rates(eta, w):
    """E⁻¹(η)·w: rates of roll, pitch and yaw."""
    (s, c), t, d = (math.sin(eta[0]), math.cos(eta[0])), math.tan(eta[1]), math.cos(eta[1])
    return [w[0] + t * (s * w[1] + c * w[2]), c * w[1] - s * w[2], (s * w[1] + c * w[2]) / d]


def to_rates_transposed(eta, w):
    """E⁻ᵀ(η)·w."""
    (s, c), t, d = (math.sin(eta[0]), math.cos(eta[0])), math.tan(eta[1]), math.cos(eta[1])
    return [w[0], s * t * w[0] + c * w[1] + s / d * w[2], c * t * w[0] - s * w[1] + c / d * w[2]]


def from_rates(eta, rates):
    """E(η)·rates: angular velocity in body axes."""
    (s, c), (sp, cp) = [(math.sin(x), math.cos(x)) for x in eta[:2]]
    return [rates[0] - sp * rates[2], c * rates[1] + s * cp * rates[2], -s * rates[1] + c * cp * rates[2]]


class Law:
    """Command-filtered integral backstepping."""

    def __init__(self):
        self.reference = [[0.0, 0.0] for _ in AXES]
        self.xi, self.chi2, self.xi1, self.omega_f = [0.0] * 3, [0.0] * 3, [0.0] * 3, [0.0] * 3

    def speeds(self, k, position, orientation, velocity, world_rates):
        """Speeds of the four rotors [rad/s]."""
        r = rotation_of(*orientation)
        eta = [math.atan2(r[2][1], r[2][2]), math.asin(max(-1.0, min(1.0, -r[2][0]))), math.atan2(r[1][0], r[0][0])]
        w = [sum(r[i][j] * world_rates[i] for i in AXES) for j in AXES]
        a = self.acceleration(waypoint(k), position, velocity)
        thrust, eta_c = extract(a, eta)
        tau = self.torque(eta_c, eta, w)
        mean = thrust / (4 * B)
        squares = [
            mean - tau[1] / (2 * B * L) - tau[2] / (4 * K),
            mean + tau[0] / (2 * B * L) + tau[2] / (4 * K),
            mean + tau[1] / (2 * B * L) - tau[2] / (4 * K),
            mean - tau[0] / (2 * B * L) + tau[2] / (4 * K),
        ]
        speeds = [math.sqrt(max(0.0, min(1200.0**2, x))) for x in squares]
        return [math.floor(x * 8192 + 0.5) / 8192 for x in speeds]

    def acceleration(self, goal, position, velocity):
        """a = p_c'' + Kd(v_c − v) + Kp(p_c − p) + Ki·ξ; the reference is filtered, critically damped, exactly."""
        result = []
        for i in AXES:
            y, rate = self.reference[i]
            e_p = y - position[i]
            forward = -(OMEGA_R**2) * (y - goal[i]) - 2 * OMEGA_R * rate
            result.append(forward + KD[i] * (rate - velocity[i]) + KP[i] * e_p + KI[i] * self.xi[i])
            self.xi[i] += TS * e_p
            e, x = y - goal[i], math.exp(-OMEGA_R * TS)
            lead = rate + OMEGA_R * e
            self.reference[i] = [goal[i] + x * (e + TS * lead), x * (rate - TS * OMEGA_R * lead)]
        return result

    def torque(self, eta_c, eta, w):
        """τ = I(ω_f' + Γ₂z₂ + Γ₂ᵢχ₂ + E⁻ᵀv₁) + ω × Iω."""
        z1 = [eta_c[i] - eta[i] for i in AXES]
        omega_c = from_rates(eta, [GAMMA1[i] * z1[i] for i in AXES])
        before, share = self.omega_f, 1 - math.exp(-TS * T_OMEGA)
        self.omega_f = [before[i] + share * (omega_c[i] - before[i]) for i in AXES]
        lost = to_rates(eta, [self.omega_f[i] - omega_c[i] for i in AXES])
        self.xi1 = [self.xi1[i] + TS * (-lost[i] - GAMMA1[i] * self.xi1[i]) for i in AXES]
        v1 = to_rates_transposed(eta, [z1[i] - self.xi1[i] for i in AXES])
        z2 = [self.omega_f[i] - w[i] for i in AXES]
        demand = [
            (self.omega_f[i] - before[i]) / TS + GAMMA2[i] * z2[i] + GAMMA2I * GAMMA2[i] * self.chi2[i] + v1[i]
            for i in AXES
        ]
        self.chi2 = [self.chi2[i] + TS * z2[i] for i in AXES]
        h = [INERTIA[i] * w[i] for i in AXES]
        gyroscopic = [w[1] * h[2] - w[2] * h[1], w[2] * h[0] - w[0] * h[2], w[0] * h[1] - w[1] * h[0]]
        return [INERTIA[i] * demand[i] + gyroscopic[i] for i in AXES]


def extract(a, eta):
    """Thrust [N] and attitude [rad] that give an acceleration at the present yaw."""
    s, c = math.sin(eta[2]), math.cos(eta[2])
    ax, ay = a[0] * c + a[1] * s, a[1] * c - a[0] * s
    pitch = math.atan2(ax, G + a[2])
    roll = math.atan2(-ay * math.cos(pitch), G + a[2])
    thrust = M * (G + a[2]) / (math.cos(eta[0]) * math.cos(eta[1]))
    return thrust, [max(-0.6, min(0.6, roll)), max(-0.6, min(0.6, pitch)), 0.0]


def main():
    port = int(sys.argv[1]) if len(sys.argv) > 1 else 23000
    sim = RemoteAPIClient(port=port).require('sim')
    body = sim.getObject('/quadrotor')
    rotors = [sim.getObject(f'/rotor{i}') for i in range(1, 5)]
    law = Law()

    sim.setStepping(True)  # before every run: it ends with the run
    sim.startSimulation()  # time stays 0 until the first step
    for k in range(round(DURATION / TS)):
        position = single(sim.getObjectPosition(body))
        orientation = single(sim.getObjectOrientation(body))
        velocity, rates = [single(list_) for list_ in sim.getObjectVelocity(body)]
        for rotor, speed in zip(rotors, law.speeds(k, position, orientation, velocity, rates)):
            sim.setJointTargetVelocity(rotor, speed)
        sim.step()  # returns when the step is done
    print(f'{sim.getSimulationTime():.2f} s:', ' '.join(f'{x:.6f}' for x in sim.getObjectPosition(body)), 'm')
    sim.stopSimulation()


if __name__ == '__main__':
    main()
