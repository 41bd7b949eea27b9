"""Finds the sessions to include: in a session's folder, a rehearsal's, a study's, or any folder that contains sessions."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any, Union

import pandas as pd

from .._facts import facts
from .._head import MOST_YAML, why_unreadable
from ..errors import Error, error
from ..session import Session
from ..study import Study

#: What to read: a path, or a list of paths to compare.
Paths = Union[str, Path, Sequence[Union[str, Path]]]  # in a form that Python 3.9 can read


@dataclass(frozen=True)
class Sample:
    """Sessions that may be averaged: those of one experiment, in which a person, a script, or one population's people moved
    the hand.

    >>> from dihaptic import figures
    >>> figures.samples_in(lift_session)
    [Sample(experiment='Two fingers lift a block', moved_by='script', population='')]
    """

    experiment: str | None  #: its title
    moved_by: str | None  #: who moved the hand, e.g. "devices" (a person) or "simulated_person"; "": not recorded
    population: str | None  #: the population of simulated people

    @property
    def is_simulated(self) -> bool:
        """Whether no person moved the hand."""
        return self.moved_by not in ("devices", "mouse", "")

    def is_among(self, wanted: Sample) -> bool:
        """Whether it has the values that are wanted, of which None stands for any."""
        pairs = zip(asdict(self).values(), asdict(wanted).values())
        return all(want is None or have == want for have, want in pairs)

    def __str__(self) -> str:
        if self.moved_by is None:
            return str(self.experiment)
        mover = (self.moved_by or "something that was not recorded").replace("_", " ")
        return f"{self.experiment}, moved by {mover}{f' ({self.population})' if self.population else ''}"


def samples_in(path: Paths) -> list[Sample]:
    """The samples that the sessions at a path belong to, in the order of their titles.

    If several paths are compared, these are the experiments. Raises Error.
    """
    return Sittings(path).samples


#: Some columns of tables that are not in docs/tables.md.
_OTHER_COLUMNS = {"settings": {"setting"}, "procedures": {"procedure"}, "trial-list": {"trial_num"}}
#: Columns of these tables, and of tables of points; a factor or measure with such a name is renamed.
_OWN = {
    "person", "group", "session", "study_session", "study_condition", "measure", "of", "n", "value", "low", "high", "part", "all",
    "first", "last", "window", "phase", "number",
}  # fmt: skip


def renamed(column: str) -> str:
    """The name of a table's column here, which differs because a factor that is called "session" is not the session.

    >>> renamed("session"), renamed("mass_g")
    ('session (column)', 'mass_g')
    """
    return f"{column} (column)" if column in _OWN else column


def _checked(session: Session, name: str) -> pd.DataFrame:
    """A session's table. Raises Error when it has none of the columns that the program writes."""
    table = session.table(name)
    known = {column for column, _ in facts()["columns"].get(f"{name}.csv", [])} or _OTHER_COLUMNS.get(name, set())
    _check_numbers(table, session.folder / f"{name}.csv")
    if known and not known & set(table):
        what = "is not the table that its name suggests: it has none of that table's columns"
        raise error(what, "Restore it from a copy of the session.", file=str(session.folder / f"{name}.csv"))
    return table


def _check_numbers(table: pd.DataFrame, file: Path) -> None:
    """Converts the columns with units to numbers. "NA" and "nan", as R and numpy save them, are empty cells. Raises Error."""
    for column in table.attrs.get("units", {}):
        if table[column].dtype != object or table[column].isna().all():
            continue
        numbers = pd.to_numeric(table[column].replace({"NA": None, "nan": None, "NaN": None}), errors="coerce")
        wrong = (numbers.isna() & table[column].notna() & ~table[column].isin(["NA", "nan", "NaN"])).to_numpy()
        if not wrong.any():
            table[column] = numbers
        elif numbers.notna().any():  # a column of words keeps them, even if its name ends in a unit
            line = int(wrong.argmax()) + 2  # after the header
            what = f"is '{table[column].iloc[line - 2]}', which is not a number"
            raise error(what, "Correct this line, or restore the table.", file=str(file), line=line, key=str(column))


