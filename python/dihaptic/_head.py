"""Reads a session's description of itself: session.yaml, and the head of raw.log (src/recording/chunk.h)."""

from __future__ import annotations

import shlex
import struct
import zlib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, BinaryIO, TypeVar

import yaml

from .errors import error

#: Every value is a text, exactly as in the file.
_LOADER = getattr(yaml, "CBaseLoader", yaml.BaseLoader)
#: For each version of the log: its first line, and the header of a chunk, whose last number is its checksum.
_VERSIONS = {
    b"DIHAPTIC LOG 3\n": struct.Struct("<4sIQII"),
    b"DIHAPTIC LOG 2\n": struct.Struct("<4sIQII"),
    b"DIHAPTIC LOG 1\n": struct.Struct("<4sII"),
}
_MOST_HEAD = 1 << 24  # bytes
#: The remedy for a damaged file that the program wrote.
_BACKUP = "Restore it from a backup."
#: The last line of session.yaml, without which it is cut off.
_END = "...\n"
#: More lists and keys within each other than any file of the program has. The parser, written in C, does not survive a
#: hundred thousand of them.
_MOST_NESTED = 200
#: What is wrong with a part of a file that is not of this kind.
_WRONG: dict[type, str] = {dict: "has no keys", list: "is not a list of items with keys", str: "is not a single value"}
#: A kind of part: keys with values, a list of such, or a single value.
_Part = TypeVar("_Part", dict[str, Any], list[Any], str)


@dataclass(frozen=True)
class Head:
    """The content of a log before its first tick."""

    tick: float  #: [s]
    items: dict[str, list[str]]  #: for each list whose items have names: these names, in order
    identity: str = field(default="", compare=False)  #: of the session, which session.yaml has too; empty: not known


def read_yaml(text: str, file: Path, remedy: str = _BACKUP) -> dict[str, Any]:
    """A mapping, whose values are texts, lists and mappings. Raises Error, with `remedy`."""
    try:
        if _is_nested_deeply(text):
            raise error(f"has more than {_MOST_NESTED} lists or keys within each other", remedy, file=str(file))
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
        remedy = f"{_BACKUP} From raw.log it is rebuilt by dihaptic recover {shlex.quote(str(folder))}"
        raise error("is cut off: it does not end with '...'", remedy, file=str(file))
    return read_yaml(text, file)


def part_of(
    document: dict[str, Any], key: str, kind: type[_Part], file: Path, remedy: str = _BACKUP, of: str = ""
) -> _Part:
    """A part of a file's content, empty if there is none; `of`: the key in front of it. Raises Error when it is of
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
        with file.open("rb") as log:
            text = _text_of_head(log, file)
    except OSError as why:
        raise error(f"cannot be read: {why}", "Copy it from the recording computer.", file=str(file)) from None
    head = read_yaml(text, file)
    turning = [device["finger"] for device in head.get("devices", []) if device.get("orientation") == "yes"]
    items = {name: list(head.get(name) or []) for name in ("fingers", "bodies", "joints")}
    in_order = {"fingers": items["fingers"], "turns": turning, "bodies": items["bodies"], "joints": items["joints"]}
    return Head(float(head["tick_s"]), in_order, str(head.get("identity", "")))


def _text_of_file(file: Path, remedy: str) -> str:
    try:
        return file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as why:
        raise error(f"cannot be read: {why}", remedy, file=str(file)) from None


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
