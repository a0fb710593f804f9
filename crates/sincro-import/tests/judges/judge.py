#!/usr/bin/env python3
"""Imports robots of public packages, and holds the dynamics of the scenes against Pinocchio and MuJoCo.

    judge.py SINCRO WORK COLLECTION... [--json FILE] [--markdown FILE]

SINCRO is the program, WORK a folder for scenes and downloads. A collection is one of the names of COLLECTIONS below; the
packages are fetched with pip, and nothing of them is kept in the repository. Exit status 1 if a bound does not hold.
"""
import argparse
import collections
import glob
import json
import os
import re
import shutil
import subprocess
import sys
import time
import zipfile

import numpy as np

STATES = 100
#: Bounds: of the largest entry, for Pinocchio and for MuJoCo; of coordinates after a second.
PINOCCHIO_BOUND, MUJOCO_BOUND, TRAJECTORY_BOUND = 1e-10, 1e-9, 1e-6


def fetch(work, package):
    """Folder with the unpacked wheel of a package."""
    folder = os.path.join(work, "packages", re.split("[=<>]", package)[0])
    if not os.path.isdir(folder):
        wheels = os.path.join(work, "wheels", package)
        subprocess.run([sys.executable, "-m", "pip", "download", "-q", "--no-deps", "-d", wheels, package], check=True)
        for wheel in glob.glob(os.path.join(wheels, "*.whl")):
            zipfile.ZipFile(wheel).extractall(folder)
    return folder


def scene_name(name):
    return re.sub(r"[^A-Za-z0-9_-]", "_", name)


def imported(sincro, file, folder):
    """Runs the import; exit status, reason, seconds, report."""
    shutil.rmtree(folder, ignore_errors=True)
    start = time.time()
    try:
        run = subprocess.run([sincro, "import", file, "-o", folder], capture_output=True, text=True, timeout=120)
    except subprocess.TimeoutExpired:
        return -1, "no end after 120 s", 120.0, None
    seconds = time.time() - start
    errors = [line.strip() for line in run.stderr.splitlines() if "error:" in line]
    reason = errors[0].split("error: ", 1)[1] if errors else run.stderr[-200:]
    report = None
    if run.returncode == 0:
        with open(os.path.join(folder, "import-report.json")) as text:
            report = json.load(text)
    return run.returncode, reason, seconds, report


def terms(sincro, folder, states=None):
    """Coordinates of a scene, and its terms at states."""
    arguments = [sincro, "dynamics", folder] + (["--stdin"] if states else [])
    text = "".join(json.dumps(state) + "\n" for state in states or [])
    run = subprocess.run(arguments, input=text, capture_output=True, text=True, check=True)
    lines = [json.loads(line) for line in run.stdout.splitlines()]
    return lines[0], lines[1:]


def relative(expected, found):
    if expected.size == 0:
        return 0.0
    return float(np.abs(expected - found).max() / max(np.abs(expected).max(), 1e-300))


def against_pinocchio(sincro, file, folder):
    """Largest difference of mass matrix, inverse and forward dynamics; none where Pinocchio has another model."""
    import pinocchio as pin

    model = pin.buildModelFromUrdf(file)
    data = model.createData()
    head, _ = terms(sincro, folder)
    if head["n_v"] == 0 and model.nv == 0:
        return 0.0
    names = {joint["joint"].split("/")[-1]: joint for joint in head["joints"]}
    if head["n_v"] != model.nv:
        raise ValueError(f"{head['n_v']} degrees of freedom, Pinocchio has {model.nv}")
    rng = np.random.default_rng(1)
    states, expected = [], []
    order = np.zeros(model.nv, int)
    for _ in range(STATES):
        q, own = pin.neutral(model), np.zeros(head["n_q"])
        v, a, tau = (rng.standard_normal(model.nv) for _ in range(3))
        for k in range(1, model.njoints):
            joint, ours = model.joints[k], names[scene_name(model.names[k])]
            if joint.nv == 1:
                x = rng.uniform(-3, 3)
                q[joint.idx_q : joint.idx_q + joint.nq] = [x] if joint.nq == 1 else [np.cos(x), np.sin(x)]
                own[ours["q"][0]] = x
                order[joint.idx_v] = ours["v"][0]
            elif joint.nv == 6:
                p, w = rng.uniform(-1, 1, 3), rng.standard_normal(4)
                w /= np.linalg.norm(w)
                q[joint.idx_q : joint.idx_q + 7] = [*p, *w[1:], w[0]]
                own[slice(*ours["q"])] = [*p, *w]
                first = ours["v"][0]
                order[joint.idx_v : joint.idx_v + 6] = [first + 3, first + 4, first + 5, first, first + 1, first + 2]
            else:
                raise ValueError(f"joint {model.names[k]} is of another kind")
        ours = []
        for list_ in (v, a, tau):
            own_list = np.zeros(model.nv)
            own_list[order] = list_
            ours.append(own_list.tolist())
        states.append(dict(q=own.tolist(), v=ours[0], a=ours[1], tau=ours[2]))
        mass = pin.crba(model, data, q)
        mass = np.triu(mass) + np.triu(mass, 1).T
        expected.append((mass, pin.rnea(model, data, q, v, a).copy(), pin.aba(model, data, q, v, tau).copy()))
    _, found = terms(sincro, folder, states)
    worst = 0.0
    for (mass, inverse, forward), at in zip(expected, found):
        worst = max(worst, relative(mass, np.array(at["mass_matrix"])[np.ix_(order, order)]))
        worst = max(worst, relative(inverse, np.array(at["inverse_dynamics"])[order]))
        worst = max(worst, relative(forward, np.array(at["forward_dynamics"])[order]))
    return worst


