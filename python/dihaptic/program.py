"""Runs the program's commands: sessions, rehearsals, reports.

Each runs in a process of its own, so that nothing that Python does keeps a servo from its tick.
"""

from __future__ import annotations

import re
import shutil
import signal
import subprocess
import sys
import threading
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import IO, Any

import pandas as pd

from . import _native
from .between import BetweenTrials, listening
from .errors import Error, NotThere, Problem, error
from .files import Input, on_disk, problems_of
from .person import Person
from .session import Session
from .tables import read_table

_BAD_INPUT = 2
_PROBLEM = re.compile(r"^(?:(?P<file>[^:\n]+):(?:(?P<line>\d+):)? )?(?P<severity>error|warning): (?P<what>.*)$")
_PROGRESS = re.compile(r"^(?P<what>.+?) +(?P<share>\d+) %")


def program() -> str:
    """Path of the program that belongs to this package, or else of the installed one. Raises Error.

    >>> import dihaptic.program
    >>> dihaptic.program.program().endswith("dihaptic")
    True
    """
    found = _native.program() or shutil.which("dihaptic")
    if not found:
        raise error("the program dihaptic is not there", "Build it by ./dev build, or install it.")
    return found


def shipped(name: str) -> Path:
    """Path of a file that comes with the program, such as "scenes/block-on-table.yaml", or is kept for all studies
    in ~/.local/share/dihaptic. Raises Error.

    >>> import dihaptic as dh
    >>> dh.shipped("scenes/block-on-table.yaml").is_file()
    True
    """
    if Path(name).is_absolute() or ".." in Path(name).parts:
        raise error("is a path of yours", "Name a file such as scenes/block-on-table.yaml.", file=name)
    found = Path(_native.kept(name))
    if not found.is_file():
        raise error("does not come with the program", "See its folders scenes, rigs and experiments.", file=name)
    return found


def run(
    file: Input,
    *,
    rig: Input = "",
    movement: str | Path = "",
    participant: str = "",
    simulate: bool = False,
    settings: Mapping[str, Any] | None = None,
    seed: int = 1,
    out: str | Path = "sessions",
    clock: str = "",
    between: BetweenTrials | None = None,
    person: Person | None = None,
    progress: bool = True,
) -> Session:
    """Runs a scene or an experiment, a file or an object, as `dihaptic run` does; opens its session.

    `simulate`: a simulated person on simulated devices does the trials. `clock`: real or virtual, as
    fast as it can be; left out, real with real devices alone. `between`: decides between
    trials. `person`: a simulated one of your own does them, in this process. With real devices, what
    the command prints and asks is printed and asked here, and Escape and Ctrl-C switch force off. A
    session that was interrupted, or whose force went off, is returned too, with a warning that says
    why. Ctrl-C ends the session in order, and is raised again once its files are made. Raises Error
    for whatever is wrong with the files.

    >>> import dihaptic as dh
    >>> session = dh.run("experiments/lift-block.yaml", out=folder, progress=False)
    >>> session.lifts.lift.item()
    'complete'
    """
    given = [f"{key}={_setting(value)}" for key, value in (settings or {}).items()]
    out = out or "sessions"
    if person is not None:
        if not isinstance(person, Person):
            raise error(f"{person!r} is nobody", "Give an object of a class that derives from Person.")
        if between is not None or movement or clock == "real":
            raise error(
                "a person of one's own does the trials alone, on the virtual clock",
                "Leave out between, movement and clock.",
            )
        with on_disk(file) as path, on_disk(rig) as rig_path:
            sitting = _native.Sitting(path, rig_path, given, seed, participant)
        return person._do(sitting, out)
    command = ["--seed", str(seed), "--out", str(out)] + ["--simulate"] * simulate
    for option, value in {"--movement": movement, "--participant": participant, "--clock": clock}.items():
        if value:
            command += [option, str(value)]
    for setting in given:
        command += ["--set", setting]
    with on_disk(file) as path, on_disk(rig) as rig_path, listening(between) as asking:
        command = ["run", path, *command, *asking] + (["--rig", rig_path] if rig else [])
        real = not simulate and _native.on_real_devices(path, rig_path)
        return _session_of(_call(command, progress, echo=real))


def resume(session: Session | str | Path, *, progress: bool = True) -> Session:
    """Goes on with a session whose trials were not all done; returns the new session.

    >>> import dihaptic as dh
    >>> dh.resume(lift_session)
    Traceback (most recent call last):
    ...
    dihaptic.errors.Error: ...: error: has no trials that could go on. ...
    """
    folder = _folder(session)
    real = Session(folder).info.get("moved_by", {}).get("mover") == "devices"
    return _session_of(_call(["resume", folder], progress, echo=real))


def replay(session: Session | str | Path, *, progress: bool = True) -> bool:
    """Whether a session's forces, computed again from what its devices said, are the same to the bit.

    If they are not, or the session is of another version or damaged, a warning says what differs.

    >>> import dihaptic as dh
    >>> dh.replay(lift_session, progress=False)
    True
    """
    answer = _call(["replay", _folder(session)], progress)
    if answer.code != 0:
        warnings.warn("\n".join([*answer.said, *answer.output]), stacklevel=2)
    return answer.code == 0


def recover(session: Session | str | Path, *, progress: bool = True) -> Session:
    """Makes the files of a session that was killed, from its raw.log.

    >>> import dihaptic as dh
    >>> dh.recover(lift_session, progress=False).info["state"]
    'complete'
    """
    folder = _folder(session)
    _call(["recover", folder], progress)
    return Session(folder)


