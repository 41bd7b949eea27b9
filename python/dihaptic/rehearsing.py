"""Lets a population of simulated people do an experiment, and collects their tables."""

from __future__ import annotations

import contextlib
import ctypes
import multiprocessing
import os
import pickle
import random
import signal
import sys
import traceback
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from multiprocessing.context import ForkProcess
from pathlib import Path
from typing import TypeVar

import numpy as np

from . import _native
from .between import BetweenTrials, listening
from .errors import error
from .files import Input, on_disk
from .person import Ended, Person
from .program import call, ended_of
from .rehearsal import Rehearsal
from .study import is_study
from .tables import command_of

_PR_SET_PDEATHSIG = 1  # <sys/prctl.h>


def rehearse(
    experiment: Input,
    people: int = 1,
    *,
    jobs: int = 1,
    population: str | Path = "",
    laboratories: int = 0,
    person: Callable[[int], Person] | None = None,
    between: Callable[[int], BetweenTrials] | None = None,
    seed: int = 1,
    out: str | Path = "",
    keep_recordings: bool = False,
    progress: bool = True,
) -> Rehearsal:
    """Lets simulated people do an experiment, like `dihaptic rehearse`, and collects their tables.

    People who are already in the folder are not done again. The tables do not depend on `jobs`.
    They come from as many `laboratories` in turn as are given here or, with 0, in the population.
    `person` makes your own simulated person for a number, from 1; by default, people are drawn from `population`.
    `between` makes the rules that choose a person's next trials. Random numbers that these draw from `random` and
    `numpy.random` depend on `seed` and the person's number; seed a generator of your own with that number too, since people
    may be simulated in separate processes. An exception in one of these ends the rehearsal, and so does an invalid decision;
    people who have finished are kept. `keep_recordings` also keeps each raw.log and session.nwb, hundreds of MB. Raises
    Error.

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
        if is_study(Path(file)):
            remedy = f"Type {command_of('rehearse', file)}, then open it by dh.Study({str(file)!r}, rehearsed=FOLDER)."
            raise error("is a study", remedy, file=str(file))
        folder = Path(out or f"rehearsals/{Path(file).stem}_{seed}")
        if person is None and between is None:
            command = ["rehearse", file, "--people", str(people), "--jobs", str(jobs), "--seed", str(seed)]
            command += ["--out", str(folder)] + (["--population", str(population)] if population else [])
            command += ["--laboratories", str(laboratories)] if laboratories else []
            call(command + ["--keep-recordings"] * keep_recordings, progress)
        else:
            if laboratories:
                raise error("need people of a population", "Leave out laboratories, or person and between.", key="laboratories")
            study = _Study(file, folder, seed, str(population), person, between, keep_recordings)
            study.claim(people, jobs)
            study.run(people, jobs, progress)
    call(["collect", str(folder), "--out", str(folder)], progress=False)
    return Rehearsal(folder)


@dataclass(frozen=True)
class _Study:
    """A rehearsal with people, or decisions between trials, written in Python."""

    file: str
    folder: Path
    seed: int
    population: str
    person: Callable[[int], Person] | None
    between: Callable[[int], BetweenTrials] | None
    keep_recordings: bool

    def claim(self, people: int, jobs: int) -> None:
        """Checks the arguments, and that nothing else is in the folder. Raises Error."""
        for name, value, least, most in (
            ("people", people, 1, _native.most_people),
            ("jobs", jobs, 1, 1024),
            ("seed", self.seed, 0, 2**64 - 1),
        ):
            if not least <= value <= most:
                raise error(f"is {value}", f"Give {least} to {most}.", key=name)
        if self.person is not None and self.population:
            raise error("are given twice", "Leave out population or person.", key="people")
        sitting = self._sitting(1)
        with self._drawing(1):
            person, rules = _made(self.person, 1, Person), _made(self.between, 1, BetweenTrials)
            if person is not None and people > 1 and _made(self.person, 2, Person) is person:
                raise error("is one object for all people", "Return a new Person for each number.", key="person")
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
        except OSError as why:
            raise error(f"cannot be made: {why.strerror}", "Give another `out`.", file=str(self.folder)) from None
        names = ["" if it is None else type(it).__name__ for it in (person, rules)]
        sitting.claim(
            str(self.folder), names[0], self.population, names[1], people, "dihaptic.rehearse() of Python, as before"
        )

    def run(self, people: int, jobs: int, progress: bool) -> None:
        """Runs everyone who has not yet done the experiment."""
        waiting = [n for n in range(1, people + 1) if not (self.folder / _native.person_id(n)).exists()]
        done = 0

        def tell() -> None:
            nonlocal done
            done += 1
            if progress:
                sys.stderr.write(f"\rrehearsing {done} of {len(waiting)}")
                sys.stderr.flush()

        if min(jobs, len(waiting)) <= 1:
            for number in waiting:
                self._do(number)  # runs in this process, so that a debugger can stop in it
                tell()
        else:
            self._in_processes(waiting, jobs, tell)
        if progress:
            sys.stderr.write("\r" + " " * 40 + "\r")

    def _in_processes(self, waiting: list[int], jobs: int, tell: Callable[[], None]) -> None:
        """Runs a process for each person, a limited number at a time; after the first failure, no more are started."""
        fork = multiprocessing.get_context("fork")  # classes that are defined in a notebook exist there, too
        running: dict[Connection, ForkProcess] = {}
        failed: BaseException | None = None
        numbers = iter(waiting)
        try:
            while True:
                while len(running) < jobs and failed is None and (number := next(numbers, None)) is not None:
                    here, there = fork.Pipe(duplex=False)
                    process = fork.Process(target=self._child, args=(number, there))
                    process.start()
                    there.close()
                    running[here] = process
                if not running:
                    break
                answered = wait(list(running))
                for here in [here for here in running if here in answered]:
                    process = running.pop(here)
                    try:
                        why = here.recv()
                    except EOFError:
                        why = error(f"a person's process ended by itself ({process.exitcode})", "Rehearse again.")
                    process.join()
                    if why is None:
                        tell()
                    elif failed is None:
                        failed = why
        except BaseException:  # on Ctrl-C, each process ends its session properly
            for process in running.values():
                os.kill(process.pid or 0, signal.SIGINT)
            for process in running.values():
                process.join()
            raise
        if failed is not None:
            raise failed

    def _child(self, number: int, answer: Connection) -> None:
        # a killed parent leaves no process behind
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)
        why = None
        try:
            self._do(number)
        except BaseException as raised:
            raised.add_note("".join(traceback.format_exception(raised)))
            why = _that_travels(raised)
        answer.send(why)

    @contextlib.contextmanager
    def _drawing(self, number: int) -> Iterator[None]:
        """Random numbers drawn within this context are a person's own, and do not affect the caller's later draws."""
        before, of_numpy = random.getstate(), np.random.get_state()
        random.seed(f"{self.seed} {number}")
        np.random.seed([self.seed & 0xFFFFFFFF, self.seed >> 32, number])
        try:
            yield
        finally:
            random.setstate(before)
            np.random.set_state(of_numpy)

    def _do(self, number: int) -> None:
        ppid = _native.person_id(number)
        place = _native.UnfinishedFolder.take(str(self.folder), ppid)
        if place is None:
            raise error("another program is doing this session now", "Wait until it has ended.", key=ppid)
        if not place.is_done():  # another program may just have done it
            with self._drawing(number):
                self._record(number, ppid, place)
        place.remove()

    def _record(self, number: int, ppid: str, place: _native.UnfinishedFolder) -> None:
        rules = _made(self.between, number, BetweenTrials)
        with listening(rules) as asking:
            ended = self._session(number, ppid, Path(place.path), asking)
        wrong = [] if rules is None else [line for line in ended.said if "decides between trials" in line]
        if wrong or not ended.good:
            told = "\n".join([*(rules.failures if rules else []), *(wrong or ended.said)])
            raise error(told or "was interrupted", f"Its files are in {ended.folder}.", key=ppid)
        if not self.keep_recordings:
            for recording in ("raw.log", "session.nwb"):
                (Path(ended.folder) / recording).unlink(missing_ok=True)
        place.finish(ended.folder)

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
    """The object that a function given to rehearse() made for a person, if any. Raises Error."""
    if make is None:
        return None
    it = make(number)
    if not isinstance(it, kind):
        raise error(f"{it!r} is not a {kind.__name__}", "Give a function of a number that returns one.", key=kind.__name__)
    return it


def _that_travels(why: BaseException) -> BaseException:
    """An exception, or one with the same text if it cannot be passed from one process to
    another."""
    try:
        pickle.loads(pickle.dumps(why))
        return why
    except Exception:
        told = RuntimeError(f"{type(why).__name__}: {why}")
        for note in why.__notes__:
            told.add_note(note)
        return told