@dataclass(frozen=True)
class Sitting:
    """A session, and its person."""

    session: Session
    person: str
    group: str
    study_session: str = ""
    study_condition: str = ""
    name: str = ""  #: name of the session, which no other of these sessions has
    of: str = ""  #: the path at which it was found, if there are several

    @property
    def _mover(self) -> dict[str, Any]:
        return self.session.info.get("moved_by") or {}

    @cached_property
    def sample(self) -> Sample:
        """The people with whom this one may be averaged."""
        mover = str(self._mover.get("mover") or "")
        mover = "" if mover == "not_recorded" else mover
        return Sample(str(self.session.info.get("title", "")), mover, str(self._mover.get("population") or ""))

    @property
    def seed(self) -> str:
        """The seed from which a simulated person was drawn; "" for others, and in a study, where a name has one person."""
        return "" if self.study_session else str(self._mover.get("seed") or "")

    @property
    def population(self) -> str:
        """The population of a simulated person; "" for others."""
        return str(self.sample.population or "")

    @cached_property
    def laboratory(self) -> int:
        """The number of a simulated person's laboratory; 0 for other people, and for those of one median laboratory."""
        file = self.session.folder / "person.yaml"
        if not self.population or why_unreadable(file, MOST_YAML):
            return 0
        found = re.search(r"^laboratory: (\d+)$", file.read_text(encoding="utf-8", errors="replace"), re.MULTILINE)
        return int(found[1]) if found else 0

    def table(self, name: str) -> pd.DataFrame:
        """A table of the session, preceded by columns that tell whose it is. Raises Error."""
        table = _checked(self.session, name)
        attrs = table.attrs
        columns = {"person": self.person, "group": self.group, "session": self.name or self.session.folder.name}
        if self.study_session:
            columns |= {"study_session": self.study_session, "study_condition": self.study_condition}
        # factors have names of their own; columns of other tables are the program's
        table = table.rename(columns=renamed) if name == "trials" else table.drop(columns=list(columns), errors="ignore")
        for place, (name, value) in enumerate(columns.items()):
            table.insert(place, name, value)
        table.attrs = attrs
        return table


class Sittings:
    """The sessions at a path, or at several: those that are included, and the reasons why the others are not."""

    def __init__(self, path: Paths) -> None:
        each = [path] if isinstance(path, (str, Path)) else list(path)
        if not each:
            raise error("is missing", "Name a session's folder, or one that contains sessions.", key="path")
        self.paths = [Path(os.path.abspath(one)) for one in each]
        self.left_out: list[str] = []
        self.counting: list[Sitting] = []
        taken: set[Path] = set()
        for one, name in zip(self.paths, _names_of(self.paths)):
            found = list(self._at(one))
            again = [each for each in found if each.session.folder.resolve() in taken]
            if again:
                what = f"has {again[0].session.folder.name}, which another one of these paths has as well"
                raise error(what, "Name each session once.", file=str(one))
            taken |= {each.session.folder.resolve() for each in found}
            if not found:
                raise error(
                    "contains no completed sessions",
                    "Name a session's folder, a rehearsal's, a study's file, or a folder that contains sessions.",
                    file=str(one),
                )
            if len(self.paths) > 1:
                found = [replace(each, of=name, group=", ".join(filter(None, [name, each.group]))) for each in found]
            self.counting += found

    @property
    def samples(self) -> list[Sample]:
        """The samples that the sessions belong to, in the order of their titles; of several paths, the experiments."""
        samples = {sitting.sample for sitting in self.counting}
        if len(self.paths) > 1:
            samples = {Sample(sample.experiment, None, None) for sample in samples}
        return sorted(samples, key=str)

    def _at(self, path: Path) -> Iterator[Sitting]:
        if path.is_file() and path.suffix in (".yaml", ".yml") and path.name != "session.yaml":
            yield from self._of_study(path)
        elif path.is_file() or os.path.lexists(path / "session.yaml"):
            yield _sitting(Session(path))
        else:
            yield from self._in_folder(path)

    def _of_study(self, file: Path) -> Iterator[Sitting]:
        study = Study(file)
        for (participant, name), rows in study.sessions.groupby(["participant", "study_session"], sort=False):
            try:
                session = study.session(participant, name)
            except Error as why:
                self.left_out.append(str(why))
                continue
            row = rows.iloc[0]
            condition = "" if pd.isna(row["study_condition"]) else str(row["study_condition"])
            yield Sitting(session, participant, str(row["group"]), name, condition)

    def _in_folder(self, folder: Path) -> Iterator[Sitting]:
        """Finds sessions at any depth, by the rules of `dihaptic report`."""
        sessions = []
        for link in sorted(folder.iterdir() if folder.is_dir() else []):
            if link.is_symlink() and (link / "session.yaml").is_file():
                self.left_out.append(f"{link}: it is a link; name the folder that it leads to")
        for file in sorted(folder.rglob("session.yaml")):
            try:
                session = Session(file)
                if session.info.get("state") == "running":
                    raise error("has not ended", "", file=str(session.folder))
                sessions.append(session)
            except Error as why:
                self.left_out.append(str(why))
        resumed = {Path(str(session.info["resumes"])).name for session in sessions if session.info.get("resumes")}
        first: dict[str, Path] = {}
        for session in sessions:
            identity = str(session.info.get("identity") or "")
            copied = first.setdefault(identity, session.folder)
            # on the virtual clock, two runs of a session are identical to the bit, but neither is a copy
            if copied != session.folder and identity and session.info.get("clock") == "real":
                why_not = f"it is the same session as {copied}"
            elif session.folder.name in resumed:
                why_not = "another session resumes it"
            elif _stands_in(session):
                why_not = "a simulated person stood in for the participant"
            elif _is_cut_short(session) and not _counts_in_study(session):
                why_not = "it ended before its trials were done"
            else:
                yield _sitting(session)
                continue
            self.left_out.append(f"{session.folder}: {why_not}")


