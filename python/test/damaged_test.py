"""A damaged session is never read silently: each call gives what was recorded, warns, or raises dihaptic.Error."""

import contextlib
import os
import pathlib
import random
import re
import shutil
import sys
import tempfile
import unittest
import warnings

import h5py
import matplotlib
import numpy as np
import yaml

matplotlib.use("Agg")

sys.path.append("test")
import soak  # noqa: E402

import dihaptic as dh  # noqa: E402


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
        """Returns whether something was said: by a warning, by Error, or by both.

        Warnings of Python itself do not count, such as those of files that nobody has closed.
        """
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            try:
                read = everything(dh.load(folder))
            except dh.Error:
                return True
        said = [str(each.message) for each in said if issubclass(each.category, UserWarning)]
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
        for _ in range(soak.of(15, 60)):
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
        for kept in range(0, len(lines), soak.of(4, 1)):
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
                with self.assertRaisesRegex(dh.Error, "more than 200 lists or keys nested within each other|cannot be read"):
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

    def said_of(self, call):
        """The warnings of a call, in one text."""
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            call()
        return "\n".join(str(each.message) for each in said)

    def edit(self, file, old, new):
        text = file.read_text()
        self.assertIn(old, text)
        file.write_text(text.replace(old, new, 1))

    # session.yaml

    def test_what_describes_the_session_warns_when_it_lost_keys_or_was_changed(self):
        whole = (self.good.folder / "session.yaml").read_text()
        ticks = re.search(r"ticks: \d+", whole)[0]
        folder = self.copy()
        file = folder / "session.yaml"
        for old, new, said in (
            ("experiment: ", "experience: ", "session.yaml: warning: has lost keys: experiment. Rebuild it"),
            ("clock: virtual\nseed: 1\n", "", "has lost keys: clock, seed"),
            (ticks, "ticks: 1", "session.yaml: warning: seal: does not match"),
            ("seal: ", "sole: ", "seal: does not match"),
            ("tables:", "tables: [1]\nolder:", "whether session.yaml has changed since the session ended is not known"),
            (whole[whole.index("tables:"):], "...\n", "session.yaml: warning: has no seals .* is not known. Rebuild it"),
        ):
            with self.subTest(said):
                self.edit(file, old, new)
                self.assertRegex(self.said_of(lambda: dh.load(folder).info), said)
                self.assertEqual(self.said_of(lambda: repr(dh.load(folder))), "")
                self.assertRegex(self.said_of(lambda: dh.load(folder).trials), said.replace("session.yaml has", "trials.csv has"))
                file.write_text(whole)
        self.edit(file, whole[whole.index("tables:"):], "...\n")
        self.edit(file, "program: dihaptic 0.2", "program: dihaptic 0.1")
        self.assertEqual(self.said_of(lambda: dh.load(folder).info), "", "version 0.1 wrote no seals")

    def test_every_end_that_is_cut_off_and_mended_is_told(self):
        folder = self.copy()
        file = folder / "session.yaml"
        lines = file.read_text().splitlines(keepends=True)
        for kept in range(len(lines) - 1):
            file.write_text("".join(lines[:kept]) + "...\n")
            try:
                said = self.said_of(lambda: dh.load(folder).info)
            except dh.Error:
                continue
            self.assertTrue(said, f"{kept} of {len(lines)} lines")

    def test_yes_and_no_may_be_saved_as_true_and_false(self):
        folder = self.copy()
        file = folder / "session.yaml"
        again = yaml.safe_dump(yaml.safe_load(file.read_text()), sort_keys=False)
        self.assertIn("interrupted: false", again)
        file.write_text(again + "...\n")
        self.assertFalse(self.assert_is_told(folder, "another software's words"))

    # Tables

    def test_a_table_that_is_gone_or_was_no_table_is_told(self):
        folder = self.copy()
        for name in ("lifts.csv", "trial-list.csv"):
            (folder / name).unlink()
        said = self.said_of(lambda: dh.load(folder).tables)
        self.assertRegex(said, "lifts.csv: warning: is gone: it had 5 rows when the session ended. Rebuild it from raw.log")
        self.assertRegex(said, "trial-list.csv: warning: is gone: it is an input of the session. Restore the recorded version")
        with self.assertRaisesRegex(dh.NotThere, "lifts: is gone: it had 5 rows .* dihaptic recover"):
            dh.load(folder).lifts  # noqa: B018
        (folder / "fault.csv").write_text("a\n1\n")
        (folder / "mine.csv").write_text("a\n1\n")
        self.assertRegex(self.said_of(lambda: dh.load(folder).table("fault")), "did not exist when the session ended")
        self.assertEqual(self.said_of(lambda: dh.load(folder).table("mine")), "")

    def test_an_input_that_was_changed_is_told(self):
        folder = self.copy()
        (folder / "trial-list.csv").write_text((folder / "trial-list.csv").read_text().replace("1", "2"))
        said = self.said_of(lambda: dh.load(folder).table("trial-list"))
        self.assertIn("trial-list.csv: warning: has changed since the session was recorded. Restore the recorded version", said)

    def test_a_damaged_table_is_no_picture(self):
        for name, change, said in (
            ("trials.csv", lambda text: text.replace("trial_num", "number", 1), "trials.csv: error: has a row without a whole number"),
            ("lifts.csv", lambda text: text.replace("attempt", "try", 1), "lifts.csv: error: has a row without a whole number"),
            ("lifts.csv", lambda text: text.replace("\n1,", "\none,", 1), "lifts.csv: error: has a row without a whole number"),
            ("trials.csv", lambda text: text + text.splitlines()[-1] + "\n", "trials.csv: error: lists an attempt twice"),
            ("lifts.csv", lambda text: text.replace("lift_off_s", "lift_off", 1), "is not a moment on which curves"),
            ("trials.csv", lambda text: "", "cannot be read as a table"),
        ):
            with self.subTest(name, said=said), warnings.catch_warnings():
                warnings.simplefilter("ignore")
                folder = self.copy()
                (folder / name).write_text(change((folder / name).read_text()))
                with self.assertRaisesRegex(dh.Error, said):
                    dh.load(folder).plot("grip_force", align="lift_off")

    # What is not a file, or far too large

    def test_what_is_no_file_is_refused_at_once(self):
        calls = {
            "session.yaml": dh.load,
            "raw.log": lambda folder: dh.load(folder).tick,
            "session.nwb": lambda folder: dh.load(folder)["grip_force"],
            "trials.csv": lambda folder: dh.load(folder).trials,
            "trial-list.csv": lambda folder: dh.load(folder).table("trial-list"),
        }
        for name, call in calls.items():
            for make in (os.mkfifo, lambda file: os.symlink("/dev/zero", file), os.mkdir):
                folder = self.copy(name)
                make(folder / name)
                with self.subTest(name, make=make), warnings.catch_warnings():
                    warnings.simplefilter("ignore")
                    with self.assertRaisesRegex(dh.Error, "it is not a regular file|it is a folder"):
                        call(folder)
        with self.assertRaisesRegex(dh.Error, "cannot be read as a table: it is not a regular file"):
            dh.read_table("/dev/zero")

    def test_what_is_far_too_large_is_refused_at_once(self):
        large = 4 * 10**12
        for name, call in (
            ("session.yaml", dh.load),
            ("trials.csv", lambda folder: dh.load(folder).trials),
            ("raw.log", lambda folder: dh.load(folder).exact("grip_force")),
        ):
            with self.subTest(name), warnings.catch_warnings():
                warnings.simplefilter("ignore")
                folder = self.copy()
                os.truncate(folder / name, large)
                with self.assertRaisesRegex(dh.Error, "it has 4000000 MB, and at most [0-9]+ MB are read"):
                    call(folder)
        os.truncate(folder / "session.nwb", large)
        said = self.said_of(lambda: dh.load(folder)["grip_force"])
        self.assertIn("session.nwb: warning: cannot be compared with its checksum: it has 4000000 MB", said)

    def test_a_folder_that_cannot_be_opened_is_an_error(self):
        for name in ("a" * 300, "a\0b", "a/" * 3000):
            with self.subTest(name[:5]):
                with self.assertRaisesRegex(dh.Error, "cannot be opened|is not a session"):
                    dh.load(name)
                with self.assertRaisesRegex(dh.Error, "cannot be read"):
                    dh.read_table(name)
                with self.assertRaisesRegex(dh.Error, "cannot be read"):
                    dh.Study(name)
                with self.assertRaisesRegex(dh.Error, "cannot be read"):
                    dh.Rehearsal(name)

    @unittest.skipUnless(os.geteuid() == 0, "only root can become somebody else")
    def test_a_folder_without_permission_is_an_error(self):
        folder = self.copy()
        os.chmod(self.folder.name, 0o755)
        os.chmod(folder.parent, 0o755)
        with contextlib.ExitStack() as back:
            back.callback(os.chmod, folder, 0o755)
            os.chmod(folder, 0o700)
            os.seteuid(65534)
            back.callback(os.seteuid, 0)
            with self.assertRaisesRegex(dh.Error, "cannot be opened: .*Permission denied.* correct its permissions"):
                dh.load(folder)
            os.seteuid(0)
            os.chmod(folder, 0o711)
            os.seteuid(65534)
            with self.assertRaisesRegex(dh.Error, "cannot be read: Permission denied. Correct its permissions"):
                dh.load(folder).tables  # noqa: B018

    # session.nwb

    def with_nwb(self, change):
        """A copy without its log, whose session.nwb is changed."""
        folder = self.copy("raw.log")
        with h5py.File(folder / "session.nwb", "a") as nwb:
            change(nwb)
        return dh.load(folder)

    def test_links_that_make_countless_paths_are_followed_once(self):
        def nest(nwb):
            at = nwb.create_group("scratch/deep")
            for _ in range(60):
                below = at.create_group("a")
                at["b"] = below
                at = below
            at["up"] = nwb["/"]

        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            self.assertEqual(len(self.with_nwb(nest)["grip_force"]), len(self.good.t))

            def many(nwb):
                group = nwb.create_group("scratch/many")
                for n in range(100_001):
                    group[str(n)] = h5py.SoftLink("/")

            with self.assertRaisesRegex(dh.Error, "session.nwb is damaged: it has more than 100000 names"):
                self.with_nwb(many)["grip_force"]

    def test_a_record_without_what_belongs_to_it_is_an_error(self):
        def replace(name, values):
            def change(nwb):
                del nwb[f"acquisition/{name}"]
                if values is not None:
                    nwb[f"acquisition/{name}"] = values

            return change

        ticks = len(self.good.t)
        for change in (
            replace("grip_force/data", np.zeros(ticks - 1)),
            replace("grip_force/data", np.zeros((ticks, 3))),
            replace("grip_force/data", 3.0),
            replace("grip_force/data", None),
            replace("sequence/data", None),
            lambda nwb: nwb["acquisition/sequence/starting_time"].attrs.__setitem__("rate", 0.0),
            lambda nwb: nwb["acquisition/sequence/starting_time"].attrs.__setitem__("rate", -1.0),
            lambda nwb: nwb["acquisition/sequence/starting_time"].attrs.__setitem__("rate", np.nan),
            lambda nwb: nwb.__setitem__("acquisition/sequence/timestamps", np.zeros(ticks)),
            lambda nwb: nwb.__setitem__("acquisition/sequence/timestamps", np.zeros((ticks, 2))),
        ):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                session = self.with_nwb(change)
                for call in (lambda: session.plot("grip_force"), lambda: session.plot("grip_force", align="lift_off")):
                    with self.assertRaisesRegex(dh.Error, "session.nwb is damaged"):
                        call()
                with contextlib.suppress(dh.Error):
                    session.between(0, 1)
                with contextlib.suppress(dh.Error):
                    session.exact("grip_force")

    def test_times_that_are_none_are_refused(self):
        with self.assertRaisesRegex(dh.Error, "from nan to 1 s is not an interval"):
            self.good.between(np.nan, 1)
        with self.assertRaisesRegex(dh.Error, "is not an interval"):
            self.good.plot("grip_force", align="lift_off", before=np.inf)

    def test_a_session_that_kept_tables_alone_says_so(self):
        folder = self.copy("raw.log", "session.nwb")
        for call in (lambda session: session["grip_force"], lambda session: session.t, lambda session: session.fingers):
            with self.assertRaisesRegex(dh.Error, "only tables: a rehearsal keeps no recordings. With --keep-recordings, "):
                call(dh.load(folder))
        folder = self.copy("session.nwb")
        with self.assertRaisesRegex(dh.Error, "has no session.nwb: it has been removed. .*dihaptic recover"):
            dh.load(folder)["grip_force"]


if __name__ == "__main__":
    unittest.main()
