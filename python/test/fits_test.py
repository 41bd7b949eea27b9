"""Fits and lifts of the package are those of the program, on arrays of one's own."""

import csv
import json
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

import dihaptic as dh
from dihaptic.program import program


def two_rates(n, retention, learning, perturbation):
    slow = fast = 0.0
    out = []
    for trial in range(n):
        out.append(slow + fast)
        error = perturbation[trial] - slow - fast
        slow = retention[0] * slow + learning[0] * error
        fast = retention[1] * fast + learning[1] * error
    return np.array(out)


class Fits(unittest.TestCase):
    def test_two_rate_is_the_command_s(self):
        draw = np.random.default_rng(5)
        perturbation = np.where(np.arange(120) < 100, 30.0, -30.0)
        measured = two_rates(120, (0.99, 0.6), (0.03, 0.2), perturbation) + draw.normal(0, 2, 120)
        measured[::17] = np.nan
        fit = dh.fit_two_rate(measured, perturbation)
        with tempfile.TemporaryDirectory() as folder:
            table = pathlib.Path(folder) / "person.csv"
            with open(table, "w", newline="") as file:
                rows = csv.writer(file)
                rows.writerow(["perturbation", "clamp", "compensation"])
                for p, c in zip(perturbation, measured):
                    rows.writerow([p, 0, "" if np.isnan(c) else repr(float(c))])
            said = subprocess.run([program(), "fit", "two_rate", table, "--json"], capture_output=True, text=True, check=True)
        told = json.loads(said.stdout)
        for key in ("retention_slow", "learning_slow", "retention_fast", "learning_fast", "sse", "n"):
            self.assertAlmostEqual(told[key], getattr(fit, key), places=9, msg=key)
        for key, (low, high) in fit.intervals.items():
            self.assertTrue(low <= getattr(fit, key) <= high, key)
        residuals = (measured - fit.predicted)[~np.isnan(measured)]
        self.assertAlmostEqual(float(residuals @ residuals), fit.sse, places=6)

    def command(self, model, columns, *options):
        with tempfile.TemporaryDirectory() as folder:
            table = pathlib.Path(folder) / "person.csv"
            with open(table, "w", newline="") as file:
                rows = csv.writer(file)
                rows.writerow(columns)
                rows.writerows(zip(*(np.asarray(column).astype(float if key in ("compensation", "level") else int).tolist() for key, column in columns.items())))
            text = subprocess.run([program(), "fit", model, table, *options], capture_output=True, text=True, check=True)
            self.assertIn("95 %", text.stdout)
            said = subprocess.run([program(), "fit", model, table, "--json", *options], capture_output=True, text=True, check=True)
        return json.loads(said.stdout)

    def test_the_others_are_the_command_s_too(self):
        draw = np.random.default_rng(6)
        measured = 20 * (1 - np.exp(-np.arange(60) / 9)) + draw.normal(0, 1, 60)
        told = self.command("single_rate", {"perturbation": [30] * 60, "clamp": [0] * 60, "compensation": measured})
        fit = dh.fit_single_rate(measured, [30.0] * 60)
        for key in ("retention", "learning", "sse", "n"):
            self.assertAlmostEqual(told[key], getattr(fit, key), places=9, msg=key)
        told = self.command("learning_curve", {"compensation": measured})
        curve = dh.fit_learning_curve(measured)
        for key in ("start", "asymptote", "time_constant", "sse", "n"):
            self.assertAlmostEqual(told[key], getattr(curve, key), places=9, msg=key)
        levels = np.repeat([1.0, 2, 3, 4, 5, 6], 20)
        answers = draw.random(120) < 0.5 + 0.5 / (1 + np.exp(-(levels - 3.3) / 0.5))
        told = self.command("psychometric", {"level": levels, "yes": answers}, "--sigmoid", "logistic", "--max-lapse", "0.02")
        answered = dh.fit_psychometric(levels, answers, sigmoid="logistic", max_lapse=0.02)
        for key in ("threshold", "shape", "lapse", "guess", "deviance"):
            self.assertAlmostEqual(told[key], getattr(answered, key), places=9, msg=key)
        self.assertEqual(told["n"], 120)

    def test_the_command_tells_what_is_wrong(self):
        for model, text, what in [
            ("single_rate", "perturbation,clamp\n1,0\n", "1: error: compensation: does not exist"),
            ("single_rate", "perturbation,clamp,compensation\n1,0,2\n1,0,3\n", "is measured in 2 trials"),
            ("learning_curve", "compensation\n1\n\nx\n", "error: compensation: is 'x'"),
            ("psychometric", "level,yes\n1,maybe\n", "2: error: yes: is 'maybe'"),
            ("psychometric", "level,yes\n1,1\n1,0\n", "level"),
        ]:
            with self.subTest(what), tempfile.TemporaryDirectory() as folder:
                table = pathlib.Path(folder) / "person.csv"
                table.write_text(text)
                done = subprocess.run([program(), "fit", model, table], capture_output=True, text=True)
                self.assertEqual(done.returncode, 2)
                self.assertIn(what, done.stderr)

    def test_a_clamp_teaches_nothing(self):
        perturbation = np.full(80, 20.0)
        clamp = np.arange(80) >= 50
        state, measured = 0.0, []
        for c in clamp:
            measured.append(state)
            state = 0.95 * state + (0 if c else 0.1 * (20 - state))
        fit = dh.fit_single_rate(measured, perturbation, clamp)
        self.assertAlmostEqual(fit.retention, 0.95, places=5)
        self.assertAlmostEqual(fit.learning, 0.1, places=5)

    def test_words_and_numbers_say_yes_and_no(self):
        perturbation, measured = np.full(40, 30.0), 25 * (1 - np.exp(-np.arange(40) / 8))
        clamp = np.arange(40) >= 30
        fits = [
            dh.fit_single_rate(measured, perturbation, given)
            for given in (clamp, clamp.astype(int), clamp.astype(float), ["yes" if c else "no" for c in clamp])
        ]
        self.assertEqual(len({fit.retention for fit in fits}), 1)

    def test_answers_and_counts_are_fitted_alike(self):
        draw = np.random.default_rng(2)
        levels = np.repeat([1.0, 2, 3, 4, 5, 6], 40)
        answers = draw.random(240) < 1 / (1 + np.exp(-(levels - 3.3) / 0.5))
        counts = [int(answers[levels == level].sum()) for level in range(1, 7)]
        one = dh.fit_psychometric(levels, answers, sigmoid="logistic", guess=0)
        other = dh.fit_psychometric(range(1, 7), yes=np.array(counts), trials=np.full(6, 40), sigmoid="logistic", guess=0)
        self.assertEqual(one, other)
        self.assertAlmostEqual(one.threshold, 3.3, delta=0.2)
        self.assertLess(one.intervals["threshold"][0], 3.3)
        self.assertGreater(one.intervals["threshold"][1], 3.3)
        np.testing.assert_allclose(one.probability([-50, 50]), [0, 1 - one.lapse], atol=1e-9)

    def test_bad_input_is_told(self):
        for what, call in [
            ("different lengths", lambda: dh.fit_two_rate([1, 2, 3, 4, 5, 6], [1, 2], [False])),
            ("the number of measurements differs", lambda: dh.fit_two_rate([1, 2, 3, 4, 5, 6], [1, 2])),
            ("", lambda: dh.fit_two_rate([1, np.nan], [1, 2])),
            ("", lambda: dh.fit_learning_curve([])),
            ("not a number in a trial", lambda: dh.fit_single_rate(np.arange(20.0), [np.nan] * 20)),
            ("is 0 in all trials", lambda: dh.fit_two_rate(np.arange(20.0), [0] * 20)),
            ("infinite", lambda: dh.fit_two_rate([np.inf] * 20, [1] * 20)),
            ("clamp: has 'nan'", lambda: dh.fit_two_rate(np.arange(20.0), [1] * 20, [np.nan] * 20)),
            ("answers: has '2'", lambda: dh.fit_psychometric([1, 2], [2, 1])),
            ("yes: has a number that is not whole", lambda: dh.fit_psychometric([1, 2], yes=[0.5, 1], trials=[2, 2])),
            ("there are no answers", lambda: dh.fit_psychometric([1, 2])),
            ("have different lengths", lambda: dh.fit_psychometric([1, 2], yes=[1], trials=[2, 2])),
            ("sigmoid", lambda: dh.fit_psychometric([1, 2], [True, False], sigmoid="cauchy")),
            ("guess", lambda: dh.fit_psychometric([1, 2], [True, False], guess=2)),
            ("guess", lambda: dh.fit_psychometric([1, 2], [True, False], guess="half")),
            ("max_lapse", lambda: dh.fit_psychometric([1, 2], [True, False], max_lapse=-1)),
            ("shape", lambda: dh.fit_psychometric([1, 2], [True, False], shape=0)),
            ("different lengths", lambda: dh.fit_psychometric([1, 2], [True])),
            ("", lambda: dh.fit_psychometric([1], yes=[3], trials=[2])),
            ("", lambda: dh.fit_psychometric([1, 2], yes=[3, 9], trials=[2, 3])),
        ]:
            with self.subTest(what), self.assertRaisesRegex(dh.Error, what):
                call()


