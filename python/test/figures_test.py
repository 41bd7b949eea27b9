"""Figures for papers: every figure of every shipped experiment can be read, and is drawn again by its script."""

import contextlib
import io
import runpy
import shutil
import subprocess
import sys
import tempfile
import unittest
import unittest.mock
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "test"))

import pandas as pd  # noqa: E402
import soak  # noqa: E402
from drawn import Drawn, rehearsed  # noqa: E402

import dihaptic as dh  # noqa: E402
from dihaptic import figures  # noqa: E402
from dihaptic.figures import drawing, quality, saving  # noqa: E402

#: Fewer lifts of grip-and-lift.
GRIP = [("suede], repeats: 4", "suede], repeats: 1"), ("perturbed, repeats: 4", "perturbed, repeats: 1")]
#: The experiment of which `./dev test` draws all figures, with fewer trials: its conditions have long names.
SAMPLE = {"bimanual-bar": [("repeats: 4", "repeats: 1")]}


def few(formats=("svg",), kinds=(quality,)):
    """While this lasts, figures of these kinds alone are drawn, in these formats: others would tell no more, and take time."""
    stack = contextlib.ExitStack()
    stack.enter_context(unittest.mock.patch.object(saving, "FORMATS", formats))
    stack.enter_context(unittest.mock.patch.object(drawing, "KINDS", kinds))
    return stack


