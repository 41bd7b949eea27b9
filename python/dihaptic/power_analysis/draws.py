"""Draws samples of people from a pool, tests each, and counts how often the test finds the effect."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy import stats

from ..errors import NotThere
from ..figures.psychophysics import wilson

Array = npt.NDArray[np.float64]
#: Samples are drawn in portions of this many, which saves memory.
_PORTION = 2000


@dataclass(frozen=True)
class Found:
    """The results of the samples of one size."""

    draws: int
    power: float  #: share of samples whose test is significant
    low: float  #: 95 % interval of the power (Wilson), from the number of samples
    high: float
    wrong_sign: float  #: type S error: share of the significant estimates that have the wrong sign; NaN: none is significant
    exaggeration: float  #: type M error: mean size of the significant estimates, relative to the size of the effect
    untested: float  #: share of samples that cannot be tested, e.g. because all people are alike; they find no effect
    half_width: float  #: median half width of the test's confidence interval; NaN for ranks
    for_none: float  #: share of samples that show that there is no effect; only Bayes factors can


@dataclass(frozen=True)
class Look:
    """The results of one look at samples that grow from look to look, and end at the first that finds the effect."""

    found: float  #: share of samples that have found it here or before
    for_none: float  #: share of samples that have ended here or before because they show that there is no effect
    exaggeration: float  #: type M error of those that find it here; NaN: there are none


def _within_t(x: Array, _: Array | None, alternative: str) -> Array:
    return np.asarray(stats.ttest_1samp(x, 0, axis=0, alternative=alternative).pvalue)


def _within_ranks(x: Array, _: Array | None, alternative: str) -> Array:
    return np.asarray(stats.wilcoxon(x, axis=0, zero_method="zsplit", alternative=alternative).pvalue)


def _between_t(x: Array, y: Array | None, alternative: str) -> Array:
    return np.asarray(stats.ttest_ind(x, y, axis=0, alternative=alternative).pvalue)


def _between_welch(x: Array, y: Array | None, alternative: str) -> Array:
    return np.asarray(stats.ttest_ind(x, y, axis=0, equal_var=False, alternative=alternative).pvalue)


def _between_ranks(x: Array, y: Array | None, alternative: str) -> Array:
    return np.asarray(stats.mannwhitneyu(x, y, axis=0, method="asymptotic", alternative=alternative).pvalue)


Test = Callable[[Array, Any, str], Array]
#: What a test may look for: any effect, or one above or below zero.
ALTERNATIVES = ("two-sided", "greater", "less")
#: Tests by name, for a value of each person that is compared with zero, and for two groups of people. A Bayes factor is that of
#: a t test, whose p value tells it (evidence.levels_of_factor).
WITHIN: dict[str, Test] = {"t": _within_t, "wilcoxon": _within_ranks, "bayes": _within_t}
BETWEEN: dict[str, Test] = {
    "welch": _between_welch, "t": _between_t, "wilcoxon": _between_ranks, "bayes": _between_t,
}  # fmt: skip


def test_named(name: str, between: bool) -> tuple[str, Test]:
    """A test and its name; "" selects the usual one: t within people, and Welch's between groups. Raises NotThere."""
    known = BETWEEN if between else WITHIN
    name = name or next(iter(known))
    if name not in known:
        of = "two groups" if between else "one value of each person"
        raise NotThere(name, f"is not a test of {of}", list(known), f"There are {', '.join(known)}.")
    return name, known[name]


def find_effect(
    pool: list[Array], sizes: list[int], draws: int, test: str, alpha: float, seed: int, spread: float = 1,
    levels: tuple[float, float] | None = None, alternative: str = "two-sided",
) -> Found:  # fmt: skip
    """Draws samples with replacement from a pool, and tests each of them.

    `pool` has the values of all people, or of those of two groups; `sizes` are the numbers of people in a sample, one
    for each. `spread` multiplies the deviations of people from the mean of their group. `levels` are the p value below which
    a sample finds the effect, and that above which it shows that there is none; without them, `alpha` is the first.
    `alternative` is one of ALTERNATIVES. The same seed gives the same samples, and a larger sample contains the people of a
    smaller one, so that curves over n are smooth.
    """
    pool = [values.mean() + spread * (values - values.mean()) for values in pool]
    true = pool[0].mean() - (pool[1].mean() if len(pool) == 2 else 0)
    p, estimates, halves = _test_samples(pool, sizes, draws, test, alpha, seed, alternative)
    below, above = levels or (alpha, np.inf)
    is_found = p < below  # excludes samples without a p
    found = estimates[is_found]
    low, high = wilson(is_found.sum(), draws)
    return Found(
        draws=draws,
        power=float(is_found.mean()),
        low=float(low),
        high=float(high),
        wrong_sign=float((found * true < 0).mean()) if len(found) and true != 0 else float("nan"),
        exaggeration=_exaggeration(found, true),
        untested=float(np.isnan(p).mean()),
        half_width=float(np.nanmedian(halves)) if len(halves) else float("nan"),
        for_none=float((p > above).mean()),
    )


