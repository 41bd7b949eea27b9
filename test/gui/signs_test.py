"""The sign over the scene after a session that did not start, broke off or was left unfinished: not the one of a session
that may start, but one with the colour of a fault or a warning."""
import os
import pathlib
import resource
import time
import unittest

import numpy as np

from window import SCENE, Participants

#: Colours of signs (app/gui/theme.cpp).
IDLE, FAULT, WARNING = (0x3d, 0x46, 0x52), (0x7a, 0x1f, 0x7f), (0xa3, 0x52, 0x00)


class Signs(Participants):
    def shows(self, colour):
        """Whether a sign of this colour is over the scene."""
        part = self.screen()[40:860, :980].astype(int)
        return (np.abs(part - colour).max(axis=2) <= 3).sum() > 5000

    def stays(self, colour, name):
        self.wait("the sign " + name, lambda: self.shows(colour))
        time.sleep(1)  # the file may be read again
        self.assertTrue(self.shows(colour), name)
        self.screenshot("sign-" + name)

    def short(self, text):
        return text[:text.index("  redo: end_of_block")] + """  redo: never
  blocks: [{ name: baseline, conditions: [right far up, left far up, right near up], order: sequential }]
"""

    def start_scene(self):
        self.key("F5")
        self.wait("the recording", lambda: list(pathlib.Path(self.out).glob("*/raw.log")))
        time.sleep(1)

    def test_says_that_the_folder_for_sessions_takes_none(self):
        pathlib.Path(self.out).write_text("no folder")
        self.open()
        self.assertTrue(self.shows(IDLE))
        self.key("F5")
        self.stays(FAULT, "no-folder")
        os.remove(self.out)
        self.start_scene()
        self.key("F7")
        with self.ended("complete"):
            pass
        self.stays(IDLE, "recorded")
        self.assertFalse(self.shows(FAULT))
        self.quit()

    def test_says_that_the_disk_was_full(self):
        self.open()
        self.start_scene()
        resource.prlimit(self.window.pid, resource.RLIMIT_FSIZE, (1000, resource.RLIM_INFINITY))
        self.stays(FAULT, "full-disk")
        resource.prlimit(self.window.pid, resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
        self.key("ctrl+3")  # the list of sessions
        time.sleep(1)
        self.assertFalse(self.shows(FAULT))
        self.key("alt+r")  # no report, because the session's files are missing; the list says why
        self.stays(FAULT, "no-report")
        self.quit()

    def test_says_that_the_text_has_errors(self):
        self.open()
        self.key("ctrl+e", "ctrl+End", "Return")
        self.type("bodis: []")
        time.sleep(1.5)
        self.assertFalse(self.shows(FAULT))
        self.key("F5")
        self.stays(FAULT, "text-with-errors")
        for _ in range(9):
            self.key("BackSpace")
        self.wait("the sign's end", lambda: not self.shows(FAULT))
        self.assertEqual(pathlib.Path(self.scene).read_text(), SCENE)

    def test_says_that_the_text_cannot_be_saved(self):
        self.open()
        self.key("ctrl+e", "ctrl+End", "Return")
        self.type("# mine")
        time.sleep(1.5)
        resource.prlimit(self.window.pid, resource.RLIMIT_FSIZE, (100, resource.RLIM_INFINITY))
        self.key("F5")
        self.stays(FAULT, "not-saved")
        self.assertEqual(pathlib.Path(self.scene).read_text(), SCENE)

    def test_says_how_many_trials_are_left(self):
        self.open(self.experiment("visuomotor-rotation", self.short))
        self.start()
        time.sleep(1)
        self.key("F8")
        time.sleep(1)
        self.key("F7")
        with self.ended("interrupted"):
            pass
        self.stays(WARNING, "unfinished")
        self.quit()


if __name__ == "__main__":
    unittest.main()
