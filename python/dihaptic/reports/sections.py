"""What the page of a report says of one sample: facts, figures, and tables."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pandas as pd

from .._head import why_unreadable
from ..errors import error
from ..figures.data import ASIDE, Data, sitting_columns
from ..figures.drawing import Drawn, draw_data
from ..figures.learning import learning_windows
from ..figures.lifts import previous_weight
from ..figures.means import means_with_intervals
from ..figures.words import counted, in_print, label
from .page import Page, in_short
from .text import in_words
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
        if len(data.sessions) > len(people) and all(not sitting.study_session for sitting in data.sittings):
            page.text("Participants with several sessions count once in means over people, with the mean of these sessions.")
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
    """How many attempts had each outcome, by block."""
    if not data.has("trials"):
        return
    trials = data.table("trials")
    if "outcome" not in trials or "block" not in trials:
        return
    block = _joined(trials, ["round", "block"])
    counts = pd.crosstab(block, trials["outcome"].fillna("none").astype(str))
    counts = counts.reindex(index=list(dict.fromkeys(block)), columns=list(dict.fromkeys(trials["outcome"].fillna("none"))))
    counts.columns.name = None
    counts.insert(0, "block", counts.index.astype(object))
    page.table(counts, f"Attempts at trials by outcome: {len(trials)} in all.")


def _counting(data: Data) -> pd.DataFrame:
    """The last attempt at each trial, without practice and catch trials."""
    trials = data.table("trials")
    if "attempt" in trials:
        trials = trials.drop_duplicates([*sitting_columns(trials), "trial_num"], keep="last")
    return trials[~trials["kind"].isin(ASIDE)] if "kind" in trials else trials


def _measures(page: Page, data: Data) -> None:
    """Each measure over all conditions, and why it is missing."""
    if not data.has("trials") or not data.measures:
        return
    trials = _counting(data)
    single = len(data.people) == 1
    rows = []
    for measure in data.measures:
        known = trials[trials[measure.column].notna()].rename(columns={measure.column: "value"})
        if known.empty:
            continue
        each = known if single else known.groupby("person")["value"].mean().reset_index()
        mean = means_with_intervals(each.assign(all=0), ["all"]).iloc[0]
        of = {} if single else {"people": len(each)}
        rows.append({
            "measure": label(measure.column, measure.unit), **of, "trials": len(known), "mean": mean["value"],
            "95 %": _between(mean["low"], mean["high"]), "SD": each["value"].std(),
            "missing": _reasons(trials[trials[measure.column].isna()], measure.column),
        })  # fmt: skip
    over = "trials" if single else "people's means"
    caption = f"Over all conditions, without practice, catch trials and repeated attempts; mean, interval and SD over {over}."
    page.table(_without_empty(pd.DataFrame(rows)), f"{caption} Values that could not be computed are left out, not zero.")


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
    keys = [key for key in (*sitting_columns(lifts), "trial_num", "attempt") if key in data.table("trials")]
    design = [name for name in ("round", "block", "kind", "condition") if name in data.table("trials")]
    own = lifts.drop(columns=design, errors="ignore").merge(data.table("trials")[[*keys, *design]], on=keys, how="left")
    own["lifts"] = _joined(own, design) if design else "all"
    rows = []
    for group, each in own.groupby("lifts", sort=False):
        complete = each[each["lift"] == "complete"] if "lift" in each else each
        row: dict[str, Any] = {"trials": group, "lifts": len(each), "complete": len(complete)}
        for name in _OF_LIFTS:
            if name in each and own[name].notna().any():
                values = each.groupby("person")[name].median()
                row[label(name, str(lifts.attrs.get("units", {}).get(name, "")))] = values.mean()
        rows.append(row)
    over = "Medians over lifts" if len(data.people) == 1 else "Means over people of each person's median"
    table = pd.DataFrame(rows)
    if len(table) <= _MOST_COLUMNS:
        table = table.set_index("trials").T.rename_axis(columns=None).reset_index(names="trials")
    page.table(table, f"{over}; an incomplete lift counts for the figures that it has.")
    effects = previous_weight(data)
    if len(effects) == 1:
        effect = effects.iloc[0]
        page.text(
            f"Weight of the previous lift: the largest rate of load force increases by {in_short(effect['effect'])} ± "
            f"{in_short(effect['error'])} N/s for each N of the previous object's weight ({effect['n']} pairs of lifts), "
            f"{in_short(100 * effect['share'])} % of the effect of both weights."
        )
    elif len(effects) > 1:
        mean = means_with_intervals(effects.rename(columns={"effect": "value"}).assign(all=0), ["all"]).iloc[0]
        page.text(
            f"Weight of the previous lift: the largest rate of load force increases by {in_short(mean['value'])} N/s "
            f"(95 % {_between(mean['low'], mean['high'])}, {len(effects)} people) for each N of the previous object's weight."
        )


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
    single = len(data.people) == 1
    caption = "with 95 % profile intervals" if single else "means over people, with 95 % intervals"
    page.table(_models(fits, single), f"Models of learning, fitted to each curve by least squares: {caption}.")


def _models(fits: pd.DataFrame, single: bool) -> pd.DataFrame:
    """The models' parameters, a row for each round."""
    rows = []
    for part, own in fits.groupby("round", sort=False):
        row: dict[str, Any] = {"round": part}
        for name, words in _OF_MODELS.items():
            if name not in own or own[name].notna().sum() == 0:
                continue
            if single:
                between = f" ({own[f'{name}_95'].iloc[0]})" if f"{name}_95" in own else ""
                row[words] = in_short(own[name].iloc[0]) + between
            else:
                each = own.groupby("person")[name].mean().dropna()
                mean = means_with_intervals(pd.DataFrame({"value": each, "all": 0}), ["all"]).iloc[0]
                row[words] = _with_interval(mean["value"], mean["low"], mean["high"])
        if len(row) > 1:
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
    for procedure, own in table.groupby("procedure", sort=False):
        # a note says why there is no fit, or that the threshold lies outside of the levels shown
        good = own[own["note"].isna() & own["threshold_share"].notna()]
        unfit += len(own) - len(good)
        each = good.groupby("person")["threshold_share"].mean()
        mean = means_with_intervals(pd.DataFrame({"value": each, "all": 0}), ["all"])
        low, high = (mean.iloc[0]["low"], mean.iloc[0]["high"]) if len(mean) else (None, None)
        rows.append({
            "procedure": procedure, "people": len(each), "mean": each.mean(), "95 %": _between(low, high), "SD": each.std(),
        })  # fmt: skip
    caption = "Thresholds over people, as shares of the perturbation or in the unit of the number's name."
    if unfit:
        caption += f" {unfit} {'is' if unfit == 1 else 'are'} left out, for reasons in population-thresholds.csv."
    page.table(pd.DataFrame(rows), caption)


# Words


def _between(low: Any, high: Any) -> str:
    return "-" if pd.isna(low) or pd.isna(high) else f"{in_short(low)} to {in_short(high)}"


def _with_interval(value: Any, low: Any, high: Any) -> str:
    return in_short(value) + ("" if pd.isna(low) or pd.isna(high) else f" ({_between(low, high)})")


def _joined(table: pd.DataFrame, columns: list[str]) -> pd.Series:
    """The words of several columns, without those that are empty, or repeat the one before."""
    rows = table[[column for column in columns if column in table]].fillna("").astype(str)
    return rows.apply(lambda row: ", ".join(dict.fromkeys(filter(None, row))) or "all", axis=1)


def _without_empty(table: pd.DataFrame) -> pd.DataFrame:
    """The table without columns that are empty."""
    empty = [name for name in table if table[name].isna().all() or (table[name].astype(str) == "").all()]
    return table.drop(columns=empty)
