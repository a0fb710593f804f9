"""Linear systems: matrices with the names of their rows and columns."""

from __future__ import annotations

import json

import numpy as np


class LinearSystem:
    """``ẋ = A·x + B·u``, ``y = C·x + D·u`` about an operating point.

    ``A`` (n, n), ``B`` (n, m), ``C`` (p, n), ``D`` (p, m): arrays. ``states``, ``inputs``, ``outputs``: names;
    ``units``: unit of each name. ``x0``, ``u0``, ``y0``: values at the operating point; ``rate``: rates of the states
    there, zero at an equilibrium. ``poles``: complex, in rad/s. ``stability``: ``stable``, ``marginal``, ``unstable``.
    ``notes``: remarks on what the linearisation leaves out. ``report``: all of ``linearization.json``.
    """

    def __init__(self, text, values, notes):
        self.report = report = json.loads(text)
        shape = {key: [axis["name"] for axis in report[key]] for key in ("states", "inputs", "outputs")}
        self.states, self.inputs, self.outputs = shape["states"], shape["inputs"], shape["outputs"]
        n, m, p = len(self.states), len(self.inputs), len(self.outputs)
        sizes = {"A": (n, n), "B": (n, m), "C": (p, n), "D": (p, m)}
        for name, size in sizes.items():
            setattr(self, name, np.array(report[name.lower()], dtype=float).reshape(size))
        axes = report["states"] + report["inputs"] + report["outputs"]
        self.units = {axis["name"]: axis["unit"] for axis in axes}
        self.x0, self.u0, self.y0, self.rate = (np.array(v, dtype=float) for v in values)
        self.poles = np.array([complex(*mode["pole"]) for mode in report["poles"]])
        self.stability = report["stability"]
        self.notes = notes

    def lqr(self, Q, R):
        """Gain ``K`` (m, n) of the linear-quadratic regulator ``u = u0 - K·(x - x0)``.

        ``Q`` (n, n) and ``R`` (m, m) weigh states and inputs; vectors are diagonals.
        """
        from . import _sincro

        Q, R = (np.diag(w) if w.ndim == 1 else w for w in (np.asarray(Q, dtype=float), np.asarray(R, dtype=float)))
        return _sincro.lqr(self.A, self.B, Q, R)

    def __iter__(self):
        """``A, B, C, D = system``."""
        return iter((self.A, self.B, self.C, self.D))

    def __repr__(self):
        sizes = f"{len(self.states)} states, {len(self.inputs)} inputs, {len(self.outputs)} outputs"
        return f"<sincro.LinearSystem: {sizes}, {self.stability}>"


class Equilibrium:
    """A state of rest: ``states``, ``inputs``, ``outputs`` (values by name), ``q``, ``largest_rate``, ``iterations``.

    ``initial``: coordinates of each joint, by path, as its ``initial.position`` takes them.
    """

    def __init__(self, text, q):
        found = json.loads(text)
        self.states, self.inputs, self.outputs = found["states"], found["inputs"], found["outputs"]
        self.initial = found["initial"]
        self.largest_rate, self.iterations = found["largest_rate"], found["iterations"]
        self.q = np.array(q)

    def __repr__(self):
        return f"<sincro.Equilibrium: largest rate {self.largest_rate:.3g}, {self.iterations} iterations>"
