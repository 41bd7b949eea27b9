"""Reads a session's description of itself: session.yaml, and the head of raw.log (src/recording/chunk.h)."""

from __future__ import annotations

import math
import os
import shlex
import stat
import struct
import zlib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, BinaryIO, TypeVar

import yaml

from .errors import Error, error

#: Every value is a text, exactly as in the file.
_LOADER = getattr(yaml, "CBaseLoader", yaml.BaseLoader)
#: For each version of the log: its first line, and the header of a chunk, whose last number is its checksum.
_VERSIONS = {
    b"DIHAPTIC LOG 3\n": struct.Struct("<4sIQII"),
    b"DIHAPTIC LOG 2\n": struct.Struct("<4sIQII"),
    b"DIHAPTIC LOG 1\n": struct.Struct("<4sII"),
}
_MOST_HEAD = 1 << 24  # bytes
#: The largest file of keys that the program reads (src/base/text_file.h) [bytes].
MOST_YAML = 16_000_000
#: The remedy for a damaged file that the program wrote.
_BACKUP = "Restore it from a backup."
#: The last line of session.yaml; a file without it has been cut off.
_END = "...\n"
#: More levels of nested lists and keys than any file of the program has. The parser, which is written in C, crashes on a :
#: hundred thousand of them.
_MOST_NESTED = 200
#: The fault of a part of a file that is not of this kind.
_WRONG: dict[type, str] = {dict: "has no keys", list: "is not a list of items with keys", str: "is not a single value"}
#: A kind of part: keys with values, a list of these, or a single value.
_Part = TypeVar("_Part", dict[str, Any], list[Any], str)


@dataclass(frozen=True)
class Head:
    """The content of a log before its first tick."""

    tick: float  #: [s]
    items: dict[str, list[str]]  #: for each list whose items have names: these names, in order
    identity: str = field(default="", compare=False)  #: identity of the session, as in session.yaml; empty: not known


def why_unreadable(file: Path, most: float = math.inf) -> str:
    """Why a file cannot be read: it is not there, is larger than `most` [bytes], or is not a regular file (a pipe or a
    device would keep its reader waiting, or reading, forever). Empty if it can be read."""
    try:
        status = os.stat(file)
        if not stat.S_ISREG(status.st_mode):
            return "it is a folder" if stat.S_ISDIR(status.st_mode) else "it is not a regular file"
        if status.st_size > most:
            return f"it has {status.st_size / 1e6:.0f} MB, and at most {most / 1e6:.0f} MB are read"
        os.close(os.open(file, os.O_RDONLY))
    except (OSError, ValueError) as why:  # it was a ValueError: no file can have this name
        return getattr(why, "strerror", None) or str(why)
    return ""


def most_of_recording(ticks: int) -> float:
    """A size [bytes] that neither raw.log nor session.nwb reaches: their ticks take a few hundred bytes each."""
    return 1e9 + 1e5 * ticks


def is_yes(document: dict[str, Any], key: str, file: Path, remedy: str = _BACKUP, of: str = "") -> bool:
    """A logical value: the program writes yes and no, and other software saves them as true and false. Raises Error."""
    word = part_of(document, key, str, file, remedy, of) or "no"
    if word not in ("yes", "true", "no", "false"):
        raise error(f"must be yes or no, but is '{word}'", remedy, file=str(file), key=of + key)
    return word in ("yes", "true")


def read_yaml(text: str, file: Path, remedy: str = _BACKUP) -> dict[str, Any]:
    """A mapping, whose values are texts, lists and mappings. Raises Error, with `remedy`."""
    try:
        if _is_nested_deeply(text):
            raise error(f"has more than {_MOST_NESTED} lists or keys nested within each other", remedy, file=str(file))
        read = yaml.load(text, _LOADER)
    except yaml.YAMLError as why:
        raise error(f"cannot be read: {why}", remedy, file=str(file)) from None
    if not isinstance(read or {}, dict):
        raise error("has no keys", remedy, file=str(file))
    return read or {}


