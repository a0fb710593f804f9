"""Grasp, lift, landing and release of the box, integrated independently of sincro from the start to the end: nothing is taken from a run.

    python grasp.py                     writes reference-grasp.csv (about twenty minutes; numpy and scipy)

Free flight and carrying are integrated as in reference.py (DOP853): carried, fingers, box and last link are one rigid body, as they met. While fingers
move or the box touches the shelf, the whole, manipulator, fingers and box, eighteen velocities, is stepped by the time stepping of Moreau and Jean (key
acary2008, chapter 10) with h = 0.05 ms: M·(v' − v) = h·f + Jᵀ·P, f in the middle of the step, and for each contact Signorini's and Coulomb's laws between
the impulse P and the velocity at the end of the step, so that touching has no rebound. A gap g that would close has u_n + g/h ≥ 0: it ends closed, not
overlapped. The impulses solve the equations of Alart and Curnier (1991) by a semismooth Newton iteration. The left finger's motor is ideal: its velocity
is given, and jumps; the damping of the right finger is implicit.
"""
import importlib.util
import os
import sys

import numpy as np

FOLDER = os.path.dirname(os.path.abspath(__file__))
spec = importlib.util.spec_from_file_location("carrying", os.path.join(FOLDER, "reference.py"))
carrying = importlib.util.module_from_spec(spec)
spec.loader.exec_module(carrying)
hover = carrying.hover
from reference import BASE, E3, G, GAMMA0, TS, Arm, Backstepping, CommandFilter, Wind, chain, cross, euler, hold, inverse_dynamics, matrix

H = 5e-5                                                    # step of the time stepping [s]
STEPPED = [(14.0, 20.0), (36.0, 46.0)]                      # [s]
PAD, FOOT, MU_PAD, MU_SPIN, MU_FOOT = 0.003, 0.002, 0.8, 0.008, (0.8 * 0.1) ** 0.5
FEET = np.array([[0.012, 0.017, -0.028], [0.012, -0.017, -0.028], [-0.012, 0.0, -0.028]])
HALF, SHELF, FORCE, DAMPING = 0.02, 1.17, 0.6, 120.0


def finger_speed(t):
    """Speed of the left finger's ideal motor [m/s] from t on."""
    return 0.005 if 14.0 - 1e-9 < t < 16.0 - 1e-9 else -0.005 if 40.0 - 1e-9 < t < 42.0 - 1e-9 else 0.0


def finger_force(t):
    return FORCE if 14.0 - 1e-9 < t < 40.0 - 1e-9 else -FORCE / 2


def skew(a):
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


