"""A head before a screen, which a tracker follows: what is drawn is what eyes at that place see, and its place is recorded.
The tracker is a stream of the tests' liblsl."""
import csv
import os
import pathlib
import time
import unittest

import numpy as np
from window import PROGRAM, Window

import soak

LIBRARY = pathlib.Path(PROGRAM).resolve().parent / "src/outlets/fake_lsl.so"
RIG = """
devices: [{{ finger: thumb, backend: simulated }}, {{ finger: index, backend: simulated }}]
displays:
  - name: screen
    lower_left_mm: [-260, -80, -40]
    lower_right_mm: [260, -80, -40]
    upper_left_mm: [-260, 173.3, 106.3]
    eyes: {eyes}
{head}
"""
HEAD = f"head: {{ stream: Head, unit: mm, position_mm: [0, 0, 100], eyes_mm: [0, 0, -80], library: {LIBRARY} }}"
RESTS, LEANS = (0, -330, 420), (150, -250, 450)


class Head(Window):
    def setUp(self):
        super().setUp()
        self.stream = pathlib.Path(self.folder.name, "stream")
        self.environment["DIHAPTIC_FAKE_LSL_IN"] = str(self.stream)
        self.allow(LIBRARY)

    def send(self, x, y, z):
        """The tracked body, 80 mm above the eyes, in the tracker's frame, 100 mm above the table."""
        new = self.stream.with_suffix(".new")
        new.write_text(f"Head 7\n{x} {y} {z - 100 + 80} 1 0 0 0\n")
        os.replace(new, self.stream)

    def before_a_screen(self, eyes, head, rests=True):
        """Opens a scene with a rig, and its participant's window; returns what that shows, if it rests."""
        pathlib.Path(self.folder.name, "rig.yaml").write_text(RIG.format(eyes=eyes, head=head))
        file = pathlib.Path(self.folder.name, "experiment.yaml")
        file.write_text("scene: block.yaml\nrig: rig.yaml\n")
        self.open(str(file))
        self.key("alt+v", "s")
        self.participant = self.wait("the participant's window", lambda: self.xdotool(
            "search", "--onlyvisible", "--name", "^Dihaptic: participant$")).strip()
        self.xdotool("windowmove", self.participant, "0", "0")
        self.xdotool("windowraise", self.participant)
        return self.still() if rests else None

    def still(self):
        """What the participant's window shows, once it no longer changes."""
        self.settle()  # on a busy machine a picture that is late does not change either
        last = None
        for _ in range(40):
            time.sleep(1)
            now = self.pixels(0, 0, 640, 480)
            if last is not None and (now == last).all():
                return now
            last = now
        self.fail("the participant's window does not come to rest")

    def resting(self, place):
        """What eyes at rest see at a place."""
        seen = self.before_a_screen(f"{{ position_mm: {list(place)} }}", "")
        self.xdotool("windowfocus", self.name)
        self.quit()
        return seen

    @soak.alone
    def test_sees_pictures_for_its_eyes_in_turn(self):
        left, right = self.resting((RESTS[0] - 30, *RESTS[1:])), self.resting((RESTS[0] + 30, *RESTS[1:]))
        self.assertGreater(np.abs(left.astype(int) - right).mean(), 0.5)
        self.before_a_screen(f"{{ position_mm: {list(RESTS)}, distance_mm: 60 }}\n    stereo: in_turn", "", rests=False)
        seen = {"left": 0, "right": 0}

        def both():
            now = self.pixels(0, 0, 640, 480)
            for name, picture in (("left", left), ("right", right)):
                seen[name] += (now == picture).all()
            return min(seen.values()) > 3

        self.wait("both eyes' pictures, again and again", both)
        self.xdotool("windowfocus", self.name)
        self.quit()

    def test_that_is_tracked_sees_what_eyes_at_its_place_would(self):
        there, here = self.resting(LEANS), self.resting(RESTS)
        self.assertGreater(np.abs(there.astype(int) - here).mean(), 2)
        tracked = f"{{ position_mm: {list(RESTS)}, tracked: yes }}"
        np.testing.assert_array_equal(self.before_a_screen(tracked, HEAD), here)  # as there is no stream yet
        self.send(*LEANS)
        self.wait("the stream", lambda: (self.pixels(0, 0, 640, 480) == there).all())
        self.screenshot("head")
        self.send(0, 900, 0)  # behind the screen
        self.wait("the eyes at rest", lambda: (self.pixels(0, 0, 640, 480) == here).all())
        self.send(*LEANS)
        self.wait("the stream again", lambda: (self.pixels(0, 0, 640, 480) == there).all())
        self.xdotool("windowfocus", self.name)
        self.start()
        time.sleep(1)
        self.send(*RESTS)
        self.wait("the head at rest", lambda: self.heads() and self.heads()[-1]["y_m"] == -0.33)
        self.stream.unlink()  # the tracker is switched off
        self.wait("a head that is not seen", lambda: self.heads()[-1]["tracked"] == 0)
        self.key("F7")
        with self.ended("complete"):
            pass
        heads = self.heads()
        for place, of in [(LEANS, heads[0]), (RESTS, heads[-1])]:
            np.testing.assert_allclose([of["x_m"], of["y_m"], of["z_m"]], np.array(place) / 1000, atol=1e-6)
            self.assertEqual(of["qw"], 1)
        self.assertEqual({row["tracked"] for row in heads}, {0, 1})
        with open(self.recording() + "shown.csv") as file:
            shown = [int(row["tick"]) for row in csv.DictReader(file)]
        self.assertEqual(sorted({int(row["tick"]) for row in heads}), shown)
        self.quit()

    def heads(self):
        file = pathlib.Path(self.recording() + "head.csv")
        if not file.exists():
            return []
        with open(file) as rows:
            return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(rows) if row["tracked"]]


if __name__ == "__main__":
    unittest.main()
