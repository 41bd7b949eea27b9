"""Tables as trackers, spreadsheets and statistics programs of any country write them. docs/outside.md has the sources.

Usage: outside/tables_test.py PROGRAM, from the project's folder.
"""
import csv
import io
import os
import pathlib
import sys
import tempfile
import unittest

import numpy as np

sys.path.append("test/cli")
from program import PROGRAM, dihaptic, session_of
import soak  # program.py adds its folder to the path

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(PROGRAM)), "python"))
import dihaptic as dh  # noqa: E402

with open("movements/reach-to-grasp.csv", newline="") as shipped:
    HEAD, *ROWS = [row[:7] for row in csv.reader(shipped)]
TIMES = [float(row[0]) for row in ROWS]
RATE = 1e3 * (len(ROWS) - 1) / (TIMES[-1] - TIMES[0])
#: Nexus and Qualisys store a rate, and no times; these are the rows of the shipped movement at regular times.
EVEN = [[f"{1e3 * i / RATE:.6f}", *row[1:]] for i, row in enumerate(ROWS)]


def joined(rows, separator=",", quoted=False):
    return "".join(separator.join(f'"{cell}"' if quoted else cell for cell in row) + "\n" for row in rows)


def with_commas(rows):
    return [[cell.replace(".", ",") for cell in row] for row in rows]


def lost(rows, begin, end, columns, as_what="0"):
    return [[as_what if begin <= i < end and c in columns else cell for c, cell in enumerate(row)] for i, row in enumerate(rows)]


def motive(unit="Meters", scale=1e-3, extra=True):
    """As Motive 2 exports it, with a rigid body, and a marker of nobody's."""
    others = 7 if extra else 0
    rows = [["Format Version", "1.23", "Take Name", "reach, slow", "Capture Frame Rate", "84.0", "Export Frame Rate", "84.0",
             "Rotation Type", "Quaternion", "Length Units", unit, "Coordinate Space", "Global"], [],
            ["", "Type"] + ["Marker"] * 6 + (["Rigid Body"] * 7)[:others],
            ["", "Name"] + ["hand:thumb"] * 3 + ["hand:index"] * 3 + (["board"] * 7)[:others],
            ["", "ID"] + ["A1"] * 3 + ["A2"] * 3 + (["7"] * 7)[:others],
            ["", ""] + ["Position"] * 6 + (["Rotation"] * 4 + ["Position"] * 3)[:others],
            ["Frame", "Time (Seconds)"] + ["X", "Y", "Z"] * 2 + ["X", "Y", "Z", "W", "X", "Y", "Z"][:others]]
    for i, row in enumerate(ROWS):
        rows.append([str(i), f"{float(row[0]) / 1e3:.6f}", *(f"{float(x) * scale:.7g}" for x in row[1:]), *["0.1"] * others])
    return '"Format Version"'[1:-1] + joined([[f'"{cell}"' if "," in cell else cell for cell in row] for row in rows])[len("Format Version"):]


