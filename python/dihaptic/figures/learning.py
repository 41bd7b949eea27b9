"""Learning: its course over trials, means in windows of trials, generalisation, and the courses of other measures."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ..errors import NotThere, error
from .courses import (
    BANDS,
    MOST_GROUPS,
    courses_of,
    draw_courses,
    grouped,
    numbered,
    parts_of,
    scattered,
    unnamed,
    width_of_bins,
    with_texts,
)
from .data import Data, checked_list, sitting_columns
from .means import BY_T, intervals, means_with_intervals, said_of_limits, t_quantile, within_limits
from .saving import Plan
from .style import COLOURS, MARKERS, QUIET, WIDTHS, canvas, drawing, faint, fit_names, legend_above, of_data, same_limits, wrapped
from .words import counted, label, level, words_of

#: Heading above these figures in a report.
HEADING = "Learning"
#: Maximum number of panels in a figure; minimum number of trials for a course.
_MOST_PANELS, _LEAST_TRIALS = 6, 8
#: Minimum number of laboratories from which bands for a further one are computed.
_LEAST_LABORATORIES = 3
#: Maximum number of points of a line, in a single panel and in each of several.
_MOST_POINTS, _MOST_POINTS_OF_SEVERAL = 160, 80
#: Windows of fits.csv that are means, and windows that are differences of means, with their names in a figure.
WINDOWS = {
    "baseline": "baseline", "early": "early", "late": "late", "catch": "catch trials", "clamp_first": "clamp, first",
    "clamp_last": "clamp, last", "washout_first": "washout, first",
}  # fmt: skip
DIFFERENCES = {"savings": "savings", "rebound": "rebound"}
#: What was learned, by the column `measure` of fits.csv, where it is not simply compensation.
LEARNED = {"adaptation_index": "adaptation index", "extent": "compensation of extent"}


# The learning curve


def _adaptation(data: Data, unit: str, parts: list[str] | None) -> pd.DataFrame:
    """The reaches of adaptation.csv in this unit, numbered in their rounds."""
    table = data.table("adaptation")
    if unit:
        table = table[table["unit"] == unit]
    table = numbered(table.rename(columns={"compensation": "value", "two_rate": "fit"}))
    for column in ("value", "fit", "perturbation"):
        known = pd.to_numeric(table[column], errors="coerce") if column in table else pd.Series(np.nan, index=table.index)
        table[column] = known.where(np.isfinite(known))
    for part in parts or []:
        if part not in set(table["part"]):
            raise NotThere(part, "is not a round of these sessions", list(table["part"].unique()), "")
    return table[table["part"].isin(parts)] if parts else table


@of_data
def learning_curve(data: Data, *, unit: str = "", rounds: list[str] | None = None, bin_trials: int = 1) -> pd.DataFrame:
    """Compensation over the trials of each round: that of each person, the mean over people, the fitted two-rate model, and
    the perturbation.

    `unit` is that of adaptation.csv, "deg" or "%"; but an adaptation index is a share here, whose unit is "1". `rounds` names
    those that are wanted, by default all; in a study, rounds are named "SESSION, ROUND". Trials are counted from the first of
    the round. With `bin_trials`, that many trials of a block are a point, from trial `first` to trial `last`.

    A row is `of` a "person" (`value` is the mean over n trials), the "mean" over n people with its 95 % interval from
    `low` to `high` (Student's t), the "fit" (the mean of people's fitted models), or the "schedule" (a trial's block
    and kind, with the perturbation as `value`). Values are in `unit`. Practice, all but the last attempt at a trial,
    and catch trials whose places in their block differ between people are left out. For one person there is no mean.

    Example: points = figures.learning_curve(figures.read(dh.rehearse("experiments/visuomotor-rotation.yaml", 4).folder)),
    once `dihaptic report` has made its tables. Raises NotThere without adaptation.csv, or for another round.
    """
    table = _adaptation(data, unit, rounds)
    out = courses_of(table, bin_trials, table["person"].nunique() > 1)
    out["unit"] = table["unit"].iloc[0] if len(table) else unit
    return out


@drawing
def draw_learning_curve(
    points: pd.DataFrame, *, ylabel: str = "", size: str = "two columns", height_mm: float = 55
) -> Figure:
    """Draws learning_curve(), with a panel for each round, all with equal limits, and a colour for each group.

    Blocks are named above the panels, and those of washout, clamps, channels and catch trials are shaded. `ylabel` is the
    label of the axis, by default "compensation" with its unit.
    """
    return _compensation(points, ylabel, size, height_mm)


def _compensation(points: pd.DataFrame, ylabel: str, size: str, height_mm: float) -> Figure:
    """A panel for each round."""
    points = with_texts(points)
    ylabel = ylabel or label("compensation", str(points["unit"].iloc[0]))
    parts = list(dict.fromkeys(points["part"]))
    panels = [(part if len(parts) > 1 else "", points[points["part"] == part], ylabel) for part in parts]
    return draw_courses(points, panels, size, height_mm, True)


# Laboratories


@of_data
def laboratory_curves(data: Data, *, unit: str = "", rounds: list[str] | None = None, bin_trials: int = 1) -> pd.DataFrame:
    """Compensation over the trials of each round, in each laboratory of a rehearsal, and bands for a further laboratory.

    Rows and options are as in learning_curve(). A row is `of` a "laboratory" (the mean over n reaches of its people), the
    "mean" over n laboratories, "50 %" or "90 %" (the band from `low` to `high` in which the mean of a further laboratory
    with as many people lies with this probability), or the "schedule". Bands are the mean +- t s sqrt(1 + 1/n), with the
    standard deviation s of the laboratories' means and the quantile t of Student's distribution for n - 1 degrees of freedom,
    as laboratories differ by a normal law.

    Example: points = figures.laboratory_curves(figures.read("rehearsals/visuomotor-rotation_1")), after `dihaptic rehearse
    experiments/visuomotor-rotation.yaml --people 40 --laboratories 10` and `dihaptic report`. Raises NotThere without
    adaptation.csv or for another round, and Error for fewer than three laboratories.
    """
    table = _adaptation(data, unit, rounds)
    numbers = table["session"].map(data.laboratories)
    table = table[numbers.notna()].assign(person="laboratory " + numbers.dropna().astype(int).astype(str))
    if table["person"].nunique() < _LEAST_LABORATORIES:
        what = f"come from {counted(table['person'].nunique(), 'laboratory', 'laboratories')}, too few for bands"
        remedy = f"Rehearse people of {_LEAST_LABORATORIES} or more: dihaptic rehearse FILE --people 40 --laboratories 10."
        raise error(what, remedy, file=str(data.paths[0]), key="people")
    points = courses_of(table.drop(columns="fit"), bin_trials, True)
    points = points.replace({"of": {"person": "laboratory"}})
    points.loc[points["of"] == "mean", ["low", "high"]] = np.nan
    by = ["part", "group", "first", "last", "trial"]
    spread = points[points["of"] == "laboratory"].groupby(by, sort=False)["value"].agg(value="mean", n="count", sd="std")
    spread = spread[spread["n"] >= _LEAST_LABORATORIES].reset_index()
    bands = []
    for share in BANDS:
        half = t_quantile(spread["n"] - 1, 0.5 + share / 200) * spread["sd"] * np.sqrt(1 + 1 / spread["n"])
        ends = {"low": spread["value"] - half, "high": spread["value"] + half}
        bands.append(spread.drop(columns=["sd", "value"]).assign(of=f"{share} %", **ends))
    out = pd.concat([points, *bands], ignore_index=True)
    words = ["person", "block", "block_kind", "kind"]
    out[words] = out[words].fillna("")
    out["unit"] = table["unit"].iloc[0]
    return out


@drawing
def draw_laboratory_curves(
    points: pd.DataFrame, *, ylabel: str = "", size: str = "two columns", height_mm: float = 55
) -> Figure:
    """Draws laboratory_curves(), with panels, shades and colours as in draw_learning_curve(): a thin line for each laboratory,
    and darker and lighter bands for a further one."""
    return _compensation(points, ylabel, size, height_mm)


# Windows of trials


@of_data
def learning_windows(data: Data, *, unit: str = "", rounds: list[str] | None = None) -> pd.DataFrame:
    """The windows of fits.csv, such as baseline, early, late and washout: of each person, and means over people.

    A row is a `window` `of` a "person", or the "mean" over n people with its 95 % interval from `low` to `high`
    (Student's t); for one person, the interval is the one over trials that fits.csv gives. `part` is the round (in a
    study, with its session); `rounds` names the rounds that are wanted; and `is_difference` tells whether a window is a
    difference of means (savings, rebound). Values are in `unit`. Raises NotThere.

    Example: points = figures.learning_windows(data), with data as for learning_curve().
    """
    table = data.table("fits")
    table = table[table["unit"] == unit] if unit else table
    table = grouped(table.assign(part=parts_of(table)))
    table = table[table["part"].isin(rounds)] if rounds else table
    several = table["person"].nunique() > 1
    rows = []
    for window in [*WINDOWS, *DIFFERENCES]:
        if window not in table or not table[window].notna().any():
            continue
        own = table[table[window].notna()]
        each = own.groupby(["part", "group", "person"], sort=False)[window].agg(value="mean", n="count").reset_index()
        each["n"] = 1
        mean = means_with_intervals(each, ["part", "group"], sort=False)
        if not several:
            ends = own.groupby(["part", "group"], sort=False)[[f"{window}_low", f"{window}_high"]].mean()
            mean["low"], mean["high"] = ends.to_numpy().T
        rows.append(pd.concat([each.assign(of="person"), mean], ignore_index=True).assign(window=window))
    columns = ["part", "group", "window", "is_difference", "of", "person", "n", "value", "low", "high", "unit"]
    out = pd.concat(rows, ignore_index=True) if rows else pd.DataFrame(columns=columns)
    out["is_difference"] = out["window"].isin(list(DIFFERENCES))
    out["unit"] = table["unit"].iloc[0] if len(table) else unit
    return out.reindex(columns=columns)


@drawing
def draw_learning_windows(
    points: pd.DataFrame, *, ylabel: str = "", size: str = "one column", height_mm: float = 62
) -> Figure:
    """Draws learning_windows(): people as joined dots, and their mean with its interval.

    Rounds have colours; with several groups, rounds have panels and groups have colours. Differences (savings, rebound)
    have a panel of their own on the right. `ylabel` is by default "compensation" with its unit.
    """
    points = with_texts(points)
    unit = str(points["unit"].iloc[0])
    parts, groups = list(dict.fromkeys(points["part"])), list(dict.fromkeys(points["group"]))
    colour, levels = ("group", groups) if len(groups) > 1 else ("part", parts)
    split: list[Any] = parts if colour == "group" and len(parts) > 1 else [None]
    sides = [side for side in (False, True) if (points["is_difference"] == side).any()]
    shares = [points[points["is_difference"] == side]["window"].nunique() + 0.5 for side in sides]
    columns = len(sides) if len(sides) > 1 else min(len(split), 2 if size == "two columns" else 1)
    ratios = shares if len(sides) > 1 else [1.0] * columns
    rows = -(-len(split) * len(sides) // columns)
    figure, all_axes = canvas(size, height_mm * rows, rows, columns, gridspec_kw={"width_ratios": ratios})
    cells = [(part, side) for part in split for side in sides]
    for i, (axes, (part, side)) in enumerate(zip(all_axes, cells)):
        own = points[(points["is_difference"] == side) & ((points["part"] == part) | (part is None))]
        width = (WIDTHS[size] - 14 * (columns - 1)) * ratios[i % columns] / sum(ratios)
        _panel_of_windows(axes, own, [own[own[colour] == value] for value in levels], width)
        axes.set_ylabel(label("difference", unit) if side else wrapped(ylabel or label("compensation", unit), 26))
        if part is not None and not side:
            axes.set_title(part)
    for axes in all_axes[len(cells) :]:
        axes.set_visible(False)
    for side in sides:
        same_limits([axes for axes, cell in zip(all_axes, cells) if cell[1] == side])
    if len(levels) > 1:
        legend_above(figure, [_dot(i) for i in range(len(levels))], [level(value) for value in levels])
    return figure


def _panel_of_windows(axes: Axes, own: pd.DataFrame, cases: list[pd.DataFrame], width_mm: float) -> None:
    """The windows of a panel of this width, and their names; a panel without windows is hidden."""
    axes.set_visible(not own.empty)
    names = {**WINDOWS, **DIFFERENCES}
    windows = [window for window in names if (own["window"] == window).any()]
    for i, case in enumerate(cases):
        _dots(axes, case, windows, i, len(cases))
    axes.axhline(0, color=QUIET, linewidth=0.4, zorder=1)
    axes.set_xticks(range(len(windows)), [names[window] for window in windows])
    axes.set_xlim(-0.6, max(len(windows), 1) - 0.4)
    fit_names(axes, width_mm)


def _dot(i: int) -> Line2D:
    return Line2D([], [], color=COLOURS[i % len(COLOURS)], marker=MARKERS[i % len(MARKERS)], ls="")


def _dots(axes: Axes, own: pd.DataFrame, windows: list[str], i: int, levels: int) -> None:
    """Draws people's windows as faint joined dots, and means with intervals."""
    aside = (i - (levels - 1) / 2) * min(0.16, 0.7 / levels)
    hue, marker = COLOURS[i % len(COLOURS)], MARKERS[i % len(MARKERS)]
    own = own.assign(at=own["window"].map({window: place + aside for place, window in enumerate(windows)})).sort_values("at")
    mean, people = own[own["of"] == "mean"], own[own["of"] == "person"]
    if people["person"].nunique() > 1:
        opacity = faint(levels * people["person"].nunique())
        for _, one in people.groupby(["part", "person"]):
            joined = 0.0 if one["is_difference"].any() else 0.5
            axes.plot(one["at"] - 0.06 / levels, one["value"], color=hue, alpha=opacity, lw=joined, marker="o", ms=2, mew=0)
    low, high = (mean["value"] - mean["low"]).fillna(0), (mean["high"] - mean["value"]).fillna(0)
    reach = np.array([low, high])
    axes.errorbar(mean["at"], mean["value"], reach, color=hue, marker=marker, ls="", capsize=2, elinewidth=1, zorder=3)