class Kinematics:
    """Bodies of the manipulator with fingers for ν = (w, v, q', s_left', s_right'), world axes: mass, inertia, and at the centre of mass
    Jacobians of angular and linear velocity (3 × 12), angular velocity, and accelerations at constant ν."""

    def __init__(self, p, r, q, s, nu):
        self.p, w, qd = p, nu[:3], nu[6:10]
        origins, axes, rotations, centres, self.tip = chain(p, r, q)
        self.origins, self.axes, self.rotation, self.origin = origins, axes, rotations[3], origins[3]
        self.bodies = []
        jw = np.zeros((3, 12))
        jw[:, :3] = E3
        self.add(hover.M0, r @ hover.I0 @ r.T, p, jw, self.column(p, 0), w, np.zeros(3))
        wi, al, a, o = w.copy(), np.zeros(3), np.zeros(3), p
        for i in range(4):
            d = origins[i] - o
            a = a + cross(al, d) + cross(wi, cross(wi, d))
            o = origins[i]
            al = al + cross(wi, axes[i] * qd[i])
            wi = wi + axes[i] * qd[i]
            jw = jw.copy()
            jw[:, 6 + i] = axes[i]
            d = centres[i] - o
            self.add(hover.MASS[i], rotations[i] @ hover.INERTIA[i] @ rotations[i].T, centres[i], jw, self.column(centres[i], i + 1), wi,
                     a + cross(al, d) + cross(wi, cross(wi, d)), al)
        r4 = rotations[3]
        self.jw = jw
        self.slide = [r4[:, 1], -r4[:, 1]]
        inertia = r4 @ carrying.FINGER_I @ r4.T
        for k, y in ((0, -0.032 + s[0]), (1, 0.032 - s[1])):
            d = r4 @ np.array([0.29, y, 0.0])
            jv = self.finger(o + d, k)
            bias = a + cross(al, d) + cross(wi, cross(wi, d)) + 2 * cross(wi, self.slide[k] * nu[10 + k])
            self.add(carrying.FINGER, inertia, o + d, jw, jv, wi, bias, al)

    def column(self, point, n):
        """Jacobian of a point of link n (0: the vehicle)."""
        j = np.zeros((3, 12))
        j[:, :3] = -skew(point - self.p)
        j[:, 3:6] = E3
        for i in range(n):
            j[:, 6 + i] = cross(self.axes[i], point - self.origins[i])
        return j

    def finger(self, point, k):
        j = self.column(point, 4)
        j[:, 10 + k] = self.slide[k]
        return j

    def add(self, mass, inertia, centre, jw, jv, w, a, al=np.zeros(3)):
        self.bodies.append((mass, inertia, centre, jw, jv, w, a, al))

    def equations(self):
        """Mass matrix and the forces of motion and gravity, 12."""
        m, h = np.zeros((12, 12)), np.zeros(12)
        for mass, inertia, _, jw, jv, w, a, al in self.bodies:
            m += mass * jv.T @ jv + jw.T @ inertia @ jw
            h += jv.T @ (mass * (a + np.array([0, 0, G]))) + jw.T @ (inertia @ al + cross(w, inertia @ w))
        return m, h


class Contact:
    """Friction coefficients and the rows n, t1, t2 (and spin about n) of a relative velocity, 18 columns."""

    def __init__(self, rows, friction, spin=0.0):
        self.rows, self.friction, self.spin, self.size = rows, friction, spin, len(rows)


def box_rows(point, place, direction):
    return np.r_[cross(point - place, direction), direction]


def gaps(p, h, q, s, place, hb):
    """Gaps of the pads, the feet and the stop of the right finger [m]."""
    origins, _, rotations, _, _ = chain(p, matrix(h), q)
    rotation, found = matrix(hb), []
    for side in (0, 1):
        sign = 1 - 2 * side
        centre = origins[3] + rotations[3] @ np.array([0.29, sign * (-0.033 + s[side]), 0.0])
        found.append(-sign * (rotation.T @ (centre - place))[1] - HALF - PAD)
    return found + [(place + rotation @ foot)[2] - FOOT - SHELF for foot in FEET] + [s[1]]


def contacts(k, place, rotation, s):
    """Contacts in the order of gaps."""
    found = []
    for side in (0, 1):
        sign = 1 - 2 * side
        centre = k.origin + k.rotation @ np.array([0.29, sign * (-0.033 + s[side]), 0.0])
        n = sign * rotation[:, 1]
        point = centre + PAD * n
        j, rows = k.finger(point, side), []
        for direction in (n, rotation[:, 0], rotation[:, 2]):
            rows.append(np.r_[-direction @ j, box_rows(point, place, direction)])
        rows.append(np.r_[-n @ k.jw, n, np.zeros(3)])
        found.append(Contact(np.array(rows), MU_PAD, MU_SPIN))
    for foot in FEET:
        point = place + rotation @ foot - np.array([0, 0, FOOT])
        rows = [np.r_[np.zeros(12), box_rows(point, place, E3[i])] for i in (2, 0, 1)]
        found.append(Contact(np.array(rows), MU_FOOT))
    stop = np.zeros((1, 18))
    stop[0, 11] = 1.0
    found.append(Contact(stop, 0.0))
    return found


