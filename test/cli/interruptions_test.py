"""Sessions that are interrupted, killed, or find the disk full. The soak kills more of them.

Usage: interruptions_test.py PROGRAM, from the project's folder.
"""
import fcntl
import glob
import os
import pathlib
import pty
import random
import re
import resource
import shutil
import signal
import subprocess
import tempfile
import termios
import time
import unittest

from program import MADE, PROGRAM, SLOWNESS, dihaptic, patient, session_of, wait_for_log, with_largest_file
import soak  # program.py adds its folder to the path

REAL_CLOCK = ["--clock", "real"]


def whole_chunks(log):
    """Chunks of 50 frames that stand complete in a log (src/recording/chunk.h)."""
    data, at, count = pathlib.Path(log).read_bytes(), len("DIHAPTIC LOG 3\n"), 0
    while at + 24 <= len(data):
        kind, size = data[at:at + 4], int.from_bytes(data[at + 4:at + 8], "little")
        at += 24 + size
        count += kind == b"PACK" and at <= len(data)
    return count


class Interruptions(unittest.TestCase):
    def start(self, out, *arguments, **options):
        return subprocess.Popen([PROGRAM, "run", "experiments/lift-block.yaml", "--out", out, *arguments],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options)

    def test_a_closed_terminal_ends_in_order(self):
        with tempfile.TemporaryDirectory() as out:
            master, slave = pty.openpty()
            process = subprocess.Popen([PROGRAM, "run", "experiments/lift-block.yaml", "--out", out, *REAL_CLOCK],
                                       stdin=slave, stdout=slave, stderr=slave, start_new_session=True,
                                       preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0))
            os.close(slave)
            wait_for_log(out, 100000)
            os.close(master)
            self.assertEqual(process.wait(timeout=patient(60)), 1)
            folder = session_of(out)
            self.assertTrue(os.path.exists(folder + "session.nwb"))
            self.assertIn("state: interrupted", pathlib.Path(folder + "session.yaml").read_text())

    @soak.alone
    def test_a_reader_that_goes_away_ends_in_order(self):
        with tempfile.TemporaryDirectory() as out:
            process = subprocess.Popen([PROGRAM, "run", "experiments/lift-block.yaml", "--out", out, *REAL_CLOCK],
                                       stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            wait_for_log(out, 100000)
            process.stdout.close()
            self.assertEqual(process.wait(timeout=patient(60)), 1)
            folder = session_of(out)
            self.assertTrue(os.path.exists(folder + "session.nwb"))
            self.assertIn("state: interrupted", pathlib.Path(folder + "session.yaml").read_text())

    def test_keys_of_a_terminal_switch_force_off(self):
        for name, key in [("Escape", b"\x1b"), ("Ctrl-C", b"\x03"), ("Ctrl-\\", b"\x1c"), ("Ctrl-Z", b"\x1a")]:
            with self.subTest(name), tempfile.TemporaryDirectory() as out:
                master, slave = pty.openpty()
                before = termios.tcgetattr(slave)
                process = subprocess.Popen([PROGRAM, "run", "experiments/lift-block.yaml", "--out", out, *REAL_CLOCK],
                                           stdin=slave, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
                                           start_new_session=True, preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0))
                wait_for_log(out, 100000)
                os.write(master, b"q")  # any other key has no effect
                time.sleep(0.2)
                self.assertIsNone(process.poll())
                os.write(master, key)
                stdout, _ = process.communicate(timeout=patient(60))
                self.assertEqual(process.returncode, 1)
                self.assertIn("Escape or Ctrl-C switches force off", stdout)
                self.assertRegex(stdout, r"force has been off since [0-9.]+ s: ")
                folder = session_of(out)
                self.assertIn("state: interrupted", pathlib.Path(folder + "session.yaml").read_text())
                self.assertEqual(termios.tcgetattr(slave), before)
                os.close(slave)
                os.close(master)
                replay = dihaptic("replay", folder)
                self.assertEqual(replay.returncode, 0, replay.stdout)

    def test_a_running_session_is_not_recovered(self):
        with tempfile.TemporaryDirectory() as out:
            process = self.start(out, *REAL_CLOCK)
            wait_for_log(out, 100000)
            folder = session_of(out)
            before = set(os.listdir(folder))
            result = dihaptic("recover", folder)
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertIn("error: is in use", result.stderr)
            self.assertEqual(set(os.listdir(folder)), before)
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=patient(60))
            self.assertEqual(dihaptic("recover", folder).returncode, 0)

    @soak.alone
    def test_ticks_that_overruns_left_out_are_told(self):
        with tempfile.TemporaryDirectory() as out:
            process = self.start(out, *REAL_CLOCK)
            wait_for_log(out, 100000)
            process.send_signal(signal.SIGSTOP)
            time.sleep(0.3)
            process.send_signal(signal.SIGCONT)
            time.sleep(0.2)
            process.send_signal(signal.SIGINT)
            stdout, _ = process.communicate(timeout=patient(60))
            told = re.compile(r"(\d+) ticks \(([0-9.]+) ms\) never took place")
            self.assertGreater(int(told.search(stdout).group(1)), 250, stdout)
            late = re.search(r"wake-ups late by (\d+) us median, \d+ us p99.9, (\d+) us at worst; \d+ overrun", stdout)
            self.assertIn(late.group(0).split(";")[0], pathlib.Path(session_of(out) + "session.yaml").read_text())
            recovered = dihaptic("recover", session_of(out)).stdout
            self.assertEqual(told.search(recovered).group(0), told.search(stdout).group(0))

    def frames_of(self, text):
        return int(text.split(" frames")[0].split()[-1])

    @soak.alone
    def test_a_small_stack_is_enough(self):
        """The servo touches its stack in advance, as far as ulimit -s allows."""
        with tempfile.TemporaryDirectory() as out:
            small = lambda: resource.setrlimit(resource.RLIMIT_STACK, (256 * 1024, 256 * 1024))
            result = dihaptic("run", "scenes/block-on-table.yaml", "--clock", "real", "--out", out, preexec_fn=small)
            self.assertEqual(result.returncode, 0, result.stderr)

    def test_ctrl_c_ends_in_order(self):
        with tempfile.TemporaryDirectory() as out:
            process = self.start(out, *REAL_CLOCK)
            wait_for_log(out, 100000)
            process.send_signal(signal.SIGINT)
            stdout, stderr = process.communicate(timeout=patient(60))
            self.assertEqual(process.returncode, 1, stderr)
            self.assertIn("interrupted", stdout)
            folder = session_of(out)
            self.assertTrue(os.path.exists(folder + "session.nwb"))
            self.assertIn("state: interrupted", pathlib.Path(folder + "session.yaml").read_text())
            # if the machine stood still for too long, force was switched off before the interruption
            self.assertRegex(pathlib.Path(folder + "trials.csv").read_text(), "interrupted|force off")

    def test_kill_loses_at_most_a_tenth_of_a_second(self):
        with tempfile.TemporaryDirectory() as out:
            process = self.start(out, *REAL_CLOCK)
            # a copy of the log, and its time: from then on, real time gives the number of frames
            wait_for_log(out, 100000)
            folder = session_of(out)
            snapshot = pathlib.Path(folder + "raw.log").read_bytes()
            seen_at = time.monotonic()
            time.sleep(1.5)
            process.kill()
            killed_at = time.monotonic()
            process.communicate()
            self.assertIn("state: running", pathlib.Path(folder + "session.yaml").read_text())

            earlier = shutil.copytree(folder, out + "/earlier")
            result = dihaptic("recover", folder)
            self.assertEqual(result.returncode, 0, result.stderr)
            recovered = self.frames_of(result.stdout)
            pathlib.Path(earlier + "/raw.log").write_bytes(snapshot)
            before = self.frames_of(dihaptic("recover", earlier).stdout)
            ticks = before + (killed_at - seen_at) * 1000 / SLOWNESS  # a loop that is late skips ticks
            self.assertGreater(recovered, ticks - 100 - 50)  # 50 ms for this script's own waits
            self.assertTrue(os.path.exists(folder + "session.nwb"))

    def test_killed_anywhere_it_recovers_and_replays(self):
        random.seed(1)
        with tempfile.TemporaryDirectory() as out:
            self.start(out).communicate(timeout=patient(60))
            whole = os.path.getsize(session_of(out) + "raw.log")
        kills = 0
        while kills < soak.of(8, 200):
            with tempfile.TemporaryDirectory() as out:
                process = self.start(out)
                size = wait_for_log(out, random.uniform(0.01, 0.99) * whole)
                process.kill()
                process.communicate()
                if process.returncode == 0:
                    continue  # the session ended before the kill
                kills += 1
                folder = session_of(out)
                self.assertIn("state: running", pathlib.Path(folder + "session.yaml").read_text())
                recovered = dihaptic("recover", folder)
                self.assertEqual(recovered.returncode, 0, recovered.stderr)
                self.assertGreaterEqual(self.frames_of(recovered.stdout), 50 * whole_chunks(folder + "raw.log") - 49)
                if size < 0.5 * whole:
                    self.assertIn("without its end mark", recovered.stdout)
                    self.assertIn("of 9.500 s planned", recovered.stdout)
                self.assertIn("state: recovered", pathlib.Path(folder + "session.yaml").read_text())
                replayed = dihaptic("replay", folder)
                self.assertEqual(replayed.returncode, 0, replayed.stdout)

    def test_a_full_disk_is_told_and_what_was_written_is_kept(self):
        with tempfile.TemporaryDirectory() as out:
            process = self.start(out, preexec_fn=with_largest_file(500_000))
            _, stderr = process.communicate(timeout=patient(60))
            self.assertEqual(process.returncode, 2)
            self.assertIn("raw.log: error: cannot be written", stderr)
            self.assertIn("dihaptic recover", stderr)
            recovered = dihaptic("recover", session_of(out))
            self.assertEqual(recovered.returncode, 0, recovered.stderr)
            self.assertGreater(self.frames_of(recovered.stdout), 300)

    def test_a_disk_that_is_full_for_the_nwb_file_leaves_a_session_to_recover(self):
        with tempfile.TemporaryDirectory() as out:
            self.assertEqual(dihaptic("run", "scenes/block-on-table.yaml", "--out", out).returncode, 0)
            folder = session_of(out)
            whole = os.path.getsize(folder + "session.nwb")
            # TMPDIR is where the thread sanitizer would write a file of its own when a program starts
            nowhere = dict(os.environ, TMPDIR="/nowhere")
            for share in [0, 0.001, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.97, 0.99, 0.999]:
                for name in MADE:
                    pathlib.Path(folder + name).unlink(missing_ok=True)
                limit = with_largest_file(int(whole * share))
                result = dihaptic("recover", folder, preexec_fn=limit, env=nowhere)
                self.assertEqual(result.returncode, 2, f"{share} {result.returncode} {result.stderr}")
                self.assertIn("session.nwb: error: cannot be written: File too large", result.stderr)
                self.assertIn("files cannot become so large there", result.stderr)
                self.assertIn("dihaptic recover " + folder.rstrip("/"), result.stderr)
                self.assertFalse(glob.glob(folder + "session.nwb*"), share)
            recovered = dihaptic("recover", folder)
            self.assertEqual(recovered.returncode, 0, recovered.stderr)
            self.assertEqual(dihaptic("replay", folder).returncode, 0)


