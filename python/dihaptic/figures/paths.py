"""Reaches from recordings: their paths to scale, their speed, and the force on channels against the ideal force."""

from __future__ import annotations

import math
import re
import warnings
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from ..errors import Error, NotThere, error
from .data import Data
from .saving import Plan
from .sessions import Sitting
from .style import COLOURS, MARKERS, QUIET, WIDTHS, canvas, drawing, legend_above, of_data, wrapped
from .words import counted, level

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]

#: Heading above these figures in a report.
HEADING = "Movements"
#: Kinds of trials whose reaches are drawn; in other kinds, reaches are held or shown on a line, or are not part of the
#: design.
_SHOWN = ["baseline", "perturbed", "washout"]
#: Number of reaches at the beginning and at the end of a block that show how learning changes them.
_FEW = 8
#: Maximum numbers of panels in a figure, and of conditions with colours of their own.
_MOST_PANELS = 12
_MOST_COLOURS = 7
#: Maximum number of paths in a panel: more would hide each other.
_MOST_PATHS = 40
#: Time between points of a curve [s], and time drawn before onset [s].
_STEP = 0.005
_BEFORE = 0.1
#: Share of reaches that must still last for a median to be drawn: with fewer, it would jump where one of them ends.
_LASTING = 0.75
#: A movement over a shorter distance is not a reach [m].
_LEAST_WAY = 0.02
#: Movement slower than this is tremor (docs/measures-of-behaviour.md) [m/s].
_LEAST_PEAK = 0.05
#: More colours, for targets around a circle.
_HUES = [*COLOURS, QUIET]
_DASHES: list[Any] = ["-", (0, (5, 1.5)), (0, (1.2, 1)), (0, (5, 1.2, 1.2, 1.2)), (0, (9, 2)), (0, (3, 3)), (0, (2, 1, 2, 3))]


# Reaches of recorded sessions


@dataclass(frozen=True)
class _Reach:
    """A reach in the last attempt at a trial, from the start of the state in which it is made to the state that ends it."""

    person: str
    group: str
    session: str
    trial_num: int
    round: str
    block: str
    kind: str
    condition: str
    start: Array  #: centre of the region where it begins [m]
    target: Array
    start_radius: float  #: [m]; NaN: not known
    target_radius: float
    axis: Array  #: left and right of the path are as seen from its tip
    path: Array  #: every 5 ms: x, y, z [m]
    begins: float = math.nan  #: time of the first value of `speed`, from onset [s]; NaN: no onset was found
    speed: Array = field(default_factory=lambda: np.empty(0))  #: every 5 ms, one value at onset [m/s]
    force: Array | None = None  #: force of the hand on a channel, to the left, at the times of `speed` [N]; None: no channel
    ideal: Array | None = None  #: force that would cancel the field that is learned [N]


def _reaches(data: Data) -> list[_Reach]:
    """The reaches of all recorded sessions, which are read only once."""
    cache: dict[str, Any] = data.__dict__
    if "_reaches" not in cache:
        found: list[_Reach] = []
        for sitting in data.recorded:
            try:
                found += _Reader(sitting, data.task).reaches()
            except Error as why:
                warnings.warn(f"reaches of {sitting.session.folder.name} are not drawn: {why}", stacklevel=2)
        cache["_reaches"] = found
    return list(cache["_reaches"])


