"""Grip-lifts: courses of grip, load and height around lift-off, grip against load, change over lifts, durations of phases."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ..errors import NotThere, error
from ..session import Session
from .data import ASIDE, Data, sitting_columns, with_design
from .saving import Plan
from .style import COLOURS, MARKERS, QUIET, WIDTHS, canvas, drawing, faint, legend_above, of_data, wrapped
from .words import counted, label, level

Array = npt.NDArray[Any]

#: Heading above these figures in a report.
HEADING = "Grip and lift"
#: Maximum numbers of conditions in a panel, of panels side by side, and of conditions one below another.
_MOST_CASES, _MOST_PANELS, _MOST_ROWS = 6, 4, 24
#: Loads below this count as no load, so the ratio of grip and load is not drawn there [N].
LEAST_LOAD = 0.2
#: Quantities in a figure of courses, from top to bottom, and their units.
QUANTITIES = {"grip force": "N", "load force": "N", "grip / load": "", "height": "mm"}
#: Moments of a lift to which courses are aligned: columns of lifts.csv without "_s".
MOMENTS = {"lift_off": "lift-off", "load_onset": "load onset", "touch": "touch"}
#: Phases of a lift, and their columns of lifts.csv.
PHASES = {"preload": "preload_s", "loading": "loading_s", "releasing": "releasing_s"}
#: Time after lift-off up to which grip against load is drawn [s].
_AFTER_LIFT_OFF = 1.0
#: End of the ratio's axis, as a multiple of the ratio's 90th percentile.
_RATIO_AXIS = 1.6
_DASHES: list[Any] = ["-", (0, (5, 1.5)), (0, (1.5, 1)), (0, (6, 1.5, 1.5, 1.5)), (0, (3, 1)), (0, (6, 1.5, 1.5, 1.5, 1.5, 1.5))]
#: Conditions that are named after a colour are drawn in that colour.
_OF_COLOURS = {"blue": 0, "red": 1, "green": 2, "pink": 3, "orange": 4, "yellow": 4, "black": 6}


# Which lifts


def _joined(data: Data, trials: pd.DataFrame, lifts: pd.DataFrame) -> pd.DataFrame:
    """Each lift with the columns of its trial, numbered for each person; of repeated attempts, the last."""
    frame = with_design(trials, lifts, data.factors)
    frame = frame.drop_duplicates([*sitting_columns(frame), "trial_num"], keep="last")
    for column in ("kind", "block", "condition", "perturbation"):
        if column not in frame:
            frame[column] = ""
    frame = frame.reset_index(drop=True)
    frame["lift_number"] = frame.groupby(["group", "person"], dropna=False).cumcount() + 1  # a person may be in two groups
    frame["presented"] = _presented(frame)
    return frame


def _presented(frame: pd.DataFrame) -> pd.Series:
    """The name of what differs between the trials of a block: the condition, the perturbation, or both."""
    words = pd.DataFrame(index=frame.index)
    words["condition"] = frame["condition"].fillna("").astype(str).replace("", "no condition")
    words["perturbation"] = frame["perturbation"].fillna("").astype(str).replace("", "no perturbation")
    kept = frame.loc[~frame["kind"].isin(["practice"])].index
    common = "perturbation" if words.loc[kept, "perturbation"].nunique() > 1 else "condition"
    out = words[common].copy()
    for _, own in words.groupby(frame["block"].fillna("")):
        varying = [column for column in words if own[column].nunique() > 1]
        if varying:
            out[own.index] = own[varying].agg(", ".join, axis=1)
    return out


def _all_lifts(data: Data) -> pd.DataFrame:
    return _joined(data, data.table("trials"), data.table("lifts"))


def _recorded_lifts(data: Data) -> pd.DataFrame:
    """The lifts of the sessions with a recording; `of` is the number of a lift's session in Data.recorded."""
    parts = []
    for number, each in enumerate(data.recorded):
        if {"trials", "lifts"} <= set(each.session.tables):
            part = _joined(data, each.table("trials"), each.table("lifts"))
            parts.append(part.assign(of=number))
    out = pd.concat(parts, ignore_index=True) if parts else _all_lifts(data).iloc[:0].assign(of=0)
    if not out.empty:
        out["presented"] = _presented(out)
    return out


def _counting(frame: pd.DataFrame, catch: bool) -> pd.DataFrame:
    """Complete lifts, without practice, and without catch trials unless they are wanted."""
    aside = [kind for kind in ASIDE if not (catch and kind == "catch")]
    return frame[(frame["lift"] == "complete") & ~frame["kind"].isin(aside)]


