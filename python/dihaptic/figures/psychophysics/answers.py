"""Binary answers by a numeric factor, in trials without a procedure."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ...errors import error
from ..conditions import counting_trials
from ..data import Data
from ..means import BY_T, intervals, means_with_intervals, wilson
from ..saving import Plan
from ..style import COLOURS, MARKERS, QUIET, canvas, drawing, faint, legend_above, of_data, wrapped
from ..words import counted, label, level, words_of
from .panels import LINES, size_option

#: Maximum number of lines with colours of their own.
_MOST_COLOURS = 7
#: An outcome counts as frequent if it ended at least this share of the included trials.
_FREQUENT = 0.05
_SHARE = ["series", "of", "person", "n", "x", "value", "low", "high"]
_SIDES = {-1: "left", 1: "right"}


@of_data
def answers_by_level(
    data: Data, *, x: str, answer: str, other: str, series: list[str] | None = None, side: str = ""
) -> pd.DataFrame:
    """The share of one of two outcomes at each level of a numeric column, in trials without a procedure.

    `x`, and the columns `series`, whose levels are distinguished, are columns of trials.csv; `answer` is the outcome
    whose share `value` is, out of n trials that had it or `other`. `side` is a column that tells on which side the
    comparison was (left or -1, right or 1); `answer` and `other` are then the outcomes that name the left and the right
    side, and the share is that of answers that name the comparison. A row is `of` "person", with Wilson's 95 % interval
    if there is only one person; or "mean" over n people, with its 95 % interval (Student's t). Practice, catch trials
    and all but the last attempt at a trial are left out. Raises NotThere, or Error when there are no such outcomes.

    >>> from dihaptic import figures
    >>> points = answers_by_level(figures.read(lift_session), x="trial_num", answer="done", other="dropped")
    >>> points[["of", "n", "x", "value"]].values.tolist()
    [['person', 1, 1.0, 1.0]]
    """
    trials = counting_trials(data)
    for column in [x, *(series or []), *([side] if side else [])]:
        data.measure(column)  # raises NotThere for an unknown name
    own = trials[trials["outcome"].isin([answer, other]) & trials[x].notna()].copy()
    if "procedure" in own:
        own = own[own["procedure"].isna()]
    if own.empty:
        raise error("has no such outcomes in the included trials", "Name two outcomes of its task.", key=f"{answer}, {other}")
    own["hit"] = (own["outcome"] == answer).astype(float)
    if side:
        own["hit"] = ((own["outcome"] == answer) == (own[side].map(_side) == "left")).astype(float)
        own = own[own[side].map(_side) != ""]
    own["x"] = own[x].astype(float)
    own["series"] = _series(own, series or [], data)
    each = own.groupby(["series", "x", "person"], sort=False)["hit"].agg(value="mean", n="count", yes="sum").reset_index()
    each["of"] = "person"
    single = own["person"].nunique() == 1
    if single:
        each["low"], each["high"] = wilson(each["yes"], each["n"])
        out = each
    else:
        out = pd.concat([each, means_with_intervals(each, ["series", "x"], sort=False)], ignore_index=True)
    order = {name: place for place, name in enumerate(_order_of_series(own, series or [], data))}
    return (
        out.assign(place=out["series"].map(order)).sort_values(["place", "of", "x", "person"], kind="stable")
        .reindex(columns=_SHARE).reset_index(drop=True)
    )  # fmt: skip


def _side(value: Any) -> str:
    """The side that a level stands for."""
    return _SIDES.get(value, "") if not isinstance(value, str) else value if value in _SIDES.values() else ""


def _name_of(values: tuple[Any, ...], columns: list[str], units: dict[str, str]) -> str:
    """ "both, trembling": a level of each column; a number has the column's name, since alone it would say nothing."""
    words = []
    for column, value in zip(columns, values):
        if column == "perturbation" and not isinstance(value, str):
            words.append("" if len(columns) > 1 else "no perturbation")
        elif isinstance(value, str) or pd.isna(value):
            words.append(level(value))
        else:
            unit = units.get(column, "")
            words.append(f"{words_of(column, unit)} {level(value, unit)}")
    return ", ".join(word for word in words if word)


def _series(own: pd.DataFrame, columns: list[str], data: Data) -> list[str]:
    """The name of the series that each trial belongs to."""
    units = own.attrs.get("units", {}) or data.table("trials").attrs.get("units", {})
    if not columns:
        return [""] * len(own)
    return [_name_of(values, columns, units) for values in own[columns].itertuples(index=False, name=None)]


def _order_of_series(own: pd.DataFrame, columns: list[str], data: Data) -> list[str]:
    """Names of series, in the order of the levels of their columns; series without a perturbation come first."""
    if not columns:
        return [""]
    units = data.table("trials").attrs.get("units", {})
    ranks = {column: {value: i for i, value in enumerate(data.levels(column))} for column in columns}
    found = set(own[columns].itertuples(index=False, name=None))
    ordered = sorted(found, key=lambda values: [ranks[column].get(value, -1) for column, value in zip(columns, values)])
    return list(dict.fromkeys(_name_of(values, columns, units) for values in ordered))


@drawing
def draw_answers(
    points: pd.DataFrame, *, xlabel: str, ylabel: str, title: str = "", size: str = "one column", height_mm: float = 65,
) -> Figure:  # fmt: skip
    """Draws answers_by_level(): shares against levels, with a colour for each series.

    `xlabel`, `ylabel`: labels of the axes; `title`: that of the legend.

    >>> from dihaptic import figures
    >>> points = figures.answers_by_level(figures.read(lift_session), x="trial_num", answer="done", other="dropped")
    >>> len(figures.draw_answers(points, xlabel="trial", ylabel="share done").axes)
    1
    """
    figure, (axes,) = canvas(size, height_mm)
    points = points.assign(series=points["series"].fillna(""))
    names = list(dict.fromkeys(points["series"]))
    levels = sorted(points["x"].unique())
    step = min(np.diff(levels)) if len(levels) > 1 else 1.0
    axes.axhline(0.5, color=QUIET, linewidth=0.6, linestyle=":", zorder=0)
    for i, name in enumerate(names):
        own = points[points["series"] == name]
        aside = (i - (len(names) - 1) / 2) * min(0.1, 0.5 / len(names)) * step
        _shares_of_series(axes, own, aside, i)
    if len(levels) <= 8:
        axes.set_xticks(levels, [f"{value:g}" for value in levels])
    axes.set_xlim(levels[0] - 0.4 * step, levels[-1] + 0.4 * step)
    axes.set_ylim(-0.05, 1.05)
    axes.set_xlabel(wrapped(xlabel, 40))
    axes.set_ylabel(wrapped(ylabel, 32))
    if len(names) > 1:
        handles = [
            Line2D([], [], color=COLOURS[i % 7], marker=MARKERS[i % 7], linestyle=LINES[i % 7]) for i in range(len(names))
        ]  # fmt: skip
        legend_above(figure, handles, names, title)
    return figure


def _shares_of_series(axes: Axes, own: pd.DataFrame, aside: float, i: int) -> None:
    """Draws people as dots, and means with intervals; for one person, shares with intervals."""
    hue, marker = COLOURS[i % len(COLOURS)], MARKERS[i % len(MARKERS)]
    people = own[own["of"] == "person"]
    mean = own[own["of"] == "mean"]
    if len(mean):
        opacity = faint(people["person"].nunique())
        for _, each in people.groupby("person", sort=False):
            each = each.sort_values("x")
            axes.plot(each["x"] + aside, each["value"], color=hue, alpha=opacity, lw=0.4, marker=".", ms=3, zorder=1)
    shown = (mean if len(mean) else people).sort_values("x")
    # a share lies between 0 and 1, whatever Student's distribution suggests
    low, high = shown["low"].clip(lower=0), shown["high"].clip(upper=1)
    errors = [(shown["value"] - low).fillna(0).clip(lower=0), (high - shown["value"]).fillna(0).clip(lower=0)]
    axes.errorbar(
        shown["x"] + aside, shown["value"], np.array(errors), color=hue, marker=marker, linestyle=LINES[i % len(LINES)],
        markersize=4.5, capsize=2, elinewidth=0.9, zorder=3,
    )  # fmt: skip


# Which figures a design calls for


def plan_of_answers(data: Data) -> Iterator[Plan]:
    """The figure of binary answers by a numeric factor, for trials without a procedure."""
    trials = counting_trials(data)
    if "outcome" not in trials or "condition" not in trials:
        return
    trials = trials[trials["procedure"].isna()] if "procedure" in trials else trials
    trials = trials[~trials["outcome"].isin(_not_counted(data.task))]
    frequent = _two_outcomes(data, trials)
    numeric = [name for name in data.factors if pd.api.types.is_numeric_dtype(trials[name]) and trials[name].nunique() > 2]
    if not frequent or not numeric:
        return
    x = max(numeric, key=lambda name: int(trials[name].nunique()))
    counting = trials[trials["outcome"].isin(frequent) & trials[x].notna()]
    if counting["outcome"].nunique() < 2 or counting[x].nunique() < 3:
        return
    series, averaged = _series_of(data, counting, x)
    side = _side_column(counting, frequent)
    answer, other = sorted(frequent, key=lambda name: "left" not in name.split()) if side else frequent
    unit = data.table("trials").attrs.get("units", {}).get(x, "")
    options = {"x": x, "answer": answer, "other": other}
    what = 'share of "comparison"' if side else f'share of "{answer}"'
    yield Plan(
        name=f"answers-by-{x}".replace("_", "-"),
        title=f"Answers by {words_of(x, unit)}",
        caption=_caption_of_answers(counting, x, len(trials) - len(counting), averaged, side),
        points=answers_by_level,
        points_options={**options, **({"series": series} if series else {}), **({"side": side} if side else {})},
        drawing=draw_answers,
        drawing_options={"xlabel": label(x, unit), "ylabel": what, **size_option(1)},
    )


def _caption_of_answers(counting: pd.DataFrame, x: str, rest: int, averaged: list[str], side: str) -> str:
    """The caption of the figure of answers: what it shows of these trials, and what is left out."""
    people = counting["person"].nunique()
    out = "Shares of trials with Wilson's 95 % intervals."
    if people > 1:
        counts = counting.groupby(["group", x])["person"].nunique()
        out = f"Dots are people's shares, joined over levels; marks are means over people{intervals(counts, BY_T)}."
    if side:
        out += f" An answer names the comparison if it names the side on which that was (column {side} of trials.csv)."
    if averaged:
        out += f" Averaged over {' and '.join(averaged)}."
    out += " Dotted: half of the answers."
    out += f" {counted(people, 'person', 'people')}, {counted(len(counting), 'trial')}"
    out += "; practice, catch trials and repeated attempts"
    out += f", and {counted(rest, 'trial')} with other outcomes," if rest else ""
    return f"{out} are left out."


def _exits(of: Any) -> Iterator[dict[str, Any]]:
    """All exits of a task's states that end a trial, in the order of the task."""
    if isinstance(of, dict):
        if "outcome" in of and "when" in of:
            yield of
        for value in of.values():
            yield from _exits(value)
    elif isinstance(of, list):
        for value in of:
            yield from _exits(value)


def _not_counted(task: dict[str, Any]) -> set[str]:
    """Outcomes after which a trial is repeated, and the outcome of interrupted trials."""
    return {str(exit["outcome"]) for exit in _exits(task) if exit.get("redo")} | {"interrupted"}


def _two_outcomes(data: Data, trials: pd.DataFrame) -> list[str]:
    """The two frequent outcomes, if there are exactly two: first the comparison, or else the one that the task names first."""
    shares = trials["outcome"].value_counts(normalize=True)
    frequent = [str(name) for name in shares.index if shares[name] >= _FREQUENT]
    if len(frequent) != 2 or _is_failure(data.task, frequent):
        return []
    order = list(dict.fromkeys(str(exit["outcome"]) for exit in _exits(data.task)))
    places = {name: place for place, name in enumerate(order)}
    return sorted(frequent, key=lambda name: (not name.startswith("comparison"), places.get(name, len(order))))


def _is_failure(task: dict[str, Any], outcomes: list[str]) -> bool:
    """Whether one of two outcomes means only that time ran out, where nobody was asked for an answer."""
    ways: dict[str, set[str]] = {name: set() for name in outcomes}
    for exit in _exits(task):
        ways.get(str(exit["outcome"]), set()).add(str(exit["when"]))
    asked = any(way & {"key", "button", "answered"} for way in ways.values())
    return not asked and any(way == {"time"} for way in ways.values())


def _side_column(trials: pd.DataFrame, outcomes: list[str]) -> str:
    """The column that tells on which side the comparison was, if answers name a side."""
    named = [{"left", "right"} & set(name.split()) for name in outcomes]
    if len(named[0]) != 1 or len(named[1]) != 1 or named[0] == named[1] or "side" not in trials:
        return ""
    sides = set(trials["side"].dropna().map(_side))
    return "side" if sides == {"left", "right"} else ""


def _series_of(data: Data, trials: pd.DataFrame, x: str) -> tuple[list[str], list[str]]:
    """Columns whose levels have colours of their own, and the factors, in words, over which shares are averaged."""
    rest = sorted((name for name in data.factors if name != x), key=lambda name: int(trials[name].nunique()))
    candidates = [name for name in rest if trials[name].nunique() > 1]
    if "perturbation" in trials and trials["perturbation"].fillna("").nunique() > 1:
        candidates.append("perturbation")
    if trials["group"].fillna("").nunique() > 1:
        candidates.insert(0, "group")
    chosen: list[str] = []
    averaged = []
    for name in candidates:
        if len(trials[[*chosen, name]].drop_duplicates()) <= _MOST_COLOURS:
            chosen.append(name)
        else:
            averaged.append(words_of(name, data.table("trials").attrs.get("units", {}).get(name, "")))
    return chosen, averaged
