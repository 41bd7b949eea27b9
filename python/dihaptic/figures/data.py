"""Reads the tables from which figures are drawn: those of a session, a rehearsal, a study, or a folder of sessions."""

from __future__ import annotations

import re
from dataclasses import asdict, dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import yaml

from .._facts import facts
from .._head import MOST_YAML, why_unreadable
from ..errors import NotThere, error
from ..session import Session
from ..study import groups_of_study
from .sessions import Paths, Sample, Sitting, Sittings, named_apart, renamed
from .words import label, split

#: Kinds of trials that do not show the effect of a condition.
ASIDE = ["practice", "catch"]
#: Columns that identify a session among those of all people.
SITTING = ("person", "group", "session", "study_session")
#: The last column of trials.csv before the measures; the columns below follow the measures, and are not measures either.
_END_OF_DESIGN = "attempt"
_AFTER_MEASURES = ["not_measured", "simulated", "moved_by", "start_type", "replays"]
#: Maximum number of trials in a window of a learning curve, such as early or late, in fits.csv.
WINDOW = 8
#: Columns of adaptation.csv and fits.csv in the unit of a row, apart from windows, which have columns with _low and _high.
_IN_UNIT = ["perturbation", "compensation", "two_rate", "single_rate", "two_rate_sd", "single_rate_sd"]
#: Columns of measures that describe what acted on the hand, not what the hand did.
_NOT_BEHAVIOUR = ["field_share"]
#: Values that differ by less than this share of their range count as equal.
_SAME = 0.01


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
        """The measure's name and unit, for an axis."""
        return label(self.column, self.unit)


def read(
    path: Paths, people: list[str] | None = None, *, experiment: str | None = None, moved_by: str | None = None,
    population: str | None = None,
) -> Data:  # fmt: skip
    """The tables of a session's folder, of a rehearsal's, of a study's file, or of a folder that contains sessions.

    A list of several paths is compared: the people of each path are a group. `people` names those who are included in all
    figures and means; by default, everybody is included. In a folder with several experiments, `experiment` selects one by
    its title; `moved_by`, a value of that column of tables, selects people or simulated people, and `population` one
    population of the latter: different samples are never averaged. Raises Error when there is nothing, or when several
    samples are left, and NotThere for an unknown person.

    >>> from dihaptic import figures
    >>> figures.read(lift_session)
    <Data of one session: Two fingers lift a block>
    """
    return Data(Sittings(path), people, Sample(experiment, moved_by, population))


