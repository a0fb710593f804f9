"""Tasks of scenes as gymnasium environments.

A scene whose ``experiment.toml`` has a table ``[task]`` is an environment: observations, actions, reward and the end of
an episode are formulas in that file (docs/python.md). ``make`` gives one world, ``make_vec`` many at once, stepped in
lanes and threads. The same seeds give the same episodes on any number of worlds, lanes and threads.
"""

from __future__ import annotations

import numpy as np

try:
    import gymnasium
except ImportError as missing:
    raise ImportError("tasks need gymnasium: pip install 'gymnasium>=1.4'") from missing
from gymnasium import spaces
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from . import _sincro
from . import load as _load
from ._errors import ArgumentError

__all__ = ["SceneEnv", "SceneVectorEnv", "make", "make_vec", "sb3_vec_env"]

_MODES = {
    AutoresetMode.NEXT_STEP: "next-step",
    AutoresetMode.SAME_STEP: "same-step",
    AutoresetMode.DISABLED: "disabled",
}


def make(scene, settings=None, *, render_mode=None, camera=None, **experiment) -> SceneEnv:
    """The task of a scene as a ``gymnasium.Env``.

    ``scene``, ``settings``, ``experiment``: as for :func:`sincro.load`. ``render_mode``: ``rgb_array``, through ``camera``
    (a camera of the scene; the first one unless given).

    >>> import sincro.gym
    >>> env = sincro.gym.make("scenes/cart-pole-balance")
    >>> observation, info = env.reset(seed=1)
    >>> observation.shape
    (4,)
    """
    return SceneEnv(scene, settings, render_mode=render_mode, camera=camera, **experiment)


def make_vec(scene, num_envs, settings=None, *, autoreset=AutoresetMode.NEXT_STEP, threads=0, **experiment):
    """Many worlds of the task of a scene as a ``gymnasium.vector.VectorEnv``.

    ``autoreset``: what becomes of a world whose episode has ended (``gymnasium.vector.AutoresetMode``, or its value as a
    text). ``threads``: 0 takes one a processor.

    >>> import sincro.gym
    >>> envs = sincro.gym.make_vec("scenes/cart-pole-balance", 8)
    >>> observations, infos = envs.reset(seed=1)
    >>> observations.shape
    (8, 4)
    """
    return SceneVectorEnv(scene, num_envs, settings, autoreset=autoreset, threads=threads, **experiment)


def sb3_vec_env(envs):
    """Worlds of a task, made by ``make_vec(…, autoreset="SameStep")``, as a ``VecEnv`` of stable-baselines3.

    What an episode saw last is ``infos[k]["terminal_observation"]``, its end by the time limit
    ``infos[k]["TimeLimit.truncated"]``, as that library expects.
    """
    if not isinstance(envs, SceneVectorEnv) or envs.autoreset_mode is not AutoresetMode.SAME_STEP:
        raise ArgumentError('stable-baselines3 resets in the same step: give make_vec(…, autoreset="SameStep")')
    try:
        from ._sb3 import Sb3VecEnv
    except ImportError as missing:
        raise ImportError("this needs stable-baselines3: pip install stable-baselines3") from missing
    return Sb3VecEnv(envs)


class _Actions:
    """Action space of a task, and its numbers."""

    def __init__(self, actions):
        self.names = [name for name, _, _ in actions]
        ranges = [bounds for _, bounds, _ in actions]
        self.values = [None if values is None else np.array(values) for _, _, values in actions]
        discrete = [values is not None for values in self.values]
        if any(discrete) and not all(discrete):
            raise ArgumentError("a task whose actions are partly ranges and partly values has no gymnasium space")
        if all(discrete):
            sizes = [len(values) for values in self.values]
            self.space = spaces.Discrete(sizes[0]) if len(sizes) == 1 else spaces.MultiDiscrete(sizes)
        else:
            low, high = np.array(ranges, dtype=np.float64).T
            self.space = spaces.Box(low, high, dtype=np.float64)

    def step(self, worlds, actions, n, mode):
        """Steps n worlds by actions."""
        given = np.asarray(actions)
        shape = (n, len(self.names))
        if given.size != n * len(self.names):
            raise ArgumentError(f"the actions have the shape {given.shape}, {shape} is wanted")
        given = given.reshape(shape)
        if self.values[0] is None:
            if given.dtype.kind not in "fiu":
                raise ArgumentError(f"the actions are of type {given.dtype}, not real numbers")
            return worlds.step(given.astype(np.float64, copy=False), mode)
        if given.dtype.kind not in "iu":
            raise ArgumentError(f"the actions are of type {given.dtype}; they choose values by whole numbers")
        return worlds.step_chosen(given.astype(np.int64, copy=False), mode)


def _seed(generator) -> int:
    return int(generator.integers(0, 2**63))


