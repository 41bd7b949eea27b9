"""Sessions in which something is damaged, changed or lost.

Usage: damage_test.py PROGRAM, from the project's folder.
"""
import os
import pathlib
import random
import re
import tempfile
import unittest

from program import MADE, SHORT, dihaptic, session_of, with_largest_file

import soak  # program.py adds its folder to the path

BLOCK = "v 0 0 0\nv 40 0 0\nv 0 40 0\nv 0 0 40\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
TICKS = 201


class Damage(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        pathlib.Path(folder.name + "/block.obj").write_text(BLOCK)
        pathlib.Path(folder.name + "/short.yaml").write_text(SHORT)
        self.out = folder.name + "/out"
        result = dihaptic("run", folder.name + "/short.yaml", "--out", self.out, "--participant", "S07")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.folder = session_of(self.out)
        self.assertIn("state: complete", self.read("session.yaml"))

    def read(self, name):
        return pathlib.Path(self.folder + name).read_text()

    def flip(self, name, share):
        path = pathlib.Path(self.folder + name)
        data = bytearray(path.read_bytes())
        data[int(len(data) * share)] ^= 1
        path.write_bytes(data)

    def test_a_damaged_chunk_costs_its_ticks_alone_and_is_told(self):
        self.flip("raw.log", 0.7)
        was = {name: pathlib.Path(self.folder + name).read_bytes() for name in MADE}
        gap = "50 ticks missing from tick 100 on, between 0.099 s and 0.150 s"

        replayed = dihaptic("replay", self.folder)
        self.assertEqual(replayed.returncode, 1)
        self.assertIn(gap, replayed.stdout)
        self.assertIn("the first 100 ticks", replayed.stdout)

        refused = dihaptic("recover", self.folder)
        self.assertEqual(refused.returncode, 2)
        self.assertIn(f"session.nwb: error: contains more than the log now yields: {TICKS} ticks", refused.stderr)
        self.assertIn("first move it away", refused.stderr)
        self.assertIn(gap, refused.stderr)
        self.assertEqual(was, {name: pathlib.Path(self.folder + name).read_bytes() for name in MADE})
        self.assertIn("state: complete", self.read("session.yaml"))

        os.rename(self.folder + "session.nwb", self.folder + "longer.nwb")
        recovered = dihaptic("recover", self.folder)
        self.assertEqual(recovered.returncode, 0, recovered.stderr)
        self.assertIn(f"{TICKS - 50} frames", recovered.stdout)
        self.assertIn(gap, recovered.stdout)
        self.assertIn("state: recovered", self.read("session.yaml"))
        self.assertIn("50 ticks missing", self.read("session.yaml"))
        self.assertEqual(dihaptic("replay", self.folder).returncode, 1)

    @soak.alone
    def test_a_log_that_was_cut_is_told_and_longer_tables_are_kept(self):
        os.truncate(self.folder + "raw.log", os.path.getsize(self.folder + "raw.log") * 78 // 100)
        lost = f"{TICKS - 100} ticks missing at the end, after 0.099 s: the session had {TICKS} ticks"
        replayed = dihaptic("replay", self.folder)
        self.assertEqual(replayed.returncode, 1)
        self.assertIn(lost, replayed.stdout)
        held = re.search(r"an unfinished chunk, of about (\d+) ticks", replayed.stdout)
        self.assertAlmostEqual(int(held[1]), 50, delta=10)
        os.remove(self.folder + "session.nwb")
        refused = dihaptic("recover", self.folder)
        self.assertEqual(refused.returncode, 2)
        for name in ["trials.csv", "phases.csv", "events.csv"]:
            self.assertIn(name + ": error: contains more than the log now yields", refused.stderr)
            os.remove(self.folder + name)
        recovered = dihaptic("recover", self.folder)
        self.assertEqual(recovered.returncode, 0, recovered.stderr)
        self.assertIn(lost, recovered.stdout)
        self.assertIn("interrupted", self.read("trials.csv"))

    def test_only_the_log_is_needed_and_nothing_that_is_cut_crashes(self):
        random.seed(2)
        names = [name for name in os.listdir(self.folder)]
        self.assertEqual(len(names), 13, names)
        whole = {name: pathlib.Path(self.folder + name).read_bytes() for name in names}
        inputs = ["scene.yaml", "rig.yaml", "settings.yaml", "mesh-1-block.obj"]
        for name in names:
            size = len(whole[name])
            everywhere = {0, 1, size - 1, *range(100, min(size, 151), 10), *(random.randrange(size) for _ in range(9))}
            for length in soak.of([random.choice([None, 0, random.randrange(size)])], [None, *sorted(everywhere)]):
                for other, data in whole.items():
                    pathlib.Path(self.folder + other).write_bytes(data)
                pathlib.Path(self.folder + name).unlink() if length is None else os.truncate(self.folder + name, length)
                where = f"{name} cut to {length}"
                replayed = dihaptic("replay", self.folder)
                for made in MADE:
                    if os.path.exists(self.folder + made) and name == "raw.log":
                        os.remove(self.folder + made)
                recovered = dihaptic("recover", self.folder)
                for result in [replayed, recovered]:
                    self.assertIn(result.returncode, [0, 1, 2], where + result.stderr)
                    self.assertNotIn("report this", result.stderr, where)
                if name == "raw.log":
                    self.assertNotEqual(replayed.returncode, 0, where)
                    continue
                self.assertEqual(replayed.returncode, 2 if name in inputs else 0, where + replayed.stderr)
                self.assertEqual(recovered.returncode, 0, where + recovered.stderr)
                self.assertIn(f"{TICKS} frames", recovered.stdout, where)
                self.assertIn("the log is complete", recovered.stdout, where)
                if name in inputs + ["session.yaml", "settings.csv"]:
                    self.assertIn(f"/{name}: warning:", recovered.stderr, where)
                for made in MADE:
                    self.assertGreater(os.path.getsize(self.folder + made), 0, where)
                self.assertTrue(self.read("session.yaml").endswith("...\n"), where)
                if name in ["session.yaml", "settings.csv"]:
                    again = dihaptic("recover", self.folder)  # it is mended now
                    self.assertEqual(again.stderr.count("warning"), 0, where + again.stderr)

    @soak.alone
    def test_changed_inputs_are_named(self):
        with open(self.folder + "rig.yaml", "a") as rig:
            rig.write("# moved a little\n")
        replayed = dihaptic("replay", self.folder)
        self.assertEqual(replayed.returncode, 2)
        self.assertIn("rig.yaml: error: has changed since the session was recorded", replayed.stderr)
        recovered = dihaptic("recover", self.folder)
        self.assertEqual(recovered.returncode, 0, recovered.stderr)
        self.assertIn("rig.yaml: warning: has changed since", recovered.stderr)

    def test_a_session_is_complete_only_with_all_of_its_files(self):
        sizes = [os.path.getsize(self.folder + name) for name in ["raw.log", "session.nwb"]]
        self.assertLess(*sizes)  # so a limit between the sizes allows only the log
        out = self.out + "/full"
        result = dihaptic("run", self.out + "/../short.yaml", "--out", out, preexec_fn=with_largest_file(sum(sizes) // 2))
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("session.nwb: error: cannot be written", result.stderr)
        folder = session_of(out)
        self.assertIn("state: running", pathlib.Path(folder + "session.yaml").read_text())
        # the tables are there all the same
        tables = {"trials.csv", "phases.csv", "events.csv", "episodes.csv", "lifts.csv"}
        self.assertEqual(set(os.listdir(folder)), set(os.listdir(self.folder)) - (set(MADE) - tables))
        recovered = dihaptic("recover", folder)
        self.assertEqual(recovered.returncode, 0, recovered.stderr)
        self.assertIn(f"{TICKS} frames", recovered.stdout)

    @soak.alone
    def test_replay_goes_to_100_percent(self):
        self.assertIn("100 %", dihaptic("replay", self.folder).stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
