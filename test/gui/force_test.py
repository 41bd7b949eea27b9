"""Whether force goes when it has to, and how soon. Needs the machine alone, as every bar here is a time."""
import os
import pathlib
import signal
import subprocess
import time
import unittest

import h5py

from window import PROGRAM, Window, patient
from felt import Felt
import soak

FORCE_OFF, STOPPED, ABANDONED, PAUSED = 10, 21, 28, 29  # bits of a frame's status


class Force(Window):
    """On two fakes of real devices whose handles are pushed into the table, and what pushes back."""
    real_rig = True

    def setUp(self):
        super().setUp()
        self.felt = Felt(self.folder.name + "/felt")
        self.environment.update(DIHAPTIC_FAKE_FELT=self.folder.name + "/felt", DIHAPTIC_FAKE_PUSH="0 0 0.007")  # half a finger is 10 mm

    def open(self, more=""):
        library = pathlib.Path(PROGRAM).resolve().parent / "src/devices/libfake_hd.so"
        self.allow(library)
        # so that a busy machine does not end the session
        title = "title: Two fakes\nsettings: {safety: {max_pause_ms: 1000}}\n"
        pathlib.Path(self.folder.name + "/rig.yaml").write_text(title + more + "devices:\n" + "".join(
            f"  - {{finger: {finger}, position_mm: [{x}, 0, 0], backend: openhaptics, "
            f"options: {{library: {library}, name: PHANToM {i}}}}}\n"
            for i, finger, x in [(1, "thumb", -100), (2, "index", 100)]))
        file = self.folder.name + "/experiment.yaml"
        pathlib.Path(file).write_text("scene: block.yaml\nrig: rig.yaml\n")
        super().open(file)

    def forces(self):
        return self.felt.forces()

    def pushed(self):
        """A busy machine may draw the first picture for longer than a window may be silent: the session is then continued."""
        for _ in range(6):
            end = time.monotonic() + patient(6)
            while time.monotonic() < end:
                if min(self.forces()) > 1:
                    return
                time.sleep(0.05)
            self.key("F6")
        self.fail("no force came")

    def off_after(self, act, most):
        """How long after `act` force was off everywhere, and stays so; at most `most` [s] in the program that labs run."""
        begin = time.monotonic()
        act()
        while max(self.forces()) > 0 and time.monotonic() < begin + patient(10):
            time.sleep(0.0002)
        took = time.monotonic() - begin
        self.assertLess(took, patient(most))
        for _ in range(20):
            self.assertEqual(max(self.forces()), 0)
            time.sleep(0.01)
        return took

    def last_frame(self):
        folder = self.recording()
        with h5py.File(folder + "session.nwb", "r") as file:
            return [self.status(file, bit)[-1] for bit in (FORCE_OFF, STOPPED)]

    def test_goes_at_the_first_escape_whatever_has_the_keyboard(self):
        self.open()
        self.assertEqual(self.felt.opened(), [0, 0])  # viewing a rig does not open its devices
        self.key("alt+v", "s")
        participant = self.wait("the participant's window",
                            lambda: self.xdotool("search", "--onlyvisible", "--name", "^Dihaptic: participant$")).strip()
        self.xdotool("windowfocus", self.name)
        self.key("ctrl+t")  # the drawer of Tuning
        self.start()
        self.pushed()
        self.assertEqual(self.felt.opened(), [1, 1])  # the session took over what the window had opened for it
        places = {
            "the scene": [],
            "a menu": ["alt+s"],
            "a menu in a menu": ["alt+v", "n", "Right"],
            "a list that is open": ["alt+l", "alt+Down"],
            "a number that is typed": ["alt+n", "ctrl+a", "4"],
            "a text that is selected": ["alt+i", "ctrl+a"],
        }
        for place, keys in places.items():
            with self.subTest(place):
                self.pushed()
                self.key(*keys)
                self.screenshot("escape-" + place.replace(" ", "-"))
                print(f"Escape, {place}: {self.off_after(lambda: self.xdotool('key', 'Escape'), 0.3) * 1e3:.1f} ms")
                self.key("Escape", "Escape")  # closes whatever was open
                self.xdotool("windowfocus", self.name)
                self.key("F6")
        with self.subTest("the participant's window"):
            self.pushed()
            self.xdotool("windowfocus", participant)
            time.sleep(0.3)
            self.off_after(lambda: self.xdotool("key", "Escape"), 0.3)
            self.key("F6")
            self.pushed()
        self.xdotool("windowfocus", self.name)
        self.off_after(lambda: self.key("F7"), 2)
        with self.ended("complete") as file:
            # on a busy machine the window may stop responding, and then force is off before Escape is handled
            pauses = self.status(file, PAUSED) | self.status(file, ABANDONED)
            self.assertGreaterEqual(pauses.sum(), len(places) + 1)
        self.quit()

    def test_waits_for_a_word_after_escape_in_the_question_before_it(self):
        pathlib.Path(self.folder.name + "/mine.yaml").write_text(
            f"date: {time.strftime('%Y-%m-%d')}\ndevices: [{{finger: thumb}}, {{finger: index, together_mm: 0}}]\n")
        self.open("calibration: mine.yaml\n")
        self.ask_to_start()
        dialog = self.wait("the question", lambda: self.xdotool("search", "--onlyvisible", "--name", "^Is the calibration")).strip()
        time.sleep(0.5)
        self.xdotool("windowfocus", dialog)
        self.key("Escape")
        self.wait("its end", lambda: not self.xdotool("search", "--onlyvisible", "--name", "^Is the calibration"))
        self.xdotool("windowfocus", self.name)
        time.sleep(1)
        self.assertEqual(max(self.forces()), 0)
        self.screenshot("escape-before")
        self.key("F6")
        self.pushed()
        self.key("F7")
        with self.ended("complete"):
            pass
        self.quit()

    def test_goes_at_signals_and_the_session_is_whole(self):
        for name in soak.of(("TERM", "TSTP"), ("INT", "TERM", "HUP", "TSTP", "QUIT", "USR1", "ALRM", "XCPU")):
            with self.subTest(name):
                self.open()
                self.start()
                self.pushed()
                number = getattr(signal, "SIG" + name)
                took = self.off_after(lambda: self.window.send_signal(number), 0.2)
                print(f"SIG{name}: {took * 1e3:.1f} ms")
                self.assertEqual(self.window.wait(patient(60)), 1)
                self.assertEqual(self.last_frame(), [True, True])
                self.assertIn("state: interrupted", pathlib.Path(self.recording() + "session.yaml").read_text())
                self.log.seek(0)
                self.assertIn("force is off, and the session ends", self.log.read())
        self.replay()

    def test_goes_when_the_window_fails_is_killed_or_stopped(self):
        """By the process that owns the devices: nothing in the window could."""
        for name in soak.of(("SEGV", "KILL", "STOP"), ("SEGV", "KILL", "STOP", "ABRT", "BUS", "FPE", "ILL")):
            with self.subTest(name):
                self.open()
                self.start()
                self.pushed()
                # a stopped window may take a second: these tests' rig allows such a pause
                took = self.off_after(lambda: self.window.send_signal(getattr(signal, "SIG" + name)), 1.2)
                print(f"SIG{name}: {took * 1e3:.1f} ms")
                self.window.kill()
                self.window.wait()
                if name not in ("KILL", "STOP"):
                    self.log.seek(0)
                    self.assertIn(f"the program failed (SIG{name}). Force is off.", self.log.read())

    def test_goes_with_the_display(self):
        for killed in (False, True):
            with self.subTest("and the program is killed" if killed else "alone"):
                self.setUp()
                self.open()
                self.start()
                self.pushed()
                print(f"display: {self.off_after(self.display.kill, 1) * 1e3:.1f} ms")
                folder = self.recording()
                if killed:
                    self.window.kill()
                    self.window.wait()
                    recovered = subprocess.run([PROGRAM, "recover", folder], capture_output=True, text=True)
                    self.assertEqual(recovered.returncode, 0, recovered.stderr)
                else:
                    ended = self.window.wait(patient(60))
                    self.log.seek(0)
                    said = self.log.read()
                    self.assertEqual(ended, 1, said)
                    self.assertIn("The window is lost: force is off", said)
                self.assertEqual(self.last_frame(), [True, True])
                self.replay()

    def test_goes_when_the_window_hangs_and_comes_back_when_told(self):
        self.open()
        self.start()
        self.pushed()
        shown = self.recording() + "shown.csv"
        self.wait("pictures of the session", lambda: os.path.exists(shown) and os.path.getsize(shown) > 100)
        took = self.off_after(lambda: self.display.send_signal(signal.SIGSTOP), 2)
        print(f"hang: {took * 1e3:.1f} ms")
        self.display.send_signal(signal.SIGCONT)
        time.sleep(2)
        self.assertEqual(max(self.forces()), 0)
        self.screenshot("hung")
        self.key("F6")
        self.pushed()
        self.key("F7")
        with self.ended("complete") as file:
            self.assertGreaterEqual(self.status(file, ABANDONED).sum(), 1)
        self.replay()
        self.quit()


if __name__ == "__main__":
    unittest.main()
