"""Sessions that earlier versions recorded are read, reported, recovered and replayed, for good.

Usage: recordings_test.py PROGRAM, from the project's folder.

test/recordings/NAME.tar.xz has a session's folder as the version that NAME begins with left it, but for its session.nwb;
NAME.json what that had: numbers that a reader of any later version has to find again. To add one, record a short session
and give its folder to `python3 test/recordings_test.py --keep FOLDER NAME`.
"""
import csv
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import unittest

import h5py
import numpy as np

import soak

RECORDINGS = pathlib.Path(__file__).parent / "recordings"
PROGRAM = "build/release/dihaptic"


def figures(session, said=""):
    """What a session's NWB file says, in a few numbers: of each series its rows, mean and largest.

    Columns that the recording lacks, as `said` has it ("colour of targets"), do not count.
    """
    lacking = {("task_" + item, column) for column, item in re.findall(r" (\w+) of (\w+)", said)}
    out = {}
    with h5py.File(session / "session.nwb", "r") as nwb:
        for name, series in nwb["acquisition"].items():
            if "colnames" in series.attrs:
                columns = [column for column in series.attrs["colnames"][1:]
                           if not {(name, column), (name, re.sub("_[wxyz]$", "", column))} & lacking]
                data = np.column_stack([np.asarray(series[column][:], float) for column in columns])
            else:
                data = np.asarray(series["data"][:], float)
            finite = data[np.isfinite(data)]
            out[name] = [len(data)] + ([float(finite.mean()), float(np.abs(finite).max())] if len(finite) else [])
    return out


def outcomes(session):
    """Trial, attempt and outcome of the rows of trials.csv, as far as the file has them."""
    with open(session / "trials.csv", newline="") as file:
        return [[row.get(key, "") for key in ("trial", "attempt", "outcome")] for row in csv.DictReader(file)]


class Recordings(unittest.TestCase):
    def each(self):
        archives = sorted(RECORDINGS.glob("*.tar.xz"))
        self.assertGreaterEqual(len(archives), 3)
        for archive in archives:
            name = archive.name.removesuffix(".tar.xz")
            with tempfile.TemporaryDirectory() as folder:
                with tarfile.open(archive) as tar:
                    tar.extractall(folder)
                yield name, pathlib.Path(folder) / "session", json.loads((RECORDINGS / (name + ".json")).read_text())

    def dihaptic(self, *arguments):
        done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
        return done.returncode, done.stdout + done.stderr

    def test_are_recovered_with_the_same_numbers(self):
        for recording, session, kept in self.each():
            code, said = self.dihaptic("recover", session)
            with self.subTest(recording=recording):
                self.assertEqual(code, 0, said)
                self.assertIn("the log is complete", said)
                self.assertEqual(outcomes(session), kept["outcomes"])
                now = figures(session, said)
                for name, numbers in kept["series"].items():
                    self.assertIn(name, now)
                    np.testing.assert_allclose(now[name], numbers, rtol=1e-6, atol=1e-9, err_msg=name)

    def test_are_replayed_though_it_may_differ(self):
        for recording, session, _ in self.each():
            _, said = self.dihaptic("replay", session)
            with self.subTest(recording=recording):
                self.assertNotIn("error:", said)
                self.assertRegex(said, r"identical to the bit|recorded by another version")

    def test_are_reported(self):
        for i, (recording, session, _) in enumerate(self.each()):
            self.dihaptic("recover", session)
            options = soak.TABLES if i > 0 else []
            code, said = self.dihaptic("report", session, *options)
            with self.subTest(recording=recording):
                self.assertEqual(code, 0, said)
                if not options:
                    self.assertGreater((session / "report.html").stat().st_size, 10_000)


def keep(session, name):
    RECORDINGS.mkdir(exist_ok=True)
    data = {"outcomes": outcomes(session), "series": figures(session)}
    (RECORDINGS / (name + ".json")).write_text(json.dumps(data, indent=1) + "\n")
    with tempfile.TemporaryDirectory() as folder:
        copy = shutil.copytree(session, pathlib.Path(folder) / "session", ignore=shutil.ignore_patterns("session.nwb"))
        with tarfile.open(RECORDINGS / (name + ".tar.xz"), "w:xz") as tar:
            tar.add(copy, arcname="session")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--keep"]:
        keep(pathlib.Path(sys.argv[2]), sys.argv[3])
    else:
        PROGRAM = sys.argv.pop(1) if len(sys.argv) > 1 else PROGRAM
        unittest.main()
