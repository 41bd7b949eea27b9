"""Psychophysics: psychometric functions, thresholds, courses of procedures, and binary answers by a factor."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, MaxNLocator, NullLocator
from scipy import special

from ..errors import NotThere, error
from .conditions import counting_trials
from .data import Data, sitting_columns
from .means import BY_T, intervals, means_with_intervals
from .saving import Plan
from .style import COLOURS, MARKERS, QUIET, WIDTHS, canvas, drawing, faint, fit_names, legend_above, of_data, wrapped
from .words import counted, in_print, label, level, words_of

#: Heading above these figures in a report.
HEADING = "Thresholds"
#: Maximum numbers of panels in a figure, and of lines with colours of their own.
_MOST_PANELS, _MOST_COLOURS = 9, 7
#: Minimum number of answers at a level for an interval, which would fill the panel and say nothing with fewer.
_LEAST_ANSWERS = 5
#: An outcome counts as frequent if it ended at least this share of the included trials.
_FREQUENT = 0.05
_ALL = "all of these"  # kind of a fit to the answers of several procedures
_OUTSIDE = "outside of the levels"  # beginning of the note on a threshold that is a guess
_LINES: list[Any] = ["-", (0, (5, 1.5)), (0, (1.5, 1)), (0, (6, 1.5, 1.5, 1.5)), (0, (3, 1)), (0, (1, 2)), (0, (8, 2))]
#: Steps of round numbers on an axis.
_STEPS = [1, 2, 2.5, 5, 10]
_PANEL = ["procedure", "kind", "quantity", "unit", "logarithmic", "yes"]


def wilson(yes: Any, n: Any) -> tuple[Any, Any]:
    """Wilson's 95 % interval of a share: `yes` out of `n` (numbers, or arrays of one shape; n > 0).

    >>> low, high = wilson(8, 10)
    >>> float(round(low, 3)), float(round(high, 3))
    (0.49, 0.943)
    """
    z = special.ndtri(0.975)
    share = yes / n
    middle = (share + z**2 / (2 * n)) / (1 + z**2 / n)
    half = z / (1 + z**2 / n) * np.sqrt(share * (1 - share) / n + z**2 / (4 * n**2))
    return middle - half, middle + half


def probability(
    levels: Any, *, sigmoid: str, threshold: float, shape: float, guess: float = 0.0, lapse: float = 0.0
) -> Any:  # fmt: skip
    """The probability of yes according to a psychometric function, at levels in its own unit (log10 if they are logarithms).

    `sigmoid`: normal, logistic, weibull or weibull_log10, as in a task's procedures; `threshold` and `shape` are those of
    thresholds.csv. Raises NotThere for another sigmoid.

    >>> float(probability(0.3, sigmoid="normal", threshold=0.3, shape=0.1, guess=0.5, lapse=0.02))
    0.74
    """
    x = np.asarray(levels, dtype=float)
    kinds: dict[str, Callable[[], Any]] = {
        "normal": lambda: special.ndtr((x - threshold) / shape),
        "logistic": lambda: special.expit((x - threshold) / shape),
        "weibull": lambda: -np.expm1(-np.power(np.maximum(x, 0) / threshold, shape)),
        "weibull_log10": lambda: -np.expm1(-np.power(10.0, shape * (x - threshold))),
    }
    if sigmoid not in kinds:
        raise NotThere(sigmoid, "is not a sigmoid", list(kinds), f"Sigmoids are {', '.join(kinds)}.")
    with np.errstate(over="ignore"):
        return guess + (1 - guess - lapse) * kinds[sigmoid]()


# Answers of procedures


@dataclass(frozen=True)
class _Procedure:
    """A procedure, or several procedures whose answers share a function, as recorded in procedures.csv."""

    name: str
    parts: tuple[str, ...]  # names of the procedures
    sitting: str  # session of a study; "" if there is none
    kind: str
    quantity: str  # the quantity that it chooses, in words
    unit: str  # unit of its levels; "" for shares
    column: str  # column of trials.csv with its levels
    logarithmic: bool
    yes: str
    no: str
    sigmoid: str
    guess: float
    guess_is_lapse: bool
    standard: float
    skipped: int  # number of first reversals of a staircase to ignore

    @property
    def title(self) -> str:
        """The procedure's name in a figure."""
        name = f"{self.name}, together" if self.kind == _ALL else self.name
        return f"{self.sitting}: {name}" if self.sitting else name

    def panel(self) -> dict[str, Any]:
        """The procedure's properties that a drawing needs."""
        return {
            "procedure": self.title, "kind": self.kind, "quantity": self.quantity, "unit": self.unit,
            "logarithmic": self.logarithmic, "yes": self.yes,
        }  # fmt: skip


def _is_yes(value: Any) -> bool:
    return value is True or str(value).lower() in ("yes", "true")


def _text(value: Any) -> str:
    return "" if pd.isna(value) else str(value)


def _sitting_of(session: Any) -> str:
    """The name that a session has in its study; "" without a study."""
    return str((session.info.get("in_study") or {}).get("session", "") or "")


def _procedures(data: Data) -> list[_Procedure]:
    """The procedures of the task that chose a level, in its order, and the joint ones of thresholds.csv."""
    trials = data.table("trials")
    if "procedure" not in trials or "outcome" not in trials:
        return []
    days = trials["study_session"].fillna("").astype(str) if "study_session" in trials else pd.Series("", trials.index)
    asked = trials["procedure"].notna()
    missing = set(zip(days[asked], trials.loc[asked, "procedure"].astype(str)))
    several = days.nunique() > 1
    found: list[_Procedure] = []
    for session in data.sessions:
        place = _sitting_of(session) if "study_session" in trials else ""
        if not any(sitting == place for sitting, _ in missing) or "procedures" not in session.tables:
            continue
        for row in session.table("procedures").to_dict("records"):
            if (place, str(row["procedure"])) in missing:
                missing.discard((place, str(row["procedure"])))
                found.append(_procedure(data, row, place if several else ""))
    return [*found, *_joint(data, found)]


def _procedure(data: Data, row: dict[str, Any], sitting: str) -> _Procedure:
    trials = data.table("trials")
    column = _text(row.get("level"))
    unit = str(trials.attrs.get("units", {}).get(column, "")) if column else ""
    skipped = 0
    for own in data.task.get("procedures") or []:
        if str(own.get("name")) == str(row["procedure"]):
            skipped = int((own.get("staircase") or {}).get("skipped_reversals", 0) or 0)
    return _Procedure(
        name=str(row["procedure"]), parts=(str(row["procedure"]),), sitting=sitting, kind=_text(row.get("kind")),
        quantity=words_of(column, unit) if column else "share of the perturbation", unit=unit, column=column or "share",
        logarithmic=_is_yes(row.get("logarithmic")), yes=_text(row.get("yes")), no=_text(row.get("no")),
        sigmoid=_text(row.get("sigmoid")), guess=float(row.get("guess", np.nan)),
        guess_is_lapse=_is_yes(row.get("guess_is_lapse")), standard=float(row.get("standard", np.nan)), skipped=skipped,
    )  # fmt: skip


def _joint(data: Data, single: list[_Procedure]) -> list[_Procedure]:
    """Several procedures to whose answers one function was fitted: thresholds.csv joins their names by commas."""
    if not data.has("thresholds"):
        return []
    table = data.table("thresholds")
    out = []
    for name in dict.fromkeys(table.loc[table["kind"] == _ALL, "procedure"].astype(str)):
        for sitting in dict.fromkeys(each.sitting for each in single):
            parts = _parts(name, [each for each in single if each.sitting == sitting])
            if len(parts) > 1:
                out.append(replace(parts[0], name=name, parts=tuple(each.name for each in parts), kind=_ALL))
    return out


