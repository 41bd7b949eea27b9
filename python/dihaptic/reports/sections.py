"""What the page of a report says of one sample: facts, figures, and tables."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pandas as pd

from .._head import why_unreadable
from ..errors import error
from ..figures.conditions import LIFT_MEASURES, axes_of_design, counting_trials
from ..figures.data import Data, sitting_columns
from ..figures.drawing import Drawn, draw_data
from ..figures.learning import learning_windows
from ..figures.lifts import previous_weight
from ..figures.means import means_with_intervals
from ..figures.words import counted, in_print, label, level, words_of
from .page import Page, in_short
from .text import in_words, means_of
from .trials import trials_to_look_at

#: Figures of lifts.csv whose medians are on the page.
_OF_LIFTS = [
    "preload_s", "loading_s", "peak_grip_rate_N_s", "peak_load_rate_N_s", "peak_grip_N", "static_grip_N", "static_load_N",
    "static_ratio", "safety_margin", "grip_load_r", "grip_load_lag_s", "overshoot_mm",
]  # fmt: skip
#: Most groups of lifts that are columns of their table; more are rows.
_MOST_COLUMNS = 6
#: Parameters of the models of learning in fits.csv.
_OF_MODELS = {
    "A_slow": "slow retention", "B_slow": "slow learning", "A_fast": "fast retention", "B_fast": "fast learning",
    "A": "retention, single rate", "B": "learning, single rate",
}  # fmt: skip
#: Trials of a window of a learning curve at most, as in fits.csv.
_WINDOW = 8
#: Columns of thresholds.csv on the page, and their names there.
_OF_THRESHOLDS = {
    "threshold": "threshold", "threshold_95": "95 %", "weber_fraction": "Weber fraction", "shape": "shape", "lapse": "lapses",
    "trials": "answers", "note": "note",
}  # fmt: skip


def add_sample(
    page: Page, data: Data, told: dict[str, Any], figures: Path, *, jobs: int, progress: Callable[[str], None] | None
) -> list[Drawn]:
    """Adds a sample to the page, and saves its figures in the folder `figures`. `told` is what the program says of it
    (src/analysis/report/report_json.cpp). Raises Error."""
    _facts(page, data, told)
    drawn = draw_data(data, figures, jobs=jobs, progress=progress)
    tables: dict[str, Callable[[Page, Data], None]] = {
        "Quality of the data": _outcomes, "By condition": _measures, "Grip and lift": _lifts, "Learning": _learning,
        "Movements": _corrections, "Thresholds": _thresholds,
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
    methods, results = in_words(data, told)
    page.heading("In words")
    page.text("A start for a paper's methods and results, with the numbers from above.", "caption")
    for paragraph in [*methods, *results]:
        page.text(paragraph)
    settings = data.sessions[0].folder / "settings.csv"
    if len(data.sessions) == 1 and settings.is_file():
        page.heading("Settings")
        page.table(data.table("settings")[["setting", "value", "origin"]].fillna(""), folded="All settings, with their origins")
    return drawn


def _figure(page: Page, drawn: Drawn) -> None:
    base = drawn.script.with_suffix("")
    svg = _text_of(base.with_suffix(".svg"), drawn.script)
    points = _text_of(base.with_suffix(".csv"), drawn.script)
    caption = drawn.plan.caption
    if drawn.kept:
        caption += f" Drawn by {drawn.script.name} as you have changed it; the caption is that of the figure before."
    page.figure(svg, drawn.plan.title, caption, f"{base.parent.name}/{base.name}", points)


def _text_of(file: Path, script: Path) -> str:
    """A file of a figure, which a script that somebody has changed need not have made. Raises Error."""
    if fault := why_unreadable(file):
        raise error(f"cannot be read: {fault}", f"Run {script.name}, which has been changed, or remove it.", file=str(file))
    return file.read_text(encoding="utf-8", errors="replace")


# Facts


def _facts(page: Page, data: Data, told: dict[str, Any]) -> None:
    if len(data.sessions) == 1:
        _facts_of_session(page, data, told)
    else:
        people = data.people
        groups = sorted({sitting.group for sitting in data.sittings} - {""})
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
                f"These sessions have {len(data.tasks)} different tasks of one title. The description of the design below is "
                "that of the first one; conditions of the same name are taken to be the same.",
                "warning",
            )
    perturbations = told.get("perturbations") or {"columns": [], "rows": []}
    table = pd.DataFrame(perturbations["rows"], columns=perturbations["columns"])
    page.table(table, "Perturbations; the column share of trials.csv states how much of each acts.")
    if told.get("not_measured"):
        page.text(
            f"Dihaptic does not yet measure the learning of these perturbations: {told['not_measured']}. Figures of "
            "trials under them are empty. The hand's movement is in trials.csv, and in full in session.nwb.",
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
        "notes": "; ".join(map(str, info.get("notes") or [])),
        "note by hand": str(told.get("note") or ""),
    }
    page.facts(facts)


# Tables of each part


def _outcomes(page: Page, data: Data) -> None:
    """What a supervisor is warned of, and how many attempts had each outcome, by block."""
    for text in _warnings(data):
        page.text(text, "warning")
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


def _warnings(data: Data) -> list[str]:
    """Sessions whose ticks missed something, in sentences."""
    ticks, missed, people = 0, 0, set()
    for sitting in data.sittings:
        convergence = sitting.session.info.get("convergence") or {}
        ticks += int(sitting.session.info.get("ticks") or 0)
        if convergence.get("missed"):
            missed += int(convergence["missed"])
            people.add(sitting.person)
    if not missed:
        return []
    share = f"{100 * missed / ticks:.2g} % of " if ticks else ""
    return [
        f"In {missed} ticks ({share}{ticks}) the contact solver missed its tolerance: {', '.join(sorted(people)[:12])}"
        f"{' and others' if len(people) > 12 else ''}. Look at the forces of these sessions before you use them."
    ]


def _measures(page: Page, data: Data) -> None:
    """Each measure by condition, and why it is missing."""
    if not data.has("trials") or not data.measures:
        return
    trials = counting_trials(data)
    page.table(_by_condition(data, [measure.column for measure in data.measures], "trials"), _caption_of_means(data))
    rows = [
        {"measure": label(measure.column, measure.unit), "trials": int(trials[measure.column].notna().sum()), "missing": why}
        for measure in data.measures
        if (why := _reasons(trials[trials[measure.column].isna()], measure.column))
    ]
    page.table(pd.DataFrame(rows), "Values that could not be computed are left out, not zero.")


def _caption_of_means(data: Data) -> str:
    over = "trials" if len(data.people) == 1 else "people's means over trials"
    return (
        f"Means, with their 95 % intervals over {over}. Practice, catch trials and repeated attempts are left out; so are force "
        "channels, of measures that other trials have."
    )


def _by_condition(data: Data, measures: list[str], table: str) -> pd.DataFrame:
    """Means of measures, with intervals: a row for each measure and combination of the other factors, and a column for each
    level of the first factor."""
    axes = axes_of_design(data)
    columns = axes.get("x", "")
    others = [axes[name] for name in ("colour", "panel") if name in axes]
    units = data.table("trials").attrs.get("units", {})
    known = counting_trials(data, table)
    rows = []
    for measure in (name for name in measures if known[name].notna().any()):
        by = [columns, *others] if columns else []
        means = means_of(data, measure, by, table)
        unit = data.measure(measure, table).unit
        key = others if others[1:] else "".join(others)  # pandas gives a level for a name, and a tuple for a list
        for case, own in means.groupby(key, sort=False, dropna=False) if key else [((), means)]:
            cases = case if isinstance(case, tuple) else (case,)
            row: dict[str, Any] = {"measure": label(measure, unit)}
            row |= {words_of(name, units.get(name, "")): _level(v, units.get(name, "")) for name, v in zip(others, cases)}
            for _, each in own.iterrows():
                column = _level(each[columns], units.get(columns, "")) if columns else "mean"
                row[column] = _with_interval(each["mean"], each["low"], each["high"])
            row["n"] = int(own["n"].max())
            rows.append(row)
    out = pd.DataFrame(rows).fillna("-")
    return out[[*(name for name in out if name != "n"), "n"]] if "n" in out else out


def _reasons(missing: pd.DataFrame, measure: str) -> str:
    """How often a measure is missing, by reason: "12: no movement (9), not over when its states ended (3)"."""
    if missing.empty or "not_measured" not in missing:
        return ""
    counts: dict[str, int] = {}
    for text in missing["not_measured"].fillna("").astype(str):
        for one in text.split("; ") if text else []:
            of, _, why = str(one).partition(": ")
            if not why or measure.startswith(of):
                counts[why or of] = counts.get(why or of, 0) + 1
    # a trial that a measure is not asked for has no reason
    return ", ".join(f"{why} ({n})" for why, n in sorted(counts.items(), key=lambda each: -each[1]))


def _lifts(page: Page, data: Data) -> None:
    """Medians of lifts by block and condition, and what the weight before does."""
    if not data.has("lifts"):
        return
    lifts = data.table("lifts")
    if "lift" in lifts and not (lifts["lift"] == "complete").any():
        return  # of another task: objects that are pushed, or carried from the start
    trials = data.table("trials")
    keys = [key for key in (*sitting_columns(lifts), "trial_num", "attempt") if key in trials]
    design = [name for name in ("study_session", "round", "block", "kind", "condition") if name in trials]
    design = [name for name in design if name not in keys]
    own = lifts.drop(columns=design, errors="ignore").merge(trials[[*keys, *design]], on=keys, how="left")
    groups = ["group"] if own["group"].nunique() > 1 else []
    own = data.in_order(own, [name for name in (*groups, "block", "condition") if name in own])
    own["lifts"] = _joined(own, [*groups, *design]) if design else "all"
    rows = []
    for group, each in own.groupby("lifts", sort=False):
        complete = each[each["lift"] == "complete"] if "lift" in each else each
        row: dict[str, Any] = {"trials": group, "lifts": len(each), "complete": len(complete)}
        for name in _OF_LIFTS:
            if name in each and own[name].notna().any():
                values = each.groupby("person")[name].median()
                row[label(name, str(lifts.attrs.get("units", {}).get(name, "")))] = values.mean()
        rows.append(row)
    page.table(_by_condition(data, [name for name in LIFT_MEASURES if name in lifts], "lifts"), _caption_of_means(data))
    over = "Medians over lifts" if len(data.people) == 1 else "Means over people of each person's median"
    table = pd.DataFrame(rows)
    if len(table) <= _MOST_COLUMNS:
        table = table.set_index("trials").T.rename_axis(columns=None).reset_index(names="trials")
    page.table(table, f"{over}; an incomplete lift counts for the figures that it has.")
    _previous_weight(page, data)


def _previous_weight(page: Page, data: Data) -> None:
    effects = previous_weight(data)
    what = "the largest rate of load force changes by {} N/s for each N of the weight lifted before"
    for group, own in effects.groupby("group", sort=False):
        of = f" ({group})" if group else ""
        if len(own) == 1:
            one = own.iloc[0]
            text = what.format(f"{in_short(one['effect'])} ± {in_short(one['error'])}")
            text += f" (standard error, {one['n']} pairs of lifts)"
        else:
            text = what.format(_with_interval(*_mean_of(own["effect"]))) + f" (95 %, {len(own)} people)"
        page.text(f"Weight of the lift before{of}, with that of this lift in one regression: {text}.")


def _learning(page: Page, data: Data) -> None:
    """Compensation in windows, the models' parameters, and what is known of the curves."""
    if not data.has("fits"):
        return
    fits = data.table("fits")
    fits["round"] = fits["round"].fillna("").astype(str)
    for note in dict.fromkeys(fits["note"].dropna().astype(str) if "note" in fits else []):
        page.text(f"Of a learning curve it is said: {note}.")
    try:
        points = learning_windows(data)
    except ValueError:  # no curve of these sessions has a window
        points = pd.DataFrame(columns=["of"])
    means = points[points["of"] == "mean"] if (points["of"] == "mean").any() else points
    rows: dict[tuple[str, str], dict[str, Any]] = {}
    for row in means.to_dict("records"):
        group = str(row["group"]) if isinstance(row.get("group"), str) else ""
        unit = in_print(str(row["unit"]))
        own = rows.setdefault((str(row["part"]), group), {"round": row["part"], "group": group, "unit": unit})
        own[str(row["window"]).replace("_", ", ")] = _with_interval(row["value"], row["low"], row["high"])
    over = "people" if len(data.people) > 1 else "trials"
    caption = f"Compensation in windows of one block each: mean over {over}, with its 95 % interval."
    page.table(_without_empty(pd.DataFrame(list(rows.values()))).fillna("-"), caption)
    if data.has("adaptation") and (text := shared_windows(data.table("adaptation"))):
        page.text(text, "warning")
    single = len(data.people) == 1
    caption = "with 95 % profile intervals" if single else "medians over people, with quartiles"
    page.table(_models(fits, single), f"Models of learning, fitted to each curve by least squares: {caption}.")


