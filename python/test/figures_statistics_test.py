"""The scripts of mixed models find an effect that was planted, both in Python and in R, and need nothing from the package."""

import contextlib
import functools
import importlib.util
import io
import os
import re
import runpy
import shutil
import subprocess
import sys
import tempfile
import unittest
import warnings
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "test"))

import needs  # noqa: E402
import numpy as np  # noqa: E402
import pandas as pd  # noqa: E402
import soak  # noqa: E402

import dihaptic  # noqa: E402
from dihaptic import figures  # noqa: E402

MASSES = [200, 400, 800]
SURFACES = ["sandpaper", "it's silk"]
SLOPE, STEP, MEAN = 0.012, 3.5, 8.0
TASK = """cross:
  - { factor: mass_g, levels: [200, 400, 800] }
  - { factor: surface, levels: [sandpaper, "it's silk"] }
blocks: [{ name: practice }, { name: lifts }]
"""


def simulated(seed, people=20, trials=10):
    """Attempts with a random intercept for each person, an effect of mass, and one of the surface."""
    random = np.random.default_rng(seed)
    rows = []
    for person in range(people):
        own = random.normal(0, 2)
        number = 0
        for mass in MASSES:
            for repeat in range(trials):
                number += 1
                surface = SURFACES[(repeat + person) % 2]
                value = MEAN + own + SLOPE * (mass - np.mean(MASSES)) + STEP * (surface != "sandpaper") + random.normal(0, 1.5)
                rows.append((f"{person:02}", "", number, mass, surface, value))
    return pd.DataFrame(rows, columns=["id", "group", "trial_num", "mass_g", "surface", "grip_N"])


def as_trials(table, **columns):
    """The columns that trials.csv of a rehearsal has, in their order."""
    fixed = {
        "group": table["group"], "id": table["id"], "trial_num": table["trial_num"], "block": "lifts",
        "kind": "baseline", "round": "", "condition": "", "perturbation": "", "mass_g": table["mass_g"],
        "surface": table["surface"], "attempt": 1, "outcome": "lifted", "grip_N": table["grip_N"], "not_measured": "",
        "simulated": "yes", "moved_by": "simulated_person",
    }  # fmt: skip
    return pd.DataFrame({**fixed, **columns}, index=table.index)


def sessions(folder, tables, task=TASK):
    """A folder with a session of each person, which has that person's rows of these tables."""
    for person, rows in tables["trials"].groupby("id"):
        own = Path(folder, person)
        own.mkdir(parents=True)
        group = rows["group"].iloc[0] if "group" in rows else ""
        of_study = f"in_study: {{ group: {group} }}\n" if group else ""
        about = f'title: Grip\nstate: complete\nparticipant: {{ id: "{person}" }}\n{of_study}'
        (own / "session.yaml").write_text(f"{about}moved_by: {{ mover: script }}\n...\n")
        (own / "task.yaml").write_text(task)
        for name, table in tables.items():
            table[table["id"] == person].drop(columns=["id", "group"]).to_csv(own / f"{name}.csv", index=False)
    return Path(folder)


def needs_statsmodels():
    if importlib.util.find_spec("statsmodels") is None:
        needs.skip("statsmodels is not installed; it is in the Debian package python3-statsmodels")


@functools.cache
def has_lme4():
    if shutil.which("Rscript") is None:
        return False
    # where it is: to load it takes more than a second
    there = subprocess.run(["Rscript", "-e", 'cat(system.file(package = "lme4"))'], capture_output=True, text=True)
    return bool(there.stdout)


def run_alone(*command):
    """What a script prints that knows nothing of the package."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    done = subprocess.run(command, capture_output=True, text=True, cwd="/", env=environment)
    if done.returncode != 0:
        raise AssertionError(done.stdout + done.stderr)
    return done.stdout


def run_here(script):
    """What a script of Python prints, run by this one: statsmodels is imported once."""
    printed = io.StringIO()
    with contextlib.chdir("/"), contextlib.redirect_stdout(printed), warnings.catch_warnings():
        warnings.simplefilter("ignore")  # run alone, it warns on standard error
        runpy.run_path(str(script), run_name="__main__")
    return printed.getvalue()


def fitted(printed):
    """What a script has printed: each measure's numbers, standard deviations, and [estimate, low, high] of its contrasts."""
    out, measure = {}, ""
    for line in printed.splitlines():
        if head := re.match(r"(\S+): (\d+) people, (\d+) trials", line):
            measure = head[1]
            out[measure, "n"] = [int(head[2]), int(head[3])]
        elif within := re.match(r"(\S+), within (\S+);", line):
            out[measure, "sd"] = [float(within[1]), float(within[2])]
        elif row := re.match(r"(.+?)\s+(-?[\d.e+-]+)\s+(-?[\d.e+-]+)\s+(-?[\d.e+-]+)\s*$", line):
            out[measure, row[1]] = [float(number) for number in row.groups()[1:]]
    return out


