"""Which lifts a figure shows, which conditions and panels they belong to, and what its caption says of their number."""

from __future__ import annotations

from typing import Any

import pandas as pd

from ...errors import NotThere
from ..data import ASIDE, Data, sitting_columns, with_design
from ..words import counted, label, level

#: Maximum numbers of conditions in a panel, and of panels side by side.
MOST_CASES, MOST_PANELS = 6, 4


def _joined(data: Data, trials: pd.DataFrame, lifts: pd.DataFrame) -> pd.DataFrame:
    """Each lift with the columns of its trial, numbered for each person; of repeated attempts, the last."""
    frame = with_design(trials, lifts, data.factors)
    frame = frame.drop_duplicates([*sitting_columns(frame), "trial_num"], keep="last")
    for column in ("kind", "block", "condition", "perturbation"):
        if column not in frame:
            frame[column] = ""
    frame = frame.reset_index(drop=True)
    frame["lift_number"] = frame.groupby(["group", "person"], dropna=False).cumcount() + 1  # a person may be in two groups
    frame["presented"] = _presented(frame)
    return frame


def _presented(frame: pd.DataFrame) -> pd.Series:
    """The name of what differs between the trials of a block: the condition, the perturbation, or both."""
    words = pd.DataFrame(index=frame.index)
    words["condition"] = frame["condition"].fillna("").astype(str).replace("", "no condition")
    words["perturbation"] = frame["perturbation"].fillna("").astype(str).replace("", "no perturbation")
    kept = frame.loc[~frame["kind"].isin(["practice"])].index
    common = "perturbation" if words.loc[kept, "perturbation"].nunique() > 1 else "condition"
    out = words[common].copy()
    for _, own in words.groupby(frame["block"].fillna("")):
        varying = [column for column in words if own[column].nunique() > 1]
        if varying:
            out[own.index] = own[varying].agg(", ".join, axis=1)
    return out


def all_lifts(data: Data) -> pd.DataFrame:
    return _joined(data, data.table("trials"), data.table("lifts"))


def recorded_lifts(data: Data) -> pd.DataFrame:
    """The lifts of the sessions with a recording; `of` is the number of a lift's session in Data.recorded."""
    parts = []
    for number, each in enumerate(data.recorded):
        if {"trials", "lifts"} <= set(each.session.tables):
            part = _joined(data, each.table("trials"), each.table("lifts"))
            parts.append(part.assign(of=number))
    out = pd.concat(parts, ignore_index=True) if parts else all_lifts(data).iloc[:0].assign(of=0)
    if not out.empty:
        out["presented"] = _presented(out)
    return out


def counting(frame: pd.DataFrame, catch: bool) -> pd.DataFrame:
    """Complete lifts, without practice, and without catch trials unless they are wanted."""
    aside = [kind for kind in ASIDE if not (catch and kind == "catch")]
    return frame[(frame["lift"] == "complete") & ~frame["kind"].isin(aside)]


# Conditions and panels


def _levels(data: Data, column: str, found: list[Any]) -> list[Any]:
    """Levels of a column in order: numbers are sorted by size, words by their order in the task."""
    if not any(isinstance(value, str) for value in found):
        return sorted(found)
    known: list[Any] = []
    if column == "presented":
        known = ["no perturbation"] + [str(p["name"]) for p in data.task.get("perturbations") or []] + data.conditions
    elif column in data.table("trials"):
        known = data.levels(column)
    place = {value: i for i, value in enumerate(known)}
    return sorted(found, key=lambda value: place.get(value, len(place)))


def named(data: Data, frame: pd.DataFrame, colour: list[str], panel: str, most: int = MOST_CASES) -> pd.DataFrame:
    """The lifts, with condition and panel in words, sorted by condition and panel; those beyond the maximum are left out."""
    units = data.table("trials").attrs.get("units", {})
    for column in [*colour, *([panel] if panel else [])]:
        if column not in frame:
            raise NotThere(column, "is not a column of the trials", [str(c) for c in frame], "trials.csv has its columns.")
    frame = frame.copy()
    order: dict[str, list[str]] = {}
    for name, columns, cap in [("condition_shown", colour, most), ("panel", [panel] if panel else [], MOST_PANELS)]:
        ranks = pd.DataFrame(index=frame.index)
        words = pd.Series("", index=frame.index)
        for column in columns:
            rank = {value: i for i, value in enumerate(_levels(data, column, list(frame[column].dropna().unique())))}
            ranks[column] = frame[column].map(rank).fillna(len(rank))
            unit = str(units.get(column, "") or "")
            bare = len(columns) > 1 and not unit and pd.api.types.is_numeric_dtype(frame[column])
            prefix = f"{label(column)} " if bare else ""
            text = frame[column].map(lambda value, unit=unit, prefix=prefix: prefix + level(value, unit))
            words = text if column == columns[0] else words + ", " + text
        frame[name] = words
        if columns:
            order[name] = list(dict.fromkeys(words[ranks.sort_values(list(columns), kind="stable").index]))[:cap]
            frame = frame[frame[name].isin(order[name])]
    for name, names in order.items():
        frame[name] = pd.Categorical(frame[name], names, ordered=True)
    frame = frame.sort_values(["panel", "condition_shown", "lift_number"], kind="stable")
    return frame.assign(panel=frame["panel"].astype(str), case=frame["condition_shown"].astype(str))


