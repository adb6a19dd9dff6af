# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Many runs that advance together, sample by sample, for learning."""

from __future__ import annotations

import functools
import math
import operator
import threading
from numbers import Integral
from typing import Any, Callable, Dict, List, Mapping, Optional, Tuple, TypeVar, Union

import numpy as np

from . import _bbsim
from ._result import Result
from ._scenario import Array, Scenario, Settings, as_yaml, given, numbers, refuse, require

_EnvBase: Any = object
_VectorBase: Any = object
try:
    import gymnasium
    from gymnasium.spaces import Box

    _EnvBase, _VectorBase = gymnasium.Env, gymnasium.vector.VectorEnv
except ImportError:
    gymnasium = None

    class Box:  # type: ignore[no-redef]
        """The parts of gymnasium.spaces.Box that an environment needs."""

        def __init__(self, low: Any, high: Any, shape: Optional[Tuple[int, ...]] = None, dtype: Any = np.float64) -> None:
            self.low, self.high = (np.full(shape or np.shape(low), end, dtype) for end in (low, high))
            self.shape, self.dtype = self.low.shape, self.low.dtype
            self.seed()

        def seed(self, seed: Optional[int] = None) -> None:
            self._random = np.random.default_rng(seed)

        def sample(self) -> Any:
            ends = (np.nan_to_num(end, neginf=-1, posinf=1) for end in (self.low, self.high))
            return self._random.uniform(*ends).astype(self.dtype)

        def contains(self, value: Any) -> bool:
            array = np.asarray(value)
            return array.shape == self.shape and bool(np.all(array >= self.low) and np.all(array <= self.high))

        __contains__ = contains


Distribution = Union[Tuple[float, float], Callable[[np.random.Generator], Any]]
Reward = Callable[[Array, Array, Array], Array]
_Options = Optional[Mapping[str, Any]]

_MOST_SEED = 2**53  # the largest seed of a scenario
_MOST_RUNS = 2**20

_Method = TypeVar("_Method", bound=Callable[..., Any])


def _one_at_a_time(method: _Method) -> _Method:
    """Refuses a call while another one of the same environment has not returned."""

    @functools.wraps(method)
    def turn(self: "VectorEnv", *args: Any, **rest: Any) -> Any:
        if not self._turn.acquire(blocking=False):
            raise RuntimeError(f"{method.__name__}: found within another call; allowed: one call of an environment at a time")
        try:
            return method(self, *args, **rest)
        finally:
            self._turn.release()

    return turn  # type: ignore[return-value]


def _generator(seed: Any) -> np.random.Generator:
    try:
        return np.random.default_rng(seed)
    except ValueError:
        raise refuse("seed", seed, "a whole number from 0 up") from None


def _require_range(key: str, found: Any) -> None:
    try:
        low, high = map(float, found)
    except (TypeError, ValueError):
        low = high = math.nan
    if not -math.inf < low <= high < math.inf:
        allowed = "(low, high), two numbers in SI units with low <= high, or a function of a numpy Generator"
        raise refuse(key, f"{found!r} in randomize", allowed)


