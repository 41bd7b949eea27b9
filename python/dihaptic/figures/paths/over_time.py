"""Curves of reaches against time from movement onset: their median and quartiles, and the panels in which they are drawn."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..style import WIDTHS, canvas, wrapped
from .reaches import STEP
from .sheets import name_of

if TYPE_CHECKING:
    from .reaches import Array

#: Share of reaches that must still last for a median to be drawn: with fewer, it would jump where one of them ends.
_LASTING = 0.75


def quartiles(curves: list[tuple[float, Array]], unit: str) -> pd.DataFrame:
    """Median and quartiles of curves that begin at different times, while at least three quarters of them last."""
    first = min(round(begin / STEP) for begin, _ in curves)
    length = max(round(begin / STEP) - first + len(values) for begin, values in curves)
    table = np.full((len(curves), length), math.nan)
    for row, (begin, values) in zip(table, curves):
        place = round(begin / STEP) - first
        row[place : place + len(values)] = values
    n = np.isfinite(table).sum(axis=0)
    kept = (n >= _LASTING * len(curves)) & (n > 0)
    lower, median, upper = np.nanpercentile(table[:, kept], [25, 50, 75], axis=0)
    return pd.DataFrame({
        "time_s": np.round(STEP * (first + np.flatnonzero(kept)), 6), "n": n[kept], "of_n": len(curves),
        f"median_{unit}": median, f"lower_{unit}": lower, f"upper_{unit}": upper,
    })  # fmt: skip


def time_panels(panels: list[str], size: str, height_mm: float, legend: bool) -> tuple[Figure, list[Axes], int]:
    """A figure with a panel for each name, all with the same limits, and the number of its columns."""
    most = 4 if size == "two columns" else 2
    rows = -(-len(panels) // most)
    columns = -(-len(panels) // rows)
    figure, all_axes = canvas(size, rows * height_mm + (6 if legend else 0), rows, columns, sharex=True, sharey=True)
    letters = int((WIDTHS[size] - 12) / columns / 1.7)
    narrow = letters < 36
    for i, axes in enumerate(all_axes):
        axes.set_visible(i < len(panels))
        if i < len(panels) and len(panels) > 1:
            axes.set_title(wrapped(name_of(panels[i]), letters))
        if i < len(panels) and i + columns >= len(panels):
            axes.set_xlabel("time from onset [s]" if narrow else "time from movement onset [s]")
            axes.tick_params(axis="x", labelbottom=True)
        axes.locator_params(axis="x", nbins=4 if columns > 2 else 6)
    return figure, all_axes, columns
