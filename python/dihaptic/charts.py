"""Draws a session's quantities, in the style of the program's report."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from . import vocabulary
from ._facts import facts
from .errors import NotThere, error

if TYPE_CHECKING:
    import numpy.typing as npt
    from matplotlib.axes import Axes

    from .session import Session

#: Moments of a lift, and the columns of lifts.csv with their times.
_LIFT_MOMENTS = ["touch", "load_onset", "lift_off", "replacement", "release", "first_slip"]
#: The remedy for a damaged table.
_RESTORE = "Restore the table, or rebuild it from raw.log: dihaptic recover."
#: Quantities that have the same colour in all charts.
_COLOURS: dict[str, str] = facts()["colours"]
#: Colours for all others, and for figures, in the order in which they are used; they are distinct with any kind of : colour
#: vision (Okabe and Ito, 2008).
COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"]


def plot(
    session: Session,
    *names: str,
    align: str | None = None,
    before: float = 0.5,
    after: float = 1.5,
    by: str | None = None,
    axes: Axes | None = None,
) -> Axes:
    """Draws quantities of a session against time, and returns matplotlib's axes.

    Without `align`, draws the whole session. With it, draws each lift or trial from `before` [s] before to `after` [s]
    after one of its moments: a column of lifts.csv (`touch`, `load_onset`, `lift_off`, `replacement`, `release`,
    `first_slip`), or `start_time` or `stop_time` of trials.csv. Each is a thin line, their mean a thick one; `by`, a column
    such as "condition", makes a mean for each of its values. A vector has a line for each component. Raises NotThere or
    Error.

    >>> import dihaptic as dh
    >>> axes = dh.load(lift_session).plot("block.position.z", align="lift_off", before=0.2, after=0.4)
    >>> axes.get_ylabel()
    'block.position.z [m]'
    """
    if not names:
        raise error("no quantity is given", 'Name one, e.g. session.plot("grip_force").')
    if by is not None and align is None:
        raise error("requires an alignment", 'Add align="lift_off", or another moment.', key="by")
    if axes is None:
        try:
            import matplotlib.pyplot as plt
        except ImportError:
            raise ImportError("plot needs matplotlib: python3 -m pip install matplotlib.", name="matplotlib") from None

        _, axes = plt.subplots(figsize=(8, 4.5), layout="constrained")
    if align is None:
        for name, label, values in _curves(session, names):
            _line(axes, session.t, values, label, _colour(name, label, axes), 1.2)
        axes.set_xlabel("time [s]")
    else:
        moments = _moments(session, align, by)
        _aligned(axes, session, names, moments, before, after)
        axes.set_xlabel(f"time from {align.replace('_', '-')} [s]")
        axes.axvline(0, color="#999999", linewidth=0.8, zorder=0)
    _finish(axes, session, names)
    return axes


def _curves(session: Session, names: tuple[str, ...]) -> list[tuple[str, str, npt.NDArray[Any]]]:
    """For each number and each component: the quantity's name, the curve's label, and its values."""
    out = []
    for name in names:
        if name in vocabulary.lists():
            raise error("is a list, which has no curve", "Draw one of its columns with pandas.", key=name)
        values = session[name]
        if values.ndim == 1:
            out.append((name, name, values))
            continue
        for i, component in enumerate(vocabulary.quantity(name).components):
            out.append((name, f"{name}.{component}", values[:, i]))
    return out


def _moments(session: Session, align: str, by: str | None) -> list[tuple[str, float]]:
    """The group and the time of each lift or trial in which the moment happened [s]."""
    trials = session.trials
    if align in _LIFT_MOMENTS:
        table = _with_trials(session, session.lifts, trials)
        column = f"{align}_s"
    else:
        table, column = trials, align
    if column not in table or not pd.api.types.is_numeric_dtype(table[column]):
        raise NotThere(
            align,
            "is not a moment on which curves can be aligned",
            [*_LIFT_MOMENTS, "start_time", "stop_time"],
            f"Valid moments are {', '.join(_LIFT_MOMENTS)} and, for trials, start_time and stop_time.",
        )
    if by is not None and by not in table:
        raise NotThere(by, "is not a column of the trials", list(table.columns), "Session.trials lists the columns.")
    groups = table[by].fillna("none").astype(str) if by is not None else pd.Series("", index=table.index)
    found = [(g, float(t)) for g, t in zip(groups, table[column]) if np.isfinite(t)]
    if not found:
        raise error("does not occur in any trial of this session", "See session.lifts.", key=align)
    return found


def _with_trials(session: Session, lifts: pd.DataFrame, trials: pd.DataFrame) -> pd.DataFrame:
    """The lifts, with the columns of their trials. Raises Error when a table is damaged."""
    keys = ["trial_num", "attempt"] if "attempt" in trials else ["trial_num"]
    for name, table in (("trials", trials), ("lifts", lifts)):
        for key in keys:
            if key not in table or not pd.api.types.is_integer_dtype(table[key]):
                what = f"has a row without a whole number in its column {key}"
                raise error(what, _RESTORE, file=str(session.folder / f"{name}.csv"))
    if trials.duplicated(keys).any():
        raise error("lists an attempt twice", _RESTORE, file=str(session.folder / "trials.csv"))
    more = trials[[*keys, *trials.columns.difference(lifts.columns)]]
    return lifts.merge(more, on=keys, how="left")


def _aligned(
    axes: Axes,
    session: Session,
    names: tuple[str, ...],
    moments: list[tuple[str, float]],
    before: float,
    after: float,
) -> None:
    if not np.isfinite([before, after]).all():
        raise error(f"from -{before} to {after} s is not an interval", "Give finite times.", key="before, after")
    ticks = np.arange(-round(before / session.tick), round(after / session.tick) + 1)
    groups = sorted({group for group, _ in moments})
    for name, label, values in _curves(session, names):
        for group in groups:
            text = f"{label}, {group}" if group else label
            colour = _colour(name, label, axes) if len(groups) == 1 else _next_colour(axes)
            rows = [_cut(session, values, time, ticks) for g, time in moments if g == group]
            if len(rows) > 1:
                for row in rows:
                    axes.plot(ticks * session.tick, row, color=colour, linewidth=0.5, alpha=0.35)
            known = np.array(rows, dtype=float)
            with np.errstate(invalid="ignore"):
                count = np.isfinite(known).sum(axis=0)
                mean = np.where(count > 0, np.nansum(known, axis=0) / np.maximum(count, 1), np.nan)
            _line(axes, ticks * session.tick, mean, text, colour, 2.0)


def _cut(session: Session, values: npt.NDArray[Any], time: float, ticks: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """The values at these ticks around a time; NaN where the session has none."""
    at = int(np.searchsorted(session.t, time - session.tick / 2)) + ticks
    inside = (at >= 0) & (at < len(values))
    out = np.full(len(ticks), np.nan)
    out[inside] = values[at[inside]]
    return out


def _line(axes: Axes, x: Any, y: Any, label: str, colour: str, width: float) -> None:
    axes.plot(x, y, label=label, color=colour, linewidth=width)


def _next_colour(axes: Axes) -> str:
    named = [line for line in axes.get_lines() if not str(line.get_label()).startswith("_")]
    return COLOURS[len(named) % len(COLOURS)]


def _colour(name: str, label: str, axes: Axes) -> str:
    return _COLOURS.get(name, "") if label == name and name in _COLOURS else _next_colour(axes)


def _finish(axes: Axes, session: Session, names: tuple[str, ...]) -> None:
    units = {session.unit(name) for name in names}
    what = names[0] if len(names) == 1 else ""
    unit = units.pop() if len(units) == 1 else ""
    axes.set_ylabel(f"{what} [{unit}]".strip() if unit and unit != "1" else what)
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(color="#eeeeee", linewidth=0.8)
    axes.set_axisbelow(True)
    if len([line for line in axes.get_lines() if not str(line.get_label()).startswith("_")]) > 1:
        axes.legend(frameon=False, fontsize="small")
