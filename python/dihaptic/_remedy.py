"""States in one line why the package, or a part of it, cannot be used here, with the remedy."""

from __future__ import annotations

import re
import shutil
import sys
from pathlib import Path

_FOLDER = Path(__file__).parent
#: The libraries that reading and figures require, with their names in pip.
_LIBRARIES = {
    "numpy": "numpy", "pandas": "pandas", "h5py": "h5py", "yaml": "pyyaml", "matplotlib": "matplotlib", "scipy": "scipy",
}  # fmt: skip

#: The prefix of Debian's own Python.
_DEBIANS = "/usr"


def explain(why: ImportError) -> str:
    """The remedy if the package cannot even read."""
    library = str(why.name).split(".")[0]
    if library in _LIBRARIES:
        return f"dihaptic needs {library}: {_how_to_install(library)}."
    if why.name == "facts":
        return (
            "dihaptic has not been built here. Run ./dev build in its folder, then "
            "export PYTHONPATH=that folder/build/release/python."
        )
    return f"dihaptic cannot be imported: {why}."


def _versions_of_the_module() -> list[str]:
    """The versions of Python for which the module was built, according to its files' names."""
    tags = (re.search(r"cpython-(\d)(\d+)", path.name) for path in _FOLDER.glob("_native*.so"))
    return sorted(f"{tag[1]}.{tag[2]}" for tag in tags if tag)


def needs_program(name: str, why: ImportError | None) -> str:
    """The remedy if the package can read, but `name` needs the program or its module."""
    if not (_FOLDER / "program.py").exists():
        there = shutil.which("dihaptic") is not None
        remedy = (
            "Type pip uninstall dihaptic-read: then Python finds the whole package, python3-dihaptic"
            if there
            else "Install Dihaptic on Debian 12 or 13, as its README shows"
        )
        return f"dihaptic.{name} needs the program, and this is dihaptic-read, which only reads. {remedy}."
    built_for = _versions_of_the_module()
    if not built_for:
        return f"dihaptic.{name} needs the module _native, which has not been built here. Run ./dev build."
    here = ".".join(map(str, sys.version_info[:2]))
    if here not in built_for:
        return (
            f"dihaptic.{name} is built for Python {' and '.join(built_for)}, and this is {here}, where dihaptic "
            "only reads. Use Debian's: /usr/bin/python3."
        )
    return f"dihaptic's module cannot be loaded: {why}. Install what packages.txt lists: ./dev build."


def _how_to_install(library: str) -> str:
    if not list(_FOLDER.glob("_native*.so")):
        return f"python3 -m pip install {_LIBRARIES[library]}"
    if sys.prefix == _DEBIANS:
        return f"sudo apt install python3-{library}"
    # an environment of venv, conda or pyenv does not see what apt installs
    return f"this Python, {sys.executable}, lacks it. Use Debian's: /usr/bin/python3"