class Data:
    """The tables of one person or of many, from which figures are drawn.

    Every table has the columns `person` and `group` ("" without groups). `paths` are the paths that were read, and
    `left_out` gives the reason for each session that is not included.

    >>> from dihaptic import figures
    >>> data = figures.read(lift_session)
    >>> list(data.table("trials").columns[:2]), data.has("thresholds")
    (['person', 'group'], False)
    """

    def __init__(self, found: Sittings, people: list[str] | None, wanted: Sample) -> None:
        self.paths, self.left_out = found.paths, found.left_out
        #: The arguments that selected these people; a script repeats them.
        self.choice: dict[str, Any] = {"people": people, **asdict(wanted)}
        chosen = [sitting for sitting in found.counting if sitting.sample.is_among(wanted)]
        samples = sorted({sitting.sample for sitting in chosen}, key=str)
        # paths that are compared may differ in who moved the hand, but each has a single sample, from one experiment
        mixed = len({(each.of, each.sample) for each in chosen}) > len({each.of for each in chosen})
        mixed = mixed or len({sample.is_simulated for sample in samples}) > 1
        if mixed or len({sample.experiment for sample in samples}) != 1:
            there = "; ".join(map(str, samples or sorted({s.sample for s in found.counting}, key=str)))
            what = f"has sessions of {len(samples)} samples" if samples else "has no such sessions"
            choose = "Choose one by experiment= (its title), moved_by= (e.g. devices, or simulated_person), population="
            raise error(what, f"{choose}; there are: {there}.", file=str(self.paths[0]))
        self.sittings = named_apart(_by_group(chosen))
        if people is not None:
            for name in people:
                if name not in self.people:
                    raise NotThere(name, "is not a person of these sessions", self.people, "Data.people lists them.")
            self.sittings = [sitting for sitting in self.sittings if sitting.person in people]
        self.sample = self.sittings[0].sample

    def __repr__(self) -> str:
        count = len(self.sessions)
        return f"<Data of {'one session' if count == 1 else f'{count} sessions'}: {self.title}>"

    @property
    def folder(self) -> Path:
        """The folder for figures of these data, which is beside their tables."""
        path = self.paths[0]
        return path.parent if path.is_file() else path

    @property
    def title(self) -> str:
        """The experiment's title."""
        return str(self.sessions[0].info.get("title", ""))

    @property
    def sessions(self) -> list[Session]:
        """The sessions that are included."""
        return [sitting.session for sitting in self.sittings]

    @property
    def recorded(self) -> list[Sitting]:
        """The sessions with a session.nwb, and their people; a rehearsal keeps only tables."""
        return [sitting for sitting in self.sittings if (sitting.session.folder / "session.nwb").is_file()]

    @property
    def task(self) -> dict[str, Any]:
        """The frozen task of the first session (task.yaml); empty for a session without a task. Raises Error."""
        return self.tasks[0]

    @cached_property
    def tasks(self) -> list[dict[str, Any]]:
        """The tasks of the sessions, each once. Raises Error."""
        files: dict[bytes, Path] = {}
        for session in self.sessions:
            file = session.folder / "task.yaml"
            content = b"" if why_unreadable(file, MOST_YAML) else file.read_bytes()
            files.setdefault(content, file)
        return [_frozen(file) for file in files.values()]

    @cached_property
    def scene(self) -> dict[str, Any]:
        """The scene of the first session, frozen (scene.yaml); empty where there is none. Raises Error."""
        return _frozen(self.sessions[0].folder / "scene.yaml")

    @property
    def groups(self) -> list[str]:
        """Names of the groups of people: those of a study in the order of its file, and those of paths in their order."""
        return list(dict.fromkeys(sitting.group for sitting in self.sittings if sitting.group))

    # Tables

    @cached_property
    def tables(self) -> list[str]:
        """Names of the tables, without .csv."""
        return sorted({name for session in self.sessions for name in session.tables})

    def has(self, name: str) -> bool:
        """Whether there is such a table, with at least one row."""
        return name in self.tables and len(self.table(name)) > 0

    def table(self, name: str) -> pd.DataFrame:
        """A table of all people, by its name; units and meanings of its columns are in `attrs`. Raises NotThere, Error."""
        cache: dict[str, pd.DataFrame] = self.__dict__.setdefault("_cache", {})
        if name not in cache:
            cache[name] = self._read(name)
        return cache[name].copy()

    def _read(self, name: str) -> pd.DataFrame:
        if name not in self.tables:
            raise NotThere(name, "is not a table of these sessions", self.tables, "Data.tables lists them.")
        sittings = [each for each in self.sittings if name in each.session.tables]
        parts = [each.table(name) for each in sittings]
        if name in ("adaptation", "fits"):
            fits = [each.table("fits") if "fits" in each.session.tables else pd.DataFrame() for each in sittings]
            parts = [_with_shares(part) if is_of_index(own) else part for part, own in zip(parts, fits)]
        out = _joined(parts)
        if name == "trials":
            _count_angles_on(out)
        return out

    @property
    def people(self) -> list[str]:
        """Names of the people, in the order of their sessions."""
        return list(dict.fromkeys(sitting.person for sitting in self.sittings))

    @cached_property
    def laboratories(self) -> dict[str, int]:
        """The number of the laboratory of each session's simulated person, by the name of the session in tables; without those
        of other people, and of people of one median laboratory."""
        return {each.name: each.laboratory for each in self.sittings if each.laboratory > 0}

    # The design

    @cached_property
    def factors(self) -> list[str]:
        """Columns of trials.csv that are factors of the design, without those that have a single level."""
        trials = self.table("trials")
        names: list[str] = []
        for task in self.tasks:
            names += [renamed(str(factor["factor"])) for factor in task.get("cross") or []]
            for each in [*(task.get("conditions") or []), *(task.get("rounds") or [])]:
                names += [renamed(str(name)) for name in each.get("factors") or {}]
        # nor are means ever taken over the sessions of a study, or over rounds
        names = list(dict.fromkeys([*names, "study_session", "round"]))
        return [name for name in names if name in trials and trials[name].nunique() > 1]

    @cached_property
    def blocks(self) -> list[str]:
        """Names of the blocks, in the order of the task."""
        return [str(block["name"]) for block in self.task.get("blocks") or []]

    @cached_property
    def conditions(self) -> list[str]:
        """Names of the conditions, in the order of the task."""
        return [str(condition["name"]) for condition in self.task.get("conditions") or []]

    @cached_property
    def rounds(self) -> list[str]:
        """Names of the rounds, in the order of the task."""
        return [str(each["name"]) for each in self.task.get("rounds") or [] if each.get("name")]

    def levels(self, column: str) -> list[Any]:
        """The levels of a column that describes trials: numbers are sorted by size, words by their order in the task or in
        the trials. Raises NotThere.

        >>> from dihaptic import figures
        >>> figures.read(lift_session).levels("outcome")
        ['done']
        """
        trials = self.table("trials")
        if column not in trials:
            raise NotThere(column, "is not a column of trials", [str(name) for name in trials], "")
        found = list(trials[column].dropna().unique())
        if not any(isinstance(value, str) for value in found):
            return sorted(found)
        known: list[Any] = {"condition": self.conditions, "block": self.blocks, "round": self.rounds}.get(column, [])
        for factor in self.task.get("cross") or []:
            known = known or (list(factor["levels"]) if factor["factor"] == column else [])
        for condition in self.task.get("conditions") or []:
            known = [*known, (condition.get("factors") or {}).get(column)]
        return [*dict.fromkeys(value for value in known if value in found), *(value for value in found if value not in known)]

    def in_order(self, table: pd.DataFrame, by: list[str]) -> pd.DataFrame:
        """The rows of a table, sorted by the levels of its columns `by`, of which the first counts most."""
        trials = self.table("trials")
        for name in reversed(by):
            place = {value: i for i, value in enumerate(self.levels(name) if name in trials else [])}
            table = table.sort_values(name, key=lambda levels: levels.map(place), kind="stable")
        return table

    @cached_property
    def measures(self) -> list[Measure]:
        """Columns of trials.csv: the task's numeric measures and answers that have a value in some trial, without stimuli."""
        return [measure for measure in self._numbers if measure.column not in self.stimuli]

    @cached_property
    def _numbers(self) -> list[Measure]:
        """The measures, and the stimuli."""
        trials = self.table("trials")
        columns = [str(column) for column in trials.columns]
        first = columns.index(_END_OF_DESIGN) + 1 if _END_OF_DESIGN in columns else len(columns)
        # ratings are among the design's columns, since the task can refer to them
        asked = [state["ask"] for task in self.tasks for state in task.get("states") or [] if isinstance(state.get("ask"), dict)]
        ratings = [str(ask["name"]) for ask in asked if ask.get("name") in columns[:first]]
        built_in = {name for name, _ in facts()["columns"]["trials.csv"]}
        numeric = trials.select_dtypes("number").columns
        return [
            self.measure(column)
            for column in [*dict.fromkeys(ratings), *columns[first:]]
            if column in numeric and column not in _AFTER_MEASURES
            and column not in [*built_in, *_NOT_BEHAVIOUR, *self.factors] and trials[column].notna().any()
        ]  # fmt: skip

    @cached_property
    def stimuli(self) -> list[str]:
        """Columns of measures whose values the experiment set: they describe what was presented, not what people did.

        Their expressions contain only factors and draws; or they have three or more values, but the same one in all trials
        of a condition, for all people.
        """
        trials = self.table("trials") if self.has("trials") else pd.DataFrame()
        alike = [name for name in (*self.factors, "kind", "condition", "perturbation") if name in trials] if len(trials) else []
        if not alike:
            return []  # a session without a task
        given = [*self.factors, *(str(draw.get("name")) for task in self.tasks for draw in task.get("draws") or [])]
        names = {split(name, str(trials.attrs.get("units", {}).get(name, ""))) for name in given} | set(given)
        custom = [each for task in self.tasks for each in task.get("custom_measures") or []]
        by_expression = {str(each.get("name")) for each in custom if _is_made_of(str(each.get("of", "")), names)}
        groups = trials.groupby(list(dict.fromkeys(alike)), dropna=False)
        found = []
        for measure in self._numbers:
            values = groups[measure.column].agg(["min", "max", "count"]).dropna()
            whole = float(values["max"].max() - values["min"].min())
            same = whole > 0 and values["count"].min() > 1 and (values["max"] - values["min"]).max() <= _SAME * whole
            if measure.column in by_expression or (same and (values["min"] / (_SAME * whole)).round().nunique() > 2):
                found.append(measure.column)
        return found

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
        """Whether no person took part."""
        return self.sample.is_simulated

    @property
    def mark(self) -> str:
        """The short mark in each figure's corner: "simulated" if no person took part."""
        return "simulated" if self.is_simulated else ""