# Generalisation


@of_data
def generalisation_curve(data: Data) -> pd.DataFrame:
    """Compensation against the angle from the trained direction, from generalisation.csv: each person's, and the means over
    people.

    A row is `of` a "person" (with n trials; conditions with the same angle are averaged), or the "mean" over n people
    with its 95 % interval from `low` to `high` (Student's t). Angles and values are in degrees; `share` is the share of
    the compensation in trained directions. Raises NotThere.
    """
    table = data.table("generalisation")
    table = table.assign(part=parts_of(table))
    table = table[table["compensation_deg"].notna() & table["angle_deg"].notna()]
    by = ["part", "group", "angle_deg"]
    table = data.in_order(table.sort_values("angle_deg", kind="stable"), ["group"]).sort_values("part", kind="stable")
    same = table.groupby([*by, "person"], sort=False)
    each = same.agg(value=("compensation_deg", "mean"), share=("share", "mean"), n=("trials", "sum")).reset_index()
    each = each.assign(of="person")
    mean = means_with_intervals(each, by, sort=False)
    out = pd.concat([each, mean] if table["person"].nunique() > 1 else [each], ignore_index=True)
    return out.reindex(columns=["part", "group", "angle_deg", "of", "person", "n", "value", "low", "high", "share"])


@drawing
def draw_generalisation(points: pd.DataFrame, *, size: str = "one column", height_mm: float = 62) -> Figure:
    """Draws generalisation_curve(), with a colour for each group or round; the trained direction is at 0°."""
    points = with_texts(points)
    figure, (axes,) = canvas(size, height_mm)
    colour = "group" if points["group"].nunique() > 1 else "part"
    levels = list(dict.fromkeys(points[colour]))
    opacity = faint(len(points.loc[points["of"] == "person", ["part", "person", colour]].drop_duplicates()))
    for i, value in enumerate(levels):
        hue, marker = COLOURS[i % len(COLOURS)], MARKERS[i % len(MARKERS)]
        own = points[points[colour] == value].sort_values("angle_deg")
        mean = own[own["of"] == "mean"]
        for _, one in own[own["of"] == "person"].groupby(["part", "person"]):
            style = {"alpha": opacity, "lw": 0.5, "ms": 2} if len(mean) else {"ms": 3.5}
            axes.plot(one["angle_deg"], one["value"], color=hue, marker=marker, **style)
        low, high = (mean["value"] - mean["low"]).fillna(0), (mean["high"] - mean["value"]).fillna(0)
        if len(mean):
            at = mean["angle_deg"]
            axes.errorbar(at, mean["value"], np.array([low, high]), color=hue, marker=marker, capsize=2, elinewidth=1, zorder=3)
    axes.axhline(0, color=QUIET, linewidth=0.4, zorder=1)
    axes.axvline(0, color=QUIET, linewidth=0.6, linestyle=":", zorder=1)
    reach = max(45.0, float(points["angle_deg"].abs().max()))
    step = 45 if reach > 60 else 15
    axes.set_xticks(np.arange(-np.floor(reach / step), np.floor(reach / step) + 1) * step)
    axes.set_xlim(-1.06 * reach, 1.06 * reach)
    axes.set_xlabel("angle from the trained direction [°]")
    axes.set_ylabel("compensation [°]")
    if len(levels) > 1:
        legend_above(figure, [_dot(i) for i in range(len(levels))], [level(value) for value in levels])
    return figure


