"""Random calls by hypothesis: every one returns or raises an exception of ours; none ends the process."""

import os
from pathlib import Path

import numpy as np
import pytest

import sincro

hypothesis = pytest.importorskip("hypothesis")
from hypothesis import HealthCheck, given, settings  # noqa: E402
from hypothesis import strategies as st  # noqa: E402

# calls in each of the five tests; 10⁵ in all are made with SINCRO_RANDOM_CALLS=20000
CALLS = int(os.environ.get("SINCRO_RANDOM_CALLS", "1500"))
PER_EXAMPLE = 25
QUIET = dict(deadline=None, suppress_health_check=list(HealthCheck), database=None, derandomize=True)

numbers = st.one_of(
    st.floats(), st.integers(-3, 3), st.sampled_from([0.0, 1.0, np.nan, np.inf, 1e308, -1e-308, True, None, "1", b"x", 1j])
)
arrays = st.one_of(
    st.lists(numbers, max_size=4),
    st.lists(st.lists(numbers, max_size=3), max_size=3),
    st.builds(np.zeros, st.sampled_from([(), (1,), (2,), (3,), (2, 2), (0,), (1, 1)])),
    st.builds(
        lambda shape, kind: np.ones(shape, dtype=kind),
        st.sampled_from([(1,), (2,), (4,)]),
        st.sampled_from(["f4", "i8", "c16", "U3", "O", "?", "M8[s]", ">f8"]),
    ),
    st.builds(lambda n: np.arange(2.0 * n)[::2], st.integers(0, 3)),
    numbers,
    st.dictionaries(st.sampled_from(["/rail", "/rail.command", "", "x"]), numbers, max_size=2),
)
names = st.sampled_from(["/rail.position", "/rail", "", "/", "\0", "é", "/rail/cart", "force", "x" * 1000, 3, None])
anything = st.one_of(arrays, names, st.just(object()), st.just(Ellipsis), st.binary(max_size=4))

CALLABLE = {
    "step": (arrays, st.integers(-1, 5)),
    "set_state": (arrays, arrays),
    "set_pose": (names, arrays, arrays),
    "observe": (st.lists(names, max_size=3),),
    "__getitem__": (names,),
    "mass_matrix": (arrays,),
    "inverse_dynamics": (arrays, arrays, arrays),
    "forward_dynamics": (arrays, arrays, arrays),
    "forward_dynamics_derivatives": (arrays, arrays, arrays),
    "jacobian": (names, arrays),
    "restore": (anything,),
    "linearize": (st.sampled_from([None, 0.0, -1.0, np.nan, "x"]),),
    "_linearize_sampled": (st.sampled_from([None, 0.0, -1.0, np.nan, "x"]), st.just(False), st.lists(names, max_size=2)),
    "controller": (anything,),
    "reset": (),
    "release": (),
    "snapshot": (),
    "clear_controllers": (),
}
calls = st.lists(
    st.sampled_from(sorted(CALLABLE)).flatmap(lambda name: st.tuples(st.just(name), st.tuples(*CALLABLE[name]))),
    min_size=PER_EXAMPLE,
    max_size=PER_EXAMPLE,
)
EXPECTED = (sincro.SincroError, TypeError, OverflowError, ValueError)


@settings(max_examples=max(1, CALLS // PER_EXAMPLE), **QUIET)
@given(calls)
def test_models_survive_random_calls(sequence):
    model = MODEL.copy()
    for name, arguments in sequence:
        try:
            getattr(model, name)(*arguments)
        except EXPECTED as error:
            assert not isinstance(error, sincro.InternalError), (name, arguments, error)
    model.reset()
    model.clear_controllers()
    model.step()
    assert model.tick == 1


MODEL = None


@pytest.fixture(autouse=True, scope="module")
def a_model():
    global MODEL
    MODEL = sincro.load(scene("cart-pole-lqr"))
    yield
    MODEL = None


TASKS = ["cart-pole-balance", "quadrotor-hover"]
seeds = st.one_of(st.none(), st.integers(-2, 5), st.lists(st.integers(0, 9), max_size=4), numbers)


def scene(name):
    return Path(__file__).resolve().parents[3] / "scenes" / name


def refused():
    gymnasium = pytest.importorskip("gymnasium")
    return (*EXPECTED, gymnasium.error.Error)


def sequence_of(names, arguments):
    call = st.tuples(st.sampled_from(names), arguments, seeds)
    return st.lists(call, min_size=PER_EXAMPLE, max_size=PER_EXAMPLE)


def actions_of(n):
    """Actions for n worlds, right ones among them."""
    choices = st.lists(st.integers(-1, 2), min_size=n, max_size=n)
    forces = st.lists(st.lists(st.floats(-1, 1), min_size=4, max_size=4), min_size=n, max_size=n)
    return st.one_of(arrays, choices, forces)


@pytest.mark.parametrize("name", TASKS)
@settings(max_examples=max(1, CALLS // PER_EXAMPLE), **QUIET)
@given(sequence_of(["step", "step", "reset"], actions_of(3)), st.sampled_from(["NextStep", "SameStep", "Disabled"]))
def test_worlds_survive_random_calls(name, sequence, mode):
    pytest.importorskip("gymnasium")
    import sincro.gym

    envs = sincro.gym.make_vec(scene(name), 3, autoreset=mode, threads=1)
    shape = envs.observation_space.shape
    for call, argument, seed in sequence:
        try:
            if call == "step":
                observations, rewards, *_ = envs.step(argument)
                assert observations.shape == shape and np.isfinite(observations).all() and np.isfinite(rewards).all()
            else:
                envs.reset(seed=seed, options={"reset_mask": argument} if isinstance(argument, np.ndarray) else None)
        except refused() as error:
            assert not isinstance(error, sincro.InternalError), (call, argument, error)


@pytest.mark.parametrize("name", TASKS)
@settings(max_examples=max(1, CALLS // PER_EXAMPLE), **QUIET)
@given(sequence_of(["step", "step", "step", "reset", "render", "close"], st.one_of(actions_of(1), st.integers(0, 1))))
def test_single_worlds_survive_random_calls(name, sequence):
    pytest.importorskip("gymnasium")
    import sincro.gym

    env = sincro.gym.make(scene(name))
    for call, argument, seed in sequence:
        try:
            if call == "step":
                observation, reward, terminated, truncated, _ = env.step(argument)
                assert env.observation_space.contains(observation) and np.isfinite(reward)
                assert isinstance(terminated, bool) and isinstance(truncated, bool)
            elif call == "reset":
                env.reset(seed=seed)
            else:
                getattr(env, call)()
        except refused() as error:
            assert not isinstance(error, sincro.InternalError), (call, argument, error)


@settings(max_examples=100, **QUIET)
@given(anything, anything, st.one_of(st.none(), anything), st.one_of(anything, st.sampled_from([0, -1, 2])))
def test_environments_are_made_or_refused(count, settings_given, mode, threads):
    pytest.importorskip("gymnasium")
    import sincro.gym

    if isinstance(count, int) and count > 5:
        return
    keywords = {} if mode is None else {"autoreset": mode}
    for make in (
        lambda: sincro.gym.make_vec(scene(TASKS[0]), count, settings_given, threads=threads, **keywords),
        lambda: sincro.gym.make(scene(TASKS[0]), settings_given, render_mode=mode, camera=count),
        lambda: sincro.gym.make(settings_given),
    ):
        try:
            make()
        except (*refused(), AttributeError, OSError) as error:
            assert not isinstance(error, sincro.InternalError), error
