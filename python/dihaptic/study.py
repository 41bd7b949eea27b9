"""Reads a whole study: its participants, their sessions, and the tables of all sessions."""

from __future__ import annotations

import csv
import io
import os
import re
import zlib
from collections.abc import Iterator
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from ._head import MOST_YAML, is_yes, part_of, read_info, why_unreadable
from ._seals import broken_seals
from .errors import Error, NotThere, error
from .session import Session
from .tables import Collected, command_of, parse_table

_BEFORE_FACTS = ["id", "group", "number", "age", "sex", "handedness"]
_AFTER_FACTS = ["added", "version", "withdrawn"]
#: Keys that each participant has, at the end; the last one is there even if the person has not withdrawn.
_LAST = ["added", "data_deleted"]
#: A folder in which the program is still making a session (src/session/unfinished_folder.h).
_UNFINISHED = "unfinished-"
#: The remedy for a mistake in a study's file.
_CHECK = "dihaptic check names the mistake."
#: The remedy for a damaged participants.yaml.
_ROSTER = "Restore the file: log.csv says who was added."
_REHEARSED = "Restore the file, or rehearse again into another folder."
#: Maximum size of a log.csv [bytes].
_MOST_LOG = 200_000_000
#: The remedy for a damaged session.yaml.
_AWAY = "Restore the file, or move the folder away."