# Courses of other measures


def _of_session(data: Data, session: str, rounds: list[str] | None, measures: list[str]) -> pd.DataFrame:
    """The trials of a session of a study and of rounds, or all, from the first to the last in which a measure was taken."""
    trials = data.table("trials")
    if session:
        trials = trials[trials["study_session"].astype(str) == session]
    if rounds:
        trials = trials[trials["round"].astype(str).isin(rounds)]
    table = numbered(trials.drop(columns=["round", "perturbation", "trial"], errors="ignore"))
    taken = table.loc[table[measures].notna().any(axis=1), "trial"]
    return table[table["trial"].between(taken.min(), taken.max())] if len(taken) else table.iloc[:0]


@of_data
def measures_over_trials(
    data: Data, *, measures: list[str], session: str = "", rounds: list[str] | None = None, bin_trials: int = 1
) -> pd.DataFrame:
    """Measures of trials.csv over the trials of the session: each person's values, and means over people.

    Rows are as in learning_curve(), and have the `measure` and its `unit`; `session` names a session of a study, and `rounds`
    those that are wanted, by default all; trials are counted from the first that is wanted. With `bin_trials`, each point
    stands for that many trials of a block. Raises NotThere.

    >>> from dihaptic import figures
    >>> points = figures.measures_over_trials(figures.read(lift_session), measures=["peak_grip_N"])
    >>> points[["measure", "of", "trial", "unit"]].values.tolist()
    [['peak_grip_N', 'person', 1.0, 'N'], ['peak_grip_N', 'schedule', 1.0, 'N']]
    """
    for measure in checked_list("measures", measures):
        data.measure(measure)
    table = _of_session(data, session, rounds, measures)
    several = table["person"].nunique() > 1
    found = []
    for measure in measures:
        unit = data.measure(measure).unit
        own = within_limits(courses_of(table.assign(value=table[measure]), bin_trials, several), measure)
        own.insert(0, "measure", measure)
        found.append(own.assign(unit=unit))
    return pd.concat(found, ignore_index=True)


