"""Errors about invalid inputs, with file, line, key and remedy."""

from __future__ import annotations

import signal
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Problem:
    """One fault, and its remedy.

    >>> Problem("error", "block.yaml", 4, "mass", "is negative", "A mass is positive.").text()
    'block.yaml:4: error: mass: is negative. A mass is positive.'
    """

    severity: str  #: "error" or "warning"
    file: str  #: "" if it was not found in a file
    line: int  #: from 1; 0: the file as a whole
    key: str  #: key concerned; may be ""
    what: str
    remedy: str

    def text(self) -> str:
        """The problem as a sentence, as the command line prints it."""
        place = f"{self.file}:{self.line}: " if self.line else f"{self.file}: " if self.file else ""
        key = f"{self.key}: " if self.key else ""
        remedy = f" {self.remedy}" if self.remedy else ""
        return f"{place}{self.severity}: {key}{self.what}.{remedy}"


class Error(ValueError):
    """An invalid input: a file, a name, a table.

    Its text is what the command line would print; `problems` lists its parts.

    >>> import dihaptic as dh
    >>> dh.load("no-session")
    Traceback (most recent call last):
    ...
    dihaptic.errors.Error: no-session: error: is not a session: it has no session.yaml. Name a folder made by dihaptic.
    """

    def __init__(self, problems: list[Problem]) -> None:
        super().__init__()
        self._take(problems)

    def _take(self, problems: list[Problem]) -> None:
        # Python itself already states that it is an error
        self.args = ("\n".join(problem.text().removeprefix("error: ") for problem in problems),)
        self.problems = problems

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (type(self), self.problems), self.__dict__


def _again(kind: type[Error], problems: list[Problem]) -> Error:
    """An error that another process has raised."""
    again = kind.__new__(kind)
    Error.__init__(again, problems)
    return again


def error(what: str, remedy: str, *, file: str = "", line: int = 0, key: str = "") -> Error:
    """An Error with one problem."""
    return Error([Problem("error", file, line, key, what, remedy)])


def tell(why: Error) -> None:
    """Prints an error as the program's commands do: a line for each problem."""
    print("\n".join(problem.text() for problem in why.problems), file=sys.stderr)


def shorten_warnings() -> None:
    """From now on, a warning is printed as the program's commands print it: without the line of Python that gave it."""
    warnings.formatwarning = lambda message, *_: f"{message}\n"


@contextmanager
def interruptible() -> Iterator[None]:
    """Ctrl-C within this raises KeyboardInterrupt once, even if a library makes an error of its own of it.

    pandas, for instance, would report that a file cannot be read. A second Ctrl-C would interrupt the orderly end, and
    leave a pool of processes waiting for itself. For commands: it needs Python's main thread.
    """
    came = False

    def interrupt(*_: object) -> None:
        nonlocal came
        if not came:
            came = True
            raise KeyboardInterrupt

    before = signal.signal(signal.SIGINT, interrupt)
    try:
        yield
    except Exception:
        if came:
            raise KeyboardInterrupt from None
        raise
    finally:
        signal.signal(signal.SIGINT, before)


class NotThere(Error, KeyError):
    """A session, or a world, has nothing with that name.

    >>> import dihaptic as dh
    >>> session = dh.load(lift_session)
    >>> session["gripforce"]
    Traceback (most recent call last):
    ...
    dihaptic.errors.NotThere: gripforce: is not recorded. Did you mean 'grip_force'? Session.quantities lists them.
    """

    __str__ = Exception.__str__  # a KeyError would put quotes around its text

    def __init__(self, name: str, what: str, candidates: list[str], remedy: str) -> None:
        import difflib

        near = difflib.get_close_matches(name, candidates, n=1)
        hint = f"Did you mean '{near[0]}'? " if near else ""
        super().__init__([Problem("error", "", 0, name, what, hint + remedy)])
