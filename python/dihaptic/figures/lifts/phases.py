"""Durations of the phases of a lift."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from ..data import Data
from ..saving import Plan
from ..style import COLOURS, MARKERS, canvas, drawing, of_data
from .looks import shortened, with_values
from .selection import all_lifts, counting, counts_in_words, named, texts, word

#: Phases of a lift, and their columns of lifts.csv.
PHASES = {"preload": "preload_s", "loading": "loading_s", "releasing": "releasing_s"}
#: Maximum number of conditions one below another.
_MOST_ROWS = 24


@of_data
def lift_phases(data: Data, *, colour: list[str] | None = None, catch: bool = False) -> pd.DataFrame:
    """Durations of preload, loading and releasing [s] by condition, from lifts.csv.

    A row has the phase, the condition, and `of`: "person", if `value` is a person's median over n lifts (or a lift, if
    there is one person); or "median", if it is the median over n people or lifts, with the quartiles `low` and `high`.
    For the other options see lift_curves().

    >>> from dihaptic import figures
    >>> list(dict.fromkeys(lift_phases(figures.read(lift_session))["phase"]))
    ['preload', 'loading', 'releasing']
    """
    frame = named(data, counting(all_lifts(data), catch), colour or [], "", _MOST_ROWS)
    frame = frame.assign(condition=frame["case"])
    single = frame["person"].nunique() == 1
    parts = []
    for phase, column in PHASES.items():
        known = frame[frame[column].notna()].rename(columns={column: "value"})
        each = known[["condition", "person", "value"]].assign(n=1)
        if not single:
            each = known.groupby(["condition", "person"], sort=False)["value"].agg(value="median", n="count").reset_index()
        groups = each.groupby("condition", sort=False)["value"]
        middle = groups.agg(value="median", n="count")
        middle["low"], middle["high"] = groups.quantile(0.25), groups.quantile(0.75)
        parts += [each.assign(phase=phase, of="person"), middle.reset_index().assign(phase=phase, of="median")]
    columns = ["phase", "condition", "of", "person", "n", "value", "low", "high"]
    out = pd.concat(parts, ignore_index=True).reindex(columns=columns)
    rank = {case: i for i, case in enumerate(texts(frame, "condition"))}
    out = out.sort_values("condition", key=lambda cases: cases.map(rank), kind="stable")
    return out.sort_values("phase", key=lambda names: names.map(list(PHASES).index), kind="stable").reset_index(drop=True)


@drawing
def draw_lift_phases(
    points: pd.DataFrame, *, ordinate: str = "", size: str = "two columns", height_mm: float = 0
) -> Figure:
    """Draws lift_phases(), with a panel for each phase and, for each condition, a line of dots with median and quartiles.

    `ordinate` names the conditions; a height of 0 depends on their number. Raises Error when there are no points.

    >>> from dihaptic import figures
    >>> figure = draw_lift_phases(figures.lift_phases(figures.read(lift_session)))
    >>> [axes.get_title("left") for axes in figure.axes]
    ['preload', 'loading', 'releasing']
    """
    points = with_values(points, "value")
    phases, cases = texts(points, "phase"), texts(points, "condition")
    points = points.assign(condition=points["condition"].fillna(""))
    place = {case: i for i, case in enumerate(cases)}
    figure, axes = canvas(size, height_mm or 22 + max(4.5 * len(cases), 10), 1, len(phases), sharey=True)
    for i, (here, phase) in enumerate(zip(axes, phases)):
        own = points[points["phase"] == phase]
        for case, part in own.groupby("condition", sort=False):
            dots, middle = part[part["of"] == "person"], part[part["of"] == "median"]
            hue, marker = COLOURS[i], MARKERS[i]
            beside = place[case] + 0.18 + 0.04 * (np.arange(len(dots)) % 4)  # keeps dots at the same place countable
            here.plot(1000 * dots["value"], beside, ".", color=hue, alpha=0.45, markersize=4, markeredgewidth=0)
            value, low, high = 1000 * middle[["value", "low", "high"]].to_numpy().T
            height = [place[case] - 0.1] * len(middle)
            here.errorbar(
                value, height, fmt=marker, color=hue, elinewidth=1.2, markersize=4, xerr=np.array([value - low, high - value])
            )  # fmt: skip
        here.set_title(phase)
        here.set_xlabel("duration [ms]")
        here.set_xlim(left=0)
    axes[0].set_yticks(list(place.values()), [shortened(case) for case in place])
    axes[0].set_ylim(len(cases) - 0.4, -0.6)
    if ordinate:
        axes[0].set_ylabel(ordinate)
    if cases == [""]:
        axes[0].set_yticks([])
    return figure


def plan_of_phases(
    data: Data, frame: pd.DataFrame, kept: pd.DataFrame, options: dict[str, Any], rows: list[str], catch: bool
) -> Plan:
    """The figure of durations of the lifts `kept`, with a row for each level of the columns `rows`."""
    ordinate = {"ordinate": ", ".join(map(word, rows))} if rows and "presented" not in rows else {}
    return Plan(
        name="lift-phases", title="Durations of the phases of a lift",
        caption=f"From touch to load onset (preload), from the last digit's load onset to lift-off (loading), and from "
        f"replacement to release (releasing). Dots are {_dots(kept)}; marks are medians with quartiles. "
        f"{counts_in_words(data, frame, catch, rows, '', _MOST_ROWS)}",
        points=lift_phases, points_options={**options, **({"colour": rows} if rows else {})},
        drawing=draw_lift_phases,
        drawing_options=ordinate,
    )  # fmt: skip


def _dots(kept: pd.DataFrame) -> str:
    return "lifts" if kept["person"].nunique() == 1 else "people's medians over lifts"