def texts(points: pd.DataFrame, column: str) -> list[str]:
    """The distinct texts of a column, in their order; in a table read from CSV, an empty text is NaN."""
    return [str(text) for text in dict.fromkeys(points[column].fillna(""))]


def factors_of(data: Data, frame: pd.DataFrame) -> list[str]:
    """Factors of the design whose level differs between lifts; numbers that are rarely repeated do not count as levels."""
    names = [name for name in ["group", *data.factors] if name in frame]
    return [name for name in names if 1 < frame[name].nunique() <= max(2, len(frame) / 2)]


def design(data: Data, frame: pd.DataFrame) -> tuple[list[str], str]:
    """The columns that colours stand for, and the one that panels stand for."""
    factors = factors_of(data, frame)
    if not factors:
        if frame["presented"].nunique() < 2:
            return [], ""
        in_block = frame.groupby(frame["block"].fillna(""))["presented"].nunique()
        return ["presented"], "block" if 1 < len(in_block) and in_block.max() > 1 else ""
    if len(frame[factors].drop_duplicates()) <= MOST_CASES or len(factors) == 1:
        return factors, ""
    numeric = [name for name in factors if pd.api.types.is_numeric_dtype(frame[name])]
    colour = max(numeric or factors, key=lambda name: min(int(frame[name].nunique()), MOST_CASES))
    panel = min((name for name in factors if name != colour), key=lambda name: int(frame[name].nunique()))
    return [colour], panel


def shows_catches(data: Data) -> bool:
    """Whether catch trials are lifts of another object, in which case they show what was expected."""
    changes = any(part.get("body") for part in data.task.get("perturbations") or [])
    trials = data.table("trials")
    return changes and "kind" in trials and bool((trials["kind"] == "catch").any())


# Captions


def word(column: str) -> str:
    """A factor in words, without its unit, which is shown with the levels."""
    return label(column).removesuffix(" g").removesuffix(" N").removesuffix(" mm").removesuffix(" ms")


def counts_in_words(
    data: Data, frame: pd.DataFrame, catch: bool, colour: list[str], panel: str, most: int, practice: bool = False
) -> str:
    """The numbers of people and lifts that are drawn, and a note on those that are left out."""
    kept = frame[frame["lift"] == "complete"] if practice else counting(frame, catch)
    shown = named(data, kept, colour, panel, most)
    wanted = frame if practice else frame[~frame["kind"].isin([k for k in ASIDE if not (catch and k == "catch")])]
    text = f"{counted(shown['person'].nunique(), 'person', 'people')}, {counted(len(shown), 'lift')}"
    missing = len(wanted) - len(kept)
    text += f"; {counted(missing, 'incomplete lift')} left out" if missing else ""
    out = [] if practice or not (frame["kind"] != "").any() else ["practice", *([] if catch else ["catch trials"])]
    out = [*out, "repeated attempts"] if (frame["kind"] != "").any() else out
    text += f"; {' and '.join([', '.join(out[:-1]), out[-1]] if len(out) > 1 else out)} are left out" if out else ""
    return text + _left_out(data, kept, shown, colour, panel, most) + "."


def _left_out(data: Data, kept: pd.DataFrame, shown: pd.DataFrame, colour: list[str], panel: str, most: int) -> str:
    """A note for the caption on conditions and panels that exceed the maximum."""
    text = ""
    for columns, drawn, cap in ((colour, shown["case"], most), ([panel] if panel else [], shown["panel"], MOST_PANELS)):
        levels = kept[columns].drop_duplicates() if columns else kept.iloc[:0]
        if len(levels) > cap:
            names = texts(named(data, kept, columns, "", len(levels)), "case")
            gone = [name for name in names if name not in set(drawn)]
            more = f" and {len(gone) - 12} more" if len(gone) > 12 else ""
            text += f"; not shown, since only the first {cap} are: {', '.join(gone[:12])}{more}"
    return text
