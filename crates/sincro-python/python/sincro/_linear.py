"""Linear systems: matrices with the names of their rows and columns."""

from __future__ import annotations

import json
from typing import NamedTuple

import numpy as np

from ._errors import ArgumentError, UnknownNameError


class Margin(NamedTuple):
    """Gain margin in dB, phase margin in degrees or modulus margin, ``value``, at ``omega`` in rad/s."""

    omega: float
    value: float


class Margins:
    """Stability margins of a loop that is closed by −1.

    ``name``: signal at which the loop is opened, or names of input and output. ``gain_margins`` (``value`` in dB) and
    ``phase_margins`` (in degrees): a list of :class:`Margin` with all crossovers, ascending in frequency; negative where
    the limit of stability is passed already. ``gain_margin``, ``phase_margin``: those of least magnitude, or None.

    Of a sampled loop also ``modulus_margin`` (smallest distance of the response from −1), ``sample_time`` in s,
    ``samples_per_period``, and the frequency response ``omega`` in rad/s, ``magnitude_db`` (NaN where it is infinite) and
    ``phase_deg``: arrays of one length. They are None for a channel of a continuous system.
    """

    def __init__(self, name, found):
        self.name = name
        self.gain_margins = [Margin(**at) for at in found["gain_margins_db"]]
        self.phase_margins = [Margin(**at) for at in found["phase_margins_deg"]]
        modulus = found.get("modulus_margin")
        self.modulus_margin = None if modulus is None else Margin(**modulus)
        self.sample_time, self.samples_per_period = found.get("sample_time"), found.get("samples_per_period")
        for key in ("omega", "magnitude_db", "phase_deg"):
            values = found.get(key)
            setattr(self, key, None if values is None else np.array(values, dtype=float))

    @property
    def gain_margin(self) -> Margin | None:
        """The gain margin of least magnitude; None if the phase never is −180°."""
        return min(self.gain_margins, key=lambda margin: abs(margin.value), default=None)

    @property
    def phase_margin(self) -> Margin | None:
        """The phase margin of least magnitude; None if the gain never is 1."""
        return min(self.phase_margins, key=lambda margin: abs(margin.value), default=None)

    def __repr__(self):
        gain, phase = self.gain_margin, self.phase_margin
        words = ["no gain margin" if gain is None else f"gain margin {gain.value:.3g} dB at {gain.omega:.4g} rad/s"]
        words += ["no phase margin" if phase is None else f"phase margin {phase.value:.3g}° at {phase.omega:.4g} rad/s"]
        if self.modulus_margin is not None:
            words += [f"modulus margin {self.modulus_margin.value:.3g}"]
        return f"<sincro.Margins {self.name}: {', '.join(words)}>"


class LinearSystem:
    """``ẋ = A·x + B·u``, ``y = C·x + D·u`` about an operating point; a sampled one is ``x⁺ = A·x``.

    ``A`` (n, n), ``B`` (n, m), ``C`` (p, n), ``D`` (p, m): arrays. ``states``, ``inputs``, ``outputs``: names;
    ``units``: unit of each name. ``x0``, ``u0``, ``y0``: values at the operating point; ``rate``: rates of the states
    there, zero at an equilibrium; None if it is sampled. ``poles``: complex, in rad/s, of a sampled system those of z.
    ``stability``: ``stable``, ``marginal``, ``unstable``. ``sample_time`` in s, None if it is continuous. ``loops``:
    :class:`Margins` of the sampled loops that were opened, by signal. ``notes``: remarks on what the linearisation leaves
    out. ``report``: all of ``linearization.json``.
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
        values = [None] * 4 if values is None else [np.array(v, dtype=float) for v in values]
        self.x0, self.u0, self.y0, self.rate = values
        self.sample_time = report["sample_time"]
        self.loops = {loop["signal"]: Margins(loop["signal"], loop) for loop in report.get("loops", [])}
        self.poles = np.array([complex(*mode["pole"]) for mode in report["poles"]])
        self.stability = report["stability"]
        self.notes = notes

    def lqr(self, Q, R):
        """Gain ``K`` (m, n) of the linear-quadratic regulator ``u = u0 - K·(x - x0)``.

        ``Q`` (n, n) and ``R`` (m, m) weigh states and inputs; vectors are diagonals.
        """
        from . import _sincro

        if self.sample_time is not None:
            raise ArgumentError("a regulator is designed for a continuous system: linearize without `sampled`")
        Q, R = (np.diag(w) if w.ndim == 1 else w for w in (np.asarray(Q, dtype=float), np.asarray(R, dtype=float)))
        return _sincro.lqr(self.A, self.B, Q, R)

    def margins(self, input=None, output=None) -> Margins:
        """Gain and phase margins of one channel of a continuous system, from an input to an output, closed by −1.

        ``input``, ``output``: names; may be left out where there is one.

        >>> import sincro
        >>> sincro.load("scenes/motor-step").linearize(at=0.0).margins()
        <sincro.Margins /motor.command -> /motor.position: no gain margin, phase margin 90° at 1 rad/s>
        """
        if self.sample_time is not None:
            raise ArgumentError("a sampled system has no channels: name signals in `loops` to open it there")
        given = {"input": (input, self.inputs), "output": (output, self.outputs)}
        chosen = {}
        for what, (name, known) in given.items():
            if name is None and len(known) != 1:
                raise ArgumentError(f"which {what}? there are: {', '.join(known) or 'none'}")
            if name is not None and name not in known:
                raise UnknownNameError(f"there is no {what} `{name}`\n  help: there are: {', '.join(known) or 'none'}")
            chosen[what] = known[0] if name is None else name
        for channel in self.report["channels"]:
            if channel["input"] == chosen["input"] and channel["output"] == chosen["output"]:
                return Margins(f"{channel['input']} -> {channel['output']}", channel)
        raise ArgumentError(f"`{chosen['input']}` has no channel to `{chosen['output']}`")

    def __iter__(self):
        """``A, B, C, D = system``."""
        return iter((self.A, self.B, self.C, self.D))

    def __repr__(self):
        sizes = f"{len(self.states)} states, {len(self.inputs)} inputs, {len(self.outputs)} outputs"
        sampled = "" if self.sample_time is None else f", sampled every {self.sample_time:.6g} s"
        return f"<sincro.LinearSystem: {sizes}{sampled}, {self.stability}>"


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