def joints_of_mujoco(model, head):
    """Our joint for each of MuJoCo's; joints without name are found by their body, or as the last ones left."""
    left = list(head["joints"])
    found = [None] * model.njnt

    def take(j, name):
        ours = [x for x in left if x["joint"].split("/")[-1] == name]
        if ours and found[j] is None:
            found[j] = ours[0]
            left.remove(ours[0])

    for j in range(model.njnt):
        body = model.jnt_bodyid[j]
        count = "" if model.body_jntnum[body] == 1 else str(j - model.body_jntadr[body] + 1)
        take(j, scene_name(model.joint(j).name or f"{model.body(body).name}-joint{count}"))
    for j in range(model.njnt):
        if found[j] is None:
            found[j] = left.pop(0)
    return found


def without_soft_constraints(folder):
    """Takes stops of tendons, and tendons and bushings that stand for equalities, out of a scene: they are soft
    constraints there. Springs and dampers of actuators on tendons, or on joints that have a tendon for it, go, too:
    actuation is off there."""
    with open(os.path.join(folder, "import-report.json")) as text:
        elements = json.load(text)["elements"]
    words = re.compile(r"a stiff \[\[tendon\]\]|(a \[\[tendon\]\] of .*, )?a spring and damper with an actuator")
    held = {str(e["line"]) for e in elements if words.match(e["words"])}
    path = os.path.join(folder, "scene.toml")
    with open(path) as text:
        blocks = text.read().split("\n\n")
    kept = []
    for block in blocks:
        if "[[bushing]]" in block:
            continue
        if "[[tendon]]" in block:
            if block.lstrip().split("\n")[0].rsplit(":", 1)[-1] in held:
                continue
            lines = [line for line in block.split("\n") if not line.startswith("limits = ")]
            block = "\n".join(lines)
            if not re.search("^(stiffness|damping|preload|actuator) = ", block, re.M):
                continue
        kept.append(block)
    with open(path, "w") as text:
        text.write("\n\n".join(kept))