class CtrlC(unittest.TestCase):
    """Commands that move no device: Ctrl-C ends each of them soon, and the files that were there stay as they were."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.out = folder.name
        cls.people = cls.out + "/r"
        dihaptic("rehearse", "experiments/visuomotor-rotation.yaml", "--people", str(soak.of(2, 30)), "--out", cls.people)
        dihaptic("report", cls.people, "--tables")

    def files(self):
        return {file: file.read_bytes() for file in pathlib.Path(self.out).rglob("*") if file.is_file()}

    def ended(self, *words, begun, wait=0.0):
        """How a command ends, and what it says, if it is interrupted with the Python that it starts: this long after it has
        shown a share of its work that matches `begun`."""
        process = subprocess.Popen([PROGRAM, *words], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                                   start_new_session=True)
        said = ""
        while line := process.stderr.readline():
            said += line
            if begun in line:
                break
        time.sleep(wait)
        os.killpg(process.pid, signal.SIGINT)
        said += process.communicate(timeout=patient(60))[1]
        self.assertNotIn("Traceback", said)
        return process.returncode, said

    def interrupted(self, *words):
        before, at = self.files(), time.monotonic()
        code, said = self.ended(*words, begun="%")
        self.assertEqual(code, 1, said)
        self.assertIn("interrupted: nothing more was written", said)
        self.assertLess(time.monotonic() - at, patient(10))
        self.assertEqual(self.files(), before)

    def test_ends_measuring(self):
        self.interrupted("bench", "grasp")

    @soak.alone
    def test_ends_exporting(self):
        dihaptic("run", "experiments/visuomotor-rotation.yaml", "--simulate", "--participant", "sim-001", "--out", self.out + "/s")
        session = session_of(self.out + "/s")
        self.interrupted("export", session, "--bids", self.out + "/bids")
        self.interrupted("export", session, "--csv", "grip_force", "--out", self.out + "/c.csv")
        self.interrupted("recover", session)

    @soak.alone
    def test_ends_reading_many_sessions(self):
        self.interrupted("collect", self.people)
        self.interrupted("report", self.people, "--tables")

    def test_ends_drawing_a_page(self):
        for wait in soak.of([0.3, 2], [0.1 * i for i in range(1, 40)]):
            with self.subTest(wait):
                code, said = self.ended("report", self.people, begun="100 %", wait=wait)
                if code != 0:  # on a fast machine, the page may be there already
                    self.assertEqual(code, 1, said)
                    self.assertIn("it was interrupted. Run the same command again.", said)


if __name__ == "__main__":
    unittest.main(verbosity=2)
