"""The differences between groups, or between sessions of a study, with their 95 % intervals."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import pandas as pd

from ..figures.conditions import averaged_over, axes_of_design, counting_trials, each_in_conditions, measures_of_lifts
from ..figures.data import Data
from ..figures.learning import DIFFERENCES, LEARNED, WINDOWS
from ..figures.means import t_quantile
from ..figures.words import label, level, with_unit, words_of
from .page import Page, between, in_short, with_interval, without_empty

#: Maximum numbers of groups that are compared with the first one, and of conditions with rows of their own.
_MOST_GROUPS, _MOST_CONDITIONS = 7, 6
#: Number of differences in the sentences; the others are in the table.
_MOST_IN_WORDS = 3
#: Ends of the names of windows of learning that are in the table alone.
_NOT_LATE = tuple(f", {called}" for window, called in {**WINDOWS, **DIFFERENCES}.items() if window != "late")


@dataclass(frozen=True)
class _Case:
    """A number that people of both sides have: columns person, side and value."""

    what: str
    unit: str
    condition: str
    each: pd.DataFrame
    is_learned: bool = False  #: whether it is a window of learning or a threshold


@dataclass(frozen=True)
class Difference:
    """A mean less another one, with its 95 % interval (NaN where there are too few people)."""

    mean: float  #: of the first
    other_mean: float
    value: float  #: the other mean less the first
    low: float
    high: float
    n: str  #: "4 and 5" people, or "4 pairs" of values of one person


def difference(first: pd.Series, other: pd.Series) -> Difference:
    """The mean of `other` less that of `first`, whose indices name people.

    If there are people on both sides, it is the mean of their own differences with Student's interval, and nobody else counts;
    or else the difference of both means, with Welch's interval.

    >>> import pandas as pd
    >>> found = difference(pd.Series([1.0, 2.0], ["a", "b"]), pd.Series([2.0, 5.0], ["a", "b"]))
    >>> found.value, round(found.low, 2), found.n
    (2.0, -10.71, '2 pairs')
    >>> found = difference(pd.Series([1.0, 2.0, 3.0], list("abc")), pd.Series([2.0, 5.0], list("de")))
    >>> found.value, round(found.low, 2), found.n
    (1.5, -10.49, '3 and 2')
    """
    both = first.index.intersection(other.index)
    if len(both):
        first, other = first[both], other[both]
        error, freedom = _error(other - first), len(both) - 1.0
        n = f"{len(both)} pair{'' if len(both) == 1 else 's'}"
    else:
        squares = [_error(first) ** 2, _error(other) ** 2]
        error = math.sqrt(sum(squares))
        parts = sum(square**2 / (len(own) - 1) for square, own in zip(squares, (first, other)) if len(own) > 1)
        freedom = sum(squares) ** 2 / parts if parts > 0 else math.nan
        n = f"{len(first)} and {len(other)}"
    value = float(other.mean() - first.mean())
    half = float(t_quantile(freedom, 0.975)) * error if freedom >= 1 else math.nan
    half = 0.0 if error == 0 else half
    return Difference(float(first.mean()), float(other.mean()), value, value - half, value + half, n)


def _error(values: pd.Series) -> float:
    """The standard error of a mean; NaN of one value."""
    return float(values.std() / math.sqrt(len(values)))


def add_differences(page: Page, data: Data) -> None:
    """A section with the differences of everything that people of several groups, or sessions of a study, have been measured by."""
    side, sides = _sides(data)
    rows: list[dict[str, Any]] = []
    cases = list(_cases(data, side, apart=True)) if side else []
    # what was learned, or the first measures; the others are for those who look for them
    learned = any(case.is_learned for case in cases)
    names = list(dict.fromkeys(case.what for case in cases))[:_MOST_IN_WORDS]
    first = 0
    for case in cases:
        for other, found in _compared(case, sides):
            first += case.is_learned if learned else case.what in names
            rows.append({
                "measure": label(case.what, case.unit), "condition": case.condition,
                words_of(side): other if len(sides) > 2 else "", sides[0]: in_short(found.mean),
                other if len(sides) == 2 else "mean": in_short(found.other_mean),
                "difference (95 %)": with_interval(found.value, found.low, found.high), "n": found.n,
            })  # fmt: skip
    if not rows:
        return
    table = pd.DataFrame(rows)
    averaged = _averaged(data, side)
    page.heading("Differences between sessions" if side == "study_session" else "Differences between groups")
    what = f"{sides[1]} minus {sides[0]}" if len(sides) == 2 else f"each {words_of(side)} minus {sides[0]}"
    caption = (
        f"Differences are those of means over people: {what}. Where n counts pairs, people are compared with themselves, and the "
        "interval is Student's; elsewhere it is Welch's. Each interval is for a single difference; none is corrected for multiple comparisons."
    )
    caption += f" Values are averaged over {' and '.join(averaged)}." if averaged else ""
    page.table(without_empty(table[:first]), caption)
    page.table(without_empty(table[first:]), folded="Differences of the other measures")


def differences_in_words(data: Data) -> str:
    """The first differences in a sentence; "" without groups."""
    side, sides = _sides(data)
    cases = list(_cases(data, side, apart=False)) if side else []
    late = [case for case in cases if case.is_learned and not case.what.endswith(_NOT_LATE)]
    texts: list[str] = []
    counts: dict[str, None] = {}
    for case in (late or cases)[:_MOST_IN_WORDS]:
        for other, found in _compared(case, sides):
            interval = "no interval" if math.isnan(found.low) else between(found.low, found.high)
            of = f" in {case.condition}" if case.condition else ""
            whom = f", {level(other)}" if len(sides) > 2 else ""
            texts.append(f"{case.what}{of}{whom}: {with_unit(in_short(found.value), case.unit)} ({interval})")
            counts[found.n] = None
    if not texts:
        return ""
    whose = f"{level(sides[1])} minus {level(sides[0])}" if len(sides) == 2 else f"minus {level(sides[0])}"
    return f"Differences between means, {whose} (95 % interval): {'; '.join(texts)}; n = {', '.join(counts)}."


def _sides(data: Data) -> tuple[str, list[str]]:
    """The column whose levels are compared with the first of them: groups or, without any, sessions of a study."""
    trials = data.table("trials") if data.has("trials") else pd.DataFrame()
    for column in ("group", "study_session"):
        levels = [str(name) for name in trials[column].dropna().unique() if str(name)] if column in trials else []
        if 1 < len(levels) <= _MOST_GROUPS:
            return column, levels
    return "", []


def _compared(case: _Case, sides: list[str]) -> Iterator[tuple[str, Difference]]:
    values = {side: own.groupby("person")["value"].mean() for side, own in case.each.groupby("side")}
    for other in sides[1:]:
        if sides[0] in values and other in values:
            yield other, difference(values[sides[0]], values[other])


def _cases(data: Data, side: str, *, apart: bool) -> Iterator[_Case]:
    """What is compared; `apart`: measures in each condition, instead of over all of them."""
    yield from _learned(data, side)
    yield from _thresholds(data, side)
    if not data.has("trials") or "attempt" not in data.table("trials"):
        return
    own = [("trials", measure.column) for measure in data.measures]
    own += [("lifts", name) for name in measures_of_lifts(data)] if data.has("lifts") else []
    units = data.table("trials").attrs.get("units", {})
    by = _condition(data, side) if apart else ""
    for table, measure in own:
        trials = counting_trials(data, table)
        each = each_in_conditions(trials, measure, [name for name in (side, by) if name], False).rename(columns={side: "side"})
        unit = data.measure(measure, table).unit
        for value in data.levels(by) if by else [""]:
            some = each[each[by] == value] if by else each
            yield _Case(words_of(measure, unit), unit, level(value, units.get(by, "")) if by else "", some)


def _condition(data: Data, side: str) -> str:
    """The column of the design whose levels have rows of their own."""
    columns = [name for name in axes_of_design(data).values() if name not in (side, "group")]
    return next((name for name in columns if len(data.levels(name)) <= _MOST_CONDITIONS), "")


def _averaged(data: Data, side: str) -> list[str]:
    trials = counting_trials(data) if data.has("trials") else pd.DataFrame()
    if trials.empty or "attempt" not in trials:
        return []
    units = data.table("trials").attrs.get("units", {})
    by = [name for name in (side, _condition(data, side)) if name]
    return [words_of(name, units.get(name, "")) for name in averaged_over(data, trials, by)]


def _learned(data: Data, side: str) -> Iterator[_Case]:
    fits = data.table("fits") if data.has("fits") else pd.DataFrame()
    if side not in fits:
        return
    parts = [name for name in ("study_session", "round") if name in fits and name != side]
    words = fits[parts].fillna("").astype(str).agg(lambda row: ", ".join(filter(None, row)), axis=1) if parts else ""
    fits = fits.assign(part=words, side=fits[side].astype(str))
    for (part, unit, measure), own in fits.groupby(["part", "unit", "measure"], sort=False):
        for window, called in {**WINDOWS, **DIFFERENCES}.items():
            if window in own and own[window].notna().any():
                each = own[own[window].notna()][["person", "side", window]].rename(columns={window: "value"})
                yield _Case(f"{LEARNED.get(str(measure), 'compensation')}, {called}", str(unit), str(part), each, True)


def _thresholds(data: Data, side: str) -> Iterator[_Case]:
    table = data.table("thresholds") if data.has("thresholds") else pd.DataFrame()
    if not {side, "threshold_share"} <= set(table):
        return
    good = table[table["note"].isna() & table["threshold_share"].notna()]
    for procedure, own in good.groupby("procedure", sort=False):
        columns: dict[str, Any] = {side: "side", "threshold_share": "value"}
        yield _Case(f"threshold, {procedure}", "", "", own[["person", *columns]].rename(columns=columns), True)
