"""Tasks: gymnasium's checks, seeds, autoreset, lanes against lock-steps, wrong calls."""

import os
import shutil
import warnings

import numpy as np
import pytest

import sincro

gymnasium = pytest.importorskip("gymnasium")
import sincro.gym  # noqa: E402
from gymnasium.utils.env_checker import check_env  # noqa: E402
from gymnasium.vector import AutoresetMode  # noqa: E402

TASKS = ["cart-pole-balance", "cart-pole-swing-up", "acrobot", "reacher-springs", "quadrotor-hover"]


def scene(name):
    return f"scenes/{name}"


def actions_for(envs, steps, seed=0):
    envs.action_space.seed(seed)
    return [envs.action_space.sample() for _ in range(steps)]


def episodes(envs, actions, seed=3):
    seen = [envs.reset(seed=seed)[0].copy()]
    rest = []
    for action in actions:
        observations, rewards, terminated, truncated, _ = envs.step(action)
        seen.append(observations.copy())
        rest.append(np.stack([rewards, terminated, truncated]))
    return np.array(seen), np.array(rest)


@pytest.mark.parametrize("name", TASKS)
def test_gymnasium_has_nothing_to_say(name):
    env = sincro.gym.make(scene(name), render_mode="rgb_array")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        # observations are not bounded, which gymnasium remarks on
        warnings.filterwarnings("ignore", message=".*-infinity.*|.*infinity.*|.*symmetric and normalized.*")
        warnings.filterwarnings("ignore", message=".*not within the.*|.*spec.*")
        check_env(env, skip_render_check=True)
    assert env.render().shape == (360, 480, 3) and env.render().std() > 1


@pytest.mark.parametrize("name", TASKS)
@pytest.mark.parametrize("mode", list(AutoresetMode))
def test_worlds_are_what_gymnasium_makes_of_single_ones(name, mode):
    n = 4
    ours = sincro.gym.make_vec(scene(name), n, autoreset=mode)
    single = [lambda: sincro.gym.make(scene(name))] * n
    theirs = gymnasium.vector.SyncVectorEnv(single, autoreset_mode=mode)
    for space in ("single_observation_space", "single_action_space", "observation_space", "action_space"):
        assert getattr(ours, space) == getattr(theirs, space)
    seen = [envs.reset(seed=21)[0] for envs in (ours, theirs)]
    assert np.array_equal(*seen) and ours.observation_space.contains(seen[0])
    alive, before = np.ones(n, dtype=bool), seen[0]
    for action in actions_for(ours, 150):
        kept = before.copy()
        (a, rewards, *ends, info), (b, their_rewards, *their_ends, their_info) = (envs.step(action) for envs in (ours, theirs))
        # what was returned before is not written to
        assert np.array_equal(before, kept)
        before = a
        assert a.dtype == b.dtype and rewards.dtype == their_rewards.dtype and ends[0].dtype == their_ends[0].dtype
        over = ends[0] | ends[1]
        for x, y in zip((rewards, *ends), (their_rewards, *their_ends), strict=True):
            assert x.shape == (n,) and np.array_equal(x[alive], y[alive])
        if mode is AutoresetMode.SAME_STEP:
            for k in np.flatnonzero(over & alive):
                assert info["_final_obs"][k] and their_info["_final_obs"][k]
                assert np.array_equal(info["final_obs"][k], their_info["final_obs"][k])
        else:
            assert np.array_equal(a[alive], b[alive])
        # only the first episodes are the same: gymnasium begins the next ones without a seed
        alive &= ~over
        if not alive.any() or (mode is AutoresetMode.DISABLED and over.any()):
            break


