"""Power from a pool of simulated people, against closed forms and against samples that are drawn here."""

import os
import re
import subprocess
import sys
import tempfile
import unittest
import unittest.mock
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
from scipy import stats

os.environ.setdefault("MPLBACKEND", "agg")
import dihaptic as dh  # noqa: E402
from dihaptic import figures  # noqa: E402
from dihaptic.power_analysis.draws import find_effect, look_repeatedly, smallest_size  # noqa: E402
from dihaptic.power_analysis.effect import Effect  # noqa: E402
from dihaptic.power_analysis.evidence import bayes_factor, levels_of_factor, levels_of_looks  # noqa: E402
from dihaptic.power_analysis.page import warnings_of  # noqa: E402

sys.path.insert(0, str(Path(__file__).parents[2] / "test"))
import needs  # noqa: E402
import soak  # noqa: E402

DIFFERENCE = "mean(static_grip_N, block=heavy) - mean(static_grip_N, block=light)"
#: People whose values are normal to the last digit, so that a pool is no source of error.
NORMAL = stats.norm.ppf((np.arange(20000) + 0.5) / 20000)


def of_t(shift, free, alpha):
    """The power of a two-sided t test whose statistic is (z + shift) / sqrt(chi2 / free): the noncentral t distribution."""
    scales = np.sqrt(stats.chi2.ppf((np.arange(20000) + 0.5) / 20000, free) / free) * stats.t.ppf(1 - alpha / 2, free)
    return float(np.mean(stats.norm.sf(scales - shift) + stats.norm.cdf(-scales - shift)))


def of_one_sample(d, n, alpha=0.05):
    """The power with n values whose mean is d of their SD."""
    return of_t(d * np.sqrt(n), n - 1, alpha)


def of_two_samples(d, n, m, alpha=0.05):
    """The power with two groups of one SD."""
    return of_t(d * np.sqrt(n * m / (n + m)), n + m - 2, alpha)


