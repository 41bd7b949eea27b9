"""report.html as its reader meets it, in headless Chromium.

Usage: report_test.py PROGRAM, from the project's folder.
"""
import contextlib
import csv
import glob
import itertools
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

import needs
import soak
from patience import patient

PROGRAM = sys.argv.pop(1) if len(sys.argv) > 1 else "build/release/dihaptic"


def dihaptic(*arguments):
    result = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=patient(300))
    assert result.returncode == 0, result.stderr
    return result.stdout


def chromium(page, *arguments):
    """What the browser prints about a page on standard output."""
    needs.for_this_test("chromium", "chromium")
    return subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=10000",
                           "--window-size=1100,3000", *arguments, pathlib.Path(page).resolve().as_uri()],
                          capture_output=True, text=True, timeout=300, check=True).stdout


class Pages(unittest.TestCase):
    """Tests that look at pages; their files are in the folder `out`."""

    out = ""

    def drawn(self, page):
        """Opens a page in a browser: it draws its figures, and nothing goes wrong. Returns the page as rendered."""
        text = pathlib.Path(page).read_text()
        # writes errors of scripts into the page
        probe = "<script>window.onerror = (why) => { document.documentElement.dataset.wrong = why; };</script>"
        with tempfile.NamedTemporaryFile("w", suffix=".html") as copy:
            copy.write(text.replace("<head>", "<head>" + probe))
            copy.flush()
            dom = chromium(copy.name, "--dump-dom")
        self.assertNotIn("data-wrong", dom)
        self.assertEqual(dom.count("<figure"), text.count("<figure"))
        self.assertGreater(dom.count("<figure"), 0)
        return dom

    def on_paper(self, page, paper="a4"):
        """Prints a page: no word leaves its sheet, or lies on another one."""
        needs.for_this_test("pdftotext", "poppler-utils")
        printed = pathlib.Path(self.out, "report.pdf")
        with tempfile.NamedTemporaryFile("w", suffix=".html") as copy:
            copy.write(pathlib.Path(page).read_text().replace("@page {", f"@page {{ size: {paper};"))
            copy.flush()
            chromium(copy.name, "--print-to-pdf=" + str(printed), "--no-pdf-header-footer")
        boxes = subprocess.run(["pdftotext", "-bbox", printed, "-"], capture_output=True, text=True, check=True).stdout
        sheets = re.findall(r'<page width="([\d.]+)" height="([\d.]+)">(.*?)</page>', boxes, flags=re.S)
        self.assertGreater(len(sheets), 0)
        for width, height, words in sheets:
            found = re.findall(r'<word xMin="([-\d.]+)" yMin="([-\d.]+)" xMax="([-\d.]+)" yMax="([-\d.]+)">(.*?)</word>', words)
            found = [(*map(float, box[:4]), box[4]) for box in found]
            for x0, y0, x1, y1, word in found:
                self.assertTrue(x0 > 0 and y0 > 0 and x1 < float(width) and y1 < float(height), (page, word))
            for one, other in itertools.combinations(found, 2):
                wide = min(one[2], other[2]) - max(one[0], other[0])
                high = min(one[3], other[3]) - max(one[1], other[1])
                # lines of small type have boxes that are higher than their letters
                self.assertFalse(wide > 1.5 and high > 3.5, (page, one, other))
        if paper == "a4":
            self.assertGreater(min(self.filled(printed)[:-1], default=1), 0.5, page)

    def filled(self, printed):
        """How much of each sheet's height there is something on, from 0 to 1."""
        subprocess.run(["pdftoppm", "-r", "20", "-gray", printed, printed.with_suffix("")], check=True, timeout=patient(60))
        shares = []
        for sheet in sorted(printed.parent.glob("report-*.pgm")):
            _, size, _, pixels = sheet.read_bytes().split(b"\n", 3)
            width, height = map(int, size.split())
            rows = [row for row in range(height) if min(pixels[row * width:(row + 1) * width]) < 200]
            margin = height * 14 / 297
            shares.append((max(rows, default=0) - margin) / (height - 2 * margin))
            sheet.unlink()
        return shares


