"""The program as its user meets it: commands, messages, interruptions, kills, full disks.

Usage: cli_test.py PROGRAM, from the project's folder.
"""
import glob
import json
import os
import pathlib
import random
import resource
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
        for arguments in [["fly"], ["run"], ["run", "scenes/block-on-table.yaml", "--clock", "sundial"], []]:
            result = dihaptic(*arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertIn("--help", result.stderr, arguments)

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
            for name in ["a.csv", "b.csv"]:
                pathlib.Path(f"{folder}/{name}").write_text(text)
            pathlib.Path(f"{folder}/broken.csv").write_text(text.replace("0.000,", "x,", 1))
            out = folder + "/out"
            result = dihaptic("run", "experiments/reach-to-grasp.yaml", "--movement", folder, "--out", out)
            self.assertEqual(result.returncode, 1)
            self.assertIn("broken.csv:2: error: time: 'x' is not a number", result.stderr)
            self.assertIn("3 movements, 1 refused", result.stdout)
            rows = pathlib.Path(out + "/summary.csv").read_text().splitlines()
            self.assertEqual(len(rows), 4)
            self.assertIn("refused", rows[3])

    def test_check(self):
        files = glob.glob("scenes/*.yaml") + glob.glob("rigs/*.yaml") + glob.glob("experiments/*.yaml")
        result = dihaptic("check", *files)
        self.assertEqual(result.returncode, 0, result.stderr)
        with tempfile.TemporaryDirectory() as folder:
            bad = folder + "/bad.yaml"
            pathlib.Path(bad).write_text("bodies:\n  - {name: b, shape: box, size_mm: [1, 1, 1], mass_g: -5}\n")
            result = dihaptic("check", bad, files[0])
            self.assertEqual(result.returncode, 2)
            self.assertIn("bad.yaml:2: error: mass_g: must be positive", result.stderr)
            self.assertIn("not usable", result.stdout)

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
