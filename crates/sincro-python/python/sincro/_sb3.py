"""Worlds of a task as an environment of stable-baselines3."""

from __future__ import annotations

import numpy as np
from stable_baselines3.common.vec_env import VecEnv

from ._errors import ArgumentError


class Sb3VecEnv(VecEnv):
    """Worlds of a task as a ``VecEnv``; made by :func:`sincro.gym.sb3_vec_env`."""

    def __init__(self, envs):
        self.envs = envs
        self._given = None
        super().__init__(envs.num_envs, envs.single_observation_space, envs.single_action_space)

    def reset(self):
        """Begins episodes with the seeds of ``seed()``, if there are any; returns the observations (num_envs, n)."""
        seeds = None if all(seed is None for seed in self._seeds) else self._seeds
        self._reset_seeds()
        self._reset_options()
        return self.envs.reset(seed=seeds)[0]

    def step_async(self, actions):
        """Takes the actions; ``step_wait`` steps."""
        self._given = actions

    def step_wait(self):
        """Steps; returns observations, rewards, ends and dictionaries with what the ended episodes saw last."""
        seen, rewards, terminated, truncated, info = self.envs.step(self._given)
        ended = terminated | truncated
        infos = [{} for _ in range(self.num_envs)]
        for k in np.flatnonzero(ended):
            infos[k]["terminal_observation"] = info["final_obs"][k]
            infos[k]["TimeLimit.truncated"] = bool(truncated[k] and not terminated[k])
        return seen, rewards, ended, infos

    def close(self):
        """Closes the model."""
        self.envs.close()

    def get_attr(self, attr_name, indices=None):
        """An attribute of the worlds, once for each index."""
        return [getattr(self.envs, attr_name)] * len(list(self._get_indices(indices)))

    def set_attr(self, attr_name, value, indices=None):
        """Refused: the worlds are one object."""
        raise ArgumentError("worlds of a task have no attributes of their own to be set")

    def env_method(self, method_name, *method_args, indices=None, **method_kwargs):
        """Refused: the worlds are one object."""
        raise ArgumentError("worlds of a task have no methods of their own")

    def env_is_wrapped(self, wrapper_class, indices=None):
        """False for each index."""
        return [False] * len(list(self._get_indices(indices)))