def _levels(data: Data, column: str, found: list[Any]) -> list[Any]:
    """Levels of a column in order: numbers are sorted by size, words by their order in the task."""
    if not any(isinstance(value, str) for value in found):
        return sorted(found)
    known: list[Any] = []
    if column == "presented":
        known = ["no perturbation"] + [str(p["name"]) for p in data.task.get("perturbations") or []] + data.conditions
    elif column in data.table("trials"):
        known = data.levels(column)
    place = {value: i for i, value in enumerate(known)}
    return sorted(found, key=lambda value: place.get(value, len(place)))


def _named(data: Data, frame: pd.DataFrame, colour: list[str], panel: str, most: int = _MOST_CASES) -> pd.DataFrame:
    """The lifts, with condition and panel in words, sorted by condition and panel; those beyond the maximum are left out."""
    units = data.table("trials").attrs.get("units", {})
    for column in [*colour, *([panel] if panel else [])]:
        if column not in frame:
            raise NotThere(column, "is not a column of the trials", [str(c) for c in frame], "trials.csv has its columns.")
    frame = frame.copy()
    order: dict[str, list[str]] = {}
    for name, columns, cap in [("condition_shown", colour, most), ("panel", [panel] if panel else [], _MOST_PANELS)]:
        ranks = pd.DataFrame(index=frame.index)
        words = pd.Series("", index=frame.index)
        for column in columns:
            rank = {value: i for i, value in enumerate(_levels(data, column, list(frame[column].dropna().unique())))}
            ranks[column] = frame[column].map(rank).fillna(len(rank))
            unit = str(units.get(column, "") or "")
            bare = len(columns) > 1 and not unit and pd.api.types.is_numeric_dtype(frame[column])
            prefix = f"{label(column)} " if bare else ""
            text = frame[column].map(lambda value, unit=unit, prefix=prefix: prefix + level(value, unit))
            words = text if column == columns[0] else words + ", " + text
        frame[name] = words
        if columns:
            order[name] = list(dict.fromkeys(words[ranks.sort_values(list(columns), kind="stable").index]))[:cap]
            frame = frame[frame[name].isin(order[name])]
    for name, names in order.items():
        frame[name] = pd.Categorical(frame[name], names, ordered=True)
    frame = frame.sort_values(["panel", "condition_shown", "lift_number"], kind="stable")
    return frame.assign(panel=frame["panel"].astype(str), case=frame["condition_shown"].astype(str))


# Courses, from recordings


def _sampled(data: Data, frame: pd.DataFrame, times: Array) -> dict[str, Array]:
    """Grip force, load force and height around the times [s] of each lift; NaN beyond the lift's attempt.

    `times` and each array have the shape (lifts, times). The height is that of the lift's object above its place at touch.
    """
    out = {name: np.full(times.shape, np.nan) for name in ("grip force", "load force", "height")}
    objects = {c["name"]: c["object"] for c in data.task.get("conditions") or [] if c.get("object")}
    for number in sorted(frame["of"].unique()):
        session = data.recorded[number].session
        rows = np.flatnonzero(frame["of"] == number)
        own = frame.iloc[rows]
        at = _ticks(session, times[rows], own)
        for name, quantity in (("grip force", "grip_force"), ("load force", "load_force")):
            if quantity in session:
                out[name][rows] = _picked(session[quantity], at)
        bodies = own["condition"].map(objects).fillna(str(session.info.get("object", "")))
        touch = _ticks(session, own[["touch_s"]].to_numpy(), own)
        for body in bodies.unique():
            if f"{body}.position.z" in session:
                height = session[f"{body}.position.z"].astype(float) * 1000
                some = np.flatnonzero(bodies == body)
                out["height"][rows[some]] = _picked(height, at[some]) - _picked(height, touch[some])
    return out


def _ticks(session: Session, times: Array, lifts: pd.DataFrame) -> Array:
    """The tick at each time; -1 if the lift's attempt has none then."""
    t = session.t
    known = np.where(np.isfinite(times), times, -1e9)
    at = np.searchsorted(t, known - session.tick / 2)
    near = np.abs(t[np.minimum(at, len(t) - 1)] - known) <= 0.51 * session.tick
    within = (known >= lifts[["start_time"]].to_numpy() - 1e-9) & (known <= lifts[["stop_time"]].to_numpy() + 1e-9)
    return np.where(near & within, at, -1)


def _picked(values: Array, at: Array) -> Array:
    out: Array = values[np.maximum(at, 0)].astype(float)
    out[at < 0] = np.nan
    return out


