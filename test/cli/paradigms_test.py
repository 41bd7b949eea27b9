"""Classic paradigms of experiments/: each is checked, rehearsed by two simulated people, and replayed, and what comes out
has the shape that its header promises.

Usage: paradigms_test.py PROGRAM, from the project's folder.
"""
import csv
import math
import os
import pathlib
import statistics
import tempfile
import unittest
from statistics import fmean, median

from program import dihaptic


class Rehearsal:
    """Tables of all people who did an experiment, and what `check` says about the experiment."""

    def __init__(self, test, name, people=2, **changes):
        folder = tempfile.TemporaryDirectory()
        test.addCleanup(folder.cleanup)
        text = pathlib.Path(f"experiments/{name}.yaml").read_text().replace("../", os.getcwd() + "/")
        for key, (old, new) in changes.items():
            test.assertIn(f"{key}: {old}", text)
            text = text.replace(f"{key}: {old}", f"{key}: {new}")
        file = pathlib.Path(folder.name, name + ".yaml")
        file.write_text(text)
        checked = dihaptic("check", str(file))
        test.assertEqual(checked.returncode, 0, checked.stdout)
        self.warnings = [line for line in checked.stdout.splitlines() if "warning" in line and ": warning:" in line]
        self.out = folder.name + "/out"
        self.test = test
        self.run("rehearse", str(file), "--people", str(people), "--out", self.out, "--keep-recordings")
        self.run("replay", self.out + "/sim-001")
        self.run("report", self.out, "--tables")
        self.run("report", self.out + "/sim-001")
        self.page = pathlib.Path(self.out, "sim-001", "report.html").read_text()
        self.people = [self.table(f"sim-{i + 1:03}/trials.csv") for i in range(people)]
        self.trials = [row for rows in self.people for row in rows]
        test.assertTrue(all(row["outcome"] for row in self.trials))

    def run(self, *arguments):
        result = dihaptic(*arguments)
        self.test.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def table(self, name):
        with open(f"{self.out}/{name}") as file:
            return list(csv.DictReader(file))


def numbers(rows, column):
    return [float(row[column]) for row in rows if row[column]]


def where(rows, **cells):
    return [row for row in rows if all(row[column] == cell for column, cell in cells.items())]


def line(x, y):
    """Slope and r of y over x."""
    return statistics.linear_regression(x, y).slope, statistics.correlation(x, y)