@drawing
def draw_measures_over_trials(
    points: pd.DataFrame, *, size: str = "two columns", height_mm: float = 48
) -> Figure:
    """Draws measures_over_trials(), with a panel for each measure, and a colour for each group.

    >>> from dihaptic import figures
    >>> points = figures.measures_over_trials(figures.read(lift_session), measures=["peak_grip_N"])
    >>> [axes.get_ylabel() for axes in figures.draw_measures_over_trials(points).axes]
    ['peak grip [N]']
    """
    points = with_texts(points)
    panels = []
    for measure, own in points.groupby("measure", sort=False):
        unit = own["unit"].fillna("").iloc[0]
        panels.append(("", own, label(measure, unit)))
    return draw_courses(points, panels, size, height_mm, False)


# Which figures a design calls for


def plans(data: Data) -> Iterator[Plan]:
    """Learning curves, windows and generalisation of adaptation; without adaptation, the task's measures over trials."""
    learned = data.has("adaptation") and bool(data.table("adaptation")["compensation"].notna().any())
    if learned:
        yield from _plans_of_curves(data)
    if data.has("fits"):
        yield from _plans_of_windows(data)
    if data.has("generalisation"):
        yield from _plan_of_generalisation(data)
    if not learned:
        yield from _plans_of_measures(data)


