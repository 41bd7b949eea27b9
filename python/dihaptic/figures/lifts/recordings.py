"""Grip, load and height in the recordings of lifts, and their quartiles over lifts and people."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd

from ...session import Session
from ..data import Data

Array = npt.NDArray[Any]


def sampled(data: Data, frame: pd.DataFrame, times: Array) -> dict[str, Array]:
    """Grip force, load force and height around the times [s] of each lift; NaN beyond the lift's attempt.

    `times` and each array have the shape (lifts, times). The height is that of the lift's object above its place at touch.
    """
    out = {name: np.full(times.shape, np.nan) for name in ("grip force", "load force", "height")}
    objects = {c["name"]: c["object"] for c in data.task.get("conditions") or [] if c.get("object")}
    for number in sorted(frame["of"].unique()):
        session = data.recorded[number].session
        rows = np.flatnonzero(frame["of"] == number)
        own = frame.iloc[rows]
        at = _ticks(session, times[rows], own)
        for name, quantity in (("grip force", "grip_force"), ("load force", "load_force")):
            if quantity in session:
                out[name][rows] = _picked(session[quantity], at)
        bodies = own["condition"].map(objects).fillna(str(session.info.get("object", "")))
        touch = _ticks(session, own[["touch_s"]].to_numpy(), own)
        for body in bodies.unique():
            if f"{body}.position.z" in session:
                height = session[f"{body}.position.z"].astype(float) * 1000
                some = np.flatnonzero(bodies == body)
                out["height"][rows[some]] = _picked(height, at[some]) - _picked(height, touch[some])
    return out


def _ticks(session: Session, times: Array, lifts: pd.DataFrame) -> Array:
    """The tick at each time; -1 if the lift's attempt has none then."""
    t = session.t
    known = np.where(np.isfinite(times), times, -1e9)
    at = np.searchsorted(t, known - session.tick / 2)
    near = np.abs(t[np.minimum(at, len(t) - 1)] - known) <= 0.51 * session.tick
    within = (known >= lifts[["start_time"]].to_numpy() - 1e-9) & (known <= lifts[["stop_time"]].to_numpy() + 1e-9)
    return np.where(near & within, at, -1)


def _picked(values: Array, at: Array) -> Array:
    out: Array = values[np.maximum(at, 0)].astype(float)
    out[at < 0] = np.nan
    return out


def _quartiles(rows: Array) -> Array:
    """Lower quartile, median and upper quartile of each column; NaN where fewer than half of the rows are known."""
    out = np.full((3, rows.shape[1]), np.nan)
    known = np.isfinite(rows).sum(axis=0)
    enough = np.flatnonzero((known > 0) & (2 * known >= len(rows)))
    ordered = np.sort(rows, axis=0)  # unknown values are sorted last; this is much faster than nanpercentile
    for i, share in enumerate((0.25, 0.5, 0.75)):
        place = share * (known[enough] - 1)
        below = np.floor(place).astype(int)
        low, high = ordered[below, enough], ordered[np.ceil(place).astype(int), enough]
        out[i, enough] = low + (place - below) * (high - low)
    return out


def over_people(rows: Array, people: Array) -> Array:
    """Quartiles over the lifts of one person, or over the medians of several people."""
    names = list(dict.fromkeys(people))
    if len(names) == 1:
        return _quartiles(rows)
    return _quartiles(np.array([_quartiles(rows[people == name])[1] for name in names]))


def cells(frame: pd.DataFrame) -> Iterator[tuple[str, str, Array, int, int]]:
    """Panel, condition, rows, number of lifts and of people, in the order of panels and conditions."""
    for panel, case in dict.fromkeys(zip(frame["panel"], frame["case"])):
        rows = np.flatnonzero((frame["panel"] == panel) & (frame["case"] == case))
        yield panel, case, rows, len(rows), frame["person"].iloc[rows].nunique()
