"""Methods and results in sentences: a start for those of a paper."""

from __future__ import annotations

import math
from typing import Any

import pandas as pd

from ..figures.conditions import axes_of_design, counting_trials, each_in_conditions
from ..figures.data import Data, sitting_columns
from ..figures.means import means_with_intervals
from ..figures.words import counted, in_print, level, words_of
from .page import in_short

#: Measures that are in the sentences; the others are in the table.
_MOST_MEASURES = 3
#: Figures of lifts that are in them, where the task has no measures of its own.
_OF_LIFTS = ["peak_grip_N", "static_grip_N", "safety_margin"]
#: Most levels that are listed by their names.
_MOST_LISTED = 12


def in_words(data: Data, told: dict[str, Any]) -> tuple[list[str], list[str]]:
    """Paragraphs of methods, and of results. `told` is what the program says of these sessions."""
    methods = [f"{_who(data, told)} {_apparatus(data)}", _design(data), _perturbations(told)]
    results = [_outcomes(data), *_measured(data), _learned(data), _thresholds(data)]
    return [text for text in methods if text], [text for text in results if text]


def listed(items: list[str]) -> str:
    """ "a", "a and b", "a, b and c".

    >>> from dihaptic.reports.text import listed
    >>> listed(["80 g", "140 g", "200 g"])
    '80 g, 140 g and 200 g'
    """
    return items[0] if len(items) == 1 else f"{', '.join(items[:-1])} and {items[-1]}" if items else ""


def _with_spread(mean: float, spread: float) -> str:
    """ "0.69 ± 0.08": a mean with its standard deviation, of which two digits are known; without one that is missing."""
    if not spread > 0:
        return in_short(mean)
    digits = min(6, max(0, 1 - math.floor(math.log10(spread))))
    return f"{round(mean, digits) + 0.0:.{digits}f} ± {spread:.{digits}f}"  # + 0.0: no "-0.00"


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]


def _who(data: Data, told: dict[str, Any]) -> str:
    if data.is_simulated or data.sample.moved_by == "":
        return str(told.get("who") or "The hand was moved by a simulation. No person took part.")
    facts = pd.DataFrame([s.session.info.get("participant") or {} for s in data.sittings])
    facts = facts.assign(person=[s.person for s in data.sittings]).drop_duplicates("person")
    about = []
    ages = pd.to_numeric(facts["age"], errors="coerce").dropna() if "age" in facts else pd.Series(dtype=float)
    if len(ages) == 1:
        about.append(f"{in_short(ages.iloc[0])} years")
    elif len(ages) > 1:
        about.append(f"age {_with_spread(ages.mean(), ages.std())} years (mean ± SD)")
    for column, words in (("sex", "{} {}"), ("handedness", "{} {}-handed")):
        known = facts[column].dropna().astype(str) if column in facts else pd.Series(dtype=str)
        counts = known[known != ""].value_counts(sort=False)
        many = len(data.people) > 1
        about += [words.format(n if many else "", value).strip() for value, n in counts.items()]
    some = f" ({', '.join(about)})" if about else ""
    if len(data.people) == 1:
        return f"Participant {data.people[0]}{some} took part."
    return f"{len(data.people)} participants{some} took part."


def _apparatus(data: Data) -> str:
    settings: dict[str, str] = {}
    if data.has("settings"):
        table = data.table("settings").drop_duplicates("setting")
        settings = dict(zip(table["setting"].astype(str), table["value"].fillna("").astype(str)))
    info = data.sessions[0].info
    devices = [f"{device['finger']} ({device['model']})" for device in info.get("devices") or []]
    rate = settings.get("rate_Hz", "")
    text = f"Forces were computed and recorded {f'{rate} times a second ' if rate else ''}by {info.get('program', 'Dihaptic')}"
    if devices:
        text += f", and rendered to {listed(devices)} through {'its device' if len(devices) == 1 else 'a device each'}"
    text += "."
    stiffness = settings.get("coupling.stiffness_N_m", "")
    if stiffness:
        text += f" Each device was connected to its virtual finger by a virtual coupling of {stiffness} N/m."
    solver = settings.get("dynamics.solver", "").replace("_", " ")
    return text + (f" Contact and friction were solved by the method {solver}." if solver else "")


