"""A monkey at the window: random keys, clicks, wheels, drags, pastes and drops, in each of its views, while two fakes of
real devices push and a session runs. The window must neither crash nor hang, its sessions have to be whole, and no force
may be left.

DIHAPTIC_MONKEY: how long it plays [s], otherwise 10, and 600 in the soak. DIHAPTIC_SEED: what it does, 1 if it is not set.
"""
import glob
import os
import pathlib
import random
import subprocess
import time
import unittest

from window import PROGRAM, Window, patient
from felt import Felt
import soak

TIME = float(os.environ.get("DIHAPTIC_MONKEY", soak.of(5, 600)))
SEED = int(os.environ.get("DIHAPTIC_SEED", 1))

# Keys, without those that quit the program or remove files in a dialog for choosing a file.
KEYS = """F4 F5 F5 F5 F6 F6 F7 F8 F9 F10 Escape Return Return Tab Tab shift+Tab Up Down Left Right Prior Next Home End BackSpace
space h v y 1 2 a s x comma minus period ctrl+e ctrl+e ctrl+z ctrl+shift+z ctrl+s ctrl+r ctrl+period ctrl+a ctrl+c ctrl+v
ctrl+v ctrl+x ctrl+space shift+Insert ctrl+shift+o ctrl+Home ctrl+End ctrl+Up ctrl+shift+Left ctrl+plus alt+Left alt+Prior
shift+Up ctrl+t ctrl+1 ctrl+2 ctrl+3 alt+f alt+s alt+v alt+h alt+a alt+n alt+g alt+d alt+o F1""".split()
#: Dialogs in which a monkey could name any file of this machine.
CHOOSES_FILES = "^(Open a scene|Save|Where sessions go)"