def _quartiles(rows: Array) -> Array:
    """Lower quartile, median and upper quartile of each column; NaN where fewer than half of the rows are known."""
    out = np.full((3, rows.shape[1]), np.nan)
    known = np.isfinite(rows).sum(axis=0)
    enough = np.flatnonzero((known > 0) & (2 * known >= len(rows)))
    ordered = np.sort(rows, axis=0)  # unknown values are sorted last; this is much faster than nanpercentile
    for i, share in enumerate((0.25, 0.5, 0.75)):
        place = share * (known[enough] - 1)
        below = np.floor(place).astype(int)
        low, high = ordered[below, enough], ordered[np.ceil(place).astype(int), enough]
        out[i, enough] = low + (place - below) * (high - low)
    return out


def _over_people(rows: Array, people: Array) -> Array:
    """Quartiles over the lifts of one person, or over the medians of several people."""
    names = list(dict.fromkeys(people))
    if len(names) == 1:
        return _quartiles(rows)
    return _quartiles(np.array([_quartiles(rows[people == name])[1] for name in names]))


def _cells(frame: pd.DataFrame) -> Iterator[tuple[str, str, Array, int, int]]:
    """Panel, condition, rows, number of lifts and of people, in the order of panels and conditions."""
    for panel, case in dict.fromkeys(zip(frame["panel"], frame["case"])):
        rows = np.flatnonzero((frame["panel"] == panel) & (frame["case"] == case))
        yield panel, case, rows, len(rows), frame["person"].iloc[rows].nunique()


@of_data
def lift_curves(
    data: Data, *, colour: list[str] | None = None, panel: str = "", align: str = "lift_off",
    before: float = 0.8, after: float = 1.5, step: float = 0.01, catch: bool = False,
) -> pd.DataFrame:  # fmt: skip
    """Grip force, load force, their ratio and the object's height around a moment of lifts, from recordings.

    `colour` lists the columns of trials.csv whose levels make up a condition (or "presented", for what differs between
    the trials of a block), and `panel` is a column whose levels get panels of their own. `align` is lift_off,
    load_onset or touch; the curves go from `before` to `after` that moment [s], every `step` [s]. A row is a time:
    `median`, and the quartiles `low` and `high`, over a person's lifts, or over several people's medians. The ratio of
    grip to load is left out where the load is less than 0.2 N. A value is given where at least half of the lifts have
    one. Only complete lifts are included, and catch trials only with `catch`. Raises NotThere, Error.

    >>> from dihaptic import figures
    >>> points = lift_curves(figures.read(lift_session))
    >>> list(dict.fromkeys(points["quantity"])), int(points["lifts"].max())
    (['grip force', 'load force', 'grip / load', 'height'], 1)
    """
    if align not in MOMENTS:
        raise NotThere(align, "is not a moment of a lift", list(MOMENTS), f"Moments are {', '.join(MOMENTS)}.")
    frame = _counting(_recorded_lifts(data), catch)
    frame = _named(data, frame[frame[f"{align}_s"].notna()], colour or [], panel)
    grid = np.arange(-round(before / step), round(after / step) + 1) * step
    values = _sampled(data, frame, frame[[f"{align}_s"]].to_numpy() + grid)
    loaded = np.where(values["load force"] > LEAST_LOAD, values["load force"], np.nan)
    values["grip / load"] = values["grip force"] / loaded
    people = frame["person"].to_numpy()
    parts = []
    for part, case, rows, lifts, count in _cells(frame):
        for quantity, unit in QUANTITIES.items():
            low, median, high = _over_people(values[quantity][rows], people[rows])
            parts.append(pd.DataFrame({
                "panel": part, "condition": case, "quantity": quantity, "unit": unit, "time_s": np.round(grid, 9),
                "people": count, "lifts": lifts, "median": median, "low": low, "high": high,
            }))  # fmt: skip
    columns = ["panel", "condition", "quantity", "unit", "time_s", "people", "lifts", "median", "low", "high"]
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame(columns=columns)


