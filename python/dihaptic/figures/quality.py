"""The quality of the sessions, to be checked first: outcomes, repeated and missing trials, durations, forces, late ticks."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from ..errors import error
from .data import Data
from .saving import Plan
from .style import COLOURS, MARKERS, QUIET, canvas, drawing, legend_above, of_data
from .words import counted, level, words_of

#: Heading above these figures in a report.
HEADING = "Quality of the data"
#: Maximum numbers of outcomes with colours, and of rows in a panel; one of each is reserved for the rest.
_MOST_OUTCOMES = 7
_MOST_BLOCKS = 14
_MOST_REASONS = 6
_MOST_PEOPLE = 8
#: Fillings of outcomes, for black and white.
_HATCHES = ["", "////", "....", "\\\\\\\\", "xxxx", "----", "++++"]
#: Names for the rest.
_OTHER = "other outcomes"
_REST = "other reasons"
#: Events of the kind "limit" (events.csv) in which a force was cut.
OF_CUT_FORCE = [
    "a force or a torque was cut to the largest allowed",
    "more than a device's peak force or torque was requested",
    "a force or a torque was cut to a level that the device's motors can sustain",
]
#: Those in which a device gave less force than was requested.
_OF_FORCE = [*OF_CUT_FORCE, "a force or a torque was kept from changing faster than allowed"]
#: Limits in events.csv after which force is off.
_OF_FAULTS = [
    "the simulation diverged: a force or a position was not a number",
    "force was off, after a fault",
]
#: Columns of the table of people: heading, and width in letters.
_HEADS = {
    "ticks": "ticks", "missed": "solves\nmissed", "late": "late\nticks", "limited": "force\nlimited", "faults": "faults",
}  # fmt: skip
_ROW_MM = 4.2  #: height of a row of a panel


def _attempts(data: Data) -> pd.DataFrame:
    """All attempts, each with its number among the attempts at its trial, and whether it is the last one, which is used."""
    trials = data.table("trials").reset_index(drop=True)
    keys = [key for key in ("person", "seed", "session", "study_session", "session_num", "trial_num") if key in trials]
    if "block" not in trials:
        numbers = trials["block_num"] if "block_num" in trials else pd.Series(1, index=trials.index)
        trials["block"] = "block " + numbers.astype(str)
    trials["outcome"] = trials["outcome"].fillna("not known").astype(str)
    trials["block"] = trials["block"].fillna("no block").astype(str)
    trials["counts"] = ~trials.duplicated(keys, keep="last")
    trials["first"] = ~trials.duplicated(keys, keep="first")
    return trials


def _blocks(data: Data, trials: pd.DataFrame) -> list[str]:
    """The names of blocks, in the order of the task."""
    found = list(dict.fromkeys(trials["block"]))
    return [name for name in data.blocks if name in found] + [name for name in found if name not in data.blocks]


# Outcomes


@of_data
def trial_outcomes(data: Data) -> pd.DataFrame:
    """How attempts at trials ended, which of them were repeated, and which trials were not measured, and why.

    A row has n of a total, and the `share`; `of` is "block", for the outcomes of the last attempts at each trial, in
    each block; "person", for the outcomes of each person's first attempts; "mean", for the mean of these shares over n
    people; "repeated", for the attempts that were repeated, by outcome, among all attempts; or "not measured", for
    trials that lack a measure, by `reason`, among all trials, with the `measures`. A measure that no trial of the same
    block, kind, condition and perturbation has is not expected there, and not counted, unless no trial at all has it.

    >>> from dihaptic import figures
    >>> figures.trial_outcomes(figures.read(lift_session))[["of", "block", "outcome", "n", "share"]].values.tolist()
    [['block', 'block 1', 'done', 1, 1.0]]
    """
    trials = _attempts(data)
    order = {name: i for i, name in enumerate(trials["outcome"].value_counts().index)}
    last, first = trials[trials["counts"]], trials[trials["first"]]
    parts = [_shares(last, "block", _blocks(data, trials)).assign(of="block")]
    if len(data.people) > 1:
        people = _shares(first, "person", data.people).assign(of="person")
        every = pd.MultiIndex.from_product([data.people, list(order)], names=["person", "outcome"])
        shares = people.set_index(["person", "outcome"])["share"].reindex(every, fill_value=0.0)
        mean = shares.groupby(level="outcome", sort=False).agg(share="mean", n="count").reset_index()
        parts += [people, mean.assign(of="mean", total=len(data.people))]
    again = trials[~trials["counts"]]
    repeated = again["outcome"].value_counts().rename_axis("outcome").reset_index(name="n")
    parts += [repeated.assign(of="repeated", total=len(trials), share=repeated["n"] / max(1, len(trials)))]
    parts += [_not_measured(last)]
    columns = ["of", "block", "person", "outcome", "reason", "measures", "n", "total", "share"]
    out = pd.concat([part for part in parts if len(part)], ignore_index=True) if len(trials) else pd.DataFrame()
    out = out.reindex(columns=columns)
    out["measures"] = out["measures"].fillna("")
    return out


def _shares(trials: pd.DataFrame, by: str, order: list[str]) -> pd.DataFrame:
    """The number and share of each outcome among the trials of each block, or person."""
    out = trials.groupby([by, "outcome"], sort=False).size().reset_index(name="n")
    out["total"] = out.groupby(by)["n"].transform("sum")
    out["share"] = out["n"] / out["total"]
    place = {name: i for i, name in enumerate(order)}
    return out.sort_values(by, key=lambda names: names.map(place), kind="stable").reset_index(drop=True)


def missing_values(trials: pd.DataFrame) -> pd.DataFrame:
    """Measures that trials lack although similar trials have them: a row for each `trial` (its index), `measure` and `reason`.

    In a reason, numbers that differ are replaced with "...".
    """
    if "not_measured" not in trials or trials["not_measured"].notna().sum() == 0:
        return pd.DataFrame(columns=["trial", "measure", "reason"])
    words = trials["not_measured"].dropna().astype(str).str.split("; ").explode()
    each = words.str.extract(r"^(?P<measure>[^:]*): (?P<reason>.*)$").dropna().rename_axis("trial").reset_index()
    alike = [key for key in ("block", "kind", "condition", "perturbation") if key in trials]
    cell = trials[alike].astype(str).agg("\t".join, axis=1)
    sizes = cell.value_counts()
    each["cell"] = each["trial"].map(cell)
    lacks = each.groupby(["measure", "cell"])["trial"].nunique()
    nowhere = each.groupby("measure")["trial"].nunique() == len(trials)
    asked = [nowhere[m] or lacks[m, c] < sizes[c] for m, c in zip(each["measure"], each["cell"])]
    each = each[np.array(asked, dtype=bool)].drop(columns="cell")
    return each.assign(reason=_alike(each["reason"]))


def _not_measured(trials: pd.DataFrame) -> pd.DataFrame:
    """Trials that lack a measure, by reason."""
    each = missing_values(trials)
    if each.empty:
        return pd.DataFrame()
    out = each.groupby("reason").agg(n=("trial", "nunique"), measures=("measure", lambda names: ", ".join(dict.fromkeys(names))))
    out = out.sort_values("n", ascending=False, kind="stable").reset_index()
    return out.assign(of="not measured", total=len(trials), share=out["n"] / len(trials))


def _alike(reasons: pd.Series) -> pd.Series:
    """Reasons that differ only in a number, combined into one: "the movement covered ... % of the way"."""
    number = re.compile(r"\d+(?:\.\d+)?")
    pattern = reasons.str.replace(number, "\0", regex=True)
    found = reasons.map(number.findall)
    names = {}
    for text, own in found.groupby(pattern):
        numbers = [each[0] if len(set(each)) == 1 else "..." for each in zip(*own)]
        pieces = str(text).split("\0")
        names[text] = "".join(piece + value for piece, value in zip(pieces, [*numbers, ""]))
    return pattern.map(names)


@drawing
def draw_trial_outcomes(
    points: pd.DataFrame, *, outcomes: list[str] | None = None, size: str = "two columns", height_mm: float = 0
) -> Figure:
    """Draws trial_outcomes(): stacked bars of outcomes by block and, if there are any, people, repetitions, missing
    measures.

    `outcomes` names those that get a colour of their own, in this order; by default, these are the seven most frequent.
    Others share one. With `height_mm` 0, the figure is as high as its rows need. Raises Error without points.
    """
    if points.empty:
        raise error("there is no trial to draw", "Draw a table of trial_outcomes() with rows.")
    chosen = outcomes or _most_frequent(points)
    known = points["outcome"].isna() | points["outcome"].isin(chosen)
    points = points.assign(outcome=points["outcome"].where(known, _OTHER))
    names = [*chosen, *([_OTHER] if not known.all() else [])]
    looks = dict(zip(names, zip(COLOURS, _HATCHES, MARKERS)))
    parts = [part for part in ("block", "person", "repeated", "not measured") if (points["of"] == part).any()]
    rows = {part: _rows_of(points, part, names) for part in parts}
    columns = _columns(parts, [*names, *points["block"].dropna()], size)
    lines = -(-len(parts) // columns)
    high = [max(rows[part] for part in parts[i * columns : (i + 1) * columns]) for i in range(lines)]
    height = height_mm or sum(_ROW_MM * max(3, each) + 15 for each in high) + 8
    options = {"gridspec_kw": {"height_ratios": [max(3, each) + 2 for each in high]}}
    figure, all_axes = canvas(size, height, lines, columns, **options)
    letters = {1: 22, 2: 26, 3: 14}[columns]
    for axes, part in zip(all_axes, parts):
        own = points[points["of"] == part]
        if part == "block":
            _bars_of_blocks(axes, own, looks, letters)
        elif part == "person":
            _dots_of_people(axes, points, looks, letters)
        else:
            _bars_of_numbers(axes, own, part, letters, looks)
        if len(parts) > 1:
            axes.set_title(_title(part, own))
    for axes in all_axes[len(parts) :]:
        axes.set_visible(False)
    handles = [Patch(facecolor=hue, hatch=hatch, edgecolor="white") for hue, hatch, _ in looks.values()]
    legend_above(figure, handles, [level(name) for name in looks], "outcome of the attempt" if len(parts) > 1 else "")
    return figure


def _columns(parts: list[str], names: list[str], size: str) -> int:
    """The number of panels side by side, which is three only if all names of rows are short."""
    if size != "two columns":
        return 1
    short = "not measured" not in parts and max(len(name) for name in names) <= 14
    return 3 if len(parts) == 3 and short else min(len(parts), 2)


def _title(part: str, own: pd.DataFrame) -> str:
    total = int(own["total"].iloc[0])
    return {
        "block": "Attempts that count",
        "person": "First attempts, by person",
        "repeated": f"Repeated, of {counted(total, 'attempt')}",
        "not measured": f"Not measured, of {counted(total, 'trial')}",
    }[part]


def _most_frequent(points: pd.DataFrame) -> list[str]:
    """The most frequent outcomes of last attempts and of repeated ones."""
    own = points[points["of"].isin(["block", "repeated"])]
    names = own.groupby("outcome", sort=False)["n"].sum().sort_values(ascending=False, kind="stable").index
    return list(names) if len(names) <= _MOST_OUTCOMES else list(names[: _MOST_OUTCOMES - 1])


def _rows_of(points: pd.DataFrame, part: str, names: list[str]) -> int:
    """The number of lines of text that a panel's rows take."""
    own = points[points["of"] == part]
    if part == "block":
        return min(int(own["block"].nunique()), _MOST_BLOCKS + 1)
    if part == "person":
        return len(names)
    if part == "repeated":
        return int(own["outcome"].nunique())
    return 2 * min(len(own), _MOST_REASONS + 1)


