"""PPO of stable-baselines3 on tasks in the box: balances the pole within 60 s and hovers the quadrotor.

Run by `cargo xtask judge learning`. Usage: learning.py CURVES.csv, at the root of the repository; writes the learning
curves of docs/notebooks/learning-to-hover.ipynb.
"""

import csv
import sys
import time
from pathlib import Path

import numpy as np
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.vec_env import VecMonitor

import sincro.gym

# return from which on gymnasium calls CartPole-v1 solved
SOLVED = 475.0
MAX_SECONDS = 60.0
# largest median distance to the point at the end of an episode [m]; a goal is up to 1.5 m away
MAX_DISTANCE = 0.1
EPISODES = 100
# steps of all worlds, steps between two points of a curve
CART_POLE = (100_000, 12_800)
HOVER = (655_360, 40_960)


def worlds(scene, n):
    return VecMonitor(sincro.gym.sb3_vec_env(sincro.gym.make_vec(scene, n, autoreset="SameStep")))


def cart_pole(seed):
    return PPO(
        "MlpPolicy", worlds("scenes/cart-pole-balance", 32), n_steps=32, batch_size=256, n_epochs=20, gae_lambda=0.8,
        gamma=0.98, learning_rate=1e-3, seed=seed, device="cpu",
    )  # fmt: skip


def hover(seed):
    return PPO(
        "MlpPolicy", worlds("scenes/quadrotor-hover", 64), n_steps=128, batch_size=1024, n_epochs=10,
        learning_rate=lambda left: 1e-3 * left, seed=seed, device="cpu",
    )  # fmt: skip


def evaluate(model, scene):
    """Returns of episodes that learning has not seen, last observations, and those that were terminated."""
    envs = sincro.gym.make_vec(scene, EPISODES, autoreset="Disabled")
    seen, _ = envs.reset(seed=1_000_000)
    returns, last, failed = np.zeros(EPISODES), seen.copy(), np.zeros(EPISODES, bool)
    alive = np.ones(EPISODES, bool)
    while alive.any():
        seen, rewards, terminated, truncated, _ = envs.step(model.predict(seen, deterministic=True)[0])
        returns += rewards * alive
        last[alive] = seen[alive]
        failed |= terminated & alive
        alive &= ~(terminated | truncated)
    return returns, last, failed


class Curve(BaseCallback):
    """Evaluates the policy between rollouts; rows of the learning curve, and the time of learning to SOLVED [s]."""

    def __init__(self, scene, every):
        super().__init__()
        self.scene, self.every = scene, every
        self.rows, self.solved = [], None

    def _on_training_start(self):
        self.began, self.next = time.perf_counter(), self.every

    def _on_step(self):
        return True

    def _on_rollout_end(self):
        if self.num_timesteps >= self.next:
            self.next += self.every
            self.look()

    def look(self):
        before = time.perf_counter()
        returns, last, failed = evaluate(self.model, self.scene)
        if self.solved is None and returns.mean() >= SOLVED:
            self.solved = before - self.began
        distance = np.median(np.linalg.norm(last[:, :3], axis=1)) if "quadrotor" in self.scene else np.nan
        found = [returns.mean(), returns.min(), int(failed.sum()), distance]
        row = [self.num_timesteps, *(round(float(x), 4) for x in found)]
        self.rows.append(row)
        print(f"{self.scene}: {row}, {before - self.began:.1f} s", flush=True)
        # what looking takes is not learning
        self.began += time.perf_counter() - before


def learn(make, scene, seed, total, every):
    curve = Curve(scene, every)
    make(seed).learn(total, callback=curve)
    if curve.rows[-1][0] != curve.num_timesteps:
        curve.look()
    return curve


def adapter_is_sound():
    """Ends by the time limit are told from others, and the seeds of worlds are those of `make_vec`."""
    task = ("scenes/quadrotor-hover", 3, {"task.time_limit": 1.0})
    envs = sincro.gym.make_vec(*task, autoreset="SameStep")
    wrapped = sincro.gym.sb3_vec_env(envs)
    wrapped.seed(7)
    seen = wrapped.reset()
    twin = sincro.gym.make_vec(*task, autoreset="SameStep")
    assert np.array_equal(seen, twin.reset(seed=7)[0])
    ends = []
    for _ in range(150):
        action = np.zeros((3, 4))
        action[0, 1] = 1.0  # tips over
        seen, rewards, ended, infos = wrapped.step(action)
        expected, _, terminated, truncated, info = twin.step(action)
        assert np.array_equal(seen, expected) and np.array_equal(ended, terminated | truncated)
        for k in np.flatnonzero(ended):
            assert np.array_equal(infos[k]["terminal_observation"], info["final_obs"][k])
            assert infos[k]["TimeLimit.truncated"] == bool(truncated[k])
            ends.append((k, infos[k]["TimeLimit.truncated"]))
    assert (0, False) in ends and (1, True) in ends, ends
    for mode in ("NextStep", "Disabled"):
        try:
            sincro.gym.sb3_vec_env(sincro.gym.make_vec("scenes/cart-pole-balance", 2, autoreset=mode))
        except sincro.ArgumentError:
            continue
        raise AssertionError(f"{mode} is refused")


def main():
    torch.set_num_threads(1)
    adapter_is_sound()
    table = []
    for make, scene, (total, every) in (
        (cart_pole, "scenes/cart-pole-balance", CART_POLE),
        (hover, "scenes/quadrotor-hover", HOVER),
    ):
        for seed in range(3):
            curve = learn(make, scene, seed, total, every)
            table += [[Path(scene).name, seed, *row] for row in curve.rows]
            if make is cart_pole:
                assert curve.solved is not None and curve.solved <= MAX_SECONDS, curve.solved
                print(f"seed {seed}: {SOLVED:.0f} and more after {curve.solved:.1f} s")
            else:
                *_, failed, distance = curve.rows[-1]
                assert failed == 0 and distance <= MAX_DISTANCE, curve.rows[-1]
    with open(sys.argv[1], "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["task", "seed", "steps", "return_mean", "return_min", "terminated_of_100", "distance_median_m"])
        writer.writerows(table)


if __name__ == "__main__":
    main()
