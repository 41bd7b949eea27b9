"""Thresholds as other programs had trouble with them. docs/outside.md has the sources.

Usage: outside/thresholds_test.py PROGRAM, from the project's folder.
"""
import csv
import glob
import json
import os
import pathlib
import sys
import tempfile
import unittest

sys.path.append("test/cli")
from program import dihaptic

TASK = """title: Thresholds
scene: SCENE
task:
  draws: [{ name: u, uniform: { from: 0, to: 1 } }]
  procedures:
    - { name: asked, level: mass_g, trials: 60, yes: heavier, no: lighter, guess: 0, PROCEDURE }
  states:
    - name: go
      exits:
        - { when: "time_in_state > 0.02 and u < CHANCE", outcome: heavier }
        - { when: time, after_s: 0.04, outcome: lighter }
  feedback_s: 0
  blocks: [{ name: all, kind: perturbed, procedures: [asked] }]
"""
STAIRCASE = "staircase: { start: 100, lowest: LOW, highest: 200, steps_up: [16, 8, 4], down_after: 2, down_over_up: 1, " \
            "reversals: 10, skipped_reversals: SKIPPED }"
RISES = "1 / (1 + exp(-(mass - 0.08 kg) / (0.008 kg)))"


class Thresholds(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def thresholds(self, procedure, chance, seed=1):
        """The rows of trials.csv, and the only one of thresholds.csv; and the folder of the report."""
        file = self.folder / "task.yaml"
        file.write_text(TASK.replace("SCENE", os.path.abspath("scenes/reach-in-space.yaml")).replace("PROCEDURE", procedure)
                        .replace("CHANCE", chance))
        out = self.folder / f"out-{len(list(self.folder.iterdir()))}"
        said = dihaptic("run", str(file), "--simulate", "--seed", str(seed), "--out", str(out))
        self.assertEqual(said.returncode, 0, said.stderr)
        (session,) = glob.glob(f"{out}/*/")
        said = dihaptic("report", session)
        self.assertEqual(said.returncode, 0, said.stderr)
        with open(session + "trials.csv") as trials, open(session + "thresholds.csv") as found:
            return list(csv.DictReader(trials)), next(csv.DictReader(found)), session

    def reversals(self, trials, low):
        """The levels after which a staircase, followed here, changed its direction."""
        level, way, row, out = 100, 0, 0, []
        for trial in trials:
            self.assertAlmostEqual(float(trial["mass_g"]), level, delta=1e-6)
            row = row + 1 if trial["outcome"] == "heavier" else 0
            move = 1 if trial["outcome"] == "lighter" else -1 if row == 2 else 0
            if move:
                if way == -move:
                    out.append(level)
                way, row = move, 0
                level = min(200, max(low, level + move * (16, 8, 4)[min(len(out), 2)]))
        return out

    def test_the_reversal_that_ends_a_staircase_counts(self):
        for low, skipped, seed in ((10, 4, 1), (10, 3, 2), (92, 4, 3)):
            with self.subTest(low=low, skipped=skipped):
                procedure = STAIRCASE.replace("LOW", str(low)).replace("SKIPPED", str(skipped))
                trials, found, _ = self.thresholds(procedure, RISES, seed)
                known = self.reversals(trials, low)
                self.assertEqual(len(known), 10)
                self.assertEqual(float(found["reversals"]), 10 - skipped)
                even = known[10 - (10 - skipped) // 2 * 2:]  # as many peaks as valleys
                self.assertAlmostEqual(float(found["mean_of_reversals"]), sum(even) / len(even), delta=1e-6)

    def test_answers_that_fall_as_the_level_rises_have_no_threshold(self):
        """As with yes and no exchanged: the fit alone gave 73 g, with an interval from -40 to 230 g."""
        _, found, session = self.thresholds("constant: { levels: [50, 80, 110, 140] }", "1.3 - mass / (0.12 kg)")
        self.assertIn("less likely as the level rises", found["note"])
        self.assertIn("Thresholds: none of 1 could be given", pathlib.Path(session, "report.html").read_text())

    def test_a_fit_to_answers_without_a_trend_says_so_in_every_form(self):
        file = self.folder / "answers.csv"
        file.write_text("level,yes\n" + "".join(f"{level},{i % 2}\n" for level in (1e-5, 2e-5, 3e-5) for i in range(8)))
        self.assertIn("'yes' is as likely at all levels", dihaptic("fit", "psychometric", str(file), "--guess", "0").stdout)
        said = json.loads(dihaptic("fit", "psychometric", str(file), "--guess", "0", "--json").stdout)
        self.assertIn("'yes' is as likely at all levels", said["note"])

    def test_a_threshold_in_metres_has_digits(self):
        file = self.folder / "answers.csv"
        file.write_text("level,yes\n" + "".join(f"{level},{int(i < yes)}\n" for level, yes in ((1e-5, 1), (2e-5, 4), (3e-5, 7))
                                              for i in range(8)))  # fmt: skip
        said = dihaptic("fit", "psychometric", str(file), "--guess", "0").stdout
        self.assertRegex(said, r"threshold +2e-05|threshold +1\.9\d+e-05|threshold +2\.0\d+e-05")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
