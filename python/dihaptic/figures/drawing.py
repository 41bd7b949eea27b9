"""Chooses the figures that an experiment's design calls for, and makes them."""

from __future__ import annotations

import gc
import os
import signal
import sys
import warnings
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_all_start_methods, get_context
from pathlib import Path

from .._parent import end_with
from ..errors import Error, shorten_warnings, tell
from . import conditions, fitts, learning, lifts, paths, psychophysics, quality
from .data import Data, read
from .people import write_means
from .saving import Plan, is_changed, save, write
from .sessions import Paths
from .statistics import write_analyses

#: The kinds of figures, each a module with `plans(data)` and a HEADING, in the order in which figures are listed.
KINDS = [fitts, conditions, lifts, learning, paths, psychophysics, quality]


def draw(path: Paths, out: str | Path | None = None, *, progress: Callable[[str], None] | None = None) -> list[Path]:
    """Draws all figures that the experiment of these sessions calls for, and returns the scripts that draw each anew.

    `path` is a session's folder, a rehearsal's, a study's file, or a folder with sessions of one experiment; `out` is the
    folder for the figures, by default `figures` beside the tables. Their captions are in captions.txt. A figure whose
    script you have changed is left as it is, with a warning. Raises Error.

    >>> from dihaptic import figures
    >>> all(script.suffix == ".py" for script in figures.draw(lift_session))
    True
    """
    data = read(path)
    folder = Path(out) if out is not None else data.folder / "figures"
    return [drawn.script for drawn in draw_data(data, folder, progress=progress)]


@dataclass(frozen=True)
class Drawn:
    """A figure whose files are in a folder."""

    plan: Plan
    heading: str  #: heading above it on the page, e.g. "Learning"
    script: Path
    kept: bool  #: whether the figure was left as it is because its script had been changed


def draw_data(
    data: Data, folder: str | Path, *, jobs: int = 1, progress: Callable[[str], None] | None = None
) -> list[Drawn]:
    """Does what draw() does, for data that have been read, in `jobs` processes. Raises Error."""
    folder = Path(folder).absolute()
    made = []
    for kind in KINDS:
        for plan in kind.plans(data):
            script = folder / f"{plan.name}.py"
            made.append(Drawn(plan, plan.heading or kind.HEADING, script, is_changed(script)))
    for each in made:
        if each.kept:
            name = each.script.name
            what = f"{name} has been changed, so its figure is left as it is; remove the script to have it drawn anew"
            warnings.warn(what, stacklevel=2)
    for title in _save_all([each for each in made if not each.kept], data, folder, jobs):
        if progress is not None:
            progress(title)
    if made:
        captions = "\n".join(f"{each.plan.name}: {each.plan.title}. {each.plan.caption}\n" for each in made)
        write(folder / "captions.txt", captions.encode())
    write_analyses(data, folder)
    write_means(data, folder)
    return made


def _save_all(made: list[Drawn], data: Data, folder: Path, jobs: int) -> Iterator[str]:
    """Makes and saves these figures, and yields the title of each when it is done."""

    def save_one(i: int) -> str:
        plan = made[i].plan
        points, figure = plan.make(data)
        save(figure, folder / plan.name, points)
        write(made[i].script, plan.script(data, folder).encode())
        return plan.title

    if min(jobs, len(made)) < 2 or "fork" not in get_all_start_methods():
        yield from map(save_one, range(len(made)))
        return
    # forked children already have the data, so nothing is read again, or passed on; what they share with this process is
    # exempt from the garbage collection, which would make each of them copy it
    gc.freeze()
    with ProcessPoolExecutor(jobs, get_context("fork"), _take, (save_one, os.getpid())) as children:
        # a child that gets Ctrl-C before it ignores that signal would carry on as a second parent
        before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        try:
            titles = children.map(_do, range(len(made)))
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)
        yield from titles
    gc.unfreeze()


_work: list[Callable[[int], str]] = []


def _take(work: Callable[[int], str], parent: int) -> None:
    end_with(parent)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent ends its children
    _work.append(work)


def _do(i: int) -> str:
    return _work[-1](i)


def main(words: list[str]) -> int:
    """`python3 -m dihaptic.figures PATH [OUT]`."""
    if not 1 <= len(words) <= 2 or words[0] in ("-h", "--help"):
        print(
            "Draw the figures that an experiment calls for\n"
            "Usage: python3 -m dihaptic.figures SESSION|REHEARSAL|STUDY.yaml|FOLDER [OUT]\n\n"
            "Example:\n  python3 -m dihaptic.figures rehearsals/grip-and-lift_1"
        )
        return 0 if words and words[0] in ("-h", "--help") else 2
    shorten_warnings()
    try:
        scripts = draw(*words, progress=lambda title: print(title, file=sys.stderr))
    except Error as why:
        tell(why)
        return 1
    if not scripts:
        print(f"{words[0]}: its experiment has nothing that a figure shows", file=sys.stderr)
        return 0
    print(f"{scripts[0].parent}: {', '.join(script.stem for script in scripts)}")
    return 0
