"""How the conditions of lifts look in a figure: their colours, dashes and markers, and the legend."""

from __future__ import annotations

from typing import Any

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ...errors import error
from ..style import COLOURS, MARKERS, legend_above

_DASHES: list[Any] = ["-", (0, (5, 1.5)), (0, (1.5, 1)), (0, (6, 1.5, 1.5, 1.5)), (0, (3, 1)), (0, (6, 1.5, 1.5, 1.5, 1.5, 1.5))]
#: Conditions that are named after a colour are drawn in that colour.
_OF_COLOURS = {"blue": 0, "red": 1, "green": 2, "pink": 3, "orange": 4, "yellow": 4, "black": 6}


def with_values(points: pd.DataFrame, value: str) -> pd.DataFrame:
    """The points whose panel, measure or phase has any value. Raises Error when there are none."""
    if points.empty or not points[value].notna().any():
        raise error("has no values to draw", "Draw only what has at least one complete lift.", key="points")
    for column in ("quantity", "measure", "phase"):
        if column in points:
            some = points.loc[points[value].notna(), column].unique()
            points = points[points[column].isin(some)]
    return points


def looks_of(cases: list[str]) -> dict[str, tuple[str, Any, str]]:
    """The colour, dashes and marker of each condition."""
    taken = {case: _OF_COLOURS[case] for case in cases if case in _OF_COLOURS}
    free = [i for i in range(len(COLOURS)) if i not in taken.values()] or [0]
    out: dict[str, tuple[str, Any, str]] = {}
    for case in cases:
        used = len([name for name in out if name not in taken])
        i = taken[case] if case in taken else free[used % len(free)]
        out[case] = (COLOURS[i], _DASHES[len(out) % len(_DASHES)], MARKERS[i])
    return out


def legend_of_cases(
    figure: Figure, cases: list[str], title: str, *, marks: bool, dashed: bool = True, more: list[Any] | None = None,
    names: list[str] | None = None,
) -> None:  # fmt: skip
    """Adds a legend of the conditions and of `more`, if it has several entries, or if its title names what they are."""
    looks = looks_of(cases)
    handles = [Line2D([], [], color=hue, linestyle=dashes if dashed else "-", marker=marker if marks else None, markersize=4)
               for hue, dashes, marker in looks.values()]  # fmt: skip
    texts = [shortened(case, int(25.4 * figure.get_figwidth() / 1.7)) for case in looks]
    if cases == [""]:
        handles, texts, title = [], [], ""
    handles, texts = [*handles, *(more or [])], [*texts, *(names or [])]
    if handles:
        legend_above(figure, handles, texts, title)


def shortened(text: str, most: int = 34) -> str:
    """A long name with its middle cut out, since names of conditions often differ at their ends."""
    half = (most - 1) // 2
    return text if len(text) <= most else f"{text[:half]}…{text[-half:]}"