@pytest.mark.parametrize("name", TASKS)
def test_wrappers_of_gymnasium_work(name):
    from gymnasium.wrappers import vector as wrappers

    short = (scene(name), 3, {"task.time_limit": 1.0})
    envs = wrappers.DictInfoToList(wrappers.RecordEpisodeStatistics(sincro.gym.make_vec(*short, autoreset="SameStep")))
    envs.reset(seed=0)
    ended = []
    for action in actions_for(envs, 60):
        _, _, terminated, truncated, infos = envs.step(action)
        for k in np.flatnonzero(terminated | truncated):
            assert infos[k]["final_obs"].shape == envs.single_observation_space.shape
            ended.append(infos[k]["episode"]["l"])
    assert len(ended) >= 3 and max(ended) <= 50
    normal = wrappers.NormalizeReward(wrappers.NormalizeObservation(sincro.gym.make_vec(*short)))
    normal.reset(seed=0)
    seen = np.array([normal.step(action)[0] for action in actions_for(normal, 60)])
    assert np.isfinite(seen).all() and seen.dtype.kind == "f"


def test_pictures_are_the_right_way_up():
    env = sincro.gym.make(scene("cart-pole-balance"), render_mode="rgb_array")
    env.reset(seed=0)
    picture = env.render().astype(int)
    # the pole is brown, the cart is not
    is_pole = (picture[..., 0] - picture[..., 2] > 40).nonzero()[0]
    is_cart = ((picture.sum(axis=2) < 500) & (picture[..., 0] <= picture[..., 2])).nonzero()[0]
    assert is_pole.size and is_cart.size and is_pole.mean() < is_cart.mean()


@pytest.mark.parametrize("name", TASKS)
@pytest.mark.parametrize("mode", list(AutoresetMode))
def test_worlds_do_not_depend_on_lanes_threads_and_neighbours(name, mode):
    many = sincro.gym.make_vec(scene(name), 19, autoreset=mode, threads=3)
    assert many.runs_in_lanes, many.lanes_refused
    actions = actions_for(many, 120)
    seen, rest = episodes(many, actions)
    few = sincro.gym.make_vec(scene(name), 5, autoreset=mode, threads=1)
    seen_few, rest_few = episodes(few, [action[:5] for action in actions])
    assert np.array_equal(seen[:, :5], seen_few) and np.array_equal(rest[:, :, :5], rest_few)


@pytest.mark.parametrize("name", TASKS)
def test_compiled_worlds_have_the_bits_of_others(name):
    many = sincro.gym.make_vec(scene(name), 260, autoreset="SameStep")
    if shutil.which("cc") and "SINCRO_COMPILE" not in os.environ:
        assert (many.compilation_refused is None) == (name != "quadrotor-hover"), many.compilation_refused
    actions = actions_for(many, 120)
    seen, rest = episodes(many, actions)
    few = sincro.gym.make_vec(scene(name), 5, autoreset="SameStep")
    assert few.compilation_refused
    seen_few, rest_few = episodes(few, [action[:5] for action in actions])
    assert np.array_equal(seen[:, :5], seen_few) and np.array_equal(rest[:, :, :5], rest_few)


def test_lanes_have_the_bits_of_lock_steps(tmp_path):
    for name in TASKS:
        folder = tmp_path / name
        shutil.copytree(scene(name), folder)
        text = (folder / "experiment.toml").read_text()
        # a number that is drawn and always the same keeps the lanes away
        text += '\n[[task.random]]\npath = "gravity.1"\nrange = [0.0, 0.0]\n'
        (folder / "experiment.toml").write_text(text)
        lanes, single = (sincro.gym.make_vec(path, 4) for path in (scene(name), folder))
        assert lanes.runs_in_lanes and not single.runs_in_lanes
        actions = actions_for(lanes, 60)
        (seen, rest), (seen_single, rest_single) = episodes(lanes, actions), episodes(single, actions)
        assert np.array_equal(seen, seen_single), name
        assert np.array_equal(rest, rest_single), name


def test_one_world_is_the_first_of_many():
    env, envs = sincro.gym.make(scene("acrobot")), sincro.gym.make_vec(scene("acrobot"), 2)
    one, _ = env.reset(seed=11)
    many, _ = envs.reset(seed=11)
    assert np.array_equal(one, many[0]) and not np.array_equal(many[0], many[1])
    for action in (0, 2, 1):
        one, reward, *_ = env.step(action)
        many, rewards, *_ = envs.step(np.array([action, 0]))
        assert np.array_equal(one, many[0]) and reward == rewards[0]


