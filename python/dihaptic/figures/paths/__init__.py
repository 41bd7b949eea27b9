"""Reaches from recordings: their paths to scale, their speed, and the force on channels against the ideal force."""

from __future__ import annotations

from collections.abc import Iterator

from ..data import Data
from ..saving import Plan
from .channels import channel_forces, channel_stages, draw_channel_forces, plan_of_channels
from .paths import draw_reach_paths, plan_of_paths, reach_paths
from .sheets import sheets_of
from .speed import draw_speed_profiles, plan_of_speed, speed_profiles

__all__ = [
    "HEADING", "channel_forces", "draw_channel_forces", "draw_reach_paths", "draw_speed_profiles", "plans", "reach_paths",
    "speed_profiles",
]  # fmt: skip

#: Heading above these figures in a report.
HEADING = "Movements"


def plans(data: Data) -> Iterator[Plan]:
    """Paths and speeds of recorded reaches, and their force on channels."""
    if not data.recorded or not (data.task.get("reach") or data.task.get("movement")):
        return
    for sheet in sheets_of(data):
        reaches = [reach for own in sheet.panels.values() for reach in own]
        yield plan_of_paths(data, sheet, reaches)
        if any(len(reach.speed) for reach in reaches):
            yield plan_of_speed(data, sheet, reaches)
    stages = channel_stages(data)
    if stages:
        yield plan_of_channels(data, stages)
