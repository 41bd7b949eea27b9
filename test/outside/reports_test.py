"""Figures and reports as journals and laboratories of any country want them. docs/outside.md has the sources.

Usage: outside/reports_test.py PROGRAM, from the project's folder.
"""
import os
import pathlib
import re
import shutil
import struct
import sys
import tempfile
import unittest
import unittest.mock
import warnings

sys.path.append("test/cli")
from program import PROGRAM, dihaptic

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(PROGRAM)), "python"))
import numpy as np  # noqa: E402
import pandas as pd  # noqa: E402
from scipy import stats  # noqa: E402

from dihaptic import figures  # noqa: E402
from dihaptic.figures import saving  # noqa: E402
from dihaptic.reports import write_page  # noqa: E402
from dihaptic.reports.differences import difference  # noqa: E402
from dihaptic.reports.page import with_interval  # noqa: E402


def experiment(levels):
    """A shipped experiment with these distances, and fewer trials."""
    text = pathlib.Path("experiments/fitts-law.yaml").read_text().replace("../", os.getcwd() + "/")
    text = re.sub(r"(factor: distance_mm, levels: )\[[^\]]*\]", rf"\g<1>[{levels}]", text)
    assert levels in text
    return re.sub(r"repeats: \d+", "repeats: 1", text)