def against_mujoco(sincro, file, folder):
    """Largest difference of the inverse dynamics, without contacts, limits, equalities and Coulomb friction."""
    import mujoco

    without_soft_constraints(folder)

    model = mujoco.MjModel.from_xml_path(file)
    data = mujoco.MjData(model)
    for flag in ("CONTACT", "EQUALITY", "LIMIT", "FRICTIONLOSS", "ACTUATION"):
        model.opt.disableflags |= getattr(mujoco.mjtDisableBit, f"mjDSBL_{flag}")
    head, _ = terms(sincro, folder)
    if head["n_v"] != model.nv:
        raise ValueError(f"{head['n_v']} degrees of freedom, MuJoCo has {model.nv}")
    joints = joints_of_mujoco(model, head)
    rng = np.random.default_rng(1)
    states, expected = [], []
    for _ in range(STATES // 5):
        v, a = rng.standard_normal(model.nv), rng.standard_normal(model.nv)
        q, own_q, own_v, own_a = np.zeros(model.nq), np.zeros(head["n_q"]), np.zeros(model.nv), np.zeros(model.nv)
        order, turns = np.zeros(model.nv, int), []
        for j, ours in enumerate(joints):
            qa, va, kind = model.jnt_qposadr[j], model.jnt_dofadr[j], model.jnt_type[j]
            sq, sv = ours["q"][0], ours["v"][0]
            if kind in (2, 3):
                x = rng.uniform(-1, 1)
                q[qa], own_q[sq] = x + model.qpos0[qa], x
                own_v[sv], own_a[sv], order[va] = v[va], a[va], sv
                continue
            w = rng.standard_normal(4)
            w /= np.linalg.norm(w)
            if kind == 1:
                q[qa : qa + 4] = own_q[sq : sq + 4] = w
                own_v[sv : sv + 3], own_a[sv : sv + 3] = v[va : va + 3], a[va : va + 3]
                order[va : va + 3] = range(sv, sv + 3)
                continue
            # linear rates: in world axes there, in the body's here
            p = rng.uniform(-1, 1, 3)
            q[qa : qa + 7] = own_q[sq : sq + 7] = [*p, *w]
            turn = np.zeros(9)
            mujoco.mju_quat2Mat(turn, w)
            turn = turn.reshape(3, 3)
            spin, linear = v[va + 3 : va + 6], turn.T @ v[va : va + 3]
            own_v[sv : sv + 6] = [*spin, *linear]
            own_a[sv : sv + 6] = [*a[va + 3 : va + 6], *(turn.T @ a[va : va + 3] - np.cross(spin, linear))]
            order[va : va + 6] = [sv + 3, sv + 4, sv + 5, sv, sv + 1, sv + 2]
            turns.append((va, turn))
        states.append(dict(q=own_q.tolist(), v=own_v.tolist(), a=own_a.tolist()))
        data.qpos[:], data.qvel[:], data.qacc[:], data.ctrl[:] = q, v, a, 0
        mujoco.mj_inverse(model, data)
        expected.append((data.qfrc_inverse.copy(), order, turns))
    _, found = terms(sincro, folder, states)
    worst = 0.0
    for (torque, order, turns), at in zip(expected, found):
        ours = (np.array(at["inverse_dynamics"]) - np.array(at["passive"]))[order]
        for first, turn in turns:
            ours[first : first + 3] = turn @ ours[first : first + 3]
        worst = max(worst, relative(torque, ours))
    return worst


def without_switching(folder):
    """Takes contacts, limits, friction, motors, loops and couplings out of a scene."""
    without_soft_constraints(folder)
    path = os.path.join(folder, "scene.toml")
    with open(path) as text:
        blocks = text.read().split("\n\n")
    blocks = [b for b in blocks if not re.search(r"^\[\[(closure|coupling|sensor|camera)\]\]|^actuator = ", b, re.M)]
    gone = ("limits = ", "friction = ", "motor = ")
    lines = [line for line in "\n\n".join(blocks).split("\n") if not line.startswith(gone)]
    # starts from the reference, which is zero here
    lines = [line for line in lines if not re.fullmatch(r"initial = \{ position = [-+.\de]+ \}", line)]
    if any(line.startswith("contact = ") for line in lines):
        lines += ["[[contact_pair]]", 'between = ["/**", "/**"]', "touches = false", ""]
    with open(path, "w") as text:
        text.write("\n".join(lines))


def trajectory(sincro, file, folder):
    """Largest difference of the coordinates after one second of motion from the reference at random rates, without
    contacts, limits, friction, loops and motors; MuJoCo by Runge–Kutta at 0.1 ms."""
    import mujoco

    without_switching(folder)
    model = mujoco.MjModel.from_xml_path(file)
    for flag in ("CONTACT", "EQUALITY", "LIMIT", "FRICTIONLOSS", "ACTUATION"):
        model.opt.disableflags |= getattr(mujoco.mjtDisableBit, f"mjDSBL_{flag}")
    model.opt.integrator, model.opt.timestep = mujoco.mjtIntegrator.mjINT_RK4, 1e-4
    head, _ = terms(sincro, folder)
    joints = joints_of_mujoco(model, head)
    scalar = [j for j in range(model.njnt) if model.jnt_type[j] in (2, 3)]
    if not scalar:
        raise ValueError("no joint with one degree of freedom")
    data = mujoco.MjData(model)
    rates = np.random.default_rng(1).uniform(-0.5, 0.5, len(scalar))
    data.qvel[model.jnt_dofadr[scalar]] = rates
    for _ in range(10_000):
        mujoco.mj_step(model, data)
    bad = ("BADQPOS", "BADQVEL", "BADQACC")
    if any(data.warning[getattr(mujoco.mjtWarning, f"mjWARN_{what}")].number for what in bad):
        raise ValueError("MuJoCo's motion is unstable at this step")
    record = ",\n".join(f'    "{joints[j]["joint"]}.position"' for j in scalar)
    with open(os.path.join(folder, "experiment.toml"), "w") as text:
        text.write(
            f'format = 2\ntitle = "free motion"\nscene = "scene.toml"\nduration = 1.0\nstep = 0.05\naccuracy = 1e-11\nerror_bar = "none"\nrecord = [\n{record}\n]\n'
        )
    out = folder + "-run"
    shutil.rmtree(out, ignore_errors=True)
    settings = [f'--set={joints[j]["joint"]}.initial.velocity={x!r}' for j, x in zip(scalar, rates.tolist())]
    run = subprocess.run([sincro, "run", folder, "--out", out, *settings], capture_output=True, text=True, timeout=240)
    if not os.path.exists(os.path.join(out, "signals.csv")):
        raise ValueError(run.stderr[-300:])
    with open(os.path.join(out, "signals.csv")) as text:
        last = [line for line in text if not line.startswith("#")][-1]
    shutil.rmtree(out, ignore_errors=True)
    found = np.array([float(x) for x in last.split(",")[1:]])
    expected = np.array([data.qpos[model.jnt_qposadr[j]] - model.qpos0[model.jnt_qposadr[j]] for j in scalar])
    return float(np.abs(found - expected).max())


def robot_data(work):
    folder = fetch(work, "example-robot-data==6.0.0")
    urdf = sorted(glob.glob(os.path.join(folder, "**", "*.urdf"), recursive=True))
    return urdf, sorted(glob.glob(os.path.join(folder, "**", "*.sdf"), recursive=True))


def mjcf_files(work, packages):
    import mujoco

    files = []
    for package in packages:
        for file in sorted(glob.glob(os.path.join(fetch(work, package), "**", "*.xml"), recursive=True)):
            with open(file, errors="replace") as text:
                if "<mujoco" not in text.read():
                    continue
            try:
                if mujoco.MjModel.from_xml_path(file).njnt > 0:
                    files.append(file)
            except (ValueError, RuntimeError):
                pass  # parts of models, which MuJoCo does not load either
    return files


#: Why some differ: the ends of their paths, and what was found when each was looked into.
EXPLAINED = {
    "icub.urdf": "rounding: the mass matrix has a condition number of up to 7e11, and accelerations of 7e11 rad/s² give the torques back to 2e-7 there and 4e-7 here",
    "drosophila_fused.xml": "MuJoCo finds principal axes of meshes to about 1e-6 rad: the inertia of random meshes is off by up to 1e-7 against their own corners, the principal moments by 3e-13",
    "omron_mobile_base.xml": "MuJoCo keeps corners of meshes as 32-bit numbers: the difference is 2e-13 when they are rounded before the import",
}

SMALL = ["dm_control==1.0.50", "gymnasium==1.4.0"]
LARGE = ["gymnasium-robotics==1.4.2", "metaworld==3.1.1", "robosuite==1.5.2", "playground==0.2.0", "mjlab==1.6.0", "myosuite==3.0.0"]
#: Name → (title, files, oracle, bound, fewest that are imported).
COLLECTIONS = {
    "urdf": ("example-robot-data, URDF", lambda w: robot_data(w)[0], against_pinocchio, PINOCCHIO_BOUND, 62),
    "sdf": ("example-robot-data, SDF", lambda w: robot_data(w)[1], None, 0.0, 4),
    "mjcf-small": ("dm_control, gymnasium: MJCF", lambda w: mjcf_files(w, SMALL), against_mujoco, MUJOCO_BOUND, 46),
    "motion-small": ("dm_control, gymnasium: 1 s of motion", lambda w: mjcf_files(w, SMALL), trajectory, TRAJECTORY_BOUND, 46),
    "mjcf": ("eight packages of MJCF", lambda w: mjcf_files(w, SMALL + LARGE), against_mujoco, MUJOCO_BOUND, 190),
    "motion": ("eight packages of MJCF, 1 s of motion", lambda w: mjcf_files(w, SMALL + LARGE), trajectory, TRAJECTORY_BOUND, 190),
    "bullet": ("pybullet, URDF", lambda w: sorted(glob.glob(os.path.join(fetch(w, "pybullet==3.2.7"), "**", "*.urdf"), recursive=True)), None, 0.0, 1080),
}


def judge(sincro, work, name):
    title, files, oracle, bound, fewest = COLLECTIONS[name]
    rows = []
    for k, file in enumerate(files(work)):
        folder = os.path.join(work, "scenes", name, str(k))
        status, reason, seconds, report = imported(sincro, file, folder)
        row = dict(file=os.path.relpath(file, os.path.join(work, "packages")), status=status, seconds=seconds)
        if status == 0:
            row["changed"] = [c["quantity"] for c in report["comparison"] if not c["equal"]]
            try:
                row["worst"] = oracle(sincro, file, folder) if oracle else None
            except Exception as error:  # the oracle has no such model
                row["not_compared"] = str(error)[:120]
        else:
            row["reason"] = reason
        shutil.rmtree(folder, ignore_errors=True)
        rows.append(row)
    good = [row for row in rows if row["status"] == 0]
    compared = [row["worst"] for row in good if row.get("worst") is not None]
    summary = dict(
        title=title,
        n=len(rows),
        imported=len(good),
        refused=sum(row["status"] == 2 for row in rows),
        panics=sum(row["status"] not in (0, 2) for row in rows),
        compared=len(compared),
        within=sum(x <= bound for x in compared),
        bound=bound,
        worst=max(compared, default=None),
        slowest=max((row["seconds"] for row in rows), default=0.0),
        reasons=collections.Counter(re.sub(r"`[^`]*`", "`…`", row["reason"]) for row in rows if row["status"] == 2).most_common(),
        rows=rows,
    )
    summary["holds"] = summary["panics"] == 0 and summary["imported"] >= fewest
    print(
        f"{title}: {summary['imported']} of {summary['n']} imported, {summary['refused']} refused, {summary['panics']} panics; "
        f"{summary['within']} of {summary['compared']} within {bound:g}, worst {summary['worst']}",
        flush=True,
    )
    return summary


def markdown(summaries):
    lines = [
        "# Import of public robots",
        "",
        "Made by `cargo xtask judge import`, from packages that pip fetches; nothing of them is in the repository. A robot is imported, or refused with",
        "a line and a reason. The dynamics of what is imported is held against another program at random states: mass matrix, inverse and forward",
        "dynamics against Pinocchio, inverse dynamics without contacts against MuJoCo; differences are relative to the largest entry. Motions of one",
        "second from the reference at random rates, without what switches, are held against MuJoCo's Runge–Kutta method at 0.1 ms (where that is stable, and",
        "where a joint has one degree of freedom): largest difference of a coordinate `[rad]`, `[m]`.",
        "",
        "| collection | files | imported | refused | panics | compared | within the bound | worst difference |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for s in summaries:
        worst = "–" if s["worst"] is None else f"{s['worst']:.1e}"
        within = "–" if not s["compared"] else f"{s['within']} (1e{int(np.log10(s['bound']))})"
        lines.append(f"| {s['title']} | {s['n']} | {s['imported']} | {s['refused']} | {s['panics']} | {s['compared'] or '–'} | {within} | {worst} |")
    for s in summaries:
        beyond = [r for r in s["rows"] if r.get("worst") is not None and r["worst"] > s["bound"]]
        if s["reasons"] or beyond:
            lines += ["", f"## {s['title']}", ""]
        if s["reasons"]:
            lines += ["| refused | reason |", "|---|---|"]
            lines += [f"| {n} | {reason} |" for reason, n in s["reasons"]]
        if beyond:
            lines += ["", "| beyond the bound | difference | why |", "|---|---|---|"]
            why = [next((words for end, words in EXPLAINED.items() if r["file"].endswith(end)), "") for r in beyond]
            lines += [f"| {r['file']} | {r['worst']:.1e} | {words} |" for r, words in zip(beyond, why)]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("sincro")
    parser.add_argument("work")
    parser.add_argument("collections", nargs="+", choices=list(COLLECTIONS))
    parser.add_argument("--json")
    parser.add_argument("--markdown")
    arguments = parser.parse_args()
    sincro, work = os.path.abspath(arguments.sincro), os.path.abspath(arguments.work)
    for key in ("json", "markdown"):
        setattr(arguments, key, getattr(arguments, key) and os.path.abspath(getattr(arguments, key)))
    # MuJoCo writes its log into the folder where it runs
    os.makedirs(work, exist_ok=True)
    os.chdir(work)
    summaries = [judge(sincro, work, name) for name in arguments.collections]
    if arguments.json:
        with open(arguments.json, "w") as out:
            json.dump(summaries, out, indent=1)
    if arguments.markdown:
        with open(arguments.markdown, "w") as out:
            out.write(markdown(summaries))
    return 0 if all(s["holds"] for s in summaries) else 1


if __name__ == "__main__":
    sys.exit(main())