def _by_group(sittings: list[Sitting]) -> list[Sitting]:
    """The sittings of a study, sorted by its groups in the order of its file, or else as they are."""
    if not any(sitting.study_session and sitting.group for sitting in sittings):
        return sittings
    paths = list(dict.fromkeys(sitting.of for sitting in sittings))
    one_of_each = {sitting.group: sitting for sitting in sittings}.values()
    groups = dict.fromkeys(name for sitting in one_of_each for name in groups_of_study(sitting.session.folder))
    known = {name: place for place, name in enumerate(groups)}
    return sorted(sittings, key=lambda each: (paths.index(each.of), known.get(each.group.rpartition(", ")[2], len(known))))


def is_of_index(fits: pd.DataFrame) -> bool:
    """Whether what was learned, according to these fits, is the adaptation index of force channels."""
    return "measure" in fits and bool((fits["measure"] == "adaptation_index").any())


def _with_shares(table: pd.DataFrame) -> pd.DataFrame:
    """A table of learning whose percentages are shares, as the adaptation index is in trials.csv, and in most papers."""
    is_percent = table["unit"] == "%"
    windows = [column.removesuffix("_low") for column in table if column.endswith("_low")]
    names = [*(name for name in _IN_UNIT if name in table), *windows, *(f"{name}{end}" for name in windows for end in ("_low", "_high"))]
    table[names] = table[names].astype(float)
    table.loc[is_percent, names] /= 100
    table.loc[is_percent, "unit"] = "1"
    return table


