"""A world in virtual time that Python steps tick by tick: the program's own contact and rendering."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd

from . import _native, vocabulary
from .errors import NotThere
from .files import Input, on_disk

Array = npt.NDArray[np.float64]
_STILL = (0.0, 0.0, 0.0)
_UPRIGHT = (1.0, 0.0, 0.0, 0.0)


class World:
    """A scene with simulated devices that a simulated hand holds.

    `file` is a scene, or an experiment without trials, as a file or an object; `rig` is a rig of simulated devices
    (ideal ones if left out); `settings` is a dict such as {"coupling.stiffness_N_m": 600}. Until a finger is led, it
    follows the scene's own hand, and each tick is identical, to the bit, to that of `dihaptic run`. Raises Error for
    every fault that `dihaptic check` finds.

    >>> import dihaptic as dh
    >>> world = dh.World("scenes/block-on-table.yaml")
    >>> world.step(1000)
    >>> round(world.t, 3), round(float(world.bodies["block"].position[2]), 3)
    (0.999, 0.02)
    """

    def __init__(
        self,
        file: Input,
        rig: Input = "",
        *,
        settings: dict[str, Any] | None = None,
        seed: int = 1,
    ) -> None:
        given = [f"{key}={value}" for key, value in (settings or {}).items()]
        with on_disk(file) as path, on_disk(rig) as rig_path:
            self._world = _native.World(path, rig_path, given, seed)
        self._items: vocabulary.Items = dict(self._world.items())
        self.bodies = {name: Body(self, i, name) for i, name in enumerate(self._items["bodies"])}
        self.joints = self._items["joints"]
        self.fingers = [Finger(self, i, name) for i, name in enumerate(self._items["fingers"])]
        self.tick: float = self._world.tick_length()  #: time from one tick to the next [s]
        self.warnings: list[str] = self._world.warnings()

    @property
    def object(self) -> Body | None:
        """The object of the scene; None if nothing can move."""
        return self.bodies.get(self._world.object())

    @property
    def t(self) -> float:
        """Time of the last tick [s]."""
        return float(self["time"]) * 1e-9

    @property
    def duration(self) -> float:
        """Time for which the scene's own hand moves [s]."""
        return float(self._world.duration())

    def step(self, ticks: int = 1, director: Callable[[World], None] | None = None) -> None:
        """Performs ticks; in each, a director is called before the world moves.

        A director's orders (pushes, places, scales) act in the same tick; a finger's lead acts in the next one, since
        the devices have already been read. A director reads the previous tick, so there must be one. Its exceptions end
        the step. Raises Error once force has been switched off for safety: for instance, because a finger was led farther in
        one step than a hand can move. Lead it in small steps, and give their velocity.

        >>> import dihaptic as dh
        >>> world = dh.World("scenes/block-on-table.yaml")
        >>> world.step()
        >>> heights = []
        >>> world.step(10, lambda w: heights.append(w.bodies["block"].position[2]))
        >>> len(heights)
        10
        """
        call = None if director is None else lambda: director(self)
        self._world.step(ticks, call)

    def reset(self) -> None:
        """Starts again at time 0, with the scene's own hand and no orders.

        >>> import dihaptic as dh
        >>> world = dh.World("scenes/block-on-table.yaml")
        >>> world.step(5)
        >>> world.reset()
        >>> world.step()
        >>> world.t
        0.0
        """
        self._world.begin()

    def __getitem__(self, name: str) -> Any:
        """A quantity of the last tick, by the names used in a Session: "grip_force",
        "block.position", "thumb.force_sent"; a list such as "contacts" as a pandas table.
        Raises NotThere.
        """
        if name in vocabulary.lists():
            columns = [c for q in vocabulary.of_list(name) for c in q.columns()]
            return pd.DataFrame(self._world.rows(name), columns=columns)
        place = vocabulary.place_of(name, self._items)
        if place is None:
            known = [q.name for q in vocabulary.of_list("")]
            raise NotThere(name, "does not exist", known, "dihaptic.quantities() lists all quantities.")
        value = self._world.read(place.of, place.item, place.quantity.name)
        return value if place.component is None else value[place.component]

    def __reduce__(self) -> tuple[Any, ...]:
        raise TypeError("a World cannot be copied: make another, or reset() it")


