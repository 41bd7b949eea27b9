"""Calibrates the rates at which simulated people learn rotations to groups of real people.

    >>> fit = dh.calibrate_population(["ours.csv", "theirs.csv"])      # doctest: +SKIP
    >>> fit.save("ours.yaml")                                           # doctest: +SKIP
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from ..errors import Error, error
from . import hierarchy
from .learner import TRAITS, Array, Group, Limits, learn, shares

__all__ = ["Calibration", "calibrate_population"]

#: Errors above which people learn hardly more, as in populations/adults.yaml, and what a fit is compared with.
LIMITS = Limits(20, 7)
STRUCTURES = {"no limits": Limits(), "the slow process limited": Limits(slow=LIMITS.slow), "both processes limited": LIMITS}
_FARTHEST = 90  # larger angles are reaches to a wrong target [degrees]
_OWN = {"id": "participant", "trial_num": "trial", "perturbation": "rotation_deg", "compensation": "compensation_deg"}
_NEEDED = ("participant", "trial", "rotation_deg", "compensation_deg")


def _text(value: float) -> str:
    return f"{value:.3g}"


@dataclass
class Calibration:
    """Rates of learning over people and laboratories, fitted to groups of people.

    >>> found = dh.calibrate_population(["ours.csv", "theirs.csv"])  # doctest: +SKIP
    >>> found.save("mine.yaml")  # doctest: +SKIP
    """

    groups: list[Group]
    fit: hierarchy.Fit

    @property
    def table(self) -> pd.DataFrame:
        """For each trait, `median` (a share), `spread` over people and `between_laboratories` (of its logit)."""
        of_people, between = np.sqrt(np.diag(self.fit.people)), np.sqrt(np.diag(self.fit.laboratories))
        rows = {"trait": TRAITS, "median": shares(self.fit.median), "spread": of_people, "between_laboratories": between}
        return pd.DataFrame(rows)

    def population(self) -> str:
        """The text of a population file, which is based on the shipped one."""
        names = ", ".join(f"{group.name} ({group.people})" for group in self.groups)
        lines = [f"# Rates of learning rotations, calibrated to {len(self.groups)} groups: {names}.",
                 "title: Calibrated adults", "based_on: populations/adults.yaml  # of the program", "traits:"]  # fmt: skip
        for row in self.table.itertuples():
            lines.append(f"  - {{ trait: {row.trait}, law: logit, median: {row.median:.5g}, spread: {_text(row.spread)}, "
                         f"between_laboratories: {_text(row.between_laboratories)}, source: calibrated }}")  # fmt: skip
        lines.append("correlations:")
        people, between = (_correlations(of) for of in (self.fit.people, self.fit.laboratories))
        for i in range(len(TRAITS)):
            for j in range(i):
                lines.append(f"  - {{ traits: [{TRAITS[j]}, {TRAITS[i]}], r: {people[i, j]:.2f}, "
                             f"between_laboratories: {between[i, j]:.2f} }}")  # fmt: skip
        return "\n".join(lines) + "\n"

    def save(self, file: str | os.PathLike[str]) -> Path:
        """Writes the population file. Raises Error if it cannot be written."""
        path = Path(file)
        try:
            path.write_text(self.population())
        except OSError as why:
            raise error(f"cannot be written: {why.strerror}", "Name another file.", file=str(path)) from None
        return path


def calibrate_population(
    files: Sequence[str | os.PathLike[str]], progress: Callable[[float], None] = lambda share: None, limits: Limits = LIMITS
) -> Calibration:
    """Fits rates to groups of people, each a CSV file: columns `participant`, `trial`, `rotation_deg`, `compensation_deg` (the
    hand's angle to the target, positive if it compensates) and, where they differ from trial to trial, `clamp` (1 if the
    cursor moves at that angle whatever the hand does) and `feedback` (`none` if no cursor was seen). The table adaptation.csv
    of `dihaptic collect` is read, too.

    Raises Error for fewer than two groups, for a file without these columns, and for a group without two people.

    >>> import dihaptic as dh
    >>> dh.calibrate_population(["ours.csv"])
    Traceback (most recent call last):
    ...
    dihaptic.errors.Error: ours.csv: error: is the only group. Name two or more: how laboratories differ is part of the fit.
    """
    if len(files) < 2:
        remedy = "Name two or more: how laboratories differ is part of the fit."
        raise error("is the only group", remedy, file=str(files[0]) if files else "")
    groups = [read_group(file) for file in files]
    return Calibration(groups, hierarchy.fit(groups, limits, progress))


def read_group(file: str | os.PathLike[str]) -> Group:
    """The reaches in one file, less each person's mean before the first perturbation."""
    path = Path(file)

    def wrong(what: str, remedy: str) -> Error:
        return error(what, remedy, file=str(path))

    try:
        table = pd.read_csv(path).rename(columns=lambda name: _OWN.get(name, name))
    except (OSError, ValueError) as why:
        raise wrong(f"cannot be read: {why}", "Name a CSV file of trials.") from None
    missing = [name for name in _NEEDED if name not in table.columns]
    if missing:
        raise wrong(f"has no column {missing[0]}", f"It needs {', '.join(_NEEDED)}.")
    if table.duplicated(["participant", "trial"]).any():
        raise wrong("has two rows for one trial of a person", "Number the trials of a person from 1 on.")

    def by_person(column: str) -> Array:
        try:
            values = table.assign(value=table[column].astype(float))
        except ValueError as why:
            raise wrong(f"has a column that is not numeric: {why}", "Leave values that are missing empty.") from None
        return np.asarray(values.pivot(index="participant", columns="trial", values="value"), dtype=float)

    if "clamp" not in table:
        table["clamp"] = 0
    table["unseen"] = (table.get("feedback", "") == "none") | (table.get("error_seen", "") == "no")
    hand = by_person("compensation_deg")
    rotation = np.nan_to_num(by_person("rotation_deg"))
    clamp = np.nan_to_num(by_person("clamp")) > 0
    seen = by_person("unseen") == 0  # NaN, which is a missing trial, is not seen either
    if len(hand) < 2:
        raise wrong("has fewer than two people", "How people differ is part of the fit.")
    hand[np.abs(hand) > _FARTHEST] = np.nan
    group = Group(path.stem, hand, rotation, clamp, seen)
    if not group.perturbed.any():
        raise wrong("has no rotation", "Give rotation_deg of each trial in degrees.")
    before = hand[:, : group.first_perturbed]
    if before.size:
        group.compensation = hand - np.nan_to_num(np.nanmean(before, 1))[:, None]
    return group


