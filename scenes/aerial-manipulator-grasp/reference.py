"""Aerial manipulator with a box, integrated independently of sincro; see ../aerial-manipulator-hover/reference.py for plant and controllers.

    python reference.py SINCRO          writes reference.csv (about five minutes; numpy and scipy); SINCRO: the program

While nothing touches, and while the box is in the air, fingers, box and last link are one rigid body, if friction holds: then motion is integrated here.
While the fingers move or the box touches the shelf, a run of the program is followed, row by row: the controllers here see what it measured, so that their
memory goes on, and the state at the end of such a phase is where the next integration starts. Phases: FREE.
"""
import csv
import os
import subprocess
import sys
import tempfile

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "aerial-manipulator-hover"))
import reference as hover
from reference import BASE, E3, GAMMA0, TS, Arm, Backstepping, CommandFilter, Plant, Wind, chain, cross, euler, hold, inverse_dynamics, matrix

FREE = [(0.0, 14.0), (20.0, 36.0), (46.0, 50.0)]    # integrated here [s]
FINGER, FINGER_I = 0.003, np.diag([2e-7, 4e-7, 4e-7])
BOX = 0.03
BOX_I = BOX / 12 * np.diag([0.04 ** 2 + 0.06 ** 2, 0.03 ** 2 + 0.06 ** 2, 0.03 ** 2 + 0.04 ** 2])
LINK4 = "/air/vehicle/arm/motor1/spring1/motor2/spring2/motor3/spring3/motor4/spring4/link4"
MOTORS = ["/air/vehicle/arm/motor1", "/air/vehicle/arm/motor1/spring1/motor2", "/air/vehicle/arm/motor1/spring1/motor2/spring2/motor3",
          "/air/vehicle/arm/motor1/spring1/motor2/spring2/motor3/spring3/motor4"]
SPRINGS = [motor + f"/spring{i + 1}" for i, motor in enumerate(MOTORS)]
SIGNALS = ([f"/air/vehicle.position.{k}" for k in "xyz"] + [f"/air/vehicle.quaternion.{k}" for k in "wxyz"]
           + [f"/air.angular_velocity.{k}" for k in "xyz"] + [f"/air/vehicle.velocity.{k}" for k in "xyz"]
           + [m + ".position" for m in MOTORS] + [s + ".position" for s in SPRINGS] + [m + ".velocity" for m in MOTORS]
           + [s + ".velocity" for s in SPRINGS] + [f"/air/vehicle/rotor{i}.speed" for i in (1, 2, 3, 4)]
           + [LINK4 + "/left.position", LINK4 + "/right.position"] + [f"/box.position.{k}" for k in "xyz"] + [f"/box.quaternion.{k}" for k in "wxyz"])


def recorded(sincro):
    """Rows of a run of the program, every 20 ms."""
    with tempfile.TemporaryDirectory() as out:
        signals = "[" + ", ".join(f'"{s}"' for s in SIGNALS) + "]"
        scene = os.path.dirname(os.path.abspath(__file__))
        command = [sincro, "run", scene, "--set", f"record={signals}", "--set", "record_every=1", "--out", out]
        subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)       # its checks miss their signals
        rows = list(csv.reader(open(os.path.join(out, "signals.csv"))))
    order = [rows[0].index(s) for s in SIGNALS]
    return np.array([[float(row[i]) for i in order] for row in rows[1:]])


def state(row):
    """State of Plant, angles of the motors, places of the fingers, and place and rotation of the box."""
    p, h, wb, v, gamma, delta, dg, dd, speeds = np.split(row[:33], [3, 7, 10, 13, 17, 21, 25, 29])
    x = np.r_[p, h, matrix(h) @ wb, v, gamma + delta, dg + dd, speeds]
    return x, gamma, row[33:35], row[35:38], matrix(row[38:42])


