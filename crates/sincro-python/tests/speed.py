"""Figures of speed on this machine, as JSON: a step from Python, worlds of tasks, beside gymnasium's own."""

import json
import time

import gymnasium
import numpy as np

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


def steps_per_second(envs, seconds=1.0, repetitions=5):
    """Steps of worlds a second, actions drawn before."""
    envs.reset(seed=0)
    actions = [envs.action_space.sample() for _ in range(20)]
    counts = []
    for _ in range(repetitions):
        start, count = time.perf_counter(), 0
        while time.perf_counter() - start < seconds / repetitions:
            for action in actions:
                envs.step(action)
            count += len(actions)
        counts.append(count * envs.num_envs / (time.perf_counter() - start))
    return max(counts)


def main():
    found = {"step_us": step_overhead()}
    for name in ("cart-pole-balance", "cart-pole-swing-up", "acrobot", "reacher-springs", "quadrotor-hover"):
        found[name] = steps_per_second(sincro.gym.make_vec(f"scenes/{name}", 4096))
        found[name + ", one thread"] = steps_per_second(sincro.gym.make_vec(f"scenes/{name}", 4096, threads=1))
    found["gymnasium CartPole-v1, SyncVectorEnv of 16"] = steps_per_second(gymnasium.make_vec("CartPole-v1", 16, "sync"))
    arrays = gymnasium.make_vec("CartPole-v1", 4096, "vector_entry_point")
    found["gymnasium CartPole-v1, arrays of 4096"] = steps_per_second(arrays)
    print(json.dumps({name: np.round(value, 3) if isinstance(value, float) else value for name, value in found.items()}, indent=1))


if __name__ == "__main__":
    main()
