#!/usr/bin/env python3
"""Times Pinocchio: forward dynamics (ABA), inverse dynamics (RNEA), one semi-implicit Euler step.

    python3 pinocchio_bench.py --models DIR [--only NAME,NAME] [--seconds-per-figure 0.2]    all figures, one JSON object
    python3 pinocchio_bench.py --models DIR --serve                                          one figure per request

DIR holds <model>/scene.toml in sincro's format; the robot that Pinocchio gets is made from that very file. stdout carries JSON
only, progress goes to stderr. Exit status: 0 done, 2 bad arguments, 3 a package or the compiler is missing, or the program does
not compile (one line on stderr says how to mend it).

Compiles pinocchio_bench.cpp against the headers of the PyPI packages `pin` and `cmeel-eigen`, twice, a minute each:
`portable` (-O3) and `native` (-O3 -march=native), both with g++'s inlining limits raised. The portable one is what a portable build of sincro is compared with.
--builds portable compiles that one only; --build-dir DIR keeps the programs, so that the next start takes a second.

LINE PROTOCOL of --serve (`sincro bench --against pinocchio`). The first line out, once, after compiling:

    {"ready": "pinocchio", "version": "4.1.0", "protocol": 1, "models": ["alexandros", …], "builds": ["portable", "native"], …}

then each request line gets exactly one JSON line, in order; end of input or `quit` ends the program with status 0.
BUILD is portable (default) or native.

    forward MODEL [BUILD]                  ABA at home, all velocities 0.1; both conventions are timed, the faster is given
    inverse MODEL [BUILD]                  RNEA at home, all velocities and accelerations 0.1
    step MODEL euler STEP [BUILD]          springs, dampers, torques, thrusts, ABA (the same), semi-implicit Euler; STEP in s
    acceleration MODEL [BUILD]             joint accelerations at home with every hinge at 0.3 rad/s (free body: at rest,
                                           angular first): compare them to know that the models agree
    seconds S                              time spent on each figure from now on

Answer to a timing request: the request's words by name, and
    median_ns, min_ns        wall time per call, over the repetitions
    cpu_median_ns, cpu_min_ns    the same in processor time of the thread
    repetitions, calls_per_repetition
    convention, other_convention_cpu_median_ns    forward, step: "local" or "world", the faster, and the other's time
    diverged, timed_step     step: not finite (or above 1e6 rad/s) at STEP; then a tenth of STEP is timed, or a hundredth …:
                             the work is the same, and huge angles would make sine and cosine slow
Answer to a request that cannot be met: {"error": "…"}.

The state returns to home every simulated second, or thousand steps, inside the timing: a copy of two vectors.
"""

import argparse
import hashlib
import importlib.metadata
import json
import os
import shutil
import subprocess
import sys
import tempfile

try:
    import tomllib
except ImportError:
    print("pinocchio_bench: Python 3.11 or later is needed (tomllib)", file=sys.stderr)
    sys.exit(3)

SOURCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "pinocchio_bench.cpp")
FLAGS = {"portable": ["-O3"], "native": ["-O3", "-march=native"]}
# g++ stops inlining in large programs, which all of Pinocchio's are; without these it loses a sixth of its speed
GCC_INLINING = ["--param", "inline-unit-growth=400", "--param", "large-unit-insns=1000000"]
# as Pinocchio's own CMake targets ask for, and a release build
DEFINITIONS = ["-DNDEBUG", "-DBOOST_MPL_LIMIT_LIST_SIZE=30", "-DBOOST_MPL_LIMIT_VECTOR_SIZE=30",
               "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS", "-DBOOST_FUSION_INVOKE_MAX_ARITY=12"]
FIGURES = ("forward", "inverse", "step", "acceleration")
JOINT_KEYS = {"name", "parent", "kind", "axis", "position", "initial", "spring", "damping", "torque"}
BODY_KEYS = {"name", "parent", "mass", "center_of_mass", "inertia"}
FORCE_KEYS = {"name", "parent", "force", "in_frame"}


class BadRequest(Exception):
    """A request that cannot be met; the message is the answer."""


def give_up(message):
    print(f"pinocchio_bench: {message}", file=sys.stderr)
    sys.exit(3)


def include_folders():
    """Folders with Pinocchio's, Boost's and Eigen's headers, from the installed packages."""
    folders = []
    for package, header in (("libpinocchio", "pinocchio/multibody.hpp"), ("cmeel-boost", "boost/variant.hpp"), ("cmeel-eigen", "Eigen/Core")):
        try:
            files = importlib.metadata.files(package) or []
        except importlib.metadata.PackageNotFoundError:
            give_up(f"the package `{package}` is missing; help: pip install 'pin>=4' cmeel-eigen")
        path = next((str(file.locate()) for file in files if str(file).endswith("/" + header)), None)
        if not path or not os.path.isfile(path):
            give_up(f"`{header}` was not found in the package `{package}`; help: pip install --force-reinstall 'pin>=4' cmeel-eigen")
        folder = os.path.normpath(path[: -len(header)])
        if folder not in folders:
            folders.append(folder)
    return folders


