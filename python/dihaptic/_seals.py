"""Detects whether a session's tables, or its session.nwb, changed since it ended (src/recording/seal.h)."""

from __future__ import annotations

import os
import shlex
import zlib
from pathlib import Path
from typing import Any

from ._facts import facts
from ._head import most_of_recording, part_of, why_unreadable
from .errors import Problem

_NWB = "session.nwb"
#: Files that every session has, but that versions before 0.3 did not seal.
_SEALED_LATER = [_NWB, "settings.csv"]
#: The largest table that the program seals (src/base/text_file.h) [bytes].
_MOST_TABLE = 200_000_000
#: Keys that every version writes into session.yaml before the first tick.
_ALWAYS = ["state", "program", "started", "title", "experiment", "clock", "seed", "inputs"]
#: The start of the names of programs that wrote no seals; some of 0.2 wrote none either.
_BEFORE_SEALS = "dihaptic 0.1."
_REPEAT = "Restore it from a backup. If there is none, the session has to be repeated."


def faults(folder: Path, info: dict[str, Any], name: str = "") -> list[str]:
    """Sentences about what session.yaml and a file of the session are known to have lost, or how they were changed.

    `info` is the content of session.yaml, and `name` the name of the file (empty: no file). Raises Error when the seals
    cannot be read.
    """
    found = []
    if lost := [key for key in _ALWAYS if not info.get(key)]:
        found.append(_problem(folder, "session.yaml", f"has lost keys: {', '.join(lost)}"))
    of_first_versions = str(info.get("program", "")).startswith(_BEFORE_SEALS)
    if not _is_sealed(info) and info.get("state") != "running" and not of_first_versions:
        what = "has no seals (tables, seal), which all but the earliest versions write: whether the session's files"
        found.append(_problem(folder, "session.yaml", f"{what} have changed since it ended is not known"))
    return found + broken_seals(folder, info, name)


def broken_seals(folder: Path, info: dict[str, Any], name: str = "") -> list[str]:
    """The faults of session.yaml's seal, and of a table, an input, or session.nwb, in sentences.

    None for a file that is never sealed and, unless it is an input, for any file of a session without seals. Raises Error
    when the seals cannot be read.
    """
    file = folder / "session.yaml"
    found = []
    if _is_sealed(info) and _seal_of(info, file) != info.get("seal", ""):
        what = "the session's identity, participant, seed, program, state, ticks, inputs or list of tables"
        found.append(_problem(folder, "session.yaml", f"does not match: {what} has been changed since it ended", key="seal"))
    problem = _problem_of(folder, info, name)
    return [*found, problem.text()] if problem else found


def gone_tables(folder: Path, info: dict[str, Any]) -> dict[str, Problem]:
    """A fault for each table that was sealed, or was an input, and no longer exists. Raises Error."""
    file = folder / "session.yaml"
    names = [str(each.get("file")) for key in ("tables", "inputs") for each in part_of(info, key, list, file)]
    gone = [name for name in names if name.endswith(".csv") and not os.path.lexists(folder / name)]
    problems = {name[: -len(".csv")]: _problem_of(folder, info, name) for name in gone}
    return {name: problem for name, problem in problems.items() if problem}


def _is_sealed(info: dict[str, Any]) -> bool:
    return bool(info.get("tables") or info.get("seal"))


def _problem_of(folder: Path, info: dict[str, Any], name: str) -> Problem | None:
    yaml = folder / "session.yaml"
    sealed = {str(each.get("file")): each for each in part_of(info, "tables", list, yaml)}
    inputs = {str(each.get("file")): each for each in part_of(info, "inputs", list, yaml)}
    known = [*facts()["tables_from_log"], *facts()["other_tables"], "trial-list.csv"]
    if name in inputs:
        fault = _fault_of_input(folder / name, inputs[name])
        remedy = "Restore the recorded version from a backup, or from another session of the same experiment."
        return _warning(folder, name, fault, remedy) if fault else None
    if name in _SEALED_LATER and name not in sealed:
        fault = ""
    elif name == _NWB:
        fault = _fault_of_nwb(folder / name, sealed[name])
    elif name in sealed or (name in known and _is_sealed(info)):
        fault = _fault_of_table(folder / name, sealed.get(name))
    else:
        fault = ""
    return _warning(folder, name, fault, _remedy(folder, name)) if fault else None


