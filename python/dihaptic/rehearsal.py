"""Lets a population of simulated people do an experiment, and collects their tables."""

from __future__ import annotations

import multiprocessing
import shutil
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import pandas as pd

from . import _native
from .between import BetweenTrials, listening
from .errors import NotThere, error
from .files import Input, on_disk
from .person import Ended, Person
from .program import call, ended_of
from .tables import read_table


def rehearse(
    experiment: Input,
    people: int = 1,
    *,
    jobs: int = 1,
    population: str | Path = "",
    person: Callable[[int], Person] | None = None,
    between: Callable[[int], BetweenTrials] | None = None,
    seed: int = 1,
    out: str | Path = "",
    keep_recordings: bool = False,
    progress: bool = True,
) -> Rehearsal:
    """Lets simulated people do an experiment, as `dihaptic rehearse` does, and collects their tables.

    Who is in the folder already is not done again. The tables are the same whatever `jobs`.
    `person`: makes a simulated person of your own, by number, from 1; otherwise they are drawn from
    `population`. `between`: makes what decides between a person's trials. What one of these raises
    ends the rehearsal; those who were done before stay. `keep_recordings`: with raw.log and
    session.nwb of each, hundreds of MB. Raises Error.

    >>> import dihaptic as dh
    >>> study = dh.rehearse("experiments/first-trials.yaml", 2, out=f"{folder}/study", progress=False)
    >>> sorted(study.trials.ppid.unique())
    ['sim-001', 'sim-002']
    >>> class Idle(dh.Person):
    ...     def __init__(self, number):
    ...         self.group = ["patients", "controls"][number % 2]
    ...     def act(self, seen):
    ...         pass
    >>> idle = dh.rehearse("experiments/first-trials.yaml", 2, person=Idle, out=f"{folder}/idle", progress=False)
    >>> idle.people[["id", "group", "class"]].values.tolist()
    [['sim-001', 'controls', 'Idle'], ['sim-002', 'patients', 'Idle']]
    """
    with on_disk(experiment) as file:
        folder = Path(out or f"rehearsals/{Path(file).stem}_{seed}")
        if person is None and between is None:
            command = ["rehearse", file, "--people", str(people), "--jobs", str(jobs), "--seed", str(seed)]
            command += ["--out", str(folder)] + (["--population", str(population)] if population else [])
            call(command + ["--keep-recordings"] * keep_recordings, progress)
        else:
            study = _Study(file, folder, seed, str(population), person, between, keep_recordings)
            study.claim(people, jobs)
            study.run(people, jobs, progress)
    call(["collect", str(folder), "--out", str(folder)], progress=False)
    return Rehearsal(folder)


class Rehearsal:
    """What a population of simulated people did: tables with a row for each person's trial or fit.

    >>> import dihaptic as dh
    >>> study = dh.rehearse("experiments/first-trials.yaml", 2, out=f"{folder}/study", progress=False)
    >>> len(study.sessions), "trials" in study.tables
    (2, True)
    """

    def __init__(self, folder: str | Path) -> None:
        self.folder = Path(folder)

    def __repr__(self) -> str:
        return f"<Rehearsal {self.folder}: {len(self.sessions)} people>"

    @property
    def sessions(self) -> list[Path]:
        """Folder of each person, in the order of their numbers."""
        return sorted(path.parent for path in self.folder.glob("*/person.yaml"))

    @property
    def tables(self) -> list[str]:
        """Names of the tables that were collected, without their .csv."""
        return sorted(path.stem for path in self.folder.glob("*.csv"))

    def table(self, name: str) -> pd.DataFrame:
        """A table of all people by its name. Raises Error."""
        if not self.tables:
            raise error("has no tables yet", f"Type dihaptic collect {self.folder}.", file=str(self.folder))
        if name not in self.tables:
            raise NotThere(name, "is no table of this rehearsal", self.tables, "Rehearsal.tables lists them.")
        return read_table(self.folder / f"{name}.csv")

    @property
    def trials(self) -> pd.DataFrame:
        """A row for each attempt of each person."""
        return self.table("trials")

    @property
    def people(self) -> pd.DataFrame:
        """A row for each person: who they are made to be."""
        return self.table("people")


