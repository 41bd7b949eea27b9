"""Detects whether a session's tables, or its session.nwb, changed since it ended (src/recording/seal.h)."""

from __future__ import annotations

import shlex
import zlib
from pathlib import Path
from typing import Any

from ._facts import facts
from ._head import part_of
from .errors import Problem

_NWB = "session.nwb"


def broken_seals(folder: Path, info: dict[str, Any], name: str) -> list[str]:
    """The faults of a table or of session.nwb, and of session.yaml's seal, in sentences.

    `info`: the content of session.yaml; `name`: that of the file. Empty for a session without seals, and for a file
    that is never sealed. Raises Error when the seals cannot be read.
    """
    sealed = {str(each.get("file")): each for each in part_of(info, "tables", list, folder / "session.yaml")}
    if not sealed and not info.get("seal"):
        return []
    found = []
    if _seal_of(info, folder / "session.yaml") != info.get("seal", ""):
        what = "the session's identity, participant, seed, program, state, ticks, inputs or list of tables"
        found.append(
            _problem(folder, "session.yaml", f"does not match: {what} has been changed since it ended", key="seal")
        )
    if name in facts()["tables_from_log"] + facts()["other_tables"]:
        fault = _fault_of_table(folder / name, sealed.get(name))
    elif name == _NWB and _NWB in sealed:  # versions before 0.3 sealed the tables alone
        fault = _fault_of_nwb(folder / name, sealed[name])
    else:
        fault = ""
    return found + [_problem(folder, name, fault)] * bool(fault)


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
    try:
        csv = file.read_bytes()
    except OSError as why:
        return f"cannot be read: {why.strerror}; {had}"
    if _checksum(csv) == sealed.get("checksum"):
        return ""
    rows = str(_rows_of(csv))
    if rows != then:
        return f"has {_counted(rows)}; {had}"
    return f"has been changed since the session ended (it still has {_counted(rows)})"


def _fault_of_nwb(file: Path, sealed: dict[str, Any]) -> str:
    checksum = 0
    try:
        with file.open("rb") as data:
            while block := data.read(1 << 20):
                checksum = zlib.crc32(block, checksum)
    except OSError as why:
        return f"cannot be read: {why.strerror}"
    if f"{checksum:08x}" == sealed.get("checksum"):
        return ""
    return "has been changed or damaged since the session ended: its values may be wrong"


def _problem(folder: Path, name: str, what: str, key: str = "") -> str:
    # the same command also seals session.yaml again
    if (folder / "raw.log").is_file() and name not in facts()["other_tables"]:
        remedy = f"Rebuild it from raw.log: dihaptic recover {shlex.quote(str(folder))}"
    else:
        remedy = "Restore it from a backup. If there is none, the session has to be repeated."
    return Problem("warning", str(folder / name), 0, key, what, remedy).text()


def _checksum(data: bytes) -> str:
    return f"{zlib.crc32(data):08x}"


def _rows_of(csv: bytes) -> int:
    """Number of rows without the header; a text in quotes may have several lines."""
    outside = b"".join(csv.split(b'"')[::2])
    lines = outside.count(b"\n") + (bool(csv) and not csv.endswith(b"\n"))
    return max(0, lines - 1)


def _counted(rows: str) -> str:
    return f"{rows} row" if rows == "1" else f"{rows} rows"
