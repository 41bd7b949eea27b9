"""Controls a session's trials from Python: chooses the next trial, or its properties."""

from __future__ import annotations

import contextlib
import json
import os
import socket
import tempfile
import threading
import traceback
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd

from ._peer import peer
from ._text import to_json
from .errors import error


@dataclass(frozen=True)
class Attempt:
    """The end of an attempt at a trial.

    >>> import dihaptic as dh
    >>> dh.Attempt(3, 1, "hit", {"force_N": 1.5}).outcome
    'hit'
    """

    trial_num: int  #: from 1; 0: the session starts, and no trial has been done
    attempt: int  #: attempt at that trial, from 1
    outcome: str | None  #: None at the session's start
    variables: Mapping[str, float | None]  #: the task's variables, in their own units; None: not measured


@dataclass(frozen=True)
class Next:
    """The decision. Omitted parts stay as in the experiment's file.

    >>> import dihaptic as dh
    >>> dh.Next(variables={"force_N": 2}, message="Slower")
    Next(variables={'force_N': 2}, trial_num=None, message='Slower')
    """

    variables: Mapping[str, float] = field(default_factory=dict)  #: new values, in their own units
    trial_num: int | None = None  #: number of a remaining trial of the same block
    message: str | None = None  #: one of BetweenTrials.messages, shown as feedback


class BetweenTrials:
    """Decisions between trials: derive a class from this one, and pass an object of it to run().

    decide() is called before the first trial, and after each attempt. It runs outside the session's process, so that no tick
    is late, however slow or faulty it is. In real time the next trial waits up to a second for its answer; after a later
    answer, or an exception, the trials stay as in the file, and the session's notes report it. On the virtual clock the
    session waits for the answer.

    The variables are those of the task: `variables: [{ name: load }]` in the experiment's file, whose formulas use
    them, as in `body: { body: block, weight_scale: load }` of a perturbation. Decisions are recorded, so that a replay
    does not need Python.

    >>> import dihaptic as dh
    >>> class Heavier(dh.BetweenTrials):
    ...     messages = ["The next one is heavier"]
    ...
    ...     def decide(self, last):
    ...         if last.trial_num == 3:
    ...             return dh.Next(message=self.messages[0])
    >>> rules = Heavier()
    >>> session = dh.run("experiments/first-trials.yaml", out=folder, simulate=True, progress=False, between=rules)
    >>> [attempt.trial_num for attempt in rules.attempts]
    [0, 1, 2, 3, 4]
    >>> session.events.query("event == 'message' and detail.str.contains('heavier')").trial.tolist()
    [4]
    """

    #: All texts that decide() may show.
    messages: list[str] = []

    def decide(self, last: Attempt) -> Next | None:
        """The decision after an attempt; None: as in the file."""
        raise NotImplementedError

    @property
    def attempts(self) -> list[Attempt]:
        """All attempts in the running session after which decide() was called."""
        attempts: list[Attempt] = self.__dict__.setdefault("_attempts", [])
        return attempts

    @property
    def session(self) -> Path:
        """Folder of the running session."""
        if "_session" not in self.__dict__:
            raise error("no session has started", "Give the rules to run().")
        return Path(self.__dict__["_session"])

    @property
    def trials(self) -> pd.DataFrame:
        """The session's list of trials, in the file's order (trial-list.csv)."""
        from .tables import read_table

        return read_table(self.session / "trial-list.csv")

    @property
    def failures(self) -> list[str]:
        """Exceptions of decide() in the running session, with their location."""
        failures: list[str] = self.__dict__.setdefault("_failures", [])
        return failures

    # The other end of src/session/listeners/trial_controller.h

    def _answer(self, question: dict[str, Any]) -> dict[str, Any] | None:
        if "session" in question:
            self.__dict__.update(_session=question["session"], _attempts=[], _failures=[])
            return None
        answer: dict[str, Any] = {"number": question["number"]}
        last = Attempt(*(question[key] for key in ("trial_num", "attempt", "outcome", "variables")))
        self.attempts.append(last)
        try:
            chosen = self.decide(last)
            if chosen is None:
                return answer
            answer["set"] = {name: float(value) for name, value in chosen.variables.items()}
            if chosen.trial_num is not None:
                answer["next"] = int(chosen.trial_num)
            if chosen.message is not None:
                answer["message"] = list(self.messages).index(chosen.message)
        except Exception as why:  # the session continues, whatever was raised
            self.failures.append(traceback.format_exc())
            return {"number": question["number"], "failed": f"{type(why).__name__}: {_text_of(why)}"}
        return answer

    def _serve(self, listening: socket.socket) -> None:
        with contextlib.suppress(OSError):
            connection, _ = listening.accept()
            while peer(connection).uid not in {0, os.geteuid()}:
                connection.close()
                connection, _ = listening.accept()
            with connection, connection.makefile("rw", encoding="utf-8") as lines:
                lines.write(to_json({"messages": list(self.messages)}) + "\n")
                lines.flush()
                for line in lines:
                    answer = self._answer(json.loads(line))
                    if answer is not None:
                        lines.write(to_json(answer) + "\n")
                        lines.flush()


def _text_of(why: Exception) -> str:
    """The exception in one line."""
    try:
        return " ".join(str(why).split())
    except Exception as another:
        return f"its text is not available ({type(another).__name__})"


def _check(rules: BetweenTrials) -> None:
    if not isinstance(rules, BetweenTrials):
        raise error(f"{rules!r} cannot decide", "Give an object of a class that derives from BetweenTrials.")
    texts = rules.messages
    if not isinstance(texts, (list, tuple)) or len(texts) > 64 or not all(isinstance(text, str) for text in texts):
        raise error("are not a list of at most 64 texts", "List each text that decide() may show.", key="messages")


@contextlib.contextmanager
def listening(rules: BetweenTrials | None) -> Iterator[list[str]]:
    """The options of `dihaptic run` that connect it to the rules, valid while this context lasts."""
    if rules is None:
        yield []
        return
    _check(rules)
    with tempfile.TemporaryDirectory(prefix="dihaptic-") as folder, socket.socket(socket.AF_UNIX) as server:
        path = f"{folder}/between"
        try:
            server.bind(path)
        except OSError:
            raise error("is too long a path for a socket", "Set TMPDIR to a shorter one.", file=folder) from None
        server.listen(1)
        thread = threading.Thread(target=rules._serve, args=(server,), daemon=True)
        thread.start()
        yield ["--between", path]
        with contextlib.suppress(OSError):
            server.shutdown(socket.SHUT_RDWR)  # a session that never started has not connected
        thread.join(timeout=1)  # decide() may never return