def _count_angles_on(trials: pd.DataFrame) -> None:
    """Counts angles beyond 180 degrees where they lie on both sides of it, so that means of neighbours lie between them.

    Does so only where there is a wide gap elsewhere, in which no angle lies.
    """
    wide = 90.0
    units, meanings = trials.attrs.get("units", {}), trials.attrs.get("meanings", {})
    for column in (name for name, unit in units.items() if unit == "deg" and name in trials):
        if not pd.api.types.is_numeric_dtype(trials[column]):
            continue
        angles = np.sort(trials[column].dropna().unique())
        if len(angles) < 2 or angles[0] < -180 or angles[-1] > 180 or angles[0] + 360 - angles[-1] >= wide:
            continue
        gaps = np.diff(angles)
        place = int(np.argmax(gaps))
        if gaps[place] < wide:
            continue
        cut = angles[place] + gaps[place] / 2
        below, above = trials[column] < cut, trials[column] > cut
        moved, by = (below, 360) if below.sum() <= above.sum() else (above, -360)
        trials[column] = trials[column].astype(float) + by * moved
        trials.attrs["meanings"] = meanings = {
            **meanings, column: f"{meanings.get(column, '')}; counted beyond {by // 2} degrees, since angles lie on both sides of it".lstrip("; ")
        }  # fmt: skip


def _frozen(file: Path) -> dict[str, Any]:
    """The content of a file that a session keeps as it was; empty where there is none. Raises Error."""
    if not file.exists():
        return {}
    if fault := why_unreadable(file, MOST_YAML):
        raise error(f"cannot be read: {fault}", "Restore the file from a copy of the session.", file=str(file))
    try:
        found = yaml.load(file.read_text(encoding="utf-8"), getattr(yaml, "CSafeLoader", yaml.SafeLoader))
    except (OSError, UnicodeDecodeError, yaml.YAMLError, RecursionError) as why:
        raise error(f"cannot be read: {why}", "Restore the file from a copy of the session.", file=str(file)) from None
    return found if isinstance(found, dict) else {}


def _is_made_of(expression: str, names: set[str]) -> bool:
    """Whether an expression of a task contains some of these names and, apart from them, only names of functions and units."""
    expression = re.sub(r"\d\s*[A-Za-z]+(/[A-Za-z]+)?", "0", expression)
    found = re.findall(r"\"[^\"]*\"|[A-Za-z_][\w.]*(?!\w*\s*\()", expression)
    return bool(found) and set(found) <= names


def checked_list(name: str, values: list[str]) -> list[str]:
    """The list of names that was given to a function.

    Raises Error for a single text, whose letters would be taken for names.
    """
    if isinstance(values, str):
        raise error("must be a list of names", f'Write {name}=["{values}"].', key=name)
    return values


def with_design(trials: pd.DataFrame, other: pd.DataFrame, factors: list[str]) -> pd.DataFrame:
    """The rows of another table of attempts, such as lifts, with the columns of their trials, in the order of trials.

    Of columns that both have, those that describe the design, including `factors`, are the trial's, and the others the row's.
    """
    columns = [str(column) for column in trials]
    design = {*columns[: columns.index("attempt" if "attempt" in columns else "trial_num") + 1], *factors}
    keys = [key for key in (*SITTING, "trial_num", "attempt") if key in trials and key in other]
    of_trials = trials[[name for name in columns if name in design or name not in other]]
    out = of_trials.merge(other[[*keys, *(name for name in other if name not in of_trials)]], on=keys, how="inner")
    out.attrs = {"units": {**other.attrs.get("units", {}), **trials.attrs.get("units", {})}}
    return out


def sitting_columns(table: pd.DataFrame) -> list[str]:
    """Columns of a table that identify a session among those of all people."""
    return [column for column in SITTING if column in table]


def _joined(parts: list[pd.DataFrame]) -> pd.DataFrame:
    """The tables, stacked in one table. A column that is empty in one session and has words in another keeps its words."""
    kinds = pd.DataFrame([part.dtypes for part in parts])
    mixed = [column for column in kinds if kinds[column].nunique(dropna=False) > 1]
    parts = [part.astype({column: object for column in mixed if column in part}) for part in parts]
    out = pd.concat(parts, ignore_index=True).infer_objects()
    out.attrs = parts[0].attrs
    return out
