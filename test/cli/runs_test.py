"""`dihaptic run`: its figures and files, faults, replays, batches of movements.

Usage: runs_test.py PROGRAM, from the project's folder.
"""
import csv
import glob
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

from program import PROGRAM, dihaptic, session_of


class Commands(unittest.TestCase):
    def test_a_simulation_that_diverges_is_told_and_fails(self):
        with tempfile.TemporaryDirectory() as out:
            result = dihaptic("run", "scenes/block-on-table.yaml", "--out", out, "--coupling", "dual_spring",
                              "--set", "coupling.stiffness_N_m=1e5", "--set", "coupling.body_mass_g=0.1")
            self.assertEqual(result.returncode, 1, result.stdout)
            self.assertRegex(result.stdout, r"WARNING: in \d+ of \d+ ticks the simulation diverged")
            self.assertIn("diverged", pathlib.Path(session_of(out) + "trials.csv").read_text())

    def test_a_fault_is_told_and_kept_and_replayed(self):
        with tempfile.TemporaryDirectory() as out:
            result = dihaptic("run", "scenes/block-on-table.yaml", "--out", out, "--set", "safety.max_speed_m_s=0.01")
            self.assertEqual(result.returncode, 1, result.stdout)
            told = (r"force has been off since 0\.\d+ s: the (thumb|index)'s device \(simulated device\) "
                    r"moved at 0\.01\d* m/s, "
                    r"but only 0\.01 m/s are allowed\. .* raise settings: safety: max_speed_m_s")
            self.assertRegex(result.stdout, "WARNING: " + told)
            folder = session_of(out)
            self.assertIn("force has been off since", pathlib.Path(folder + "session.yaml").read_text())
            self.assertIn("force off", pathlib.Path(folder + "trials.csv").read_text())
            self.assertIn("The last second before the fault is in fault.csv.", result.stdout)
            with open(folder + "fault.csv") as file:
                rows = list(csv.DictReader(file))
            self.assertIn("moved faster than allowed", rows[-1]["status"])
            self.assertIn(f"force has been off since {float(rows[-1]['time_s']):.3f} s", result.stdout)
            self.assertLessEqual(float(rows[-1]["time_s"]) - float(rows[0]["time_s"]), 1)
            fault = pathlib.Path(folder + "fault.csv").read_text()
            os.remove(folder + "fault.csv")
            self.assertEqual(dihaptic("recover", folder).returncode, 0)
            self.assertEqual(pathlib.Path(folder + "fault.csv").read_text(), fault)
            replay = dihaptic("replay", folder)
            self.assertEqual(replay.returncode, 0, replay.stdout + replay.stderr)

    def test_run_prints_figures_and_the_folder_and_leaves_all_files(self):
        with tempfile.TemporaryDirectory() as out:
            result = dihaptic("run", "scenes/block-on-table.yaml", "--out", out, "--participant", "S07", "--seed", "3")
            self.assertEqual(result.returncode, 0, result.stderr)
            for word in ["hold", "grip", "load", "slip", "weight", "tick", "times real time"]:
                self.assertIn(word, result.stdout)
            folder = session_of(out)
            self.assertIn(folder.rstrip("/"), result.stdout)
            self.assertIn("S07", folder)
            for name in ["session.yaml", "scene.yaml", "rig.yaml", "settings.yaml", "settings.csv", "raw.log", "session.nwb",
                         "trials.csv", "phases.csv", "episodes.csv", "lifts.csv", "events.csv"]:
                self.assertTrue(os.path.exists(folder + name), name)
            self.assertIn("S07", pathlib.Path(folder + "trials.csv").read_text())
            self.assertFalse(glob.glob(folder + "*.part"))

    def test_replay_finds_nothing_different(self):
        with tempfile.TemporaryDirectory() as out:
            dihaptic("run", "scenes/push-block.yaml", "--out", out)
            result = dihaptic("replay", session_of(out))
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("identical to the bit", result.stdout)

    def test_a_folder_of_movements_runs_as_a_batch(self):
        with tempfile.TemporaryDirectory() as folder:
            text = pathlib.Path("movements/reach-to-grasp.csv").read_text()
            lines = text.splitlines()
            # in b, the index finger was seen in few lines
            thin = [line if i % 12 < 2 else ",".join(line.split(",")[:4] + [""] * 3 + ["0"]) for i, line in enumerate(lines)]
            late = lines[:-1] + ["1e303" + lines[-1][lines[-1].index(","):]]
            for name, content in [("a.csv", text), ("b.tsv", "\n".join(thin)), ("broken.csv", text.replace("0.000,", "x,", 1)),
                                  ("late.csv", "\n".join(late))]:
                pathlib.Path(folder, name).write_text(content)
            out = folder + "/out"
            result = dihaptic("run", "experiments/reach-to-grasp.yaml", "--movement", folder, "--out", out)
            self.assertEqual(result.returncode, 1)
            self.assertIn("broken.csv:2: error: time_ms: 'x' is not a number", result.stderr)
            self.assertRegex(result.stderr, r"late.csv:\d+: error: time_ms: time jumps from")
            self.assertIn("4 movements, 2 refused", result.stdout)
            self.assertRegex(result.stdout, r"b.tsv +[\d.]+ +[\d.]+ %! ")
            with open(out + "/summary.csv") as file:
                rows = list(csv.DictReader(file))
            self.assertEqual([row["outcome"] for row in rows], ["done", "done", "refused", "refused"])
            self.assertEqual([row["mostly_bridged"] for row in rows], ["no", "yes", "", ""])
            with open(rows[0]["session"] + "/phases.csv") as file:
                (grasp,) = [row for row in csv.DictReader(file) if row["phase"] == "grasp"]
            self.assertEqual(rows[0]["grasp_mean_grip_N"], grasp["mean_grip_N"])
            self.assertEqual(rows[0]["grasp_peak_grip_N"], grasp["peak_grip_N"])

    def test_a_batch_that_is_killed_keeps_the_rows_of_what_was_done(self):
        with tempfile.TemporaryDirectory() as folder:
            for i in range(40):
                shutil.copy("movements/reach-to-grasp.csv", f"{folder}/{i:02d}.csv")
            out = folder + "/out"
            process = subprocess.Popen([PROGRAM, "run", "experiments/reach-to-grasp.yaml", "--movement", folder, "--out", out],
                                       stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            for _ in range(3):
                process.stdout.readline()  # reads the head, and two movements
            process.kill()
            process.communicate()
            self.assertGreaterEqual(len(pathlib.Path(out + "/summary.csv").read_text().splitlines()), 2)


if __name__ == "__main__":
    unittest.main(verbosity=2)
