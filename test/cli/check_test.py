"""`dihaptic check`: what it says about files that are good, bad, or damaged.

Usage: check_test.py PROGRAM, from the project's folder.
"""
import glob
import os
import pathlib
import tempfile
import unittest

from program import SHORT, dihaptic


class Commands(unittest.TestCase):
    def test_check(self):
        files = glob.glob("scenes/*.yaml") + glob.glob("rigs/*.yaml") + glob.glob("experiments/*.yaml")
        files += glob.glob("populations/*.yaml") + glob.glob("studies/*.yaml")
        result = dihaptic("check", *files)
        self.assertEqual(result.returncode, 0, result.stderr)
        with tempfile.TemporaryDirectory() as folder:
            bad = folder + "/bad.yaml"
            pathlib.Path(bad).write_text("bodies:\n  - {name: b, shape: box, size_mm: [1, 1, 1], mass_g: -5}\n")
            result = dihaptic("check", bad, files[0])
            self.assertEqual(result.returncode, 2)
            self.assertIn("bad.yaml:2: error: mass_g: must be positive", result.stdout)
            self.assertIn("not usable", result.stdout)
            self.assertLess(result.stdout.index("mass_g"), result.stdout.index("not usable"))
            self.assertEqual(result.stderr, "")

    def test_check_names_a_line_once_and_shows_no_raw_bytes(self):
        result = dihaptic("check", "movements/reach-to-grasp.csv")
        self.assertRegex(result.stdout, r"reach-to-grasp.csv:\d+: warning: [\d.]+ to")
        self.assertNotIn("(line", result.stdout)
        with tempfile.TemporaryDirectory() as folder:
            junk = folder + "/junk.csv"
            pathlib.Path(junk).write_bytes(bytes(range(256)))
            result = dihaptic("check", junk, folder)
            self.assertEqual(result.returncode, 2)
            self.assertIn("junk.csv: error: is not a text file", result.stdout)
            self.assertIn(folder + ": error: is a folder. Name a file in it.", result.stdout)
            self.assertTrue(result.stdout.replace("\n", "").isprintable())

    def test_the_settings_of_a_rig_are_checked_with_it(self):
        rig = pathlib.Path("rigs/premium-pair.yaml").read_text().split("\nsettings:")[0]
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "rig.yaml")
            for settings, said in [("{ safety: { max_force_N: 3 } }", None), ("{ safety: { max_force_N: -5 } }", "must be positive"),
                                   ("{ safety: { force_N: 0.5 } }", "force_N: is not known here"), ("word", "is not a list of keys"),
                                   ("{ safety: { max_force_N: many } }", "max_force_N")]:
                file.write_text(f"{rig}\nsettings: {settings}\n")
                result = dihaptic("check", str(file))
                self.assertEqual(result.returncode, 2 if said else 0, result.stdout)
                self.assertIn(said or "", result.stdout + result.stderr)

    def test_a_damaged_mesh_ends_in_a_message(self):
        head = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        faces = "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
        good = head + faces + "0 0 0\n40 0 0\n0 40 0\n0 0 40\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"
        damaged = {"index.ply": good.replace("3 1 2 3", "3 1 2 300000000"), "cut.ply": good[:150],
                   "counts.ply": good.replace("vertex 4\n", "vertex 4000000000\n"),
                   "listed.ply": good.replace("property float z", "property list uchar float z"),
                   "binary.ply": good.replace("ascii", "binary_little_endian"),
                   "empty.stl": "", "promises.stl": "\0" * 80 + "\x7f" * 4 + "\0" * 50, "empty.off": "OFF\n4 4 0\n"}
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder, "scene.yaml")
            for name, text in {"good.ply": good, **damaged}.items():
                pathlib.Path(folder, name).write_text(text)
                scene.write_text(SHORT.replace("block.obj", name))
                result = dihaptic("check", str(scene))
                if name == "good.ply":
                    self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
                    continue
                self.assertEqual(result.returncode, 2, name + result.stdout + result.stderr)
                self.assertRegex(result.stdout, r"scene.yaml:3: error: file: .*" + name)
            os.mkfifo(folder + "/pipe.obj")
            scene.write_text(SHORT.replace("block.obj", "pipe.obj"))
            self.assertIn("is not a file, but a pipe, a socket or a device", dihaptic("check", str(scene)).stdout)


if __name__ == "__main__":
    unittest.main(verbosity=2)
