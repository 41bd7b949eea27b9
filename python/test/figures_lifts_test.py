"""Figures of grip-lifts: their numbers are those of pandas, and their texts can be read, whatever is missing."""

import tempfile
import unittest
import unittest.mock

import numpy as np
import pandas as pd
from boxes import faults
from drawn import Drawn, rehearsed, with_tables

from dihaptic import figures
from dihaptic.errors import Error, NotThere
from dihaptic.figures import lifts
from dihaptic.figures.lifts import previous_weight

TIGHT = {"rtol": 0, "atol": 1e-12, "equal_nan": True}
#: Fewer lifts of unexpected-weight.
WEIGHTS = [("repeats: 3 }", "repeats: 1 }"), ("repeats: 18", "repeats: 4"), ("count: 3, gap: 5", "count: 1, gap: 2"),
    ("repeats: 8", "repeats: 2")]  # fmt: skip


class Lifts(Drawn):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.recorded = rehearsed("size-weight", folder.name, 2, [("repeats: 20", "repeats: 4")], keep_recordings=True)
        cls.weights = rehearsed("unexpected-weight", folder.name, 3, WEIGHTS)

    def joined(self, path):
        trials, own = pd.read_csv(path / "trials.csv"), pd.read_csv(path / "lifts.csv")
        design = trials[["id", "trial_num", "attempt", "block", "kind", "condition", "perturbation", "start_time", "stop_time"]]
        both = design.merge(own, on=["id", "trial_num", "attempt"])
        return both.drop_duplicates(["id", "trial_num"], keep="last")

    def curve(self, session, lift, quantity):
        """A course of one lift, tick by tick, with plain pandas."""
        body = lift.condition
        values = {
            "grip force": session["grip_force"], "load force": session["load_force"],
            "height": 1000 * session[f"{body}.position.z"].astype(float),
        }[quantity]  # fmt: skip
        series = pd.Series(values.astype(float), index=np.round(session.t / session.tick).astype(int))
        ticks = round(lift.lift_off_s / session.tick) + np.arange(-80, 151) * 10
        out = series.reindex(ticks)
        if quantity == "height":
            out -= series[round(lift.touch_s / session.tick)]
        times = ticks * session.tick
        return out.where((times >= lift.start_time - 1e-9) & (times <= lift.stop_time + 1e-9)).values

    def test_courses_are_those_of_pandas(self):
        data = figures.read(self.recorded)
        points = figures.lift_curves(data, colour=["condition"])
        own = self.joined(self.recorded)
        own = own[own.lift == "complete"]
        sessions = {sitting.person: sitting.session for sitting in data.recorded}
        for condition in ("small", "large"):
            for quantity in ("grip force", "load force", "height"):
                medians = pd.DataFrame({
                    person: pd.DataFrame([self.curve(sessions[person], lift, quantity) for lift in part.itertuples()]).median()
                    for person, part in own[own.condition == condition].groupby("id")
                })  # fmt: skip
                found = points[(points.condition == condition) & (points.quantity == quantity)]
                np.testing.assert_allclose(found["median"], medians.median(axis=1), **TIGHT)
                np.testing.assert_allclose(found["low"], medians.quantile(0.25, axis=1), **TIGHT)
                self.assertEqual(found.lifts.iloc[0], (own.condition == condition).sum())

    def test_a_ratio_needs_load(self):
        points = figures.lift_curves(figures.read(self.recorded / "sim-001"))
        wide = points.pivot(index="time_s", columns="quantity", values="median")
        self.assertTrue(wide.loc[wide["load force"] < 0.1, "grip / load"].isna().all())
        held = wide[wide.index > 1]
        np.testing.assert_allclose(held["grip / load"], held["grip force"] / held["load force"], rtol=0.1)

    def test_slip_and_hold_are_those_of_the_table(self):
        points = figures.grip_against_load(figures.read(self.recorded / "sim-001"))
        own = self.joined(self.recorded)
        own = own[(own.id == "sim-001") & (own.lift == "complete")]
        hold = points[points.phase == "hold"].iloc[0]
        self.assertAlmostEqual(hold.grip_N, own.static_grip_N.median(), delta=1e-12)
        self.assertAlmostEqual(hold.load_N, own.static_load_N.median(), delta=1e-12)
        slip = points[points.phase == "slip"].iloc[-1]
        friction = 0.8  # of the scene; each digit carries half of the load
        self.assertAlmostEqual(slip.grip_N / slip.load_N, 1 / (2 * friction), delta=1e-6)

    def test_change_is_that_of_pandas(self):
        points = figures.successive_lifts(
            figures.read(self.weights), measures=["peak_grip_rate_N_s"], colour=["perturbation"], catch=True
        )
        own = self.joined(self.weights)
        own["number"] = own.groupby("id").cumcount() + 1
        own = own[own.lift == "complete"]
        people = points[points.of == "person"].set_index(["person", "number"]).value.sort_index()
        pd.testing.assert_series_equal(
            people, own.set_index(["id", "number"]).peak_grip_rate_N_s.sort_index(), check_names=False, rtol=1e-12
        )
        mean = points[points.of == "mean"].set_index(["condition", "number"])
        self.assertTrue((mean.n >= 3).all())
        for (condition, number), value in mean.value.items():
            part = own[(own.perturbation == condition) & (own.number == number)].peak_grip_rate_N_s
            self.assertAlmostEqual(value, part.mean(), delta=1e-12 * part.mean())

    def test_phases_are_those_of_pandas(self):
        points = figures.lift_phases(figures.read(self.weights), colour=["condition"])
        own = self.joined(self.weights)
        own = own[(own.lift == "complete") & ~own.kind.isin(["practice", "catch"])]
        for phase in ("preload", "loading", "releasing"):
            each = own.groupby(["condition", "id"])[f"{phase}_s"].median()
            part = points[(points.phase == phase) & (points.of == "median")].set_index("condition")
            for share, column in ((0.25, "low"), (0.5, "value"), (0.75, "high")):
                wanted = each.groupby(level=0).quantile(share)[part.index]
                np.testing.assert_allclose(part[column], wanted, **TIGHT)

    def test_all_texts_can_be_read(self):
        for path, names in [
            (self.recorded, ["lift-curves", "grip-against-load", "successive-lifts", "lift-phases"]),
            (self.recorded / "sim-001", ["lift-curves", "grip-against-load", "successive-lifts", "lift-phases"]),
            (self.weights, ["successive-lifts", "lift-phases"]),
        ]:  # fmt: skip
            for plan, _, _ in self.check(lifts, figures.read(path), names, kept=path != self.weights).values():
                self.assertRegex(plan.caption, r"\d (person|people), \d+ lift")

    def test_the_unexpected_weight_is_shown_by_block(self):
        data = figures.read(self.weights)
        plan = next(lifts.plans(data))
        points = plan.points(data, **plan.points_options)
        self.assertEqual(set(points[points.block == "200 g expected"].condition), {"200 g", "400 g"})
        self.assertEqual(set(points[points.block == "told by colour"].condition), {"blue", "red"})

    def test_many_and_long_conditions(self):
        trials = figures.read(self.weights).table("trials")
        trials["condition"] = [f"a condition with quite a long name, number {i % 30}" for i in range(len(trials))]
        data = with_tables(self.weights, trials=trials)
        points = figures.lift_phases(data, colour=["condition"])
        self.assertEqual(points.condition.nunique(), 24)
        self.assertEqual(faults(figures.draw_lift_phases(points)), [])
        points = figures.successive_lifts(data, measures=["safety_margin"], colour=["condition"])
        self.assertEqual(points.condition.nunique(), 6)
        self.assertEqual(faults(figures.draw_successive_lifts(points)), [])
        captions = [plan.caption for plan in lifts.plans(data) if plan.name == "lift-phases"]
        self.assertIn("only the first 24 are: ", captions[0])

    def test_missing_values(self):
        whole = figures.read(self.weights).table("lifts")
        for change in ("margin", "phase", "all incomplete", "one lift", "no rows"):
            broken = whole.copy()
            if change == "margin":
                broken["safety_margin"] = np.nan
                broken.loc[broken.index[::3], "peak_grip_rate_N_s"] = np.nan
            elif change == "phase":
                broken["preload_s"] = np.nan
                broken.loc[broken.index[::2], "loading_s"] = np.nan
            elif change == "all incomplete":
                broken["lift"] = "no touch"
            else:
                broken = broken.iloc[10:11] if change == "one lift" else broken.iloc[:0]
            data = with_tables(self.weights, lifts=broken)
            with self.subTest(change):
                self.assertEqual(bool(self.check(lifts, data)), change in ("margin", "phase"))
                if change == "one lift":
                    self.assertEqual(faults(figures.draw_lift_phases(figures.lift_phases(data))), [])
        empty = figures.lift_phases(data).iloc[:0]
        for draw in (figures.draw_lift_phases, figures.draw_successive_lifts, figures.draw_lift_curves,
                     figures.draw_grip_against_load):  # fmt: skip
            with self.assertRaises(Error):
                draw(empty)

    def test_wrong_options(self):
        data = figures.read(self.recorded)
        with self.assertRaises(NotThere):
            figures.lift_curves(data, align="touchdown")
        with self.assertRaises(NotThere):
            figures.lift_phases(data, colour=["no such column"])