def _parts(name: str, candidates: list[_Procedure]) -> list[_Procedure]:
    """The candidates whose names, joined by commas in their order, are `name`; [] if there are none."""
    for i, each in enumerate(candidates):
        if name == each.name:
            return [each]
        if name.startswith(f"{each.name}, "):
            rest = _parts(name[len(each.name) + 2 :], candidates[i + 1 :])
            if rest:
                return [each, *rest]
    return []


def _is_single(data: Data) -> bool:
    """Whether all trials are those of one session of one person."""
    trials = data.table("trials")
    return len(trials[sitting_columns(trials)].drop_duplicates()) == 1


def _of_sitting(table: pd.DataFrame, procedure: _Procedure) -> pd.DataFrame:
    table = table.assign(group=table["group"].fillna(""))
    if procedure.sitting and "study_session" in table:
        table = table[table["study_session"].astype(str) == procedure.sitting]
    return table


def _answers(data: Data, procedure: _Procedure) -> pd.DataFrame:
    """The answers of all people, in order: the level in its unit, whether the answer was yes, and the answer's number from 1."""
    trials = _of_sitting(data.table("trials"), procedure)
    own = trials[trials["procedure"].isin(procedure.parts) & trials["outcome"].isin([procedure.yes, procedure.no])].copy()
    own["level"] = pd.to_numeric(own[procedure.column], errors="coerce") if procedure.column in own else np.nan
    own = own[np.isfinite(own["level"]) & ((own["level"] > 0) | (not procedure.logarithmic))]
    own["said_yes"] = own["outcome"] == procedure.yes
    keys = sitting_columns(own)
    own["answer"] = own.groupby(keys).cumcount() + 1 if len(own) else pd.Series(dtype=int)
    return own[[*keys, "trial_num", "answer", "level", "said_yes"]]


def _fits(data: Data, procedure: _Procedure) -> pd.DataFrame:
    """Rows of thresholds.csv with a fitted function; `outside`: its threshold is a guess."""
    if not data.has("thresholds"):
        return pd.DataFrame(columns=["person", "group", "outside"])
    table = _of_sitting(data.table("thresholds"), procedure)
    table = table[(table["procedure"].astype(str) == procedure.name) & ((table["kind"] == _ALL) == (procedure.kind == _ALL))]
    # only the latest report of a session is used
    table = table.drop_duplicates(sitting_columns(table), keep="last")
    table = table[table["threshold"].notna() & (table["shape"] > 0)]
    return table.assign(outside=table["note"].fillna("").astype(str).str.startswith(_OUTSIDE))


def _chosen(data: Data, procedures: list[str] | None) -> list[_Procedure]:
    """The procedures with these titles, by default all. Raises NotThere, or Error when there is none."""
    known = _procedures(data)
    if not known:
        raise error("has no trials of a procedure", "Name a session whose task has procedures.", file=str(data.folder))
    if procedures is None:
        return known
    for name in procedures:
        titles = [each.title for each in known]
        if name not in titles:
            raise NotThere(name, "is not a procedure of these trials", titles, "procedures.csv lists them.")
    return [each for each in known if each.title in procedures]


def _finished(parts: list[dict[str, Any]], columns: list[str], procedures: list[str] | None) -> pd.DataFrame:
    out = pd.DataFrame(parts).reindex(columns=columns)
    if out.empty:
        raise error("has no answers", "Name procedures that were answered.", key=", ".join(procedures or []))
    return out


def _mean(values: pd.Series, logarithmic: bool) -> dict[str, Any]:
    """The mean over people with its 95 % interval (Student's t); it is the mean of the logarithms, if levels are logarithms."""
    x = np.log10(values) if logarithmic else values
    n = len(x)
    middle = x.mean()
    half = special.stdtrit(max(1, n - 1), 0.975) * x.std() / np.sqrt(n) if n > 1 else np.nan
    ends = [middle, middle - half, middle + half]
    value, low, high = [10**end if logarithmic else end for end in ends]
    return {"n": n, "value": value, "low": low, "high": high}


# Psychometric functions

_FUNCTION = [*_PANEL, "group", "of", "person", "n", "level", "value", "low", "high"]


@of_data
def psychometric_functions(data: Data, *, procedures: list[str] | None = None) -> pd.DataFrame:
    """Answers of procedures by level, with the fitted functions of thresholds.csv; nothing is fitted anew.

    A row has its procedure, and `of`: "level", at which n answers had the share `value` of yes, with Wilson's 95 %
    interval; "curve", a point of a person's function; "threshold", at `level`, where the function's value is `value`, with
    its 95 % interval of levels from `low` to `high`; "mean" of n people's thresholds, with its interval of levels;
    "chance", the share of guesses; "standard", its level. Levels have the unit `unit`, and are never logarithms; the mean
    is the geometric one where `logarithmic`. Shares at levels are given only for one person. Thresholds outside the levels
    shown are left out. `procedures`: names, by default all. Raises NotThere, or Error when there are no answers.

    >>> from dihaptic import figures
    >>> psychometric_functions(figures.read(lift_session))
    Traceback (most recent call last):
    ...
    dihaptic.errors.Error: ...has no trials of a procedure. Name a session whose task has procedures.
    """
    rows: list[dict[str, Any]] = []
    single = _is_single(data)
    for procedure in _chosen(data, procedures):
        answers = _answers(data, procedure)
        if answers.empty:
            continue
        head = procedure.panel()
        fits = _fits(data, procedure)
        if not single and fits.empty:
            continue
        if single:
            rows += [{**head, "group": answers["group"].iloc[0], **row} for row in _shares(answers, procedure)]
        rows += [{**head, **row} for row in _curves(answers, fits, procedure)]
        if not single:
            rows += [{**head, **row} for row in _mean_thresholds(fits, procedure)]
        if procedure.guess > 0 and not procedure.guess_is_lapse:
            rows.append({**head, "group": "", "of": "chance", "value": procedure.guess})
        if np.isfinite(procedure.standard):
            rows.append({**head, "group": "", "of": "standard", "level": procedure.standard})
    return _finished(rows, _FUNCTION, procedures)


def _mean_thresholds(fits: pd.DataFrame, procedure: _Procedure) -> Iterator[dict[str, Any]]:
    """The mean threshold of each group's people, at their mean probability of yes."""
    for group, own in fits[~fits["outside"].astype(bool)].groupby("group", sort=False):
        mean = _mean(own.groupby("person")["threshold_share"].mean(), procedure.logarithmic)
        yield {"group": group, "of": "mean", **mean, "level": mean["value"], "value": own["threshold_probability"].mean()}


def _shares(answers: pd.DataFrame, procedure: _Procedure) -> Iterator[dict[str, Any]]:
    """The share of yes at each level; levels that differ only by rounding count as one."""
    own = answers.sort_values("level", kind="stable")
    at = np.log10(own["level"]) if procedure.logarithmic else own["level"]
    # as in the program: sums of a staircase's steps return to a level only up to rounding
    new = (at.diff() > 1e-9 * (at.max() - at.min())).cumsum()
    for _, same in own.groupby(new.to_numpy()):
        yes, n = int(same["said_yes"].sum()), len(same)
        low, high = wilson(yes, n) if n >= _LEAST_ANSWERS else (np.nan, np.nan)
        yield {
            "of": "level", "person": same["person"].iloc[0], "n": n, "level": same["level"].iloc[0],
            "value": yes / n, "low": low, "high": high,
        }  # fmt: skip


