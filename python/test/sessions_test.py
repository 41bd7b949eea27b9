"""A session is read as it was recorded: all of session.nwb, by h5py's own reading, and all tables."""

import glob
import os
import pathlib
import pickle
import shutil
import sys
import tarfile
import tempfile
import unittest
import warnings

import h5py
import matplotlib
import numpy as np
import pandas as pd

matplotlib.use("Agg")

import dihaptic as dh  # noqa: E402

sys.path.append("test")
import soak  # noqa: E402

# one of each kind of record: no task, a simulated person's trials, joints, devices that turn, a lattice, sounds
KINDS = ["lift-block", "first-trials", "swing-rod", "hand-over", "reach-at-tone"]
if soak.EVERYTHING:
    KINDS = sorted(pathlib.Path(file).stem for file in glob.glob("experiments/*.yaml"))
RECORDINGS = pathlib.Path("test/recordings")


def record(kind, folder, **options):
    has_trials = "task:" in pathlib.Path(f"experiments/{kind}.yaml").read_text()
    person = {"simulate": True, "participant": "sim-001"} if has_trials else {}
    return dh.run(f"experiments/{kind}.yaml", out=folder, progress=False, **person, **options)


class Sessions(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.lift = record("lift-block", cls.folder.name)

    def assert_is_the_file(self, session):
        """Each series of the file is what the session gives by one name, and nothing else is there."""
        found = set()
        with h5py.File(session.folder / "session.nwb", "r") as nwb:
            series = nwb["acquisition"]
            for name in session.keys():
                group = f"task_{name}" if f"task_{name}" in series else name.replace(".", "_")
                found.add(group)
                here = session[name]
                if isinstance(here, pd.DataFrame):
                    self.assertEqual(list(here.columns), list(series[group].attrs["colnames"]))
                    for column in here.columns:
                        np.testing.assert_array_equal(here[column], series[group][column], err_msg=name)
                else:
                    np.testing.assert_array_equal(here, series[group]["data"], err_msg=name)
            self.assertEqual(found, set(series))

    def test_a_table_that_is_asked_for_as_a_quantity_is_named(self):
        for name in ("lifts", "phases"):
            with self.assertRaisesRegex(dh.NotThere, rf'^{name}: is a table of this session, .* Session.table\("{name}"\) reads it'):
                self.lift[name]

    def test_every_series_is_read(self):
        for kind in KINDS:
            with self.subTest(kind):
                self.assert_is_the_file(record(kind, self.folder.name))

    def test_lists_of_earlier_versions_were_series(self):
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(self.lift.folder, f"{folder}/session")
            now = self.lift["contacts"]
            with h5py.File(f"{folder}/session/session.nwb", "a") as nwb:
                del nwb["acquisition/contacts"]
                nwb["acquisition/contacts/data"] = now.drop(columns="time").to_numpy(dtype="f4")
                nwb["acquisition/contacts/timestamps"] = now.time
            before = dh.load(f"{folder}/session")["contacts"]
        np.testing.assert_array_equal(before, now)
        self.assertEqual(list(before.columns), list(now.columns))

    def test_sessions_of_earlier_versions_are_read(self):
        for archive in sorted(RECORDINGS.glob("*.tar.xz")):
            with self.subTest(archive.name), tempfile.TemporaryDirectory() as folder:
                with tarfile.open(archive) as tar:
                    tar.extractall(folder)
                session = dh.recover(f"{folder}/session", progress=False)
                self.assert_is_the_file(session)
                self.assertGreater(len(session.trials), 0)

    def test_a_session_without_its_log_is_read_all_the_same(self):
        for kind in ("lift-block", "hand-over"):
            with self.subTest(kind), tempfile.TemporaryDirectory() as folder:
                session = record(kind, folder)
                light = pathlib.Path(shutil.copytree(session.folder, f"{folder}/light", ignore=shutil.ignore_patterns("raw.log")))
                self.assert_is_the_file(dh.load(light))
                self.assertEqual(dh.load(light)._head, session._head)
                with h5py.File(light / "session.nwb", "a") as nwb:
                    del nwb["scratch/items"]
                with self.assertRaisesRegex(dh.Error, "raw.log: error: cannot be read: .* Copy it"):
                    dh.load(light).fingers

    def test_time_goes_by_ticks(self):
        np.testing.assert_allclose(np.diff(self.lift.t), self.lift.tick, atol=1e-12)
        self.assertEqual(len(self.lift.t), len(self.lift["grip_force"]))

    def test_a_component_is_a_column(self):
        np.testing.assert_array_equal(self.lift["block.position.z"], self.lift["block.position"][:, 2])
        np.testing.assert_array_equal(self.lift["block.orientation.w"], self.lift["block.orientation"][:, 0])

    def test_what_is_not_there_is_told(self):
        for name in ("grip", "block.positon", "cup.position", "block.position.w", "hinge.angle", ""):
            with self.subTest(name):
                self.assertNotIn(name, self.lift)
                with self.assertRaises(dh.NotThere) as caught:
                    self.lift[name]
                self.assertIsInstance(caught.exception, KeyError)
                self.assertIn("Session.quantities lists them.", str(caught.exception))
        with self.assertRaisesRegex(dh.NotThere, "Did you mean 'lifts'"):
            self.lift.table("lift")

    def test_tables_have_units_and_meanings(self):
        lifts = self.lift.lifts
        self.assertEqual(lifts.attrs["units"]["peak_grip_rate_N_s"], "N/s")
        self.assertEqual(lifts.attrs["units"]["height_mm"], "mm")
        self.assertNotIn("trial_num", lifts.attrs["units"])
        self.assertEqual(set(lifts.attrs["meanings"]), set(lifts.columns) - {"simulated", "moved_by"})
        self.assertIs(bool(lifts.simulated.item()), True)

    def test_a_table_of_nonsense_is_refused(self):
        empty = pathlib.Path(self.folder.name) / "empty.csv"
        empty.touch()
        for file in (empty, pathlib.Path("/nowhere.csv"), pathlib.Path("/bin/true")):
            with self.subTest(file), self.assertRaisesRegex(dh.Error, "cannot be read as a table"):
                dh.read_table(file)

    def test_a_session_that_has_no_record_says_how_to_get_one(self):
        with tempfile.TemporaryDirectory() as folder:
            with self.assertRaisesRegex(dh.Error, "is not a session"):
                dh.load(folder)
            (pathlib.Path(folder) / "session.yaml").write_text("state: running\n")
            with self.assertRaisesRegex(dh.Error, "dihaptic recover"):
                dh.load(folder)["grip_force"]

    def test_a_table_that_was_edited_says_so(self):
        with tempfile.TemporaryDirectory() as folder:
            edited = pathlib.Path(shutil.copytree(self.lift.folder, f"{folder}/session"))
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                self.assertGreater(len(dh.load(edited).phases), 1)
            lines = (edited / "phases.csv").read_text().splitlines(keepends=True)
            (edited / "phases.csv").write_text("".join(lines[:-1]))
            with self.assertWarnsRegex(UserWarning, "phases.csv: warning: has .* when the session ended. .*recover"):
                self.assertEqual(len(dh.load(edited).phases), len(lines) - 2)

    def test_one_that_is_damaged_says_so(self):
        with tempfile.TemporaryDirectory() as folder:
            broken = shutil.copytree(self.lift.folder, f"{folder}/session")
            nwb = broken + "/session.nwb"
            size = os.path.getsize(nwb)
            os.truncate(nwb, size // 2)
            with self.assertRaisesRegex(dh.Error, "session.nwb is damaged: .*recover"):
                dh.load(broken)["grip_force"]
            shutil.copy(self.lift.folder / "session.nwb", nwb)
            os.truncate(broken + "/raw.log", os.path.getsize(broken + "/raw.log") // 2)
            with self.assertRaisesRegex(dh.Error, "raw.log has [0-9]+ ticks, session.nwb 9501"):
                dh.load(broken).exact("grip_force")

    def test_sessions_and_errors_go_to_other_processes(self):
        self.lift["grip_force"]
        again = pickle.loads(pickle.dumps(self.lift))
        self.assertEqual(again.folder, self.lift.folder)
        for call in (lambda: dh.load("nowhere"), lambda: self.lift["grip"]):
            with self.assertRaises(dh.Error) as caught:
                call()
            sent = pickle.loads(pickle.dumps(caught.exception))
            self.assertEqual((type(sent), str(sent)), (type(caught.exception), str(caught.exception)))

    def test_names_that_look_like_numbers_stay_names(self):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "adaptation.csv").write_text("id,group,trial_num\n001,02,1\n")
            table = dh.read_table(f"{folder}/adaptation.csv")
        self.assertEqual((table.id.item(), table.group.item()), ("001", "02"))

    def test_lists_have_named_columns(self):
        contacts = self.lift["contacts"]
        self.assertEqual(list(contacts.columns[:4]), ["time", "body_a", "body_b", "points"])
        self.assertGreater(contacts.normal_force.max(), 0.9)
        self.assertEqual(len(self.lift["loads"]) if "loads" in self.lift else 0, 0)

    def test_between_cuts_half_open(self):
        self.assertEqual(self.lift.between(0, 0.01), slice(0, 10))
        self.assertEqual(self.lift.between(0.0005, 0.0105), slice(0, 10))
        self.assertEqual(self.lift.between(-1, 1e9), slice(0, len(self.lift.t)))


class Plots(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.session = record("grip-and-lift", cls.folder.name)

    def lines(self, axes):
        return {line.get_label(): line.get_xydata() for line in axes.get_lines() if line.get_label()[0] != "_"}

    def test_a_curve_has_the_record_s_values(self):
        lines = self.lines(self.session.plot("grip_force"))
        np.testing.assert_array_equal(lines["grip_force"][:, 1], self.session["grip_force"])

    def test_a_vector_has_a_curve_for_each_component(self):
        lines = self.lines(self.session.plot("thumb.force_sent"))
        self.assertEqual(list(lines), ["thumb.force_sent.x", "thumb.force_sent.y", "thumb.force_sent.z"])

    def test_aligned_curves_are_means_over_lifts(self):
        session = self.session
        moments = session.lifts.lift_off_s.dropna()
        lines = self.lines(session.plot("load_force", align="lift_off", before=0.1, after=0.1))
        ticks = [round(t / session.tick) for t in moments]
        rows = [session["load_force"][i - 100 : i + 101] for i in ticks]
        self.assertGreater(len(rows), 3)
        np.testing.assert_allclose(lines["load_force"][:, 1], np.mean(rows, axis=0, dtype=float), atol=1e-9)
        self.assertAlmostEqual(lines["load_force"][0, 0], -0.1)

    def test_groups_have_a_mean_each(self):
        by = self.session.plot("grip_force", align="lift_off", by="condition")
        lifted = self.session.lifts.dropna(subset="lift_off_s").merge(self.session.trials, on=["trial_num", "attempt"])
        self.assertEqual(len(self.lines(by)), lifted.condition.nunique())

    def test_what_cannot_be_drawn_is_told(self):
        for names, options, what in [
            ((), {}, "no quantity is given"),
            (("contacts",), {}, "is a list"),
            (("grip_force",), {"by": "condition"}, "requires an alignment"),
            (("grip_force",), {"align": "liftoff"}, "Did you mean 'lift_off'"),
            (("grip_force",), {"align": "condition"}, "is not a moment"),
            (("grip_force",), {"align": "lift_off", "by": "colour"}, "is not a column"),
        ]:
            with self.subTest(what), self.assertRaisesRegex(dh.Error, what):
                self.session.plot(*names, **options)


if __name__ == "__main__":
    unittest.main()
