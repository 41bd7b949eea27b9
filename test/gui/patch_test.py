"""The patch for a photodiode: white in the pictures of the ticks whose state asks for it, and in no others."""
import csv
import pathlib
import re
import statistics
import subprocess
import time
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
             self.environment["DISPLAY"] + "+20,690", "-fps_mode", "cfr", "-f", "rawvideo",
             "-pix_fmt", "gray", "-"],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.start()
        self.screenshot("patch")
        with self.ended("complete"):
            pass
        time.sleep(1)  # until it is black again
        grey, _ = grab.communicate(b"q")
        seen = [sum(grey[i:i + 64]) / 64 for i in range(0, len(grey) - 63, 64)]
        white = [value > 250 for value in seen]
        begins = [i for i in range(1, len(white)) if white[i] and not white[i - 1]]
        self.assertEqual(len(begins), 4, seen)
        # shown.csv agrees on when the first picture of each state came to the screen
        with open(self.recording() + "events.csv") as file:
            phases = [(float(row["time_s"]), row["detail"]) for row in csv.DictReader(file) if row["event"] == "phase"]
        with open(self.recording() + "shown.csv") as file:
            pictures = [(int(row["tick"]) * 1e-3, float(row["shown_s"])) for row in csv.DictReader(file)]
        came = [(next(shown for tick, shown in pictures if tick > time - 5e-4), name) for time, name in phases]
        self.assertEqual([name for _, name in came], ["dark", "light"] * 4)
        changes = [time for time, _ in came[1:]]
        on_screen = [i / RATE for i in range(1, len(white)) if white[i] != white[i - 1]][:len(changes)]
        apart = [abs((after - before) - (told_after - told_before)) for (before, after), (told_before, told_after)
                 in zip(zip(on_screen, on_screen[1:]), zip(changes, changes[1:]))]
        # on a busy machine, single pictures and grabs are late: one change may be off by the duration of a picture
        longest = max(after - before for (_, before), (_, after) in zip(pictures, pictures[1:]))
        self.assertLess(statistics.median(apart), 0.15, apart)
        self.assertLess(max(apart), 0.15 + longest, apart)


if __name__ == "__main__":
    unittest.main()
