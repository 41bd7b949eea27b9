"""The subject's window, the dark theme, and what else is drawn on request."""
import os
import pathlib
import time
import unittest

from window import Window


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


if __name__ == "__main__":
    unittest.main()
