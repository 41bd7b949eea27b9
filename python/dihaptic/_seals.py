"""Detects whether a session's tables changed since it ended (src/recording/seal.h)."""

from __future__ import annotations

import shlex
import zlib
from pathlib import Path
from typing import Any

from ._facts import facts
from .errors import Problem


def broken_seals(folder: Path, info: dict[str, Any], table: str) -> list[str]:
    """The faults of a table and of session.yaml's seal, in sentences.

    `info`: the content of session.yaml; `table`: the name of a file. Empty for a session without seals, and for a table
    that is never sealed.
    """
    sealed = {each["file"]: each for each in info.get("tables") or []}
    if not sealed and not info.get("seal"):
        return []
    found = []
    if _seal_of(info) != info.get("seal", ""):
        what = "the session's identity, participant, seed, program, state, ticks, inputs or list of tables"
        found.append(
            _problem(folder, "session.yaml", f"does not match: {what} has been changed since it ended", key="seal")
        )
    if table in facts()["tables_from_log"] + facts()["other_tables"]:
        fault = _fault_of(folder / table, sealed.get(table))
        if fault:
            found.append(_problem(folder, table, fault))
    return found


def _seal_of(info: dict[str, Any]) -> str:
    participant = (info.get("participant") or {}).get("id", "")
    own = [info.get("identity", ""), participant, info.get("seed", ""), info.get("program", "")]
    lines = [*own, info.get("state", ""), info.get("ticks", "0")]
    lines += [f"{each['file']} {each.get('checksum', '')}" for each in info.get("inputs") or []]
    lines += [f"{each['file']} {each.get('rows', '0')} {each['checksum']}" for each in info.get("tables") or []]
    return _checksum("".join(f"{line}\n" for line in lines).encode())


def _fault_of(file: Path, sealed: dict[str, str] | None) -> str:
    if sealed is None:
        return "did not exist when the session ended: it belongs to something else"
    then = f"it had {_counted(int(sealed.get('rows', 0)))} when the session ended"
    try:
        csv = file.read_bytes()
    except OSError as why:
        return f"cannot be read: {why.strerror}; {then}"
    if _checksum(csv) == sealed["checksum"]:
        return ""
    rows = _rows_of(csv)
    if rows != int(sealed.get("rows", 0)):
        return f"has {_counted(rows)}; {then}"
    return f"has been changed since the session ended (it still has {_counted(rows)})"


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


def _counted(rows: int) -> str:
    return f"{rows} row" if rows == 1 else f"{rows} rows"
