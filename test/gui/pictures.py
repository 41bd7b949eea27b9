"""The pictures of the window in docs/pictures, each drawn from what it shows: `./dev pictures` writes them.

Usage: gui/pictures.py PROGRAM docs/pictures, from the project's folder.
"""
import os
import pathlib
import shutil
import subprocess
import time
import unittest

import window
from window import Window

# from whichever folder, since a picture shows paths relative to it
window.PROGRAM = os.path.abspath(window.PROGRAM)
window.SCREENSHOTS = os.path.abspath(window.SCREENSHOTS)


class Pictures(Window):
    """Each test draws the picture of its name."""

    def test_window(self):
        """The mouse has lifted the block of the first scene."""
        self.open("scenes/block-on-table.yaml")
        self.start()
        self.xdotool("click", "--repeat", "19", "--delay", "20", "5")  # squeezes
        self.recorded("the grip", lambda file: self.series(file, "grip_force")[-1] > 1.5)
        self.move(0, -4, 40)
        self.recorded("the lift", lambda file: self.series(file, "block_position")[-1, 2] > 0.05)
        time.sleep(1)
        self.screenshot("window")
        self.key("F7")
        with self.ended("complete"):
            pass
        self.quit()

    def test_player(self):
        """A block that a script has lifted, and holds."""
        subprocess.run([window.PROGRAM, "run", "experiments/lift-block.yaml", "--out", self.out], check=True, capture_output=True)
        self.open(self.recording().rstrip("/"))
        self.key("Home", *["Page_Down"] * 6)
        self.settle()
        time.sleep(3)  # then, all pixels are drawn
        self.screenshot("player")
        self.quit()

    def test_calibration(self):
        """What a calibration of two misplaced devices found."""
        pathlib.Path(self.folder.name, "rigs").mkdir()
        shutil.copy("rigs/premium-misplaced.yaml", self.folder.name + "/rigs")
        pathlib.Path(self.folder.name, "lift.yaml").write_text("scene: block.yaml\nrig: rigs/premium-misplaced.yaml\n")
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder.name)
        self.open("lift.yaml")
        self.key("alt+s", "c")
        dialog = self.wait("the result", lambda: self.dialogs("^Result of the calibration"))[-1]
        time.sleep(1)
        self.screenshot("calibration")
        self.xdotool("windowfocus", dialog)
        self.key("Escape")
        self.wait("the result's end", lambda: not self.dialogs("^Result of the calibration"))
        self.xdotool("windowfocus", self.name)
        self.quit()


if __name__ == "__main__":
    unittest.main()
