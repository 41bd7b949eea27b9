"""Finds the events and figures of a grip-lift in forces and heights from any source."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _native
from .errors import error


def find_lift(
    grip: npt.ArrayLike,
    load: npt.ArrayLike,
    height: npt.ArrayLike,
    tick: float,
    friction: Sequence[float] | float = 1.0,
) -> dict[str, Any]:
    """The figures of one lift, with the names and units of lifts.csv (docs/tables.md).

    `grip` and `load` are each digit's normal force and upward tangential force on the object [N]: one row per sample,
    one column per digit. `height` is the object's [m], initially at rest; `tick` the time
    between samples [s]; `friction` the coefficient of the object with each digit, for the safety
    margin. Times are in seconds from the first sample. The events are found from the forces alone,
    by the rules of src/analysis/lifts.h: they differ by tens of milliseconds from those of a session of the program,
    which knows its contacts. Figures whose events did not happen are NaN.
    Raises Error when the arrays do not match.

    >>> import dihaptic as dh
    >>> import numpy as np
    >>> t = np.arange(0, 4, 0.001)
    >>> ramp = lambda begin, end: np.clip((t - begin) / (end - begin), 0, 1)
    >>> grip = np.repeat((6 * ramp(0.5, 0.9) * ramp(3.8, 3.4))[:, None], 2, axis=1)
    >>> load = np.repeat((1.5 * ramp(0.6, 0.9) * ramp(3.3, 3.1))[:, None], 2, axis=1)
    >>> lift = dh.find_lift(grip, load, 0.05 * ramp(0.9, 1.4) * ramp(3.1, 2.6), 0.001)
    >>> round(lift["static_grip_N"], 3), round(lift["height_mm"], 3)
    (6.0, 50.0)
    """
    forces = np.asarray(grip, dtype=float)
    if forces.ndim != 2:
        raise error("grip has no columns", "Give one row per sample and one column per digit.")
    each = [float(of_one) for of_one in np.broadcast_to(np.asarray(friction, dtype=float), forces.shape[1:])]
    figures: dict[str, Any] = _native.find_lift(
        forces, np.asarray(load, dtype=float), np.asarray(height, dtype=float), tick, each
    )
    for of_a_session in ("trial_num", "attempt"):
        del figures[of_a_session]
    return figures