def solve(w, b, contacts, guess):
    """Impulses λ of u = Wλ + b under the laws of the contacts, by semismooth Newton; b has the gaps in its normal rows."""
    x, n = guess.copy(), len(b)
    rho = 1.0 / np.diag(w)
    scale = np.sqrt(rho)
    for iteration in range(200):
        u = w @ x + b
        f, d = np.zeros(n), np.zeros((n, n))
        i = 0
        for c in contacts:
            z = x[i] - rho[i] * u[i]
            if z > 0:
                f[i], d[i] = u[i], w[i]
            else:
                f[i], d[i, i] = x[i] / rho[i], 1 / rho[i]
            if c.size > 1:
                t = slice(i + 1, i + 3)
                r = min(rho[i + 1], rho[i + 2])
                y, bound = x[t] - r * u[t], c.friction * max(z, 0.0)
                length = np.hypot(*y)
                if bound <= 0:
                    f[t] = x[t] / r
                    d[t, t] = np.eye(2) / r
                elif length <= bound:
                    f[t], d[t] = u[t], w[t]
                else:
                    e = y / length
                    f[t] = (x[t] - bound * e) / r
                    dy = -r * w[t]
                    dy[0, i + 1] += 1
                    dy[1, i + 2] += 1
                    dz = -rho[i] * w[i]
                    dz[i] += 1
                    d[t] = -(bound / length * (np.eye(2) - np.outer(e, e)) @ dy + np.outer(e, c.friction * dz)) / r
                    d[i + 1, i + 1] += 1 / r
                    d[i + 2, i + 2] += 1 / r
            if c.size > 3:
                j, bound = i + 3, c.spin * max(z, 0.0)
                y = x[j] - rho[j] * u[j]
                if abs(y) <= bound:
                    f[j], d[j] = u[j], w[j]
                else:
                    f[j] = (x[j] - np.sign(y) * bound) / rho[j]
                    d[j, j] = 1 / rho[j]
                    if bound > 0:
                        dz = -rho[i] * w[i]
                        dz[i] += 1
                        d[j] -= np.sign(y) * c.spin * dz / rho[j]
            i += c.size
        error = np.max(np.abs(f))
        if error < 1e-13:
            return x, iteration
        # three feet that stick have more forces than equations: least squares
        x = x - (1.0 if iteration < 30 else 0.5) * np.linalg.lstsq(d * scale, f, rcond=1e-12)[0] * scale
    if error < 1e-9:
        return x, iteration
    raise SystemExit(f"no convergence: {error}")


def turned(h, w, dt):
    """Quaternion after a rotation of w·dt, world axes."""
    angle = np.linalg.norm(w) * dt
    if angle < 1e-300:
        return h
    e = np.r_[np.cos(angle / 2), w / np.linalg.norm(w) * np.sin(angle / 2)]
    return np.r_[e[0] * h[0] - e[1:] @ h[1:], e[0] * h[1:] + h[0] * e[1:] + cross(e[1:], h[1:])]