@drawing
def draw_lift_curves(
    points: pd.DataFrame, *, align: str = "lift_off", legend: str = "", size: str = "one column", height_mm: float = 30,
) -> Figure:  # fmt: skip
    """Draws lift_curves(), with rows of panels, each `height_mm` [mm] high, for grip, load, their ratio and height.

    `legend` is the title of the legend. Raises Error when there are no points.

    >>> from dihaptic import figures
    >>> figure = draw_lift_curves(figures.lift_curves(figures.read(lift_session)))
    >>> figure.axes[0].get_ylabel(), figure.axes[-1].get_xlabel()
    ('grip force [N]', 'time from lift-off [s]')
    """
    points = _known(points, "median")
    quantities = list(dict.fromkeys(points["quantity"]))
    panels, cases = _texts(points, "panel"), _texts(points, "condition")
    figure, axes = canvas(size, height_mm * len(quantities) + 14, len(quantities), len(panels), sharex=True, sharey="row")
    for i, quantity in enumerate(quantities):
        own = points[points["quantity"] == quantity]
        for k, panel in enumerate(panels):
            here = axes[i * len(panels) + k]
            here.axvline(0, color=QUIET, linewidth=0.6, zorder=0)
            for case, (hue, dashes, _) in _looks(cases).items():
                curve = own[(own["panel"].fillna("") == panel) & (own["condition"].fillna("") == case)]
                here.fill_between(curve["time_s"], curve["low"], curve["high"], color=hue, alpha=0.18, linewidth=0)
                here.plot(curve["time_s"], curve["median"], color=hue, linestyle=dashes)
            if i == len(quantities) - 1:
                here.set_xlabel(f"time from {MOMENTS[align]} [s]")
            if i == 0 and len(panels) > 1:
                here.set_title(wrapped(panel, int(WIDTHS[size] / len(panels) / 1.9)))
        if quantity == "grip / load":
            _limit_ratio(axes[i * len(panels)], own)
        unit = str(own["unit"].iloc[0]) if own["unit"].notna().all() else ""
        axes[i * len(panels)].set_ylabel(f"{quantity} [{unit}]" if unit else quantity)
        axes[i * len(panels)].margins(x=0.04)  # this keeps the last number of the axis on the canvas
    _widen(axes)
    figure.align_ylabels()
    _legend(figure, cases, legend, marks=False)
    return figure


def _limit_ratio(axes: Axes, points: pd.DataFrame) -> None:
    """Ends the axis of the ratio just above nearly all values, because the ratio shoots up when the load dips for a moment."""
    ratios = points["median"].dropna()
    most = _RATIO_AXIS * float(ratios.quantile(0.9))
    axes.set_ylim(0, most if ratios.max() > most > 0 else max(1.05 * float(ratios.max()), 1e-9))


# Grip against load


@of_data
def grip_against_load(
    data: Data, *, colour: list[str] | None = None, panel: str = "", steps: int = 50, catch: bool = False
) -> pd.DataFrame:
    """Grip force against load force while an object is loaded and lifted, from recordings.

    Rows with the phase "loading" are medians at equal shares of the time from load onset to lift-off; "lifted", every
    10 ms during the first second after it; "hold", of the static grip and load of lifts.csv. All are medians over a
    person's lifts, or over several people's medians. "slip" is the line below which the object slips because of its
    friction: it follows from the safety margin of lifts.csv, and is left out unless it is the same in all lifts. For
    the other options see lift_curves(). Raises NotThere, Error.

    >>> from dihaptic import figures
    >>> points = grip_against_load(figures.read(lift_session))
    >>> list(dict.fromkeys(points["phase"]))
    ['loading', 'lifted', 'hold', 'slip']
    """
    frame = _counting(_recorded_lifts(data), catch)
    frame = _named(data, frame[frame[["load_onset_s", "lift_off_s"]].notna().all(axis=1)], colour or [], panel)
    begin, end = frame[["load_onset_s"]].to_numpy(), frame[["lift_off_s"]].to_numpy()
    loading = begin + np.linspace(0, 1, steps + 1) * (end - begin)
    lifted = end + np.arange(1, round(_AFTER_LIFT_OFF / 0.01) + 1) * 0.01
    values = _sampled(data, frame, np.hstack([loading, np.where(lifted < frame[["replacement_s"]].to_numpy(), lifted, np.nan)]))
    phases = ["loading"] * loading.shape[1] + ["lifted"] * lifted.shape[1]
    people = frame["person"].to_numpy()
    parts = []
    for part, case, rows, lifts, count in _cells(frame):
        own = frame.iloc[rows]
        hold = {name: _over_people(own[[column]].to_numpy(float), people[rows])[1]
                for name, column in (("load", "static_load_N"), ("grip", "static_grip_N"))}  # fmt: skip
        load = np.append(_over_people(values["load force"][rows], people[rows])[1], hold["load"])
        grip = np.append(_over_people(values["grip force"][rows], people[rows])[1], hold["grip"])
        ratio = _slip_ratio(own)
        table = pd.DataFrame({"phase": [*phases, "hold"], "load_N": load, "grip_N": grip})
        if np.isfinite(ratio) and np.isfinite(load).any():
            most = float(np.nanmax(load))
            table = pd.concat([table, pd.DataFrame({"phase": "slip", "load_N": [0, most], "grip_N": [0, ratio * most]})])
        parts.append(table.assign(panel=part, condition=case, people=count, lifts=lifts))
    columns = ["panel", "condition", "phase", "people", "lifts", "load_N", "grip_N"]
    return pd.concat(parts, ignore_index=True)[columns] if parts else pd.DataFrame(columns=columns)


