"""Figures of psychophysics: their numbers are those of pandas, and they can be read with any number of people and answers."""

import sys
import tempfile
import unittest
import unittest.mock
import warnings
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "test"))

import numpy as np  # noqa: E402
import pandas as pd  # noqa: E402
import soak  # noqa: E402
from boxes import faults  # noqa: E402
from drawn import Drawn, with_tables  # noqa: E402
from scipy import special, stats  # noqa: E402
from small_study import dihaptic  # noqa: E402

from dihaptic import figures  # noqa: E402
from dihaptic.errors import Error, NotThere  # noqa: E402
from dihaptic.figures import psychophysics  # noqa: E402

STATES = """
  states:
    - name: look
      exits:
        - { when: key, key: l, outcome: left }
        - { when: key, key: r, outcome: right }
        - { when: time, after_s: 1, outcome: no answer, redo: yes }
"""
HEAD = """title: Four ways to a threshold
scene: scenes/block-on-table.yaml
hand: { centre_mm: [0, 0, 60], aperture_mm: 85 }
task:
  regions:
    - { name: middle, position_mm: [0, 0, 60], radius_mm: 20 }
  perturbations:
    - { name: larger, visual: { moves: [proxies], about: middle, scale: [1.5, 1.5, 1.5] } }
    - { name: sized, visual: { moves: [proxies], about: middle, scale: [size / (1 mm), 1, 1] } }
"""
GRIDS = "levels: { from: 0, to: 1, count: 21 }, thresholds: { from: 0.1, to: 1, count: 10 }"
QUEST_PLUS = f"{{ {GRIDS}, shapes: {{ from: 0.1, to: 0.5, count: 3 }} }}"
PROCEDURES = f"""{HEAD}{STATES}
  procedures:
    - {{ name: up and down, perturb: larger, yes: left, no: right, trials: 24, guess: 0.5,
        staircase: {{ start: 0.8, steps_up: [0.2, 0.1], down_after: 1, lowest: 0.1, skipped_reversals: 1 }} }}
    - {{ name: quest, perturb: larger, logarithmic: yes, yes: left, no: right, trials: 20, guess: 0.5,
        quest: {{ prior_mean: -0.5, prior_sd: 0.5, target: 0.82, slope: 3.5, lowest: -2, highest: 0 }} }}
    - {{ name: the most telling level, perturb: larger, yes: left, no: right, trials: 16, guess: 0.5,
        quest_plus: {QUEST_PLUS} }}
    - {{ name: constant, level: size_mm, perturb: sized, standard: 1, yes: left, no: right, sigmoid: logistic,
        guess_is_lapse: yes, trials: 40, constant: {{ levels: [0.6, 0.8, 1, 1.2, 1.4] }} }}
  blocks:
    - {{ name: all, kind: perturbed, procedures: [up and down, quest, the most telling level, constant] }}
"""
ANSWERS = f"""{HEAD.replace("size /", "width /")}{STATES}
  draws:
    - {{ name: side, permutation: [-1, 1] }}
  cross:
    - {{ factor: modality, levels: [touch, vision] }}
    - {{ factor: width_mm, levels: [0.9, 1, 1.1] }}
  blocks:
    - {{ name: clear, kind: baseline, repeats: 4 }}
    - {{ name: shaken, kind: perturbed, perturb: larger, repeats: 2 }}
"""


def done(text, folder, name, people):
    """A rehearsal of an experiment that is written here, with its tables."""
    file, out = Path(folder, f"{name}.yaml"), Path(folder, name)
    file.write_text(text)
    dihaptic("rehearse", file, "--people", people, "--out", out)
    dihaptic("report", out, "--tables")
    dihaptic("collect", out)
    return out


def interval(values):
    """Mean and 95 % interval, by scipy."""
    half = stats.t.ppf(0.975, len(values) - 1) * stats.sem(values)
    return np.mean(values), np.mean(values) - half, np.mean(values) + half


