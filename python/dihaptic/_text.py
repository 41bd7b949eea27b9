"""Texts that Python passes to the programs, which read UTF-8 only."""

from __future__ import annotations

import json
import re
from typing import Any


class Plain(str):
    """A word without quotes in a file: a number, yes or no, or a text, depending on its key."""


def to_json(value: Any) -> str:
    r"""One line of JSON. Half of a surrogate pair, by which Python represents an unreadable byte, is not a character: it is
    written as Python's own escape for it.

    >>> from dihaptic._text import to_json
    >>> print(to_json({"failed": "no file caf\udce9"}))
    {"failed": "no file caf\\udce9"}
    """
    text = json.dumps(value, ensure_ascii=False)
    return re.sub("[\ud800-\udfff]", lambda half: rf"\\u{ord(half[0]):04x}", text)
