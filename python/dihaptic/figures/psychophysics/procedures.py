"""The procedures whose answers the trials have, those answers, and the functions that a report fitted to them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd

from ...errors import NotThere, error
from ..data import Data, sitting_columns
from ..means import t_quantile
from ..words import words_of

ALL = "all of these"  # kind of a fit to the answers of several procedures
#: Columns of a table of points that have a procedure's properties.
PANEL = ["procedure", "kind", "quantity", "unit", "logarithmic", "yes"]


@dataclass(frozen=True)
class Procedure:
    """A procedure, or several procedures whose answers share a function, as recorded in procedures.csv."""

    name: str
    parts: tuple[str, ...]  # names of the procedures
    sitting: str  # session of a study; "" if there is none
    kind: str
    quantity: str  # the quantity that it chooses, in words
    unit: str  # unit of its levels; "" for shares
    column: str  # column of trials.csv with its levels
    logarithmic: bool
    yes: str
    no: str
    sigmoid: str
    guess: float
    guess_is_lapse: bool
    standard: float
    skipped: int  # number of first reversals of a staircase to ignore
    down_after: int  # consecutive answers of yes that lower a staircase's level

    @property
    def title(self) -> str:
        """The procedure's name in a figure."""
        name = f"{self.name}, together" if self.kind == ALL else self.name
        return f"{self.sitting}: {name}" if self.sitting else name

    def panel(self) -> dict[str, Any]:
        """The procedure's properties that a drawing needs."""
        return {
            "procedure": self.title, "kind": self.kind, "quantity": self.quantity, "unit": self.unit,
            "logarithmic": self.logarithmic, "yes": self.yes,
        }  # fmt: skip


def is_yes(value: Any) -> bool:
    return value is True or str(value).lower() in ("yes", "true")


def text_of(value: Any) -> str:
    return "" if pd.isna(value) else str(value)


def _sitting_of(session: Any) -> str:
    """The name that a session has in its study; "" without a study."""
    return str((session.info.get("in_study") or {}).get("session", "") or "")


def procedures_of(data: Data) -> list[Procedure]:
    """The procedures of the task that chose a level, in its order, and the joint ones of thresholds.csv."""
    trials = data.table("trials")
    if "procedure" not in trials or "outcome" not in trials:
        return []
    days = trials["study_session"].fillna("").astype(str) if "study_session" in trials else pd.Series("", trials.index)
    asked = trials["procedure"].notna()
    missing = set(zip(days[asked], trials.loc[asked, "procedure"].astype(str)))
    several = days.nunique() > 1
    found: list[Procedure] = []
    for session in data.sessions:
        place = _sitting_of(session) if "study_session" in trials else ""
        if not any(sitting == place for sitting, _ in missing) or "procedures" not in session.tables:
            continue
        for row in session.table("procedures").to_dict("records"):
            if (place, str(row["procedure"])) in missing:
                missing.discard((place, str(row["procedure"])))
                found.append(_procedure(data, row, place if several else ""))
    return [*found, *_joint(data, found)]


def _procedure(data: Data, row: dict[str, Any], sitting: str) -> Procedure:
    trials = data.table("trials")
    column = text_of(row.get("level"))
    unit = str(trials.attrs.get("units", {}).get(column, "")) if column else ""
    staircase: dict[str, Any] = {}
    for own in data.task.get("procedures") or []:
        if str(own.get("name")) == str(row["procedure"]):
            staircase = own.get("staircase") or {}
    return Procedure(
        name=str(row["procedure"]), parts=(str(row["procedure"]),), sitting=sitting, kind=text_of(row.get("kind")),
        quantity=words_of(column, unit) if column else "share of the perturbation", unit=unit, column=column or "share",
        logarithmic=is_yes(row.get("logarithmic")), yes=text_of(row.get("yes")), no=text_of(row.get("no")),
        sigmoid=text_of(row.get("sigmoid")), guess=float(row.get("guess", np.nan)),
        guess_is_lapse=is_yes(row.get("guess_is_lapse")), standard=float(row.get("standard", np.nan)),
        skipped=int(staircase.get("skipped_reversals", 0) or 0), down_after=int(staircase.get("down_after", 1) or 1),
    )  # fmt: skip


