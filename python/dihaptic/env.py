"""Environments for learners: two fingers lift or turn an object, or four hand it over, with the program's contact model.

They have the interface of gymnasium (reset, step, spaces). Where gymnasium 1.1 or later is installed, they are its
environments, created by `gymnasium.make("Dihaptic/Lift-v0")` and `gymnasium.make_vec`.

>>> import dihaptic as dh
>>> environment = dh.env.Grasp("lift", seed=1)
>>> seen, info = environment.reset()
>>> seen, reward, terminated, truncated, info = environment.step(environment.action_space.sample())
>>> seen.shape == environment.observation_space.shape, terminated
(True, False)
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _native
from .errors import error
from .program import shipped
from .world import World

Array = npt.NDArray[np.float64]
Info = dict[str, Any]


class Box:
    """A space of arrays between two bounds.

    >>> import dihaptic as dh
    >>> box = dh.env.Box(-1, 1, (2,), seed=1)
    >>> box.contains(box.sample())
    True
    """

    def __init__(self, low: float, high: float, shape: tuple[int, ...], seed: int | None = None) -> None:
        self.low = np.full(shape, low)
        self.high = np.full(shape, high)
        self.shape = shape
        self.dtype = np.dtype(float)
        self._random = np.random.default_rng(seed)

    def sample(self) -> Array:
        """A random array, uniform within bounds that must be finite."""
        return self._random.uniform(self.low, self.high)

    def contains(self, x: npt.ArrayLike) -> bool:
        """Whether an array has the right shape and lies between the bounds."""
        given = np.asarray(x, dtype=float)
        return given.shape == self.shape and bool(((given >= self.low) & (given <= self.high)).all())


class _Env:
    """Stands in for gymnasium.Env and gymnasium.vector.VectorEnv if they are not installed."""

    metadata: dict[str, Any] = {}
    render_mode: str | None = None
    _np_random: np.random.Generator

    def reset(self, *, seed: int | None = None, options: Info | None = None) -> Any:
        if seed is not None:
            self._np_random = np.random.default_rng(seed)

    def close(self) -> None:
        """Does nothing: there is nothing to close."""


_VectorEnv = _Env
_AUTORESET: dict[str, Any] = {}
gymnasium: Any = None
if not TYPE_CHECKING:
    try:
        import gymnasium
        from gymnasium.vector import AutoresetMode
    except ImportError:  # missing, or older
        gymnasium = None
    else:
        _Env, _VectorEnv = gymnasium.Env, gymnasium.vector.VectorEnv
        _AUTORESET = {"autoreset_mode": AutoresetMode.DISABLED}


def _space(low: float, high: float, shape: tuple[int, ...], seed: int) -> Box:
    if gymnasium is None:
        return Box(low, high, shape, seed)
    space: Box = gymnasium.spaces.Box(low, high, shape, np.float64, seed)
    return space


def _refuse_options(options: Info | None, *known: str) -> None:
    for name in set(options or {}) - set(known):
        remedy = f"Allowed names: {', '.join(known)}." if known else "Leave it out."
        raise error(f"has '{name}'", remedy, key="options")


#: For each task: its scene, the range of its goal, and the tolerance.
_TASKS: dict[str, tuple[str, tuple[float, float], float]] = {
    "lift": ("scenes/block-on-table.yaml", (0.03, 0.1), 0.005),  # height [m]
    "turn": ("experiments/turn-block.yaml", (0.2, 0.8), 0.05),  # about z [rad]
    "hand_over": ("experiments/hand-over.yaml", (0.03, 0.1), 0.005),  # height in the other hand [m]
}
_FASTEST = 0.3  # largest speed of a finger's target [m/s]
_HOLD = 0.2  # time for which the object must be at the goal [s]


class Grasps(_VectorEnv):
    """Many worlds with the same task, stepped side by side on all processors.

    `task`: "lift" an object to a height, "turn" it by an angle, "hand_over" from the first hand to
    the second. An action is, for each finger, the velocity of its target point [m/s], three numbers from -1 to 1 times
    0.3 m/s; it acts for `ticks` ticks. An observation contains, for each finger, the handle's position and velocity,
    the force on it, and the pressing force; the
    object's position, orientation (w, x, y, z), velocity and angular velocity; and the goal, in SI
    units. The reward is the negative distance from the goal, divided by its initial value, and 1 once the
    goal is reached and held for 0.2 s, which ends the episode; `time` [s] truncates it. In hand_over, progress counts only
    while the first hand is not touching the object.

    >>> import dihaptic as dh
    >>> many = dh.env.Grasps("lift", 3, seed=1)
    >>> seen, info = many.reset()
    >>> seen.shape
    (3, 34)
    >>> many.action_space.shape, many.single_action_space.shape
    ((3, 6), (6,))
    >>> seen, reward, terminated, truncated, info = many.step(np.zeros((3, 6)))
    >>> bool((np.abs(reward + 1) < 0.01).all())
    True
    """

    metadata = {"render_modes": [], **_AUTORESET}

    def __init__(
        self, task: str = "lift", n: int = 1, *, seed: int = 1, ticks: int = 10, time: float = 5.0, jobs: int | None = None
    ) -> None:
        if task not in _TASKS:
            raise error(f"is '{task}'", f"Tasks are: {', '.join(_TASKS)}.", key="task")
        if n < 1 or ticks < 1:
            raise error("the number of worlds, or of ticks per step, is below 1", "Give at least 1.")
        scene, self._goals, self._near = _TASKS[task]
        self.task = task
        self.worlds = [World(shipped(scene), seed=seed + i) for i in range(n)]
        self.ticks = ticks
        self.time = time
        self.step_time = ticks * self.worlds[0].tick
        fingers = len(self.worlds[0].fingers)
        self.num_envs = n
        self.single_action_space = _space(-1, 1, (3 * fingers,), seed)
        self.single_observation_space = _space(-np.inf, np.inf, (10 * fingers + 14,), seed)
        self.action_space = _space(-1, 1, (n, 3 * fingers), seed)
        self.observation_space = _space(-np.inf, np.inf, (n, 10 * fingers + 14), seed)
        self._jobs = jobs or os.cpu_count() or 1
        super().reset(seed=seed)
        self._fingers = fingers
        self._inner = [world._world for world in self.worlds]
        self._targets = np.zeros((n, fingers, 6))
        self._goal = np.zeros(n)
        self._zero = np.zeros(n)  # the object's height or angle at the start
        self._held: Array = np.zeros(n)
        self._passed = np.zeros(n)
        self._began = np.zeros(n, dtype=bool)

    def reset(
        self,
        which: Sequence[int] | npt.NDArray[Any] | None = None,
        *,
        seed: int | None = None,
        options: Info | None = None,
    ) -> tuple[Array, Info]:
        """Restarts all episodes, or those of `which` worlds (their numbers, or an array such as `terminated |
        truncated`); each gets its own goal. Only this restarts an episode that has ended. In gymnasium's form, `which` is
        `options={"reset_mask": which}`."""
        _refuse_options(options, "reset_mask")
        if options and which is None:
            which = options["reset_mask"]
        super().reset(seed=seed)
        chosen = self._chosen(which if self._began.all() else None)
        for i in chosen:
            self.worlds[i].reset()
            self.worlds[i].step()
        self._began[:] = True
        self._goal[chosen] = self._np_random.uniform(*self._goals, size=len(chosen))
        self._held[chosen] = 0
        self._passed[chosen] = 0
        seen = _native.observe(self._inner)
        for finger in range(self._fingers):
            at = seen[:, 10 * finger : 10 * finger + 3]
            self._targets[chosen, finger, :3] = at[chosen]
        self._targets[chosen, :, 3:] = 0
        self._zero[chosen] = self._value(seen)[chosen]
        return self._with_goal(seen), self._info(seen)

    def _chosen(self, which: Sequence[int] | npt.NDArray[Any] | None) -> npt.NDArray[np.int_]:
        n = len(self.worlds)
        given = np.arange(n) if which is None else np.atleast_1d(np.asarray(which))
        if given.dtype == bool and given.shape == (n,):
            given = np.flatnonzero(given)
        if len(given) == 0:
            return np.array([], dtype=int)
        if given.ndim != 1 or given.dtype.kind not in "iu" or given.min() < 0 or given.max() >= n:
            raise error(f"is {which}", f"Give numbers from 0 to {n - 1}, or {n} times True or False.", key="which")
        out: npt.NDArray[np.int_] = np.unique(given)
        return out

    def step(self, actions: npt.ArrayLike) -> tuple[Array, Array, npt.NDArray[np.bool_], npt.NDArray[np.bool_], Info]:
        """Returns the observations, the rewards, the flags of terminated and of truncated episodes, and the info."""
        if not self._began.all():
            raise error("an episode has not started", "Call reset() first.")
        given = np.asarray(actions, dtype=float).reshape(len(self.worlds), self._fingers, 3)
        if not np.isfinite(given).all():
            raise error("an action has a component that is not a number", "Give numbers from -1 to 1.")
        velocity = _FASTEST * np.clip(given, -1, 1)
        self._targets[:, :, :3] += velocity * self.step_time
        self._targets[:, :, 3:] = velocity
        _native.lead_all(self._inner, self._targets)
        _native.step_all(self._inner, self.ticks, self._jobs)
        seen = _native.observe(self._inner)
        distance = self._distance(seen)
        self._passed += self.step_time
        self._held = np.where(distance < self._near, self._held + self.step_time, 0)
        success = self._held >= _HOLD - 1e-9
        failed = np.array([world.over() for world in self._inner])
        reward = np.where(success, 1.0, -distance / self._goal)
        truncated = (self._passed >= self.time - 1e-9) & ~success
        return self._with_goal(seen), reward, success | failed, truncated, self._info(seen)

    def _object(self, seen: Array) -> Array:
        return seen[:, 10 * self._fingers :]

    def _value(self, seen: Array) -> Array:
        """The value that the goal refers to: the object's height, or its angle about z."""
        of = self._object(seen)
        if self.task != "turn":
            return of[:, 2]
        w, x, y, z = of[:, 3], of[:, 4], of[:, 5], of[:, 6]
        angle: Array = np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
        return angle

    def _distance(self, seen: Array) -> Array:
        distance = np.abs(self._value(seen) - self._zero - self._goal)
        if self.task == "hand_over":
            first = seen[:, 9] + seen[:, 19]  # pressing force of the first hand
            distance = np.where(first > 0, np.maximum(distance, self._goal), distance)
        out: Array = distance
        return out

    def _with_goal(self, seen: Array) -> Array:
        return np.column_stack([seen, self._goal])

    def _info(self, seen: Array) -> Info:
        return {"distance": self._distance(seen), "success": self._held >= _HOLD - 1e-9}