def _bars_of_blocks(axes: Axes, own: pd.DataFrame, looks: dict[str, tuple[str, str, str]], letters: int) -> None:
    """Draws stacked bars of shares, with the number of trials at their ends; blocks beyond the maximum are combined into one."""
    blocks = list(dict.fromkeys(own["block"]))
    if len(blocks) > _MOST_BLOCKS:
        rest = f"{len(blocks) - _MOST_BLOCKS} further blocks"
        own = own.assign(block=own["block"].where(own["block"].isin(blocks[:_MOST_BLOCKS]), rest))
        blocks = [*blocks[:_MOST_BLOCKS], rest]
    table = own.pivot_table(index="block", columns="outcome", values="n", aggfunc="sum", fill_value=0).reindex(blocks)
    shares = 100 * table.div(table.sum(axis=1), axis=0)
    left = np.zeros(len(blocks))
    for name, (hue, hatch, _) in looks.items():
        if name in shares:
            look = {"color": hue, "hatch": hatch, "edgecolor": "white", "linewidth": 0.3}
            axes.barh(range(len(blocks)), shares[name], left=left, height=0.7, **look)
            left += shares[name].to_numpy()
    for i, total in enumerate(table.sum(axis=1)):
        axes.annotate(f"n = {total}", (100, i), (3, 0), textcoords="offset points", va="center", color=QUIET)
    _name_rows(axes, [_short(level(name), letters) for name in blocks])
    axes.set_xlim(0, 122)
    axes.set_xticks([0, 50, 100])
    axes.set_xlabel("share of trials [%]")


