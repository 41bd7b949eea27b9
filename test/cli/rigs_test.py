"""Rigs: tuning, workspaces, calibration.

Usage: rigs_test.py PROGRAM, from the project's folder.
"""
import os
import pathlib
import re
import signal
import subprocess
import tempfile
import time
import unittest

from program import PROGRAM, dihaptic, patient, session_of, wait_for_log


class Commands(unittest.TestCase):
    def test_tune_refuses_a_rig_that_is_not_simulated_and_a_map_that_cannot_be(self):
        with tempfile.TemporaryDirectory() as folder:
            rig = folder + "/rig.yaml"
            pathlib.Path(rig).write_text("devices:\n  - { finger: thumb, backend: replay }\n"
                                         "  - { finger: index, backend: replay }\n")
            result = dihaptic("tune", "scenes/block-on-table.yaml", "--rig", rig)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(rig + ":2: error: backend: devices of the backend 'replay' need a recording. Use", result.stderr)
            pathlib.Path(rig).write_text("devices:\n  - { finger: toe, backend: simulated }\n")
            result = dihaptic("tune", "scenes/block-on-table.yaml", "--rig", rig)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn("the scene's finger 'thumb' holds no device", result.stderr)
            result = dihaptic("tune", "scenes/block-on-table.yaml", "--map", folder + "/none/map.svg")
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn("map.svg: error: cannot be written: No such file or directory. Name a file in an existing folder", result.stderr)

    def test_workspace_measures_and_draws(self):
        with tempfile.TemporaryDirectory() as folder:
            picture = folder + "/workspace.svg"
            result = dihaptic("workspace", "rigs/premium-arms.yaml", "-o", picture)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertRegex(result.stdout, r"shared +\d+\.\d\d litres")
            self.assertIn("largest sphere in it", pathlib.Path(picture).read_text())
            # the keys that it proposes are valid in a rig file, and are then reported as set
            rig = folder + "/rig.yaml"
            proposed = "".join(re.findall(r"^(?:origin_mm|wall): .*\n", result.stdout, re.MULTILINE))
            pathlib.Path(rig).write_text(pathlib.Path("rigs/premium-arms.yaml").read_text() + proposed)
            again = dihaptic("workspace", rig, "-o", picture)
            self.assertEqual(again.returncode, 0, again.stderr)
            self.assertIn("keeps hands where all devices reach", again.stdout)
            self.assertIn(proposed, again.stdout.replace(" }\n\n", " }\n"))
            pathlib.Path(rig).write_text(pathlib.Path("rigs/premium-arms.yaml").read_text()
                                         + "wall: { centre_mm: [0, 0, 70], size_mm: [600, 600, 600] }\n")
            result = dihaptic("workspace", rig, "-o", picture)
            self.assertEqual(result.returncode, 1, result.stderr)
            self.assertRegex(result.stdout, r"not all devices reach, in \d\d\.\d % of it")
            result = dihaptic("workspace", "rigs/ideal-pair.yaml", "-o", picture)
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertIn("rigs/ideal-pair.yaml:5: error: options: the thumb's device does not state its reach."
                          " Give workspace_mm", result.stderr)

    def test_calibrate_finds_what_is_misplaced_and_sessions_use_it(self):
        with tempfile.TemporaryDirectory() as folder:
            rig = folder + "/rig.yaml"
            text = pathlib.Path("rigs/premium-misplaced.yaml").read_text()
            pathlib.Path(rig).write_text(text.replace("jig:", "calibration: mine.yaml\njig:"))
            result = dihaptic("check", rig)
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertIn("rig.yaml:", result.stdout)
            self.assertIn("calibration: mine.yaml cannot be used. Calibrate the rig", result.stdout)
            result = dihaptic("calibrate", rig)
            self.assertEqual(result.returncode, 0, result.stderr)
            agree = re.search(r"agree to ([\d.]+) mm rms", result.stdout)
            self.assertLess(float(agree[1]), 0.1, result.stdout)
            before = re.search(r"before +([\d.]+) mm rms", result.stdout)
            self.assertGreater(float(before[1]), 1, result.stdout)
            self.assertTrue(pathlib.Path(folder + "/mine.svg").exists())
            result = dihaptic("check", rig)
            self.assertEqual(result.returncode, 0, result.stdout)
            # an old calibration gives a warning, and a session keeps a copy of its own
            mine = pathlib.Path(folder + "/mine.yaml")
            mine.write_text(re.sub(r"date: .*", "date: 2020-01-01", mine.read_text()))
            result = dihaptic("run", "experiments/lift-block.yaml", "--rig", rig, "--out", folder + "/sessions")
            self.assertIn("Calibrate it again: dihaptic calibrate", result.stderr)
            mine.unlink()
            session = session_of(folder + "/sessions")
            self.assertTrue(pathlib.Path(session + "/calibration.yaml").exists())
            result = dihaptic("replay", session)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_calibrate_writes_over_no_input_and_says_at_once_where_it_cannot(self):
        with tempfile.TemporaryDirectory() as folder:
            rig = folder + "/rig.yaml"
            text = pathlib.Path("rigs/premium-misplaced.yaml").read_text()
            pathlib.Path(rig).write_text(text)
            os.mkdir(folder + "/taken.svg")
            for out, message in [(rig, "is the rig file itself"), (folder + "/c.svg", "is the name of the picture"),
                                 (folder + "/none/c.yaml", "cannot be written: No such file or directory"),
                                 (folder + "/taken.yaml", "cannot be written: it is a folder")]:
                began = time.monotonic()
                result = dihaptic("calibrate", rig, "-o", out)
                self.assertEqual(result.returncode, 2, out)
                self.assertIn(message, result.stderr)
                self.assertLess(time.monotonic() - began, 2)
            result = dihaptic("workspace", rig, "-o", rig)
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertEqual(pathlib.Path(rig).read_text(), text)
            self.assertEqual(sorted(os.listdir(folder)), ["rig.yaml", "taken.svg"])
            pathlib.Path(rig).write_text(text[:text.index("jig:")] + "jig: [{name: post, position_mm: [0, 0, 100]}]\n")
            result = dihaptic("calibrate", rig)
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertRegex(result.stderr, r"rig.yaml:\d+: error: jig: its points are on a line")


