"""Figures of learning: their numbers are those of pandas, and they can be read with any number of people and trials."""

import tempfile
import unittest

import numpy as np
import pandas as pd
from drawn import Drawn, rehearsed, with_tables
from scipy import stats
from small_study import dihaptic

import dihaptic as dh
from dihaptic import figures
from dihaptic.figures import learning

#: Fewer trials of the shipped experiments: in each of the four rounds 8, 26, 8 and 8.
ROTATION = [
    ("baseline, repeats: 2", "baseline, repeats: 1"), ("repeats: 8", "repeats: 3"), ("count: 6", "count: 2"),
    ("clamp, repeats: 2", "clamp, repeats: 1"), ("washout, repeats: 3", "washout, repeats: 1"),
]  # fmt: skip
FIELD = [("repeats: 12", "repeats: 6"), ("repeats: 40", "repeats: 14"), ("count: 4", "count: 2"), ("repeats: 8", "repeats: 4")]
GENERALISATION = [("repeats: 4", "repeats: 1"), ("repeats: 3", "repeats: 1"), ("repeats: 24", "repeats: 6"),
    ("repeats: 88", "repeats: 24")]  # fmt: skip


class Learning(Drawn):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.rotation = rehearsed("visuomotor-rotation", folder.name, 3, ROTATION)
        cls.field = rehearsed("divergent-field", folder.name, 2, FIELD)
        cls.one = rehearsed("generalisation-one", folder.name, 1, GENERALISATION) / "sim-001"
        dihaptic("report", cls.one)

    def check(self, data, expected=None):
        """All figures of these data can be read; returns their plans."""
        made = super().check(learning, data, expected)
        for name, (_, _, figure) in made.items():
            with self.subTest(name):
                self.assertTrue(all(axes.get_xlabel() or axes.get_xticklabels() for axes in figure.axes))
        return {name: plan for name, (plan, _, _) in made.items()}

    def adaptation(self):
        table = pd.read_csv(self.rotation / "adaptation.csv")
        table = table.drop_duplicates(["id", "round", "trial_num"], keep="last")
        first = table.groupby(["id", "round"]).trial_num.transform("min")
        return table.assign(trial=table.trial_num - first + 1)

    def test_bands_hold_a_further_laboratory(self):
        data = figures.read(self.rotation)
        with self.assertRaisesRegex(dh.Error, "come from 0 laboratories, too few for bands. Rehearse people of 3 or more"):
            figures.laboratory_curves(data)
        self.assertNotIn("laboratory-curve", self.check(data))
        for place, name in enumerate(data.people):  # as if each came from another laboratory
            file = self.rotation / name / "person.yaml"
            text = file.read_text()
            self.addCleanup(file.write_text, text)
            file.write_text(text.replace("\nlaboratory: 0\n", f"\nlaboratory: {place + 1}\n"))
        data = figures.read(self.rotation)
        plan = self.check(data)["laboratory-curve"]
        self.assertIn("Thin lines are the means of 3 laboratories of 1 people each", plan.caption)
        points = figures.laboratory_curves(data)
        own = points[(points.part == "about y") & (points.trial == 10)]
        values = own[own.of == "laboratory"].value
        table = self.adaptation()
        measured = table[(table["round"] == "about y") & (table.trial == 10)].compensation
        np.testing.assert_allclose(sorted(values), sorted(measured), rtol=1e-12)
        for share in (0.5, 0.9):
            band = own[own.of == f"{share:.0%}".replace("%", " %")].iloc[0]
            half = stats.t.ppf((1 + share) / 2, 2) * values.std() * np.sqrt(1 + 1 / 3)
            np.testing.assert_allclose([band.low, band.high], [values.mean() - half, values.mean() + half], rtol=1e-12)

    def test_curves_are_those_of_pandas(self):
        table = self.adaptation()
        catch = table.kind.eq("catch").groupby([table["round"], table.trial]).transform("mean")
        self.assertTrue(catch.isin([0, 1]).all(), "catch trials of this rehearsal have the same places")
        by = [table["round"], table.trial]
        points = figures.learning_curve(figures.read(self.rotation))
        mean = points[points.of == "mean"].set_index(["part", "trial"]).sort_index()
        each = table.groupby(by).compensation
        half = stats.t.ppf(0.975, each.count() - 1) * each.std() / np.sqrt(each.count())
        ends = {"low": each.mean() - half, "high": each.mean() + half}
        for column, wanted in {"value": each.mean(), "n": each.count(), **ends}.items():
            np.testing.assert_allclose(mean[column], wanted.sort_index(), rtol=1e-12, atol=1e-12, err_msg=column)
        fit = points[points.of == "fit"].set_index(["part", "trial"]).value.sort_index()
        np.testing.assert_allclose(fit, table.groupby(by).two_rate.mean().sort_index(), rtol=1e-12, atol=1e-12)
        people = points[points.of == "person"].set_index(["part", "trial", "person"]).value.sort_index()
        wanted = table.set_index(["round", "trial", "id"]).compensation.dropna().sort_index()
        np.testing.assert_allclose(people, wanted, rtol=1e-12)
        schedule = points[(points.of == "schedule") & (points.block == "rotation")]
        np.testing.assert_allclose(schedule.value, table.perturbation.max(), rtol=1e-7)

    def test_bins_stay_in_their_blocks(self):
        points = figures.learning_curve(figures.read(self.rotation), rounds=["about y"], bin_trials=4)
        table = self.adaptation()
        table = table[table["round"] == "about y"]
        # blocks of 8, 26, 8 and 8 trials: the last two of the second one are a bin of their own
        ends = [*range(4, 33, 4), 34, *range(38, 51, 4)]
        wanted = list(zip([1, *(end + 1 for end in ends)], ends))
        mean = points[points.of == "mean"].sort_values("first")
        self.assertEqual(list(zip(mean["first"], mean["last"])), wanted)
        for row in mean.itertuples():
            each = table[table.trial.between(row.first, row.last)].groupby("id").compensation.mean()
            np.testing.assert_allclose([row.value, row.n], [each.mean(), each.count()], rtol=1e-12)

    def test_windows_are_those_of_pandas(self):
        fits = pd.read_csv(self.rotation / "fits.csv")
        points = figures.learning_windows(figures.read(self.rotation))
        for window in ("baseline", "early", "late", "catch", "clamp_first", "clamp_last", "washout_first"):
            own = points[(points.window == window) & (points.of == "mean")].set_index("part").sort_index()
            each = fits.groupby("round")[window]
            half = stats.t.ppf(0.975, each.count() - 1) * each.std() / np.sqrt(each.count())
            np.testing.assert_allclose(own.value, each.mean(), rtol=1e-12)
            np.testing.assert_allclose(own.high, each.mean() + half, rtol=1e-12)
        self.assertNotIn("rebound", set(points.window))

    def test_measures_are_those_of_pandas(self):
        points = figures.measures_over_trials(figures.read(self.field), measures=["lateral_deviation_mm"])
        trials = pd.read_csv(self.field / "trials.csv")
        trials = trials[trials.kind != "practice"].drop_duplicates(["id", "trial_num"], keep="last")
        mean = points[points.of == "mean"].set_index("trial").value
        wanted = trials.groupby("trial_num").lateral_deviation_mm.mean().dropna()
        np.testing.assert_allclose(mean.sort_index(), wanted, rtol=1e-12)

    def test_generalisation_is_the_table_s(self):
        points = figures.generalisation_curve(figures.read(self.one))
        table = pd.read_csv(self.one / "generalisation.csv").sort_values("angle_deg")
        np.testing.assert_allclose(points.value, table.compensation_deg, rtol=1e-12)
        self.assertEqual(set(points.of), {"person"})

    def test_figures_of_several_people_and_of_one(self):
        made = self.check(figures.read(self.rotation), ["learning-curve", "learning-windows"])
        self.assertIn("3 people", made["learning-curve"].caption)
        self.check(figures.read(self.field), ["measures-over-trials"])
        self.check(figures.read(self.field / "sim-001"), ["measures-over-trials"])
        made = self.check(figures.read(self.one), ["learning-curve", "learning-windows", "generalisation"])
        self.assertIn("1 person", made["learning-curve"].caption)

    def test_catch_trials_at_other_places_are_left_out(self):
        table = figures.read(self.rotation).table("adaptation")
        own = (table.person == "sim-002") & (table["round"] == "about x") & (table.block == "rotation")
        kinds = table.loc[own, "kind"].to_numpy()
        table.loc[own, "kind"] = np.roll(kinds, 3)
        data = with_tables(self.rotation, adaptation=table)
        points = figures.learning_curve(data, rounds=["about x"])
        people = points[points.of == "person"]
        last = table.drop_duplicates(["person", "round", "trial_num"], keep="last")
        measured = last[(last["round"] == "about x") & last.compensation.notna()]
        self.assertEqual(len(people), len(measured[measured.kind != "catch"]))
        self.assertLess(len(people), len(measured))
        self.assertIn("Catch trials", self.check(data)["learning-curve"].caption)

    def test_groups_and_long_names(self):
        table, fits = figures.read(self.rotation).table("adaptation"), figures.read(self.rotation).table("fits")
        long = {"baseline": "a block without any rotation of the cursor", "washout": "the same once more, without any rotation"}
        for each in (table, fits):
            each["group"] = each["person"].map({"sim-001": "those who see everything"}).fillna("those who see nothing at all")
            each["round"] = "a reach forwards and " + each["round"]
        table["block"] = table["block"].replace(long)
        self.check(with_tables(self.rotation, adaptation=table, fits=fits), ["learning-curve", "learning-windows"])

    def test_many_blocks(self):
        table = figures.read(self.rotation).table("adaptation")
        table = table[table["round"].isin(["about x", "about z"])]
        trial = table["trial_num"] - table.groupby(["person", "round"])["trial_num"].transform("min")
        table["block"] = "block number " + (trial // 2).astype(str)
        made = self.check(with_tables(self.rotation, adaptation=table))
        self.assertIn("too narrow", made["learning-curve"].caption)
        table["block"] = "block number " + ((trial + table["person"].eq("sim-001")) // 16).astype(str)
        made = self.check(with_tables(self.rotation, adaptation=table))
        self.assertIn("order differs between people", made["learning-curve"].caption)

    def test_missing_values(self):
        table, fits = figures.read(self.rotation).table("adaptation"), figures.read(self.rotation).table("fits")
        holes = table.assign(compensation=table.compensation.where(table.trial_num % 3 > 0), two_rate=np.nan)
        holes.loc[holes["round"] == "about y", "compensation"] = np.nan
        holes.loc[5, "compensation"] = np.inf
        fits[["early", "catch"]] = np.nan
        made = self.check(with_tables(self.rotation, adaptation=holes, fits=fits), ["learning-curve", "learning-windows"])
        self.assertEqual(made["learning-curve"].points_options["rounds"], ["about x", "oblique", "about z"])
        single = table[table.trial_num == 1]
        self.check(with_tables(self.rotation, adaptation=single, fits=fits.iloc[:0]), ["learning-curve"])
        none = table.assign(compensation=np.nan)
        names = list(self.check(with_tables(self.rotation, adaptation=none, fits=fits.iloc[:0])))
        self.assertNotIn("learning-curve", names)
        self.check(with_tables(self.rotation, adaptation=table.iloc[:0], fits=fits.iloc[:0]))
        trials = figures.read(self.field).table("trials")
        none = {measure.column: np.nan for measure in figures.read(self.field).measures}
        self.check(with_tables(self.field, trials=trials.assign(**none)), [])
        self.check(with_tables(self.field, trials=trials[trials.trial_num < 8]), [])


if __name__ == "__main__":
    unittest.main()