def _dots_of_people(axes: Axes, points: pd.DataFrame, looks: dict[str, tuple[str, str, str]], letters: int) -> None:
    """Draws a dot for each person's share of first attempts with each outcome, and a line for the mean over people."""
    own = points[points["of"] == "person"]
    people = list(dict.fromkeys(own["person"]))
    shares = own.pivot_table(index="person", columns="outcome", values="share", aggfunc="sum", fill_value=0.0)
    shares = 100 * shares.reindex(people).reindex(columns=list(looks), fill_value=0.0)
    mean = 100 * points[points["of"] == "mean"].groupby("outcome")["share"].sum()
    aside = np.linspace(-0.28, 0.28, len(people)) if len(people) > 1 else np.zeros(1)
    for i, (name, (hue, _, marker)) in enumerate(looks.items()):
        axes.plot(shares[name], i + aside, marker, color=hue, markersize=2.8, alpha=0.7, markeredgewidth=0)
        if name in mean:
            axes.plot([mean[name]] * 2, [i - 0.4, i + 0.4], color="black", linewidth=1, zorder=1)
    _name_rows(axes, [_short(level(name), letters) for name in looks])
    axes.set_xlim(-4, 104)
    axes.set_xticks([0, 50, 100])
    axes.set_xlabel("share of first attempts [%]")


