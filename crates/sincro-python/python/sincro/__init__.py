"""Simulates robots and their controllers in lock-step: exact, deterministic, with an error bar on every run.

>>> import sincro
>>> model = sincro.load("scenes/spring-dynamic", {"/shoulder.spring.stiffness": 20})
>>> result = model.run()
>>> result["/shoulder.position"].unit
'rad'
"""

from __future__ import annotations

import os as _os
from collections.abc import Mapping as _Mapping

from . import _sincro
from ._errors import (
    ArgumentError,
    ClosedError,
    ControllerError,
    InternalError,
    SceneError,
    SincroError,
    StoppedError,
    UnknownNameError,
)
from ._linear import Equilibrium, LinearSystem, Margin, Margins
from ._model import Model, State
from ._model import toml_value as _toml_value
from ._result import Result, Signal
from ._robots import import_robot, is_robot_file
from ._scene import Scene
from ._sincro import Snapshot, __version__

__all__ = [
    "ArgumentError",
    "ClosedError",
    "ControllerError",
    "Equilibrium",
    "InternalError",
    "LinearSystem",
    "Margin",
    "Margins",
    "Model",
    "Result",
    "Scene",
    "SceneError",
    "Signal",
    "SincroError",
    "Snapshot",
    "State",
    "StoppedError",
    "UnknownNameError",
    "__version__",
    "import_robot",
    "load",
    "run",
]


def load(scene, settings: _Mapping | None = None, /, **experiment) -> Model:
    """Opens a scene folder, its ``experiment.toml``, a robot file (URDF, SDF, MJCF) or a :class:`Scene`.

    ``settings`` win over the files: ``{"/arm.spring.stiffness": 20, "step": 0.001}``, paths as after ``--set`` on the
    command line. Keywords are settings of the experiment: ``duration=2.0``, ``step=0.001``, ``seed=3``.

    Raises :class:`SceneError` with all problems of the files and settings at once.
    """
    both = {**(settings or {}), **experiment}
    pairs = [(str(path), _toml_value(value)) for path, value in both.items()]
    if isinstance(scene, Scene):
        scene = scene._folder()
    elif not isinstance(scene, (str, _os.PathLike)):
        raise ArgumentError(f"a {type(scene).__name__} is no scene: give a path, or a sincro.Scene")
    elif is_robot_file(scene):
        scene = import_robot(scene).folder
    return Model(_os.fspath(scene), pairs)


def run(scene, settings: _Mapping | None = None, /, **experiment) -> Result:
    """Loads a scene and runs it: ``load(scene, settings).run()``."""
    return load(scene, settings, **experiment).run()
