"""Learning: its course over trials, means in windows of trials, generalisation, and the courses of other measures."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from ..errors import NotThere, error
from .data import Data, checked_list, sitting_columns
from .means import BY_T, intervals, means_with_intervals, said_of_limits, within_limits
from .saving import Plan
from .style import (
    COLOURS,
    MARKERS,
    QUIET,
    WIDTHS,
    canvas,
    drawing,
    fit_names,
    legend_above,
    letter_mm,
    of_data,
    same_limits,
    wrapped,
)
from .words import counted, label, level, words_of

#: Heading above these figures in a report.
HEADING = "Learning"
#: Maximum numbers of panels in a figure, and of groups with colours of their own; minimum number of trials for a course.
_MOST_PANELS, _MOST_GROUPS, _LEAST_TRIALS = 6, 7, 8
#: Maximum number of rows of blocks' names.
_MOST_ROWS = 3
#: Maximum number of points of a line, in a single panel and in each of several.
_MOST_POINTS, _MOST_POINTS_OF_SEVERAL = 160, 80
_WIDTHS_OF_BINS = [1, 2, 4, 5, 8, 10, 16, 20, 25, 32, 40, 50, 64, 80, 100]
#: Kinds of trials that mark a block, with the colour behind it and its name in the legend.
SHADES = {
    "washout": ("#ececec", "washout"),
    "visual_clamp": ("#f5efc4", "visual clamp"),
    "force_channel": ("#fbdfc4", "force channels"),
    "catch": ("#d5ecd9", "catch trials"),
}
#: Kinds of trials that do not show which perturbation their block has.
_WITHOUT_PERTURBATION = ["catch", "visual_clamp", "force_channel", "practice"]
#: Windows of fits.csv that are means, and windows that are differences of means, with their names in a figure.
WINDOWS = {
    "baseline": "baseline", "early": "early", "late": "late", "catch": "catch trials", "clamp_first": "clamp, first",
    "clamp_last": "clamp, last", "washout_first": "washout, first",
}  # fmt: skip
DIFFERENCES = {"savings": "savings", "rebound": "rebound"}
#: What was learned, by the column `measure` of fits.csv, where it is not simply compensation.
LEARNED = {"adaptation_index": "adaptation index", "extent": "compensation of extent"}
_DASHES: list[Any] = [
    "-", (0, (5, 1.5)), (0, (1.5, 1)), (0, (6, 1.5, 1.5, 1.5)), (0, (3, 1)), (0, (6, 1.5, 1.5, 1.5, 1.5, 1.5)), "-",
]  # fmt: skip
_COLUMNS = ["part", "group", "of", "person", "first", "last", "trial", "block", "block_kind", "kind", "n", "value", "low", "high"]


# Courses over trials, of any quantity


def _parts(table: pd.DataFrame) -> pd.Series:
    """For each row, the name of its part (a session of a study, or a round), which has its own panel."""
    words = pd.Series("", index=table.index)
    for column in ("study_session", "round"):
        if column in table:
            name = table[column].fillna("").astype(str)
            words = words.where(name == "", (words + ", " + name).str.removeprefix(", "))
    return words


def _grouped(table: pd.DataFrame) -> pd.DataFrame:
    """The table, with groups merged if there are more groups than colours."""
    return table.assign(group="") if table["group"].nunique() > _MOST_GROUPS else table


def _numbered(table: pd.DataFrame) -> pd.DataFrame:
    """The last attempt at each trial, with its number in its part, from 1; practice is left out."""
    table = _grouped(table[table["trial_num"].notna()].assign(part=_parts(table)))
    keys = [*sitting_columns(table), "part"]
    table["trial"] = table["trial_num"] - table.groupby(keys)["trial_num"].transform("min") + 1
    table = table.drop_duplicates([*keys, "trial"], keep="last")
    for column in ("block", "kind"):
        table[column] = table[column].fillna("").astype(str) if column in table else ""
    # parts stay in the order of the first person
    places = {part: place for place, part in enumerate(dict.fromkeys(table["part"]))}
    table = table.assign(place=table["part"].map(places))
    table = table.sort_values(["place", *sitting_columns(table), "trial_num"], kind="stable")
    return table[table["kind"] != "practice"].drop(columns="place").reset_index(drop=True)


def _scattered(table: pd.DataFrame) -> pd.Series:
    """Which rows are catch trials of blocks in which their places differ between people."""
    catch = table["kind"] == "catch"
    share = catch.groupby([table[column] for column in ("part", "group", "block", "trial")]).transform("mean")
    differs = ((share > 0) & (share < 1)).groupby([table[column] for column in ("part", "group", "block")]).transform("any")
    return catch & differs


def _bins(table: pd.DataFrame, width: int) -> pd.DataFrame:
    """The first and the last trial of each trial's bin, in each part; a bin ends with its block.

    The remaining trials of a block are a bin of their own if they are at least half as many as a bin has.
    """
    found = []
    for part, own in table.groupby("part", sort=False):
        by_trial = own.groupby("trial")["block"]
        block = by_trial.first().where(by_trial.nunique() == 1, "")
        run = (block != block.shift()).cumsum()
        place, count = run.groupby(run).cumcount(), run.groupby(run).transform("count")
        bins = (count // width + (2 * (count % width) >= width)).clip(lower=1)
        number = np.minimum(place // width, bins - 1)
        trials = pd.DataFrame({"part": part, "trial": block.index, "run": run.to_numpy(), "number": number.to_numpy()})
        same = trials.groupby(["run", "number"])["trial"]
        found.append(trials.assign(first=same.transform("min"), last=same.transform("max"))[["part", "trial", "first", "last"]])
    return pd.concat(found, ignore_index=True)


def _schedule(table: pd.DataFrame) -> pd.DataFrame:
    """The block, kind and perturbation of each trial of a part, if they are the same for all people of a group, or else ""."""
    keys = ["part", "group", "trial"]
    same = table.groupby(keys, sort=False)
    out = same.agg(block=("block", "first"), kind=("kind", "first"), n=("person", "nunique")).reset_index()
    for column in ("block", "kind"):
        out[column] = out[column].where(same[column].nunique().to_numpy() == 1, "")
    commonest = table.groupby(["part", "group", "block"])["kind"].agg(lambda kinds: kinds.mode().iloc[0])
    blocks = out[["part", "group", "block"]].to_numpy()
    out["block_kind"] = [commonest.get((part, group, block), "") for part, group, block in blocks]
    out["value"] = np.nan
    if "perturbation" in table:
        # adaptation.csv gives 0 where no error was seen, including reaches of a perturbed block that fell short
        telling = table[~table["kind"].isin(_WITHOUT_PERTURBATION) & table["error_seen"].isin(["yes", True])]
        known = telling.groupby(keys)["perturbation"].mean().rename("known").reset_index()
        out = out.merge(known, on=keys, how="left")
        # the line shows the perturbation of the block, which a catch trial interrupts
        near = out.groupby(["part", "group", "block"])["known"]
        out["value"] = near.ffill().where(near.ffill().notna(), near.bfill())
        out = out.drop(columns="known")
    return out.assign(of="schedule", first=out["trial"], last=out["trial"])


def _courses(table: pd.DataFrame, width: int, several: bool) -> pd.DataFrame:
    """Each person's values, their means, the fitted models, and the schedule of blocks, as rows of a table of points."""
    if width < 1:
        raise error("must be at least one trial", "Write bin_trials=1 for every trial.", key="bin_trials")
    shown = table[~_scattered(table)].merge(_bins(table, width), on=["part", "trial"], how="left")
    by = ["part", "group", "first", "last"]
    measured = shown[shown["value"].notna()]
    kinds = measured.groupby([*by, "person"], sort=False)["kind"]
    each = measured.groupby([*by, "person"], sort=False)["value"].agg(value="mean", n="count")
    each["kind"] = kinds.first().where(kinds.nunique() == 1, "")
    parts = [each.reset_index().assign(of="person")]
    if several:
        mean = means_with_intervals(parts[0], by, sort=False).set_index(by)
        kinds = measured.groupby(by, sort=False)["kind"]
        mean["kind"] = kinds.first().where(kinds.nunique() == 1, "")
        parts.append(mean.reset_index())
    if "fit" in shown:
        fitted = shown[shown["fit"].notna()].groupby([*by, "person"], sort=False)["fit"].mean().rename("value").reset_index()
        parts.append(fitted.groupby(by, sort=False)["value"].agg(value="mean", n="count").reset_index().assign(of="fit"))
    parts.append(_schedule(table))
    out = pd.concat([part for part in parts if not part.empty], ignore_index=True).reindex(columns=_COLUMNS)
    out["trial"] = (out["first"] + out["last"]) / 2
    words = ["part", "group", "of", "person", "block", "block_kind", "kind"]
    out[words] = out[words].fillna("")
    return out


