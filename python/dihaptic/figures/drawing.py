"""Chooses the figures that an experiment's design calls for, and makes them."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path

from ..errors import Error
from . import conditions, learning, lifts, paths, psychophysics, quality
from .data import Data, read
from .saving import Plan, is_changed, save, write
from .statistics import write_analyses

#: Each kind of figure: a module with `plans(data)`, in the order in which figures are listed.
KINDS = [conditions, lifts, learning, paths, psychophysics, quality]


def plans(data: Data) -> Iterator[Plan]:
    """The figures that this experiment's design calls for."""
    for kind in KINDS:
        yield from kind.plans(data)


def draw(path: str | Path, out: str | Path | None = None, *, progress: Callable[[str], None] | None = None) -> list[Path]:
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
    folder = folder.absolute()
    scripts, captions = [], []
    for plan in plans(data):
        script = folder / f"{plan.name}.py"
        text = plan.script(data, folder).encode()
        scripts.append(script)
        captions.append(f"{plan.name}: {plan.title}. {plan.caption}\n")
        if script.exists() and is_changed(script):
            kept = f"{script.name} has been changed, so its figure is left as it is; remove the script to have it drawn anew"
            warnings.warn(kept, stacklevel=2)
            continue
        if progress is not None:
            progress(plan.title)
        points, figure = plan.make(data)
        save(figure, folder / plan.name, points)
        write(script, text)
    if captions:
        write(folder / "captions.txt", "\n".join(captions).encode())
    write_analyses(data, folder)
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
    warnings.formatwarning = lambda message, *_: f"{message}\n"  # for somebody who has typed a command
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