def _bars_of_numbers(axes: Axes, own: pd.DataFrame, part: str, letters: int, looks: dict[str, tuple[str, str, str]]) -> None:
    """Draws the numbers of attempts that were repeated, or of trials that lack a measure."""
    if part == "repeated":
        numbers = own.groupby("outcome", sort=False)["n"].sum()
        names, hues = [_short(level(name), letters) for name in numbers.index], [looks[name][0] for name in numbers.index]
        hatches = [looks[name][1] for name in numbers.index]
    else:
        own = own.sort_values("n", ascending=False, kind="stable")
        shown = own[: _MOST_REASONS if len(own) > _MOST_REASONS + 1 else len(own)]
        numbers, rest = shown["n"].reset_index(drop=True), own[len(shown) :]
        names = [_reason(reason, measures, letters) for reason, measures in zip(shown["reason"], shown["measures"])]
        if len(rest):
            # a trial may have several reasons, so the number of trials with at least one of the rest is not known
            numbers, names = pd.concat([numbers, pd.Series([rest["n"].max()])]), [*names, f"{_REST} ({len(rest)}), at least"]
        hues, hatches = [QUIET] * len(numbers), [""] * len(numbers)
    for i, (number, hue, hatch) in enumerate(zip(numbers, hues, hatches)):
        axes.barh(i, number, color=hue, hatch=hatch, edgecolor="white", linewidth=0.3, height=0.6)
        axes.annotate(f"{number}", (number, i), (3, 0), textcoords="offset points", va="center", color=QUIET)
    _name_rows(axes, names)
    axes.set_xlim(0, max(10, 1.2 * int(numbers.max())))
    axes.xaxis.get_major_locator().set_params(integer=True, nbins=4)
    axes.set_xlabel("number of attempts" if part == "repeated" else "number of trials")


def _reason(reason: str, measures: str, letters: int) -> str:
    """A reason with the measures that it concerns, in two lines."""
    names = [words_of(name) for name in measures.split(", ") if name]
    of = names[0] if len(names) == 1 else f"{len(names)} measures"
    return f"{_short(reason, letters + 10)}\n{_short(of, letters + 8)}"


def _short(text: str, letters: int) -> str:
    """A name on one line, cut after this many letters."""
    return text if len(text) <= letters else text[: letters - 1].rstrip() + "…"