class Statistics(unittest.TestCase):
    def setUp(self):
        # the sessions are made up and lack seals, among other things; reading says so
        warnings.filterwarnings("ignore", ".*session.yaml: warning: has (lost keys|no seals)")
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        # a space and a letter that is not ASCII in the way to the tables
        self.folder = Path(self.temporary.name, "Renée Müller", "grip")

    def check_both(self, folder, *, alone=False, in_r=True):
        """Runs both scripts, and compares what they print; returns it. The one of Python may have a process of its own."""
        needs_statsmodels()
        script = folder / "analysis.py"
        python = fitted(run_alone(sys.executable, script) if alone else run_here(script))
        if not in_r:
            return python
        if not has_lme4():
            needs.skip("lme4 is not installed; it is in the Debian package r-cran-lme4")
        found = fitted(run_alone("Rscript", folder / "analysis.R"))
        self.assertEqual(list(python), list(found))
        for name, numbers in python.items():
            np.testing.assert_allclose(numbers, found[name], rtol=1e-3, atol=1e-3 * max(map(abs, numbers)), err_msg=str(name))
        return python

    def planted(self):
        """Tables with practice, and with first attempts that were repeated, both of which do not count."""
        table = simulated(1)
        again = table[table["trial_num"] % 7 == 0]
        wrong = as_trials(again, attempt=1, grip_N=again["grip_N"] + 100, outcome="not lifted")
        trials = as_trials(table, attempt=1 + (table["trial_num"] % 7 == 0))
        practice = as_trials(table[:20], kind="practice", block="practice", trial_num=np.arange(100, 120), grip_N=-50)
        return pd.concat([practice, wrong, trials]).sort_values(["id", "trial_num", "attempt"], kind="stable")

    def test_finds_what_was_planted(self):
        sessions(self.folder, {"trials": self.planted()})
        written = figures.write_analyses(figures.read(self.folder), self.folder / "figures")
        self.assertEqual([path.name for path in written], ["analysis.py", "analysis.R", "analysis-trials.csv"])
        found = self.check_both(self.folder / "figures", alone=True)
        self.assertEqual(found["grip_N", "n"], [20, 600])
        both = "surface: it's silk - sandpaper x mass_g, for each g"
        names = {"Intercept", "surface: it's silk - sandpaper", "mass_g, for each g", both}
        self.assertEqual({name for _, name in found} - {"n", "sd"}, names)
        estimate, low, high = found["grip_N", both]  # none was planted
        self.assertLess(abs(estimate), 2 * (high - low) / 1.96)
        for name, true in (("surface: it's silk - sandpaper", STEP), ("mass_g, for each g", SLOPE)):
            estimate, low, high = found["grip_N", name]
            self.assertLess(abs(estimate - true), 2 * (high - low) / 1.96)
        # without missing trials these are the differences of means in conditions, by least squares
        table = simulated(1)
        within = table.assign(silk=(table["surface"] != "sandpaper") * 1.0)[["id", "mass_g", "silk", "grip_N"]]
        within = within.set_index("id") - within.groupby("id").mean()
        slopes = np.linalg.lstsq(within[["mass_g", "silk"]].to_numpy(), within["grip_N"].to_numpy(), rcond=None)[0]
        np.testing.assert_allclose(found["grip_N", "mass_g, for each g"][0], slopes[0], rtol=1e-4)
        np.testing.assert_allclose(found["grip_N", "surface: it's silk - sandpaper"][0], slopes[1], rtol=1e-4)
        np.testing.assert_allclose(found["grip_N", "sd"], [2, 1.5], rtol=0.4)

    def test_finds_an_interaction_that_was_planted(self):
        table = simulated(4)
        table["grip_N"] += 0.01 * (table["mass_g"] - np.mean(MASSES)) * (table["surface"] != "sandpaper")
        sessions(self.folder, {"trials": as_trials(table)})
        figures.write_analyses(figures.read(self.folder), self.folder / "figures")
        estimate, low, high = self.check_both(self.folder / "figures")[
            "grip_N", "surface: it's silk - sandpaper x mass_g, for each g"
        ]
        self.assertLess(abs(estimate - 0.01), 2 * (high - low) / 1.96)
        self.assertGreater(low, 0)

    def test_an_interaction_that_trials_do_not_tell_is_not_fitted(self):
        table = simulated(1)
        table = table[(table["surface"] == "sandpaper") | (table["mass_g"] == 400)]
        sessions(self.folder, {"trials": as_trials(table)})
        figures.write_analyses(figures.read(self.folder), self.folder / "figures")
        script = (self.folder / "figures" / "analysis.py").read_text()
        self.assertIn('"grip_N": [("surface + mass_g", ["surface", "I(mass_g / 218)"], 1)],', script)

    def test_effects_that_vary_within_people_are_their_own(self):
        random = np.random.default_rng(5)
        table = simulated(5)
        slopes = dict(zip(table["id"].unique(), random.normal(0, 0.01, 20)))
        table["grip_N"] += table["id"].map(slopes) * (table["mass_g"] - np.mean(MASSES))
        table["group"] = np.where(table["id"].astype(int) % 2, "late", "early")
        sessions(self.folder, {"trials": as_trials(table)})
        figures.write_analyses(figures.read(self.folder), self.folder / "figures")
        script = self.folder / "figures" / "analysis.py"
        self.assertIn('("surface + group + mass_g", ["surface", "I(mass_g / 250)"], 2)', script.read_text())
        found = self.check_both(self.folder / "figures")
        # the standard error of a mean of twenty people's slopes
        low, high = found["grip_N", "mass_g, for each g"][1:]
        each = [np.polyfit(own["mass_g"], own["grip_N"], 1)[0] for _, own in table.groupby("id")]
        self.assertAlmostEqual((high - low) / (2 * 2.1009 * np.std(each, ddof=1) / np.sqrt(20)), 1, delta=0.03)

    def test_one_trial_of_each_level_tells_nothing_of_a_persons_own_effect(self):
        table = simulated(6, trials=2)
        table = table[table["mass_g"] == MASSES[0]]
        sessions(self.folder, {"trials": as_trials(table)})
        figures.write_analyses(figures.read(self.folder), self.folder / "figures")
        script = (self.folder / "figures" / "analysis.py").read_text()
        self.assertIn('"grip_N": [("surface", [], 1)]', script)
        self.check_says(["surface has the same effect in all people, since each person has few trials"])

    def check_says(self, expected):
        """Both scripts print each of these once, below the estimates; and nothing alike of other effects."""
        needs_statsmodels()
        texts = [run_here(self.folder / "figures" / "analysis.py")]
        if has_lme4():
            texts.append(run_alone("Rscript", self.folder / "figures" / "analysis.R"))
        for text in texts:
            said = re.findall(r"^In this model, (.*)\. If people differ in it, its interval is too narrow\.$", text, re.M)
            self.assertEqual(said, expected, text)
            self.assertTrue(text.endswith("narrow.\n"), text)

    def test_a_factor_that_few_people_meet_twice_has_one_effect(self):
        table = simulated(7)
        # half of the people and more meet one surface alone
        people = table["id"].astype(int)
        table = table[(people % 3 == 0) | ((table["surface"] == "sandpaper") == (people % 3 == 1))]
        sessions(self.folder, {"trials": as_trials(table)})
        figures.write_analyses(figures.read(self.folder), self.folder / "figures")
        script = (self.folder / "figures" / "analysis.py").read_text()
        self.assertIn('("surface + mass_g", ["I(mass_g / ', script)
        self.check_says(["surface has the same effect in all people, since few people meet several of its levels"])

    def test_lifts_and_missing_values(self):
        trials = self.planted().rename(columns={"grip_N": "reaction_s"})
        lifts = trials[["group", "id", "trial_num", "attempt"]].copy()
        lifts["static_grip_N"] = trials["reaction_s"] * 2
        lifts["safety_margin"] = np.nan
        lifts.loc[lifts["trial_num"] == 3, "static_grip_N"] = np.nan
        trials.loc[trials["surface"] == "sandpaper", "reaction_s"] = np.nan
        sessions(self.folder, {"trials": trials, "lifts": lifts})
        figures.write_analyses(figures.read(self.folder), self.folder / "figures")
        found = self.check_both(self.folder / "figures")
        self.assertEqual({measure for measure, _ in found}, {"reaction_s", "static_grip_N"})
        self.assertEqual(found["static_grip_N", "n"], [20, 580])
        # these trials have one surface: its effect is not in the model
        self.assertNotIn(("reaction_s", "surface: it's silk - sandpaper"), found)
        self.assertEqual(found["reaction_s", "n"], [20, 300])

    def test_late_compensation_by_group(self):
        random = np.random.default_rng(3)
        rows = []
        for person in range(12):
            group, own = ("given", "withheld")[person % 2], random.normal(0, 3)
            for number in range(40):
                kind, block = ("baseline", "before") if number < 10 else ("perturbed", "rotated")
                value = 0.0 if number < 10 else 20 + 5 * (person % 2)
                value = np.nan if number == 37 else value + own + random.normal(0, 2)
                kind = "catch" if number == 38 else kind
                rows.append((group, f"{person:02}", "", number + 1, block, kind, "deg", value))
        columns = ["group", "id", "round", "trial_num", "block", "kind", "unit", "compensation"]
        adaptation = pd.DataFrame(rows, columns=columns)
        perturbed = adaptation[(adaptation["kind"] == "perturbed")].dropna(subset=["compensation"])
        late = perturbed.groupby(["group", "id"])["compensation"]
        late = late.apply(lambda own: own[-8:].mean()).reset_index(name="late")
        fits = late.assign(round="", measure="angle", unit="deg")
        trials = as_trials(simulated(1, 12), group=np.repeat(["given", "withheld"] * 6, 30))
        trials = trials.drop(columns=["mass_g", "surface", "grip_N"])
        sessions(self.folder, {"trials": trials, "adaptation": adaptation, "fits": fits}, "blocks: []\n")
        figures.write_analyses(figures.read(self.folder), self.folder / "figures")
        found = self.check_both(self.folder / "figures")
        self.assertEqual(found["compensation", "n"], [12, 96])
        # as many trials of each person: the estimates are means over people
        means = late.groupby("group")["late"].mean()
        np.testing.assert_allclose(found["compensation", "Intercept"][0], means["given"], rtol=1e-4)
        difference = found["compensation", "group: withheld - given"]
        np.testing.assert_allclose(difference[0], means["withheld"] - means["given"], rtol=1e-4)

    def test_of_some_people(self):
        needs_statsmodels()
        sessions(self.folder, {"trials": self.planted()})
        some = figures.read(self.folder, people=["03", "04", "05"])
        figures.write_analyses(some, self.folder / "figures")
        found = self.check_both(self.folder / "figures", in_r=soak.EVERYTHING)
        self.assertEqual(found["grip_N", "n"], [3, 90])

    def test_nothing_for_one_person_nor_without_factors(self):
        one = as_trials(simulated(1, 1))
        none = as_trials(simulated(1, 3), mass_g=200, surface="silk")
        empty = as_trials(simulated(1, 3), grip_N=np.nan)
        for name, trials in (("one", one), ("none", none), ("empty", empty)):
            with self.subTest(name):
                folder = sessions(self.folder / name, {"trials": trials})
                self.assertEqual(figures.write_analyses(figures.read(folder), folder / "figures"), [])
                self.assertFalse((folder / "figures").exists())

    def test_a_script_that_was_changed_stays(self):
        data = figures.read(sessions(self.folder, {"trials": self.planted()}))
        script = figures.write_analyses(data, self.folder / "figures")[0]
        before = script.read_bytes()
        figures.write_analyses(data, self.folder / "figures")
        self.assertEqual(script.read_bytes(), before)
        script.write_text("# my own\n")
        with self.assertWarnsRegex(UserWarning, "analysis.py has been changed"):
            figures.write_analyses(data, self.folder / "figures")
        self.assertEqual(script.read_text(), "# my own\n")

    def test_can_be_read(self):
        figures.write_analyses(figures.read(sessions(self.folder, {"trials": self.planted()})), self.folder / "figures")
        for name in ("analysis.py", "analysis.R"):
            text = (self.folder / "figures" / name).read_text()
            lines = text.splitlines()
            self.assertTrue(20 <= len(lines) <= 64, len(lines))
            self.assertLessEqual(max(map(len, lines)), 130)
            self.assertNotIn("signific", text)
            self.assertNotIn("dihaptic", text)