@dataclass(frozen=True)
class _Study:
    """A rehearsal whose people are Python's, or between whose trials Python decides."""

    file: str
    folder: Path
    seed: int
    population: str
    person: Callable[[int], Person] | None
    between: Callable[[int], BetweenTrials] | None
    keep_recordings: bool

    def claim(self, people: int, jobs: int) -> None:
        """Checks what was given, and that nothing else is in the folder. Raises Error."""
        for name, value, most in (("people", people, _native.most_people), ("jobs", jobs, 1024)):
            if not 1 <= value <= most:
                raise error(f"is {value}", f"Ask for 1 to {most}.", key=name)
        if self.person is not None and self.population:
            raise error("are given twice", "Leave out population or person.", key="people")
        person = _made(self.person, 1, Person)
        rules = _made(self.between, 1, BetweenTrials)
        self.folder.mkdir(parents=True, exist_ok=True)
        names = ["" if it is None else type(it).__name__ for it in (person, rules)]
        self._sitting(1).claim(
            str(self.folder), names[0], self.population, names[1], people, "dihaptic.rehearse() of Python, as before"
        )

    def run(self, people: int, jobs: int, progress: bool) -> None:
        """Lets everybody do it who has not yet."""
        waiting = [n for n in range(1, people + 1) if not (self.folder / _native.person_id(n)).exists()]
        for done, _ in enumerate(self._each(waiting, jobs), 1):
            if progress:
                sys.stderr.write(f"\rrehearsing {done} of {len(waiting)}")
                sys.stderr.flush()
        if progress:
            sys.stderr.write("\r" + " " * 40 + "\r")

    def _each(self, numbers: list[int], jobs: int) -> Iterator[None]:
        if min(jobs, len(numbers)) <= 1:
            yield from map(self._do, numbers)  # here, where a debugger stops in it
            return
        # forked, so that classes of a notebook are there, too
        fork = multiprocessing.get_context("fork")
        with ProcessPoolExecutor(jobs, fork, initializer=_share, initargs=(self,)) as workers:
            tasks = [workers.submit(_do_shared, number) for number in numbers]
            try:
                for task in as_completed(tasks):
                    yield task.result()
            finally:
                workers.shutdown(wait=True, cancel_futures=True)

    def _do(self, number: int) -> None:
        ppid = _native.person_id(number)
        place = self.folder / f"{_native.unfinished}{ppid}"
        shutil.rmtree(place, ignore_errors=True)
        with listening(_made(self.between, number, BetweenTrials)) as asking:
            ended = self._session(number, ppid, place, asking)
        if not ended.good:
            raise error("\n".join(ended.said) or "was interrupted", f"Its files are in {ended.folder}.", key=ppid)
        if not self.keep_recordings:
            for recording in ("raw.log", "session.nwb"):
                (Path(ended.folder) / recording).unlink(missing_ok=True)
        Path(ended.folder).rename(self.folder / ppid)  # appears complete, or not at all
        shutil.rmtree(place)

    def _session(self, number: int, ppid: str, place: Path, asking: list[str]) -> Ended:
        person = _made(self.person, number, Person)
        if person is not None:
            socket = asking[-1] if asking else ""
            return person._do(self._sitting(number), place, socket, self.keep_recordings)
        command = ["run", self.file, "--simulate", "--participant", ppid, "--seed", str(self.seed), "--out", str(place)]
        command += ["--population", self.population] if self.population else []
        return ended_of(call(command + asking, progress=False))

    def _sitting(self, number: int) -> _native.Sitting:
        return _native.Sitting(self.file, "", [], self.seed, _native.person_id(number))


Made = TypeVar("Made", Person, BetweenTrials)


def _made(make: Callable[[int], Made] | None, number: int, kind: type[Made]) -> Made | None:
    """What a function of rehearse()'s made for a person, if there is one. Raises Error."""
    if make is None:
        return None
    it = make(number)
    if not isinstance(it, kind):
        raise error(f"{it!r} is none", "Give a function of a number that returns one.", key=kind.__name__)
    return it


_shared: list[_Study] = []


def _share(study: _Study) -> None:
    _shared.append(study)


def _do_shared(number: int) -> None:
    _shared[-1]._do(number)