def _quantity(data: Data, unit: str) -> str:
    """The label of the axis of compensation, for the rounds with this unit."""
    if not data.has("fits"):
        return label("compensation", unit)
    fits = data.table("fits")
    names = set(fits[fits["unit"] == unit]["measure"].dropna())
    word = LEARNED.get(str(next(iter(names))), "compensation") if len(names) == 1 else "compensation"
    return label(word, unit)


def _left_out(table: pd.DataFrame, panels: int) -> str:
    """Sentences about what a course does not show."""
    catch = " Catch trials, whose places in their block differ between people, are left out." if scattered(table).any() else ""
    return catch + unnamed(table, panels)


def _too_many(data: Data) -> str:
    """A sentence for the caption if groups have no colours."""
    groups = data.table("trials")["group"].nunique()
    return f" The {groups} groups are not distinguished." if groups > MOST_GROUPS else ""


def _lines_in_words(table: pd.DataFrame, width: int) -> str:
    """The meaning of the lines and dots of a course, for a caption."""
    counts = table.groupby("group")["person"].nunique()
    groups = len(counts)
    if table["person"].nunique() == 1:
        return "Dots are trials"
    each = f" over {width} trials of a block" if width > 1 else ""
    whose = "of the groups' people" if groups > 1 else "of people"
    bands = "lines and bands" if (counts > 1).any() else "lines"
    return f"Thin lines are people's values{each}; {bands} are means {whose}{intervals(counts, BY_T)}"


