"""Courses of grip force, load force, their ratio and height around a moment of lifts."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...errors import NotThere
from ..data import Data
from ..saving import Plan
from ..style import QUIET, WIDTHS, canvas, drawing, of_data, wrapped
from .looks import legend_of_cases, looks_of, with_values
from .recordings import cells, over_people, sampled
from .selection import counting, named, recorded_lifts, texts

#: Loads below this count as no load, so the ratio of grip and load is not drawn there [N].
LEAST_LOAD = 0.2
#: Quantities in a figure of courses, from top to bottom, and their units.
QUANTITIES = {"grip force": "N", "load force": "N", "grip / load": "", "height": "mm"}
#: Moments of a lift to which courses are aligned: columns of lifts.csv without "_s".
MOMENTS = {"lift_off": "lift-off", "load_onset": "load onset", "touch": "touch"}
#: End of the ratio's axis, as a multiple of the ratio's 90th percentile.
_RATIO_AXIS = 1.6


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
    frame = counting(recorded_lifts(data), catch)
    frame = named(data, frame[frame[f"{align}_s"].notna()], colour or [], panel)
    grid = np.arange(-round(before / step), round(after / step) + 1) * step
    values = sampled(data, frame, frame[[f"{align}_s"]].to_numpy() + grid)
    loaded = np.where(values["load force"] > LEAST_LOAD, values["load force"], np.nan)
    values["grip / load"] = values["grip force"] / loaded
    people = frame["person"].to_numpy()
    parts = []
    for part, case, rows, lifts, count in cells(frame):
        for quantity, unit in QUANTITIES.items():
            low, median, high = over_people(values[quantity][rows], people[rows])
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
    points = with_values(points, "median")
    quantities = list(dict.fromkeys(points["quantity"]))
    panels, cases = texts(points, "panel"), texts(points, "condition")
    figure, axes = canvas(size, height_mm * len(quantities) + 14, len(quantities), len(panels), sharex=True, sharey="row")
    for i, quantity in enumerate(quantities):
        own = points[points["quantity"] == quantity]
        for k, panel in enumerate(panels):
            here = axes[i * len(panels) + k]
            here.axvline(0, color=QUIET, linewidth=0.6, zorder=0)
            for case, (hue, dashes, _) in looks_of(cases).items():
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
    legend_of_cases(figure, cases, legend, marks=False)
    return figure


def _limit_ratio(axes: Axes, points: pd.DataFrame) -> None:
    """Ends the axis of the ratio just above nearly all values, because the ratio shoots up when the load dips for a moment."""
    ratios = points["median"].dropna()
    most = _RATIO_AXIS * float(ratios.quantile(0.9))
    axes.set_ylim(0, most if ratios.max() > most > 0 else max(1.05 * float(ratios.max()), 1e-9))


def _widen(axes: list[Axes]) -> None:
    """Keeps forces and ratios that hardly change from being magnified into noise."""
    for here in axes:
        low, high = here.get_ylim()
        if high - low < 1e-9:
            here.set_ylim(low - 0.5, high + 0.5)


def plan_of_curves(points_options: dict[str, Any], drawing_options: dict[str, Any], shown: str, counts: str) -> Plan:
    """The figure of courses; `shown` is what its lines are, and `counts` whose lifts they show, in words."""
    return Plan(
        name="lift-curves", title="Grip, load and height about lift-off",
        caption=f"Grip force (mean of the digits), load force (their sum), grip over load where the load exceeds {LEAST_LOAD} N "
        f"(its axis ends at {_RATIO_AXIS} times the 90th percentile, if larger values are rare), "
        f"and the object's height above its place at touch. Lines: {shown}. {counts}",
        points=lift_curves, points_options=points_options, drawing=draw_lift_curves, drawing_options=drawing_options,
    )  # fmt: skip
