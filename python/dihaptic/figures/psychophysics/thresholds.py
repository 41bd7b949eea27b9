"""Thresholds and Weber fractions of people, procedure by procedure."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...errors import NotThere
from ..data import Data
from ..means import BY_T, intervals
from ..saving import Plan
from ..style import COLOURS, MARKERS, WIDTHS, canvas, drawing, faint, fit_names, legend_above, of_data, wrapped
from .panels import (
    counts_in_words,
    group_marks,
    groups_in,
    log_ticks,
    guesses_in_words,
    parted,
    people_with_thresholds,
    quantity,
    size_option,
)
from .procedures import Procedure, chosen, finished, fits_of, mean_of

_THRESHOLD = ["measure", "quantity", "unit", "logarithmic", "procedure", "group", "of", "person", "n", "value", "low", "high"]


@of_data
def thresholds_by_procedure(
    data: Data, *, measure: str = "threshold_share", procedures: list[str] | None = None
) -> pd.DataFrame:
    """A measure of thresholds.csv for each person and procedure, and its means over people.

    `measure`: threshold_share, the threshold in the unit of the level; weber_fraction; or mean_of_reversals. A row has
    its procedure and group, and `of`: "person", or "mean" over n people with its 95 % interval (Student's t); the
    geometric mean, where `logarithmic`. Thresholds that are guesses are left out. Raises NotThere, or Error when
    there is none.

    >>> from dihaptic import figures
    >>> thresholds_by_procedure(figures.read(lift_session))
    Traceback (most recent call last):
    ...
    dihaptic.errors.Error: ...has no trials of a procedure. Name a session whose task has procedures.
    """
    known = ["threshold_share", "weber_fraction", "mean_of_reversals"]
    if measure not in known:
        raise NotThere(measure, "is not a measure of thresholds.csv", known, f"Measures are {', '.join(known)}.")
    rows: list[dict[str, Any]] = []
    for procedure in chosen(data, procedures):
        fits = fits_of(data, procedure)
        if fits.empty or measure not in fits:
            continue
        if measure != "mean_of_reversals":
            fits = fits[~fits["guess"]]
        fits = fits[np.isfinite(fits[measure].astype(float))]
        logarithmic = procedure.logarithmic and measure != "weber_fraction"
        if logarithmic:
            fits = fits[fits[measure] > 0]
        head: dict[str, Any] = {"measure": measure, "quantity": procedure.quantity, "unit": procedure.unit}
        head["procedure"] = procedure.title
        if measure == "weber_fraction":
            head |= {"quantity": "Weber fraction", "unit": ""}
        head["logarithmic"] = logarithmic
        each = fits.groupby(["group", "person"], sort=False)[measure].agg(["mean", "count"]).reset_index()
        for row in each.to_dict("records"):
            own = {"group": row["group"], "person": row["person"], "n": row["count"], "value": row["mean"]}
            rows.append({**head, "of": "person", **own})
        for group, people in each.groupby("group", sort=False):
            rows.append({**head, "group": group, "of": "mean", **mean_of(people["mean"], logarithmic)})
    return finished(rows, _THRESHOLD, procedures)


@drawing
def draw_thresholds(points: pd.DataFrame, *, size: str = "one column", height_mm: float = 60) -> Figure:
    """Draws thresholds_by_procedure(): people as dots, and means with intervals, with a panel for each quantity, and a
    colour for each group.

    Where all people did all procedures of a panel, a line joins each one's dots.

    >>> import pandas as pd
    >>> row = {"measure": "threshold_share", "quantity": "period", "unit": "mm", "logarithmic": False, "procedure": "ring finger"}
    >>> dots = [{**row, "group": "", "of": "person", "person": f"p{i}", "n": 1, "value": 2.5 + i / 10} for i in range(4)]
    >>> draw_thresholds(pd.DataFrame(dots)).axes[0].get_ylabel()
    'threshold: period [mm]'
    """
    points = points.reindex(columns=list(dict.fromkeys([*_THRESHOLD, *points.columns])))
    keys = ["quantity", "unit", "logarithmic"]
    panels = [own for _, own in points.assign(unit=points["unit"].fillna("")).groupby(keys, sort=False)]
    groups = groups_in(points)
    columns = min(len(panels), 1 if size == "one column" else 3)
    rows = -(-len(panels) // columns)
    figure, all_axes = canvas(size, height_mm * rows, rows, columns)
    for axes in all_axes[len(panels) :]:
        axes.set_visible(False)
    for axes, own in zip(all_axes, panels):
        names = list(dict.fromkeys(own["procedure"]))
        for i, group in enumerate(groups):
            _people_and_mean(axes, own[own["group"].fillna("") == group], names, i, len(groups))
        axes.set_xticks(range(len(names)), [str(name) for name in names])
        axes.set_xlim(-0.5, len(names) - 0.5)
        fit_names(axes, WIDTHS[size] / columns)
        if bool(own["logarithmic"].iloc[0]):
            axes.set_yscale("log")
            log_ticks(axes.yaxis, *axes.get_ylim())
        what = {"threshold_share": "threshold: ", "mean_of_reversals": "mean of reversals: "}.get(own["measure"].iloc[0], "")
        axes.set_ylabel(wrapped(what + quantity(own), 30))
    if len(groups) > 1:
        marks = group_marks(groups)
        legend_above(figure, [handle for _, handle in marks], [name for name, _ in marks])
    return figure


def _people_and_mean(axes: Axes, own: pd.DataFrame, names: list[str], i: int, groups: int) -> None:
    """Draws a group's people as dots, joined over procedures, and their means beside them."""
    hue, marker = COLOURS[i % len(COLOURS)], MARKERS[i % len(MARKERS)]
    step = 0.8 / (groups + 1)
    aside = (i - (groups - 1) / 2) * step
    places = {name: place + aside for place, name in enumerate(names)}
    people = own[own["of"] == "person"]
    opacity = faint(people["person"].nunique())
    for _, each in people.groupby("person", sort=False):
        each = each.assign(at=each["procedure"].map(places)).sort_values("at")
        joined = groups == 1 and len(each) > 1
        axes.plot(each["at"], each["value"], color=hue, alpha=opacity, linewidth=0.5 if joined else 0, marker="o", markersize=2.5)
    mean = own[own["of"] == "mean"]
    at = mean["procedure"].map(places) + 0.3 * step
    errors = np.array([(mean["value"] - mean["low"]).fillna(0), (mean["high"] - mean["value"]).fillna(0)])
    axes.errorbar(
        at, mean["value"], errors, color=hue, marker=marker, markersize=5, capsize=2, linestyle="", elinewidth=1.2, zorder=3
    )  # fmt: skip


def plans_of_thresholds(data: Data, procedures: list[Procedure]) -> Iterator[Plan]:
    if len(data.people) < 2 or not data.has("thresholds"):
        return
    words = {"threshold_share": ("thresholds", "Thresholds"), "weber_fraction": ("weber-fractions", "Weber fractions")}
    for measure, (name, title) in words.items():
        inside = {each.title: fits_of(data, each) for each in procedures}
        drawn = [
            each for each in procedures
            if measure in inside[each.title] and (~inside[each.title]["guess"] & inside[each.title][measure].notna()).any()
        ]  # fmt: skip
        most = [inside[each.title][~inside[each.title]["guess"]]["person"].nunique() for each in drawn]
        if max(most, default=0) < 2:
            continue  # a dot and its own mean show nothing
        for part, some in parted(name, drawn):
            kinds = {(each.quantity, each.unit, each.logarithmic) for each in some}
            quantities = len(kinds) if measure == "threshold_share" else 1
            joined = ", joined over procedures" * (len(some) > 1 and len(data.table("thresholds")["group"].unique()) == 1)
            geometric = " (geometric where the axis is logarithmic)" * any(each.logarithmic for each in some)
            yield Plan(
                name=part,
                title=f"{title} by procedure",
                caption=f"Dots are people{joined}; marks are means{geometric}{intervals(people_with_thresholds(data, some), BY_T)}. "
                f"{counts_in_words(data, some)}.{guesses_in_words(data, procedures)}",
                points=thresholds_by_procedure,
                points_options={"measure": measure, "procedures": [each.title for each in some]},
                drawing=draw_thresholds,
                drawing_options=size_option(max(quantities, 2 if len(some) > 3 else 1)),
            )