def _plans_of_curves(data: Data) -> Iterator[Plan]:
    adaptation = data.table("adaptation")
    units = list(adaptation[adaptation["compensation"].notna()]["unit"].dropna().unique())
    for unit in units:
        table = _adaptation(data, unit, None)
        parts = [part for part in dict.fromkeys(table["part"]) if table[table["part"] == part]["value"].notna().any()]
        name = "learning-curve" + ("" if len(units) == 1 else "-percent" if unit == "%" else f"-{unit}")
        for first in range(0, len(parts), _MOST_PANELS):
            some = parts[first : first + _MOST_PANELS]
            number = f"-{first // _MOST_PANELS + 1}" if len(parts) > _MOST_PANELS else ""
            options: dict[str, Any] = {"unit": unit} if len(units) > 1 else {}
            if len(some) < table["part"].nunique():
                options["rounds"] = some
            own = table[table["part"].isin(some)]
            yield _plan_of_curve(data, own, options, unit, name + number)
            if len(set(data.laboratories.values())) >= _LEAST_LABORATORIES:
                yield _plan_of_laboratories(data, own, options, unit, name.replace("learning", "laboratory") + number)


def _plan_of_curve(data: Data, table: pd.DataFrame, options: dict[str, Any], unit: str, name: str) -> Plan:
    parts = list(dict.fromkeys(table["part"]))
    people = table["person"].nunique()
    width = 1 if people == 1 else width_of_bins(table, _MOST_POINTS if len(parts) == 1 else _MOST_POINTS_OF_SEVERAL)
    measured = table[table["value"].notna() & ~scattered(table)]
    ylabel = _quantity(data, unit)
    fitted = "two-rate model" if people == 1 else "mean over people of the two-rate models fitted to each person"
    model = f"; the dashed line is the {fitted}"
    channels = " Values are those of trials in force channels." if set(measured["kind"]) == {"force_channel"} else ""
    dotted = "; the dotted line is the perturbation" if (table["perturbation"].fillna(0) != 0).any() else ""
    short = table.groupby("part")["trial"].max().max() <= 60 and len(parts) == 1
    part = "round" if data.rounds else "session"
    return Plan(
        name=name,
        title="Learning over trials",
        caption=f"{ylabel.split(' [')[0].capitalize()} over the trials of {'each ' if len(parts) > 1 else 'the ' if part == 'session' else 'a '}{part}. "
        f"{_lines_in_words(table, width)}{model if table['fit'].notna().any() else ''}{dotted}.{channels}"
        f"{_left_out(table, len(parts))}{_too_many(data)} {counted(people, 'person', 'people')}, "
        f"{counted(len(measured), 'measured trial')}; practice and all but the last attempt at a trial are left out.",
        points=learning_curve,
        points_options={**options, **({"bin_trials": width} if width > 1 else {})},
        drawing=draw_learning_curve,
        drawing_options={"ylabel": ylabel, "size": "one column" if short else "two columns"},
    )


