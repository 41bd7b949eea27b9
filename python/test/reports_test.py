"""Pages of reports: what is on them, for one person, several, several experiments, and in comparison."""

import base64
import json
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import unittest.mock
import warnings
import xml.etree.ElementTree as xml
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pandas as pd
from drawn import rehearsed, with_tables
from scipy import stats

import dihaptic as dh
from dihaptic import figures
from dihaptic.figures import saving
from dihaptic.reports import page as pages
from dihaptic.reports import sections, write_page
from dihaptic.reports.differences import difference
from dihaptic.reports.models import notes_on_models
from dihaptic.reports.page import Page, in_short
from dihaptic.reports.results import results_of, shared_windows, warnings_of, with_spreads
from dihaptic.reports.simulated import limits_of
from dihaptic.reports.text import methods_of, perturbations_table

#: Fewer reaches of fitts-law: its distances and widths once.
FITTS = [("practice, repeats: 1", "practice, repeats: 1"), ("repeats: 8", "repeats: 2")]


class Reader(HTMLParser):
    """What a browser would find: headings, texts, names, files that it would fetch."""

    def __init__(self, text):
        super().__init__()
        self.names, self.fetched, self.buttons, self.open, self.text = [], [], [], [], ""
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        own = dict(attrs)
        self.names += [own["id"]] if "id" in own else []
        self.fetched += [own[key] for key in ("src", "xlink:href") if key in own and not own[key].startswith("#")]
        self.fetched += [own["href"]] if tag == "link" else []
        if tag not in ("meta", "link", "br"):
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.handle_starttag(tag, attrs)
        self.open.pop()

    def handle_endtag(self, tag):
        assert self.open.pop() == tag, tag

    def handle_data(self, data):
        if self.open and self.open[-1] not in ("script", "style", "template"):
            self.text += data


