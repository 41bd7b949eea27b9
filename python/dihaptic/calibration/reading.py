"""Reads the reaches of one group of people from a CSV file, and refuses what would be fitted wrongly without a word."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from ..errors import Error, error
from .learner import Array, Group

#: Columns of `dihaptic collect`'s adaptation.csv, under the names that they have here.
_OWN = {"id": "participant", "trial_num": "trial", "perturbation": "rotation_deg", "compensation": "compensation_deg"}
_NEEDED = ("participant", "trial", "rotation_deg", "compensation_deg")
_FARTHEST = 90.0  # larger angles are reaches to a wrong target [degrees]
_MOST_FAR = 0.1  # share of such reaches above which the angles are not what they should be
_LEAST_REACHES = 10  # measured from the first rotation on; with fewer, a person is left out
_MISSING = ("", "NA", "NaN", "nan")
_WORDS = {"feedback": ("none", "cursor"), "error_seen": ("no", "yes")}  # the first means that no error was seen


@dataclass
class Reaches:
    """The reaches of one file."""

    group: Group
    left_out: list[str]  #: sentences about what was not used


def read_group(file: str | os.PathLike[str]) -> Reaches:
    """The reaches in one file, less each person's mean before the first rotation. Raises Error."""
    path = Path(file)
    table = _table(path)
    numbers = {column: _numbers(table, column, path) for column in ("trial", "rotation_deg", "compensation_deg")}
    numbers["clamp"] = _numbers(table, "clamp", path).fillna(0) if "clamp" in table else pd.Series(0.0, table.index)
    _refuse(numbers["trial"] % 1 != 0, table, "trial", "is not a whole number", "Number the trials of a person from 1 on.", path)
    _refuse(numbers["rotation_deg"].isna(), table, "rotation_deg", "is missing", "Write 0 where nothing was rotated.", path)
    _refuse(~numbers["clamp"].isin([0, 1]), table, "clamp", "is neither 0 nor 1", "Write 1 for a trial in an error clamp.", path)
    unseen = pd.Series(False, table.index)
    for column in [column for column in _WORDS if column in table]:
        unseen |= _is_first_word(table, column, path)
    table = table[["participant"]].assign(**numbers, unseen=unseen.astype(float))
    again = table.duplicated(["participant", "trial"])
    remedy = "Number the trials of a person from 1 on; give each session of a person a file, or a participant, of its own."
    _refuse(again, table, "trial", "is a second row for this trial of the person", remedy, path)

    def by_person(column: str) -> Array:
        return np.asarray(table.pivot(index="participant", columns="trial", values=column), dtype=float)

    hand, rotation = by_person("compensation_deg"), np.nan_to_num(by_person("rotation_deg"))
    clamp = np.nan_to_num(by_person("clamp")) > 0
    seen = by_person("unseen") == 0  # NaN, which is a missing trial, is not seen either
    left_out = []
    if far := int((np.abs(hand) > _FARTHEST).sum()):
        if far > _MOST_FAR * np.isfinite(hand).sum():
            what = f"has {far} of {np.isfinite(hand).sum()} reaches beyond {_FARTHEST:.0f} degrees"
            raise error(what, "Give angles to the target, between -180 and 180 degrees.", file=str(path), key="compensation_deg")
        left_out.append(f"{far} of {np.isfinite(hand).sum()} reaches, which went farther than {_FARTHEST:.0f} degrees astray")
        hand[np.abs(hand) > _FARTHEST] = np.nan
    group = Group(path.stem, hand, rotation, clamp, seen)
    if not group.perturbed.any():
        raise error("has no rotation", "Give rotation_deg of each trial in degrees.", file=str(path), key="rotation_deg")
    group, few = _without_few(group, np.unique(table["participant"]))
    left_out += few
    if group.people < 2:
        what = f"has fewer than two people with {_LEAST_REACHES} measured reaches or more after the first rotation"
        raise error(what, "How people differ is part of the fit: name a file of more people.", file=str(path))
    _check_angles(group, path)
    if group.first_perturbed:
        before = group.compensation[:, : group.first_perturbed]
        count = np.maximum(np.isfinite(before).sum(1), 1)
        group.compensation = group.compensation - (np.nansum(before, 1) / count)[:, None]
    return Reaches(group, left_out)


