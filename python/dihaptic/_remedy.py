"""Says in one line why the package cannot be imported here, and what to do."""

from __future__ import annotations

import sys
from pathlib import Path

#: That the module was built for: Debian 12's.
_VERSION = (3, 11)


def explain(why: ImportError) -> str:
    """The remedy for an import that failed."""
    folder = Path(__file__).parent
    if sys.version_info[:2] != _VERSION:
        here = ".".join(map(str, sys.version_info[:2]))
        return f"dihaptic is built for Python 3.11, and this is {here}. Use Debian's: /usr/bin/python3."
    if not list(folder.glob("_native*.so")):
        return (
            "dihaptic has not been built here. Run ./dev build in its folder, then "
            "export PYTHONPATH=that folder/build/release/python."
        )
    if why.name in ("numpy", "pandas", "h5py"):
        return f"dihaptic needs {why.name}: sudo apt install python3-{why.name}."
    return f"dihaptic's module cannot be loaded: {why}. Install what packages.txt lists: ./dev build."
