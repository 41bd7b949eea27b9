"""A recorded session, looked at again: from the list of sessions, and by itself."""
import csv
import glob
import os
import pathlib
import subprocess
import time
import unittest

import numpy as np

from window import PROGRAM, Window

import soak


class Player(Window):
    def record(self):
        subprocess.run([PROGRAM, "run", "experiments/lift-block.yaml", "--out", self.out], check=True,
                       capture_output=True)
        return self.recording().rstrip("/")

    def saved_at(self, folder):
        """Times of the saved pictures, from their names."""
        return sorted(float(file.rpartition("-at-")[2][:-6]) for file in glob.glob(self.picture_of(folder, "*")))

    def picture_of(self, folder, at):
        """Pictures go to the user's documents or, if there is no such folder, to the home."""
        return f"{self.folder.name}/{os.path.basename(folder)}-at-{at}-s.png"

    def save(self, folder):
        before = len(self.saved_at(folder))
        self.key("ctrl+s")
        time.sleep(0.5)
        self.key("Return")
        self.wait("a picture", lambda: len(self.saved_at(folder)) > before)
        self.xdotool("windowfocus", self.name)  # there is no window manager to do so

    def test_shows_any_moment_of_a_recording(self):
        folder = self.record()
        self.open(folder)
        time.sleep(1)
        self.screenshot("player")
        self.key("End")
        self.save(folder)
        self.key("Home", "Right", "Right", "shift+Right")
        self.save(folder)
        self.assertEqual(self.saved_at(folder), [0.102, 9.5])
        self.key("Page_Down", "Page_Down", "Page_Down", "Page_Down")
        self.key("space")
        time.sleep(1.5)
        self.key("space")
        self.screenshot("player-played")
        self.save(folder)
        played = self.saved_at(folder)[1]
        self.assertGreater(played, 1)
        self.assertLess(played, 9.5)
        self.assertNotEqual(pathlib.Path(self.picture_of(folder, "9.500")).read_bytes(),
                            pathlib.Path(self.picture_of(folder, f"{played:.3f}")).read_bytes())
        self.key("ctrl+w")
        self.wait("the end", lambda: self.window.poll() is not None or True)

    def test_saves_its_curves_as_a_figure_and_as_numbers(self):
        folder = self.record()
        self.open(folder)
        for kind, begins in (("svg", b"<?xml"), ("pdf", b"%PDF"), ("png", b"\x89PNG"), ("csv", b"time_s,grip_force_N,load_force_N")):
            file = pathlib.Path(self.folder.name, "curves." + kind)
            self.key("ctrl+shift+c")
            dialog = self.wait("the dialog", lambda: self.dialogs("^Save the stretch"))[-1]
            self.xdotool("windowfocus", dialog)
            time.sleep(0.5)
            self.key("ctrl+a")
            self.type(str(file))
            self.key("Return")
            self.wait("the file", file.is_file)
            self.assertTrue(file.read_bytes().startswith(begins), kind)
            self.xdotool("windowfocus", self.name)
        with open(file) as table:
            rows = list(csv.DictReader(table))
        self.assertEqual(len(rows), 9501)  # a row for each tick
        self.assertAlmostEqual(max(float(row["grip_force_N"]) for row in rows), 4, delta=3)
        self.quit()

    def test_never_replaces_what_belongs_to_a_session(self):
        folder = self.record()
        texture = pathlib.Path(folder, "curves.csv")
        texture.write_text("the laboratory's own")
        before = {name: pathlib.Path(folder, name).read_bytes() for name in os.listdir(folder)}
        self.open(folder)
        for keys, title, name in (("ctrl+shift+c", "^Save the stretch", "lifts.csv"), ("ctrl+shift+c", "^Save the stretch", "curves.csv"),
                                  ("ctrl+s", "^Save the picture", "session.yaml"),
                                  ("ctrl+shift+s", "^Save a video", "session.nwb")):
            with self.subTest(name):
                self.key(keys)
                dialog = self.wait("the dialog", lambda: self.dialogs(title))[-1]
                self.xdotool("windowfocus", dialog)
                time.sleep(0.5)
                self.key("ctrl+a")
                self.type(f"{folder}/{name}")
                self.key("Return")
                replace = self.wait("the question", lambda: [other for other in self.dialogs("Save|^$") if other != dialog])
                self.xdotool("windowfocus", replace[-1])
                time.sleep(0.5)
                self.screenshot("player-replace-" + name)
                self.key("alt+y")  # yes, replace it
                self.wait("the dialog's end", lambda: not self.xdotool("getwindowname", dialog).startswith("Save")
                          or dialog not in self.dialogs(title))
                refusal = self.wait("the refusal", lambda: self.dialogs(title))[-1]
                self.xdotool("windowfocus", refusal)
                time.sleep(0.5)
                self.screenshot("player-refuses-" + name)
                self.key("Return")
                self.wait("the refusal's end", lambda: not self.dialogs(title))
                self.xdotool("windowfocus", self.name)
                time.sleep(0.3)
        self.assertEqual({name: pathlib.Path(folder, name).read_bytes() for name in os.listdir(folder)}, before)
        self.quit()

    def test_draws_what_is_ticked_in_the_list_of_curves(self):
        folder = self.record()
        self.open(folder)
        self.settle()

        def chart():
            return self.pixels(60, 720, 800, 140).astype(int)

        before = chart()
        self.key("ctrl+f")
        self.type("block.position.z")
        self.key("Tab", "Down", "space")
        self.settle()
        self.screenshot("player-ticked")
        self.assertGreater(np.abs(chart() - before).mean(), 1)
        self.quit()

    @soak.alone
    def test_is_opened_from_the_list_of_sessions(self):
        folder = self.record()
        self.open()
        self.key("ctrl+shift+o")
        time.sleep(0.5)
        self.type("S07")  # a participant without sessions leaves none to open
        self.screenshot("sessions-of-nobody")
        self.key("Return")
        time.sleep(1)
        self.assertTrue(self.dialogs("^Recorded sessions$"))
        self.key("ctrl+a", "BackSpace")
        self.screenshot("sessions")
        self.key("Return")
        name = os.path.basename(folder)
        self.wait("the player",
                  lambda: self.xdotool("search", "--onlyvisible", "--name", f"^{name} - Dihaptic$"))

    @soak.alone
    def test_a_video_of_a_stretch_is_saved(self):
        folder = self.record()
        self.open(folder)
        time.sleep(1)
        for _ in range(12):  # zoomed to a part of the session
            self.xdotool("mousemove", "--window", self.name, "400", "750", "click", "4")
        self.key("ctrl+shift+s")
        time.sleep(0.5)
        self.screenshot("player-video")
        self.key("Return")
        video = pathlib.Path(folder, "session.mp4")
        self.wait("the video", video.is_file)
        told = subprocess.run(["ffprobe", "-v", "error", "-show_entries", "format=duration:stream=width,height", "-of",
                               "default=nokey=0", video], capture_output=True, text=True, check=True).stdout
        facts = dict(line.split("=") for line in told.split() if "=" in line)
        self.assertGreater(float(facts["duration"]), 0.1)
        self.assertLess(float(facts["duration"]), 5)
        self.assertGreater(int(facts["width"]), 600)

    def test_a_note_is_kept_with_its_session(self):
        folder = self.record()
        self.open()
        self.key("ctrl+shift+o")
        time.sleep(0.5)
        self.key("alt+n")
        self.settle()
        self.xdotool("type", "coughed in the lift")
        self.screenshot("note")
        self.key("Tab", "Return")
        note = pathlib.Path(folder, "note.txt")
        self.wait("the note", note.is_file)
        self.assertEqual(note.read_text(), "coughed in the lift\n")
        time.sleep(0.5)
        self.screenshot("sessions-note")
        subprocess.run([PROGRAM, "report", folder], check=True, capture_output=True)
        self.assertIn("coughed in the lift", pathlib.Path(folder, "report.html").read_text())

    @soak.alone
    def test_shows_two_sessions_side_by_side_at_the_same_place_of_a_trial(self):
        starts = []
        for i in (1, 2):
            subprocess.run([PROGRAM, "run", "experiments/first-trials.yaml", "--simulate", "--participant", f"sim-00{i}",
                            "--seed", str(i), "--out", self.out], check=True, capture_output=True)
        folders = sorted(path.rstrip("/") for path in glob.glob(self.out + "/*/"))
        for folder in folders:
            with open(folder + "/trials.csv") as file:
                starts.append([float(row["start_time"]) for row in csv.DictReader(file)])
        self.assertNotAlmostEqual(starts[0][2], starts[1][2], delta=0.05)
        self.open(*folders)
        first, second = (self.xdotool("search", "--name", f"^{os.path.basename(folder)} - Dihaptic$").strip()
                         for folder in folders)
        self.xdotool("windowmove", first, "0", "0", "windowsize", first, "700", "900", "windowmove", second, "700", "0",
                     "windowsize", second, "700", "900", "windowfocus", first)
        for name in (first, second):
            self.assertIn("Geometry: 700x900", self.xdotool("getwindowgeometry", name))
        steps = int((starts[0][2] + 0.5) * 10)  # steps of 100 ticks, into the third trial
        self.xdotool("key", "--delay", "30", *["shift+Right"] * steps)
        time.sleep(1)
        self.screenshot("two-sessions")
        at = []
        for self.name, folder in zip((first, second), folders):
            self.xdotool("windowfocus", self.name)
            self.save(folder)
            at += self.saved_at(folder)
        self.assertGreater(at[0] - starts[0][2], 0.2)
        self.assertAlmostEqual(at[0] - starts[0][2], at[1] - starts[1][2], delta=0.0021)

    def test_refuses_a_folder_that_is_no_session(self):
        told = subprocess.run([PROGRAM, "gui", self.folder.name], env=self.environment, capture_output=True, text=True)
        self.assertEqual(told.returncode, 2, told.stderr)
        self.assertIn("session", told.stderr)

    def test_refuses_two_scenes(self):
        told = subprocess.run([PROGRAM, "gui", self.scene, self.scene], env=self.environment, capture_output=True, text=True)
        self.assertEqual(told.returncode, 2, told.stderr)
        self.assertIn("Name one scene or experiment", told.stderr)


if __name__ == "__main__":
    unittest.main()