def _trials(data: Data) -> pd.DataFrame:
    """The last attempt at each trial; no rows in a session without a task."""
    trials = data.table("trials") if data.has("trials") else pd.DataFrame()
    if "attempt" not in trials:
        return pd.DataFrame()
    return trials.drop_duplicates([*sitting_columns(trials), "trial_num"], keep="last")


def _levels(trials: pd.DataFrame, column: str) -> list[str]:
    """The words in a column, in the order in which they come first."""
    return [str(word) for word in trials[column].dropna().unique() if str(word)] if column in trials else []


def _design(data: Data) -> str:
    trials = _trials(data)
    if trials.empty:
        return ""
    first = trials[trials["session"] == trials["session"].iloc[0]]
    rounds = _levels(first, "round")
    of = first[first["round"].fillna("").astype(str) == rounds[0]] if len(rounds) > 1 else first
    blocks = []
    for block, own in of.groupby(of["block"].fillna("").astype(str), sort=False):
        kinds = [kind.replace("_", " ") for kind in _levels(own, "kind") if kind != block]
        blocks.append(f"{block or 'one block'} ({', '.join([counted(len(own), 'trial'), *kinds])})")
    text = f"The experiment ({data.title}) had "
    if len(rounds) > 1:
        text += f"{len(rounds)} rounds ({listed(rounds)}), each with "
    text += f"{counted(len(blocks), 'block')}: {listed(blocks[:_MOST_LISTED])}"
    text += f" and {len(blocks) - _MOST_LISTED} further ones." if len(blocks) > _MOST_LISTED else "."
    units = data.table("trials").attrs.get("units", {})
    for factor in data.factors:
        levels = [level(value) for value in data.levels(factor)]
        if factor in ("round", "study_session"):
            continue
        unit = f" {in_print(units[factor])}" if factor in units else ""
        text += f" The factor {words_of(factor, units.get(factor, ''))} had {len(levels)} levels: {listed(levels)}{unit}."
    conditions = _levels(trials, "condition")
    if len(conditions) > 1 and not data.factors:
        shown = listed(conditions) if len(conditions) <= _MOST_LISTED else ", ".join(conditions[:_MOST_LISTED]) + ", ..."
        text += f" There were {len(conditions)} conditions: {shown}."
    states = [str(state.get("name")) for state in data.task.get("states") or [] if state.get("name")]
    return text + (f" Each trial went through {counted(len(states), 'state')}: {listed(states)}." if states else "")


def _perturbations(told: dict[str, Any]) -> str:
    rows = (told.get("perturbations") or {}).get("rows") or []
    each = [f"{row[0]}{f' (in {row[1]})' if row[1] else ''}: {row[2]}" for row in rows]
    return f"Perturbations: {'; '.join(each)}." if each else ""


def _outcomes(data: Data) -> str:
    if not data.has("trials") or "outcome" not in data.table("trials"):
        return ""
    outcomes = data.table("trials")["outcome"].fillna("none").astype(str).value_counts()
    every = [f"{n} {outcome}" for outcome, n in outcomes.items()]
    return f"Outcomes of {counted(int(outcomes.sum()), 'attempt')}: {listed(every)}."


def means_of(data: Data, measure: str, by: list[str], table: str = "trials") -> pd.DataFrame:
    """Means of a measure: a row for each combination of the columns `by`, in the order of their levels, with `mean`, `sd`,
    and the 95 % interval from `low` to `high` over `n` people, or over `n` trials of one person; and the number of `trials`.
    """
    trials = counting_trials(data, table).assign(all="")
    keys = by or ["all"]
    each = each_in_conditions(trials, measure, keys, len(data.people) == 1)
    means = means_with_intervals(each, keys, dropna=False).rename(columns={"value": "mean"})
    spread = each.groupby(keys, dropna=False).agg(sd=("value", "std"), trials=("n", "sum")).reset_index()
    return data.in_order(means.merge(spread, on=keys), by).reset_index(drop=True)


