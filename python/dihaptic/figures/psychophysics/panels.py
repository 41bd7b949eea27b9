"""What figures with a panel for each procedure have in common: their panels, axes of levels, labels, legends and captions."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, MaxNLocator, NullLocator

from ..data import Data
from ..saving import Plan
from ..style import COLOURS, MARKERS, WIDTHS, canvas, wrapped
from ..words import counted, in_print, level
from .procedures import ALL, Procedure, answers_of, fits_of, text_of

#: Maximum number of panels in a figure.
_MOST_PANELS = 9
LINES: list[Any] = ["-", (0, (5, 1.5)), (0, (1.5, 1)), (0, (6, 1.5, 1.5, 1.5)), (0, (3, 1)), (0, (1, 2)), (0, (8, 2))]
#: Steps of round numbers on an axis.
_STEPS = [1, 2, 2.5, 5, 10]


def panels_of(points: pd.DataFrame, size: str, height_mm: float) -> tuple[Figure, list[tuple[Axes, pd.DataFrame]]]:
    """A panel for each procedure, with its points."""
    names = list(dict.fromkeys(points["procedure"]))
    columns = _columns(len(names), size)
    rows = -(-len(names) // columns)
    # in a figure with one row, names and a legend take a larger part of the height
    figure, all_axes = canvas(size, height_mm * rows + 8, rows, columns)
    for axes in all_axes[len(names) :]:
        axes.set_visible(False)
    panels = []
    for axes, name in zip(all_axes, names):
        panels.append((axes, points[points["procedure"] == name]))
        if len(names) > 1:
            axes.set_title(wrapped(str(name), max(10, int((WIDTHS[size] / columns - 14) / 1.6))))
    return figure, panels


def _columns(panels: int, size: str) -> int:
    return 1 if size == "one column" else {1: 1, 2: 2, 4: 2}.get(panels, 3)


def level_axes(panels: list[tuple[Axes, pd.DataFrame]], axis: str) -> None:
    """Sets the axes of levels: axes of the same quantity have the same limits, and are logarithmic if its levels are."""
    keys = [tuple(own[["quantity", "unit", "logarithmic"]].fillna("").iloc[0]) for _, own in panels]
    for key in dict.fromkeys(keys):
        some = [(axes, own) for (axes, own), other in zip(panels, keys) if other == key]
        logarithmic = bool(key[2]) and all(bool((own["level"].dropna() > 0).all()) for _, own in some)
        shown = pd.concat([_extent(own, logarithmic) for _, own in some])
        low, high = (float(shown.min()), float(shown.max())) if len(shown) else (0.0, 1.0)
        # a panel with a single level needs a width, too
        margin = 0.07 * (high - low) or 0.1 * (abs(high) or 1)
        limits = [10**end if logarithmic else end for end in (low - margin, high + margin)]
        for axes, _ in some:
            if logarithmic:
                axes.set(**{f"{axis}scale": "log"})
            axes.set(**{f"{axis}lim": limits})
            if logarithmic:
                log_ticks(getattr(axes, f"{axis}axis"), *limits)
            else:
                getattr(axes, f"{axis}axis").set_major_locator(MaxNLocator(5, steps=_STEPS))


def _extent(own: pd.DataFrame, logarithmic: bool) -> pd.Series:
    """The range that an axis of levels, or of their logarithms, has to show: an interval may end far from all levels."""
    levels = own["level"].dropna().astype(float)
    mean = own[own["of"] == "mean"]
    ends = pd.concat([mean["low"], mean["high"]]).dropna().astype(float) if "low" in own else pd.Series(dtype=float)
    if logarithmic:
        levels, ends = np.log10(levels), np.log10(ends[ends > 0])
    room = 0.25 * (levels.max() - levels.min())
    return pd.concat([levels, ends.clip(levels.min() - room, levels.max() + room)])


def log_ticks(axis: Any, low: float, high: float) -> None:
    """Ticks at round numbers of a logarithmic axis."""
    decades = range(int(np.floor(np.log10(low))) - 1, int(np.ceil(np.log10(high))) + 1)
    ticks: list[float] = []
    for steps in ([1], [1, 3], [1, 2, 5]):
        ticks = [float(f"{step}e{decade}") for decade in decades for step in steps if low <= float(f"{step}e{decade}") <= high]
        if len(ticks) >= 3:
            break
    if len(ticks) < 2:
        ticks = [float(tick) for tick in MaxNLocator(4, steps=_STEPS).tick_values(low, high) if low <= tick <= high]
    axis.set_major_locator(FixedLocator(ticks))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))


def quantity(own: pd.DataFrame) -> str:
    """The quantity of a panel's levels, with its unit."""
    row = own.iloc[0]
    unit = text_of(row["unit"])
    return f"{row['quantity']} [{in_print(unit)}]" if unit and unit != "1" else str(row["quantity"])