@soak.alone
class Coverage(unittest.TestCase):
    """95 % intervals contain what was planted about as often as they say."""

    def test_of_rehearsed_people_who_differ_in_what_was_planted(self):
        """A hundred samples of 16 of 40 people: a mean in the interval in 93 to 97, within the error of a hundred (2.2)."""
        needs_statsmodels()
        if not has_lme4():
            needs.skip("lme4 is not installed; it is in the Debian package r-cran-lme4")
        random = np.random.default_rng(7)
        inside = {}
        with tempfile.TemporaryDirectory() as temporary:
            dihaptic.rehearse("experiments/fitts-law.yaml", 40, out=f"{temporary}/fitts", progress=False)
            folder = Path(temporary, "figures")
            figures.write_analyses(figures.read(f"{temporary}/fitts"), folder)
            table = pd.read_csv(folder / "analysis-trials.csv", dtype={"person": str})
            table = table[table["kind"] != "practice"]
            own = pd.Series(random.normal(0.002, 0.001, 40), table["person"].unique())
            table["movement_time_s"] += table["person"].map(own) * table["distance_mm"]
            everybody = dict(list(table.groupby("person")))
            measures = ["movement_time_s", "reaction_time_s", "peak_speed_m_s"]
            truth = {}
            for measure in measures:
                known = table.dropna(subset=[measure])
                last = known.drop_duplicates(["person", "session", "trial_num"], keep="last")
                for factor, other in (("distance_mm", "width_mm"), ("width_mm", "distance_mm")):
                    slopes = [np.linalg.lstsq(np.column_stack([np.ones(len(one)), one[factor], one[other]]), one[measure],
                                              rcond=None)[0][1] for _, one in last.groupby("person")]  # fmt: skip
                    truth[measure, f"{factor}, for each mm"] = np.mean(slopes)
            for run in range(100):
                drawn = random.choice(list(everybody), 16)
                sample = pd.concat([everybody[name].assign(person=f"p{n:02}") for n, name in enumerate(drawn)])
                sample.to_csv(folder / "analysis-trials.csv", index=False)
                found = fitted(run_alone("Rscript", folder / "analysis.R"))
                if run < 3:
                    for name, numbers in fitted(run_here(folder / "analysis.py")).items():
                        np.testing.assert_allclose(numbers, found[name], rtol=1e-3, atol=1e-3 * max(map(abs, numbers)))
                for name, true in truth.items():
                    _, low, high = found[name]
                    inside[name] = inside.get(name, 0) + (low <= true <= high)
        print(inside)
        self.assertEqual(set(inside), set(truth))
        for name, count in inside.items():
            self.assertTrue(90 <= count <= 100, (name, count))
        self.assertTrue(93 <= np.mean(list(inside.values())) <= 97, inside)

    def test_of_intervals(self):
        needs_statsmodels()
        inside, runs = {"surface: it's silk - sandpaper": 0, "mass_g, for each g": 0}, 60
        with tempfile.TemporaryDirectory() as temporary:
            folder = sessions(Path(temporary, "grip"), {"trials": as_trials(simulated(0))})
            figures.write_analyses(figures.read(folder), folder / "figures")
            for seed in range(100, 100 + runs):
                table = as_trials(simulated(seed)).rename(columns={"id": "person"}).assign(session="")
                table.to_csv(folder / "figures" / "analysis-trials.csv", index=False)
                found = fitted(run_here(folder / "figures" / "analysis.py"))
                for name, true in zip(inside, (STEP, SLOPE)):
                    _, low, high = found["grip_N", name]
                    inside[name] += low <= true <= high
        for name, count in inside.items():
            # of 60 intervals, 52 and more contain it in 99.5 % of all series
            self.assertGreaterEqual(count, 52, name)


if __name__ == "__main__":
    unittest.main()