def _name_rows(axes: Axes, names: list[str]) -> None:
    """Names of rows, from the top."""
    axes.set_yticks(range(len(names)), names)
    edge = 0.6 if len(names) > 1 else 1.0
    axes.set_ylim(len(names) - 1 + edge, -edge)
    axes.tick_params(axis="y", length=0)


# Duration, force, and the exactness of the simulation


@of_data
def timing_and_force(data: Data) -> pd.DataFrame:
    """The durations of attempts, the sizes of forces, and the numbers of each person's ticks that were late or inexact.

    A row with `of` "duration_s" or "peak_force_N" has the median, the quartiles, and the extremes of n attempts in a
    block, of a person, or of all ("" as person). A row `of` "largest_force_N" has, as median, the largest force that
    the weakest device can give. A row `of` "ticks" has the person's number of `ticks`, of those in which the contact
    solver `missed` its tolerance, of `late` ticks (empty without a real clock), of events in which force was `limited`,
    and of `faults` (empty without events.csv).

    >>> from dihaptic import figures
    >>> points = figures.timing_and_force(figures.read(lift_session))
    >>> points[["of", "median", "ticks", "missed"]].dropna(how="all", axis=1).values.tolist()[:2]
    [['duration_s', 9.5, nan, nan], ['peak_force_N', ..., nan, nan]]
    """
    trials = _attempts(data)
    trials["duration_s"] = trials["stop_time"] - trials["start_time"]
    parts = []
    for column in ("duration_s", "peak_force_N"):
        known = trials[trials[column].notna()] if column in trials else trials[:0]
        if len(known) and (column != "peak_force_N" or known[column].max() > 0):
            several = known["person"].nunique() > 1
            for by in (["block"], ["block", "person"]) if several else (["block"],):
                parts.append(_spread(known.groupby(by, sort=False)[column], column))
    devices = [device for session in data.sessions for device in session.info.get("devices") or []]
    peaks = [float(device["peak_force_N"]) for device in devices if float(device.get("peak_force_N") or 0) > 0]
    if peaks:
        parts.append(pd.DataFrame({"of": ["largest_force_N"], "median": [min(peaks)]}))
    parts.append(_ticks(data))
    columns = ["of", "block", "person", "n", "low", "q25", "median", "q75", "high", *_HEADS]
    return pd.concat([part for part in parts if len(part)], ignore_index=True).reindex(columns=columns)


def _spread(groups: Any, of: str) -> pd.DataFrame:
    """Median, quartiles and extremes of groups of trials."""
    out = groups.agg(
        n="count", low="min", q25=lambda x: x.quantile(0.25), median="median", q75=lambda x: x.quantile(0.75), high="max"
    ).reset_index()
    return out.assign(of=of, person=out["person"] if "person" in out else "")


def _ticks(data: Data) -> pd.DataFrame:
    """Each person's ticks, how many missed and how many were late, and the numbers of force limits and faults."""
    rows = []
    for sitting in data.sittings:
        session, info = sitting.session, sitting.session.info
        convergence = info.get("convergence") or {}
        late = re.search(r"(\d+) overruns?", str(info.get("finished", "")))
        row: dict[str, Any] = {"person": sitting.person, "ticks": info.get("ticks"), "missed": convergence.get("missed")}
        row["late"] = int(late[1]) if late and info.get("clock") == "real" else None
        if "events" in session.tables:
            events = session.table("events")
            limits = events.loc[events["event"] == "limit", "detail"]
            row["limited"], row["faults"] = int(limits.isin(_OF_FORCE).sum()), int(limits.isin(_OF_FAULTS).sum())
        rows.append(row)
    out = pd.DataFrame(rows, columns=["person", *_HEADS])
    for name in _HEADS:
        out[name] = pd.to_numeric(out[name])
    out = out.groupby("person", sort=False)[list(_HEADS)].sum(min_count=1).reset_index()
    return out[out["ticks"].notna()].assign(of="ticks")


