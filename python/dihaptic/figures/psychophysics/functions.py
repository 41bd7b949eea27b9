"""Psychometric functions: the shares of answers at each level, and the functions that a report fitted to them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ...errors import NotThere
from ..data import Data, sitting_columns
from ..means import BY_T, intervals, wilson
from ..saving import Plan
from ..style import COLOURS, MARKERS, QUIET, drawing, faint, legend_above, of_data
from .panels import LINES, group_marks, groups_in, label_all, level_axes, panels_of, parted, people_with_thresholds, plan_of
from .procedures import PANEL, Procedure, answers_of, chosen, finished, fits_of, is_single, mean_of

#: Minimum number of answers at a level for an interval, which would fill the panel and say nothing with fewer.
_LEAST_ANSWERS = 5
_FUNCTION = [*PANEL, "group", "of", "person", "n", "level", "value", "low", "high"]


def probability(
    levels: Any, *, sigmoid: str, threshold: float, shape: float, guess: float = 0.0, lapse: float = 0.0
) -> Any:  # fmt: skip
    """The probability of yes according to a psychometric function, at levels in its own unit (log10 if they are logarithms).

    `sigmoid`: normal, logistic, weibull or weibull_log10, as in a task's procedures; `threshold` and `shape` are those of
    thresholds.csv. Raises NotThere for another sigmoid.

    >>> float(probability(0.3, sigmoid="normal", threshold=0.3, shape=0.1, guess=0.5, lapse=0.02))
    0.74
    """
    from scipy import special

    x = np.asarray(levels, dtype=float)
    kinds: dict[str, Callable[[], Any]] = {
        "normal": lambda: special.ndtr((x - threshold) / shape),
        "logistic": lambda: special.expit((x - threshold) / shape),
        "weibull": lambda: -np.expm1(-np.power(np.maximum(x, 0) / threshold, shape)),
        "weibull_log10": lambda: -np.expm1(-np.power(10.0, shape * (x - threshold))),
    }
    if sigmoid not in kinds:
        raise NotThere(sigmoid, "is not a sigmoid", list(kinds), f"Sigmoids are {', '.join(kinds)}.")
    with np.errstate(over="ignore"):
        return guess + (1 - guess - lapse) * kinds[sigmoid]()


@of_data
def psychometric_functions(data: Data, *, procedures: list[str] | None = None) -> pd.DataFrame:
    """Answers of procedures by level, with the fitted functions of thresholds.csv; nothing is fitted anew.

    A row has its procedure, and `of`: "level", at which n answers had the share `value` of yes, with Wilson's 95 %
    interval; "curve", a point of a person's function; "threshold", at `level`, where the function's value is `value`, with
    its 95 % interval of levels from `low` to `high`; "mean" of n people's thresholds, with its interval of levels;
    "chance", the share of guesses; "standard", its level. Levels have the unit `unit`, and are never logarithms; the mean
    is the geometric one where `logarithmic`. Shares at levels are given only for one person. Thresholds that are
    guesses are left out. `procedures`: names, by default all. Raises NotThere, or Error when there are no answers.

    >>> from dihaptic import figures
    >>> psychometric_functions(figures.read(lift_session))
    Traceback (most recent call last):
    ...
    dihaptic.errors.Error: ...has no trials of a procedure. Name a session whose task has procedures.
    """
    rows: list[dict[str, Any]] = []
    single = is_single(data)
    for procedure in chosen(data, procedures):
        answers = answers_of(data, procedure)
        if answers.empty:
            continue
        head = procedure.panel()
        fits = fits_of(data, procedure)
        if not single and fits.empty:
            continue
        if single:
            rows += [{**head, "group": answers["group"].iloc[0], **row} for row in _shares(answers, procedure)]
        rows += [{**head, **row} for row in _curves(answers, fits, procedure)]
        if not single:
            rows += [{**head, **row} for row in _mean_thresholds(fits, procedure)]
        if procedure.guess > 0 and not procedure.guess_is_lapse:
            rows.append({**head, "group": "", "of": "chance", "value": procedure.guess})
        if np.isfinite(procedure.standard):
            rows.append({**head, "group": "", "of": "standard", "level": procedure.standard})
    return finished(rows, _FUNCTION, procedures)


def _mean_thresholds(fits: pd.DataFrame, procedure: Procedure) -> Iterator[dict[str, Any]]:
    """The mean threshold of each group's people, at their mean probability of yes."""
    for group, own in fits[~fits["guess"].astype(bool)].groupby("group", sort=False):
        mean = mean_of(own.groupby("person")["threshold_share"].mean(), procedure.logarithmic)
        yield {"group": group, "of": "mean", **mean, "level": mean["value"], "value": own["threshold_probability"].mean()}


