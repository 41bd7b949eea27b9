"""Reads a session's description of itself: session.yaml, and the head of raw.log (src/recording/chunk.h) or its copy in
session.nwb."""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO

import h5py
import numpy as np
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


@dataclass(frozen=True)
class Head:
    """The content of a log before its first tick."""

    tick: float  #: [s]
    items: dict[str, list[str]]  #: for each list whose items have names: these names, in order


def read_yaml(text: str, file: Path, remedy: str = _BACKUP) -> dict[str, Any]:
    """A mapping, whose values are texts, lists and mappings. Raises Error, with `remedy`."""
    try:
        read = yaml.load(text, _LOADER)
    except (yaml.YAMLError, RecursionError) as why:
        raise error(f"cannot be read: {why}", remedy, file=str(file)) from None
    if not isinstance(read or {}, dict):
        raise error("has no keys", remedy, file=str(file))
    return read or {}


def read_info(file: Path, remedy: str = _BACKUP) -> dict[str, Any]:
    """The content of session.yaml, or of another file of keys. Raises Error, with `remedy`."""
    try:
        text = file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as why:
        raise error(f"cannot be read: {why}", remedy, file=str(file)) from None
    return read_yaml(text, file, remedy)


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
    return Head(float(head["tick_s"]), in_order)


def head_of_nwb(file: h5py.File) -> Head | None:
    """The head from session.nwb, which is smaller to copy; None if an older version made the file, without a head."""
    if "scratch/items" not in file:
        return None
    table = file["scratch/items"]
    items: dict[str, list[str]] = {"fingers": [], "turns": [], "bodies": [], "joints": []}
    for of, name in zip(table["list"][...], table["name"][...]):
        items[_text(of)].append(_text(name))
    sequence = file["acquisition/sequence"]
    if "timestamps" in sequence:
        tick = float(np.median(np.diff(sequence["timestamps"][...])))
    else:
        tick = 1 / float(sequence["starting_time"].attrs["rate"])
    return Head(round(tick, 9), items)  # ticks are whole nanoseconds, rates have 24 bits


def _text(value: str | bytes) -> str:
    """A text from HDF5, which h5py returns as bytes since its version 3."""
    return value.decode("utf-8") if isinstance(value, bytes) else value


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
