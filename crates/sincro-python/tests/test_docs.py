"""The examples of the documentation and of the docstrings run."""

import doctest
import importlib
import re

import notebooks
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


NOTEBOOKS = sorted(notebooks.FOLDER.glob("*.ipynb"))


def test_there_are_five_notebooks():
    assert len(NOTEBOOKS) == 5


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks(notebook):
    pytest.importorskip("matplotlib")
    found = notebooks.page(notebook, render=False)
    # values that are shown may differ in their last digits from machine to machine
    committed = re.sub(r"```text\n.*?\n```\n\n?", "", notebook.with_suffix(".md").read_text(), flags=re.DOTALL)
    assert found.strip() == committed.strip(), f"render the page anew: python {notebooks.__file__} {notebook.stem}"
    for figure in re.findall(r"\]\(([\w-]+\.png)\)", committed):
        assert (notebooks.FOLDER / figure).is_file()