class Loaded(Plant):
    """The manipulator whose last link is one body with what it carries."""

    def load(self, fingers, box=None):
        """Mass, centre and inertia of the last link with fingers at their strokes and, if given, the box (place, rotation; axes of the link)."""
        parts = [(hover.MASS[3], hover.COM[3], hover.INERTIA[3]), (FINGER, np.array([0.29, -0.032 + fingers[0], 0.0]), FINGER_I),
                 (FINGER, np.array([0.29, 0.032 - fingers[1], 0.0]), FINGER_I)]
        if box is not None:
            parts.append((BOX, box[0], box[1] @ BOX_I @ box[1].T))
        mass = sum(m for m, _, _ in parts)
        centre = sum(m * c for m, c, _ in parts) / mass
        inertia = sum(i + m * ((c - centre) @ (c - centre) * E3 - np.outer(c - centre, c - centre)) for m, c, i in parts)
        self.last = mass, centre, inertia

    def equations(self, t, x, t0):
        known = hover.MASS[3], hover.COM[3].copy(), hover.INERTIA[3]        # what the controllers know stays so
        hover.MASS[3], hover.COM[3], hover.INERTIA[3] = self.last
        try:
            return super().equations(t, x, t0)
        finally:
            hover.MASS[3], hover.COM[3], hover.INERTIA[3] = known


def last_link(x):
    """Place and rotation of the last link."""
    origins, _, rotations, _, tip = chain(x[:3], matrix(x[3:7]), x[13:17])
    return origins[3], rotations[3], tip


def simulate(run, task, duration=50.0):
    start = np.array([0.0, 0.0, 1.5])
    plant = Loaded(Wind(), GAMMA0.copy(), hover.start(start))
    plant.load((0.0, 0.0))
    flight, arm = Backstepping(z_integral=200.0), Arm(GAMMA0, gain=2.0)
    task_filter, place_filter = CommandFilter(1.0, task[0][1:]), CommandFilter(1.0, start)
    rows = []
    for k in range(round(duration / TS) + 1):
        t = k * TS
        is_free = any(a - 1e-9 <= t <= b + 1e-9 for a, b in FREE)
        if not is_free or any(abs(t - a) < 1e-9 for a, _ in FREE[1:]):
            plant.x, plant.gamma, fingers, place, rotation = state(run[k])
            o, r4, _ = last_link(plant.x)
            carried = (r4.T @ (place - o), r4.T @ rotation) if 20.0 - 1e-9 <= t <= 36.0 else None
            plant.load(fingers, carried)
        x = plant.x
        p, r, w, v, q, qd = x[:3], matrix(x[3:7]), x[7:10], x[10:13], x[13:17], x[17:21]
        if is_free:
            rows.append(np.r_[t, p, euler(r), last_link(x)[2], q - plant.gamma])
        target = task_filter.step(hold(task, t))[0]
        u, acceleration = arm.step(plant.gamma, q, r.T @ (target - p) - BASE)
        ahead = r.T @ inverse_dynamics(p, r, w, v, q, qd, np.zeros(3), cross(w, v), acceleration, links_only=True)[:3]
        goal = start if t < 1.0 - 1e-9 else np.array([0.3, 0.0, 1.5]) if t < 22.0 - 1e-9 else np.array([0.3, 0.3, 1.5])
        plant.command = flight.step(place_filter.step(goal), p, v, euler(r), r.T @ w, ahead)
        plant.rate = u
        if is_free:
            plant.advance(t)
        if k % 250 == 0:
            print(f"{t:6.2f} s  {np.round(p, 5)}", file=sys.stderr)
    return rows


if __name__ == "__main__":
    folder = os.path.dirname(os.path.abspath(__file__))
    columns = "t,x,y,z,roll,pitch,yaw,tip_x,tip_y,tip_z,delta1,delta2,delta3,delta4".split(",")
    rows = simulate(recorded(sys.argv[1]), hover.read_task(folder))
    hover.write(os.path.join(folder, "reference.csv"), rows, 10, columns, "by reference.py: [s], [m], [rad]; tip in the world")
