"""The participant's window, the dark theme, and what else is drawn on request."""
import os
import pathlib
import time
import unittest

import numpy as np

from window import Window

import soak


class Looks(Window):
    def open_participants_window(self):
        self.key("alt+v", "s")
        window = self.wait("the participant's window",
                           lambda: self.xdotool("search", "--onlyvisible", "--name", "^Dihaptic: participant$")).strip()
        time.sleep(0.5)
        self.xdotool("windowfocus", self.name)  # it has taken the keyboard
        return window

    def test_has_a_participants_window_and_is_dark_and_remembers_it(self):
        self.open()
        self.key("alt+v", "d")  # View, Dark
        participant = self.open_participants_window()
        self.start()
        time.sleep(1)
        self.screenshot("participant")
        self.xdotool("windowclose", participant)
        self.key("F7")
        with self.ended("complete"):
            pass
        self.screenshot("dark")
        self.quit()
        self.assertIn("dark=true", (pathlib.Path(self.folder.name) / ".config/dihaptic/dihaptic.conf").read_text())

    def test_draws_all_pixels_when_nothing_moves(self):
        self.open()
        still = self.pixels(0, 30, 980, 700).astype(int)
        self.key("alt+v", "i")  # View, Fine pictures
        self.settle()
        self.screenshot("fine")
        fine = self.pixels(0, 30, 980, 700).astype(int)
        self.assertLess(np.abs(fine - still).mean(), 0.01)
        self.assertGreater(np.abs(fine[:, 1:] - fine[:, :-1]).max(), 60)  # an edge between two pixels

    @soak.alone
    def test_draws_what_is_not_to_be_seen_in_the_world(self):
        scene = pathlib.Path("scenes/tools.yaml").read_text().replace("../meshes", os.getcwd() + "/meshes")
        pathlib.Path(self.scene).write_text(scene)
        self.open()
        for layer in "hfcgape":
            self.key("alt+v", layer)
        self.key("alt+a", "Down")
        self.key("F5")
        time.sleep(4)
        self.screenshot("layers")

    @soak.alone
    def test_the_camera_moves_by_keys(self):
        self.open()
        self.xdotool("mousemove", "200", "300", "click", "1")  # the scene has the keyboard

        def look():
            self.settle()
            return self.pixels(0, 30, 980, 700).astype(int)

        def differs(key):
            self.key(key)
            return np.abs(look() - before).mean()

        before = look()
        for there, back in (("ctrl+Left", "ctrl+Right"), ("ctrl+Up", "ctrl+Down"), ("ctrl+plus", "ctrl+minus"),
                            ("ctrl+shift+Left", "ctrl+shift+Right"), ("ctrl+shift+Up", "ctrl+shift+Down")):
            with self.subTest(there):
                self.assertGreater(differs(there), 0.5)
                self.assertLess(differs(back), 0.1)
        self.key("ctrl+Left", "ctrl+Left")
        self.assertLess(differs("Home"), 0.1)
        self.quit()

    @soak.alone
    def test_draws_pictures_metals_and_meshes_with_colours(self):
        self.open("scenes/looks.yaml")
        self.key("F5")
        time.sleep(3)
        self.screenshot("materials")
        red, green, blue = self.screen()[:800, :1000].astype(int).transpose(2, 0, 1)
        self.assertGreater(((red > green + 40) & (green > blue + 20)).sum(), 50_000)  # oak
        self.assertGreater(((red > 110) & (red > 3 * green)).sum(), 1000)  # the apple's red cheek

    def test_shows_the_operator_what_the_participant_sees(self):
        self.open()
        self.key("alt+v", "n", "w")
        self.screenshot("no-participant")
        participant = self.open_participants_window()
        self.start()
        time.sleep(1)
        seen = self.pixels(0, 0, 800, 600)
        self.xdotool("windowmove", participant, "1390", "890")
        time.sleep(2)
        self.screenshot("mirror")
        panel = self.pixels(1022, 260, 374, 590)
        drawn = np.flatnonzero((panel != panel[0, 0]).any(axis=1))  # the picture has the panel's width, and not its height
        mirrored = panel[drawn[0]:drawn[-1] + 1]
        self.assertLess(mirrored.shape[0], 400)
        alike = np.corrcoef(coarse(seen[30:-30]), coarse(mirrored))[0, 1]
        self.assertGreater(alike, 0.95)


def coarse(pixels):
    """Means of 8 by 8 parts of a picture, in a row."""
    rows = np.array_split(pixels, 8)
    return np.array([part.mean() for row in rows for part in np.array_split(row, 8, axis=1)])


if __name__ == "__main__":
    unittest.main()
