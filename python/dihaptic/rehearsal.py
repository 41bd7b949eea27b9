"""Reads the results of a rehearsal."""

from __future__ import annotations

import os
from pathlib import Path

import pandas as pd

from .errors import error
from .tables import Collected, command_of


class Rehearsal(Collected):
    """The results of a population of simulated people: tables with a row for each person's trial or
    fit. Raises Error when the folder is not a rehearsal's.

    >>> import dihaptic as dh
    >>> study = dh.rehearse("experiments/first-trials.yaml", 2, out=f"{folder}/study", progress=False)
    >>> len(study.sessions), "trials" in study.tables
    (2, True)
    """

    def __init__(self, folder: str | Path) -> None:
        self.folder = Path(os.path.abspath(folder))  # stays valid when the program changes its working folder
        there = _names_in(self.folder)
        if not there & {"rehearsal.yaml", "people.csv"} and not self.sessions:
            raise error(
                "is not a rehearsal: it has neither rehearsal.yaml nor people",
                "Name the folder that dihaptic rehearse has made.",
                file=str(folder),
            )

    def __repr__(self) -> str:
        return f"<Rehearsal {self.folder}: {len(self.sessions)} people>"

    @property
    def sessions(self) -> list[Path]:
        """Folder of each person, in the order of their numbers."""
        return [self.folder / name for name in sorted(_names_in(self.folder)) if _is_person(self.folder / name)]

    @property
    def people(self) -> pd.DataFrame:
        """A row for each person, with the person's traits."""
        return self.table("people")

    @property
    def _tables_folder(self) -> Path:
        return self.folder

    def _collecting(self) -> tuple[Path, str]:
        return self.folder, command_of("collect", self.folder)


def _names_in(folder: Path) -> set[str]:
    """Names of the items in a folder. Raises Error."""
    try:
        return set(os.listdir(folder))
    except (OSError, ValueError) as why:  # it was a ValueError: no folder can have this name
        remedy = "Name the folder that dihaptic rehearse has made."
        raise error(f"cannot be read: {getattr(why, 'strerror', why)}", remedy, file=str(folder)) from None


def _is_person(folder: Path) -> bool:
    """Whether a folder belongs to one person. Raises Error when this cannot be determined."""
    return os.path.isdir(folder) and bool(_names_in(folder) & {"person.yaml", "session.yaml"})