def _width_of_bins(table: pd.DataFrame, most: int) -> int:
    """How many trials to average for each point of a line, so that there are few enough points, and most include all people."""
    keys = [*sitting_columns(table), "part"]
    trials = int(table.groupby(keys)["trial"].count().max())
    share = table["value"].notna().groupby([table[column] for column in [*keys, "block"]]).mean()
    share = share.groupby([*keys[1:], "block"] if len(keys) > 1 else ["block"]).mean()
    least = float(share[share > 0].min()) if (share > 0).any() else 1.0
    # if points must be means of trials, half as many are drawn as would fit
    wanted = max(2 * trials / most if trials > most else 1.0, 1 / least if least < 0.5 else 1.0)
    return next((width for width in _WIDTHS_OF_BINS if width >= wanted * 0.999), _WIDTHS_OF_BINS[-1])


def _frame(points: pd.DataFrame) -> pd.DataFrame:
    """A table of points in which empty texts are texts, even if the table was read from a file."""
    words = [column for column in ("part", "group", "person", "block", "block_kind", "kind") if column in points]
    return points.assign(**{column: points[column].fillna("").astype(str) for column in words})


# The drawing of courses


def _runs(schedule: pd.DataFrame) -> list[tuple[str, str, float, float]]:
    """The blocks in the order of trials: the name, the most common kind, and the first and last trial of each.

    A name that differs between people is left out.
    """
    by_trial = schedule.sort_values("trial").groupby("trial")
    block = by_trial["block"].first().where(by_trial["block"].nunique() == 1, "")
    kind = by_trial["block_kind"].first().where(by_trial["block_kind"].nunique() == 1, "")
    run = (block != block.shift()).cumsum()
    return [(own.iloc[0], kind[own.index[0]], own.index[0], own.index[-1]) for _, own in block.groupby(run)]


def _place_names(runs: list[tuple[str, str, float, float]], width_mm: float) -> list[tuple[str, float, int]]:
    """Names of blocks, with their places along a panel of this width [mm] and their rows, chosen so that no names overlap."""
    if not runs:
        return []
    low, high = runs[0][2] - 0.5, runs[-1][3] + 0.5
    ends: list[float] = []
    placed = []
    for name, _, first, last in runs:
        if not name:
            continue
        wide = letter_mm() * len(name) + 1.5
        middle = ((first + last) / 2 - low) / (high - low) * width_mm
        middle = min(max(middle, wide / 2), max(width_mm - wide / 2, wide / 2))
        row = next((i for i, end in enumerate(ends) if middle - wide / 2 >= end), len(ends))
        ends[row:] = [middle + wide / 2, *ends[row + 1 :]]
        placed.append((name, middle, row))
    return placed


