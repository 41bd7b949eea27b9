"""What `./dev soak` does of a file of tests, and `./dev test` only samples. A file that imports this is a test NAME of both,
as CMake reads it: of `./dev test`, and, with everything, as NAME/soak of `./dev soak`."""
import os

#: Whether everything is done. By hand: DIHAPTIC_SOAK=1 python3 FILE PROGRAM.
EVERYTHING = "DIHAPTIC_SOAK" in os.environ


def of(sample, everything):
    """How many, or which, are tried."""
    return everything if EVERYTHING else sample


def alone(test):
    """A test, or a class of tests, of the soak alone."""
    return test if EVERYTHING else None
