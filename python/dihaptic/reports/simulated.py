"""Names the abilities that an experiment needs but simulated people lack, since their answers would look like any others."""

from __future__ import annotations

import re
from typing import Any

from ..figures.data import Data

#: A warning of src/person/simulated_limits.cpp among the notes of session.yaml: "FILE:LINE: warning: NAME: WHAT. REMEDY".
_WARNING = re.compile(r": warning: (?P<name>.*?): (?P<what>[^:].*simulated people.*?)\. Rehearse the order")


def limits_of(data: Data) -> list[str]:
    """A sentence for each ability that the experiment requires but simulated people lack, from notes. [] for people."""
    if data.sample.moved_by != "simulated_person":
        return []
    names: dict[str, list[str]] = {}
    for session in data.sessions:
        for note in session.info.get("notes") or []:
            if found := _WARNING.search(str(note)):
                names.setdefault(found["what"], []).append(found["name"])
    return [f"{', '.join(dict.fromkeys(of))}: {what}." for what, of in names.items()]


def is_of_limits(note: Any) -> bool:
    """Whether a note of session.yaml is among those of limits_of()."""
    return _WARNING.search(str(note)) is not None
