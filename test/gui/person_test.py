"""A simulated person does the trials in the window: at any pace, paused, tick by tick."""
import pathlib
import time
import unittest

from window import Participants

import soak


class Person(Participants):
    def choose(self, pace):
        """A simulated person, whose time goes by at this pace."""
        self.key("alt+a")
        self.xdotool("type", "--delay", "50", "a s")
        time.sleep(1.5)  # meanwhile the file is read again; letters typed after this start a new word
        self.key("Tab")
        self.xdotool("type", "--delay", "50", pace)
        time.sleep(0.5)

    def begin(self):
        self.key("F5")
        self.recording()
        time.sleep(0.3)

    def test_does_the_trials_as_fast_as_it_goes(self):
        self.open(self.experiment("first-trials", lambda text: text.replace("repeats: 2", "repeats: 1")))
        self.choose("as")
        self.screenshot("person-chosen")
        self.begin()
        with self.ended("complete"):
            pass
        self.screenshot("person-done")
        self.assertEqual(self.outcomes(), ["held"] * 3)
        info = pathlib.Path(self.recording() + "session.yaml").read_text()
        for line in ("clock: virtual", "  mover: simulated_person", "  id: sim-001"):
            self.assertIn(line + "\n", info)
        self.replay()

    @soak.alone
    def test_stands_still_in_a_pause_and_goes_tick_by_tick(self):
        self.open("experiments/first-trials.yaml")
        self.choose("in")
        self.begin()
        time.sleep(2)
        self.key("F6")
        time.sleep(0.5)
        self.screenshot("person-paused")
        size = lambda: pathlib.Path(self.recording() + "raw.log").stat().st_size
        before = size()
        time.sleep(1)
        self.assertEqual(size(), before)
        self.key("ctrl+period", "ctrl+period", "ctrl+period")
        self.key("F6")
        time.sleep(1)
        self.key("F7")
        with self.ended("interrupted") as recording:
            self.assertGreater(len(self.series(recording, "status")), 2000)
        self.replay()


if __name__ == "__main__":
    unittest.main()