def test_autoreset_modes_differ_as_gymnasium_says():
    push = np.array([1, 1])
    runs = {}
    for mode in AutoresetMode:
        envs = sincro.gym.make_vec(scene("cart-pole-balance"), 2, autoreset=mode)
        envs.reset(seed=0)
        for count in range(1, 100):
            observations, rewards, terminated, truncated, info = envs.step(push)
            if terminated[0]:
                break
        runs[mode] = (count, observations[0], info)
        assert rewards[0] == 1.0 and not truncated[0]
        after, rewards, terminated, _, _ = envs.step(push)
        if mode is AutoresetMode.NEXT_STEP:
            assert rewards[0] == 0.0 and not terminated[0] and np.abs(after[0]).max() <= 0.05
        if mode is AutoresetMode.DISABLED:
            assert np.array_equal(after[0], observations[0]) and not terminated[0]
            again, _ = envs.reset(options={"reset_mask": np.array([True, False])})
            assert np.abs(again[0]).max() <= 0.05 and np.array_equal(again[1], after[1])
    counts = {count for count, _, _ in runs.values()}
    assert len(counts) == 1
    same = runs[AutoresetMode.SAME_STEP]
    final = same[2]["final_obs"][0]
    assert same[2]["_final_obs"][0] and np.array_equal(final, runs[AutoresetMode.DISABLED][1])
    assert np.abs(same[1]).max() <= 0.05


def test_cart_pole_has_the_episodes_of_gymnasium():
    ours = sincro.gym.make(scene("cart-pole-balance"))
    theirs = gymnasium.make("CartPole-v1").unwrapped
    theirs.kinematics_integrator = "semi-implicit euler"
    generator = np.random.default_rng(5)
    lengths = []
    for episode in range(50):
        observation, _ = ours.reset(seed=episode)
        theirs.reset(seed=0)
        theirs.state = tuple(observation)
        actions = generator.integers(0, 2, 500)
        pair = []
        for env in (ours, theirs):
            for count, action in enumerate(actions, 1):
                result = env.step(int(action))
                if result[2] or count == 500:
                    break
            pair.append(count)
            last = result[0]
        lengths.append(pair)
    assert all(a == b for a, b in lengths), lengths


def test_arrays_of_cart_poles_have_the_episodes_of_gymnasium():
    n = 300
    ours = sincro.gym.make_vec(scene("cart-pole-balance"), n)
    theirs = gymnasium.make_vec("CartPole-v1", n, "vector_entry_point").unwrapped
    theirs.kinematics_integrator = "semi-implicit euler"
    observations, _ = ours.reset(seed=8)
    theirs.reset(seed=0)
    theirs.state = observations.T.copy()
    generator = np.random.default_rng(2)
    # the worlds do not hear of each other, so roundings grow by exp(4 t) and more: episodes of up to 5 s are compared
    steps = 250
    results, seen = [], observations
    for _ in range(steps):
        x, v, q, w = seen.T
        noise = 0.4 * generator.standard_normal(n)
        action = (q + 0.5 * w + 0.05 * x + 0.1 * v + noise > 0).astype(np.int64)
        stepped = [envs.step(action) for envs in (ours, theirs)]
        results.append([np.stack(parts[1:4]) for parts in stepped])
        seen = stepped[0][0]
    rewards, terminated, truncated = np.array(results).transpose(2, 1, 0, 3)
    lengths = [np.where(t.any(0), t.argmax(0) + 1, steps + 1) for t in terminated > 0]
    # the first episode of each world: after it, each draws a start of its own
    during = np.arange(steps)[:, None] < lengths[0]
    assert np.array_equal(*lengths) and not truncated.any()
    assert np.array_equal(*(rewards * during).sum(1))
    assert np.unique(lengths[0]).size > 50 and np.median(lengths[0]) > 50