def _seal_of(info: dict[str, Any], file: Path) -> str:
    participant = part_of(info, "participant", dict, file).get("id", "")
    own = [info.get("identity", ""), participant, info.get("seed", ""), info.get("program", "")]
    lines = [*own, info.get("state", ""), info.get("ticks", "0")]
    lines += [f"{each.get('file')} {each.get('checksum', '')}" for each in part_of(info, "inputs", list, file)]
    for each in part_of(info, "tables", list, file):
        lines.append(f"{each.get('file')} {each.get('rows', '0')} {each.get('checksum')}")
    return _checksum("".join(f"{line}\n" for line in lines).encode())


def _fault_of_table(file: Path, sealed: dict[str, Any] | None) -> str:
    if sealed is None:
        return "did not exist when the session ended: it belongs to something else"
    then = str(sealed.get("rows", "0"))
    had = f"it had {_counted(then)} when the session ended"
    if not os.path.lexists(file):
        return f"is gone: {had}"
    if why := why_unreadable(file, _MOST_TABLE):
        return f"cannot be read: {why}; {had}"
    csv = file.read_bytes()
    if _checksum(csv) == sealed.get("checksum"):
        return ""
    rows = str(_rows_of(csv))
    if rows != then:
        return f"has {_counted(rows)}; {had}"
    return f"has been changed since the session ended (it still has {_counted(rows)})"


def _fault_of_nwb(file: Path, sealed: dict[str, Any]) -> str:
    rows = str(sealed.get("rows", "0"))  # the number of ticks
    if why := why_unreadable(file, most_of_recording(int(rows) if rows.isdecimal() else 0)):
        return f"cannot be compared with its checksum: {why}"
    if _checksum_of(file) == sealed.get("checksum"):
        return ""
    return "has been changed or damaged since the session ended: its values may be wrong"


def _fault_of_input(file: Path, recorded: dict[str, Any]) -> str:
    if not os.path.lexists(file):
        return "is gone: it is an input of the session"
    if why := why_unreadable(file, _MOST_TABLE):
        return f"cannot be read: {why}"
    return "" if _checksum_of(file) == recorded.get("checksum") else "has changed since the session was recorded"


def _problem(folder: Path, name: str, what: str, key: str = "") -> str:
    return _warning(folder, name, what, _remedy(folder, name), key).text()


def _warning(folder: Path, name: str, what: str, remedy: str, key: str = "") -> Problem:
    return Problem("warning", str(folder / name), 0, key, what, remedy)


def _remedy(folder: Path, name: str) -> str:
    # the same command also seals session.yaml again
    if (folder / "raw.log").is_file() and name not in facts()["other_tables"]:
        return f"Rebuild it from raw.log: dihaptic recover {shlex.quote(str(folder))}"
    return _REPEAT


def _checksum_of(file: Path) -> str:
    checksum = 0
    with file.open("rb") as data:
        while block := data.read(1 << 20):
            checksum = zlib.crc32(block, checksum)
    return f"{checksum:08x}"


def _checksum(data: bytes) -> str:
    return f"{zlib.crc32(data):08x}"


def _rows_of(csv: bytes) -> int:
    """Number of rows without the header; a text in quotes may have several lines."""
    outside = b"".join(csv.split(b'"')[::2])
    lines = outside.count(b"\n") + (bool(csv) and not csv.endswith(b"\n"))
    return max(0, lines - 1)


def _counted(rows: str) -> str:
    return f"{rows} row" if rows == "1" else f"{rows} rows"
