"""An effect as an expression over the tables of an experiment: `mean(late, group=a) - mean(late, group=b)`."""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd

from ..errors import NotThere, error
from ..figures.conditions import counting_trials
from ..figures.data import SITTING, Data, sitting_columns
from ..reports.results import listed

#: The functions by which a term summarises the values of a person's trials.
_STATISTICS: dict[str, Callable[[pd.Series], float]] = {
    "mean": lambda values: float(values.mean()),
    "median": lambda values: float(values.median()),
    "sd": lambda values: float(values.std()),
}
_OPERATORS: dict[type, Callable[[Any, Any], Any]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
}  # fmt: skip
#: Tables in which a column is looked for, in this order.
_TABLES = ["trials", "lifts", "fits", "thresholds", "adaptation", "corrections", "phases", "episodes"]
#: Maximum number of names, numbers and operators of an effect: about 25 terms.
_MOST_PARTS = 200
_EXAMPLE = "Write e.g. mean(movement_time_s, block=late) - mean(movement_time_s, block=early)."


class Effect:
    """An effect, with a value for each person.

    A term is `mean`, `median` or `sd` of a column of a table, over the rows that have the named values in other columns:
    `mean(static_grip_N, mass_g=200, surface="fine sandpaper")`. Terms and numbers are joined by + - * / and parentheses.
    The column is taken from the first of these tables that has it: trials, lifts, fits, thresholds, adaptation, corrections,
    phases and episodes; `table=` names another one. For trials and lifts, the last attempt at each trial is used, without
    practice and catch trials, unless the term names `kind` or `attempt`. Terms of two groups make an effect between people, which is the
    left side minus the right side: `mean(late, group=a) - mean(late, group=b)`. Raises Error when it cannot be understood.

    >>> from dihaptic import figures
    >>> from dihaptic.power_analysis.effect import Effect
    >>> Effect("mean(peak_grip_N, table=lifts) / 2").sides(figures.read(lift_session))[0].round(2).tolist()
    [0.53]
    """

    def __init__(self, text: str) -> None:
        self.text = text
        try:
            self._tree = ast.parse(text.strip(), mode="eval").body
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            short = text if len(text) <= 60 else text[:60] + "..."
            raise error("is not an expression", f"{_EXAMPLE} Conditions are equalities.", key=short) from None
        parts = sum(1 for _ in ast.walk(self._tree))
        if parts > _MOST_PARTS:
            raise error(f"is too long: it has {parts} parts, and may have {_MOST_PARTS}", "Shorten it.", key=text[:60] + "...")
        self._check(self._tree)
        self.groups = list(dict.fromkeys(self._groups_in(self._tree)))
        if not any(isinstance(node, ast.Call) for node in ast.walk(self._tree)):
            raise error("has no term, such as mean(movement_time_s)", _EXAMPLE, key=text)
        if len(self.groups) == 2:
            tree = self._tree
            sides = [tree.left, tree.right] if isinstance(tree, ast.BinOp) and isinstance(tree.op, ast.Sub) else []
            if [set(self._groups_in(side)) for side in sides] != [{group} for group in self.groups]:
                raise error("compares groups, but is not one group's value minus another group's",
                            "Write e.g. mean(late, group=a) - mean(late, group=b).", key=text)  # fmt: skip
        if len(self.groups) > 2:
            raise error(f"names {len(self.groups)} groups", "Compare two of them.", key=text)

    @property
    def columns(self) -> list[str]:
        """Names of the columns of its terms."""
        calls = [node for node in ast.walk(self._tree) if isinstance(node, ast.Call)]
        return list(dict.fromkeys(str(_word(call.args[0])) for call in calls))

    @property
    def is_between(self) -> bool:
        """Whether it compares two groups of people; otherwise, each person has a value, which is compared with zero."""
        return len(self.groups) == 2

    @property
    def has_fixed_value(self) -> bool:
        """Whether a number is added to a person's value, or subtracted from it, to be compared with zero."""
        tree = self._tree
        is_sum = isinstance(tree, ast.BinOp) and isinstance(tree.op, (ast.Add, ast.Sub))
        return is_sum and any(isinstance(side, ast.Constant) for side in (tree.left, tree.right))  # type: ignore[attr-defined]

    def sides(self, data: Data) -> list[pd.Series]:
        """The known values of the people in each group or, if it does not compare groups, of all people. Raises Error."""
        if not self.is_between:
            return [self._value(self._tree, data).dropna()]
        assert isinstance(self._tree, ast.BinOp)
        return [self._value(side, data).dropna() for side in (self._tree.left, self._tree.right)]

    def check_names(self, data: Data) -> None:
        """Checks that the columns of all terms, and those of their conditions, are in tables of these people. Raises Error."""
        for node in ast.walk(self._tree):
            if isinstance(node, ast.Call):
                _named(node, data)

    def _check(self, node: ast.expr) -> None:
        if isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
            self._check(node.left)
            self._check(node.right)
        elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
            self._check(node.operand)
        elif isinstance(node, ast.Call):
            name = node.func.id if isinstance(node.func, ast.Name) else ast.unparse(node.func)
            if name not in _STATISTICS:
                raise NotThere(name, "is not a function of an effect", list(_STATISTICS), f"There are {', '.join(_STATISTICS)}.")
            if len(node.args) != 1 or any(word.arg is None for word in node.keywords):
                raise error("needs one column, then conditions such as block=late", _EXAMPLE, key=ast.unparse(node))
            _word(node.args[0])
            for word in node.keywords:
                _word(word.value)
            names = [str(word.arg) for word in node.keywords]
            for again in {name for name in names if names.count(name) > 1}:
                what = f"has two conditions on {again}"
                raise error(what, "Write a mean for each of its values, and join them with + or -.", key=ast.unparse(node))
        elif not (isinstance(node, ast.Constant) and type(node.value) in (int, float) and abs(node.value) < 1e100):
            raise error("cannot be part of an effect", _EXAMPLE, key=ast.unparse(node))

    def _groups_in(self, tree: ast.expr) -> list[str]:
        if isinstance(tree, ast.Call):
            return [str(_word(word.value)) for word in tree.keywords if word.arg == "group"]
        parts = [part for part in ast.iter_child_nodes(tree) if isinstance(part, ast.expr)]  # from left to right
        return [group for part in parts for group in self._groups_in(part)]

    def _value(self, node: ast.expr, data: Data) -> Any:
        if isinstance(node, ast.BinOp):
            left, right = self._value(node.left, data), self._value(node.right, data)
            try:
                with np.errstate(all="ignore"):
                    return _OPERATORS[type(node.op)](left, right)
            except ArithmeticError as why:
                raise error(f"cannot be computed: {why}", "Correct the numbers.", key=self.text) from None
        if isinstance(node, ast.UnaryOp):
            return -self._value(node.operand, data)
        if isinstance(node, ast.Constant):
            return node.value
        assert isinstance(node, ast.Call)
        return _term(node, data)