class Reports(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        # PDF and PNG would take half of the time, and are not looked at here
        patch = unittest.mock.patch.object(saving, "FORMATS", ("svg",))
        patch.start()
        cls.addClassCleanup(patch.stop)
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.here = Path(cls.folder.name)
        cls.fitts = rehearsed("fitts-law", cls.here, 3, FITTS)
        cls.lift = dh.run("experiments/lift-block.yaml", out=cls.here / "lifts", progress=False).folder
        cls.page = write_page(cls.fitts).read_text()

    def read(self, page):
        """A page, whose elements are closed, whose names differ, and which fetches nothing."""
        found = Reader(page)
        self.assertEqual(found.open, [])
        self.assertEqual(len(found.names), len(set(found.names)))
        self.assertEqual(found.fetched, [])
        self.assertNotRegex(page, r"@import|url\(['\"]?http|sourceMappingURL")
        self.assertNotRegex(found.text, r"\bnan\b|NaN|None|inf\b")
        return found

    def test_it_has_each_figure_as_it_is_saved(self):
        found = self.read(self.page)
        names = re.findall(r'<figure class="\w+" data-name="([^"]+)"', self.page)
        self.assertEqual(sorted(names), sorted(file.stem for file in (self.fitts / "figures").glob("*.svg")))
        svgs = re.findall(r'<div class="drawing">(<svg.*?</svg>)', self.page, flags=re.S)
        self.assertEqual(len(svgs), len(names))
        for name, svg in zip(names, svgs):
            xml.fromstring(svg)  # as a browser saves it
            own = (self.fitts / "figures" / f"{name}.svg").read_text()
            self.assertEqual(re.findall(r">([^<]+)</text>", svg), re.findall(r">([^<]+)</text>", own))
            caption = (self.fitts / "figures" / "captions.txt").read_text()
            self.assertIn(name + ": ", caption)
        headings = re.findall(r"<h2[^>]*>([^<]+)</h2>", self.page)
        wanted = ["Result", "By condition", "Quality of the data", "Over trials", "Methods in words"]
        self.assertEqual([heading for heading in headings if heading in wanted], wanted)
        self.assertNotIn("Learning", headings)  # nobody learns here
        self.assertLess(found.text.index("Movement time (mean"), found.text.index("Measures by"))
        self.assertEqual(self.page.count("recorded by"), 1)  # where the numbers are from is said once

    def test_its_numbers_are_those_of_the_tables(self):
        trials = pd.concat([pd.read_csv(file) for file in sorted(self.fitts.glob("sim-*/trials.csv"))])
        trials = trials.drop_duplicates(["ppid", "trial_num"], keep="last")
        trials = trials[~trials.kind.isin(["practice", "catch"])]
        each = trials.groupby(["width_mm", "distance_mm", "ppid"]).movement_time_s.mean()
        for width in (8, 16, 32):
            row = re.search(rf"<tr><td>movement time \[s\]</td><td>{width} mm</td>(.*?)</tr>", self.page).group(1)
            cells = re.findall(r"<td[^>]*>([^<]*)</td>", row)
            for distance, cell in zip((40, 80, 160), cells):
                people = each[width, distance]
                half = stats.t.ppf(0.975, 2) * people.std() / np.sqrt(3)
                ends = f"({in_short(people.mean() - half)} to {in_short(people.mean() + half)})"
                self.assertEqual(cell, f"{in_short(people.mean())} {ends}")
            self.assertEqual(cells[3], "3")

    def test_what_the_program_tells_is_on_it(self):
        sample = {
            "who": "Who moved the hand.", "folders": [str(self.lift)], "not_measured": "the pull",
            "perturbations": {"columns": ["name", "in", "what"], "rows": [["heavy", "", "mass of 2 kg"]]},
            "contact": "all solved", "note": "coughed",
        }  # fmt: skip
        told = {"command": "dihaptic report x", "program": "dihaptic 9", "changed": ["trials.csv was changed"],
                "faults": ["3 ticks are missing"], "left_out": ["x: it is the same"], "samples": [sample]}  # fmt: skip
        text = self.read(write_page(self.lift, told=told).read_text()).text
        for words in ("Who moved the hand.", "the pull", "mass of 2 kg", "all solved", "coughed", "dihaptic 9 with: dihaptic report x",
                      "trials.csv was changed", "3 ticks are missing", "x: it is the same"):  # fmt: skip
            self.assertIn(words, text)

    def test_recorded_trials_can_be_looked_at(self):
        page = write_page(self.lift).read_text()
        data = json.loads(re.search(r'<script type="application/json">(.*?)</script>', page, flags=re.S).group(1))
        self.assertEqual([q["name"] for q in data["quantities"]][0], "grip and load force")
        session = dh.load(self.lift)
        (trial,) = data["trials"]
        load = np.frombuffer(base64.b64decode(trial["values"][0][1]), "<f4")
        np.testing.assert_allclose(load, session["load_force"][:: round(0.01 / session.tick)][: len(load)], rtol=1e-6, atol=1e-6)
        self.assertEqual(len(trial["values"]), len(data["quantities"]))

    def test_people_and_experiments_have_parts_of_their_own(self):
        both = self.here / "both"
        both.mkdir()
        shutil.copytree(self.fitts / "sim-001", both / "one")
        shutil.copytree(self.lift, both / "two")
        person = both / "three"
        shutil.copytree(self.fitts / "sim-002", person)
        info = (person / "session.yaml").read_text().replace("mover: simulated_person", "mover: devices")
        (person / "session.yaml").write_text(info)
        with self.assertRaisesRegex(dh.Error, "sessions of 3 samples.*experiment=.*moved by devices"):
            figures.read(both)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # session.yaml was changed
            page = write_page(both).read_text()
            data = figures.read(both, moved_by="devices")
        self.assertEqual(data.people, ["sim-002"])
        self.assertFalse(data.is_simulated)
        self.read(page)
        self.assertEqual(page.count('class="part"'), 3)
        self.assertEqual(len(list(both.glob("figures-*"))), 3)
        script = next(file for file in both.glob("figures-*device*/*.py"))
        self.assertIn("moved_by='devices'", script.read_text())
        subprocess.run([sys.executable, "-W", "ignore", script], check=True, timeout=300)

    def test_two_folders_are_compared_in_shared_axes(self):
        one, two = self.fitts / "sim-001", self.fitts / "sim-002"
        with self.assertRaisesRegex(dh.Error, "--out"):
            write_page([one, two])
        page = write_page([one, two], self.here / "compared").read_text()
        text = self.read(page).text
        self.assertIn("2 groups (sim-001, sim-002)", text)
        self.assertRegex(text, r"Movement time: .*; n = 2 people, 36 trials; averaged over width\.")
        points = pd.read_csv(next((self.here / "compared" / "figures").glob("measures-by-*.csv")))
        self.assertEqual(set(points["group"].dropna()), {"sim-001", "sim-002"})
        self.assertRegex(text, r"Differences between means, sim-002 minus sim-001 \(95 % interval\): movement time: .*no interval.*1 and 1")

    def test_two_groups_have_their_differences(self):
        for name, people in (("first", ["sim-001", "sim-002"]), ("third", ["sim-003"])):
            for person in people:
                shutil.copytree(self.fitts / person, self.here / name / person)
        trials = pd.concat([pd.read_csv(file) for file in sorted(self.fitts.glob("sim-*/trials.csv"))])
        trials = trials.drop_duplicates(["ppid", "trial_num"], keep="last")
        trials = trials[~trials.kind.isin(["practice", "catch"])]
        each = trials.groupby(["distance_mm", "ppid"]).movement_time_s.mean()
        text = self.read(write_page([self.here / "first", self.here / "third"], self.here / "of-two").read_text()).text
        self.assertIn("Differences between groups", text)
        page = (self.here / "of-two" / "report.html").read_text()
        self.assertIn("<summary>Differences of the other measures</summary>", page)
        for distance in (40, 80, 160):
            row = re.search(rf"<tr><td>movement time \[s\]</td><td>{distance} mm</td>(.*?)</tr>", page).group(1)
            mean = each[distance][["sim-001", "sim-002"]].mean()
            cells = [in_short(mean), in_short(each[distance]["sim-003"]), in_short(each[distance]["sim-003"] - mean), "2 and 1"]
            self.assertEqual(re.findall(r"<td[^>]*>([^<]*)</td>", row), cells)

    def test_a_difference_is_that_of_pairs_or_welchs(self):
        random = np.random.default_rng(3)
        a = pd.Series(random.normal(5, 2, 7), list("abcdefg"))
        b = pd.Series(random.normal(7, 4, 5), list("mnopq"))
        found = difference(a, b)
        statistic = stats.ttest_ind(b, a, equal_var=False).statistic
        self.assertAlmostEqual(found.value, b.mean() - a.mean(), 12)
        error = np.sqrt(a.var() / 7 + b.var() / 5)
        self.assertAlmostEqual(found.value / error, statistic, 10)
        at_the_end = stats.ttest_ind(b - found.low, a, equal_var=False).pvalue
        self.assertAlmostEqual(at_the_end, 0.05, 9)  # the ends are what a test at 5 % just does not reject
        self.assertAlmostEqual(stats.ttest_ind(b - found.high, a, equal_var=False).pvalue, 0.05, 9)
        again = pd.Series(random.normal(6, 1, 6), list("bcdefz"))
        paired = difference(a, again)
        self.assertEqual(paired.n, "5 pairs")
        pairs = list("bcdef")
        for end in (paired.low, paired.high):
            self.assertAlmostEqual(stats.ttest_rel(again[pairs] - end, a[pairs]).pvalue, 0.05, 9)
        alone = difference(a[:1], b)
        self.assertTrue(np.isnan(alone.low) and np.isnan(alone.high))
        same = difference(pd.Series([1.0, 1.0], list("ab")), pd.Series([2.0, 2.0], list("cd")))
        self.assertEqual((same.low, same.high), (1, 1))

    def test_experiments_of_several_folders_are_never_mixed(self):
        for name, parts in (("a", ["sim-001", "sim-002"]), ("b", ["sim-003"])):
            for part in parts:
                shutil.copytree(self.fitts / part, self.here / "mixed" / name / part)
            shutil.copytree(self.lift, self.here / "mixed" / name / "lift")
        paths = [self.here / "mixed" / name for name in ("a", "b")]
        with self.assertRaisesRegex(dh.Error, "samples"):
            figures.read(paths)
        page = write_page(paths, self.here / "of-both").read_text()
        self.assertEqual(page.count('class="part"'), 2)
        trials = figures.read(paths, experiment="Fitts's law").table("trials")
        self.assertEqual(trials.groupby("group").person.nunique().to_dict(), {"a": 2, "b": 1})
        with self.assertRaisesRegex(dh.Error, "Name each session once"):
            figures.read([paths[0], paths[0] / "lift"])

    def test_sessions_of_one_name_in_several_folders_are_told_apart(self):
        for day in ("day1", "day2"):
            shutil.copytree(self.fitts / "sim-001", self.here / "days" / day / "S01")
        data = figures.read(self.here / "days")
        self.assertEqual(data.people, ["sim-001"])
        self.assertEqual(sorted(data.table("trials").session.unique()), ["day1/S01", "day2/S01"])
        points = figures.means_by_condition(data, measures=["movement_time_s"], x="distance_mm")
        once = pd.read_csv(self.fitts / "sim-001" / "trials.csv").drop_duplicates("trial_num")  # without repetitions
        self.assertEqual(points[points.of == "person"].shape[0], 2 * (~once.kind.isin(["practice"])).sum())

    def test_a_figure_that_was_changed_is_on_the_page(self):
        folder = self.here / "changed"
        shutil.copytree(self.lift, folder)
        write_page(folder)
        script = folder / "figures" / "grip-against-load.py"
        script.write_text(script.read_text().replace("figures.save(", "figure.axes[0].set_xlabel('my own words')\nfigures.save("))
        subprocess.run([sys.executable, script], check=True, timeout=300)
        with self.assertWarnsRegex(UserWarning, "has been changed"):
            page = write_page(folder).read_text()
        self.assertIn("my own words", page)
        self.assertIn("as you have changed it", page)

    def test_sessions_that_do_not_count_are_told(self):
        folder = self.here / "some"
        for name in ("sim-001", "sim-002", "sim-003"):
            shutil.copytree(self.fitts / name, folder / name)
        file = folder / "sim-003" / "session.yaml"
        file.write_text(file.read_text().replace("state: complete", "state: interrupted"))
        (folder / "bad").mkdir()
        (folder / "bad" / "session.yaml").write_text("state: running\n")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            data = figures.read(folder)
        self.assertEqual(data.people, ["sim-001", "sim-002"])
        self.assertEqual(len(data.left_out), 2)
        self.assertRegex("; ".join(data.left_out), "ended before its trials were done")

    def test_simulated_people_of_one_name_and_several_seeds_are_several(self):
        folder = self.here / "seeds"
        for seed in (1, 2):
            shutil.copytree(self.fitts / "sim-001", folder / str(seed))
            file = folder / str(seed) / "session.yaml"
            text = file.read_text()
            file.write_text(text[: text.index("moved_by:")] + text[text.index("moved_by:") :].replace("seed: 1", f"seed: {seed}", 1))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            self.assertEqual(figures.read(folder).people, ["1/sim-001", "2/sim-001"])

    def test_words_are_those_of_a_paper(self):
        data = figures.read(self.fitts)
        methods, results = methods_of(data, {"who": "Simulated."}), results_of(data)
        self.assertIn("The factor distance had 3 levels: 40, 80 and 160 mm.", " ".join(methods))
        wanted = r"Movement time \(mean ± SD over people\): 0\.\d+ ± 0\.\d+ s \(40 mm\), .* \(160 mm\); n = 3 people"
        self.assertRegex(" ".join(results), wanted)
        self.assertRegex(results[0], r"^Movement time against the index of difficulty \(ID\): .* bit/s\.$")
        for text in results[1:4]:  # with as many decimals everywhere
            self.assertEqual(len({len(decimals) for decimals in re.findall(r"\d\.(\d+)", text)}), 1, text)

    def test_perturbations_have_a_sentence_each_up_to_six(self):
        data = figures.read(self.fitts)
        trials = data.table("trials").assign(perturbation="a + b")
        data = with_tables(self.fitts, trials=trials)
        rows = [["a", "", "curl field of 13 N*s/m"], *([f"b{i}", "", "mass of 1 kg"] for i in range(7))]
        text = methods_of(data, {"perturbations": {"columns": ["name", "in", "what"], "rows": rows}})[-1]
        self.assertTrue(text.startswith("Perturbation a (blocks practice and reaches): curl field of 13 N\u00a0s/m."), text)
        self.assertEqual(text.count("Perturbation "), 6)
        self.assertTrue(text.endswith("The table has 2 further ones."), text)

    def test_a_density_is_a_mass_in_grams(self):
        folder = self.here / "dense"
        shutil.copytree(self.lift, folder)
        body = "body: { body: block, density_scale: 4 }"
        task = f"perturbations: [{{ name: heavy, {body} }}, {{ name: same, body: {{ body: block }} }}]\n"
        (folder / "task.yaml").write_text(task)
        told = {"perturbations": {"columns": ["perturbation", "in", "what"], "rows": [["heavy", "", "4 times the density"],
                                  ["same", "", "turned by 30 deg"], ["heavy", "b", "none"]]}}  # fmt: skip
        scene = (folder / "scene.yaml").read_text()
        mass = 1000 * float(re.search(r"name: block.*?mass_kg: ([\d.]+)", scene, flags=re.S).group(1))
        table = perturbations_table(figures.read(folder), told)
        self.assertEqual(list(table["what"]), [f"4 times the density; block of {4 * mass:g} g", "turned by 30°", "none"])

    def test_each_factor_has_its_sentence(self):
        text = " ".join(results_of(figures.read(self.fitts)))
        for over in ("width", "distance"):
            self.assertRegex(text, rf"Movement time \(mean[^.]*: [^;]*; n = [^;]*; averaged over {over}\.")

    def test_each_condition_has_its_own_n(self):
        trials = figures.read(self.fitts).table("trials")
        one = trials["person"] == trials["person"].iloc[0]
        trials.loc[one & (trials["distance_mm"] == trials["distance_mm"].min()), "movement_time_s"] = np.nan
        data = with_tables(self.fitts, trials=trials)
        table, counts = sections._by_condition(data, ["movement_time_s", "peak_speed_m_s"], "trials")
        self.assertEqual(sorted(set(counts)), [2, 3])
        page = Page("", "", "")
        sections._measures(page, data)
        self.assertIn("<td>2, 3, 3</td>", page.html())
        self.assertEqual(table.groupby("measure")["n"].unique().map(list).to_dict(), {
            "movement time [s]": ["2, 3, 3"], "peak speed [m/s]": [3],
        })  # fmt: skip

    def test_shares_of_answers_are_a_result(self):
        trials = figures.read(self.fitts).table("trials")
        trials["outcome"] = np.where(trials["distance_mm"] > 80, "longer", np.where(trials["trial_num"] % 2, "longer", "shorter"))
        trials = trials.assign(width_mm=8)
        text = " ".join(results_of(with_tables(self.fitts, trials=trials)))
        wanted = r'Share of "\w+" \(mean ± SD over people\): .* \(40 mm\), .* and [01]\.\d+ \(160 mm\); n = 3 people'
        self.assertRegex(text, wanted)

    def test_decimals_are_alike_in_all_rounds(self):
        fits = pd.DataFrame({"person": ["a", "b"] * 2, "group": "", "round": ["one", "one", "two", "two"], "unit": "deg",
                             "measure": "angle", "early": [1.0, 1.5, 10, 30], "late": [2.0, 2.25, 20, 50]})  # fmt: skip
        data = figures.read(self.fitts)
        data.__dict__.setdefault("_cache", {})["fits"] = fits
        data.__dict__["tables"] = [*data.tables, "fits"]
        numbers = re.findall(r"\d+(?:\.(\d+))?(?= ±|°)", results_of(data)[0])
        self.assertEqual(len(numbers), 8)
        self.assertEqual(len({len(decimals) for decimals in numbers}), 1, results_of(data)[0])

    def test_a_factor_that_goes_with_another_one_is_not_averaged_over(self):
        trials = figures.read(self.fitts).table("trials")
        trials["width_mm"] = trials["distance_mm"] / 5
        self.assertNotIn("averaged over", " ".join(results_of(with_tables(self.fitts, trials=trials))))

    def test_what_the_experiment_set_is_no_result(self):
        trials = figures.read(self.fitts).table("trials")
        trials["reaction_time_s"] = trials["distance_mm"] / 100
        data = with_tables(self.fitts, trials=trials)
        self.assertEqual(data.stimuli, ["reaction_time_s"])
        self.assertNotIn("Reaction time", " ".join(results_of(data)))
        self.assertIn("Reaction time was set by the experiment.", methods_of(data, {}))

    def test_captions_promise_only_intervals_that_are_drawn(self):
        page = write_page([self.fitts / "sim-001", self.fitts / "sim-002"], self.here / "of-one-each")
        captions = (page.parent / "figures" / "captions.txt").read_text()
        for line in captions.splitlines():
            self.assertNotIn("95 %", line)
        self.assertGreater(captions.count("of one value each, so there is no interval"), 1)
        self.assertNotIn("with 95 % intervals", self.read(page.read_text()).text)

    def test_a_value_that_was_never_asked_for_is_not_missing(self):
        trials = figures.read(self.fitts).table("trials")
        trials.loc[trials.distance_mm == 40, "peak_speed_m_s"] = np.nan
        trials["not_measured"] = np.where(trials.distance_mm == 40, "peak_speed: no channel", "")
        for row, reason in ((-1, "peak_speed: 3 % of the way"), (-2, "peak_speed: 4 % of the way")):
            trials.loc[trials.index[row], "not_measured"] = reason
            trials.loc[trials.index[row], "peak_speed_m_s"] = np.nan
        page = Page("", "", "")
        sections._measures(page, with_tables(self.fitts, trials=trials))
        self.assertNotIn("no channel", page.html())
        self.assertIn("... % of the way (2)", page.html())

    def test_medians_of_lifts_are_called_so(self):
        page = Page("", "", "")
        sections._lifts(page, figures.read(self.lift))
        self.assertIn("<th>median of</th>", page.html())

    def test_warnings_stand_with_the_result(self):
        data = figures.read(self.fitts)
        self.assertEqual(warnings_of(data, {}), [])
        trials = data.table("trials")
        again = trials[trials.block == "reaches"].assign(attempt=2)
        data = with_tables(self.fitts, trials=pd.concat([trials, again], ignore_index=True))
        data.sessions[0].info["convergence"] = {"missed": 7}
        data.laboratories = {"sim-001": 1, "sim-002": 2, "sim-003": 2}
        texts = warnings_of(data, {"not_measured": "the pull"})
        for words in ("the pull", "In 7 ticks", " %) were repeated", "come from 2 laboratories"):
            self.assertTrue(any(words in text for text in texts), (words, texts))


class Simulated(unittest.TestCase):
    """What simulated people cannot do is said with the result."""

    def test_what_the_program_noted_in_their_sessions(self):
        rest = "Rehearse the order and timing of trials with simulated people, but do not treat their figures as human data."
        rating = "is a rating, for which there is no model: the answers of simulated people are arbitrary"
        asks = "asks about mass_g: simulated people judge only lengths, and their answers and threshold are arbitrary"
        pushes = "pushes with a motor: simulated people do not judge forces, and measures of it are arbitrary"
        cases = (("noticed", rating), ("from above", asks), ("target", pushes))
        notes = [f"a.yaml:5: warning: {name}: {what}. {rest}" for name, what in cases]
        notes += [f"b: c.yaml:7: warning: tlx: {rating}. {rest}", "in 7 of 90 ticks the solver missed"]
        for mover, wanted in (
            ("simulated_person", [f"noticed, tlx: {rating}.", f"from above: {asks}.", f"target: {pushes}."]),
            ("devices", []),
        ):
            data = unittest.mock.Mock(sample=figures.Sample("", mover, ""), tasks=[{}])
            data.sessions = [unittest.mock.Mock(info={"notes": notes}), unittest.mock.Mock(info={})]
            self.assertEqual(limits_of(data), wanted)


class Models(unittest.TestCase):
    class Told:
        """Data with two tables."""

        def __init__(self, fits, adaptation):
            self.tables = {"fits": fits, "adaptation": adaptation}

        def has(self, name):
            return name in self.tables

        def table(self, name):
            return self.tables[name]

    def notes(self, curves=1.0, **parameters):
        people = ["S01", "S02", "S03", "S04"]
        good = {"A_slow": 0.99, "B_slow": 0.02, "A_fast": 0.6, "B_fast": 0.2, "A": 0.9, "B": 0.1}
        fits = pd.DataFrame({"person": people, **{k: [v] * 4 for k, v in good.items()}, **parameters})
        values = np.tile([0.0, 1, 2, 3], 4)
        adaptation = pd.DataFrame({"person": np.repeat(people, 4), "session": "s", "round": np.nan, "compensation": values})
        adaptation["two_rate"] = adaptation["single_rate"] = 1.5 + curves * (values - 1.5)
        return notes_on_models(self.Told(fits, adaptation))

    def test_good_ones_are_not_spoken_of(self):
        self.assertEqual(self.notes(), "")

    def test_parameters_at_their_bounds_are_counted(self):
        self.assertIn("in 3 of 4 people fast learning lies at its bound 1", self.notes(B_fast=[1, 1, 0.5, 1]))
        self.assertIn("in 1 of 4 people slow retention lies at its bound 1", self.notes(A_slow=[0.99, 0.99, 1, 0.99]))
        self.assertIn("in 4 of 4 people single-rate learning lies at its bound 0", self.notes(B=0))

    def test_two_processes_that_are_one_are_counted(self):
        self.assertIn("in 2 of 4 people slow and fast retention are equal", self.notes(A_fast=[0.99, 0.5, 0.999, 0.6]))

    def test_curves_that_explain_little_are_counted(self):
        self.assertIn("in 4 of 4 people the two-rate model fits no better than a constant", self.notes(0.0))
        self.assertIn("in 4 of 4 people the two-rate model explains less than 20 %", self.notes(0.05))


class Windows(unittest.TestCase):
    def test_that_share_trials_are_told(self):
        def table(channels):
            kinds = ["baseline"] * 4 + ["perturbed", "force_channel"] * channels
            values = [np.nan if kind == "perturbed" else 1.0 for kind in kinds]
            blocks = ["before"] * 4 + ["field"] * (2 * channels)
            return pd.DataFrame({"person": "S01", "group": "", "session": "s", "round": np.nan, "block": blocks, "kind": kinds,
                                 "compensation": values})  # fmt: skip

        self.assertIn("fewer than 16 measured trials (field: 10)", shared_windows(table(10)))
        self.assertEqual(shared_windows(table(16)), "")
        self.assertEqual(shared_windows(table(10).assign(kind="baseline")), "")


class Pages(unittest.TestCase):
    def test_any_text_is_shown_as_it_is(self):
        page = Page("</title><script>alert(1)</script>", 'a < b & "c"', "\ud800")
        page.heading("<h>")
        page.text("</p>")
        page.facts({"</td>": "<b>", "none": ""})
        page.table(pd.DataFrame({"<a>": ["</td>"], "x": [np.nan]}), "</table>", folded="</details>")
        page.figure('<?xml?><svg width="400pt"><g id="a"/><use xlink:href="#a"/></svg>', "<t>", "</c>", 'figures/"', "a,b\n<,&\n")
        page.viewer({"trials": [{"name": "</script>"}]})
        text = page.html()
        self.assertEqual(Reader(text.encode(errors="replace").decode()).open, [])
        self.assertNotIn("<script>alert", text)
        self.assertEqual(text.count("</script>"), 2)
        self.assertNotIn("<th>none</th>", text)
        self.assertIn('xlink:href="#figures--a"', text)

    def test_numbers_have_three_digits(self):
        expected = {0.123456: "0.123", 12.3456: "12.3", 1234.56: "1235", 5.0: "5", 1e-9: "0", 2.5e-5: "2.50e\N{MINUS SIGN}05",
                    1e7: "1.00e+07", -0.98765: "\N{MINUS SIGN}0.988", np.nan: "-", None: "-", True: "yes", "80 g": "80 g"}  # fmt: skip
        self.assertEqual({value: in_short(value) for value in expected}, expected)

    def test_decimals_are_alike_in_a_sentence(self):
        means, spreads = pd.Series([0.1857, 0.3651, 0.7304]), pd.Series([0.0252, 0.0498, 0.1101])
        self.assertEqual(with_spreads(means, spreads), ["0.186 ± 0.025", "0.365 ± 0.050", "0.730 ± 0.110"])
        self.assertEqual(with_spreads(pd.Series([1, 1.5, 2]), pd.Series([0, 0, 0])), ["1.00", "1.50", "2.00"])
        self.assertEqual(with_spreads(pd.Series([-0.001]), pd.Series([1.0])), ["0.0 ± 1.0"])
        self.assertEqual(with_spreads(pd.Series([0.234235, 0.276]), pd.Series([1e-9, np.nan])), ["0.234", "0.276"])

    def test_a_table_that_is_too_wide_for_paper_is_in_pieces(self):
        page = Page("", "", "")
        page.table(pd.DataFrame([["a", *range(16)]], columns=["of", *(f"c{i}" for i in range(16))]), keys=1)
        heads = [re.findall(r"<th[^>]*>([^<]+)</th>", piece) for piece in page.html().split("<table")[1:]]
        self.assertEqual([len(head) for head in heads], [8, 8, 3])
        self.assertEqual([head[0] for head in heads], ["of"] * 3)
        self.assertEqual([name for head in heads for name in head[1:]], [f"c{i}" for i in range(16)])

    def test_a_page_of_nothing_has_no_empty_tables(self):
        page = Page("title", "", "")
        page.table(pd.DataFrame({"a": []}), "caption")
        self.assertTrue(page.is_empty)
        self.assertGreater(len(pages._asset("page.js")), 100)


if __name__ == "__main__":
    unittest.main()
