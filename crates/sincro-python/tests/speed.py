"""Figures of speed on this machine, as JSON: a step from Python, worlds of tasks, beside gymnasium's own and MuJoCo's.

Ratios are of figures that were taken in turns in one run. MuJoCo's need `pip install "gymnasium[mujoco]"`.
"""

import json
import time

import gymnasium

import sincro
import sincro.gym


def best(function, repetitions=10):
    times = []
    for _ in range(repetitions):
        start = time.perf_counter()
        function()
        times.append(time.perf_counter() - start)
    return min(times)


def step_overhead(n=20_000):
    """Time of a call of `step` beyond that of a step in Rust [µs]."""
    model = sincro.load("scenes/cart-pole-lqr", integrator="rk4")

    def one_by_one():
        model.reset()
        model.step()
        step = model.step
        for _ in range(n):
            step()

    def at_once():
        model.reset()
        model.step()
        model.step(steps=n)

    return {"one": 1e6 * best(one_by_one) / n, "in_rust": 1e6 * best(at_once) / n}


def steps_per_second(envs, seconds=0.2):
    """Steps of worlds a second, over at least that time; actions are drawn before."""
    actions = [envs.action_space.sample() for _ in range(20)]
    start, count = time.perf_counter(), 0
    while time.perf_counter() - start < seconds:
        for action in actions:
            envs.step(action)
        count += len(actions)
    return count * envs.num_envs / (time.perf_counter() - start)


def side_by_side(all_envs, repetitions=5):
    """The best figure of each of several environments, which take turns."""
    for envs in all_envs.values():
        envs.reset(seed=0)
    counts = {name: [] for name in all_envs}
    for _ in range(repetitions):
        for name, envs in all_envs.items():
            counts[name].append(steps_per_second(envs))
    return {name: max(found) for name, found in counts.items()}


# gymnasium's environment, ours, and the least ratio: worlds one by one, and all of them in arrays
PAIRS = [
    ("CartPole-v1", "sync", "cart-pole-balance", 20),
    ("CartPole-v1", "vector_entry_point", "cart-pole-balance", 2),
    ("InvertedPendulum-v5", "sync", "cart-pole-balance", 20),
    ("Reacher-v5", "sync", "reacher-springs", 20),
]
WORLDS = {"sync": 16, "vector_entry_point": 4096}


def ratios(n=4096):
    """Our steps of worlds a second over gymnasium's, in one process each."""
    found = {}
    for theirs, how, ours, least in PAIRS:
        try:
            peer = gymnasium.make_vec(theirs, WORLDS[how], how)
        except gymnasium.error.DependencyNotInstalled as missing:
            found[theirs] = str(missing)
            continue
        envs = {
            "gymnasium": peer,
            "sincro": sincro.gym.make_vec(f"scenes/{ours}", n),
            "sincro, one thread": sincro.gym.make_vec(f"scenes/{ours}", n, threads=1),
        }
        counts = side_by_side(envs)
        counts["ratio"] = counts["sincro"] / counts["gymnasium"]
        counts["least"] = least
        found[f"{ours} beside {theirs}, {how} of {WORLDS[how]}"] = counts
    return found


TASKS = ("cart-pole-balance", "cart-pole-swing-up", "acrobot", "reacher-springs", "quadrotor-hover")


def rounded(value):
    if isinstance(value, dict):
        return {name: rounded(entry) for name, entry in value.items()}
    return round(value, 3) if isinstance(value, float) else value


def main():
    found = {"step_us": step_overhead()}
    for name in TASKS:
        envs = {"all threads": sincro.gym.make_vec(f"scenes/{name}", 4096)}
        envs["one thread"] = sincro.gym.make_vec(f"scenes/{name}", 4096, threads=1)
        found[name] = side_by_side(envs)
    found["ratios"] = ratios()
    print(json.dumps(rounded(found), indent=1))


if __name__ == "__main__":
    main()
