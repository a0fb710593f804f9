#!/usr/bin/env python3
"""Times MuJoCo: one step per integrator, forward and inverse dynamics, batches over threads.

    python3 mujoco_bench.py --models DIR [--only NAME,NAME] [--seconds-per-figure 0.2]    all figures, one JSON object
    python3 mujoco_bench.py --models DIR --serve                                          one figure per request

DIR holds <model>/model.xml with a keyframe `home`. stdout carries JSON only, progress goes to stderr. Exit status: 0 done,
2 bad arguments, 3 a package is missing (one line on stderr says how to install it).

LINE PROTOCOL of --serve (`sincro bench --against mujoco`). The first line out, once, says who answers:

    {"ready": "mujoco", "version": "4.0.0", "protocol": 1, "models": ["alexandros", …], …}

then each request line gets exactly one JSON line, in order; end of input or `quit` ends the program with status 0.

    step MODEL INTEGRATOR STEP                   mj_step; INTEGRATOR is euler, rk4, implicit or implicitfast; STEP in s
    forward MODEL                                mj_forward at a fixed state: home, and 0.1 s of stepping
    inverse MODEL                                mj_inverse at that state
    batch MODEL INTEGRATOR STEP THREADS [WORLDS]           per world and step; one call advances a simulated second
                                                           (large models: as many steps as 0.1 s of work are)
    batch_lockstep MODEL INTEGRATOR STEP THREADS [WORLDS]  the same, one call a step; WORLDS is 256 unless given
    acceleration MODEL                           joint accelerations at home with every hinge at 0.3 rad/s (free body:
                                                 at rest, angular first, body axes), contacts and limits off: compare them to know that the models agree
    seconds S                                    time spent on each figure from now on

Answer to a timing request: the request's words by name, and
    median_ns, min_ns        wall time per call (batch: per world and step), over the repetitions
    cpu_median_ns, cpu_min_ns    the same in processor time of the calling thread; absent for a batch on several threads
    repetitions, calls_per_repetition
    method                   how the loop ran
    contacts, rows           with geometry: contacts and rows of constraints, on average over the steps of the second
    diverged                 MuJoCo warned of a state that is not finite, and reset it
Answer to a request that cannot be met: {"error": "…"}.

HOW. The loop never runs in Python: mj_step is called with nstep > 1, the batch advances many worlds a call, and mj_forward and
mj_inverse, which take no count, run in a three-line C loop compiled at start (method "c-loop"). Without a C compiler they
are called through ctypes, and the measured cost of an empty ctypes call is subtracted (method "ctypes-minus-call").
Every simulated second the state returns to the keyframe; the return is not timed.

FAIRNESS. Importing the Python package installs a profiling clock (`mjcb_time`) in the C library, which MuJoCo then reads many
times a step: alexandros 2.3 instead of 1.6 µs. `set_mjcb_time(None)` does not take it out again; this program does, through
ctypes, and so measures what a C program would see. `profiling_clock` in the first line says whether that worked.
"""

import argparse
import ctypes
import gc
import glob
import json
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

try:
    import mujoco
except ImportError as problem:
    print(f"mujoco_bench: the package `mujoco` cannot be imported ({problem}); help: pip install mujoco", file=sys.stderr)
    sys.exit(3)
try:
    from mujoco.batch import Batch  # since MuJoCo 4
except ImportError:
    Batch = None

INTEGRATORS = {
    "euler": mujoco.mjtIntegrator.mjINT_EULER,
    "rk4": mujoco.mjtIntegrator.mjINT_RK4,
    "implicit": mujoco.mjtIntegrator.mjINT_IMPLICIT,
    "implicitfast": mujoco.mjtIntegrator.mjINT_IMPLICITFAST,
}
REPETITION_S = 0.005   # shorter: the clock shows; longer: fewer repetitions to take a median of
MIN_REPETITIONS = 5
BATCH_CALL_S = 0.1     # longest call of a batch: a second of many worlds of a large model would take minutes
WORLDS = 256
BAD_STATE = [int(kind) for kind in (mujoco.mjtWarning.mjWARN_BADQPOS, mujoco.mjtWarning.mjWARN_BADQVEL, mujoco.mjtWarning.mjWARN_BADQACC)]

C_LOOP = """
void loop(void (*f)(const void *, void *), const void *m, void *d, long n) { while (n-- > 0) f(m, d); }
void empty(const void *m, void *d) { (void)m; (void)d; }
"""


class BadRequest(Exception):
    """A request that cannot be met; the message is the answer."""