def _slip_ratio(lifts: pd.DataFrame) -> float:
    """The ratio of grip and load at which the object slips, NaN unless it is the same in all lifts.

    The safety margin is (static grip - least grip) / static grip, so the ratio of least grip to load depends only on
    friction.
    """
    ratios = ((1 - lifts["safety_margin"]) * lifts["static_ratio"]).dropna()
    if ratios.empty or ratios.max() - ratios.min() > 0.01 * ratios.median():
        return np.nan
    return float(ratios.median())


@drawing
def draw_grip_against_load(
    points: pd.DataFrame, *, legend: str = "", size: str = "one column", height_mm: float = 70
) -> Figure:
    """Draws grip_against_load(), with load on the abscissa, so that lifting goes to the right; marks show the hold.

    Raises Error when there are no points.

    >>> from dihaptic import figures
    >>> figure = draw_grip_against_load(figures.grip_against_load(figures.read(lift_session)))
    >>> figure.axes[0].get_xlabel()
    'load force [N]'
    """
    points = _known(points, "grip_N")
    panels, cases = _texts(points, "panel"), _texts(points, "condition")
    looks = _looks(cases)
    figure, axes = canvas(size, height_mm, 1, len(panels), sharex=True, sharey=True)
    slips = False
    for here, panel in zip(axes, panels):
        own = points[points["panel"].fillna("") == panel]
        lines = own[own["phase"] == "slip"]
        alike = _slope(lines).round(6).nunique() == 1
        for case, (hue, _, marker) in looks.items():
            curve = own[own["condition"].fillna("") == case]
            course = curve[curve["phase"].isin(["loading", "lifted"])]
            here.plot(course["load_N"], course["grip_N"], color=hue, linewidth=1, alpha=0.9)
            held = curve[curve["phase"] == "hold"]
            here.plot(held["load_N"], held["grip_N"], marker, color=hue, markersize=5, markeredgecolor="white", zorder=3)
            slip = curve[curve["phase"] == "slip"]
            if len(slip) and not alike:
                here.plot(slip["load_N"], slip["grip_N"], ":", color=hue, linewidth=0.8, zorder=1)
        if len(lines) and alike:
            longest = lines.loc[[lines["load_N"].idxmax()]]
            here.plot([0, *longest["load_N"]], [0, *longest["grip_N"]], ":", color=QUIET, linewidth=0.9, zorder=1)
        slips = slips or len(lines) > 0
        here.set_xlabel("load force [N]")
        if len(panels) > 1:
            here.set_title(wrapped(panel, int(WIDTHS[size] / len(panels) / 1.9)))
    axes[0].set_ylabel("grip force [N]")
    if points["grip_N"].min() >= 0:
        axes[0].set_ylim(bottom=0)
    handles = [Line2D([], [], linestyle=":", color=QUIET, linewidth=0.9)] if slips else []
    _legend(figure, cases, legend, marks=True, dashed=False, more=handles, names=["slip"] if slips else [])
    return figure


def _slope(lines: pd.DataFrame) -> pd.Series:
    ends = lines[lines["load_N"] > 0]
    return ends["grip_N"] / ends["load_N"]


# Change over lifts


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
    frame = _all_lifts(data)
    frame = _counting(frame, catch) if repetition else frame[frame["lift"] == "complete"]
    frame = _named(data, frame, colour or [], "").sort_values(["lift_number"], kind="stable")
    order = _texts(_named(data, frame, colour or [], ""), "case")
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
    points = _known(points, "value")
    measures, cases = _texts(points, "measure"), _texts(points, "condition")
    points = points.assign(block=points["block"].fillna(""), condition=points["condition"].fillna(""))
    looks = _looks(cases)
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
    _legend(figure, cases, legend, marks=True)
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
        text = _shortened(level(str(name)), 40)
        half = len(text) * per_letter / 2
        at = min(max((first + last) / 2, left + half), right - half)
        row = next((i for i, end in enumerate(rows) if end + per_letter < at - half), len(rows))
        rows[row : row + 1] = [at + half]
        axes[0].annotate(
            text, (at, 1), xycoords=("data", "axes fraction"), xytext=(0, 2 + 8.5 * row), textcoords="offset points",
            ha="center", va="bottom", fontsize=7, color=QUIET, annotation_clip=False,
        )  # fmt: skip


# Phases


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
    frame = _named(data, _counting(_all_lifts(data), catch), colour or [], "", _MOST_ROWS)
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
    rank = {case: i for i, case in enumerate(_texts(frame, "condition"))}
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
    points = _known(points, "value")
    phases, cases = _texts(points, "phase"), _texts(points, "condition")
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
    axes[0].set_yticks(list(place.values()), [_shortened(case) for case in place])
    axes[0].set_ylim(len(cases) - 0.4, -0.6)
    if ordinate:
        axes[0].set_ylabel(ordinate)
    if cases == [""]:
        axes[0].set_yticks([])
    return figure


