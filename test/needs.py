"""Skips tests that need what is not installed here. Each says so on a line that `./dev test` repeats at its end."""
import importlib.util
import pathlib
import shutil
import sys
import unittest

#: Exit status that tells ctest that a test did not run.
NOT_RUN = 77


def _missing(program, package):
    return f"{program} is not installed; it is in the Debian package {package}"


def program(name, package):
    """Ends a file of tests all of which need this program, if it is missing."""
    if shutil.which(name) is None:
        print(f"SKIPPED: {_missing(name, package)}", flush=True)
        sys.exit(NOT_RUN)


def module(name, package):
    """The same for a module of Python."""
    if importlib.util.find_spec(name) is None:
        print(f"SKIPPED: {_missing(name, package)}", flush=True)
        sys.exit(NOT_RUN)


def for_this_test(name, package):
    """Skips the test that runs, if this program is missing."""
    if shutil.which(name) is None:
        skip(_missing(name, package))


def part(name, program):
    """Ends a file of tests all of which need this part of the build (DIHAPTIC_PARTS), if it was not built."""
    why = _not_built(name, program)
    if why:
        print(f"SKIPPED: {why}", flush=True)
        sys.exit(NOT_RUN)


def part_for_this_test(name, program):
    """Skips the test that runs, if this part of the build is missing."""
    why = _not_built(name, program)
    if why:
        skip(why)


def _not_built(name, program):
    cache = pathlib.Path(program).parent / "CMakeCache.txt"
    parts = [line for line in cache.read_text().splitlines() if line.startswith("DIHAPTIC_PARTS:")] if cache.exists() else []
    if not parts or name in parts[0].split("=")[1].split(";"):
        return ""
    return f"the {name} was not built; its packages are those of [{name}] in packages.txt"


def skip(why):
    """Skips the test that runs, for this reason."""
    print(f"SKIPPED: {why}", flush=True)
    raise unittest.SkipTest(why)
