"""`dihaptic export --csv` writes what Python reads of raw.log, tick by tick."""

import pathlib
import subprocess
import tempfile
import unittest

import numpy as np
import pandas as pd

import dihaptic as dh
from dihaptic.program import program


def export(folder, *words):
    return subprocess.run([program(), "export", *map(str, words)], cwd=folder, capture_output=True, text=True)


class Exports(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.here = pathlib.Path(cls.folder.name)
        cls.session = dh.run("experiments/first-trials.yaml", out=cls.here, simulate=True, progress=False)

    def test_have_every_curve_and_its_unit(self):
        session = self.session
        names = [name for name in session if name not in dh.vocabulary.lists()]
        done = export(self.here, "--csv", ", ".join(names), session.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(f"written: {session.folder.name}_curves.csv\n", done.stdout)
        table = dh.read_table(self.here / f"{session.folder.name}_curves.csv")
        self.assertEqual(list(table.columns[:2]), ["t_s", "trial"])
        np.testing.assert_allclose(table.t_s, session.t, atol=1e-9)
        np.testing.assert_array_equal(table.trial, session["trial"])
        for name in names:
            values = session.exact(name)
            unit = session.unit(name).replace("*", "").replace("/", "_")
            suffix = "" if unit == "1" else f"_{unit}"
            parts = dh.quantity(name).components
            for i, part in enumerate(parts):
                np.testing.assert_allclose(table[f"{name}.{part}{suffix}"], values[:, i], rtol=1e-8, err_msg=name)
            if not parts:
                np.testing.assert_allclose(table[name + suffix], values, rtol=1e-8, err_msg=name)

    def test_have_the_columns_that_are_asked_for_each_once(self):
        done = export(self.here, self.session.folder, "--csv", "trial,block.position.z,grip_force,block.position", "-o", "some.csv")
        self.assertEqual(done.returncode, 0, done.stderr)
        table = pd.read_csv(self.here / "some.csv")
        self.assertEqual(list(table.columns), ["t_s", "trial", "block.position.z_m", "grip_force_N", "block.position.x_m",
                                               "block.position.y_m"])
        self.assertEqual(sorted(set(table.trial) - {0}), [1, 2, 3, 4, 5])

    def test_say_what_was_meant(self):
        done = export(self.here, self.session.folder, "--csv", "gripforce,contacts", "-o", "none.csv")
        self.assertEqual(done.returncode, 2)
        self.assertIn("gripforce: is not recorded. Did you mean grip_force?", done.stderr)
        self.assertIn("contacts: is a list, which has no curve.", done.stderr)
        self.assertFalse((self.here / "none.csv").exists())
        for words in ([], ["--csv", " , "]):
            self.assertIn("Add --bids FOLDER, --psych-ds FOLDER, or --csv", export(self.here, self.session.folder, *words).stderr)


if __name__ == "__main__":
    unittest.main()
