"""The examples of the documentation and of the docstrings run."""

import doctest
import importlib
import json
from pathlib import Path

import pytest

MODULES = ["sincro", "sincro._model", "sincro._result", "sincro._scene", "sincro._linear", "sincro.gym"]


@pytest.mark.parametrize("name", MODULES)
def test_docstrings(name):
    if name == "sincro.gym":
        pytest.importorskip("gymnasium")
    failed, tried = doctest.testmod(importlib.import_module(name), optionflags=doctest.ELLIPSIS)
    assert failed == 0 and (tried > 0 or name == "sincro._linear")


def test_the_page():
    pytest.importorskip("gymnasium")
    failed, tried = doctest.testfile("docs/python.md", module_relative=False, optionflags=doctest.ELLIPSIS)
    assert failed == 0 and tried > 20


NOTEBOOKS = sorted((Path(__file__).resolve().parents[3] / "docs/notebooks").glob("*.ipynb"))


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks(notebook):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    from matplotlib import pyplot

    names = {}
    for cell in json.loads(notebook.read_text())["cells"]:
        assert not cell.get("outputs"), "notebooks are committed without outputs"
        if cell["cell_type"] == "code":
            exec(compile("".join(cell["source"]), notebook.name, "exec"), names)
    pyplot.close("all")
