"""Measures by condition: people as joined dots, their mean, and its interval."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from ..errors import NotThere, error
from .data import ASIDE, SITTING, Data, checked_list, sitting_columns, with_design
from .means import intervals, means_with_intervals, said_of_limits, within_limits
from .saving import Plan
from .style import COLOURS, MARKERS, WIDTHS, canvas, drawing, faint, fit_names, legend_above, of_data, same_limits, wrapped
from .words import counted, label, level, words_of

#: Heading above these figures in a report.
HEADING = "By condition"
#: Maximum numbers of panels in a figure, and of levels with colours of their own.
_MOST_PANELS = 9
_MOST_COLOURS = 7
#: Figures of lifts.csv that a study of grip reports (Johansson and Westling 1984).
LIFT_MEASURES = [
    "peak_grip_N", "peak_grip_rate_N_s", "peak_load_rate_N_s", "static_grip_N", "static_ratio", "safety_margin", "loading_s",
]  # fmt: skip


def counting_trials(data: Data, table: str = "trials") -> pd.DataFrame:
    """The last attempt at each trial, without practice and catch trials; for "lifts", their lifts, with the trials' design.

    >>> from dihaptic import figures
    >>> len(counting_trials(figures.read(lift_session), "lifts"))
    1
    """
    trials = data.table("trials")
    if table != "trials":
        trials = with_design(trials, data.table(table), data.factors)
    attrs = trials.attrs
    trials = trials.drop_duplicates([*sitting_columns(trials), "trial_num"], keep="last")
    trials = trials[~trials["kind"].isin(ASIDE)] if "kind" in trials else trials
    trials.attrs = attrs
    return trials


def without_channels(trials: pd.DataFrame) -> pd.DataFrame:
    """These trials without those in force channels, whose walls hold the hand, unless all trials are in channels."""
    if "kind" not in trials:
        return trials
    free = trials[trials["kind"] != "force_channel"]
    return free if len(free) else trials


def each_in_conditions(trials: pd.DataFrame, measure: str, by: list[str], single: bool) -> pd.DataFrame:
    """The values of a measure that are averaged in each condition: people's means over n trials or, for one person, the
    trials.

    A row has the columns `by`, person, value, n, and `of`, which is "person". Force channels are left out, unless the
    measure exists only in them.
    """
    known = without_channels(trials[trials[measure].notna()])
    if single:
        return known[["person", *by, measure]].rename(columns={measure: "value"}).assign(n=1, of="person")
    people = known.groupby([*by, "person"], dropna=False, sort=True)[measure].agg(value="mean", n="count")
    return people.reset_index().assign(of="person")


def averaged_over(data: Data, trials: pd.DataFrame, by: list[str]) -> list[str]:
    """The factors whose levels differ among trials that have the same levels of the columns `by`."""
    same = trials.groupby(by, dropna=False) if by else trials.assign(all="").groupby("all")
    return _separable(trials, [name for name in data.factors if name not in by and same[name].nunique().max() > 1])


def check_column(table: pd.DataFrame, name: str) -> None:
    """Raises NotThere when the table has no such column."""
    if name not in table:
        columns = [str(column) for column in table]
        raise NotThere(name, "is not a column of these trials", columns, f"Columns: {', '.join(columns)}.")


@of_data
def means_by_condition(
    data: Data, *, measures: list[str], x: str, colour: str = "", panel: str = "", table: str = "trials"
) -> pd.DataFrame:
    """Means of measures in each condition: of each person, and over people.

    `x`, `colour` and `panel` are columns of trials.csv. A row has the measure, the levels, and `of`: "person", if
    `value` is a person's mean over n trials; or "mean", if it is the mean over n people, with its 95 % interval from
    `low` to `high` (Student's t). For one person, the dots are trials, and the mean is the mean over trials. Practice,
    catch trials and all but the last attempt at a trial are left out; so are force channels, unless the measure exists
    only in them. Raises NotThere, or Error when no trial has a value.

    >>> from dihaptic import figures
    >>> points = means_by_condition(figures.read(lift_session), measures=["peak_grip_N"], x="trial_num", table="lifts")
    >>> points[["measure", "of", "n"]].values.tolist()
    [['peak_grip_N', 'person', 1], ['peak_grip_N', 'mean', 1]]
    """
    trials = counting_trials(data, table)
    by = [name for name in (x, colour, panel) if name]
    for name in by:
        check_column(trials, name)
    units = trials.attrs.get("units", {})
    single = len(data.people) == 1
    parts = []
    for measure in checked_list("measures", measures):
        check_column(trials, measure)
        if not pd.api.types.is_numeric_dtype(trials[measure]):
            raise error("contains words, which have no mean", "Name a column of numbers.", key=measure)
        each = each_in_conditions(trials, measure, by, single)
        mean = within_limits(means_with_intervals(each, by, dropna=False, sort=True), measure)
        both = pd.concat([each, mean], ignore_index=True)
        both.insert(0, "measure", measure)
        parts.append(both)
    columns = ["measure", *by, "of", "person", "n", "value", "low", "high"]
    out = pd.concat(parts, ignore_index=True).reindex(columns=columns)
    if out.empty:
        raise error("has no value in any of the included trials", "Name a measure of this task.", key=", ".join(measures))
    out = data.in_order(out, by)  # the order of drawing
    out = out.sort_values("measure", key=lambda names: names.map({m: i for i, m in enumerate(measures)}), kind="stable")
    out = out.reset_index(drop=True)
    out.attrs["units"] = {name: unit for name, unit in units.items() if name in [*measures, *by]}
    return out


@drawing
def draw_conditions(
    points: pd.DataFrame, *, x: str, colour: str = "", panel: str = "", size: str = "one column", height_mm: float = 60,
    order: dict[str, list[str]] | None = None,
) -> Figure:  # fmt: skip
    """Draws means_by_condition(), with a panel for each measure and each level of `panel`, and a colour for each level of
    `colour`.

    `order` lists, in order, the levels of those columns that contain words.

    >>> from dihaptic import figures
    >>> data = figures.read(lift_session)
    >>> points = figures.means_by_condition(data, measures=["peak_grip_N"], x="trial_num", table="lifts")
    >>> [axes.get_ylabel() for axes in draw_conditions(points, x="trial_num").axes]
    ['peak grip [N]']
    """
    units = points.attrs.get("units", {})
    for name in (x, colour, panel):
        if name:
            check_column(points, name)
    means = points[points["of"] == "mean"]
    if means.empty:
        raise error("no mean is available to be drawn", "Draw a table of means_by_condition() with its rows of means.")
    if means.duplicated(["measure", *(name for name in (x, colour, panel) if name)]).any():
        raise error("there are several means at one place", "As colour or panel, choose a column that separates them.", key=x)
    measures = list(dict.fromkeys(points["measure"]))
    order = order or {}
    for column, levels in order.items():
        check_column(points, column)
        known = list(points[column].dropna().unique())
        for each in levels:
            if each not in known:
                raise NotThere(str(each), f"is not a level of {column}", [str(value) for value in known], "")
    panels = list(_places(points[panel], order.get(panel))) if panel else [None]
    rows, columns = _grid(len(measures), len(panels), size)
    figure, all_axes = canvas(size, height_mm * rows, rows, columns)
    places = _places(points[x], order.get(x))
    colours = list(_places(points[colour], order.get(colour))) if colour else [None]
    cells = [(measure, part) for measure in measures for part in panels]
    for axes, (measure, part) in zip(all_axes, cells):
        own = points[points["measure"] == measure]
        if panel:
            own = own[own[panel] == part]
        for i, value in enumerate(colours):
            shown = own if value is None else own[own[colour] == value]
            shown = shown[shown[x].notna()]
            _dots_and_mean(axes, shown, x, places, i, len(colours), level(value, units.get(colour, "")))
        _label(axes, places, label(x, units.get(x, "")), label(measure, units.get(measure, "")), WIDTHS[size] / columns)
        if panel:
            axes.set_title(level(part, units.get(panel, "")))
    for measure in measures:
        same_limits([axes for axes, (of, _) in zip(all_axes, cells) if of == measure])
    for axes in all_axes[len(cells) :]:
        axes.set_visible(False)
    if colour:
        handles, names = all_axes[0].get_legend_handles_labels()
        legend_above(figure, handles, names, words_of(colour, units.get(colour, "")))
    return figure


def _grid(measures: int, panels: int, size: str) -> tuple[int, int]:
    """Rows and columns of panels: each measure has a row or, if each has a single panel, measures are side by side."""
    if panels > 1:
        return measures, panels
    columns = min(measures, 3 if size == "two columns" else 1)
    columns = 2 if measures == 4 and columns == 3 else columns  # rows that are filled evenly
    return -(-measures // columns), columns


def _places(levels: pd.Series, order: list[str] | None) -> dict[Any, float]:
    """The position of each level on the axis: numbers are at their values."""
    values = list(levels.dropna().unique())
    if all(isinstance(value, (int, float, np.number)) for value in values):
        return {value: float(value) for value in sorted(values)}
    known = [value for value in order or [] if value in values]
    rest = [value for value in values if value not in known]
    return {value: float(i) for i, value in enumerate([*known, *rest])}


def _dots_and_mean(
    axes: Axes, shown: pd.DataFrame, x: str, places: dict[Any, float], i: int, colours: int, name: str
) -> None:
    """People as faint dots joined over x, and their mean with its interval."""
    step = min(np.diff(sorted(places.values()))) if len(places) > 1 else 1.0
    aside = (i - (colours - 1) / 2) * 0.12 * step
    hue, marker = COLOURS[i % len(COLOURS)], MARKERS[i % len(MARKERS)]
    people = shown[shown["of"] == "person"]
    opacity = faint(colours * people["person"].nunique())
    for _, own in people.groupby("person"):
        own = own.sort_values(x, key=lambda levels: levels.map(places))
        at = [places[value] + aside for value in own[x]]
        joined = len(own) == own[x].nunique()  # one person's trials are not joined
        axes.plot(at, own["value"], color=hue, alpha=opacity, linewidth=0.6 if joined else 0, marker=".", markersize=3)
    mean = shown[shown["of"] == "mean"].assign(at=lambda rows: [places[value] + aside for value in rows[x]]).sort_values("at")
    low, high = (mean["value"] - mean["low"]).fillna(0), (mean["high"] - mean["value"]).fillna(0)
    reach = np.array([low, high])
    axes.errorbar(mean["at"], mean["value"], reach, color=hue, marker=marker, capsize=2, elinewidth=1, label=name, zorder=3)


def _label(axes: Axes, places: dict[Any, float], xlabel: str, ylabel: str, width_mm: float) -> None:
    """Labels of a panel of this width."""
    words = any(isinstance(value, str) for value in places)
    if words or len(places) <= 6:
        axes.set_xticks(list(places.values()), [level(value) for value in places])
    elif xlabel.endswith("[°]"):
        axes.xaxis.set_major_locator(MaxNLocator(nbins=6, steps=[1, 1.5, 3, 4.5, 9, 10]))  # parts of a turn
    if words:
        fit_names(axes, width_mm)
    axes.set_xlabel(wrapped(xlabel, 34))
    axes.set_ylabel(wrapped(ylabel, 24))
    axes.margins(x=0.12 if len(places) > 1 else 0.5, y=0.08)


# Which figures a design calls for


def plans(data: Data) -> Iterator[Plan]:
    """A figure of the task's measures by condition, and one of its lifts'."""
    axes_of = axes_of_design(data)
    if not axes_of:
        return
    own = [measure.column for measure in data.measures]
    if own:
        yield from _plans_of(data, "trials", own, "measures", axes_of)
    if data.has("lifts"):
        if known := measures_of_lifts(data):
            yield from _plans_of(data, "lifts", known, "lifts", axes_of)


def measures_of_lifts(data: Data) -> list[str]:
    """The LIFT_MEASURES that these lifts have and that the task does not measure itself, whatever their names."""
    lifts, both, trials = data.table("lifts"), counting_trials(data, "lifts"), counting_trials(data)
    keys = [key for key in (*SITTING, "trial_num") if key in trials and key in both]
    of_trials = both[keys].merge(trials, on=keys, how="left")
    own = [of_trials[measure.column] for measure in data.measures if measure.column in of_trials]
    return [
        name for name in LIFT_MEASURES
        if name in lifts and lifts[name].notna().any()
        and not any(np.isclose(values, both[name], rtol=1e-6, equal_nan=True).all() for values in own)
    ]  # fmt: skip


def axes_of_design(data: Data) -> dict[str, str]:
    """The columns of trials.csv for x, colours and panels: numeric factors go to x, and factors with few levels to colours."""
    trials = data.table("trials")
    if "condition" not in trials:
        return {}
    trials = trials[~trials["kind"].isin(ASIDE)] if "kind" in trials else trials
    factors = _separable(trials, [name for name in data.factors if trials[name].nunique() > 1])
    if not factors:
        return _axes_of_names(trials)
    levels = {name: int(trials[name].nunique()) for name in [*factors, "group"]}
    numeric = [name for name in factors if pd.api.types.is_numeric_dtype(trials[name])]
    x = max(numeric or factors, key=lambda name: levels[name])
    rest = sorted((name for name in factors if name != x), key=lambda name: levels[name])
    if levels["group"] > 1:
        rest.insert(0, "group")
    rest = [name for name in rest if levels[name] <= _MOST_COLOURS]
    out = {"x": x}
    if rest:
        out["colour"] = rest[0]
    if len(rest) > 1 and levels[rest[1]] <= 4:
        out["panel"] = rest[1]
    return out


def _separable(trials: pd.DataFrame, factors: list[str]) -> list[str]:
    """The factors without those whose levels go one by one with the levels of one before, such as rounds that differ in a lag."""
    out: list[str] = []
    for name in factors:
        cases = [trials[[other, name]].dropna().drop_duplicates() for other in out]
        if not any(len(own) == own.iloc[:, 0].nunique() == own.iloc[:, 1].nunique() == trials[name].nunique() for own in cases):
            out.append(name)
    return out


def _axes_of_names(trials: pd.DataFrame) -> dict[str, str]:
    """The same for a design without factors: conditions, and perturbations that are crossed with them; or blocks."""
    if trials["condition"].nunique() > 1:
        crossed = trials.groupby("condition")["perturbation"].nunique().max() > 1
        several = trials["group"].nunique() > 1
        colour = "group" if several else "perturbation" if crossed and trials["perturbation"].nunique() <= _MOST_COLOURS else ""
        return {"x": "condition", **({"colour": colour} if colour else {})}
    if trials["block"].nunique() > 1:
        return {"x": "block", **({"colour": "group"} if trials["group"].nunique() > 1 else {})}
    return {}


def _has_catches(data: Data) -> bool:
    trials = data.table("trials")
    return "kind" in trials and bool((trials["kind"] == "catch").any())


def _pooled(trials: pd.DataFrame, by: list[str]) -> str:
    """A sentence for a caption if trials of several blocks, or of several perturbations in a block, are averaged."""
    told = ""
    if {"block", "perturbation"} <= set(trials) and "perturbation" not in by:
        known = trials.assign(perturbation=trials["perturbation"].fillna("none"))
        mixed = known.groupby(list(dict.fromkeys([*by, "block"])), dropna=False)["perturbation"].transform("nunique") > 1
        if mixed.any():
            found = list(dict.fromkeys(known.loc[mixed, "perturbation"].astype(str)))
            told = f" Trials of one block with different perturbations are averaged ({_few(found)}); population-measures.csv has each."
    blocks = [str(block) for block in trials["block"].dropna().unique()] if "block" in trials and "block" not in by else []
    return told + (f" All blocks are pooled ({_few(blocks)})." if len(blocks) > 1 else "")


def _few(names: list[str]) -> str:
    """The names, or their number if they are many."""
    return ", ".join(names) if len(names) <= 6 else f"{len(names)}"


def _plans_of(data: Data, table: str, measures: list[str], name: str, design: dict[str, str]) -> Iterator[Plan]:
    trials = counting_trials(data, table)
    # a questionnaire, for example, may be asked in a single condition
    measures = [name for name in measures if trials.loc[trials[name].notna(), design["x"]].nunique() > 1]
    trials = trials[trials[measures].notna().any(axis=1)]
    if not measures or trials.empty:
        return
    people = trials["person"].nunique()
    by_columns = list(design.values())
    units = data.table("trials").attrs.get("units", {})
    panels = trials[design["panel"]].nunique() if "panel" in design else 1
    most = max(1, _MOST_PANELS // panels) if panels > 1 else 6
    each = -(-len(measures) // -(-len(measures) // most))  # about as many in each figure
    for first in range(0, len(measures), each):
        some = measures[first : first + each]
        by = " and ".join(words_of(column, units.get(column, "")) for column in design.values())
        number = f"-{first // each + 1}" if len(measures) > each else ""
        dots = "Dots are trials" if people == 1 else "Dots are people's means over trials, joined over conditions"
        over = "trials" if people == 1 else "people"
        rest = [words_of(name, units.get(name, "")) for name in averaged_over(data, trials, by_columns)]
        channels = "kind" in trials and (trials["kind"] == "force_channel").any()
        channels = ", and force channels from measures that other trials have" if channels else ""
        drawn = pd.concat([without_channels(trials[trials[measure].notna()]) for measure in some])
        cells = [each_in_conditions(trials, name, by_columns, people == 1).groupby(by_columns, dropna=False) for name in some]
        values = pd.concat([cell["value"].count() for cell in cells])
        order = {
            name: [value for value in data.levels(name) if (drawn[name] == value).any()]
            for name in design.values() if not pd.api.types.is_numeric_dtype(trials[name])
        }  # fmt: skip
        yield Plan(
            name=f"{name}-by-{'-'.join(design.values())}{number}".replace("_", "-"),
            title=f"{'Lifts' if table == 'lifts' else 'Measures'} by {by}{', continued' if first else ''}",
            caption=f"{dots}; marks are means over {over}{intervals(values)}. {counted(people, 'person', 'people')}, "
            f"{counted(len(trials), 'trial')}; practice, catch trials and repeated attempts are left out{channels}."
            + (" Catch trials are in population-measures.csv." if people > 1 and _has_catches(data) else "")
            + (f" Averaged over {' and '.join(rest)}." if rest else "")
            + _pooled(trials, list(design.values()))
            + said_of_limits({name: words_of(name, units.get(name, "")) for name in some}),
            points=means_by_condition,
            points_options={"measures": some, **design, "table": table},
            drawing=draw_conditions,
            drawing_options={
                **design,
                "size": "two columns" if max(len(some), panels) > 1 else "one column",
                **({"order": order} if order else {}),
            },
        )
