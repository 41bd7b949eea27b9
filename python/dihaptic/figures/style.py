"""The style of all figures: the widths of a journal's columns, typefaces, colours."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Callable
from functools import cache, wraps
from pathlib import Path
from typing import Any, TypeVar

import matplotlib
import numpy as np
from matplotlib import font_manager
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.textpath import TextPath

from ..charts import COLOURS as COLOURS  # the same colours
from ..errors import NotThere

#: The marker of each colour, so that figures can be read in black and white.
MARKERS = ["o", "s", "^", "D", "v", "P", "X"]
#: Widths of a figure [mm].
WIDTHS = {"one column": 89.0, "two columns": 183.0}
#: Colour of what is not data: reference lines, names of blocks.
QUIET = "#767676"

#: Fonts for letters that the typeface lacks, where they are installed; matplotlib brings DejaVu Sans.
_OTHER_FONTS = [
    "DejaVu Sans",
    "Noto Sans CJK JP", "Noto Sans CJK SC", "WenQuanYi Micro Hei", "IPAexGothic", "Droid Sans Fallback", "Microsoft YaHei",
    "Yu Gothic", "Malgun Gothic", "Hiragino Sans", "PingFang SC", "Apple SD Gothic Neo", "Noto Sans Devanagari", "Noto Sans Thai",
]  # fmt: skip

_RC = {
    "font.family": ["sans-serif"],
    # Journals ask for Arial or Helvetica. Liberation Sans has the same widths, so that an SVG looks alike on every system.
    "font.sans-serif": ["Liberation Sans", "Arial", "Helvetica", "DejaVu Sans"],
    "font.size": 7.0,
    "axes.titlesize": 8.0,
    "axes.labelsize": 8.0,
    "xtick.labelsize": 7.0,
    "ytick.labelsize": 7.0,
    "legend.fontsize": 7.0,
    "figure.titlesize": 9.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.6,
    "axes.axisbelow": True,
    "axes.titlelocation": "left",
    "axes.titley": 1.0,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "lines.linewidth": 1.2,
    "lines.markersize": 3.5,
    "legend.frameon": False,
    "legend.handlelength": 1.4,
    "axes.formatter.useoffset": False,
    "savefig.dpi": 300,
    "svg.fonttype": "none",  # text stays text: it can be searched and edited
    "svg.hashsalt": "dihaptic",  # the same figure gives the same file
    "pdf.fonttype": 42,
    "figure.facecolor": "none",
    "axes.facecolor": "none",
    "savefig.facecolor": "white",
}

_Function = TypeVar("_Function", bound=Callable[..., Any])


def styled(function: _Function) -> _Function:
    """Calls the function in the style of this package, whatever the caller's own style is."""

    @wraps(function)
    def call(*arguments: Any, **options: Any) -> Any:
        with matplotlib.rc_context():
            matplotlib.rcdefaults()
            matplotlib.rcParams.update(_RC)
            matplotlib.rcParams["font.family"] = _families()
            return function(*arguments, **options)

    return call  # type: ignore[return-value]


def of_data(function: _Function) -> _Function:
    """Notes in the table of points that a function makes of Data whether they are simulated, for drawing(). The same points are
    made once: captions and sentences need them, too."""

    @wraps(function)
    def call(data: Any, *arguments: Any, **options: Any) -> Any:
        made = data.__dict__.setdefault("_points", {})
        key = (function.__name__, repr(arguments), repr(sorted(options.items())))
        if key not in made:
            points = function(data, *arguments, **options)
            points.attrs["mark"] = data.mark
            made[key] = points
        return made[key].copy()

    return call  # type: ignore[return-value]


def drawing(function: _Function) -> _Function:
    """Draws a table of points in the style of this package, with the table's mark, if any, in the lower right corner."""

    @styled
    @wraps(function)
    def call(points: Any, *arguments: Any, **options: Any) -> Any:
        figure = function(points, *arguments, **options)
        if mark := points.attrs.get("mark", ""):
            share = 7 / (figure.get_figheight() * 72)
            engine = figure.get_layout_engine()
            left, bottom, width, height = engine.get()["rect"]
            engine.set(rect=(left, bottom + share, width, height - share))
            figure.text(0.995, 0.1 * share, mark, ha="right", va="bottom", fontsize=5, color=QUIET)
        return figure

    return call  # type: ignore[return-value]


