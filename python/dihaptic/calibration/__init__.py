"""Calibrates the rates at which simulated people learn rotations to groups of real people.

    >>> fit = dh.calibrate_population(["ours.csv", "theirs.csv"])      # doctest: +SKIP
    >>> fit.save("ours.yaml")                                           # doctest: +SKIP
"""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from ..errors import error
from ..program import check
from . import hierarchy
from .learner import TRAITS, Array, Group, Limits, learn, shares
from .reading import read_group

__all__ = ["Calibration", "calibrate_population"]

#: Errors above which people learn hardly more, as in populations/adults.yaml, and what a fit is compared with.
LIMITS = Limits(20, 7)
STRUCTURES = {"no limits": Limits(), "the slow process limited": Limits(slow=LIMITS.slow), "both processes limited": LIMITS}
#: Number of groups from which on they say how laboratories differ, as far as groups do.
ENOUGH_GROUPS = 5


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
    left_out: list[str]  #: sentences about people and reaches that were not used

    @property
    def warning(self) -> str:
        """What should be known about a fit to few groups; "" for one to many."""
        if len(self.groups) >= ENOUGH_GROUPS:
            return ""
        return (f"{len(self.groups)} groups hardly determine how laboratories differ: between_laboratories may be far from the truth. "
                f"Name {ENOUGH_GROUPS} groups or more, or rehearse without --laboratories.")  # fmt: skip

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
                 *([f"# Warning: {self.warning}"] if self.warning else []), "title: Calibrated adults", "based_on: populations/adults.yaml  # of the program", "traits:"]  # fmt: skip
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
        """Writes the population file, which must not exist. Raises Error if it cannot be written, or if the program would refuse
        it, as it refuses the rates of people who do not learn."""
        path, text = Path(file), self.population()
        _check(text)
        try:
            with open(path, "x", encoding="utf-8") as out:
                out.write(text)
        except FileExistsError:
            raise error("exists already", "Move it away, or name another file.", file=str(path)) from None
        except OSError as why:
            with contextlib.suppress(OSError):
                if path.is_file() and path.read_text(encoding="utf-8") != text:
                    path.unlink()  # half of it
            raise error(f"cannot be written: {why.strerror}", "Name another file.", file=str(path)) from None
        return path


def _check(text: str) -> None:
    """Raises Error if the program refuses this population."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "population.yaml")
        file.write_text(text, encoding="utf-8")
        problems = [problem for problem in check(file) if problem.severity == "error"]
    if problems:
        what = f"these groups give rates that are none of people: {problems[0].key}: {problems[0].what}"
        raise error(what, "Check the signs and units of rotation_deg and compensation_deg, and that people learned.")


def calibrate_population(
    files: Sequence[str | os.PathLike[str]], progress: Callable[[float], None] = lambda share: None, limits: Limits = LIMITS
) -> Calibration:
    """Fits rates to groups of people, each a CSV file: columns `participant`, `trial`, `rotation_deg`, `compensation_deg` (the
    hand's angle to the target, with the sign of the rotation that it cancels) and, where they differ from trial to trial, `clamp` (1 if the
    cursor moves at that angle whatever the hand does) and `feedback` (`none` if no cursor was seen, or else `cursor`). The table
    adaptation.csv of `dihaptic collect` is read, too. People with fewer than ten measured reaches after the first rotation, and
    reaches that went farther than 90 degrees astray, are left out (`left_out`).

    Raises Error for fewer than two groups, for a file that is named twice, for one whose columns, units or signs are wrong, and
    for a group without two people.

    >>> import dihaptic as dh
    >>> dh.calibrate_population(["ours.csv"])
    Traceback (most recent call last):
    ...
    dihaptic.errors.Error: ours.csv: error: is the only group. Name two or more: how laboratories differ is part of the fit.
    """
    if len(files) < 2:
        remedy = "Name two or more: how laboratories differ is part of the fit."
        raise error("is the only group", remedy, file=str(files[0]) if files else "")
    places = [os.path.realpath(os.fspath(file)) for file in files]
    for number, place in enumerate(places):
        if place in places[:number]:
            raise error("is named twice", "Name each group once.", file=str(files[number]))
    read = [read_group(file) for file in files]
    groups = [each.group for each in read]
    left_out = [f"{each.group.name}: left out {what}" for each in read for what in each.left_out]
    return Calibration(groups, hierarchy.fit(groups, limits, progress), left_out)


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
    trials = (count, group.rotation.shape[1])
    rotation, clamp = np.broadcast_to(group.rotation[:1], trials), np.broadcast_to(group.clamp[:1], trials)
    one = Group(group.name, np.empty((count, 0)), rotation, clamp, np.broadcast_to(group.seen[:1], trials))
    curves = learn(people.reshape(-1, 4), np.full(count, float(np.median(found.noise))), one, limits)
    return np.asarray(curves.reshape(laboratories, group.people, -1).mean(1), dtype=float)


def _correlations(covariance: Array) -> Array:
    """Correlations with two decimals, as far from 1 as the program demands of a matrix: of few groups, whose covariance is
    singular, they are drawn toward zero."""
    sd = np.sqrt(np.maximum(np.diag(covariance), 1e-12))
    raw = np.clip(covariance / np.outer(sd, sd), -0.99, 0.99)
    np.fill_diagonal(raw, 1)
    kept = 1.0
    while True:
        rounded = np.round(kept * raw + (1 - kept) * np.eye(len(raw)), 2)
        if np.linalg.eigvalsh(rounded)[0] > 0.01:
            return np.asarray(rounded, dtype=float)
        kept -= 0.01