def shared_windows(adaptation: pd.DataFrame) -> str:
    """Says of adaptation.csv whether early and late are means over some of the same trials; "" if they are not."""
    least: dict[str, int] = {}
    keys = [*sitting_columns(adaptation), "round"]
    for case, own in adaptation.groupby(keys, sort=False, dropna=False):
        blocks = own.loc[own["kind"] == "perturbed", "block"].unique()
        measured = int(own.loc[own["block"].isin(blocks), "compensation"].notna().sum())
        if len(blocks) == 1 and 0 < measured < 2 * _WINDOW:
            least[str(blocks[0])] = min(measured, least.get(str(blocks[0]), measured))
    if not least:
        return ""
    few = ", ".join(f"{block}: {count}" for block, count in least.items())
    return (
        f"Early and late share trials, and differ by less than what was learned: their block has fewer than {2 * _WINDOW} "
        f"measured trials ({few}). Measure more of its trials, as by more force channels, or draw the curve."
    )


def _models(fits: pd.DataFrame, single: bool) -> pd.DataFrame:
    """The models' parameters, a row for each round."""
    rows = []
    several = fits["group"].nunique() > 1
    for (group, part), own in fits.groupby(["group", "round"], sort=False):
        row: dict[str, Any] = {"group": group if several else "", "round": part}
        for name, words in _OF_MODELS.items():
            if name not in own or own[name].notna().sum() == 0:
                continue
            if single:
                between = f" ({own[f'{name}_95'].iloc[0]})" if f"{name}_95" in own else ""
                row[words] = in_short(own[name].iloc[0]) + between
            else:
                # rates lie between 0 and 1, and people's are far from normal
                low, middle, high = own.groupby("person")[name].mean().quantile([0.25, 0.5, 0.75])
                row[words] = _with_interval(middle, low, high)
        if len(row) > 2:
            rows.append(row)
    return _without_empty(pd.DataFrame(rows))


