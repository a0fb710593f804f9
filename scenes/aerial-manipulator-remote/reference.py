"""Reference of the remote flight, without rounding: python reference.py (numpy and scipy, about three minutes).

The independent integration of ../aerial-manipulator-hover/reference.py with the arm's weight in advance.
"""
import importlib.util
import os

FOLDER = os.path.dirname(os.path.abspath(__file__))
HOVER = os.path.join(FOLDER, "..", "aerial-manipulator-hover")

if __name__ == "__main__":
    spec = importlib.util.spec_from_file_location("hover", os.path.join(HOVER, "reference.py"))
    hover = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(hover)
    rows = hover.simulate(40.0, compensation=2, task=hover.read_task(HOVER))
    hover.write(os.path.join(FOLDER, "reference.csv"), rows, 10, comment="by reference.py: [s], [m], [rad]; tip in the axes of the arm's base")
