"""The figure of a Power, and its page for a preregistration."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from .._facts import version
from ..errors import error
from ..figures.saving import is_changed, save, signed, write
from ..figures.style import COLOURS, QUIET, canvas, drawing, legend_above
from ..reports.page import Page
from ..reports.results import is_index, listed
from ..reports.simulated import limits_of

if TYPE_CHECKING:
    from .result import Power

#: Measures of rotations whose means and spreads over people were compared with those of real people (src/person/README.md).
_COMPARED = {"baseline", "early", "late", "clamp_first", "clamp_last", "compensation", "catch", "washout_first", "rebound"}
#: The share by which one person may change Cohen's d without being named.
_MOST_OF_ONE = 0.25
#: Cohen's d above which an effect within people is larger than those found in experiments.
_LARGE = 3
#: The width of the power's interval over pools above which the pool is called small.
_MOST_DOUBT = 0.2
#: Number of samples of each size for the curves, and about how many n they have.
_CURVE = 12
#: What a pool of one laboratory, and one of several, cannot show of laboratories.
_LABORATORIES = {
    False: "How laboratories differ. These people come from one laboratory, or from too few; groups of real people on one "
    "schedule differ by more than their people's scatter explains (docs/manual/explanation/simulated-people.md). The power "
    "of your laboratory may lie outside every interval here. Rehearse people of several (--laboratories).",
    True: "How laboratories differ, but for the traits that have between_laboratories in the population's file: in all others, "
    "and in how they instruct and select people, these laboratories are alike.",
}
_CAPTION_OF_LOOKS = (
    "The study is tested after these numbers of people, and ends at the first test whose p value is below the level. "
    "Then the share of samples that end here; the share that has found the effect by now; and the share that would have found one "
    "if there were none. Exaggeration: mean size of the estimates that find the effect here, over the true one."
)
#: What no pool of this program can show, whatever the experiment.
_NOT_KNOWN = [
    "Whether the true effect is as large as the one that is sought here. The intervals reflect only the numbers of samples "
    "and of simulated people, and not whether the model of people is right.",
    "Exclusions after the analysis was seen, and other choices that a preregistration is meant to prevent.",
]


def curve(result: Power) -> pd.DataFrame:
    """The points of the figure: the power against n for each spread of people, with its interval due to the number of draws."""
    from .result import SPREADS, WANTED

    last = max(result.n)
    for wanted in result.smallest["n"].dropna():
        last = max(last, min(int(wanted), 4 * max(result.n)))
    every = np.unique(np.concatenate([result.n, np.round(np.geomspace(result.fewest, last, _CURVE)).astype(int)]))
    rows = []
    for spread in SPREADS:
        for n in every:
            found = result.at(int(n), spread)
            own = {"value": found.power, "low": found.low, "high": found.high}
            rows.append({"of": "power", "spread": spread, "n": int(n), **own})
    rows += [{"of": "wanted", "value": wanted} for wanted in WANTED]
    points = pd.DataFrame(rows)
    points.attrs["mark"] = result.data.mark
    return points


@drawing
def draw_power(points: pd.DataFrame, *, xlabel: str = "people", size: str = "one column", height_mm: float = 65) -> Figure:
    """Draws curve(): the power of the pool with its interval, dashed lines for people who differ less and more."""
    figure, (axes,) = canvas(size, height_mm)
    lines = points[points["of"] == "power"]
    others = [spread for spread in lines["spread"].unique() if spread != 1]
    for spread, style in zip([1.0, *others], ("-", "--", ":")):
        own = lines[lines["spread"] == spread]
        words = "as simulated" if spread == 1 else f"spread of people times {spread:g}"
        axes.plot(own["n"], own["value"], style, color=COLOURS[0], lw=1.2 if spread == 1 else 0.8, label=words)
        if spread == 1:
            axes.fill_between(own["n"], own["low"], own["high"], color=COLOURS[0], alpha=0.2, linewidth=0)
    for wanted in points.loc[points["of"] == "wanted", "value"]:
        axes.axhline(wanted, color=QUIET, lw=0.5)
    axes.set(xlabel=xlabel, ylabel="power", ylim=(0, 1.02))
    legend_above(figure, *axes.get_legend_handles_labels())
    return figure


def _script(xlabel: str, mark: str) -> str:
    """The script that draws the figure anew from power.csv."""
    text = f'''"""Power against the number of people: draws power.svg, .pdf and .png from power.csv."""

from pathlib import Path

import pandas as pd

from dihaptic import figures
from dihaptic.power_analysis.page import draw_power

here = Path(__file__).resolve().parent
points = pd.read_csv(here / "power.csv")
points.attrs["mark"] = {mark!r}  # in the figure's corner

# size: "one column" (89 mm) or "two columns" (183 mm) of a journal
figure = draw_power(points, xlabel={xlabel!r}, size="one column")
# The panels are matplotlib's: figure.axes[0].set_ylim(0, 1)

figures.save(figure, here / "power", points)
'''
    return text + signed(text)


def write_page(result: Power, folder: Path) -> Path:
    """Writes the page, its figure and its tables into a folder."""
    who = "people"
    if result.effect.is_between:
        who += " in each group" if result.ratio == 1 else f" of group {result.effect.groups[0]}"
    points = curve(result)
    xlabel = f"{who} who are recruited" if result.attrition else who
    if (folder / "rehearsal.yaml").exists():
        raise error("is the folder of a rehearsal", "Name another folder for the power.", file=str(folder))
    script = folder / "power.py"
    save(draw_power(points, xlabel=xlabel), folder / "power", points)
    if is_changed(script):
        warnings.warn(f"{script} has been changed, and is left as it is: run it to draw the figure your way", stacklevel=3)
    else:
        write(script, _script(xlabel, result.data.mark).encode())
    table = result.table
    write(folder / "power-by-n.csv", table.to_csv(index=False).encode())
    people = pd.concat([pd.DataFrame({"person": side.index, "group": group, "effect": side.to_numpy()})
                        for side, group in zip(result.sides, result.effect.groups or [""])])  # fmt: skip
    write(folder / "effect-of-people.csv", people.to_csv(index=False).encode())
    simulated = "Simulated. No person took part." if result.data.is_simulated else ""
    if result.looks is not None:
        write(folder / "power-by-look.csv", result.looks.to_csv(index=False).encode())
    page = Page(f"Power: {result.data.title}", simulated, f"Made by dihaptic {version()}.")
    page.heading("Result")
    page.text(result.in_words())
    for text in warnings_of(result):
        page.text(text, "warning")
    if result.looks is not None:
        page.heading("Looks")
        of_bayes = " The level is that at which the Bayes factor exceeds the one that is asked for." * (result.test == "bayes")
        page.table(_shown_looks(result, who), _CAPTION_OF_LOOKS + of_bayes, keys=1)
    page.heading("Power" if result.looks is None else "Power of a single test")
    svg = (folder / "power.svg").read_text(encoding="utf-8")
    caption = (
        f"Band: 95 % interval from {result.draws} samples of each size. Broken lines: if people differed less, or more, than "
        "those who were simulated."
    )
    page.figure(svg, "Power against the number of people", caption, "power", points.to_csv(index=False))
    caption = (
        "Power with its 95 % interval from the number of samples; its middle 95 % if the pool were other people of the "
        "population. Among significant estimates: the share with the wrong sign (type S), and their mean size over the true one "
        "(type M). Half width: of the confidence interval, the median. The next column gives the power if people's spread were 0.7 "
        "or 1.5 times as large."
        + " The last one gives the powers that half, and nine in ten, of further laboratories exceed." * ("laboratory_50" in result.table)
    )
    page.table(_shown(result, who), caption, keys=1)
    smallest = result.smallest.rename(columns={"n": "smallest n", "may_be": "upper end", "probably": "lower end"})
    smallest["power"] = [f"{100 * power:.0f} %" for power in smallest["power"]]
    caption = (
        "The smallest n with this power, and those at which the upper and the lower end of its interval from the number of "
        "samples reach it. The uncertainty due to the size of the pool is larger: see the column 'with other pools'."
    )
    page.table(smallest.astype(object).where(smallest.notna(), None), caption)
    page.heading("What these numbers cannot tell you")
    for text in [_LABORATORIES[result.spread_of_laboratories is not None], *_NOT_KNOWN]:
        page.text(text)
    return write(folder / "power.html", page.html().encode(errors="replace"))


def warnings_of(result: Power) -> list[str]:
    """Reasons not to use the power as it is."""
    table, everybody = result.table, len(result.data.people)
    out = limits_of(result.data)
    # in force channels, the same columns are another measure, which was not compared
    unknown = [name for name in result.effect.columns if name not in _COMPARED or is_index(result.data)]
    low, high = result.interval
    if low <= 0 <= high and result.smallest_effect is None:
        out.append(
            f"The pool cannot tell this effect from zero (95 % interval {low:.3g} to {high:.3g}): the power says nothing yet. "
            "Rehearse more people (--people), or give the smallest effect of interest (--smallest-effect)."
        )
    if (result.alternative == "greater" and result.sought < 0) or (result.alternative == "less" and result.sought > 0):
        out.append(
            f"The test looks for an effect {'above' if result.alternative == 'greater' else 'below'} zero, and the one that is "
            f"sought is {result.sought:.3g}: give the other --alternative, or turn the effect around."
        )
    if result.effect.has_fixed_value and result.smallest_effect is None:
        known = "differs from that of a group of real people by up to 9 degrees"
        if unknown:
            known = "has not been compared with that of real people"
        out.append(
            "The effect compares people with a fixed number. This requires the mean of simulated people to be right, not "
            f"only their differences; in this measure, their mean {known}."
        )
    out += [f"Left out: {why}." for why in result.data.left_out]
    out += _drivers(result) if result.smallest_effect is None else []
    if unknown and result.data.is_simulated:
        out.append(
            f"How much {listed(unknown)} varies over trials and over people has never been compared with real people. If "
            "simulated people vary too little, fewer people seem to be enough: read the power with people's spread times 1.5, or "
            "look up the spread in a published study."
        )
    if unknown and result.spread_of_laboratories is not None:
        out.append(
            "These laboratories differ only in the traits that have between_laboratories in the population's file. In the "
            f"program's own population, these are the rates of learning rotations: in {listed(unknown)} its laboratories are "
            "alike, and real ones may not be."
        )
    if abs(result.standardised) > _LARGE:
        out.append(
            f"An effect of {abs(result.standardised):.1f} standard deviations of people (Cohen's d) is larger than experiments "
            "find: simulated people are too much alike in this measure, and the power says nothing."
        )
    if not result.data.is_simulated and result.smallest_effect is None:
        out.append(
            "The pool consists of people who took part. The power of a study to find the effect in its own data says nothing "
            "beyond its p value; to plan another study, give its smallest effect of interest (--smallest-effect)."
        )
    if (table["untested"] > 0).any():
        worst = table.loc[table["untested"].idxmax()]
        out.append(
            f"Of the samples of {worst['n']:.0f}, {100 * worst['untested']:.2g} % have no test, because their people are all "
            "alike; they are treated as if they had not found the effect."
        )
    lost = everybody - sum(len(side) for side in result.sides)
    if lost and not (result.effect.is_between and len(set(result.data.table("trials")["group"])) > 2):
        out.append(f"For {lost} of {everybody} people in the pool the effect is not known; they are left out.")
    widest = table.loc[(table["pool_high"] - table["pool_low"]).idxmax()]
    if widest["pool_high"] - widest["pool_low"] > _MOST_DOUBT:
        out.append(
            f"The pool is small: with {everybody} other people of the population, the power of {widest['n']:.0f} would be "
            f"between {widest['pool_low']:.2f} and {widest['pool_high']:.2f}. Rehearse more people (--people)."
        )
    return out


def _drivers(result: Power) -> list[str]:
    """Names single people without whom the effect would be quite different."""
    out = []
    for side in result.sides:
        for person in side.index:
            rest = side.drop(person)
            if abs(rest.mean() / rest.std() - side.mean() / side.std()) > _MOST_OF_ONE * abs(side.mean() / side.std()):
                out.append(person)
    if not out or result.effect.is_between:
        return []
    return [
        f"Without {'any one of ' if len(out) > 1 else ''}{listed(out[:8])}, Cohen's d would change by more than "
        f"{100 * _MOST_OF_ONE:.0f} %: look at effect-of-people.csv, and at the trials of these people."
    ]


def _shown_looks(result: Power, who: str) -> pd.DataFrame:
    """The table of looks at the data."""
    looks = result.looks
    assert looks is not None
    columns: dict[str, object] = {who: looks["n"], "level": [f"{level:.2g}" for level in looks["level"]]}
    for name, words in (("ends", "ends here"), ("found", "effect found"), ("for_none", "no effect found")):
        columns[words] = [f"{share:.2f}" for share in looks[name]]
    if result.test != "bayes":
        del columns["no effect found"]
    columns["found without one"] = [f"{share:.3f}" for share in looks["false_alarm"]]
    return pd.DataFrame({**columns, "exaggeration": looks["exaggeration"]})


def _shown(result: Power, who: str) -> pd.DataFrame:
    """The table of the page."""
    table = result.table
    columns: dict[str, object] = {who: table["n"]}
    if result.effect.is_between and result.ratio != 1:
        columns[f"of group {result.effect.groups[1]}"] = [round(result.ratio * n) for n in table["n"]]
    if result.attrition:
        columns["analysed"] = table["analysed"]
    columns["power"] = [f"{row.power:.2f} ({row.low:.2f} to {row.high:.2f})" for row in table.itertuples()]
    columns["with other pools"] = [f"{row.pool_low:.2f} to {row.pool_high:.2f}" for row in table.itertuples()]
    if "for_none" in table:
        columns["no effect found"] = [f"{share:.2f}" for share in table["for_none"]]
    columns |= {name.replace("_", " "): table[name] for name in ("wrong_sign", "exaggeration", "half_width")}
    spreads = zip(table["spread_0.7"], table["spread_1.5"])
    columns["spread x 0.7, x 1.5"] = [f"{less:.2f}, {more:.2f}" for less, more in spreads]
    if "laboratory_50" in table:
        both = zip(table["laboratory_50"], table["laboratory_10"])
        columns["laboratories: half, nine in ten"] = [f"{half:.2f}, {most:.2f}" for half, most in both]
    return pd.DataFrame(columns)
