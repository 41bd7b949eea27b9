"""The operator's window as its user meets it: real mouse and key events, in an X server of its own. What the tests
beside this file share.

Usage: gui/NAME_test.py PROGRAM [SCREENSHOTS [CLASS[.TEST]]], from the project's folder. Pictures of the window go to
the folder SCREENSHOTS.
"""
import contextlib
import csv
import glob
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import h5py
import numpy as np

sys.path.append("test")  # felt.py, patience.py
import needs
from patience import SLOWNESS, patient

needs.module("PIL", "python3-pil")
from PIL import Image

needs.program("Xvfb", "xvfb")
needs.program("xdotool", "xdotool")

PROGRAM = sys.argv.pop(1) if len(sys.argv) > 1 else "build/release/dihaptic"
needs.part("window", PROGRAM)
SCREENSHOTS = sys.argv.pop(1) if len(sys.argv) > 1 else "build/release/screenshots"
#: The first scene, seen from the left: the positions on the screen in these tests depend on this camera.
SCENE = pathlib.Path("scenes/block-on-table.yaml").read_text().replace(
    "position_mm: [-60, -470, 330]\n    look_at_mm: [0, 0, 55]", "position_mm: [-250, -400, 290]\n    look_at_mm: [20, 0, 65]")
assert "[-250, -400, 290]" in SCENE


def end_display(display):
    """A process that is stopped, or was asked just before it began to wait, does not notice that it is to end."""
    display.terminate()
    try:
        display.wait(5)
    except subprocess.TimeoutExpired:
        display.kill()
        display.wait()


def threads_at_work(process):
    """Whether a thread of the process runs, could run, or waits for a disk."""
    for file in glob.glob(f"/proc/{process}/task/*/stat"):
        with contextlib.suppress(OSError):  # a thread that has ended since
            if pathlib.Path(file).read_text().rpartition(")")[2].split()[0] in "RD":
                return True
    return False


#: The thread sanitizer of LLVM 14 fails a check of its own (tsan_rtl.cpp) when Qt starts another program.
starts_programs = unittest.skipIf("TSAN_OPTIONS" in os.environ, "the thread sanitizer cannot follow Qt into a new program")


