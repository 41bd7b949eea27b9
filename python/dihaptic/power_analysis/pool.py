"""Reads the pool of people from whom samples are drawn."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from .. import figures
from ..errors import error
from ..figures.data import Data

#: The text between the name of a population and that of a group, in session.yaml.
_GROUP = ", group "


def read_pool(folder: Path) -> Data:
    """The tables of a rehearsal. Groups of its population are groups of people here, although elsewhere each is a sample of
    its own. Raises Error."""
    samples = figures.samples_in(folder)
    titles = sorted({str(sample.experiment) for sample in samples})
    if len(titles) > 1:
        what = f"contains sessions of {len(titles)} experiments: {'; '.join(titles)}"
        remedy = "Name a folder with one; or, to compare groups whose files differ in little, give these files the same title."
        raise error(what, remedy, file=str(folder))
    if len(samples) < 2 or any(_GROUP not in str(sample.population) for sample in samples):
        return figures.read(folder)
    names = [str(sample.population).rpartition(_GROUP) for sample in samples]
    parts = [figures.read(folder, population=sample.population) for sample in samples]
    out = parts[0]
    out.sittings = [replace(each, group=group) for part, (*_, group) in zip(parts, names) for each in part.sittings]
    out.sample = replace(out.sample, population=names[0][0])
    return out