def _corrections(page: Page, data: Data) -> None:
    if data.has("corrections"):
        table = data.table("corrections").drop(columns=["session", "simulated", "moved_by", "population"], errors="ignore")
        page.table(_without_empty(table), "When the mean velocity parts from that of matched trials.")


def _thresholds(page: Page, data: Data) -> None:
    """The fitted thresholds: of one person with their intervals, of several their means."""
    if not data.has("thresholds"):
        return
    table = data.table("thresholds")
    if len(data.people) == 1:
        out = pd.DataFrame({"procedure": table["procedure"]})
        for column, name in _OF_THRESHOLDS.items():
            if column in table:
                out[name] = table[column]
        caption = "Fitted by maximum likelihood to all answers, with lapses up to 5 %; intervals from the profile likelihood."
        page.table(_without_empty(out), caption)
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
            "group": group, "procedure": procedure, "people": len(each), "mean": mean, "95 %": _between(low, high),
            "SD": each.std(),
        })  # fmt: skip
    caption = "Thresholds over people, as shares of the perturbation or in the unit of the number's name."
    if unfit:
        caption += f" {unfit} {'is' if unfit == 1 else 'are'} left out, for reasons in population-thresholds.csv."
    page.table(_without_empty(pd.DataFrame(rows)), caption)


