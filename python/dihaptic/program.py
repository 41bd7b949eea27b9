"""Runs the program's commands: sessions, reports, checks.

Each runs in a separate process, so that Python cannot delay a tick.
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

from . import _native
from .between import BetweenTrials, listening
from .errors import Error, Problem, error
from .files import Input, on_disk, problems_of
from .person import Ended, Person
from .session import Session

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
        raise error("the program dihaptic is missing", "Build it with ./dev build, or install it.")
    return found


def shipped(name: str) -> Path:
    """Path of a file that comes with the program, such as "scenes/block-on-table.yaml", or is kept for all studies
    in ~/.local/share/dihaptic. Raises Error.

    >>> import dihaptic as dh
    >>> dh.shipped("scenes/block-on-table.yaml").is_file()
    True
    """
    if Path(name).is_absolute() or ".." in Path(name).parts:
        raise error("is a path of your own", "Name a file such as scenes/block-on-table.yaml.", file=name)
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
    population: str | Path = "",
    settings: Mapping[str, Any] | None = None,
    seed: int = 1,
    out: str | Path = "sessions",
    clock: str = "",
    between: BetweenTrials | None = None,
    person: Person | None = None,
    progress: bool = True,
) -> Session:
    """Runs a scene or an experiment, given as a file or an object, as `dihaptic run` does, and opens its session.

    With `simulate`, a simulated person, drawn from `population`, does the trials on simulated devices.
    `clock` is real, or virtual (as fast as possible); the default is real only with real devices. `between` chooses the next
    trials. With `person`, your own simulated person does them, in this process. With real devices, the command's output and
    questions appear here, and Escape and Ctrl-C switch force off. A session that was interrupted, or whose force was
    switched off, is returned too, with a warning that gives the reason. Ctrl-C ends the session properly, and is raised
    again once its files are made. Raises Error for any fault in the files.

    >>> import dihaptic as dh
    >>> session = dh.run("experiments/lift-block.yaml", out=folder, progress=False)
    >>> session.lifts.lift.item()
    'complete'
    """
    given = [f"{key}={_setting(value)}" for key, value in (settings or {}).items()]
    out = out or "sessions"
    if person is not None:
        _check_person(person, alone=not (simulate or population or movement or clock == "real"))
        with on_disk(file) as path, on_disk(rig) as rig_path:
            sitting = _native.Sitting(path, rig_path, given, seed, participant)
        with listening(between) as asking:
            return _open(person._do(sitting, out, asking[-1] if asking else ""))
    command = ["--seed", str(seed), "--out", str(out)] + ["--simulate"] * simulate
    options = {"movement": movement, "participant": participant, "clock": clock, "population": population}
    for option, value in options.items():
        if value:
            command += [f"--{option}", str(value)]
    for setting in given:
        command += ["--set", setting]
    with on_disk(file) as path, on_disk(rig) as rig_path, listening(between) as asking:
        command = ["run", path, *command, *asking] + (["--rig", rig_path] if rig else [])
        real = not simulate and _native.on_real_devices(path, rig_path)
        return _open(ended_of(call(command, progress, echo=real)))


def resume(session: Session | str | Path, *, progress: bool = True) -> Session:
    """Continues a session whose trials were not all done; returns the new session.

    >>> import dihaptic as dh
    >>> dh.resume(lift_session)
    Traceback (most recent call last):
    ...
    dihaptic.errors.Error: ...: error: has no trials that could be resumed. ...
    """
    folder = _folder(session)
    real = Session(folder).info.get("moved_by", {}).get("mover") == "devices"
    return _open(ended_of(call(["resume", folder], progress, echo=real)))


def replay(session: Session | str | Path, *, progress: bool = True) -> bool:
    """Whether a session's forces, computed again from its devices' readings, are the same to the bit.

    If they are not, or if the session comes from another version or is damaged, a warning describes the difference.

    >>> import dihaptic as dh
    >>> dh.replay(lift_session, progress=False)
    True
    """
    answer = call(["replay", _folder(session)], progress)
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
    call(["recover", folder], progress)
    return Session(folder)


def report(*sessions: Session | str | Path, out: str | Path = "", progress: bool = True) -> Path:
    """Makes the report of a session, or of a folder of sessions; returns its report.html.

    Several folders are compared, and require a folder `out` for the page. Raises Error.

    >>> import dihaptic as dh
    >>> dh.report(lift_session, progress=False).name
    'report.html'
    """
    if not sessions:
        raise error("is missing", "Name the folder of a session, or one with sessions.", key="sessions")
    folders = [_folder(session) for session in sessions]
    call(["report", *folders, *(["--out", str(out)] if out else [])], progress)
    return Path(out or folders[0]) / "report.html"


def check(*files: Input, rig: Input = "") -> list[Problem]:
    """The findings of `dihaptic check` in files or objects: a list of errors and warnings, empty if there are none.

    >>> import dihaptic as dh
    >>> dh.check("scenes/block-on-table.yaml", "experiments/first-trials.yaml")
    []
    """
    return [problem for given in files for problem in problems_of(given, rig)]


def _setting(value: Any) -> Any:
    return "yes" if value is True else "no" if value is False else value


class _Answer:
    """The output of a command, and its exit code."""

    def __init__(self, code: int, output: list[str], said: list[str]) -> None:
        self.code = code
        self.output = output
        self.said = said  # what it wrote on standard error, without its progress


def call(command: Sequence[str], progress: bool, echo: bool = False) -> _Answer:
    """Runs a command to its end.

    Raises Error when its input was invalid. With `echo`, its output is shown, since with real devices a command asks
    questions, and explains how to switch force off.
    """
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
            # the command then ends properly, with its files made and force off
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
            "Its recording stays in its folder: recover() makes a session from it.",
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
    """Shows the command's progress in one line, and keeps all other output."""
    shown = False
    for line in stream:
        at = _PROGRESS.match(line)
        if line.startswith("waiting: "):  # a command may take long, so its output is shown at once
            sys.stderr.write(line)
            sys.stderr.flush()
        elif at is None:
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
    """Turns a problem with an option of the command line into one with the argument of that
    name."""
    text = "\n".join(line for line in lines if not line.startswith("Run with --help")).rstrip(".")
    at = re.match(r"--(?P<name>[a-z-]+): (?P<what>.*)", text, re.DOTALL)
    if at is None:
        return Problem("error", "", 0, "", text, "")
    return Problem("error", "", 0, at["name"].replace("-", "_"), at["what"], "")


def ended_of(answer: _Answer) -> Ended:
    """The end of a command's session. Raises Error when there is none."""
    folder = next((line[len("session: ") :] for line in answer.output if line.startswith("session: ")), None)
    if folder is None:
        raise error("\n".join(answer.said + answer.output), "")
    told = [line for line in answer.output if line.startswith("WARNING: ")]
    return Ended(folder, answer.code == 0, [*answer.said, *told])


def _open(ended: Ended) -> Session:
    """Opens a session, and turns anything unexpected into a warning at the call of run() or resume()."""
    if not ended.good or any(line.startswith("WARNING: ") for line in ended.said):
        warnings.warn("\n".join(ended.said) or f"see {ended.folder}", stacklevel=3)
    return Session(ended.folder)


def _check_person(person: object, alone: bool) -> None:
    if not isinstance(person, Person):
        raise error(f"{person!r} is not a person", "Give an object of a class that derives from Person.")
    if not alone:
        raise error(
            "your own person does the trials alone, on the virtual clock",
            "Leave out simulate, population, movement and clock.",
        )


def _folder(session: Session | str | Path) -> str:
    return str(session.folder if isinstance(session, Session) else session)
