"""Models: scenes, loaded."""

from __future__ import annotations

import json
import math
import os
from typing import NamedTuple

import numpy as np

from . import _sincro
from ._errors import ArgumentError, ControllerError
from ._linear import Equilibrium, LinearSystem
from ._result import Result


class State(NamedTuple):
    """State of a run: ``t`` in s, coordinates ``q`` (n_q,), velocities ``v`` (n_v,); angles in rad, lengths in m."""

    t: float
    q: np.ndarray
    v: np.ndarray


def toml_value(value) -> str:
    """A Python value as it stands in a scene file."""
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        number = float(value)
        return repr(number) if math.isfinite(number) else {math.inf: "inf", -math.inf: "-inf"}.get(number, "nan")
    if isinstance(value, (str, os.PathLike)):
        return json.dumps(os.fspath(value), ensure_ascii=False)
    if isinstance(value, np.ndarray):
        value = value.tolist()
        return toml_value(value)
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(toml_value, value)) + "]"
    if isinstance(value, dict):
        pairs = (f"{toml_key(key)} = {toml_value(entry)}" for key, entry in value.items())
        return "{ " + ", ".join(pairs) + " }"
    raise ArgumentError(f"a {type(value).__name__} cannot stand in a scene: give numbers, texts, lists or dictionaries")


def toml_key(key) -> str:
    """A key as it stands in a scene file."""
    bare = key and all(c.isascii() and (c.isalnum() or c in "_-") for c in key)
    return key if bare else json.dumps(key, ensure_ascii=False)


