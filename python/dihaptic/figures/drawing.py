"""Chooses the figures that an experiment's design calls for, and makes them."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from pathlib import Path

from ..errors import Error
from . import conditions, learning, lifts, paths
from .data import Data, read
from .saving import Plan, save

#: Each kind of figure: a module with `plans(data)`, in the order in which figures are listed.
KINDS = [conditions, lifts, learning, paths]


def plans(data: Data) -> Iterator[Plan]:
    """The figures that this experiment's design calls for."""
    for kind in KINDS:
        yield from kind.plans(data)


def draw(path: str | Path, out: str | Path | None = None, *, progress: Callable[[str], None] | None = None) -> list[Path]:
    """Draws all figures that the experiment of these sessions calls for, and returns the scripts that draw each anew.

    `path` is a session's folder, a rehearsal's, a study's file, or a folder with sessions of one experiment; `out` is the
    folder for the figures, by default `figures` beside the tables. Raises Error.

    >>> from dihaptic import figures
    >>> all(script.suffix == ".py" for script in figures.draw(lift_session))
    True
    """
    data = read(path)
    folder = Path(out) if out is not None else data.folder / "figures"
    folder = folder.absolute()
    scripts = []
    for plan in plans(data):
        if progress is not None:
            progress(plan.title)
        points, figure = plan.make(data)
        save(figure, folder / plan.name, points)
        script = folder / f"{plan.name}.py"
        script.write_text(plan.script(data, folder), encoding="utf-8")
        scripts.append(script)
    return scripts


def main(words: list[str]) -> int:
    """`python3 -m dihaptic.figures PATH [OUT]`."""
    if not 1 <= len(words) <= 2 or words[0] in ("-h", "--help"):
        print(
            "Draw the figures that an experiment calls for\n"
            "Usage: python3 -m dihaptic.figures SESSION|REHEARSAL|STUDY.yaml|FOLDER [OUT]\n\n"
            "Example:\n  python3 -m dihaptic.figures rehearsals/grip-and-lift_1"
        )
        return 0 if words and words[0] in ("-h", "--help") else 2
    try:
        scripts = draw(*words, progress=lambda title: print(title, file=sys.stderr))
    except Error as why:
        print("\n".join(problem.text() for problem in why.problems), file=sys.stderr)
        return 1
    if not scripts:
        print(f"{words[0]}: its experiment has nothing that a figure shows", file=sys.stderr)
        return 0
    print(f"{scripts[0].parent}: {', '.join(script.stem for script in scripts)}")
    return 0
