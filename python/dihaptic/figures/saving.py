"""Saves a figure as SVG, PDF and PNG, with its points as CSV, and with the script that draws it."""

from __future__ import annotations

import io
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from .data import Data
from .style import styled

#: Formats of a saved figure.
FORMATS = ("svg", "pdf", "png")


@dataclass(frozen=True)
class Plan:
    """A figure that is to be drawn: which table of points, and how it is drawn.

    `points` is called with the Data and its options, and gives a table with a row for each point; `drawing` is called
    with that table and its own options, and gives matplotlib's Figure.

    >>> from dihaptic import figures
    >>> options = {"measures": ["peak_grip_N"], "x": "trial_num", "table": "lifts"}
    >>> plan = figures.Plan("grip", "Grip", "", figures.means_by_condition, options, figures.draw_conditions, {"x": "trial_num"})
    >>> points, figure = plan.make(figures.read(lift_session))
    >>> len(points), len(figure.axes)
    (2, 1)
    """

    name: str  #: of its files, e.g. "peak-grip-by-mass"
    title: str  #: what it shows, in a few words
    caption: str  #: a sentence or two: what is drawn, n of people and of trials
    points: Callable[..., pd.DataFrame]
    points_options: dict[str, Any] = field(default_factory=dict)
    drawing: Callable[..., Figure] = Figure
    drawing_options: dict[str, Any] = field(default_factory=dict)

    def make(self, data: Data) -> tuple[pd.DataFrame, Figure]:
        """Its points, and the figure. Raises Error."""
        points = self.points(data, **self.points_options)
        return points, self.drawing(points, **self.drawing_options)

    def script(self, data: Data, folder: Path) -> str:
        """The Python script that draws this figure anew, to be kept in `folder`."""
        up = Path("..") if folder.parent == data.folder else data.folder
        source = f'here / "{up.as_posix()}"' if not up.is_absolute() else repr(str(up))
        if data.path.is_file():
            source = f'here / "{(up / data.path.name).as_posix()}"' if not up.is_absolute() else repr(str(data.path))
        return f'''"""{self.title}: draws {self.name}.svg, .pdf and .png, and writes {self.name}.csv."""

from pathlib import Path

from dihaptic import figures

here = Path(__file__).resolve().parent
data = figures.read({source})

# A pandas table with a row for each point that is drawn; leave out rows or add columns here.
points = {_call(self.points, "data", self.points_options)}

# size: "one column" (89 mm) or "two columns" (183 mm) of a journal
figure = {_call(self.drawing, "points", self.drawing_options)}
# The panels are matplotlib's: figure.axes[0].set_ylim(0, 10)

figures.save(figure, here / "{self.name}", points)
'''


def _call(function: Callable[..., Any], first: str, options: dict[str, Any]) -> str:
    """The call of one of this package's functions, as it is written in a script."""
    lines = "".join(f"    {key}={value!r},\n" for key, value in options.items())
    name = f"figures.{function.__name__}"
    return f"{name}(\n    {first},\n{lines})" if lines else f"{name}({first})"


@styled
def save(figure: Figure, file: str | Path, points: pd.DataFrame | None = None) -> list[Path]:
    """Saves a figure as FILE.svg, FILE.pdf and FILE.png (300 dots per inch), and its points as FILE.csv.

    Returns the files. The same figure always gives the same SVG, to the byte.

    >>> from dihaptic import figures
    >>> figure, (axes,) = figures.canvas()
    >>> lines = axes.plot([1, 2], [3, 4])
    >>> [path.name for path in figures.save(figure, f"{folder}/curve")]
    ['curve.svg', 'curve.pdf', 'curve.png']
    """
    base = Path(file)
    base.parent.mkdir(parents=True, exist_ok=True)
    written = []
    for kind in FORMATS:
        # neither the date nor the version of a library is in a file
        metadata: dict[str, Any] = {
            "svg": {"Date": None, "Creator": None},
            "pdf": {"CreationDate": None, "Creator": None, "Producer": None},
            "png": {"Software": None},
        }[kind]
        whole = io.BytesIO()
        figure.savefig(whole, format=kind, metadata=metadata, **({"transparent": True} if kind == "svg" else {}))
        path = base.with_name(f"{base.name}.{kind}")
        path.write_bytes(whole.getvalue())
        written.append(path)
    if points is not None:
        path = base.with_name(f"{base.name}.csv")
        path.write_text(points.to_csv(index=False), encoding="utf-8")
        written.append(path)
    return written
