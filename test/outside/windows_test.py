"""What operators of other programs lost, or could not reach, in their windows. docs/outside.md has the sources.

Usage: outside/windows_test.py PROGRAM, from the project's folder.
"""
import csv
import glob
import os
import pathlib
import shutil
import subprocess
import sys
import time
import unittest

sys.path.append("test/gui")
from window import PROGRAM, Participants

ASKS = """title: Asked in words
scene: SCENE
task:
  states:
    - name: rate
      message: How heavy was it?
      ask: { name: heaviness, scale: vas, labels: [light, heavy], by: mouse }
      exits: [{ when: answered, outcome: rated }]
  blocks: [{ name: all, repeats: 3 }]
"""


class Windows(Participants):
    size = "1024x700"

    def events(self):
        with open(self.recording() + "events.csv") as file:
            return [(row["event"], row["detail"]) for row in csv.DictReader(file)]

    def lifts(self):
        return self.experiment("first-trials", lambda text: text.replace("../rigs", os.getcwd() + "/rigs"))

    def test_a_session_that_ends_after_escape_has_all_of_its_files(self):
        self.open(self.lifts())
        self.start()
        time.sleep(1)
        self.key("F3")
        self.type("looked away")
        self.key("Return", "Escape", "F7")
        with self.ended("interrupted"):
            pass
        self.settle()
        folder = pathlib.Path(self.recording())
        for name in ("raw.log", "session.nwb", "trials.csv", "events.csv", "shown.csv", "notes.csv"):
            self.assertGreater((folder / name).stat().st_size, 30, name)
        self.assertIn(("note", "looked away"), self.events())
        self.assertIn(("paused", "force off"), self.events())
        report = subprocess.run([PROGRAM, "report", folder], capture_output=True, text=True)
        self.assertEqual(report.returncode, 0, report.stderr)
        self.assertNotIn("changed", report.stdout + report.stderr)
        self.assertIn("looked away", (folder / "report.html").read_text())
        self.quit()

    def test_escape_takes_force_away_while_a_question_waits_for_no_key(self):
        file = pathlib.Path(self.folder.name, "asks.yaml")
        file.write_text(ASKS.replace("SCENE", os.getcwd() + "/scenes/reach-in-space.yaml"))
        self.open(file)
        self.start()
        time.sleep(1)
        self.key("Escape")
        time.sleep(0.5)
        self.key("F7")
        with self.ended("interrupted"):
            pass
        self.assertIn(("paused", "force off"), self.events())
        self.quit()

    def test_nobody_is_recorded_twice_or_overwritten_unasked(self):
        self.open(self.lifts())
        self.start()  # S07
        time.sleep(0.5)
        self.key("F7")
        with self.ended("interrupted"):
            pass
        self.settle()
        first = pathlib.Path(self.recording(), "raw.log").read_bytes()
        self.ask()
        self.type("S07")
        self.key("Return")  # refused: the box "same person" is not ticked
        time.sleep(0.5)
        self.assertTrue(self.dialog())
        self.assertEqual(len(glob.glob(self.out + "/*/raw.log")), 1)
        self.answered("Escape")
        self.assertEqual(pathlib.Path(self.recording(), "raw.log").read_bytes(), first)
        self.quit()

    def test_buttons_stay_on_the_screen_however_many_people_there_are(self):
        subprocess.run([PROGRAM, "run", "scenes/block-on-table.yaml", "--participant", "S001", "--out", self.out], check=True,
                       capture_output=True)
        one = pathlib.Path(self.recording())
        for number in range(2, 90):
            other = pathlib.Path(self.out, f"2026-01-01_000000_block_S{number:03}")
            other.mkdir()
            (other / "raw.log").write_bytes(b"")
            text = (one / "session.yaml").read_text().replace("S001", f"S{number:03}")
            (other / "session.yaml").write_text(text.replace("mover: script", "mover: mouse"))
        self.open(self.lifts())
        self.ask()
        self.screenshot("ninety-people")
        dialog = self.dialog().split()[-1]
        place = dict(line.split("=") for line in self.xdotool("getwindowgeometry", "--shell", dialog).split())
        self.assertLessEqual(int(place["Y"]) + int(place["HEIGHT"]), 700)
        self.assertLessEqual(int(place["X"]) + int(place["WIDTH"]), 1024)
        self.answered("Escape")
        shutil.rmtree(self.out)
        self.quit()


if __name__ == "__main__":
    unittest.main()
