"""Opens session.nwb, and reports damage to it in whichever call finds the damage."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path

import h5py
import numpy as np

from ._head import Head, read_session_info, tick_of, why_unreadable
from .errors import Error, error

#: The exceptions that h5py raises when it reads a damaged file, depending on which bytes are damaged.
_DAMAGE = (ArithmeticError, AttributeError, LookupError, MemoryError, OSError, RuntimeError, TypeError, ValueError)

#: More names than any session.nwb contains: the usual number is a few hundred.
_MOST_LINKS = 100_000


@contextlib.contextmanager
def reading(folder: Path) -> Iterator[None]:
    """Raises Error when what is read from session.nwb in this context is damaged."""
    try:
        yield
    except Error:
        raise
    except _DAMAGE as why:
        raise error(
            f"session.nwb is damaged: {why}",
            "Rebuild it from raw.log: dihaptic.recover(), or dihaptic recover.",
            file=str(folder),
        ) from None


def open_nwb(folder: Path) -> h5py.File:
    """A session's session.nwb. Raises Error when there is none, or when it is damaged or leads into another file."""
    file = folder / "session.nwb"
    if not os.path.lexists(file):
        raise _without_nwb(folder)
    if why := why_unreadable(file):
        raise error(f"cannot be read: {why}", "Copy it from the recording computer.", file=str(file))
    with reading(folder):
        opened = h5py.File(file, "r")
        try:
            leads_out = _what_leads_out(opened)
        except BaseException:
            opened.close()
            raise
    if leads_out:
        opened.close()
        raise error(
            f"has {leads_out[0]} in another file, which HDF5 would read without asking",
            "Dihaptic never writes such links: find out where this file came from. 'dihaptic recover' rebuilds it.",
            file=str(file),
        )
    return opened


def _without_nwb(folder: Path) -> Error:
    """Why a session has no session.nwb."""
    try:
        state = read_session_info(folder).get("state", "")
    except Error:
        state = ""
    if state not in ("", "running") and not os.path.lexists(folder / "raw.log"):
        return error(
            "has neither session.nwb nor raw.log, only tables: a rehearsal keeps no recordings",
            "With --keep-recordings, dihaptic rehearse keeps them. For a real session, copy its recordings here.",
            file=str(folder),
        )
    what = "the session is still running, or was killed" if state in ("", "running") else "it has been removed"
    return error(
        f"has no session.nwb: {what}",
        "If it is not running, make its files: dihaptic.recover(), or dihaptic recover.",
        file=str(folder),
    )


def head_of_nwb(file: h5py.File) -> Head | None:
    """The log's head, from its copy in session.nwb, which is smaller than raw.log; None if an older version wrote no copy."""
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
    return Head(tick_of(round(tick, 9)), items)  # ticks are whole nanoseconds, rates have 24 bits


def _text(value: str | bytes) -> str:
    """A text from HDF5, which h5py has returned as bytes since version 3."""
    return value.decode("utf-8") if isinstance(value, bytes) else value


def _what_leads_out(file: h5py.File) -> list[str]:
    """Names with content in another file: links, data sets with external raw data, virtual data sets.

    Visits each group once, because links can create countless paths to a few groups. Raises ValueError when there are
    far too many links."""
    out = []
    groups = [file["/"]]
    seen = {h5py.h5o.get_info(groups[0].id).addr}
    links = 0
    while groups:
        group = groups.pop()
        for name in group:
            links += 1
            if links > _MOST_LINKS:
                raise ValueError(f"it has more than {_MOST_LINKS} names")
            link = group.get(name, getlink=True)
            if isinstance(link, h5py.ExternalLink):
                out.append(f"{group.name}/{name}")
            if not isinstance(link, h5py.HardLink):
                continue
            item = group[name]
            address = h5py.h5o.get_info(item.id).addr
            if address in seen:
                continue
            seen.add(address)
            if isinstance(item, h5py.Group):
                groups.append(item)
            elif isinstance(item, h5py.Dataset) and (item.external or item.is_virtual):
                out.append(item.name)
    return out
