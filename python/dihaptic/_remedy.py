"""Says in one line why the package, or a part of it, cannot be used here, and what to do."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

_FOLDER = Path(__file__).parent
#: That the module was built for: Debian 12's.
_VERSION = (3, 11)
#: Of the libraries that reading takes: what Debian calls each, and what pip does.
_LIBRARIES = {"numpy": "numpy", "pandas": "pandas", "h5py": "h5py", "yaml": "pyyaml"}


def explain(why: ImportError) -> str:
    """The remedy where the package cannot even read."""
    if why.name in _LIBRARIES:
        return f"dihaptic needs {why.name}: {_how_to_install(why.name)}."
    if why.name == "facts":
        return (
            "dihaptic has not been built here. Run ./dev build in its folder, then "
            "export PYTHONPATH=that folder/build/release/python."
        )
    return f"dihaptic cannot be imported: {why}."


def needs_program(name: str, why: ImportError | None) -> str:
    """The remedy where the package reads, and `name` takes the program or its module."""
    if not (_FOLDER / "program.py").exists():
        there = shutil.which("dihaptic") is not None
        remedy = (
            "Type pip uninstall dihaptic-read: then Python finds the whole package, python3-dihaptic"
            if there
            else "Install Dihaptic on a Debian 12, which its README shows"
        )
        return f"dihaptic.{name} needs the program, and this is dihaptic-read, which only reads. {remedy}."
    if sys.version_info[:2] != _VERSION:
        here = ".".join(map(str, sys.version_info[:2]))
        return (
            f"dihaptic.{name} is built for Python 3.11, and this is {here}, where dihaptic only reads. "
            "Use Debian's: /usr/bin/python3."
        )
    if not list(_FOLDER.glob("_native*.so")):
        return f"dihaptic.{name} needs the module _native, which has not been built here. Run ./dev build."
    return f"dihaptic's module cannot be loaded: {why}. Install what packages.txt lists: ./dev build."


def _how_to_install(library: str) -> str:
    if list(_FOLDER.glob("_native*.so")):
        return f"sudo apt install python3-{library}"
    return f"python3 -m pip install {_LIBRARIES[library]}"
