"""Courses of procedures: the levels that they chose, answer after answer."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from ..data import Data, sitting_columns
from ..saving import Plan
from ..style import COLOURS, QUIET, drawing, faint, legend_above, of_data
from .panels import LINES, group_marks, groups_in, label_all, level_axes, panels_of, parted, plan_of
from .procedures import ALL, PANEL, Procedure, answers_of, chosen, finished, fits_of, is_single, is_yes, mean_of

_COURSE = [*PANEL, "group", "of", "person", "n", "answer", "trial_num", "level", "said_yes"]


@of_data
def procedure_courses(data: Data, *, procedures: list[str] | None = None) -> pd.DataFrame:
    """The levels that procedures chose, answer after answer.

    A row has its procedure, and `of`: "answer", with its number from 1, its trial, its level and whether it was yes;
    "reversal" of a staircase, if not ignored, at the last answer before the direction changed; "mean" level of n people
    at an answer, as long as all of them answer, three times at least (the geometric mean, where `logarithmic`);
    "threshold", of the fitted function or, of several people, the mean of theirs; those that are guesses are
    left out. Procedures with constant levels have no course. Raises NotThere, or Error when there are no answers.

    >>> from dihaptic import figures
    >>> procedure_courses(figures.read(lift_session))
    Traceback (most recent call last):
    ...
    dihaptic.errors.Error: ...has no trials of a procedure. Name a session whose task has procedures.
    """
    rows: list[dict[str, Any]] = []
    for procedure in chosen(data, procedures):
        answers = answers_of(data, procedure)
        if answers.empty or procedure.kind in (ALL, "constant"):
            continue
        head = procedure.panel()
        sessions = answers.groupby("person")["session"].nunique() if "session" in answers else pd.Series([1])
        keys = sitting_columns(answers)
        for _, own in answers.groupby(keys, sort=False):
            person = own["person"].iloc[0]
            person = f"{person}, {own['session'].iloc[0]}" if sessions.max() > 1 else person
            common = {**head, "group": own["group"].iloc[0], "person": person, "n": 1}
            columns = ["answer", "trial_num", "level", "said_yes"]
            rows += [{**common, "of": "answer", **row} for row in own[columns].to_dict("records")]
            for row in own.iloc[_reversals(own["said_yes"], procedure)][columns].to_dict("records"):
                rows.append({**common, "of": "reversal", **row})
        fits = fits_of(data, procedure)
        fits = fits[~fits["guess"].astype(bool)]
        for group, own in answers.groupby("group", sort=False):
            if not is_single(data):
                rows += [{**head, "group": group, "of": "mean", **row} for row in _mean_course(own, procedure.logarithmic)]
            thresholds = fits[fits["group"] == group]
            if len(thresholds):
                mean = mean_of(thresholds.groupby("person")["threshold_share"].mean(), procedure.logarithmic)
                rows.append({**head, "group": group, "of": "threshold", "n": mean["n"], "level": mean["value"]})
    return finished(rows, _COURSE, procedures)


def _reversals(said_yes: pd.Series, procedure: Procedure) -> list[int]:
    """Indices of the answers after which a staircase changed its direction, without the first ones, which are ignored.

    The levels alone would not show the reversal that ends a staircase, nor one at a limit.
    """
    out: list[int] = []
    way = in_a_row = 0
    if procedure.kind != "staircase":
        return out
    for i, yes in enumerate(said_yes):
        in_a_row = in_a_row + 1 if yes else 0
        now = 1 if not yes else -1 if in_a_row == procedure.down_after else 0
        if now:
            if way == -now:
                out.append(i)
            way, in_a_row = now, 0
    return out[procedure.skipped :]


def _mean_course(answers: pd.DataFrame, logarithmic: bool) -> Iterator[dict[str, Any]]:
    """The mean level of all people at each answer, up to the last answer that all of them gave."""
    keys = sitting_columns(answers)
    last = answers.groupby(keys)["answer"].max().min()
    if answers.groupby(keys).ngroups < 2 or last < 3:
        return
    for number, own in answers[answers["answer"] <= last].groupby("answer"):
        mean = mean_of(own["level"], logarithmic)
        yield {"answer": number, "n": mean["n"], "level": mean["value"]}


@drawing
def draw_procedure_courses(points: pd.DataFrame, *, size: str = "one column", height_mm: float = 45) -> Figure:
    """Draws procedure_courses(): a panel for each procedure. For one person, yes is filled, no is hollow, reversals are ringed.

    `height_mm` is the height of a row of panels.

    >>> import pandas as pd
    >>> row = {"procedure": "up", "kind": "staircase", "quantity": "width", "unit": "mm", "logarithmic": False, "yes": "wider"}
    >>> row |= {"group": "", "of": "answer", "person": "p", "said_yes": True}
    >>> answers = [{**row, "answer": i, "level": 9 - i} for i in (1, 2)]
    >>> draw_procedure_courses(pd.DataFrame(answers)).axes[0].get_ylabel()
    'width [mm]'
    """
    points = points.reindex(columns=list(dict.fromkeys([*_COURSE, *points.columns])))
    groups = groups_in(points)
    several = points.loc[points["of"] == "answer", "person"].nunique() > 1
    figure, panels = panels_of(points, size, height_mm)
    for axes, own in panels:
        for i, group in enumerate(groups):
            _course(axes, own[own["group"].fillna("") == group], i, several)
        axes.xaxis.set_major_locator(MaxNLocator(5, integer=True, steps=[1, 2, 5, 10]))
    last = points["answer"].max()
    for axes, _ in panels:
        axes.set_xlim(1 - 0.04 * last, last + 0.04 * last)
    level_axes(panels, "y")
    label_all(panels, x="answer", y=None, size=size)
    legend_above(figure, *_legend_of_courses(points, groups, several))
    return figure


def _course(axes: Axes, own: pd.DataFrame, i: int, several: bool) -> None:
    """Draws the courses of one group's people, or of one person."""
    hue = COLOURS[i % len(COLOURS)]
    answers = own[own["of"] == "answer"]
    opacity = faint(answers["person"].nunique()) if several else 0.8
    for _, each in answers.groupby("person", sort=False):
        line = {"linewidth": 0.5 if several else 0.7, "alpha": opacity}
        axes.plot(each["answer"], each["level"], color=hue, zorder=1, **line)
    if not several and len(answers):
        for said, face in ((True, hue), (False, "white")):
            some = answers[answers["said_yes"].map(is_yes) == said]
            axes.plot(
                some["answer"], some["level"], linewidth=0, marker="o", markersize=3.2, markerfacecolor=face,
                markeredgecolor=hue, markeredgewidth=0.7, zorder=2,
            )  # fmt: skip
        turns = own[own["of"] == "reversal"]
        axes.plot(
            turns["answer"], turns["level"], linewidth=0, marker="o", markersize=6.5, markerfacecolor="none",
            markeredgecolor=COLOURS[1], markeredgewidth=0.9, zorder=3,
        )  # fmt: skip
    mean = own[own["of"] == "mean"]
    axes.plot(mean["answer"], mean["level"], color=hue, linewidth=1.4, linestyle=LINES[i % len(LINES)], zorder=3)
    for value in own.loc[own["of"] == "threshold", "level"]:
        axes.axhline(value, color="black" if i == 0 else hue, linewidth=0.8, linestyle="--", zorder=0)


