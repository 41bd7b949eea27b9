"""Fitts's law: movement time against the index of difficulty, if targets differ in distance and size."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from ..errors import error
from .conditions import counting_trials
from .data import Data
from .means import BY_T, intervals, means_with_intervals
from .saving import Plan
from .style import COLOURS, MARKERS, canvas, drawing, faint, legend_above, of_data
from .words import counted, level, split

#: Heading above this figure in a report.
HEADING = "By condition"
_TIME = "movement_time_s"
#: Units of length [mm].
_LENGTHS = {"mm": 1.0, "cm": 10.0, "m": 1000.0}
_COLUMNS = [
    "group", "of", "person", "distance_mm", "width_mm", "difficulty_bits", "n", "value", "low", "high", "intercept_s",
    "slope_s_bit", "r2", "throughput_bits_s",
]  # fmt: skip


@of_data
def fitts_law(data: Data) -> pd.DataFrame:
    """Movement time against the index of difficulty, for each person and over people, and its regression line.

    The distance D of a reach is measured from the centre of the region `from` of the task's `movement` to the centre of
    `to`, and the width W is the diameter of `to`, both in mm. The index of difficulty is log2(D / W + 1) in bits, Shannon's
    formulation, as in ISO 9241-411. A row is `of` "person", if `value` is a person's mean over n trials [s]; "mean", if it
    is the mean over n people, with its 95 % interval from `low` to `high` (Student's t); or "line", for an end of the
    least-squares line through the means of a group, with intercept, slope and R². Its `throughput_bits_s` is the ratio of
    index to movement time with the nominal widths, averaged first over each person's conditions and then over people. For
    one person, each "person" row is a trial. Practice, catch trials and all but the last attempt at a trial are left out.
    Raises Error when the task has no such reach.
    """
    trials = _difficulties(data)
    if trials is None:
        what = "has no reach to targets of several distances and widths"
        remedy = "Its movement must lead to a region whose position and radius depend on factors."
        raise error(what, remedy, file=str(data.folder))
    by = ["group", "distance_mm", "width_mm", "difficulty_bits"]
    if len(data.people) == 1:
        each = trials[[*by, "person", _TIME]].rename(columns={_TIME: "value"}).assign(n=1)
    else:
        each = trials.groupby([*by, "person"])[_TIME].agg(value="mean", n="count").reset_index()
    mean = means_with_intervals(each, by)
    lines = []
    for group, own in mean.groupby("group"):
        slope, intercept = np.polyfit(own["difficulty_bits"], own["value"], 1)
        r2 = np.corrcoef(own["difficulty_bits"], own["value"])[0, 1] ** 2
        people = each[each["group"] == group].groupby(["person", "difficulty_bits", "distance_mm"])["value"].mean().reset_index()
        through = (people["difficulty_bits"] / people["value"]).groupby(people["person"]).mean().mean()
        ends = np.array([own["difficulty_bits"].min(), own["difficulty_bits"].max()])
        lines.append(pd.DataFrame({
            "group": group, "of": "line", "difficulty_bits": ends, "value": intercept + slope * ends, "intercept_s": intercept,
            "slope_s_bit": slope, "r2": r2, "throughput_bits_s": through,
        }))  # fmt: skip
    return pd.concat([each.assign(of="person"), mean, *lines], ignore_index=True).reindex(columns=_COLUMNS)


@drawing
def draw_fitts_law(points: pd.DataFrame, *, size: str = "one column", height_mm: float = 65) -> Figure:
    """Draws fitts_law(): people as dots, means with intervals, and the line, with a colour for each group."""
    figure, (axes,) = canvas(size, height_mm)
    points = points.assign(group=points["group"].fillna("").astype(str))
    groups = list(dict.fromkeys(points["group"]))
    for i, group in enumerate(groups):
        hue, marker = COLOURS[i % len(COLOURS)], MARKERS[i % len(MARKERS)]
        own = points[points["group"] == group]
        people, mean, line = (own[own["of"] == of] for of in ("person", "mean", "line"))
        opacity = faint(people["person"].nunique())
        axes.plot(people["difficulty_bits"], people["value"], color=hue, alpha=opacity, ls="", marker=".", ms=3)
        low, high = (mean["value"] - mean["low"]).fillna(0), (mean["high"] - mean["value"]).fillna(0)
        style: dict[str, Any] = {"color": hue, "marker": marker, "ls": "", "capsize": 2, "elinewidth": 1, "zorder": 3}
        axes.errorbar(mean["difficulty_bits"], mean["value"], np.array([low, high]), label=level(group), **style)
        axes.plot(line["difficulty_bits"], line["value"], color=hue, linewidth=1)
    axes.set_ylim(bottom=0)
    if len(groups) == 1 and not points[points["of"] == "line"].empty:
        law = _law(points[points["of"] == "line"].iloc[0])
        axes.text(0.98, 0.04, law, transform=axes.transAxes, ha="right", va="bottom")  # no time is near zero
    axes.set_xlabel("index of difficulty [bit]")
    axes.set_ylabel("movement time [s]")
    if len(groups) > 1:
        legend_above(figure, *axes.get_legend_handles_labels())
    return figure


def _law(line: Any) -> str:
    """A regression line: "0.520 s + 0.094 s/bit × ID (R² = 0.91)"."""
    sign = "\N{MINUS SIGN}" if line.slope_s_bit < 0 else "+"
    return f"{line.intercept_s:.3f} s {sign} {abs(line.slope_s_bit):.3f} s/bit × ID (R² = {line.r2:.2f})"


def law_in_words(points: pd.DataFrame) -> str:
    """The regression of fitts_law(), and the throughput, of each group: "0.52 s + 0.094 s/bit × ID (R² = 0.91)"."""
    lines = points[points["of"] == "line"].drop_duplicates("group")
    texts = []
    for line in lines.itertuples():
        text = f"{_law(line)}, throughput {line.throughput_bits_s:.2f} bit/s"
        texts.append(text + (f" ({level(line.group)})" if len(lines) > 1 else ""))
    return "; ".join(texts)


def plans(data: Data) -> Iterator[Plan]:
    """The figure of Fitts's law, if the task's reach has targets of several distances and widths."""
    if not data.has("trials") or _difficulties(data) is None:
        return
    points = fitts_law(data)
    people, single = len(data.people), len(data.people) == 1
    trials = len(points[points["of"] == "person"]) if single else int(points.loc[points["of"] == "person", "n"].sum())
    dots = "Dots are trials" if single else "Dots are people's means over trials"
    means = intervals(points.loc[points["of"] == "mean", "n"], BY_T)
    yield Plan(
        name="fitts-law",
        title="Movement time against the index of difficulty",
        caption="The index is log2(D / W + 1), with the distance D and the nominal width W of the target (Shannon's "
        f"formulation, ISO 9241-411). {dots}; marks are means over {'trials' if single else 'people'}{means}; the line "
        f"is the least-squares fit to the means of conditions: {law_in_words(points)}. {counted(people, 'person', 'people')}, "
        f"{counted(trials, 'trial')}; practice, catch trials and repeated attempts are left out.",
        points=fitts_law,
        drawing=draw_fitts_law,
    )


# The task's targets


def _difficulties(data: Data) -> pd.DataFrame | None:
    """The trials that are included, with distance, width and index of difficulty of their reach; None if these do not vary."""
    trials = counting_trials(data)
    movement = data.task.get("movement") or {}
    regions = {str(region.get("name")): region for region in data.task.get("regions") or []}
    start, target = (regions.get(str(movement.get(key))) for key in ("from", "to"))
    replaced = [part for key in ("rounds", "conditions") for part in data.task.get(key) or [] if part.get("regions")]
    if _TIME not in trials or start is None or target is None or replaced or len(data.tasks) > 1:
        return None
    values = _values(trials)
    centres = {}
    for region in (start, target):
        place = _numbers(region, "position", values)
        if place is None or len(place) != 3:
            return None
        centres[str(region["name"])] = place
        values.update({f"{region['name']}.{axis}": value for axis, value in zip("xyz", place)})
    radius = _numbers(target, "radius", values)
    if radius is None:
        return None
    ways = [there - here for here, there in zip(*centres.values())]
    distance = np.sqrt(sum(np.square(way) for way in ways))
    out = trials.assign(distance_mm=np.round(distance, 6), width_mm=np.round(2 * radius[0], 6))
    out = out[out[_TIME].notna() & (out["width_mm"] > 0)]
    out = out.assign(difficulty_bits=np.log2(out["distance_mm"] / out["width_mm"] + 1))
    varies = out["distance_mm"].nunique() > 1 and out["width_mm"].nunique() > 1 and out["difficulty_bits"].nunique() > 2
    return out if varies else None


def _values(trials: pd.DataFrame) -> dict[str, Any]:
    """The names that expressions can contain: numeric columns of trials, without the units at their ends, with lengths in mm."""
    units = trials.attrs.get("units", {})
    out: dict[str, Any] = {}
    for column in trials.select_dtypes("number"):
        unit = str(units.get(column, ""))
        out[split(str(column), unit)] = trials[column] * _LENGTHS.get(unit, 1.0)
    return out


def _numbers(region: dict[str, Any], key: str, values: dict[str, Any]) -> list[Any] | None:
    """The numbers of a region's `key` [mm], such as position_mm; None if they need more than arithmetic."""
    for unit, scale in _LENGTHS.items():
        given = region.get(f"{key}_{unit}")
        if given is None:
            continue
        texts = given if isinstance(given, list) else [given]
        try:
            return [float(text) * scale if _is_number(text) else _value(_parsed(text), values) for text in texts]
        except (SyntaxError, LookupError, TypeError):
            return None
    return None


def _is_number(text: Any) -> bool:
    return re.fullmatch(r"\s*[-+]?\d*\.?\d+(e[-+]?\d+)?\s*", str(text)) is not None


def _parsed(text: Any) -> ast.expr:
    """An expression whose lengths are in mm."""
    lengths = re.sub(r"(\d)\s*(mm|cm|m)\b", lambda found: f"{found[1]} * {_LENGTHS[found[2]]}", str(text))
    return ast.parse(lengths, mode="eval").body


def _value(node: ast.expr, values: dict[str, Any]) -> Any:
    """The value of an arithmetic expression with names. Raises LookupError for anything else."""
    if isinstance(node, ast.Constant) and isinstance(node.value, (int, float)):
        return node.value
    if isinstance(node, (ast.Name, ast.Attribute)):
        return values[ast.unparse(node)]
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        return -_value(node.operand, values)
    if isinstance(node, ast.BinOp):
        left, right = _value(node.left, values), _value(node.right, values)
        kinds: dict[type[ast.operator], Any] = {ast.Add: np.add, ast.Sub: np.subtract, ast.Mult: np.multiply, ast.Div: np.divide}
        return kinds[type(node.op)](left, right)
    raise LookupError(ast.unparse(node))