# Words


def _level(value: Any, unit: str) -> str:
    return level(value.item() if hasattr(value, "item") else value, unit)


def _mean_of(values: pd.Series) -> tuple[float, float, float]:
    """A mean, and its 95 % interval; NaN for what too few values do not tell."""
    means = means_with_intervals(pd.DataFrame({"value": values, "all": 0}), ["all"])
    if means.empty:
        return math.nan, math.nan, math.nan
    return float(means["value"].iloc[0]), float(means["low"].iloc[0]), float(means["high"].iloc[0])


def _between(low: Any, high: Any) -> str:
    return "-" if pd.isna(low) or pd.isna(high) else f"{in_short(low)} to {in_short(high)}"


def _with_interval(value: Any, low: Any, high: Any) -> str:
    known = not (pd.isna(low) or pd.isna(high)) and in_short(low) != in_short(high)
    return in_short(value) + (f" ({_between(low, high)})" if known else "")


def _joined(table: pd.DataFrame, columns: list[str]) -> pd.Series:
    """The words of several columns, without those that are empty, or repeat the one before."""
    rows = table[[column for column in columns if column in table]].fillna("").astype(str)
    return rows.apply(lambda row: ", ".join(dict.fromkeys(filter(None, row))) or "all", axis=1)


def _without_empty(table: pd.DataFrame) -> pd.DataFrame:
    """The table without columns that are empty."""
    empty = [name for name in table if table[name].isna().all() or (table[name].astype(str) == "").all()]
    return table.drop(columns=empty)