@drawing
def draw_timing_and_force(points: pd.DataFrame, *, size: str = "two columns", height_mm: float = 0) -> Figure:
    """Draws timing_and_force(): boxes of durations and peak forces by block, and a table of ticks by person.

    A box shows the median and the quartiles of all attempts, and its whiskers show the extremes; dots are people's medians.
    With `height_mm` 0, the figure is as high as its rows need. Raises Error without points.
    """
    parts = [part for part in ("duration_s", "peak_force_N", "ticks") if (points["of"] == part).any()]
    if not parts:
        raise error("there is no trial to draw", "Draw a table of timing_and_force() with rows.")
    blocks = list(dict.fromkeys(points.loc[points["of"].isin(parts[:2]), "block"].dropna()))
    people = min((points["of"] == "ticks").sum(), _MOST_PEOPLE + 1)
    height = _ROW_MM * max(6, min(len(blocks), _MOST_BLOCKS) + 2, 1.1 * people + 3) + 20
    wide = size == "two columns"
    if wide:
        ratios = [1.5 if part == "ticks" else 1.0 for part in parts]
        figure, all_axes = canvas(size, height_mm or height, 1, len(parts), gridspec_kw={"width_ratios": ratios})
    else:
        figure, all_axes = canvas(size, height_mm or height * len(parts), len(parts))
    largest = points.loc[points["of"] == "largest_force_N", "median"]
    for axes, part in zip(all_axes, parts):
        own = points[points["of"] == part]
        if part == "ticks":
            _table_of_ticks(axes, own)
            axes.set_title("Ticks, by person" if len(parts) > 1 else "")
            continue
        _boxes(axes, own, blocks[:_MOST_BLOCKS], 20 if not wide or part == parts[0] else 0)
        _name_boxes(axes, part, float(largest.iloc[0]) if len(largest) else np.nan)
    return figure


def _name_boxes(axes: Axes, part: str, largest: float) -> None:
    """Labels of a panel of boxes, and a line at the largest force that the device can give."""
    if part == "duration_s":
        axes.set_xlabel("duration [s]")
        axes.set_title("Duration of attempts")
    else:
        known = np.isfinite(largest)
        axes.set_xlabel("peak force [N]" + (f"\n(dashed: the device's maximum, {largest:g} N)" if known else ""))
        axes.set_title("Largest force")
        if known:
            axes.axvline(largest, color="black", linestyle="--", linewidth=0.8)
    axes.set_xlim(left=0)


def _boxes(axes: Axes, own: pd.DataFrame, blocks: list[str], letters: int) -> None:
    """Draws a box for each block, with a dot for each person's median; names of blocks have at most this many letters."""
    own = own.assign(person=own["person"].fillna(""))  # a CSV file has NaN for an empty name
    for i, block in enumerate(blocks):
        whole = own[(own["block"] == block) & (own["person"] == "")]
        people = own[(own["block"] == block) & (own["person"] != "")]
        for box in whole.itertuples():
            axes.plot([box.low, box.high], [i, i], color=QUIET, linewidth=0.8)
            axes.barh(i, box.q75 - box.q25, left=box.q25, height=0.5, color="#d9e7f2", edgecolor=COLOURS[0], linewidth=0.8)
            axes.plot([box.median] * 2, [i - 0.25, i + 0.25], color=COLOURS[0], linewidth=1.6)
        aside = np.linspace(-0.2, 0.2, len(people)) if len(people) > 1 else np.zeros(len(people))
        axes.plot(people["median"], i + aside, "o", color=COLOURS[1], markersize=2.2, alpha=0.8, markeredgewidth=0, zorder=3)
    _name_rows(axes, [_short(level(block), letters) if letters else "" for block in blocks])


def _table_of_ticks(axes: Axes, own: pd.DataFrame) -> None:
    """Draws a table with each person's numbers; of many people, those with the most faults, and the sum over the others."""
    heads = [name for name in _HEADS if own[name].notna().any()]
    if len(own) > _MOST_PEOPLE + 1:
        bad = own[["missed", "late", "limited", "faults"]].fillna(0).sum(axis=1)
        first = own.loc[bad.sort_values(ascending=False, kind="stable").index[:_MOST_PEOPLE].sort_values()]
        rest = own.drop(index=first.index)
        sums = rest[heads].sum(min_count=1).to_frame().T.assign(person=f"{len(rest)} others")
        own = pd.concat([first, sums], ignore_index=True)
    widths = np.cumsum([1.6, *(1.8 if name == "ticks" else 1.2 for name in heads)])
    places = widths[1:] / widths[-1]
    for place, name in zip(places, heads):
        axes.text(place, -0.2, _HEADS[name], ha="right", va="bottom")
        for i, value in enumerate(own[name]):
            axes.text(place, i + 0.5, "-" if pd.isna(value) else _thin(int(value)), ha="right", va="center")
    for i, person in enumerate(own["person"]):
        axes.text(0, i + 0.5, _short(str(person), 11), ha="left", va="center")
    axes.plot([0, 1], [0, 0], color="black", linewidth=0.6)
    axes.plot([0, 1], [len(own), len(own)], color="black", linewidth=0.6)
    axes.set_xlim(0, 1)
    axes.set_ylim(max(len(own), 4) + 0.2, -2.2)
    axes.set_xticks([])
    axes.set_yticks([])
    axes.set_axis_off()