class Reports(Pages):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.out = cls.folder.name + "/sessions"
        # all blocks of the shipped file, and all rounds or two of them, with 50 trials in each instead of 126
        text = pathlib.Path("experiments/visuomotor-rotation.yaml").read_text().replace("../", os.getcwd() + "/")
        for block, times in [("baseline, repeats: 2", 1), ("repeats: 8", 3), ("count: 6", 2), ("clamp, repeats: 2", 1),
                             ("washout, repeats: 3", 1)]:
            assert text.count(block) == 1, block
            text = text.replace(block, f"{block[:-1]}{times}")
        cls.rounds = soak.of(2, 4)
        if cls.rounds == 2:
            text = text[:text.index("    - name: about y")] + text[text.index("    - name: oblique"):]
        experiment = cls.folder.name + "/visuomotor-rotation.yaml"
        pathlib.Path(experiment).write_text(text)
        for person in ["S01", "S02"]:
            dihaptic("run", experiment, "--simulate", "--participant", person, "--out", cls.out)
        dihaptic("run", "experiments/lift-block.yaml", "--out", cls.out)
        cls.sessions = sorted(glob.glob(cls.out + "/*/"))

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_a_session_has_its_tables_and_says_what_made_them(self):
        session = next(s for s in self.sessions if "S01" in s)
        self.assertIn("report.html, adaptation.csv, fits.csv, adaptation-blocks.csv: of 1 session", dihaptic("report", session))
        dom = self.drawn(session + "/report.html")
        self.assertIn("Adaptation to visuomotor rotations about four axes", dom)
        self.assertIn("seed 1", dom)
        for name in ("learning-curve", "learning-windows", "outcomes"):
            self.assertIn(f'data-name="{name}"', dom)
        with open(session + "/trials.csv") as file:
            trials = list(csv.DictReader(file))
        self.assertIn("each with 4 blocks: baseline (", dom)
        self.assertIn(dihaptic("--version").strip(), dom)
        with open(session + "/adaptation.csv") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), len(trials))
        for trial, row in zip(trials, rows):
            self.assertEqual(float(row["compensation"]), -float(trial["hand_angle_deg"]))
        clamped = [row["error_seen"] for row in rows if row["kind"] == "visual_clamp"]
        self.assertEqual(set(clamped), {"no"})
        rotated = [float(r["perturbation"]) for r in rows if r["kind"] == "perturbed"]
        self.assertTrue(all(abs(f - 30) < 0.5 for f in rotated), rotated[:5])
        self.on_paper(session + "/report.html")

    def test_a_lift_is_drawn_over_time(self):
        session = next(s for s in self.sessions if "lift-block" in s)
        dihaptic("report", session)
        dom = self.drawn(session + "/report.html")
        for name in ("lift-curves", "grip-against-load"):
            self.assertIn(f'data-name="{name}"', dom)
        # the recorded trial is shown, with a strip for each quantity
        viewer = dom[dom.index('class="viewer"'):]
        self.assertEqual(viewer.count("<canvas"), 4)
        self.assertIn("No person took part.", dom[dom.index("Methods in words</h2>"):])
        for paper in soak.of(["a4"], ["a4", "letter"]):
            self.on_paper(session + "/report.html", paper)

    def test_people_are_averaged_and_damaged_sessions_left_out(self):
        bad = pathlib.Path(self.out, "bad")
        bad.mkdir()
        (bad / "session.yaml").write_text("state: running\n")
        (bad / "raw.log").write_text("")
        said = dihaptic("report", self.out)
        self.assertIn("left out: ", said)
        self.assertIn("of 3 sessions", said)
        dom = self.drawn(self.out + "/report.html")
        self.assertEqual(dom.count('class="part"'), 2)  # the two experiments
        with open(self.out + "/population-adaptation.csv") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual({r["people"] for r in rows}, {"2"})
        self.assertEqual(len({r["round"] for r in rows}), self.rounds)

    @soak.alone
    def test_a_rehearsal_is_reported_without_its_recordings(self):
        parent = tempfile.TemporaryDirectory()
        self.addCleanup(parent.cleanup)
        people = parent.name + "/people with a blank"
        dihaptic("rehearse", "experiments/rotation-reversal.yaml", "--people", "2", "--jobs", "2", "--out", people)
        self.assertIn("of 2 sessions", dihaptic("report", people))
        self.drawn(people + "/report.html")
        with open(people + "/population-adaptation.csv") as file:
            late = [float(r["mean"]) for r in csv.DictReader(file)][200:220]
        self.assertGreater(sum(late) / len(late), 15)
        for kind in ("svg", "pdf", "png", "csv", "py"):
            self.assertTrue(pathlib.Path(people, "figures", f"learning-curve.{kind}").is_file(), kind)
        # only the tables of two compared sessions: a page of both would need a folder
        said = dihaptic("report", people + "/sim-001", people + "/sim-002", "--tables")
        self.assertNotIn("report.html", said)
        self.assertIn("of 2 sessions", said)
        refused = subprocess.run([PROGRAM, "report", people + "/sim-001", people + "/sim-002"], capture_output=True, text=True)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("--out", refused.stderr)
        said = dihaptic("report", people + "/sim-001", people + "/sim-002", "--out", parent.name + "/both")
        self.assertIn("/both/report.html; in the folder of each path adaptation.csv, ", said)
        self.assertIn("2 groups (sim-001, sim-002)", self.drawn(parent.name + "/both/report.html"))

    def test_killed_it_leaves_nothing_that_draws(self):
        session = next(s for s in self.sessions if "S02" in s)
        shutil.rmtree(session + "/figures", ignore_errors=True)
        process = subprocess.Popen([PROGRAM, "report", session], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        end = time.monotonic() + patient(60)
        while not glob.glob(session + "/figures/*.svg") and time.monotonic() < end:  # the first figure is saved
            time.sleep(0.01)
        drawing = self.descendants(process.pid)
        self.assertGreater(len(drawing), 1)
        process.kill()
        process.wait()
        end = time.monotonic() + patient(10)
        while any(map(self.is_running, drawing)) and time.monotonic() < end:
            time.sleep(0.05)
        self.assertEqual([pid for pid in drawing if self.is_running(pid)], [])

    def descendants(self, process):
        children = []
        for task in glob.glob(f"/proc/{process}/task/*/children"):
            with contextlib.suppress(OSError):
                children += map(int, pathlib.Path(task).read_text().split())
        return [*children, *(other for child in children for other in self.descendants(child))]

    def is_running(self, process):
        try:
            return pathlib.Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
        except OSError:
            return False

    def test_without_the_python_package_it_says_so(self):
        session = next(s for s in self.sessions if "lift-block" in s)
        with tempfile.TemporaryDirectory() as alone:
            program = shutil.copy(PROGRAM, alone)
            refused = subprocess.run([program, "report", session], capture_output=True, text=True)
            if refused.returncode == 0:
                self.skipTest("an installed package drew it")
            self.assertEqual(refused.returncode, 2)
            self.assertIn("python3-dihaptic", refused.stderr)
            subprocess.run([program, "report", session, "--tables"], check=True, capture_output=True)


#: Reports that are printed in the soak.
PRINTED = ["bimanual-bar", "cue-integration", "fitts-law", "fragile-object", "grip-and-lift", "reward-learning",
           "spontaneous-recovery", "force-matching", "unexpected-weight", "visuomotor-rotation"]


@soak.alone
class Printed(Pages):
    """Reports of people of shipped experiments, on paper."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.out = cls.folder.name

    def test_nothing_is_cut_or_lies_on_something_else(self):
        for name in PRINTED:
            people = f"{self.out}/{name}"
            dihaptic("rehearse", f"experiments/{name}.yaml", "--people", "4", "--jobs", "2", "--out", people)
            for path in (people, people + "/sim-001"):
                dihaptic("report", path)
                with self.subTest(path):
                    self.drawn(path + "/report.html")
                    for paper in ("a4", "letter"):
                        self.on_paper(path + "/report.html", paper)


if __name__ == "__main__":
    unittest.main()