def look_repeatedly(
    pool: list[Array], sizes: list[list[int]], draws: int, test: str, levels: list[tuple[float, float]], seed: int,
    alternative: str = "two-sided",
) -> list[Look]:  # fmt: skip
    """Draws samples that grow to these sizes, from the smallest to the largest, and tests each at every size.

    A sample ends at the first test whose p value is below the first of its `levels`, which finds the effect, or above the
    second, which shows that there is none. The arguments are those of find_effect(), with a list entry for each look.
    """
    true = pool[0].mean() - (pool[1].mean() if len(pool) == 2 else 0)
    goes_on = np.ones(draws, dtype=bool)
    looks, found, none = [], 0.0, 0.0
    for own, (below, above) in zip(sizes, levels):
        p, estimates, _ = _test_samples(pool, own, draws, test, 0.05, seed, alternative)
        finds, shows_none = goes_on & (p < below), goes_on & (p > above)
        found, none = found + float(finds.mean()), none + float(shows_none.mean())
        looks.append(Look(found, none, _exaggeration(estimates[finds], true)))
        goes_on &= ~(finds | shows_none)
    return looks


def _exaggeration(estimates: Array, true: float) -> float:
    return float(np.abs(estimates).mean() / abs(true)) if len(estimates) and true != 0 else float("nan")


def _test_samples(
    pool: list[Array], sizes: list[int], draws: int, test: str, alpha: float, seed: int, alternative: str
) -> tuple[Array, Array, Array]:
    """The p value of each sample (NaN for one that cannot be tested), its estimate, and half the width of its confidence
    interval, for tests that have one. A one-sided test at `alpha` belongs to the interval with 2 alpha outside."""
    outside = alpha if alternative == "two-sided" else 2 * alpha
    _, p_of = test_named(test, len(pool) == 2)
    p, estimates, halves = [], [], []
    for first in range(0, draws, _PORTION):
        some = min(_PORTION, draws - first)
        samples = []  # a row for each person, a column for each sample
        for side, (values, n) in enumerate(zip(pool, sizes)):
            rng = np.random.default_rng([seed, side, first])
            samples.append(values[rng.integers(0, len(values), (n, some))])
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")  # a sample that repeats the same person cannot be tested
            some_p = p_of(samples[0], samples[1] if len(samples) == 2 else None, alternative)
        if test != "wilcoxon":  # values that scatter by less than their rounding errors have no t
            scatter, size = np.sum([s.std(0) for s in samples], 0), np.sum([np.abs(s).max(0) for s in samples], 0)
            some_p = np.where(scatter > 1e-9 * size, some_p, np.nan)
        p.append(some_p)
        estimates.append(samples[0].mean(0) - (samples[1].mean(0) if len(samples) == 2 else 0))
        if test != "wilcoxon":
            halves.append(half_width(samples, test, outside))
    return np.concatenate(p), np.concatenate(estimates), np.concatenate(halves) if halves else np.empty(0)


def half_width(samples: list[Array], test: str, alpha: float) -> Array:
    """Half the width of the confidence interval of each sample's estimate, by "t" or "welch". A sample is a column."""
    n = [len(sample) for sample in samples]
    variances = [sample.var(0, ddof=1) for sample in samples]
    if len(samples) == 1:
        return np.asarray(stats.t.ppf(1 - alpha / 2, n[0] - 1) * np.sqrt(variances[0] / n[0]))
    if test != "welch":
        free = n[0] + n[1] - 2
        pooled = ((n[0] - 1) * variances[0] + (n[1] - 1) * variances[1]) / free
        return np.asarray(stats.t.ppf(1 - alpha / 2, free) * np.sqrt(pooled * (1 / n[0] + 1 / n[1])))
    parts = [variance / size for variance, size in zip(variances, n)]
    with np.errstate(all="ignore"):
        free = (parts[0] + parts[1]) ** 2 / (parts[0] ** 2 / (n[0] - 1) + parts[1] ** 2 / (n[1] - 1))
    return np.asarray(stats.t.ppf(1 - alpha / 2, free) * np.sqrt(parts[0] + parts[1]))


def smallest_size(
    power_at: Callable[[int], Found], wanted: float, most: int, least: int = 3
) -> tuple[int | None, int | None, int | None]:
    """The smallest n at which the power reaches the wanted value, and those at which the ends of its interval do.

    Of these two, the first may be enough (upper end), and the second is probably enough (lower end). None stands for more
    than `most`.
    """
    return (
        _first(lambda n: power_at(n).power >= wanted, least, most),
        _first(lambda n: power_at(n).high >= wanted, least, most),
        _first(lambda n: power_at(n).low >= wanted, least, most),
    )


def _first(is_enough: Callable[[int], bool], least: int, most: int) -> int | None:
    """The smallest n, starting from `least`, that is enough, given that all larger ones are."""
    below, n = least - 1, least
    while not is_enough(n):
        if n >= most:
            return None
        below, n = n, min(most, max(n + 1, int(n * 1.5)))
    while n - below > 1:
        middle = (below + n) // 2
        below, n = (below, middle) if is_enough(middle) else (middle, n)
    return n