class VectorEnv(_VectorBase):
    """``n`` runs of a scenario with Gymnasium's API of vector environments.

    An action has the commands for phi and theta of each run, an array of shape (n, 2), in ``command_unit``. A step is a
    sample of the controller, and an episode is a run: truncated at ``time.end``, terminated if an event or a failure
    ends it earlier. The step after the end begins the next episode, with a reward of zero. One call at a time.

    randomize  {KEY: (low, high)}: drawn uniformly for each episode; or a function of a numpy Generator
    reward     a function of the arrays observations, actions and terminated that returns an array of n; by default
               minus the squared distance of the measured ball from its reference, m^2, and more at a termination
    record     keeps the rows of each episode for ``result()``
    """

    metadata: Dict[str, Any] = {"render_modes": [], "autoreset_mode": "NextStep"}
    observation_columns: List[Tuple[str, str, str]] = _bbsim.OBSERVATIONS  # name, unit and meaning of each
    render_mode, spec, closed = None, None, False

    def __init__(self, scenario: Scenario, n: int, randomize: Optional[Mapping[str, Distribution]] = None,
                 seed: int = 0, *, set: Settings = None, reward: Optional[Reward] = None,
                 record: bool = False) -> None:  # fmt: skip
        allowed = f"a whole number from 1 to {_MOST_RUNS}"
        count = int(require("n", n, Integral, allowed))
        if not 1 <= count <= _MOST_RUNS:
            raise refuse("n", n, allowed)
        draws = require("randomize", {} if randomize is None else randomize, Mapping, "a dict such as {'gravity': (9, 10)}")
        for key, distribution in draws.items():
            if not callable(distribution):
                _require_range(key, distribution)
        modes = gymnasium and getattr(gymnasium.vector, "AutoresetMode", None)  # from Gymnasium 1.1 on
        if modes is not None:
            self.metadata = {**self.metadata, "autoreset_mode": modes.NEXT_STEP}
        self.num_envs, self._randomize, self._reward = count, dict(draws), reward
        self._turn = threading.Lock()
        self._runs = _bbsim.Environments(given(scenario, set), count, list(self._randomize), record)
        self.command_unit: str = self._runs.command_unit  # of an action: rad, rad/s^2, N m or V
        self._random = _generator(seed)
        self._options: Dict[str, Any] = {}
        self._over, self._begun = np.zeros((2, count), dtype=bool)
        width = len(self.observation_columns)
        limit = np.fmin(np.array(self._runs.limits, float), np.inf)  # None is unlimited
        limits = np.tile(limit, (count, 1))
        self.single_observation_space = Box(-np.inf, np.inf, (width,), np.float64)
        self.observation_space = Box(-np.inf, np.inf, (count, width), np.float64)
        self.single_action_space = Box(-limit, limit, dtype=np.float64)
        self.action_space = Box(-limits, limits, dtype=np.float64)

    def _beginnings(self, which: Array, random: np.random.Generator, options: Mapping[str, Any]) -> Any:
        """The runs, and what is drawn for the new episode of each: values and a seed."""
        made = []
        for _ in which:
            drawn = {key: its(random) if callable(its) else random.uniform(*its) for key, its in self._randomize.items()}
            values = [as_yaml(options.get(key, value)) for key, value in drawn.items()]
            made.append((values, int(random.integers(_MOST_SEED))))
        return which.tolist(), made

    @_one_at_a_time
    def reset(self, *, seed: Optional[int] = None, options: _Options = None) -> Tuple[Array, Dict[str, Any]]:
        """Begins an episode of each run, or of those of ``{"reset_mask": mask}``. Other ``options`` fix values of keys
        of ``randomize`` until the next ``reset()``. A reset that raises changes no run."""
        random = self._random if seed is None else _generator(seed)
        fixed = dict(options or {})
        mask = fixed.pop("reset_mask", None)
        flags = np.full(self.num_envs, True) if mask is None else np.asarray(mask)
        if flags.shape != (self.num_envs,) or flags.dtype != bool:
            found = f"shape {flags.shape} and type {flags.dtype}"
            raise refuse("reset_mask", found, f"an array of {self.num_envs} booleans")
        which = np.flatnonzero(flags)
        for key in fixed:
            if key not in self._randomize:
                raise refuse("options", key, f"the keys of randomize, which are: {', '.join(self._randomize) or 'none'}")
        self._runs.advance(None, *self._beginnings(which, random, fixed))
        self._random, self._options = random, fixed
        self._over[which], self._begun[which] = False, True
        return self._runs.observations.copy(), {}

    @_one_at_a_time
    def step(self, actions: Any) -> Tuple[Array, Array, Array, Array, Dict[str, Any]]:
        """Gives each run its commands, and advances it to its next sample."""
        if not self._begun.all():
            raise RuntimeError("step: found a run that has not begun; allowed: reset() first")
        commands = numbers("actions", actions, (self.num_envs, 2))
        begins = self._over
        self._runs.advance(commands, *self._beginnings(np.flatnonzero(begins), self._random, self._options))
        terminated, truncated = self._runs.terminated, self._runs.truncated
        self._over = terminated | truncated
        observations = self._runs.observations.copy()
        if self._reward is None:  # minus the squared distance of the ball, as measured, from its reference, m^2
            distances = (observations[:, 0] - observations[:, 3]) ** 2 + (observations[:, 1] - observations[:, 4]) ** 2
            rewards = np.where(terminated, -self._runs.costs_of_ending, -distances) if terminated.any() else -distances
        else:
            rewards = numbers("reward", self._reward(observations, commands, terminated), (self.num_envs,))
        return observations, np.where(begins, 0.0, rewards), terminated, truncated, {}

    @_one_at_a_time
    def result(self, which: int = 0) -> Optional[Result]:
        """The episode of a run that has just ended; None if it has not."""
        if not 0 <= operator.index(which) < self.num_envs:
            raise IndexError(f"which: found {which}; allowed: 0 to {self.num_envs - 1}")
        made = self._runs.result(which)
        return None if made is None else Result(made)

    def close(self, **_: Any) -> None:
        self.closed = True

    def __repr__(self) -> str:
        return f"<bbsim.VectorEnv of {self.num_envs} runs>"


class Env(_EnvBase):
    """A single run with Gymnasium's API, also by ``gymnasium.make("bbsim/Plate-v0", scenario=...)``. Its ``reward`` gets
    arrays without the first axis, and returns a number."""

    metadata: Dict[str, Any] = {"render_modes": []}
    observation_columns, render_mode = VectorEnv.observation_columns, None

    def __init__(self, scenario: Scenario, randomize: Optional[Mapping[str, Distribution]] = None, seed: int = 0, *,
                 set: Settings = None, reward: Optional[Reward] = None, record: bool = False,
                 render_mode: None = None) -> None:  # fmt: skip
        of_all: Any = reward and (lambda *batch: [reward(*(array[0] for array in batch))])  # type: ignore[misc]
        self._all = VectorEnv(scenario, 1, randomize, seed, set=set, reward=of_all, record=record)
        self.observation_space, self.action_space = self._all.single_observation_space, self._all.single_action_space
        self.command_unit = self._all.command_unit

    def reset(self, *, seed: Optional[int] = None, options: _Options = None) -> Tuple[Array, Dict[str, Any]]:
        if gymnasium is not None:
            super().reset(seed=seed)
        observations, info = self._all.reset(seed=seed, options=options)
        return observations[0], info

    def step(self, action: Any) -> Tuple[Array, float, bool, bool, Dict[str, Any]]:
        if self._all._over[0]:
            raise RuntimeError("the episode has ended; allowed: reset()")
        observations, rewards, terminated, truncated, info = self._all.step(numbers("action", action, (2,))[None])
        return observations[0], float(rewards[0]), bool(terminated[0]), bool(truncated[0]), info

    def result(self) -> Optional[Result]:
        return self._all.result(0)

    def close(self) -> None:
        self._all.close()

    def __repr__(self) -> str:
        return "<bbsim.Env>"


if gymnasium is not None:
    gymnasium.register(id="bbsim/Plate-v0", entry_point=Env, vector_entry_point=(
        lambda scenario, num_envs=1, **rest: VectorEnv(scenario, num_envs, **rest)))  # fmt: skip