class Psychophysics(Drawn):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.many = done(PROCEDURES, cls.folder.name, "procedures", 4)
        cls.one = cls.many / "sim-002"
        cls.sides = done(ANSWERS, cls.folder.name, "sides", 3)

    def check(self, data, expected=None, kept=False):
        """All figures of these data can be read; returns their plans."""
        return {name: plan for name, (plan, _, _) in super().check(psychophysics, data, expected, kept).items()}

    def test_shares_are_those_of_pandas(self):
        points = figures.psychometric_functions(figures.read(self.one), procedures=["constant", "up and down"])
        trials = pd.read_csv(self.one / "trials.csv")
        trials = trials[trials.outcome.isin(["left", "right"])].assign(yes=lambda rows: rows.outcome == "left")
        for name, column in [("constant", "size_mm"), ("up and down", "share")]:
            own = trials[trials.procedure == name]
            each = own.groupby(own[column].round(9)).yes.agg(["mean", "count", "sum"])
            found = points[(points.procedure == name) & (points.of == "level")].sort_values("level")
            np.testing.assert_allclose(found.level, each.index, rtol=1e-9)
            np.testing.assert_allclose(found.value, each["mean"], rtol=1e-12)
            np.testing.assert_allclose(found.n, each["count"])
            for row, yes in zip(found.itertuples(), each["sum"]):
                ends = stats.binomtest(int(yes), int(row.n)).proportion_ci(method="wilson")
                if row.n >= 5:
                    np.testing.assert_allclose([row.low, row.high], ends, rtol=1e-12, atol=1e-12)
        self.assertEqual(points[points.procedure == "constant"].unit.unique().tolist(), ["mm"])

    def test_curves_are_those_of_the_parameters(self):
        points = figures.psychometric_functions(figures.read(self.one))
        fits = pd.read_csv(self.one / "thresholds.csv").set_index("procedure")
        for name, sigmoid in [
            ("constant", lambda x, t, s: special.expit((x - t) / s)),
            ("up and down", lambda x, t, s: stats.norm.cdf(x, t, s)),
            ("quest", lambda x, t, s: 1 - np.exp(-(10 ** (s * (np.log10(x) - t))))),
        ]:
            fit = fits.loc[name]
            curve = points[(points.procedure == name) & (points.of == "curve")]
            guess = fit.lapse if name == "constant" else 0.5
            wanted = guess + (1 - guess - fit.lapse) * sigmoid(curve.level, fit.threshold, fit["shape"])
            np.testing.assert_allclose(curve.value, wanted, rtol=1e-11)
            self.assertGreater(len(curve), 50)
            p = psychophysics.probability(
                fit.threshold, sigmoid={"constant": "logistic", "up and down": "normal"}.get(name, "weibull_log10"),
                threshold=fit.threshold, shape=fit["shape"], guess=guess, lapse=fit.lapse,
            )  # fmt: skip
            np.testing.assert_allclose(p, fit.threshold_probability, rtol=1e-7)
        weibull = psychophysics.probability([-1, 0, 2, 4], sigmoid="weibull", threshold=2, shape=3)
        np.testing.assert_allclose(weibull, [0, 0, *stats.weibull_min.cdf([2, 4], 3, scale=2)], rtol=1e-12)
        with self.assertRaises(NotThere):
            psychophysics.probability(0, sigmoid="gumbel", threshold=1, shape=1)

    def test_means_of_thresholds_are_those_of_pandas(self):
        table = pd.read_csv(self.many / "thresholds.csv")
        table = table[table.note.isna()]
        points = figures.thresholds_by_procedure(figures.read(self.many))
        functions = figures.psychometric_functions(figures.read(self.many))
        for name, own in table.groupby("procedure"):
            title = f"{name}, together" if "all of these" in set(own.kind) else name
            values = own.threshold_share
            with self.subTest(title):
                people = points[(points.procedure == title) & (points.of == "person")].set_index("person").value
                np.testing.assert_allclose(people[own.id], values, rtol=1e-12)
                mean = points[(points.procedure == title) & (points.of == "mean")].iloc[0]
                self.assertEqual(mean.n, len(own))
                wanted = np.mean(values) if name != "quest" else stats.gmean(values)
                np.testing.assert_allclose(mean.value, wanted, rtol=1e-12)
                if len(own) > 1:
                    ends = interval(values)[1:] if name != "quest" else 10 ** np.array(interval(np.log10(values))[1:])
                    np.testing.assert_allclose([mean.low, mean.high], ends, rtol=1e-12)
                same = functions[(functions.procedure == title) & (functions.of == "mean")].iloc[0]
                np.testing.assert_allclose([same.level, same.n], [mean.value, mean.n], rtol=1e-12)

    def test_reversals_are_those_of_the_report(self):
        points = figures.procedure_courses(figures.read(self.many))
        table = pd.read_csv(self.many / "thresholds.csv")
        for row in table[table.kind == "staircase"].itertuples():
            own = points[(points.procedure == row.procedure) & (points.person == row.id)]
            turns = own[own.of == "reversal"].level
            self.assertEqual(len(turns), row.reversals)
            if len(turns):
                even = turns.iloc[len(turns) % 2 :]  # as many peaks as valleys
                np.testing.assert_allclose(even.mean(), row.mean_of_reversals, rtol=1e-8)
        trials = pd.read_csv(self.many / "trials.csv")
        trials = trials[trials.outcome.isin(["left", "right"]) & (trials.procedure == "quest")]
        answers = points[(points.procedure == "quest") & (points.of == "answer")]
        np.testing.assert_allclose(answers.level, trials.share, rtol=1e-12)
        self.assertEqual(answers.said_yes.tolist(), (trials.outcome == "left").tolist())
        mean = points[(points.procedure == "quest") & (points.of == "mean")]
        number = trials.groupby("id").cumcount() + 1
        wanted = 10 ** np.log10(trials.share).groupby(number).mean()
        np.testing.assert_allclose(mean.level, wanted[mean.answer], rtol=1e-12)
        self.assertNotIn("constant", set(points.procedure))

    def test_answers_by_side_are_those_of_pandas(self):
        options = {"x": "width_mm", "answer": "left", "other": "right", "series": ["modality", "perturbation"], "side": "side"}
        points = figures.answers_by_level(figures.read(self.sides), **options)
        trials = pd.read_csv(self.sides / "trials.csv").drop_duplicates(["id", "trial_num"], keep="last")
        trials = trials[trials.outcome.isin(["left", "right"])]
        trials["comparison"] = trials.outcome == trials.side.map({-1: "left", 1: "right"})
        shaken = trials.perturbation.notna()
        trials["series"] = trials.modality + np.where(shaken, ", larger", "")
        self.assertEqual(list(dict.fromkeys(points.series)), ["touch", "touch, larger", "vision", "vision, larger"])
        each = trials.groupby(["series", "width_mm", "id"]).comparison.mean()
        people = points[points.of == "person"].set_index(["series", "x", "person"]).value
        np.testing.assert_allclose(people.sort_index(), each.sort_index(), rtol=1e-12)
        mean = points[points.of == "mean"].set_index(["series", "x"]).sort_index()
        for key, own in each.groupby(level=[0, 1]):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # all people may have the same share
                np.testing.assert_allclose(mean.loc[key, ["value", "low", "high"]].astype(float), interval(own), rtol=1e-12)
        single = figures.answers_by_level(figures.read(self.sides / "sim-001"), **options)
        row = single.iloc[0]
        ends = stats.binomtest(round(row.value * row.n), int(row.n)).proportion_ci(method="wilson")
        np.testing.assert_allclose([row.low, row.high], ends, rtol=1e-12, atol=1e-12)

    def test_figures_of_several_people_and_of_one(self):
        made = self.check(figures.read(self.many), kept=True)
        self.assertIn("4 people, 400 answers", made["psychometric-functions"].caption)
        made = self.check(figures.read(self.one), ["psychometric-functions", "procedure-courses"], kept=True)
        self.assertIn("1 person, 100 answers", made["psychometric-functions"].caption)
        for path in (self.sides, self.sides / "sim-001"):
            made = self.check(figures.read(path), ["answers-by-width-mm"], kept=True)
            self.assertEqual(made["answers-by-width-mm"].drawing_options["ylabel"], 'share of "comparison"')

    def test_groups_and_long_names(self):
        tables = {name: figures.read(self.many).table(name) for name in ("trials", "thresholds")}
        for table in tables.values():
            table["group"] = table.person.map({"sim-001": "with practice", "sim-002": "with practice"}).fillna("without practice")
        data = with_tables(self.many, **tables)
        made = self.check(data)
        points = made["psychometric-functions"].make(data)[0]
        self.assertEqual(set(points[points.of == "curve"].group), {"with practice", "without practice"})
        long = "which of two neighbouring forces is the stronger one, by the left index finger"
        points = points.assign(procedure=points.procedure.replace("quest", long))
        self.assertEqual(faults(figures.draw_psychometric_functions(points, size="two columns")), [])
        points = figures.thresholds_by_procedure(data)
        points = points.assign(procedure=points.procedure.replace("constant", long))
        self.assertEqual(faults(figures.draw_thresholds(points, size="two columns", height_mm=90)), [])

    def test_many_procedures_are_several_figures(self):
        trials, thresholds = (figures.read(self.one).table(name) for name in ("trials", "thresholds"))
        definitions = pd.read_csv(self.one / "procedures.csv")
        more = [definitions.iloc[[0]].assign(procedure=f"up and down {i}") for i in range(7)]
        copies = [trials[trials.procedure == "up and down"].assign(procedure=f"up and down {i}") for i in range(7)]
        data = with_tables(self.one, trials=pd.concat([trials, *copies], ignore_index=True), thresholds=thresholds)
        definitions = pd.concat([definitions, *more], ignore_index=True)
        with unittest.mock.patch.object(type(data.sessions[0]), "table", lambda session, name: definitions):
            made = self.check(data)
        names = ["psychometric-functions-1", "psychometric-functions-2", "procedure-courses-1", "procedure-courses-2"]
        self.assertEqual(list(made), names)
        self.assertEqual(sum(len(plan.points_options["procedures"]) for plan in list(made.values())[2:]), 10)

    def test_missing_values(self):
        trials, thresholds = (figures.read(self.one).table(name) for name in ("trials", "thresholds"))
        holes = trials.copy()
        holes.loc[holes.index[::3], ["outcome", "share", "size_mm"]] = np.nan
        self.check(with_tables(self.one, trials=holes))
        unfitted = thresholds.copy()
        unfitted[["threshold", "threshold_share", "shape", "lapse"]] = np.nan
        unfitted["threshold_95"] = "-"
        made = self.check(with_tables(self.one, thresholds=unfitted), ["psychometric-functions", "procedure-courses"])
        self.assertNotIn("Curves", made["psychometric-functions"].caption)
        without_intervals, none = thresholds.assign(threshold_95="-", lapse=np.nan), thresholds.iloc[:0]
        for changed in soak.of([none], [none, without_intervals]):
            self.check(with_tables(self.one, thresholds=changed))
        self.check(with_tables(self.one, trials=trials.groupby("procedure").head(1)))
        for table in (trials.iloc[:0], trials.assign(procedure=np.nan), trials.assign(outcome=np.nan)):
            data = with_tables(self.one, trials=table)
            self.check(data, [])
            for points in (figures.psychometric_functions, figures.procedure_courses, figures.thresholds_by_procedure):
                with self.assertRaises(Error):
                    points(data)
        sides = figures.read(self.sides).table("trials")
        sides.loc[sides.index[::4], ["outcome", "side", "width_mm"]] = np.nan
        self.check(with_tables(self.sides, trials=sides))
        self.check(with_tables(self.sides, trials=sides.iloc[:0]), [])

    def test_wrong_names(self):
        data = figures.read(self.many)
        with self.assertRaisesRegex(NotThere, "Did you mean 'constant'"):
            figures.psychometric_functions(data, procedures=["constnat"])
        with self.assertRaisesRegex(NotThere, "is not a measure"):
            figures.thresholds_by_procedure(data, measure="threshold")
        with self.assertRaises(Error):
            figures.answers_by_level(data, x="share", answer="up", other="down")


if __name__ == "__main__":
    unittest.main()
