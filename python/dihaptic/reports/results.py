"""The results in sentences, and warnings to read before using them."""

from __future__ import annotations

import math
from typing import Any

import pandas as pd

from ..figures import fitts, psychophysics
from ..figures.conditions import averaged_over, axes_of_design, counting_trials, each_in_conditions
from ..figures.data import WINDOW, Data, is_of_index, sitting_columns
from ..figures.means import means_with_intervals, within_limits
from ..figures.quality import OF_CUT_FORCE
from ..figures.words import counted, label, level, with_unit, words_of
from .differences import differences_in_words
from .page import in_short
from .simulated import limits_of

#: Number of measures in the sentences; the table has the others.
_MOST_MEASURES = 3
#: Figures of lifts in the sentences, if the task has no measures of its own.
_OF_LIFTS = ["peak_grip_N", "static_grip_N", "safety_margin"]
#: Maximum number of levels that are listed by name.
MOST_LISTED = 12
#: Maximum number of conditions whose means are all in a sentence; of more, it has the smallest and the largest one.
_MOST_MEANS = 6
#: Columns over which no sentence takes a mean.
_APART = ("group", "round", "study_session", "perturbation")
#: A reader is warned if more than this share of the trials was repeated.
_MANY_REPEATED = 0.1
#: A reader is warned if forces were limited in at least this share of the trials.
_MANY_LIMITED = 0.05


def results_of(data: Data) -> list[str]:
    """A sentence for each main result: what was learned, thresholds, answers, the first measures by condition, outcomes."""
    results = [_learned(data), _thresholds(data), *_answered(data), _fitts(data), *_measured(data)]
    results += [differences_in_words(data), _outcomes(data)]
    return [text for text in results if text]


def warnings_of(data: Data, told: dict[str, Any]) -> list[str]:
    """Reasons not to use these numbers as they are. `told` is the program's description of these sessions."""
    out = []
    if told.get("not_measured"):
        out.append(
            f"Dihaptic does not yet measure the learning of these perturbations: {told['not_measured']}. Their "
            "trials lack a compensation. The hand's movement is in trials.csv, and in full in session.nwb."
        )
    out += limits_of(data)
    if (several := len(set(data.laboratories.values()))) > 1:
        out.append(
            f"These people come from {several} laboratories. Means and intervals are over people, as if they came from one: a "
            "further laboratory may lie outside the intervals."
        )
    trials, repeated = _repeated(data)
    out += [text for text in (_missed_solves(data), _limited_forces(data, trials)) if text]
    if data.has("adaptation") and (text := shared_windows(data.table("adaptation"))):
        out.append(text)
    if repeated > _MANY_REPEATED * trials:
        share = _percent(repeated, trials)
        out.append(f"{repeated} of {trials} trials ({share}) were repeated: Quality of the data shows after which outcomes.")
    return out


def listed(items: list[str]) -> str:
    """ "a", "a and b", "a, b and c".

    >>> from dihaptic.reports.results import listed
    >>> listed(["80 g", "140 g", "200 g"])
    '80 g, 140 g and 200 g'
    """
    return items[0] if len(items) == 1 else f"{', '.join(items[:-1])} and {items[-1]}" if items else ""


def capital(text: str) -> str:
    """A text that begins a sentence."""
    return text[:1].upper() + text[1:]


def with_spreads(means: pd.Series, spreads: pd.Series) -> list[str]:
    """ "0.69 ± 0.08": means with their standard deviations, all with the same number of decimals.

    These are as many as two digits of the middle deviation need or, without deviations, three digits of the largest mean.
    No mean has more than four digits, and a deviation too small to show in them is left out.

    >>> with_spreads(pd.Series([0.1857, 0.7304]), pd.Series([0.0252, 0.11]))
    ['0.19 ± 0.03', '0.73 ± 0.11']
    >>> with_spreads(pd.Series([-2.5]), pd.Series([1.2]))  # with a minus sign, not a hyphen
    ['\N{MINUS SIGN}2.5 ± 1.2']
    """
    largest = means.abs().max()
    is_known = spreads > 1e-4 * largest
    some = spreads[is_known]
    # takes the larger of two middle deviations, since few digits of people's deviations are certain
    size = max(some.quantile(0.5, interpolation="higher") / 10, largest / 1000) if len(some) else largest / 100
    digits = min(6, max(0, -math.floor(math.log10(size)))) if size > 0 else 0
    # + 0.0: no "-0.00"
    texts = [f"{round(mean, digits) + 0.0:.{digits}f}".replace("-", "\N{MINUS SIGN}") for mean in means]
    return [text + (f" ± {spread:.{digits}f}" if known else "") for text, spread, known in zip(texts, spreads, is_known)]


