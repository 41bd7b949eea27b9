"""Reads the program's tables, with the units of their columns."""

from __future__ import annotations

import os
import re
import shlex
from abc import ABC, abstractmethod
from pathlib import Path
from typing import TextIO

import pandas as pd

from ._facts import facts
from ._head import why_unreadable
from .errors import Error, NotThere, error

#: The program writes yes and no, while R, pandas and spreadsheets save logical values in words of their own.
_YES = {"yes": True, "no": False, "true": True, "false": False}
#: The largest table that is read [bytes]: in memory it takes several times as much.
_MOST_TABLE = 2e9


def read_table(file: str | Path) -> pd.DataFrame:
    """Reads a table of the program (docs/tables.md), or any CSV file of your own.

    `attrs["units"]` has the unit of each column whose name ends in one, and `attrs["meanings"]` a
    few words about each column of trials, phases, events, episodes and lifts. Cells that are empty
    or missing are NaN. Raises Error when the file cannot be read, or a row has more cells than the header.

    >>> import dihaptic as dh
    >>> lifts = dh.read_table(f"{lift_session}/lifts.csv")
    >>> lifts.attrs["units"]["peak_grip_N"]
    'N'
    >>> lifts.attrs["meanings"]["peak_grip_N"]
    'peak of the grip (mean over digits), from touch to lowering'
    """
    path = Path(file)
    if unreadable := why_unreadable(path, _MOST_TABLE):
        raise error(f"cannot be read as a table: {unreadable}", "Name a CSV file.", file=str(path))
    try:
        table = parse_table(path, path.name)
        if len(table) and not isinstance(table.index, pd.RangeIndex):
            # the first row has more cells than the header, so pandas took some of them for the row's name; reading
            # without a header raises the same error as for a later row
            pd.read_csv(path, header=None)
        return table
    except (OSError, MemoryError, OverflowError, ValueError) as why:  # errors of pandas' reader are ValueErrors
        if isinstance(why, Error):
            raise
        if longer := re.search(r"Expected \d+ fields in line (\d+)", str(why)):
            remedy = "Correct this line, or make the table again."
            raise error("has more cells than the header", remedy, file=str(path), line=int(longer[1])) from None
        raise error(f"cannot be read as a table: {why}", "Name a CSV file.", file=str(path)) from None


def parse_table(source: Path | TextIO, name: str) -> pd.DataFrame:
    """The table in a CSV file or a text; `name` is the name of its file."""
    texts = dict.fromkeys(facts()["text_columns"], str)
    table = pd.read_csv(source, keep_default_na=False, na_values=[""], dtype=texts)
    if "simulated" in table:
        table["simulated"] = _logical(table["simulated"], name)
    units = {column: _unit_of(column) for column in table}
    table.attrs["units"] = {column: unit for column, unit in units.items() if unit}
    known = facts()["columns"].get(name, [])
    table.attrs["meanings"] = {c: meaning for c, meaning in known if c in table}
    return table


def _logical(column: pd.Series, name: str) -> pd.Series:
    words = column.astype(str).str.lower()
    wrong = (column.notna() & ~words.isin(list(_YES))).to_numpy()
    if wrong.any():
        row = int(wrong.argmax())
        line = row + 2  # after the header
        what = f"is '{column.iloc[row]}', which is neither yes nor no"
        raise error(what, "Correct this line, or make the table again.", file=name, line=line, key=str(column.name))
    return words.map(_YES)


def tables_in(folder: Path) -> list[str]:
    """Names of the tables in a folder, without .csv; none if there is no folder. Raises Error."""
    try:
        return sorted(name[: -len(".csv")] for name in os.listdir(folder) if name.endswith(".csv") and name != ".csv")
    except FileNotFoundError:
        return []
    except OSError as why:
        raise error(f"cannot be read: {why.strerror}", "Correct its permissions.", file=str(folder)) from None


class Collected(ABC):
    """The tables of many sessions, joined by `dihaptic collect`."""

    @property
    @abstractmethod
    def _tables_folder(self) -> Path:
        """The folder that contains the joined tables."""

    @abstractmethod
    def _collecting(self) -> tuple[Path, str]:
        """The kind of data that is collected, and the command that collects it."""

    @property
    def tables(self) -> list[str]:
        """Names of the collected tables, without .csv."""
        return tables_in(self._tables_folder)

    def table(self, name: str) -> pd.DataFrame:
        """A table of all people by its name, with its units in `attrs`. Raises Error when the tables have not been
        collected, and NotThere when none has this name."""
        tables = self.tables
        if not tables:
            collected, command = self._collecting()
            raise error("has no tables yet", f"Type {command}.", file=str(collected))
        if name not in tables:
            kind = type(self).__name__
            raise NotThere(name, f"is not a table of this {kind.lower()}", tables, f"{kind}.tables lists them.")
        return read_table(self._tables_folder / f"{name}.csv")

    @property
    def trials(self) -> pd.DataFrame:
        """One row for each attempt of each person."""
        return self.table("trials")


def command_of(*words: str | Path) -> str:
    """A command of the program, as typed in a shell."""
    return shlex.join(["dihaptic", *map(str, words)])


def _unit_of(column: str) -> str:
    """The unit at the end of a column's name, in the usual notation: "N/s" for peak_grip_rate_N_s; "" if there is
    none."""
    units: dict[str, str] = facts()["units"]
    parts = str(column).split("_")
    # takes the longest match: N_s, not s
    return next((units[end] for i in range(1, len(parts)) if (end := "_".join(parts[i:])) in units), "")
