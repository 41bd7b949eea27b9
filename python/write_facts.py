"""Writes the program's facts about sessions for the package's readers: facts.json, beside the module _native.

Usage: write_facts.py FOLDER, where FOLDER has the module.
"""

import json
import pathlib
import sys

folder = pathlib.Path(sys.argv[1])
sys.path.insert(0, str(folder))
import _native  # noqa: E402

(folder / "facts.json").write_text(json.dumps(_native.facts(), indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
