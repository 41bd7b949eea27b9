"""Saves a figure as SVG, PDF and PNG, with its points as CSV, and with the script that draws it."""

from __future__ import annotations

import errno
import io
import os
import re
import textwrap
import warnings
import zlib
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from ..errors import error
from .data import Data
from .style import styled

#: Formats of a saved figure.
FORMATS = ("svg", "pdf", "png")


@dataclass(frozen=True)
class Plan:
    """A figure to be drawn: the function that makes its table of points, and the function that draws it.

    `points` is called with the Data and its options, and gives a table with a row for each point; `drawing` is called
    with that table and its own options, and gives matplotlib's Figure.

    >>> from dihaptic import figures
    >>> options = {"measures": ["peak_grip_N"], "x": "trial_num", "table": "lifts"}
    >>> plan = figures.Plan("grip", "Grip", "", figures.means_by_condition, options, figures.draw_conditions, {"x": "trial_num"})
    >>> points, figure = plan.make(figures.read(lift_session))
    >>> len(points), len(figure.axes)
    (2, 1)
    """

    name: str  #: name of its files, e.g. "peak-grip-by-mass"
    title: str  #: the content, in a few words
    caption: str  #: a sentence or two: what is drawn, and the numbers of people and of trials
    points: Callable[..., pd.DataFrame]
    points_options: dict[str, Any] = field(default_factory=dict)
    drawing: Callable[..., Figure] = Figure
    drawing_options: dict[str, Any] = field(default_factory=dict)
    heading: str = ""  #: heading above it in a report; "": that of its kind

    def make(self, data: Data) -> tuple[pd.DataFrame, Figure]:
        """The points, and the figure drawn from them. Raises Error."""
        points = self.points(data, **self.points_options)
        return points, self.drawing(points, **self.drawing_options)

    def script(self, data: Data, folder: Path) -> str:
        """The Python script that draws this figure anew from `folder`."""
        caption = textwrap.fill(self.caption, 120)
        text = f'''"""{self.title}: draws {self.name}.svg, .pdf and .png, and writes {self.name}.csv.

{caption}
"""

from pathlib import Path

from dihaptic import figures

here = Path(__file__).resolve().parent
# The folder of the sessions. To draw some of the people: figures.read(..., people=["sim-001", "sim-002"])
data = {_reading(data, folder)}

# A pandas table with a row for each point, mean and interval that is drawn.
points = {_call(self.points, "data", self.points_options)}

# size: "one column" (89 mm) or "two columns" (183 mm) of a journal
figure = {_call(self.drawing, "points", self.drawing_options)}
# The panels are matplotlib's: figure.axes[0].set_ylim(0, 10)

figures.save(figure, here / "{self.name}", points)
'''
        return text + signed(text)


def signed(text: str) -> str:
    """The last line of a script, by which a changed script is recognised."""
    return f"# Checksum {zlib.crc32(text.encode()):08x}: a script that was changed is not written anew.\n"


def is_changed(script: Path) -> bool:
    """Whether the script exists, was made by Plan.script(), and has been changed by somebody."""
    if script.is_symlink():
        return True  # this package makes no links
    if not script.is_file():
        return False
    lines = script.read_text(encoding="utf-8", errors="replace").splitlines(keepends=True)
    # the words after the checksum may come from another version
    return not lines or lines[-1].split(":")[0] != signed("".join(lines[:-1])).split(":")[0]


def _reading(data: Data, folder: Path) -> str:
    """The call that reads these data, as written in a script that is in `folder`."""
    paths = []
    for path in data.paths:
        near = folder.is_relative_to(data.folder)
        up = Path(*[".."] * len(folder.relative_to(data.folder).parts)) if near else Path()
        within = near and path.is_relative_to(data.folder)
        paths.append(f'here / "{(up / path.relative_to(data.folder)).as_posix()}"' if within else repr(str(path)))
    options = "".join(f", {name}={value!r}" for name, value in data.choice.items() if value is not None)
    return f"figures.read({paths[0] if len(paths) == 1 else '[' + ', '.join(paths) + ']'}{options})"


def _call(function: Callable[..., Any], first: str, options: dict[str, Any]) -> str:
    """The call of one of this package's functions, as written in a script."""
    lines = "".join(f"    {key}={value!r},\n" for key, value in options.items())
    name = f"figures.{function.__name__}"
    return f"{name}(\n    {first},\n{lines})" if lines else f"{name}({first})"