def _named(node: ast.Call, data: Data) -> tuple[str, pd.DataFrame, str, dict[str, Any]]:
    """The table of a term, its rows and column, and the values that it asks for of other columns. Raises NotThere."""
    column = str(_word(node.args[0]))
    chosen = {str(word.arg): _word(word.value) for word in node.keywords}
    name = str(chosen.pop("table", "")) or _table_of(column, data)
    table = _rows(data, name, chosen)
    for key in (column, *chosen):
        if key not in table:
            raise NotThere(key, f"is not a column of {name}", [str(each) for each in table], "")
    return name, table, column, chosen


def _term(node: ast.Call, data: Data) -> pd.Series:
    """The value of one term for each person."""
    assert isinstance(node.func, ast.Name)
    name, table, column, chosen = _named(node, data)
    for key, value in chosen.items():
        levels = table[key].dropna().unique()
        if key == "group" and not any(str(level) for level in levels):
            what = "has no groups"
            raise error(what, "Rehearse a population with groups (--population), or a study.", key=f"{key}={value}")
        numeric = pd.api.types.is_numeric_dtype(table[key])
        same = np.isclose(table[key], float(value)) if numeric and _is_number(value) else table[key].astype(str) == str(value)
        if not same.any():
            there = [f"{key}={level:g}" if numeric else f"{key}={level}" for level in levels]
            others = [str(other) for other in table if other != key and (table[other].astype(str) == str(value)).any()]
            remedy = f"There are {', '.join(there[:12])}." if there else f"The column {key} is empty."
            if others:
                remedy = f"Write {others[0]}={value}: it is a value of that column. {remedy}"
            raise NotThere(f"{key}={value}", f"has no rows in {name}", there, remedy)
        table = table[same]
    if table[column].isna().all():
        raise error(f"is empty in all of these rows of {name}", "Name a column that these trials have.", key=column)
    if not pd.api.types.is_numeric_dtype(table[column]):
        raise error("contains words, which have no statistic", "Name a column of numbers.", key=column)
    known = table[table[column].notna()]
    if node.func.id == "sd" and known.groupby("person").size().max() < 2:
        raise error("has one value of each person here, which has no SD", "Leave out a condition.", key=ast.unparse(node))
    values = known.groupby("person")[column].apply(_STATISTICS[node.func.id])
    return values.reindex(data.people).astype(float)


def _rows(data: Data, name: str, chosen: dict[str, Any]) -> pd.DataFrame:
    """The rows of a table to which terms refer."""
    if not data.has(name):
        raise NotThere(name, "is not a table of these people", data.tables, f"There are {', '.join(data.tables)}.")
    if name in ("trials", "lifts") and not {"kind", "attempt"} & set(chosen):
        return counting_trials(data, name)
    table = data.table(name)
    if name == "trials" and "attempt" not in chosen:
        return table.drop_duplicates([*sitting_columns(table), "trial_num"], keep="last")
    if "block" not in table and data.has("trials") and "trial_num" in table:  # the description of a trial is in trials.csv
        trials = data.table("trials")
        keys = [key for key in (*SITTING, "trial_num", "attempt") if key in table and key in trials]
        design = [column for column in trials if column not in table or column in keys]
        return table.merge(trials[design].drop_duplicates(keys), on=keys, how="left")
    return table


def _table_of(column: str, data: Data) -> str:
    for name in _TABLES:
        if data.has(name) and column in data.table(name):
            return name
    known = dict.fromkeys(str(each) for name in _TABLES if data.has(name) for each in data.table(name))
    raise NotThere(column, "is not a column of the tables of these people", list(known), f"It is looked for in {listed(_TABLES)}.")


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float))


def _word(node: ast.expr) -> Any:
    """A name, a text in quotes, or a number."""
    if isinstance(node, ast.Name):
        return node.id
    if isinstance(node, ast.Constant) and isinstance(node.value, (str, int, float)):
        return node.value
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub) and isinstance(node.operand, ast.Constant):
        if isinstance(node.operand.value, (int, float)):
            return -node.operand.value
    raise error("must be a name, a number, or a text in quotes", 'Write e.g. block=late or surface="fine sandpaper".',
                key=ast.unparse(node))  # fmt: skip
