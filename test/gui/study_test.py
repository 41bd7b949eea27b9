"""A session of a study that is started in the window."""
import glob
import os
import pathlib
import subprocess
import time
import unittest

from window import PROGRAM, Participants

STUDY = """title: One day
groups:
  - { name: all, people: 4 }
sessions:
  - { name: only, experiment: experiment.yaml }
"""


class Study(Participants):
    def setUp(self):
        super().setUp()
        self.study = self.folder.name + "/study.yaml"
        pathlib.Path(self.study).write_text(STUDY)

    def dihaptic(self, *words):
        done = subprocess.run([PROGRAM, *words], capture_output=True, text=True, env=self.environment)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def who(self, id):
        self.wait("the dialog", self.dialog)
        self.xdotool("windowfocus", self.dialog().split()[-1])
        time.sleep(0.5)
        self.type(id)
        self.key("Return")
        self.wait("the dialog's end", lambda: not self.dialog())

    def test_counts_in_the_study(self):
        library = pathlib.Path(PROGRAM).resolve().parent / "src/devices/libfake_hd.so"
        self.allow(library)
        pathlib.Path(self.folder.name, "rig.yaml").write_text("devices:\n" + "".join(
            f"  - {{finger: {finger}, backend: openhaptics, options: {{library: {library}, name: PHANToM {i}}}}}\n"
            for i, finger in [(1, "thumb"), (2, "index")]))
        file = self.experiment("first-trials", lambda text: text.replace("../rigs/ideal-pair.yaml", "rig.yaml"))
        self.dihaptic("participant", "add", self.study, "S04")
        self.real_rig = True
        self.open(file)
        self.ask_to_start()
        self.who("S04")
        here = self.folder.name + "/sessions/S04/only/*/"
        recording = self.wait("the session in the study's folder", lambda: glob.glob(here))[0]
        info = pathlib.Path(recording, "session.yaml")
        self.wait("the start", lambda: pathlib.Path(recording, "raw.log").exists())
        self.xdotool("windowfocus", self.name)
        time.sleep(1)
        self.key("F3")
        self.type("coughed")
        self.key("Return")
        self.key("F7")
        self.wait("the end", lambda: "state: interrupted" in info.read_text())
        self.assertIn("study: One day", info.read_text())
        self.assertIn("begin,S04,only", pathlib.Path(self.folder.name, "log.csv").read_text())
        self.assertRegex(pathlib.Path(recording, "events.csv").read_text(), r"note,coughed")
        self.quit()

    def test_asks_before_a_session_that_would_not_count(self):
        file = self.experiment("first-trials", lambda text: text.replace("../rigs", os.getcwd() + "/rigs"))
        self.dihaptic("participant", "add", self.study, "S04")
        self.open(file)
        self.key("F5")
        self.who("S04")
        self.answer("^Outside the study", "Return")
        self.assertEqual(glob.glob(self.out + "/*/raw.log"), [])
        self.key("F5")
        self.who("S04")
        self.answer("^Outside the study", "alt+o")
        self.wait("the start", lambda: glob.glob(self.out + "/*/raw.log"))
        time.sleep(0.5)
        self.key("F7")
        with self.ended("interrupted"):
            pass
        self.quit()


if __name__ == "__main__":
    unittest.main()
