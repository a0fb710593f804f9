"""Executes notebooks and writes them as pages: docs/notebooks/NAME.md with the figures NAME-K.png beside it.

Usage: notebooks.py [NAME…], at the root of the repository; all of them unless named. Needs the package with matplotlib and
gymnasium. Notebooks are committed without outputs; the pages are what readers of the docs see.
"""

import ast
import json
import re
import sys
from pathlib import Path

FOLDER = Path(__file__).resolve().parents[3] / "docs/notebooks"


def cells(notebook):
    """(kind, text) of each cell; notebooks have no outputs."""
    for cell in json.loads(notebook.read_text())["cells"]:
        assert not cell.get("outputs"), "notebooks are committed without outputs"
        yield cell["cell_type"], "".join(cell["source"])


def execute(text, names, file):
    """Runs a cell; returns the value of its last expression as Jupyter shows it, or None."""
    tree = ast.parse(text, file)
    last = tree.body[-1] if tree.body else None
    is_shown = isinstance(last, ast.Expr) and not text.rstrip().endswith(";")
    body = tree.body[:-1] if is_shown else tree.body
    exec(compile(ast.Module(body, []), file, "exec"), names)
    return eval(compile(ast.Expression(last.value), file, "eval"), names) if is_shown else None


def source_block(text):
    return f"```python\n{text}\n```\n"


def plain(text):
    """Numbers as they are, without the names of their types."""
    return re.sub(r"np[.](?:float|int|bool)(?:64)?_?[(]([^()]*)[)]", r"\1", text)


def page(notebook, render=True):
    """Executes a notebook; returns the text of its page. With `render` false it has no values, and no figure is written."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot
    from matplotlib.artist import Artist

    names, parts, n_figures = {}, [], 0
    for kind, text in cells(notebook):
        if kind == "markdown":
            parts.append(text + "\n")
            continue
        shown = execute(text, names, notebook.name)
        parts.append(source_block(text))
        if shown is not None and not isinstance(shown, Artist) and render:
            parts.append(f"```text\n{plain(repr(shown))}\n```\n")
        for number in pyplot.get_fignums():
            n_figures += 1
            name = f"{notebook.stem}-{n_figures}.png"
            parts.append(f"![{notebook.stem}, figure {n_figures}]({name})\n")
            if render:
                pyplot.figure(number).savefig(FOLDER / name, dpi=110, metadata={"Software": None}, bbox_inches="tight")
        pyplot.close("all")
    link = f"The notebook: [{notebook.name}]({notebook.name}).\n"
    return "\n".join([parts[0], link, *parts[1:]])


def main():
    wanted = sys.argv[1:]
    for notebook in sorted(FOLDER.glob("*.ipynb")):
        if not wanted or notebook.stem in wanted:
            notebook.with_suffix(".md").write_text(page(notebook))
            print(notebook.with_suffix(".md"))


if __name__ == "__main__":
    main()