def _curves(answers: pd.DataFrame, fits: pd.DataFrame, procedure: _Procedure) -> Iterator[dict[str, Any]]:
    """The function of each person over the levels that the person was shown, and its threshold."""
    for fit in fits.to_dict("records"):
        own = answers
        for key in sitting_columns(answers):
            own = own[own[key] == fit[key]] if key in fit else own
        if own.empty:
            continue
        shown = np.log10(own["level"]) if procedure.logarithmic else own["level"]
        low, high, t, s = float(shown.min()), float(shown.max()), float(fit["threshold"]), float(fit["shape"])
        near = t + np.linspace(-4, 4, 41) * (s if procedure.sigmoid in ("normal", "logistic") else 0)
        x = np.unique(np.concatenate([np.linspace(low, high, 81), near[(near > low) & (near < high)]]))
        lapse = float(fit["lapse"]) if np.isfinite(fit["lapse"]) else 0.0
        guess = lapse if procedure.guess_is_lapse else procedure.guess
        p = probability(x, sigmoid=procedure.sigmoid, threshold=t, shape=s, guess=guess, lapse=lapse)
        common = {"group": fit["group"], "person": fit["person"], "n": len(own)}
        if "session" in fit and answers.groupby("person")["session"].nunique().max() > 1:
            common["person"] = f"{fit['person']}, {fit['session']}"
        for level_, value in zip(10**x if procedure.logarithmic else x, p):
            yield {**common, "of": "curve", "level": level_, "value": value}
        if not fit["outside"]:
            ends = _interval(fit["threshold_95"])
            if procedure.logarithmic:
                ends = [10**end for end in ends]
            yield {
                **common, "of": "threshold", "level": fit["threshold_share"], "value": fit["threshold_probability"],
                "low": ends[0], "high": ends[1],
            }  # fmt: skip


def _interval(text: Any) -> list[float]:
    """Both ends of "0.2 to 0.3"; NaN where there is none."""
    try:
        low, high = str(text).split(" to ")
        return [float(low), float(high)]
    except ValueError:
        return [np.nan, np.nan]


@drawing
def draw_psychometric_functions(
    points: pd.DataFrame, *, size: str = "one column", height_mm: float = 55
) -> Figure:
    """Draws psychometric_functions(), with a panel for each procedure, and a colour for each group.

    `height_mm` is the height of a row of panels.

    >>> import pandas as pd
    >>> common = {"procedure": "finger", "kind": "constant", "quantity": "width", "unit": "mm", "logarithmic": False}
    >>> common |= {"yes": "wider", "group": "", "of": "level", "n": 20}
    >>> shares = [{**common, "level": 50 + i, "value": i / 4} for i in range(5)]
    >>> figure = draw_psychometric_functions(pd.DataFrame(shares))
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('width [mm]', 'share of "wider"')
    """
    points = points.reindex(columns=list(dict.fromkeys([*_FUNCTION, *points.columns])))
    groups = _groups(points[points["of"].isin(["level", "curve", "threshold", "mean"])])
    several = not bool((points["of"] == "level").any())
    figure, panels = _panels(points, size, height_mm)
    largest = points.loc[points["of"] == "level", "n"].max()
    shares = pd.concat([points["value"], points.loc[points["of"] == "level", "low"]])
    lowest = 0.5 if shares.min() >= 0.48 else 0  # in a forced choice, shares are rarely below 0.5
    for axes, own in panels:
        _quiet_lines(axes, own)
        for i, group in enumerate(groups):
            dark = "black" if len(groups) == 1 else COLOURS[i % len(COLOURS)]
            _function(axes, own[own["group"].fillna("") == group], i, several, largest, dark)
        axes.set_ylim(lowest - 0.04, 1.04)
        axes.set_yticks(*_ticks_of_shares(lowest))
    _level_axes(panels, "x")
    answers = list(dict.fromkeys(points["yes"]))
    _label_all(panels, x=None, y=f'share of "{answers[0]}"' if len(answers) == 1 else "share of yes", size=size)
    handles, names = _legend_of_functions(points, groups, several)
    legend_above(figure, handles, names)
    return figure


def _ticks_of_shares(lowest: float) -> tuple[list[float], list[str]]:
    ticks = [0, 0.25, 0.5, 0.75, 1] if lowest == 0 else [0.5, 0.6, 0.7, 0.8, 0.9, 1]
    return ticks, [f"{tick:g}" for tick in ticks]


def _groups(points: pd.DataFrame) -> list[str]:
    return list(dict.fromkeys(points["group"].fillna("").astype(str)))


def _quiet_lines(axes: Axes, own: pd.DataFrame) -> None:
    """Draws the chance level, and the standard."""
    for value in own.loc[own["of"] == "chance", "value"]:
        axes.axhline(value, color=QUIET, linewidth=0.6, linestyle=":", zorder=0)
    for value in own.loc[own["of"] == "standard", "level"]:
        axes.axvline(value, color=QUIET, linewidth=0.6, linestyle="--", zorder=0)


def _function(axes: Axes, own: pd.DataFrame, i: int, several: bool, largest: float, dark: str) -> None:
    """Draws one group's or person's function: shares at levels, curves, thresholds."""
    hue, marker = COLOURS[i % len(COLOURS)], MARKERS[i % len(MARKERS)]
    shares = own[own["of"] == "level"]
    known = shares[shares["low"].notna()]
    axes.vlines(known["level"], known["low"], known["high"], color=hue, alpha=0.5, linewidth=0.7, zorder=1)
    axes.scatter(
        shares["level"], shares["value"], s=4 + 44 * shares["n"] / max(10, largest), marker="o", facecolor="white", edgecolor=hue,
        linewidth=0.9, zorder=2, clip_on=False,
    )  # fmt: skip
    curves = own[own["of"] == "curve"]
    line = {"linewidth": 0.6, "alpha": faint(curves["person"].nunique())} if several else {"linewidth": 1.2}
    for _, curve in curves.groupby("person", sort=False):
        axes.plot(curve["level"], curve["value"], color=hue, linestyle=_LINES[i % len(_LINES)], zorder=3, **line)
    thresholds = own[own["of"] == "threshold"]
    if several:
        axes.plot(thresholds["level"], thresholds["value"], linewidth=0, marker=".", markersize=3.5, color=hue, alpha=0.6)
    for row in own[own["of"] == ("mean" if several else "threshold")].itertuples():
        if np.isfinite(row.low) and np.isfinite(row.high):
            axes.hlines(row.value, row.low, row.high, color=dark, linewidth=1.4, zorder=4)
        axes.plot(row.level, row.value, marker=marker, markersize=5, markerfacecolor=hue, markeredgecolor="black", zorder=5)


def _group_marks(groups: list[str], marked: bool = True) -> list[tuple[str, Line2D]]:
    """Names and lines of groups in a legend; none for a single one."""
    if len(groups) == 1:
        return []
    return [
        (
            level(group) or "no group",
            Line2D([], [], color=COLOURS[i % 7], linestyle=_LINES[i % 7], marker=MARKERS[i % 7] if marked else ""),
        )
        for i, group in enumerate(groups)
    ]


def _legend_of_functions(points: pd.DataFrame, groups: list[str], several: bool) -> tuple[list[Any], list[str]]:
    kinds = set(points["of"])
    out = _group_marks(groups)
    hue, dark = (COLOURS[0], "black") if len(groups) == 1 else (QUIET, QUIET)
    if "level" in kinds:
        out.append(("share of answers", Line2D([], [], color=hue, linewidth=0, marker="o", markerfacecolor="white")))
    if "curve" in kinds:
        name, width = ("function of a person", 0.6) if several else ("fitted function", 1.2)
        out.append((name, Line2D([], [], color=hue, linewidth=width)))
    of, name = ("mean", "mean threshold") if several else ("threshold", "threshold")
    if of in kinds:
        known = bool(points.loc[points["of"] == of, "low"].notna().any())
        mark = {"marker": MARKERS[0], "markersize": 5, "markerfacecolor": hue, "markeredgecolor": "black"}
        line = Line2D([], [], color=dark, linewidth=1.4 * known, **mark)
        out.append((name + ", 95 % interval" * known, line))
    for of, dashes in (("chance", ":"), ("standard", "--")):
        if of in kinds:
            out.append((of, Line2D([], [], color=QUIET, linewidth=0.6, linestyle=dashes)))
    return [handle for _, handle in out], [name for name, _ in out]