def means_of(data: Data, measure: str, by: list[str], table: str = "trials") -> pd.DataFrame:
    """Means of a measure: a row for each combination of the columns `by`, in the order of their levels, with `mean`, `sd`,
    and the 95 % interval from `low` to `high` over `n` people, or over `n` trials of one person; and the number of `trials`.
    """
    trials = counting_trials(data, table).assign(all="")
    keys = by or ["all"]
    each = each_in_conditions(trials, measure, keys, len(data.people) == 1)
    means = within_limits(means_with_intervals(each, keys, dropna=False), measure).rename(columns={"value": "mean"})
    spread = each.groupby(keys, dropna=False).agg(sd=("value", "std"), trials=("n", "sum")).reset_index()
    return data.in_order(means.merge(spread, on=keys), by).reset_index(drop=True)


# Results


def _answered(data: Data) -> list[str]:
    """The shares of answers at each level of a factor."""
    out = []
    for plan in psychophysics.plan_of_answers(data) if data.has("trials") else []:
        points = plan.points(data, **plan.points_options)
        each = points[points["of"] == "person"]
        shares = each.groupby(["series", "x"], sort=False)["value"].agg(["mean", "std"]).reset_index()
        unit = data.table("trials").attrs.get("units", {}).get(plan.points_options["x"], "")
        words = with_spreads(shares["mean"], shares["std"])
        cases = [", ".join(filter(None, [level(x, unit), series])) for x, series in zip(shares["x"], shares["series"])]
        texts = [f"{value} ({case})" for value, case in zip(words, cases)][:MOST_LISTED]
        more = f", and {len(shares) - MOST_LISTED} further conditions" if len(shares) > MOST_LISTED else ""
        several = len(data.people) > 1
        n = f"{counted(each['person'].nunique(), 'person', 'people')}, " if several else ""
        n += counted(int(each["n"].sum()), "trial")
        name = capital(str(plan.drawing_options["ylabel"]))
        out.append(f"{name}{' (mean ± SD over people)' if several else ''}: {listed(texts)}{more}; n = {n}.")
    return out


def _fitts(data: Data) -> str:
    for plan in fitts.plans(data):
        return f"Movement time against the index of difficulty (ID): {fitts.law_in_words(plan.points(data))}."
    return ""


def _outcomes(data: Data) -> str:
    if not data.has("trials") or "outcome" not in data.table("trials"):
        return ""
    outcomes = data.table("trials")["outcome"].fillna("none").astype(str).value_counts()
    every = [f"{n} {outcome}" for outcome, n in outcomes.items()]
    trials, repeated = _repeated(data)
    verb = "was" if repeated == 1 else "were"
    again = f" {repeated} of {trials} trials ({_percent(repeated, trials)}) {verb} repeated." if repeated else ""
    return f"Outcomes of {counted(int(outcomes.sum()), 'attempt')}: {listed(every)}.{again}"


def _repeated(data: Data) -> tuple[int, int]:
    """How many trials there are, and how many of them had more than one attempt."""
    trials = data.table("trials") if data.has("trials") else pd.DataFrame()
    if not {"attempt", "trial_num"} <= set(trials):
        return 0, 0
    attempts = trials.groupby([*sitting_columns(trials), "trial_num"]).size()
    return len(attempts), int((attempts > 1).sum())


def _percent(part: int, whole: int) -> str:
    return f"{100 * part / whole:.2g} %"


