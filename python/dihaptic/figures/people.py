"""Writes each person's means into a long and a wide table, for statistics programs such as JASP, SPSS and R."""

from __future__ import annotations

import re
from pathlib import Path

import pandas as pd

from .conditions import axes_of_design, counting_trials, each_in_conditions, measures_of_lifts
from .data import Data
from .saving import write
from .words import level


def write_means(data: Data, folder: str | Path) -> list[Path]:
    """Writes `means-long.csv` and `means-wide.csv` into the folder, and returns them; nothing for one person, or for a
    design without conditions. Practice, catch trials and repeated attempts are left out. Raises Error.

    >>> from dihaptic import figures
    >>> figures.write_means(figures.read(lift_session), folder)
    []
    """
    if len(data.people) < 2 or not axes_of_design(data):
        return []
    long = means_of_people(data)
    if long.empty:
        return []
    tables = {"means-long.csv": long, "means-wide.csv": in_columns(long)}
    return [write(Path(folder) / name, table.to_csv(index=False).encode()) for name, table in tables.items()]


def means_of_people(data: Data) -> pd.DataFrame:
    """The means of each person: a row for each person, measure and condition, with person, group, measure, unit, the columns
    that make a condition in figures, the number n of trials, and their mean."""
    by = [name for name in axes_of_design(data).values() if name != "group"]
    parts = []
    own = [("trials", measure.column) for measure in data.measures]
    own += [("lifts", name) for name in measures_of_lifts(data)] if data.has("lifts") else []
    for table, name in own:
        trials = counting_trials(data, table)
        each = each_in_conditions(trials, name, ["group", *by], single=False)
        parts.append(each.assign(measure=name, unit=data.measure(name, table).unit))
    columns = ["person", "group", "measure", "unit", *by, "n", "mean"]
    every = pd.concat(parts, ignore_index=True) if parts else pd.DataFrame(columns=columns)
    out = data.in_order(every.rename(columns={"value": "mean"})[columns], by)
    order = {name: i for i, (_, name) in enumerate(own)}
    return out.sort_values(["person", "measure"], key=lambda c: c.map(order) if c.name == "measure" else c, kind="stable")


def in_columns(long: pd.DataFrame) -> pd.DataFrame:
    """A table of means_of_people() with a row for each person, and a column for each measure in each condition, such as
    peak_grip_N_80_smooth: a name of letters, digits and underscores, as statistics programs require."""
    by = [name for name in long if name not in ("person", "group", "measure", "unit", "n", "mean")]
    names: dict[tuple[str, ...], str] = {}
    for case in long[["measure", *by]].drop_duplicates().itertuples(index=False):
        words = "_".join([str(case[0]), *(level(value) for value in case[1:])])
        name = re.sub(r"\W+", "_", words.replace("-", "minus")).strip("_")
        alike = sum(re.fullmatch(rf"{re.escape(name)}(_\d+)?", other) is not None for other in names.values())
        names[tuple(map(str, case))] = f"{name}_{alike + 1}" if alike else name
    cases = [names[tuple(map(str, row))] for row in long[["measure", *by]].itertuples(index=False)]
    wide = long.assign(column=cases).pivot_table("mean", ["person", "group"], "column", aggfunc="first", sort=False)
    return wide.reindex(columns=list(names.values())).reset_index().rename_axis(columns=None)