# Shared by all figures


def _shortened(text: str, most: int = 34) -> str:
    """A long name with its middle cut out, since names of conditions often differ at their ends."""
    half = (most - 1) // 2
    return text if len(text) <= most else f"{text[:half]}…{text[-half:]}"


def _known(points: pd.DataFrame, value: str) -> pd.DataFrame:
    """The points whose panel, measure or phase has any value. Raises Error when there are none."""
    if points.empty or not points[value].notna().any():
        raise error("has no values to draw", "Draw only what has at least one complete lift.", key="points")
    for column in ("quantity", "measure", "phase"):
        if column in points:
            some = points.loc[points[value].notna(), column].unique()
            points = points[points[column].isin(some)]
    return points


def _texts(points: pd.DataFrame, column: str) -> list[str]:
    """The distinct texts of a column, in their order; in a table read from CSV, an empty text is NaN."""
    return [str(text) for text in dict.fromkeys(points[column].fillna(""))]


def _looks(cases: list[str]) -> dict[str, tuple[str, Any, str]]:
    """The colour, dashes and marker of each condition."""
    taken = {case: _OF_COLOURS[case] for case in cases if case in _OF_COLOURS}
    free = [i for i in range(len(COLOURS)) if i not in taken.values()] or [0]
    out: dict[str, tuple[str, Any, str]] = {}
    for case in cases:
        used = len([name for name in out if name not in taken])
        i = taken[case] if case in taken else free[used % len(free)]
        out[case] = (COLOURS[i], _DASHES[len(out) % len(_DASHES)], MARKERS[i])
    return out


def _widen(axes: list[Axes]) -> None:
    """Keeps forces and ratios that hardly change from being magnified into noise."""
    for here in axes:
        low, high = here.get_ylim()
        if high - low < 1e-9:
            here.set_ylim(low - 0.5, high + 0.5)


def _legend(
    figure: Figure, cases: list[str], title: str, *, marks: bool, dashed: bool = True, more: list[Any] | None = None,
    names: list[str] | None = None,
) -> None:  # fmt: skip
    """Adds a legend of the conditions and of `more`, if it has several entries, or if its title names what they are."""
    looks = _looks(cases)
    handles = [Line2D([], [], color=hue, linestyle=dashes if dashed else "-", marker=marker if marks else None, markersize=4)
               for hue, dashes, marker in looks.values()]  # fmt: skip
    texts = [_shortened(case, int(25.4 * figure.get_figwidth() / 1.7)) for case in looks]
    if cases == [""]:
        handles, texts, title = [], [], ""
    handles, texts = [*handles, *(more or [])], [*texts, *(names or [])]
    if handles:
        legend_above(figure, handles, texts, title)


# Which figures a design calls for


def _factors(data: Data, frame: pd.DataFrame) -> list[str]:
    """Factors of the design whose level differs between lifts; numbers that are rarely repeated do not count as levels."""
    names = [name for name in ["group", *data.factors] if name in frame]
    return [name for name in names if 1 < frame[name].nunique() <= max(2, len(frame) / 2)]


def _design(data: Data, frame: pd.DataFrame) -> tuple[list[str], str]:
    """The columns that colours stand for, and the one that panels stand for."""
    factors = _factors(data, frame)
    if not factors:
        if frame["presented"].nunique() < 2:
            return [], ""
        in_block = frame.groupby(frame["block"].fillna(""))["presented"].nunique()
        return ["presented"], "block" if 1 < len(in_block) and in_block.max() > 1 else ""
    if len(frame[factors].drop_duplicates()) <= _MOST_CASES or len(factors) == 1:
        return factors, ""
    numeric = [name for name in factors if pd.api.types.is_numeric_dtype(frame[name])]
    colour = max(numeric or factors, key=lambda name: min(int(frame[name].nunique()), _MOST_CASES))
    panel = min((name for name in factors if name != colour), key=lambda name: int(frame[name].nunique()))
    return [colour], panel


def _shows_catches(data: Data) -> bool:
    """Whether catch trials are lifts of another object, in which case they show what was expected."""
    changes = any(part.get("body") for part in data.task.get("perturbations") or [])
    trials = data.table("trials")
    return changes and "kind" in trials and bool((trials["kind"] == "catch").any())