def _named_blocks(axes: Axes, schedule: pd.DataFrame, width_mm: float) -> tuple[int, set[str]]:
    """Names blocks above a panel, and shades those of certain kinds. Returns the rows of names, and the kinds."""
    runs = _runs(schedule)
    low, high = runs[0][2] - 0.5, runs[-1][3] + 0.5
    axes.set_xlim(low, high)
    shaded = set()
    for i, (_, kind, first, last) in enumerate(runs):
        if kind in SHADES:
            axes.axvspan(first - 0.5, last + 0.5, color=SHADES[kind][0], linewidth=0, zorder=0)
            shaded.add(kind)
        if i:
            axes.axvline(first - 0.5, color=QUIET, linewidth=0.4, zorder=0.5)
    rows = _rows_of_names(runs, width_mm)
    style: dict[str, Any] = {
        "xycoords": ("data", "axes fraction"), "textcoords": "offset points", "ha": "center", "va": "bottom", "fontsize": 7,
        "color": QUIET, "annotation_clip": False,
    }  # fmt: skip
    if rows > _MOST_ROWS:
        for name, trial in _upright_places(runs, width_mm):
            axes.annotate(name, (trial, 1), (0, 2), rotation=90, **style)
    elif rows:
        for name, middle, row in _place_names(runs, width_mm):
            axes.annotate(name, (low + middle / width_mm * (high - low), 1), (0, 2 + 9 * row), **style)
    return rows, shaded


