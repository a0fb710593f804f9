"""Scenes built in code: they write the same TOML as a folder has."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from ._errors import ArgumentError
from ._model import toml_key, toml_value


class Scene:
    """A scene in the making.

    ``add(kind, name, **keys)`` appends an entry of the scene file (``joint``, ``body``, ``frame``, ``rotor``, ``sensor`` …);
    keys, units and meanings are those of docs/scene-format.md. Each ``add`` returns the path of the object, to be the
    ``parent`` of others. ``experiment`` has the keys of ``experiment.toml``.

    >>> import sincro
    >>> scene = sincro.Scene("A pendulum", duration=1.0, step=0.005)
    >>> hinge = scene.add("joint", "hinge", kind="revolute", axis=[0, 1, 0], initial={"position": 1.0})
    >>> bob = scene.add("body", "bob", parent=hinge, position=[0, 0, -0.5], density=1000.0,
    ...                 shape=[{"sphere": {"radius": 0.05}}])
    >>> scene.record(hinge + ".position", "energy.balance")
    >>> result = sincro.load(scene).run()
    >>> round(float(result["/hinge.position"][0]), 6)
    1.0
    """

    def __init__(self, title="Scene", *, scene=None, **experiment):
        self.entries: list[tuple[str, dict]] = []
        self.top: dict = dict(scene or {})
        self.experiment: dict = {"title": title, "scene": "scene.toml", "duration": 1.0, "step": 0.001, **experiment}
        self.experiment.setdefault("record", [])
        self._temporary = None

    def add(self, entry, name, /, **keys) -> str:
        """Appends an entry and returns the path of its object."""
        if not isinstance(name, str) or not name or "/" in name:
            raise ArgumentError(f"{name!r} is no name: it names the object below its parent, without `/`")
        parent = str(keys.get("parent", "/")).rstrip("/")
        self.entries.append((entry, {"name": name, **keys}))
        return f"{parent}/{name}"

    def record(self, *signals):
        """Adds signals to those that are recorded."""
        self.experiment["record"].extend(signals)

    def scene_toml(self) -> str:
        """Text of ``scene.toml``."""
        parts = [_table(self.top)] if self.top else []
        parts += [f"[[{entry}]]\n{_table(keys)}" for entry, keys in self.entries]
        return "\n".join(parts)

    def experiment_toml(self) -> str:
        """Text of ``experiment.toml``."""
        return _table(self.experiment)

    def write(self, folder) -> Path:
        """Writes ``scene.toml`` and ``experiment.toml`` into a folder, made if it is absent."""
        folder = Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "scene.toml").write_text(self.scene_toml(), encoding="utf-8")
        (folder / "experiment.toml").write_text(self.experiment_toml(), encoding="utf-8")
        return folder

    def _folder(self) -> str:
        if self._temporary is None:
            self._temporary = tempfile.TemporaryDirectory(prefix="sincro-scene-")
        return os.fspath(self.write(Path(self._temporary.name) / "scene"))

    def __repr__(self):
        return f"<sincro.Scene {self.experiment['title']!r}: {len(self.entries)} objects>"


def _table(keys) -> str:
    return "".join(f"{toml_key(key)} = {toml_value(value)}\n" for key, value in keys.items())
