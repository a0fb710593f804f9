"""The two-link arm as an FMU, controlled from Python: python arm.py PATH/TO/sincro

The position loop of `scenes/two-dof-position`, u[k] = k_pos (r[k] - q[k-1]), is written here in Python and commands the
motors of the exported arm. The same loop as a diagram runs inside another FMU. Both move in the same way, bit for bit.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave

ROOT = Path(__file__).resolve().parents[2]
JOINTS = ["shoulder", "shoulder.elbow"]
STEP, K_POS = 0.005, 2.0


def reference(t):
    return (1.0, -0.5) if t < 4.0 - 1e-9 else (0.2, 0.8)


def open_fmu(sincro, scene, work):
    path = work / f"{scene.name}.fmu"
    subprocess.run([sincro, "export", "fmu", scene, "--out", path], check=True, stdout=subprocess.DEVNULL)
    description = read_model_description(str(path))
    fmu = FMU2Slave(guid=description.guid, unzipDirectory=extract(str(path)),
                    modelIdentifier=description.coSimulation.modelIdentifier, instanceName=scene.name)
    fmu.instantiate()
    fmu.setupExperiment(startTime=0.0)
    fmu.enterInitializationMode()
    fmu.exitInitializationMode()
    return fmu, {v.name: v.valueReference for v in description.modelVariables}


def main():
    sincro = Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as folder:
        arm, names = open_fmu(sincro, ROOT / "examples/fmi/arm", Path(folder))
        whole, names_of_whole = open_fmu(sincro, ROOT / "scenes/two-dof-position", Path(folder))
        commands = [names[f"{joint}.command"] for joint in JOINTS]
        positions = [names[f"{joint}.position"] for joint in JOINTS]
        expected = [names_of_whole[f"{joint}.position"] for joint in JOINTS]
        before = [0.0, 0.0]  # the loop sees the measurement of the sample before
        for k in range(1600):
            t = k * STEP
            q = arm.getReal(positions)
            arm.setReal(commands, [K_POS * (r - x) for r, x in zip(reference(t), before)])
            before = q
            arm.doStep(currentCommunicationPoint=t, communicationStepSize=STEP)
            whole.doStep(currentCommunicationPoint=t, communicationStepSize=STEP)
            if [x.hex() for x in arm.getReal(positions)] != [x.hex() for x in whole.getReal(expected)]:
                sys.exit(f"the two differ at t = {t + STEP} s: {arm.getReal(positions)}, {whole.getReal(expected)}")
        print("after 8 s the arm stands at", *(f"{x:.6f} rad" for x in arm.getReal(positions)))
        for fmu in (arm, whole):
            fmu.terminate()
            fmu.freeInstance()


if __name__ == "__main__":
    main()
