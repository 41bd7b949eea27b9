"""Trials that wait for keys, and those that an earlier session left undone."""
import csv
import os
import pathlib
import time
import unittest

from window import Participants

import soak


class Trials(Participants):
    def focus(self, window):
        """Gives a new window the keyboard, which no window manager does here."""
        self.xdotool("windowfocus", self.wait("the window", window).split()[-1])
        time.sleep(0.5)

    def test_get_the_keys_that_they_wait_for(self):
        def keys(text):
            return text[:text.index("task:")] + """task:
  regions:
    - { name: start, position_mm: [0, 0, 120], radius_mm: 8 }
  states:
    - name: ready
      show: [start]
      message: Press G when you are ready
      exits:
        - { when: key, key: g, outcome: ready, feedback: Good }
  blocks:
    - { name: all, repeats: 2 }
"""
        self.open(self.experiment("visuomotor-rotation", keys))
        self.start()
        time.sleep(1)
        self.screenshot("key")
        self.key("h", "g")
        time.sleep(0.5)
        self.key("g")  # not an answer, since the feedback is shown
        time.sleep(1.5)
        self.key("g")
        with self.ended("complete"):
            pass
        self.assertEqual(self.outcomes(), ["ready", "ready"])

    @soak.alone
    def test_get_ratings_by_mouse_on_a_line(self):
        def rated(text):
            return text[:text.index("task:")] + """task:
  states:
    - name: rate
      message: How heavy was it?
      ask: { name: heaviness, scale: vas, labels: [light, heavy], by: mouse }
      exits: [{ when: answered, outcome: rated, feedback: Thank you }]
  blocks: [{ name: all, repeats: 3 }]
"""
        self.open(self.experiment("visuomotor-rotation", rated))
        self.start()
        time.sleep(1)
        for x in (120, 520, 890):  # left of the line, on it, right of it
            self.xdotool("mousemove", str(x), "600")
            time.sleep(0.5)
            self.screenshot(f"rating-{x}")
            self.xdotool("click", "1")
            time.sleep(2)
        with self.ended("complete"):
            pass
        with open(self.recording() + "trials.csv") as file:
            answers = [float(row["heaviness"]) for row in csv.DictReader(file)]
        self.assertEqual((answers[0], answers[2]), (0, 100))
        self.assertTrue(20 < answers[1] < 80, answers)

    def test_fill_in_a_form_by_mouse_and_keys(self):
        def asked(text):
            return text[:text.index("task:")] + """task:
  states:
    - name: rate
      form: { file: ../forms/nasa-tlx.yaml }
      exits: [{ when: answered, outcome: filled }]
  blocks: [{ name: all, repeats: 1 }]
"""
        self.open(self.experiment("visuomotor-rotation", asked))
        self.start()
        time.sleep(1)
        self.screenshot("form-empty")
        self.xdotool("mousemove", "520", "300")
        time.sleep(0.5)
        self.xdotool("click", "1")  # the middle of some item
        for answer in ("10", "20", "30", "40", "50"):
            time.sleep(0.2)
            self.key(*answer, "Return")
        time.sleep(0.5)
        self.screenshot("form-filled")
        self.key("Return")
        with self.ended("complete"):
            pass
        with open(self.recording() + "trials.csv") as file:
            row = next(csv.DictReader(file))
        given = [float(row["tlx_" + item])
                 for item in ("mental", "physical", "temporal", "performance", "effort", "frustration")]
        clicked = [answer for answer in given if answer not in (10, 20, 30, 40, 50)]
        self.assertEqual(len(clicked), 1, given)  # answered with the mouse, and not asked again
        self.assertTrue(20 < clicked[0] < 80, given)
        self.assertEqual([a for a in given if a != clicked[0]], [10, 20, 30, 40, 50])
        self.assertAlmostEqual(float(row["tlx"]), sum(given) / 6, places=6)

    @soak.alone
    def test_that_were_not_finished_are_offered_before_new_ones(self):
        """Three reaches by mouse, of which one is skipped; the rest is done in a second session."""
        def short(text):
            return text[:text.index("  redo: end_of_block")] + """  redo: never
  blocks: [{ name: baseline, conditions: [right far up, left far up, right near up], order: sequential }]
"""
        question = lambda: self.xdotool("search", "--onlyvisible", "--name", "^Continue")

        def again():
            """The same person once more, which is asked: Enter leads to the question, Space answers it."""
            self.ask()
            self.xdotool("type", "--delay", "50", "S07")
            self.key("Return", "space")
            self.screenshot("the-same-person")
            self.answered("Return")

        self.open(self.experiment("visuomotor-rotation", short))
        self.start()
        time.sleep(1)
        self.key("F8")
        time.sleep(1)
        self.key("F7")
        with self.ended("interrupted"):
            pass
        first = self.recording()
        self.settle()
        again()
        self.focus(question)
        self.screenshot("go-on")
        self.key("Escape")
        time.sleep(1)
        self.assertEqual(self.recording(), first)  # nothing began
        self.xdotool("windowfocus", self.name)
        again()
        self.focus(question)
        self.key("Return")
        self.wait("the session", lambda: self.recording() != first)
        self.xdotool("windowfocus", self.name)
        time.sleep(1)
        self.screenshot("goes-on")
        for _ in range(12):  # three in each round
            self.key("F8")
            time.sleep(0.3)
        with self.ended("complete"):
            pass
        info = pathlib.Path(self.recording() + "session.yaml").read_text()
        self.assertIn("resumes: ", info)
        self.assertIn(os.path.basename(first.rstrip("/")), info)
        self.assertRegex(info, "mover: mouse")
        with open(self.recording() + "trials.csv") as file:
            rows = list(csv.DictReader(file))
        finished = [row["session_num"] for row in rows if row["outcome"] != "interrupted"]
        self.assertEqual(finished[0], "1")
        self.assertEqual(finished[-1], "2")
        self.replay()


if __name__ == "__main__":
    unittest.main()
