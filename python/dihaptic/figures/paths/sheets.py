"""The figures into which the reaches of an experiment are divided, and the panels and colours of each."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ...errors import NotThere, error
from ..data import Data
from ..saving import Plan
from ..style import COLOURS, QUIET, legend_above, wrapped
from ..words import counted, level
from .reaches import Reach, is_none, reaches_of

#: Kinds of trials whose reaches are drawn; in other kinds, reaches are held or shown on a line, or are not part of the
#: design.
_SHOWN = ["baseline", "perturbed", "washout"]
#: Number of reaches at the beginning and at the end of a block that show how learning changes them.
FEW = 8
#: Maximum numbers of panels in a figure, and of conditions with colours of their own.
_MOST_PANELS = 12
MOST_COLOURS = 7
#: More colours, for targets around a circle.
HUES = [*COLOURS, QUIET]


@dataclass(frozen=True)
class Sheet:
    """The reaches of one figure, by panel."""

    name: str  #: part of its file's name; "" if it is the only figure
    title: str
    panels: dict[str, list[Reach]]


def sheets_of(data: Data) -> list[Sheet]:
    """The figures of an experiment, and the panels of each figure: rounds and groups, or the stages of learning in them."""
    rounds = [str(own.get("name")) for own in data.task.get("rounds") or []]
    shown = [reach for reach in reaches_of(data) if reach.kind in _SHOWN or not reach.kind]
    # the order of rounds may differ between people
    shown.sort(key=lambda reach: (reach.group, rounds.index(reach.round) if reach.round in rounds else -1))
    parts: dict[str, list[Reach]] = {}
    for reach in shown:
        parts.setdefault(", ".join(word for word in (reach.group, reach.round) if word), []).append(reach)
    kinds = {reach.kind for reach in shown}
    if "perturbed" not in kinds or len(kinds) < 2:
        found = [("", parts)]
    else:
        found = [(name if len(parts) > 1 else "", _stages(own)) for name, own in parts.items()]
    return [sheet for name, panels in found for sheet in _parts_of(name, panels)]


def _parts_of(name: str, panels: dict[str, list[Reach]]) -> Iterator[Sheet]:
    """Figures with these panels, with as many panels in each as fit on a page."""
    names = list(panels)
    for first in range(0, len(names), _MOST_PANELS):
        number = str(first // _MOST_PANELS + 1) if len(names) > _MOST_PANELS else ""
        title = ", ".join(word for word in (name, f"part {number}" if number else "") if word)
        file = "-".join(word for word in (_file_name(name), number) if word)
        yield Sheet(file, title, {key: panels[key] for key in names[first : first + _MOST_PANELS]})


def _stages(reaches: list[Reach]) -> dict[str, list[Reach]]:
    """Blocks: the first and last reaches of perturbed blocks, and the first reaches of the blocks after them."""
    blocks: dict[str, list[Reach]] = {}
    for reach in sorted(reaches, key=lambda reach: reach.trial_num):
        blocks.setdefault(reach.block, []).append(reach)
    out = {}
    for block, own in blocks.items():
        kind = own[0].kind
        few = min(FEW, fewest(own) // (2 if kind == "perturbed" else 1))
        if kind == "perturbed" and few > 1:
            out[f"{block}, first {few}"] = of_each(own, slice(None, few))
            out[f"{block}, last {few}"] = of_each(own, slice(-few, None))
        elif kind == "washout" and fewest(own) > FEW:
            out[f"{block}, first {few}"] = of_each(own, slice(None, few))
        else:
            out[block] = own
    return out


def _by_session(reaches: Iterable[Reach]) -> dict[tuple[str, str], list[Reach]]:
    out: dict[tuple[str, str], list[Reach]] = {}
    for reach in reaches:
        out.setdefault((reach.person, reach.session), []).append(reach)
    return out


def fewest(reaches: list[Reach]) -> int:
    return min(len(own) for own in _by_session(reaches).values())


def of_each(reaches: list[Reach], some: slice) -> list[Reach]:
    return [reach for own in _by_session(reaches).values() for reach in own[some]]


def _file_name(words: str) -> str:
    return re.sub("[^a-z0-9]+", "-", words.lower()).strip("-")


def sheet_named(data: Data, name: str) -> Sheet:
    sheets = sheets_of(data)
    for sheet in sheets:
        if sheet.name == name:
            return sheet
    if not sheets:
        remedy = "Name sessions with session.nwb whose task measures reaches."
        raise error("has no recorded reaches", remedy, file=str(data.folder))
    raise NotThere(name, "is not a part of these reaches", [sheet.name for sheet in sheets], "")


def colours_of(data: Data, reaches: list[Reach], of_speed: bool = False) -> dict[str, list[Reach]]:
    """Reaches by the meaning of their colours: conditions or, if there are too many, the target or, for speed, its distance."""
    names = list(dict.fromkeys(reach.condition for reach in reaches))
    known = [name for name in data.conditions if name in names]
    order = [*known, *sorted((name for name in names if name not in known), key=_by_number)]
    if len(order) <= MOST_COLOURS:
        return {name: [reach for reach in reaches if reach.condition == name] for name in order}
    out: dict[Any, list[Reach]] = {}
    for reach in reaches:
        way = np.round(1000 * (reach.target - reach.start), 3) + 0.0
        key = f"{np.linalg.norm(way):.4g} mm" if of_speed else " ".join(f"{value:g}" for value in way)
        out.setdefault(key, []).append(reach)
    if of_speed and len(out) > MOST_COLOURS:
        return {"": reaches}
    ordered = sorted(out, key=_by_number)
    if of_speed:
        return {key if len(out) > 1 else "": out[key] for key in ordered}
    return {key: out[key] for key in ordered}


def _by_number(name: str) -> tuple[list[float], str]:
    """Sort key of names that contain numbers."""
    return [float(number) for number in re.findall(r"-?\d+(?:\.\d+)?", name)], name


# Drawing


def with_names(points: pd.DataFrame) -> pd.DataFrame:
    """The points, with the empty name of an only panel or colour restored: a CSV file cannot tell it from a missing value."""
    return points.assign(colour=points["colour"].fillna("").astype(str), panel=points["panel"].fillna("").astype(str))


def place_in(points: pd.DataFrame) -> dict[str, int]:
    """The colours, in the order in which they first appear in the panels."""
    order: list[str] = []
    for _, own in points.groupby("panel", sort=False):
        names = list(dict.fromkeys(own["colour"]))
        for i, name in enumerate(names):
            if name not in order:
                after = [order.index(other) + 1 for other in names[:i] if other in order]
                order.insert(max(after, default=0), name)
    return {name: i for i, name in enumerate(order)}


def legend_of_colours(figure: Figure, handles: list[Line2D], colours: list[str], title: str) -> None:
    """Draws a legend above all panels, with space for names of several lines."""
    names = [wrapped(name_of(name), int(figure.get_figwidth() * 72 / 4.6) - 8) for name in colours]
    legend_above(figure, handles, names, title)
    more = sum(name.count("\n") for name in names) * 7 * 1.45 / (figure.get_figheight() * 72)
    engine = figure.get_layout_engine()
    left, bottom, width, height = engine.get()["rect"]
    engine.set(rect=(left, bottom, width, height - more))


def name_of(name: Any) -> str:
    return "" if is_none(name) else level(str(name))


# Plans of figures


def plan_of_sheet(sheet: Sheet, name: str, title: str, caption: str, points: Any, drawing: Any, options: dict[str, Any]) -> Plan:
    """A figure of the reaches of a sheet."""
    return Plan(
        name="-".join(word for word in (name, sheet.name) if word),
        title=title + (f": {sheet.title}" if sheet.title else ""),
        caption=caption,
        points=points,
        points_options={"part": sheet.name} if sheet.name else {},
        drawing=drawing,
        drawing_options={**options, "size": "two columns" if len(sheet.panels) > 1 else "one column"},
    )


def counts_in_words(reaches: list[Reach]) -> str:
    people = len({reach.person for reach in reaches})
    return (
        f"{counted(people, 'person', 'people')}, {counted(len(reaches), 'reach', 'reaches')}; practice, catch trials, clamps, "
        "channels, and repeated attempts are left out."
    )