class Paradigms(unittest.TestCase):
    def test_load_steps(self):
        done = Rehearsal(self, "load-steps", repeats=("8", "4"))
        self.assertEqual(done.warnings, [])
        loaded = where(done.trials, kind="perturbed")
        latency = {name: numbers(where(loaded, condition=name), "grip_latency_s")
                   for name in ["step", "4 N per s", "2 N per s"]}
        # a reflex latency of 75 ms, plus the delays of the load and the muscle
        self.assertEqual(len(latency["step"]), 8)
        self.assertTrue(all(0.04 < t < 0.15 for t in latency["step"]), latency)
        # a ramp has to grow by 15 % of a weight of 1 N before it is answered: 37 ms at 4 N/s, twice that at 2 N/s
        medians = [median(latency[name]) for name in latency]
        self.assertTrue(all(0.02 < b - a < 0.15 for a, b in zip(medians, medians[1:])), medians)
        for row in where(done.trials, kind="catch"):
            self.assertEqual(row["grip_latency_s"], "")
            self.assertIn("grip_latency: grip did not respond", row["not_measured"])
        for rows in done.people:
            waits = numbers(rows, "foreperiod_s")
            self.assertEqual(len(set(waits)), len(waits))
            self.assertTrue(all(1 <= t <= 3 for t in waits))
        self.assertIn('data-name="measures-by-rise-ms', done.page)

    def test_size_weight(self):
        done = Rehearsal(self, "size-weight", repeats=("20", "10"))
        self.assertEqual(len(done.warnings), 1, done.warnings)
        self.assertIn("is a rating, for which there is no model", done.warnings[0])
        self.assertTrue(all(row["outcome"] == "rated" for row in done.trials))
        self.assertTrue(all(1 <= answer <= 9 for answer in numbers(done.trials, "heaviness")))
        first, last = [], []  # rate of load force for the large cube over that for the small one
        for rows in done.people:
            small, large = (numbers(where(rows, condition=name), "peak_load_rate_N_s") for name in ["small", "large"])
            self.assertEqual((len(small), len(large)), (10, 10))
            first.append(large[0] / small[0])
            last.append(median(large[-5:]) / median(small[-5:]))
        # a cube of 1 g/cm^3 would weigh 4.5 times as much as the other, and be loaded 3.5 times as fast
        self.assertGreater(fmean(first), 1.5)
        self.assertAlmostEqual(fmean(last), 1, delta=0.3)

    def test_curl_field(self):
        done = Rehearsal(self, "curl-field")
        self.assertEqual(done.warnings, [])
        blocks = ["without the field", "field", "washout"]
        index = {block: [numbers(where(rows, block=block, kind="force_channel"), "adaptation_index") for rows in done.people]
                 for block in blocks}
        before = fmean(fmean(one) for one in index["without the field"])
        late = fmean(fmean(one[-5:]) for one in index["field"])
        after = fmean(fmean(one[-2:]) for one in index["washout"])
        self.assertAlmostEqual(before, 0, delta=0.25)
        self.assertGreater(late, before + 0.25)
        self.assertLess(late, 1)
        self.assertLess(after, late - 0.15)
        # the plane that holds every trial does not count as a channel
        for row in done.trials:
            if row["kind"] != "force_channel":
                self.assertEqual(row["adaptation_index"], "")
                self.assertEqual(float(row["field_share"]), 1 if row["block"] == "field" else 0)
        free = {block: [numbers([row for row in where(rows, block=block) if row["kind"] != "force_channel"],
                                "lateral_deviation_at_peak_speed_mm") for rows in done.people] for block in blocks}
        early = fmean(fmean(one[:4]) for one in free["field"])
        learned = fmean(fmean(one[-10:]) for one in free["field"])
        aftereffect = fmean(fmean(one[:4]) for one in free["washout"])
        self.assertLess(early, -8)
        self.assertGreater(learned, early / 1.3)
        self.assertGreater(aftereffect, 2)
        # for each person, and regardless of the swing back, the field pushes to one side, and the after-effect goes to
        # the other
        for rows in done.people:
            first = [numbers([row for row in where(rows, block=block) if row["kind"] != "force_channel"], "lateral_deviation_mm")
                     for block in ("field", "washout")]
            self.assertLess(max(first[0][:4]), 0, first[0][:4])
            self.assertGreater(first[1][0], 0, first[1][:4])
        self.assertIn("adaptation index", done.page)

    def test_unexpected_weight(self):
        done = Rehearsal(self, "unexpected-weight", repeats=("18", "12"), count=("3", "2"))
        self.assertEqual(done.warnings, [])

        def rate(block, perturbation):
            return median(numbers(where(done.trials, block=block, perturbation=perturbation), "peak_load_rate_N_s"))

        # the expected load divided by its rise time, 1.1 W / (0.16 s + 0.028 s/N W), is 1.6 times as large for 400 g
        self.assertGreater(rate("400 g expected", "400 g"), 1.25 * rate("200 g expected", "200 g"))
        self.assertGreater(rate("400 g expected", "200 g"), 1.25 * rate("200 g expected", "200 g"))
        self.assertLess(rate("200 g expected", "400 g"), 0.8 * rate("400 g expected", "400 g"))
        # a block heavier than expected lifts off late, after a second rise of force; a lighter one lifts off early
        loading = {}
        for i, rows in enumerate(done.people):
            of = {row["trial_num"]: (row["block"], row["perturbation"]) for row in rows}
            for lift in done.table(f"sim-{i + 1:03}/lifts.csv"):
                loading.setdefault(of[lift["trial_num"]], []).extend(numbers([lift], "loading_s"))
        loading = {key: median(values) for key, values in loading.items()}
        self.assertGreater(loading["200 g expected", "400 g"], 1.5 * loading["400 g expected", "400 g"])
        self.assertLess(loading["400 g expected", "200 g"], loading["200 g expected", "200 g"])
        for rows in done.people:
            for block in ["200 g expected", "400 g expected"]:
                kinds = [row["kind"] for row in where(rows, block=block)]
                places = [i for i, kind in enumerate(kinds) if kind == "catch"]
                self.assertEqual(len(places), 2)
                self.assertGreater(places[1] - places[0], 5)
                self.assertGreater(places[0], 0)
            told = where(rows, block="told by colour")
            self.assertEqual({row["condition"] for row in told}, {"blue", "red"})

    def test_friction_discrimination(self):
        done = Rehearsal(self, "friction-discrimination")
        self.assertEqual(len(done.warnings), 2, done.warnings)
        self.assertTrue(all("answers and threshold are arbitrary" in warning for warning in done.warnings))
        answered = [row for row in done.trials if row["outcome"].startswith("said")]
        self.assertEqual(len(answered), 80)
        right = fmean(row["outcome"] == "said " + row["procedure"] for row in answered)
        self.assertAlmostEqual(right, 0.5, delta=4 * 0.5 / math.sqrt(80))
        rows = done.table("sim-001/thresholds.csv")  # the report's
        self.assertEqual([row["procedure"] for row in rows], ["left", "right"])
        self.assertEqual([row["trials"] for row in rows], ["20", "20"])

    def test_fitts_law(self):
        done = Rehearsal(self, "fitts-law")
        self.assertEqual(done.warnings, [])
        self.assertIn('data-name="measures-by-distance-mm', done.page)
        reaches = where(done.trials, block="reaches", outcome="hit")
        times, reactions = {}, {}
        for row in reaches:
            difficulty = math.log2(2 * float(row["distance_mm"]) / float(row["width_mm"]))
            times.setdefault(difficulty, []).append(float(row["movement_time_s"]))
            reactions.setdefault(difficulty, []).append(float(row["reaction_time_s"]))
        self.assertEqual(len(times), 5)
        ids = sorted(times)
        slope, r = line(ids, [fmean(times[i]) for i in ids])
        # a further stroke takes 0.2 s, and begins when the error of the first has been seen for about 0.16 s: nearly every
        # reach needs one at 5.3 bits, and at most half of them at 1.3
        self.assertTrue(0.03 < slope < 0.15, slope)
        self.assertGreater(r, 0.85)
        # medians, since a reaction now and then takes a second
        slope, _ = line(ids, [median(reactions[i]) for i in ids])
        self.assertLess(abs(slope), 0.02)


if __name__ == "__main__":
    unittest.main(verbosity=2)
