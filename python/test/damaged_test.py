"""A damaged session is never read silently: each call gives what was recorded, warns, or raises dihaptic.Error."""

import os
import pathlib
import random
import shutil
import tempfile
import unittest
import warnings

import numpy as np

import dihaptic as dh


def everything(session):
    """All that a session has, by name."""
    out = {"t": session.t, "tick": session.tick, "info": session.info["state"]}
    out.update({name: session[name] for name in session.keys()})
    out.update({f"table {name}": session.table(name) for name in session.tables})
    return out


def are_equal(one, other):
    return one.keys() == other.keys() and all(np.array_equal(np.asarray(one[name]), np.asarray(other[name]))
                                              or str(one[name]) == str(other[name]) for name in one)


class Damaged(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.good = dh.run("experiments/first-trials.yaml", out=cls.folder.name, progress=False,
                          simulate=True, participant="sim-001")
        cls.all = everything(cls.good)

    def copy(self, *left_out):
        ignored = shutil.ignore_patterns(*left_out)
        return pathlib.Path(shutil.copytree(self.good.folder, tempfile.mkdtemp(dir=self.folder.name) + "/s", ignore=ignored))

    def assert_is_told(self, folder, what):
        """Returns whether something was said: by a warning, by Error, or by both."""
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            try:
                read = everything(dh.load(folder))
            except dh.Error:
                return True
        self.assertTrue(said or are_equal(read, self.all), f"{what}: other values, and no word of it")
        return bool(said)

    def test_an_intact_one_warns_of_nothing(self):
        for left_out in ((), ("raw.log",)):
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                self.assertTrue(are_equal(everything(dh.load(self.copy(*left_out))), self.all))

    def test_a_flipped_bit_of_session_nwb_is_told(self):
        folder = self.copy("raw.log")  # the head is read from session.nwb, too
        file = folder / "session.nwb"
        whole = file.read_bytes()
        draw = random.Random(1)
        for _ in range(60):
            at, bit = draw.randrange(len(whole)), draw.randrange(8)
            changed = bytearray(whole)
            changed[at] ^= 1 << bit
            file.write_bytes(changed)
            self.assertTrue(self.assert_is_told(folder, f"bit {bit} of byte {at}"), f"bit {bit} of byte {at}")
        file.write_bytes(whole)
        self.assertFalse(self.assert_is_told(folder, "nothing"))

    def test_a_session_yaml_that_is_cut_is_told(self):
        folder = self.copy()
        file = folder / "session.yaml"
        lines = file.read_text().splitlines(keepends=True)
        for kept in range(len(lines)):
            file.write_text("".join(lines[:kept]))
            self.assertTrue(self.assert_is_told(folder, f"{kept} lines"), f"{kept} of {len(lines)} lines")
            with self.assertRaisesRegex(dh.Error, "session.yaml: error: is cut off.*dihaptic recover"):
                dh.load(folder).info

    def test_a_table_of_a_session_that_describes_itself_no_more_warns(self):
        folder = self.copy()
        (folder / "session.yaml").write_text("state: complete\n")
        with self.assertWarnsRegex(UserWarning, "whether trials.csv has changed .* is not known: .* is cut off"):
            self.assertEqual(len(dh.load(folder).trials), len(self.good.trials))

    def test_parts_of_another_kind_are_told(self):
        good = (self.good.folder / "session.yaml").read_text()
        end = "...\n"
        for what in ("tables: [1, 2]", "tables: {}", "tables: [{rows: 1}]", "participant: [1]", "inputs: yes", "ticks: {a: 1}",
                     "seal: [1]", "state: [complete]"):
            with self.subTest(what):
                folder = self.copy()
                key = what.split(":")[0]
                lines = good.removesuffix(end).splitlines(keepends=True)
                first = next(n for n, line in enumerate(lines) if line.startswith(f"{key}:"))
                last = next((n for n in range(first + 1, len(lines)) if lines[n][0].isalpha()), len(lines))
                (folder / "session.yaml").write_text("".join(lines[:first] + [what + "\n"] + lines[last:]) + end)
                self.assertTrue(self.assert_is_told(folder, what))

    def test_a_hundred_thousand_brackets_are_an_error(self):
        for text in ("tables: " + "[" * 100_000, "a: " + "{a: " * 100_000, "- " * 100_000 + "1", "? " * 100_000):
            with self.subTest(text[:12]):
                folder = self.copy()
                (folder / "session.yaml").write_text(text + "\n...\n")
                with self.assertRaisesRegex(dh.Error, "more than 200 lists or keys within each other|cannot be read"):
                    dh.load(folder).info

    def test_a_name_that_leads_out_of_the_folder_is_no_table(self):
        folder = self.copy()
        (folder.parent / "other.csv").write_text("a\n1\n")
        for name in ("../other", str(folder.parent / "other"), "", ".", "trials.csv"):
            with self.subTest(name), self.assertRaises(dh.NotThere):
                dh.load(folder).table(name)

    def test_the_log_of_another_session_is_refused(self):
        other = dh.run("experiments/lift-block.yaml", out=self.folder.name, progress=False)
        folder = self.copy()
        shutil.copy(other.folder / "raw.log", folder)
        for call in (lambda session: session.tick, lambda session: session.keys(), lambda session: session.between(0, 1)):
            with self.assertRaisesRegex(dh.Error, "raw.log: error: belongs to a different session"):
                call(dh.load(folder))

    def test_a_misspelt_folder_in_a_session_is_not_that_session(self):
        with self.assertRaisesRegex(dh.Error, "seesion2: error: is not a session"):
            dh.load(self.good.folder / "seesion2")
        self.assertEqual(dh.load(self.good.folder / "trials.csv").folder, self.good.folder)

    def test_a_relative_folder_stays_the_same_when_the_program_changes_its_own(self):
        before = pathlib.Path.cwd()
        try:
            os.chdir(self.good.folder.parent)
            session = dh.load(self.good.folder.name)
            os.chdir("/")
            self.assertEqual(len(session["grip_force"]), len(session.t))
        finally:
            os.chdir(before)

    def test_logical_values_in_other_words_are_read(self):
        table = self.good.folder.parent / "saved.csv"
        for yes, no in (("yes", "no"), ("True", "False"), ("TRUE", "FALSE"), ("true", "false")):
            table.write_text(f"trial_num,simulated\n1,{yes}\n2,{no}\n3,{yes}\n")
            self.assertEqual(dh.read_table(table).simulated.tolist(), [True, False, True])
        table.write_text("trial_num,simulated\n1,yes\n2,maybe\n")
        with self.assertRaisesRegex(dh.Error, "saved.csv:3: error: simulated: is 'maybe', which is neither yes nor no"):
            dh.read_table(table)
        # a first cell without a heading is taken for the row's name
        table.write_text("name,simulated\na,b,maybe\nc,d,yes\n")
        with self.assertRaisesRegex(dh.Error, "neither yes nor no"):
            dh.read_table(table)


if __name__ == "__main__":
    unittest.main()