class Study(Collected):
    """A study, opened by its file (docs/files/study.md): its participants, its recordings, and the tables that
    `dihaptic collect` has joined.

    `rehearsed` is the folder of the study's rehearsal, whose simulated people are read in place of the participants. As
    in `dihaptic collect`, sessions in which a simulated person stood in for a participant (`dihaptic run --simulate`)
    do not belong to it.

    `title` is the study's title, `groups` has the names of its groups in the order of its file, and `folder` is the
    folder of its participants and recordings. Everything else is read on request, and is as recent as the files. Raises
    Error when the file is not a study, or when there is no such rehearsal.

    >>> import dihaptic as dh
    >>> dh.Study("studies/two-groups.yaml").groups
    ['size-weight', 'unexpected-weight']
    >>> study = dh.Study(f"{folder}/two-days.yaml", rehearsed=f"{folder}/rehearsal")
    >>> study
    <Study two-days.yaml: Two days of lifting, 4 simulated people>
    >>> study.trials.groupby("group").id.unique().str.len().to_dict()
    {'heavy': 2, 'light': 2}
    """

    def __init__(self, file: str | Path, *, rehearsed: str | Path = "") -> None:
        self.file = Path(os.path.abspath(file))  # stays valid when the program changes its working folder
        spec = read_info(self.file, f"Name a study's file. {_CHECK}")
        for key in ("title", "groups", "sessions"):
            if not spec.get(key):
                raise error(f"is not a study: it has no {key}", "Name a study's file.", file=str(self.file))
        if rehearsed and not os.path.isdir(rehearsed):
            raise error(
                "is not a folder",
                f"Name the folder of the rehearsal. Without one, type {command_of('rehearse', self.file)}.",
                file=str(rehearsed),
            )
        self.title = part_of(spec, "title", str, self.file, _CHECK)
        self.groups = _names(spec, "groups", self.file)
        self.folder = Path(os.path.abspath(rehearsed)) if rehearsed else self.file.parent
        self._rehearsed = bool(rehearsed)
        self._sessions = _names(spec, "sessions", self.file)
        self._facts = _names(spec, "facts", self.file)
        self._enough = _enough(spec, self.file)
        allocation = part_of(spec, "allocation", dict, self.file, _CHECK)
        concealed = is_yes(allocation, "concealed", self.file, _CHECK, "allocation.")
        seed = part_of(allocation, "seed", str, self.file, _CHECK, "allocation.") or "1"
        codes = {name: _code_of(name, seed) for name in self.groups}
        #: The name shown for each group, by its name or code in participants.yaml.
        self._shown = {name: codes[name] if concealed else name for name in self.groups}
        self._shown.update({codes[name]: shown for name, shown in self._shown.items()})

    def __repr__(self) -> str:
        who = "simulated people" if self._rehearsed else "participants"
        return f"<Study {self.file.name}: {self.title}, {len(self._members())} {who}>"

    # People

    @property
    def participants(self) -> pd.DataFrame:
        """A row for each participant, in the order in which they were added, with those who withdrew.

        The columns are those of the collected table `participants`: `id`, `group`, `number` (in the group, from 1),
        `age` [years], `sex`, `handedness`, one for each of the study's own facts, `added`, `version` (of the study's
        files at that time) and `withdrawn`. `added` and `withdrawn` are times (ISO 8601); `withdrawn` is NaN for
        everybody who takes part. A fact that is not known is NaN.

        This is the present state, from participants.yaml, whether or not the tables have been collected. While groups
        are concealed, `group` has their codes, even if `dihaptic collect --reveal-groups` has named the groups in the
        tables. Raises Error when participants.yaml is damaged, or belongs to another study.

        >>> import dihaptic as dh
        >>> study = dh.Study(f"{folder}/two-days.yaml", rehearsed=f"{folder}/rehearsal")
        >>> people = study.participants
        >>> people[people.withdrawn.isna()].groupby("group").id.apply(list).to_dict()
        {'heavy': ['sim-002', 'sim-004'], 'light': ['sim-001', 'sim-003']}
        """
        text = io.StringIO()
        table = csv.writer(text, lineterminator="\n")
        table.writerow(_BEFORE_FACTS + self._facts + _AFTER_FACTS)
        for member in self._members():
            facts = {each["name"]: each.get("value") for each in member.get("facts") or []}
            own = [facts.get(name) for name in self._facts]
            before, after = ([member.get(name) for name in names] for names in (_BEFORE_FACTS, _AFTER_FACTS))
            table.writerow(before + own + after)
        text.seek(0)
        return parse_table(text, "participants.csv")

    # Recordings

    @property
    def sessions(self) -> pd.DataFrame:
        """A row for each recording, ordered by participant, by session as in the study's file, and by time.

        The columns are `participant`, `group` (as in `participants`), `study_session`, `study_condition` (NaN: the
        session has none), `complete` and `folder` (path of the recording, for `dihaptic.load()`). A session has several
        rows if it was interrupted, and then resumed or started again.

        `complete` means that the recording reached its end, or that no trial was left when it was interrupted. For the
        tables, `dihaptic collect` takes the first complete recording of each session or, if there is none, the last one,
        provided that as many of its trials are done as `resuming` in the study's file requires. Raises Error for a recording
        that cannot be read, or is somebody else's.

        >>> import dihaptic as dh
        >>> study = dh.Study(f"{folder}/two-days.yaml", rehearsed=f"{folder}/rehearsal")
        >>> study.sessions.groupby(["group", "study_session"]).complete.sum().to_dict()
        {('heavy', 'day1'): 2, ('heavy', 'day2'): 2, ('light', 'day1'): 2, ('light', 'day2'): 2}
        """
        rows = []
        for member in self._members():
            for name in self._sessions:
                for session in self._recordings(member["id"], name):
                    condition = session.info["in_study"].get("condition") or np.nan
                    row = (member["id"], member["group"], name, condition, _is_complete(session), str(session.folder))
                    rows.append(row)
        columns = ["participant", "group", "study_session", "study_condition", "complete", "folder"]
        return pd.DataFrame(rows, columns=columns).astype({"complete": bool})

    def session(self, participant: str, study_session: str) -> Session:
        """The recording of a participant's session that the tables contain: the first complete one, or else the last one,
        provided that as many of its trials are done as `resuming` in the study's file requires.

        Raises NotThere for an unknown participant or session, and Error when there is no such recording.

        >>> import dihaptic as dh
        >>> study = dh.Study(f"{folder}/two-days.yaml", rehearsed=f"{folder}/rehearsal")
        >>> study.session("sim-001", "day2").info["in_study"]["group"]
        'light'
        >>> study.session("sim-001", "day3")
        Traceback (most recent call last):
        ...
        dihaptic.errors.NotThere: day3: is not a session of this study. Did you mean 'day2'? It has day1, day2.
        """
        members = {member["id"]: member for member in self._members()}
        if participant not in members:
            if self._rehearsed:
                what = "is not one of the simulated people"
                remedy = "Study.participants lists them; sessions of dihaptic run --simulate are not included."
            else:
                what, remedy = "is not a participant of this study", "Study.participants lists them."
            raise NotThere(participant, what, list(members), remedy)
        if study_session not in self._sessions:
            remedy = f"It has {', '.join(self._sessions)}."
            raise NotThere(study_session, "is not a session of this study", self._sessions, remedy)
        recordings = list(self._recordings(participant, study_session))
        for session in recordings:
            if _is_complete(session):
                return session
        if recordings and _share_done(recordings[-1]) >= self._enough:
            return recordings[-1]
        raise self._without(members[participant], study_session, recordings)

    # How a study is read

    @property
    def _tables_folder(self) -> Path:
        return self.folder / "tables"

    def _collecting(self) -> tuple[Path, str]:
        of_rehearsal = ["--rehearsed", str(self.folder)] if self._rehearsed else []
        return self.file, command_of("collect", self.file, *of_rehearsal)

    def _members(self) -> list[dict[str, Any]]:
        """The participants in participants.yaml, with the groups as they may be shown. Raises Error."""
        file = self.folder / "participants.yaml"
        known = self._known()
        if not os.path.lexists(file):
            if known:
                what = f"is gone, and {', '.join(known)} had been added"
                raise error(what, _ROSTER if not self._rehearsed else _REHEARSED, file=str(file))
            return []
        roster = read_info(file)
        if (roster.get("study") or self.title) != self.title:
            what = f"is '{roster['study']}', not '{self.title}'"
            raise error(what, "Give each study a folder of its own.", file=str(file), key="study")
        members = _items(roster, "participants", "id", file, _ROSTER)
        _check_members(members, file)
        if lost := [who for who in known if who not in {member["id"] for member in members}]:
            what = f"lacks {', '.join(lost)}, who had been added"
            raise error(what, _ROSTER if not self._rehearsed else _REHEARSED, file=str(file))
        for member in members:
            group = member.get("group", "")
            if group not in self._shown:
                what = f"is in the group '{group}', which the study does not have"
                remedy = "Restore the study's groups, or its allocation's seed."
                raise error(what, remedy, file=str(file), key=member["id"])
            member["group"] = self._shown[group]
        return members

    def _known(self) -> list[str]:
        """Who has been added according to log.csv or, in a rehearsal, to the names of the folders. Raises Error."""
        if self._rehearsed:
            try:
                return sorted(name for name in os.listdir(self.folder / "sessions") if re.fullmatch(r"sim-\d+", name))
            except FileNotFoundError:
                return []
            except OSError as why:
                remedy = "Correct its permissions."
                raise error(f"cannot be read: {why.strerror}", remedy, file=str(self.folder / "sessions")) from None
        file = self.folder / "log.csv"
        if not os.path.lexists(file):
            return []
        try:
            if fault := why_unreadable(file, _MOST_LOG):
                raise OSError(fault)
            with file.open(encoding="utf-8", newline="") as log:
                added = [row.get("participant") or "" for row in csv.DictReader(log) if row.get("action") == "add"]
        except (OSError, UnicodeDecodeError, csv.Error) as why:
            raise error(f"cannot be read: {why}", "Restore it from a backup.", file=str(file)) from None
        return sorted({who for who in added if who})

    def _recordings(self, participant: str, study_session: str) -> Iterator[Session]:
        """The recordings of a session, in the order of their start. Raises Error when one cannot be read, because the
        session would then seem not to have been done."""
        folder = self.folder / "sessions" / participant / study_session
        try:
            # a hidden file, such as .DS_Store, is not a recording
            paths = [path for path in folder.iterdir() if not path.name.startswith((_UNFINISHED, "."))]
        except FileNotFoundError:
            return
        except OSError as why:
            remedy = "Recordings in it would not count: correct its permissions."
            raise error(f"cannot be read: {why.strerror}", remedy, file=str(folder)) from None
        found = [_recording(path, participant, study_session) for path in paths]
        # sorted by time rather than by name, which contains the local time
        for _, _, session in sorted(found, key=lambda each: each[:2]):
            yield session

    def _without(self, member: dict[str, Any], study_session: str, recordings: list[Session]) -> Error:
        """The reason why there is no complete recording of a participant's session."""
        who = member["id"]
        if recordings:
            last = recordings[-1]
            state = "is still running, or was killed" if last.info.get("state") == "running" else "broke off"
            what = f"has no complete recording of {study_session}: {last.folder} {state}"
            there = " dihaptic.load() opens what there is."
        else:
            what = f"has no recording of {study_session}"
            there = ""
        if self._rehearsed:
            remedy = "Repeat the command that rehearsed the study: it completes what is missing."
        elif member.get("withdrawn"):
            what += f", and withdrew on {member['withdrawn']}"
            remedy = "" if recordings else "Study.sessions lists the recordings."
        else:
            remedy = f"{command_of('run', self.file, '--participant', who)} runs the next session."
        return error(what, (remedy + there).strip(), key=who)


