"""Reads the results of a rehearsal."""

from __future__ import annotations

import shlex
from pathlib import Path

import pandas as pd

from .errors import NotThere, error
from .tables import read_table


class Rehearsal:
    """The results of a population of simulated people: tables with a row for each person's trial or
    fit.

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
        """Names of the collected tables, without .csv."""
        return sorted(path.stem for path in self.folder.glob("*.csv"))

    def table(self, name: str) -> pd.DataFrame:
        """A table of all people by its name. Raises Error."""
        if not self.tables:
            raise error("has no tables yet", f"Type dihaptic collect {shlex.quote(str(self.folder))}.", file=str(self.folder))
        if name not in self.tables:
            raise NotThere(name, "is not a table of this rehearsal", self.tables, "Rehearsal.tables lists them.")
        return read_table(self.folder / f"{name}.csv")

    @property
    def trials(self) -> pd.DataFrame:
        """One row for each attempt of each person."""
        return self.table("trials")

    @property
    def people(self) -> pd.DataFrame:
        """A row for each person, with the person's traits."""
        return self.table("people")