class Stepped:
    """The whole while contacts change."""

    def __init__(self, x, s, box):
        self.p, self.h, self.q, self.speed = x[:3].copy(), x[3:7].copy(), x[13:17].copy(), x[21:25].copy()
        self.s, self.place, self.hb = np.array(s), box[0].copy(), box[1].copy()
        self.nu = np.r_[x[7:13], x[17:21], np.zeros(2), box[2], box[3]]
        self.change, self.impulse, self.forces = np.zeros(18), {}, np.zeros(6)

    def moved(self, nu, dt):
        s = self.s + nu[10:12] * dt
        return (self.p + nu[3:6] * dt, turned(self.h, nu[:3], dt), self.q + nu[6:10] * dt, s, self.place + nu[15:18] * dt,
                turned(self.hb, nu[12:15], dt))

    def step(self, t, h, t0, plant):
        """One step under the commands of plant, which it has since t0."""
        guess = self.nu + 0.5 * self.change
        p, q4, q, s, place, hb = self.moved(self.nu + 0.25 * self.change, 0.5 * h)
        r, rb = matrix(q4), matrix(hb)
        k = Kinematics(p, r, q, s, guess[:12])
        m, bias = k.equations()
        speed = plant.command + (self.speed - plant.command) * np.exp(-0.5 * h / hover.TAU)
        x = np.r_[p, q4, guess[:6], q, guess[6:10], speed]
        applied = plant.forces(t + 0.5 * h, x, t0)
        f = np.zeros(18)
        f[:10] = applied
        f[:12] -= bias
        f[11] += finger_force(t)
        big = np.zeros((18, 18))
        big[:12, :12] = m
        inertia = rb @ carrying.BOX_I @ rb.T
        big[12:15, 12:15] = inertia
        big[15:, 15:] = carrying.BOX * E3
        wb = guess[12:15]
        f[12:15] = -cross(wb, inertia @ wb)
        f[17] -= carrying.BOX * G
        # damping of the right finger implicit; the left one has its velocity
        implicit = big.copy()
        implicit[11, 11] += h * DAMPING
        new_left = finger_speed(t)
        momentum = big @ self.nu + h * f
        free = [i for i in range(18) if i != 10]
        momentum = momentum - implicit[:, 10] * new_left
        reduced = implicit[np.ix_(free, free)]
        inverse = np.linalg.inv(reduced)
        unloaded = np.zeros(18)
        unloaded[free] = inverse @ momentum[free]
        unloaded[10] = new_left
        # contacts that would close or are closed; gaps at the start of the step
        now, mid = gaps(self.p, self.h, self.q, self.s, self.place, self.hb), contacts(k, place, rb, s)
        active = [i for i in range(6) if i in self.impulse or now[i] < 1e-3 and now[i] + h * (mid[i].rows[0] @ unloaded) < 1e-10]
        nu = unloaded
        impulses = {}
        if active:
            chosen = [mid[i] for i in active]
            j = np.vstack([c.rows for c in chosen])
            w = j[:, free] @ inverse @ j[:, free].T
            b, start, at = j @ unloaded, np.zeros(len(j)), 0
            for i, c in zip(active, chosen):
                b[at] += now[i] / h
                start[at:at + c.size] = self.impulse.get(i, np.zeros(c.size))
                at += c.size
            x, _ = solve(w, b, chosen, start)
            nu = unloaded.copy()
            nu[free] += inverse @ (j[:, free].T @ x)
            at = 0
            for i, c in zip(active, chosen):
                if x[at] > 0:
                    impulses[i] = x[at:at + c.size]
                at += c.size
        mean = 0.5 * (self.nu + nu)
        # positions move with the mean of the velocities, gaps with the velocity at the end
        closing = nu if set(impulses) != set(self.impulse) else mean
        before = self.s
        self.p, self.h, self.q, self.s, self.place, self.hb = self.moved(closing, h)
        self.s = before + h * nu[10:12]                         # one is given, the other is damped within a quarter of a step
        self.h, self.hb = self.h / np.linalg.norm(self.h), self.hb / np.linalg.norm(self.hb)
        self.change = nu - self.nu if set(impulses) == set(self.impulse) and new_left == self.nu[10] else np.zeros(18)
        self.nu, self.impulse = nu, impulses
        self.forces = np.array([impulses[i][0] / h if i in impulses else 0.0 for i in range(6)])
        self.speed = plant.command + (self.speed - plant.command) * np.exp(-h / hover.TAU)

    def state(self):
        return np.r_[self.p, self.h, self.nu[:6], self.q, self.nu[6:10], self.speed]


def quaternion(r):
    """Quaternion of a rotation by less than 120°."""
    w = 0.5 * np.sqrt(1 + np.trace(r))
    return np.r_[w, np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]]) / (4 * w)]


def carrying_box(x, held):
    """Place, quaternion and velocities of the box that moves with the last link."""
    k = Kinematics(x[:3], matrix(x[3:7]), x[13:17], np.zeros(2), np.zeros(12))
    place, nu = k.origin + k.rotation @ held[0], np.r_[x[7:13], x[17:21], 0, 0]
    return [place, quaternion(k.rotation @ held[1]), k.jw @ nu, k.column(place, 4) @ nu]


