"""Reads what figures are drawn from: the tables of one session, of a rehearsal, of a study, or of a folder of sessions."""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import pandas as pd
import yaml

from .._facts import facts
from ..errors import Error, NotThere, error
from ..rehearsal import Rehearsal
from ..session import Session
from ..study import Study
from ..tables import Collected, command_of
from .words import label

#: Trials of these kinds are not among those that show the effect of a condition.
ASIDE = ["practice", "catch"]
#: Columns that tell the sessions of all people apart.
SITTING = ("person", "group", "session", "study_session")
#: Columns of trials.csv that describe a trial, or how it was done, and that are no measure.
_END_OF_DESIGN = "attempt"
_AFTER_MEASURES = ["not_measured", "simulated", "moved_by", "start_type", "replays"]


@dataclass(frozen=True)
class Measure:
    """A column of a table that a figure can show.

    >>> from dihaptic import figures
    >>> figures.read(lift_session).measure("peak_grip_N", "lifts").label
    'peak grip [N]'
    """

    column: str
    unit: str  #: "" for a pure number
    meaning: str  #: may be ""

    @property
    def label(self) -> str:
        """Its name and unit, for an axis."""
        return label(self.column, self.unit)


def read(path: str | Path, people: list[str] | None = None) -> Data:
    """The tables of a session's folder, of a rehearsal's, of a study's file, or of a folder that contains sessions.

    `people` names those who count, in all figures and means; the default is everybody. A rehearsal and a study are read
    from their collected tables (dihaptic collect). Raises Error when there is nothing, and NotThere for a person's name.

    >>> from dihaptic import figures
    >>> figures.read(lift_session)
    <Data of one session: Two fingers lift a block>
    """
    return Data(path, people)


