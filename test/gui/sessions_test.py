"""Sessions that are paused, that wait after Escape, or whose window is closed."""
import time
import unittest

from window import Window

RESUMED, PAUSED = 22, 29  # bits of a frame's status


class Sessions(Window):
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
        self.key("Escape", "Escape", "F7")  # the second Escape does nothing
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


if __name__ == "__main__":
    unittest.main()
