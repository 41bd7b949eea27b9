"""A simulated person, written in Python, who does an experiment's trials on simulated devices."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _native, vocabulary
from .errors import NotThere, error

Array = npt.NDArray[np.float64]


class Seen:
    """A person's sight and touch in a tick; valid only within Person.act().

    The display may differ from the truth, because it includes perturbations.
    `seen["block.position"]` gives the truth, which no person could see, by the names of docs/quantities.md.

    >>> import dihaptic as dh
    >>> sorted(name for name in vars(dh.Seen) if not name.startswith("_"))
    ['attempt', 'body', 'felt', 'fingers', 'message', 'state', 't', 'targets', 'trial']
    """

    def __init__(self, sitting: _native.Sitting) -> None:
        self._sitting = sitting
        self._items: vocabulary.Items = dict(sitting.items())

    @property
    def t(self) -> float:
        """Time in the session [s]."""
        return self._sitting.time()

    @property
    def trial(self) -> int:
        """Number of the trial, from 1."""
        return int(self["trial"])

    @property
    def attempt(self) -> int:
        """Number of the attempt at the trial, from 1."""
        return int(self["attempt"])

    @property
    def state(self) -> str:
        """Name of the task's state, or "between trials"."""
        return self._sitting.state()

    @property
    def message(self) -> str:
        """The text over the scene, in which numbers are {names}."""
        return self._sitting.message()

    @property
    def fingers(self) -> dict[str, Array]:
        """Displayed position of each finger's handle, in world axes [m]."""
        return {name: self._sitting.shown_finger(i) for i, name in enumerate(self._items["fingers"])}

    @property
    def targets(self) -> dict[str, Array]:
        """Position of each visible target, by its region's name, in world axes [m]."""
        return dict(self._sitting.targets())

    def body(self, name: str) -> Array | None:
        """Displayed position of a body, in world axes [m]; None while it is hidden. Raises NotThere."""
        bodies = self._items["bodies"]
        if name not in bodies:
            raise NotThere(name, "is not a body of the scene", bodies, "")
        index = bodies.index(name)
        return self._sitting.shown_body(index) if self._sitting.is_shown(index) else None

    def felt(self, finger: str) -> Array:
        """Force of the device on a finger's handle, in world axes [N]."""
        force: Array = self[f"{finger}.force_sent"]
        return force

    def __getitem__(self, name: str) -> Any:
        place = vocabulary.place_of(name, self._items)
        if place is None:
            raise NotThere(name, "does not exist", [], "dihaptic.quantities() lists all quantities.")
        value = self._sitting.read(place.of, place.item, place.quantity.name)
        return value if place.component is None else value[place.component]


class Person:
    """A simulated person; derive a class from it, and give an object of it to run().

    act() is called every 10 ms of the session's time (`every`), with sight and touch; it leads the fingers, and presses
    keys. It may be slow: the clock is virtual. An exception ends
    the session, whose files are made nevertheless; a note of the exception names its folder.
    Attributes that are numbers, texts or None are written to the session's person.yaml, and become columns in a
    rehearsal's table of people; `group` fills the tables' second column.

    >>> import dihaptic as dh
    >>> class Waits(dh.Person):
    ...     def act(self, seen):
    ...         for finger, side in (("thumb", -1), ("index", 1)):
    ...             self.lead(finger, (0.05 * side, 0, 0.09))
    ...         if seen.t > 2:
    ...             raise StopIteration("that was enough")
    >>> try:
    ...     dh.run("experiments/first-trials.yaml", out=folder, person=Waits(), progress=False)
    ... except StopIteration as why:
    ...     print(why, *why.__notes__, sep="; ")
    that was enough; The session until then: ...first-trials...

    docs/tutorials/own_person.py has a person that lifts.
    """

    #: Time between two calls of act() [s].
    every: float = 0.01

    def act(self, seen: Seen) -> None:
        """Called to observe, and to act by lead() and press()."""
        raise NotImplementedError

    def lead(
        self, finger: str, position: Sequence[float] | Array, velocity: Sequence[float] | Array = (0.0, 0.0, 0.0)
    ) -> None:
        """Leads a finger: sets its target point [m], and its velocity [m/s], in world axes.

        The hand's muscles pull the handle there (the experiment's `hand.impedance`).
        """
        sitting, fingers = self._seat()
        if finger not in fingers:
            raise NotThere(finger, "is not a finger of the scene", fingers, "")
        sitting.lead(fingers.index(finger), position, velocity)

    def press(self, key: str) -> None:
        """Presses a key of the keyboard: a character, "Enter" or "Backspace"."""
        self._seat()[0].press(key)

    def _seat(self) -> tuple[_native.Sitting, list[str]]:
        if "_sitting" not in self.__dict__:
            raise error("the person is not in an experiment", "Give the person to run(); act within act().")
        return self.__dict__["_sitting"], self.__dict__["_fingers"]

    def _traits(self, ppid: str) -> str:
        """Text of person.yaml: the class, and its attributes that a file can hold."""
        own = [vars(kind) for kind in reversed(type(self).__mro__) if issubclass(kind, Person) and kind is not Person]
        named = {name: value for names in [*own, vars(self)] for name, value in names.items() if name[0] != "_"}
        traits = {name: value.item() if isinstance(value, np.generic) else value for name, value in named.items()}
        traits = {name: value for name, value in traits.items() if value is None or isinstance(value, (int, float, str))}
        for name in _TAKEN & traits.keys():
            raise error("is already a column in a rehearsal's table of people", "Give it another name.", key=name)
        lines = {"id": ppid, "class": type(self).__name__, **traits}
        return "".join(f"{_yaml(name)}: {_yaml(value)}\n" for name, value in lines.items())

    def _do(
        self, sitting: _native.Sitting, out: str | Path, between: str = "", keep_recordings: bool = True
    ) -> Ended:
        if "_sitting" in self.__dict__:
            raise error("is doing another session now", "Give each session its own person.", key=type(self).__name__)
        if not 1e-4 <= self.every <= 1:
            raise error(f"is {self.every}", "Give the time between two calls, 0.0001 to 1 s.", key="every")
        name, traits = type(self).__name__, self._traits(sitting.participant())
        self.__dict__.update(_sitting=sitting, _fingers=dict(sitting.items())["fingers"])
        seen = Seen(sitting)
        try:
            ended = Ended(
                *sitting.run(lambda: self.act(seen), self.every, name, traits, str(out), between, keep_recordings)
            )
        finally:
            del self.__dict__["_sitting"]
        try:
            sitting.raise_thrown()
        except BaseException as why:
            why.add_note(f"The session until then: {ended.folder}")
            raise
        return ended


#: Columns that a rehearsal's table of people always has.
_TAKEN = frozenset({"id", "class", "seed", "simulated", "moved_by"})


def _yaml(value: bool | int | float | str | None) -> str:
    if value is None or value != value:
        return ""  # not known
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, str):
        return json.dumps(str(value).encode("utf-8", "replace").decode(), ensure_ascii=False)
    return repr(int(value)) if isinstance(value, int) else repr(float(value))


@dataclass(frozen=True)
class Ended:
    """A finished session that has not been opened."""

    folder: str
    good: bool  #: whether it was completed, and the felt forces were as planned
    said: Sequence[str]  #: lines that start with "WARNING: " or "note: "
