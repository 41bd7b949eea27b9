"""Speed of reaches from movement onset."""

from __future__ import annotations

from typing import Any

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ...errors import error
from ..data import Data
from ..saving import Plan
from ..style import drawing, of_data
from ..words import counted
from .over_time import quartiles, time_panels
from .reaches import Reach
from .sheets import (
    HUES,
    MOST_COLOURS,
    Sheet,
    colours_of,
    counts_in_words,
    legend_of_colours,
    place_in,
    plan_of_sheet,
    sheet_named,
    with_names,
)

_DASHES: list[Any] = ["-", (0, (5, 1.5)), (0, (1.2, 1)), (0, (5, 1.2, 1.2, 1.2)), (0, (9, 2)), (0, (3, 3)), (0, (2, 1, 2, 3))]


@of_data
def speed_profiles(data: Data, *, part: str = "") -> pd.DataFrame:
    """Speed against time from movement onset, from recordings: median and quartiles over reaches, every 5 ms.

    `part` selects one of an experiment's figures, if it has several. Columns: `panel`, `colour` (the condition; of
    more than seven, the distance of the target), `time_s`, `n` reaches of `of_n`, and `median_m_s`, `lower_m_s` and
    `upper_m_s`. Onset is defined as in docs/measures-of-behaviour.md; a time is included while three quarters of the reaches
    last. Raises NotThere, or Error without such recordings.

    A rehearsal has recordings only if it is made by `dh.rehearse(..., keep_recordings=True)`.
    """
    sheet = sheet_named(data, part)
    every = colours_of(data, [reach for own in sheet.panels.values() for reach in own], of_speed=True)
    colour_of = {id(reach): name for name, own in every.items() for reach in own}
    parts = []
    for panel, own in sheet.panels.items():
        for colour in every:
            some = [reach for reach in own if colour_of[id(reach)] == colour and len(reach.speed)]
            if some:
                curve = quartiles([(reach.begins, reach.speed) for reach in some], "m_s")
                parts.append(pd.concat({(panel, colour): curve}, names=["panel", "colour"]).droplevel(2).reset_index())
    if not parts:
        raise error("has no reach with an onset", "Name sessions in which the hand moved.", file=str(data.folder))
    return pd.concat(parts, ignore_index=True)


@drawing
def draw_speed_profiles(
    points: pd.DataFrame, *, size: str = "one column", height_mm: float = 50, legend: str = ""
) -> Figure:
    """Draws speed_profiles(): lines are medians, and bands extend from quartile to quartile (with four colours or fewer).

    `legend` is what the colours stand for, in words.
    """
    if points.empty:
        raise error("has no speed", "Draw a table of speed_profiles() with rows.", key="points")
    points = with_names(points)
    panels = list(dict.fromkeys(points["panel"]))
    places = place_in(points)
    colours = sorted(places, key=lambda name: places[name])
    figure, all_axes, columns = time_panels(panels, size, height_mm, len(colours) > 1)
    for i, panel in enumerate(panels):
        own = points[points["panel"] == panel]
        for j, colour in enumerate(colours):
            curve = own[own["colour"] == colour]
            if curve.empty:
                continue
            all_axes[i].plot(curve["time_s"], curve["median_m_s"], color=HUES[j % 8], linestyle=_DASHES[j % 7])
            if len(colours) <= 4:
                all_axes[i].fill_between(
                    curve["time_s"], curve["lower_m_s"], curve["upper_m_s"], color=HUES[j % 8], alpha=0.2, linewidth=0
                )
        if i % columns == 0:
            all_axes[i].set_ylabel("speed [m/s]")
    all_axes[0].set_ylim(bottom=0)
    if len(colours) > 1:
        handles = [Line2D([], [], color=HUES[j % 8], linestyle=_DASHES[j % 7]) for j in range(len(colours))]
        legend_of_colours(figure, handles, colours, legend)
    return figure


def plan_of_speed(data: Data, sheet: Sheet, reaches: list[Reach]) -> Plan:
    without = sum(not len(reach.speed) for reach in reaches)
    colours = colours_of(data, [reach for reach in reaches if len(reach.speed)], of_speed=True)
    by_distance = len({reach.condition for reach in reaches}) > MOST_COLOURS
    caption = "Speed from movement onset: medians over reaches"
    caption += ", with bands from quartile to quartile" if len(colours) <= 4 else ""
    caption += ", while at least three quarters of them last."
    if without:
        caption += f" {counted(without, 'reach', 'reaches')} without an onset {'is' if without == 1 else 'are'} left out."
    options = {"legend": "distance of the target"} if by_distance and len(colours) > 1 else {}
    caption = f"{caption} {counts_in_words(reaches)}"
    return plan_of_sheet(sheet, "reach-speed", "Speed of reaches", caption, speed_profiles, draw_speed_profiles, options)
