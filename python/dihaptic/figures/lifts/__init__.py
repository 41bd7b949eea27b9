"""Grip-lifts: courses of grip, load and height around lift-off, grip against load, change over lifts, durations of phases."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pandas as pd

from ..data import ASIDE, Data
from ..saving import Plan
from .curves import draw_lift_curves, lift_curves, plan_of_curves
from .load import draw_grip_against_load, grip_against_load, plan_of_load
from .phases import draw_lift_phases, lift_phases, plan_of_phases
from .selection import MOST_CASES, MOST_PANELS, all_lifts, counting, counts_in_words, design, recorded_lifts, shows_catches, word
from .successive import draw_successive_lifts, plans_of_change, successive_lifts
from .weights import previous_weight

__all__ = [
    "HEADING", "draw_grip_against_load", "draw_lift_curves", "draw_lift_phases", "draw_successive_lifts", "grip_against_load",
    "lift_curves", "lift_phases", "plans", "previous_weight", "successive_lifts", "why_not_drawn",
]  # fmt: skip

#: Heading above these figures in a report.
HEADING = "Grip and lift"


def plans(data: Data) -> Iterator[Plan]:
    """Courses around lift-off and grip against load, from recordings; change over lifts, and phases, from lifts.csv."""
    if not data.has("lifts") or not data.has("trials"):
        return
    catch = shows_catches(data)
    frame = all_lifts(data)
    kept = counting(frame, catch)
    if few_are_complete(frame, kept):
        return  # another kind of task: objects that are pushed, or carried from the start
    colour, panel = design(data, kept)
    options: dict[str, Any] = {**({"colour": colour} if colour else {}), **({"catch": True} if catch else {})}
    legend = " and ".join(word(column) for column in colour if column != "presented")
    yield from _plans_of_courses(data, options, panel, legend, catch)
    yield from plans_of_change(data, frame, options, panel, catch)
    if len(kept) > 1:
        rows = [*colour, *([panel] if panel else [])]
        yield plan_of_phases(data, frame, kept, options, rows, catch)


def few_are_complete(frame: pd.DataFrame, kept: pd.DataFrame) -> bool:
    """Whether so few lifts, `kept` of those in `frame`, are complete that none is drawn."""
    return kept.empty or 4 * len(kept) < len(frame[~frame["kind"].isin(ASIDE)])


def why_not_drawn(data: Data) -> str:
    """A sentence on lifts of which no figure is drawn, since most are incomplete; "" if they are drawn."""
    frame = all_lifts(data)
    kept = counting(frame, shows_catches(data))
    if not few_are_complete(frame, kept):
        return ""
    reasons = frame.loc[frame["lift"] != "complete", "lift"].value_counts()
    told = ", ".join(f"{count} {reason}" for reason, count in reasons.items())
    return f"Too few of {len(frame)} lifts are complete to draw their courses, grip against load and phases: {told}."


def _plans_of_courses(data: Data, options: dict[str, Any], panel: str, legend: str, catch: bool) -> Iterator[Plan]:
    """The figures that need recordings."""
    if not data.recorded:
        return
    frame = recorded_lifts(data)
    kept = counting(frame, catch)
    kept = kept[kept["lift_off_s"].notna()]
    if kept.empty:
        return
    cap = min(MOST_PANELS, kept[panel].nunique()) if panel else 1
    where = {"panel": panel} if panel else {}
    drawing: dict[str, Any] = {"legend": legend} if legend else {}
    drawing |= {"size": "two columns" if cap > 1 else "one column"}
    shown = ["median over lifts, bands are quartiles", "single lift"][len(kept) == 1]
    if kept["person"].nunique() > 1:
        shown = "median over people's medians, bands are quartiles over people"
    counts = counts_in_words(data, frame, catch, options.get("colour", []), panel, MOST_CASES)
    yield plan_of_curves({**options, **where}, drawing, shown, counts)
    if kept[["load_onset_s", "lift_off_s"]].notna().all(axis=1).any():
        yield plan_of_load(kept, {**options, **where}, drawing, shown, counts)