class _Reader:
    """Finds the reaches of one session."""

    def __init__(self, sitting: Sitting, task: dict[str, Any]) -> None:
        self.sitting, self.session, self.task = sitting, sitting.session, task
        self.movement: dict[str, Any] = task.get("movement") or {}
        measured = task.get("reach")
        self.of_reach = bool(measured)
        self.rule: dict[str, Any] = measured or self.movement
        self.during = _words_in(self.rule.get("during"))
        self.shown: tuple[Any, ...] | None = None  # times, regions and radii of the balls

    def reaches(self) -> list[_Reach]:
        prefix = "reach" if self.of_reach else "movement"
        if not self.during or any(name not in self.session.tables for name in ("trial-list", "trials", "phases")):
            return []
        listed = self.session.table("trial-list")
        if f"{prefix}_from_x_mm" not in listed:
            return []
        of = str(listed["reach_finger"].dropna().iloc[0]) if self.of_reach else str(self.movement.get("of", ""))
        points = self._moving(of)
        if not points:
            return []
        self.position = self._mean(points, "position")
        self.velocity = self._mean(points, "velocity")
        self.sent = self._force_sent(listed, points)
        plan = [column for column in listed if re.match("(reach|movement)_", column)]
        rows = self._attempts().merge(listed[["trial_num", *plan]], on="trial_num")
        phases = self.session.phases
        self.begins, self.ends = (phases[name].to_numpy(float) for name in ("start_time", "stop_time"))
        self.inside = phases["phase"].astype(str).isin(self.during).to_numpy()
        made = [self._reach(row, prefix) for row in rows.to_dict("records")]
        return [reach for reach in made if reach is not None]

    def _moving(self, of: str) -> list[str]:
        """The beginnings of the names of the moving points' quantities, such as "index.handle_"; several points are averaged."""
        fingers = self.session.fingers
        points = [f"{name}.handle_" for name in fingers if of in (name, "hand")]
        points = [f"{of}."] if of in self.session.bodies else points
        return points if all(f"{point}position" in self.session for point in points) else []

    def _force_sent(self, listed: pd.DataFrame, points: list[str]) -> Array | None:
        """The force on the hand, summed over its fingers; None unless channels hold it throughout its movement."""
        channels = "movement_channel" in listed and bool(listed["movement_channel"].eq(1).any())
        if not channels or not points[0].endswith(".handle_") or not self._walls_last():
            return None
        fingers = [point[: -len("handle_")] for point in points]
        return len(fingers) * self._mean(fingers, "force_sent")

    def _mean(self, points: list[str], quantity: str) -> Array:
        total: Array = np.asarray(self.session[f"{points[0]}{quantity}"], float)
        for point in points[1:]:
            total = total + np.asarray(self.session[f"{point}{quantity}"], float)
        return total / len(points)

    def _attempts(self) -> pd.DataFrame:
        trials = self.session.trials.drop_duplicates("trial_num", keep="last")
        known = trials["start_time"].notna() & trials["stop_time"].notna() & (trials["outcome"] != "interrupted")
        return trials[known]

    def _walls_last(self) -> bool:
        """Whether channels act in all states of the movement; otherwise the force cannot be compared with the ideal one."""
        for own in self.task.get("perturbations") or []:
            channel = any(load.get("kind") == "channel" for load in own.get("loads") or [])
            if channel and own.get("during") and not set(self.during) <= set(_words_in(own["during"])):
                return False
        states = {str(state.get("name")): state for state in self.task.get("states") or []}
        return all(states.get(name, {}).get("perturbed", "yes") not in ("no", False) for name in self.during)

    def _reach(self, row: dict[str, Any], prefix: str) -> _Reach | None:
        part = self._part(row)
        start, target = (_vector(row, f"{prefix}_{end}", "_mm") / 1000 for end in ("from", "to"))
        axis = _vector(row, f"{prefix}_axis")
        way = float(np.linalg.norm(target - start))
        if part is None or not way >= _LEAST_WAY:
            return None
        position, velocity = self.position[part], self.velocity[part]
        every = max(1, round(_STEP / self.session.tick))
        path = position[::every]
        if not np.isfinite(path).all():
            return None
        along = np.asarray((target - start) / way, np.float64)
        channel = row.get("movement_channel") == 1
        speed = np.abs(velocity @ along) if channel else np.linalg.norm(velocity, axis=1)
        onset = _onset(speed, position, way, self.movement, self.session.tick)
        curves: dict[str, Any] = {}
        if onset is not None:
            first = max(onset % every, onset - every * round(_BEFORE / _STEP))
            curves = {"begins": (first - onset) * self.session.tick, "speed": speed[first::every]}
            curves.update(self._forces(row, part, axis, along, velocity, slice(first, None, every)))
        text = {name: "" if _none(row.get(name)) else str(row[name]) for name in ("round", "block", "kind", "condition")}
        return _Reach(
            self.sitting.person, self.sitting.group, self.session.folder.name, int(row["trial_num"]),
            text["round"], text["block"], text["kind"], text["condition"], start, target,
            self._radius("from", text["condition"], part.start), self._radius("to", text["condition"], part.start),
            axis, path, **curves,
        )  # fmt: skip

    def _part(self, row: dict[str, Any]) -> slice | None:
        """The ticks from entry into the first of these states until the last of them is left; None if any tick is missing."""
        half = self.session.tick / 2
        own = np.flatnonzero((self.begins >= row["start_time"] - half) & (self.begins <= row["stop_time"] + half))
        inside = self.inside[own]
        if not inside.any():
            return None
        first = int(inside.argmax())
        out = np.flatnonzero(~inside[first:])
        last = first + int(out[0]) - 1 if len(out) else len(own) - 1
        begin, end = float(self.begins[own[first]]), float(self.ends[own[last]])
        if not (math.isfinite(begin) and math.isfinite(end)):
            return None
        part = self.session.between(begin, end + self.session.tick)
        times = self.session.t[part]
        whole = len(times) > 2 and float(np.diff(times).max()) < 1.5 * self.session.tick
        return part if whole else None

    def _forces(
        self, row: dict[str, Any], part: slice, axis: Array, along: Array, velocity: Array, each: slice
    ) -> dict[str, Array]:
        if self.sent is None or row.get("movement_channel") != 1:
            return {}
        field_of = np.array([[row.get(f"movement_ideal_{r}{c}_Ns_m", math.nan) for c in "xyz"] for r in "xyz"], float)
        left = np.cross(axis, along)
        if not (np.isfinite(field_of).all() and field_of.any() and np.linalg.norm(left) > 0):
            return {}
        left /= np.linalg.norm(left)
        return {"force": -(self.sent[part] @ left)[each], "ideal": -(velocity @ field_of.T @ left)[each]}

    def _radius(self, end: str, condition: str, tick: int) -> float:
        """Radius of a region [m]: from the task or from the ball shown there; NaN if neither is known."""
        name = str(self.rule.get(end, self.movement.get(end, "")))
        regions = self.task.get("regions") or []
        changed = [own for own in self.task.get("conditions") or [] if str(own.get("name")) == condition]
        for place in [*((changed[0].get("regions") or []) if changed else []), *regions]:
            if str(place.get("name")) == name:
                for key, unit in (("radius_m", 1.0), ("radius_mm", 0.001)):
                    if isinstance(place.get(key), (int, float)):
                        return float(place[key]) * unit
        names = [str(place.get("name")) for place in regions]
        return self._shown_radius(names.index(name), tick) if name in names else math.nan

    def _shown_radius(self, region: int, tick: int) -> float:
        if self.shown is None:
            table = self.session["targets"] if "targets" in self.session else pd.DataFrame(columns=["time", "region", "radius"])
            self.shown = tuple(table[name].to_numpy() for name in ("time", "region", "radius"))
        times, regions, radii = self.shown
        begin = self.session.t[tick]
        first, last = np.searchsorted(times, [begin - self.session.tick / 2, begin + 1.5 * self.session.tick])
        here = np.flatnonzero(regions[first:last] == region)
        return float(radii[first + here[-1]]) if len(here) else math.nan


