"""What tests of figures share: short rehearsals, data with other tables, and the check that figures can be read."""

import io
import unittest
import warnings
from pathlib import Path

import pandas as pd
from boxes import faults
from matplotlib.text import Text

import dihaptic as dh
from dihaptic import figures
from dihaptic.program import call


def rehearsed(name, folder, people, fewer=(), **options):
    """A rehearsal of a shipped experiment with its tables, into a folder of its name.

    `fewer` are pairs of words in its file and of those in their place, such as fewer repeats: trials take the program longer
    than figures of them take to be drawn.
    """
    file, out = Path("experiments", f"{name}.yaml"), Path(folder, name)
    if fewer:
        text = file.read_text(encoding="utf-8").replace("../", f"{Path.cwd()}/")
        for before, after in fewer:
            assert before in text, before
            text = text.replace(before, after)
        file = out.with_suffix(".yaml")
        file.write_text(text, encoding="utf-8")
    dh.rehearse(str(file), people, out=out, progress=False, **options)
    call(["report", str(out), "--tables"], progress=False)
    return out


def with_tables(path, **tables):
    """The data of a folder, with other tables in place of its own."""
    data = figures.read(path)
    for name, table in tables.items():
        table.attrs = data.table(name).attrs
        data.__dict__["_cache"][name] = table
    return data


def drawn_again(plan, points, data):
    """The figure of points that were kept in a file, which has no types."""
    kept = pd.read_csv(io.StringIO(points.to_csv(index=False)), float_precision="round_trip")
    kept.attrs["mark"] = data.mark
    return plan.drawing(kept, **plan.drawing_options)


def likeness(figure):
    """What two figures of the same points have in common: size, ranges of axes, and texts, but for those of ticks."""
    axes = figure.axes
    ticks = {id(t) for a in axes for axis in (a.xaxis, a.yaxis) for t in axis.findobj(Text) if t is not axis.label}
    texts = [text.get_text() for text in figure.findobj(Text) if id(text) not in ticks]
    return tuple(figure.get_size_inches()), [(a.get_xlim(), a.get_ylim()) for a in axes], texts


class Drawn(unittest.TestCase):
    """Tests of a kind of figure: a module with plans(data)."""

    def check(self, kind, data, expected=None, kept=False, damaged=False):
        """All figures of these data can be read, and are made without a warning; returns their plans, points and figures.

        `expected` are the names of all figures. With `kept`, points that were kept in a file give the same figure. Of
        `damaged` data, warnings may tell.
        """
        made = {}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore" if damaged else "error")
            for plan in kind.plans(data):
                points, figure = plan.make(data)
                with self.subTest(plan.name):
                    self.assertFalse(points.empty)
                    self.assertEqual(faults(figure), [])
                    if kept:
                        self.assertEqual(likeness(drawn_again(plan, points, data)), likeness(figure))
                self.assertNotIn(plan.name, made)
                made[plan.name] = plan, points, figure
        if expected is not None:
            self.assertEqual(list(made), expected)
        return made
