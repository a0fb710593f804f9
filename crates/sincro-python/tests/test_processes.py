"""Threads, processes, pickling, Ctrl-C, the command line."""

import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import sincro

SCENE = "scenes/cart-pole-lqr"


def hash_of(settings):
    return sincro.load(SCENE, settings).run(error_bars=False, until=0.5).trace_hash


def hash_of_model(model):
    model.step(steps=10)
    return model.trace_hash


def test_eight_threads_share_a_model():
    model = sincro.load(SCENE)
    expected = model.run(error_bars=False).trace_hash
    with ThreadPoolExecutor(8) as threads:
        hashes = list(threads.map(lambda _: model.run(error_bars=False).trace_hash, range(16)))
    assert set(hashes) == {expected}
    with ThreadPoolExecutor(8) as threads:
        list(threads.map(lambda _: [model.step() for _ in range(50)], range(8)))
    assert model.tick == 400
    alone = sincro.load(SCENE)
    alone.step(steps=400)
    assert model.trace_hash == alone.trace_hash


def test_eight_threads_with_a_controller():
    model = sincro.load(SCENE)
    model.controller(lambda t, y: [-50.0 * y[1]], period=0.02, reads=["/rail.position", "/rail/cart/hinge.position"])
    with ThreadPoolExecutor(8) as threads:
        hashes = list(threads.map(lambda _: model.run(until=0.5).trace_hash, range(8)))
    assert len(set(hashes)) == 1


def test_a_pickled_model_goes_on():
    model = sincro.load(SCENE, {"/rail/cart/hinge/pole.mass": 0.2})
    model.step([1.0], steps=10)
    other = pickle.loads(pickle.dumps(model))
    assert other.tick == 10
    assert hash_of_model(other) == hash_of_model(model)
    result = model.run(until=0.2)
    signal_of = pickle.loads(pickle.dumps(result["/rail.position"]))
    assert signal_of.unit == "m" and signal_of.time.size == signal_of.size
    model.controller(lambda t, y: None)
    with pytest.raises(TypeError, match="cannot be pickled"):
        pickle.dumps(model)


@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_processes_give_the_same_bits(method):
    expected = hash_of({"/rail/cart/hinge/pole.mass": 0.2})
    model = sincro.load(SCENE)
    model.step(steps=5)
    context = multiprocessing.get_context(method)
    with context.Pool(2) as pool:
        hashes = pool.map(hash_of, [{"/rail/cart/hinge/pole.mass": 0.2}] * 4)
        of_model = pool.apply(hash_of_model, (model,))
    assert set(hashes) == {expected} and of_model == hash_of_model(model)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
def test_worlds_of_a_task_step_in_a_forked_process():
    pytest.importorskip("gymnasium")
    import sincro.gym

    envs = sincro.gym.make_vec("scenes/acrobot", 256, threads=2)
    envs.reset(seed=1)
    actions = np.ones(256, dtype=np.int64)
    envs.step(actions)
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            os.write(writing, envs.step(actions)[0].tobytes())
        finally:
            os._exit(0)
    with os.fdopen(reading, "rb") as pipe:
        os.close(writing)
        of_child = np.frombuffer(pipe.read(), dtype=np.float64)
    assert os.waitpid(child, 0)[1] == 0
    assert np.array_equal(of_child, envs.step(actions)[0].ravel())


@pytest.mark.skipif(not hasattr(os, "kill"), reason="needs signals")
@pytest.mark.parametrize("what", ["run", "step"])
def test_ctrl_c_ends_a_long_run(what):
    model = sincro.load(SCENE, duration=20_000.0, record_every=1000)
    timer = threading.Timer(0.4, lambda: os.kill(os.getpid(), signal.SIGINT))
    start = time.monotonic()
    # shells let what they start in the background ignore the signal
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            timer.start()
            if what == "run":
                model.run()
            else:
                model.step(steps=10**9)
    finally:
        signal.signal(signal.SIGINT, before)
    assert time.monotonic() - start < 5


def test_the_gil_is_released():
    model, count, over = sincro.load(SCENE, duration=400.0, record_every=100), [0], threading.Event()

    def counting():
        while not over.is_set():
            count[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=counting)
    thread.start()
    start = time.monotonic()
    model.run(error_bars=False)
    wall = time.monotonic() - start
    over.set()
    thread.join()
    assert count[0] > 50 * wall


def test_the_command_line_is_there(tmp_path):
    command = [sys.executable, "-m", "sincro"]
    out = tmp_path / "out"
    done = subprocess.run([*command, "run", SCENE, "--until", "0.5", "--out", out], capture_output=True, text=True)
    assert done.returncode in (0, 1), done.stderr
    assert (out / "report.html").is_file()
    refused = subprocess.run([*command, "run", "no-such-scene"], capture_output=True, text=True)
    assert refused.returncode == 2 and "error" in refused.stderr
    version = subprocess.run([*command, "--version"], capture_output=True, text=True)
    assert version.stdout.strip() == f"sincro {sincro.__version__}"
