"""Sessions and calibrations on fakes of the makers' libraries.

Usage: real_devices_test.py PROGRAM, from the project's folder.
"""
import fcntl
import os
import pathlib
import pty
import shutil
import signal
import subprocess
import tempfile
import termios
import time
import unittest

from program import PROGRAM, dihaptic, patient, session_of, wait_for_log

# fakes of the makers' software pass for real devices: a busy machine's pauses must not end the session
PATIENT = "max_pause_ms: 1000, hand_damping_Ns_m: 100"


class RealDevices(unittest.TestCase):
    """On fakes of the makers' libraries, which stand where the machine seeks the real ones."""

    HD = ["libHD.so", "libHD.so.3.4", "libHD.so.3.0"]
    DHD = ["libdhd.so.3", "libdrd.so.3", "libdhd.so", "libdrd.so"]

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.env = {**os.environ, "LD_LIBRARY_PATH": self.folder.name}

    def put(self, names, fake=None):
        for name in names:
            file = pathlib.Path(self.folder.name, name)
            file.unlink(missing_ok=True)
            if fake:
                file.symlink_to(pathlib.Path(PROGRAM).resolve().parent / "src/devices" / fake)
            else:
                file.write_text("no library at all")

    def rig(self, shipped, safety=PATIENT):
        """A copy of a shipped rig, with limits of its own."""
        rig = pathlib.Path(self.folder.name, "rig.yaml")
        rig.write_text(pathlib.Path(shipped).read_text() + f"settings: {{safety: {{{safety}}}}}\n")
        return str(rig)

    def test_devices_says_what_is_missing_and_what_mends_it(self):
        self.put(self.HD + self.DHD)
        result = dihaptic("devices", env=self.env)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stdout, r"openhaptics\n    OpenHaptics cannot be loaded; tried libHD.so \(.*file too short\), "
                                        r"libHD.so.3.4 \(.*\), libHD.so.3.0 \(.*\). Install OpenHaptics 3.4")
        self.assertRegex(result.stdout, r"forcedimension\n    Force Dimension's SDK cannot be loaded; tried libdhd.so.3 \(.*"
                                        r"Install the Force Dimension SDK 3")
        self.put(self.HD, "libfake_dhd.so")
        self.assertIn("has no hdInitDevice. This program does not support its version", dihaptic("devices", env=self.env).stdout)

    def test_devices_lists_what_is_there(self):
        self.put(self.HD, "libfake_hd.so")
        self.put(self.DHD, "libfake_dhd.so")
        told = dihaptic("devices", env=self.env).stdout
        self.assertIn("openhaptics\n    PHANToM Premium 1.0, serial 40123: ", told)
        self.assertIn("forcedimension\n    omega.3, serial 101: ready\n    omega.3, serial 102: ready\n", told)

    def test_real_devices_keep_real_time(self):
        for rig in ["rigs/omega-pair.yaml", "rigs/phantom-pair-openhaptics.yaml"]:
            result = dihaptic("run", "scenes/block-on-table.yaml", "--rig", rig, "--clock", "virtual", env=self.env)
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertIn("--clock: error: real devices run in real time. Leave out --clock", result.stderr)
            result = dihaptic("tune", "scenes/block-on-table.yaml", "--rig", rig, env=self.env)
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertIn("has real devices, but tune shakes only simulated ones", result.stderr)

    def test_a_session_on_devices_that_are_not_there_says_so_before_it_begins(self):
        self.put(self.HD + self.DHD)
        with tempfile.TemporaryDirectory() as out:
            result = dihaptic("run", "scenes/block-on-table.yaml", "--rig", "rigs/omega-pair.yaml", "--out", out,
                              env=self.env)
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertRegex(result.stderr, r"omega-pair.yaml:\d+: error: library: Force Dimension's SDK cannot be loaded")
            self.assertEqual(os.listdir(out), [])

    def test_ctrl_c_while_the_keeper_is_silent_is_an_interruption(self):
        folder = pathlib.Path(self.folder.name)
        program = shutil.copy(PROGRAM, folder)
        host = folder / "dihaptic-host"
        host.write_text(f"#!/bin/sh\ntouch {folder}/began\nexec sleep 60\n")
        host.chmod(0o755)
        process = subprocess.Popen([program, "run", "scenes/block-on-table.yaml", "--rig", "rigs/phantom-pair-openhaptics.yaml",
                                    "--out", str(folder / "out")], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        deadline = time.monotonic() + patient(20)
        while not (folder / "began").exists() and time.monotonic() < deadline:
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        _, stderr = process.communicate(timeout=patient(20))
        self.assertIn("interrupted while the program that owns the devices did not answer", stderr)
        self.assertEqual(process.returncode, 1)

    def test_calibrate_ends_in_the_middle_of_a_line(self):
        self.put(self.HD, "libfake_hd.so")
        process = subprocess.Popen([PROGRAM, "calibrate", "rigs/phantom-pair-openhaptics.yaml", "-o", self.folder.name + "/c.yaml"],
                                   stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=self.env)
        process.stdin.write(b"\n\nabc")  # two steps at once, and no end of line
        process.stdin.flush()
        lines = iter(process.stdout.readline, b"")
        next(line for line in lines if b"3 of 4" in line)
        process.send_signal(signal.SIGINT)
        _, stderr = process.communicate(timeout=patient(20))
        self.assertEqual(process.returncode, 1)
        self.assertIn(b"nothing was stored", stderr)

    def test_calibrate_leads_a_person_who_may_give_up(self):
        self.put(self.HD, "libfake_hd.so")
        rig = self.folder.name + "/rig.yaml"
        pathlib.Path(rig).write_text(pathlib.Path("rigs/phantom-pair-openhaptics.yaml").read_text())
        result = dihaptic("calibrate", rig, input="\n\n", env=self.env)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertRegex(result.stdout, r"1 of 4\. Hold each arm in the standard configuration: .*\n   Then press Enter\.\n"
                                        r"2 of 4\. Join the endpoints of thumb and index with the link")
        self.assertIn("3 of 4. Move the link through all of the workspace", result.stdout)
        self.assertIn("interrupted: nothing was stored", result.stderr)
        self.assertEqual(os.listdir(self.folder.name).count("rig-calibration.yaml"), 0)

    def test_a_session_asks_for_endpoints_held_together_and_tells_when_they_disagree(self):
        self.put(self.HD, "libfake_hd.so")
        rig = self.folder.name + "/rig.yaml"
        text = pathlib.Path(self.rig("rigs/phantom-pair-openhaptics.yaml")).read_text()
        pathlib.Path(rig).write_text("calibration: mine.yaml\n" + text)
        pathlib.Path(self.folder.name + "/mine.yaml").write_text(
            f"date: {time.strftime('%Y-%m-%d')}\ndevices: [{{finger: thumb}}, {{finger: index, together_mm: 12}}]\n")
        for answer, notes in [(b"\n", True), (b"s", False)]:
            with tempfile.TemporaryDirectory() as out:
                master, slave = pty.openpty()
                process = subprocess.Popen([PROGRAM, "run", "scenes/block-on-table.yaml", "--rig", rig, "--out", out],
                                           stdin=slave,
                                           stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=self.env,
                                           start_new_session=True, preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0))
                lines = iter(process.stdout.readline, "")
                next(line for line in lines if "Hold the endpoints of thumb and index together" in line)
                os.write(master, answer)
                wait_for_log(out, 100000)
                process.send_signal(signal.SIGINT)
                stdout, stderr = process.communicate(timeout=patient(60))
                os.close(master)
                os.close(slave)
                told = "held together, are 0.0 mm apart, but were 12.0 mm apart when the rig was calibrated"
                self.assertEqual(told in stdout, notes, stdout + stderr)
                session = pathlib.Path(session_of(out) + "session.yaml").read_text()
                self.assertEqual(told in session, notes, session)

    def test_a_session_goes_on_until_it_is_ended(self):
        self.put(self.HD, "libfake_hd.so")
        self.put(self.DHD, "libfake_dhd.so")
        for rig in ["rigs/omega-pair.yaml", "rigs/phantom-pair-openhaptics.yaml"]:
            with tempfile.TemporaryDirectory() as out:
                process = subprocess.Popen([PROGRAM, "run", "scenes/block-on-table.yaml", "--rig", self.rig(rig),
                                            "--out", out],
                                           stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=self.env)
                wait_for_log(out, 100000)
                process.send_signal(signal.SIGINT)
                stdout, stderr = process.communicate(timeout=patient(60))
                self.assertIn("Escape or Ctrl-C switches force off", stdout, stderr)
                session = pathlib.Path(session_of(out) + "session.yaml").read_text()
                self.assertIn("clock: real", session)
                self.assertRegex(session, r"serial (101|40123)")
                self.assertEqual(dihaptic("replay", session_of(out)).returncode, 0)


if __name__ == "__main__":
    unittest.main(verbosity=2)
