"""The program as its user meets it: commands, messages, files. What the tests beside this file share.

Usage: cli/NAME_test.py PROGRAM [CLASS[.TEST]], from the project's folder.
"""
import glob
import os
import resource
import subprocess
import sys
import time

sys.path.append("test")  # patience.py
from patience import SLOWNESS, patient

PROGRAM = sys.argv.pop(1) if len(sys.argv) > 1 else "build/release/dihaptic"
SHORT = """bodies:
  - {name: floor, shape: plane, fixed: yes}
  - {name: thing, shape: mesh, file: block.obj, unit: mm, mass_g: 50}
hand: {centre_mm: [0, 0, 100], script: [{name: wait, duration_s: 0.1}, {name: rest, duration_s: 0.1}]}
"""
MADE = ["session.nwb", "trials.csv", "phases.csv", "episodes.csv", "lifts.csv", "events.csv"]


def dihaptic(*arguments, program=PROGRAM, **options):
    return subprocess.run([program, *arguments], capture_output=True, text=True, timeout=patient(300), **options)


def session_of(out):
    """The only session's folder in `out`."""
    (folder,) = glob.glob(out + "/*/")
    return folder


def wait_for_log(out, size):
    """Until the only session's raw log in `out` is longer; returns how long it is."""
    deadline = time.monotonic() + patient(60)
    while time.monotonic() < deadline:
        logs = glob.glob(out + "/*/raw.log")
        if logs and os.path.getsize(logs[0]) > size:
            return os.path.getsize(logs[0])
        time.sleep(0.001)
    raise AssertionError("no log of that length in " + out)


def with_largest_file(size):
    """For preexec_fn: no file gets larger, as on a disk that gets full."""
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