def compile_program(build, folder):
    """Path of the compiled program; compiles it unless this very source, version and compiler were compiled there before."""
    compiler = shutil.which("g++") or shutil.which("clang++")
    if not compiler:
        give_up("no C++ compiler; help: install g++")
    compiler_version = subprocess.run([compiler, "--version"], capture_output=True, text=True).stdout.splitlines()[0]
    inlining = [] if "clang" in compiler_version else GCC_INLINING
    command = [compiler, "-std=c++17", "-w", *FLAGS[build], *inlining, *DEFINITIONS]
    with open(SOURCE, "rb") as source:
        made_of = source.read() + repr((command, compiler_version, importlib.metadata.version("pin"))).encode()
    program = os.path.join(folder, f"pinocchio_bench-{build}-{hashlib.sha256(made_of).hexdigest()[:16]}")
    if not os.path.exists(program):
        print(f"compiling {build} (about a minute) …", file=sys.stderr, flush=True)
        command += [argument for path in include_folders() for argument in ("-isystem", path)] + [SOURCE, "-o", program + ".new"]
        result = subprocess.run(command, capture_output=True, text=True)
        if result.returncode:
            errors = [line for line in result.stderr.splitlines() if "error" in line] or ["no message"]
            give_up(f"pinocchio_bench.cpp does not compile: {errors[0][:300]}")
        os.replace(program + ".new", program)
    return program, compiler_version


def refuse_unknown(entry, known, path):
    unknown = set(entry) - known
    if unknown:
        raise BadRequest(f"`{path}` has `{sorted(unknown)[0]}`, which this comparison does not carry over")