def _legend_of_courses(points: pd.DataFrame, groups: list[str], several: bool) -> tuple[list[Any], list[str]]:
    hue = COLOURS[0] if len(groups) == 1 else QUIET
    out = group_marks(groups, marked=False)
    kinds = set(points["of"])
    if several:
        out.append(("person", Line2D([], [], color=hue, linewidth=0.5, alpha=0.6)))
        if "mean" in kinds:
            out.append(("mean", Line2D([], [], color=hue, linewidth=1.4)))
    else:
        answers = list(dict.fromkeys(points["yes"]))
        yes, no = (f'"{answers[0]}"', "other answer") if len(answers) == 1 else ("yes", "no")
        out.append((yes, Line2D([], [], color=hue, marker="o", linewidth=0)))
        out.append((no, Line2D([], [], color=hue, marker="o", linewidth=0, markerfacecolor="white")))
    if "reversal" in kinds and not several:
        ring = {"marker": "o", "linewidth": 0, "markersize": 6.5, "markerfacecolor": "none"}
        out.append(("reversal", Line2D([], [], color=COLOURS[1], **ring)))
    if "threshold" in kinds:
        out.append(("mean threshold" if several else "threshold", Line2D([], [], color="black", linewidth=0.8, linestyle="--")))
    return [handle for _, handle in out], [name for name, _ in out]


def plans_of_courses(data: Data, procedures: list[Procedure]) -> Iterator[Plan]:
    adaptive = [each for each in procedures if each.kind not in (ALL, "constant")]
    for name, some in parted("procedure-courses", adaptive):
        single = is_single(data)
        fits = any((~fits_of(data, each)["guess"].astype(bool)).any() for each in some)
        if single:
            what = f"Levels in the order of answers; filled: yes{_meaning(some)}, hollow: no."
            what += " Rings are reversals that are averaged." * any(each.kind == "staircase" for each in some)
            what += " Dashed: threshold of the fitted function." * fits
        else:
            what = "Levels in the order of answers, of each person (thin), and their mean as long as all people answer (thick)."
            what += " Dashed: mean of the thresholds of the fitted functions." * fits
        yield plan_of(data, name, "Courses of the procedures", what, some, procedure_courses, draw_procedure_courses)


def _meaning(procedures: list[Procedure]) -> str:
    """The meaning of yes, if it is the same in all procedures."""
    words = {each.yes for each in procedures}
    return f' ("{words.pop()}")' if len(words) == 1 else ""
