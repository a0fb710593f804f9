"""Linear-quadratic regulator of the vehicle with its arm: python lqr.py SINCRO (numpy and scipy).

Takes the linear model that `sincro linearize` gives of the scene in hover (rotation, displacement, springs, their rates, speeds of the rotors), lets the
springs follow at once, adds integrals of the displacement, discretises for 20 ms, and solves the discrete Riccati equation. Prints the gain as it stands in
coordinated-lqr.toml: speeds of the rotors from rotation [rad], displacement [m], angular velocity [rad/s], velocity [m/s], speeds [rad/s], integrals [m s].
"""
import json
import os
import subprocess
import sys

import numpy as np
from scipy.linalg import expm, solve_discrete_are

TS = 0.02
# what is as bad as what: largest values of the states and inputs (Bryson)
ROTATION, PLACE, RATE, VELOCITY, SPEED, INTEGRAL, COMMAND = (0.15, 0.15, 0.2), (0.12, 0.12, 0.05), 0.8, 0.4, 200.0, (0.25, 0.25, 0.05), 25.0


def model(sincro):
    scene = os.path.dirname(os.path.abspath(__file__))
    rotors = [word for i in range(1, 5) for word in ("--input", f"/air/vehicle/rotor{i}")]
    text = subprocess.run([sincro, "linearize", scene, "--at", "4.98", *rotors, "--json"], check=True, stdout=subprocess.PIPE).stdout
    found = json.loads(text)
    return [state["name"] for state in found["states"]], np.array(found["a"]), np.array(found["b"])


def main():
    names, a, b = model(sys.argv[1])
    fast = [k for k, name in enumerate(names) if "spring" in name]
    slow = [k for k in range(len(names)) if k not in fast]
    pick = lambda m, rows, columns: m[np.ix_(rows, columns)]
    follow = np.linalg.solve(pick(a, fast, fast), np.hstack([pick(a, fast, slow), b[fast]]))
    reduced = np.hstack([pick(a, slow, slow), b[slow]]) - pick(a, slow, fast) @ follow
    n = len(slow)
    block = np.zeros((n + 4 + 3, n + 4 + 3))                    # states, inputs held, integrals of the displacement
    block[:n, :n + 4] = reduced
    block[n + 4:, 3:6] = np.eye(3)
    step = expm(block * TS)
    order = list(range(n)) + list(range(n + 4, n + 7))
    ad, bd = step[np.ix_(order, order)], step[np.ix_(order, range(n, n + 4))]
    sizes = np.r_[ROTATION, PLACE, [RATE] * 3, [VELOCITY] * 3, [SPEED] * 4, INTEGRAL]
    q, r = np.diag(sizes ** -2.0), np.eye(4) * COMMAND ** -2.0
    p = solve_discrete_are(ad, bd, q, r)
    k = np.linalg.solve(r + bd.T @ p @ bd, bd.T @ p @ ad)
    poles = np.linalg.eigvals(ad - bd @ k)
    print("slowest and fastest pole [1/s]:", np.log(np.abs(poles)).max() / TS, np.log(np.abs(poles)).min() / TS, file=sys.stderr)
    print("gain = [")
    for row in k:
        print("  [" + ", ".join(f"{x:.6g}" for x in row) + "],")
    print("]")


if __name__ == "__main__":
    main()
