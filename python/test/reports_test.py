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
from drawn import rehearsed
from scipy import stats

import dihaptic as dh
from dihaptic import figures
from dihaptic.figures import saving
from dihaptic.reports import page as pages
from dihaptic.reports import write_page
from dihaptic.reports.page import Page, in_short
from dihaptic.reports.sections import shared_windows
from dihaptic.reports.text import in_words

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
        for heading in ("Quality of the data", "By condition", "In words"):
            self.assertIn(heading, found.text)
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
        once = pd.read_csv(self.fitts / "sim-001" / "trials.csv")
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
        methods, results = in_words(figures.read(self.fitts), {"who": "Simulated."})
        self.assertIn("The factor distance had 3 levels: 40, 80 and 160 mm.", " ".join(methods))
        self.assertRegex(" ".join(results), r"Movement time \(mean ± SD over people\): 0\.\d+ ± 0\.\d+ s \(40 mm\), .* \(160 mm\); n = 3 people")


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
        expected = {0.123456: "0.123", 12.3456: "12.3", 1234.56: "1235", 5.0: "5", 1e-9: "0", 2.5e-5: "2.50e-05", 1e7: "1.00e+07",
                    -0.98765: "-0.988", np.nan: "-", None: "-", True: "yes", "80 g": "80 g"}  # fmt: skip
        self.assertEqual({value: in_short(value) for value in expected}, expected)

    def test_a_page_of_nothing_has_no_empty_tables(self):
        page = Page("title", "", "")
        page.table(pd.DataFrame({"a": []}), "caption")
        self.assertTrue(page.is_empty)
        self.assertGreater(len(pages._asset("page.js")), 100)


if __name__ == "__main__":
    unittest.main()