def table_of(scene):
    """The plain table that pinocchio_bench.cpp reads; one line a joint with its body, parents first:

    gravity x y z
    kind name parent_row axis(3) position(3) mass com(3) ixx iyy izz ixy ixz iyz stiffness rest damping torque force(3) start(1 or 7)
    """
    bodies = {}
    for body in scene.get("body", []):
        path = body.get("parent", "/").rstrip("/") + "/" + body["name"]
        refuse_unknown(body, BODY_KEYS, path)
        bodies[body.get("parent", "/")] = path, body
    forces = {}
    for force in scene.get("force", []):
        refuse_unknown(force, FORCE_KEYS, force["name"])
        if force.get("in_frame") != "body" or not all(isinstance(x, (int, float)) for x in force["force"]):
            raise BadRequest(f"force `{force['name']}`: only constant forces in body axes are carried over")
        old = forces.get(force["parent"], [0.0] * 3)
        forces[force["parent"]] = [a + b for a, b in zip(old, force["force"])]

    lines = ["gravity " + " ".join(repr(float(x)) for x in scene.get("gravity", [0.0, 0.0, -9.81]))]
    row_of, waiting = {"/": -1}, list(scene.get("joint", []))
    while waiting:
        ready = [joint for joint in waiting if joint.get("parent", "/") in row_of]
        if not ready:
            raise BadRequest(f"joint `{waiting[0]['name']}` has no parent among the bodies")
        waiting = [joint for joint in waiting if joint.get("parent", "/") not in row_of]
        for joint in ready:
            path = joint.get("parent", "/").rstrip("/") + "/" + joint["name"]
            refuse_unknown(joint, JOINT_KEYS, path)
            if joint["kind"] not in ("revolute", "free") or not isinstance(joint.get("torque", 0.0), (int, float)):
                raise BadRequest(f"`{path}`: only revolute and free joints with constant torques are carried over")
            if path not in bodies:
                raise BadRequest(f"`{path}` carries no body")
            body_path, body = bodies[path]
            inertia, spring = body["inertia"], joint.get("spring", {})
            start = joint.get("initial", {}).get("position", 0.0 if joint["kind"] == "revolute" else [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
            numbers = [*joint.get("axis", [0.0, 0.0, 1.0]), *joint.get("position", [0.0] * 3), body["mass"],
                       *body.get("center_of_mass", [0.0] * 3), *(inertia.get(key, 0.0) for key in ("xx", "yy", "zz", "xy", "xz", "yz")),
                       spring.get("stiffness", 0.0), spring.get("rest", 0.0), joint.get("damping", 0.0), joint.get("torque", 0.0),
                       *forces.pop(body_path, [0.0] * 3), *(start if isinstance(start, list) else [start])]
            parent_row, row_of[body_path] = row_of[joint.get("parent", "/")], len(lines) - 1
            lines.append(" ".join([joint["kind"], body["name"], str(parent_row), *(repr(float(x)) for x in numbers)]))
    if forces:
        raise BadRequest(f"a force acts on `{next(iter(forces))}`, which is no body")
    return "\n".join(lines) + "\n"


class Bench:
    def __init__(self, folder, seconds, builds, build_dir, scratch):
        self.folder, self.seconds, self.scratch = folder, seconds, scratch
        self.programs = {}
        for build in builds:
            program, self.compiler = compile_program(build, build_dir)
            self.programs[build] = subprocess.Popen([program, scratch], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def names(self):
        return sorted(name for name in os.listdir(self.folder) if os.path.isfile(os.path.join(self.folder, name, "scene.toml")))

    def hello(self):
        return {"ready": "pinocchio", "version": importlib.metadata.version("pin"), "protocol": 1, "models": self.names(),
                "integrators": ["euler"], "builds": list(self.programs), "figures": ["forward", "inverse", "step"],
                "compiler": self.compiler, "eigen": importlib.metadata.version("cmeel-eigen")}

    def write_table(self, name):
        table = os.path.join(self.scratch, name + ".table")
        if os.path.exists(table):
            return
        if name not in self.names():
            raise BadRequest(f"no model `{name}`; present: {', '.join(self.names())}")
        with open(os.path.join(self.folder, name, "scene.toml"), "rb") as file:
            text = table_of(tomllib.load(file))
        with open(table, "w") as file:
            file.write(text)

    def answer(self, line):
        """The answer to one request line, a dictionary."""
        words = line.split()
        try:
            if words[0] == "seconds":
                self.seconds = float(words[1])
                return {"seconds": self.seconds}
            build = words.pop() if words[-1] in FLAGS else "portable"
            if words[0] not in FIGURES:
                raise ValueError
            asked, step = {"figure": words[0], "model": words[1], "build": build}, 0.0
            if words[0] == "step":
                _, name, integrator, step = words
                step = float(step)
                if integrator != "euler":
                    raise BadRequest(f"unknown integrator `{integrator}`; expected euler")
                if not 0.0 < step <= 1.0:
                    raise BadRequest(f"step {step} s is outside (0, 1]")
                asked |= {"integrator": integrator, "step": step}
            else:
                _, name = words
            if build not in self.programs:
                raise BadRequest(f"the {build} build was not compiled; help: --builds")
            self.write_table(name)
            program = self.programs[build]
            program.stdin.write(f"{words[0]} {name} {self.seconds!r} {step!r}\n")
            program.stdin.flush()
            reply = program.stdout.readline()
            if not reply:
                raise BadRequest(f"the {build} program died at `{line}` (status {program.poll()})")
            reply = json.loads(reply)
            return reply if "error" in reply else asked | reply
        except BadRequest as problem:
            return {"error": str(problem)}
        except OSError as problem:
            return {"error": f"{problem}"}
        except tomllib.TOMLDecodeError as problem:
            return {"error": f"scene.toml of `{words[1]}`: {problem}"}
        except (IndexError, ValueError):
            return {"error": f"cannot read the request `{line}`; help: the head of pinocchio_bench.py lists them"}

    def close(self):
        for program in self.programs.values():
            program.stdin.close()
            program.wait()


def serve(bench):
    print(json.dumps(bench.hello()), flush=True)
    for line in sys.stdin:
        line = line.strip()
        if line == "quit":
            break
        if line:
            print(json.dumps(bench.answer(line)), flush=True)


def all_figures(bench, names, step):
    figures = []
    for name in names:
        for build in bench.programs:
            for request in (f"forward {name}", f"inverse {name}", f"step {name} euler {step}"):
                figures.append(bench.answer(f"{request} {build}"))
                answer = figures[-1]
                text = answer.get("error") or f"{answer['median_ns']:10.1f} ns  cpu {answer['cpu_median_ns']:.1f}  {answer.get('convention', '')}"
                print(f"{request:32} {build:9} {text}", file=sys.stderr)
    json.dump(bench.hello() | {"figures": figures}, sys.stdout, indent=1)
    print()


def main():
    parser = argparse.ArgumentParser(description="times Pinocchio; see the head of this file")
    parser.add_argument("--models", required=True, help="folder with <model>/scene.toml")
    parser.add_argument("--only", default="", help="names, separated by commas; default all")
    parser.add_argument("--seconds-per-figure", type=float, default=0.2)
    parser.add_argument("--step", type=float, default=0.005, help="time step [s]")
    parser.add_argument("--builds", default="portable,native")
    parser.add_argument("--build-dir", help="keep the compiled programs here; default: compile anew, into a temporary folder")
    parser.add_argument("--serve", action="store_true", help="answer requests from stdin, one JSON line each")
    options = parser.parse_args()
    builds = [build for build in options.builds.split(",") if build]
    if not builds or set(builds) - set(FLAGS):
        parser.error(f"--builds takes {', '.join(FLAGS)}")
    if not os.path.isdir(options.models):
        parser.error(f"no folder `{options.models}`")
    if options.build_dir:
        os.makedirs(options.build_dir, exist_ok=True)
    include_folders()  # complains before anything is begun
    with tempfile.TemporaryDirectory() as scratch:
        bench = Bench(options.models, options.seconds_per_figure, builds, options.build_dir or scratch, scratch)
        if options.serve:
            serve(bench)
        else:
            all_figures(bench, [name for name in options.only.split(",") if name] or bench.names(), options.step)
        bench.close()


if __name__ == "__main__":
    main()
