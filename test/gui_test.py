"""The operator's window as its user meets it: real mouse and key events, in an X server of its own.

Usage: gui_test.py PROGRAM [SCREENSHOTS], from the project's folder. Pictures of the window go to the folder
SCREENSHOTS.
"""
import csv
import glob
import math
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import h5py
import numpy as np

from felt import Felt

PROGRAM = sys.argv.pop(1) if len(sys.argv) > 1 else "build/release/dihaptic"
SCREENSHOTS = sys.argv.pop(1) if len(sys.argv) > 1 else "build/release/screenshots"
SIZE = "1400x900"
FORCE_OFF, STOPPED, RESUMED, ABANDONED, PAUSED = 10, 21, 22, 28, 29  # bits of a frame's status

SCENE = pathlib.Path("scenes/block-on-table.yaml").read_text()


def end_display(display):
    """One that is stopped, or was asked just before it began to wait, does not hear that it is to end."""
    display.terminate()
    try:
        display.wait(5)
    except subprocess.TimeoutExpired:
        display.kill()
        display.wait()


class Window(unittest.TestCase):
    """Each test has a display, a home and a window of its own."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        read, write = os.pipe()
        self.display = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-noreset", "-screen", "0", SIZE + "x24"],
                                        pass_fds=[write], stderr=subprocess.DEVNULL)
        self.addCleanup(end_display, self.display)
        os.close(write)
        with os.fdopen(read) as pipe:
            number = pipe.readline().strip()
        self.environment = dict(os.environ, DISPLAY=":" + number, HOME=self.folder.name, XDG_RUNTIME_DIR=self.folder.name)
        self.scene = self.folder.name + "/block.yaml"
        pathlib.Path(self.scene).write_text(SCENE)
        self.out = self.folder.name + "/sessions"
        self.window = None

    def open(self, file=None):
        self.log = open(self.folder.name + "/log", "w+")
        self.addCleanup(self.log.close)
        # a test that is run by nohup too
        self.window = subprocess.Popen([PROGRAM, "gui", "--out", self.out, file or self.scene], env=self.environment,
                                       stdout=self.log, stderr=self.log,
                                       preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_DFL))
        self.addCleanup(self.window.wait)
        self.addCleanup(self.window.kill)
        name = self.wait("the window", lambda: self.xdotool("search", "--onlyvisible", "--name", " - Dihaptic$"))
        self.name = name.split()[-1]
        # there is no window manager that would
        self.xdotool("windowmove", self.name, "0", "0", "windowsize", self.name, *SIZE.split("x"),
                     "windowfocus", self.name, "mousemove", "450", "450")
        time.sleep(1)

    def xdotool(self, *words):
        return subprocess.run(["xdotool", *words], env=self.environment, capture_output=True, text=True, timeout=60).stdout

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
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            value = condition()
            if value:
                return value
            if self.window is not None and self.window.poll() is not None:
                break
            time.sleep(0.05)
        self.log.seek(0)
        self.fail(f"waited in vain for {what}: {self.log.read()}")

    def screenshot(self, name):
        pathlib.Path(SCREENSHOTS).mkdir(parents=True, exist_ok=True)
        subprocess.run(["ffmpeg", "-loglevel", "error", "-y", "-f", "x11grab", "-video_size", SIZE, "-i",
                        self.environment["DISPLAY"], "-frames:v", "1", f"{SCREENSHOTS}/{name}.png"], check=True, timeout=60)

    def recording(self):
        """Folder of the session that runs, or the last one."""
        return self.wait("a session", lambda: sorted(glob.glob(self.out + "/*/")))[-1]

    def start(self):
        before = len(glob.glob(self.out + "/*/raw.log"))
        self.key("F5")
        self.wait("the start", lambda: len(glob.glob(self.out + "/*/raw.log")) > before)
        time.sleep(0.3)

    def ended(self, state):
        """The recording of the session that has just ended, in this state."""
        folder = self.recording()
        info = pathlib.Path(folder + "session.yaml")
        self.wait("state: " + state, lambda: "state: " + state in info.read_text())
        return h5py.File(folder + "session.nwb", "r")

    def series(self, file, name):
        return file[f"acquisition/{name}/data"][:]

    def status(self, file, bit):
        """Whether each tick has that bit."""
        return (self.series(file, "status").astype(int) >> bit & 1) == 1

    def replay(self):
        """Every force of the last recording, to the bit."""
        check = subprocess.run([PROGRAM, "replay", self.recording()], capture_output=True, text=True)
        self.assertEqual(check.returncode, 0, check.stdout + check.stderr)

    def quit(self):
        self.key("ctrl+q")
        self.assertEqual(self.window.wait(60), 0)


class Mouse(Window):
    OPEN, CLOSE = "4", "5"  # X's buttons for the wheel

    def wheel(self, way, notches):
        for _ in range(notches):
            self.xdotool("click", way)
            time.sleep(0.02)
        time.sleep(1.5)  # a busy machine takes its time

    def lift(self, steps):
        """The block of the scene, which is open; so many steps of 4 pixels up."""
        self.start()
        self.wheel(self.CLOSE, 19)
        self.move(0, -4, steps)

    def test_grips_and_lifts_while_the_solver_changes(self):
        self.open()
        self.screenshot("opened")
        self.lift(40)
        time.sleep(1.5)
        self.screenshot("lifted")
        self.key("alt+i", "ctrl+a")
        self.xdotool("type", "1.5\n")  # friction
        self.key("alt+n", "ctrl+a")
        self.xdotool("type", "2000\n")
        time.sleep(0.5)
        self.key("alt+x", "End")  # a point, once the block is let go: not in this session
        self.key("alt+c", "End")  # not through the dual spring, which shakes when it is so stiff
        time.sleep(0.4)
        for _ in range(3):  # through all solvers
            self.key("alt+l", "Up")
            time.sleep(0.4)
        self.key("F7")
        with self.ended("complete") as file:
            solver = self.series(file, "solver")
            self.assertEqual(sorted(set(solver)), [0, 1, 2, 3])
            self.assertEqual(sorted(set(self.series(file, "coupling"))), [0, 2])
            self.assertEqual(sorted(set(self.series(file, "friction_scale"))), [1, 1.5])
            self.assertEqual(sorted(set(self.series(file, "proxy"))), [0])
            stiffness = self.series(file, "stiffness")
            self.assertEqual((stiffness[0], stiffness[-1]), (1000, 2000))
            changed = np.flatnonzero(stiffness != stiffness[0])[0]
            height = self.series(file, "block_position")[:, 2]
            self.assertGreater(height[changed:].min(), 0.05)
        self.replay()
        self.quit()

    def test_holds_while_the_workspace_follows_the_camera(self):
        self.open()
        self.lift(30)
        time.sleep(1)
        self.key("F9")  # the scene's own camera is at -0.59 rad
        self.xdotool("mousedown", "3")
        self.move(-5, 0, 52)  # by 1.56 rad
        self.xdotool("mouseup", "3")
        time.sleep(3)
        self.move(4, 0, 20)  # to the right of the picture
        time.sleep(0.7)
        self.screenshot("followed")
        self.key("F7")
        with self.ended("complete") as file:
            turn = self.series(file, "workspace_turn")
            self.assertAlmostEqual(turn[-1], 0.97, delta=0.01)
            self.assertLess(turn.min(), -0.1)
            self.assertLessEqual(np.abs(self.series(file, "workspace_rate")).max(), 1)
            position = self.series(file, "block_position")
            turned = position[np.flatnonzero(turn)[0]:]
            self.assertGreater(turned[:, 2].min(), 0.05)
            right = np.array([np.cos(0.97), np.sin(0.97)])
            arrived = np.flatnonzero(np.abs(turn - turn[-1]) > 0.005)[-1]
            way = position[-1, :2] - position[arrived, :2]
            self.assertGreater(way @ right, 0.02)
            self.assertLess(np.linalg.norm(way - way @ right * right), 0.003)
            w, x, y, z = self.series(file, "block_orientation")[-1]
            self.assertAlmostEqual(2 * np.arctan2(z, w), 0.97, delta=0.1)
        self.replay()
        self.quit()
        self.assertIn("follow_camera=true", (pathlib.Path(self.folder.name) / ".config/dihaptic/dihaptic.conf").read_text())

    def test_squeezes_by_a_key_and_lets_go(self):
        self.open()
        self.start()
        self.hold("space", 0.5)
        self.wheel(self.CLOSE, 18)  # 54 mm
        self.move(0, -4, 30)
        time.sleep(0.3)
        self.wheel(self.OPEN, 18)
        time.sleep(0.6)
        self.key("F7")
        with self.ended("complete") as file:
            height = self.series(file, "block_position")[:, 2]
            self.assertGreater(height.max(), 0.04)
            self.assertAlmostEqual(height[-1], 0.02, delta=0.001)

    def test_turns_by_a_drag(self):
        self.open()
        self.lift(20)
        self.xdotool("mousedown", "1")
        self.move(4, 0, 20)
        self.xdotool("mouseup", "1")
        time.sleep(0.5)
        self.screenshot("turned")
        self.key("F7")
        with self.ended("complete") as file:
            w, x, y, z = self.series(file, "block_orientation")[-1]
            self.assertAlmostEqual(2 * np.arctan2(z, w), 0.64, delta=0.15)  # 80 pixels


    def test_stays_while_the_pointer_goes_elsewhere_and_is_reported(self):
        self.open()
        self.lift(30)
        time.sleep(0.7)
        self.key("h")
        self.move(5, 3, 40)
        time.sleep(0.5)
        self.key("h")
        time.sleep(1)
        self.key("F7")
        with self.ended("complete") as file:
            position = self.series(file, "block_position")
            self.assertGreater(position[-1, 2], 0.03)
            self.assertLess(np.abs(position[-500:] - position[-1500]).max(), 0.002)
        time.sleep(0.5)
        self.screenshot("recorded")
        self.key("ctrl+r")
        self.wait("the report", lambda: os.path.exists(self.recording() + "report.html"))
        self.quit()


class Sessions(Window):
    def test_run_a_script_to_its_end(self):
        self.open()
        self.key("alt+h", "Down")
        self.start()
        time.sleep(1.5)
        self.screenshot("script")
        with self.ended("complete") as file:
            # ticks that a busy machine misses are left out
            self.assertGreater(len(self.series(file, "solver")), 2700)
            self.assertLess(len(self.series(file, "solver")), 3002)
        self.quit()

    def test_go_on_after_a_pause(self):
        self.open()
        self.start()
        self.key("F6")
        time.sleep(0.3)
        self.screenshot("paused")
        self.key("F6")
        time.sleep(0.5)
        self.key("F7")
        with self.ended("complete") as file:
            self.assertEqual(self.status(file, RESUMED).sum(), 1)

    def test_wait_after_escape_and_go_on_or_end(self):
        self.open()
        self.start()
        self.key("Escape")
        time.sleep(0.5)
        self.screenshot("force-off")
        self.key("F6")
        time.sleep(0.5)
        self.key("Escape", "Escape", "F7")  # the second does nothing
        with self.ended("complete") as file:
            self.assertEqual(self.status(file, PAUSED).sum(), 2)
            self.assertEqual(self.status(file, RESUMED).sum(), 1)
            self.assertTrue(self.status(file, PAUSED)[-1])
        self.replay()
        self.quit()

    def test_are_whole_when_the_window_is_closed(self):
        self.open()
        self.start()
        time.sleep(1)
        self.quit()
        with self.ended("complete") as file:
            self.assertGreater(len(self.series(file, "solver")), 300)
        self.replay()


class Trials(Window):
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

    def focus(self, window):
        """Of a window that comes up: there is no window manager that would give it."""
        self.xdotool("windowfocus", self.wait("the window", window).split()[-1])
        time.sleep(0.5)

    def outcomes(self):
        with open(self.recording() + "trials.csv") as file:
            return [row["outcome"] for row in csv.DictReader(file)]

    def assert_changes_were_seen(self):
        """Of what came on and stayed, events.csv says when it came to the subject's screen."""
        with open(self.recording() + "events.csv") as file:
            events = [row for row in csv.DictReader(file) if row["event"] in ("message", "perturbation")]
        self.assertGreater(len(events), 10)
        seen = [float(row["shown_s"]) - float(row["time_s"]) for row in events if row["shown_s"]]
        self.assertGreater(len(seen), 0.8 * len(events))
        self.assertGreater(min(seen), 0)
        self.assertLess(sorted(seen)[len(seen) // 2], 0.5)  # this machine draws slowly

    def test_run_from_start_to_end_by_the_simulated_hand(self):
        def short(text):
            return text[:text.index("  redo: end_of_block")] + """  redo: never
  blocks:
    - { name: baseline, conditions: [right far up], order: sequential }
    - { name: rotation, kind: perturbed, perturb: rotation, conditions: [left near up] }
"""
        self.open(self.experiment("visuomotor-rotation", short))
        self.key("alt+v", "s")
        time.sleep(0.5)
        self.xdotool("windowfocus", self.name)
        self.key("alt+h", "Down")
        time.sleep(1)
        self.ask()
        self.screenshot("participant")
        self.answered("Escape")
        self.assertEqual(glob.glob(self.out + "/*"), [])
        self.start()
        time.sleep(1)
        self.screenshot("trial")
        self.key("F8")
        with self.ended("complete"):
            pass
        outcomes = self.outcomes()
        self.assertEqual(len(outcomes), 8)
        self.assertEqual(outcomes.count("skipped"), 1)
        self.assertEqual(outcomes.count("reached"), 7)
        info = pathlib.Path(self.recording() + "session.yaml").read_text()
        for line in ("id: S07", "age: 31", "sex: F", "handedness: right"):
            self.assertRegex(info, line.replace(": ", ": \"?"))
        self.assert_changes_were_seen()
        self.replay()
        self.quit()

    def test_get_the_keys_that_they_wait_for(self):
        def keys(text):
            return text[:text.index("task:")] + """task:
  regions:
    - { name: start, position_mm: [0, 0, 120], radius_mm: 8 }
  states:
    - name: ready
      show: [start]
      message: Press G when you are ready
      exits:
        - { when: key, key: g, outcome: ready, feedback: Good }
  blocks:
    - { name: all, repeats: 2 }
"""
        self.open(self.experiment("visuomotor-rotation", keys))
        self.start()
        time.sleep(1)
        self.screenshot("key")
        self.key("h", "g")
        time.sleep(0.5)
        self.key("g")  # while the feedback is shown: no answer
        time.sleep(1.5)
        self.key("g")
        with self.ended("complete"):
            pass
        self.assertEqual(self.outcomes(), ["ready", "ready"])


    def test_that_were_not_finished_are_offered_before_new_ones(self):
        """Three reaches by mouse, of which one is skipped; the rest is done in a second session."""
        def short(text):
            return text[:text.index("  redo: end_of_block")] + """  redo: never
  blocks: [{ name: baseline, conditions: [right far up, left far up, right near up], order: sequential }]
"""
        question = lambda: self.xdotool("search", "--onlyvisible", "--name", "^Go on")
        self.open(self.experiment("visuomotor-rotation", short))
        self.start()
        time.sleep(1)
        self.key("F8")
        time.sleep(1)
        self.key("F7")
        with self.ended("interrupted"):
            pass
        first = self.recording()
        time.sleep(1)
        self.key("F5")
        self.wait("the dialog", self.dialog)
        time.sleep(0.5)
        self.answered("Return")
        self.focus(question)
        self.screenshot("go-on")
        self.key("Escape")
        time.sleep(1)
        self.assertEqual(self.recording(), first)  # nothing began
        self.xdotool("windowfocus", self.name)
        self.key("F5")
        self.wait("the dialog", self.dialog)
        time.sleep(0.5)
        self.answered("Return")
        self.focus(question)
        self.key("Return")
        self.wait("the session", lambda: self.recording() != first)
        self.xdotool("windowfocus", self.name)
        time.sleep(1)
        self.screenshot("goes-on")
        for _ in range(12):  # three in each round
            self.key("F8")
            time.sleep(0.3)
        with self.ended("complete"):
            pass
        info = pathlib.Path(self.recording() + "session.yaml").read_text()
        self.assertIn("resumes: ", info)
        self.assertIn(os.path.basename(first.rstrip("/")), info)
        self.assertRegex(info, "mover: mouse")
        with open(self.recording() + "trials.csv") as file:
            rows = list(csv.DictReader(file))
        finished = [row["session_num"] for row in rows if row["outcome"] != "interrupted"]
        self.assertEqual(finished[0], "1")
        self.assertEqual(finished[-1], "2")
        self.replay()


class Rigs(Window):
    def with_rig(self, text):
        pathlib.Path(self.folder.name + "/rig.yaml").write_text(text)
        file = self.folder.name + "/experiment.yaml"
        pathlib.Path(file).write_text("scene: block.yaml\nrig: rig.yaml\n")
        self.open(file)

    def dialog(self, name):
        found = self.wait(f"the dialog '{name}'", lambda: self.xdotool("search", "--onlyvisible", "--name", name)).split()[-1]
        time.sleep(0.5)
        self.xdotool("windowfocus", found)
        time.sleep(0.3)
        return found

    def gone(self, name):
        self.wait(f"the end of '{name}'", lambda: not self.xdotool("search", "--onlyvisible", "--name", name))
        self.xdotool("windowfocus", self.name)
        time.sleep(0.5)

    def test_are_calibrated_in_the_window(self):
        self.with_rig(pathlib.Path("rigs/premium-misplaced.yaml").read_text())
        mine = pathlib.Path(self.folder.name + "/rig-calibration.yaml")
        for answer in ["Escape", "Return"]:
            self.key("alt+s", "c")
            self.dialog("^What the calibration found")
            self.screenshot("calibration")
            self.key(answer)
            self.gone("^What the calibration found")
            self.assertEqual(mine.exists(), answer == "Return")
        self.assertIn("agreement_rms_m", mine.read_text())
        self.assertIn("<svg", mine.with_suffix(".svg").read_text())
        self.assertIn("\ncalibration: rig-calibration.yaml\n", pathlib.Path(self.folder.name + "/rig.yaml").read_text())
        self.quit()

    def on_fakes(self, together, more=""):
        """Two devices that nobody moves, and how far apart they are said to have been; `more`: of the rig."""
        library = pathlib.Path(PROGRAM).resolve().parent / "src/devices/libfake_hd.so"
        pathlib.Path(self.folder.name + "/mine.yaml").write_text(
            f"date: {time.strftime('%Y-%m-%d')}\ndevices: [{{finger: thumb}}, {{finger: index, together_mm: {together}}}]\n")
        self.with_rig("title: Two fakes\ncalibration: mine.yaml\ndevices:\n" + "".join(
            f"  - {{finger: {finger}, backend: openhaptics, options: {{library: {library}, name: PHANToM {i}}}}}\n"
            for i, finger in [(1, "thumb"), (2, "index")]) + more)

    def test_lead_a_person_through_a_calibration_who_gives_up(self):
        self.on_fakes(0)
        self.key("alt+s", "c")
        self.dialog("^Calibration: Two fakes")
        self.key("Return")  # reset
        self.key("Return")  # link
        time.sleep(1)
        self.key("Return")  # carried too little: nobody moves them
        time.sleep(1)
        self.screenshot("guide")
        self.key("Escape")
        self.gone("^Calibration: Two fakes")
        self.assertEqual(list(pathlib.Path(self.folder.name).glob("rig-calibration*")), [])
        self.quit()

    def test_that_were_moved_since_their_calibration_are_warned_of(self):
        self.on_fakes(12)
        for answer, notes in [("Return", True), ("alt+s", False)]:
            before = len(glob.glob(self.out + "/*/raw.log"))
            self.key("F5")
            self.dialog("^Does the calibration still hold")
            self.screenshot("together")
            self.key(answer)
            self.gone("^Does the calibration still hold")
            self.wait("the start", lambda: len(glob.glob(self.out + "/*/raw.log")) > before)
            time.sleep(0.5)
            self.key("F7")
            with self.ended("complete"):
                pass
            time.sleep(1)
            info = pathlib.Path(self.recording() + "session.yaml").read_text()
            self.assertEqual("12.0 mm apart when the rig was calibrated" in info, notes, info)
        self.quit()


    def test_that_cannot_start_ask_for_nothing_more(self):
        self.on_fakes(0, "outlets: [{ kind: serial, options: { port: /dev/no-such-line } }]\n")
        self.key("F5")
        time.sleep(2)
        self.assertEqual(self.xdotool("search", "--onlyvisible", "--name", "^Does the calibration still hold"), "")
        self.assertEqual(glob.glob(self.out + "/*"), [])
        self.xdotool("windowfocus", self.name)
        self.quit()


class Force(Window):
    """On two fakes of real devices whose handles are pushed into the table, and what pushes back."""

    def setUp(self):
        super().setUp()
        self.felt = Felt(self.folder.name + "/felt")
        self.environment.update(DIHAPTIC_FAKE_FELT=self.folder.name + "/felt", DIHAPTIC_FAKE_PUSH="0 0 0.007")  # half a finger is 10 mm

    def open(self, more=""):
        library = pathlib.Path(PROGRAM).resolve().parent / "src/devices/libfake_hd.so"
        # a busy machine is another test's
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
        """A busy machine may draw the first picture for longer than a window may be silent: then it is told to go on."""
        for _ in range(6):
            end = time.monotonic() + 6
            while time.monotonic() < end:
                if min(self.forces()) > 1:
                    return
                time.sleep(0.05)
            self.key("F6")
        self.fail("no force came")

    def off_after(self, act, most):
        """How long after `act` force was off everywhere, and stays so; at most `most` [s]."""
        begin = time.monotonic()
        act()
        while max(self.forces()) > 0 and time.monotonic() < begin + 10:
            time.sleep(0.0002)
        took = time.monotonic() - begin
        self.assertLess(took, most)
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
        self.key("alt+v", "s")
        subject = self.wait("the subject's window",
                            lambda: self.xdotool("search", "--onlyvisible", "--name", "^Dihaptic: subject$")).strip()
        self.xdotool("windowfocus", self.name)
        self.start()
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
                print(f"Escape, {place}: {self.off_after(lambda: self.xdotool('key', 'Escape'), 0.5) * 1e3:.1f} ms")
                self.key("Escape", "Escape")  # what was open is closed by now
                self.xdotool("windowfocus", self.name)
                self.key("F6")
        with self.subTest("the subject's window"):
            self.pushed()
            self.xdotool("windowfocus", subject)
            time.sleep(0.3)
            self.off_after(lambda: self.xdotool("key", "Escape"), 0.5)
            self.key("F6")
            self.pushed()
        self.xdotool("windowfocus", self.name)
        self.off_after(lambda: self.key("F7"), 2)
        with self.ended("complete") as file:
            self.assertEqual(self.status(file, PAUSED).sum(), len(places) + 1)
        self.quit()

    def test_waits_for_a_word_after_escape_in_the_question_before_it(self):
        pathlib.Path(self.folder.name + "/mine.yaml").write_text(
            f"date: {time.strftime('%Y-%m-%d')}\ndevices: [{{finger: thumb}}, {{finger: index, together_mm: 0}}]\n")
        self.open("calibration: mine.yaml\n")
        self.key("F5")
        dialog = self.wait("the question", lambda: self.xdotool("search", "--onlyvisible", "--name", "^Does the calibration")).strip()
        time.sleep(0.5)
        self.xdotool("windowfocus", dialog)
        self.key("Escape")
        self.wait("its end", lambda: not self.xdotool("search", "--onlyvisible", "--name", "^Does the calibration"))
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
        for name in ("INT", "TERM", "HUP", "QUIT", "TSTP", "USR1", "ALRM", "XCPU"):
            with self.subTest(name):
                self.open()
                self.start()
                self.pushed()
                number = getattr(signal, "SIG" + name)
                took = self.off_after(lambda: self.window.send_signal(number), 0.2)
                print(f"SIG{name}: {took * 1e3:.1f} ms")
                self.assertEqual(self.window.wait(60), 1)
                self.assertEqual(self.last_frame(), [True, True])
                self.assertIn("state: interrupted", pathlib.Path(self.recording() + "session.yaml").read_text())
                self.log.seek(0)
                self.assertIn("force is off, and the session ends", self.log.read())
        self.replay()

    def test_goes_when_the_window_fails_is_killed_or_stopped(self):
        """By the process that owns the devices: nothing in the window could."""
        for name in ("SEGV", "ABRT", "BUS", "FPE", "ILL", "KILL", "STOP"):
            with self.subTest(name):
                self.open()
                self.start()
                self.pushed()
                # a second when it is stopped: the rig of these tests bears such a silence
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
                    self.assertEqual(self.window.wait(60), 1)
                    self.log.seek(0)
                    self.assertIn("The window is lost: force is off", self.log.read())
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


class Looks(Window):
    def test_has_a_subjects_window_and_is_dark_and_remembers_it(self):
        self.open()
        self.key("alt+v", "d")  # View, Dark
        self.key("alt+v", "s")
        subject = self.wait("the subject's window",
                            lambda: self.xdotool("search", "--onlyvisible", "--name", "^Dihaptic: subject$")).strip()
        self.key("F5")
        time.sleep(1)
        self.screenshot("subject")
        self.xdotool("windowclose", subject)
        self.key("F7")
        with self.ended("complete"):
            pass
        self.screenshot("dark")
        self.quit()
        self.assertIn("dark=true", (pathlib.Path(self.folder.name) / ".config/dihaptic/dihaptic.conf").read_text())


    def test_draws_what_is_not_to_be_seen_in_the_world(self):
        scene = pathlib.Path("scenes/tools.yaml").read_text().replace("../meshes", os.getcwd() + "/meshes")
        pathlib.Path(self.scene).write_text(scene)
        self.open()
        for layer in "hfcgap":
            self.key("alt+v", layer)
        self.key("alt+h", "Down")
        self.key("F5")
        time.sleep(4)
        self.screenshot("layers")


class Files(Window):
    def test_that_go_bad_leave_what_was_open_and_say_why(self):
        self.open()
        pathlib.Path(self.scene).write_text(SCENE.replace("mass_g: 100", "mas_g: 100"))
        time.sleep(1.5)
        self.screenshot("bad-file")
        self.key("F5")
        time.sleep(1)
        self.assertEqual(glob.glob(self.out + "/*"), [])
        pathlib.Path(self.scene).write_text(SCENE)
        time.sleep(1.5)
        self.start()
        self.quit()


    def test_that_are_edited_while_they_run_are_shown_after_it(self):
        self.open()
        title = lambda: self.xdotool("getwindowname", self.name).strip()
        before = title()
        self.start()
        pathlib.Path(self.scene).write_text(SCENE.replace("title: ", "title: Other, "))
        time.sleep(1)
        self.assertEqual(title(), before)
        self.key("F7")
        with self.ended("complete"):
            pass
        self.wait("the file as it is", lambda: "Other, " in title())

    def test_that_changed_a_moment_ago_are_shown_as_they_run(self):
        """Of an experiment's scene nobody watches whether it changes."""
        file = self.folder.name + "/experiment.yaml"
        pathlib.Path(file).write_text("scene: block.yaml\n")
        super().open(file)
        pathlib.Path(self.scene).write_text(SCENE.replace("size_mm: [40, 40, 40]", "size_mm: [40, 40, 90]")
                                            .replace("[0, 0, 20]", "[0, 0, 45]"))
        self.start()
        time.sleep(1)
        self.screenshot("changed")
        self.key("F7")
        with self.ended("complete") as recording:
            self.assertAlmostEqual(self.series(recording, "block_position")[0, 2], 0.045, delta=0.001)

    def test_are_not_opened_while_a_session_runs(self):
        self.open()
        self.start()
        for keys in (["ctrl+o"], ["alt+f", "o"]):
            self.key(*keys)
            time.sleep(0.5)
            self.assertEqual(self.xdotool("search", "--onlyvisible", "--name", "^Open a scene"), "")
            self.key("Escape")  # the menu
        self.screenshot("menu-in-a-session")
        self.key("F7")
        with self.ended("complete"):
            pass
        time.sleep(1)  # the window hears of it after the files are whole
        self.key("ctrl+o")
        self.wait("the dialog", lambda: self.xdotool("search", "--onlyvisible", "--name", "^Open a scene"))

    def test_that_take_long_can_be_cancelled(self):
        self.open()
        mesh = pathlib.Path(self.folder.name, "star.obj")
        mesh.write_text(star(teeth=2000))  # minutes
        slow = SCENE.replace("fingers:", f"  - {{ name: star, shape: mesh, file: {mesh}, unit: mm, concave: yes, "
                                         "mass_g: 10, position_mm: [100, 0, 30] }\nfingers:", 1)
        pathlib.Path(self.scene).write_text(slow)
        time.sleep(2)
        self.screenshot("opening")
        self.key("F7")
        time.sleep(1)
        pathlib.Path(self.scene).write_text(SCENE)
        time.sleep(1.5)
        self.start()
        self.quit()


def star(teeth):
    """A prism over a star, as OBJ: the more teeth, the longer it takes to cut."""
    n = 2 * teeth
    ring = [(1 + i % 2, math.pi * i / teeth) for i in range(n)]
    lines = [f"v {5 * r * math.cos(a):.6f} {5 * r * math.sin(a):.6f} {z}" for z in (0, 5) for r, a in ring]
    lines += ["f " + " ".join(str(n - i) for i in range(n)), "f " + " ".join(str(n + i + 1) for i in range(n))]
    lines += [f"f {i + 1} {(i + 1) % n + 1} {n + (i + 1) % n + 1} {n + i + 1}" for i in range(n)]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    unittest.main()