def report(session: Session | str | Path, *, progress: bool = True) -> Path:
    """Makes the report of a session, or of a folder of sessions; returns its report.html.

    >>> import dihaptic as dh
    >>> dh.report(lift_session, progress=False).name
    'report.html'
    """
    folder = _folder(session)
    _call(["report", folder], progress)
    return Path(folder) / "report.html"


def check(*files: Input, rig: Input = "") -> list[Problem]:
    """What `dihaptic check` finds in files or objects: errors and warnings; none: all is in order.

    >>> import dihaptic as dh
    >>> dh.check("scenes/block-on-table.yaml", "experiments/first-trials.yaml")
    []
    """
    return [problem for given in files for problem in problems_of(given, rig)]


def rehearse(
    experiment: Input,
    people: int = 1,
    *,
    jobs: int = 1,
    population: str | Path = "",
    seed: int = 1,
    out: str | Path = "",
    progress: bool = True,
) -> Rehearsal:
    """Lets simulated people do an experiment, as `dihaptic rehearse` does, and collects their tables.

    Who is in the folder already is not done again. The tables are the same whatever `jobs`. Raises
    Error.

    >>> import dihaptic as dh
    >>> study = dh.rehearse("experiments/first-trials.yaml", 2, out=f"{folder}/study", progress=False)
    >>> sorted(study.trials.ppid.unique())
    ['sim-001', 'sim-002']
    """
    with on_disk(experiment) as file:
        folder = Path(out or f"rehearsals/{Path(file).stem}_{seed}")
        command = ["rehearse", file, "--people", str(people), "--jobs", str(jobs), "--seed", str(seed)]
        command += ["--out", str(folder)] + (["--population", str(population)] if population else [])
        _call(command, progress)
    _call(["collect", str(folder), "--out", str(folder)], progress=False)
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


def _setting(value: Any) -> Any:
    return "yes" if value is True else "no" if value is False else value


class _Answer:
    """What a command printed, and how it ended."""

    def __init__(self, code: int, output: list[str], said: list[str]) -> None:
        self.code = code
        self.output = output
        self.said = said  # on standard error, without progress


def _call(command: Sequence[str], progress: bool, echo: bool = False) -> _Answer:
    """Runs a command to its end. Raises Error when its input was bad. `echo`: with what it prints,
    since with real devices it asks, and tells how to switch force off."""
    with subprocess.Popen(
        [program(), *command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, errors="replace"
    ) as process:
        assert process.stdout is not None and process.stderr is not None
        said: list[str] = []
        watcher = threading.Thread(target=_watch, args=(process.stderr, said, progress))
        watcher.start()
        try:
            output = _read(process.stdout, echo)
        except KeyboardInterrupt:
            # it ends in order, with its files made, and force off
            process.send_signal(signal.SIGINT)
            process.stdout.read()
            raise
        finally:
            watcher.join()
    if process.returncode == _BAD_INPUT:
        raise Error(_problems(said + output) or [_problem_of_option(said)])
    if process.returncode < 0:
        raise error(
            f"dihaptic {command[0]} was ended by signal {-process.returncode}",
            "What it had recorded stays in its folder: recover() makes a session of it.",
        )
    return _Answer(process.returncode, output, said)


def _read(stream: IO[str], echo: bool) -> list[str]:
    text = ""
    while some := stream.read(1 if echo else -1):
        text += some
        if echo:
            sys.stdout.write(some)
            sys.stdout.flush()
    return text.splitlines()


def _watch(stream: IO[str], said: list[str], progress: bool) -> None:
    """Shows the command's progress in one line, and keeps what else it says."""
    shown = False
    for line in stream:
        at = _PROGRESS.match(line)
        if at is None:
            said.append(line.rstrip("\n"))
        elif progress:
            sys.stderr.write(f"\r{at['what']} {at['share']} %".ljust(40))
            sys.stderr.flush()
            shown = True
    if shown:
        sys.stderr.write("\r" + " " * 40 + "\r")


def _problems(lines: Sequence[str]) -> list[Problem]:
    found = []
    for line in lines:
        at = _PROBLEM.match(line)
        if at:
            place = (at["severity"], at["file"] or "", int(at["line"] or 0))
            found.append(Problem(*place, key="", what=at["what"].rstrip("."), remedy=""))
    return found


def _problem_of_option(lines: Sequence[str]) -> Problem:
    """What the command line says of an option is about the argument of that name."""
    text = "\n".join(line for line in lines if not line.startswith("Run with --help")).rstrip(".")
    at = re.match(r"--(?P<name>[a-z-]+): (?P<what>.*)", text, re.DOTALL)
    if at is None:
        return Problem("error", "", 0, "", text, "")
    return Problem("error", "", 0, at["name"].replace("-", "_"), at["what"], "")


def _session_of(answer: _Answer) -> Session:
    folder = next((line[len("session: ") :] for line in answer.output if line.startswith("session: ")), None)
    if folder is None:
        raise error("\n".join(answer.said + answer.output), "")
    told = [line for line in answer.output if line.startswith("WARNING: ")]
    if answer.code != 0 or told:
        warnings.warn("\n".join([*answer.said, *told]) or f"see {folder}", stacklevel=3)
    return Session(folder)


def _folder(session: Session | str | Path) -> str:
    return str(session.folder if isinstance(session, Session) else session)