class Finger:
    """A finger of a world: its device's handle, and its proxy, which represents it in the world.

    >>> import dihaptic as dh
    >>> world = dh.World("scenes/block-on-table.yaml")
    >>> world.step()
    >>> world.fingers[0].name, world.fingers[0].handle.shape
    ('thumb', (3,))
    """

    def __init__(self, world: World, index: int, name: str) -> None:
        self._world = world
        self._index = index
        self.name = name

    def _read(self, term: str) -> Array:
        value: Array = self._world._world.read("fingers", self._index, term)
        return value

    @property
    def handle(self) -> Array:
        """Position of the handle, in world axes [m]."""
        return self._read("handle_position")

    @property
    def handle_velocity(self) -> Array:
        """Velocity of the handle, in world axes [m/s]."""
        return self._read("handle_velocity")

    @property
    def proxy(self) -> Array:
        """Position of the proxy, in world axes [m]."""
        return self._read("proxy_position")

    @property
    def force(self) -> Array:
        """Force that the device exerts on the handle, in world axes [N]."""
        return self._read("force_sent")

    def lead(
        self,
        position: Sequence[float] | Array,
        velocity: Sequence[float] | Array = _STILL,
        orientation: Sequence[float] | Array | None = None,
    ) -> None:
        """Leads the finger from the next tick on, until the next order.

        `position` [m] and `velocity` [m/s] are those of its target point, in world axes: the hand's muscles pull the
        handle there (the scene's `hand.impedance`), so that a body that it presses on can keep it away. `orientation`:
        unit quaternion w, x, y, z.

        >>> import dihaptic as dh
        >>> world = dh.World("scenes/block-on-table.yaml")
        >>> world.fingers[0].lead((-0.05, 0, 0.1))
        >>> world.step(1500)
        >>> bool(abs(world.fingers[0].handle - (-0.05, 0, 0.1)).max() < 2e-3)
        True
        """
        self._world._world.lead(self._index, position, velocity, orientation)

    def let_go(self) -> None:
        """Gives the finger back to the scene's own hand."""
        self._world._world.let_go(self._index)


class Body:
    """A body of a world's scene.

    >>> import dihaptic as dh
    >>> world = dh.World("scenes/block-on-table.yaml")
    >>> world.bodies["block"].place((0, 0, 0.5))
    >>> world.step(100)  # the first tick puts it there; then it falls
    >>> fallen = 0.5 - world.bodies["block"].position[2]
    >>> bool(abs(fallen - 9.81 / 2 * 0.1**2) < 1e-3)
    True
    """

    def __init__(self, world: World, index: int, name: str) -> None:
        self._world = world
        self._index = index
        self.name = name

    def _read(self, term: str) -> Array:
        value: Array = self._world._world.read("bodies", self._index, term)
        return value

    @property
    def position(self) -> Array:
        """Position of the body's origin, in world axes [m]."""
        return self._read("position")

    @property
    def orientation(self) -> Array:
        """Unit quaternion w, x, y, z that turns the body's axes into the world's."""
        return self._read("orientation")

    @property
    def velocity(self) -> Array:
        """Velocity of the body's origin, in world axes [m/s]."""
        return self._read("velocity")

    @property
    def angular_velocity(self) -> Array:
        """Angular velocity of the body, in world axes [rad/s]."""
        return self._read("angular_velocity")

    def place(
        self,
        position: Sequence[float] | Array,
        orientation: Sequence[float] | Array = _UPRIGHT,
        velocity: Sequence[float] | Array = _STILL,
        angular_velocity: Sequence[float] | Array = _STILL,
    ) -> None:
        """Places the body in the next tick: position [m], unit quaternion w, x, y, z, velocities [m/s, rad/s], all in world
        axes."""
        self._world._world.place(self._index, position, orientation, velocity, angular_velocity)

    def push(
        self, force: Sequence[float] | Array = _STILL, torque: Sequence[float] | Array = _STILL
    ) -> None:
        """Pushes the body at its centre of mass in every tick from now on [N, N*m, world axes], until another push; without
        arguments, the push ends."""
        self._world._world.push(self._index, force, torque)

    def scale(
        self,
        *,
        mass: float | Sequence[float] = 1.0,
        weight: float = 1.0,
        turning: float = 1.0,
        friction: float = 1.0,
    ) -> None:
        """Scales the body's inertia (by one factor, or one for each of the world's axes), weight, moments of
        inertia and friction from now on; without arguments, they return to the scene's values. A body of
        twice the density has mass=2, weight=2, turning=2."""
        axes = np.broadcast_to(np.asarray(mass, dtype=float), 3)
        self._world._world.scale(self._index, axes, weight, turning, friction)


def step_all(worlds: Iterable[World], ticks: int = 1, jobs: int | None = None) -> list[bool]:
    """Steps many worlds side by side, on all processors, and returns a flag for each that continues.

    >>> import dihaptic as dh
    >>> worlds = [dh.World("scenes/block-on-table.yaml", seed=seed) for seed in range(1, 4)]
    >>> dh.step_all(worlds, 100)
    [True, True, True]
    """
    inner = [world._world for world in worlds]
    _native.step_all(inner, ticks, jobs or os.cpu_count() or 1)
    return [not world.over() for world in inner]