def compile_c_loop():
    """The C loop as a loaded library, or None without a compiler."""
    compiler = shutil.which("gcc") or shutil.which("cc") or shutil.which("clang")
    if not compiler:
        return None
    with tempfile.TemporaryDirectory() as folder:
        source, library = os.path.join(folder, "loop.c"), os.path.join(folder, "loop.so")
        with open(source, "w") as file:
            file.write(C_LOOP)
        if subprocess.run([compiler, "-O2", "-shared", "-fPIC", source, "-o", library], capture_output=True).returncode:
            return None
        return ctypes.CDLL(library)  # stays mapped after the file is gone


def load_libmujoco():
    """The C library that the Python package itself runs on."""
    folder = os.path.dirname(mujoco.__file__)
    found = [path for name in ("libmujoco*.so*", "libmujoco*.dylib", "mujoco.dll") for path in glob.glob(os.path.join(folder, name))]
    if not found:
        return None
    return ctypes.CDLL(found[0])


def remove_profiling_clock(library):
    """Takes out the clock that the Python package installs (see FAIRNESS above); false if that is not possible."""
    try:
        ctypes.c_void_p.in_dll(library, "mjcb_time").value = None
        return True
    except (ValueError, TypeError):
        return False


def measure(call, calls, seconds, cpu=True):
    """Median and minimum of `call() -> (wall_ns, cpu_ns)` per one of its `calls` calls, over repetitions of about 5 ms."""
    wall, _ = call()
    wall, _ = call()
    per_repetition = max(1, round(REPETITION_S * 1e9 / max(wall, 1)))
    walls, cpus = [], []
    end = time.perf_counter() + seconds
    while len(walls) < MIN_REPETITIONS or time.perf_counter() < end:
        pairs = [call() for _ in range(per_repetition)]
        walls.append(sum(pair[0] for pair in pairs) / (per_repetition * calls))
        cpus.append(sum(pair[1] for pair in pairs) / (per_repetition * calls))
    figure = {"median_ns": round(statistics.median(walls), 2), "min_ns": round(min(walls), 2)}
    if cpu:
        figure["cpu_median_ns"] = round(statistics.median(cpus), 2)
        figure["cpu_min_ns"] = round(min(cpus), 2)
    return figure | {"repetitions": len(walls), "calls_per_repetition": per_repetition * calls}


def timed(function, *arguments):
    """Wall and thread processor time of one call, in ns."""
    cpu = time.thread_time_ns()
    wall = time.perf_counter_ns()
    function(*arguments)
    wall = time.perf_counter_ns() - wall
    return wall, time.thread_time_ns() - cpu


