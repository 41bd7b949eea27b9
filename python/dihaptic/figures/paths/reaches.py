"""Reads the reaches of recorded sessions: their paths, the speed from their onset, and the force on channels."""

from __future__ import annotations

import math
import re
import warnings
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from ...errors import Error
from ..data import Data
from ..sessions import Sitting

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]

#: Time between points of a curve [s], and time drawn before onset [s].
STEP = 0.005
_BEFORE = 0.1
#: A movement over a shorter distance is not a reach [m].
_LEAST_WAY = 0.02
#: Movement slower than this is tremor (docs/measures-of-behaviour.md) [m/s].
_LEAST_PEAK = 0.05


@dataclass(frozen=True)
class Reach:
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


def reaches_of(data: Data) -> list[Reach]:
    """The reaches of all recorded sessions, which are read only once."""
    cache: dict[str, Any] = data.__dict__
    if "_reaches" not in cache:
        found: list[Reach] = []
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

    def reaches(self) -> list[Reach]:
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
        self.position = self._recorded(points, "position")
        self.velocity = self._recorded(points, "velocity")
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

    def _force_sent(self, listed: pd.DataFrame, points: list[str]) -> list[Array] | None:
        """The forces on the hand's fingers; None unless channels hold it throughout its movement."""
        channels = "movement_channel" in listed and bool(listed["movement_channel"].eq(1).any())
        if not channels or not points[0].endswith(".handle_") or not self._walls_last():
            return None
        fingers = [point[: -len("handle_")] for point in points]
        return self._recorded(fingers, "force_sent")

    def _recorded(self, points: list[str], quantity: str) -> list[Array]:
        return [self.session[f"{point}{quantity}"] for point in points]

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

    def _reach(self, row: dict[str, Any], prefix: str) -> Reach | None:
        part = self._part(row)
        start, target = (_vector(row, f"{prefix}_{end}", "_mm") / 1000 for end in ("from", "to"))
        axis = _vector(row, f"{prefix}_axis")
        way = float(np.linalg.norm(target - start))
        if part is None or not way >= _LEAST_WAY:
            return None
        position, velocity = _mean(self.position, part), _mean(self.velocity, part)
        every = max(1, round(STEP / self.session.tick))
        path = position[::every]
        if not np.isfinite(path).all():
            return None
        along = np.asarray((target - start) / way, np.float64)
        channel = row.get("movement_channel") == 1
        speed = np.abs(velocity @ along) if channel else np.linalg.norm(velocity, axis=1)
        onset = _onset(speed, position, way, self.movement, self.session.tick)
        curves: dict[str, Any] = {}
        if onset is not None:
            first = max(onset % every, onset - every * round(_BEFORE / STEP))
            curves = {"begins": (first - onset) * self.session.tick, "speed": speed[first::every]}
            curves.update(self._forces(row, part, axis, along, velocity, slice(first, None, every)))
        text = {name: "" if is_none(row.get(name)) else str(row[name]) for name in ("round", "block", "kind", "condition")}
        return Reach(
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
        force = len(self.sent) * _mean(self.sent, part)
        return {"force": -(force @ left)[each], "ideal": -(velocity @ field_of.T @ left)[each]}

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


def _mean(points: list[Array], part: slice) -> Array:
    """The mean over points of what was recorded of each, for these ticks alone: a whole session has millions of them."""
    mean: Array = np.mean([point[part] for point in points], axis=0, dtype=float)
    return mean


def _words_in(value: Any) -> list[str]:
    return [str(item) for item in value] if isinstance(value, list) else [str(value)] if value else []


def is_none(value: Any) -> bool:
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