class Figures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.grip = rehearsed("grip-and-lift", cls.folder.name, 2, GRIP)
        cls.done = subprocess.run([sys.executable, "-m", "dihaptic.figures", cls.grip], capture_output=True, text=True)

    def test_means_are_those_of_pandas(self):
        lifts = pd.read_csv(self.grip / "lifts.csv")
        trials = pd.read_csv(self.grip / "trials.csv").merge(lifts, on=["seed", "id", "trial_num", "attempt"])
        trials = trials[~trials.kind.isin(["practice", "catch"])].drop_duplicates(["id", "trial_num"], keep="last")
        column = "peak_grip_N_y" if "peak_grip_N_y" in trials else "peak_grip_N"
        for keys, options in ((["mass_g"], {}), (["mass_g", "surface"], {"colour": "surface"})):
            points = figures.means_by_condition(
                figures.read(self.grip), measures=["peak_grip_N"], x="mass_g", table="lifts", **options
            )
            each = trials.groupby([*keys, "id"])[column].mean()
            people = points[points.of == "person"].set_index([*keys, "person"]).value
            pd.testing.assert_series_equal(people.sort_index(), each.sort_index(), check_names=False, rtol=1e-12)
            over = each.groupby(level=list(range(len(keys)))).mean()
            mean = points[points.of == "mean"].set_index(keys).value
            pd.testing.assert_series_equal(mean.sort_index(), over.sort_index(), check_names=False, rtol=1e-12)

    def test_a_script_draws_the_same_figure(self):
        scripts = sorted((self.grip / "figures").glob("*.py"))
        scripts = [script for script in scripts if script.name != "analysis.py"]
        self.assertGreater(len(scripts), 4)
        for script in scripts:
            with self.subTest(script.name):
                self.assertLessEqual(10, len(script.read_text().splitlines()), script)
                self.assertLessEqual(len(script.read_text().splitlines()), 40, script)
                before = {kind: script.with_suffix(kind).read_bytes() for kind in (".svg", ".csv")}
                for kind in before:
                    script.with_suffix(kind).unlink()
                if script == scripts[0]:  # as it is meant to be run
                    done = subprocess.run([sys.executable, script], capture_output=True, text=True, cwd="/")
                    self.assertEqual(done.returncode, 0, done.stderr)
                else:
                    with few(), contextlib.chdir("/"):
                        runpy.run_path(str(script))
                for kind, content in before.items():
                    self.assertEqual(script.with_suffix(kind).read_bytes(), content, kind)

    def test_a_script_that_was_changed_is_kept(self):
        folder = Path(self.folder.name, "changed")
        shutil.copytree(self.grip, folder, ignore=shutil.ignore_patterns("figures"))
        with few():
            script = figures.draw(folder)[0]
            script.write_text("size = 3\n")
            script.with_suffix(".svg").unlink()
            with self.assertWarnsRegex(UserWarning, "has been changed, so its figure is left as it is"):
                figures.draw(folder)
            self.assertEqual(script.read_text(), "size = 3\n")
            self.assertFalse(script.with_suffix(".svg").exists())
            script.unlink()
            figures.draw(folder)
            # another version explained the checksum in other words
            text = script.read_text()
            script.write_text(text[: text.rindex(": a script")] + ": of an earlier version.\n")
            figures.draw(folder)
            self.assertEqual(script.read_text(), text)
        self.assertTrue(script.with_suffix(".svg").exists())
        self.assertIn(f"{script.stem}: ", (script.parent / "captions.txt").read_text())

    def test_means_of_people_are_in_rows_and_in_columns(self):
        long, wide = (pd.read_csv(self.grip / f"figures/means-{kind}.csv") for kind in ("long", "wide"))
        lifts = pd.read_csv(self.grip / "lifts.csv")
        trials = pd.read_csv(self.grip / "trials.csv").merge(lifts, on=["seed", "id", "trial_num", "attempt"])
        trials = trials[~trials.kind.isin(["practice", "catch"])].drop_duplicates(["id", "trial_num"], keep="last")
        each = trials.groupby(["id", "mass_g", "surface"])["static_ratio"].mean()
        own = long[long.measure == "static_ratio"].set_index(["person", "mass_g", "surface"])["mean"]
        pd.testing.assert_series_equal(own.sort_index(), each.sort_index(), check_names=False, rtol=1e-12)
        for (person, mass, surface), mean in each.items():
            column = f"static_ratio_{mass}_{surface.replace(' ', '_')}"
            self.assertAlmostEqual(wide.set_index("person").loc[person, column], mean, delta=1e-9)
        self.assertEqual(len(wide), 2)
        for column in wide:
            self.assertRegex(column, r"^[A-Za-z]\w*$")

    def test_a_rating_is_a_measure(self):
        rated = rehearsed("size-weight", self.folder.name, 2, [("repeats: 20", "repeats: 2")])
        data = figures.read(rated)
        self.assertEqual(data.measures[0].column, "heaviness")
        lifts = figures.conditions.measures_of_lifts(data)  # without those that the task measures by other names
        self.assertEqual(lifts, ["static_grip_N", "static_ratio", "loading_s"])

    def test_figures_of_simulated_people_say_so(self):
        data = figures.read(self.grip)
        points = figures.means_by_condition(data, measures=["peak_grip_N"], x="mass_g", table="lifts")
        words = [text.get_text() for text in figures.draw_conditions(points, x="mass_g").texts]
        self.assertEqual(words, ["simulated"])
        heavy = points[points["mass_g"] > 100]
        self.assertEqual(len(figures.draw_conditions(heavy, x="mass_g").texts), 1)
        points.attrs["mark"] = ""
        self.assertEqual(len(figures.draw_conditions(points, x="mass_g").texts), 0)

    def test_some_of_the_people(self):
        options = {"measures": ["peak_grip_N"], "x": "mass_g", "table": "lifts"}
        one = figures.means_by_condition(figures.read(self.grip, people=["sim-002"]), **options)
        self.assertEqual(set(one.person.dropna()), {"sim-002"})
        both = figures.means_by_condition(figures.read(self.grip), **options)
        of_two = both[(both.of == "person") & (both.person == "sim-002")].value
        pd.testing.assert_series_equal(one[one.of == "mean"].value, of_two, check_names=False, check_index=False, rtol=1e-12)

    def test_mistakes_are_told(self):
        data = figures.read(self.grip)
        means = figures.means_by_condition(data, measures=["peak_grip_N"], x="mass_g", colour="surface", table="lifts")
        self.assertEqual(list(dict.fromkeys(means.surface)), ["sandpaper", "suede", "silk"])
        for said, call in [
            ("mas_g: is not a column", lambda: figures.means_by_condition(data, measures=["peak_grip_N"], x="mas_g")),
            ("contains words", lambda: figures.means_by_condition(data, measures=["lift"], x="mass_g", table="lifts")),
            ("there are several means at one place", lambda: figures.draw_conditions(means, x="mass_g")),
            ("no mean is", lambda: figures.draw_conditions(means[means.of == "person"], x="mass_g", colour="surface")),
            ("is not a person", lambda: figures.read(self.grip, people=["S01"])),
            ("cannot be written", lambda: figures.save(figures.canvas()[0], "/proc/figure")),
            ("is not a size", lambda: figures.canvas("three columns")),
        ]:
            with self.subTest(said), self.assertRaisesRegex(dh.Error, said):
                call()

    def test_the_command(self):
        self.assertEqual(self.done.returncode, 0, self.done.stderr)
        data = figures.read(self.grip)
        names = {plan.name for kind in drawing.KINDS for plan in kind.plans(data)}
        for kind in ("svg", "pdf", "png", "csv", "py"):
            self.assertLessEqual(names, {file.stem for file in (self.grip / "figures").glob(f"*.{kind}")}, kind)
            self.assertTrue(all(file.stat().st_size > 0 for file in (self.grip / "figures").glob(f"*.{kind}")), kind)
        out = Path(self.folder.name, "out")
        for words, code, said in [
            ([], 2, "Usage"), (["--help"], 0, "Example"), (["no-such-folder"], 1, "contains no completed sessions"),
            ([str(self.grip), str(out)], 0, "outcomes"),
        ]:  # fmt: skip
            told, argv = io.StringIO(), unittest.mock.patch.object(sys, "argv", ["", *words])
            with few(("pdf",)), argv, unittest.mock.patch("warnings.formatwarning"), self.assertRaises(SystemExit) as ended:
                with contextlib.redirect_stdout(told), contextlib.redirect_stderr(told):
                    runpy.run_module("dihaptic.figures", run_name="__main__")
            self.assertEqual(ended.exception.code, code, words)
            self.assertIn(said, told.getvalue())
        self.assertTrue(list(out.glob("*.pdf")))


def shipped():
    """The shipped experiments that simulated people can do."""
    return sorted(path.stem for path in Path("experiments").glob("*.yaml") if "\ntask:" in path.read_text())


class Shipped(Drawn):
    """Every figure of an experiment, of two people and of one: it has points, and its texts can be read."""


def check(name):
    def test(self):
        with tempfile.TemporaryDirectory() as folder:
            people = rehearsed(name, folder, 2, soak.of(SAMPLE.get(name), ()))
            for path in (people, people / "sim-001"):
                with self.subTest(path.name):
                    data = figures.read(path)
                    names = [name for kind in drawing.KINDS for name in self.check(kind, data)]
                    self.assertEqual(len(names), len(set(names)), names)

    return test


for _name in soak.of(SAMPLE, shipped()):
    setattr(Shipped, "test_" + _name.replace("-", "_"), check(_name))


if __name__ == "__main__":
    unittest.main()