class Lifts(unittest.TestCase):
    def test_forces_alone_tell_a_session_s_lift(self):
        """Late or early by what the rules from forces are late or early beside those from contacts."""
        with tempfile.TemporaryDirectory() as folder:
            session = dh.run("experiments/lift-block.yaml", out=folder, progress=False)
            contacts = session["contacts"]
            grip = np.column_stack([session[f"{f}.normal_force"] for f in session.fingers])
            # what a finger carries presses it down
            load = np.column_stack([-session[f"{f}.contact_force"][:, 2] for f in session.fingers])
            found = dh.find_lift(grip, load, session["block.position.z"], session.tick, 0.8)
            known = session.lifts.iloc[0]
        self.assertGreater(len(contacts), 0)
        for column in ("lift_off_s", "touch_s", "replacement_s"):
            self.assertAlmostEqual(found[column], known[column], delta=0.1, msg=column)
        for column in ("static_grip_N", "peak_grip_N", "height_mm"):
            self.assertAlmostEqual(found[column] / known[column], 1, delta=0.01, msg=column)
        self.assertEqual(found["events_by"], "force")

    def test_nothing_lifted_has_no_figures(self):
        still = np.zeros((1000, 2))
        found = dh.find_lift(still, still, np.zeros(1000), 0.001)
        self.assertEqual(found["lift"], "no touch")
        self.assertTrue(np.isnan(found["peak_grip_N"]))

    def test_bad_input_is_told(self):
        two = np.zeros((100, 2))
        for what, arguments in [
            ("no columns", (np.zeros(100), two, np.zeros(100), 0.001)),
            ("do not match", (two, np.zeros((99, 2)), np.zeros(100), 0.001)),
            ("do not match", (two, two, np.zeros(99), 0.001)),
            ("tick", (two, two, np.zeros(100), 0)),
            ("tick", (two, two, np.zeros(100), float("nan"))),
            ("friction", (two, two, np.zeros(100), 0.001, [1.0, -1.0])),
            ("not a number", (np.full((100, 2), np.nan), two, np.zeros(100), 0.001)),
            ("sample", (np.zeros((0, 2)), np.zeros((0, 2)), np.zeros(0), 0.001)),
        ]:
            with self.subTest(what), self.assertRaisesRegex(dh.Error, what):
                dh.find_lift(*arguments)


if __name__ == "__main__":
    unittest.main()
