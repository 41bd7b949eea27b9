"""The window on displays of other sizes: what opens has room on them, and the keyboard reaches it. `./dev soak` looks at more
sizes; the pictures are for people."""
import time
import unittest

from window import Participants, starts_programs
import soak


@starts_programs
class Small(Participants):
    size = "1024x700"
    scale = "1"

    def setUp(self):
        super().setUp()
        self.environment["QT_SCALE_FACTOR"] = self.scale

    def look(self, name):
        """A picture of the display, on which every window of the program must fit."""
        time.sleep(0.7)
        self.screenshot(f"{name}-{self.size}")
        width, height = map(int, self.size.split("x"))
        windows = self.xdotool("search", "--onlyvisible", "--pid", str(self.window.pid)).split()
        self.assertTrue(windows)
        for window in windows:
            geometry = self.xdotool("getwindowgeometry", "--shell", window)  # empty if the window has closed meanwhile
            place = dict(line.split("=") for line in geometry.split())
            if place:
                self.assertLessEqual(int(place["X"]) + int(place["WIDTH"]), width, name)
                self.assertLessEqual(int(place["Y"]) + int(place["HEIGHT"]), height, name)

    def back(self):
        """Gives the keyboard back to the operator's window, which no window manager does here."""
        self.key("Escape")
        time.sleep(0.3)
        self.xdotool("windowfocus", self.name)
        time.sleep(0.3)

    def focus(self, title):
        window = self.wait(title, lambda: self.xdotool("search", "--onlyvisible", "--name", title)).split()[-1]
        self.xdotool("windowfocus", window)

    def test_has_room_for_everything(self):
        self.open(self.experiment("visuomotor-rotation", lambda text: text))
        self.look("opened")
        for menu in "fsvh":
            self.key("alt+" + menu)
            self.look("menu-" + menu)
            self.key("Escape")
        self.key("alt+h", "a")
        self.focus("^About Dihaptic$")
        self.look("about")
        self.back()
        self.key("alt+s", "b")
        self.focus("^Before the session")
        self.look("checklist")
        self.back()
        self.key("alt+f", "t")
        self.look("start-page")
        self.key("alt+f", "r", "Return")
        self.settle()
        for key, mode in (("ctrl+3", "look"), ("ctrl+2", "run"), ("ctrl+1", "prepare")):
            self.key(key)
            self.look("mode-" + mode)
        self.key("ctrl+e")
        self.look("editor")
        self.xdotool("windowfocus", self.name)
        self.ask()
        self.look("who")
        self.xdotool("type", "--delay", "50", "S07\t31\tF\tr")
        self.answered("Return")
        recording = self.recording()
        time.sleep(2)
        self.look("trial")
        self.key("F6")
        self.look("paused")
        self.key("F7")
        with self.ended("interrupted"):
            pass
        self.look("ended")
        self.key("ctrl+shift+o")
        self.focus("^Recorded sessions$")
        self.look("sessions")
        self.key("Return")
        self.focus(recording.rstrip("/").split("/")[-1])
        self.look("player")
        self.xdotool("windowfocus", self.name)
        self.quit()


class Large(Small):
    size = "1920x1080"


class Fine(Small):
    """Twice as many pixels on as many inches."""
    size = "2048x1400"
    scale = "2"


def load_tests(loader, tests, pattern):
    return soak.of(loader.loadTestsFromTestCase(Small), tests)


if __name__ == "__main__":
    unittest.main()
