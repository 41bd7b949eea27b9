"""The effect of the previous weight on a lift."""

from __future__ import annotations

import numpy as np
import pandas as pd

from ..data import Data, sitting_columns

#: Minimum number of pairs of complete lifts, and minimum ratio of weights, to estimate the effect of the previous weight.
_LEAST_PAIRS, _LEAST_RATIO = 10, 1.05


def previous_weight(data: Data) -> pd.DataFrame:
    """The effect of the previous weight on a lift (Johansson and Westling 1988), for each person.

    The regression is rate = a + b W + c W_before, of the largest rate of load force before lift-off on the weights
    held, over consecutive complete lifts of a session. A row has the group, the person, `effect` (c, in N/s for each
    N), its standard `error`, `share` (c / (b + c): 0 if only the present weight matters, 1 if only the previous one does),
    and `n` pairs of lifts. People whose weights vary by less than 5 %, or who have fewer than ten pairs, have no row.

    >>> from dihaptic import figures
    >>> len(previous_weight(figures.read(lift_session)))
    0
    """
    columns = ["group", "person", "effect", "error", "share", "n"]
    if not data.has("lifts"):
        return pd.DataFrame(columns=columns)
    lifts = data.table("lifts")
    rows = []
    for (group, person), own in lifts.groupby(["group", "person"], sort=False):
        own = own.assign(known=(own["lift"] == "complete") & own[["static_load_N", "peak_load_rate_N_s"]].notna().all(axis=1))
        by = own.groupby(sitting_columns(own), sort=False, dropna=False)
        own = own.assign(before=by["static_load_N"].shift(), known_before=by["known"].shift(fill_value=False))
        pairs = own[own["known"] & own["known_before"]]
        n = len(pairs)
        weights = pairs["static_load_N"]
        if n < _LEAST_PAIRS or weights.max() < _LEAST_RATIO * weights.min():
            continue
        design = np.column_stack([np.ones(n), weights, pairs["before"]])
        rates = pairs["peak_load_rate_N_s"].to_numpy()
        b, _, rank, _ = np.linalg.lstsq(design, rates, rcond=None)
        if rank < 3:
            continue
        variance = float(np.sum((rates - design @ b) ** 2)) / (n - 3)
        error = np.sqrt(variance * np.linalg.inv(design.T @ design)[2, 2])
        rows.append([group, person, b[2], error, b[2] / (b[1] + b[2]), n])
    return pd.DataFrame(rows, columns=columns)