class Draws(unittest.TestCase):
    """Each interval is one of 99.9 %: a test of dozens of them fails once in some hundred seeds."""

    def assert_power(self, found, power):
        self.assertLess(abs(found.power - power), 3.3 * np.sqrt(power * (1 - power) / found.draws) + 1e-3, (found, power))

    def test_t_tests_have_the_power_of_the_noncentral_t(self):
        for seed, (d, n) in enumerate([(0.3, 40), (0.5, 12), (0.5, 30), (0.8, 8), (0.8, 16), (1.2, 6), (2, 4)]):
            with self.subTest(d=d, n=n):
                self.assert_power(find_effect([NORMAL + d], [n], 4000, "t", 0.05, seed), of_one_sample(d, n))
                self.assert_power(find_effect([NORMAL + d], [n], 4000, "t", 0.01, seed), of_one_sample(d, n, 0.01))
                for m in (n, 2 * n):
                    found = find_effect([NORMAL + d, NORMAL], [n, m], 4000, "t", 0.05, seed)
                    self.assert_power(found, of_two_samples(d, n, m))

    def test_t_tests_agree_with_power_t_test_of_r(self):
        needs.for_this_test("Rscript", "r-base-core")
        designs = [(0.3, 20), (0.5, 12), (0.5, 34), (0.8, 8), (0.8, 26), (1.5, 5)]
        calls = [f'cat(power.t.test(n={n}, delta={d}, sd=1, type="{kind}", strict=TRUE)$power, "\\n")'
                 for d, n in designs for kind in ("one.sample", "two.sample")]  # fmt: skip
        said = subprocess.run(["Rscript", "-e", "; ".join(calls)], capture_output=True, text=True, check=True).stdout
        powers = iter(map(float, said.split()))
        for d, n in designs:
            with self.subTest(d=d, n=n):
                self.assert_power(find_effect([NORMAL + d], [n], 4000, "t", 0.05, 11), next(powers))
                self.assert_power(find_effect([NORMAL + d, NORMAL], [n, n], 4000, "t", 0.05, 11), next(powers))

    def test_one_sided_tests_agree_with_power_t_test_of_r(self):
        needs.for_this_test("Rscript", "r-base-core")
        designs = [(0.3, 20), (0.8, 8), (1.5, 5)]
        calls = [f'cat(power.t.test(n={n}, delta={d}, sd=1, type="{kind}", alternative="one.sided")$power, "\\n")'
                 for d, n in designs for kind in ("one.sample", "two.sample")]  # fmt: skip
        said = subprocess.run(["Rscript", "-e", "; ".join(calls)], capture_output=True, text=True, check=True).stdout
        powers = iter(map(float, said.split()))
        for d, n in designs:
            for pool, sizes in (([NORMAL + d], [n]), ([NORMAL + d, NORMAL], [n, n])):
                with self.subTest(d=d, n=n, groups=len(sizes)):
                    found = find_effect(pool, sizes, 4000, "t", 0.05, 11, alternative="greater")
                    self.assert_power(found, next(powers))
                    self.assertEqual(found.wrong_sign, 0)
                    # the interval is that with 5 % outside on each side
                    self.assertEqual(found.half_width, find_effect(pool, sizes, 4000, "t", 0.1, 11).half_width)

    def test_one_sided_tests_hold_their_level_and_find_nothing_on_the_other_side(self):
        for test, pool, sizes in (("t", [NORMAL], [15]), ("welch", [NORMAL, NORMAL], [15, 15]), ("wilcoxon", [NORMAL], [15]),
                                  ("wilcoxon", [NORMAL, NORMAL], [15, 15])):  # fmt: skip
            with self.subTest(test, groups=len(sizes)):
                found = find_effect(pool, sizes, 4000, test, 0.05, 3, alternative="less")
                self.assertTrue(0.035 < found.power < 0.062, found)
                other = find_effect([pool[0] + 1, *pool[1:]], sizes, 1000, test, 0.05, 3, alternative="less")
                self.assertLess(other.power, 0.002)

    def test_welch_is_close_to_it_with_equal_spreads_and_holds_its_level_without(self):
        found = find_effect([NORMAL + 0.8, NORMAL], [24, 24], 4000, "welch", 0.05, 1)
        self.assert_power(found, of_two_samples(0.8, 24, 24))
        unequal = [3 * NORMAL, NORMAL]
        self.assert_power(find_effect(unequal, [10, 30], 4000, "welch", 0.05, 1), 0.05)
        self.assertGreater(find_effect(unequal, [10, 30], 4000, "t", 0.05, 1).power, 0.15)  # which the t test does not

    def test_people_who_are_all_alike_find_no_effect(self):
        found = find_effect([np.repeat([1.0, 0.0], [20, 4])], [3], 4000, "t", 0.05, 1)
        self.assertEqual(found.power, 0)
        self.assertGreater(found.untested, 0.5)
        self.assertTrue(np.isfinite(find_effect([np.repeat([1.0, 0.0], [20, 4])] * 2, [3, 3], 1000, "welch", 0.05, 1).half_width))

    def test_without_an_effect_one_test_in_twenty_finds_one(self):
        for seed in range(soak.of(1, 5)):
            self.assert_power(find_effect([NORMAL], [15], 4000, "t", 0.05, seed), 0.05)
            self.assert_power(find_effect([NORMAL, NORMAL], [15, 15], 4000, "welch", 0.05, seed), 0.05)
            found = find_effect([NORMAL, NORMAL], [15, 15], 4000, "wilcoxon", 0.05, seed)
            self.assertTrue(0.03 < found.power < 0.06, found)

    def test_ranks_have_nearly_the_power_of_t_for_normal_people(self):
        for pool, sizes in (([NORMAL + 0.8], [20]), ([NORMAL + 0.8, NORMAL], [25, 25])):
            ranks = find_effect(pool, sizes, 4000, "wilcoxon", 0.05, 3).power
            t = find_effect(pool, sizes, 4000, "t", 0.05, 3).power
            self.assertTrue(t - 0.06 < ranks < t + 0.01, (ranks, t))

    def test_errors_of_sign_and_size_are_those_of_a_closed_form(self):
        # Gelman and Carlin 2014: an effect of 0.1 standard errors' size, here with the spread that is estimated
        found = find_effect([NORMAL + 0.1], [10], 200000, "t", 0.05, 5)
        rng = np.random.default_rng(6)
        x = rng.normal(0.1, 1, (200000, 10))
        p, mean = stats.ttest_1samp(x, 0, axis=1).pvalue, x.mean(1)
        self.assertAlmostEqual(found.wrong_sign, (mean[p < 0.05] < 0).mean(), delta=0.02)
        self.assertAlmostEqual(found.exaggeration, np.abs(mean[p < 0.05]).mean() / 0.1, delta=0.2)

    def test_the_half_width_is_that_of_the_interval(self):
        found = find_effect([NORMAL + 0.5], [20], 4000, "t", 0.05, 5)
        self.assertAlmostEqual(found.half_width, stats.t.ppf(0.975, 19) / np.sqrt(20), delta=0.02)
        self.assertTrue(np.isnan(find_effect([NORMAL], [20], 100, "wilcoxon", 0.05, 5).half_width))

    def test_spread_makes_the_effect_smaller(self):
        wide = find_effect([NORMAL + 0.8], [12], 4000, "t", 0.05, 2, spread=1.5)
        self.assert_power(wide, of_one_sample(0.8 / 1.5, 12))

    def test_the_same_seed_gives_the_same_samples(self):
        self.assertEqual(find_effect([NORMAL + 0.5], [9], 500, "t", 0.05, 4), find_effect([NORMAL + 0.5], [9], 500, "t", 0.05, 4))
        powers = [find_effect([NORMAL + 0.5], [n], 500, "t", 0.05, 4).power for n in range(5, 40)]
        self.assertGreater(np.corrcoef(powers, [of_one_sample(0.5, n) for n in range(5, 40)])[0, 1], 0.995)

    def test_the_smallest_size_is_that_of_the_closed_form(self):
        for d in (0.5, 0.8, 1.5):
            n, may_be, probably = smallest_size(lambda n, d=d: find_effect([NORMAL + d], [n], 4000, "t", 0.05, 1), 0.8, 1000)
            exact = next(n for n in range(3, 200) if of_one_sample(d, n) >= 0.8)
            self.assertLessEqual(may_be, exact)
            self.assertLessEqual(exact, probably + 1)
            self.assertTrue(may_be <= n <= probably, (may_be, n, probably))
        none = smallest_size(lambda n: find_effect([NORMAL], [n], 500, "t", 0.05, 1), 0.8, 50)
        self.assertEqual(none[0], None)


