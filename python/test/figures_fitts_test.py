"""The figure of Fitts's law: recognised from the design, with the index, the line and the throughput that are known."""

import tempfile
import unittest
from pathlib import Path

import numpy as np
import pandas as pd
from drawn import Drawn, rehearsed, with_tables

import dihaptic as dh
from dihaptic import figures
from dihaptic.figures import fitts

FEWER = [("practice, repeats: 1", "practice, repeats: 1"), ("repeats: 8", "repeats: 1")]


class Fitts(Drawn):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = rehearsed("fitts-law", Path(folder.name), 2, FEWER)

    def exact(self, **group):
        """The data with movement times of 0.2 s + 0.1 s/bit."""
        trials = figures.read(self.folder).table("trials").assign(**group)
        trials["movement_time_s"] = 0.2 + 0.1 * np.log2(trials["distance_mm"] / trials["width_mm"] + 1)
        return with_tables(self.folder, trials=trials)

    def test_index_line_and_throughput_are_those_that_are_known(self):
        points = figures.fitts_law(self.exact())
        means = points[points["of"] == "mean"]
        self.assertEqual(len(means), 9)
        np.testing.assert_allclose(means["difficulty_bits"], np.log2(means["distance_mm"] / means["width_mm"] + 1))
        line = points[points["of"] == "line"].iloc[0]
        np.testing.assert_allclose([line["intercept_s"], line["slope_s_bit"], line["r2"]], [0.2, 0.1, 1], rtol=1e-9)
        np.testing.assert_allclose(line["throughput_bits_s"], (means["difficulty_bits"] / means["value"]).mean())

    def test_it_is_drawn(self):
        made = self.check(fitts, self.exact(), ["fitts-law"], kept=True)
        self.assertIn("0.200 s + 0.100 s/bit × ID (R² = 1.00)", made["fitts-law"][0].caption)
        self.assertIn("log2(D / W + 1)", made["fitts-law"][0].caption)

    def test_groups_have_lines_of_their_own(self):
        people = figures.read(self.folder).table("trials")["person"]
        made = self.check(fitts, self.exact(group=people.map({"sim-001": "a", "sim-002": "b"})), ["fitts-law"], kept=True)
        plan, points, _ = made["fitts-law"]
        self.assertEqual(points[points["of"] == "line"]["group"].tolist(), ["a", "a", "b", "b"])
        self.assertNotIn("95 %", plan.caption)  # of one person each

    def test_one_person_has_trials(self):
        points = figures.fitts_law(figures.read(self.folder, people=["sim-001"]))
        self.assertEqual((points["of"] == "person").sum(), 9)

    def test_other_designs_have_none(self):
        data = self.exact()
        for key, value in (("movement", {}), ("regions", []), ("conditions", [{"regions": [{"name": "target"}]}])):
            data.__dict__["tasks"] = [{**figures.read(self.folder).task, key: value}]
            self.assertEqual(list(fitts.plans(data)), [], key)
            with self.assertRaisesRegex(dh.Error, "no reach to targets of several"):
                figures.fitts_law(data)

    def test_expressions_of_regions(self):
        values = {"width": pd.Series([8.0, 16.0]), "start.x": -80.0}
        self.assertEqual(list(fitts._numbers({"radius_mm": "width / 2"}, "radius", values)[0]), [4, 8])
        self.assertEqual(fitts._numbers({"position_m": [0.1, "0", -0.2]}, "position", values), [100, 0, -200])
        self.assertEqual(fitts._numbers({"position_mm": ["-start.x + 2 cm"]}, "position", values), [100])
        for text in ("sin(width)", "unknown + 1", "width if width else 1", "width **", "'a'"):
            self.assertIsNone(fitts._numbers({"radius_mm": text}, "radius", values), text)


if __name__ == "__main__":
    unittest.main()