class Monkey(Window):
    real_rig = True

    def setUp(self):
        super().setUp()
        self.felt = Felt(self.folder.name + "/felt")
        self.environment.update(DIHAPTIC_FAKE_FELT=self.folder.name + "/felt", DIHAPTIC_FAKE_PUSH="0 0 0.007")
        self.random = random.Random(SEED)
        library = pathlib.Path(PROGRAM).resolve().parent / "src/devices/libfake_hd.so"
        self.allow(library)
        pathlib.Path(self.folder.name + "/rig.yaml").write_text(
            "title: Two fakes\nsettings: {safety: {max_pause_ms: 1000}}\ndevices:\n" + "".join(
                f"  - {{finger: {finger}, position_mm: [{x}, 0, 0], backend: openhaptics, "
                f"options: {{library: {library}, name: PHANToM {i}}}}}\n"
                for i, finger, x in [(1, "thumb", -100), (2, "index", 100)]))
        self.experiment = self.folder.name + "/experiment.yaml"
        pathlib.Path(self.experiment).write_text("scene: block.yaml\nrig: rig.yaml\n")

    def windows(self):
        """All open windows, the newest last."""
        return self.xdotool("search", "--onlyvisible", "--pid", str(self.window.pid)).split()

    def choose_no_file(self):
        for dialog in self.dialogs(CHOOSES_FILES):
            self.xdotool("windowfocus", dialog, "key", "Escape")

    def place(self):
        width, height = map(int, self.size.split("x"))
        return [str(self.random.randrange(width)), str(self.random.randrange(height))]

    def act(self):
        r = self.random
        kind = r.choices(["key", "type", "click", "drag", "wheel", "focus", "paste", "file"],
                         [40, 10, 25, 6, 6, 6, 4, 2])[0]
        if kind == "key":
            return ["key", *r.choices(KEYS, k=r.randint(1, 4))]
        if kind == "type":
            return ["type", "--delay", "2", "--", "".join(r.choices("abz019 :-[]{},#'\"", k=r.randint(1, 12)))]
        if kind == "click":
            return ["mousemove", *self.place(), "click", "--repeat", str(r.randint(1, 2)), str(r.choice([1, 1, 1, 2, 3]))]
        if kind == "drag":  # may also drag and drop a selected text
            held = str(r.choice([1, 1, 3]))
            return ["mousemove", *self.place(), "mousedown", held, "mousemove", *self.place(), "mousemove", *self.place(),
                    "mouseup", held]
        if kind == "wheel":
            return ["mousemove", *self.place(), "click", "--repeat", str(r.randint(1, 9)), str(r.choice([4, 5]))]
        if kind == "paste":
            return ["mousemove", *self.place(), "click", "1", "key", r.choice(["ctrl+v", "shift+Insert"]), "click", "2"]
        if kind == "file":
            self.change_file()
        windows = self.windows()
        return ["windowfocus", r.choice(windows)] if windows else ["key", "Escape"]

    def change_file(self):
        """As another program would."""
        scene, r = pathlib.Path(self.scene), self.random
        what = r.choice(["same", "other", "gone", "garbage"])
        if what == "gone":
            scene.unlink(missing_ok=True)
        else:
            text = pathlib.Path(self.folder.name, "good").read_text()
            scene.write_text({"same": text, "other": text.replace("size_mm: [40", "size_mm: [50"), "garbage": text[:r.randrange(len(text))]}[what])

    def look(self, done):
        """Whether the window still exists; opens another if the monkey has quit."""
        code = self.window.poll()
        if code is None:
            return
        self.log.seek(0)
        self.assertEqual(code, 0, f"after {done}: {self.log.read()}")
        self.open_next()

    def open_next(self):
        """What the views are of: a scene, trials, what was recorded, what there is to begin with."""
        if self.window is not None and self.window.poll() is None:
            self.close()
        pathlib.Path(self.scene).write_text(pathlib.Path(self.folder.name, "good").read_text())
        # the monkey may have saved what it typed
        pathlib.Path(self.experiment).write_text("scene: block.yaml\nrig: rig.yaml\n")
        pathlib.Path(self.trials).write_text(
            pathlib.Path("experiments/first-trials.yaml").read_text().replace("../", os.getcwd() + "/"))
        self.open(self.next_files())
        self.key("ctrl+e", "F5")
        time.sleep(1)
        for dialog in self.dialogs("^(Before the session|Who does)"):
            self.xdotool("windowfocus", dialog)
            time.sleep(0.3)
            self.key("alt+n", "Return")  # a new participant
        self.xdotool("windowfocus", self.name)

    def next_files(self):
        self.opened_so_far = getattr(self, "opened_so_far", -1) + 1
        return [self.experiment, self.trials, self.scene][self.opened_so_far % 3]

    def close(self):
        """Every session ends whole, and nothing more is asked than whether to save."""
        end = time.monotonic() + patient(90)
        while self.window.poll() is None and time.monotonic() < end:
            for window in self.windows():
                self.xdotool("windowfocus", window, "key", "Escape")
            self.xdotool("windowfocus", self.name, "key", "F7")
            self.xdotool("windowfocus", self.name, "key", "ctrl+q")
            time.sleep(0.7)
            for dialog in self.dialogs("^Save"):
                self.xdotool("windowfocus", dialog)
                time.sleep(0.3)
                self.key("Tab", "space")  # discards it
        if self.window.poll() is None:
            self.screenshot("monkey-stays")
            names = [self.xdotool("getwindowname", window).strip() for window in self.windows()]
            self.fail(f"it does not close: {names}")
        self.assertEqual(self.window.poll(), 0)
        self.assertEqual(max(self.felt.forces()), 0)

    def test_breaks_nothing(self):
        pathlib.Path(self.folder.name, "good").write_text(pathlib.Path(self.scene).read_text())
        self.trials = self.folder.name + "/trials.yaml"
        foreign = pathlib.Path(self.folder.name, ".block.draft.yaml")
        foreign.write_text("theirs")
        self.open_next()
        last, each, done, acts = time.monotonic() + TIME, max(7, TIME / 12), [], 0
        change = time.monotonic() + each
        while time.monotonic() < last:
            self.choose_no_file()
            done = (done + [self.act()])[-12:]
            self.xdotool(*done[-1])
            acts += 1
            self.look(done)
            if time.monotonic() > change:
                self.screenshot(f"monkey-{self.opened_so_far}")
                self.open_next()
                change = time.monotonic() + each
        self.close()
        print(f"seed {SEED}: {acts} acts, {self.opened_so_far + 1} windows, {len(glob.glob(self.out + '/*/raw.log'))} sessions")
        self.assertEqual(foreign.read_text(), "theirs")
        for session in glob.glob(self.out + "/*/"):
            made = subprocess.run([PROGRAM, "replay", session], capture_output=True, text=True)
            self.assertEqual(made.returncode, 0, made.stdout + made.stderr)


if __name__ == "__main__":
    unittest.main()
