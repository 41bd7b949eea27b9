"""Reads the results of a rehearsal."""

from __future__ import annotations

import os
from pathlib import Path

import pandas as pd

from .tables import Collected, command_of


class Rehearsal(Collected):
    """The results of a population of simulated people: tables with a row for each person's trial or
    fit.

    >>> import dihaptic as dh
    >>> study = dh.rehearse("experiments/first-trials.yaml", 2, out=f"{folder}/study", progress=False)
    >>> len(study.sessions), "trials" in study.tables
    (2, True)
    """

    def __init__(self, folder: str | Path) -> None:
        self.folder = Path(os.path.abspath(folder))  # still the same when the program changes its own

    def __repr__(self) -> str:
        return f"<Rehearsal {self.folder}: {len(self.sessions)} people>"

    @property
    def sessions(self) -> list[Path]:
        """Folder of each person, in the order of their numbers."""
        return sorted(path.parent for path in self.folder.glob("*/person.yaml"))

    @property
    def people(self) -> pd.DataFrame:
        """A row for each person, with the person's traits."""
        return self.table("people")

    @property
    def _tables_folder(self) -> Path:
        return self.folder

    def _collecting(self) -> tuple[Path, str]:
        return self.folder, command_of("collect", self.folder)