def plans(data: Data) -> Iterator[Plan]:
    """Courses around lift-off and grip against load, from recordings; change over lifts, and phases, from lifts.csv."""
    if not data.has("lifts") or not data.has("trials"):
        return
    catch = _shows_catches(data)
    frame = _all_lifts(data)
    kept = _counting(frame, catch)
    if kept.empty or 4 * len(kept) < len(frame[~frame["kind"].isin(ASIDE)]):
        return  # another kind of task: objects that are pushed, or carried from the start
    colour, panel = _design(data, kept)
    options: dict[str, Any] = {**({"colour": colour} if colour else {}), **({"catch": True} if catch else {})}
    legend = " and ".join(_word(column) for column in colour if column != "presented")
    yield from _plans_of_courses(data, options, panel, legend, catch)
    yield from _plans_of_change(data, frame, options, panel, catch)
    rows = [*colour, *([panel] if panel else [])]
    ordinate = {"ordinate": ", ".join(map(_word, rows))} if rows and "presented" not in rows else {}
    if len(kept) > 1:
        yield Plan(
            name="lift-phases", title="Durations of the phases of a lift",
            caption=f"From touch to load onset (preload), from the last digit's load onset to lift-off (loading), and from "
            f"replacement to release (releasing). Dots are {_dots(kept)}; marks are medians with quartiles. "
            f"{_counts(data, frame, catch, rows, '', _MOST_ROWS)}",
            points=lift_phases, points_options={**options, **({"colour": rows} if rows else {})},
            drawing=draw_lift_phases,
            drawing_options=ordinate,
        )  # fmt: skip


def _plans_of_courses(data: Data, options: dict[str, Any], panel: str, legend: str, catch: bool) -> Iterator[Plan]:
    """The figures that need recordings."""
    if not data.recorded:
        return
    frame = _recorded_lifts(data)
    kept = _counting(frame, catch)
    kept = kept[kept["lift_off_s"].notna()]
    if kept.empty:
        return
    cap = min(_MOST_PANELS, kept[panel].nunique()) if panel else 1
    where = {"panel": panel} if panel else {}
    drawing: dict[str, Any] = {"legend": legend} if legend else {}
    drawing |= {"size": "two columns" if cap > 1 else "one column"}
    shown = ["median over lifts, bands are quartiles", "single lift"][len(kept) == 1]
    if kept["person"].nunique() > 1:
        shown = "median over people's medians, bands are quartiles over people"
    counts = _counts(data, frame, catch, options.get("colour", []), panel, _MOST_CASES)
    yield Plan(
        name="lift-curves", title="Grip, load and height about lift-off",
        caption=f"Grip force (mean of the digits), load force (their sum), grip over load where the load exceeds {LEAST_LOAD} N "
        f"(its axis ends at {_RATIO_AXIS} times the 90th percentile, if larger values are rare), "
        f"and the object's height above its place at touch. Lines: {shown}. {counts}",
        points=lift_curves, points_options={**options, **where}, drawing=draw_lift_curves, drawing_options=drawing,
    )  # fmt: skip
    some = kept[["load_onset_s", "lift_off_s"]].notna().all(axis=1)
    if not some.any():
        return
    slip = "; dotted: below it the object slips" if np.isfinite(kept["safety_margin"]).any() else ""
    yield Plan(
        name="grip-against-load", title="Grip against load in loading and hold",
        caption=f"From load onset, at equal shares of the time to lift-off, to {_AFTER_LIFT_OFF:g} s after lift-off; marks are "
        f"the static hold{slip}. Lines: {shown.split(',')[0]}. {counts}",
        points=grip_against_load, points_options={**options, **where}, drawing=draw_grip_against_load,
        drawing_options={**drawing, "height_mm": 75},
    )  # fmt: skip


def _plans_of_change(data: Data, frame: pd.DataFrame, options: dict[str, Any], panel: str, catch: bool) -> Iterator[Plan]:
    """The figure of change over lifts, where each person lifts often enough."""
    complete = frame[frame["lift"] == "complete"]
    wanted = ["safety_margin", "peak_grip_rate_N_s", *(["peak_load_rate_N_s"] if catch else [])]  # expected weight
    known = [name for name in wanted if complete[name].notna().any()]
    if not known or complete.groupby("person").size().median() < 8 or not data.task:
        return
    colour = options.get("colour", [])
    if panel in _factors(data, frame) and _is_surface(complete, panel):
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
    names = [_word(column) for column in colour if column != "presented"]
    yield Plan(
        name="successive-lifts", title="Change over successive lifts",
        caption=f"{lines}; {number}. {_counts(data, frame, catch or not repetition, colour, '', _MOST_CASES, not repetition)}",
        points=successive_lifts, points_options={"measures": known, **own}, drawing=draw_successive_lifts,
        drawing_options={
            **({"legend": " and ".join(names)} if names else {}),
            **({"abscissa": "number of the lift in its condition", "size": "one column"} if repetition else {}),
        },
    )  # fmt: skip


def _is_surface(lifts: pd.DataFrame, factor: str) -> bool:
    """Whether the friction depends on this factor and on no other."""
    ratios = [_slip_ratio(own) for _, own in lifts.groupby(factor)]
    return bool(np.isfinite(ratios).all() and len(ratios) > 1 and max(ratios) > 1.01 * min(ratios))