class Data:
    """The tables that figures are drawn from, of one person or of many.

    Every table has the columns `person` and `group` ("" without groups). `path` is what was read.

    >>> from dihaptic import figures
    >>> data = figures.read(lift_session)
    >>> list(data.table("trials").columns[:2]), data.has("thresholds")
    (['person', 'group'], False)
    """

    def __init__(self, path: str | Path, people: list[str] | None = None) -> None:
        self.path = Path(os.path.abspath(path))
        self._only: list[str] | None = None
        self._collected: Collected | None = None
        if self.path.is_file() and self.path.suffix in (".yaml", ".yml") and self.path.name != "session.yaml":
            self._collected = study = Study(self.path)
            self.sessions = _sessions_in(study.folder / "sessions")
        elif (self.path / "rehearsal.yaml").is_file():
            self._collected = rehearsal = Rehearsal(self.path)
            self.sessions = [Session(folder) for folder in rehearsal.sessions]
            self._check_collected()
        elif (self.path / "session.yaml").is_file() or self.path.is_file():
            self.sessions = [Session(self.path)]
        else:
            self.sessions = _sessions_in(self.path)
        if not self.sessions:
            raise error(
                "contains no completed sessions",
                "Name a session's folder, a rehearsal's, a study's file, or a folder that contains sessions.",
                file=str(path),
            )
        titles = {str(session.info.get("title", "")) for session in self.sessions}
        if len(titles) > 1 and self._collected is None:
            raise error(
                f"contains sessions of {len(titles)} experiments: {', '.join(sorted(titles))}",
                "Name a folder with the sessions of one of them.",
                file=str(path),
            )

        if people is not None:
            for name in people:
                if name not in self.people:
                    raise NotThere(name, "is not a person of these sessions", self.people, "Data.people lists them.")
            self.__dict__.pop("_cache")
            self._only = list(people)
            self.sessions = [session for session in self.sessions if _person_of(session) in self._only] or self.sessions

    def _check_collected(self) -> None:
        """Raises Error when the joined tables of a rehearsal are missing, or older than its people."""
        trials = self.path / "trials.csv"
        known = pd.read_csv(trials, usecols=["id"], dtype=str)["id"].nunique() if trials.is_file() else 0
        if known < len(self.sessions):
            raise error(
                f"has tables of {known} of {len(self.sessions)} people", f"Type {command_of('collect', self.path)}.",
                file=str(self.path),
            )  # fmt: skip

    def __repr__(self) -> str:
        count = len(self.sessions)
        return f"<Data of {'one session' if count == 1 else f'{count} sessions'}: {self.title}>"

    @property
    def folder(self) -> Path:
        """Where figures of these data go: beside their tables."""
        return self.path.parent if self.path.is_file() else self.path

    @property
    def title(self) -> str:
        """The experiment's title."""
        return str(self.sessions[0].info.get("title", ""))

    @property
    def recorded(self) -> list[Session]:
        """The sessions with a session.nwb: a rehearsal keeps the tables alone."""
        return [session for session in self.sessions if (session.folder / "session.nwb").is_file()]

    @cached_property
    def task(self) -> dict[str, Any]:
        """The task of the first session, frozen (task.yaml); empty for a session without a task. Raises Error."""
        file = self.sessions[0].folder / "task.yaml"
        if not file.exists():
            return {}
        try:
            task = yaml.load(file.read_text(encoding="utf-8"), getattr(yaml, "CSafeLoader", yaml.SafeLoader))
        except (OSError, UnicodeDecodeError, yaml.YAMLError, RecursionError) as why:
            raise error(f"cannot be read: {why}", "Restore the file from a copy of the session.", file=str(file)) from None
        return task if isinstance(task, dict) else {}

    # Tables

    @cached_property
    def tables(self) -> list[str]:
        """Names of the tables, without .csv."""
        if self._collected is not None:
            return self._collected.tables
        return sorted({name for session in self.sessions for name in session.tables})

    def has(self, name: str) -> bool:
        """Whether there is such a table, with at least one row."""
        return name in self.tables and len(self.table(name)) > 0

    def table(self, name: str) -> pd.DataFrame:
        """A table of all people, by its name; units and meanings of its columns are in `attrs`. Raises NotThere, Error."""
        cache: dict[str, pd.DataFrame] = self.__dict__.setdefault("_cache", {})
        if name not in cache:
            table = self._read(name)
            if self._only is not None:
                attrs, table = table.attrs, table[table["person"].isin(self._only)].reset_index(drop=True)
                table.attrs = attrs
            cache[name] = table
        return cache[name].copy()

    def _read(self, name: str) -> pd.DataFrame:
        if self._collected is not None:
            table = self._collected.table(name)
            person = table["id"].astype(str)
            # rehearsals that were joined have people of the same names; a study's sessions have seeds of their own
            if isinstance(self._collected, Rehearsal) and "seed" in table and table["seed"].nunique() > 1:
                person = table["seed"].astype(str) + "/" + person
            group = table["group"].fillna("").astype(str) if "group" in table else pd.Series("", index=table.index)
            return _marked(table, person, group)
        if name not in self.tables:
            raise NotThere(name, "is not a table of these sessions", self.tables, "Data.tables lists them.")
        parts = []
        for session in self.sessions:
            if name not in session.tables:
                continue
            table = session.table(name)
            person = _person_of(session)
            group = str((session.info.get("in_study") or {}).get("group", "") or "")
            part = _marked(table, pd.Series(person, index=table.index), pd.Series(group, index=table.index))
            part.insert(2, "session", session.folder.name)
            parts.append(part)
        out = pd.concat(parts, ignore_index=True)
        out.attrs = parts[0].attrs
        return out

    @property
    def people(self) -> list[str]:
        """Names of the people, in the order of their sessions."""
        return list(dict.fromkeys(self.table("trials")["person"]))

    # The design

    @cached_property
    def factors(self) -> list[str]:
        """Columns of trials.csv that are factors of the design, those with a single level left out."""
        names = [str(factor["factor"]) for factor in self.task.get("cross") or []]
        for each in [*(self.task.get("conditions") or []), *(self.task.get("rounds") or [])]:
            names += [str(name) for name in (each.get("factors") or {}) if str(name) not in names]
        trials = self.table("trials")
        return [name for name in names if name in trials and trials[name].nunique() > 1]

    @cached_property
    def blocks(self) -> list[str]:
        """Names of the blocks, in the order of the task."""
        return [str(block["name"]) for block in self.task.get("blocks") or []]

    @cached_property
    def conditions(self) -> list[str]:
        """Names of the conditions, in the order of the task."""
        return [str(condition["name"]) for condition in self.task.get("conditions") or []]

    def levels(self, column: str) -> list[Any]:
        """The levels of a column that describes trials: numbers by size, words in the order of the task or of the trials.

        >>> from dihaptic import figures
        >>> figures.read(lift_session).levels("outcome")
        ['done']
        """
        found = list(self.table("trials")[column].dropna().unique())
        if not any(isinstance(value, str) for value in found):
            return sorted(found)
        known: list[Any] = {"condition": self.conditions, "block": self.blocks}.get(column, [])
        for factor in self.task.get("cross") or []:
            known = known or (list(factor["levels"]) if factor["factor"] == column else [])
        for condition in self.task.get("conditions") or []:
            known = [*known, (condition.get("factors") or {}).get(column)]
        return [*dict.fromkeys(value for value in known if value in found), *(value for value in found if value not in known)]

    @cached_property
    def measures(self) -> list[Measure]:
        """The numeric measures and answers of the task that have a value in some trial, as columns of trials.csv."""
        trials = self.table("trials")
        columns = [str(column) for column in trials.columns]
        first = columns.index(_END_OF_DESIGN) + 1 if _END_OF_DESIGN in columns else len(columns)
        built_in = {name for name, _ in facts()["columns"]["trials.csv"]}
        numeric = trials.select_dtypes("number").columns
        return [
            self.measure(column)
            for column in columns[first:]
            if column in numeric and column not in _AFTER_MEASURES
            and column not in built_in and trials[column].notna().any()
        ]  # fmt: skip

    def measure(self, column: str, table: str = "trials") -> Measure:
        """A column of a table as a measure. Raises NotThere."""
        found = self.table(table)
        if column not in found:
            raise NotThere(column, f"is not a column of {table}", [str(c) for c in found], "")
        meaning = str(found.attrs.get("meanings", {}).get(column, ""))
        for own in self.task.get("custom_measures") or []:
            if str(own.get("name", "")) and column.startswith(str(own["name"])):
                meaning = meaning or str(own.get("value", own.get("expression", "")))
        return Measure(column, str(found.attrs.get("units", {}).get(column, "")), meaning)

    # Words

    @property
    def is_simulated(self) -> bool:
        """Whether simulated people moved all hands."""
        trials = self.table("trials")
        return "simulated" in trials and bool(trials["simulated"].all())

    @property
    def mark(self) -> str:
        """The short mark in each figure's corner: "simulated" if no person took part."""
        return "simulated" if self.is_simulated else ""


def sittings(table: pd.DataFrame) -> list[str]:
    """Columns of a table that tell the sessions of all people apart."""
    return [column for column in SITTING if column in table]


def _person_of(session: Session) -> str:
    """A session's participant; a session without a name counts as a person of its own."""
    return str((session.info.get("participant") or {}).get("id", "") or session.folder.name)


def _marked(table: pd.DataFrame, person: pd.Series, group: pd.Series) -> pd.DataFrame:
    """The table with the columns person and group in front."""
    attrs = table.attrs
    table = table.drop(columns=["group", "person"], errors="ignore")
    table.insert(0, "person", person)
    table.insert(1, "group", group)
    table.attrs = attrs
    return table


def _sessions_in(folder: Path) -> list[Session]:
    """The completed sessions in a folder, at any depth; sessions that another one resumes are left out."""
    sessions, resumed = [], set()
    for file in sorted(folder.rglob("session.yaml")):
        session = Session(file)
        try:
            info = session.info
        except Error:
            continue
        if info.get("resumes"):
            resumed.add(Path(str(info["resumes"])).name)
        if info.get("state") == "complete":
            sessions.append(session)
    return [session for session in sessions if session.folder.name not in resumed]
