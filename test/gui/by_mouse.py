"""Whole experiments by mouse, as a person with a mouse does them: a long check of `./dev soak`. Each has every condition
and every state, and fewer repeats than it is shipped with; time limits are the shipped ones. Needs the machine alone.

Usage: gui/by_mouse.py PROGRAM [SCREENSHOTS [CLASS[.TEST]]]
"""
import collections
import os
import pathlib
import re
import shutil
import time
import unittest

from window import Participants

PIXELS = 3.2  # per millimetre, with the scenes' first cameras


class ByMouse(Participants):
    def shift(self, right, up, seconds):
        """The hand, by millimetres in the picture's plane."""
        steps = max(1, round(seconds / 0.016))
        done = [0, 0]
        for i in range(1, steps + 1):
            to = [round(PIXELS * right * i / steps), round(-PIXELS * up * i / steps)]
            self.xdotool("mousemove_relative", "--", str(to[0] - done[0]), str(to[1] - done[1]))
            done = to
            time.sleep(0.016)

    def back(self):
        """The hand goes to its start, and the pointer to the middle of the scene."""
        self.xdotool("mousemove", "480", "400", "key", "F4")
        time.sleep(0.15)

    def grip_and_raise(self, by):
        self.hold("v", 0.3)
        self.shift(0, -40, 0.4)
        self.hold("space", 1.7)
        self.shift(0, by, 0.5)

    def end(self, one_trial, longest):
        """Does trials until the session has ended."""
        last = time.monotonic() + longest
        while "state: running" in self.info() and time.monotonic() < last:
            one_trial()
        with self.ended("complete"):
            pass
        outcomes = collections.Counter(self.outcomes())
        print(f"{self.id()}: {dict(outcomes)}")
        if "DIHAPTIC_KEEP" in os.environ:
            shutil.copytree(self.recording(), os.environ["DIHAPTIC_KEEP"], dirs_exist_ok=True)
        return outcomes

    def info(self):
        with open(self.recording() + "session.yaml") as file:
            return file.read()

    def fewer(self, name, changes):
        def change(text):
            for what, by in changes:
                text, count = re.subn(what, by, text)
                assert count > 0, what
            return text.replace("../rigs", os.getcwd() + "/rigs")
        return self.experiment(name, change)

    def click(self, x, y):
        self.xdotool("mousemove", str(x), str(y))
        time.sleep(0.4)
        self.xdotool("click", "1")
        time.sleep(0.6)

    def test_from_the_start_page_to_the_report(self):
        """As somebody does who sees the window for the first time: nothing but what it offers, and no key but the hand's."""
        self.open_without_a_file()
        time.sleep(3)
        self.click(400, 220)  # the second picture: first-trials
        self.wait("the file", lambda: self.xdotool("getwindowname", self.name).startswith("Five lifts"))
        self.settle()
        self.click(1209, 234)  # Start
        dialog = self.wait("the dialog", self.dialog).split()[-1]
        time.sleep(0.7)
        place = dict(line.split("=") for line in self.xdotool("getwindowgeometry", "--shell", dialog).split())
        left, top, width, height = (int(place[name]) for name in ("X", "Y", "WIDTH", "HEIGHT"))
        self.xdotool("windowfocus", dialog)
        self.click(left + width - 55, top + 22)  # New: S01
        self.click(left + width - 115, top + height - 24)  # Start
        self.recording()
        self.xdotool("windowfocus", self.name)
        time.sleep(1)

        def trial():
            self.back()
            self.grip_and_raise(34)
            time.sleep(1.6)
            self.shift(0, -38, 0.6)
            self.hold("v", 0.6)
            self.back()
            self.shift(0, 30, 0.3)
            time.sleep(0.8)
        outcomes = self.end(trial, 300)
        self.assertEqual(outcomes["held"], 5, outcomes)
        self.settle()
        time.sleep(1)
        self.screenshot("recorded-by-mouse")
        self.click(1306, 284)  # Report
        page = self.wait("the report", self.opened)[-1]
        self.assertIn("Five lifts", pathlib.Path(page.removeprefix("file://")).read_text())
        self.quit()

    def test_grip_and_lift(self):
        self.open(self.fewer("grip-and-lift", [("repeats: 4", "repeats: 1")]))
        self.start()

        def trial():
            self.back()
            self.grip_and_raise(50)
            time.sleep(2.3)
            self.shift(0, -54, 0.6)
            self.hold("v", 0.6)
            self.back()
            self.shift(0, 30, 0.3)
            time.sleep(0.8)
        outcomes = self.end(trial, 600)
        self.assertEqual(outcomes["lifted"], 10, outcomes)

    def test_visuomotor_rotation(self):
        few = "conditions: [right far up, left near down], "
        self.open(self.fewer("visuomotor-rotation", [
            ("kind: baseline, repeats: 2", f"kind: baseline, {few}repeats: 1"),
            ("repeats: 8\n", "repeats: 2\n      conditions: [right far up, left near down]\n"), ("count: 6", "count: 1"),
            ("perturb: clamp, repeats: 2", f"perturb: clamp, {few}repeats: 1"),
            ("kind: washout, repeats: 3", f"kind: washout, {few}repeats: 1")]))
        self.start()

        def trial():
            self.back()
            time.sleep(0.5)
            self.shift(56, 56, 0.3)
            time.sleep(0.3)
        outcomes = self.end(trial, 600)
        self.assertEqual(outcomes["reached"], 44, outcomes)

    def test_visual_scaling(self):
        self.open(self.fewer("visual-scaling", [("trials: 25", "trials: 2")]))
        self.start()

        def trial():
            self.back()
            self.grip_and_raise(35)
            time.sleep(0.4)
            self.shift(40, 40, 0.8)
            time.sleep(1)
            self.key("y")
            self.hold("v", 0.6)
            self.back()
            self.shift(0, 50, 0.3)
            time.sleep(0.8)
        outcomes = self.end(trial, 900)
        self.assertEqual(outcomes["more"], 12, outcomes)


if __name__ == "__main__":
    unittest.main()