def nexus(separator=",", devices=True):
    """As Nexus 2 exports it, behind a force plate."""
    plate = [["Devices"], ["1000"], ["", "", "Plate - Force", "", ""], ["Frame", "Sub Frame", "Fx", "Fy", "Fz"], ["", "", "N", "N", "N"],
             *([str(i // 10 + 1), str(i % 10), "0.1", "0.2", "0.3"] for i in range(50)), []] if devices else []
    rows = [["Trajectories"], [f"{RATE:.9g}"], ["", "", "hand:thumb", "", "", "hand:index", "", "", "*12", "", ""],
            ["Frame", "Sub Frame"] + ["X", "Y", "Z"] * 3, ["", ""] + ["mm"] * 9]
    rows += [[str(i + 1), "0", *row[1:], "", "", ""] for i, row in enumerate(EVEN)]
    return joined(plate + (with_commas(rows) if separator == ";" else rows), separator)


def qualisys(named=True):
    """As QTM exports it, with or without columns' names, and frames and times."""
    rows = [["NO_OF_FRAMES", str(len(ROWS))], ["NO_OF_CAMERAS", "8"], ["NO_OF_MARKERS", "3"], ["FREQUENCY", f"{RATE:.9g}"],
            ["NO_OF_ANALOG", "0"], ["ANALOG_FREQUENCY", "0"], ["DESCRIPTION", "--"], ["TIME_STAMP", "2026-11-27, 10:00:00", "1.5"],
            ["DATA_INCLUDED", "3D"], ["MARKER_NAMES", "thumb", "index", "new 1"], ["TRAJECTORY_TYPES", "Measured", "Measured", "Mixed"]]
    if named:
        rows.append(["Frame", "Time"] + [f"{name} {axis}" for name in ("thumb", "index", "new 1") for axis in "XYZ"])
    for i, row in enumerate(EVEN):
        rows.append([str(i + 1), f"{float(row[0]) / 1e3:.5f}"] * named + [*row[1:], "0.000", "0.000", "0.000"])
    return joined(rows, "\t")


class Movements(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.usual, cls.even = cls.hand(joined([HEAD, *ROWS]))[0], cls.hand(joined([HEAD, *EVEN]))[0]

    @classmethod
    def hand(cls, text, mark=b""):
        """Where the fingers were, tick by tick, and what the program said."""
        cls.movement = cls.folder / "movement.csv"
        cls.movement.write_bytes(mark + text.encode())
        experiment = cls.folder / "reach.yaml"
        experiment.write_text(pathlib.Path("experiments/reach-to-grasp.yaml").read_text()
                              .replace("../movements/reach-to-grasp.csv", str(cls.movement)).replace("../", os.getcwd() + "/"))
        out = tempfile.mkdtemp(dir=cls.folder)
        result = dihaptic("run", str(experiment), "--out", out)
        if result.returncode != 0:
            return None, result.stderr
        session = dh.load(session_of(out))
        where = np.column_stack([session[f"{finger}.handle_position"] for finger in ("thumb", "index")])
        return where, result.stderr + (session.folder / "movement-faults.csv").read_text()

    def assert_moves_as(self, wanted, found, millimetres):
        self.assertIsNotNone(found[0], found[1])
        length = min(len(wanted), len(found[0]))
        self.assertLess(abs(len(wanted) - len(found[0])), 30)
        self.assertLess(1e3 * np.abs(wanted[:length] - found[0][:length]).max(), millimetres)

    def test_of_other_countries_are_the_same(self):
        numbers = with_commas(ROWS)
        for name, text, mark in (("semicolons and commas", joined([HEAD, *numbers], ";"), b""),
                                 ("semicolons and points", joined([HEAD, *ROWS], ";"), b""),
                                 ("tabs", joined([HEAD, *ROWS], "\t"), b""),
                                 ("commas in quotes", joined([HEAD, *numbers], quoted=True), b""),
                                 ("sep=;", "sep=;\n" + joined([HEAD, *numbers], ";"), b""),
                                 ("sep=,", "sep=,\r\n" + joined([HEAD, *ROWS]).replace("\n", "\r\n"), b""),
                                 ("byte order mark", joined([HEAD, *ROWS]), b"\xef\xbb\xbf"),
                                 ("byte order mark, semicolons", joined([HEAD, *numbers], ";"), b"\xef\xbb\xbf")):
            with self.subTest(name):
                self.assert_moves_as(self.usual, self.hand(text, mark), 1e-6)

    def test_commas_that_might_part_thousands_are_told(self):
        said = self.hand(joined([HEAD, *with_commas(ROWS)], quoted=True))[1]
        self.assertIn("movement.csv:2: warning: from here on a comma in a number is read as a decimal point", said)
        mixed = [HEAD, *with_commas(ROWS[:20]), *ROWS[20:]]
        found, said = self.hand(joined(mixed, ";"))
        self.assertIsNone(found)
        self.assertIn("movement.csv:22: error: ", said)
        self.assertIn("has a point before its decimals, and line 2 has a comma", said)

    def test_commas_without_quotes_are_told(self):
        found, said = self.hand(joined([HEAD, *with_commas(ROWS)]))
        self.assertIsNone(found)
        self.assertIn("movement.csv:2: error: has 14 values, but the first line names 7 columns. Do its numbers have decimal commas?", said)

    @soak.alone
    def test_quotes_that_are_not_closed_are_told(self):
        found, said = self.hand(joined([HEAD, *ROWS]).replace("\n", '\n"', 1))
        self.assertIsNone(found)
        self.assertIn("movement.csv:2: error: has a quote", said)

    @soak.alone
    def test_lost_markers_at_an_end_are_as_if_they_were_empty(self):
        count = len(ROWS)
        for name, span in (("start", (0, 12)), ("middle", (60, 72)), ("end", (count - 12, count)), ("long", (60, 90))):
            for columns in ((1, 2, 3), (4, 5, 6), (1, 2, 3, 4, 5, 6)):
                with self.subTest(name, columns=columns):
                    empty = self.hand(joined([HEAD, *lost(ROWS, *span, columns, "")]))
                    zeros = self.hand(joined([HEAD, *lost(ROWS, *span, columns)]))
                    self.assert_moves_as(empty[0], zeros, 1e-6)
                    self.assertGreater(zeros[1].count("missing marker"), 1)
                    self.assertEqual(zeros[1].count("missing marker"), empty[1].count("missing marker"))

    @soak.alone
    def test_that_begin_at_zero_are_kept(self):
        """As of a laboratory that counts positions from the first."""
        start = [float(x) for x in ROWS[0][1:]]
        rows = [[row[0], *(f"{float(x) - s + (40 if i == 4 else 0):.4f}" for i, (x, s) in enumerate(zip(row[1:], start)))] for row in ROWS]
        said = self.hand(joined([HEAD, *rows]))[1]
        self.assertEqual(said.count("missing marker"), 1)  # as in the shipped movement

    def test_with_a_column_twice_or_times_that_go_back_are_told(self):
        midnight = [[f"{(float(row[0]) + 86399000) % 86400000:.3f}", *row[1:]] for row in ROWS]
        for text, said in ((joined([[*row, row[1]] for row in [HEAD, *ROWS]]), "movement.csv:1: error: thumb_x_mm: column 8 repeats an earlier one"),
                           (joined([[*row, "0"] if row is not HEAD else [*row, "thumb_x_m"] for row in [HEAD, *ROWS]]),
                            "movement.csv:1: error: thumb_x_m: column 8 repeats an earlier one"),
                           (joined([HEAD, *midnight]), "error: time_ms: time goes from 86399999."),
                           (joined([HEAD, *ROWS[:50], ROWS[49], *ROWS[50:]]), "movement.csv:52: error: time_ms: the same time twice")):
            with self.subTest(said):
                found, told = self.hand(text)
                self.assertIsNone(found)
                self.assertIn(said, told)

    def test_exported_by_motive(self):
        for unit, scale in (("Meters", 1e-3), ("Centimeters", 0.1), ("Millimeters", 1)):
            with self.subTest(unit):
                self.assert_moves_as(self.usual, self.hand(motive(unit, scale)), 0.01)
        self.assert_moves_as(self.usual, self.hand(motive(extra=False)), 0.01)
        self.assertIn("board: is left out: no finger of the scene has such a name", self.hand(motive())[1])
        found, said = self.hand(motive("Inches"))
        self.assertIsNone(found)
        self.assertIn("the unit of its positions is 'Inches'", said)

    @soak.alone
    def test_exported_by_nexus(self):
        for name, text in (("alone", nexus(devices=False)), ("behind force plates", nexus()), ("with decimal commas", nexus(";"))):
            with self.subTest(name):
                self.assert_moves_as(self.even, self.hand(text), 1e-3)

    @soak.alone
    def test_exported_by_qualisys(self):
        for named in (True, False):
            with self.subTest(named=named):
                self.assert_moves_as(self.even, self.hand(qualisys(named)), 0.1)
        found, said = self.hand(qualisys().replace("FREQUENCY", "frequency"))
        self.assertIsNone(found)
        self.assertIn("its header does not contain FREQUENCY", said)

    def test_whose_markers_are_no_fingers_are_told(self):
        found, said = self.hand(motive().replace("hand:thumb", "hand:a").replace("hand:index", "hand:b"))
        self.assertIsNone(found)
        self.assertIn("no finger of the scene has any of these names. Give the markers the names of the scene's fingers", said)


GOOD = "time_s,z_mm\n0,0\n0.4,30\n"
#: A table of a path, and the message about it; "": the table is read.
PATHS = {
    "usual": (GOOD, ""),
    "byte order mark, CR LF": ("\ufeff" + GOOD.replace("\n", "\r\n"), ""),
    "semicolons, decimal commas": ("time_s;z_mm\n0;0\n0,4;30\n", ""),
    "sep=;": ("sep=;\ntime_s;z_mm\n0;0\n0,4;30\n", ""),
    "tabs": (GOOD.replace(",", "\t"), ""),
    "blanks after commas": (GOOD.replace(",", ", "), ""),
    "R's quotes and row names": ('"","time_s","z_mm"\n"1",0,0\n"2",0.4,30\n', ""),
    "exponents": ("time_s,z_mm\n0.00E+00,0\n4.00E-01,3.00E+01\n", ""),
    "decimal commas in quotes": ('time_s,z_mm\n0,0\n"0,4",30\n', "path.csv:3: warning: from here on a comma in a number is read as a decimal point"),
    "comment": ("# platform\n" + GOOD, "path.csv:1: error: starts with a comment (#)"),
    "empty cell": ("time_s,z_mm\n0,0\n0.4,\n", "path.csv:3: error: z_mm: '' is not a number"),
    "NaN": ("time_s,z_mm\n0,0\n0.4,NaN\n", "path.csv:3: error: z_mm: 'NaN' is not a number"),
    "text": ("time_s,z_mm\n0,0\n0.4,high\n", "path.csv:3: error: z_mm: 'high' is not a number"),
    "decimal commas without quotes": ("time_s,z_mm\n0,0\n0,4,30\n", "path.csv:3: error: has 3 values, but line 1 names 2 columns"),
    "a short line": ("time_s,z_mm\n0,0\n0.4\n", "path.csv:3: error: has 1 value, but line 1 names 2 columns"),
    "points and commas": ("time_s;z_mm\n0,1;0\n0.4;30\n", "path.csv:3: error: '0.4' has a point before its decimals, and line 2 has a comma"),
    "times that go back": ("time_s,z_mm\n0,0\n0.4,30\n0.3,20\n", "path.csv:4: error: time_s: time goes from 0.4 to 0.3 s"),
    "other names": ("t,z\n0,0\n0.4,30\n", "path.csv:1: error: time_s: no column has this name; the columns are t, z"),
    "no names": ("0,0\n0.4,30\n", "path.csv:1: error: time_s: no column has this name"),
    "another unit": ("time_s,z_m\n0,0\n0.4,0.03\n", "path.csv:1: error: z_mm: no column has this name; the columns are time_s, z_m"),
    "a column twice": ("time_s,z_mm,z_mm\n0,0,0\n0.4,30,60\n", "path.csv:1: error: z_mm: column 3 repeats an earlier one"),
    "columns without a name": ("time_s,z_mm,,\n0,0,,\n0.4,30,,\n,,,\n", ""),
    "no last line end": (GOOD.strip(), ""),
    "exponents of FORTRAN": ("time_s,z_mm\n0.0D+00,0\n4.0D-01,30\n", "path.csv:2: error: time_s: '0.0D+00' is not a number"),
    "a blank between thousands": ("time_s;z_mm\n0;0\n0,4;1\u202f000,5\n", "path.csv:3: error: z_mm: '1\u202f000,5' is not a number"),
    "another minus": ("time_s,z_mm\n0,0\n0.4,\u221230\n", "path.csv:3: error: z_mm: '\u221230' is not a number"),
    "one row": ("time_s,z_mm\n0,0\n", "path.csv:1: error: time_s: there are fewer than two times"),
    "an open quote": ('time_s,z_mm\n0,0\n"0.4,30\n', "path.csv:3: error: has a quote"),
    "nothing": ("", "path.csv' is empty, or cannot be read"),
    "old Mac's": (GOOD.replace("\n", "\r"), "path.csv' is empty, or cannot be read"),
}


class Paths(unittest.TestCase):
    def test_are_read_or_told_with_line_and_remedy(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "path.yaml").write_text(f"""title: platform
scene: {os.getcwd()}/scenes/block-on-table.yaml
task:
  states:
    - name: a
      drive: [{{ body: block, path: {{ file: path.csv }} }}]
      exits: [{{ when: time, after_s: 0.5, outcome: done }}]
  blocks: [{{ name: b, kind: baseline, repeats: 1 }}]
""")
            for what, (text, said) in PATHS.items():
                with self.subTest(what):
                    (folder / "path.csv").write_text(text, newline="")
                    result = dihaptic("check", str(folder / "path.yaml"))
                    self.assertEqual(result.returncode, 2 if "error" in said or "cannot" in said else 0, result.stdout + result.stderr)
                    self.assertIn(said, result.stdout + result.stderr)
                    if not said:
                        self.assertNotIn("path.csv", result.stdout + result.stderr)


class Fits(unittest.TestCase):
    def test_read_tables_of_other_countries(self):
        rows = [["perturbation", "clamp", "compensation"], *([str(30 * (i > 9)), "0", f"{20 * (1 - 0.9 ** max(0, i - 9)):.4f}"] for i in range(60))]
        with tempfile.TemporaryDirectory() as name:
            file = pathlib.Path(name, "trials.csv")
            said = []
            for text in (joined(rows), joined(with_commas(rows), ";"), joined(with_commas(rows), quoted=True)):
                file.write_text(text)
                result = dihaptic("fit", "single_rate", str(file))
                self.assertEqual(result.returncode, 0, result.stderr)
                said.append(result.stdout)
            self.assertEqual(said, [said[0]] * 3)
            file.write_text(joined([[*row, row[2]] for row in rows]))
            result = dihaptic("fit", "single_rate", str(file))
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertIn("trials.csv:1: error: compensation: column 4 repeats an earlier one", result.stderr)


class Sessions(unittest.TestCase):
    """trials.csv of a session, after other programs have saved it."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        text = pathlib.Path("experiments/rotation-reversal.yaml").read_text().replace("../", os.getcwd() + "/")
        for repeats in ["64", "160", "16", "48"]:
            text = text.replace(f"repeats: {repeats}", "repeats: 3")
        file = pathlib.Path(folder.name, "short.yaml")
        file.write_text(text)
        dihaptic("run", str(file), "--simulate", "--participant", "sim-001", "--out", folder.name + "/out")
        self.session = pathlib.Path(session_of(folder.name + "/out"))
        self.trials = self.session / "trials.csv"
        with self.trials.open(newline="") as table:
            self.head, *self.rows = list(csv.reader(table))
        self.adaptation = self.reported("--tables")[1]

    @staticmethod
    def saved(rows):
        out = io.StringIO()
        csv.writer(out, lineterminator="\n").writerows(rows)
        return out.getvalue()

    def reported(self, *options):
        result = dihaptic("report", str(self.session), *options)
        made = self.session / "adaptation.csv"
        return result, made.read_text() if result.returncode == 0 else ""

    def same(self, text):
        self.trials.write_text(text)
        result, adaptation = self.reported()
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(adaptation, self.adaptation)
        self.assertIn("trials.csv", result.stderr, "a change is reported")

    @soak.alone
    def test_with_a_byte_order_mark_are_the_same(self):
        self.same("\ufeff" + self.saved([self.head, *self.rows]).replace("\n", "\r\n"))

    def test_with_a_column_that_numbers_the_rows_are_the_same(self):
        self.same(self.saved([["", *self.head], *([str(i), *row] for i, row in enumerate(self.rows))]))

    @soak.alone
    def test_with_a_comma_at_the_end_of_each_line_are_the_same(self):
        self.same(self.saved([*row, ""] for row in [self.head, *self.rows]))

    @soak.alone
    def test_with_whole_numbers_as_decimals_are_the_same(self):
        whole = [i for i, name in enumerate(self.head) if name in ("trial_num", "attempt", "session_num")]
        self.same(self.saved([self.head, *([cell + ".0" if i in whole else cell for i, cell in enumerate(row)] for row in self.rows)]))

    def test_with_the_names_of_the_columns_once_more_are_refused_with_the_line(self):
        self.trials.write_text(self.saved([self.head, *self.rows[:5], self.head, *self.rows[5:]]))
        result, _ = self.reported()
        self.assertEqual(result.returncode, 2)
        self.assertIn("trials.csv:7: error: kind: is 'kind', which is not one of: practice, baseline", result.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=1)
