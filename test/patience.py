"""How long tests wait for what may take long: the time that is enough for the program as it is built for use, times how
much slower it may be here. CMake says so of programs with sanitizers (DIHAPTIC_SLOWNESS in CMakeLists.txt)."""
import os

SLOWNESS = float(os.environ.get("DIHAPTIC_SLOWNESS", 1))


def patient(seconds):
    return seconds * SLOWNESS