def _joint(data: Data, single: list[Procedure]) -> list[Procedure]:
    """Several procedures to whose answers one function was fitted: thresholds.csv joins their names by commas."""
    if not data.has("thresholds"):
        return []
    table = data.table("thresholds")
    out = []
    for name in dict.fromkeys(table.loc[table["kind"] == ALL, "procedure"].astype(str)):
        for sitting in dict.fromkeys(each.sitting for each in single):
            parts = _parts(name, [each for each in single if each.sitting == sitting])
            if len(parts) > 1:
                out.append(replace(parts[0], name=name, parts=tuple(each.name for each in parts), kind=ALL))
    return out


def _parts(name: str, candidates: list[Procedure]) -> list[Procedure]:
    """The candidates whose names, joined by commas in their order, are `name`; [] if there are none."""
    for i, each in enumerate(candidates):
        if name == each.name:
            return [each]
        if name.startswith(f"{each.name}, "):
            rest = _parts(name[len(each.name) + 2 :], candidates[i + 1 :])
            if rest:
                return [each, *rest]
    return []


def chosen(data: Data, procedures: list[str] | None) -> list[Procedure]:
    """The procedures with these titles, by default all. Raises NotThere, or Error when there is none."""
    known = procedures_of(data)
    if not known:
        raise error("has no trials of a procedure", "Name a session whose task has procedures.", file=str(data.folder))
    if procedures is None:
        return known
    for name in procedures:
        titles = [each.title for each in known]
        if name not in titles:
            raise NotThere(name, "is not a procedure of these trials", titles, "procedures.csv lists them.")
    return [each for each in known if each.title in procedures]


def is_single(data: Data) -> bool:
    """Whether all trials are those of one session of one person."""
    trials = data.table("trials")
    return len(trials[sitting_columns(trials)].drop_duplicates()) == 1


def _of_sitting(table: pd.DataFrame, procedure: Procedure) -> pd.DataFrame:
    table = table.assign(group=table["group"].fillna(""))
    if procedure.sitting and "study_session" in table:
        table = table[table["study_session"].astype(str) == procedure.sitting]
    return table


def answers_of(data: Data, procedure: Procedure) -> pd.DataFrame:
    """The answers of all people, in order: the level in its unit, whether the answer was yes, and the answer's number from 1."""
    trials = _of_sitting(data.table("trials"), procedure)
    own = trials[trials["procedure"].isin(procedure.parts) & trials["outcome"].isin([procedure.yes, procedure.no])].copy()
    own["level"] = pd.to_numeric(own[procedure.column], errors="coerce") if procedure.column in own else np.nan
    own = own[np.isfinite(own["level"]) & ((own["level"] > 0) | (not procedure.logarithmic))]
    own["said_yes"] = own["outcome"] == procedure.yes
    keys = sitting_columns(own)
    own["answer"] = own.groupby(keys).cumcount() + 1 if len(own) else pd.Series(dtype=int)
    return own[[*keys, "trial_num", "answer", "level", "said_yes"]]


def fits_of(data: Data, procedure: Procedure) -> pd.DataFrame:
    """Rows of thresholds.csv with a fitted function; `guess`: its note says why its threshold is one."""
    if not data.has("thresholds"):
        return pd.DataFrame(columns=["person", "group", "guess"])
    table = _of_sitting(data.table("thresholds"), procedure)
    table = table[(table["procedure"].astype(str) == procedure.name) & ((table["kind"] == ALL) == (procedure.kind == ALL))]
    # only the latest report of a session is used
    table = table.drop_duplicates(sitting_columns(table), keep="last")
    table = table[table["threshold"].notna() & (table["shape"] > 0)]
    return table.assign(guess=table["note"].notna())


def finished(parts: list[dict[str, Any]], columns: list[str], procedures: list[str] | None) -> pd.DataFrame:
    out = pd.DataFrame(parts).reindex(columns=columns)
    if out.empty:
        raise error("has no answers", "Name procedures that were answered.", key=", ".join(procedures or []))
    return out


def mean_of(values: pd.Series, logarithmic: bool) -> dict[str, Any]:
    """The mean over people with its 95 % interval (Student's t); it is the mean of the logarithms, if levels are logarithms."""
    x = np.log10(values) if logarithmic else values
    n = len(x)
    middle = x.mean()
    half = t_quantile(max(1, n - 1), 0.975) * x.std() / np.sqrt(n) if n > 1 else np.nan
    ends = [middle, middle - half, middle + half]
    value, low, high = [10**end if logarithmic else end for end in ends]
    return {"n": n, "value": value, "low": low, "high": high}