def _items(
    document: dict[str, Any], key: str, name: str, file: Path, remedy: str, of: str = ""
) -> list[dict[str, Any]]:
    """The items of a list; each has a name, which may become a part of a path. Raises Error."""
    items = part_of(document, key, list, file, remedy, of)
    for item in items:
        if not re.fullmatch("[A-Za-z0-9_-]+", str(item.get(name, ""))):
            raise error(f"has an item whose {name} is {item.get(name, '')!r}", remedy, file=str(file), key=of + key)
    return items


def is_study(file: Path) -> bool:
    """Whether this is the file of a study, whose mistakes do not matter here."""
    if not file.is_file() or why_unreadable(file, MOST_YAML):
        return False
    try:
        return {"groups", "sessions"} <= set(read_info(file, ""))
    except Error:
        return False


def groups_of_study(session: Path) -> list[str]:
    """The names of a study's groups, in the order of its file, as the study's folder has kept it; [] where it has not.

    `session` is the folder of one of its recordings, FOLDER/sessions/PERSON/SESSION/RECORDING.
    """
    above = session.resolve().parents
    kept = (_groups_kept(folder / "versions.yaml") for folder in above[2:4])
    return next((groups for groups in kept if groups), [])


def _groups_kept(file: Path) -> list[str]:
    if why_unreadable(file, MOST_YAML):
        return []
    try:
        versions = read_info(file, "")["versions"]
        return [str(group["name"]) for group in versions[-1]["study"]["groups"]]
    except (Error, LookupError, TypeError):
        return []


