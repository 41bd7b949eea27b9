"""Figures and reports as journals and laboratories of any country want them. docs/outside.md has the sources.

Usage: outside/reports_test.py PROGRAM, from the project's folder.
"""
import os
import pathlib
import re
import struct
import sys
import tempfile
import unittest
import warnings

sys.path.append("test/cli")
from program import PROGRAM, dihaptic

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(PROGRAM)), "python"))
import numpy as np  # noqa: E402
import pandas as pd  # noqa: E402
from scipy import stats  # noqa: E402

from dihaptic import figures  # noqa: E402

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


if __name__ == "__main__":
    unittest.main()
