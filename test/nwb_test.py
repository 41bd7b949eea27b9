"""session.nwb, read as a user would: with h5py, without this program.

Usage: nwb_test.py PROGRAM, from the project's folder.
"""
import datetime
import glob
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np

try:
    import pynwb
except ImportError:  # Debian has no package of it; its validator is also run where it is installed
    pynwb = None

STUDY = """study:
  experimenters: ["Doe, J.", "Roe, R."]
  institution: University
  lab: Hands
  keywords: [grip, load]
"""

PROGRAM = sys.argv.pop(1) if len(sys.argv) > 1 else "build/release/dihaptic"


class Nwb(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        experiment = pathlib.Path(cls.folder.name, "lift-block.yaml")
        experiment.write_text(pathlib.Path("experiments/lift-block.yaml").read_text().replace("../", os.getcwd() + "/").replace(
            "title: ", "title: Lift, hold; ", 1) + STUDY)
        subprocess.run([PROGRAM, "run", str(experiment), "--out", cls.folder.name, "--participant", "S07",
                        "--set", "coupling.stiffness_N_m=900"], check=True, capture_output=True)
        (name,) = glob.glob(cls.folder.name + "/*/session.nwb")
        cls.file = h5py.File(name, "r")

    @classmethod
    def tearDownClass(cls):
        cls.file.close()
        cls.folder.cleanup()

    def text(self, path):
        return self.file[path].asstr()[()]

    def test_root_has_what_the_schema_wants(self):
        self.assertEqual(self.file.attrs["namespace"], "core")
        self.assertEqual(self.file.attrs["neurodata_type"], "NWBFile")
        self.assertRegex(self.file.attrs["nwb_version"], r"^2\.")
        self.assertEqual(len(self.file.attrs["object_id"]), 36)
        for name in ["identifier", "session_description", "session_start_time", "timestamps_reference_time", "file_create_date"]:
            self.assertIn(name, self.file)
        for name in ["acquisition", "analysis", "processing", "stimulus/presentation", "stimulus/templates", "general"]:
            self.assertIsInstance(self.file[name], h5py.Group, name)
        started = datetime.datetime.fromisoformat(self.text("session_start_time"))
        self.assertIsNotNone(started.utcoffset())
        self.assertLess(abs((datetime.datetime.now(started.tzinfo) - started).total_seconds()), 600)
        self.assertEqual(self.file["file_create_date"].shape, (1,))

    def test_every_object_has_type_namespace_and_an_id_of_its_own(self):
        ids = []

        def visit(name, item):
            if "neurodata_type" in item.attrs:
                self.assertIn(item.attrs["namespace"], ["core", "hdmf-common"], name)
                ids.append(item.attrs["object_id"])

        self.file.visititems(visit)
        self.assertGreater(len(ids), 30)
        self.assertEqual(len(ids), len(set(ids)))

    def test_series_have_units_and_one_row_a_tick(self):
        ticks = len(self.file["acquisition/grip_force/data"])
        self.assertEqual(ticks, 9501)
        for name, series in self.file["acquisition"].items():
            if name == "contacts":
                continue
            data = series["data"]
            self.assertEqual(data.shape[0], ticks, name)
            self.assertIn("unit", data.attrs, name)
            self.assertTrue(series.attrs["description"], name)
            self.assertEqual(series["starting_time"][()], 0, name)
            self.assertEqual(series["starting_time"].attrs["rate"], 1000, name)
            self.assertEqual(series["starting_time"].attrs["unit"], "seconds", name)
            self.assertIsNotNone(data.compression, name)
        for finger in ["thumb", "index"]:
            for what in ["handle_position", "proxy_position"]:
                position = self.file[f"acquisition/{finger}_{what}"]
                self.assertEqual(position.attrs["neurodata_type"], "SpatialSeries")
                self.assertEqual(position["data"].shape[1], 3)
                self.assertEqual(position["data"].attrs["unit"], "meters")
                self.assertIn("z up", position["reference_frame"].asstr()[()])
            self.assertEqual(self.file[f"acquisition/{finger}_force_sent/data"].attrs["unit"], "newtons")

    @unittest.skipUnless(pynwb, "needs pynwb")
    def test_pynwb_reads_it_and_finds_no_error(self):
        errors, _ = pynwb.validate(paths=[self.file.filename], use_cached_namespaces=False)
        self.assertEqual(errors, [])
        with pynwb.NWBHDF5IO(self.file.filename, "r") as nwb:
            self.assertEqual(nwb.read().subject.subject_id, "S07")

    def test_time_runs_along_the_rows(self):
        """The rules of NWB Inspector that are critical or of best practice, over every object of sessions of both kinds."""
        def look(name, item):
            kind = item.attrs.get("neurodata_type", "")
            if kind in ("TimeSeries", "SpatialSeries"):
                shape = item["data"].shape
                self.assertGreaterEqual(shape[0], max(shape[1:], default=0), f"{name}: time is the longest dimension")
                self.assertNotEqual("timestamps" in item, "starting_time" in item, name)
                if "timestamps" in item:
                    self.assertEqual(len(item["timestamps"]), shape[0], name)
                    self.assertTrue(np.all(np.diff(item["timestamps"][:]) > 0), f"{name}: times ascend")
                else:
                    self.assertGreater(item["starting_time"].attrs["rate"], 0, name)
                self.assertTrue(item["data"].attrs["unit"], name)
            elif kind in ("DynamicTable", "TimeIntervals"):
                rows = len(item["id"])
                self.assertGreater(len(item.attrs["colnames"]), 0, name)
                for column in item.attrs["colnames"]:
                    self.assertEqual(item[column].shape, (rows,), f"{name}/{column}")
                    self.assertEqual(item[column].attrs["neurodata_type"], "VectorData")
                    self.assertTrue(item[column].attrs["description"], f"{name}/{column}")
                if kind == "TimeIntervals":
                    self.assertTrue(np.all(np.diff(item["start_time"][:]) >= 0), f"{name}: times ascend")
                    self.assertTrue(np.all(item["stop_time"][:] >= item["start_time"][:]), name)
                elif "time" in item.attrs["colnames"]:
                    self.assertTrue(np.all(np.diff(item["time"][:]) >= 0), f"{name}: times ascend")

        for name in ("first-trials", "unexpected-weight", "bimanual-bar", "turn-block"):
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                subprocess.run([PROGRAM, "run", f"experiments/{name}.yaml", "--simulate", "--out", folder], check=True, capture_output=True)
                (session,) = glob.glob(folder + "/*/session.nwb")
                with h5py.File(session) as file:
                    file.visititems(look)

    def test_contacts_have_times_that_never_go_back(self):
        contacts = self.file["acquisition/contacts"]
        self.assertEqual(contacts.attrs["neurodata_type"], "DynamicTable")
        self.assertEqual(len(contacts.attrs["colnames"]), 15)
        self.assertTrue(np.all(np.diff(contacts["time"][:]) >= 0))
        self.assertTrue(np.issubdtype(contacts["body_a"].dtype, np.integer))

    def test_the_physics_is_in_it(self):
        hold = slice(4500, 7400)
        height = self.file["acquisition/block_position/data"][hold, 2]
        self.assertGreater(height.min(), 0.115)
        down = -(self.file["acquisition/thumb_force_sent/data"][hold, 2] + self.file["acquisition/index_force_sent/data"][hold, 2])
        self.assertAlmostEqual(down.mean() / (0.1 * 9.81), 1, delta=0.005)
        orientation = self.file["acquisition/block_orientation/data"][hold]
        self.assertTrue(np.allclose(np.linalg.norm(orientation, axis=1), 1))
        self.assertTrue(np.allclose(orientation[:, 0], 1, atol=1e-3))  # w first

    def test_tables(self):
        for name, columns in {"trials": ["start_time", "stop_time", "outcome"], "phases": ["start_time", "stop_time", "phase", "mean_grip_N"], "events": ["start_time", "stop_time", "event", "detail", "shown_s"]}.items():
            table = self.file["intervals/" + name]
            self.assertEqual(table.attrs["neurodata_type"], "TimeIntervals")
            self.assertEqual(table["id"].attrs["neurodata_type"], "ElementIdentifiers")
            for column in columns:
                self.assertIn(column, list(table.attrs["colnames"]))
            for column in table.attrs["colnames"]:
                self.assertEqual(len(table[column]), len(table["id"]))
                self.assertTrue(table[column].attrs["description"])
            moments = name == "events"
            self.assertTrue(np.all((table["stop_time"][:] - table["start_time"][:] > 0) != moments))
        self.assertEqual(self.file["intervals/trials/outcome"].asstr()[0], "done")
        self.assertEqual(self.file["intervals/phases/phase"].asstr()[3], "hold")
        self.assertIn("lift-off", list(self.file["intervals/events/event"].asstr()))
        self.assertTrue(np.all(np.isnan(self.file["intervals/events/shown_s"][:])))  # there was no screen

    def test_settings_with_their_origins_are_inside(self):
        table = self.file["scratch/settings"]
        rows = dict(zip(table["setting"].asstr()[:], zip(table["value"].asstr()[:], table["origin"].asstr()[:])))
        self.assertEqual(rows["coupling.stiffness_N_m"], ("900", "command line"))
        self.assertEqual(rows["rate_Hz"], ("1000", "default"))

    def test_names_are_inside_in_order(self):
        table = self.file["scratch/items"]
        rows = list(zip(table["list"].asstr()[:], table["name"].asstr()[:]))
        self.assertEqual([name for of, name in rows if of == "fingers"], ["thumb", "index"])
        self.assertEqual([name for of, name in rows if of == "bodies"], ["table", "block"])

    def test_text_is_text_and_counts_are_whole_numbers(self):
        trials = self.file["intervals/trials"]
        self.assertEqual(trials["experiment"].asstr()[0], self.text("session_description"))
        self.assertIn(",", trials["experiment"].asstr()[0])
        self.assertNotIn('"', trials["experiment"].asstr()[0])
        for name in ["trial_num", "session_num", "block_num"]:
            self.assertTrue(np.issubdtype(trials[name].dtype, np.integer), name)
        for name in ["trial", "phase", "status", "sequence", "solver", "marker", "thumb_buttons", "block_awake"]:
            self.assertTrue(np.issubdtype(self.file[f"acquisition/{name}/data"].dtype, np.integer), name)

    def test_codes_are_explained(self):
        for name, meaning in {"phase": "3: hold", "status": "2: a force or a torque was cut", "solver": "3: newton", "coupling": "0: implicit",
                              "outcome": "-1: none", "message": "-1: none", "thumb_status": "2: a force or a torque was cut"}.items():
            self.assertIn(meaning, self.file["acquisition/" + name].attrs["description"], name)

    def test_descriptions_are_those_of_the_quantities(self):
        self.assertEqual(self.file["acquisition/thumb_force_sent"].attrs["description"],
                         "thumb: Force on the handle, as sent to the device. In the world's axes.")
        self.assertEqual(self.file["acquisition/contacts/gap"].attrs["description"],
                         "Smallest distance; negative: penetration. [m]")

    def test_axes_are_those_of_the_data(self):
        for finger in ["thumb", "index"]:
            device = self.file[f"acquisition/{finger}_device_position"]
            self.assertTrue(device["reference_frame"].asstr()[()].startswith("Device:"))
            handle = self.file[f"acquisition/{finger}_handle_position"]
            self.assertTrue(handle["reference_frame"].asstr()[()].startswith("World:"))
            self.assertFalse(np.allclose(device["data"][100], handle["data"][100], atol=1e-3))
            self.assertIn("device's axes", self.file[f"acquisition/{finger}_device_velocity"].attrs["description"])
            self.assertIn("world's axes", self.file[f"acquisition/{finger}_force_sent"].attrs["description"])

    def test_who_did_it_and_where(self):
        general = self.file["general"]
        self.assertEqual(self.text("general/session_id"), pathlib.Path(self.file.filename).parent.name)
        self.assertEqual(list(general["experimenter"].asstr()), ["Doe, J.", "Roe, R."])
        self.assertEqual(self.text("general/institution"), "University")
        self.assertEqual(self.text("general/lab"), "Hands")
        self.assertEqual(list(general["keywords"].asstr()), ["grip", "load"])

    def test_subject_and_devices(self):
        self.assertEqual(self.text("general/subject/subject_id"), "S07")
        # a script has no species
        self.assertNotIn("species", self.file["general/subject"])
        self.assertTrue(self.text("general/subject/description").startswith("Simulated: the file's script moved the hand."))
        self.assertEqual("simulated Premium 1.0", self.file["general/devices/thumb"].attrs["description"])


if __name__ == "__main__":
    unittest.main(verbosity=2)