def named_apart(sittings: list[Sitting]) -> list[Sitting]:
    """The sittings with names of their own.

    Simulated people with the same name who were drawn from different seeds have the seed in their names; likewise, parts of
    their paths are in the names of sessions. A person in several groups counts as one person.
    """
    names = _names_of([sitting.session.folder for sitting in sittings])
    sittings = [replace(sitting, name=name) for sitting, name in zip(sittings, names)]
    for what in ("seed", "population"):
        told: dict[str, set[str]] = {}
        for sitting in sittings:
            told.setdefault(sitting.person, set()).add(getattr(sitting, what))
        if any(len(each) > 1 for each in told.values()):
            sittings = [replace(s, person="/".join(filter(None, [getattr(s, what), s.person]))) for s in sittings]
    return sittings


def _sitting(session: Session) -> Sitting:
    place = session.info.get("in_study") or {}
    # a session without a name counts as a person of its own
    person = str((session.info.get("participant") or {}).get("id") or session.folder.name)
    names = [str(place.get(key) or "") for key in ("group", "session", "condition")]
    return Sitting(session, person, *names)


def _names_of(paths: list[Path]) -> list[str]:
    """A name for each path: its last part, with those before it where that is not enough to tell them apart."""
    parts = 1
    while parts < 9:
        names = ["/".join((path.parent / path.stem if path.is_file() else path).parts[-parts:]) for path in paths]
        if len(set(names)) == len(paths):
            return names
        parts += 1
    return [str(path) for path in paths]


def _stands_in(session: Session) -> bool:
    """Whether a simulated person did a participant's session of a study (`run --simulate`), in the participant's folder."""
    person = str((session.info.get("participant") or {}).get("id") or "")
    return bool(session.info.get("in_study")) and person == f"sim-{session.folder.parent.parent.name}"


def _counts_in_study(session: Session) -> bool:
    """Whether `dihaptic collect` includes a session that ended early, according to the study's `resuming`. The study's file
    lies beside the folder sessions/PARTICIPANT/STUDY_SESSION."""
    place, above = session.info.get("in_study") or {}, session.folder.resolve().parents
    if not place or len(above) < 4:
        return False
    for file in sorted(above[3].glob("*.y*ml")):
        try:
            study = Study(file)
            if study.title == place.get("study"):
                return study.session(above[1].name, above[0].name).folder.resolve() == session.folder.resolve()
        except Error:  # another kind of file, or a study without this session
            continue
    return False


def _is_cut_short(session: Session) -> bool:
    """Whether a session ended before its trials were done."""
    state = session.info.get("state")
    if state not in ("interrupted", "recovered") or not (session.folder / "trial-list.csv").is_file():
        return False
    if state == "interrupted":
        return True
    trials = session.table("trials")
    return len(trials) == 0 or trials["outcome"].iloc[-1] == "interrupted"
