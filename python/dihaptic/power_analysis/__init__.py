"""Statistical power of an experiment, from simulated people who do the very file that will be run.

    import dihaptic as dh

    result = dh.power("experiments/size-weight.yaml",
                      "mean(peak_grip_rate_N_s, condition=large) - mean(peak_grip_rate_N_s, condition=small)",
                      n=[8, 12, 16, 24])
    result.table            # power, its interval, errors of sign and size, by the number of people
    result.save("power")    # a page for a preregistration, the figure, the tables

A pool of people is simulated once. Samples are drawn from it with replacement, and each is tested.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import NotThere, error
from ..program import call
from ..rehearsing import rehearse
from ..study import is_study
from ..tables import command_of

if TYPE_CHECKING:
    from ..figures.data import Data
    from .effect import Effect
    from .result import Power

#: Largest number of people in a sample.
_MOST_PEOPLE = 10_000
#: Tables that a report makes for each session.
_REPORTED = ["fits", "adaptation", "thresholds"]
#: Smallest number of people in a pool, or in one of its groups, from which samples are drawn.
_LEAST = 10


def power(
    path: str | Path,
    effect: str,
    n: Sequence[int] = (8, 12, 16, 24),
    *,
    people: int = 200,
    draws: int = 500,
    test: str = "",
    alpha: float = 0.05,
    ratio: float = 1,
    attrition: float = 0,
    smallest_effect: float | None = None,
    bayes_factor: float = 10,
    sequential: bool = False,
    alternative: str = "two-sided",
    population: str | Path = "",
    laboratories: int = 0,
    seed: int = 1,
    jobs: int = 1,
    out: str | Path = "",
    progress: bool = True,
) -> Power:
    """The power of an experiment to find an effect with n people.

    `path` is the experiment's file, which a pool of `people` then rehearses in `out`/pool (or continues there); or the folder
    of a rehearsal, whose people are then the pool. `effect` is an expression over its tables (power_analysis.effect.Effect):
    a value of each person that is compared with zero, or the difference of two groups of people. `n` lists the numbers of
    people recruited in each group; the second group has `ratio` times as many. The share `attrition` of them is lost before
    the analysis. `smallest_effect` is the smallest effect of interest, in the unit of the effect: the samples then have this
    effect on average, and people's scatter as simulated. `test`: "t" or "wilcoxon" for one value of each person; "welch", "t"
    or "wilcoxon" (rank sum) for groups; at the level `alpha`, for an effect of either sign or, if `alternative` is "greater" or
    "less", for one above or below zero alone. "bayes" finds the effect where the Bayes factor of the t test exceeds
    `bayes_factor`. A `sequential` study is tested after each `n`, and ends at the first test that finds the effect, at levels
    that keep `alpha` (or whose Bayes factor is below 1 / `bayes_factor`): see `looks` of the result. `draws` samples are made
    for each n. People who come from `laboratories` show the power in a median one, and in one of the tenth percentile. Raises
    Error.

    >>> import dihaptic as dh
    >>> pool = dh.rehearse("experiments/first-trials.yaml", 12, out=f"{folder}/pool", progress=False)
    >>> result = dh.power(pool.folder, "mean(static_grip_N, block=heavy) - mean(static_grip_N, block=light)", [6, 8], draws=100)
    >>> result.table[["n", "power"]].values.tolist()
    [[6.0, 1.0], [8.0, 1.0]]
    """
    # these need matplotlib and SciPy, and take long to import
    from .draws import ALTERNATIVES, test_named
    from .effect import Effect
    from .result import Power

    asked = Effect(effect)
    _check(n, draws, alpha, ratio, attrition, seed)
    if not 1 < bayes_factor <= 1e6:
        raise error("must be above 1, and at most a million", "10 is usual; some journals ask for 6.", key="bayes_factor")
    if sequential and (len(n) < 2 or list(n) != sorted(set(n))):
        raise error("must be two or more rising numbers, after which a sequential study is tested", "Write e.g. 12, 18, 24.", key="n")
    if laboratories in (1, 2):
        what = f"cannot be {laboratories}: fewer than three do not show how laboratories differ"
        raise error(what, "Give three or more, or leave this out.", key="laboratories")
    if smallest_effect is not None and not 0 < abs(smallest_effect) < np.inf:
        remedy = "Give the smallest effect of interest, in the unit of the effect, with its sign."
        raise error("must be a number other than zero", remedy, key="smallest_effect")
    name, _ = test_named(test, asked.is_between)
    if alternative not in ALTERNATIVES:
        raise NotThere(alternative, "is not an alternative", list(ALTERNATIVES), f"There are {', '.join(ALTERNATIVES)}.")
    if name == "bayes" and alternative != "two-sided":
        raise error("has no side with the test bayes", "Leave it out, or use the test t.", key="alternative")
    folder = Path(path)
    if is_study(folder):
        remedy = f"Rehearse it ({command_of('rehearse', folder)}), then name the folder of its rehearsal."
        raise error("is a study, whose people are not rehearsed here", remedy, file=str(folder))
    if folder.is_dir() and laboratories:
        raise error("are those from which the people in the folder come", "Leave this out.", key="laboratories")
    if not folder.is_dir():
        into = Path(out or f"power/{folder.stem}_{seed}")
        options: dict[str, Any] = {"jobs": jobs, "population": population, "laboratories": laboratories, "seed": seed}
        first = max(1, 2 * laboratories)  # people after whom a misspelt column is told, and not after all
        if not (into / "pool").exists() and people > first:
            asked.check_names(_tables_for(asked, rehearse(path, first, out=into / "pool", progress=False, **options).folder, False))
        folder = rehearse(path, people, out=into / "pool", progress=progress, **options).folder
    data = _tables_for(asked, folder, progress)
    if not Path(path).is_dir() and len(data.people) < people:
        what = f"has {len(data.people)} of {people} people: another program is still writing there, or removes them"
        raise error(what, "Type the same command again when it has ended.", file=str(folder))
    sides = asked.sides(data)
    for side, group in zip(sides, asked.groups or [""]):
        if len(side) < _LEAST:
            of = f"group {group} of the pool" if group else "the pool"
            what = f"{of} has {len(side)} people whose value is known"
            raise error(what, f"Rehearse more people: at least {_LEAST}.", key=effect)
        if not np.isfinite(side).all():
            some = ", ".join(side.index[~np.isfinite(side)][:8])
            raise error(f"is infinite for {some}", "Divide by a number that is never zero.", key=effect)
        if side.std() <= 1e-9 * abs(side.mean()):
            raise error("is the same for all people, so that it needs no test", "Name a column that differs.", key=effect)
    result = Power(
        data, asked, sides, list(n), draws, name, alpha, ratio, attrition, seed, smallest_effect, bayes_factor, sequential,
        alternative,
    )  # fmt: skip
    if not 1e-6 < abs(result.standardised) < 1e6 and smallest_effect is not None:
        what = f"is {result.standardised:.2g} standard deviations of people"
        raise error(what, "Give it in the unit of the effect.", key="smallest_effect")
    if min(n) < result.fewest:
        raise error(f"leaves fewer than 3 people for a test; {result.fewest} must be recruited", "Recruit more.", key="n")
    analysed = [sum(result.sizes(each)) for each in n]
    if sequential and any(later <= earlier for earlier, later in zip(analysed, analysed[1:])):
        raise error("has looks between which nobody is added to the analysis", "Leave more people between them.", key="n")
    return result


def _tables_for(asked: Effect, folder: Path, progress: bool) -> Data:
    """The tables of a pool, with those of a report if the effect needs them."""
    from .pool import read_pool

    data = read_pool(folder)
    own = {str(column) for table in data.tables if table not in _REPORTED for column in data.table(table)}
    lacking = [each for each in data.sessions if not any((each.folder / f"{table}.csv").is_file() for table in _REPORTED)]
    if lacking and set(asked.columns) - own:  # people have been added since the last report, or there was none
        call(["report", str(folder), "--tables"], progress=progress)
        data = read_pool(folder)
    return data


def _check(n: Sequence[int], draws: int, alpha: float, ratio: float, attrition: float, seed: int) -> None:
    if not n or any(int(each) != each or not 3 <= each <= _MOST_PEOPLE for each in n):
        raise error(f"must be whole numbers from 3 to {_MOST_PEOPLE}", "Write e.g. n=[8, 12, 16, 24], or --n 8,12,16,24.", key="n")
    if not 100 <= draws <= 1_000_000:
        raise error("must be from 100 to a million", "500 samples tell the power within about 0.04.", key="draws")
    if not 1e-6 <= alpha <= 0.5:
        raise error("must be from 0.000001 to 0.5", "0.05 is usual.", key="alpha")
    if not 0.1 <= ratio <= 10:
        raise error("must be from 0.1 to 10", "It is the number of people in the second group for one in the first.", key="ratio")
    if not 0 <= attrition <= 0.99:
        raise error("must be a share from 0 to 0.99", "Write e.g. 0.1 for a tenth.", key="attrition")
    if seed < 0:
        raise error("must not be negative", "Write e.g. 1.", key="seed")