def simulate(task, duration=50.0):
    start = np.array([0.0, 0.0, 1.5])
    plant = carrying.Loaded(Wind(), GAMMA0.copy(), hover.start(start))
    plant.load((0.0, 0.0))
    s, box = np.zeros(2), [np.array([0.95, 0.0, 1.2]), np.array([1.0, 0, 0, 0]), np.zeros(3), np.zeros(3)]
    flight, arm = Backstepping(z_integral=200.0), Arm(GAMMA0, gain=2.0)
    task_filter, place_filter = CommandFilter(1.0, task[0][1:]), CommandFilter(1.0, start)
    rows, stepped = [], None
    for k in range(round(duration / TS) + 1):
        t = k * TS
        is_stepped = any(a - 1e-9 <= t < b - 1e-9 for a, b in STEPPED)
        if is_stepped and stepped is None:
            stepped = Stepped(plant.x, s, carrying_box(plant.x, held) if t > 30.0 else box)
        if not is_stepped and stepped is not None:
            plant.x, s = stepped.state(), stepped.s
            box = [stepped.place, stepped.hb, stepped.nu[12:15], stepped.nu[15:]]
            stepped = None
            o, r4, _ = carrying.last_link(plant.x)
            held = (r4.T @ (box[0] - o), r4.T @ matrix(box[1])) if t < 30.0 else None
            plant.load(s, held)
        x = stepped.state() if stepped else plant.x
        if not stepped and 20.0 - 1e-9 <= t <= 36.0 + 1e-9:
            o, r4, _ = carrying.last_link(x)
            box[0] = o + r4 @ held[0]
        p, r, w, v, q, qd = x[:3], matrix(x[3:7]), x[7:10], x[10:13], x[13:17], x[17:21]
        turn = matrix(stepped.hb) if stepped else r4 @ held[1] if 20.0 - 1e-9 <= t <= 36.0 + 1e-9 else matrix(box[1])
        place = stepped.place if stepped else box[0]
        rows.append(np.r_[t, p, carrying.last_link(x)[2], place, euler(turn)[2], stepped.s if stepped else s, stepped.forces if stepped else np.zeros(6)])
        target = task_filter.step(hold(task, t))[0]
        u, acceleration = arm.step(plant.gamma, q, r.T @ (target - p) - BASE)
        ahead = r.T @ inverse_dynamics(p, r, w, v, q, qd, np.zeros(3), cross(w, v), acceleration, links_only=True)[:3]
        goal = start if t < 1.0 - 1e-9 else np.array([0.3, 0.0, 1.5]) if t < 22.0 - 1e-9 else np.array([0.3, 0.3, 1.5])
        plant.command = flight.step(place_filter.step(goal), p, v, euler(r), r.T @ w, ahead)
        plant.rate = u
        if stepped:
            steps = round(TS / H)
            for i in range(steps):
                stepped.step(t + i * H, H, t, plant)
            plant.gamma = plant.gamma + TS * u
        else:
            plant.advance(t)
        if k % 25 == 0:
            extra = f"  box {np.round(place, 6)}  {np.round(rows[-1][-6:], 4)}" if stepped else ""
            print(f"{t:6.2f} s  {np.round(p, 5)}{extra}", file=sys.stderr, flush=True)
    return rows


if __name__ == "__main__":
    columns = "t,x,y,z,tip_x,tip_y,tip_z,box_x,box_y,box_z,yaw,left,right,n_left,n_right,n_foot1,n_foot2,n_foot3,n_stop".split(",")
    rows = simulate(hover.read_task(FOLDER))
    hover.write(os.path.join(FOLDER, "reference-grasp.csv"), rows, 5, columns, "by grasp.py: [s], [m], [rad], [N]; tip and box in the world")
