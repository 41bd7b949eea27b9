"""Makes report.html: the page of a session, of a rehearsal, of a study, or of a folder of sessions.

    dihaptic report rehearsals/grip-and-lift_1

The program makes the tables, and this package the page, from them and from the figures of dihaptic.figures, which are saved
beside it. `python3 -m dihaptic.reports FOLDER` makes only the page, from existing tables; this also works on a
computer without the program. To change the page for your laboratory, change sections.py; for a figure, change its script in
the folder figures, which is then kept.
"""

from __future__ import annotations

import os
import re
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

from .. import figures
from ..errors import Error, error
from ..figures.saving import write
from ..figures.sessions import Paths, Sample, Sittings
from .page import Page
from .sections import add_sample

#: The name of the page.
NAME = "report.html"


def write_page(
    paths: Paths, out: str | Path = "", told: dict[str, Any] | None = None, *, jobs: int = 1,
    progress: Callable[[str], None] | None = None,
) -> Path:  # fmt: skip
    """Writes report.html, and the folder figures beside it, and returns the page.

    `paths`: a session's folder, a rehearsal's, a study's file, or a folder that contains sessions; or several of them,
    which are compared, and need a folder `out` for the page. `told` is what `dihaptic report` adds to the tables
    (src/analysis/report/report_json.cpp). Each experiment has a part of the page, and people and simulated people are kept
    apart. Figures are drawn in `jobs` processes. Raises Error.

    >>> from dihaptic.reports import write_page
    >>> write_page(lift_session).name
    'report.html'
    """
    told = told or {}
    sittings = Sittings(paths)
    found = sittings.samples
    several = not isinstance(paths, (str, Path)) and len(paths) > 1
    if several and not out:
        raise error("has no folder", "Name one for the page, with --out.", key="out")
    # choices that make no difference are not written into scripts
    every = [figures.Data(sittings, None, sample if len(found) > 1 else Sample(None, None, None)) for sample in found]
    folder = Path(os.path.abspath(out)) if out else every[0].folder
    titles = list(dict.fromkeys(data.title for data in every))
    of = {id(data): _told_of(data, told) for data in every}
    who = " ".join(dict.fromkeys(str(of[id(data)].get("who") or "") for data in every)).strip()
    if not who:
        who = "Simulated. No person took part." if all(data.is_simulated for data in every) else ""
    page = Page(titles[0] if len(titles) == 1 else f"{len(titles)} experiments", who, _origin(every, told))
    sessions = sum(len(data.sessions) for data in every)
    told_first = False
    for heading, texts in (
        (f"Changed since the session{'s' if sessions > 1 else ''} ended", told.get("changed")),
        ("Tables that could not be written", told.get("unwritten")),
        ("Of raw.log", told.get("faults")),
        ("Left out", told.get("left_out")),
        ("Not read", [text for text in every[0].left_out if "left_out" not in told or "it is a link" in text]),
    ):
        if texts:
            told_first = True
            page.heading(heading)
            for text in texts:
                page.text(str(text), "warning")
    if told_first and len(every) == 1:
        page.heading("Sessions" if sessions > 1 else "Session")
    if text := _groups_apart(every):
        page.text(text, "warning")
        warnings.warn(text, stacklevel=2)
    for data in every:
        if len(every) > 1:
            page.heading(str(data.sample) if len(found) > len(titles) else data.title, "part")
        try:
            add_sample(page, data, of[id(data)], _figures_of(folder, data, every), jobs=jobs, progress=progress)
        except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as why:
            if isinstance(why, Error):
                raise
            what = f"cannot be drawn: {type(why).__name__}: {why}"
            remedy = "If its tables are as the program wrote them, report this; or else restore them."
            raise error(what, remedy, file=str(data.folder)) from why
    return write(folder / NAME, page.html().encode(errors="replace"))


def _groups_apart(every: list[figures.Data]) -> str:
    """Says that groups of a study are not compared, because each has an experiment of its own; "" otherwise."""
    groups: dict[str, set[str]] = {}
    for data in every:
        for sitting in data.sittings:
            if sitting.study_session and sitting.group:
                groups.setdefault(sitting.study_session, set()).add(f"{sitting.group}: {data.title}")
    each = [sorted(group) for group in groups.values() if len(group) > 1]
    apart = [one for one in each if len({text.partition(": ")[0] for text in one}) == len(one) == len({t.partition(": ")[2] for t in one})]
    if not apart:
        return ""
    return (
        f"The groups of this study are not compared, because their experiments have different titles ({'; '.join(apart[0])}). "
        "If they are the same apart from what differs between the groups, give both files the same title before people take part."
    )


def _figures_of(folder: Path, data: figures.Data, every: list[figures.Data]) -> Path:
    """The folder of a sample's figures."""
    if len(every) == 1:
        return folder / "figures"
    alone = sum(one.title == data.title for one in every) == 1
    number = every.index(data) + 1  # a title may contain no Latin letter
    words = re.sub(r"[^a-z0-9]+", "-", (data.title if alone else str(data.sample)).lower()).strip("-")
    return folder / f"figures-{number}-{words[:60]}"


def _told_of(data: figures.Data, told: dict[str, Any]) -> dict[str, Any]:
    """The description of these sessions: that of the first sample with one of them, but with the `who` of all samples."""
    folders = {str(session.folder) for session in data.sessions}
    own = [each for each in told.get("samples") or [] if folders & {os.path.abspath(f) for f in each.get("folders") or []}]
    if not own:
        return {}
    who = " ".join(dict.fromkeys(str(each.get("who") or "") for each in own))
    return {**own[0], "who": who}


def _origin(every: list[figures.Data], told: dict[str, Any]) -> str:
    """The origin of the numbers on the page, in a sentence or two."""
    sessions = sum(len(data.sessions) for data in every)
    programs = sorted({str(session.info.get("program", "")) for data in every for session in data.sessions} - {""})
    where = ", ".join(dict.fromkeys(str(path) for data in every for path in data.paths))
    count = "One session" if sessions == 1 else f"{sessions} sessions"
    first = next(iter(every)).sessions[0].info
    one = [f"seed {first['seed']}", str(first.get("started") or "")] if sessions == 1 and first.get("seed") else []
    made = f" Made by {told['program']} with: {told['command']}" if told.get("command") else ""
    return f"{count} in {where}, recorded by {', '.join([*programs, *filter(None, one)])}.{made}"