def _shares(answers: pd.DataFrame, procedure: Procedure) -> Iterator[dict[str, Any]]:
    """The share of yes at each level; levels that differ only by rounding count as one."""
    own = answers.sort_values("level", kind="stable")
    at = np.log10(own["level"]) if procedure.logarithmic else own["level"]
    # as in the program: sums of a staircase's steps return to a level only up to rounding
    new = (at.diff() > 1e-9 * (at.max() - at.min())).cumsum()
    for _, same in own.groupby(new.to_numpy()):
        yes, n = int(same["said_yes"].sum()), len(same)
        low, high = wilson(yes, n) if n >= _LEAST_ANSWERS else (np.nan, np.nan)
        yield {
            "of": "level", "person": same["person"].iloc[0], "n": n, "level": same["level"].iloc[0],
            "value": yes / n, "low": low, "high": high,
        }  # fmt: skip


def _curves(answers: pd.DataFrame, fits: pd.DataFrame, procedure: Procedure) -> Iterator[dict[str, Any]]:
    """The function of each person over the levels that the person was shown, and its threshold."""
    for fit in fits.to_dict("records"):
        own = answers
        for key in sitting_columns(answers):
            own = own[own[key] == fit[key]] if key in fit else own
        if own.empty:
            continue
        shown = np.log10(own["level"]) if procedure.logarithmic else own["level"]
        low, high, t, s = float(shown.min()), float(shown.max()), float(fit["threshold"]), float(fit["shape"])
        near = t + np.linspace(-4, 4, 41) * (s if procedure.sigmoid in ("normal", "logistic") else 0)
        x = np.unique(np.concatenate([np.linspace(low, high, 81), near[(near > low) & (near < high)]]))
        lapse = float(fit["lapse"]) if np.isfinite(fit["lapse"]) else 0.0
        guess = lapse if procedure.guess_is_lapse else procedure.guess
        p = probability(x, sigmoid=procedure.sigmoid, threshold=t, shape=s, guess=guess, lapse=lapse)
        common = {"group": fit["group"], "person": fit["person"], "n": len(own)}
        if "session" in fit and answers.groupby("person")["session"].nunique().max() > 1:
            common["person"] = f"{fit['person']}, {fit['session']}"
        for level_, value in zip(10**x if procedure.logarithmic else x, p):
            yield {**common, "of": "curve", "level": level_, "value": value}
        if not fit["guess"]:
            ends = _interval(fit["threshold_95"])
            if procedure.logarithmic:
                ends = [10**end for end in ends]
            yield {
                **common, "of": "threshold", "level": fit["threshold_share"], "value": fit["threshold_probability"],
                "low": ends[0], "high": ends[1],
            }  # fmt: skip


def _interval(text: Any) -> list[float]:
    """Both ends of "0.2 to 0.3"; NaN where there is none."""
    try:
        low, high = str(text).split(" to ")
        return [float(low), float(high)]
    except ValueError:
        return [np.nan, np.nan]