def read_info(file: Path, remedy: str = _BACKUP) -> dict[str, Any]:
    """The content of a file of keys. Raises Error, with `remedy`."""
    return read_yaml(_text_of_file(file, remedy), file, remedy)


def read_session_info(folder: Path) -> dict[str, Any]:
    """The content of session.yaml. Raises Error, also when the file is cut off, since its end has the seals."""
    file = folder / "session.yaml"
    text = _text_of_file(file, _BACKUP)
    if not text.endswith(_END):
        remedy = f"{_BACKUP} Or rebuild it from raw.log: dihaptic recover {shlex.quote(str(folder))}"
        raise error("is cut off: it does not end with '...'", remedy, file=str(file))
    return read_yaml(text, file)


def part_of(
    document: dict[str, Any], key: str, kind: type[_Part], file: Path, remedy: str = _BACKUP, of: str = ""
) -> _Part:
    """A part of a file's content, empty if there is none; `of` is the key in front of it. Raises Error when it is of
    another kind."""
    part = document.get(key)
    if part is None or part == "":
        return kind()
    if not isinstance(part, kind) or (kind is list and not all(isinstance(item, dict) for item in part)):
        raise error(_WRONG[kind], remedy, file=str(file), key=of + key)
    return part


def read_head(file: Path) -> Head:
    """The head of a raw.log. Raises Error."""
    try:
        if why := why_unreadable(file):
            raise OSError(why)
        with file.open("rb") as log:
            text = _text_of_head(log, file)
    except (OSError, UnicodeDecodeError) as fault:
        raise error(f"cannot be read: {fault}", "Copy it from the recording computer.", file=str(file)) from None
    head = read_yaml(text, file)
    try:
        devices = part_of(head, "devices", list, file)
        turning = [device["finger"] for device in devices if is_yes(device, "orientation", file)]
        items = {name: list(head.get(name) or []) for name in ("fingers", "bodies", "joints")}
        if not all(isinstance(name, str) for names in (turning, *items.values()) for name in names):
            raise ValueError("a name is not a single value")
        tick = tick_of(head["tick_s"])
    except (KeyError, TypeError, ValueError) as fault:
        if isinstance(fault, Error):
            raise
        raise error(f"has a damaged head: {fault}", _BACKUP, file=str(file)) from None
    in_order = {"fingers": items["fingers"], "turns": turning, "bodies": items["bodies"], "joints": items["joints"]}
    return Head(tick, in_order, str(head.get("identity", "")))


def tick_of(value: Any) -> float:
    """The time from one tick to the next [s]. Raises ValueError or TypeError when it cannot be one."""
    tick = float(value)
    if not 0 < tick < math.inf:
        raise ValueError(f"the tick is {value} s")
    return tick


def _text_of_file(file: Path, remedy: str) -> str:
    if why := why_unreadable(file, MOST_YAML):
        raise error(f"cannot be read: {why}", remedy, file=str(file))
    try:
        return file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as fault:
        raise error(f"cannot be read: {fault}", remedy, file=str(file)) from None


def _is_nested_deeply(text: str) -> bool:
    depth = 0
    for event in yaml.parse(text, _LOADER):
        if isinstance(event, yaml.CollectionStartEvent):
            depth += 1
            if depth > _MOST_NESTED:
                return True
        elif isinstance(event, yaml.CollectionEndEvent):
            depth -= 1
    return False


def _text_of_head(log: BinaryIO, file: Path) -> str:
    first = log.readline(len(next(iter(_VERSIONS))))
    if first not in _VERSIONS:
        raise error("is not a log of Dihaptic", "Give a session's folder, or its raw.log.", file=str(file))
    layout = _VERSIONS[first]
    header = log.read(layout.size)
    if len(header) == layout.size:
        kind, size, *_, checksum = layout.unpack(header)
        payload = log.read(min(size, _MOST_HEAD))
        if kind == b"HEAD" and zlib.crc32(payload, zlib.crc32(header[:-4])) == checksum:
            return payload.decode("utf-8")
    raise error(
        "has no readable head", "Nothing in it can be recovered: replace it with a backup.", file=str(file)
    )