def _word(column: str) -> str:
    """A factor in words, without its unit, which is shown with the levels."""
    return label(column).removesuffix(" g").removesuffix(" N").removesuffix(" mm").removesuffix(" ms")


def _dots(kept: pd.DataFrame) -> str:
    return "lifts" if kept["person"].nunique() == 1 else "people's medians over lifts"


def _counts(
    data: Data, frame: pd.DataFrame, catch: bool, colour: list[str], panel: str, most: int, practice: bool = False
) -> str:
    """The numbers of people and lifts that are drawn, and a note on those that are left out."""
    kept = frame[frame["lift"] == "complete"] if practice else _counting(frame, catch)
    shown = _named(data, kept, colour, panel, most)
    wanted = frame if practice else frame[~frame["kind"].isin([k for k in ASIDE if not (catch and k == "catch")])]
    text = f"{counted(shown['person'].nunique(), 'person', 'people')}, {counted(len(shown), 'lift')}"
    missing = len(wanted) - len(kept)
    text += f"; {counted(missing, 'incomplete lift')} left out" if missing else ""
    out = [] if practice or not (frame["kind"] != "").any() else ["practice", *([] if catch else ["catch trials"])]
    out = [*out, "repeated attempts"] if (frame["kind"] != "").any() else out
    text += f"; {' and '.join([', '.join(out[:-1]), out[-1]] if len(out) > 1 else out)} are left out" if out else ""
    return text + _left_out(data, kept, shown, colour, panel, most) + "."


def _left_out(data: Data, kept: pd.DataFrame, shown: pd.DataFrame, colour: list[str], panel: str, most: int) -> str:
    """A note for the caption on conditions and panels that exceed the maximum."""
    text = ""
    for columns, drawn, cap in ((colour, shown["case"], most), ([panel] if panel else [], shown["panel"], _MOST_PANELS)):
        levels = kept[columns].drop_duplicates() if columns else kept.iloc[:0]
        if len(levels) > cap:
            names = _texts(_named(data, kept, columns, "", len(levels)), "case")
            gone = [name for name in names if name not in set(drawn)]
            more = f" and {len(gone) - 12} more" if len(gone) > 12 else ""
            text += f"; not shown, since only the first {cap} are: {', '.join(gone[:12])}{more}"
    return text


# The weight of the previous lift

#: Minimum number of pairs of complete lifts, and minimum ratio of weights, to estimate the effect of the previous weight.
_LEAST_PAIRS, _LEAST_RATIO = 10, 1.05


def previous_weight(data: Data) -> pd.DataFrame:
    """The effect of the previous weight on a lift (Johansson and Westling 1988), for each person.

    The regression is rate = a + b W + c W_before, of the largest rate of load force before lift-off on the weights
    held, over consecutive complete lifts of a session. A row has the group, the person, `effect` (c, in N/s for each
    N), its standard `error`, `share` (c / (b + c): 0 if only the present weight matters, 1 if only the previous one does),
    and `n` pairs of lifts. People whose weights vary by less than 5 %, or who have fewer than ten pairs, have no row.

    >>> from dihaptic import figures
    >>> len(previous_weight(figures.read(lift_session)))
    0
    """
    columns = ["group", "person", "effect", "error", "share", "n"]
    if not data.has("lifts"):
        return pd.DataFrame(columns=columns)
    lifts = data.table("lifts")
    rows = []
    for (group, person), own in lifts.groupby(["group", "person"], sort=False):
        own = own.assign(known=(own["lift"] == "complete") & own[["static_load_N", "peak_load_rate_N_s"]].notna().all(axis=1))
        by = own.groupby(sitting_columns(own), sort=False, dropna=False)
        own = own.assign(before=by["static_load_N"].shift(), known_before=by["known"].shift(fill_value=False))
        pairs = own[own["known"] & own["known_before"]]
        n = len(pairs)
        weights = pairs["static_load_N"]
        if n < _LEAST_PAIRS or weights.max() < _LEAST_RATIO * weights.min():
            continue
        design = np.column_stack([np.ones(n), weights, pairs["before"]])
        rates = pairs["peak_load_rate_N_s"].to_numpy()
        b, _, rank, _ = np.linalg.lstsq(design, rates, rcond=None)
        if rank < 3:
            continue
        variance = float(np.sum((rates - design @ b) ** 2)) / (n - 3)
        error = np.sqrt(variance * np.linalg.inv(design.T @ design)[2, 2])
        rows.append([group, person, b[2], error, b[2] / (b[1] + b[2]), n])
    return pd.DataFrame(rows, columns=columns)