# Panels of procedures


def _panels(points: pd.DataFrame, size: str, height_mm: float) -> tuple[Figure, list[tuple[Axes, pd.DataFrame]]]:
    """A panel for each procedure, with its points."""
    names = list(dict.fromkeys(points["procedure"]))
    columns = _columns(len(names), size)
    rows = -(-len(names) // columns)
    # in a figure with one row, names and a legend take a larger part of the height
    figure, all_axes = canvas(size, height_mm * rows + 8, rows, columns)
    for axes in all_axes[len(names) :]:
        axes.set_visible(False)
    panels = []
    for axes, name in zip(all_axes, names):
        panels.append((axes, points[points["procedure"] == name]))
        if len(names) > 1:
            axes.set_title(wrapped(str(name), max(10, int((WIDTHS[size] / columns - 14) / 1.6))))
    return figure, panels


def _columns(panels: int, size: str) -> int:
    return 1 if size == "one column" else {1: 1, 2: 2, 4: 2}.get(panels, 3)


def _level_axes(panels: list[tuple[Axes, pd.DataFrame]], axis: str) -> None:
    """Sets the axes of levels: axes of the same quantity have the same limits, and are logarithmic if its levels are."""
    keys = [tuple(own[["quantity", "unit", "logarithmic"]].fillna("").iloc[0]) for _, own in panels]
    for key in dict.fromkeys(keys):
        some = [(axes, own) for (axes, own), other in zip(panels, keys) if other == key]
        logarithmic = bool(key[2]) and all(bool((own["level"].dropna() > 0).all()) for _, own in some)
        shown = pd.concat([_extent(own, logarithmic) for _, own in some])
        low, high = (float(shown.min()), float(shown.max())) if len(shown) else (0.0, 1.0)
        # a panel with a single level needs a width, too
        margin = 0.07 * (high - low) or 0.1 * (abs(high) or 1)
        limits = [10**end if logarithmic else end for end in (low - margin, high + margin)]
        for axes, _ in some:
            if logarithmic:
                axes.set(**{f"{axis}scale": "log"})
            axes.set(**{f"{axis}lim": limits})
            if logarithmic:
                _log_ticks(getattr(axes, f"{axis}axis"), *limits)
            else:
                getattr(axes, f"{axis}axis").set_major_locator(MaxNLocator(5, steps=_STEPS))


def _extent(own: pd.DataFrame, logarithmic: bool) -> pd.Series:
    """The range that an axis of levels, or of their logarithms, has to show: an interval may end far from all levels."""
    levels = own["level"].dropna().astype(float)
    mean = own[own["of"] == "mean"]
    ends = pd.concat([mean["low"], mean["high"]]).dropna().astype(float) if "low" in own else pd.Series(dtype=float)
    if logarithmic:
        levels, ends = np.log10(levels), np.log10(ends[ends > 0])
    room = 0.25 * (levels.max() - levels.min())
    return pd.concat([levels, ends.clip(levels.min() - room, levels.max() + room)])


def _log_ticks(axis: Any, low: float, high: float) -> None:
    """Ticks at round numbers of a logarithmic axis."""
    decades = range(int(np.floor(np.log10(low))) - 1, int(np.ceil(np.log10(high))) + 1)
    ticks: list[float] = []
    for steps in ([1], [1, 3], [1, 2, 5]):
        ticks = [float(f"{step}e{decade}") for decade in decades for step in steps if low <= float(f"{step}e{decade}") <= high]
        if len(ticks) >= 3:
            break
    if len(ticks) < 2:
        ticks = [float(tick) for tick in MaxNLocator(4, steps=_STEPS).tick_values(low, high) if low <= tick <= high]
    axis.set_major_locator(FixedLocator(ticks))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))


def _quantity(own: pd.DataFrame) -> str:
    """The quantity of a panel's levels, with its unit."""
    row = own.iloc[0]
    unit = _text(row["unit"])
    return f"{row['quantity']} [{in_print(unit)}]" if unit and unit != "1" else str(row["quantity"])


def _label_all(panels: list[tuple[Axes, pd.DataFrame]], *, x: str | None, y: str | None, size: str) -> None:
    """Labels of all panels; None: the quantity of the levels.

    A label equal to that of the panel to the left is not repeated.
    """
    columns = _columns(len(panels), size)
    width = WIDTHS[size] / columns
    for i, (axes, own) in enumerate(panels):
        xlabel, ylabel = (x if x is not None else _quantity(own)), (y if y is not None else _quantity(own))
        below = panels[i + columns][1] if i + columns < len(panels) else None
        if below is None or (x is None and _quantity(below) != xlabel):
            axes.set_xlabel(wrapped(xlabel, int((width - 12) / 1.5)))
        left = panels[i - 1][1] if i % columns else None
        if left is None or (y is None and _quantity(left) != ylabel):
            axes.set_ylabel(wrapped(ylabel, 30))


# Thresholds of people

_THRESHOLD = ["measure", "quantity", "unit", "logarithmic", "procedure", "group", "of", "person", "n", "value", "low", "high"]


@of_data
def thresholds_by_procedure(
    data: Data, *, measure: str = "threshold_share", procedures: list[str] | None = None
) -> pd.DataFrame:
    """A measure of thresholds.csv for each person and procedure, and its means over people.

    `measure`: threshold_share, the threshold in the unit of the level; weber_fraction; or mean_of_reversals. A row has
    its procedure and group, and `of`: "person", or "mean" over n people with its 95 % interval (Student's t); the
    geometric mean, where `logarithmic`. Thresholds outside the levels shown are left out. Raises NotThere, or Error when
    there is none.

    >>> from dihaptic import figures
    >>> thresholds_by_procedure(figures.read(lift_session))
    Traceback (most recent call last):
    ...
    dihaptic.errors.Error: ...has no trials of a procedure. Name a session whose task has procedures.
    """
    known = ["threshold_share", "weber_fraction", "mean_of_reversals"]
    if measure not in known:
        raise NotThere(measure, "is not a measure of thresholds.csv", known, f"Measures are {', '.join(known)}.")
    rows: list[dict[str, Any]] = []
    for procedure in _chosen(data, procedures):
        fits = _fits(data, procedure)
        if fits.empty or measure not in fits:
            continue
        if measure != "mean_of_reversals":
            fits = fits[~fits["outside"]]
        fits = fits[np.isfinite(fits[measure].astype(float))]
        logarithmic = procedure.logarithmic and measure != "weber_fraction"
        if logarithmic:
            fits = fits[fits[measure] > 0]
        head: dict[str, Any] = {"measure": measure, "quantity": procedure.quantity, "unit": procedure.unit}
        head["procedure"] = procedure.title
        if measure == "weber_fraction":
            head |= {"quantity": "Weber fraction", "unit": ""}
        head["logarithmic"] = logarithmic
        each = fits.groupby(["group", "person"], sort=False)[measure].agg(["mean", "count"]).reset_index()
        for row in each.to_dict("records"):
            own = {"group": row["group"], "person": row["person"], "n": row["count"], "value": row["mean"]}
            rows.append({**head, "of": "person", **own})
        for group, people in each.groupby("group", sort=False):
            rows.append({**head, "group": group, "of": "mean", **_mean(people["mean"], logarithmic)})
    return _finished(rows, _THRESHOLD, procedures)