def _words_in(value: Any) -> list[str]:
    return [str(item) for item in value] if isinstance(value, list) else [str(value)] if value else []


def _none(value: Any) -> bool:
    return value is None or (isinstance(value, float) and math.isnan(value))


def _vector(row: dict[str, Any], name: str, unit: str = "") -> Array:
    return np.array([row.get(f"{name}_{axis}{unit}", math.nan) for axis in "xyz"], float)


def _onset(speed: Array, position: Array, way: float, options: dict[str, Any], tick: float) -> int | None:
    """The tick of the movement's onset, by the rule of docs/measures-of-behaviour.md; None if there is no such movement."""
    least = options.get("onset_speed_m_s")
    pause = round(float(options.get("end_still_s", 0)) / tick)
    start, before = 0, False
    while True:
        peak, last = _first_stroke([*map(float, speed[start:])])
        peak, last = start + peak, start + last
        threshold = float(least) if least is not None else float(options.get("onset_share", 0.05)) * speed[peak]
        slow = np.flatnonzero(speed[start:peak] < threshold)
        onset = start + int(slow[-1]) + 1 if len(slow) else start
        end = _end(speed, peak, threshold, pause)
        before = onset == start and (start == 0 or before)
        before = before and not (start == 0 and options.get("continues") in (True, "yes"))
        moved = float(np.linalg.norm(position[onset : end + 1] - position[onset], axis=1).max())
        small = moved < 0.1 * way or (end - onset) * tick < 0.05
        if (before or small) and last + 1 < len(speed):
            start = last
            continue
        found = speed[peak] >= (_LEAST_PEAK if least is None else float(least))
        return onset if found and not before and not small else None


