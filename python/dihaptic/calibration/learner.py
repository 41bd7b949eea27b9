"""The learner whose rates are calibrated: two processes that learn hardly more from large errors than from small ones.

In trial n, with compensation x = fast + slow and perturbation f [degrees],

    e = f - x  (f in a clamp, 0 without feedback)      fast <- A_f fast + B_f l(e, l_f)      slow <- A_s slow + B_s l(e, l_s)

and l(e, l) = l tanh(e / l). The error that a person sees also has the noise of the reach, of standard deviation s, which
weakens a limited process: the mean of l tanh((e + n) / l) over a normal n is close to l tanh(e / l') with
l'^2 = l^2 + pi s^2 / 2, since tanh(u) is close to erf(sqrt(pi) u / 2).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: The traits of a population, in the order of the learner's parameters, each of which is the logit of a trait.
TRAITS = ("fast_retention", "fast_learning", "slow_retention", "slow_learning")


@dataclass
class Group:
    """The reaches of one group, i.e. of one laboratory: a row for each person, a column for each trial."""

    name: str
    compensation: Array  #: [degrees]; NaN where a trial is missing
    rotation: Array  #: of the cursor or, in a clamp, of the cursor's fixed direction [degrees]
    clamp: NDArray[np.bool_]
    seen: NDArray[np.bool_]  #: whether the person saw an error

    @property
    def people(self) -> int:
        """Number of people."""
        return len(self.compensation)

    @property
    def perturbed(self) -> NDArray[np.bool_]:
        """Whether each trial is perturbed for anybody."""
        return np.asarray(np.any((self.rotation != 0) | self.clamp, axis=0))

    @property
    def first_perturbed(self) -> int:
        """Index of the first such trial."""
        return int(np.argmax(self.perturbed))


@dataclass(frozen=True)
class Limits:
    """Errors above which the processes learn hardly more [degrees]; infinity for none."""

    fast: float = np.inf
    slow: float = np.inf


def shares(logits: Array) -> Array:
    """The traits of which these are the logits."""
    return np.asarray(1 / (1 + np.exp(-np.clip(logits, -40, 40))), dtype=float)


def _limited(error: Array, limit: float, weakened: Array) -> Array:
    return error if np.isinf(limit) else np.asarray(limit * np.tanh(error / weakened), dtype=float)


def learn(logits: Array, noise: Array, group: Group, limits: Limits) -> Array:
    """The compensation in each trial [degrees], without noise of its own: (..., people, trials) for `logits` of
    (..., people, 4). `noise`: the standard deviation of each person's reaches [degrees]."""
    keeps_fast, learns_fast, keeps_slow, learns_slow = np.moveaxis(shares(logits), -1, 0)
    weakened_fast, weakened_slow = (np.sqrt(limit**2 + np.pi / 2 * noise**2) for limit in (limits.fast, limits.slow))
    # a row for each trial, since these loops take most of a calibration's time
    shown, moved = (group.rotation * group.seen).T, (group.seen & ~group.clamp).T.astype(float)
    fast = slow = np.zeros(logits.shape[:-1])
    out = np.empty((group.rotation.shape[1], *fast.shape))
    for n in range(len(out)):
        out[n] = fast + slow
        error = shown[n] - moved[n] * out[n]
        fast = keeps_fast * fast + learns_fast * _limited(error, limits.fast, weakened_fast)
        slow = keeps_slow * slow + learns_slow * _limited(error, limits.slow, weakened_slow)
    return np.moveaxis(out, 0, -1)