@drawing
def draw_thresholds(points: pd.DataFrame, *, size: str = "one column", height_mm: float = 60) -> Figure:
    """Draws thresholds_by_procedure(): people as dots, and means with intervals, with a panel for each quantity, and a
    colour for each group.

    Where all people did all procedures of a panel, a line joins each one's dots.

    >>> import pandas as pd
    >>> row = {"measure": "threshold_share", "quantity": "period", "unit": "mm", "logarithmic": False, "procedure": "ring finger"}
    >>> dots = [{**row, "group": "", "of": "person", "person": f"p{i}", "n": 1, "value": 2.5 + i / 10} for i in range(4)]
    >>> draw_thresholds(pd.DataFrame(dots)).axes[0].get_ylabel()
    'threshold: period [mm]'
    """
    points = points.reindex(columns=list(dict.fromkeys([*_THRESHOLD, *points.columns])))
    keys = ["quantity", "unit", "logarithmic"]
    panels = [own for _, own in points.assign(unit=points["unit"].fillna("")).groupby(keys, sort=False)]
    groups = _groups(points)
    columns = min(len(panels), 1 if size == "one column" else 3)
    rows = -(-len(panels) // columns)
    figure, all_axes = canvas(size, height_mm * rows, rows, columns)
    for axes in all_axes[len(panels) :]:
        axes.set_visible(False)
    for axes, own in zip(all_axes, panels):
        names = list(dict.fromkeys(own["procedure"]))
        for i, group in enumerate(groups):
            _people_and_mean(axes, own[own["group"].fillna("") == group], names, i, len(groups))
        axes.set_xticks(range(len(names)), [str(name) for name in names])
        axes.set_xlim(-0.5, len(names) - 0.5)
        fit_names(axes, WIDTHS[size] / columns)
        if bool(own["logarithmic"].iloc[0]):
            axes.set_yscale("log")
            _log_ticks(axes.yaxis, *axes.get_ylim())
        what = {"threshold_share": "threshold: ", "mean_of_reversals": "mean of reversals: "}.get(own["measure"].iloc[0], "")
        axes.set_ylabel(wrapped(what + _quantity(own), 30))
    if len(groups) > 1:
        marks = _group_marks(groups)
        legend_above(figure, [handle for _, handle in marks], [name for name, _ in marks])
    return figure


def _people_and_mean(axes: Axes, own: pd.DataFrame, names: list[str], i: int, groups: int) -> None:
    """Draws a group's people as dots, joined over procedures, and their means beside them."""
    hue, marker = COLOURS[i % len(COLOURS)], MARKERS[i % len(MARKERS)]
    step = 0.8 / (groups + 1)
    aside = (i - (groups - 1) / 2) * step
    places = {name: place + aside for place, name in enumerate(names)}
    people = own[own["of"] == "person"]
    opacity = faint(people["person"].nunique())
    for _, each in people.groupby("person", sort=False):
        each = each.assign(at=each["procedure"].map(places)).sort_values("at")
        joined = groups == 1 and len(each) > 1
        axes.plot(each["at"], each["value"], color=hue, alpha=opacity, linewidth=0.5 if joined else 0, marker="o", markersize=2.5)
    mean = own[own["of"] == "mean"]
    at = mean["procedure"].map(places) + 0.3 * step
    errors = np.array([(mean["value"] - mean["low"]).fillna(0), (mean["high"] - mean["value"]).fillna(0)])
    axes.errorbar(
        at, mean["value"], errors, color=hue, marker=marker, markersize=5, capsize=2, linestyle="", elinewidth=1.2, zorder=3
    )  # fmt: skip


# Courses of procedures

_COURSE = [*_PANEL, "group", "of", "person", "n", "answer", "trial_num", "level", "said_yes"]


@of_data
def procedure_courses(data: Data, *, procedures: list[str] | None = None) -> pd.DataFrame:
    """The levels that procedures chose, answer after answer.

    A row has its procedure, and `of`: "answer", with its number from 1, its trial, its level and whether it was yes;
    "reversal" of a staircase, if not ignored, at the last answer before the direction changed; "mean" level of n people
    at an answer, as long as all of them answer, three times at least (the geometric mean, where `logarithmic`);
    "threshold", of the fitted function or, of several people, the mean of theirs; those outside of the levels shown are
    left out. Procedures with constant levels have no course. Raises NotThere, or Error when there are no answers.

    >>> from dihaptic import figures
    >>> procedure_courses(figures.read(lift_session))
    Traceback (most recent call last):
    ...
    dihaptic.errors.Error: ...has no trials of a procedure. Name a session whose task has procedures.
    """
    rows: list[dict[str, Any]] = []
    for procedure in _chosen(data, procedures):
        answers = _answers(data, procedure)
        if answers.empty or procedure.kind in (_ALL, "constant"):
            continue
        head = procedure.panel()
        sessions = answers.groupby("person")["session"].nunique() if "session" in answers else pd.Series([1])
        keys = sitting_columns(answers)
        for _, own in answers.groupby(keys, sort=False):
            person = own["person"].iloc[0]
            person = f"{person}, {own['session'].iloc[0]}" if sessions.max() > 1 else person
            common = {**head, "group": own["group"].iloc[0], "person": person, "n": 1}
            columns = ["answer", "trial_num", "level", "said_yes"]
            rows += [{**common, "of": "answer", **row} for row in own[columns].to_dict("records")]
            for row in own.iloc[_reversals(own["level"], procedure)][columns].to_dict("records"):
                rows.append({**common, "of": "reversal", **row})
        fits = _fits(data, procedure)
        fits = fits[~fits["outside"].astype(bool)]
        for group, own in answers.groupby("group", sort=False):
            if not _is_single(data):
                rows += [{**head, "group": group, "of": "mean", **row} for row in _mean_course(own, procedure.logarithmic)]
            thresholds = fits[fits["group"] == group]
            if len(thresholds):
                mean = _mean(thresholds.groupby("person")["threshold_share"].mean(), procedure.logarithmic)
                rows.append({**head, "group": group, "of": "threshold", "n": mean["n"], "level": mean["value"]})
    return _finished(rows, _COURSE, procedures)


def _reversals(levels: pd.Series, procedure: _Procedure) -> list[int]:
    """Indices of the answers after which a staircase changed its direction, without the first ones, which are ignored."""
    out: list[int] = []
    way = 0
    if procedure.kind != "staircase":
        return out
    for i, step in enumerate(np.diff(levels), start=1):
        now = int(np.sign(step))
        if now:
            if way * now < 0:
                out.append(i - 1)
            way = now
    return out[procedure.skipped :]


def _mean_course(answers: pd.DataFrame, logarithmic: bool) -> Iterator[dict[str, Any]]:
    """The mean level of all people at each answer, up to the last answer that all of them gave."""
    keys = sitting_columns(answers)
    last = answers.groupby(keys)["answer"].max().min()
    if answers.groupby(keys).ngroups < 2 or last < 3:
        return
    for number, own in answers[answers["answer"] <= last].groupby("answer"):
        mean = _mean(own["level"], logarithmic)
        yield {"answer": number, "n": mean["n"], "level": mean["value"]}


@drawing
def draw_procedure_courses(points: pd.DataFrame, *, size: str = "one column", height_mm: float = 45) -> Figure:
    """Draws procedure_courses(): a panel for each procedure. For one person, yes is filled, no is hollow, reversals are ringed.

    `height_mm` is the height of a row of panels.

    >>> import pandas as pd
    >>> row = {"procedure": "up", "kind": "staircase", "quantity": "width", "unit": "mm", "logarithmic": False, "yes": "wider"}
    >>> row |= {"group": "", "of": "answer", "person": "p", "said_yes": True}
    >>> answers = [{**row, "answer": i, "level": 9 - i} for i in (1, 2)]
    >>> draw_procedure_courses(pd.DataFrame(answers)).axes[0].get_ylabel()
    'width [mm]'
    """
    points = points.reindex(columns=list(dict.fromkeys([*_COURSE, *points.columns])))
    groups = _groups(points)
    several = points.loc[points["of"] == "answer", "person"].nunique() > 1
    figure, panels = _panels(points, size, height_mm)
    for axes, own in panels:
        for i, group in enumerate(groups):
            _course(axes, own[own["group"].fillna("") == group], i, several)
        axes.xaxis.set_major_locator(MaxNLocator(5, integer=True, steps=[1, 2, 5, 10]))
    last = points["answer"].max()
    for axes, _ in panels:
        axes.set_xlim(1 - 0.04 * last, last + 0.04 * last)
    _level_axes(panels, "y")
    _label_all(panels, x="answer", y=None, size=size)
    legend_above(figure, *_legend_of_courses(points, groups, several))
    return figure


def _course(axes: Axes, own: pd.DataFrame, i: int, several: bool) -> None:
    """Draws the courses of one group's people, or of one person."""
    hue = COLOURS[i % len(COLOURS)]
    answers = own[own["of"] == "answer"]
    opacity = faint(answers["person"].nunique()) if several else 0.8
    for _, each in answers.groupby("person", sort=False):
        line = {"linewidth": 0.5 if several else 0.7, "alpha": opacity}
        axes.plot(each["answer"], each["level"], color=hue, zorder=1, **line)
    if not several and len(answers):
        for said, face in ((True, hue), (False, "white")):
            some = answers[answers["said_yes"].map(_is_yes) == said]
            axes.plot(
                some["answer"], some["level"], linewidth=0, marker="o", markersize=3.2, markerfacecolor=face,
                markeredgecolor=hue, markeredgewidth=0.7, zorder=2,
            )  # fmt: skip
        turns = own[own["of"] == "reversal"]
        axes.plot(
            turns["answer"], turns["level"], linewidth=0, marker="o", markersize=6.5, markerfacecolor="none",
            markeredgecolor=COLOURS[1], markeredgewidth=0.9, zorder=3,
        )  # fmt: skip
    mean = own[own["of"] == "mean"]
    axes.plot(mean["answer"], mean["level"], color=hue, linewidth=1.4, linestyle=_LINES[i % len(_LINES)], zorder=3)
    for value in own.loc[own["of"] == "threshold", "level"]:
        axes.axhline(value, color="black" if i == 0 else hue, linewidth=0.8, linestyle="--", zorder=0)


def _legend_of_courses(points: pd.DataFrame, groups: list[str], several: bool) -> tuple[list[Any], list[str]]:
    hue = COLOURS[0] if len(groups) == 1 else QUIET
    out = _group_marks(groups, marked=False)
    kinds = set(points["of"])
    if several:
        out.append(("person", Line2D([], [], color=hue, linewidth=0.5, alpha=0.6)))
        if "mean" in kinds:
            out.append(("mean", Line2D([], [], color=hue, linewidth=1.4)))
    else:
        answers = list(dict.fromkeys(points["yes"]))
        yes, no = (f'"{answers[0]}"', "other answer") if len(answers) == 1 else ("yes", "no")
        out.append((yes, Line2D([], [], color=hue, marker="o", linewidth=0)))
        out.append((no, Line2D([], [], color=hue, marker="o", linewidth=0, markerfacecolor="white")))
    if "reversal" in kinds and not several:
        ring = {"marker": "o", "linewidth": 0, "markersize": 6.5, "markerfacecolor": "none"}
        out.append(("reversal", Line2D([], [], color=COLOURS[1], **ring)))
    if "threshold" in kinds:
        out.append(("mean threshold" if several else "threshold", Line2D([], [], color="black", linewidth=0.8, linestyle="--")))
    return [handle for _, handle in out], [name for name, _ in out]


# Binary answers without a procedure

_SHARE = ["series", "of", "person", "n", "x", "value", "low", "high"]
_SIDES = {-1: "left", 1: "right"}


@of_data
def answers_by_level(
    data: Data, *, x: str, answer: str, other: str, series: list[str] | None = None, side: str = ""
) -> pd.DataFrame:
    """The share of one of two outcomes at each level of a numeric column, in trials without a procedure.

    `x`, and the columns `series`, whose levels are distinguished, are columns of trials.csv; `answer` is the outcome
    whose share `value` is, out of n trials that had it or `other`. `side` is a column that tells on which side the
    comparison was (left or -1, right or 1); `answer` and `other` are then the outcomes that name the left and the right
    side, and the share is that of answers that name the comparison. A row is `of` "person", with Wilson's 95 % interval
    if there is only one person; or "mean" over n people, with its 95 % interval (Student's t). Practice, catch trials
    and all but the last attempt at a trial are left out. Raises NotThere, or Error when there are no such outcomes.

    >>> from dihaptic import figures
    >>> points = answers_by_level(figures.read(lift_session), x="trial_num", answer="done", other="dropped")
    >>> points[["of", "n", "x", "value"]].values.tolist()
    [['person', 1, 1.0, 1.0]]
    """
    trials = counting_trials(data)
    for column in [x, *(series or []), *([side] if side else [])]:
        data.measure(column)  # raises NotThere for an unknown name
    own = trials[trials["outcome"].isin([answer, other]) & trials[x].notna()].copy()
    if "procedure" in own:
        own = own[own["procedure"].isna()]
    if own.empty:
        raise error("has no such outcomes in the included trials", "Name two outcomes of its task.", key=f"{answer}, {other}")
    own["hit"] = (own["outcome"] == answer).astype(float)
    if side:
        own["hit"] = ((own["outcome"] == answer) == (own[side].map(_side) == "left")).astype(float)
        own = own[own[side].map(_side) != ""]
    own["x"] = own[x].astype(float)
    own["series"] = _series(own, series or [], data)
    each = own.groupby(["series", "x", "person"], sort=False)["hit"].agg(value="mean", n="count", yes="sum").reset_index()
    each["of"] = "person"
    single = own["person"].nunique() == 1
    if single:
        each["low"], each["high"] = wilson(each["yes"], each["n"])
        out = each
    else:
        out = pd.concat([each, means_with_intervals(each, ["series", "x"], sort=False)], ignore_index=True)
    order = {name: place for place, name in enumerate(_order_of_series(own, series or [], data))}
    return (
        out.assign(place=out["series"].map(order)).sort_values(["place", "of", "x", "person"], kind="stable")
        .reindex(columns=_SHARE).reset_index(drop=True)
    )  # fmt: skip


def _side(value: Any) -> str:
    """The side that a level stands for."""
    return _SIDES.get(value, "") if not isinstance(value, str) else value if value in _SIDES.values() else ""


def _name_of(values: tuple[Any, ...], columns: list[str], units: dict[str, str]) -> str:
    """ "both, trembling": a level of each column; a number has the column's name, since alone it would say nothing."""
    words = []
    for column, value in zip(columns, values):
        if column == "perturbation" and not isinstance(value, str):
            words.append("" if len(columns) > 1 else "no perturbation")
        elif isinstance(value, str) or pd.isna(value):
            words.append(level(value))
        else:
            unit = units.get(column, "")
            words.append(f"{words_of(column, unit)} {level(value, unit)}")
    return ", ".join(word for word in words if word)


def _series(own: pd.DataFrame, columns: list[str], data: Data) -> list[str]:
    """The name of the series that each trial belongs to."""
    units = own.attrs.get("units", {}) or data.table("trials").attrs.get("units", {})
    if not columns:
        return [""] * len(own)
    return [_name_of(values, columns, units) for values in own[columns].itertuples(index=False, name=None)]


def _order_of_series(own: pd.DataFrame, columns: list[str], data: Data) -> list[str]:
    """Names of series, in the order of the levels of their columns; series without a perturbation come first."""
    if not columns:
        return [""]
    units = data.table("trials").attrs.get("units", {})
    ranks = {column: {value: i for i, value in enumerate(data.levels(column))} for column in columns}
    found = set(own[columns].itertuples(index=False, name=None))
    ordered = sorted(found, key=lambda values: [ranks[column].get(value, -1) for column, value in zip(columns, values)])
    return list(dict.fromkeys(_name_of(values, columns, units) for values in ordered))


@drawing
def draw_answers(
    points: pd.DataFrame, *, xlabel: str, ylabel: str, title: str = "", size: str = "one column", height_mm: float = 65,
) -> Figure:  # fmt: skip
    """Draws answers_by_level(): shares against levels, with a colour for each series.

    `xlabel`, `ylabel`: labels of the axes; `title`: that of the legend.

    >>> from dihaptic import figures
    >>> points = figures.answers_by_level(figures.read(lift_session), x="trial_num", answer="done", other="dropped")
    >>> len(figures.draw_answers(points, xlabel="trial", ylabel="share done").axes)
    1
    """
    figure, (axes,) = canvas(size, height_mm)
    points = points.assign(series=points["series"].fillna(""))
    names = list(dict.fromkeys(points["series"]))
    levels = sorted(points["x"].unique())
    step = min(np.diff(levels)) if len(levels) > 1 else 1.0
    axes.axhline(0.5, color=QUIET, linewidth=0.6, linestyle=":", zorder=0)
    for i, name in enumerate(names):
        own = points[points["series"] == name]
        aside = (i - (len(names) - 1) / 2) * min(0.1, 0.5 / len(names)) * step
        _shares_of_series(axes, own, aside, i)
    if len(levels) <= 8:
        axes.set_xticks(levels, [f"{value:g}" for value in levels])
    axes.set_xlim(levels[0] - 0.4 * step, levels[-1] + 0.4 * step)
    axes.set_ylim(-0.05, 1.05)
    axes.set_xlabel(wrapped(xlabel, 40))
    axes.set_ylabel(wrapped(ylabel, 32))
    if len(names) > 1:
        handles = [
            Line2D([], [], color=COLOURS[i % 7], marker=MARKERS[i % 7], linestyle=_LINES[i % 7]) for i in range(len(names))
        ]  # fmt: skip
        legend_above(figure, handles, names, title)
    return figure


def _shares_of_series(axes: Axes, own: pd.DataFrame, aside: float, i: int) -> None:
    """Draws people as dots, and means with intervals; for one person, shares with intervals."""
    hue, marker = COLOURS[i % len(COLOURS)], MARKERS[i % len(MARKERS)]
    people = own[own["of"] == "person"]
    mean = own[own["of"] == "mean"]
    if len(mean):
        opacity = faint(people["person"].nunique())
        for _, each in people.groupby("person", sort=False):
            each = each.sort_values("x")
            axes.plot(each["x"] + aside, each["value"], color=hue, alpha=opacity, lw=0.4, marker=".", ms=3, zorder=1)
    shown = (mean if len(mean) else people).sort_values("x")
    # a share lies between 0 and 1, whatever Student's distribution suggests
    low, high = shown["low"].clip(lower=0), shown["high"].clip(upper=1)
    errors = [(shown["value"] - low).fillna(0).clip(lower=0), (high - shown["value"]).fillna(0).clip(lower=0)]
    axes.errorbar(
        shown["x"] + aside, shown["value"], np.array(errors), color=hue, marker=marker, linestyle=_LINES[i % len(_LINES)],
        markersize=4.5, capsize=2, elinewidth=0.9, zorder=3,
    )  # fmt: skip


# Which figures a design calls for


def plans(data: Data) -> Iterator[Plan]:
    """Figures of the task's procedures or, if it has none, of binary answers by a numeric factor."""
    procedures = [each for each in _procedures(data) if len(_answers(data, each))]
    if procedures:
        yield from _plans_of_functions(data, procedures)
        yield from _plans_of_thresholds(data, procedures)
        yield from _plans_of_courses(data, procedures)
    yield from plan_of_answers(data)


def _parted(name: str, procedures: list[_Procedure]) -> Iterator[tuple[str, list[_Procedure]]]:
    """Names of figures, with the procedures of each: as many as fit."""
    figures = -(-len(procedures) // _MOST_PANELS)
    each = -(-len(procedures) // max(1, figures))  # about as many in each
    for first in range(0, len(procedures), max(1, each)):
        number = f"-{first // each + 1}" if figures > 1 else ""
        yield name + number, procedures[first : first + each]


def _count(data: Data, procedures: list[_Procedure]) -> str:
    """The numbers of people and of their answers."""
    answers = [_answers(data, each) for each in procedures if each.kind != _ALL] or [_answers(data, each) for each in procedures]
    people = len({person for own in answers for person in own["person"]})
    return f"{counted(people, 'person', 'people')}, {counted(sum(map(len, answers)), 'answer')}"


def _outside(data: Data, procedures: list[_Procedure]) -> str:
    """A sentence about thresholds that are not drawn."""
    outside = sum(int(fits["outside"].sum()) for fits in (_fits(data, each) for each in procedures))
    if not outside:
        return ""
    verb = "is" if outside == 1 else "are"
    return f" {counted(outside, 'threshold lies', 'thresholds lie')} outside the levels shown, and {verb} left out."


def _options(panels: int) -> dict[str, Any]:
    return {"size": "two columns" if panels > 1 else "one column"}


def _plan_of(data: Data, name: str, title: str, what: str, some: list[_Procedure], points: Any, drawing: Any) -> Plan:
    """A figure with a panel for each of some procedures; `what` says what it shows."""
    return Plan(
        name=name,
        title=title,
        caption=f"{what} {_count(data, some)}.{_outside(data, some)}",
        points=points,
        points_options={"procedures": [each.title for each in some]},
        drawing=drawing,
        drawing_options=_options(len(some)),
    )


def _plans_of_functions(data: Data, procedures: list[_Procedure]) -> Iterator[Plan]:
    single = _is_single(data)
    drawn = procedures if single else [each for each in procedures if len(_fits(data, each))]
    for name, some in _parted("psychometric-functions", drawn):
        what = (_what_of_one if single else _what_of_several)(data, some)
        if len({each.yes for each in some}) > 1:
            what += ' Yes is ' + ', '.join(f'"{each.yes}"' for each in some) + ', in the order of panels.'
        yield _plan_of(
            data, name, "Psychometric functions", what, some, psychometric_functions, draw_psychometric_functions
        )  # fmt: skip


def _what_of_several(data: Data, procedures: list[_Procedure]) -> str:
    """The caption for psychometric functions of several people."""
    out = "Thin curves are the functions fitted to each person's answers (maximum likelihood), over the levels that the person "
    out += "was shown; dots are their thresholds"
    counts = _people_inside(data, procedures)
    if counts.empty:
        return f"{out}."
    cut = ", which are cut where they would leave the panel" if (counts > 1).any() else ""
    return f"{out}, and marks are means of thresholds{intervals(counts, BY_T)}{cut}."


def _people_inside(data: Data, procedures: list[_Procedure]) -> pd.Series:
    """How many people of each group have a threshold within the levels shown, for each procedure."""
    fits = [_fits(data, each).assign(procedure=each.title) for each in procedures]
    known = pd.concat([each[~each["outside"].astype(bool)] for each in fits if len(each)] or [pd.DataFrame()])
    return known.groupby(["procedure", "group"])["person"].nunique() if len(known) else pd.Series(dtype=int)


def _what_of_one(data: Data, procedures: list[_Procedure]) -> str:
    """The caption for one person's psychometric functions."""
    out = "The share of answers at each level; the area of a circle grows with their number"
    if _has_intervals(data, procedures):
        out += f", and a line is Wilson's 95 % interval from {_LEAST_ANSWERS} answers on"
    out += "."
    if any(len(_fits(data, each)) for each in procedures):
        out += " Curves are the fitted functions (maximum likelihood), marks their thresholds with 95 % profile intervals,"
        out += " which are cut where they would leave the panel."
    elif not data.has("thresholds"):
        out += " No function is drawn: the session has no report yet."
    return out


def _has_intervals(data: Data, procedures: list[_Procedure]) -> bool:
    return any(row["n"] >= _LEAST_ANSWERS for each in procedures for row in _shares(_answers(data, each), each))


def _plans_of_thresholds(data: Data, procedures: list[_Procedure]) -> Iterator[Plan]:
    if len(data.people) < 2 or not data.has("thresholds"):
        return
    words = {"threshold_share": ("thresholds", "Thresholds"), "weber_fraction": ("weber-fractions", "Weber fractions")}
    for measure, (name, title) in words.items():
        inside = {each.title: _fits(data, each) for each in procedures}
        drawn = [
            each for each in procedures
            if measure in inside[each.title] and (~inside[each.title]["outside"] & inside[each.title][measure].notna()).any()
        ]  # fmt: skip
        most = [inside[each.title][~inside[each.title]["outside"]]["person"].nunique() for each in drawn]
        if max(most, default=0) < 2:
            continue  # a dot and its own mean show nothing
        for part, some in _parted(name, drawn):
            kinds = {(each.quantity, each.unit, each.logarithmic) for each in some}
            quantities = len(kinds) if measure == "threshold_share" else 1
            joined = ", joined over procedures" * (len(some) > 1 and len(data.table("thresholds")["group"].unique()) == 1)
            geometric = " (geometric where the axis is logarithmic)" * any(each.logarithmic for each in some)
            yield Plan(
                name=part,
                title=f"{title} by procedure",
                caption=f"Dots are people{joined}; marks are means{geometric}{intervals(_people_inside(data, some), BY_T)}. "
                f"{_count(data, some)}.{_outside(data, procedures)}",
                points=thresholds_by_procedure,
                points_options={"measure": measure, "procedures": [each.title for each in some]},
                drawing=draw_thresholds,
                drawing_options=_options(max(quantities, 2 if len(some) > 3 else 1)),
            )


def _plans_of_courses(data: Data, procedures: list[_Procedure]) -> Iterator[Plan]:
    adaptive = [each for each in procedures if each.kind not in (_ALL, "constant")]
    for name, some in _parted("procedure-courses", adaptive):
        single = _is_single(data)
        fits = any((~_fits(data, each)["outside"].astype(bool)).any() for each in some)
        if single:
            what = f"Levels in the order of answers; filled: yes{_meaning(some)}, hollow: no."
            what += " Rings are reversals that are averaged." * any(each.kind == "staircase" for each in some)
            what += " Dashed: threshold of the fitted function." * fits
        else:
            what = "Levels in the order of answers, of each person (thin), and their mean as long as all people answer (thick)."
            what += " Dashed: mean of the thresholds of the fitted functions." * fits
        yield _plan_of(data, name, "Courses of the procedures", what, some, procedure_courses, draw_procedure_courses)


def _meaning(procedures: list[_Procedure]) -> str:
    """The meaning of yes, if it is the same in all procedures."""
    words = {each.yes for each in procedures}
    return f' ("{words.pop()}")' if len(words) == 1 else ""


def plan_of_answers(data: Data) -> Iterator[Plan]:
    """The figure of binary answers by a numeric factor, for trials without a procedure."""
    trials = counting_trials(data)
    if "outcome" not in trials or "condition" not in trials:
        return
    trials = trials[trials["procedure"].isna()] if "procedure" in trials else trials
    trials = trials[~trials["outcome"].isin(_not_counted(data.task))]
    frequent = _two_outcomes(data, trials)
    numeric = [name for name in data.factors if pd.api.types.is_numeric_dtype(trials[name]) and trials[name].nunique() > 2]
    if not frequent or not numeric:
        return
    x = max(numeric, key=lambda name: int(trials[name].nunique()))
    counting = trials[trials["outcome"].isin(frequent) & trials[x].notna()]
    if counting["outcome"].nunique() < 2 or counting[x].nunique() < 3:
        return
    series, averaged = _series_of(data, counting, x)
    side = _side_column(counting, frequent)
    answer, other = sorted(frequent, key=lambda name: "left" not in name.split()) if side else frequent
    unit = data.table("trials").attrs.get("units", {}).get(x, "")
    options = {"x": x, "answer": answer, "other": other}
    what = 'share of "comparison"' if side else f'share of "{answer}"'
    yield Plan(
        name=f"answers-by-{x}".replace("_", "-"),
        title=f"Answers by {words_of(x, unit)}",
        caption=_caption_of_answers(counting, x, len(trials) - len(counting), averaged, side),
        points=answers_by_level,
        points_options={**options, **({"series": series} if series else {}), **({"side": side} if side else {})},
        drawing=draw_answers,
        drawing_options={"xlabel": label(x, unit), "ylabel": what, **_options(1)},
    )


def _caption_of_answers(counting: pd.DataFrame, x: str, rest: int, averaged: list[str], side: str) -> str:
    """The caption of the figure of answers: what it shows of these trials, and what is left out."""
    people = counting["person"].nunique()
    out = "Shares of trials with Wilson's 95 % intervals."
    if people > 1:
        counts = counting.groupby(["group", x])["person"].nunique()
        out = f"Dots are people's shares, joined over levels; marks are means over people{intervals(counts, BY_T)}."
    if side:
        out += f" An answer names the comparison if it names the side on which that was (column {side} of trials.csv)."
    if averaged:
        out += f" Averaged over {' and '.join(averaged)}."
    out += " Dotted: half of the answers."
    out += f" {counted(people, 'person', 'people')}, {counted(len(counting), 'trial')}"
    out += "; practice, catch trials and repeated attempts"
    out += f", and {counted(rest, 'trial')} with other outcomes," if rest else ""
    return f"{out} are left out."


def _exits(of: Any) -> Iterator[dict[str, Any]]:
    """All exits of a task's states that end a trial, in the order of the task."""
    if isinstance(of, dict):
        if "outcome" in of and "when" in of:
            yield of
        for value in of.values():
            yield from _exits(value)
    elif isinstance(of, list):
        for value in of:
            yield from _exits(value)


def _not_counted(task: dict[str, Any]) -> set[str]:
    """Outcomes after which a trial is repeated, and the outcome of interrupted trials."""
    return {str(exit["outcome"]) for exit in _exits(task) if exit.get("redo")} | {"interrupted"}


def _two_outcomes(data: Data, trials: pd.DataFrame) -> list[str]:
    """The two frequent outcomes, if there are exactly two: first the comparison, or else the one that the task names first."""
    shares = trials["outcome"].value_counts(normalize=True)
    frequent = [str(name) for name in shares.index if shares[name] >= _FREQUENT]
    if len(frequent) != 2:
        return []
    order = list(dict.fromkeys(str(exit["outcome"]) for exit in _exits(data.task)))
    places = {name: place for place, name in enumerate(order)}
    return sorted(frequent, key=lambda name: (not name.startswith("comparison"), places.get(name, len(order))))


def _side_column(trials: pd.DataFrame, outcomes: list[str]) -> str:
    """The column that tells on which side the comparison was, if answers name a side."""
    named = [{"left", "right"} & set(name.split()) for name in outcomes]
    if len(named[0]) != 1 or len(named[1]) != 1 or named[0] == named[1] or "side" not in trials:
        return ""
    sides = set(trials["side"].dropna().map(_side))
    return "side" if sides == {"left", "right"} else ""


def _series_of(data: Data, trials: pd.DataFrame, x: str) -> tuple[list[str], list[str]]:
    """Columns whose levels have colours of their own, and the factors, in words, over which shares are averaged."""
    rest = sorted((name for name in data.factors if name != x), key=lambda name: int(trials[name].nunique()))
    candidates = [name for name in rest if trials[name].nunique() > 1]
    if "perturbation" in trials and trials["perturbation"].fillna("").nunique() > 1:
        candidates.append("perturbation")
    if trials["group"].fillna("").nunique() > 1:
        candidates.insert(0, "group")
    chosen: list[str] = []
    averaged = []
    for name in candidates:
        if len(trials[[*chosen, name]].drop_duplicates()) <= _MOST_COLOURS:
            chosen.append(name)
        else:
            averaged.append(words_of(name, data.table("trials").attrs.get("units", {}).get(name, "")))
    return chosen, averaged