class Model(_sincro.Model):
    """A scene, loaded: made by :func:`sincro.load`.

    It is used in two ways. :meth:`run` makes the whole run that its experiment describes and returns a
    :class:`Result`; each call is a run of its own, and any number of threads may call it at once. :meth:`step` advances
    the one run that the model holds, which begins when it is first used and starts anew by :meth:`reset`.

    Attributes: ``path``, ``title``, ``warnings``, ``dt`` (base step in s), ``duration`` in s, ``n_q``, ``n_v`` (numbers of
    coordinates and of velocities), ``inputs`` and ``signals`` ((name, unit) pairs), ``joints`` ((path, range in q, range
    in v)), ``frames``, ``controllers``, ``time``, ``tick``, ``q``, ``v``, ``trace_hash``.

    >>> import sincro
    >>> model = sincro.load("scenes/spring-dynamic")
    >>> model.n_v, model.dt
    (1, 0.005)
    >>> model.step(steps=100)
    >>> model.time
    0.5
    """

    # ---- whole runs

    def run(self, *, until=None, error_bars=True, variants=True) -> Result:
        """Runs the experiment and returns its :class:`Result`.

        ``until``: end in s in place of the experiment's duration. ``error_bars``: estimate them by a second, finer run.
        ``variants``: run variants and sweep of the experiment too. Controllers in Python that keep a memory, and have no
        method ``reset``, are run once: without error bars, variants and sweep.

        Ctrl-C ends the run with ``KeyboardInterrupt``. A run that stops is a result (``status``); an exception of a
        controller in Python is raised as :class:`ControllerError`.
        """
        try:
            return Result(self._run(until, error_bars, variants))
        except ControllerError as error:
            error.result = Result(error.__dict__.pop("run"))
            raise

    # ---- the run under way

    @property
    def state(self) -> State:
        """The present :class:`State` of the run under way; set it with ``set_state(q=…, v=…)``."""
        return State(self.time, self.q, self.v)

    def __getitem__(self, name) -> float:
        """Value of a signal at the present instant: ``model["/arm.position"]``."""
        return float(self.observe([name])[0])

    # ---- controllers

    def controller(self, function=None, *, period=None, reads=None, writes=None, name=None, repeatable=None):
        """Attaches a function as a controller in lock-step: the world waits for it.

        ``function(t, y)`` is called every ``period`` seconds (every base step unless given) with the time and an array
        of the signals ``reads``; it returns the commands ``writes``, as a list in that order or as a dictionary, or None
        to hold the last ones. They act from the instant of the measurement on. ``reads``: signals of the world and of
        sensors, all positions and velocities of the joints unless given. ``writes``: names of commands (see ``inputs``),
        all unless given. An object with a method ``reset`` has it called at the start of each run. ``repeatable``: the
        function gives the same answers in a second run, so that error bars can be estimated; true for objects with
        ``reset``, else false unless given.

        As a decorator, with or without arguments:

        >>> import sincro
        >>> model = sincro.load("scenes/spring-dynamic")
        >>> @model.controller(period=0.01, reads=["/shoulder.position"], writes=[], repeatable=True)
        ... def watch(t, y):
        ...     return None
        >>> model.controllers
        ['watch']
        """
        if function is None:
            return lambda f: self.controller(
                f, period=period, reads=reads, writes=writes, name=name, repeatable=repeatable
            )
        if not callable(function):
            raise ArgumentError(f"a {type(function).__name__} is no controller: give a function of time and measurements")
        if reads is None:
            known = [signal for signal, _ in self.signals]
            of_joints = tuple(path for path, _, _ in self.joints)
            states = ("position", "quaternion", "velocity", "angular_velocity")
            reads = [s for s in known if s.split(".")[0] in of_joints and s.split(".")[1] in states]
        writes = [command for command, _ in self.inputs] if writes is None else writes
        for given, what in ((reads, "reads"), (writes, "writes")):
            if isinstance(given, str):
                raise ArgumentError(f"`{what}` is a list of names: write [{given!r}]")
        has_reset = callable(getattr(function, "reset", None))
        name = name or getattr(function, "__name__", type(function).__name__)
        is_repeatable = has_reset if repeatable is None else bool(repeatable)
        self._control((name, function), period, list(reads), list(writes), is_repeatable)
        return function

    def clear_controllers(self):
        """Removes all controllers that were attached by :meth:`controller`."""
        self._clear_controllers()

    # ---- linear analysis

    def linearize(
        self, at=None, *, equilibrium=False, inputs=(), outputs=(), closed_loop=False, sampled=False, loops=()
    ) -> LinearSystem:
        """Linearises the scene, exactly, by dual numbers.

        ``at``: time in s to which a fresh run goes first; None: where the run under way is. ``equilibrium``: find one near
        there first. ``inputs``: commands (``/joint``), with ``closed_loop`` signals of the diagram; all free commands
        unless given. ``outputs``: signals; all coordinates unless given. ``closed_loop``: with the continuous blocks of the
        diagram in the loop.

        ``sampled``: the scene with its sampled diagram, from one period of all sample times to the next, by central
        differences. ``loops``: signals of the diagram at which it is opened, each in turn; ``system.loops[signal]`` then
        has the :class:`sincro.Margins`.

        >>> import sincro
        >>> system = sincro.load("scenes/spring-dynamic").linearize(at=0.0)
        >>> system.A.shape, system.stability
        ((2, 2), 'stable')
        >>> system = sincro.load("scenes/two-dof-position").linearize(at=0.0, sampled=True, loops=["speed[0]"])
        >>> system.loops["speed[0]"]
        <sincro.Margins speed[0]: no gain margin, phase margin 89.1° at 2 rad/s, modulus margin 0.986>
        """
        if isinstance(loops, str):
            raise ArgumentError(f"`loops` is a list of names: write [{loops!r}]")
        if loops and not sampled:
            raise ArgumentError("loops are opened in the sampled system: sampled=True")
        if not sampled:
            return LinearSystem(*self._linearize(at, equilibrium, list(inputs), list(outputs), closed_loop))
        if inputs or outputs or closed_loop:
            raise ArgumentError("the sampled system is the scene as a whole: without inputs, outputs and closed_loop")
        return LinearSystem(self._linearize_sampled(at, equilibrium, list(loops)), None, [])

    def trim(self, *, free=(), want=None, closed_loop=False, go=False) -> Equilibrium:
        """Finds an equilibrium near where the run under way is.

        ``free``: commands that may be changed. ``want``: values that signals must have. ``closed_loop``: with the diagram.
        ``go``: put the run under way there, at rest.
        """
        want = [(name, float(value)) for name, value in dict(want or {}).items()]
        return Equilibrium(*self._trim(list(free), want, closed_loop, go))

    def forward_dynamics_derivatives(self, q=None, v=None, tau=None):
        """Derivatives of ``forward_dynamics`` by displacements of q, by v and by tau: three (n_v, n_v) arrays, exact.

        A displacement of a ball or free joint is a rotation vector (and a shift) in the axes of the moving body.
        """
        return tuple(self._forward_dynamics_derivatives(q, v, tau))

    # ---- the page

    def view(self, *, open_browser=True):
        """Shows the scene live in the browser, from a process of its own; returns the process (``terminate()`` it)."""
        return _spawn(self, "view", [] if open_browser else ["--no-open"])

    def serve(self, *arguments):
        """Serves the scene to clients of V-REP and CoppeliaSim from a process of its own; returns the process.

        ``arguments``: those of ``sincro serve``.
        """
        return _spawn(self, "serve", list(arguments))

    # ---- Python's own

    def copy(self) -> Model:
        """Another model of the same scene and settings, with a run of its own and no controllers."""
        return Model(self.path, self._settings)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def __reduce__(self):
        if self.controllers:
            raise TypeError(
                "a model with controllers in Python cannot be pickled: attach them where it is unpickled "
                f"({', '.join(self.controllers)})"
            )
        return _restored, (str(self.path), self._settings, self.snapshot())

    def __repr__(self):
        return f"<sincro.Model {self.path}: {self.title!r}, {self.n_v} degrees of freedom, step {self.dt} s>"


def _restored(path, settings, snapshot):
    model = Model(path, settings)
    model.restore(snapshot)
    return model


def _spawn(model, command, arguments):
    import subprocess
    import sys

    settings = [part for path, value in model._settings for part in ("--set", f"{path}={value}")]
    return subprocess.Popen([sys.executable, "-m", "sincro", command, str(model.path), *settings, *arguments])
