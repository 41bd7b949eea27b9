"""Paths of reaches, to scale."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from ...errors import error
from ..data import Data
from ..saving import Plan
from ..style import MARKERS, QUIET, WIDTHS, canvas, drawing, of_data, wrapped
from .reaches import STEP, Reach
from .sheets import (
    HUES,
    MOST_COLOURS,
    Sheet,
    colours_of,
    counts_in_words,
    legend_of_colours,
    name_of,
    place_in,
    plan_of_sheet,
    sheet_named,
    with_names,
)

if TYPE_CHECKING:
    from .reaches import Array

#: Maximum number of paths in a panel: more would hide each other.
_MOST_PATHS = 40


def _plane(reaches: list[Reach]) -> tuple[Array, Array]:
    """Unit vectors to the right and upward in the plane that is drawn.

    That is the plane across the axis about which angles and sides are defined; if the path to a target is almost parallel to
    that axis, it is the plane of those two of x, y and z along which the hand went farthest.
    """
    axes = np.array([reach.axis for reach in reaches])
    normal = axes[0] / np.linalg.norm(axes[0]) if np.linalg.norm(axes[0]) > 0 else np.full(3, math.nan)
    ways = np.array([reach.target - reach.start for reach in reaches])
    across = np.abs(ways @ normal) / np.linalg.norm(ways, axis=1)
    if not (np.isfinite(axes).all() and np.ptp(axes, axis=0).max() < 1e-6 and (across < 0.9).all()):
        extents = np.median([np.ptp(reach.path, axis=0) for reach in reaches], axis=0)
        # if two extents are equal, prefers the plane of x and y, seen from above
        normal = np.eye(3)[2 - int(np.argmin(extents[::-1]))]
    if abs(normal[2]) > 0.95:
        return np.array([1.0, 0, 0]), np.array([0, 1.0, 0])
    up = np.array([0, 0, 1.0]) - normal[2] * normal
    up /= np.linalg.norm(up)
    right = np.cross(up, normal)
    backward = right[0] < -1e-9 or (abs(right[0]) < 1e-9 and right[1] < 0)
    return (-right if backward else right), up


def _direction(vector: Array) -> str:
    """A direction in words."""
    names = [("to the left", "to the right"), ("towards the body", "away from the body"), ("down", "up")]
    return " and ".join(pair[int(value > 0)] for pair, value in zip(names, vector) if abs(value) > 0.3)


def _chosen(by_colour: dict[str, list[Reach]], most: int) -> dict[str, list[Reach]]:
    """At most this many reaches, spread evenly over colours, people and trials."""
    all_of = [(name, reach) for name, own in by_colour.items() for reach in own]
    if len(all_of) > most:
        all_of = [all_of[i] for i in np.unique(np.linspace(0, len(all_of) - 1, most).round().astype(int))]
    return {name: [reach for key, reach in all_of if key == name] for name in by_colour}


@of_data
def reach_paths(data: Data, *, part: str = "", most: int = _MOST_PATHS) -> pd.DataFrame:
    """Paths of reaches in the plane in which they are drawn, from recordings: a row for each point, 5 ms apart.

    `part` selects one of an experiment's figures, if it has several; `most` is the maximum number of paths in a panel.
    Columns: `panel`, `colour` (the condition; of more than seven, the vector to the target: x y z in mm), `of` ("path",
    "start" or "target"), `person`, `session`, `trial_num`, `time_s` from the start of the state, `across_mm` and `up_mm`,
    and `radius_mm` of starts and targets (NaN: not known). A path belongs to the last attempt at a trial, and goes from the
    start of the state in which the reach is made to the state that ends it. Raises NotThere, or Error without such
    recordings.

    `python/dihaptic/figures/paths/paths.py` explains which plane is drawn. A rehearsal has recordings only if it is made by
    `dh.rehearse(..., keep_recordings=True)`.
    """
    sheet = sheet_named(data, part)
    everything = [reach for own in sheet.panels.values() for reach in own]
    plane = np.array(_plane(everything)).T * 1000
    every = colours_of(data, everything)
    colour_of = {id(reach): name for name, own in every.items() for reach in own}
    parts = []
    for panel, own in sheet.panels.items():
        by_colour: dict[str, list[Reach]] = {name: [] for name in every}
        for reach in own:
            by_colour[colour_of[id(reach)]].append(reach)
        for colour, some in _chosen(by_colour, most).items():
            parts += [_marks_of(reach, plane, panel, colour) for reach in some]
            parts += [_path_of(reach, plane, panel, colour) for reach in some]
    out = pd.concat(parts, ignore_index=True)
    same = out["of"].ne("path") & out.duplicated(["panel", "colour", "of", "across_mm", "up_mm", "radius_mm"])
    return out[~same].reset_index(drop=True)


def _path_of(reach: Reach, plane: Array, panel: str, colour: str) -> pd.DataFrame:
    flat = reach.path @ plane
    return pd.DataFrame({
        "panel": panel, "colour": colour, "of": "path", "person": reach.person, "session": reach.session,
        "trial_num": pd.array([reach.trial_num] * len(flat), dtype="Int64"), "time_s": STEP * np.arange(len(flat)),
        "across_mm": flat[:, 0], "up_mm": flat[:, 1], "radius_mm": math.nan,
    })  # fmt: skip


def _marks_of(reach: Reach, plane: Array, panel: str, colour: str) -> pd.DataFrame:
    ends = np.array([reach.start, reach.target]) @ plane
    return pd.DataFrame({
        "panel": panel, "colour": colour, "of": ["start", "target"], "person": "", "session": "",
        "trial_num": pd.array([pd.NA, pd.NA], dtype="Int64"), "time_s": math.nan, "across_mm": ends[:, 0], "up_mm": ends[:, 1],
        "radius_mm": [1000 * reach.start_radius, 1000 * reach.target_radius],
    })  # fmt: skip


@drawing
def draw_reach_paths(
    points: pd.DataFrame, *, across: str = "to the right", up: str = "away from the body", legend: bool = True,
    bar_mm: float = 20, size: str = "one column", height_mm: float = 70,
) -> Figure:  # fmt: skip
    """Draws reach_paths() to scale: thin lines with a mark at their ends, circles where they start and where targets are.

    `across` and `up` say in words to which directions the right and the top of the page correspond; `bar_mm` is the length
    of the scale bar; `height_mm` is the maximum height of a row of panels. Limits are the same in all panels.
    """
    if points.empty:
        raise error("has no path", "Draw a table of reach_paths() with rows.", key="points")
    points = with_names(points)
    low, high = _box(points)
    panels = list(dict.fromkeys(points["panel"]))
    colours = list(dict.fromkeys(points.sort_values("colour", key=lambda c: c.map(place_in(points)))["colour"]))
    columns = _columns(len(panels), high - low, size, height_mm)
    rows = -(-len(panels) // columns)
    letters = int((WIDTHS[size] - 8) / columns / 1.75)
    lines = max(wrapped(name_of(name), letters).count("\n") + 1 for name in panels) if len(panels) > 1 else 0
    each = min(height_mm, (WIDTHS[size] - 10) / columns * (high - low)[1] / (high - low)[0] + 3)
    named = legend and len([name for name in colours if name]) > 1
    total = rows * (each + 4 * lines) + 7 + (8 if named else 0)
    figure, all_axes = canvas(size, total, rows, columns)
    for i, axes in enumerate(all_axes):
        if i >= len(panels):
            axes.set_visible(False)
            continue
        _draw_paths(axes, points[points["panel"] == panels[i]], colours)
        axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), xticks=[], yticks=[])
        axes.set_aspect("equal")
        axes.spines[["left", "bottom"]].set_visible(False)
        if len(panels) > 1:
            # a panel that is drawn to scale may be narrower than its title
            axes.set_title(wrapped(name_of(panels[i]), letters), loc="center")
        if i % columns == 0:
            axes.set_ylabel(wrapped(f"{up} →", int(each / 1.6)), color=QUIET)
        if i == columns * (rows - 1):
            axes.set_xlabel(wrapped(f"{across} →", letters), color=QUIET, labelpad=2)
    _scale_bar(all_axes[0], bar_mm, low, high)
    if named:
        handles = [Line2D([], [], color=HUES[i % 8], marker=MARKERS[i % 7], linewidth=0.8) for i in range(len(colours))]
        legend_of_colours(figure, handles, colours, "")
    return figure


def _box(points: pd.DataFrame) -> tuple[Array, Array]:
    """The lower left and upper right corners of all panels [mm], with space for the scale bar below."""
    places = points[["across_mm", "up_mm"]].to_numpy(float)
    radius = points["radius_mm"].fillna(0).to_numpy(float)[:, None]
    low, high = np.nanmin(places - radius, axis=0), np.nanmax(places + radius, axis=0)
    widest = float((high - low).max()) or 1.0
    middle = (low + high) / 2
    # leaves space beside a straight path, whose panel would otherwise have no width
    half = np.maximum((high - low) / 2 + 0.03 * widest, 0.15 * widest)
    low, high = middle - half, middle + half
    low[1] -= 0.13 * widest
    return low, high


def _columns(panels: int, extent: Array, size: str, height_mm: float) -> int:
    """The number of panels in a row that makes them about as high as possible, and fills the rows evenly."""
    narrow = height_mm * extent[0] / extent[1]
    fit = max(1, min(int((WIDTHS[size] - 8) / max(narrow, 30)), 6))
    fit = max(fit, min(panels, 4 if size == "two columns" else 2))
    rows = -(-panels // fit)
    return -(-panels // rows)


def _draw_paths(axes: Axes, shown: pd.DataFrame, colours: list[str]) -> None:
    for row in shown[shown["of"] != "path"].itertuples():
        hue = QUIET if row.of == "start" else "#333333"
        if math.isfinite(row.radius_mm):
            # an artist, since the limits are known; those of a patch are computed, which takes long
            axes.add_artist(Circle((row.across_mm, row.up_mm), row.radius_mm, fill=False, edgecolor=hue, linewidth=0.6))
        else:
            axes.plot([row.across_mm], [row.up_mm], marker="+", color=hue, markersize=4)
    paths = shown[shown["of"] == "path"]
    for i, colour in enumerate(colours):
        own = paths[paths["colour"] == colour]
        x, y, ends = [], [], []
        for _, one in own.groupby(["person", "session", "trial_num"], sort=False, dropna=False):
            x += [*one["across_mm"], math.nan]
            y += [*one["up_mm"], math.nan]
            ends.append(len(x) - 2)
        if ends:
            axes.plot(
                x, y, color=HUES[i % 8], linewidth=0.5, alpha=0.75, marker=MARKERS[i % 7], markersize=1.8, markevery=ends,
                markeredgewidth=0,
            )  # fmt: skip


def _scale_bar(axes: Axes, bar_mm: float, low: Array, high: Array) -> None:
    x = low[0] + 0.04 * (high - low)[0]
    y = low[1] + 0.1 * float((high - low).max())
    axes.plot([x, x + bar_mm], [y, y], color="black", linewidth=1.5, solid_capstyle="butt")
    axes.annotate(f"{bar_mm:g} mm", (x, y), (0, -3), textcoords="offset points", ha="left", va="top")


# Which figures a design calls for


def plan_of_paths(data: Data, sheet: Sheet, reaches: list[Reach]) -> Plan:
    colours = colours_of(data, reaches)
    by_target = len({reach.condition for reach in reaches}) > MOST_COLOURS
    right, up = _plane(reaches)
    widest = 1000 * max(float(np.ptp(reach.path @ np.array([right, up]).T, axis=0).max()) for reach in reaches)
    caption = "Paths of the hand in single reaches, to scale, until the state that ends them; small marks are their ends, "
    caption += "circles are start and target."
    if by_target and len(colours) > 1:
        caption += " Colours tell neighbouring targets apart."
    caption += _cut(sheet)
    options = {
        "across": _direction(right), "up": _direction(up), **({"legend": False} if by_target else {}),
        "bar_mm": 50 if widest > 150 else 20,
    }  # fmt: skip
    caption = f"{caption} {counts_in_words(reaches)}"
    return plan_of_sheet(sheet, "reach-paths", "Paths of reaches", caption, reach_paths, draw_reach_paths, options)


def _cut(sheet: Sheet) -> str:
    """A sentence about panels in which not all paths are drawn."""
    many = {name: len(own) for name, own in sheet.panels.items() if len(own) > _MOST_PATHS}
    cut = [f"{_MOST_PATHS} of {count}" + (f' in "{name}"' if name else "") for name, count in many.items()]
    return f" The figure shows {', '.join(cut)}, spread evenly over conditions, people and trials." if cut else ""