class Libraries(unittest.TestCase):
    """An experiment, its rig and a library in one folder, as they come from somebody else."""

    TRIALS = ("hand: {centre_mm: [0, 0, 100]}\n"
              "task: {states: [{name: wait, exits: [{when: time, after_s: 0.5, outcome: done}]}], feedback_s: 0, "
              "blocks: [{name: all, repeats: 8}]}\n")

    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)
        self.library = self.folder / "libours.so"
        self.library.symlink_to(pathlib.Path(PROGRAM).resolve().parent / "src/outlets/fake_lsl.so")
        self.rig = self.folder / "rig.yaml"
        self.rig.write_text("devices:\n  - {finger: thumb, backend: simulated}\n  - {finger: index, backend: simulated}\n"
                            f"outlets:\n  - kind: lsl\n    options:\n      library: {self.library}\n")
        self.experiment = self.folder / "experiment.yaml"
        scene = pathlib.Path("scenes/block-on-table.yaml").absolute()
        self.experiment.write_text(f"scene: {scene}\nrig: rig.yaml\n" + self.TRIALS)
        self.env = {**os.environ, "XDG_CONFIG_HOME": str(self.folder / "config"),
                    "DIHAPTIC_FAKE_LSL": str(self.folder / "told")}

    def allow(self):
        mine = self.folder / "config/dihaptic/libraries.yaml"
        mine.parent.mkdir(parents=True)
        mine.write_text(f"- {self.library}\n")

    def run_it(self, *more):
        return dihaptic("run", str(self.experiment), "--clock", "real", "--out", str(self.folder / "out"), *more, env=self.env)

    def refused(self, result, rig):
        self.assertEqual(result.returncode, 2, result.stdout)
        self.assertRegex(result.stderr, f"{rig}:\\d+: error: library: '.*/libours.so' is not loaded: .*you did not name yourself")
        self.assertIn(f"add the line '- {self.library.resolve()}' to {self.folder}/config/dihaptic/libraries.yaml", result.stderr)

    def test_that_an_experiments_rig_names_is_not_loaded_until_the_user_allows_it(self):
        self.refused(self.run_it(), "rig.yaml")
        self.assertFalse((self.folder / "out").exists())
        self.assertFalse((self.folder / "told").exists())
        checked = dihaptic("check", str(self.experiment), env=self.env)
        self.assertEqual(checked.returncode, 0, checked.stderr)
        self.assertIn("is not loaded", checked.stdout + checked.stderr)
        self.allow()
        self.assertEqual(self.run_it().returncode, 0)
        self.assertTrue((self.folder / "told").exists())

    def test_that_a_sessions_frozen_rig_names_is_not_loaded_either(self):
        process = subprocess.Popen([PROGRAM, "run", str(self.experiment), "--rig", str(self.rig), "--clock", "real", "--out",
                                    str(self.folder / "out")], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                   env=self.env)
        wait_for_log(str(self.folder / "out"), 40000)
        time.sleep(1)
        process.send_signal(signal.SIGINT)
        said = process.communicate(timeout=patient(60))
        self.assertEqual(process.returncode, 1, said)
        session = session_of(str(self.folder / "out"))
        result = dihaptic("resume", session, env=self.env)
        self.refused(result, "rig.yaml")
        self.assertNotIn("resumes ", result.stdout)
        self.allow()
        resumed = dihaptic("resume", session, env=self.env)
        self.assertEqual(resumed.returncode, 0, resumed.stderr)
        again = dihaptic("resume", session, env=self.env)
        self.assertEqual(again.returncode, 2, again.stdout)
        self.assertIn("has already been resumed, as " + str(self.folder / "out"), again.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