def _measured(data: Data) -> list[str]:
    """The first measures, and those of lifts, in each condition: mean and SD over people, or over the trials of one person."""
    if not data.has("trials") or "attempt" not in data.table("trials"):
        return []
    index = is_index(data)
    # learning has a sentence of its own, and the table has the details of its regression
    names = [measure.column for measure in data.measures if not (index and measure.column.startswith("adaptation_index"))]
    own = [("trials", name) for name in names[:_MOST_MEASURES]]
    if data.has("lifts") and not data.measures:
        known = counting_trials(data, "lifts")
        own = [("lifts", name) for name in _OF_LIFTS if name in known and known[name].notna().any()]
    axes = axes_of_design(data)
    apart = [name for name in (axes.get("colour"), axes.get("panel")) if name in _APART]
    main = [name for name in (axes.get("x"), axes.get("colour")) if name and name not in apart]
    # each factor has its sentence: a mean over surfaces hides what the surfaces do
    out = []
    for table, measure in own:
        known = counting_trials(data, table).dropna(subset=[measure])
        varied = [[name] for name in main if known[name].nunique() > 1]  # a question is perhaps asked in one condition alone
        out += [_sentence(data, measure, [*name, *apart], table) for name in varied or [[]]]
    if out and len(names) > _MOST_MEASURES:
        out[-1] += " The tables have the other measures."
    return out


def is_index(data: Data) -> bool:
    """Whether compensation is the adaptation index of force channels."""
    return data.has("fits") and is_of_index(data.table("fits"))


def _sentence(data: Data, measure: str, by: list[str], table: str) -> str:
    """A measure in each condition: "Movement time (mean ± SD): 0.69 ± 0.08 s (40 mm), ..."."""
    units = data.table("trials").attrs.get("units", {})
    unit = data.measure(measure, table).unit
    name = words_of(measure, data.measure(measure, table).unit)
    if sum(words_of(each.column, each.unit) == name for each in data.measures) > 1:
        name = label(measure, data.measure(measure, table).unit)
    means = means_of(data, measure, by, table)
    means = means[means["mean"].notna()]
    if means.empty:
        return f"{capital(name)} was measured in no trial that counts; the column not_measured of trials.csv says why."
    texts = []
    shown = means if len(means) <= _MOST_MEANS else means.loc[[means["mean"].idxmin(), means["mean"].idxmax()]]
    for row, words in zip(shown.to_dict("records"), with_spreads(shown["mean"], shown["sd"])):
        named = [name for name in by if pd.notna(row[name])]
        of = ", ".join(level(row[name], units.get(name, "")) for name in named)
        value = with_unit(words, unit)
        texts.append(f"{value} ({of})" if of else value)
    said = listed(texts) if len(means) <= _MOST_MEANS else f"from {texts[0]} to {texts[1]}, in {len(means)} conditions"
    trials = counted(int(means["trials"].sum()), "trial")
    people = counting_trials(data, table).dropna(subset=[measure])["person"].nunique()
    n = trials if len(data.people) == 1 else f"{counted(people, 'person', 'people')}, {trials}"
    over = [words_of(name, units.get(name, "")) for name in averaged_over(data, counting_trials(data, table), by)]
    averaged = f"; averaged over {listed(over)}" if over else ""
    spread = "" if (means["n"] < 2).all() else f" (mean ± SD over {'trials' if len(data.people) == 1 else 'people'})"
    return f"{capital(name)}{spread}: {said}; n = {n}{averaged}."


def _learned(data: Data) -> str:
    if not data.has("fits"):
        return ""
    fits = data.table("fits")
    fits["round"] = fits["round"].fillna("").astype(str)
    cases = []
    several = fits["group"].nunique() > 1
    for (group, part), own in fits.groupby(["group", "round"], sort=False):
        of = ", ".join(filter(None, [group if several else "", f"round {part}" if part else ""]))
        known = [name for name in ("baseline", "early", "late") if name in own and own[name].notna().any()]
        each = own.groupby("person")[known].mean()
        cases += [(of, name, str(own["unit"].iloc[0]), each[name].mean(), each[name].std()) for name in known]
    table = pd.DataFrame(cases, columns=["of", "window", "unit", "mean", "sd"])
    words = zip(with_spreads(table["mean"], table["sd"]), table["unit"], table["window"])
    table["words"] = [f"{with_unit(value, unit)} ({window})" for value, unit, window in words]
    texts = [f"{listed(list(own['words']))}{f' in {of}' if of else ''}" for of, own in table.groupby("of", sort=False)]
    people = fits["person"].nunique()
    spread = "mean ± SD over people" if table["sd"].notna().any() else "means over at most eight trials"
    n = f"; n = {counted(people, 'person', 'people')}" if people > 1 else ""
    return f"{'Adaptation index' if is_index(data) else 'Compensation'} ({spread}): {'; '.join(texts)}{n}." if texts else ""


