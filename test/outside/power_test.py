"""Power as users of other programs have found it wrong. docs/outside.md has the sources.

Usage: outside/power_test.py PROGRAM, from the project's folder.
"""
import os
import re
import sys
import tempfile
import unittest

sys.path.append("test/cli")
from program import PROGRAM, dihaptic

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(PROGRAM)), "python"))
import numpy as np  # noqa: E402
import pandas as pd  # noqa: E402
from scipy import stats  # noqa: E402

from dihaptic.power_analysis.draws import find_effect, smallest_size  # noqa: E402
from dihaptic.power_analysis.evidence import bayes_factor, levels_of_factor, levels_of_looks  # noqa: E402

NORMAL = stats.norm.ppf((np.arange(5000) + 0.5) / 5000)


class Power(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.pool = os.path.join(folder.name, "pool")
        dihaptic("rehearse", "experiments/first-trials.yaml", "--people", "10", "--out", cls.pool)
        dihaptic("collect", cls.pool, "--out", cls.pool)

    def power(self, effect, *options, draws=200):
        out = self.enterContext(tempfile.TemporaryDirectory())
        said = dihaptic("power", self.pool, "--effect", effect, "--draws", str(draws), "--out", out, *options)
        self.assertEqual(said.returncode, 0, said.stderr)
        folder = os.path.dirname(said.stdout.splitlines()[-1])
        return said.stdout, pd.read_csv(os.path.join(folder, "power-by-n.csv"))

    def test_samples_without_a_test_are_told(self):
        pool = np.repeat([0.0, 1.0], [38, 2])  # a sample of few people has only zeros most of the time
        self.assertGreater(find_effect([pool], [4], 1000, "t", 0.05, 1).untested, 0.5)
        self.assertEqual(find_effect([NORMAL], [4], 1000, "t", 0.05, 1).untested, 0)
        self.assertTrue((self.power("mean(static_grip_N)", "--n", "8")[1].untested == 0).all())

    def test_effects_that_differ_in_a_sign_or_in_brackets_have_their_own_folders(self):
        out = self.enterContext(tempfile.TemporaryDirectory())
        effects = ["mean(static_grip_N)", "-mean(static_grip_N)", "(mean(static_grip_N) - mean(peak_grip_N)) - mean(preload_s)",
                   "mean(static_grip_N) - (mean(peak_grip_N) - mean(preload_s))"]  # fmt: skip
        for effect in effects:
            said = dihaptic("power", self.pool, f"--effect={effect}", "--n", "5", "--draws", "100", "--out", out)
            self.assertEqual(said.returncode, 0, said.stderr)
        self.assertEqual(len(os.listdir(out)), len(effects))

    def test_a_huge_effect_needs_the_fewest_people(self):
        sizes = smallest_size(lambda n: find_effect([NORMAL + 7, NORMAL], [n, n], 500, "t", 0.05, 1), 0.8, 1000)
        self.assertEqual(sizes, (3, 3, 3))

    def test_no_number_is_given_where_none_is_enough(self):
        sizes = smallest_size(lambda n: find_effect([NORMAL], [n], 500, "t", 0.05, 1), 0.8, 100)
        self.assertEqual(sizes, (None, None, None))

    def test_a_power_is_never_missing(self):
        for d in (0.0, 0.5, 0.66, 1, 3, 10):
            for n in (3, 5, 20, 100):
                self.assertTrue(0 <= find_effect([NORMAL + d], [n], 200, "t", 0.05, 1).power <= 1)

    def test_names_that_nobody_has_are_no_power_of_zero(self):
        for effect, meant in (("mean(static_grip)", "static_grip_N"), ("mean(static_grip_N, block=havy)", "block=heavy")):
            with tempfile.TemporaryDirectory() as out:
                said = dihaptic("power", self.pool, "--effect", effect, "--out", out)
                self.assertEqual((said.returncode, os.listdir(out)), (2, []))
                self.assertIn(f"Did you mean '{meant}'", said.stderr)

    def test_fewer_people_than_in_the_pool_find_less(self):
        effect = "mean(static_grip_N, block=heavy) - mean(static_grip_N, block=light)"
        table = self.power(effect, "--n", "4,7,10,14", "--smallest-effect", "0.3", draws=2000)[1]
        self.assertTrue((table.power.diff()[1:] > 0.05).all(), table.power.tolist())

    def test_the_effect_need_not_be_the_one_that_the_pool_has(self):
        effect = "mean(static_grip_N, block=heavy) - mean(static_grip_N, block=light)"
        of_pool, half, small = (self.power(effect, "--n", "8", *more)[1].power[0]
                                for more in ((), ("--smallest-effect", "0.3"), ("--smallest-effect", "0.02")))
        self.assertGreater(of_pool, half)
        self.assertGreater(half, small)
        self.assertLess(small, 0.3)

    def test_the_ratio_is_that_of_the_second_group(self):
        wide = [3 * NORMAL + 2, NORMAL]  # it is the first group that needs more people
        few, many = (find_effect(wide, sizes, 4000, "welch", 0.05, 1).power for sizes in ([10, 20], [20, 10]))
        self.assertGreater(many, few + 0.1)
        said = dihaptic("power", "--help").stdout
        self.assertRegex(re.sub(r"\s+", " ", said), "number of people in the second group for one in the first")

    def test_groups_may_differ_in_spread_and_in_size(self):
        rng = np.random.default_rng(1)
        p = stats.ttest_ind(rng.normal(2, 3, (10, 20000)), rng.normal(0, 1, (25, 20000)), equal_var=False).pvalue
        found = find_effect([3 * NORMAL + 2, NORMAL], [10, 25], 4000, "welch", 0.05, 1)
        self.assertAlmostEqual(found.power, (p < 0.05).mean(), delta=0.03)

    def test_looks_after_half_and_three_quarters_have_the_levels_of_gsdesign(self):
        levels = levels_of_looks([0.5, 0.75, 1], 0.05)
        np.testing.assert_allclose(levels, [0.0031, 0.0183, 0.044], atol=6e-5)
        np.testing.assert_allclose(stats.norm.isf(np.array(levels) / 2), [2.963, 2.359, 2.014], atol=6e-4)
        effect = "mean(static_grip_N, block=heavy) - mean(static_grip_N, block=light)"
        said = self.power(effect, "--n", "12,18,24", "--smallest-effect", "0.3", "--sequential")[0]
        self.assertIn("p is below 0.0031, 0.018 and 0.044, in turn", said)

    def test_an_early_look_spends_what_gsdesign_says(self):
        self.assertAlmostEqual(levels_of_looks([0.2587722, 1], 0.05)[0] / 2 / 1.052152e-05, 1, delta=1e-5)

    def test_a_look_shortly_before_the_end_has_a_level(self):
        for share in (0.9, 0.99, 0.999, 0.9999):
            first, last = levels_of_looks([share, 1], 0.05)
            self.assertTrue(0 < last < 0.05 and 0 < first < 0.05, (share, first, last))

    def test_an_extreme_t_has_a_bayes_factor_without_end(self):
        self.assertEqual(bayes_factor(1000, [100, 100]), float("inf"))
        self.assertEqual(bayes_factor(-1000, [100, 100]), float("inf"))

    def test_a_hundred_thousand_values_have_a_bayes_factor(self):
        for sizes in ([51000, 51159], [10000]):
            self.assertTrue(0 < bayes_factor(2, sizes) < 1)
            self.assertTrue(0 < levels_of_factor(3, sizes)[0] < levels_of_factor(3, sizes)[1] < 1)


unittest.main(argv=sys.argv[:1])
