"""The contents of a report's page about one sample: facts, figures, and tables."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pandas as pd

from .._head import why_unreadable
from ..errors import error
from ..figures.conditions import axes_of_design, counting_trials, measures_of_lifts
from ..figures.data import Data, with_design
from ..figures.drawing import Drawn, draw_data
from ..figures.learning import learning_windows
from ..figures.lifts import previous_weight, why_not_drawn
from ..figures.means import intervals, means_with_intervals, said_of_limits
from ..figures.quality import missing_values
from ..figures.words import counted, in_print, label, level, words_of
from .differences import add_differences
from .models import models_table, notes_on_models
from .page import Page, between, in_short, with_interval, without_empty
from .results import means_of, results_of, warnings_of
from .simulated import is_of_limits
from .text import methods_of, perturbations_table
from .trials import trials_to_look_at

#: Figures of lifts.csv whose medians are on the page.
_OF_LIFTS = [
    "preload_s", "loading_s", "peak_grip_rate_N_s", "peak_load_rate_N_s", "peak_grip_N", "static_grip_N", "static_load_N",
    "static_ratio", "safety_margin", "grip_load_r", "grip_load_lag_s", "overshoot_mm",
]  # fmt: skip
#: Columns of thresholds.csv on the page, and their names there.
_OF_THRESHOLDS = {
    "threshold": "threshold", "threshold_95": "95 %", "weber_fraction": "Weber fraction", "shape": "shape", "lapse": "lapses",
    "trials": "answers", "note": "note",
}  # fmt: skip


def add_sample(
    page: Page, data: Data, told: dict[str, Any], figures: Path, *, jobs: int, progress: Callable[[str], None] | None
) -> list[Drawn]:
    """Adds a sample to the page, and saves its figures in the folder `figures`: the result, its figures and tables, the
    quality of the data, and then details that few readers need. `told` is the program's description of the sample
    (src/analysis/report/report_json.cpp). Raises Error."""
    _facts(page, data, told)
    _result(page, data, told)
    add_differences(page, data)
    drawn = draw_data(data, figures, jobs=jobs, progress=progress)
    tables: dict[str, Callable[[Page, Data], None]] = {
        "Learning": _learning, "Thresholds": _thresholds, "By condition": _measures, "Grip and lift": _lifts,
        "Movements": _corrections, "Quality of the data": _outcomes, "Over trials": _nothing,
    }  # fmt: skip
    for heading, add_tables in tables.items():
        part = Page("", "", "")
        for each in drawn:
            if each.heading == heading:
                _figure(part, each)
        add_tables(part, data)
        if not part.is_empty:
            page.heading(heading)
            page.add(part)
    looked_at = trials_to_look_at(data)
    if looked_at:
        page.heading("Single trials")
        page.text(looked_at.pop("said"))
        page.viewer(looked_at)
    _methods(page, data, told)
    settings = data.sessions[0].folder / "settings.csv"
    if len(data.sessions) == 1 and settings.is_file():
        page.heading("Settings")
        page.table(data.table("settings")[["setting", "value", "origin"]].fillna(""), folded="All settings, with their origins")
    return drawn


def _result(page: Page, data: Data, told: dict[str, Any]) -> None:
    """The results, and warnings about them, before any figure."""
    results, warnings = results_of(data), warnings_of(data, told)
    if results or warnings:
        page.heading("Result")
    for text in results:
        page.text(text)
    for text in warnings:
        page.text(text, "warning")


def _methods(page: Page, data: Data, told: dict[str, Any]) -> None:
    """The methods in words, and the perturbations."""
    page.heading("Methods in words")
    page.text("A draft of a methods section. For the results section, begin with the sentences under Result.", "caption")
    for text in methods_of(data, told):
        page.text(text)
    table = perturbations_table(data, told)
    caption = "Perturbations; the column share of trials.csv states how much of each acts."
    if "in" in table and table["in"].nunique() > 1 and (table["in"] == "").any():
        caption += " A row with nothing under \"in\" holds wherever no other row of that perturbation replaces it."
    page.table(table, caption)


def _nothing(page: Page, data: Data) -> None:
    """A part of the page that has only figures."""


def _figure(page: Page, drawn: Drawn) -> None:
    base = drawn.script.with_suffix("")
    svg = _text_of(base.with_suffix(".svg"), drawn.script)
    points = _text_of(base.with_suffix(".csv"), drawn.script)
    caption = drawn.plan.caption
    if drawn.kept:
        caption += f" Drawn by {drawn.script.name} as you have changed it; the caption is that of the original figure."
    page.figure(svg, drawn.plan.title, caption, f"{base.parent.name}/{base.name}", points)


def _text_of(file: Path, script: Path) -> str:
    """A file of a figure, which may be missing if somebody has changed its script. Raises Error."""
    if fault := why_unreadable(file):
        raise error(f"cannot be read: {fault}", f"Run {script.name}, which has been changed, or remove it.", file=str(file))
    return file.read_text(encoding="utf-8", errors="replace")


# Facts


def _facts(page: Page, data: Data, told: dict[str, Any]) -> None:
    if len(data.sessions) == 1:
        _facts_of_session(page, data, told)
    else:
        people = data.people
        groups = data.groups
        said = f"{counted(len(data.sessions), 'session')} of {counted(len(people), 'participant')}"
        if groups:
            said += f" in {counted(len(groups), 'group')} ({', '.join(groups)})"
        names = ", ".join(people) if len(people) <= 40 else f"{', '.join(people[:39])} and {len(people) - 39} others"
        page.text(f"{said}: {names}.")
        days = sorted({sitting.study_session for sitting in data.sittings} - {""})
        if days:
            page.text(f"Sessions of the study: {', '.join(days)}.")
        elif len(data.sessions) > len(people) and not groups:
            page.text("Participants with several sessions count once in means over people, with the mean of these sessions.")
        if len(data.tasks) > 1:
            page.text(
                f"These sessions come from {len(data.tasks)} different tasks with the same title. The design described below is "
                "that of the first; conditions with the same name are treated as the same condition.",
                "warning",
            )


def _facts_of_session(page: Page, data: Data, told: dict[str, Any]) -> None:
    info = data.sessions[0].info
    person = info.get("participant") or {}
    who = [str(person.get("id") or "")]
    who += [f"{person['age']} years"] if person.get("age") else []
    who += [str(person["sex"])] if person.get("sex") else []
    who += [f"{person['handedness']}-handed"] if person.get("handedness") else []
    study = info.get("in_study") or {}
    facts = {
        "participant": ", ".join(filter(None, who)),
        "study": ", ".join(str(study[key]) for key in ("group", "session", "condition") if study.get(key)),
        "started": str(info.get("started") or ""),
        "state": str(info.get("state") or ""),
        "experiment": str(info.get("experiment") or ""),
        "command": str(info.get("command") or ""),
        "seed": str(info.get("seed", "")),
        "devices": "; ".join(f"{device['finger']}: {device['model']}" for device in info.get("devices") or []),
        "end": str(info.get("finished") or ""),
        "contact": str(told.get("contact") or ""),
        "notes": "; ".join(str(note) for note in info.get("notes") or [] if not is_of_limits(note)),
        "note by hand": str(told.get("note") or ""),
    }
    page.facts(facts)


# Tables of each part


def _outcomes(page: Page, data: Data) -> None:
    """How many attempts had each outcome, by block."""
    if not data.has("trials"):
        return
    trials = data.table("trials")
    if "outcome" not in trials or "block" not in trials:
        return
    block = _joined(trials, ["study_session", "round", "block"])
    counts = pd.crosstab(block, trials["outcome"].fillna("none").astype(str))
    counts = counts.reindex(index=list(dict.fromkeys(block)), columns=list(dict.fromkeys(trials["outcome"].fillna("none"))))
    counts.columns.name = None
    counts.insert(0, "block", counts.index.astype(object))
    page.table(counts, f"Attempts at trials by outcome: {len(trials)} in all.")


def _measures(page: Page, data: Data) -> None:
    """Each measure by condition, and the reasons for missing values."""
    if not data.has("trials") or not data.measures:
        return
    trials = counting_trials(data)
    _means(page, data, [measure.column for measure in data.measures], "trials")
    lacking = missing_values(trials)
    rows = []
    for measure in data.measures:
        own = lacking[lacking["measure"].map(lambda name, column=measure.column: column.startswith(str(name))).astype(bool)]
        counts = own.groupby("reason", sort=False)["trial"].nunique().sort_values(ascending=False, kind="stable")
        if len(counts):
            known = int(trials[measure.column].notna().sum())
            why = ", ".join(f"{reason} ({n})" for reason, n in counts.items())
            rows.append({"measure": label(measure.column, measure.unit), "trials": known, "missing": why})
    page.table(pd.DataFrame(rows), "Values that could not be computed are left out, not zero.")


def _means(page: Page, data: Data, measures: list[str], table: str) -> None:
    """The means of measures of trials.csv or lifts.csv, by condition."""
    axes = axes_of_design(data)
    keys = 1 + sum(name in axes for name in ("colour", "panel"))
    means, counts = _by_condition(data, measures, table)
    if means.empty:
        return
    trials = data.table("trials")
    has_channels = "kind" in trials and (trials["kind"] == "force_channel").any()
    channels = "; so are force channels, for measures that other trials have" if has_channels else ""
    caption = (
        f"Means over {'trials' if len(data.people) == 1 else 'people'}{intervals(counts)}. Practice, catch trials and "
        f"repeated attempts are left out{channels}."
        + said_of_limits({name: words_of(name, data.measure(name, table).unit) for name in measures})
    )
    page.table(means, caption, keys=keys)


def _by_condition(data: Data, measures: list[str], table: str) -> tuple[pd.DataFrame, pd.Series]:
    """Means of measures, with intervals: a row for each measure and combination of the other factors, and a column for each
    level of the first factor; and the number of values in each mean."""
    axes = axes_of_design(data)
    columns = axes.get("x", "")
    others = [axes[name] for name in ("colour", "panel") if name in axes]
    units = data.table("trials").attrs.get("units", {})
    known = counting_trials(data, table)
    rows: list[dict[str, Any]] = []
    counts: list[int] = []
    for measure in (name for name in measures if known[name].notna().any()):
        by = [columns, *others] if columns else []
        means = means_of(data, measure, by, table)
        counts += list(means["n"])
        unit = data.measure(measure, table).unit
        key = others if others[1:] else "".join(others)  # pandas gives a level for a name, and a tuple for a list
        for case, own in means.groupby(key, sort=False, dropna=False) if key else [((), means)]:
            cases = case if isinstance(case, tuple) else (case,)
            row: dict[str, Any] = {"measure": label(measure, unit)}
            row |= {words_of(name, units.get(name, "")): _level(v, units.get(name, "")) for name, v in zip(others, cases)}
            for _, each in own.iterrows():
                column = _level(each[columns], units.get(columns, "")) if columns else "mean"
                row[column] = with_interval(each["mean"], each["low"], each["high"])
            row["n"] = ", ".join(map(str, own["n"])) if own["n"].nunique() > 1 else int(own["n"].max())
            rows.append(row)
    out = pd.DataFrame(rows).fillna("-")
    out = out[[*(name for name in out if name != "n"), "n"]] if "n" in out else out
    return out, pd.Series(counts, dtype=int)


def _lifts(page: Page, data: Data) -> None:
    """Medians of lifts by block and condition, and the effect of the previous weight."""
    if not data.has("lifts"):
        return
    lifts = data.table("lifts")
    if "lift" in lifts and not (lifts["lift"] == "complete").any():
        if lifts["lift_off_s"].notna().any():
            page.text(why_not_drawn(data), "caption")
        return  # another kind of task: objects that are pushed, or carried from the start
    own = with_design(data.table("trials"), lifts, data.factors)
    design = [name for name in ("study_session", "round", "block", "kind", "condition") if name in own]
    groups = ["group"] if own["group"].nunique() > 1 else []
    own = data.in_order(own, [name for name in (*groups, "block", "condition") if name in own])
    own["lifts"] = _joined(own, [*groups, *design]) if design else "all"
    rows = []
    for group, each in own.groupby("lifts", sort=False):
        complete = each[each["lift"] == "complete"] if "lift" in each else each
        row: dict[str, Any] = {"median of": group, "lifts": len(each), "complete lifts": len(complete)}
        for name in _OF_LIFTS:
            if name in each and own[name].notna().any():
                values = each.groupby("person")[name].median()
                row[label(name, str(lifts.attrs.get("units", {}).get(name, "")))] = values.mean()
        rows.append(row)
    _means(page, data, measures_of_lifts(data), "lifts")
    over = "Medians over lifts" if len(data.people) == 1 else "Means over people of each person's median"
    table = pd.DataFrame(rows).set_index("median of").T.rename_axis(columns=None).reset_index(names="median of")
    caption = f"{over}, practice and catch trials included; an incomplete lift counts toward every measure that it has."
    if "safety margin" in list(table["median of"]):
        caption += " Safety margin: the share of the static grip that exceeds the least grip without slip."
    if why := why_not_drawn(data):
        page.text(why, "caption")
    page.table(table, caption, keys=1)
    _previous_weight(page, data)


def _previous_weight(page: Page, data: Data) -> None:
    effects = previous_weight(data)
    what = "the largest rate of load force changes by {} N/s for each N of the previous weight"
    for group, own in effects.groupby("group", sort=False):
        of = f" ({group})" if group else ""
        if len(own) == 1:
            one = own.iloc[0]
            text = what.format(f"{in_short(one['effect'])} ± {in_short(one['error'])}")
            text += f" (standard error, {one['n']} pairs of lifts)"
        else:
            text = what.format(with_interval(*_mean_of(own["effect"]))) + f" (95 %, {len(own)} people)"
        page.text(f"Weight of the previous lift{of}, with that of this lift in one regression: {text}.")


def _learning(page: Page, data: Data) -> None:
    """Compensation in windows, the models' parameters, and notes on the curves."""
    if not data.has("fits"):
        return
    fits = data.table("fits")
    fits["round"] = fits["round"].fillna("").astype(str)
    for note in dict.fromkeys(fits["note"].dropna().astype(str) if "note" in fits else []):
        page.text(f"Note on a learning curve: {note}.")
    try:
        points = learning_windows(data)
    except ValueError:  # no curve of these sessions has a window
        points = pd.DataFrame(columns=["of"])
    means = points[points["of"] == "mean"] if (points["of"] == "mean").any() else points
    rows: dict[tuple[str, str], dict[str, Any]] = {}
    part = "round" if data.rounds else "session"
    for row in means.to_dict("records"):
        group = str(row["group"]) if isinstance(row.get("group"), str) else ""
        unit = in_print(str(row["unit"]))
        own = rows.setdefault((str(row["part"]), group), {part: row["part"], "group": group, "unit": unit})
        own[str(row["window"]).replace("_", ", ")] = with_interval(row["value"], row["low"], row["high"])
    over = "people" if len(data.people) > 1 else "trials"
    caption = f"Compensation in windows of one block each: mean over {over}, with its 95 % interval."
    page.table(without_empty(pd.DataFrame(list(rows.values()))).fillna("-"), caption)
    single = len(data.people) == 1
    caption = "with 95 % profile intervals" if single else "medians over people, with quartiles"
    models = models_table(fits, single)
    page.table(models, f"Models of learning, fitted to each curve by least squares: {caption}.")
    if len(models) and (text := notes_on_models(data)):
        page.text(text, "warning")