def _thresholds(data: Data) -> str:
    if not data.has("thresholds"):
        return ""
    table = data.table("thresholds")
    texts: list[str] = []
    cases = []
    several = table["group"].nunique() > 1
    for (group, name), own in table.groupby(["group", "procedure"], sort=False):
        procedure = f"{name} ({group})" if several else name
        if len(data.people) == 1:
            row = own.iloc[0]
            if pd.notna(row["threshold"]) and pd.isna(row["note"]):
                between = f" (95 % {row['threshold_95']})" if isinstance(row.get("threshold_95"), str) else ""
                texts.append(f"{in_short(row['threshold'])}{between} in {procedure}, of {row['trials']} answers")
            continue
        each = own[own["note"].isna()].groupby("person")["threshold_share"].mean().dropna()
        if len(each):
            cases.append((each.mean(), each.std(), f"{procedure} (n = {counted(len(each), 'person', 'people')})"))
    means, spreads = (pd.Series([case[i] for case in cases], dtype=float) for i in (0, 1))
    texts += [f"{words} in {of}" for words, (*_, of) in zip(with_spreads(means, spreads), cases)]
    if not texts:
        return f"Thresholds: none of {len(table)} could be given; thresholds.csv notes why."
    kind = " (mean ± SD, as shares of the perturbation or in the unit of the number's name)" if len(data.people) > 1 else ""
    return f"Thresholds{kind}: {listed(texts)}."


# Warnings


def _missed_solves(data: Data) -> str:
    """A sentence about sessions in which ticks missed something."""
    ticks, missed, people = 0, 0, set()
    for sitting in data.sittings:
        convergence = sitting.session.info.get("convergence") or {}
        ticks += int(sitting.session.info.get("ticks") or 0)
        if convergence.get("missed"):
            missed += int(convergence["missed"])
            people.add(sitting.person)
    if not missed:
        return ""
    share = f"{100 * missed / ticks:.2g} % of " if ticks else ""
    return (
        f"In {missed} ticks ({share}{ticks}) the contact solver missed its tolerance: {', '.join(sorted(people)[:12])}"
        f"{' and others' if len(people) > 12 else ''}. Look at the forces of these sessions before you use them."
    )


def _limited_forces(data: Data, trials: int) -> str:
    """A sentence about trials in which a device gave less force than was asked for, if these are many of all `trials`."""
    limited = 0
    for sitting in data.sittings:
        if "events" in sitting.session.tables:
            events = sitting.session.table("events")
            limited += events.loc[(events["event"] == "limit") & events["detail"].isin(OF_CUT_FORCE), "trial"].nunique()
    if not trials or limited < _MANY_LIMITED * trials:
        return ""
    return (
        f"In {limited} of {trials} trials a device gave less force than was asked for: less was felt there than the contact "
        "forces, such as normal_force, which are the model's. Quality of the data shows in which sessions."
    )


def shared_windows(adaptation: pd.DataFrame) -> str:
    """A warning if early and late in adaptation.csv are means over some of the same trials; "" if they are not."""
    least: dict[str, int] = {}
    keys = [*sitting_columns(adaptation), "round"]
    for case, own in adaptation.groupby(keys, sort=False, dropna=False):
        blocks = own.loc[own["kind"] == "perturbed", "block"].unique()
        measured = int(own.loc[own["block"].isin(blocks), "compensation"].notna().sum())
        if len(blocks) == 1 and 0 < measured < 2 * WINDOW:
            least[str(blocks[0])] = min(measured, least.get(str(blocks[0]), measured))
    if not least:
        return ""
    few = ", ".join(f"{block}: {count}" for block, count in least.items())
    return (
        f"Early and late share trials, and differ by less than what was learned: their block has fewer than {2 * WINDOW} "
        f"measured trials ({few}). Measure more of its trials, as by more force channels, or draw the curve."
    )
