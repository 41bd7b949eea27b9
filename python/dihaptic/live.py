"""Watches a running session from another process, and steers it."""

from __future__ import annotations

import json
import os
import socket
import time
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType
from typing import Any

from ._peer import peer
from ._text import to_json
from .errors import error

_LONGEST = 1 << 20  # message [bytes]


@dataclass(frozen=True)
class Moment:
    """The state of a session in a tick, or the end of an attempt at a trial.

    >>> import dihaptic as dh
    >>> dh.Moment(tick=1200, time_s=1.2, trial_num=3, attempt=1, state="reach", values={"grip_force": 2.1}).outcome
    """

    tick: int
    time_s: float  #: session time
    trial_num: int  #: from 1; 0: none
    attempt: int
    state: str | None = None  #: the task's state, or phase; None at the end of an attempt
    outcome: str | None = None  #: outcome at the end of an attempt; then there are no values
    values: dict[str, float | None] = field(default_factory=dict)  #: values by expression; None: not measured


class Live:
    """A running session, as observe() returns it: iterate over it, or steer it.

    Moments arrive as they happen. A slow reader misses some, but never the end of an attempt.
    Steering a session that has just ended has no effect. docs/adr/0022 explains why the session never waits.

    >>> import threading
    >>> import dihaptic as dh
    >>> lift = threading.Thread(target=dh.run, args=("experiments/lift-block.yaml",),
    ...                         kwargs={"out": folder, "clock": "real", "progress": False})
    >>> lift.start()
    >>> with dh.observe(folder, "block.z", every_ms=5) as live:
    ...     for now in live:
    ...         if now.time_s > 0.1:
    ...             break
    ...     live.turn(stiffness=800)
    ...     live.end()
    >>> lift.join()
    >>> round(now.values["block.z"]), live.units, now.state
    (20, {'block.z': 'mm'}, 'close')
    """

    def __init__(self, folder: Path, connection: socket.socket) -> None:
        self._socket = connection
        self._watched: list[str] = []
        self._waiting: list[Moment] = []
        greeting = self._receive()
        if greeting is None:
            raise error("is over", "Watch a running session.", file=str(folder))
        if "session" not in greeting:
            self._socket.close()
            raise error(str(greeting.get("refused", "is not understood")), "", file=str(folder))
        self.session = folder  #: its folder
        self.states: list[str] = greeting["states"]  #: the task's states, or phases
        self.outcomes: list[str] = greeting["outcomes"]  #: possible outcomes of attempts
        self.units: dict[str, str] = {}  #: units of the values that are watched, by expression

    def __enter__(self) -> Live:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, why: BaseException | None, where: TracebackType | None
    ) -> None:
        self._socket.close()

    def __repr__(self) -> str:
        return f"<Live {self.session}>"

    def __iter__(self) -> Iterator[Moment]:
        """The moments from now on until the session is over."""
        while True:
            if self._waiting:
                yield self._waiting.pop(0)
                continue
            message = self._receive()
            if message is None:
                return
            moment = self._moment(message)
            if moment is not None:
                yield moment

    def watch(self, *expressions: str, every_ms: float = 20) -> None:
        """Chooses the content of the moments: expressions of recorded quantities, as in Session; lengths are in mm."""
        self._send({"watch": list(expressions), "every_ms": every_ms})
        while (message := self._receive()) is not None:
            if "watching" in message:
                self._watched = list(expressions)
                self.units = {of["of"]: of["unit"] for of in message["watching"]}
                return
            moment = self._moment(message)
            if moment is not None and moment.outcome is not None:
                self._waiting.append(moment)

    def press(self, key: str) -> None:
        """Presses a key for a task that waits for one: a character, "Enter" or "Backspace"."""
        self._send({"key": key})

    def trigger(self, code: int) -> None:
        """Sends a trigger, as if received on one of the rig's outlets; `code` from 1 to 255."""
        self._send({"trigger": code})

    def turn(self, **knobs: float | str | None) -> None:
        """Turns knobs: coupling, stiffness (N/m), damping (N*s/m), smoothing, proxy, friction_scale, solver.

        Changes take 0.2 s if an object is held, and are recorded. In the window's sessions, only its panel can turn the
        knobs.
        """
        self._send({"turn": knobs})

    def end(self) -> None:
        """Ends the session properly."""
        self._send({"end": True})

    def _send(self, message: dict[str, Any]) -> None:
        with suppress(ConnectionError):  # the session is over, as the next moment would show
            self._socket.send(to_json(message).encode())

    def _receive(self) -> dict[str, Any] | None:
        """The next message; None when the session is over."""
        try:
            text = self._socket.recv(_LONGEST)
        except ConnectionResetError:
            text = b""
        message: dict[str, Any] = json.loads(text) if text else {"over": True}
        return None if "over" in message else message

    def _moment(self, message: dict[str, Any]) -> Moment | None:
        if "refused" in message:
            raise error(str(message["refused"]), "")
        if "ended" in message:
            return Moment(message["tick"], message["time_s"], **message["ended"])
        if "values" not in message or len(message["values"]) != len(self._watched):
            return None  # values watched before
        values = dict(zip(self._watched, message.pop("values"), strict=True))
        return Moment(**message, values=values)


def _connected(folder: Path) -> socket.socket | None:
    """The other end of src/session/listeners/observers.h; None if no session is running in that folder."""
    try:
        descriptor = os.open(folder / "observers", os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
        with open(descriptor, "rb") as file:
            name = file.read(100)
            owner = os.fstat(descriptor).st_uid
    except OSError:
        return None
    if not name.startswith(b"dihaptic/session/"):
        return None
    connection = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    try:
        connection.connect(b"\0" + name)
    except OSError:
        connection.close()
        return None
    # root may watch a session of the folder's owner; other users only their own
    if peer(connection).uid not in {0, os.geteuid() or owner}:
        connection.close()
        raise error("is answered by another user's program", "Watch a session of your own.", file=str(folder))
    return connection


def _running(folder: Path) -> tuple[Path, socket.socket] | None:
    """The folder itself if a session is running in it, or the newest folder in it with a running
    session."""
    inside = sorted((path for path in folder.glob("*/") if path.is_dir()), key=lambda path: path.name, reverse=True)
    for path in [folder, *inside]:
        connection = _connected(path)
        if connection is not None:
            return path, connection
    return None


def observe(
    session: str | Path = "sessions", *expressions: str, every_ms: float = 20, patience_s: float = 10
) -> Live:
    """Watches a running session.

    `session`: its folder, or a folder of sessions, of which the newest running one is used. A session that is not yet
    running is awaited for up to `patience_s`. `expressions`: the content of its moments; see Live.watch(). The session
    may come from the window, from `dihaptic run` or from run(); a rehearsal cannot be watched.

    >>> import dihaptic as dh
    >>> dh.observe(folder, patience_s=0)
    Traceback (most recent call last):
    dihaptic.errors.Error: ...has no running session. Start one; rehearsals cannot be watched.
    """
    end = time.monotonic() + patience_s
    while (found := _running(Path(session))) is None:
        if time.monotonic() > end:
            raise error("has no running session", "Start one; rehearsals cannot be watched.", file=str(session))
        time.sleep(0.02)
    live = Live(*found)
    try:
        live.watch(*expressions, every_ms=every_ms)
    except BaseException:
        live._socket.close()
        raise
    return live
