"""Reference of the remote flight to the wall, without rounding: python reference.py (numpy and scipy, about five minutes).

The independent integration of ../aerial-manipulator-contact/reference.py with the arm's weight in advance.
"""
import importlib.util
import os

FOLDER = os.path.dirname(os.path.abspath(__file__))
CONTACT = os.path.join(FOLDER, "..", "aerial-manipulator-contact")

if __name__ == "__main__":
    spec = importlib.util.spec_from_file_location("contact", os.path.join(CONTACT, "reference.py"))
    contact = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(contact)
    rows = contact.simulate(60.0, contact.hover.read_task(FOLDER), weight_only=True)
    columns = "t,x,y,z,roll,pitch,yaw,tip_x,tip_y,tip_z,wall,force".split(",")
    contact.hover.write(os.path.join(FOLDER, "reference.csv"), rows, 10, columns, "by reference.py: [s], [m], [rad], [N]; tip in the world")
