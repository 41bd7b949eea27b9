"""Where a test's p value must lie for a study to find its effect: looks at the data while they come, and Bayes factors."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from scipy import integrate, optimize, stats

#: Scale of the Cauchy prior of the standardised effect, the default of most programs.
PRIOR_SCALE = math.sqrt(0.5)
#: Points of the grid on which the chances of a study that goes on are integrated: z is then right to 1e-4.
_GRID = 501


def effective_size(sizes: Sequence[int]) -> float:
    """The number of people in one sample, or n m / (n + m) of two: what the standard error of the effect depends on."""
    return float(sizes[0] if len(sizes) == 1 else sizes[0] * sizes[1] / (sizes[0] + sizes[1]))


def levels_of_looks(shares: Sequence[float], alpha: float) -> list[float]:
    """The two-sided p values below which a study ends at looks at these shares of its people, in rising order up to 1.

    Without an effect, the share `alpha` of such studies ends with one. The looks spend it as O'Brien and Fleming's do, whatever
    their number and times (Lan and DeMets 1983); the chance to get past each look is integrated over a grid (Armitage, McPherson
    and Rowe 1969). The statistic is taken as normal: in small samples its p value is compared instead, which is usual.

    >>> from dihaptic.power_analysis.evidence import levels_of_looks
    >>> [round(level, 4) for level in levels_of_looks([0.5, 1], 0.05)]
    [0.0031, 0.049]
    """
    spent = [4 * stats.norm.sf(stats.norm.isf(alpha / 4) / math.sqrt(share)) for share in shares]
    ends = [stats.norm.isf(spent[0] / 2)]  # of |z|, at which the study ends
    grid = np.linspace(-1, 1, _GRID) * ends[0] * math.sqrt(shares[0])
    density = stats.norm.pdf(grid, scale=math.sqrt(shares[0]))
    for k in range(1, len(shares)):
        step, chance = math.sqrt(shares[k] - shares[k - 1]), spent[k] - spent[k - 1]

        def excess(z: float) -> float:
            outside = stats.norm.sf((z * math.sqrt(shares[k]) - grid) / step)  # the lower side is as likely
            return 2 * float(integrate.trapezoid(density * outside, grid)) - float(chance)

        ends.append(float(optimize.brentq(excess, 0, 40, xtol=1e-10)))
        after = np.linspace(-1, 1, _GRID) * ends[-1] * math.sqrt(shares[k])
        density = integrate.trapezoid(density * stats.norm.pdf((after[:, None] - grid) / step) / step, grid, axis=1)
        grid = after
    return [float(2 * stats.norm.sf(z)) for z in ends]


def bayes_factor(t: float, sizes: Sequence[int]) -> float:
    """How many times as likely a t value is with an effect than without one, in one sample or two of these sizes.

    The prior of the standardised effect is a Cauchy distribution with the scale PRIOR_SCALE (Rouder et al. 2009, equation 1).
    Infinite where it is beyond the largest number.

    >>> from dihaptic.power_analysis.evidence import bayes_factor
    >>> round(bayes_factor(3.5, [20]), 2), round(bayes_factor(3.5, [20, 20]), 2)
    (17.18, 26.74)
    """
    with np.errstate(over="ignore"):
        return float(np.exp(_log_bayes_factor(t, sizes)))


def _log_bayes_factor(t: float, sizes: Sequence[int]) -> float:
    n, free = effective_size(sizes), sum(sizes) - len(sizes)
    log_g = np.linspace(-10, 80, 9001)  # g, the variance of the effect in units of its scale, has an inverse gamma distribution
    wide = 1 + n * PRIOR_SCALE**2 * np.exp(log_g)
    log_of = (free + 1) / 2 * (np.log1p(t * t / free) - np.log1p(t * t / (wide * free))) - 0.5 * np.log(wide)
    log_of -= 0.5 * (math.log(2 * math.pi) + log_g + np.exp(-log_g))
    most = float(log_of.max())  # the factor itself may be too large for a number
    return most + math.log(integrate.trapezoid(np.exp(log_of - most), log_g))


def levels_of_factor(factor: float, sizes: Sequence[int]) -> tuple[float, float]:
    """The two-sided p value of a t test below which the Bayes factor exceeds `factor`, and that above which it is less than
    1 / `factor`; the latter is 1 where samples are too small for that, and the former 0. The factor rises with |t|.

    >>> from dihaptic.power_analysis.evidence import levels_of_factor
    >>> [round(level, 4) for level in levels_of_factor(10, [20])]
    [0.0045, 1.0]
    """
    free = sum(sizes) - len(sizes)

    def p_where(wanted: float) -> float:
        def excess(t: float) -> float:
            return _log_bayes_factor(t, sizes) - math.log(wanted)

        if excess(0) >= 0:
            return 1.0
        end = 4.0
        while excess(end) < 0:
            end *= 2
            if end > 1e9:
                return 0.0
        return float(2 * stats.t.sf(optimize.brentq(excess, 0, end), free))

    return p_where(factor), p_where(1 / factor)
