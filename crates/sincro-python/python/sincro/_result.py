"""Results of runs: signals as arrays, checks, audit, plots, the page."""

from __future__ import annotations

import html
import json
from pathlib import Path

import numpy as np

from ._errors import UnknownNameError


class Signal(np.ndarray):
    """A recorded signal: a read-only NumPy array that knows its name, unit, times and error bar.

    ``name``: path of the signal; ``unit``: SI unit; ``time``: times of the values in s, of the same length;
    ``error_bar``: estimated integration error in the same unit, or None; ``error_bar_method``: how it was estimated,
    or why it was not. What NumPy computes from a signal is a plain array.
    """

    name: str
    unit: str
    time: np.ndarray | None
    error_bar: float | None
    error_bar_method: str

    def __new__(cls, values, name, unit, time, error_bar, error_bar_method):
        signal = np.asarray(values).view(cls)
        signal.name, signal.unit, signal.time = name, unit, time
        signal.error_bar, signal.error_bar_method = error_bar, error_bar_method
        return signal

    def __array_finalize__(self, source):
        self.name = getattr(source, "name", "")
        self.unit = getattr(source, "unit", "")
        # times belong to the whole signal
        self.time = self.error_bar = None
        self.error_bar_method = ""

    def __array_wrap__(self, array, context=None, return_scalar=False):
        return array[()] if return_scalar else np.asarray(array)

    def __getitem__(self, index):
        return np.asarray(self)[index]

    def __reduce__(self):
        parts = (np.asarray(self), self.name, self.unit, self.time, self.error_bar, self.error_bar_method)
        return Signal, parts

    def __repr__(self):
        unit = f" {self.unit}" if self.unit else ""
        bar = "" if self.error_bar is None else f", ± {self.error_bar:.3g}{unit}"
        if not self.size:
            return f"<sincro.Signal {self.name}: empty>"
        values = np.asarray(self)
        return f"<sincro.Signal {self.name}: {self.size} values, {values.min():.6g} to {values.max():.6g}{unit}{bar}>"


