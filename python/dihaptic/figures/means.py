"""Means over people, or over trials, with their intervals."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pandas as pd


#: Measures that cannot lie beyond these limits.
_LIMITS = {"adaptation_index_r2": (0.0, 1.0), "grip_load_r": (-1.0, 1.0), "safety_margin": (-math.inf, 1.0)}
#: How intervals were computed, in captions.
BY_T = " (Student's t)"


def intervals(counts: pd.Series, how: str = "") -> str:
    """Words for a caption about the intervals of means over these numbers of values: the mean of one value has no interval.

    >>> intervals(pd.Series([4, 4])), intervals(pd.Series([4, 1])), intervals(pd.Series([1, 1]))
    (' with 95 % intervals', ' with 95 % intervals where they are over several', ' (of one value each, so there is no interval)')
    """
    several = counts[counts > 0] > 1
    if not several.any():
        return " (of one value each, so there is no interval)"
    return f" with 95 % intervals{how}{'' if several.all() else ' where they are over several'}"


def within_limits(points: pd.DataFrame, measure: str) -> pd.DataFrame:
    """The points, with intervals that end where their measure does: Student's t knows nothing of limits.

    >>> within_limits(pd.DataFrame({"value": [0.9], "low": [0.7], "high": [1.1]}), "adaptation_index_r2").values.tolist()
    [[0.9, 0.7, 1.0]]
    """
    low, high = _LIMITS.get(measure, (-math.inf, math.inf))
    return points.assign(low=points["low"].clip(lower=low), high=points["high"].clip(upper=high))


def said_of_limits(measures: dict[str, str]) -> str:
    """A sentence for a caption on those measures, with their names in words, whose intervals may end at a limit."""
    names = [words for measure, words in measures.items() if measure in _LIMITS]
    return f" Intervals of {' and '.join(names)} are cut off at the limits of possible values." if names else ""


def means_with_intervals(each: pd.DataFrame, by: list[str], **options: Any) -> pd.DataFrame:
    """Means of the column `value` in each group, with their 95 % intervals by Student's t.

    A row has the columns `by`, value, n, low, high, and `of`, which is "mean". The ends are NaN where n is 1. `options` go
    to pandas' groupby(), such as sort=False.

    >>> each = pd.DataFrame({"x": [1, 1, 2], "value": [3.0, 5.0, 7.0]})
    >>> means_with_intervals(each, ["x"]).round(2).values.tolist()
    [[1, 4.0, 2, 'mean', -8.71, 16.71], [2, 7.0, 1, 'mean', nan, nan]]
    """
    mean = each.groupby(by, **options)["value"].agg(value="mean", n="count", sd="std").reset_index()
    factor = t_quantile(mean["n"].clip(lower=2) - 1, 0.975) if (mean["n"] > 1).any() else math.nan
    half = factor * mean["sd"] / np.sqrt(mean["n"])
    return mean.assign(of="mean", low=mean["value"] - half, high=mean["value"] + half).drop(columns="sd")


def t_quantile(freedom: Any, share: float) -> Any:
    """The value of Student's t with this many degrees of freedom below which this share of it lies.

    >>> float(t_quantile(4, 0.975).round(3))
    2.776
    """
    from scipy import special  # takes a tenth of a second, and a report on one person needs none of it

    return special.stdtrit(freedom, share)


def wilson(yes: Any, n: Any) -> tuple[Any, Any]:
    """Wilson's 95 % interval of a share: `yes` out of `n` (numbers, or arrays of one shape; n > 0).

    >>> low, high = wilson(8, 10)
    >>> float(round(low, 3)), float(round(high, 3))
    (0.49, 0.943)
    """
    from scipy import special

    z = special.ndtri(0.975)
    share = yes / n
    middle = (share + z**2 / (2 * n)) / (1 + z**2 / n)
    half = z / (1 + z**2 / n) * np.sqrt(share * (1 - share) / n + z**2 / (4 * n**2))
    return middle - half, middle + half
