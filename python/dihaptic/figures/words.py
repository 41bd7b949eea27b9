"""Names of columns, conditions and numbers in the words of a figure."""

from __future__ import annotations

import math
import re
from typing import Any

#: Columns whose names are too terse for a reader.
_WORDS = {
    "hand_angle": "direction error of the hand",
    "shown_angle": "direction error as shown",
    "hand_extent": "extent of the hand",
    "shown_extent": "extent as shown",
    "reach_time": "time of reach",
    "grip_load_r": "correlation of grip and load",
    "grip_load_lag": "lag of grip behind load",
    "static_ratio": "static ratio of grip and load",
    "adaptation_index_r2": "adaptation index, R²",
    "adaptation_index_slope": "adaptation index, slope",
    "adaptation_index_offset": "adaptation index, offset",
    "tlx": "workload (TLX)",
}


def split(column: str, unit: str) -> str:
    """A column's name without the unit at its end: "peak_grip_rate" of "peak_grip_rate_N_s"."""
    ends = {"N*s/m": "Ns_m", "m/s^2": "m_s2", "N*m": "Nm", "N/m^2": "Pa", "kg/m^3": "kg_m3", "N*m/rad": "Nm_rad",
            "mm^2": "mm2"}  # fmt: skip
    for end in (ends.get(unit, ""), unit.replace("/", "_").replace("*", "")):
        if end and column.endswith("_" + end):
            return column[: -len(end) - 1]
    return column


def words_of(column: str, unit: str = "") -> str:
    """A column in words, without its unit: "peak grip rate" for peak_grip_rate_N_s."""
    name = split(column, unit)
    return _WORDS.get(name, name.replace("_", " "))


def label(column: str, unit: str = "") -> str:
    """A column in words, with its unit: "peak grip rate [N/s]" for peak_grip_rate_N_s.

    >>> label("peak_grip_rate_N_s", "N/s")
    'peak grip rate [N/s]'
    """
    words = words_of(column, unit)
    return f"{words} [{in_print(unit)}]" if unit and unit != "1" else words


def in_print(unit: str) -> str:
    """A unit as a journal prints it; the signs of a formula stay."""
    printed = unit.replace("deg", "°").replace("um", "µm").replace("^2", "²").replace("^3", "³")
    return re.sub(r"(?<=[A-Za-z])\*(?=[A-Za-z])", "\u00a0", printed)


def level(value: Any, unit: str = "") -> str:
    """A level of a factor: "80 g" for 80 with the unit g; a word stays as it is."""
    if isinstance(value, str):
        return value.replace("_", " ")
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return "none"
    return with_unit(f"{value:g}", unit)


def with_unit(number: str, unit: str) -> str:
    """A number with its unit; a degree sign stands next to it.

    >>> with_unit("80", "g"), with_unit("30", "deg"), with_unit("0.5", "1")
    ('80 g', '30°', '0.5')
    """
    if not unit or unit == "1":
        return number
    return number + ("" if in_print(unit) == "°" else " ") + in_print(unit)


def counted(number: int, thing: str, things: str = "") -> str:
    """ "one person", "4 people": a number with its noun."""
    return f"{number} {thing}" if number == 1 else f"{number} {things or thing + 's'}"
