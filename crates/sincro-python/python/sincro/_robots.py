"""Robots from URDF, SDF and MJCF files as scene folders."""

from __future__ import annotations

import json
import os
import tempfile
from pathlib import Path
from typing import NamedTuple

from . import _sincro

_ENDINGS = (".urdf", ".xacro", ".sdf", ".xml", ".mjcf", ".world")

# folders of robots that were loaded without a folder to keep them in
_TEMPORARY: list = []


class Import(NamedTuple):
    """An imported robot: ``folder`` of the scene, ``report`` (a dictionary: what became of every element), ``warnings``."""

    folder: Path
    report: dict
    warnings: list


def is_robot_file(path) -> bool:
    """True for a file that :func:`import_robot` reads, judged by its name."""
    path = os.fspath(path)
    return path.lower().endswith(_ENDINGS) and os.path.isfile(path)


def import_robot(
    robot, folder=None, *, free_base=False, motors="hold", repairs=(), package_paths=(), merge_fixed=False
) -> Import:
    """Imports a robot from a URDF, xacro, SDF or MJCF file as a scene folder.

    ``folder``: absent or empty; a temporary one unless given. ``free_base``: the base moves freely. ``motors``: drives of
    joints where the source names none: ``hold``, ``torque`` or ``none``. ``repairs``: ``min-inertia``,
    ``positive-inertia``; nothing is repaired that is not named. ``package_paths``: folders in which packages are searched.
    ``merge_fixed``: links on fixed joints become parts of the bodies that carry them; frames of their names stay.

    Raises :class:`SceneError` with everything that keeps the robot from being a scene, each with its line.
    """
    if folder is None:
        temporary = tempfile.TemporaryDirectory(prefix="sincro-robot-")
        _TEMPORARY.append(temporary)
        folder = Path(temporary.name) / Path(os.fspath(robot)).stem
    paths = [os.fspath(path) for path in package_paths]
    report, warnings = _sincro.import_robot(
        os.fspath(robot), os.fspath(folder), bool(free_base), motors, list(repairs), paths, bool(merge_fixed)
    )
    return Import(Path(folder), json.loads(report), warnings)
