"""Rates of learning fitted to groups of people: those from which the groups were made are found again."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
import pandas as pd

import dihaptic as dh
from dihaptic.calibration import LIMITS, STRUCTURES, leave_one_out
from dihaptic.calibration.learner import Group, Limits, learn, shares

MEDIAN = np.array([0.3, -0.5, 4.0, -2.0])
SPREAD = np.array([0.5, 0.6, 0.5, 0.4])
BETWEEN = np.array([0.3, 0.8, 0.4, 0.3])
NOISE = 4.0
ROTATION = np.repeat([0.0, 30, -30, 0], [20, 80, 12, 24])
CLAMP = np.arange(136) >= 112


def one_group(name, people, median, rng, limits=LIMITS):
    """People whose reaches have noise that they see and learn from."""
    rotation = np.tile(ROTATION, (people, 1))
    clamp = np.tile(CLAMP, (people, 1))
    keeps_fast, learns_fast, keeps_slow, learns_slow = shares(median + SPREAD * rng.normal(size=(people, 4))).T
    fast = slow = np.zeros(people)
    hand = np.empty(rotation.shape)
    for n in range(hand.shape[1]):
        hand[:, n] = fast + slow + NOISE * rng.normal(size=people)
        error = np.where(clamp[:, n], 0, rotation[:, n] - hand[:, n])
        fast = keeps_fast * fast + learns_fast * limits.fast * np.tanh(error / limits.fast)
        slow = keeps_slow * slow + learns_slow * limits.slow * np.tanh(error / limits.slow)
    return Group(name, hand, rotation, clamp, np.ones(rotation.shape, bool))


def written(group, folder):
    people, trials = group.compensation.shape
    table = pd.DataFrame({
        "participant": np.repeat([f"p{i:02d}" for i in range(people)], trials), "trial": np.tile(np.arange(1, trials + 1), people),
        "rotation_deg": group.rotation.ravel(), "clamp": group.clamp.ravel().astype(int), "feedback": "cursor",
        "compensation_deg": group.compensation.ravel() + 3,  # a bias, which the baseline reveals
    })  # fmt: skip
    table.loc[5, "compensation_deg"] = np.nan
    table.loc[7, "compensation_deg"] = 170  # a reach to the wrong target
    file = Path(folder, group.name + ".csv")
    table.to_csv(file, index=False)
    return file


class Calibration(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rng = np.random.default_rng(3)
        cls.medians = MEDIAN + BETWEEN * rng.normal(size=(4, 4))
        cls.folder = tempfile.TemporaryDirectory()
        cls.files = [written(one_group(f"lab{i}", 24, m, rng), cls.folder.name) for i, m in enumerate(cls.medians)]
        cls.found = dh.calibrate_population(cls.files)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_finds_the_medians_of_laboratories_and_the_spread_of_people(self):
        off = self.found.fit.groups - self.medians
        # a median of 24 people has a standard error of about a tenth, beside that of each person's own rates
        self.assertLess(np.abs(off.mean(0)).max(), 0.25, off)
        self.assertLess(np.abs(off).max(), 0.7, off)
        np.testing.assert_allclose(np.sqrt(np.diag(self.found.fit.people)), SPREAD, rtol=0.35)
        self.assertLess(abs(np.median(self.found.fit.noise) - NOISE), 0.4)

    def test_of_fewer_laboratories_is_less_sure_of_the_next_one(self):
        of_four = np.sqrt(np.diag(self.found.fit.laboratories))
        np.testing.assert_allclose(of_four, self.found.fit.groups.std(0, ddof=1) * np.sqrt(5 / 4) * 2.3534 / 1.6449, rtol=1e-4)

    def test_prefers_the_structure_from_which_people_were_made(self):
        likelihood = {name: dh.calibrate_population(self.files[:2], limits=limits).fit.likelihood
                      for name, limits in STRUCTURES.items()}  # fmt: skip
        self.assertEqual(max(likelihood, key=likelihood.get), "both processes limited", likelihood)

    def test_is_a_population_of_the_program(self):
        file = self.found.save(Path(self.folder.name, "mine.yaml"))
        self.assertEqual([problem.text() for problem in dh.check(file)], [])

    def test_reads_the_table_of_the_program_itself(self):
        table = pd.read_csv(self.files[0])
        own = table.rename(columns={"participant": "id", "trial": "trial_num", "rotation_deg": "perturbation",
                                    "compensation_deg": "compensation"}).drop(columns=["clamp", "feedback"])  # fmt: skip
        own["error_seen"] = np.where(table.clamp == 1, "no", "yes")
        file = Path(self.folder.name, "adaptation.csv")
        own.to_csv(file, index=False)
        again = dh.calibrate_population([file, self.files[1]]).fit
        first = dh.calibrate_population(self.files[:2]).fit
        np.testing.assert_allclose(again.median, first.median, atol=1e-9)

    def test_says_how_well_a_group_is_predicted_by_the_others(self):
        table = leave_one_out(self.found.groups[:3], laboratories=50)
        self.assertEqual(len(table), 3 * 8)
        self.assertTrue((table.low_90 <= table.low_50).all() and (table.low_50 <= table["median"]).all())
        inside = ((table.real >= table.low_90) & (table.real <= table.high_90)).mean()
        self.assertGreater(inside, 0.6)

    def test_refuses_what_it_cannot_use(self):
        good = pd.read_csv(self.files[0])
        bad = {
            "has no column trial": good.drop(columns="trial"),
            "has two rows for one trial of a person": pd.concat([good, good[:1]]),
            "has fewer than two people": good[good.participant == "p00"],
            "has no rotation": good.assign(rotation_deg=0, clamp=0),
            "has a column that is not numeric": good.assign(rotation_deg="30 degrees"),
        }
        for what, table in bad.items():
            with self.subTest(what):
                file = Path(self.folder.name, "bad.csv")
                table.to_csv(file, index=False)
                with self.assertRaises(dh.Error) as refused:
                    dh.calibrate_population([self.files[0], file])
                self.assertIn(f"bad.csv: error: {what}", refused.exception.problems[0].text())
        for files, what in (([self.files[0]], "is the only group"), ([self.files[0], "none.csv"], "cannot be read")):
            with self.subTest(what), self.assertRaises(dh.Error) as refused:
                dh.calibrate_population(files)
            self.assertIn(what, str(refused.exception))

    def test_is_a_command(self):
        out = Path(self.folder.name, "by-command.yaml")
        command = [os.environ.get("DIHAPTIC", "build/release/dihaptic"), "calibrate-population", *map(str, self.files[:2])]
        made = subprocess.run([*command, "--out", str(out)], capture_output=True, text=True)
        self.assertEqual(made.returncode, 0, made.stderr)
        self.assertIn("slow_learning", made.stdout)
        self.assertIn("lab0 (24), lab1 (24)", out.read_text())
        for words, what in ((command[:3], "is the only group"), ([*command, "--out", str(out)], "exists already")):
            with self.subTest(what):
                wrong = subprocess.run(words, capture_output=True, text=True)
                self.assertEqual(wrong.returncode, 2)
                self.assertIn(what, wrong.stderr)
        self.assertIn("lab0 (24), lab1 (24)", out.read_text())


class Learner(unittest.TestCase):
    def test_without_limits_is_the_two_rate_model(self):
        rates = (0.6, 0.2, 0.99, 0.03)
        group = Group("one", np.zeros((1, 136)), ROTATION[None], CLAMP[None], np.ones((1, 136), bool))
        logits = np.log(np.array([rates]) / (1 - np.array([rates])))
        x = learn(logits, np.zeros(1), group, Limits())[0]
        fast = slow = 0.0
        for n in range(136):
            self.assertAlmostEqual(x[n], fast + slow, places=10)
            error = 0 if CLAMP[n] else ROTATION[n] - fast - slow
            fast, slow = rates[0] * fast + rates[1] * error, rates[2] * slow + rates[3] * error

    def test_weakens_a_limited_process_by_noise_as_the_mean_over_noise_does(self):
        rng = np.random.default_rng(1)
        for error in (1.0, 5, 10, 30):
            mean = np.mean(7 * np.tanh((error + 5 * rng.normal(size=200_000)) / 7))
            near = 7 * np.tanh(error / np.sqrt(49 + np.pi / 2 * 25))
            self.assertLess(abs(near - mean), 0.25, error)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