class Evidence(unittest.TestCase):
    def test_looks_have_the_published_boundaries(self):
        # z values at equally spaced looks, as printed by the programs of Reboussin, DeMets, Kim and Lan (2000), alpha = 0.05
        for ends in ([2.9626, 1.9686], [3.7103, 2.5114, 1.9930], [4.3326, 2.9631, 2.3590, 2.0141],
                     [4.8769, 3.3569, 2.6803, 2.2898, 2.0310]):  # fmt: skip
            levels = levels_of_looks(np.arange(1, len(ends) + 1) / len(ends), 0.05)
            np.testing.assert_allclose(stats.norm.isf(np.array(levels) / 2), ends, atol=2e-4)

    def test_looks_at_any_times_keep_the_level(self):
        for shares, alpha in (([0.3, 0.35, 0.9, 1], 0.05), ([0.98, 1], 0.05), ([0.1, 0.2, 1], 0.01), (np.arange(20, 41) / 40, 0.05)):
            z = np.cumsum(np.random.default_rng(7).normal(0, np.sqrt(np.diff(shares, prepend=0)), (200000, len(shares))), axis=1)
            ends = stats.norm.isf(np.array(levels_of_looks(shares, alpha)) / 2)
            crossed = (np.abs(z / np.sqrt(shares)) > ends).any(axis=1).mean()
            self.assertAlmostEqual(crossed, alpha, delta=4 * np.sqrt(alpha / 200000))

    def test_bayes_factors_are_those_that_others_publish(self):
        # of the sleep data by R's package BayesFactor, and of the examples of Python's pingouin
        for t, sizes, factor in ((-4.062128, [10], 17.25888), (3.5, [20], 17.185), (3.5, [20, 20], 26.743)):
            self.assertAlmostEqual(bayes_factor(t, sizes) / factor, 1, delta=1e-4)
        # with more and more people, exp(t^2 / 2) over how much larger than the standard error the prior is
        t, n, prior = 4.0, 1e8, np.sqrt(0.5)
        large = np.exp(t**2 / 2) * np.sqrt(2 * np.pi / n) / (np.pi * prior * (1 + t**2 / n / prior**2))
        self.assertAlmostEqual(bayes_factor(t, [int(n)]) / large, 1, delta=1e-3)

    def test_factors_have_the_power_of_the_noncentral_t(self):
        for d, sizes in ((0.8, [12]), (0.8, [30]), (1, [15, 20])):
            pool = [NORMAL + d, NORMAL][: len(sizes)]
            for factor in (3, 10):
                level, none = levels_of_factor(factor, sizes)
                found = find_effect(pool, sizes, 4000, "bayes", 0.05, 3, levels=(level, none))
                n, m = [*sizes, 0][:2]
                exact = of_two_samples(d, n, m, level) if m else of_one_sample(d, n, level)
                self.assertLess(abs(found.power - exact), 3.3 * np.sqrt(exact * (1 - exact) / 4000) + 1e-3)
        level, none = levels_of_factor(3, [40])
        found = find_effect([NORMAL], [40], 4000, "bayes", 0.05, 3, levels=(level, none))
        self.assertAlmostEqual(found.for_none, 1 - none, delta=0.025)  # p is uniform there
        self.assertAlmostEqual(bayes_factor(stats.t.isf(none / 2, 39), [40]), 1 / 3, delta=1e-6)
        self.assertEqual(levels_of_factor(10, [5])[1], 1)  # so few people can never show that there is none

    def test_a_sequential_study_ends_as_samples_that_are_tested_one_by_one(self):
        pool, n = NORMAL[5::10] + 0.7, [8, 14, 20]
        levels = levels_of_looks([each / 20 for each in n], 0.05)
        looks = look_repeatedly([pool], [[each] for each in n], 4000, "t", [(level, np.inf) for level in levels], 2)
        people = np.random.default_rng(1).normal(0.7, 1, (20, 20000))
        goes_on = np.ones(20000, dtype=bool)
        for each, level, look in zip(n, levels, looks):
            finds = goes_on & (stats.ttest_1samp(people[:each], 0, axis=0).pvalue < level)
            goes_on &= ~finds
            self.assertAlmostEqual(look.found, 1 - goes_on.mean(), delta=0.03)
            self.assertAlmostEqual(look.exaggeration, people[:each, finds].mean() / 0.7, delta=0.04)
        none = look_repeatedly([NORMAL], [[each] for each in n], 20000, "t", [(level, np.inf) for level in levels], 2)
        self.assertAlmostEqual(none[-1].found, 0.05, delta=0.008)


