"""Rates of learning fitted to groups of people: those from which the groups were made are found again."""

import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import numpy as np
import pandas as pd

sys.path.insert(0, str(Path(__file__).parents[2] / "test"))

import dihaptic as dh  # noqa: E402
import soak  # noqa: E402
from dihaptic.calibration import LIMITS, STRUCTURES, _correlations, leave_one_out  # noqa: E402
from dihaptic.calibration.learner import Group, Limits, learn, shares  # noqa: E402
from dihaptic.calibration.reading import read_group  # noqa: E402

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

    @soak.alone
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
        own["unit"] = "deg"
        own["error_seen"] = np.where(table.clamp == 1, "no", "yes")
        file = Path(self.folder.name, "adaptation.csv")
        own.to_csv(file, index=False)
        again = dh.calibrate_population([file, self.files[1]]).fit
        first = dh.calibrate_population(self.files[:2]).fit
        np.testing.assert_allclose(again.median, first.median, atol=1e-9)

    @soak.alone
    def test_says_how_well_a_group_is_predicted_by_the_others(self):
        table = leave_one_out(self.found.groups[:3], laboratories=50)
        self.assertEqual(len(table), 3 * 8)
        self.assertTrue((table.low_90 <= table.low_50).all() and (table.low_50 <= table["median"]).all())
        inside = ((table.real >= table.low_90) & (table.real <= table.high_90)).mean()
        self.assertGreater(inside, 0.6)

    def bad(self, table, **options):
        file = Path(self.folder.name, "bad.csv")
        if isinstance(table, bytes):
            file.write_bytes(table)
        else:
            table.to_csv(file, index=False, **options)
        return file

    def test_refuses_what_it_cannot_use(self):
        good = pd.read_csv(self.files[0])
        angles = ["rotation_deg", "compensation_deg"]
        learned = good.assign(compensation_deg=good.compensation_deg.where(good.trial <= 20, good.rotation_deg - 1))

        def at(row, **values):
            table = good.astype(object)
            for column, value in values.items():
                table.loc[row, column] = value
            return table

        bad = {
            "has no column trial. It needs": good.drop(columns="trial"),
            "26: error: trial: is a second row for this trial of the person: 1": pd.concat([good[:24], good[:1]]),
            "has fewer than two people with 10 measured reaches": good[good.participant == "p00"],
            "rotation_deg: has no rotation": good.assign(rotation_deg=0, clamp=0),
            "2: error: rotation_deg: is not a number: 30 degrees": good.assign(rotation_deg="30 degrees"),
            "5: error: compensation_deg: is not a number: inf": at(3, compensation_deg=np.inf),
            "5: error: rotation_deg: is missing. Write 0": at(3, rotation_deg=np.nan),
            "12: error: trial: is not a number: x": at(10, trial="x"),
            "12: error: trial: is not a whole number: 3.5": at(10, trial=3.5),
            "9: error: clamp: is neither 0 nor 1: -1": at(7, clamp=-1),
            "8: error: clamp: is not a number: no": at(6, clamp="no"),
            "7: error: feedback: is not known: endpoint. Write none or cursor": at(5, feedback="endpoint"),
            "4: error: participant: is missing": at(2, participant=""),
            "as if angles were in radians": good.assign(**np.deg2rad(good[angles] - [0, 3]).clip(-1, 1)),
            "degrees the wrong way on average. Give compensation_deg the sign of the rotation":
                learned.assign(rotation_deg=-good.rotation_deg),
            "reaches beyond 90 degrees. Give angles to the target": good.assign(compensation_deg=-good.compensation_deg % 360),
            "has rows in %. Leave them out": good.rename(columns={"participant": "id", "compensation_deg": "compensation"}).assign(unit="%"),
        }  # fmt: skip
        for what, table in bad.items():
            with self.subTest(what), self.assertRaises(dh.Error) as refused:
                dh.calibrate_population([self.files[1], self.bad(table)])
            self.assertIn(what, refused.exception.problems[0].text())
            self.assertIn("bad.csv", refused.exception.problems[0].text())
        with self.assertRaisesRegex(dh.Error, "has columns that are not separated by commas"):
            dh.calibrate_population([self.files[1], self.bad(good, sep=";")])
        for content, what in ((b"PK\x03\x04", "has no column participant|is not a table"), (b"", "is not a table: No columns to parse"),
                              (b"a,b\n1,2,3,4\n\xff\xfe", "is not a table")):
            with self.subTest(content), self.assertRaisesRegex(dh.Error, what):
                dh.calibrate_population([self.files[1], self.bad(content)])
        for files, what in (([self.files[0]], "is the only group"), ([self.files[0], "none.csv"], "cannot be read: No such file"),
                            ([self.files[0], self.folder.name], "cannot be read: Is a directory"),
                            ([self.files[0], self.files[1], self.files[0]], "lab0.csv: error: is named twice")):
            with self.subTest(what), self.assertRaises(dh.Error) as refused:
                dh.calibrate_population(files)
            self.assertIn(what, str(refused.exception))

    def test_reads_what_spreadsheets_write(self):
        good = pd.read_csv(self.files[0])
        first = read_group(self.files[0]).group
        ways = {
            "a mark, CRLF, words in capitals": good.assign(feedback="Cursor").to_csv(index=False, lineterminator="\r\n").encode("utf-8-sig"),
            "another order of rows": good.sample(frac=1, random_state=1).to_csv(index=False).encode(),
            "no column of feedback": good.drop(columns="feedback").to_csv(index=False).encode(),
        }
        for what, content in ways.items():
            with self.subTest(what):
                again = read_group(self.bad(content)).group
                np.testing.assert_allclose(again.compensation, first.compensation, atol=1e-12)  # rounded when written
                np.testing.assert_array_equal(again.seen, first.seen)
        people = good.assign(participant=good.participant.replace({"p00": "1", "p01": "01", "p02": "NA"}))
        self.assertEqual(read_group(self.bad(people)).group.people, 24)
        self.assertTrue((~read_group(self.bad(good.assign(feedback="None"))).group.seen).all())

    def test_names_whom_and_what_it_leaves_out(self):
        good = pd.read_csv(self.files[0])
        good.loc[good.participant == "p03", "compensation_deg"] = np.nan
        stray = pd.DataFrame({"participant": ["p99"], "trial": [1], "rotation_deg": [0]})
        read = read_group(self.bad(pd.concat([good, stray])))
        self.assertEqual(read.group.people, 23)
        self.assertTrue(np.isfinite(np.nanmean(read.group.compensation, 1)).all())
        self.assertRegex("; ".join(read.left_out), "^1 of 31.. reaches, which went farther than 90 degrees astray; "
                         "p03, of whom 0 reaches were measured.*; p99, of whom 0 reaches")

    def test_few_groups_give_a_population_with_a_warning(self):
        for count in (2, 3):
            with self.subTest(count):
                found = dh.calibrate_population(self.files[:count])
                file = found.save(Path(self.folder.name, f"of-{count}.yaml"))
                self.assertEqual([problem.text() for problem in dh.check(file)], [])
                self.assertIn(f"# Warning: {count} groups hardly determine how laboratories differ", file.read_text())

    def test_any_correlations_become_those_of_a_population(self):
        rng = np.random.default_rng(2)
        for groups in (2, 3, 4, 5, 6):
            for _ in range(50):
                medians = rng.normal(size=(groups, 4)) @ rng.normal(size=(4, 4))
                found = _correlations(np.cov(medians.T))
                np.linalg.cholesky(found)
                np.testing.assert_array_equal(found, np.round(found, 2))
        exact = np.array([[1, 0.5, 0, 0], [0.5, 1, 0, 0], [0, 0, 1, -0.3], [0, 0, -0.3, 1]])
        np.testing.assert_array_equal(_correlations(exact * 4), exact)
        self.assertTrue(np.isfinite(_correlations(np.zeros((4, 4)))).all())

    def test_people_who_do_not_learn_are_no_population(self):
        rng = np.random.default_rng(4)
        files = []
        for name in ("still1", "still2"):
            group = one_group(name, 6, MEDIAN, rng)
            group.compensation = np.zeros_like(group.compensation)
            files.append(written(group, self.folder.name))
        file = Path(self.folder.name, "still.yaml")
        with self.assertRaisesRegex(dh.Error, "these groups give rates that are none of people: .* Check the signs and units"):
            dh.calibrate_population(files).save(file)
        self.assertFalse(file.exists())

    def test_is_a_command(self):
        out = Path(self.folder.name, "by-command.yaml")
        command = [os.environ.get("DIHAPTIC", "build/release/dihaptic"), "calibrate-population", *map(str, self.files[:2])]
        made = subprocess.run([*command, "--out", str(out)], capture_output=True, text=True)
        self.assertEqual(made.returncode, 0, made.stderr)
        self.assertIn("slow_learning", made.stdout)
        self.assertIn("lab0 (24), lab1 (24)", out.read_text())
        self.assertIn("warning: 2 groups hardly determine", made.stderr)
        self.assertIn("lab0: left out 1 of 32", made.stderr)
        for words, what in ((command[:3], "is the only group"), ([*command, "--out", str(out)], "exists already"),
                            ([*command, "--out", self.folder.name], "--out: is a folder"),
                            ([*command, "--out", str(out) + "/x.yaml"], "is in a folder that does not exist")):
            with self.subTest(what):
                wrong = subprocess.run(words, capture_output=True, text=True)
                self.assertEqual(wrong.returncode, 2)
                self.assertIn(what, wrong.stderr)
        self.assertIn("lab0 (24), lab1 (24)", out.read_text())

    def interrupted(self, after, interrupt):
        """How the command ends, what it says, and that it writes nothing, if `interrupt` is called after this time."""
        out = Path(self.folder.name, "never.yaml")
        many = [shutil.copy(file, Path(self.folder.name, f"{n}-{file.name}")) for n in range(20) for file in self.files]
        command = [os.environ.get("DIHAPTIC", "build/release/dihaptic"), "calibrate-population", *map(str, many)]
        running = subprocess.Popen(
            [*command, "--out", str(out)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
        )
        time.sleep(after)
        interrupt(running)
        told = running.communicate(timeout=60)[1]
        self.assertFalse(out.exists())
        return running.returncode, told

    def test_ends_when_it_is_told_to(self):
        for name in ("SIGTERM", "SIGINT"):
            with self.subTest(name):
                ended, told = self.interrupted(3, lambda running: running.send_signal(getattr(signal, name)))
                self.assertEqual(ended, 130, told)
                self.assertIn("interrupted: nothing more was written", told)

    def test_ctrl_c_is_not_taken_for_a_fault(self):
        # a terminal sends it to the program and to Python, which first loads its packages, and then reads the files
        for after in (0.4, 0.6, 0.8, 1, 1.2):
            with self.subTest(after=after):
                ended, told = self.interrupted(after, lambda running: os.killpg(running.pid, signal.SIGINT))
                self.assertIn(ended, (1, 130), told)
                self.assertIn("interrupted", told)
                self.assertEqual(told.count("\n"), 1, told)


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
