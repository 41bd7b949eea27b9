"""`python3 -m dihaptic.reports PATH...`: see main()."""

from __future__ import annotations

import json
import os
import sys
from typing import Any

from ..errors import Error, interruptible, shorten_warnings, tell
from . import write_page

_HELP = """Make report.html and its figures from the tables that are there
Usage: python3 -m dihaptic.reports SESSION|REHEARSAL|STUDY.yaml|FOLDER

dihaptic report first makes the tables, and then calls this with a description on the standard input.

Example:
  python3 -m dihaptic.reports rehearsals/grip-and-lift_1"""


def main(words: list[str]) -> int:
    """Makes a page, whose description in JSON the program may give on the standard input."""
    if not words or words[0] in ("-h", "--help"):
        print(_HELP)
        return 0 if words else 2
    shorten_warnings()
    try:
        # the description comes once the tables are there; until then, Ctrl-C ends this process at once
        told: dict[str, Any] = {} if sys.stdin is None or sys.stdin.isatty() else json.loads(sys.stdin.buffer.read() or "{}")
        with interruptible():
            show = _Progress()
            page = write_page(
                words if len(words) > 1 else words[0], told.get("out", ""), told, jobs=os.cpu_count() or 1,
                progress=show.title,
            )  # fmt: skip
            show.end()
    except json.JSONDecodeError:
        print("The description on the standard input is not JSON. Without one, add </dev/null.", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("interrupted: report.html is as it was before", file=sys.stderr)
        return 130
    except Error as why:
        tell(why)
        return 1
    if not told:
        print(page)
    return 0


class _Progress:
    """In a terminal, shows the figure that was drawn last in one line."""

    def __init__(self) -> None:
        self._shows = sys.stderr.isatty()

    def title(self, title: str) -> None:
        """Shows that a figure has been drawn."""
        if self._shows:
            print(f"\r\033[Kdrawing: {title}", end="", file=sys.stderr, flush=True)

    def end(self) -> None:
        """Clears the line."""
        if self._shows:
            print("\r\033[K", end="", file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
