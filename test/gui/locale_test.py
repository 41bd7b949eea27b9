"""The window does the same in every language: whether numbers are written with a point or a comma there."""
import csv
import os
import pathlib
import sys
import tempfile
import time
import unittest

sys.path.append("test")
import needs
from locales import COMMAS, with_language
from window import Participants, Window

import soak

#: An experiment whose trials use draws, factors, variables and tables.
EXPERIMENT = """title: Waits by chance
scene: {scenes}/block-on-table.yaml
task:
  draws:
    - {{ name: wait_s, uniform: {{ from: 0.25, to: 0.9 }} }}
    - {{ name: weight, choice: [0.5, 1.5, 2.5] }}
  cross:
    - {{ factor: mass_g, levels: [100.5, 200.5] }}
  variables:
    - {{ name: score, start: 0.25 }}
  after_trial:
    - {{ set: score, to: score + 0.5 }}
  states:
    - name: wait
      message: Wait
      drive: [{{ body: block, path: {{ file: path.csv }} }}]
      exits:
        - {{ when: time, after_s: wait, outcome: waited }}
  blocks:
    - {{ name: waits, kind: baseline, repeats: 2 }}
"""
#: Columns of trials.csv that depend on no clock.
DECIDED = ("trial_num", "condition", "mass_g", "wait_s", "weight", "score", "outcome")


class Languages(Participants):
    def in_language(self, name):
        folder = tempfile.mkdtemp(dir=self.folder.name)
        language = with_language(name, self.folder.name) if name != "C" else dict(os.environ, LC_ALL="C.UTF-8")
        if language is None:
            needs.skip(f"the language {name} cannot be made: localedef and its sources are in the Debian package locales")
        self.environment |= {key: language[key] for key in ("LC_ALL", "LOCPATH") if key in language}
        self.out = folder + "/sessions"

    def trials(self, name):
        """The rows of trials.csv of a session in a language."""
        self.in_language(name)
        pathlib.Path(self.folder.name, "path.csv").write_text("time_s,x_mm\n0,0.5\n0.2,1.5\n")
        file = pathlib.Path(self.folder.name, "waits.yaml")
        file.write_text(EXPERIMENT.format(scenes=os.getcwd() + "/scenes"))
        self.open(str(file))
        self.start()
        with self.ended("complete"):
            pass
        with open(self.recording() + "trials.csv", newline="") as table:
            rows = list(csv.DictReader(table))
        self.window.terminate()
        self.window.wait()
        return rows

    @soak.alone
    def test_have_the_same_trials(self):
        usual = self.trials("C")
        self.assertEqual(len(usual), 4)
        self.assertTrue(all(0.25 <= float(row["wait_s"]) <= 0.9 for row in usual))
        for name in COMMAS:
            there = self.trials(name)
            self.assertEqual(*([[row[key] for key in DECIDED] for row in rows] for rows in (usual, there)))
            for row in there:
                self.assertAlmostEqual(float(row["stop_time"]) - float(row["start_time"]), float(row["wait_s"]), delta=0.01)


class Fields(Window):
    def test_take_points_and_commas_alike(self):
        language = with_language("de_DE", self.folder.name)
        if language is None:
            needs.skip("German cannot be made: localedef and its sources are in the Debian package locales")
        self.environment |= {key: language[key] for key in ("LC_ALL", "LOCPATH")}
        self.open()
        self.start()
        self.key("ctrl+t")  # the drawer of Tuning
        for typed, read in (("1.5", 1.5), ("1,3", 1.3)):
            self.key("alt+i", "ctrl+a")
            self.xdotool("type", typed)  # friction
            self.key("Return")
            self.recorded(typed, lambda file: abs(self.series(file, "friction_scale")[-1] - read) < 1e-6)
        self.screenshot("comma")
        self.key("F7")
        with self.ended("complete"):
            pass


if __name__ == "__main__":
    unittest.main(verbosity=1)
