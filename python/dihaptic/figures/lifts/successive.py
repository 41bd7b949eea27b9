"""Change of measures over successive lifts."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..data import Data
from ..saving import Plan
from ..style import QUIET, WIDTHS, canvas, drawing, faint, of_data
from ..words import label, level
from .load import slip_ratio
from .looks import legend_of_cases, looks_of, shortened, with_values
from .selection import MOST_CASES, all_lifts, counting, counts_in_words, factors_of, named, texts, word


@of_data
def successive_lifts(
    data: Data, *, measures: list[str], colour: list[str] | None = None, repetition: bool = False, catch: bool = False
) -> pd.DataFrame:
    """Measures of lifts.csv over successive lifts: of each person, and their means over people.

    The lifts are numbered through the session, including practice and incomplete ones, or, with `repetition`, only the
    complete ones of each condition without practice. A row has the measure, its unit, block, condition, number of the lift,
    and `of`: "person", or, with several people, "mean", over n people, if these are at least three quarters of all (and this
    holds for at least half of a condition's numbers). For the other options see lift_curves(). Raises NotThere.

    >>> from dihaptic import figures
    >>> len(successive_lifts(figures.read(lift_session), measures=["safety_margin"]))
    1
    """
    frame = all_lifts(data)
    frame = counting(frame, catch) if repetition else frame[frame["lift"] == "complete"]
    frame = named(data, frame, colour or [], "").sort_values(["lift_number"], kind="stable")
    order = texts(named(data, frame, colour or [], ""), "case")
    frame = frame.assign(block="" if repetition else frame["block"].fillna(""), condition=frame["case"])
    if repetition:
        frame["lift_number"] = frame.groupby(["person", "condition"]).cumcount() + 1
    people = frame["person"].nunique()
    parts = []
    for measure in measures:
        unit = data.measure(measure, "lifts").unit
        known = frame[frame[measure].notna()].rename(columns={"lift_number": "number", measure: "value"})
        each = known[["block", "condition", "person", "number", "value"]].assign(of="person", n=1)
        by = ["block", "condition", "number"]
        mean = each.groupby(by, sort=False)["value"].agg(value="mean", n="count").reset_index().assign(of="mean", person="")
        # if each lift had the mean over different people, differences between people would look like changes
        enough = 4 * mean["n"] >= 3 * people
        common = enough.groupby([mean["block"], mean["condition"]]).transform("mean") >= 0.5
        mean = mean[enough & common]
        both = pd.concat([each, mean]) if people > 1 else each
        parts.append(both.assign(measure=measure, unit=unit))
    columns = ["measure", "unit", "of", "person", "block", "condition", "number", "n", "value"]
    out = pd.concat(parts, ignore_index=True)[columns] if parts else pd.DataFrame(columns=columns)
    rank = {case: i for i, case in enumerate(order)}
    return out.sort_values("condition", key=lambda cases: cases.map(rank), kind="stable").reset_index(drop=True)


@drawing
def draw_successive_lifts(
    points: pd.DataFrame, *, legend: str = "", abscissa: str = "number of the lift", size: str = "two columns",
    height_mm: float = 45,
) -> Figure:  # fmt: skip
    """Draws successive_lifts(), with a panel, `height_mm` [mm] high, for each measure, and the names of blocks above.

    With several people, a condition that makes up most of a block is drawn as thin lines for people and a thick one for
    their mean; other conditions, and one person's lifts, are drawn as marks. Raises Error when there are no points.

    >>> from dihaptic import figures
    >>> points = figures.successive_lifts(figures.read(lift_session), measures=["safety_margin"])
    >>> draw_successive_lifts(points).axes[0].get_ylabel()
    'safety margin'
    """
    points = with_values(points, "value")
    measures, cases = texts(points, "measure"), texts(points, "condition")
    points = points.assign(block=points["block"].fillna(""), condition=points["condition"].fillna(""))
    looks = looks_of(cases)
    figure, axes = canvas(size, height_mm * len(measures) + 12, len(measures), 1, sharex=True)
    for here, measure in zip(axes, measures):
        own = points[points["measure"] == measure]
        for (block, case), part in own.groupby(["block", "condition"], sort=False):
            in_block = points[(points["measure"] == measure) & (points["block"] == block) & (points["of"] == "person")]
            joined = (own["of"] == "mean").any() and (block == "" or 2 * (in_block["condition"] == case).sum() > len(in_block))
            _course_of_lifts(here, part, looks[case], joined)
        unit = str(own["unit"].iloc[0]) if own["unit"].notna().all() else ""
        here.set_ylabel(label(measure, unit))
        here.margins(x=0.02, y=0.08)
    axes[-1].set_xlabel(abscissa)
    axes[-1].xaxis.get_major_locator().set_params(integer=True)
    _name_blocks(axes, points, WIDTHS[size])
    figure.align_ylabels()
    legend_of_cases(figure, cases, legend, marks=True)
    return figure


def _course_of_lifts(axes: Axes, part: pd.DataFrame, look: tuple[str, Any, str], joined: bool) -> None:
    """Draws the lifts of a condition in a block: lines of people and of their mean, or marks."""
    hue, dashes, marker = look
    people, mean = part[part["of"] == "person"], part[part["of"] == "mean"].sort_values("number")
    if joined and len(mean) > 1:
        opacity = faint(people["person"].nunique())
        for _, own in people.groupby("person"):
            own = own.sort_values("number")
            axes.plot(own["number"], own["value"], color=hue, alpha=opacity, linewidth=0.5)
        axes.plot(mean["number"], mean["value"], color=hue, linestyle=dashes, marker=marker, markersize=3, linewidth=1.6)
    else:
        axes.plot(people["number"], people["value"], marker, color=hue, markersize=4 if mean.empty else 2.5, linestyle="none",
                  alpha=1 if mean.empty else 0.4, markeredgewidth=0, zorder=3)  # fmt: skip
        axes.plot(mean["number"], mean["value"], marker, color=hue, markersize=5, linestyle="none", zorder=4)


def _name_blocks(axes: list[Axes], points: pd.DataFrame, width_mm: float) -> None:
    """Draws lines between blocks, and writes their names above the first panel, in as many lines as they need."""
    spans = points[points["block"] != ""].groupby("block")["number"].agg(["min", "max"]).sort_values("min")
    if len(spans) < 2:
        return
    left, right = axes[0].get_xlim()
    per_letter = 6 * 0.6 * 25.4 / 72 / (0.85 * width_mm) * (right - left)  # width of a letter, in lifts
    ends = list(spans["max"])
    for last, first in zip(ends, list(spans["min"])[1:]):
        for here in axes:
            here.axvline((last + first) / 2, color=QUIET, linewidth=0.5, linestyle=(0, (4, 2)), zorder=0)
    rows: list[float] = []  # the end of the last name of each line
    for name, first, last in zip(spans.index, spans["min"], spans["max"]):
        text = shortened(level(str(name)), 40)
        half = len(text) * per_letter / 2
        at = min(max((first + last) / 2, left + half), right - half)
        row = next((i for i, end in enumerate(rows) if end + per_letter < at - half), len(rows))
        rows[row : row + 1] = [at + half]
        axes[0].annotate(
            text, (at, 1), xycoords=("data", "axes fraction"), xytext=(0, 2 + 8.5 * row), textcoords="offset points",
            ha="center", va="bottom", fontsize=7, color=QUIET, annotation_clip=False,
        )  # fmt: skip


def plans_of_change(data: Data, frame: pd.DataFrame, options: dict[str, Any], panel: str, catch: bool) -> Iterator[Plan]:
    """The figure of change over lifts, where each person lifts often enough."""
    complete = frame[frame["lift"] == "complete"]
    wanted = ["safety_margin", "peak_grip_rate_N_s", *(["peak_load_rate_N_s"] if catch else [])]  # expected weight
    known = [name for name in wanted if complete[name].notna().any()]
    if not known or complete.groupby("person").size().median() < 8 or not data.task:
        return
    colour = options.get("colour", [])
    if panel in factors_of(data, frame) and _is_surface(complete, panel):
        colour = [panel]  # a surface explains grip better than a weight that nobody can foresee
    if frame["group"].nunique() > 1:
        colour = ["group"]
    orders = complete.assign(case=complete[["block", *colour]].astype(str).agg("/".join, axis=1)).groupby("lift_number")["case"]
    repetition = bool((orders.nunique() > 1).mean() > 0.1) and not catch
    own = {**options, **({"colour": colour} if colour else {}), **({"repetition": True} if repetition else {})}
    people = frame["person"].nunique()
    lines = "Marks are lifts"
    if people > 1:
        lines = "Thin lines are people; thick lines, and large marks among small ones, are means over at least 3/4 of them; "
        lines += "marks without a mean are people"
    number = "the lifts of each condition, in their order" if repetition else "all lifts, in their order, practice included"
    names = [word(column) for column in colour if column != "presented"]
    counts = counts_in_words(data, frame, catch or not repetition, colour, "", MOST_CASES, not repetition)
    yield Plan(
        name="successive-lifts", title="Change over successive lifts", caption=f"{lines}; {number}. {counts}",
        points=successive_lifts, points_options={"measures": known, **own}, drawing=draw_successive_lifts,
        drawing_options={
            **({"legend": " and ".join(names)} if names else {}),
            **({"abscissa": "number of the lift in its condition", "size": "one column"} if repetition else {}),
        },
    )  # fmt: skip


def _is_surface(lifts: pd.DataFrame, factor: str) -> bool:
    """Whether the friction depends on this factor and on no other."""
    ratios = [slip_ratio(own) for _, own in lifts.groupby(factor)]
    return bool(np.isfinite(ratios).all() and len(ratios) > 1 and max(ratios) > 1.01 * min(ratios))
