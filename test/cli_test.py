"""The program as its user meets it: commands, messages, interruptions, kills, full disks.

Usage: cli_test.py PROGRAM, from the project's folder.
"""
import csv
import glob
import json
import os
import pathlib
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = sys.argv.pop(1) if len(sys.argv) > 1 else "build/release/dihaptic"


def dihaptic(*arguments, **options):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=300, **options)


def session_of(out):
    """The only session's folder in `out`."""
    (folder,) = glob.glob(out + "/*/")
    return folder


class Commands(unittest.TestCase):
    def test_every_command_has_help_with_an_example(self):
        commands = [[], ["run"], ["replay"], ["recover"], ["check"], ["bench"], ["bench", "grasp"], ["bench", "friction"],
                    ["bench", "scale"]]
        for command in commands:
            result = dihaptic(*command, "--help")
            self.assertEqual(result.returncode, 0, command)
            self.assertIn("Example", result.stdout, command)
            self.assertIn("dihaptic", result.stdout, command)

    def test_version(self):
        self.assertRegex(dihaptic("--version").stdout, r"^dihaptic \d+\.\d+\.\d+\n$")

    def test_wrong_use_fails_and_says_how(self):
        for arguments in [["fly"], ["rnu"], ["run"], ["run", "scenes/block-on-table.yaml", "--clock", "sundial"], []]:
            result = dihaptic(*arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertIn("--help", result.stderr, arguments)

    def test_an_unknown_command_is_named(self):
        self.assertIn("error: 'foo' is no command. There are run, replay", dihaptic("foo").stderr)
        self.assertIn("Did you mean check? See dihaptic --help.", dihaptic("chekc", "x").stderr)

    def test_numbers_of_options_have_ranges(self):
        for rate in ["nan", "0", "-1", "1e9", "fast"]:
            for command in [["run", "scenes/block-on-table.yaml"], ["bench", "grasp"]]:
                result = dihaptic(*command, f"--rate={rate}")
                self.assertEqual(result.returncode, 2, rate)
                self.assertIn(f"--rate: must be a number from 100 to 10000, is '{rate}'", result.stderr)
        for seed in ["-1", "1.5", "99999999999999999999999"]:
            result = dihaptic("run", "scenes/block-on-table.yaml", "--seed", seed)
            self.assertEqual(result.returncode, 2, seed)
            self.assertIn(f"--seed: must be a whole number from 0 to 18446744073709551615, is '{seed}'", result.stderr)

    def test_a_simulation_that_diverges_is_told_and_fails(self):
        with tempfile.TemporaryDirectory() as out:
            result = dihaptic("run", "scenes/block-on-table.yaml", "--out", out, "--coupling", "dual_spring",
                              "--set", "coupling.stiffness_N_m=1e6", "--set", "coupling.body_mass_g=0.0001")
            self.assertEqual(result.returncode, 1, result.stdout)
            self.assertRegex(result.stdout, r"WARNING: in \d+ of \d+ ticks the simulation diverged")
            self.assertIn("diverged", pathlib.Path(session_of(out) + "trials.csv").read_text())

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
                         "trials.csv", "phases.csv", "events.csv"]:
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
            # b: the index was seen in one line of twelve
            thin = [line if i % 12 < 2 else ",".join(line.split(",")[:4] + [""] * 3 + ["0"]) for i, line in enumerate(lines)]
            late = lines[:-1] + ["1e303" + lines[-1][lines[-1].index(","):]]
            for name, content in [("a", text), ("b", "\n".join(thin)), ("broken", text.replace("0.000,", "x,", 1)),
                                  ("late", "\n".join(late))]:
                pathlib.Path(f"{folder}/{name}.csv").write_text(content)
            out = folder + "/out"
            result = dihaptic("run", "experiments/reach-to-grasp.yaml", "--movement", folder, "--out", out)
            self.assertEqual(result.returncode, 1)
            self.assertIn("broken.csv:2: error: time_ms: 'x' is not a number", result.stderr)
            self.assertRegex(result.stderr, r"late.csv:\d+: error: time_ms: time jumps from")
            self.assertIn("4 movements, 2 refused", result.stdout)
            self.assertRegex(result.stdout, r"b.csv +[\d.]+ +[\d.]+ %! ")
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
                process.stdout.readline()  # the head, and two movements
            process.kill()
            process.communicate()
            self.assertGreaterEqual(len(pathlib.Path(out + "/summary.csv").read_text().splitlines()), 2)

    def test_check(self):
        files = glob.glob("scenes/*.yaml") + glob.glob("rigs/*.yaml") + glob.glob("experiments/*.yaml")
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

    def test_bad_input_fails_with_file_and_remedy(self):
        for arguments in [["run", "gone.yaml"], ["run", "README.md"], ["replay", "/tmp"], ["recover", "/nowhere"],
                          ["run", "scenes/block-on-table.yaml", "--rig", "gone.yaml"],
                          ["run", "scenes/block-on-table.yaml", "--solver", "magic"],
                          ["run", "scenes/block-on-table.yaml", "--out", "/proc/nowhere"]]:
            result = dihaptic(*arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertIn("error:", result.stderr, arguments)
            self.assertNotIn("report this", result.stderr, arguments)

    def test_bench_json_is_one_object_and_nothing_else(self):
        result = dihaptic("bench", "scale", "--extra", "0", "--json")
        figures = json.loads(result.stdout)
        self.assertEqual(set(figures["tick"][0]), {"extra", "awake", "asleep", "bullet_us"})
        self.assertEqual(set(figures["tick"][0]["awake"]), {"median_us", "p99_us", "max_us"})


class Interruptions(unittest.TestCase):
    def start(self, out, *arguments, **options):
        return subprocess.Popen([PROGRAM, "run", "experiments/lift-block.yaml", "--out", out, *arguments],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options)

    def wait_for_log(self, out, size):
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline:
            logs = glob.glob(out + "/*/raw.log")
            if logs and os.path.getsize(logs[0]) > size:
                return os.path.getsize(logs[0])
            time.sleep(0.001)
        self.fail("no log")

    def frames_of(self, text):
        return int(text.split(" frames")[0].split()[-1])

    def test_ctrl_c_ends_in_order(self):
        with tempfile.TemporaryDirectory() as out:
            process = self.start(out, "--clock", "real")
            self.wait_for_log(out, 300000)
            process.send_signal(signal.SIGINT)
            stdout, stderr = process.communicate(timeout=60)
            self.assertEqual(process.returncode, 1, stderr)
            self.assertIn("interrupted", stdout)
            folder = session_of(out)
            self.assertTrue(os.path.exists(folder + "session.nwb"))
            self.assertIn("state: interrupted", pathlib.Path(folder + "session.yaml").read_text())
            self.assertIn("interrupted", pathlib.Path(folder + "trials.csv").read_text())

    def test_kill_loses_at_most_a_tenth_of_a_second(self):
        with tempfile.TemporaryDirectory() as out:
            process = self.start(out, "--clock", "real")
            # the log as it stands, and when: from there on real time counts the frames
            self.wait_for_log(out, 100000)
            folder = session_of(out)
            snapshot = pathlib.Path(folder + "raw.log").read_bytes()
            seen_at = time.monotonic()
            time.sleep(1.5)
            process.kill()
            killed_at = time.monotonic()
            process.communicate()
            self.assertIn("state: running", pathlib.Path(folder + "session.yaml").read_text())

            result = dihaptic("recover", folder)
            self.assertEqual(result.returncode, 0, result.stderr)
            recovered = self.frames_of(result.stdout)
            pathlib.Path(folder + "raw.log").write_bytes(snapshot)
            before = self.frames_of(dihaptic("recover", folder).stdout)
            ticks = before + (killed_at - seen_at) * 1000
            self.assertGreater(recovered, ticks - 100 - 50)  # 50 ms for this script's own waits
            self.assertTrue(os.path.exists(folder + "session.nwb"))

    def test_killed_anywhere_it_recovers_and_replays(self):
        random.seed(1)
        for _ in range(int(os.environ.get("DIHAPTIC_KILLS", 8))):
            with tempfile.TemporaryDirectory() as out:
                process = self.start(out)
                self.wait_for_log(out, random.randint(50_000, 9_000_000))
                process.kill()
                process.communicate()
                folder = session_of(out)
                recovered = dihaptic("recover", folder)
                self.assertEqual(recovered.returncode, 0, recovered.stderr)
                self.assertGreater(self.frames_of(recovered.stdout), 0)
                self.assertIn("state: recovered", pathlib.Path(folder + "session.yaml").read_text())
                replayed = dihaptic("replay", folder)
                self.assertEqual(replayed.returncode, 0, replayed.stdout)

    def test_a_full_disk_is_told_and_what_was_written_is_kept(self):
        def small_disk():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (500_000, 500_000))

        with tempfile.TemporaryDirectory() as out:
            process = self.start(out, preexec_fn=small_disk)
            _, stderr = process.communicate(timeout=60)
            self.assertEqual(process.returncode, 2)
            self.assertIn("raw.log: error: cannot be written", stderr)
            self.assertIn("dihaptic recover", stderr)
            recovered = dihaptic("recover", session_of(out))
            self.assertEqual(recovered.returncode, 0, recovered.stderr)
            self.assertGreater(self.frames_of(recovered.stdout), 300)


if __name__ == "__main__":
    unittest.main(verbosity=2)
