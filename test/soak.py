"""Tests of which `./dev test` runs a sample, and `./dev soak` everything. CMake makes two tests of a file that imports this:
NAME, in `./dev test`, and NAME/soak, with everything, in `./dev soak`."""
import os

#: Whether to run everything rather than a sample. To run a file that way: DIHAPTIC_SOAK=1 python3 FILE PROGRAM.
EVERYTHING = "DIHAPTIC_SOAK" in os.environ


def of(sample, everything):
    """How many cases are tried, or which ones."""
    return everything if EVERYTHING else sample


#: Options of `dihaptic report` where a test looks at its tables: a page takes seconds, and only the soak draws it as well.
TABLES = of(["--tables"], [])


def alone(test):
    """Marks a test, or a class of tests, as part of the soak only."""
    return test if EVERYTHING else None