def _end(speed: Array, peak: int, threshold: float, pause: int) -> int:
    """The tick after the peak from which the speed stays below the threshold for longer than a pause."""
    slow = 0
    for i, value in enumerate(map(float, speed[peak:]), peak):
        slow = slow + 1 if value < threshold else 0
        if slow > pause:
            return i - pause
    return len(speed)


def _first_stroke(speed: list[float]) -> tuple[int, int]:
    """The fastest tick of the first stroke, and the tick before the next stroke begins."""
    most = max(speed)
    peak = end = 0
    for i, value in enumerate(speed):
        fallen = speed[peak] >= 0.25 * most and speed[end] <= 0.8 * speed[peak]
        if most > 0 and fallen and value - speed[end] >= 0.1 * most:
            return peak, end
        if value > speed[peak]:
            peak = end = i
        elif value < speed[end]:
            end = i
    return peak, len(speed) - 1


# Panels and colours


@dataclass(frozen=True)
class _Sheet:
    """The reaches of one figure, by panel."""

    name: str  #: part of its file's name; "" if it is the only figure
    title: str
    panels: dict[str, list[_Reach]]


def _sheets(data: Data) -> list[_Sheet]:
    """The figures of an experiment, and the panels of each figure: rounds and groups, or the stages of learning in them."""
    rounds = [str(own.get("name")) for own in data.task.get("rounds") or []]
    shown = [reach for reach in _reaches(data) if reach.kind in _SHOWN or not reach.kind]
    # the order of rounds may differ between people
    shown.sort(key=lambda reach: (reach.group, rounds.index(reach.round) if reach.round in rounds else -1))
    parts: dict[str, list[_Reach]] = {}
    for reach in shown:
        parts.setdefault(", ".join(word for word in (reach.group, reach.round) if word), []).append(reach)
    kinds = {reach.kind for reach in shown}
    if "perturbed" not in kinds or len(kinds) < 2:
        found = [("", parts)]
    else:
        found = [(name if len(parts) > 1 else "", _stages(own)) for name, own in parts.items()]
    return [sheet for name, panels in found for sheet in _parts_of(name, panels)]