class Result:
    """Result of a run.

    ``result["/arm.position"]`` is a :class:`Signal`. ``trace_hash`` is that of ``sincro run``: the same bits give the
    same hash.

    >>> import sincro
    >>> result = sincro.load("scenes/free-body").run(until=0.1)
    >>> result.status
    'completed'
    >>> float(result["t"][-1])
    0.1
    """

    def __init__(self, run, variant=None):
        self._run, self._variant = run, variant
        self._columns = None
        self._report = None

    # ---- signals

    def _signals(self):
        if self._columns is None:
            columns = self._run.columns(self._variant)
            time = columns[0][2]
            self._columns = {c[0]: Signal(c[2], c[0], c[1], time, c[3], c[4]) for c in columns}
        return self._columns

    def __getitem__(self, name) -> Signal:
        signals = self._signals()
        if name in signals:
            return signals[name]
        ends = self._ending(name)
        if len(ends) == 1:
            return signals[ends[0]]
        if ends:
            several = ", ".join(f"`{end}`" for end in ends)
            raise UnknownNameError(f"`{name}` may mean {several}\n  help: write the whole path")
        import difflib

        near = difflib.get_close_matches(str(name), signals, 1)
        help = f"did you mean `{near[0]}`?" if near else "recorded are: " + ", ".join(signals)
        raise UnknownNameError(f"`{name}` was not recorded\n  help: {help}")

    def __contains__(self, name):
        return name in self._signals() or len(self._ending(name)) == 1

    def _ending(self, name) -> list:
        """Names of the signals that end so: ``hinge.position``."""
        tail = "/" + str(name).removeprefix("/")
        return [known for known in self._signals() if known.endswith(tail)]

    def __iter__(self):
        return iter(self._signals())

    def __len__(self):
        return len(self._signals())

    def keys(self):
        """Names of the recorded signals, ``t`` first."""
        return self._signals().keys()

    @property
    def time(self) -> Signal:
        """Times of the recorded rows in s."""
        return self["t"]

    # ---- judgement

    @property
    def report(self) -> dict:
        """The content of ``run.json``; for a variant, its entry there."""
        if self._report is None:
            whole = json.loads(self._run.json())
            if self._variant is not None:
                whole = next(v for v in whole["variants"] if v["name"] == self._variant)
            self._report = whole
        return self._report

    @property
    def trace_hash(self) -> str:
        """Hash of the states of all ticks, hexadecimal."""
        return self.report["trace_hash"]

    @property
    def status(self) -> str:
        """``completed``, ``ended`` (at a bound of the experiment), ``stopped`` or ``interrupted``."""
        return self.report["status"]["state"]

    @property
    def verdict(self) -> str:
        """``holds``, ``fails`` or ``stopped``, over all checks, variants and audits: the exit status of ``sincro run``."""
        return self._run.verdict

    @property
    def audit(self) -> dict:
        """Audit of the run: ``ok``, ``findings``, ``laws`` (see docs/accuracy.md)."""
        return self.report["audit"]

    @property
    def checks(self) -> list:
        """Checks of the experiment, judged: dictionaries with ``name``, ``verdict``, ``measured``, ``expected`` …"""
        return self.report["checks"]

    @property
    def warnings(self) -> list:
        """Warnings about the accuracy of the numbers."""
        return self.report["warnings"]

    @property
    def variants(self) -> dict:
        """Results of the experiment's variants, by their names."""
        if self._variant is not None:
            return {}
        return {name: Result(self._run, name) for name in self._run.variants}

    # ---- to look at

    def to_dict(self) -> dict:
        """Signals as a dictionary of plain arrays: ``pandas.DataFrame(result.to_dict())``."""
        return {name: np.asarray(values) for name, values in self._signals().items()}

    def html(self) -> str:
        """The page that ``sincro run`` writes: replay in 3-D, plots, checks, as one HTML text."""
        return self._run.html()

    def write(self, folder) -> Path:
        """Writes the folder that ``sincro run --out`` writes; returns the path of its page.

        The folder must be absent, empty, or an earlier result, which is replaced whole.
        """
        self._run.write(Path(folder))
        return Path(folder) / "report.html"

    def plot(self, *names, axes=None):
        """Plots signals over time with matplotlib, one panel a unit; returns the axes.

        ``names``: signals; all but energies and torques unless given. ``axes``: matplotlib axes to draw in.
        """
        try:
            from matplotlib import pyplot
        except ImportError as missing:
            raise ImportError("plots need matplotlib: pip install matplotlib") from missing
        signals = [self[name] for name in names] or list(self._signals().values())[1:9]
        units = list(dict.fromkeys(signal.unit for signal in signals))
        if axes is None:
            _, axes = pyplot.subplots(len(units), 1, sharex=True, squeeze=False, layout="constrained")
        axes = np.atleast_1d(np.asarray(axes, dtype=object)).ravel()
        for axis, unit in zip(axes, units):
            for signal in (s for s in signals if s.unit == unit):
                (line,) = axis.plot(signal.time, np.asarray(signal), label=signal.name)
                if signal.error_bar:
                    values, bar = np.asarray(signal), signal.error_bar
                    axis.fill_between(signal.time, values - bar, values + bar, color=line.get_color(), alpha=0.2)
            axis.set_ylabel(f"[{unit}]" if unit else "")
            axis.legend(fontsize="small")
            axis.grid(alpha=0.3)
        axes[-1].set_xlabel("t [s]")
        return axes

    def __repr__(self):
        checks = self.checks
        held = sum(check["verdict"] == "holds" for check in checks)
        name = self.report.get("scene") or self._variant
        return f"<sincro.Result {name}: {self.status}, {held} of {len(checks)} checks hold, trace {self.trace_hash}>"

    def _repr_html_(self):
        page = html.escape(self.html(), quote=True)
        return (
            f'<iframe srcdoc="{page}" style="width:100%;height:640px;border:1px solid #ccc" '
            'sandbox="allow-scripts" title="sincro run"></iframe>'
        )