class Window(unittest.TestCase):
    """Each test has a display, a home and a window of its own."""
    real_rig = False
    size = "1400x900"  # of the display

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        read, write = os.pipe()
        # -fbdir: a file in this folder always holds what is on the screen
        self.display = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-noreset", "-screen", "0", self.size + "x24",
                                         "-fbdir", self.folder.name], pass_fds=[write], stderr=subprocess.DEVNULL)
        self.addCleanup(end_display, self.display)
        os.close(write)
        with os.fdopen(read) as pipe:
            number = pipe.readline().strip()
        self.environment = dict(os.environ, DISPLAY=":" + number, HOME=self.folder.name, XDG_RUNTIME_DIR=self.folder.name,
                                XDG_STATE_HOME=self.folder.name + "/state",
                                PATH=f"{self.folder.name}/bin:{os.environ['PATH']}")
        self.keep_browsers_away()
        self.scene = self.folder.name + "/block.yaml"
        pathlib.Path(self.scene).write_text(SCENE)
        self.out = self.folder.name + "/sessions"
        self.window = None

    def allow(self, library):
        """As a laboratory does whose experiments name its rig: from a file, no library is loaded that its user did not allow."""
        list = pathlib.Path(self.folder.name, "config/dihaptic/libraries.yaml")
        list.parent.mkdir(parents=True, exist_ok=True)
        list.write_text(f"- {library}\n")
        self.environment["XDG_CONFIG_HOME"] = self.folder.name + "/config"

    def keep_browsers_away(self):
        """A page that the window opens goes to a list. A browser would write into the test's home while it is deleted."""
        opener = pathlib.Path(self.folder.name, "bin", "xdg-open")
        opener.parent.mkdir()
        opener.write_text(f'#!/bin/sh\necho "$1" >> {self.folder.name}/opened\n')
        opener.chmod(0o755)

    def opened(self):
        """Addresses of the pages that the window had opened."""
        list = pathlib.Path(self.folder.name, "opened")
        return list.read_text().split() if list.exists() else []

    def open(self, *files):
        self.log = open(self.folder.name + "/log", "w+")
        self.addCleanup(self.log.close)
        # so that SIGHUP ends the window even if the test is run under nohup
        self.window = subprocess.Popen([PROGRAM, "gui", "--out", self.out, *(files or [self.scene])], env=self.environment,
                                       stdout=self.log, stderr=self.log,
                                       preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_DFL))
        self.addCleanup(self.window.wait)
        self.addCleanup(self.window.kill)
        name = self.wait("the window", lambda: self.xdotool("search", "--onlyvisible", "--name", " - Dihaptic$"))
        self.name = name.split()[-1]
        # there is no window manager to do so
        self.xdotool("windowmove", self.name, "0", "0", "windowsize", self.name, *self.size.split("x"),
                     "windowfocus", self.name, "mousemove", "450", "450")
        self.settle()

    def open_without_a_file(self):
        self.log = open(self.folder.name + "/log", "w+")
        self.addCleanup(self.log.close)
        self.window = subprocess.Popen([PROGRAM, "gui", "--out", self.out], env=self.environment, stdout=self.log,
                                       stderr=self.log)
        self.addCleanup(self.window.wait)
        self.addCleanup(self.window.kill)
        name = self.wait("the window", lambda: self.xdotool("search", "--onlyvisible", "--name", "^Dihaptic$"))
        self.name = name.split()[-1]
        self.xdotool("windowmove", self.name, "0", "0", "windowsize", self.name, *self.size.split("x"), "windowfocus",
                     self.name)
        time.sleep(1)

    def type(self, text):
        self.xdotool("type", "--delay", "30", "--", text)

    def drafts(self):
        """What is kept of texts that were not saved."""
        return glob.glob(self.folder.name + "/state/dihaptic/drafts/*.draft")

    def dialogs(self, title):
        return self.xdotool("search", "--onlyvisible", "--name", title).split()

    def answer(self, title, *keys):
        """Waits for a dialog, and types. There is no window manager that would give it the keyboard, and take it back."""
        dialog = self.wait(title, lambda: self.dialogs(title))[-1]
        self.xdotool("windowfocus", dialog)
        time.sleep(0.5)
        self.screenshot("asks-" + title.strip("^$?").lower().replace(" ", "-"))
        self.key(*keys)
        self.wait("the dialog's end", lambda: not self.dialogs(title))
        self.xdotool("windowfocus", self.name)
        time.sleep(0.3)

    def answer_with_path(self, title, path):
        """Waits for a dialog that asks for a file or a folder, and types it."""
        dialog = self.wait(title, lambda: self.dialogs(title))[-1]
        self.xdotool("windowfocus", dialog)
        time.sleep(0.5)
        self.key("ctrl+a")
        self.type(path)
        self.key("Return")
        self.wait("the dialog's end", lambda: not self.dialogs(title))
        self.xdotool("windowfocus", self.name)

    def xdotool(self, *words):
        return subprocess.run(["xdotool", *words], env=self.environment, capture_output=True, text=True,
                              timeout=patient(60)).stdout

    def key(self, *keys):
        for key in keys:
            self.xdotool("key", key)
            time.sleep(0.2)

    def hold(self, key, seconds):
        self.xdotool("keydown", key)
        time.sleep(seconds)
        self.xdotool("keyup", key)

    def move(self, x, y, steps):
        """The pointer, sixty times a second, as a hand would."""
        for _ in range(steps):
            self.xdotool("mousemove_relative", "--", str(x), str(y))
            time.sleep(0.016)

    def wait(self, what, condition, seconds=60):
        end = time.monotonic() + patient(seconds)
        while time.monotonic() < end:
            value = condition()
            if value:
                return value
            if self.window is not None and self.window.poll() is not None:
                break
            time.sleep(0.1)  # most conditions start a program
        self.log.seek(0)
        self.fail(f"waited in vain for {what}: {self.log.read()}")

    def settle(self):
        """Until the window, of which no session runs, has drawn all: eight looks in a row find its threads asleep. One that
        has nothing to do leaves the processor to others. A scene whose last frame came from a session or a player gets
        all its pixels two seconds later."""
        end, asleep = time.monotonic() + patient(60), 0
        while asleep < 8:  # a third of a second
            self.assertLess(time.monotonic(), end, "the window draws without end, though no session runs")
            asleep = 0 if threads_at_work(self.window.pid) else asleep + 1
            time.sleep(0.04)

    def screenshot(self, name):
        pathlib.Path(SCREENSHOTS).mkdir(parents=True, exist_ok=True)
        Image.fromarray(self.screen()).save(f"{SCREENSHOTS}/{name}.png")

    def screen(self):
        """Red, green and blue of the display, by row and column."""
        picture = np.fromfile(self.folder.name + "/Xvfb_screen0", np.uint8)  # the format of the program xwd
        head = picture[:100].view(">u4")
        size, width, height, bytes_per_line, colours = (int(head[i]) for i in (0, 4, 5, 12, 19))
        begin = size + 12 * colours
        rows = picture[begin:begin + height * bytes_per_line].reshape(height, bytes_per_line)
        return np.ascontiguousarray(rows[:, :4 * width].reshape(height, width, 4)[:, :, 2::-1])

    def pixels(self, left, top, width, height):
        """Grey levels of a part of the display, by row."""
        return np.asarray(Image.fromarray(self.screen()[top:top + height, left:left + width]).convert("L"))

    def recording(self):
        """Folder of the running session, or else of the last one."""
        return self.wait("a session", lambda: sorted(glob.glob(self.out + "/*/")))[-1]

    def start(self):
        before = len(glob.glob(self.out + "/*/raw.log"))
        self.ask_to_start()
        self.wait("the start", lambda: len(glob.glob(self.out + "/*/raw.log")) > before)
        time.sleep(0.3)

    def ask_to_start(self):
        """With real devices the window shows its checklist first."""
        self.key("F5")
        if not self.real_rig:
            return

        def lists():
            return self.xdotool("search", "--onlyvisible", "--name", "^Before the session").split()

        list = self.wait("the checklist", lists)[-1]

        def has_keyboard():
            """There is no window manager, so that the list may not have the keyboard at once."""
            self.xdotool("windowfocus", list)
            time.sleep(0.3)
            return self.xdotool("getwindowfocus").strip() == list

        self.wait("the checklist's keyboard", has_keyboard)
        self.key("Return")  # once: a second one could go to the window below, and start again
        self.wait("the checklist's end", lambda: not lists())
        self.xdotool("windowfocus", self.name)

    def ended(self, state):
        """The recording of the session that has just ended, in this state."""
        folder = self.recording()
        info = pathlib.Path(folder + "session.yaml")
        self.wait("state: " + state, lambda: info.exists() and "state: " + state in info.read_text())
        return h5py.File(folder + "session.nwb", "r")

    def series(self, file, name):
        return file[f"acquisition/{name}/data"][:]

    def recorded(self, what, condition, seconds=60):
        """Waits until the session that runs has recorded this; `condition` is asked of a file of what there is so far.
        How long a picture takes differs by machine, so no time is long enough for what a mouse does."""
        copy = self.folder.name + "/so-far"

        def holds():
            shutil.rmtree(copy, ignore_errors=True)
            shutil.copytree(self.recording(), copy)
            made = subprocess.run([PROGRAM, "recover", copy], capture_output=True)
            if made.returncode != 0:
                return False
            with h5py.File(copy + "/session.nwb", "r") as file:
                return "status" in file["acquisition"] and condition(file)  # at first the file has no ticks

        self.wait(what, holds, seconds)

    def status(self, file, bit):
        """Whether each tick has that bit."""
        return (self.series(file, "status").astype(int) >> bit & 1) == 1

    def replay(self):
        """Every force of the last recording, to the bit."""
        check = subprocess.run([PROGRAM, "replay", self.recording()], capture_output=True, text=True)
        self.assertEqual(check.returncode, 0, check.stdout + check.stderr)

    def quit(self):
        self.key("ctrl+q")
        self.assertEqual(self.window.wait(patient(60)), 0)


class Participants(Window):
    """Each test asks who does the trials of its experiment."""

    def experiment(self, name, change):
        text = change(pathlib.Path(f"experiments/{name}.yaml").read_text()).replace("../scenes", os.getcwd() + "/scenes")
        file = self.folder.name + "/experiment.yaml"
        pathlib.Path(file).write_text(text)
        return file

    def dialog(self):
        return self.xdotool("search", "--onlyvisible", "--name", "^Who does the trials")

    def ask(self):
        self.key("F5")
        self.wait("the dialog", self.dialog)
        time.sleep(0.5)

    def answered(self, key):
        """There is no window manager that gives the focus back."""
        self.key(key)
        self.wait("the dialog's end", lambda: not self.dialog())
        time.sleep(0.5)
        self.xdotool("windowfocus", self.name)
        time.sleep(0.5)

    def start(self):
        self.ask()
        self.xdotool("type", "--delay", "50", "S07\t31\tF\tr")
        self.answered("Return")
        self.wait("the start", lambda: glob.glob(self.out + "/*/raw.log"))

    def outcomes(self):
        with open(self.recording() + "trials.csv") as file:
            return [row["outcome"] for row in csv.DictReader(file)]