class Bench:
    def __init__(self, folder, seconds):
        self.folder, self.seconds = folder, seconds
        self.models, self.batches = {}, {}
        self.c_loop = compile_c_loop()
        self.library = load_libmujoco()
        self.clock_removed = remove_profiling_clock(self.library)
        if not self.clock_removed:
            print("mujoco_bench: warning: the package's profiling clock could not be removed; MuJoCo looks slower than it is", file=sys.stderr)
        mujoco.set_mju_user_warning(lambda message: None)  # or divergence fills a log file in the working directory

    def names(self):
        paths = glob.glob(os.path.join(self.folder, "*", "model.xml"))
        return sorted(os.path.basename(os.path.dirname(path)) for path in paths)

    def hello(self):
        return {"ready": "mujoco", "version": mujoco.__version__, "protocol": 1, "models": self.names(),
                "integrators": list(INTEGRATORS), "c_loop": self.c_loop is not None, "python": sys.version.split()[0],
                "profiling_clock": "removed" if self.clock_removed else "kept", "figures": ["step", "forward", "inverse"] + (["batch", "batch_lockstep"] if Batch else [])}

    def load(self, name, integrator="euler", step=0.001):
        """Model and data, at the keyframe."""
        if integrator not in INTEGRATORS:
            raise BadRequest(f"unknown integrator `{integrator}`; expected one of {', '.join(INTEGRATORS)}")
        if not 0.0 < step <= 1.0:
            raise BadRequest(f"step {step} s is outside (0, 1]")
        if name not in self.models:
            path = os.path.join(self.folder, name, "model.xml")
            if not os.path.isfile(path):
                raise BadRequest(f"no model `{name}`; present: {', '.join(self.names())}")
            model = mujoco.MjModel.from_xml_path(path)
            if model.nkey < 1:
                raise BadRequest(f"model `{name}` has no keyframe `home`")
            self.models[name] = model, mujoco.MjData(model)
        model, data = self.models[name]
        model.opt.timestep, model.opt.integrator = step, INTEGRATORS[integrator]
        mujoco.mj_resetDataKeyframe(model, data, 0)
        return model, data

    def step(self, name, integrator, step):
        model, data = self.load(name, integrator, step)
        per_second = max(1, round(1.0 / step))
        wall, _ = timed(mujoco.mj_step, model, data, per_second)
        mujoco.mj_resetDataKeyframe(model, data, 0)
        calls = max(1, per_second // max(1, round(wall * 1e-9 / REPETITION_S)))  # a second of a large model is several calls
        state = {"taken": 0, "diverged": False}

        def call():
            if state["taken"] + calls > per_second:
                mujoco.mj_resetDataKeyframe(model, data, 0)
                state["taken"] = 0
            pair = timed(mujoco.mj_step, model, data, calls)
            state["taken"] += calls
            state["diverged"] |= any(data.warning[kind].number for kind in BAD_STATE)
            return pair

        figure = measure(call, calls, self.seconds)
        if model.ngeom:
            figure |= self.contacts(model, data, per_second)
        return figure | {"method": "mj_step(nstep)", "diverged": bool(state["diverged"])}

    def contacts(self, model, data, per_second):
        """Contacts and rows of constraints, on average over the steps of a second that is not timed."""
        mujoco.mj_resetDataKeyframe(model, data, 0)
        contacts = rows = 0
        for _ in range(per_second):
            mujoco.mj_step(model, data)
            contacts, rows = contacts + data.ncon, rows + data.nefc
        return {"contacts": contacts / per_second, "rows": rows / per_second}

    def function(self, function_name, name):
        """A function of (model, data) that MuJoCo calls once only: forward or inverse dynamics."""
        model, data = self.load(name)
        mujoco.mj_step(model, data, 100)
        mujoco.mj_forward(model, data)
        if not self.library:
            raise BadRequest("libmujoco was not found beside the Python package")
        c_model, c_data = ctypes.c_void_p(model._address), ctypes.c_void_p(data._address)
        function = getattr(self.library, function_name)
        function.restype, function.argtypes = None, [ctypes.c_void_p, ctypes.c_void_p]
        if self.c_loop:
            def loop(n):
                self.c_loop.loop(ctypes.cast(function, ctypes.c_void_p), c_model, c_data, ctypes.c_long(n))
            wall, _ = timed(loop, 100)
            n = max(1, round(100 * REPETITION_S * 1e9 / max(wall, 1)))
            return measure(lambda: timed(loop, n), n, self.seconds) | {"method": "c-loop"}

        def loop(called, n):
            for _ in range(n):
                called(c_model, c_data)
        empty_function = self.library.mj_version  # returns at once, and ignores what it is given
        empty_function.restype, empty_function.argtypes = None, [ctypes.c_void_p, ctypes.c_void_p]
        n = 2000
        empty = measure(lambda: timed(loop, empty_function, n), n, self.seconds / 2)
        full = measure(lambda: timed(loop, function, n), n, self.seconds / 2)
        for key in ("median_ns", "min_ns", "cpu_median_ns", "cpu_min_ns"):
            full[key] = round(full[key] - empty[key], 2)
        return full | {"method": "ctypes-minus-call", "empty_call_ns": empty["median_ns"]}

    def batch(self, name, integrator, step, threads, worlds, lockstep):
        if not Batch:
            raise BadRequest("this MuJoCo has no batch; help: pip install 'mujoco>=4'")
        if threads < 1 or worlds < 1:
            raise BadRequest("threads and worlds must be at least 1")
        key = (name, integrator, step, threads, worlds)
        if key not in self.batches:
            model, _ = self.load(name, integrator, step)
            self.batches = {key: Batch(model, nsim=worlds, nthread=threads)}  # one at a time: its threads may spin
        batch = self.batches[key]
        batch.reset(keyframe=0, stage=mujoco.mjtStage.mjSTAGE_NONE.value)
        one_step_ns = min(timed(batch.step)[0] for _ in range(5))
        steps = max(1, min(round(1.0 / step), round(BATCH_CALL_S * 1e9 / one_step_ns)))

        def advance():
            if lockstep:
                for _ in range(steps):
                    batch.step()
            else:
                batch.step(nstep=steps)

        diverged = [False]

        def call():
            batch.reset(keyframe=0, stage=mujoco.mjtStage.mjSTAGE_NONE.value)
            pair = timed(advance)
            diverged[0] |= bool(batch.warning[:, BAD_STATE, 1].any())  # (world, kind, [last info, number])
            return pair

        figure = measure(call, steps * worlds, self.seconds, cpu=threads == 1)
        return figure | {"method": "Batch.step()" if lockstep else "Batch.step(nstep)", "diverged": diverged[0]}

    def acceleration(self, name):
        model, data = self.load(name)
        # what touches a floor is compared without it: contact is soft here and rigid there
        flags, model.opt.disableflags = model.opt.disableflags, model.opt.disableflags | int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
        hinges = [model.jnt_dofadr[j] for j in range(model.njnt) if model.jnt_type[j] == mujoco.mjtJoint.mjJNT_HINGE]
        data.qvel[hinges] = 0.3
        mujoco.mj_forward(model, data)
        model.opt.disableflags = flags
        answer = {}
        for j in range(model.njnt):
            first = model.jnt_dofadr[j]
            free = model.jnt_type[j] == mujoco.mjtJoint.mjJNT_FREE
            rows = range(3, 6) if free else [0]
            answer.setdefault(model.body(model.jnt_bodyid[j]).name, []).extend(float(data.qacc[first + row]) for row in rows)
            if free:  # MuJoCo: linear first, in world axes
                axes = data.xmat[model.jnt_bodyid[j]].reshape(3, 3)
                answer[model.body(model.jnt_bodyid[j]).name].extend(float(x) for x in axes.T @ data.qacc[first:first + 3])
        return {"acceleration": answer}

    def answer(self, line):
        """The answer to one request line, a dictionary."""
        words = line.split()
        try:
            verb, arguments = words[0], words[1:]
            if verb == "seconds":
                self.seconds = float(arguments[0])
                return {"seconds": self.seconds}
            asked = {"figure": verb, "model": arguments[0]}
            if verb == "step":
                name, integrator, step = arguments
                asked |= {"integrator": integrator, "step": float(step)}
                return asked | self.step(name, integrator, float(step))
            if verb in ("forward", "inverse"):
                (name,) = arguments
                return asked | self.function("mj_" + verb, name)
            if verb in ("batch", "batch_lockstep"):
                name, integrator, step, threads = arguments[:4]
                worlds = int(arguments[4]) if len(arguments) > 4 else WORLDS
                asked |= {"integrator": integrator, "step": float(step), "threads": int(threads), "worlds": worlds}
                return asked | self.batch(name, integrator, float(step), int(threads), worlds, verb == "batch_lockstep")
            if verb == "acceleration":
                (name,) = arguments
                return asked | self.acceleration(name)
        except BadRequest as problem:
            return {"error": str(problem)}
        except (IndexError, ValueError):
            pass
        except Exception as problem:  # MuJoCo's own errors: this request fails, the server stays
            return {"error": f"{type(problem).__name__}: {problem}".splitlines()[0]}
        return {"error": f"cannot read the request `{line}`; help: the head of mujoco_bench.py lists them"}


def serve(bench):
    print(json.dumps(bench.hello()), flush=True)
    for line in sys.stdin:
        line = line.strip()
        if line == "quit":
            break
        if line:
            print(json.dumps(bench.answer(line)), flush=True)


def all_figures(bench, names, step, threads):
    requests = []
    for name in names:
        requests += [f"step {name} {integrator} {step}" for integrator in INTEGRATORS]
        requests += [f"forward {name}", f"inverse {name}"]
        requests += [f"batch {name} euler {step} {count}" for count in threads]
    figures = []
    for request in requests:
        figures.append(bench.answer(request))
        answer = figures[-1]
        print(f"{request:45} " + (answer.get("error") or f"{answer['median_ns']:12.1f} ns  min {answer['min_ns']:.1f}"), file=sys.stderr)
    json.dump(bench.hello() | {"figures": figures}, sys.stdout, indent=1)
    print()


def main():
    parser = argparse.ArgumentParser(description="times MuJoCo; see the head of this file")
    parser.add_argument("--models", required=True, help="folder with <model>/model.xml")
    parser.add_argument("--only", default="", help="names, separated by commas; default all")
    parser.add_argument("--seconds-per-figure", type=float, default=0.2)
    parser.add_argument("--step", type=float, default=0.005, help="time step [s]")
    parser.add_argument("--threads", default="1,2", help="thread counts of the batch figures")
    parser.add_argument("--serve", action="store_true", help="answer requests from stdin, one JSON line each")
    options = parser.parse_args()
    gc.disable()  # a collection in the middle of a repetition would be counted
    bench = Bench(options.models, options.seconds_per_figure)
    if not bench.names():
        parser.error(f"no <model>/model.xml under `{options.models}`")
    if options.serve:
        serve(bench)
    else:
        all_figures(bench, [n for n in options.only.split(",") if n] or bench.names(), options.step, [int(n) for n in options.threads.split(",")])


if __name__ == "__main__":
    main()