def leave_one_out(
    groups: list[Group], limits: Limits = LIMITS, laboratories: int = 400, seed: int = 1,
    progress: Callable[[float], None] = lambda share: None,
) -> pd.DataFrame:  # fmt: skip
    """Predicts each group from a fit to the others: for every eighth of its trials from the first perturbation on, the mean of
    the group's people (`real`), the median over laboratories (`median`), and the bounds of 50 and 90 % of laboratories
    (`low_50`, `high_50`, `low_90`, `high_90`), all in degrees."""
    out = []
    for index, left in enumerate(groups):
        progress(index / len(groups))
        found = hierarchy.fit([group for group in groups if group is not left], limits)
        drawn = _draw(found, left, limits, laboratories, seed)
        edges = np.linspace(left.first_perturbed, left.rotation.shape[1], 9).astype(int)
        for begin, end in zip(edges[:-1], edges[1:]):
            means = drawn[:, begin:end].mean(1)
            bounds = dict(zip(("low_90", "low_50", "median", "high_50", "high_90"), np.quantile(means, [0.05, 0.25, 0.5, 0.75, 0.95])))
            real = float(np.nanmean(left.compensation[:, begin:end]))
            out.append({"group": left.name, "first_trial": begin + 1, "last_trial": end, "real": real, **bounds})
    progress(1)
    return pd.DataFrame(out)


def _draw(found: hierarchy.Fit, group: Group, limits: Limits, laboratories: int, seed: int) -> Array:
    """Mean curves of as many people as the group has, a row for each laboratory [degrees]."""
    rng = np.random.default_rng(seed)

    def normal(*shape: int) -> Array:
        return np.clip(rng.normal(size=shape), -2.5, 2.5)  # as populations are drawn

    medians = found.median + normal(laboratories, 4) @ np.linalg.cholesky(found.laboratories + 1e-9 * np.eye(4)).T
    people = normal(laboratories, group.people, 4) @ np.linalg.cholesky(found.people).T + medians[:, None]
    count = laboratories * group.people
    one = Group(group.name, np.empty((count, 0)), *(np.broadcast_to(of[:1], (count, of.shape[1]))
                                                   for of in (group.rotation, group.clamp, group.seen)))  # fmt: skip
    curves = learn(people.reshape(-1, 4), np.full(count, float(np.median(found.noise))), one, limits)
    return np.asarray(curves.reshape(laboratories, group.people, -1).mean(1), dtype=float)


def _correlations(covariance: Array) -> Array:
    sd = np.sqrt(np.diag(covariance))
    return np.asarray(np.clip(covariance / np.outer(sd, sd), -0.99, 0.99), dtype=float)