def _thin(number: int) -> str:
    """A number with its thousands separated: 296 614."""
    return f"{number:,}".replace(",", "\u2009")


# Which figures there are


def plans(data: Data) -> Iterator[Plan]:
    """Outcomes of a task's trials, and the timing and forces of any session that has trials."""
    trials = data.table("trials") if data.has("trials") else pd.DataFrame()
    if trials.empty or not {"outcome", "trial_num", "start_time", "stop_time"} <= set(trials):
        return
    people = counted(len(data.people), "person", "people")
    if "attempt" in trials or trials["outcome"].nunique() > 1:
        yield _plan_of_outcomes(data, people)
    if "attempt" in trials or len(trials) > 1:
        yield _plan_of_timing(data, people)


def _plan_of_outcomes(data: Data, people: str) -> Plan:
    points = trial_outcomes(data)
    parts = set(points["of"])
    attempts = _attempts(data)
    text = [f"{people}, {counted(int(attempts['counts'].sum()), 'trial')}, {counted(len(attempts), 'attempt')}."]
    text.append("The last attempt at each trial is used.")
    if "person" in parts:
        text.append("Dots are people; upright lines are means over people.")
    if "not measured" in parts:
        text.append("A measure that no trial of the same block, kind, condition and perturbation has is not expected there.")
    blocks = points.loc[points["of"] == "block", "block"].nunique()
    if blocks > _MOST_BLOCKS:
        text.append(f"Of {blocks} blocks, the last {blocks - _MOST_BLOCKS} are one bar.")
    outcomes = points["outcome"].nunique()
    if outcomes > _MOST_OUTCOMES:
        text.append(f"The {outcomes - _MOST_OUTCOMES + 1} rarest of {outcomes} outcomes have one colour.")
    reasons = int((points["of"] == "not measured").sum())
    if reasons > _MOST_REASONS + 1:
        text.append(f"The {_MOST_REASONS} most frequent of {reasons} reasons have bars of their own.")
    size = {"size": "one column"} if parts == {"block"} else {}
    return Plan(
        name="outcomes", title="Outcomes of trials", caption=" ".join(text), points=trial_outcomes,
        drawing=draw_trial_outcomes, drawing_options=size,
    )  # fmt: skip


def _plan_of_timing(data: Data, people: str) -> Plan:
    points = timing_and_force(data)
    text = [f"{people}, {counted(len(data.table('trials')), 'attempt')}, repeated ones included."]
    text.append("Boxes show the median and the quartiles of attempts, whiskers reach to the shortest and longest")
    text[-1] += (", and to the smallest and largest force." if (points["of"] == "peak_force_N").any() else ".")
    if len(data.people) > 1:
        text.append("Dots are people's medians.")
    blocks = points["block"].nunique()
    if blocks > _MOST_BLOCKS:
        text.append(f"The first {_MOST_BLOCKS} of {blocks} blocks are shown.")
    if (points["of"] == "ticks").any():
        text.append("Solves missed: ticks in which the contact solver missed its tolerance.")
        if points["late"].isna().all():
            text.append("These sessions did not run in real time, so that no tick can be late.")
        if points["limited"].notna().any():
            text.append("Force limited: how often a device started to fall short of the requested force.")
        count = int((points["of"] == "ticks").sum())
        if count > _MOST_PEOPLE + 1:
            text.append(f"The {_MOST_PEOPLE} of {count} people with the most of these have rows of their own.")
    return Plan(
        name="timing-and-force", title="Durations, forces and ticks", caption=" ".join(text), points=timing_and_force,
        drawing=draw_timing_and_force,
    )  # fmt: skip
