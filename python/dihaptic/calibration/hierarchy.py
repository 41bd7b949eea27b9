"""Fits a hierarchy of trials, people and laboratories to groups of people, by the Laplace approximation.

    reach ~ N(learner(theta), s^2)      theta ~ N(m, P)      m ~ N(mu, L)

theta are the logits of one person's rates, m those of a laboratory's median person, mu those of a median laboratory. In turn,
each person's most likely theta is found for given m and P, by Levenberg's method, and m, P, mu and L are set to what is most
likely for these, as in the expectation-maximisation of a linear mixed model whose "data" are the thetas, with the inverse of
their curvature as variance.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .learner import Array, Group, Limits, learn

_START = np.array([0.4, -1.0, 6.0, -3.0])  # of mu: rates of Smith et al. (2006), about
_STEP = 1e-3  # of the derivatives
_ROUNDS = 20  # after which mu changes by less than 0.01


@dataclass
class Fit:
    """A fitted hierarchy. All values are logits, in the order of `learner.TRAITS`."""

    groups: Array  #: m, a row for each group
    people: Array  #: P, 4 x 4
    likelihood: float  #: the logarithm of the marginal likelihood of all reaches
    noise: Array  #: standard deviation of each person's reaches about the learner [degrees]

    @property
    def median(self) -> Array:
        """mu: the mean over the groups."""
        return np.asarray(self.groups.mean(0), dtype=float)

    @property
    def laboratories(self) -> Array:
        """The covariance of a further laboratory about the median one, 4 x 4: that of the groups, widened because there are
        few (by 1 + 1/k for their mean, and by the ratio of Student's t with k - 1 degrees of freedom to a normal distribution
        at 90 %, squared)."""
        from scipy import stats

        k = len(self.groups)
        widened = stats.t.ppf(0.95, k - 1) / stats.norm.ppf(0.95)
        return np.asarray(np.cov(self.groups.T) * (1 + 1 / k) * widened**2, dtype=float)


class _People:
    """The people of one group, as far as they are known."""

    def __init__(self, group: Group, limits: Limits) -> None:
        self.group, self.limits = group, limits
        self.theta = np.tile(_START, (group.people, 1))
        self.noise = np.full(group.people, 6.0)
        self.median = _START.copy()
        self.likelihood = -np.inf
        self.variance = np.zeros((group.people, 4, 4))

    def _residuals(self, theta: Array) -> Array:
        return self.group.compensation - learn(theta, self.noise, self.group, self.limits)

    def _cost(self, theta: Array, residuals: Array, precision: Array) -> Array:
        off = theta - self.median
        return np.asarray(np.nansum(residuals**2, 1) / self.noise**2 + np.einsum("ni,ij,nj->n", off, precision, off))

    def find(self, spread: Array) -> None:
        """Moves each person's theta toward the most likely one, and estimates its variance and the person's noise."""
        precision: Array = np.asarray(np.linalg.inv(spread), dtype=float)
        damping: Array = np.full(self.group.people, 1e-3)
        residuals = self._residuals(self.theta)
        cost = self._cost(self.theta, residuals, precision)
        for _ in range(4):
            beside = self._residuals(self.theta + _STEP * np.eye(4)[:, None])
            slope = np.moveaxis(np.nan_to_num((beside - residuals) / -_STEP), 0, -1)
            weight = 1 / self.noise**2
            curvature = np.einsum("n,ntk,ntl->nkl", weight, slope, slope) + precision
            pull = np.einsum("n,ntk,nt->nk", weight, slope, np.nan_to_num(residuals)) - (self.theta - self.median) @ precision
            damped = curvature + damping[:, None, None] * np.einsum("nkk->nk", curvature)[:, :, None] * np.eye(4)
            tried = self.theta + np.clip(np.linalg.solve(damped, pull[..., None])[..., 0], -1, 1)
            there = self._residuals(tried)
            lower = self._cost(tried, there, precision)
            better = lower < cost
            self.theta[better], residuals[better], cost[better] = tried[better], there[better], lower[better]
            damping = np.where(better, damping / 5, damping * 10)
        count = np.sum(~np.isnan(residuals), 1)
        self.noise = np.sqrt(np.nansum(residuals**2, 1) / count)
        self.variance = np.linalg.inv(curvature)
        determinants = np.linalg.slogdet(spread)[1] + np.linalg.slogdet(curvature)[1]
        self.likelihood = float(np.sum(-0.5 * (cost + 2 * count * np.log(self.noise) + determinants)))


def fit(groups: list[Group], limits: Limits, progress: Callable[[float], None] = lambda share: None) -> Fit:
    """Fits the hierarchy to groups, of which there must be two or more. `progress` is called with the share that is done."""
    everyone = [_People(group, limits) for group in groups]
    median, people, laboratories = _START.copy(), np.diag([0.5, 1.0, 2.0, 0.5]), np.diag([0.2, 0.5, 1.0, 0.2])
    for turn in range(_ROUNDS):
        scatter, uncertain = np.zeros((4, 4)), np.zeros((4, 4))
        for one in everyone:
            one.find(people)
            count = one.group.people
            of_all, of_people = np.linalg.inv(laboratories), np.linalg.inv(people)
            variance = np.linalg.inv(of_all + count * of_people)
            one.median = variance @ (of_all @ median + count * of_people @ one.theta.mean(0))
            off = one.theta - one.median
            scatter += off.T @ off + one.variance.sum(0) + count * variance
            uncertain += variance
        people = scatter / sum(one.group.people for one in everyone)
        medians = np.array([one.median for one in everyone])
        median = medians.mean(0)
        off = medians - median
        # few groups do not determine how their traits go together well enough to hold a group's people by it
        laboratories = np.diag(np.diag(off.T @ off + uncertain) / (len(everyone) - 1) + 1e-4)
        progress((turn + 1) / _ROUNDS)
    likelihood = sum(one.likelihood for one in everyone)
    return Fit(medians, people, likelihood, np.concatenate([one.noise for one in everyone]))
