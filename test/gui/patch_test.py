"""The patch for a photodiode: white in the pictures of the ticks whose state asks for it, and in no others."""
import csv
import pathlib
import re
import subprocess
import unittest

from window import Participants

RIG = """
devices: [{ finger: index, backend: simulated }]
patch: { corner: lower_left, size: 0.2 }
"""
TASK = """task:
  states:
    - { name: dark, message: Wait, exits: [{ when: time, after_s: 0.7, to: light }] }
    - { name: light, patch: yes, exits: [{ when: time, after_s: 0.5, outcome: seen }] }
  blocks: [{ name: all, repeats: 4 }]
"""
RATE = 50


class Patch(Participants):
    def flicker(self, text):
        rig = pathlib.Path(self.folder.name, "rig.yaml")
        rig.write_text(RIG)
        return re.sub("^scene:", f"rig: {rig}\nscene:", text[:text.index("task:")], flags=re.M) + TASK

    def test_is_white_while_a_state_asks_for_it(self):
        self.open(self.experiment("visuomotor-rotation", self.flicker))
        grab = subprocess.Popen(
            ["ffmpeg", "-loglevel", "error", "-f", "x11grab", "-framerate", str(RATE), "-video_size", "8x8", "-i",
             self.environment["DISPLAY"] + "+20,690", "-f", "rawvideo", "-pix_fmt", "gray", "-"],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.start()
        self.screenshot("patch")
        with self.ended("complete"):
            pass
        grey, _ = grab.communicate(b"q")
        seen = [sum(grey[i:i + 64]) / 64 for i in range(0, len(grey) - 63, 64)]
        white = [value > 250 for value in seen]
        begins = [i for i in range(1, len(white)) if white[i] and not white[i - 1]]
        lasts = [next(k for k in range(i, len(white)) if not white[k]) - i for i in begins]
        self.assertEqual(len(begins), 4, seen)
        with open(self.recording() + "events.csv") as file:
            onsets = [float(row["time_s"]) for row in csv.DictReader(file) if row["event"] == "phase light"]
        self.assertEqual(len(onsets), 4)
        # as far apart, and as long, as the states; a picture in software may be late
        for gap, exact in zip(zip(begins, begins[1:]), zip(onsets, onsets[1:])):
            self.assertAlmostEqual((gap[1] - gap[0]) / RATE, exact[1] - exact[0], delta=0.2)
        for last in lasts:
            self.assertAlmostEqual(last / RATE, 0.5, delta=0.2)


if __name__ == "__main__":
    unittest.main()