def _measured(data: Data) -> list[str]:
    """The first measures, and those of lifts, in each condition: mean and SD over people, or over the trials of one person."""
    if _trials(data).empty:
        return []
    own = [("trials", measure.column) for measure in data.measures[:_MOST_MEASURES]]
    if data.has("lifts") and not own:
        known = counting_trials(data, "lifts")
        own = [("lifts", name) for name in _OF_LIFTS if name in known and known[name].notna().any()]
    axes = axes_of_design(data)
    by = [axes["x"]] if axes else []
    # groups, and rounds, are never averaged over
    by += [name for name in (axes.get("colour"), axes.get("panel")) if name in ("group", "round", "study_session")]
    out = [_sentence(data, measure, by, table) for table, measure in own]
    if len(data.measures) > _MOST_MEASURES:
        out[-1] += " The tables above have the other measures."
    return out


def _sentence(data: Data, measure: str, by: list[str], table: str) -> str:
    """A measure in each condition: "Movement time (mean ± SD): 0.69 ± 0.08 s (40 mm), ..."."""
    units = data.table("trials").attrs.get("units", {})
    unit = in_print(data.measure(measure, table).unit)
    means = means_of(data, measure, by, table)
    texts = []
    for row in means.head(_MOST_LISTED).to_dict("records"):
        of = ", ".join(level(row[name], units.get(name, "")) for name in by)
        value = f"{_with_spread(row['mean'], row['sd'])} {unit if unit != '1' else ''}".strip()
        texts.append(f"{value} ({of})" if of else value)
    more = f", and {len(means) - _MOST_LISTED} further conditions" if len(means) > _MOST_LISTED else ""
    trials = counted(int(means["trials"].sum()), "trial")
    people = counting_trials(data, table).dropna(subset=[measure])["person"].nunique()
    n = trials if len(data.people) == 1 else f"{counted(people, 'person', 'people')}, {trials}"
    over = [words_of(name, units.get(name, "")) for name in data.factors if name not in by]
    averaged = f"; averaged over {listed(over)}" if over else ""
    spread = "" if (means["n"] < 2).all() else f" (mean ± SD over {'trials' if len(data.people) == 1 else 'people'})"
    return f"{_capital(words_of(measure, data.measure(measure, table).unit))}{spread}: {listed(texts)}{more}; n = {n}{averaged}."


def _learned(data: Data) -> str:
    if not data.has("fits"):
        return ""
    fits = data.table("fits")
    fits["round"] = fits["round"].fillna("").astype(str)
    texts = []
    several = fits["group"].nunique() > 1
    for (group, part), own in fits.groupby(["group", "round"], sort=False):
        windows = []
        of = ", ".join(filter(None, [group if several else "", f"round {part}" if part else ""]))
        for window in ("baseline", "early", "late"):
            if window not in own or own[window].notna().sum() == 0:
                continue
            each = own.groupby("person")[window].mean().dropna()
            windows.append(f"{_with_spread(each.mean(), each.std())} {in_print(str(own['unit'].iloc[0]))} ({window})")
        if windows:
            texts.append(f"{listed(windows)}{f' in {of}' if of else ''}")
    spread = "mean ± SD over people" if len(data.people) > 1 else "means over at most eight trials"
    return f"Compensation ({spread}): {'; '.join(texts)}." if texts else ""


def _thresholds(data: Data) -> str:
    if not data.has("thresholds"):
        return ""
    table = data.table("thresholds")
    texts = []
    several = table["group"].nunique() > 1
    for (group, name), own in table.groupby(["group", "procedure"], sort=False):
        procedure = f"{name} ({group})" if several else name
        if len(data.people) == 1:
            row = own.iloc[0]
            if pd.notna(row["threshold"]):
                between = f" (95 % {row['threshold_95']})" if isinstance(row.get("threshold_95"), str) else ""
                texts.append(f"{in_short(row['threshold'])}{between} in {procedure}, of {row['trials']} answers")
            continue
        each = own[own["note"].isna()].groupby("person")["threshold_share"].mean().dropna()
        if len(each):
            texts.append(f"{_with_spread(each.mean(), each.std())} in {procedure} (n = {counted(len(each), 'person', 'people')})")
    kind = " (mean ± SD, as a share of the perturbation)" if len(data.people) > 1 else ""
    return f"Thresholds{kind}: {listed(texts)}." if texts else ""