class Pools(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.pool = dh.rehearse("experiments/first-trials.yaml", 12, out=f"{cls.folder.name}/pool", progress=False).folder
        cls.data = figures.read(cls.pool)

    def refused(self, what, call, kind=dh.Error):
        with self.assertRaisesRegex(kind, what):
            call()

    def test_an_effect_is_that_of_pandas(self):
        trials = pd.read_csv(self.pool / "trials.csv")
        lifts = pd.read_csv(self.pool / "lifts.csv").merge(trials[["id", "trial_num", "attempt", "kind", "block"]])
        lifts = lifts[~lifts.kind.isin(["practice", "catch"])].drop_duplicates(["id", "trial_num"], keep="last")
        means = lifts.groupby(["id", "block"]).static_grip_N.mean().unstack()
        wanted = means.heavy - means.light
        pd.testing.assert_series_equal(Effect(DIFFERENCE).sides(self.data)[0], wanted, check_names=False, rtol=1e-12)
        ratio = Effect("2 * median(static_grip_N, block='heavy') / mean(static_grip_N, block=light, table=lifts) - 1")
        medians = lifts[lifts.block == "heavy"].groupby("id").static_grip_N.median()
        pd.testing.assert_series_equal(ratio.sides(self.data)[0], 2 * medians / means.light - 1, check_names=False, rtol=1e-12)

    def test_mistakes_are_told(self):
        for text, what in (
            ("mean(static_grip_N", "is not an expression"),
            ("3", "has no term"),
            ("mean(static_grip_N) ** 2", "cannot be part of an effect"),
            ("__import__('os')", "is not a function of an effect"),
            ("mean(a, b)", "needs one column"),
            ("mean(*a)", "must be a name"),
            ("means(static_grip_N)", "Did you mean 'mean'"),
            ("mean(late, group=a) + mean(late, group=b)", "not one group's value minus another"),
            ("mean(late) * 1" + 400 * "0", "cannot be part of an effect"),
            ("True * mean(late)", "cannot be part of an effect"),
            ("mean(x, group=a) - mean(x, group=b) - mean(x, group=c)", "names 3 groups"),
            ("mean(x, block=heavy, block=light)", "has two conditions on block. Write a mean for each"),
            ("mean(x, block=-'light')", "must be a name"), ("mean(-None)", "must be a name"),
            (900 * "-" + "mean(x)", "is too long: it has"), ("mean(x)" + 900 * "+1", "is too long: it has"),
            (" + ".join(30 * ["mean(x, block=light)"]), "is too long: it has 298 parts, and may have 200. Shorten it."),
        ):
            with self.subTest(text[:60]):
                self.refused(what, lambda text=text: Effect(text))
        for text, what in (
            ("mean(static_gripN)", "Did you mean 'static_grip_N'"),
            ("mean(static_grip_N, block=heavier)", "has no rows in lifts. Did you mean 'block=heavy'"),
            ("mean(static_grip_N, condition=heavy)", "Write block=heavy: it is a value of that column. The column condition is"),
            ("mean(static_grip_N, blocks=heavy)", "Did you mean 'block'"),
            ("mean(outcome)", "contains words"),
            ("mean(safety_margin, group=a)", "has no groups"),
            ("mean(safety_margin) + 1 / 0", "cannot be computed"),
            ("mean(reach_time_s)", "is empty in all of these rows"),
            ("mean(static_grip_N, table=lift)", "is not a table of these people"),
        ):
            with self.subTest(text):
                self.refused(what, lambda text=text: Effect(text).sides(self.data)[0])
        for options, what in (
            ({"n": [2]}, "from 3 to"), ({"n": []}, "from 3 to"), ({"n": [10**8]}, "from 3 to"), ({"draws": 5}, "from 100"),
            ({"alpha": 2}, "from 0.000001"), ({"alpha": 1e-300}, "from 0.000001"), ({"ratio": 11}, "from 0.1"),
            ({"seed": -1}, "negative"),
            ({"smallest_effect": 0}, "other than zero"), ({"smallest_effect": float("nan")}, "other than zero"),
            ({"laboratories": 2}, "fewer than three do not show how"),
            ({"smallest_effect": 1e300}, "standard deviations of people. Give it in the unit of the effect"),
            ({"test": "welch"}, "is not a test of one value of each person"), ({"attrition": 0.9}, "fewer than 3"),
            ({"n": [30], "attrition": 0.99}, "300 must be recruited"), ({"attrition": 0.9999999999}, "from 0 to 0.99"),
        ):  # fmt: skip
            with self.subTest(options):
                self.refused(what, lambda options=options: dh.power(self.pool, DIFFERENCE, **options))

    def test_groups_are_named_from_left_to_right(self):
        effect = Effect("mean(x, group=a) / mean(y, group=a) - mean(x, group=b)")
        self.assertEqual(effect.groups, ["a", "b"])
        self.assertEqual(Effect("-mean(x, group=b) - mean(x, group=a)").groups, ["b", "a"])

    def test_an_effect_that_no_test_can_find_is_refused(self):
        self.refused("is infinite for sim-001", lambda: dh.power(self.pool, "1 / mean(slips)"))
        self.refused("is the same for all people", lambda: dh.power(self.pool, "mean(block_num) / 10"))

    def test_a_pool_that_has_grown_is_used_whole(self):
        """The tables of a report are made again when people have been added since."""
        file = Path(self.folder.name, "short.yaml")
        text = Path("experiments/rotation-reversal.yaml").read_text().replace("../", f"{Path.cwd()}/")
        file.write_text(re.sub(r"repeats: \d+", "repeats: 2", text))
        options = {"n": [4], "draws": 100, "out": f"{self.folder.name}/grown", "progress": False}
        first = dh.power(str(file), "mean(late)", people=10, **options)
        self.assertEqual(len(first.sides[0]), 10)
        self.assertEqual(len(dh.power(str(file), "mean(late)", people=11, **options).sides[0]), 11)

    def test_the_page_warns_of_what_speaks_against_it(self):
        def page(effect, name):
            return dh.power(self.pool, effect, [4], draws=100).save(Path(self.folder.name, name)).read_text()

        self.assertIn("The effect compares people with a fixed number", page("mean(preload_s) - 0.09", "fixed"))
        self.assertIn("cannot tell this effect from zero", page(f"mean(preload_s) - {self.mean_preload()}", "none"))
        self.refused("is the folder of a rehearsal", lambda: dh.power(self.pool, "mean(preload_s)", [4]).save(self.pool))

    def test_the_smallest_effect_of_interest_takes_the_place_of_the_pool_s(self):
        """Of the people, their scatter alone counts."""
        result = dh.power(self.pool, "mean(preload_s) - 0.09", [6, 12], draws=200, smallest_effect=-0.02)
        moved = dh.power(self.pool, "mean(preload_s) + 1", [6, 12], draws=200, smallest_effect=-0.02)
        np.testing.assert_allclose(moved.table, result.table)
        twice = dh.power(self.pool, "2 * (mean(preload_s) - 0.09)", [6, 12], draws=200, smallest_effect=-0.04)
        np.testing.assert_allclose(twice.table.power, result.table.power)
        normal = replace(result, sides=[pd.Series(5 + 2 * NORMAL)], smallest_effect=-1.2, draws=4000, _known={})
        for n in (6, 12, 24):
            ends = stats.t.ppf([0.025, 0.975], n - 1)
            of_t = stats.nct.cdf(ends[0], n - 1, -0.6 * np.sqrt(n)) + stats.nct.sf(ends[1], n - 1, -0.6 * np.sqrt(n))
            self.assertAlmostEqual(normal.at(n).power, of_t, delta=0.025)
        self.assertAlmostEqual(normal.standardised, -0.6, delta=0.002)
        text = result.save(Path(self.folder.name, "of-interest")).read_text()
        self.assertIn("The effect to be detected is the smallest effect of interest, -0.02, Cohen's d = ", result.in_words())
        self.assertNotIn("The effect compares people with a fixed number", text)
        self.assertNotIn("cannot tell this effect from zero", text)

    def test_a_study_is_tested_while_its_people_come(self):
        options = {"draws": 400, "smallest_effect": 0.02}
        result = dh.power(self.pool, "mean(preload_s) - 0.09", [6, 10, 14], sequential=True, **options)
        looks = result.looks
        self.assertEqual(looks.n.tolist(), [6, 10, 14])
        self.assertTrue((looks.found.diff()[1:] >= 0).all() and (looks.found <= result.table.power).all())
        self.assertAlmostEqual(looks.ends.sum(), 1)
        self.assertAlmostEqual(result.people_on_average, (looks.n * looks.ends).sum())
        self.assertIn("The data are tested after 6, 10 and 14 people, and the study ends at the first test", result.in_words())
        page = result.save(Path(self.folder.name, "sequential"))
        self.assertIn("Power of a single test", page.read_text())
        np.testing.assert_allclose(pd.read_csv(page.parent / "power-by-look.csv"), looks)
        bayes = dh.power(self.pool, "mean(preload_s) - 0.09", [6, 40], test="bayes", bayes_factor=3, sequential=True, **options)
        self.assertEqual(bayes.looks.for_none[0], 0)
        self.assertIn("above 3 or below 1/3", bayes.in_words())
        self.assertIn("no effect found", bayes.save(Path(self.folder.name, "bayes")).read_text())
        self.assertIsNone(dh.power(self.pool, "mean(preload_s) - 0.09", [6], **options).looks)
        for n in ([6], [10, 6], [6, 6]):
            self.refused("must be two or more rising numbers", lambda n=n: dh.power(self.pool, DIFFERENCE, n, sequential=True))
        self.refused("nobody is added", lambda: dh.power(self.pool, DIFFERENCE, [8, 9], attrition=0.5, sequential=True))
        for factor in (1, 0, -3, float("nan"), float("inf")):
            self.refused("must be above 1", lambda factor=factor: dh.power(self.pool, DIFFERENCE, bayes_factor=factor))

    def test_a_test_has_one_side_where_that_was_decided_before(self):
        options = {"draws": 400, "smallest_effect": -0.02}
        effect = "mean(preload_s) - 0.09"
        both, less = (dh.power(self.pool, effect, [6, 10, 14], alternative=one, sequential=True, **options)
                      for one in ("two-sided", "less"))  # fmt: skip
        self.assertTrue((less.table.power > both.table.power).all())
        # each look spends on one side what two sides share at twice the level
        twice = dh.power(self.pool, effect, [6, 10, 14], alpha=0.1, sequential=True, **options)
        np.testing.assert_allclose(less.looks.level, twice.looks.level / 2)
        normal = replace(less, sides=[pd.Series(5 + 2 * NORMAL)], n=[20, 30, 40], draws=4000, _known={})
        self.assertAlmostEqual(normal.looks.false_alarm.iloc[-1], 0.05, delta=0.012)
        self.assertIn("a t test (one-sided, for an effect below zero, alpha = 0.05)", less.in_words())
        wrong = dh.power(self.pool, effect, [6, 10], alternative="greater", **options)
        self.assertLess(wrong.table.power.max(), 0.02)
        self.assertTrue(any("looks for an effect above zero, and the one that is sought is -0.02" in text for text in warnings_of(wrong)))
        self.refused("There are two-sided, greater, less", lambda: dh.power(self.pool, effect, alternative="larger"))
        self.refused("has no side", lambda: dh.power(self.pool, effect, test="bayes", alternative="less"))

    def mean_preload(self):
        return Effect("mean(preload_s)").sides(self.data)[0].mean()

    def test_a_pool_is_rehearsed_once_and_continued(self):
        out = f"{self.folder.name}/made"
        options = {"n": [4], "draws": 100, "out": out, "progress": False}
        first = dh.power("experiments/first-trials.yaml", DIFFERENCE, people=10, **options)
        began = os.stat(f"{out}/pool/sim-003/trials.csv").st_mtime_ns
        again = dh.power("experiments/first-trials.yaml", DIFFERENCE, people=11, **options)
        self.assertEqual(os.stat(f"{out}/pool/sim-003/trials.csv").st_mtime_ns, began)
        self.assertEqual([len(first.sides[0]), len(again.sides[0])], [10, 11])
        pd.testing.assert_series_equal(first.sides[0], again.sides[0].iloc[:10])

    def test_further_laboratories_have_the_power_of_their_own_effect(self):
        result = replace(dh.power(self.pool, "mean(preload_s)", [6], draws=200), draws=4000, _known={})
        self.assertEqual((result.spread_of_laboratories, result.in_laboratories(6)), (None, {}))
        self.assertNotIn("laboratory_50", result.table)

        # six people of each; their scatter spreads the means of laboratories too
        scatter = np.random.default_rng(3).permutation(NORMAL)[:12000].reshape(2000, 6)
        means = 0.9 + 0.5 * NORMAL[5::10]
        sides = [pd.Series(mean + people) for mean, people in zip(means, scatter)]
        result = replace(result, sides=[pd.concat(sides)], _known={})
        result.__dict__["_laboratories"] = [[side] for side in sides]
        self.assertAlmostEqual(result.spread_of_laboratories, 0.5, delta=0.05)
        both = result.in_laboratories(12)
        for share, effect in ((50, 0.9), (10, 0.9 - 1.2816 * 0.5)):
            of_t = stats.nct.sf(stats.t.ppf(0.975, 11), 11, effect * np.sqrt(12))
            self.assertAlmostEqual(both[share], of_t, delta=0.05)
        # where laboratories are alike, chance alone spreads their means
        result.__dict__["_laboratories"] = [[pd.Series(0.9 + people)] for people in scatter]
        del result.__dict__["spread_of_laboratories"]
        self.assertLess(result.spread_of_laboratories, 0.15)

    def test_people_of_laboratories_are_rehearsed(self):
        file = Path(self.folder.name, "short-rotation.yaml")
        text = Path("experiments/rotation-reversal.yaml").read_text().replace("../", f"{Path.cwd()}/")
        file.write_text(re.sub(r"repeats: \d+", "repeats: 2", text))
        options = {"n": [4], "draws": 100, "out": f"{self.folder.name}/laboratories", "progress": False}
        result = dh.power(str(file), "mean(late)", people=12, laboratories=3, **options)
        row = result.table.iloc[0]
        self.assertTrue(0 <= row.laboratory_10 <= row.laboratory_50 <= 1, row)
        self.assertIn("of further laboratories have a power of at least", result.in_words())
        text = result.save(Path(self.folder.name, "of-laboratories")).read_text()
        self.assertIn("laboratories: half, nine in ten", text)
        self.assertIn("but for the traits that have between_laboratories", text)
        self.assertNotIn("These laboratories differ only", text)
        reach = dh.power(str(file), "mean(reach_time_s)", people=12, laboratories=3, **options)
        self.assertIn("in reach_time_s its laboratories are alike", reach.save(Path(self.folder.name, "of-reaches")).read_text())
        pool = Path(options["out"], "pool")
        self.refused("from which the people in the folder come", lambda: dh.power(pool, "mean(late)", laboratories=3))
        self.refused("need people of a population", lambda: dh.rehearse(str(file), 1, laboratories=3, person=dh.Person))

    @soak.alone
    def test_groups_of_a_population_are_compared(self):
        population = Path(self.folder.name, "two.yaml")
        population.write_text(
            f"title: Two\nbased_on: {Path('populations/adults.yaml').resolve()}\ngroups:\n  - {{ name: control }}\n"
            "  - name: patients\n    traits: [{ trait: safety_margin, median: 0.55, spread: 0.3 }]\n"
        )
        options = {"population": population, "people": 20, "draws": 200, "progress": False, "out": f"{self.folder.name}/groups"}
        difference = "mean(static_grip_N, group=patients) - mean(static_grip_N, group=control)"
        result = dh.power("experiments/first-trials.yaml", difference, [5, 10], ratio=1.5, **options)
        lifts = pd.read_csv(f"{self.folder.name}/groups/pool/lifts.csv")
        means = lifts.drop_duplicates(["id", "trial_num"], keep="last").groupby(["group", "id"]).static_grip_N.mean()
        pd.testing.assert_series_equal(result.sides[0], means["patients"], check_names=False, rtol=1e-12)
        self.assertAlmostEqual(result.size, means["patients"].mean() - means["control"].mean(), delta=1e-12)
        self.assertEqual(result.test, "welch")
        self.assertEqual(result.table.analysed.tolist(), [5 + 8, 10 + 15])
        text = result.save(Path(self.folder.name, "of-groups")).read_text()
        self.assertIn("The second group, control, has 1.5 times as many.", text)
        self.assertIn("of group control", text)

    def test_few_people_are_refused(self):
        few = figures.read(self.pool, people=["sim-001", "sim-002"])
        with unittest.mock.patch("dihaptic.power_analysis.pool.read_pool", return_value=few):
            self.refused("has 2 people whose value is known", lambda: dh.power(self.pool, DIFFERENCE))

    def test_the_page_says_what_was_done(self):
        result = dh.power(self.pool, "mean(preload_s) - 0.09", [6, 12], attrition=0.25, draws=200)
        page = result.save(Path(self.folder.name, "saved"))
        text = page.read_text()
        said = ("Adults", "12 simulated people", "alpha = 0.05", "seed 1", "200 samples", "25 % of them", "How laboratories")
        for words in said:
            self.assertIn(words, text)
        names = sorted(path.name for path in page.parent.iterdir())
        kinds = ("csv", "html", "pdf", "png", "py", "svg")
        self.assertEqual(names, ["effect-of-people.csv", "power-by-n.csv", *(f"power.{kind}" for kind in kinds)])
        before = (page.parent / "power.svg").read_bytes()
        (page.parent / "power.svg").unlink()
        subprocess.run([sys.executable, page.parent / "power.py"], check=True)
        self.assertEqual((page.parent / "power.svg").read_bytes(), before)
        people = pd.read_csv(page.parent / "effect-of-people.csv")
        self.assertEqual(people.person.tolist(), self.data.people)
        self.assertAlmostEqual(people.effect.mean(), result.size, delta=1e-9)
        self.assertEqual(result.table.analysed.tolist(), [4, 9])
        self.assertIn("How much preload_s varies over trials and over people has never been compared", text)
        alike = dh.power(self.pool, "mean(loading_s, trial_num=3) - mean(loading_s, trial_num=4)", [4], draws=100)
        self.assertIn("is larger than experiments find", alike.save(Path(self.folder.name, "alike")).read_text())


if __name__ == "__main__":
    unittest.main()