class Reports(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        (cls.folder / "distances.yaml").write_text(experiment("100, 20, 50"))
        cls.people = cls.folder / "people"
        for words in (["rehearse", cls.folder / "distances.yaml", "--people", "3", "--out", cls.people], ["report", cls.people]):
            done = dihaptic(*map(str, words))
            assert done.returncode == 0, done.stderr
        cls.figures = cls.people / "figures"
        cls.name = next(cls.figures.glob("measures-by-distance*.csv")).stem

    def test_rounds_in_different_orders_are_not_mixed_and_forces_that_were_not_felt_are_told(self):
        """Shergill, Bays, Frith and Wolpert 2003: half of the people begin with the one way, half with the other."""
        (self.folder / "rounds.yaml").write_text(f"""title: Rounds
scene: {os.getcwd()}/scenes/reach-in-space.yaml
hand: {{ centre_mm: [0, 0, 120] }}
task:
  draws: [{{ name: extra, uniform: {{ from: 0, to: 1 }} }}]
  perturbations: [{{ name: strong, loads: [{{ kind: constant, on: index, force_N: [0, 0, 12] }}] }}]
  states: [{{ name: wait, exits: [{{ when: time, after_s: 0.1, outcome: done }}] }}]
  feedback_s: 0
  round_order: counterbalanced
  rounds: [{{ name: low, factors: {{ level: 1 }} }}, {{ name: high, factors: {{ level: 11 }} }}]
  custom_measures: [{{ name: score_mm, of: index.z + 1 m * (level + extra), take: last }}]
  blocks:
    - {{ name: quiet, repeats: 8 }}
    - {{ name: pushed, kind: perturbed, perturb: strong, repeats: 4 }}
""")
        out = self.folder / "rounds"
        for words in (["rehearse", self.folder / "rounds.yaml", "--people", "4", "--out", out], ["report", out]):
            done = dihaptic(*map(str, words))
            self.assertEqual(done.returncode, 0, done.stderr)
        page = (out / "report.html").read_text()
        self.assertIn("In 32 of 96 trials a device gave less force than was asked for", page)
        self.assertIn("trials are counted within this one, and those outside the rounds are not drawn", page)
        self.assertFalse((out / "figures/measures-over-trials.csv").exists())
        for name, level in (("low", 1), ("high", 11)):
            points = pd.read_csv(out / f"figures/measures-over-trials-{name}.csv")
            means = points[points.of == "mean"]
            self.assertEqual(means.trial.tolist(), list(range(1, 13)))
            self.assertTrue(means.value.between(1000 * level, 1000 * level + 1500).all())

    def test_a_pdf_has_no_fonts_that_journals_refuse(self):
        for file in self.figures.glob("*.pdf"):
            content = file.read_bytes()
            self.assertNotIn(b"/Type3", content, file)
            self.assertIn(b"/TrueType" if b"/TrueType" in content else b"/CIDFontType2", content, file)

    def test_a_png_says_that_it_has_300_dots_per_inch(self):
        for file in self.figures.glob("*.png"):
            content = file.read_bytes()
            at = content.index(b"pHYs") + 4
            across, down, unit = struct.unpack(">IIB", content[at : at + 9])
            self.assertEqual((across, down, unit), (11811, 11811, 1), file)  # per metre

    def test_levels_are_in_the_order_of_their_values(self):
        svg = (self.figures / f"{self.name}.svg").read_text()
        found = re.findall(r">(20|50|100)</text>", svg)
        self.assertEqual(found[:3], ["20", "50", "100"])
        page = (self.people / "report.html").read_text()
        self.assertIn('<th>20 mm</th><th>50 mm</th><th>100 mm</th>', page)

    def test_an_interval_is_over_people_who_came_with_many_trials(self):
        points = pd.read_csv(self.figures / f"{self.name}.csv")
        points = points[points.measure == "movement_time_s"]
        for keys, own in points[points.of == "person"].groupby(["distance_mm", "width_mm"]):
            mean = points[(points.of == "mean") & (points.distance_mm == keys[0]) & (points.width_mm == keys[1])].iloc[0]
            half = stats.t.ppf(0.975, 2) * own.value.std() / np.sqrt(3)
            np.testing.assert_allclose([mean.low, mean.high], [mean.value - half, mean.value + half], rtol=1e-9)
            self.assertEqual(mean.n, 3)
        self.assertIn("over people", (self.figures / "captions.txt").read_text())

    def test_letters_of_every_script_are_drawn_or_the_missing_font_is_named(self):
        figure, (axes,) = figures.canvas()
        axes.set_xlabel("触觉 [N], сила, δύναμη, قوة")
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            figures.save(figure, self.folder / "label")
        self.assertIn("触觉", (self.folder / "label.svg").read_text())
        said = [str(each.message) for each in told]
        self.assertLessEqual(len(said), 1, said)
        for words in said:  # there is a warning if no font has these letters
            self.assertRegex(words, "label: no font of this computer has 触觉, .*Install")

    def test_an_svg_has_no_points_far_away(self):
        row = {"measure": "threshold_share", "quantity": "period", "unit": "mm", "logarithmic": True, "procedure": "one", "group": ""}
        points = [{**row, "of": "person", "person": f"p{i}", "n": 1, "value": 2.5 + i} for i in range(3)]
        points.append({**row, "of": "mean", "n": 3, "value": 3.4, "low": 0.0, "high": 9.0})
        figures.save(figures.draw_thresholds(pd.DataFrame(points)), self.folder / "thresholds.svg")
        for file in [*self.figures.glob("*.svg"), self.folder / "thresholds.svg"]:
            svg = file.read_text()
            width, height = (float(re.search(rf'<svg[^>]* {side}="([\d.]+)pt"', svg).group(1)) for side in ("width", "height"))
            paths = re.findall(r' d="([^"]*)"', re.sub(r"<defs>.*?</defs>", "", svg, flags=re.S))
            numbers = [float(number) for path in paths for number in re.findall(r"-?[\d.]+(?:e[-+]?\d+)?", path)]
            self.assertLess(max(map(abs, numbers)), 2 * max(width, height), file)


class Differences(unittest.TestCase):
    """Of three people, with movement times that were measured before and after, in folders of other names and orders."""

    #: How much slower each of them is afterwards [s].
    LATER = {"sim-001": 0.1, "sim-002": 0.2, "sim-003": 0.6}

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        (cls.folder / "distances.yaml").write_text(experiment("100, 20, 50"))
        done = dihaptic("rehearse", str(cls.folder / "distances.yaml"), "--people", "3", "--out", str(cls.folder / "people"))
        assert done.returncode == 0, done.stderr
        cls.before = cls.copies("before", {"sim-001": "a", "sim-002": "b", "sim-003": "c"}, {})
        cls.after = cls.copies("after", {"sim-003": "a", "sim-001": "b", "sim-002": "c"}, cls.LATER)
        cls.fewer = cls.copies("fewer", {"sim-002": "a", "sim-001": "b"}, {"sim-001": 0.3, "sim-002": 0.1})

    @classmethod
    def copies(cls, name, places, later):
        for person, place in places.items():
            session = cls.folder / name / place
            shutil.copytree(cls.folder / "people" / person, session)
            trials = pd.read_csv(session / "trials.csv")
            trials["movement_time_s"] += later.get(person, 0)
            trials.to_csv(session / "trials.csv", index=False)
        return cls.folder / name

    def compared(self, *paths):
        """The cells of the row of movement time, and the page."""
        out = self.folder / "-".join(path.name for path in paths)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            with unittest.mock.patch.object(saving, "FORMATS", ("svg",)):
                page = write_page(list(paths), out).read_text()
        self.assertIn("Differences between groups", page)
        rows = re.findall(r"<tr><td>movement time \[s\]</td><td>100 mm</td>(.*?)</tr>", page)
        return [re.findall(r"<td[^>]*>([^<]*)</td>", row) for row in rows if "pair" in row]

    def interval(self, values):
        half = stats.t.ppf(0.975, len(values) - 1) * np.std(values, ddof=1) / np.sqrt(len(values))
        return with_interval(np.mean(values), np.mean(values) - half, np.mean(values) + half)

    def test_people_are_compared_with_themselves_in_any_order(self):
        ((*_, found, n),) = self.compared(self.before, self.after)
        self.assertEqual((found, n), (self.interval(list(self.LATER.values())), "3 pairs"))

    def test_whoever_lacks_one_side_does_not_count(self):
        ((*_, found, n),) = self.compared(self.before, self.fewer)
        self.assertEqual((found, n), (self.interval([0.3, 0.1]), "2 pairs"))

    def test_whoever_lacks_a_third_group_counts_in_the_first_two(self):
        rows = self.compared(self.before, self.after, self.fewer)
        self.assertEqual([row[-1] for row in rows], ["3 pairs", "2 pairs"])
        self.assertEqual(rows[0][-2], self.interval(list(self.LATER.values())))

    def test_freedom_is_that_of_pairs(self):
        before = pd.Series([35, 81, 69, 82, 84, 108, 75, 57, 102, 68, 76, 75], range(12))
        after = pd.Series([32, 84, 66, 107, 76, 110, 99, 59, 112, 92, 76, 112], range(12))
        found = difference(after, before)  # the published values are those of R's t.test
        np.testing.assert_allclose([found.value, found.low, found.high], [-9.416667, -18.5659033, -0.2674301], atol=1e-6)
        self.assertEqual(found.n, "12 pairs")


if __name__ == "__main__":
    unittest.main()
