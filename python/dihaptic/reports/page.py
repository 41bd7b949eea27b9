"""Builds an HTML page that needs no other file: headings, sentences, tables, and figures as SVG."""

from __future__ import annotations

import json
import math
import re
from html import escape
from importlib import resources
from typing import Any

import pandas as pd

#: Points of a figure that take more than this [bytes] are in a file beside the page instead of on it.
_MOST_POINTS = 200_000
#: Maximum number of columns of a table that fits on paper.
_MOST_COLUMNS = 8


class Page:
    """A page, made from top to bottom. Texts are shown as they are, whatever they contain.

    >>> from dihaptic.reports.page import Page
    >>> page = Page("Grip & lift", "Simulated.", "Made by the program.")
    >>> page.heading("Trials")
    >>> page.text("1 < 2")
    >>> "<p>1 &lt; 2</p>" in page.html()
    True
    """

    def __init__(self, title: str, who: str, origin: str) -> None:
        self._head = [title, who, origin]
        self._body: list[str] = []
        self._headings: list[str] = []

    def heading(self, text: str, kind: str = "") -> None:
        """A heading, which is in the contents; `kind`: "part" for the title of a part of the page."""
        self._headings.append(text)
        self._body.append(f'<h2{_class(kind)} id="section-{len(self._headings)}">{escape(text)}</h2>')

    def add(self, other: Page) -> None:
        """Adds the content of another page, without its head."""
        self._body += other._body

    @property
    def is_empty(self) -> bool:
        """Whether the page has no content."""
        return not self._body

    def text(self, text: str, kind: str = "") -> None:
        """A paragraph; `kind` is a class of the style sheet."""
        # a warning may contain a command, whose minus is a hyphen
        self._body.append(f"<p{_class(kind)}>{escape(text if kind else with_minus_signs(text))}</p>")

    def table(self, table: pd.DataFrame, caption: str = "", *, folded: str = "", keys: int = 0) -> None:
        """A table with its header; numbers have three digits. With `folded`, only this title is visible at first. With
        `keys`, a table that is too wide for paper is split into pieces, each of which begins with this number of its
        columns."""
        if len(table) == 0:
            return
        rest = table.shape[1] - keys
        step = rest if not keys or table.shape[1] <= _MOST_COLUMNS else max(1, _MOST_COLUMNS - keys)
        pieces = [table.iloc[:, [*range(keys), *range(i, min(i + step, rest + keys))]] for i in range(keys, rest + keys, step)]
        text = "\n".join(
            f'<div class="wide"><table{_class("many" if piece.shape[1] > _MOST_COLUMNS else "")}>\n'
            f"{_header(piece)}{_rows(piece)}</table></div>"
            for piece in pieces
        )
        if caption:
            text += f'\n<p class="caption">{escape(caption)}</p>'
        self._body.append(f"<details><summary>{escape(folded)}</summary>\n{text}\n</details>" if folded else text)

    def facts(self, facts: dict[str, str]) -> None:
        """A table of names and values, without those that are empty."""
        rows = "".join(f"<tr><th>{escape(k)}</th><td>{escape(v)}</td></tr>\n" for k, v in facts.items() if v)
        self._body.append(f'<div class="wide"><table class="facts">\n{rows}</table></div>')

    def figure(self, svg: str, title: str, caption: str, base: str, points: str = "") -> None:
        """A figure. `base`: the path of its files from the page's, without their ends; `points`: the content of its CSV."""
        wide = _width_of(svg) > 120
        prefix = re.sub("[^A-Za-z0-9]+", "-", base) + "-"
        data = escape(points) if len(points) <= _MOST_POINTS else ""
        links = "".join(f' <a href="{escape(base)}.{end}">{name}</a>' for end, name in _BESIDE if not (data and end == "csv"))
        buttons = "".join(f'<button type="button" data-save="{kind}">{name}</button>' for kind, name in _BUTTONS)
        csv = f'<button type="button" data-save="csv">Save numbers</button><template>{data}</template>' if data else ""
        self._body.append(
            f'<figure class="{"wide" if wide else "narrow"}" data-name="{escape(base.rpartition("/")[2])}">'
            f'<div class="drawing">{_inline(svg, prefix, title)}</div>\n'
            f"<figcaption><b>{escape(title)}.</b> {escape(caption)}</figcaption>\n"
            f'<p class="saving">{buttons}{csv} <span>beside this page:{links}</span></p></figure>'
        )

    def viewer(self, data: dict[str, Any]) -> None:
        """The trials that can be looked at on the page (trials.py)."""
        text = json.dumps(data, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
        self._body.append(
            '<div class="viewer"><p><label>Trial <select></select></label> <button type="button">previous</button>'
            '<button type="button">next</button> <span></span></p><div></div>'
            f'<script type="application/json">{text}</script></div>'
        )

    def html(self) -> str:
        """The whole page."""
        title, who, origin = (escape(text) for text in self._head)
        contents = " ".join(f'<a href="#section-{i + 1}">{escape(text)}</a>' for i, text in enumerate(self._headings))
        body = "\n".join(self._body)
        return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>{title}</title>
<style>
{_asset("page.css")}</style>
</head>
<body>
<h1>{title}</h1>
<p class="who">{who}</p>
<p class="origin">{origin}</p>
<nav>{contents}</nav>
{body}
<script>
{_asset("page.js")}</script>
</body>
</html>
"""


#: Files beside the page, and what they are called.
_BESIDE = [("pdf", "PDF"), ("png", "PNG"), ("csv", "numbers"), ("py", "script")]
_BUTTONS = [("copy", "Copy"), ("svg", "Save SVG"), ("png", "Save PNG")]


def with_minus_signs(text: str) -> str:
    """A text whose negative numbers have a minus sign instead of a hyphen.

    >>> with_minus_signs("0.29 s (-135°), day-1, 3-4")
    '0.29 s (−135°), day-1, 3-4'
    """
    return re.sub(r"(?<![\w.)-])-(?=\d)", "\N{MINUS SIGN}", text)


def in_short(value: Any) -> str:
    """A cell in words: numbers with three digits and a minus sign, "-" for what is missing. A number as small as a rounding
    error becomes 0."""
    if isinstance(value, (bool, str)):
        return {True: "yes", False: "no"}.get(value, str(value)) if isinstance(value, bool) else value
    if value is None or pd.isna(value):
        return "-"
    return _three_digits(value).replace("-", "\N{MINUS SIGN}")


def _three_digits(value: float) -> str:
    if isinstance(value, int) or float(value).is_integer() and abs(value) < 1e6:
        return str(int(value))
    if abs(value) < 1e-6:
        return "0"
    digits = max(0, 2 - math.floor(math.log10(abs(value))))
    return f"{value:.{digits}f}" if 1e-3 <= abs(value) < 1e6 else f"{value:.2e}"


def between(low: Any, high: Any) -> str:
    """ "0.6 to 0.8": an interval in words, or "-"."""
    return "-" if pd.isna(low) or pd.isna(high) else f"{in_short(low)} to {in_short(high)}"


def with_interval(value: Any, low: Any, high: Any) -> str:
    """A number with its interval, if there is one."""
    known = not (pd.isna(low) or pd.isna(high)) and in_short(low) != in_short(high)
    return in_short(value) + (f" ({between(low, high)})" if known else "")


def without_empty(table: pd.DataFrame) -> pd.DataFrame:
    """The table without columns that are empty."""
    empty = [name for name in table if table[name].isna().all() or (table[name].astype(str) == "").all()]
    return table.drop(columns=empty)


def _class(kind: str) -> str:
    return f' class="{kind}"' if kind else ""


def _header(table: pd.DataFrame) -> str:
    meanings = table.attrs.get("meanings", {})
    cells = "".join(
        f'<th{_class("" if table[name].dtype == object else "number")}{_title(meanings.get(name, ""))}>{escape(with_minus_signs(str(name)))}</th>'
        for name in table
    )
    return f"<thead><tr>{cells}</tr></thead>\n"


def _title(meaning: str) -> str:
    return f' title="{escape(meaning)}"' if meaning else ""


def _rows(table: pd.DataFrame) -> str:
    numeric = [table[name].dtype != object for name in table]
    lines = []
    for row in table.itertuples(index=False, name=None):
        cells = (f"<td{_class('number' if n else '')}>{escape(in_short(v))}</td>" for v, n in zip(row, numeric))
        lines.append(f"<tr>{''.join(cells)}</tr>\n")
    return f"<tbody>\n{''.join(lines)}</tbody>\n"


def _width_of(svg: str) -> float:
    """The width of an SVG of matplotlib's [mm]."""
    found = re.search(r'<svg[^>]*\swidth="([\d.]+)pt"', svg)
    return float(found[1]) / 72 * 25.4 if found else 0.0


def _inline(svg: str, prefix: str, title: str) -> str:
    """An SVG that shares a page with others: names in it are its own."""
    svg = svg[svg.index("<svg") :]
    svg = re.sub(r"<metadata>.*?</metadata>", "", svg, flags=re.S)
    svg = re.sub(r'\b(id|xlink:href|href)="(#?)', rf'\1="\2{prefix}', svg).replace("url(#", f"url(#{prefix}")
    return svg.replace("<svg", f'<svg role="img" aria-label="{escape(title)}"', 1)


def _asset(name: str) -> str:
    return (resources.files(__package__) / name).read_text(encoding="utf-8")