def _rows_of_names(runs: list[tuple[str, str, float, float]], width_mm: float) -> int:
    """How many lines of text the names of blocks take; more than _MOST_ROWS if they are upright."""
    if len(runs) < 2:
        return 0
    rows = max((row for *_, row in _place_names(runs, width_mm)), default=-1) + 1
    if rows <= _MOST_ROWS:
        return rows
    longest = max(len(name) for name, _ in _upright_places(runs, width_mm))
    return max(-(-longest // 2), _MOST_ROWS + 1)


def _upright_places(runs: list[tuple[str, str, float, float]], width_mm: float) -> list[tuple[str, float]]:
    """If there are many blocks, those names that fit side by side when they are upright, with their trials."""
    low, high = runs[0][2] - 0.5, runs[-1][3] + 0.5
    end = -10.0
    placed = []
    for name, _, first, last in runs:
        middle = ((first + last) / 2 - low) / (high - low) * width_mm
        if name and middle >= end + 3.2:
            end = middle
            placed.append((name, (first + last) / 2))
    return placed


def _unnamed(table: pd.DataFrame, panels: int) -> str:
    """A sentence for the caption if some blocks cannot be named."""
    width_mm = WIDTHS["two columns"] / _columns(table["trial"].max(), panels, "two columns") - 17
    for _, own in table.groupby("part"):
        runs = _runs(_schedule(own))
        if any(not name for name, *_ in runs) and own["block"].ne("").any():
            return " Blocks whose order differs between people are not named."
        named = sum(bool(name) for name, *_ in runs)
        if _rows_of_names(runs, width_mm) > _MOST_ROWS and len(_upright_places(runs, width_mm)) < named:
            return " Blocks that are too narrow for their names are not named."
    return ""


def _lines(axes: Axes, own: pd.DataFrame, group: int, several: bool, groups: int) -> None:
    """Draws the people, the mean with its interval, and the fitted model of one group in one panel."""
    hue, dashes = COLOURS[group % len(COLOURS)], _DASHES[group % len(_DASHES)]
    for _, one in own[own["of"] == "person"].groupby("person"):
        one = one.sort_values("trial")
        if several:
            axes.plot(one["trial"], one["value"], color=hue, alpha=0.45, linewidth=0.5, zorder=3)
            continue
        catch = one["trial"].isin(_single_catch(own))
        axes.plot(one["trial"][~catch], one["value"][~catch], ls="", marker=MARKERS[group % 7], color=hue, ms=2, mew=0, alpha=0.7)
        axes.plot(one["trial"][catch], one["value"][catch], ls="", marker="D", color=hue, mfc="white", ms=2.6, mew=0.6, zorder=3)
    mean = own[own["of"] == "mean"].sort_values("trial")
    few = len(mean) <= 45
    if len(mean):
        axes.fill_between(mean["trial"], mean["low"], mean["high"], color=hue, alpha=0.22, linewidth=0, zorder=2.5)
        marker = MARKERS[group % len(MARKERS)] if few else ""
        axes.plot(mean["trial"], mean["value"], color=hue, ls=dashes, marker=marker, ms=2.6, lw=1.1, zorder=4)
        catch = mean[mean["trial"].isin(_single_catch(own))]
        axes.plot(catch["trial"], catch["value"], ls="", marker="D", color=hue, mfc="white", ms=2.6, mew=0.6, zorder=4.5)
    fit = own[own["of"] == "fit"].sort_values("trial")
    if len(fit):
        axes.plot(fit["trial"], fit["value"], color=COLOURS[1] if groups == 1 else hue, ls=(0, (3, 1.2)), lw=0.9, zorder=5)


def _single_catch(points: pd.DataFrame) -> set[float]:
    """Draws catch trials among other trials, if their places are the same for all people."""
    schedule = points[points["of"] == "schedule"]
    return set(schedule[(schedule["kind"] == "catch") & (schedule["block_kind"] != "catch")]["trial"])


def _perturbation(axes: Axes, schedule: pd.DataFrame, groups: dict[str, int]) -> bool:
    """Draws the perturbation as a dotted line, in the groups' colours if it differs between groups.

    Returns whether there is one.
    """
    if not (schedule["value"].fillna(0) != 0).any():
        return False
    same = schedule.groupby("trial")["value"]
    differs = (same.max() - same.min()).max() > 1e-6 * schedule["value"].abs().max()
    for group, own in schedule.groupby("group", sort=False):
        own = own.sort_values("trial")
        edges = np.stack([own["trial"] - 0.5, own["trial"] + 0.5], axis=1).ravel()
        hue = COLOURS[groups[group] % len(COLOURS)] if differs else "black"
        axes.plot(edges, np.repeat(own["value"].to_numpy(dtype=float), 2), color=hue, ls=":", lw=0.9, zorder=3.5)
        if not differs:
            break
    return True


def _key(
    points: pd.DataFrame, groups: dict[str, int], several: bool, shaded: set[str], perturbed: bool, catch: bool
) -> tuple[list[Any], list[str]]:
    """Handles and names of the legend of courses."""
    out: list[tuple[Any, str]] = []
    of = set(points["of"])
    one = COLOURS[0] if len(groups) == 1 else QUIET
    if several:
        few = (points[points["of"] == "mean"].groupby(["part", "group"]).size() <= 45).all()
        for group, i in groups.items():
            hue, marker = COLOURS[i % len(COLOURS)], MARKERS[i % len(MARKERS)] if few else ""
            line = Line2D([], [], color=hue, ls=_DASHES[i % len(_DASHES)], marker=marker, ms=2.6, lw=1.1)
            band = Patch(color=hue, alpha=0.22, lw=0)
            drawn = points.loc[(points["of"] == "mean") & (points["group"] == group), "low"].notna().any()
            out.append(((band, line) if drawn else line, level(group) if len(groups) > 1 else "mean with 95 % interval"))
        out.append((Line2D([], [], color=one, alpha=0.5, lw=0.5), "people"))
    else:
        out.append((Line2D([], [], ls="", marker="o", color=COLOURS[0], ms=2.6), "trial"))
    if catch:
        out.append((Line2D([], [], ls="", marker="D", color=one, mfc="white", ms=2.6, mew=0.6), "catch trial"))
    if "fit" in of:
        out.append((Line2D([], [], color=COLOURS[1] if one != QUIET else QUIET, ls=(0, (3, 1.2)), lw=0.9), "two-rate model"))
    if perturbed:
        out.append((Line2D([], [], color="black", ls=":", lw=0.9), "perturbation"))
    out += [(Patch(color=colour, lw=0), name) for kind, (colour, name) in SHADES.items() if kind in shaded]
    return [handle for handle, _ in out], [name for _, name in out]


def _draw_courses(
    points: pd.DataFrame, panels: list[tuple[str, pd.DataFrame, str]], size: str, height_mm: float, share: bool
) -> Figure:
    """Panels of courses, each with its title, its points, and the label of its axis."""
    columns = _columns(points["last"].max(), len(panels), size)
    rows = -(-len(panels) // columns)
    width_mm = WIDTHS[size] / columns - 17
    names_mm = [3.2 * _rows_of_names(_runs(own[own["of"] == "schedule"]), width_mm) for _, own, _ in panels]
    figure, all_axes = canvas(size, (height_mm + max(names_mm)) * rows + 5, rows, columns)
    groups = {group: i for i, group in enumerate(sorted(points["group"].unique()))}
    several = bool((points["of"] == "mean").any())
    shaded: set[str] = set()
    perturbed = catch = False
    for axes, (title, own, ylabel) in zip(all_axes, panels):
        schedule = own[own["of"] == "schedule"]
        lines, kinds = _named_blocks(axes, schedule, width_mm)
        shaded |= kinds
        perturbed |= _perturbation(axes, schedule, groups)
        for group, i in groups.items():
            _lines(axes, own[own["group"] == group], i, several, len(groups))
            shown = own[(own["group"] == group) & (own["of"] == ("mean" if several else "person"))]
            catch = catch or bool(shown["trial"].isin(_single_catch(own[own["group"] == group])).any())
        low, high = axes.get_ylim()
        if low < 0 < high:
            axes.axhline(0, color=QUIET, linewidth=0.4, zorder=1)
        if title:
            axes.set_title(title, pad=4 + 9 * lines)
        if not share or all_axes.index(axes) % columns == 0:
            axes.set_ylabel(wrapped(ylabel, 26))
        axes.set_xlabel("trial")
        axes.xaxis.set_major_locator(MaxNLocator(nbins=7, steps=[1, 2, 5, 10], integer=True))
        axes.locator_params(axis="y", nbins=6)
    for axes in all_axes[len(panels) :]:
        axes.set_visible(False)
    if share:
        same_limits(all_axes[: len(panels)])
    handles, names = _key(points, groups, several, shaded, perturbed, catch)
    if len(names) > 1:
        legend_above(figure, handles, names)
    return figure


def _columns(trials: float, panels: int, size: str) -> int:
    """Number of panels with this many trials that fit side by side."""
    if panels == 1 or size != "two columns":
        return 1
    return 3 if panels == 3 and trials <= 80 else 2


# The learning curve


def _adaptation(data: Data, unit: str, parts: list[str] | None) -> pd.DataFrame:
    """The reaches of adaptation.csv in this unit, numbered in their rounds."""
    table = data.table("adaptation")
    if unit:
        table = table[table["unit"] == unit]
    table = _numbered(table.rename(columns={"compensation": "value", "two_rate": "fit"}))
    for column in ("value", "fit", "perturbation"):
        known = pd.to_numeric(table[column], errors="coerce") if column in table else pd.Series(np.nan, index=table.index)
        table[column] = known.where(np.isfinite(known))
    for part in parts or []:
        if part not in set(table["part"]):
            raise NotThere(part, "is not a round of these sessions", list(table["part"].unique()), "")
    return table[table["part"].isin(parts)] if parts else table


@of_data
def learning_curve(data: Data, *, unit: str = "", rounds: list[str] | None = None, bin_trials: int = 1) -> pd.DataFrame:
    """Compensation over the trials of each round: that of each person, the mean over people, the fitted two-rate model, and
    the perturbation.

    `unit` is that of adaptation.csv, "deg" or "%"; but an adaptation index is a share here, whose unit is "1". `rounds` names
    those that are wanted, by default all; in a study, rounds are named "SESSION, ROUND". Trials are counted from the first of
    the round. With `bin_trials`, that many trials of a block are a point, from trial `first` to trial `last`.

    A row is `of` a "person" (`value` is the mean over n trials), the "mean" over n people with its 95 % interval from
    `low` to `high` (Student's t), the "fit" (the mean of people's fitted models), or the "schedule" (a trial's block
    and kind, with the perturbation as `value`). Values are in `unit`. Practice, all but the last attempt at a trial,
    and catch trials whose places in their block differ between people are left out. For one person there is no mean.

    Example: points = figures.learning_curve(figures.read(dh.rehearse("experiments/visuomotor-rotation.yaml", 4).folder)),
    once `dihaptic report` has made its tables. Raises NotThere without adaptation.csv, or for another round.
    """
    table = _adaptation(data, unit, rounds)
    out = _courses(table, bin_trials, table["person"].nunique() > 1)
    out["unit"] = table["unit"].iloc[0] if len(table) else unit
    return out


@drawing
def draw_learning_curve(
    points: pd.DataFrame, *, ylabel: str = "", size: str = "two columns", height_mm: float = 55
) -> Figure:
    """Draws learning_curve(), with a panel for each round, all with equal limits, and a colour for each group.

    Blocks are named above the panels, and those of washout, clamps, channels and catch trials are shaded. `ylabel` is the
    label of the axis, by default "compensation" with its unit.
    """
    points = _frame(points)
    ylabel = ylabel or label("compensation", str(points["unit"].iloc[0]))
    parts = list(dict.fromkeys(points["part"]))
    panels = [(part if len(parts) > 1 else "", points[points["part"] == part], ylabel) for part in parts]
    return _draw_courses(points, panels, size, height_mm, True)


# Windows of trials


@of_data
def learning_windows(data: Data, *, unit: str = "", rounds: list[str] | None = None) -> pd.DataFrame:
    """The windows of fits.csv, such as baseline, early, late and washout: of each person, and means over people.

    A row is a `window` `of` a "person", or the "mean" over n people with its 95 % interval from `low` to `high`
    (Student's t); for one person, the interval is the one over trials that fits.csv gives. `part` is the round (in a
    study, with its session); `rounds` names the rounds that are wanted; and `is_difference` tells whether a window is a
    difference of means (savings, rebound). Values are in `unit`. Raises NotThere.

    Example: points = figures.learning_windows(data), with data as for learning_curve().
    """
    table = data.table("fits")
    table = table[table["unit"] == unit] if unit else table
    table = _grouped(table.assign(part=_parts(table)))
    table = table[table["part"].isin(rounds)] if rounds else table
    several = table["person"].nunique() > 1
    rows = []
    for window in [*WINDOWS, *DIFFERENCES]:
        if window not in table or not table[window].notna().any():
            continue
        own = table[table[window].notna()]
        each = own.groupby(["part", "group", "person"], sort=False)[window].agg(value="mean", n="count").reset_index()
        each["n"] = 1
        mean = means_with_intervals(each, ["part", "group"], sort=False)
        if not several:
            ends = own.groupby(["part", "group"], sort=False)[[f"{window}_low", f"{window}_high"]].mean()
            mean["low"], mean["high"] = ends.to_numpy().T
        rows.append(pd.concat([each.assign(of="person"), mean], ignore_index=True).assign(window=window))
    columns = ["part", "group", "window", "is_difference", "of", "person", "n", "value", "low", "high", "unit"]
    out = pd.concat(rows, ignore_index=True) if rows else pd.DataFrame(columns=columns)
    out["is_difference"] = out["window"].isin(list(DIFFERENCES))
    out["unit"] = table["unit"].iloc[0] if len(table) else unit
    return out.reindex(columns=columns)


@drawing
def draw_learning_windows(
    points: pd.DataFrame, *, ylabel: str = "", size: str = "one column", height_mm: float = 62
) -> Figure:
    """Draws learning_windows(): people as joined dots, and their mean with its interval.

    Rounds have colours; with several groups, rounds have panels and groups have colours. Differences (savings, rebound)
    have a panel of their own on the right. `ylabel` is by default "compensation" with its unit.
    """
    points = _frame(points)
    unit = str(points["unit"].iloc[0])
    parts, groups = list(dict.fromkeys(points["part"])), sorted(points["group"].unique())
    colour, levels = ("group", groups) if len(groups) > 1 else ("part", parts)
    split: list[Any] = parts if colour == "group" and len(parts) > 1 else [None]
    sides = [side for side in (False, True) if (points["is_difference"] == side).any()]
    shares = [points[points["is_difference"] == side]["window"].nunique() + 0.5 for side in sides]
    columns = len(sides) if len(sides) > 1 else min(len(split), 2 if size == "two columns" else 1)
    ratios = shares if len(sides) > 1 else [1.0] * columns
    rows = -(-len(split) * len(sides) // columns)
    figure, all_axes = canvas(size, height_mm * rows, rows, columns, gridspec_kw={"width_ratios": ratios})
    cells = [(part, side) for part in split for side in sides]
    for i, (axes, (part, side)) in enumerate(zip(all_axes, cells)):
        own = points[(points["is_difference"] == side) & ((points["part"] == part) | (part is None))]
        width = (WIDTHS[size] - 14 * (columns - 1)) * ratios[i % columns] / sum(ratios)
        _panel_of_windows(axes, own, [own[own[colour] == value] for value in levels], width)
        axes.set_ylabel(label("difference", unit) if side else wrapped(ylabel or label("compensation", unit), 26))
        if part is not None and not side:
            axes.set_title(part)
    for axes in all_axes[len(cells) :]:
        axes.set_visible(False)
    for side in sides:
        same_limits([axes for axes, cell in zip(all_axes, cells) if cell[1] == side])
    if len(levels) > 1:
        legend_above(figure, [_dot(i) for i in range(len(levels))], [level(value) for value in levels])
    return figure


def _panel_of_windows(axes: Axes, own: pd.DataFrame, cases: list[pd.DataFrame], width_mm: float) -> None:
    """The windows of a panel of this width, and their names; a panel without windows is hidden."""
    axes.set_visible(not own.empty)
    names = {**WINDOWS, **DIFFERENCES}
    windows = [window for window in names if (own["window"] == window).any()]
    for i, case in enumerate(cases):
        _dots(axes, case, windows, i, len(cases))
    axes.axhline(0, color=QUIET, linewidth=0.4, zorder=1)
    axes.set_xticks(range(len(windows)), [names[window] for window in windows])
    axes.set_xlim(-0.6, max(len(windows), 1) - 0.4)
    fit_names(axes, width_mm)


def _dot(i: int) -> Line2D:
    return Line2D([], [], color=COLOURS[i % len(COLOURS)], marker=MARKERS[i % len(MARKERS)], ls="")


def _dots(axes: Axes, own: pd.DataFrame, windows: list[str], i: int, levels: int) -> None:
    """Draws people's windows as faint joined dots, and means with intervals."""
    aside = (i - (levels - 1) / 2) * min(0.16, 0.7 / levels)
    hue, marker = COLOURS[i % len(COLOURS)], MARKERS[i % len(MARKERS)]
    own = own.assign(at=own["window"].map({window: place + aside for place, window in enumerate(windows)})).sort_values("at")
    mean, people = own[own["of"] == "mean"], own[own["of"] == "person"]
    if people["person"].nunique() > 1:
        for _, one in people.groupby(["part", "person"]):
            joined = 0.0 if one["is_difference"].any() else 0.5
            axes.plot(one["at"] - 0.06 / levels, one["value"], color=hue, alpha=0.35, lw=joined, marker="o", ms=2, mew=0)
    low, high = (mean["value"] - mean["low"]).fillna(0), (mean["high"] - mean["value"]).fillna(0)
    reach = np.array([low, high])
    axes.errorbar(mean["at"], mean["value"], reach, color=hue, marker=marker, ls="", capsize=2, elinewidth=1, zorder=3)


# Generalisation


@of_data
def generalisation_curve(data: Data) -> pd.DataFrame:
    """Compensation against the angle from the trained direction, from generalisation.csv: each person's, and the means over
    people.

    A row is `of` a "person" (with n trials; conditions with the same angle are averaged), or the "mean" over n people
    with its 95 % interval from `low` to `high` (Student's t). Angles and values are in degrees; `share` is the share of
    the compensation in trained directions. Raises NotThere.
    """
    table = data.table("generalisation")
    table = table.assign(part=_parts(table))
    table = table[table["compensation_deg"].notna() & table["angle_deg"].notna()]
    by = ["part", "group", "angle_deg"]
    same = table.groupby([*by, "person"], sort=True)
    each = same.agg(value=("compensation_deg", "mean"), share=("share", "mean"), n=("trials", "sum")).reset_index()
    each = each.assign(of="person")
    mean = means_with_intervals(each, by, sort=False)
    out = pd.concat([each, mean] if table["person"].nunique() > 1 else [each], ignore_index=True)
    return out.reindex(columns=["part", "group", "angle_deg", "of", "person", "n", "value", "low", "high", "share"])


@drawing
def draw_generalisation(points: pd.DataFrame, *, size: str = "one column", height_mm: float = 62) -> Figure:
    """Draws generalisation_curve(), with a colour for each group or round; the trained direction is at 0°."""
    points = _frame(points)
    figure, (axes,) = canvas(size, height_mm)
    colour = "group" if points["group"].nunique() > 1 else "part"
    levels = list(dict.fromkeys(points[colour]))
    for i, value in enumerate(levels):
        hue, marker = COLOURS[i % len(COLOURS)], MARKERS[i % len(MARKERS)]
        own = points[points[colour] == value].sort_values("angle_deg")
        mean = own[own["of"] == "mean"]
        for _, one in own[own["of"] == "person"].groupby(["part", "person"]):
            style = {"alpha": 0.35, "lw": 0.5, "ms": 2} if len(mean) else {"ms": 3.5}
            axes.plot(one["angle_deg"], one["value"], color=hue, marker=marker, **style)
        low, high = (mean["value"] - mean["low"]).fillna(0), (mean["high"] - mean["value"]).fillna(0)
        if len(mean):
            at = mean["angle_deg"]
            axes.errorbar(at, mean["value"], np.array([low, high]), color=hue, marker=marker, capsize=2, elinewidth=1, zorder=3)
    axes.axhline(0, color=QUIET, linewidth=0.4, zorder=1)
    axes.axvline(0, color=QUIET, linewidth=0.6, linestyle=":", zorder=1)
    reach = max(45.0, float(points["angle_deg"].abs().max()))
    step = 45 if reach > 60 else 15
    axes.set_xticks(np.arange(-np.floor(reach / step), np.floor(reach / step) + 1) * step)
    axes.set_xlim(-1.06 * reach, 1.06 * reach)
    axes.set_xlabel("angle from the trained direction [°]")
    axes.set_ylabel("compensation [°]")
    if len(levels) > 1:
        legend_above(figure, [_dot(i) for i in range(len(levels))], [level(value) for value in levels])
    return figure


# Courses of other measures


def _of_session(data: Data, session: str, measures: list[str]) -> pd.DataFrame:
    """The trials of a session of a study, or all, from the first to the last in which a measure was taken.

    Rounds are not distinguished. Trials keep their numbers.
    """
    trials = data.table("trials")
    if session:
        trials = trials[trials["study_session"].astype(str) == session]
    table = _numbered(trials.drop(columns=["round", "perturbation", "trial"], errors="ignore"))
    taken = table.loc[table[measures].notna().any(axis=1), "trial"]
    return table[table["trial"].between(taken.min(), taken.max())] if len(taken) else table.iloc[:0]


@of_data
def measures_over_trials(data: Data, *, measures: list[str], session: str = "", bin_trials: int = 1) -> pd.DataFrame:
    """Measures of trials.csv over the trials of the session: each person's values, and means over people.

    Rows are as in learning_curve(), and have the `measure` and its `unit`; `session` names a session of a study. With
    `bin_trials`, each point stands for that many trials of a block. Raises NotThere.

    >>> from dihaptic import figures
    >>> points = figures.measures_over_trials(figures.read(lift_session), measures=["peak_grip_N"])
    >>> points[["measure", "of", "trial", "unit"]].values.tolist()
    [['peak_grip_N', 'person', 1.0, 'N'], ['peak_grip_N', 'schedule', 1.0, 'N']]
    """
    for measure in checked_list("measures", measures):
        data.measure(measure)
    table = _of_session(data, session, measures)
    several = table["person"].nunique() > 1
    found = []
    for measure in measures:
        unit = data.measure(measure).unit
        own = within_limits(_courses(table.assign(value=table[measure]), bin_trials, several), measure)
        own.insert(0, "measure", measure)
        found.append(own.assign(unit=unit))
    return pd.concat(found, ignore_index=True)


@drawing
def draw_measures_over_trials(
    points: pd.DataFrame, *, size: str = "two columns", height_mm: float = 48
) -> Figure:
    """Draws measures_over_trials(), with a panel for each measure, and a colour for each group.

    >>> from dihaptic import figures
    >>> points = figures.measures_over_trials(figures.read(lift_session), measures=["peak_grip_N"])
    >>> [axes.get_ylabel() for axes in figures.draw_measures_over_trials(points).axes]
    ['peak grip [N]']
    """
    points = _frame(points)
    panels = []
    for measure, own in points.groupby("measure", sort=False):
        unit = own["unit"].fillna("").iloc[0]
        panels.append(("", own, label(measure, unit)))
    return _draw_courses(points, panels, size, height_mm, False)


# Which figures a design calls for


def plans(data: Data) -> Iterator[Plan]:
    """Learning curves, windows and generalisation of adaptation; without adaptation, the task's measures over trials."""
    learned = data.has("adaptation") and bool(data.table("adaptation")["compensation"].notna().any())
    if learned:
        yield from _plans_of_curves(data)
    if data.has("fits"):
        yield from _plans_of_windows(data)
    if data.has("generalisation"):
        yield from _plan_of_generalisation(data)
    if not learned:
        yield from _plans_of_measures(data)


def _quantity(data: Data, unit: str) -> str:
    """The label of the axis of compensation, for the rounds with this unit."""
    if not data.has("fits"):
        return label("compensation", unit)
    fits = data.table("fits")
    names = set(fits[fits["unit"] == unit]["measure"].dropna())
    word = LEARNED.get(str(next(iter(names))), "compensation") if len(names) == 1 else "compensation"
    return label(word, unit)


def _left_out(table: pd.DataFrame, panels: int) -> str:
    """Sentences about what a course does not show."""
    catch = " Catch trials, whose places in their block differ between people, are left out." if _scattered(table).any() else ""
    return catch + _unnamed(table, panels)


def _too_many(data: Data) -> str:
    """A sentence for the caption if groups have no colours."""
    groups = data.table("trials")["group"].nunique()
    return f" The {groups} groups are not distinguished." if groups > _MOST_GROUPS else ""


def _lines_in_words(table: pd.DataFrame, width: int) -> str:
    """The meaning of the lines and dots of a course, for a caption."""
    counts = table.groupby("group")["person"].nunique()
    groups = len(counts)
    if table["person"].nunique() == 1:
        return "Dots are trials"
    each = f" over {width} trials of a block" if width > 1 else ""
    whose = "of the groups' people" if groups > 1 else "of people"
    bands = "lines and bands" if (counts > 1).any() else "lines"
    return f"Thin lines are people's values{each}; {bands} are means {whose}{intervals(counts, BY_T)}"


def _plans_of_curves(data: Data) -> Iterator[Plan]:
    adaptation = data.table("adaptation")
    units = list(adaptation[adaptation["compensation"].notna()]["unit"].dropna().unique())
    for unit in units:
        table = _adaptation(data, unit, None)
        parts = [part for part in dict.fromkeys(table["part"]) if table[table["part"] == part]["value"].notna().any()]
        name = "learning-curve" + ("" if len(units) == 1 else "-percent" if unit == "%" else f"-{unit}")
        for first in range(0, len(parts), _MOST_PANELS):
            some = parts[first : first + _MOST_PANELS]
            number = f"-{first // _MOST_PANELS + 1}" if len(parts) > _MOST_PANELS else ""
            options: dict[str, Any] = {"unit": unit} if len(units) > 1 else {}
            if len(some) < table["part"].nunique():
                options["rounds"] = some
            yield _plan_of_curve(data, table[table["part"].isin(some)], options, unit, name + number)


def _plan_of_curve(data: Data, table: pd.DataFrame, options: dict[str, Any], unit: str, name: str) -> Plan:
    parts = list(dict.fromkeys(table["part"]))
    people = table["person"].nunique()
    width = 1 if people == 1 else _width_of_bins(table, _MOST_POINTS if len(parts) == 1 else _MOST_POINTS_OF_SEVERAL)
    measured = table[table["value"].notna()]
    ylabel = _quantity(data, unit)
    model = f"; the dashed line is the two-rate model{'' if people == 1 else ', fitted to each person, as the mean of people'}"
    channels = " Values are those of trials in force channels." if set(measured["kind"]) == {"force_channel"} else ""
    dotted = ", the dotted line is the perturbation" if (table["perturbation"].fillna(0) != 0).any() else ""
    short = table.groupby("part")["trial"].max().max() <= 60 and len(parts) == 1
    return Plan(
        name=name,
        title="Learning over trials",
        caption=f"{ylabel.split(' [')[0].capitalize()} over the trials of {'a round' if len(parts) == 1 else 'each round'}. "
        f"{_lines_in_words(table, width)}{model if table['fit'].notna().any() else ''}{dotted}.{channels}"
        f"{_left_out(table, len(parts))}{_too_many(data)} {counted(people, 'person', 'people')}, "
        f"{counted(len(measured), 'measured trial')}; practice and all but the last attempt at a trial are left out.",
        points=learning_curve,
        points_options={**options, **({"bin_trials": width} if width > 1 else {})},
        drawing=draw_learning_curve,
        drawing_options={"ylabel": ylabel, "size": "one column" if short else "two columns"},
    )


def _plans_of_windows(data: Data) -> Iterator[Plan]:
    fits = data.table("fits")
    known = [window for window in [*WINDOWS, *DIFFERENCES] if window in fits]
    fits = _grouped(fits[fits[known].notna().any(axis=1)])
    fits = fits.assign(part=_parts(fits))
    units = list(fits["unit"].dropna().unique())
    for unit in units:
        own = fits[fits["unit"] == unit]
        parts = list(dict.fromkeys(own["part"]))
        name = "learning-windows" + ("" if len(units) == 1 else "-percent" if unit == "%" else f"-{unit}")
        most = 4 if own["group"].nunique() > 1 else len(COLOURS)
        for first in range(0, len(parts), most):
            some = parts[first : first + most]
            number = f"-{first // most + 1}" if len(parts) > most else ""
            options: dict[str, Any] = {"unit": unit} if len(units) > 1 else {}
            if len(parts) > most:
                options["rounds"] = some
            yield _plan_of_windows(data, own[own["part"].isin(some)], options, unit, name + number)


def _plan_of_windows(data: Data, own: pd.DataFrame, options: dict[str, Any], unit: str, name: str) -> Plan:
    windows = [window for window in [*WINDOWS, *DIFFERENCES] if window in own and own[window].notna().any()]
    people, groups, rounds = own["person"].nunique(), own["group"].nunique(), own["part"].nunique()
    dots = "Marks are one person's means" if people == 1 else "Dots are people, joined over windows; marks are their means"
    means = intervals(own.groupby(["part", "group"])["person"].nunique(), f" over people{BY_T}")
    means = ", with 95 % intervals over trials" if people == 1 else means
    clamp, washout = any("clamp" in window for window in windows), "washout_first" in windows
    also = " and ".join(word for word, there in (("clamp", clamp), ("washout", washout)) if there)
    about = [
        "Early and late: the first eight measured trials of the first perturbed block, and the last eight with that "
        "perturbation",
        f"{also}: the first{' or last' if clamp else ''} eight measured trials of the block" if also else "",
        "savings: the first eight measured trials of relearning less those of learning" if "savings" in windows else "",
        "rebound: the end of the clamp less what preceded it" if "rebound" in windows else "",
        "where there are fewer than eight, all of them are taken",
    ]
    wide = len(windows) > 4 or (groups > 1 and rounds > 1) or max(groups, rounds) > 2
    return Plan(
        name=name,
        title="Learning in windows of trials",
        caption=f"{dots}{means}. {'; '.join(part for part in about if part)}.{_too_many(data)} "
        f"{counted(people, 'person', 'people')}{f', {rounds} rounds' if rounds > 1 else ''}, "
        f"{counted(int(own['measured'].sum()), 'measured trial')}.",
        points=learning_windows,
        points_options=options,
        drawing=draw_learning_windows,
        drawing_options={"ylabel": _quantity(data, unit), "size": "two columns" if wide else "one column"},
    )


def _plan_of_generalisation(data: Data) -> Iterator[Plan]:
    table = data.table("generalisation")
    table = table[table["compensation_deg"].notna() & table["angle_deg"].notna()]
    if table["angle_deg"].nunique() < 2:
        return
    people = table["person"].nunique()
    counts = table.groupby([_parts(table), "group", "angle_deg"])["person"].nunique()
    lines = "" if people == 1 else f" Thin lines are people, marks their means{intervals(counts, BY_T)}."
    yield Plan(
        name="generalisation",
        title="Generalisation to other directions",
        caption="Compensation without a visible error, minus that before training, against the angle from the nearest trained "
        f"direction.{lines} {counted(people, 'person', 'people')}, {counted(int(table['trials'].sum()), 'trial')}.",
        points=generalisation_curve,
        drawing=draw_generalisation,
    )


def _plans_of_measures(data: Data) -> Iterator[Plan]:
    trials = data.table("trials")
    known = trials["study_session"].notna() if "study_session" in trials else pd.Series(False, index=trials.index)
    sessions = list(dict.fromkeys(trials[known]["study_session"].astype(str))) if known.any() else [""]
    for session in sessions:
        plan = _plan_of_measures(data, session, "-" + re.sub(r"\W|_", "-", session.lower()) if len(sessions) > 1 else "")
        if plan is not None:
            yield plan


def _plan_of_measures(data: Data, session: str, suffix: str) -> Plan | None:
    table = _of_session(data, session, [measure.column for measure in data.measures])
    if table.empty:
        return None
    shown = table[~_scattered(table)]
    measures = []
    for measure in data.measures:
        values = shown[shown[measure.column].notna()]
        # a constant has no course
        if values["trial"].nunique() >= _LEAST_TRIALS and values[measure.column].nunique() > 1:
            measures.append(measure)
    if not measures:
        return None
    some, rest = measures[:_MOST_PANELS], measures[_MOST_PANELS:]
    people = table["person"].nunique()
    most = _MOST_POINTS if len(some) == 1 else _MOST_POINTS_OF_SEVERAL
    widths = [_width_of_bins(table.assign(value=table[measure.column]), most) for measure in some]
    width = 1 if people == 1 else max(widths)
    omitted = f" Not shown: {', '.join(words_of(measure.column, measure.unit) for measure in rest)}." if rest else ""
    values = table[[measure.column for measure in some]].notna().any(axis=1)
    return Plan(
        name=f"measures-over-trials{suffix}",
        title="Measures over trials" + (f" ({session})" if suffix else ""),
        caption=f"{_lines_in_words(table, width)}.{_left_out(table, len(some))}{_too_many(data)} "
        f"{counted(people, 'person', 'people')}, "
        f"{counted(int(values.sum()), 'trial')}; practice and all but the last attempt at a trial are left out.{omitted}"
        + said_of_limits({measure.column: words_of(measure.column, measure.unit) for measure in some}),
        points=measures_over_trials,
        points_options={
            "measures": [measure.column for measure in some],
            **({"session": session} if session else {}),
            **({"bin_trials": width} if width > 1 else {}),
        },
        drawing=draw_measures_over_trials,
        drawing_options={
            "size": "two columns" if len(some) > 1 or table["trial"].max() > 60 else "one column",
        },  # fmt: skip
        heading="Over trials",
    )