class SceneEnv(gymnasium.Env):
    """The task of a scene as a ``gymnasium.Env``; made by :func:`make`.

    Observations are float64 arrays (n_observations,), actions those of ``action_space``. ``info["stopped"]`` is true where
    the world could not go on; such an episode is truncated.
    """

    metadata = {"render_modes": ["rgb_array"]}

    def __init__(self, scene, settings=None, /, *, render_mode=None, camera=None, **experiment):
        if render_mode not in (None, "rgb_array"):
            raise ArgumentError(f"there is no render mode {render_mode!r}; there is: rgb_array")
        self.model = _load(scene, settings, **experiment)
        self._worlds = _sincro.Worlds(self.model, 1, 1)
        self._actions = _Actions(self._worlds.actions)
        self.action_space = self._actions.space
        shape = (len(self._worlds.observations),)
        self.observation_space = spaces.Box(-np.inf, np.inf, shape, np.float64)
        self.render_mode, self._camera = render_mode, camera
        self.metadata = {**self.metadata, "render_fps": round(1.0 / self._worlds.period)}
        self._is_over = True

    def reset(self, *, seed=None, options=None):
        """Begins an episode; returns what the agent sees, and a dictionary."""
        super().reset(seed=seed)
        seed = seed if seed is not None else _seed(self.np_random)
        self._is_over = False
        return self._worlds.reset([seed], [True], None)[0], {}

    def step(self, action):
        """Steps by an action; returns observation, reward, terminated, truncated and a dictionary."""
        if self._is_over:
            raise ArgumentError("the episode is over, or has not begun: reset() first")
        seen, rewards, (terminated, truncated), stopped, _ = self._actions.step(self._worlds, action, 1, "disabled")
        self._is_over = bool(terminated[0] or truncated[0])
        info = {} if stopped is None else {"stopped": True}
        return seen[0], float(rewards[0]), bool(terminated[0]), bool(truncated[0]), info

    def render(self):
        """Picture of the world by a camera of the scene, (height, width, 3) uint8."""
        if self.render_mode is None:
            return None
        # cameras give their lowest row first
        return np.ascontiguousarray(self._worlds.picture(0, self._camera)[::-1])

    def close(self):
        """Closes the model."""
        self.model.close()


class SceneVectorEnv(VectorEnv):
    """Many worlds of the task of a scene; made by :func:`make_vec`.

    Observations are float64 arrays (num_envs, n_observations). World k of ``reset(seed=s)`` has the seed s + k. With
    ``SAME_STEP``, ``info["final_obs"]`` has the last observations of the episodes that ended (mask: ``_final_obs``).
    ``info["stopped"]`` is true where a world could not go on; its episode is truncated. With ``DISABLED``,
    ``reset(options={"reset_mask": mask})`` begins new episodes in the worlds of the mask.
    """

    def __init__(self, scene, num_envs, settings=None, /, *, autoreset=AutoresetMode.NEXT_STEP, threads=0, **experiment):
        self.model = _load(scene, settings, **experiment)
        self.num_envs = int(num_envs)
        self.autoreset_mode = AutoresetMode(autoreset)
        self._mode = _MODES[self.autoreset_mode]
        self._worlds = _sincro.Worlds(self.model, self.num_envs, threads)
        self._actions = _Actions(self._worlds.actions)
        shape = (len(self._worlds.observations),)
        self.single_action_space = self._actions.space
        self.single_observation_space = spaces.Box(-np.inf, np.inf, shape, np.float64)
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self.metadata = {"autoreset_mode": self.autoreset_mode, "render_modes": []}
        self.render_mode = None
        self._seen = None

    @property
    def runs_in_lanes(self) -> bool:
        """True if the worlds advance in the lanes of vector registers."""
        return self._worlds.lanes_refused is None

    @property
    def lanes_refused(self) -> str | None:
        """What in the scene keeps its worlds from the lanes; None if they are in lanes."""
        return self._worlds.lanes_refused

    @property
    def steps_alone(self) -> int:
        """Base steps that worlds in lanes have made by themselves, because a limit of a joint or a contact might act."""
        return self._worlds.steps_alone

    @property
    def compilation_refused(self) -> str | None:
        """Reason for steps that are not compiled by the system's C compiler; None if they are. The results are the same."""
        return self._worlds.compilation_refused

    def reset(self, *, seed=None, options=None):
        """Begins episodes; returns what the agents see, and a dictionary."""
        n = self.num_envs
        mask = (options or {}).get("reset_mask")
        mask = np.ones(n, dtype=bool) if mask is None else np.asarray(mask)
        if mask.shape != (n,) or mask.dtype != bool:
            raise ArgumentError(f"`reset_mask` is an array of {n} truth values")
        if self._seen is None and not mask.all():
            raise ArgumentError("the first reset is of all worlds")
        if isinstance(seed, (int, np.integer)):
            super().reset(seed=int(seed))
            seeds = [int(seed) + k for k in range(n)]
        elif seed is not None:
            seeds = [None if s is None else int(s) for s in seed]
            if len(seeds) != n:
                raise ArgumentError(f"there are {len(seeds)} seeds for {n} worlds")
        elif self._seen is None:
            seeds = [_seed(self.np_random) for _ in range(n)]
        else:
            seeds = [None] * n
        if any(s is not None and not 0 <= s < 2**64 for s in seeds):
            raise ArgumentError("seeds are whole numbers from 0 to 2**64 - 1")
        self._seen = self._worlds.reset(seeds, mask.tolist(), self._seen)
        return self._seen.copy(), {}

    def step(self, actions):
        """Steps all worlds; returns observations, rewards, terminations, truncations and a dictionary."""
        if self._seen is None:
            raise ArgumentError("the episodes have not begun: reset() first")
        results = self._actions.step(self._worlds, actions, self.num_envs, self._mode)
        seen, rewards, (terminated, truncated), stopped, finals = results
        self._seen = seen
        info = {}
        if finals is not None:
            ended = terminated | truncated
            kept = np.empty(self.num_envs, dtype=object)
            for k in np.flatnonzero(ended):
                kept[k] = finals[k]
            info = {"final_obs": kept, "_final_obs": ended, "final_info": {}, "_final_info": ended.copy()}
        if stopped is not None:
            info["stopped"], info["_stopped"] = stopped, stopped.copy()
        return seen.copy() if self._mode == "disabled" else seen, rewards, terminated, truncated, info

    def close_extras(self, **kwargs):
        """Closes the model."""
        self.model.close()