def _names(study: dict[str, Any], key: str, file: Path) -> list[str]:
    """The names of the items of a list in a study's file. Raises Error."""
    return [item["name"] for item in _items(study, key, "name", file, _CHECK)]


def _check_members(members: list[dict[str, Any]], file: Path) -> None:
    """Raises Error when a participant is listed twice, or has something other than single values and facts."""
    there = set()
    for member in members:
        who = member["id"]
        if who.lower() in there:
            raise error("is listed twice", _ROSTER, file=str(file), key=who)
        there.add(who.lower())
        for key in _LAST:
            if key not in member:
                raise error("is missing: the file was cut off", _ROSTER, file=str(file), key=f"{who}.{key}")
        for key in _BEFORE_FACTS + _AFTER_FACTS:
            part_of(member, key, str, file, _ROSTER, f"{who}.")
        for fact in _items(member, "facts", "name", file, _ROSTER, f"{who}."):
            part_of(fact, "value", str, file, _ROSTER, f"{who}.{fact['name']}.")


def _enough(study: dict[str, Any], file: Path) -> float:
    """The smallest share of its trials that must be done for an interrupted session to be included. Raises Error."""
    resuming = part_of(study, "resuming", dict, file, _CHECK)
    text = part_of(resuming, "complete", str, file, _CHECK, "resuming.") or "1"
    try:
        share = float(text)
    except ValueError:
        share = np.nan
    if not 0.01 <= share <= 1:
        what = f"must be a number from 0.01 to 1, but is '{text}'"
        raise error(what, _CHECK, file=str(file), key="resuming.complete")
    return share