def _corrections(page: Page, data: Data) -> None:
    if data.has("corrections"):
        table = data.table("corrections").drop(columns=["session", "simulated", "moved_by", "population"], errors="ignore")
        page.table(without_empty(table), "Times at which the mean velocity departs from that of matched trials.", keys=2)


def _thresholds(page: Page, data: Data) -> None:
    """The fitted thresholds: for one person with their intervals, for several people as means."""
    if not data.has("thresholds"):
        return
    table = data.table("thresholds")
    if len(data.people) == 1:
        out = pd.DataFrame({"procedure": table["procedure"]})
        for column, name in _OF_THRESHOLDS.items():
            if column in table:
                out[name] = table[column]
        caption = "Fitted by maximum likelihood to all answers, with lapses up to 5 %; intervals from the profile likelihood."
        page.table(without_empty(out), caption)
        return
    rows = []
    unfit = 0
    for (group, procedure), own in table.groupby(["group", "procedure"], sort=False):
        # a note says why there is no fit, or that the threshold lies outside of the levels shown
        good = own[own["note"].isna() & own["threshold_share"].notna()]
        unfit += len(own) - len(good)
        each = good.groupby("person")["threshold_share"].mean()
        mean, low, high = _mean_of(each)
        rows.append({
            "group": group, "procedure": procedure, "people": len(each), "mean": mean, "95 %": between(low, high),
            "SD": each.std(),
        })  # fmt: skip
    caption = "Thresholds over people, as shares of the perturbation or in the unit of the number's name."
    if unfit:
        caption += f" {unfit} {'is' if unfit == 1 else 'are'} left out, for reasons in population-thresholds.csv."
    page.table(without_empty(pd.DataFrame(rows)), caption)


# Words


def _level(value: Any, unit: str) -> str:
    return level(value.item() if hasattr(value, "item") else value, unit)


def _mean_of(values: pd.Series) -> tuple[float, float, float]:
    """A mean, and its 95 % interval; NaN where there are too few values."""
    means = means_with_intervals(pd.DataFrame({"value": values, "all": 0}), ["all"])
    if means.empty:
        return math.nan, math.nan, math.nan
    return float(means["value"].iloc[0]), float(means["low"].iloc[0]), float(means["high"].iloc[0])


def _joined(table: pd.DataFrame, columns: list[str]) -> pd.Series:
    """The words of several columns, without those that are empty or repeat the previous one."""
    rows = table[[column for column in columns if column in table]].fillna("").astype(str)
    return rows.apply(lambda row: ", ".join(dict.fromkeys(filter(None, row))) or "all", axis=1)
