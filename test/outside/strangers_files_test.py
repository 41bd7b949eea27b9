"""What files and names of strangers did to other programs, tried on this one. docs/outside.md has the sources.

Usage: outside/strangers_files_test.py PROGRAM, from the project's folder.
"""
import os
import pathlib
import shlex
import subprocess
import sys
import tempfile
import unittest

import h5py

sys.path.append("test/cli")
from program import PROGRAM, dihaptic, patient

PROGRAM = os.path.abspath(PROGRAM)
sys.path.append(os.path.join(os.path.dirname(PROGRAM), "python"))


class StrangersFiles(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def record(self, *arguments, out="out"):
        result = dihaptic("run", "experiments/first-trials.yaml", "--simulate", *arguments, "--out", str(self.folder / out))
        self.assertEqual(result.returncode, 0, result.stderr)
        (session,) = (self.folder / out).iterdir()
        return session

    def test_a_participant_of_parent_folders_stays_in_the_output_folder(self):
        session = self.record("--participant", "../../up1")
        self.assertEqual(session.parent, self.folder / "out")
        self.assertEqual(os.listdir(self.folder), ["out"])

    def test_a_participant_that_a_spreadsheet_would_take_for_a_formula_is_refused(self):
        for word in ('=HYPERLINK("http://x.invalid";"S1")', "@SUM(A1)1", "+1", "=1"):
            result = dihaptic("run", "experiments/lift-block.yaml", f"--participant={word}",
                              "--out", str(self.folder / "out"))
            self.assertEqual(result.returncode, 2, word)
            self.assertIn("a spreadsheet would take for a formula", result.stderr)
        self.assertEqual(os.listdir(self.folder), [])

    def test_names_that_begin_with_a_dash_are_names(self):
        experiment = os.path.abspath("experiments/first-trials.yaml")
        result = subprocess.run([PROGRAM, "rehearse", experiment, "--people", "1", "--out=-r"], cwd=self.folder,
                                capture_output=True, text=True, timeout=patient(300))
        self.assertEqual(result.returncode, 0, result.stderr)
        typed = result.stdout.split("next: dihaptic ")[1].splitlines()[0]
        result = subprocess.run([PROGRAM, *shlex.split(typed)], cwd=self.folder, capture_output=True, text=True,
                                timeout=patient(300))
        self.assertEqual(result.returncode, 0, typed + ": " + result.stderr)

    def test_names_that_turn_the_order_of_a_line_around_are_not_shown_so(self):
        result = dihaptic("check", "scene\u202elmay.yaml")
        self.assertEqual(result.returncode, 2)
        self.assertNotIn("\u202e", result.stderr)
        result = dihaptic("run", "experiments/first-trials.yaml", "--participant", "S\u202e1")
        self.assertEqual(result.returncode, 2)
        self.assertIn("changes the order of those around it", result.stderr)

    def test_data_sets_of_a_session_that_lead_into_other_files_are_not_read(self):
        import dihaptic as dh

        secret = self.folder / "secret"
        secret.write_bytes(b"\x01" * 4096)
        with h5py.File(self.folder / "other.h5", "w") as file:
            file["data"] = [1.0]
        traps = {
            "external data": lambda file: file.create_dataset("acquisition/trap", (512,), "f8", external=[(str(secret), 0, 4096)]),
            "external link": lambda file: file["acquisition"].__setitem__("trap", h5py.ExternalLink(str(self.folder / "other.h5"), "/data")),
            "virtual": self.make_virtual,
        }
        for name, trap in traps.items():
            with self.subTest(name):
                session = self.record("--participant", "S1", out=name)
                dh.load(session).t  # can be read before it is changed
                with h5py.File(session / "session.nwb", "a") as file:
                    trap(file)
                with self.assertRaises(dh.Error) as told:
                    dh.load(session).t
                self.assertIn("in another file", str(told.exception))

    def test_a_folder_with_a_library_of_that_name_is_not_searched_for_libraries(self):
        linked = subprocess.run(["ldd", PROGRAM], capture_output=True, text=True, check=True).stdout
        for line in linked.splitlines():
            if "=>" in line:
                (self.folder / line.split()[0]).write_text("no library")
        result = subprocess.run([PROGRAM, "check", os.path.abspath("scenes/block-on-table.yaml")], cwd=self.folder,
                                capture_output=True, text=True, timeout=patient(60))
        self.assertEqual(result.returncode, 0, result.stderr)
        for name in os.listdir(os.path.dirname(PROGRAM)):
            file = os.path.join(os.path.dirname(PROGRAM), name)
            if os.path.isfile(file) and os.access(file, os.X_OK):
                with open(file, "rb") as program:
                    if program.read(4) != b"\x7fELF":
                        continue
                head = subprocess.run(["readelf", "-d", file], capture_output=True, text=True).stdout
                self.assertNotRegex(head, r"R(UN)?PATH", name)

    def make_virtual(self, file):
        layout = h5py.VirtualLayout(shape=(1,), dtype="f8")
        layout[:] = h5py.VirtualSource(str(self.folder / "other.h5"), "data", shape=(1,))
        file.create_virtual_dataset("acquisition/trap", layout)


if __name__ == "__main__":
    unittest.main()