def _code_of(group: str, seed: str) -> str:
    """The code that stands for a concealed group (StudyFile::code_of)."""
    return f"arm {zlib.crc32(f'{seed}/{group}'.encode()):08x}"[:8]


def _recording(path: Path, participant: str, study_session: str) -> tuple[float, str, Session]:
    """A recording, with the time of its start and its name. Raises Error when it is not this participant's, or of
    another session."""
    session = Session(path)
    file = session.folder / "session.yaml"
    recorded = part_of(session.info, "participant", dict, file, _AWAY).get("id", "")
    if recorded not in (participant, f"sim-{participant}"):
        what = f"is '{recorded}', not {participant}"
        raise error(what, "Move the folder to where it belongs.", file=str(path), key="participant")
    place = part_of(session.info, "in_study", dict, file, _AWAY).get("session")
    if place != study_session:
        what = f"is {place} of a study, not {study_session}" if place else "is missing: it was recorded outside the study"
        raise error(what, "Move the folder to where it belongs.", file=str(path), key="in_study")
    started = part_of(session.info, "started", str, file, _AWAY)
    try:
        seconds = datetime.fromisoformat(started).timestamp()
    except ValueError:
        raise error(f"'{started}' is not a time", _AWAY, file=str(file), key="started") from None
    return seconds, path.name, session


def _is_complete(session: Session) -> bool:
    """Whether all of a recording's trials are done."""
    return _share_done(session) == 1


def _share_done(session: Session) -> float:
    """The share of a recording's trials that are done, from 0 to 1.

    It is 0 while the session runs, and if its files do not show the share or have been changed since; it is less than 1
    if a procedure ended before its trials did.
    """
    state = session.info.get("state")
    if state == "complete":
        return 1
    if state not in ("interrupted", "recovered"):
        return 0
    try:
        return _share_told(session)
    except (OSError, csv.Error, AttributeError, KeyError, TypeError, ValueError):
        return 0  # the files are damaged (an Error is a ValueError, too)


def _share_told(session: Session) -> float:
    """The share of its trials that are done, according to an interrupted recording's files."""
    folder = session.folder
    if broken_seals(folder, session.info, "trials.csv"):
        return 0
    task = read_info(folder / "task.yaml")
    for name in ("trial-list.csv", "trials.csv"):
        if why_unreadable(folder / name, _MOST_LOG):
            return 0
    with (folder / "trial-list.csv").open(encoding="utf-8", newline="") as file:
        left = {row["trial_num"] for row in csv.DictReader(file)}
        trials = len(left)
    with (folder / "trials.csv").open(encoding="utf-8", newline="") as file:
        attempts = [(row["trial_num"], int(row["attempt"]), row["outcome"]) for row in csv.DictReader(file)]
    exits = {e.get("outcome"): e for state in task.get("states") or [] for e in state.get("exits") or []}
    most = 1 if task.get("redo") == "never" else int(task.get("most_attempts", 3))
    for trial, attempt, outcome in attempts:
        end = exits.get(outcome, {})
        if is_yes(end, "ends_session", folder / "task.yaml"):
            return 1
        if outcome != "interrupted" and (not is_yes(end, "redo", folder / "task.yaml") or attempt >= most):
            left.discard(trial)
    return 1 - len(left) / trials if trials else 0