def _table(path: Path) -> pd.DataFrame:
    """The rows of the file, with our names of columns."""

    def wrong(what: str, remedy: str) -> Error:
        return error(what, remedy, file=str(path))

    try:
        # as texts: "01" is another person than "1", "NA" may be one, and versions of pandas differ in whether "None" is a word
        table = pd.read_csv(path, compression=None, dtype=str, keep_default_na=False, encoding="utf-8-sig")
    except OSError as why:
        raise wrong(f"cannot be read: {why.strerror}", "Name a CSV file of trials.") from None
    except ValueError as why:
        reason = " ".join(str(why).removeprefix("Error tokenizing data. C error: ").split())
        raise wrong(f"is not a table: {reason}", "Name a CSV file of trials.") from None
    if len(table.columns) == 1 and re.search("[;\t]", str(table.columns[0])):
        raise wrong("has columns that are not separated by commas", "Save it with commas between columns, and decimal points.")
    if {"id", "compensation", "unit"} <= set(table.columns):  # of `dihaptic collect`
        table = table.rename(columns={own: name for own, name in _OWN.items() if name not in table})
        others = set(table["unit"]) - {"deg"}
        if others:
            raise wrong(f"has rows in {sorted(others)[0]}", "Leave them out: only rotations can be calibrated, in deg.")
    missing = [name for name in _NEEDED if name not in table.columns]
    if missing:
        raise wrong(f"has no column {missing[0]}", f"It needs {', '.join(_NEEDED)}.")
    _refuse(table["participant"].str.strip() == "", table, "participant", "is missing", "Name the person of each row.", path)
    return table


def _refuse(rows: pd.Series, table: pd.DataFrame, column: str, what: str, remedy: str, path: Path) -> None:
    """Raises Error about the first of these rows."""
    if rows.any():
        place = int(np.argmax(rows.to_numpy()))
        value = str(table[column].iloc[place]).strip()
        raise error(f"{what}: {value}" if value else what, remedy, file=str(path), line=place + 2, key=column)


def _numbers(table: pd.DataFrame, column: str, path: Path) -> pd.Series:
    given = table[column].str.strip()
    numbers = pd.to_numeric(given, errors="coerce")
    wrong = (numbers.isna() & ~given.isin(_MISSING)) | np.isinf(numbers)
    _refuse(wrong, table, column, "is not a number", "Leave a value that is missing empty.", path)
    return numbers


def _is_first_word(table: pd.DataFrame, column: str, path: Path) -> pd.Series:
    words = table[column].str.strip().str.lower()
    first, second = _WORDS[column]
    _refuse(~words.isin([first, second, ""]), table, column, "is not known", f"Write {first} or {second}.", path)
    return words == first


def _without_few(group: Group, names: Array) -> tuple[Group, list[str]]:
    """The group without people of whom hardly anything was measured, and a sentence for each of them."""
    measured = np.isfinite(group.compensation[:, group.first_perturbed :]).sum(1)
    enough = measured >= _LEAST_REACHES
    rows = (group.compensation, group.rotation, group.clamp, group.seen)
    few = [f"{name}, of whom {count} reaches were measured after the first rotation; {_LEAST_REACHES} are needed"
           for name, count in zip(names[~enough], measured[~enough])]  # fmt: skip
    return Group(group.name, rows[0][enough], rows[1][enough], rows[2][enough], rows[3][enough]), few


def _check_angles(group: Group, path: Path) -> None:
    """Refuses angles in radians, and hands that turn with the cursor rather than against it."""
    largest = max(float(np.abs(group.rotation).max()), float(np.nanmax(np.abs(group.compensation))))
    if largest < np.pi:
        what = f"has no angle above {largest:.2g}, as if angles were in radians"
        raise error(what, "Give rotation_deg and compensation_deg in degrees.", file=str(path))
    rotated = (group.rotation != 0) & ~group.clamp & group.seen & np.isfinite(group.compensation)
    if rotated.any():
        compensated = group.compensation[rotated] * np.sign(group.rotation[rotated])
        if compensated.mean() < -0.1 * np.abs(group.rotation[rotated]).mean():
            what = f"has hands that go {-compensated.mean():.0f} degrees the wrong way on average"
            remedy = "Give compensation_deg the sign of the rotation that it cancels: 30 for a rotation of 30, -30 for one of -30."
            raise error(what, remedy, file=str(path), key="compensation_deg")
