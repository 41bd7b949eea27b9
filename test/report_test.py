"""report.html as its reader meets it, in headless Chromium.

Usage: report_test.py PROGRAM, from the project's folder.
"""
import csv
import glob
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import needs
from patience import patient

PROGRAM = sys.argv.pop(1) if len(sys.argv) > 1 else "build/release/dihaptic"


def dihaptic(*arguments):
    result = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=patient(300))
    assert result.returncode == 0, result.stderr
    return result.stdout


def chromium(page, *arguments):
    """What the browser says of a page on standard output."""
    needs.for_this_test("chromium", "chromium")
    return subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=10000",
                           "--window-size=1100,3000", *arguments, pathlib.Path(page).resolve().as_uri()],
                          capture_output=True, text=True, timeout=300, check=True).stdout


class Reports(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.out = cls.folder.name + "/sessions"
        # all rounds and blocks of the shipped file, with 200 trials in place of 504
        text = pathlib.Path("experiments/visuomotor-rotation.yaml").read_text().replace("../", os.getcwd() + "/")
        for block, times in [("baseline, repeats: 2", 1), ("repeats: 8", 3), ("count: 6", 2), ("clamp, repeats: 2", 1),
                             ("washout, repeats: 3", 1)]:
            assert text.count(block) == 1, block
            text = text.replace(block, f"{block[:-1]}{times}")
        experiment = cls.folder.name + "/visuomotor-rotation.yaml"
        pathlib.Path(experiment).write_text(text)
        for person in ["S01", "S02"]:
            dihaptic("run", experiment, "--simulate", "--participant", person, "--out", cls.out)
        dihaptic("run", "experiments/lift-block.yaml", "--out", cls.out)
        cls.sessions = sorted(glob.glob(cls.out + "/*/"))

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def drawn(self, page, count):
        """Opens a page: every chart is drawn, on a canvas, and nothing went wrong."""
        text = pathlib.Path(page).read_text()
        self.assertEqual(text.count('<div class="chart" data-chart="{'), count, page)
        dom = chromium(page, "--dump-dom")
        self.assertEqual(len(re.findall(r'class="chart[^"]*drawn', dom)), count, page)
        self.assertNotIn("NaN", re.sub(r"<script>.*?</script>", "", dom, flags=re.S))
        return dom

    def test_a_session_has_its_curves_and_says_what_made_them(self):
        session = next(s for s in self.sessions if "S01" in s)
        self.assertIn("report.html, adaptation.csv, fits.csv, adaptation-blocks.csv: of 1 session", dihaptic("report", session))
        dom = self.drawn(session + "/report.html", 4)
        self.assertIn("Adaptation to visuomotor rotations about four axes", dom)
        self.assertIn("seed 1", dom)
        with open(session + "/trials.csv") as file:
            reaches = sum(1 for _ in csv.DictReader(file))
        paths = re.search(r"<svg.*?</svg>", dom[dom.index("<h2>Each reach"):], flags=re.S).group()
        self.assertEqual(paths.count('stroke-opacity="0.5"'), reaches)
        self.assertIn("each with 4 blocks: baseline (", dom)
        self.assertIn(dihaptic("--version").strip(), dom)
        with open(session + "/trials.csv") as file:
            trials = list(csv.DictReader(file))
        with open(session + "/adaptation.csv") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), len(trials))
        for trial, row in zip(trials, rows):
            self.assertEqual(float(row["compensation"]), -float(trial["hand_angle_deg"]))
        clamped = [row["error_seen"] for row in rows if row["kind"] == "visual_clamp"]
        self.assertEqual(set(clamped), {"no"})
        rotated = [float(r["perturbation"]) for r in rows if r["kind"] == "perturbed"]
        self.assertTrue(all(abs(f - 30) < 0.5 for f in rotated), rotated[:5])

    def test_a_lift_is_drawn_over_time(self):
        session = next(s for s in self.sessions if "lift-block" in s)
        dihaptic("report", session)
        dom = self.drawn(session + "/report.html", 4)  # forces and height over time, and from lift-off on
        # of all lifts' curves the legend names the means alone
        legends = re.findall(r'<div class="legend">(.*?)<figcaption', dom, flags=re.S)
        self.assertTrue(any("grip force" in legend for legend in legends))
        self.assertFalse(any("in trial" in legend for legend in legends))
        self.assertIn("No person took part.", dom[dom.index("<h2>In words"):])

    def test_people_are_averaged_and_damaged_sessions_left_out(self):
        bad = pathlib.Path(self.out, "bad")
        bad.mkdir()
        (bad / "session.yaml").write_text("state: running\n")
        (bad / "raw.log").write_text("")
        said = dihaptic("report", self.out)
        self.assertIn("left out: ", said)
        self.assertIn("of 3 sessions", said)
        self.drawn(self.out + "/report.html", 4)
        with open(self.out + "/population-adaptation.csv") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual({r["people"] for r in rows}, {"2"})
        self.assertEqual(len({r["round"] for r in rows}), 4)

    def test_a_rehearsal_is_reported_without_its_recordings(self):
        parent = tempfile.TemporaryDirectory()
        self.addCleanup(parent.cleanup)
        people = parent.name + "/people"
        dihaptic("rehearse", "experiments/rotation-reversal.yaml", "--people", "2", "--jobs", "2", "--out", people)
        self.assertIn("of 2 sessions", dihaptic("report", people))
        self.drawn(people + "/report.html", 1)
        self.assertIn("of 1 session", dihaptic("report", people + "/sim-001"))
        self.drawn(people + "/sim-001/report.html", 1)
        with open(people + "/population-adaptation.csv") as file:
            late = [float(r["mean"]) for r in csv.DictReader(file)][200:220]
        self.assertGreater(sum(late) / len(late), 15)

    def test_figures_are_drawn_if_they_are_asked_for(self):
        parent = tempfile.TemporaryDirectory()
        self.addCleanup(parent.cleanup)
        people = pathlib.Path(parent.name, "people with a blank")
        dihaptic("rehearse", "experiments/fitts-law.yaml", "--people", "2", "--jobs", "2", "--out", str(people))
        refused = subprocess.run([PROGRAM, "report", people, "--figures"], capture_output=True, text=True)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("has tables of 0 of 2 people. Type dihaptic collect", refused.stderr)
        dihaptic("collect", str(people))
        self.assertIn("measures-by-", dihaptic("report", str(people), "--figures"))
        for kind in ("svg", "pdf", "png", "csv", "py"):
            self.assertTrue(list((people / "figures").glob(f"measures-by-*.{kind}")), kind)

    def test_it_reads_on_paper(self):
        session = next(s for s in self.sessions if "lift-block" in s)
        dihaptic("report", session)
        paper = self.out + "/report.pdf"
        chromium(session + "/report.html", "--print-to-pdf=" + paper)
        self.assertTrue(pathlib.Path(paper).read_bytes().startswith(b"%PDF"))


if __name__ == "__main__":
    unittest.main()
