"""Force on channels against the ideal force."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ...errors import error
from ..data import Data
from ..saving import Plan
from ..style import COLOURS, QUIET, drawing, legend_above, of_data
from ..words import counted
from .over_time import quartiles, time_panels
from .reaches import Reach, reaches_of
from .sheets import FEW, fewest, of_each


def channel_stages(data: Data) -> dict[str, list[Reach]]:
    """Reaches in channels by block; in perturbed blocks, at most eight in the first third and at most eight in the last.

    Reaches whose ideal forces point to opposite sides are kept apart.
    """
    kinds = {str(block.get("name")): str(block.get("kind", "")) for block in data.task.get("blocks") or []}
    with_force = [reach for reach in reaches_of(data) if reach.force is not None]
    several = len({(reach.group, reach.round) for reach in with_force}) > 1
    opposed = len({_side(reach) for reach in with_force} - {""}) > 1
    blocks: dict[str, list[Reach]] = {}
    for reach in sorted(with_force, key=lambda reach: reach.trial_num):
        part = [reach.group, reach.round, reach.block] if several else [reach.block]
        part += [_side(reach)] if opposed else []
        blocks.setdefault(", ".join(word for word in part if word), []).append(reach)
    out = {}
    for name, own in blocks.items():
        few = min(FEW, fewest(own) // 3)
        if kinds.get(own[0].block) in ("perturbed", "force_channel") and few > 0:
            what = "channel" if few == 1 else f"{few} channels"
            out[f"{name}, first {what}"] = of_each(own, slice(None, few))
            out[f"{name}, last {what}"] = of_each(own, slice(-few, None))
        else:
            out[name] = own
    return out


def _side(reach: Reach) -> str:
    """The side to which the ideal force of a reach points on average; empty if there is none."""
    ideal = reach.ideal
    if ideal is None or not np.isfinite(ideal).any() or (mean := float(np.nanmean(ideal))) == 0:
        return ""
    return "ideal to the left" if mean > 0 else "ideal to the right"


@of_data
def channel_forces(data: Data) -> pd.DataFrame:
    """Force of the hand on channels and the ideal force against time from movement onset: median and quartiles, every 5 ms.

    The ideal force would cancel the field that is learned, at the speed of the hand in the channel
    (docs/measures-of-behaviour.md). Columns: `panel` (block; of perturbed ones, its first and last channels), `force` ("on
    the channel" or "ideal"), `time_s`, `n` reaches of `of_n`, `median_N`, `lower_N`, `upper_N`; positive: to the left.
    Raises Error without recorded reaches in channels.

    A rehearsal has recordings only if it is made by `dh.rehearse(..., keep_recordings=True)`.
    """
    parts = []
    for panel, own in channel_stages(data).items():
        for name in ("on the channel", "ideal"):
            curves = [(r.begins, r.force if name == "on the channel" else r.ideal) for r in own]
            curve = quartiles([(begins, values) for begins, values in curves if values is not None], "N")
            parts.append(pd.concat({(panel, name): curve}, names=["panel", "force"]).droplevel(2).reset_index())
    if not parts:
        raise error("has no recorded reach in a channel", "Name sessions with force channels.", file=str(data.folder))
    return pd.concat(parts, ignore_index=True)


@drawing
def draw_channel_forces(
    points: pd.DataFrame, *, size: str = "two columns", height_mm: float = 50
) -> Figure:
    """Draws channel_forces(): the hand's force as a line with a band from quartile to quartile, the ideal one dashed."""
    if points.empty:
        raise error("has no force", "Draw a table of channel_forces() with rows.", key="points")
    points = points.assign(panel=points["panel"].fillna(""))
    panels = list(dict.fromkeys(points["panel"]))
    figure, all_axes, columns = time_panels(panels, size, height_mm, True)
    for i, panel in enumerate(panels):
        axes = all_axes[i]
        axes.axhline(0, color=QUIET, linewidth=0.5)
        own = points[points["panel"] == panel]
        for name, hue, dash in (("ideal", "black", (0, (4, 2))), ("on the channel", COLOURS[0], "-")):
            curve = own[own["force"] == name]
            axes.plot(curve["time_s"], curve["median_N"], color=hue, linestyle=dash)
            if name != "ideal":
                axes.fill_between(curve["time_s"], curve["lower_N"], curve["upper_N"], color=hue, alpha=0.2, linewidth=0)
        if i % columns == 0:
            axes.set_ylabel("force to the left [N]")
    handles = [Line2D([], [], color=COLOURS[0]), Line2D([], [], color="black", linestyle=(0, (4, 2)))]
    legend_above(figure, handles, ["on the channel", "ideal: would cancel the field"])
    return figure


def plan_of_channels(data: Data, stages: dict[str, list[Reach]]) -> Plan:
    reaches = [reach for own in stages.values() for reach in own]
    people = len({reach.person for reach in reaches})
    return Plan(
        name="channel-force",
        title="Force on the channel against the ideal force",
        caption="Force of the hand on the channel, to the left of the way: median over reaches, with a band from quartile to "
        "quartile, while at least three quarters of them last. Dashed: the force that would cancel the field at the speed "
        f"of these reaches. {counted(people, 'person', 'people')}, {counted(len(reaches), 'reach', 'reaches')} in channels, "
        "by block.",
        points=channel_forces,
        drawing=draw_channel_forces,
        drawing_options={
            "size": "two columns" if len(stages) > 1 else "one column",
        },
    )
