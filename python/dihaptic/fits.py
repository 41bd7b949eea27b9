"""Fits models to people's data: makes the fits of the program's report available for your own arrays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from . import _native
from .errors import error

Numbers = Union[Sequence[float], npt.NDArray[Any]]
Interval = tuple[float, float]


@dataclass(frozen=True)
class Fit:
    """The base class of fits of a curve."""

    predicted: npt.NDArray[np.float64] = field(repr=False)  #: values predicted for each trial, measured or not
    residual_sd: float  #: standard deviation of the residuals, with n - p in the denominator
    sse: float  #: sum of squared residuals
    n: int  #: number of measured trials
    intervals: dict[str, Interval] = field(repr=False)  #: 95 % profile intervals, by parameter


@dataclass(frozen=True)
class TwoRateFit(Fit):
    """The two-rate model of Smith, Ghazizadeh and Shadmehr (2006); see fit_two_rate().

    >>> import dihaptic as dh
    >>> sorted(dh.TwoRateFit.__dataclass_fields__)[:2]
    ['intervals', 'learning_fast']
    """

    retention_slow: float
    learning_slow: float
    retention_fast: float
    learning_fast: float


@dataclass(frozen=True)
class SingleRateFit(Fit):
    """One process that retains and learns; see fit_single_rate().

    >>> import dihaptic as dh
    >>> "retention" in dh.SingleRateFit.__dataclass_fields__
    True
    """

    retention: float
    learning: float


@dataclass(frozen=True)
class LearningCurveFit(Fit):
    """An exponential from a start to an asymptote; see fit_learning_curve().

    >>> import dihaptic as dh
    >>> "time_constant" in dh.LearningCurveFit.__dataclass_fields__
    True
    """

    start: float
    asymptote: float
    time_constant: float  #: [trials]


@dataclass(frozen=True)
class PsychometricFit:
    """The share of "yes" as a function of the level; see fit_psychometric().

    >>> import dihaptic as dh
    >>> fit = dh.fit_psychometric([1, 2, 3, 4], yes=[1, 3, 8, 10], trials=[10, 10, 10, 10], guess=0)
    >>> bool(abs(fit.probability(fit.threshold) - (1 - fit.lapse) / 2) < 1e-9)
    True
    """

    sigmoid: str
    threshold: float  #: level at which the sigmoid itself is one half (normal, logistic), or 1 - 1/e (weibull)
    shape: float  #: the normal's standard deviation, the logistic's scale, the Weibull's exponent
    guess: float
    lapse: float
    deviance: float  #: twice the log likelihood lost against the model with each level's own share
    shape_unknown: bool  #: whether the answers leave the shape undetermined, and so meaningless
    intervals: dict[str, Interval]  #: 95 % profile intervals, by parameter

    def probability(self, level: float | Numbers) -> Any:
        """Probability of "yes" at a level, or at each of an array of levels."""
        function = (self.sigmoid, self.threshold, self.shape, self.guess, self.lapse)
        each = np.vectorize(lambda x: _native.psychometric(*function, float(x)), otypes=[float])
        return each(level)


def fit_two_rate(
    compensation: Numbers, perturbation: Numbers, clamp: Sequence[bool] | npt.NDArray[Any] | None = None
) -> TwoRateFit:
    """Fits the two-rate model: a slow and a fast process that learn from the same error.

    `compensation`: the compensation in each trial, NaN if not measured; `perturbation`: the perturbation that acted, in
    the same unit and with the sign of the compensation; `clamp`: true if no error was shown, whatever the person did.
    The least sum of squares is the global one within
    0 <= A_fast <= A_slow <= 1, 0 <= B_slow <= B_fast <= 1. Raises Error for fewer than five measured
    trials, or arrays of different lengths.

    >>> import dihaptic as dh
    >>> import numpy as np
    >>> slow = fast = 0.0
    >>> seen = []
    >>> for trial in range(100):
    ...     seen.append(slow + fast)
    ...     error = 30 - slow - fast
    ...     slow, fast = 0.99 * slow + 0.03 * error, 0.6 * fast + 0.2 * error
    >>> fit = dh.fit_two_rate(seen, np.full(100, 30.0))
    >>> round(fit.retention_slow, 3), round(fit.learning_fast, 3)
    (0.99, 0.2)
    """
    return TwoRateFit(**_native.fit_two_rate(*_trials(compensation, perturbation, clamp)))


def fit_single_rate(
    compensation: Numbers, perturbation: Numbers, clamp: Sequence[bool] | npt.NDArray[Any] | None = None
) -> SingleRateFit:
    """Fits a single process that retains and learns. The arguments are those of fit_two_rate().

    >>> import dihaptic as dh
    >>> import numpy as np
    >>> state, seen = 0.0, []
    >>> for trial in range(60):
    ...     seen.append(state)
    ...     state = 0.95 * state + 0.1 * (30 - state)
    >>> fit = dh.fit_single_rate(seen, np.full(60, 30.0))
    >>> round(fit.retention, 3), round(fit.learning, 3)
    (0.95, 0.1)
    """
    return SingleRateFit(**_native.fit_single_rate(*_trials(compensation, perturbation, clamp)))


def fit_learning_curve(measured: Numbers) -> LearningCurveFit:
    """Fits an exponential, start + (asymptote - start) (1 - exp(-trial / time_constant)).

    NaN: not measured in that trial. Raises Error for fewer than four measured trials.

    >>> import dihaptic as dh
    >>> import numpy as np
    >>> fit = dh.fit_learning_curve(20 - 18 * np.exp(-np.arange(80) / 12))
    >>> round(fit.asymptote, 3), round(fit.time_constant, 3)
    (20.0, 12.0)
    """
    return LearningCurveFit(**_native.fit_learning_curve(_floats(measured)))


def fit_psychometric(
    levels: Numbers,
    answers: Sequence[bool] | npt.NDArray[Any] | None = None,
    *,
    yes: Sequence[int] | npt.NDArray[Any] | None = None,
    trials: Sequence[int] | npt.NDArray[Any] | None = None,
    sigmoid: str = "normal",
    guess: float | str = 0.5,
    max_lapse: float = 0.05,
    shape: float | None = None,
) -> PsychometricFit:
    """Fits the psychometric function that makes the answers most likely.

    Either `answers` has one answer for each of `levels`, or `yes` and `trials` count them by level.
    `sigmoid`: normal, logistic or weibull. `guess`: the share of "yes" by guessing, or "lapse" for "more or less?"
    questions, where it equals the lapse rate. The lapse rate is fitted between 0 and `max_lapse`. `shape`: the known shape;
    required after an adaptive procedure, whose levels make the function look steeper than it is. Raises Error for fewer than
    two levels and for impossible counts.

    >>> import dihaptic as dh
    >>> fit = dh.fit_psychometric([1, 2, 3, 4, 5], yes=[0, 1, 5, 9, 10], trials=[10] * 5, guess=0)
    >>> round(fit.threshold, 2)
    3.0
    """
    if answers is not None:
        counts = _native.count_answers(_floats(levels), _truths(answers, "answers"))
    elif yes is None or trials is None:
        raise error("there are no answers", "Give answers, or yes and trials.")
    elif not len(levels) == len(yes) == len(trials):
        raise error("levels, yes and trials have different lengths", "Give one of each per level.")
    else:
        counts = list(zip(_floats(levels), _wholes(yes, "yes"), _wholes(trials, "trials")))
    return PsychometricFit(**_native.fit_psychometric(counts, sigmoid, guess, max_lapse, shape))


def _floats(values: Numbers) -> list[float]:
    out = [float(value) for value in values]
    if any(np.isinf(value) for value in out):
        raise error("a value is infinite", "Give NaN if nothing was measured.")
    return out


def _wholes(values: Sequence[int] | npt.NDArray[Any], key: str) -> list[int]:
    if any(value != int(value) for value in values):
        raise error("has a number that is not whole", "Give counts.", key=key)
    return [int(value) for value in values]


_WORDS = {"yes": True, "1": True, "True": True, "no": False, "0": False, "False": False}


def _truths(values: Sequence[Any] | npt.NDArray[Any], key: str) -> list[bool]:
    """Truth values from bools, from 0 and 1, and from yes and no, as in tables."""
    words = [str(value.item() if isinstance(value, np.generic) else value).removesuffix(".0") for value in values]
    for word in words:
        if word not in _WORDS:
            raise error(f"has '{word}'", "Give True or False, 1 or 0, yes or no.", key=key)
    return [_WORDS[word] for word in words]


def _trials(
    compensation: Numbers, perturbation: Numbers, clamp: Sequence[bool] | npt.NDArray[Any] | None
) -> tuple[list[float], list[float], list[bool]]:
    perturbed = _floats(perturbation)
    clamped = [False] * len(perturbed) if clamp is None else _truths(clamp, "clamp")
    return _floats(compensation), perturbed, clamped
