"""Grip force against load force in loading and hold."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ..data import Data
from ..saving import Plan
from ..style import QUIET, WIDTHS, canvas, drawing, of_data, wrapped
from .looks import legend_of_cases, looks_of, with_values
from .recordings import cells, over_people, sampled
from .selection import counting, named, recorded_lifts, texts

#: Time after lift-off up to which grip against load is drawn [s].
_AFTER_LIFT_OFF = 1.0


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
    frame = counting(recorded_lifts(data), catch)
    frame = named(data, frame[frame[["load_onset_s", "lift_off_s"]].notna().all(axis=1)], colour or [], panel)
    begin, end = frame[["load_onset_s"]].to_numpy(), frame[["lift_off_s"]].to_numpy()
    loading = begin + np.linspace(0, 1, steps + 1) * (end - begin)
    lifted = end + np.arange(1, round(_AFTER_LIFT_OFF / 0.01) + 1) * 0.01
    values = sampled(data, frame, np.hstack([loading, np.where(lifted < frame[["replacement_s"]].to_numpy(), lifted, np.nan)]))
    phases = ["loading"] * loading.shape[1] + ["lifted"] * lifted.shape[1]
    people = frame["person"].to_numpy()
    parts = []
    for part, case, rows, lifts, count in cells(frame):
        own = frame.iloc[rows]
        hold = {name: over_people(own[[column]].to_numpy(float), people[rows])[1]
                for name, column in (("load", "static_load_N"), ("grip", "static_grip_N"))}  # fmt: skip
        load = np.append(over_people(values["load force"][rows], people[rows])[1], hold["load"])
        grip = np.append(over_people(values["grip force"][rows], people[rows])[1], hold["grip"])
        ratio = slip_ratio(own)
        table = pd.DataFrame({"phase": [*phases, "hold"], "load_N": load, "grip_N": grip})
        if np.isfinite(ratio) and np.isfinite(load).any():
            most = float(np.nanmax(load))
            table = pd.concat([table, pd.DataFrame({"phase": "slip", "load_N": [0, most], "grip_N": [0, ratio * most]})])
        parts.append(table.assign(panel=part, condition=case, people=count, lifts=lifts))
    columns = ["panel", "condition", "phase", "people", "lifts", "load_N", "grip_N"]
    return pd.concat(parts, ignore_index=True)[columns] if parts else pd.DataFrame(columns=columns)


def slip_ratio(lifts: pd.DataFrame) -> float:
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
    points = with_values(points, "grip_N")
    panels, cases = texts(points, "panel"), texts(points, "condition")
    looks = looks_of(cases)
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
    legend_of_cases(figure, cases, legend, marks=True, dashed=False, more=handles, names=["slip"] if slips else [])
    return figure


def _slope(lines: pd.DataFrame) -> pd.Series:
    ends = lines[lines["load_N"] > 0]
    return ends["grip_N"] / ends["load_N"]


def plan_of_load(
    kept: pd.DataFrame, points_options: dict[str, Any], drawing_options: dict[str, Any], shown: str, counts: str
) -> Plan:
    """The figure of grip against load in these lifts; `shown` and `counts` are those of plan_of_curves()."""
    slip = "; dotted: below it the object slips" if np.isfinite(kept["safety_margin"]).any() else ""
    return Plan(
        name="grip-against-load", title="Grip against load in loading and hold",
        caption=f"From load onset, at equal shares of the time to lift-off, to {_AFTER_LIFT_OFF:g} s after lift-off; marks are "
        f"the static hold{slip}. Lines: {shown.split(',')[0]}. {counts}",
        points=grip_against_load, points_options=points_options, drawing=draw_grip_against_load,
        drawing_options={**drawing_options, "height_mm": 75},
    )  # fmt: skip