@drawing
def draw_psychometric_functions(
    points: pd.DataFrame, *, size: str = "one column", height_mm: float = 55
) -> Figure:
    """Draws psychometric_functions(), with a panel for each procedure, and a colour for each group.

    `height_mm` is the height of a row of panels.

    >>> import pandas as pd
    >>> common = {"procedure": "finger", "kind": "constant", "quantity": "width", "unit": "mm", "logarithmic": False}
    >>> common |= {"yes": "wider", "group": "", "of": "level", "n": 20}
    >>> shares = [{**common, "level": 50 + i, "value": i / 4} for i in range(5)]
    >>> figure = draw_psychometric_functions(pd.DataFrame(shares))
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('width [mm]', 'share of "wider"')
    """
    points = points.reindex(columns=list(dict.fromkeys([*_FUNCTION, *points.columns])))
    groups = groups_in(points[points["of"].isin(["level", "curve", "threshold", "mean"])])
    several = not bool((points["of"] == "level").any())
    figure, panels = panels_of(points, size, height_mm)
    largest = points.loc[points["of"] == "level", "n"].max()
    shares = pd.concat([points["value"], points.loc[points["of"] == "level", "low"]])
    lowest = 0.5 if shares.min() >= 0.48 else 0  # in a forced choice, shares are rarely below 0.5
    for axes, own in panels:
        _quiet_lines(axes, own)
        for i, group in enumerate(groups):
            dark = "black" if len(groups) == 1 else COLOURS[i % len(COLOURS)]
            _function(axes, own[own["group"].fillna("") == group], i, several, largest, dark)
        axes.set_ylim(lowest - 0.04, 1.04)
        axes.set_yticks(*_ticks_of_shares(lowest))
    level_axes(panels, "x")
    answers = list(dict.fromkeys(points["yes"]))
    label_all(panels, x=None, y=f'share of "{answers[0]}"' if len(answers) == 1 else "share of yes", size=size)
    handles, names = _legend_of_functions(points, groups, several)
    legend_above(figure, handles, names)
    return figure


def _ticks_of_shares(lowest: float) -> tuple[list[float], list[str]]:
    ticks = [0, 0.25, 0.5, 0.75, 1] if lowest == 0 else [0.5, 0.6, 0.7, 0.8, 0.9, 1]
    return ticks, [f"{tick:g}" for tick in ticks]


def _quiet_lines(axes: Axes, own: pd.DataFrame) -> None:
    """Draws the chance level, and the standard."""
    for value in own.loc[own["of"] == "chance", "value"]:
        axes.axhline(value, color=QUIET, linewidth=0.6, linestyle=":", zorder=0)
    for value in own.loc[own["of"] == "standard", "level"]:
        axes.axvline(value, color=QUIET, linewidth=0.6, linestyle="--", zorder=0)


def _function(axes: Axes, own: pd.DataFrame, i: int, several: bool, largest: float, dark: str) -> None:
    """Draws one group's or person's function: shares at levels, curves, thresholds."""
    hue, marker = COLOURS[i % len(COLOURS)], MARKERS[i % len(MARKERS)]
    shares = own[own["of"] == "level"]
    known = shares[shares["low"].notna()]
    axes.vlines(known["level"], known["low"], known["high"], color=hue, alpha=0.5, linewidth=0.7, zorder=1)
    axes.scatter(
        shares["level"], shares["value"], s=4 + 44 * shares["n"] / max(10, largest), marker="o", facecolor="white", edgecolor=hue,
        linewidth=0.9, zorder=2, clip_on=False,
    )  # fmt: skip
    curves = own[own["of"] == "curve"]
    line = {"linewidth": 0.6, "alpha": faint(curves["person"].nunique())} if several else {"linewidth": 1.2}
    for _, curve in curves.groupby("person", sort=False):
        axes.plot(curve["level"], curve["value"], color=hue, linestyle=LINES[i % len(LINES)], zorder=3, **line)
    thresholds = own[own["of"] == "threshold"]
    if several:
        axes.plot(thresholds["level"], thresholds["value"], linewidth=0, marker=".", markersize=3.5, color=hue, alpha=0.6)
    for row in own[own["of"] == ("mean" if several else "threshold")].itertuples():
        if np.isfinite(row.low) and np.isfinite(row.high):
            axes.hlines(row.value, row.low, row.high, color=dark, linewidth=1.4, zorder=4)
        axes.plot(row.level, row.value, marker=marker, markersize=5, markerfacecolor=hue, markeredgecolor="black", zorder=5)