def test_randomised_parameters_are_drawn_by_episode(tmp_path):
    folder = tmp_path / "cart"
    shutil.copytree(scene("cart-pole-balance"), folder)
    with (folder / "experiment.toml").open("a") as file:
        file.write('\n[[task.random]]\npath = "/rail/cart/hinge/pole.mass"\nrange = [0.05, 0.5]\n')
    envs = sincro.gym.make_vec(folder, 3, threads=2)
    assert "drawn" in envs.lanes_refused
    actions = actions_for(envs, 50)
    first, second = episodes(envs, actions), episodes(envs, actions)
    assert np.array_equal(first[0], second[0])
    plain = sincro.gym.make_vec(scene("cart-pole-balance"), 3)
    assert not np.array_equal(episodes(plain, actions)[0][1:], first[0][1:])


@pytest.mark.parametrize(
    "action", [np.array([np.nan] * 4), np.zeros(3), "text", None, np.zeros((2, 4)), np.full(4, np.inf), np.zeros(4, complex)]
)
def test_wrong_actions_are_refused(action):
    env = sincro.gym.make(scene("quadrotor-hover"))
    env.reset(seed=0)
    with pytest.raises(sincro.SincroError):
        env.step(action)


@pytest.mark.parametrize("mode", [AutoresetMode.NEXT_STEP, AutoresetMode.DISABLED])
def test_stable_baselines_takes_worlds_that_reset_in_the_same_step(mode):
    with pytest.raises(sincro.ArgumentError, match="SameStep"):
        sincro.gym.sb3_vec_env(sincro.gym.make_vec(scene("acrobot"), 2, autoreset=mode))
    with pytest.raises(sincro.ArgumentError, match="make_vec"):
        sincro.gym.sb3_vec_env(sincro.gym.make(scene("acrobot")))


@pytest.mark.parametrize("action", [2, -1, 0.5, np.array([0, 1]), None])
def test_wrong_choices_are_refused(action):
    env = sincro.gym.make(scene("cart-pole-balance"))
    with pytest.raises(sincro.ArgumentError, match="reset"):
        env.step(0)
    env.reset(seed=0)
    with pytest.raises(sincro.SincroError):
        env.step(action)


def test_tasks_are_checked_when_the_scene_is_loaded(tmp_path):
    wrong = [
        ('reward = "1"', 'reward = "1 + nothing"', "unknown name `nothing`"),
        ('command = "/rail"', 'command = "/rial"', "there is no command `/rial`"),
        ('x = "/rail.position", v', 'x = "/rail.positon", v', "there is no signal `/rail.positon`"),
        ('signal = "/rail.velocity"', 'signal = "/rail.motor_torque"', "cannot start with"),
        ("values = [-10.0, 10.0]", "range = [1.0, 1.0]", "empty or unbounded"),
        ("time_limit = 10.0", "time_limit = 10.0\nperiod = 0.03", "no whole multiple"),
        ('name = "push"', 'name = "x"', "cannot be a name here"),
    ]
    for k, (old, new, message) in enumerate(wrong):
        folder = tmp_path / str(k)
        shutil.copytree(scene("cart-pole-balance"), folder)
        text = (folder / "experiment.toml").read_text()
        assert old in text
        (folder / "experiment.toml").write_text(text.replace(old, new, 1))
        with pytest.raises(sincro.SceneError, match=message) as caught:
            sincro.load(folder)
        assert caught.value.diagnostics[0]["line"] > 1


def test_a_scene_without_a_task_says_so():
    with pytest.raises(sincro.SceneError, match="no task"):
        sincro.gym.make("scenes/spring-dynamic")


def test_arrays_that_are_held_are_never_written_again():
    envs = sincro.gym.make_vec(scene("cart-pole-balance"), 16)
    seen, _ = envs.reset(seed=3)
    held, copies = [seen], [seen.copy()]
    for k in range(20):
        seen, rewards, terminated, truncated, _ = envs.step(np.full(16, k % 2))
        if k % 3 == 0:
            # a view alone keeps its array, too
            held += [seen[2:5, 1], rewards, terminated]
            copies += [seen[2:5, 1].copy(), rewards.copy(), terminated.copy()]
    assert all(np.array_equal(a, b) for a, b in zip(held, copies))