class PreviousWeight(unittest.TestCase):
    def test_is_what_the_lifts_were_made_with(self):
        random = np.random.default_rng(3)
        weights = random.choice([2.0, 8.0], 60)
        before = np.concatenate([[2.0], weights[:-1]])
        rates = 5 + 1.5 * weights + 0.5 * before + 0.1 * random.normal(size=60)
        lifts = pd.DataFrame({"group": "", "person": "S01", "session": "s", "lift": "complete", "static_load_N": weights, "peak_load_rate_N_s": rates})

        def found(table):
            data = unittest.mock.Mock(has=lambda name: True, table=lambda name: table)
            return previous_weight(data)

        (effect,) = found(lifts).itertuples()
        self.assertLess(abs(effect.effect - 0.5), 4 * effect.error)
        self.assertLess(effect.error, 0.02)
        self.assertAlmostEqual(effect.share, 0.25, delta=0.02)
        self.assertEqual(effect.n, 59)
        # the first lift of a session has none before it, and one that failed tells nothing
        both = lifts.assign(session=["s"] * 30 + ["t"] * 30)
        self.assertEqual(found(both).n.item(), 58)
        both.loc[5, "lift"] = "not lifted"
        self.assertEqual(found(both).n.item(), 56)
        self.assertTrue(found(lifts.assign(static_load_N=2.0)).empty)
        # who came before and after a training has an effect of each
        twice = pd.concat([lifts.assign(group="before"), lifts.assign(group="after", session="t")])
        self.assertEqual(found(twice)[["group", "n"]].values.tolist(), [["before", 59], ["after", 59]])


if __name__ == "__main__":
    unittest.main()
