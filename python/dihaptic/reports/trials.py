"""Chooses recorded trials that can be viewed on the page of a report."""

from __future__ import annotations

import base64
from dataclasses import dataclass
from itertools import groupby
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd

from .._facts import facts
from ..errors import Error
from ..figures.data import Data
from ..figures.sessions import Sitting
from ..figures.style import COLOURS
from ..session import Session

#: Number of points of a curve per second, and maximum of numbers on a page: a page of a few MB still opens at once.
_POINTS_PER_S = 100
_MOST_NUMBERS = 200_000
#: The longest recording without trials that is shown as one [s].
_LONGEST = 60.0
#: Only this much of a longer trial is shown [s].
_LONGEST_TRIAL = 30.0


@dataclass
class _Curve:
    """A curve of a strip: a quantity of the recording (the magnitude of a vector), multiplied by a scale."""

    name: str
    quantity: str
    colour: str
    scale: float = 1

    def of(self, session: Session, every: int) -> npt.NDArray[np.float32]:
        values = np.asarray(session[self.quantity])[::every]
        size = np.linalg.norm(values, axis=1) if values.ndim == 2 else values
        return np.asarray(self.scale * size, dtype="<f4")


@dataclass
class _Trial:
    sitting: Sitting
    name: str
    about: str
    start: float
    stop: float


def trials_to_look_at(data: Data) -> dict[str, Any]:
    """Trials of recorded sessions as page.js draws them, with the sentence `said` above them; {} without recordings.

    All trials if they are few, and otherwise a selection, evenly spaced over the sessions. Each quantity has a list of
    curves, and each trial their values at equal steps of time (float32, base64).
    """
    trials = [trial for sitting in data.recorded for trial in _trials_of(sitting)]
    if not trials:
        return {}
    strips = _strips(trials[0].sitting.session)
    curves = sum(len(curves) for _, _, curves in strips)
    numbers = [curves * _POINTS_PER_S * (trial.stop - trial.start) for trial in trials]
    share = min(1.0, _MOST_NUMBERS / max(1.0, sum(numbers)))
    chosen = [trials[i] for i in np.unique(np.linspace(0, len(trials) - 1, max(1, int(share * len(trials))), dtype=int))]
    shown = []
    for session, own in groupby(chosen, _session_of):
        try:
            shown += _shown(session, list(own), strips)
        except (Error, KeyError):  # the recording lacks something that the tables have, which the page reports elsewhere
            continue
    if not shown or not strips:
        return {}
    some = "The recorded trials" if len(shown) == len(trials) else f"{len(shown)} of {len(trials)} recorded trials, evenly spaced"
    return {
        "said": f"{some}, with {_POINTS_PER_S} points for each second; session.nwb has every tick.",
        "quantities": [
            {"name": name, "unit": unit, "curves": [{"name": curve.name, "colour": curve.colour} for curve in own]}
            for name, unit, own in strips
        ],
        "trials": shown,
    }


def _session_of(trial: _Trial) -> Session:
    return trial.sitting.session


def _trials_of(sitting: Sitting) -> list[_Trial]:
    session = sitting.session
    several = f"{sitting.person}, " if sitting.person else ""
    table = session.table("trials") if "trials" in session.tables else pd.DataFrame()
    if table.empty or "start_time" not in table:
        length = float(session.t[-1]) if len(session.t) else 0.0
        return [_Trial(sitting, f"{several}whole session", "", 0.0, length)] if 0 < length <= _LONGEST else []
    out = []
    for row in table.to_dict("records"):
        if not row["stop_time"] > row["start_time"]:
            continue
        words = [str(row[name]) for name in ("block", "condition", "perturbation", "outcome") if isinstance(row.get(name), str)]
        attempt = f", attempt {row['attempt']}" if row.get("attempt", 1) > 1 else ""
        stop = min(row["stop_time"], row["start_time"] + _LONGEST_TRIAL)
        name = f"{several}trial {row['trial_num']}{attempt}"
        out.append(_Trial(sitting, name, ", ".join(dict.fromkeys(words)), row["start_time"], stop))
    return out


def _strips(session: Session) -> list[tuple[str, str, list[_Curve]]]:
    """Quantities that are drawn one above another: name, unit, curves."""
    colours: dict[str, str] = facts()["colours"]
    forces = [
        _Curve(name, f"{name}_force", colours.get(name, COLOURS[i]))
        for i, name in enumerate(("grip", "load")) if f"{name}_force" in session
    ]  # fmt: skip
    fingers = list(enumerate(session.fingers))
    sent = [_Curve(f, f"{f}.force_sent", COLOURS[i % 7]) for i, f in fingers if f"{f}.force_sent" in session]
    speed = [_Curve(f, f"{f}.handle_velocity", COLOURS[i % 7]) for i, f in fingers if f"{f}.handle_velocity" in session]
    item = str(session.info.get("object") or "")
    height = [_Curve(item, f"{item}.position.z", COLOURS[2], 1000)] if f"{item}.position.z" in session else []
    strips = [("grip and load force", "N", forces if len(fingers) > 1 else []), ("force sent to each device", "N", sent)]
    strips += [("height of the object", "mm", height), ("speed of each finger", "m/s", speed)]
    return [strip for strip in strips if strip[2]]


def _shown(session: Session, trials: list[_Trial], strips: list[tuple[str, str, list[_Curve]]]) -> list[dict[str, Any]]:
    """These trials of a session, as page.js draws them."""
    every = max(1, round(1 / (_POINTS_PER_S * session.tick)))
    t = session.t[::every]
    parts = [slice(*np.searchsorted(t, [trial.start, trial.stop]) + [0, 1]) for trial in trials]
    strips_of_all = [[curve.of(session, every) for curve in curves] for _, _, curves in strips]
    phases = session.table("phases") if "phases" in session.tables else pd.DataFrame()
    if not {"start_time", "phase"} <= set(phases):
        phases = pd.DataFrame({"start_time": [], "phase": []})
    begins, names = phases["start_time"].to_numpy(float), phases["phase"].astype(str).to_numpy()
    return [
        {
            "name": trial.name, "about": trial.about, "seconds": round(trial.stop - trial.start, 3),
            "marks": _marks(begins, names, trial), "values": [[_packed(curve[part]) for curve in curves] for curves in strips_of_all],
        }
        for trial, part in zip(trials, parts)
    ]  # fmt: skip


def _packed(values: npt.NDArray[np.float32]) -> str:
    return base64.b64encode(values.tobytes()).decode()


def _marks(begins: npt.NDArray[np.float64], names: npt.NDArray[np.object_], trial: _Trial) -> list[dict[str, Any]]:
    """The phases that begin within a trial; `begins`: when each phase begins [s]."""
    own = np.flatnonzero((begins >= trial.start) & (begins < trial.stop))
    return [{"t": round(float(begins[i]) - trial.start, 3), "name": names[i]} for i in own]