@styled
def save(figure: Figure, file: str | Path, points: pd.DataFrame | None = None) -> list[Path]:
    """Saves a figure as FILE.svg, FILE.pdf and FILE.png (300 dots per inch), and its points as FILE.csv.

    If FILE ends in one of these, only that file is saved. Returns the files. The same figure always gives the same
    SVG, to the byte. Raises Error when a file cannot be written.

    >>> from dihaptic import figures
    >>> figure, (axes,) = figures.canvas()
    >>> lines = axes.plot([1, 2], [3, 4])
    >>> [path.name for path in figures.save(figure, f"{folder}/curve")]
    ['curve.svg', 'curve.pdf', 'curve.png']
    >>> [path.name for path in figures.save(figure, f"{folder}/curve.pdf")]
    ['curve.pdf']
    """
    base = Path(file)
    kinds: tuple[str, ...] = FORMATS
    if base.suffix[1:] in FORMATS:
        base, kinds = base.with_suffix(""), (base.suffix[1:],)
    # keeps the date and the versions of libraries out of the files
    metadata: dict[str, dict[str, Any]] = {
        "svg": {"Date": None, "Creator": None},
        "pdf": {"CreationDate": None, "Creator": None, "Producer": None},
        "png": {"Software": None},
    }
    # the usual compression of PNG takes a third longer, for files that are an eighth smaller
    options: dict[str, dict[str, Any]] = {"svg": {"transparent": True}, "pdf": {}, "png": {"pil_kwargs": {"compress_level": 3}}}
    engine = figure.get_layout_engine()
    drawn = {}
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        if engine is not None:
            # the layout is computed once, so that it is the same in all formats; with any engine, even "none", matplotlib
            # would draw the figure twice for each
            engine.execute(figure)
            figure.set_layout_engine(None)
        for kind in kinds:
            drawn[kind] = io.BytesIO()
            figure.savefig(drawn[kind], format=kind, metadata=metadata[kind], **options[kind])
        figure.set_layout_engine(engine)
    _tell(told, base.name)
    written = []
    for kind, whole in drawn.items():
        content = _with_steady_names(whole.getvalue()) if kind == "svg" else whole.getvalue()
        written.append(write(base.with_name(f"{base.name}.{kind}"), content))
    if points is not None:
        written.append(write(base.with_name(f"{base.name}.csv"), points.to_csv(index=False).encode()))
    return written


def _tell(told: list[warnings.WarningMessage], name: str) -> None:
    """Warns once of each letter that no font has, and passes on other warnings, also once."""
    missing: dict[str, None] = {}
    for each in {str(one.message): one for one in told}.values():
        if found := re.search(r"Glyph (\d+) .*missing", str(each.message)):
            missing[chr(int(found[1]))] = None
        else:
            warnings.warn_explicit(each.message, each.category, each.filename, each.lineno)
    if missing:
        what = f"{name}: no font of this computer has {''.join(missing)}, which PDF and PNG show as boxes"
        warnings.warn(f"{what}. Install one, such as Debian's fonts-noto-cjk, and draw again.", stacklevel=4)


def _with_steady_names(svg: bytes) -> bytes:
    """An SVG whose clipping paths are numbered: matplotlib names some by their address in memory, which differs each time."""
    for number, name in enumerate(dict.fromkeys(re.findall(rb'<clipPath id="(\w+)"', svg))):
        svg = svg.replace(name, b"clip%d" % number)
    return svg


def write(file: Path, content: bytes) -> Path:
    """Writes a file, after making its folder. A link with this name is replaced, and its target is left unchanged.
    Raises Error."""
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        if file.parent.name.startswith("figures") and file.parent.is_symlink():  # this package makes no links
            raise OSError(0, "its folder is a link to another one")
        new = file.with_name(f".unfinished-{os.getpid()}-{file.name}")
        new.unlink(missing_ok=True)
        try:
            with new.open("xb") as whole:
                whole.write(content)
            os.replace(new, file)
        except BaseException:
            new.unlink(missing_ok=True)
            raise
    except OSError as why:
        remedy = "Correct its permissions, remove whatever has its name, or name another folder."
        if why.errno == errno.ENOSPC:
            remedy = "Free some space, or name another folder."
        raise error(f"cannot be written: {why.strerror}", remedy, file=str(file)) from None
    return file
