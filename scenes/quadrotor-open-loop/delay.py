"""Delay of the climb at 750 rad/s by the lag of the rotors: python3 delay.py.

Integrates m z'' = 4 T(Omega, z') - m g with the classical Runge-Kutta method at 0.1 ms, independently of sincro, for readings of the thesis's
"rise time of 0.3 s" and for starts of the rotors, and prints how much later than rotors without lag a height is reached [s].
"""

import math

M, G, RHO, R, CHORD, BLADES, SLOPE, PITCH, OMEGA = 10.305, 9.81, 1.225, 0.2032, 0.025, 4, 5.7, 0.1412, 750.0
K1 = BLADES * CHORD / (math.pi * R) * SLOPE / 8
HOVER = 720.597286  # [rad/s]
STEP = 1e-4  # [s]


def thrust(omega, climb):
    """Thrust of a rotor in axial flow [N]: w² + (k1·V − v)·w − ⅔·k1·θ·V² = 0 where (w − v)·w = ⅔k1θV² − k1·V·w."""
    v_tip = omega * R
    s = K1 * PITCH * 2 / 3 * v_tip**2
    b = K1 * v_tip - climb
    w = 0.5 * (-b + math.sqrt(b * b + 4 * s))
    return 2 * RHO * math.pi * R**2 * (s - K1 * v_tip * w)


def climb(tau, start, on_floor, duration=12.0):
    """Heights [m] every STEP; tau 0: no lag."""
    z, v, path = 0.0, 0.0, [0.0]

    def speed(t):
        return OMEGA + (start - OMEGA) * math.exp(-t / tau) if tau > 0 else OMEGA

    def rates(t, z, v):
        a = 4 * thrust(speed(t), v) / M - G
        return v, (0.0 if on_floor and z <= 0 and v <= 0 and a < 0 else a)

    for k in range(round(duration / STEP)):
        t = k * STEP
        k1 = rates(t, z, v)
        k2 = rates(t + STEP / 2, z + STEP / 2 * k1[0], v + STEP / 2 * k1[1])
        k3 = rates(t + STEP / 2, z + STEP / 2 * k2[0], v + STEP / 2 * k2[1])
        k4 = rates(t + STEP, z + STEP * k3[0], v + STEP * k3[1])
        z += STEP / 6 * (k1[0] + 2 * k2[0] + 2 * k3[0] + k4[0])
        v += STEP / 6 * (k1[1] + 2 * k2[1] + 2 * k3[1] + k4[1])
        path.append(z)
    return path


def crossings(path, heights):
    """Instants at which heights are reached for good [s]."""
    found = []
    for height in heights:
        k = next(k for k in range(len(path) - 1, 0, -1) if path[k - 1] < height)
        found.append(STEP * (k - 1 + (height - path[k - 1]) / (path[k] - path[k - 1])))
    return found


def main():
    heights = [1.0, 2.0, 3.0, 4.0]
    plain = crossings(climb(0.0, OMEGA, False), heights)
    print('delay of 1, 2, 3, 4 m [s]; height at 1, 3, 6 s [m]')
    readings = [('10 to 90 %, tau = 0.3/ln 9', 0.3 / math.log(9)), ('0 to 95 %, tau = 0.1', 0.1), ('time constant, tau = 0.3', 0.3)]
    for reading, tau in readings:
        for name, start, on_floor in [('hover', HOVER, False), ('floor', 0.0, True), ('rest, in the air', 0.0, False)]:
            path = climb(tau, start, on_floor)
            late = [a - b for a, b in zip(crossings(path, heights), plain)]
            at = [path[round(t / STEP)] for t in (1, 3, 6)]
            print(f'{reading:28} {name:18}', ' '.join(f'{x:.4f}' for x in late), ' ', ' '.join(f'{x:.7f}' for x in at))


if __name__ == '__main__':
    main()