def _parts_of(name: str, panels: dict[str, list[_Reach]]) -> Iterator[_Sheet]:
    """Figures with these panels, with as many panels in each as fit on a page."""
    names = list(panels)
    for first in range(0, len(names), _MOST_PANELS):
        number = str(first // _MOST_PANELS + 1) if len(names) > _MOST_PANELS else ""
        title = ", ".join(word for word in (name, f"part {number}" if number else "") if word)
        file = "-".join(word for word in (_file_name(name), number) if word)
        yield _Sheet(file, title, {key: panels[key] for key in names[first : first + _MOST_PANELS]})


def _stages(reaches: list[_Reach]) -> dict[str, list[_Reach]]:
    """Blocks: the first and last reaches of perturbed blocks, and the first reaches of the blocks after them."""
    blocks: dict[str, list[_Reach]] = {}
    for reach in sorted(reaches, key=lambda reach: reach.trial_num):
        blocks.setdefault(reach.block, []).append(reach)
    out = {}
    for block, own in blocks.items():
        kind = own[0].kind
        few = min(_FEW, _fewest(own) // (2 if kind == "perturbed" else 1))
        if kind == "perturbed" and few > 1:
            out[f"{block}, first {few}"] = _of_each(own, slice(None, few))
            out[f"{block}, last {few}"] = _of_each(own, slice(-few, None))
        elif kind == "washout" and _fewest(own) > _FEW:
            out[f"{block}, first {few}"] = _of_each(own, slice(None, few))
        else:
            out[block] = own
    return out


def _by_session(reaches: Iterable[_Reach]) -> dict[tuple[str, str], list[_Reach]]:
    out: dict[tuple[str, str], list[_Reach]] = {}
    for reach in reaches:
        out.setdefault((reach.person, reach.session), []).append(reach)
    return out


def _fewest(reaches: list[_Reach]) -> int:
    return min(len(own) for own in _by_session(reaches).values())


def _of_each(reaches: list[_Reach], some: slice) -> list[_Reach]:
    return [reach for own in _by_session(reaches).values() for reach in own[some]]


def _file_name(words: str) -> str:
    return re.sub("[^a-z0-9]+", "-", words.lower()).strip("-")


def _sheet(data: Data, name: str) -> _Sheet:
    sheets = _sheets(data)
    for sheet in sheets:
        if sheet.name == name:
            return sheet
    if not sheets:
        remedy = "Name sessions with session.nwb whose task measures reaches."
        raise error("has no recorded reaches", remedy, file=str(data.folder))
    raise NotThere(name, "is not a part of these reaches", [sheet.name for sheet in sheets], "")


def _colours_of(data: Data, reaches: list[_Reach], of_speed: bool = False) -> dict[str, list[_Reach]]:
    """Reaches by the meaning of their colours: conditions or, if there are too many, the target or, for speed, its distance."""
    names = list(dict.fromkeys(reach.condition for reach in reaches))
    known = [name for name in data.conditions if name in names]
    order = [*known, *sorted((name for name in names if name not in known), key=_by_number)]
    if len(order) <= _MOST_COLOURS:
        return {name: [reach for reach in reaches if reach.condition == name] for name in order}
    out: dict[Any, list[_Reach]] = {}
    for reach in reaches:
        way = np.round(1000 * (reach.target - reach.start), 3) + 0.0
        key = f"{np.linalg.norm(way):.4g} mm" if of_speed else " ".join(f"{value:g}" for value in way)
        out.setdefault(key, []).append(reach)
    if of_speed and len(out) > _MOST_COLOURS:
        return {"": reaches}
    ordered = sorted(out, key=_by_number)
    if of_speed:
        return {key if len(out) > 1 else "": out[key] for key in ordered}
    return {key: out[key] for key in ordered}


def _by_number(name: str) -> tuple[list[float], str]:
    """Sort key of names that contain numbers."""
    return [float(number) for number in re.findall(r"-?\d+(?:\.\d+)?", name)], name


# Paths


def _plane(reaches: list[_Reach]) -> tuple[Array, Array]:
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


def _chosen(by_colour: dict[str, list[_Reach]], most: int) -> dict[str, list[_Reach]]:
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

    `python/dihaptic/figures/paths.py` explains which plane is drawn. A rehearsal has recordings only if it is made by
    `dh.rehearse(..., keep_recordings=True)`.
    """
    sheet = _sheet(data, part)
    everything = [reach for own in sheet.panels.values() for reach in own]
    plane = np.array(_plane(everything)).T * 1000
    every = _colours_of(data, everything)
    colour_of = {id(reach): name for name, own in every.items() for reach in own}
    parts = []
    for panel, own in sheet.panels.items():
        by_colour: dict[str, list[_Reach]] = {name: [] for name in every}
        for reach in own:
            by_colour[colour_of[id(reach)]].append(reach)
        for colour, some in _chosen(by_colour, most).items():
            parts += [_marks_of(reach, plane, panel, colour) for reach in some]
            parts += [_path_of(reach, plane, panel, colour) for reach in some]
    out = pd.concat(parts, ignore_index=True)
    same = out["of"].ne("path") & out.duplicated(["panel", "colour", "of", "across_mm", "up_mm", "radius_mm"])
    return out[~same].reset_index(drop=True)


def _path_of(reach: _Reach, plane: Array, panel: str, colour: str) -> pd.DataFrame:
    flat = reach.path @ plane
    return pd.DataFrame({
        "panel": panel, "colour": colour, "of": "path", "person": reach.person, "session": reach.session,
        "trial_num": pd.array([reach.trial_num] * len(flat), dtype="Int64"), "time_s": _STEP * np.arange(len(flat)),
        "across_mm": flat[:, 0], "up_mm": flat[:, 1], "radius_mm": math.nan,
    })  # fmt: skip


def _marks_of(reach: _Reach, plane: Array, panel: str, colour: str) -> pd.DataFrame:
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
    points = _with_names(points)
    low, high = _box(points)
    panels = list(dict.fromkeys(points["panel"]))
    colours = list(dict.fromkeys(points.sort_values("colour", key=lambda c: c.map(_place_in(points)))["colour"]))
    columns = _columns(len(panels), high - low, size, height_mm)
    rows = -(-len(panels) // columns)
    letters = int((WIDTHS[size] - 8) / columns / 1.75)
    lines = max(wrapped(_level(name), letters).count("\n") + 1 for name in panels) if len(panels) > 1 else 0
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
            axes.set_title(wrapped(_level(panels[i]), letters), loc="center")
        if i % columns == 0:
            axes.set_ylabel(wrapped(f"{up} →", int(each / 1.6)), color=QUIET)
        if i == columns * (rows - 1):
            axes.set_xlabel(wrapped(f"{across} →", letters), color=QUIET, labelpad=2)
    _scale_bar(all_axes[0], bar_mm, low, high)
    if named:
        handles = [Line2D([], [], color=_HUES[i % 8], marker=MARKERS[i % 7], linewidth=0.8) for i in range(len(colours))]
        _legend(figure, handles, colours, "")
    return figure


def _with_names(points: pd.DataFrame) -> pd.DataFrame:
    """The points, with the empty name of an only panel or colour restored: a CSV file cannot tell it from a missing value."""
    return points.assign(colour=points["colour"].fillna("").astype(str), panel=points["panel"].fillna("").astype(str))


def _place_in(points: pd.DataFrame) -> dict[str, int]:
    """The colours, in the order in which they first appear in the panels."""
    order: list[str] = []
    for _, own in points.groupby("panel", sort=False):
        names = list(dict.fromkeys(own["colour"]))
        for i, name in enumerate(names):
            if name not in order:
                after = [order.index(other) + 1 for other in names[:i] if other in order]
                order.insert(max(after, default=0), name)
    return {name: i for i, name in enumerate(order)}


def _legend(figure: Figure, handles: list[Line2D], colours: list[str], title: str) -> None:
    """Draws a legend above all panels, with space for names of several lines."""
    names = [wrapped(_level(name), int(figure.get_figwidth() * 72 / 4.6) - 8) for name in colours]
    legend_above(figure, handles, names, title)
    more = sum(name.count("\n") for name in names) * 7 * 1.45 / (figure.get_figheight() * 72)
    engine = figure.get_layout_engine()
    left, bottom, width, height = engine.get()["rect"]
    engine.set(rect=(left, bottom, width, height - more))


def _level(name: Any) -> str:
    return "" if _none(name) else level(str(name))


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
                x, y, color=_HUES[i % 8], linewidth=0.5, alpha=0.75, marker=MARKERS[i % 7], markersize=1.8, markevery=ends,
                markeredgewidth=0,
            )  # fmt: skip


def _scale_bar(axes: Axes, bar_mm: float, low: Array, high: Array) -> None:
    x = low[0] + 0.04 * (high - low)[0]
    y = low[1] + 0.1 * float((high - low).max())
    axes.plot([x, x + bar_mm], [y, y], color="black", linewidth=1.5, solid_capstyle="butt")
    axes.annotate(f"{bar_mm:g} mm", (x, y), (0, -3), textcoords="offset points", ha="left", va="top")


# Speed


@of_data
def speed_profiles(data: Data, *, part: str = "") -> pd.DataFrame:
    """Speed against time from movement onset, from recordings: median and quartiles over reaches, every 5 ms.

    `part` selects one of an experiment's figures, if it has several. Columns: `panel`, `colour` (the condition; of
    more than seven, the distance of the target), `time_s`, `n` reaches of `of_n`, and `median_m_s`, `lower_m_s` and
    `upper_m_s`. Onset is defined as in docs/measures-of-behaviour.md; a time is included while three quarters of the reaches
    last. Raises NotThere, or Error without such recordings.

    A rehearsal has recordings only if it is made by `dh.rehearse(..., keep_recordings=True)`.
    """
    sheet = _sheet(data, part)
    every = _colours_of(data, [reach for own in sheet.panels.values() for reach in own], of_speed=True)
    colour_of = {id(reach): name for name, own in every.items() for reach in own}
    parts = []
    for panel, own in sheet.panels.items():
        for colour in every:
            some = [reach for reach in own if colour_of[id(reach)] == colour and len(reach.speed)]
            if some:
                curve = _quartiles([(reach.begins, reach.speed) for reach in some], "m_s")
                parts.append(pd.concat({(panel, colour): curve}, names=["panel", "colour"]).droplevel(2).reset_index())
    if not parts:
        raise error("has no reach with an onset", "Name sessions in which the hand moved.", file=str(data.folder))
    return pd.concat(parts, ignore_index=True)


def _quartiles(curves: list[tuple[float, Array]], unit: str) -> pd.DataFrame:
    """Median and quartiles of curves that begin at different times, while at least three quarters of them last."""
    first = min(round(begin / _STEP) for begin, _ in curves)
    length = max(round(begin / _STEP) - first + len(values) for begin, values in curves)
    table = np.full((len(curves), length), math.nan)
    for row, (begin, values) in zip(table, curves):
        place = round(begin / _STEP) - first
        row[place : place + len(values)] = values
    n = np.isfinite(table).sum(axis=0)
    kept = (n >= _LASTING * len(curves)) & (n > 0)
    lower, median, upper = np.nanpercentile(table[:, kept], [25, 50, 75], axis=0)
    return pd.DataFrame({
        "time_s": np.round(_STEP * (first + np.flatnonzero(kept)), 6), "n": n[kept], "of_n": len(curves),
        f"median_{unit}": median, f"lower_{unit}": lower, f"upper_{unit}": upper,
    })  # fmt: skip


def _time_panels(panels: list[str], size: str, height_mm: float, legend: bool) -> tuple[Figure, list[Axes], int]:
    """A figure with a panel for each name, all with the same limits, and the number of its columns."""
    most = 4 if size == "two columns" else 2
    rows = -(-len(panels) // most)
    columns = -(-len(panels) // rows)
    figure, all_axes = canvas(size, rows * height_mm + (6 if legend else 0), rows, columns, sharex=True, sharey=True)
    letters = int((WIDTHS[size] - 12) / columns / 1.7)
    narrow = letters < 36
    for i, axes in enumerate(all_axes):
        axes.set_visible(i < len(panels))
        if i < len(panels) and len(panels) > 1:
            axes.set_title(wrapped(_level(panels[i]), letters))
        if i < len(panels) and i + columns >= len(panels):
            axes.set_xlabel("time from onset [s]" if narrow else "time from movement onset [s]")
            axes.tick_params(axis="x", labelbottom=True)
        axes.locator_params(axis="x", nbins=4 if columns > 2 else 6)
    return figure, all_axes, columns


@drawing
def draw_speed_profiles(
    points: pd.DataFrame, *, size: str = "one column", height_mm: float = 50, legend: str = ""
) -> Figure:
    """Draws speed_profiles(): lines are medians, and bands extend from quartile to quartile (with four colours or fewer).

    `legend` is what the colours stand for, in words.
    """
    if points.empty:
        raise error("has no speed", "Draw a table of speed_profiles() with rows.", key="points")
    points = _with_names(points)
    panels = list(dict.fromkeys(points["panel"]))
    places = _place_in(points)
    colours = sorted(places, key=lambda name: places[name])
    figure, all_axes, columns = _time_panels(panels, size, height_mm, len(colours) > 1)
    for i, panel in enumerate(panels):
        own = points[points["panel"] == panel]
        for j, colour in enumerate(colours):
            curve = own[own["colour"] == colour]
            if curve.empty:
                continue
            all_axes[i].plot(curve["time_s"], curve["median_m_s"], color=_HUES[j % 8], linestyle=_DASHES[j % 7])
            if len(colours) <= 4:
                all_axes[i].fill_between(
                    curve["time_s"], curve["lower_m_s"], curve["upper_m_s"], color=_HUES[j % 8], alpha=0.2, linewidth=0
                )
        if i % columns == 0:
            all_axes[i].set_ylabel("speed [m/s]")
    all_axes[0].set_ylim(bottom=0)
    if len(colours) > 1:
        handles = [Line2D([], [], color=_HUES[j % 8], linestyle=_DASHES[j % 7]) for j in range(len(colours))]
        _legend(figure, handles, colours, legend)
    return figure


# Force on a channel


def _channel_stages(data: Data) -> dict[str, list[_Reach]]:
    """Reaches in channels by block; in perturbed blocks, at most eight in the first third and at most eight in the last."""
    kinds = {str(block.get("name")): str(block.get("kind", "")) for block in data.task.get("blocks") or []}
    with_force = [reach for reach in _reaches(data) if reach.force is not None]
    several = len({(reach.group, reach.round) for reach in with_force}) > 1
    blocks: dict[str, list[_Reach]] = {}
    for reach in sorted(with_force, key=lambda reach: reach.trial_num):
        part = [reach.group, reach.round, reach.block] if several else [reach.block]
        blocks.setdefault(", ".join(word for word in part if word), []).append(reach)
    out = {}
    for name, own in blocks.items():
        few = min(_FEW, _fewest(own) // 3)
        if kinds.get(own[0].block) in ("perturbed", "force_channel") and few > 0:
            what = "channel" if few == 1 else f"{few} channels"
            out[f"{name}, first {what}"] = _of_each(own, slice(None, few))
            out[f"{name}, last {what}"] = _of_each(own, slice(-few, None))
        else:
            out[name] = own
    return out


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
    for panel, own in _channel_stages(data).items():
        for name in ("on the channel", "ideal"):
            curves = [(r.begins, r.force if name == "on the channel" else r.ideal) for r in own]
            curve = _quartiles([(begins, values) for begins, values in curves if values is not None], "N")
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
    figure, all_axes, columns = _time_panels(panels, size, height_mm, True)
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


# Which figures a design calls for


def plans(data: Data) -> Iterator[Plan]:
    """Paths and speeds of recorded reaches, and their force on channels."""
    if not data.recorded or not (data.task.get("reach") or data.task.get("movement")):
        return
    for sheet in _sheets(data):
        reaches = [reach for own in sheet.panels.values() for reach in own]
        yield _plan_of_paths(data, sheet, reaches)
        if any(len(reach.speed) for reach in reaches):
            yield _plan_of_speed(data, sheet, reaches)
    stages = _channel_stages(data)
    if stages:
        yield _plan_of_channels(data, stages)


def _plan_of_sheet(sheet: _Sheet, name: str, title: str, caption: str, points: Any, drawing: Any, options: dict[str, Any]) -> Plan:
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


def _plan_of_paths(data: Data, sheet: _Sheet, reaches: list[_Reach]) -> Plan:
    colours = _colours_of(data, reaches)
    by_target = len({reach.condition for reach in reaches}) > _MOST_COLOURS
    right, up = _plane(reaches)
    widest = 1000 * max(float(np.ptp(reach.path @ np.array([right, up]).T, axis=0).max()) for reach in reaches)
    caption = "Paths of the hand in single reaches, to scale, until the state that ends them; small marks are their ends, circles are start "
    caption += "and target."
    if by_target and len(colours) > 1:
        caption += " Colours tell neighbouring targets apart."
    caption += _cut(sheet)
    options = {
        "across": _direction(right), "up": _direction(up), **({"legend": False} if by_target else {}),
        "bar_mm": 50 if widest > 150 else 20,
    }  # fmt: skip
    caption = f"{caption} {_counts(reaches)}"
    return _plan_of_sheet(sheet, "reach-paths", "Paths of reaches", caption, reach_paths, draw_reach_paths, options)


def _cut(sheet: _Sheet) -> str:
    """A sentence about panels in which not all paths are drawn."""
    many = {name: len(own) for name, own in sheet.panels.items() if len(own) > _MOST_PATHS}
    cut = [f"{_MOST_PATHS} of {count}" + (f' in "{name}"' if name else "") for name, count in many.items()]
    return f" The figure shows {', '.join(cut)}, spread evenly over conditions, people and trials." if cut else ""


def _counts(reaches: list[_Reach]) -> str:
    people = len({reach.person for reach in reaches})
    return (
        f"{counted(people, 'person', 'people')}, {counted(len(reaches), 'reach', 'reaches')}; practice, catch trials, clamps, "
        "channels, and repeated attempts are left out."
    )


def _plan_of_speed(data: Data, sheet: _Sheet, reaches: list[_Reach]) -> Plan:
    without = sum(not len(reach.speed) for reach in reaches)
    colours = _colours_of(data, [reach for reach in reaches if len(reach.speed)], of_speed=True)
    by_distance = len({reach.condition for reach in reaches}) > _MOST_COLOURS
    caption = "Speed from movement onset: medians over reaches"
    caption += ", with bands from quartile to quartile" if len(colours) <= 4 else ""
    caption += ", while at least three quarters of them last."
    if without:
        caption += f" {counted(without, 'reach', 'reaches')} without an onset {'is' if without == 1 else 'are'} left out."
    options = {"legend": "distance of the target"} if by_distance and len(colours) > 1 else {}
    caption = f"{caption} {_counts(reaches)}"
    return _plan_of_sheet(sheet, "reach-speed", "Speed of reaches", caption, speed_profiles, draw_speed_profiles, options)


def _plan_of_channels(data: Data, stages: dict[str, list[_Reach]]) -> Plan:
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