def _plan_of_laboratories(data: Data, table: pd.DataFrame, options: dict[str, Any], unit: str, name: str) -> Plan:
    curve = _plan_of_curve(data, table, options, unit, name)
    laboratories = len(set(data.laboratories.values()))
    people = table["person"].nunique()
    each = table.groupby(table["session"].map(data.laboratories))["person"].nunique()
    size = f"{each.min()}" if each.min() == each.max() else f"{each.min()} to {each.max()}"
    return replace(
        curve,
        title="Learning in other laboratories",
        caption=f"Thin lines are the means of {laboratories} laboratories of {size} people each, the thick line is their mean. The mean "
        "of a further laboratory with as many people is expected in the dark band with a probability of 50 %, and in the light "
        "band with 90 % (Student's t). How laboratories differ is taken from the population file; the manual's page on simulated "
        f"people compares such bands with groups of real people.{_left_out(table, table['part'].nunique())}{_too_many(data)} "
        f"{counted(people, 'person', 'people')}; practice and all but the last attempt at a trial are left out.",
        points=laboratory_curves,
        drawing=draw_laboratory_curves,
    )


def _plans_of_windows(data: Data) -> Iterator[Plan]:
    fits = data.table("fits")
    known = [window for window in [*WINDOWS, *DIFFERENCES] if window in fits]
    fits = grouped(fits[fits[known].notna().any(axis=1)])
    fits = fits.assign(part=parts_of(fits))
    units = list(fits["unit"].dropna().unique())
    for unit in units:
        own = fits[fits["unit"] == unit]
        parts = list(dict.fromkeys(own["part"]))
        name = "learning-windows" + ("" if len(units) == 1 else "-percent" if unit == "%" else f"-{unit}")
        most = 4 if own["group"].nunique() > 1 else len(COLOURS)
        for first in range(0, len(parts), most):
            some = parts[first : first + most]
            number = f"-{first // most + 1}" if len(parts) > most else ""
            options: dict[str, Any] = {"unit": unit} if len(units) > 1 else {}
            if len(parts) > most:
                options["rounds"] = some
            yield _plan_of_windows(data, own[own["part"].isin(some)], options, unit, name + number)


def _plan_of_windows(data: Data, own: pd.DataFrame, options: dict[str, Any], unit: str, name: str) -> Plan:
    windows = [window for window in [*WINDOWS, *DIFFERENCES] if window in own and own[window].notna().any()]
    people, groups, rounds = own["person"].nunique(), own["group"].nunique(), own["part"].nunique()
    dots = "Marks are one person's means" if people == 1 else "Dots are people, joined over windows; marks are their means"
    means = intervals(own.groupby(["part", "group"])["person"].nunique(), f" over people{BY_T}")
    means = ", with 95 % intervals over trials" if people == 1 else means
    clamp, washout = any("clamp" in window for window in windows), "washout_first" in windows
    also = " and ".join(word for word, there in (("clamp", clamp), ("washout", washout)) if there)
    about = [
        "Baseline: all measured trials before the first perturbed block" if "baseline" in windows else "",
        "early and late: the first eight measured trials of the first perturbed block, and the last eight with that "
        "perturbation",
        "catch trials: all of them" if "catch" in windows else "",
        f"{also}: the first{' or last' if clamp else ''} eight measured trials of the block" if also else "",
        "savings: the first eight measured trials of relearning less those of learning" if "savings" in windows else "",
        "rebound: the end of the clamp less what preceded it" if "rebound" in windows else "",
        "where there are fewer than eight, all of them are taken",
    ]
    windows_in_words = "; ".join(part for part in about if part)
    wide = len(windows) > 4 or (groups > 1 and rounds > 1) or max(groups, rounds) > 2
    return Plan(
        name=name,
        title="Learning in windows of trials",
        caption=f"{dots}{means}. {windows_in_words[:1].upper()}{windows_in_words[1:]}.{_too_many(data)} "
        f"{counted(people, 'person', 'people')}{f', {rounds} rounds' if rounds > 1 else ''}, "
        f"{counted(int(own['measured'].sum()), 'measured trial')}.",
        points=learning_windows,
        points_options=options,
        drawing=draw_learning_windows,
        drawing_options={"ylabel": _quantity(data, unit), "size": "two columns" if wide else "one column"},
    )


