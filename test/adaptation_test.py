"""Figures of adaptation, computed again with numpy from adaptation.csv by the words of docs/tables.md alone.

Usage: adaptation_test.py PROGRAM, from the project's folder.
"""
import csv
import os
import pathlib
import sys
import tempfile
import unittest

import numpy as np

sys.path.insert(0, "test/cli")
from program import dihaptic, session_of

import soak  # program.py adds its folder to the path


def first(x, count):
    return np.mean(x[:count]) if len(x) else np.nan


def last(x, count):
    return np.mean(x[-count:]) if len(x) else np.nan


class Adaptation(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        text = pathlib.Path("experiments/rotation-reversal.yaml").read_text().replace("../", os.getcwd() + "/")
        for repeats, few in (("64", "12"), ("160", "14"), ("16", "10"), ("48", "12")):
            text = text.replace(f"repeats: {repeats} }}", f"repeats: {few} }}")
        text += "    - { name: again, kind: perturbed, perturb: rotation, repeats: 11 }\n"
        file = pathlib.Path(cls.folder.name, "short.yaml")
        file.write_text(text)
        ran = dihaptic("run", str(file), "--simulate", "--participant", "sim-001", "--out", cls.folder.name + "/out")
        assert ran.returncode == 0, ran.stderr
        session = session_of(cls.folder.name + "/out")
        made = dihaptic("report", session, *soak.TABLES)
        assert made.returncode == 0, made.stderr
        with open(session + "/adaptation.csv", newline="") as table:
            rows = list(csv.DictReader(table))
        with open(session + "/fits.csv", newline="") as table:
            (cls.fits,) = csv.DictReader(table)
        # sign of the perturbation in the first perturbed block
        cls.direction = next(np.sign(float(row["perturbation"])) for row in rows if abs(float(row["perturbation"])) > 1)
        cls.blocks = {}
        for row in rows:
            cls.blocks.setdefault(row["block"], []).append(float(row["compensation"] or "nan"))
        cls.measured = {block: [x for x in values if not np.isnan(x)] for block, values in cls.blocks.items()}

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def expect(self, name, value):
        self.assertAlmostEqual(float(self.fits[name]), value, delta=1e-6, msg=name)

    def test_windows(self):
        of = self.measured
        self.expect("baseline", np.mean(of["baseline"]))
        self.expect("early", first(of["rotation"], 8))
        self.expect("late", last(of["rotation"], 8))
        self.expect("clamp_first", first(of["clamp"], 8))
        self.expect("clamp_last", last(of["clamp"], 8))

    def test_savings_and_rebound(self):
        of = self.measured
        sign = self.direction
        self.expect("savings", sign * (first(of["again"], 8) - first(of["rotation"], 8)))
        self.expect("rebound", sign * (last(of["clamp"], 8) - last(of["reversal"], 2)))

    def test_numbers_of_trials(self):
        values = np.concatenate(list(self.blocks.values()))
        self.expect("measured", np.sum(~np.isnan(values)))
        self.expect("left_out", np.sum(np.isnan(values)))


if __name__ == "__main__":
    unittest.main()
