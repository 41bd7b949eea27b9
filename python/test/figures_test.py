"""Figures for papers: every figure of every shipped experiment can be read, and is drawn again by its script."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "test"))

import pandas as pd  # noqa: E402
import soak  # noqa: E402
from boxes import faults  # noqa: E402

import dihaptic as dh  # noqa: E402
from dihaptic import figures  # noqa: E402
from dihaptic.figures.drawing import plans  # noqa: E402


def rehearsed(name, folder, people=2):
    """A rehearsal of a shipped experiment by few people, with its tables."""
    out = Path(folder, name)
    dh.rehearse(f"experiments/{name}.yaml", people, out=out, progress=False)
    return out


class Figures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.grip = rehearsed("grip-and-lift", cls.folder.name)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_means_are_those_of_pandas(self):
        points = figures.means_by_condition(
            figures.read(self.grip), measures=["peak_grip_N"], x="mass_g", colour="surface", table="lifts"
        )
        lifts = pd.read_csv(self.grip / "lifts.csv")
        trials = pd.read_csv(self.grip / "trials.csv").merge(lifts, on=["seed", "id", "trial_num", "attempt"])
        trials = trials[~trials.kind.isin(["practice", "catch"])].drop_duplicates(["id", "trial_num"], keep="last")
        each = trials.groupby(["mass_g", "surface", "id"]).peak_grip_N_y.mean() if "peak_grip_N_y" in trials else None
        people = points[points.of == "person"].set_index(["mass_g", "surface", "person"]).value
        pd.testing.assert_series_equal(people.sort_index(), each.sort_index(), check_names=False, rtol=1e-12)
        over = each.groupby(level=[0, 1]).mean()
        mean = points[points.of == "mean"].set_index(["mass_g", "surface"]).value
        pd.testing.assert_series_equal(mean.sort_index(), over.sort_index(), check_names=False, rtol=1e-12)

    def test_a_script_draws_the_same_figure(self):
        for script in figures.draw(self.grip):
            with self.subTest(script.name):
                before = {kind: script.with_suffix(kind).read_bytes() for kind in (".svg", ".csv")}
                for kind in before:
                    script.with_suffix(kind).unlink()
                done = subprocess.run([sys.executable, script], capture_output=True, text=True, cwd="/")
                self.assertEqual(done.returncode, 0, done.stderr)
                for kind, content in before.items():
                    self.assertEqual(script.with_suffix(kind).read_bytes(), content, kind)
                self.assertLessEqual(10, len(script.read_text().splitlines()), script)
                self.assertLessEqual(len(script.read_text().splitlines()), 40, script)

    def test_a_script_that_was_changed_is_kept(self):
        script = figures.draw(self.grip)[0]
        script.write_text("size = 3\n")
        script.with_suffix(".svg").unlink()
        with self.assertWarnsRegex(UserWarning, "has been changed, so its figure is left as it is"):
            figures.draw(self.grip)
        self.assertEqual(script.read_text(), "size = 3\n")
        self.assertFalse(script.with_suffix(".svg").exists())
        script.unlink()
        figures.draw(self.grip)
        self.assertTrue(script.with_suffix(".svg").exists())
        self.assertIn(f"{script.stem}: ", (script.parent / "captions.txt").read_text())

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
            ("has words", lambda: figures.means_by_condition(data, measures=["lift"], x="mass_g", table="lifts")),
            ("there are several means at one place", lambda: figures.draw_conditions(means, x="mass_g")),
            ("there is no mean", lambda: figures.draw_conditions(means[means.of == "person"], x="mass_g", colour="surface")),
            ("is not a person", lambda: figures.read(self.grip, people=["S01"])),
            ("cannot be written", lambda: figures.save(figures.canvas()[0], "/proc/figure")),
            ("is not a size", lambda: figures.canvas("three columns")),
        ]:
            with self.subTest(said), self.assertRaisesRegex(dh.Error, said):
                call()

    def test_the_command(self):
        done = subprocess.run(
            [sys.executable, "-m", "dihaptic.figures", self.grip, Path(self.folder.name, "out")], capture_output=True, text=True
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(list(Path(self.folder.name, "out").glob("*.pdf")))
        for words, code, said in [
            ([], 2, "Usage"), (["--help"], 0, "Example"), (["no-such-folder"], 1, "contains no completed sessions"),
        ]:  # fmt: skip
            done = subprocess.run([sys.executable, "-m", "dihaptic.figures", *words], capture_output=True, text=True)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn(said, done.stdout + done.stderr)


def shipped():
    """The shipped experiments that simulated people can do."""
    return sorted(path.stem for path in Path("experiments").glob("*.yaml") if "\ntask:" in path.read_text())


class Shipped(unittest.TestCase):
    """Every figure of an experiment, of two people and of one: it has points, and its texts can be read."""


def check(name):
    def test(self):
        with tempfile.TemporaryDirectory() as folder:
            people = rehearsed(name, folder)
            for path in (people, people / "sim-001"):
                data = figures.read(path)
                for plan in plans(data):
                    with self.subTest(f"{path.name}: {plan.name}"):
                        points, figure = plan.make(data)
                        self.assertFalse(points.empty)
                        self.assertEqual(faults(figure), [])

    return test


# conditions with long names; answers
for _name in soak.of(["bimanual-bar", "delayed-stiffness"], shipped()):
    setattr(Shipped, "test_" + _name.replace("-", "_"), check(_name))


if __name__ == "__main__":
    unittest.main()