def _plan_of_generalisation(data: Data) -> Iterator[Plan]:
    table = data.table("generalisation")
    table = table[table["compensation_deg"].notna() & table["angle_deg"].notna()]
    if table["angle_deg"].nunique() < 2:
        return
    people = table["person"].nunique()
    counts = table.groupby([parts_of(table), "group", "angle_deg"])["person"].nunique()
    lines = "" if people == 1 else f" Thin lines are people, marks their means{intervals(counts, BY_T)}."
    yield Plan(
        name="generalisation",
        title="Generalisation to other directions",
        caption="Compensation without a visible error, minus that before training, against the angle from the nearest trained "
        f"direction.{lines} {counted(people, 'person', 'people')}, {counted(int(table['trials'].sum()), 'trial')}.",
        points=generalisation_curve,
        drawing=draw_generalisation,
    )


def _plans_of_measures(data: Data) -> Iterator[Plan]:
    trials = data.table("trials")
    known = trials["study_session"].notna() if "study_session" in trials else pd.Series(False, index=trials.index)
    sessions = list(dict.fromkeys(trials[known]["study_session"].astype(str))) if known.any() else [""]
    for session in sessions:
        own = trials[trials["study_session"].astype(str) == session] if session else trials
        for rounds in _rounds_apart(own, data.rounds):
            names = [*([session] if len(sessions) > 1 else []), *rounds]
            plan = _plan_of_measures(data, session, rounds, names)
            if plan is not None:
                yield plan


#: What is said of a figure of one round.
_OF_ONE_ROUND = (
    " People do the rounds in different orders: trials are counted within this one, and those outside the rounds are not drawn."
)


def _rounds_apart(trials: pd.DataFrame, rounds: list[str]) -> list[list[str]]:
    """Each round, if people do them in different orders: a mean over people at a trial would then mix them. Otherwise [[]]."""
    if "round" not in trials:
        return [[]]
    known = trials[trials["round"].notna()]
    orders = {tuple(dict.fromkeys(own["round"].astype(str))) for _, own in known.groupby(sitting_columns(known), sort=False)}
    return [[name] for name in rounds if any(name in order for order in orders)] if len(orders) > 1 else [[]]


def _plan_of_measures(data: Data, session: str, rounds: list[str], names: list[str]) -> Plan | None:
    suffix = "".join("-" + re.sub(r"\W|_", "-", name.lower()) for name in names)
    table = _of_session(data, session, rounds, [measure.column for measure in data.measures])
    if table.empty:
        return None
    shown = table[~scattered(table)]
    measures = []
    for measure in data.measures:
        values = shown[shown[measure.column].notna()]
        # a constant has no course
        if values["trial"].nunique() >= _LEAST_TRIALS and values[measure.column].nunique() > 1:
            measures.append(measure)
    if not measures:
        return None
    some, rest = measures[:_MOST_PANELS], measures[_MOST_PANELS:]
    people = table["person"].nunique()
    most = _MOST_POINTS if len(some) == 1 else _MOST_POINTS_OF_SEVERAL
    widths = [width_of_bins(table.assign(value=table[measure.column]), most) for measure in some]
    width = 1 if people == 1 else max(widths)
    omitted = f" Not shown: {', '.join(words_of(measure.column, measure.unit) for measure in rest)}." if rest else ""
    values = table[[measure.column for measure in some]].notna().any(axis=1)
    return Plan(
        name=f"measures-over-trials{suffix}",
        title="Measures over trials" + (f" ({', '.join(names)})" if names else ""),
        caption=f"{_lines_in_words(table, width)}.{_left_out(table, len(some))}{_too_many(data)} "
        f"{counted(people, 'person', 'people')}, "
        f"{counted(int(values.sum()), 'trial')}; practice and all but the last attempt at a trial are left out.{omitted}"
        + (_OF_ONE_ROUND if rounds else "")
        + said_of_limits({measure.column: words_of(measure.column, measure.unit) for measure in some}),
        points=measures_over_trials,
        points_options={
            "measures": [measure.column for measure in some],
            **({"session": session} if session else {}),
            **({"rounds": rounds} if rounds else {}),
            **({"bin_trials": width} if width > 1 else {}),
        },
        drawing=draw_measures_over_trials,
        drawing_options={
            "size": "two columns" if len(some) > 1 or table["trial"].max() > 60 else "one column",
        },  # fmt: skip
        heading="Over trials",
    )
