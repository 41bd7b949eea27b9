"""Facts about the program that are needed to read a session; python/write_facts.py writes them."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

_FILE = Path(__file__).with_name("facts.json")


@cache
def facts() -> dict[str, Any]:
    """The facts, by their names in python/native/vocabulary.cpp. Raises ImportError where they are missing."""
    try:
        known: dict[str, Any] = json.loads(_FILE.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise ImportError(f"there is no {_FILE}", name="facts") from None
    return known


def version() -> str:
    """Version of the program that this package belongs to."""
    return str(facts()["version"]).split()[-1]