def label_all(panels: list[tuple[Axes, pd.DataFrame]], *, x: str | None, y: str | None, size: str) -> None:
    """Labels of all panels; None: the quantity of the levels.

    A label equal to that of the panel to the left is not repeated.
    """
    columns = _columns(len(panels), size)
    width = WIDTHS[size] / columns
    for i, (axes, own) in enumerate(panels):
        xlabel, ylabel = (x if x is not None else quantity(own)), (y if y is not None else quantity(own))
        below = panels[i + columns][1] if i + columns < len(panels) else None
        if below is None or (x is None and quantity(below) != xlabel):
            axes.set_xlabel(wrapped(xlabel, int((width - 12) / 1.5)))
        left = panels[i - 1][1] if i % columns else None
        if left is None or (y is None and quantity(left) != ylabel):
            axes.set_ylabel(wrapped(ylabel, 30))


def groups_in(points: pd.DataFrame) -> list[str]:
    return list(dict.fromkeys(points["group"].fillna("").astype(str)))


def group_marks(groups: list[str], marked: bool = True) -> list[tuple[str, Line2D]]:
    """Names and lines of groups in a legend; none for a single one."""
    if len(groups) == 1:
        return []
    return [
        (
            level(group) or "no group",
            Line2D([], [], color=COLOURS[i % 7], linestyle=LINES[i % 7], marker=MARKERS[i % 7] if marked else ""),
        )
        for i, group in enumerate(groups)
    ]


# Plans of figures


def parted(name: str, procedures: list[Procedure]) -> Iterator[tuple[str, list[Procedure]]]:
    """Names of figures, with the procedures of each: as many as fit."""
    figures = -(-len(procedures) // _MOST_PANELS)
    each = -(-len(procedures) // max(1, figures))  # about as many in each
    for first in range(0, len(procedures), max(1, each)):
        number = f"-{first // each + 1}" if figures > 1 else ""
        yield name + number, procedures[first : first + each]


def counts_in_words(data: Data, procedures: list[Procedure]) -> str:
    """The numbers of people and of their answers."""
    single = [each for each in procedures if each.kind != ALL]
    answers = [answers_of(data, each) for each in single or procedures]
    people = len({person for own in answers for person in own["person"]})
    return f"{counted(people, 'person', 'people')}, {counted(sum(map(len, answers)), 'answer')}"


def guesses_in_words(data: Data, procedures: list[Procedure]) -> str:
    """A sentence about thresholds that are not drawn."""
    guesses = sum(int(fits["guess"].sum()) for fits in (fits_of(data, each) for each in procedures))
    if not guesses:
        return ""
    verb = "is" if guesses == 1 else "are"
    return f" {counted(guesses, 'threshold is a guess', 'thresholds are guesses')}, as thresholds.csv notes, and {verb} left out."


def people_with_thresholds(data: Data, procedures: list[Procedure]) -> pd.Series:
    """How many people of each group have a threshold that is not a guess, for each procedure."""
    fits = [fits_of(data, each).assign(procedure=each.title) for each in procedures]
    known = pd.concat([each[~each["guess"].astype(bool)] for each in fits if len(each)] or [pd.DataFrame()])
    return known.groupby(["procedure", "group"])["person"].nunique() if len(known) else pd.Series(dtype=int)


def size_option(panels: int) -> dict[str, Any]:
    return {"size": "two columns" if panels > 1 else "one column"}


def plan_of(data: Data, name: str, title: str, what: str, some: list[Procedure], points: Any, drawing: Any) -> Plan:
    """A figure with a panel for each of some procedures; `what` says what it shows."""
    return Plan(
        name=name,
        title=title,
        caption=f"{what} {counts_in_words(data, some)}.{guesses_in_words(data, some)}",
        points=points,
        points_options={"procedures": [each.title for each in some]},
        drawing=drawing,
        drawing_options=size_option(len(some)),
    )
