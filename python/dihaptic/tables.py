"""Reads the program's tables, with the units of their columns."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from ._facts import facts
from .errors import error

#: Columns with yes and no.
_YES = {"yes": True, "no": False}


def read_table(file: str | Path) -> pd.DataFrame:
    """Reads a table of the program (docs/tables.md), or any CSV file of your own.

    `attrs["units"]` has the unit of each column whose name ends in one, and `attrs["meanings"]` a
    few words on each column of trials, phases, events, episodes and lifts. An empty cell is NaN.
    Raises Error when the file cannot be read.

    >>> import dihaptic as dh
    >>> lifts = dh.read_table(f"{lift_session}/lifts.csv")
    >>> lifts.attrs["units"]["peak_grip_N"]
    'N'
    >>> lifts.attrs["meanings"]["peak_grip_N"]
    'peak of the mean over digits, from touch to lowering'
    """
    path = Path(file)
    texts = dict.fromkeys(facts()["text_columns"], str)
    try:
        table = pd.read_csv(path, keep_default_na=False, na_values=[""], dtype=texts)
    except (OSError, pd.errors.EmptyDataError, pd.errors.ParserError, UnicodeDecodeError) as why:
        raise error(f"cannot be read as a table: {why}", "Name a CSV file.", file=str(path)) from None
    if "simulated" in table:
        table["simulated"] = table["simulated"].map(_YES)
    units = {column: _unit_of(column) for column in table}
    table.attrs["units"] = {column: unit for column, unit in units.items() if unit}
    known = facts()["columns"].get(path.name, [])
    table.attrs["meanings"] = {c: meaning for c, meaning in known if c in table}
    return table


def _unit_of(column: str) -> str:
    """The unit at the end of a column's name, in the usual notation: "N/s" for peak_grip_rate_N_s; "" if there is
    none."""
    units: dict[str, str] = facts()["units"]
    parts = str(column).split("_")
    # the longest match: N_s, not s
    return next((units[end] for i in range(1, len(parts)) if (end := "_".join(parts[i:])) in units), "")