def _legend_of_functions(points: pd.DataFrame, groups: list[str], several: bool) -> tuple[list[Any], list[str]]:
    kinds = set(points["of"])
    out = group_marks(groups)
    hue, dark = (COLOURS[0], "black") if len(groups) == 1 else (QUIET, QUIET)
    if "level" in kinds:
        out.append(("share of answers", Line2D([], [], color=hue, linewidth=0, marker="o", markerfacecolor="white")))
    if "curve" in kinds:
        name, width = ("function of a person", 0.6) if several else ("fitted function", 1.2)
        out.append((name, Line2D([], [], color=hue, linewidth=width)))
    of, name = ("mean", "mean threshold") if several else ("threshold", "threshold")
    if of in kinds:
        known = bool(points.loc[points["of"] == of, "low"].notna().any())
        mark = {"marker": MARKERS[0], "markersize": 5, "markerfacecolor": hue, "markeredgecolor": "black"}
        line = Line2D([], [], color=dark, linewidth=1.4 * known, **mark)
        out.append((name + ", 95 % interval" * known, line))
    for of, dashes in (("chance", ":"), ("standard", "--")):
        if of in kinds:
            out.append((of, Line2D([], [], color=QUIET, linewidth=0.6, linestyle=dashes)))
    return [handle for _, handle in out], [name for name, _ in out]


# Which figures a design calls for


def plans_of_functions(data: Data, procedures: list[Procedure]) -> Iterator[Plan]:
    single = is_single(data)
    drawn = procedures if single else [each for each in procedures if len(fits_of(data, each))]
    for name, some in parted("psychometric-functions", drawn):
        what = (_what_of_one if single else _what_of_several)(data, some)
        if len({each.yes for each in some}) > 1:
            what += ' Yes is ' + ', '.join(f'"{each.yes}"' for each in some) + ', in the order of panels.'
        yield plan_of(
            data, name, "Psychometric functions", what, some, psychometric_functions, draw_psychometric_functions
        )  # fmt: skip


def _what_of_several(data: Data, procedures: list[Procedure]) -> str:
    """The caption for psychometric functions of several people."""
    out = "Thin curves are the functions fitted to each person's answers (maximum likelihood), over the levels that the person "
    out += "was shown; dots are their thresholds"
    counts = people_with_thresholds(data, procedures)
    if counts.empty:
        return f"{out}."
    cut = ", which are cut where they would leave the panel" if (counts > 1).any() else ""
    return f"{out}, and marks are means of thresholds{intervals(counts, BY_T)}{cut}."


def _what_of_one(data: Data, procedures: list[Procedure]) -> str:
    """The caption for one person's psychometric functions."""
    out = "The share of answers at each level; the area of a circle grows with their number"
    if _has_intervals(data, procedures):
        out += f", and a line is Wilson's 95 % interval from {_LEAST_ANSWERS} answers on"
    out += "."
    if any(len(fits_of(data, each)) for each in procedures):
        out += " Curves are the fitted functions (maximum likelihood), marks their thresholds with 95 % profile intervals,"
        out += " which are cut where they would leave the panel."
    elif not data.has("thresholds"):
        out += " No function is drawn: the session has no report yet."
    return out


def _has_intervals(data: Data, procedures: list[Procedure]) -> bool:
    return any(row["n"] >= _LEAST_ANSWERS for each in procedures for row in _shares(answers_of(data, each), each))