class Grasp(_Env):
    """One world with a task: Grasps with n = 1, without its first axis.

    >>> import dihaptic as dh
    >>> environment = dh.env.Grasp("turn")
    >>> seen, info = environment.reset(seed=3)
    >>> bool(0.2 <= seen[-1] <= 0.8)  # the goal
    True
    """

    metadata = {"render_modes": []}

    def __init__(self, task: str = "lift", *, seed: int = 1, ticks: int = 10, time: float = 5.0) -> None:
        super().reset(seed=seed)
        self._one = Grasps(task, 1, seed=seed, ticks=ticks, time=time, jobs=1)
        self.action_space = self._one.single_action_space
        self.observation_space = self._one.single_observation_space
        self.world = self._one.worlds[0]

    def reset(self, *, seed: int | None = None, options: Info | None = None) -> tuple[Array, Info]:
        """Starts an episode with a new goal; `options` must be empty."""
        _refuse_options(options)
        super().reset(seed=seed)
        self._one._np_random = self._np_random
        seen, info = self._one.reset()
        return seen[0], _first(info)

    def step(self, action: npt.ArrayLike) -> tuple[Array, float, bool, bool, Info]:
        """Returns the observation, the reward, whether the episode is terminated or truncated, and
        info."""
        seen, reward, terminated, truncated, info = self._one.step(np.asarray(action, dtype=float)[None])
        return seen[0], float(reward[0]), bool(terminated[0]), bool(truncated[0]), _first(info)


def _first(info: Info) -> Info:
    return {key: value[0].item() for key, value in info.items()}


def _many(num_envs: int, **given: Any) -> Grasps:
    return Grasps(n=num_envs, **given)


if gymnasium is not None:
    for _task in _TASKS:
        gymnasium.register(
            f"Dihaptic/{_task.title().replace('_', '')}-v0",
            entry_point="dihaptic.env:Grasp",
            vector_entry_point="dihaptic.env:_many",
            kwargs={"task": _task},
        )
