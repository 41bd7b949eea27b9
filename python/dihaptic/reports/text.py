"""The methods in sentences: a draft for a paper."""

from __future__ import annotations

from typing import Any

import pandas as pd

from ..figures.data import Data, sitting_columns
from ..figures.words import counted, in_print, level, with_unit, words_of
from .page import in_short
from .results import MOST_LISTED, capital, listed, with_spreads

#: Maximum number of perturbations with a sentence; the table has the others.
_MOST_PERTURBATIONS = 6


def methods_of(data: Data, told: dict[str, Any]) -> list[str]:
    """Paragraphs of methods. `told` is the program's description of these sessions."""
    methods = [f"{_who(data, told)} {_apparatus(data)}", _design(data), _set_values(data), _perturbations(data, told)]
    return [text for text in methods if text]


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
        about.append(f"age {with_spreads(pd.Series([ages.mean()]), pd.Series([ages.std()]))[0]} years (mean ± SD)")
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
    devices = [f"the {device['finger']} ({device['model']})" for device in info.get("devices") or []]
    rate = settings.get("rate_Hz", "")
    text = f"Forces were computed and recorded {f'{rate} times a second ' if rate else ''}by {info.get('program', 'Dihaptic')}"
    if devices:
        text += f", and rendered to {listed(devices)}"
    text += "."
    stiffness = settings.get("coupling.stiffness_N_m", "")
    if stiffness:
        text += f" {'The' if len(devices) == 1 else 'Each'} device was connected to its virtual finger by a virtual coupling of {stiffness} N/m."
    solver = settings.get("dynamics.solver", "").replace("_", " ")
    return text + (f" Contact and friction were solved by the method {solver}." if solver else "")


def _trials(data: Data) -> pd.DataFrame:
    """The last attempt at each trial; no rows in a session without a task."""
    trials = data.table("trials") if data.has("trials") else pd.DataFrame()
    if "attempt" not in trials:
        return pd.DataFrame()
    return trials.drop_duplicates([*sitting_columns(trials), "trial_num"], keep="last")


def _levels(trials: pd.DataFrame, column: str) -> list[str]:
    """The words in a column, in the order of their first occurrence."""
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
        counts = own["kind"].astype(str).value_counts(sort=False)
        kinds = [f"{n} {kind.replace('_', ' ')}" if kind != block else str(n) for kind, n in counts.items()]
        blocks.append(f"{block or 'one block'} ({listed(kinds)} {'trial' if len(own) == 1 else 'trials'})")
    text = f"The experiment ({data.title}) had "
    if len(rounds) > 1:
        text += f"{len(rounds)} rounds ({listed(rounds)}), each with "
    text += f"{counted(len(blocks), 'block')}: {listed(blocks[:MOST_LISTED])}"
    text += f" and {len(blocks) - MOST_LISTED} further ones." if len(blocks) > MOST_LISTED else "."
    units = data.table("trials").attrs.get("units", {})
    for factor in data.factors:
        levels = [level(value) for value in data.levels(factor)]
        if factor in ("round", "study_session"):
            continue
        named = with_unit(listed(levels), units.get(factor, ""))
        text += f" The factor {words_of(factor, units.get(factor, ''))} had {len(levels)} levels: {named}."
    conditions = _levels(trials, "condition")
    if len(conditions) > 1 and not data.factors:
        shown = listed(conditions) if len(conditions) <= MOST_LISTED else ", ".join(conditions[:MOST_LISTED]) + ", ..."
        text += f" There were {len(conditions)} conditions: {shown}."
    states = [str(state.get("name")) for state in data.task.get("states") or [] if state.get("name")]
    return text + (f" Each trial went through {counted(len(states), 'state')}: {listed(states)}." if states else "")


def _set_values(data: Data) -> str:
    """Names the measures that describe what was presented."""
    names = [words_of(name, data.measure(name).unit) for name in data.stimuli]
    return f"{capital(listed(names))} {'was' if len(names) == 1 else 'were'} set by the experiment." if names else ""


def perturbations_table(data: Data, told: dict[str, Any]) -> pd.DataFrame:
    """The program's table of perturbations, in print, with the masses that factors make of those of the scene."""
    found = told.get("perturbations") or {"columns": [], "rows": []}
    masses = _masses(data)
    rows = [[*map(str, row)] for row in found["rows"]]
    for row in rows:
        row[-1] = "; ".join([in_print(row[-1]).replace(" \N{DEGREE SIGN}", "\N{DEGREE SIGN}"), *masses.get((row[0], row[1]), [])])
    return pd.DataFrame(rows, columns=found["columns"])


def _masses(data: Data) -> dict[tuple[str, str], list[str]]:
    """The masses of bodies whose density is changed, by perturbation and round or condition ("": neither)."""
    bodies = {str(body.get("name")): body.get("mass_kg") for body in data.scene.get("bodies") or []}
    out: dict[tuple[str, str], list[str]] = {}
    parts = [data.task, *(data.task.get("rounds") or []), *(data.task.get("conditions") or [])]
    for part in parts:
        for each in part.get("perturbations") or []:
            body = each.get("body") or {}
            factor, mass = body.get("density_scale"), bodies.get(str(body.get("body")))
            if isinstance(factor, (int, float)) and isinstance(mass, (int, float)) and factor != 1:
                of = "" if part is data.task else str(part.get("name") or "")
                out.setdefault((str(each.get("name")), of), []).append(f"{body['body']} of {level(1000 * mass * factor, 'g')}")
    return out


def _ramp_of(data: Data, block: str) -> int:
    """The number of trials over which the perturbations of a block rise to their size; 0 where they have it at once."""
    found = [each.get("ramp") for each in data.task.get("blocks") or [] if str(each.get("name")) == block]
    return int(found[0]) if found and isinstance(found[0], int) else 0


def _perturbations(data: Data, told: dict[str, Any]) -> str:
    """A sentence for each perturbation: its blocks, kind and size. Values that rounds or conditions replace are left out."""
    rows = perturbations_table(data, told).to_numpy().tolist()
    trials = _trials(data)
    within = {name: {row[1] for row in rows if row[0] == name} for name, *_ in rows}
    every = [set(parts) for parts in (data.rounds, data.conditions) if parts]
    rows = [row for row in rows if row[1] or not any(parts <= within[row[0]] for parts in every)]
    each = []
    for name, part, what in rows[:_MOST_PERTURBATIONS]:
        acts = [name in str(names).split(" + ") for names in trials["perturbation"]] if "perturbation" in trials else []
        blocks = _levels(trials[acts], "block") if any(acts) else []
        where = f"{'block' if len(blocks) == 1 else 'blocks'} {listed(blocks)}" if len(blocks) <= 3 and blocks else ""
        where = f" ({', '.join(filter(None, [part, where]))})" if part or where else ""
        ramps = [ramp for block in dict.fromkeys(blocks) if (ramp := _ramp_of(data, block)) > 1]
        grows = f", growing over the first {listed([str(ramp) for ramp in dict.fromkeys(ramps)])} trials of the block" if ramps else ""
        each.append(f"Perturbation {name}{where}: {what}{grows}.")
    if len(rows) > _MOST_PERTURBATIONS:
        each.append(f"The table has {len(rows) - _MOST_PERTURBATIONS} further ones.")
    return " ".join(each)