@cache
def _families() -> list[str]:
    """The typeface, and those installed that have the letters of other scripts: each letter is in the first that has it."""
    # matplotlib keeps a list of fonts, and does not look for those that were installed later
    if all(font.name != "Liberation Sans" for font in font_manager.fontManager.ttflist):
        for file in sorted(Path("/usr/share/fonts/truetype").glob("liberation*/LiberationSans-*.ttf")):
            font_manager.fontManager.addfont(file)
    installed = {font.name for font in font_manager.fontManager.ttflist}
    return ["sans-serif", *(name for name in _OTHER_FONTS if name in installed)]


@styled
def canvas(
    size: str = "one column", height_mm: float = 65, rows: int = 1, columns: int = 1, **options: Any
) -> tuple[Figure, list[Axes]]:
    """An empty figure in the style of this package, and its panels from the upper left to the lower right.

    `size`: "one column" (89 mm wide) or "two columns" (183 mm); `options` go to matplotlib's Figure.subplots(), such as
    sharey=True. Raises NotThere for another size.

    >>> from dihaptic import figures
    >>> figure, (axes,) = figures.canvas("two columns", height_mm=50)
    >>> [round(25.4 * inches) for inches in figure.get_size_inches()]
    [183, 50]
    """
    if size not in WIDTHS:
        raise NotThere(size, "is not a size of figures", list(WIDTHS), "Sizes are " + " and ".join(WIDTHS) + ".")
    figure = Figure(figsize=(WIDTHS[size] / 25.4, height_mm / 25.4), layout="constrained")
    panels = list(figure.subplots(rows, columns, squeeze=False, **options).flat)
    for axes in panels:
        axes.set_title("")  # at the height of axes.titley: matplotlib would search for one each time that it draws
    return figure, panels


@cache
@styled
def letter_mm() -> float:
    """The width of a letter of 7 points in most words, which depends on the typeface that is installed."""
    text = "opposite field without measurement"
    path = TextPath((0, 0), text, size=7, prop=FontProperties(size=7))
    # the outermost points of letters are vertices; get_extents() would solve an equation for each curve
    width = np.ptp(path.vertices[path.codes != path.CLOSEPOLY, 0])
    return 1.06 * float(width) / len(text) / 72 * 25.4


def faint(curves: int) -> float:
    """The opacity of the marks of single people, fainter the more there are: together they show how people differ, and the
    means on top of them can still be seen.

    >>> from dihaptic.figures.style import faint
    >>> [round(faint(curves), 2) for curves in (1, 12, 48, 120)]
    [0.35, 0.35, 0.17, 0.11]
    """
    return 0.35 * math.sqrt(min(1.0, 12 / max(curves, 1)))


def wrapped(text: str, letters: int) -> str:
    """A label in lines of at most this many letters, as far as its words allow."""
    return "\n".join(textwrap.wrap(text, letters, break_long_words=False, break_on_hyphens=False))


def fit_names(axes: Axes, width_mm: float) -> None:
    """Writes the names below a panel of this width in several lines, or upright if a word does not fit."""
    names = [text.get_text() for text in axes.get_xticklabels()]
    letters = int((width_mm - 14) / max(1, len(names)) / letter_mm())  # about 14 mm of a panel's width are to the left of it
    if max(len(word) for name in names for word in name.split() or [""]) > letters:
        axes.tick_params(axis="x", labelrotation=90)
    else:
        axes.set_xticks(axes.get_xticks(), [wrapped(name, letters) for name in names])


def same_limits(panels: list[Axes]) -> None:
    """Gives panels the same vertical limits."""
    low, high = min(axes.get_ylim()[0] for axes in panels), max(axes.get_ylim()[1] for axes in panels)
    for axes in panels:
        axes.set_ylim(low, high)


def legend_above(figure: Figure, handles: list[Any], names: list[str], title: str = "") -> None:
    """Draws a legend above all panels, and makes space for it; must be called once the panels are complete."""
    # a letter is about 0.6 times as wide as it is high; the line before a name is about 4 letters wide
    width = figure.get_figwidth() * 72 / 7 / 0.6
    columns = max(1, min(len(names), int(width / (max(map(len, names)) + 6))))
    renderer = FigureCanvasAgg(figure).get_renderer()
    while True:
        lines = -(-len(names) // columns) + (1 if title else 0)
        share = (lines * 7 * 1.45 + 6) / (figure.get_figheight() * 72)
        figure.get_layout_engine().set(rect=(0, 0, 1, 1 - share))
        legend = figure.legend(handles, names, loc="upper center", ncols=columns, title=title or None, borderaxespad=0.2)
        if columns == 1 or legend.get_window_extent(renderer).width <= figure.bbox.width:
            return
        legend.remove()
        columns -= 1
