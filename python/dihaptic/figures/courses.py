"""Courses over trials, of any quantity: each person's, their mean, fitted models, and the schedule of blocks."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from ..errors import error
from .data import sitting_columns
from .means import means_with_intervals
from .style import COLOURS, MARKERS, QUIET, WIDTHS, canvas, faint, legend_above, letter_mm, same_limits, wrapped
from .words import level

#: Maximum number of groups with colours of their own.
MOST_GROUPS = 7
#: Bands around means: the probability of each, in percent.
BANDS = (90, 50)
#: Maximum number of rows of blocks' names.
_MOST_ROWS = 3
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
_DASHES: list[Any] = [
    "-", (0, (5, 1.5)), (0, (1.5, 1)), (0, (6, 1.5, 1.5, 1.5)), (0, (3, 1)), (0, (6, 1.5, 1.5, 1.5, 1.5, 1.5)), "-",
]  # fmt: skip
#: Opacity of intervals and bands.
_ALPHA = 0.22
_COLUMNS = ["part", "group", "of", "person", "first", "last", "trial", "block", "block_kind", "kind", "n", "value", "low", "high"]


def parts_of(table: pd.DataFrame) -> pd.Series:
    """For each row, the name of its part (a session of a study, or a round), which has its own panel."""
    words = pd.Series("", index=table.index)
    for column in ("study_session", "round"):
        if column in table:
            name = table[column].fillna("").astype(str)
            words = words.where(name == "", (words + ", " + name).str.removeprefix(", "))
    return words


def grouped(table: pd.DataFrame) -> pd.DataFrame:
    """The table, with groups merged if there are more groups than colours."""
    return table.assign(group="") if table["group"].nunique() > MOST_GROUPS else table


def numbered(table: pd.DataFrame) -> pd.DataFrame:
    """The last attempt at each trial, with its number in its part, from 1; practice is left out."""
    table = grouped(table[table["trial_num"].notna()].assign(part=parts_of(table)))
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


def scattered(table: pd.DataFrame) -> pd.Series:
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


def courses_of(table: pd.DataFrame, width: int, several: bool) -> pd.DataFrame:
    """Each person's values, their means, the fitted models, and the schedule of blocks, as rows of a table of points."""
    if width < 1:
        raise error("must be at least one trial", "Write bin_trials=1 for every trial.", key="bin_trials")
    shown = table[~scattered(table)].merge(_bins(table, width), on=["part", "trial"], how="left")
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


def width_of_bins(table: pd.DataFrame, most: int) -> int:
    """How many trials to average for each point of a line, so that there are few enough points, and most include all people."""
    keys = [*sitting_columns(table), "part"]
    trials = int(table.groupby(keys)["trial"].count().max())
    share = table["value"].notna().groupby([table[column] for column in [*keys, "block"]]).mean()
    share = share.groupby([*keys[1:], "block"] if len(keys) > 1 else ["block"]).mean()
    least = float(share[share > 0].min()) if (share > 0).any() else 1.0
    # if points must be means of trials, half as many are drawn as would fit
    wanted = max(2 * trials / most if trials > most else 1.0, 1 / least if least < 0.5 else 1.0)
    return next((width for width in _WIDTHS_OF_BINS if width >= wanted * 0.999), _WIDTHS_OF_BINS[-1])


def with_texts(points: pd.DataFrame) -> pd.DataFrame:
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


def unnamed(table: pd.DataFrame, panels: int) -> str:
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
    """Draws the people or laboratories, their mean with its interval or bands, and the fitted model, of one group in a panel."""
    hue, dashes = COLOURS[group % len(COLOURS)], _DASHES[group % len(_DASHES)]
    for share in BANDS:
        band = own[own["of"] == f"{share} %"].sort_values("trial")
        axes.fill_between(band["trial"], band["low"], band["high"], color=hue, alpha=_ALPHA, linewidth=0, zorder=2.5)
    single = own[own["of"].isin(["person", "laboratory"])]
    opacity = faint(groups * single["person"].nunique())
    for _, one in single.groupby("person"):
        one = one.sort_values("trial")
        if several:
            axes.plot(one["trial"], one["value"], color=hue, alpha=opacity, linewidth=0.5, zorder=3)
            continue
        catch = one["trial"].isin(_single_catch(own))
        axes.plot(one["trial"][~catch], one["value"][~catch], ls="", marker=MARKERS[group % 7], color=hue, ms=2, mew=0, alpha=0.7)
        axes.plot(one["trial"][catch], one["value"][catch], ls="", marker="D", color=hue, mfc="white", ms=2.6, mew=0.6, zorder=3)
    mean = own[own["of"] == "mean"].sort_values("trial")
    few = len(mean) <= 45
    if len(mean):
        axes.fill_between(mean["trial"], mean["low"], mean["high"], color=hue, alpha=_ALPHA, linewidth=0, zorder=2.5)
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
            band = Patch(color=hue, alpha=_ALPHA, lw=0)
            drawn = points.loc[(points["of"] == "mean") & (points["group"] == group), "low"].notna().any()
            name = "mean with 95 % interval" if drawn else "mean"
            out.append(((band, line) if drawn else line, level(group) if len(groups) > 1 else name))
        who = "laboratories" if "laboratory" in of else "people"
        out.append((Line2D([], [], color=one, alpha=0.5, lw=0.5), who))
        # a band within another one is darker
        bands = [share for share in reversed(BANDS) if f"{share} %" in of]
        out += [(Patch(color=one, alpha=1 - (1 - _ALPHA) ** (len(bands) - i), lw=0), f"{share} % band") for i, share in enumerate(bands)]
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


def draw_courses(
    points: pd.DataFrame, panels: list[tuple[str, pd.DataFrame, str]], size: str, height_mm: float, share: bool
) -> Figure:
    """Panels of courses, each with its title, its points, and the label of its axis."""
    columns = _columns(points["last"].max(), len(panels), size)
    rows = -(-len(panels) // columns)
    width_mm = WIDTHS[size] / columns - 17
    names_mm = [3.2 * _rows_of_names(_runs(own[own["of"] == "schedule"]), width_mm) for _, own, _ in panels]
    figure, all_axes = canvas(size, (height_mm + max(names_mm)) * rows + 5, rows, columns)
    groups = {group: i for i, group in enumerate(dict.fromkeys(points["group"]))}
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
