"""The result of power(): the power of an experiment to find an effect, by the number of people."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np
import pandas as pd
from scipy import stats

from .._facts import version
from ..figures.data import Data
from ..reports.results import listed
from .draws import Array, Found, find_effect, half_width, look_repeatedly, smallest_size
from .effect import Effect
from .evidence import PRIOR_SCALE, effective_size, levels_of_factor, levels_of_looks

#: Factors on the spread of people, for the sensitivity of the power to it.
SPREADS = (0.7, 1.0, 1.5)
#: Powers for which the smallest sufficient number of people is found.
WANTED = (0.8, 0.9)
#: Largest number of people (in each group) that is tried for them.
MOST = 1000
#: How often the pool itself is drawn anew, to show how its size affects the power.
_POOLS = 100
#: Minimum number of laboratories from which their spread is estimated, and number of further ones whose power is computed.
_LEAST_LABORATORIES, _FURTHER = 3, 41


@dataclass(frozen=True)
class Power:
    """The power of an experiment to find an effect, by the number of people; made by power()."""

    data: Data  #: of the pool
    effect: Effect
    sides: list[pd.Series]  #: the effect of each person of the pool, or of those of each group
    n: list[int]
    draws: int
    test: str
    alpha: float
    ratio: float
    attrition: float
    seed: int
    smallest_effect: float | None = None  #: the smallest effect of interest, in place of that of the pool
    bayes_factor: float = 10  #: the Bayes factor above which the test "bayes" finds the effect
    is_sequential: bool = False  #: whether `n` are looks at the data of one study
    alternative: str = "two-sided"  #: or "greater" or "less": a test of effects above, or below, zero alone
    _known: dict[tuple[int, float], Found] = field(default_factory=dict, repr=False)

    def __repr__(self) -> str:
        return f"<Power of {self.effect.text}: {len(self.sides[0])} simulated people>"

    @property
    def size(self) -> float:
        """The effect in the pool, in the unit of its measure."""
        means = [float(side.mean()) for side in self.sides]
        return means[0] - means[1] if len(means) == 2 else means[0]

    @property
    def sought(self) -> float:
        """The true effect in the samples: the smallest one of interest or, if none is given, that of the pool."""
        return self.size if self.smallest_effect is None else self.smallest_effect

    @property
    def standardised(self) -> float:
        """Cohen's d: the effect that is sought, divided by the SD of people, which is pooled for two groups."""
        return self.sought / math.sqrt(sum(float(side.var()) for side in self.sides) / len(self.sides))

    @property
    def interval(self) -> tuple[float, float]:
        """The 95 % interval of the effect, from the people in the pool (by t or, for two groups, Welch's t)."""
        half = float(half_width([values[:, None] for values in self._pool], "welch" if self.effect.is_between else "t", 0.05)[0])
        return self.size - half, self.size + half

    def at(self, n: int, spread: float = 1) -> Found:
        """The power with n people recruited (in each group). `spread` multiplies the deviations of people."""
        if (n, spread) not in self._known:
            self._known[n, spread] = self._find(self._pool, n, spread=spread)
        return self._known[n, spread]

    def _find(self, pool: list[Array], n: int, draws: int = 0, more: int = 0, spread: float = 1) -> Found:
        """The power with n people of a pool; `more` is added to the seed."""
        sizes = self.sizes(n)
        seed, levels = self.seed + more, self._levels(sizes)
        return find_effect(pool, sizes, draws or self.draws, self.test, self.alpha, seed, spread, levels, self.alternative)

    def _levels(self, sizes: list[int]) -> tuple[float, float]:
        """The p values below which a test finds the effect, and above which it shows that there is none."""
        return levels_of_factor(self.bayes_factor, sizes) if self.test == "bayes" else (self.alpha, math.inf)

    @cached_property
    def table(self) -> pd.DataFrame:
        """A row for each n: the power, with its 95 % interval from the number of draws (low, high), and the range that it
        might have with other pools of this size (pool_low, pool_high); wrong_sign and exaggeration of significant estimates
        (errors of type S and M); half_width of the confidence interval; untested, the share of samples without a test; and
        the power if people differed less, or more (spread_0.7, spread_1.5); of Bayes factors, the share of samples that show
        that there is no effect (for_none); and, of people who come from laboratories, the power in a median laboratory, and in
        one of the tenth percentile (laboratory_50, laboratory_10)."""
        rows = []
        for n in self.n:
            found = self.at(n)
            low, high = self._interval_of_pool(n)
            rows.append({
                "n": n, "analysed": sum(self.sizes(n)), "power": found.power, "low": found.low, "high": found.high,
                "pool_low": low, "pool_high": high, "wrong_sign": found.wrong_sign, "exaggeration": found.exaggeration,
                "half_width": found.half_width, "untested": found.untested,
                **{f"spread_{spread:g}": self.at(n, spread).power for spread in SPREADS if spread != 1},
                **({"for_none": found.for_none} if self.test == "bayes" else {}),
                **{f"laboratory_{share}": power for share, power in self.in_laboratories(n).items()},
            })  # fmt: skip
        return pd.DataFrame(rows)

    @cached_property
    def _laboratories(self) -> list[list[pd.Series]]:
        """The effect of the people of each laboratory, or of those of each group there; [] for people of fewer than three
        laboratories, or where one has a single person."""
        number = {each.person: each.laboratory for each in self.data.sittings}
        known = sorted({number[person] for side in self.sides for person in side.index} - {0})
        each = [[side[side.index.map(number) == one] for side in self.sides] for one in known]
        return each if len(each) >= _LEAST_LABORATORIES and all(len(side) > 1 for own in each for side in own) else []

    @cached_property
    def spread_of_laboratories(self) -> float | None:
        """The standard deviation of the effect over laboratories, without what the scatter of the people in each explains
        (method of moments); None for people of fewer than three laboratories."""
        if not self._laboratories:
            return None
        effects = [own[0].mean() - (own[1].mean() if len(own) == 2 else 0) for own in self._laboratories]
        within = [self._variance_within(i) for i in range(len(self.sides))]
        chance = np.mean([sum(var / len(side) for var, side in zip(within, own)) for own in self._laboratories])
        return math.sqrt(max(0.0, float(np.var(effects, ddof=1) - chance)))

    def _variance_within(self, side: int) -> float:
        """The variance of people about the mean of their laboratory, in one of the groups."""
        squares = sum(float(own[side].var()) * (len(own[side]) - 1) for own in self._laboratories)
        return squares / sum(len(own[side]) - 1 for own in self._laboratories)

    def in_laboratories(self, n: int) -> dict[int, float]:
        """With n people recruited (in each group), the power that half of further laboratories exceed (50), and that nine in
        ten exceed (10); {} for people of fewer than three laboratories.

        The effect of a further laboratory is that which is sought plus t s sqrt(1 + 1/k), where k laboratories have the spread
        s, and t follows Student's distribution for k - 1 degrees of freedom; its people scatter as those of all laboratories
        do about the means of theirs. What is found in the wrong direction does not count.
        """
        spread, k = self.spread_of_laboratories, len(self._laboratories)
        if spread is None:
            return {}
        people = []  # their deviations from the means of their laboratories, which are smaller than those from the true means
        for i in range(len(self.sides)):
            own = [laboratory[i].to_numpy(float) for laboratory in self._laboratories]
            people.append(np.concatenate([(each - each.mean()) * math.sqrt(len(each) / (len(each) - 1)) for each in own]))
        powers = []
        for t in stats.t.ppf((np.arange(_FURTHER) + 0.5) / _FURTHER, k - 1):
            effect = self.sought + t * spread * math.sqrt(1 + 1 / k)
            found = self._find([people[0] + effect, *people[1:]], n)
            wrong = 0.0 if math.isnan(found.wrong_sign) else found.wrong_sign
            powers.append(found.power * (1 - wrong if effect * self.sought > 0 else wrong))
        return {share: float(np.quantile(powers, share / 100)) for share in (50, 10)}

    @cached_property
    def looks(self) -> pd.DataFrame | None:
        """A row for each look at the data of a sequential study: n; analysed; level, the p value below which the study
        ends with the effect, as do the shares `found` of the samples by this look, and `false_alarm` if there were none;
        for_none, the share that has ended because its Bayes factor speaks for no effect; ends, the share that ends here; and
        exaggeration, the type M error of the estimates that find the effect here. None for a study of fixed size."""
        if not self.is_sequential:
            return None
        sizes = [self.sizes(n) for n in self.n]
        levels = [self._levels(each) for each in sizes]
        if self.test != "bayes":
            shares = [effective_size(each) / effective_size(sizes[-1]) for each in sizes]
            # each side of a two-sided test spends half of its level
            sides = 2 if self.alternative == "two-sided" else 1
            levels = [(level * sides / 2, math.inf) for level in levels_of_looks(shares, self.alpha * 2 / sides)]
        pool = self._pool
        effect = pool[0].mean() - (pool[1].mean() if len(pool) == 2 else 0)
        rest = (sizes, self.draws, self.test, levels, self.seed, self.alternative)
        looks = look_repeatedly(pool, *rest)
        without = look_repeatedly([pool[0] - effect, *pool[1:]], *rest)
        table = pd.DataFrame({
            "n": self.n, "analysed": [sum(each) for each in sizes], "level": [level for level, _ in levels],
            "found": [look.found for look in looks], "for_none": [look.for_none for look in looks],
            "exaggeration": [look.exaggeration for look in looks], "false_alarm": [look.found for look in without],
        })  # fmt: skip
        over = table["found"] + table["for_none"]
        over.iloc[-1] = 1
        return table.assign(ends=over.diff().fillna(over))

    @property
    def people_on_average(self) -> float:
        """The number of people recruited (in each group) when a study ends, on average."""
        return float(max(self.n)) if self.looks is None else float((self.looks["n"] * self.looks["ends"]).sum())

    @cached_property
    def smallest(self) -> pd.DataFrame:
        """A row for each wanted power, 0.8 and 0.9: the smallest n, and those at which the upper and the lower end of the
        power's interval reach it (may_be, probably). A missing value stands for more than 1000."""
        rows = [(wanted, *smallest_size(self.at, wanted, MOST, self.fewest)) for wanted in WANTED]
        table = pd.DataFrame(rows, columns=["power", "n", "may_be", "probably"])
        return table.astype({name: "Int64" for name in ("n", "may_be", "probably")})

    def save(self, folder: str | Path) -> Path:
        """Writes power.html, the figure (power.svg, .pdf, .png), power.csv, power-by-n.csv, and effect-of-people.csv into a
        folder; returns the page. Raises Error, also for the folder of a rehearsal."""
        from .page import write_page

        return write_page(self, Path(folder))

    @property
    def _pool(self) -> list[Array]:
        return self._with_sought([side.to_numpy(float) for side in self.sides])

    def _with_sought(self, sides: list[Array]) -> list[Array]:
        """These values, those of the first group moved so that the effect is the smallest one of interest, if that is given."""
        if self.smallest_effect is None:
            return sides
        effect = sides[0].mean() - (sides[1].mean() if len(sides) == 2 else 0)
        return [sides[0] + self.smallest_effect - effect, *sides[1:]]

    def sizes(self, n: int) -> list[int]:
        """How many of n recruited people remain, in each group."""
        recruited = [n, round(self.ratio * n)] if self.effect.is_between else [n]
        return [math.floor((1 - self.attrition) * each + 1e-9) for each in recruited]

    @cached_property
    def fewest(self) -> int:
        """The smallest number of people who must be recruited, so that three in each group are analysed."""
        n = 3
        while min(self.sizes(n)) < 3:
            n += 1
        return n

    def _interval_of_pool(self, n: int) -> tuple[float, float]:
        """The middle 95 % of the power over pools of other people from the same population."""
        rng = np.random.default_rng(self.seed)
        draws = max(200, self.draws // 2)
        powers = []
        for i in range(_POOLS):
            pool = self._with_sought([values[rng.integers(0, len(values), len(values))] for values in self._pool])
            powers.append(self._find(pool, n, draws, more=i).power)
        low, high = np.quantile(powers, [0.025, 0.975])
        return float(low), float(high)

    def in_words(self) -> str:
        """A paragraph for a preregistration."""
        who = " and ".join(f"{len(side)} simulated people{f' of group {group}' if group else ''}"
                           for side, group in zip(self.sides, self.effect.groups or [""]))  # fmt: skip
        each = ""
        if self.effect.is_between:
            each = " in each group" if self.ratio == 1 else " in the first group"
        population = self.data.sample.population or "not named"
        low, high = self.interval
        size = f", Cohen's d = {self.standardised:.2f}"
        if self.smallest_effect is not None:
            size = (
                f". The effect to be detected is the smallest effect of interest, {self.smallest_effect:.3g}{size}, among people "
                "who differ from each other as these do"
            )
        text = (
            f"The effect {self.effect.text} was computed from {who} (population {population}, dihaptic {version()}): "
            f"{self.size:.3g} (95 % interval {low:.3g} to {high:.3g}){size}. {self.draws} samples of each size were drawn "
            f"from them with replacement (seed {self.seed}), and tested by {self._test_in_words()}."
        )
        text += self._looks_in_words(each)
        for row in self.smallest.itertuples():
            if pd.isna(row.n):
                text += f" More than {MOST} people{each} are needed for a power of {100 * row.power:.0f} %"
                text += ", if they are tested only once." if self.is_sequential else "."
            else:
                pool_low, pool_high = self._interval_of_pool(int(row.n))
                once = " and a single test" if self.is_sequential else ""
                text += (
                    f" With {row.n} people{each}{once} the power reaches {100 * row.power:.0f} %; with other pools of this size "
                    f"it would be between {pool_low:.2f} and {pool_high:.2f}."
                )
        some = self.smallest["n"].dropna()
        n = int(some.iloc[0]) if len(some) else max(self.n)
        if there := self.in_laboratories(n):
            text += (
                f" Laboratories differ in the effect by a standard deviation of {self.spread_of_laboratories:.2g}: with "
                f"{n} people{each}, half of further laboratories have a power of at least {there[50]:.2f}, and nine in ten of at "
                f"least {there[10]:.2f}."
            )
        if self.effect.is_between and self.ratio != 1:
            text += f" The second group, {self.effect.groups[1]}, has {self.ratio:g} times as many."
        if self.attrition:
            text += f" These are recruited; {100 * self.attrition:.0f} % of them are expected to be lost."
        return text

    def _test_in_words(self) -> str:
        if self.test == "bayes":
            return (
                f"the Bayes factor of a t test (two-sided, Cauchy prior with the scale {PRIOR_SCALE:.3f}), which finds the effect "
                f"above {self.bayes_factor:g}"
            )
        tests = {"t": "a t test", "welch": "Welch's t test", "wilcoxon": "Wilcoxon's test"}
        side = "two-sided"
        if self.alternative != "two-sided":
            side = f"one-sided, for an effect {'above' if self.alternative == 'greater' else 'below'} zero"
        return f"{tests[self.test]} ({side}, alpha = {self.alpha:g})"

    def _looks_in_words(self, each: str) -> str:
        """What becomes of a study whose data are looked at while they come; "" for one of fixed size."""
        if self.looks is None:
            return ""
        last = self.looks.iloc[-1]
        ends = f"the Bayes factor is above {self.bayes_factor:g} or below 1/{self.bayes_factor:g}"
        if self.test != "bayes":
            levels = listed([f"{level:.2g}" for level in self.looks["level"]])
            ends = f"p is below {levels}, in turn (alpha spending of the O'Brien-Fleming type, Lan and DeMets 1983)"
        text = (
            f" The data are tested after {listed([str(n) for n in self.n])} people{each}, and the study ends at the first test at "
            f"which {ends}. It then finds the effect in {100 * last.found:.0f} % of the samples"
        )
        text += f", finds that there is none in {100 * last.for_none:.0f} %" if self.test == "bayes" else ""
        text += (
            f", and has {self.people_on_average:.1f} people{each} on average; if there were no effect, "
            f"{100 * last.false_alarm:.1f} % would find one."
        )
        return text
