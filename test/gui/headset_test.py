"""The participant's window as a headset, on the tests' OpenXR runtime, with OpenXR's validation layer between."""
import csv
import math
import pathlib
import re
import subprocess
import time
import unittest

from window import PROGRAM, SCREENSHOTS, Participants

import soak

RIG = """
devices: [{ finger: index, backend: simulated }]
headset: { position_mm: [10, 20, 30] }
"""
TASK = """task:
  states:
    - { name: wait, message: Wait for the light, exits: [{ when: time, after_s: 1, to: look }] }
    - { name: look, message: "", exits: [{ when: time, after_s: 1, outcome: seen }] }
  blocks: [{ name: all, repeats: 2 }]
"""


class Headset(Participants):
    def setUp(self):
        super().setUp()
        self.pictures = pathlib.Path(self.folder.name, "pictures")
        self.pictures.mkdir()
        self.messages = pathlib.Path(self.folder.name, "validation.txt")
        manifest = pathlib.Path(PROGRAM).resolve().parent / "test_runtime/manifest.json"
        self.environment.update(
            XR_RUNTIME_JSON=str(manifest), XR_ENABLE_API_LAYERS="XR_APILAYER_LUNARG_core_validation",
            XR_CORE_VALIDATION_EXPORT_TYPE="text", XR_CORE_VALIDATION_FILE_NAME=str(self.messages),
            DIHAPTIC_TEST_RUNTIME_PICTURES=str(self.pictures))

    def in_a_headset(self, text):
        rig = pathlib.Path(self.folder.name, "rig.yaml")
        rig.write_text(RIG)
        return re.sub("^scene:", f"rig: {rig}\nscene:", text[:text.index("task:")], flags=re.M) + TASK

    def put_on(self):
        self.open(self.experiment("visuomotor-rotation", self.in_a_headset))
        self.key("alt+v", "s")
        self.wait("a picture", lambda: (self.pictures / "right.ppm").exists())
        self.xdotool("windowfocus", self.name)
        self.key("alt+a", "Down")  # the script moves the hand

    def keep(self, name):
        """A picture that can be looked at."""
        pathlib.Path(SCREENSHOTS).mkdir(parents=True, exist_ok=True)
        subprocess.run(["ffmpeg", "-loglevel", "error", "-y", "-i", self.pictures / f"{name}.ppm",
                        f"{SCREENSHOTS}/headset-{name}.png"], check=True)

    def rows(self, name):
        with open(self.recording() + name) as file:
            return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]

    def test_shows_a_session_and_tells_what_was_seen_from_where(self):
        self.put_on()
        self.start()
        self.wait("words", lambda: (self.pictures / "words.ppm").exists())
        self.screenshot("headset")
        with self.ended("complete"):
            pass
        for name in ["left", "right", "words"]:
            self.keep(name)
        shown, heads = self.rows("shown.csv"), self.rows("head.csv")
        ticks = [row["tick"] for row in shown]
        self.assertEqual(ticks, sorted(set(ticks)))
        self.assertGreater(len(ticks), 5)
        self.assertEqual(sorted({row["tick"] for row in heads}), ticks)
        for row in heads:
            # the runtime's head in world axes; in the runtime's space, it is 0.35 m above and 0.4 m behind the origin
            for value, exact in zip([row["x_m"], row["y_m"], row["z_m"]], [0.01, 0.02 - 0.4, 0.03 + 0.35]):
                self.assertAlmostEqual(value, exact, places=5)
            # the head looks down by 33.7 degrees; upright, it would be turned by 90
            self.assertAlmostEqual(row["qw"], math.cos(math.radians(90 - 33.72) / 2), places=3)
            self.assertAlmostEqual(row["qx"], math.sin(math.radians(90 - 33.72) / 2), places=3)
            self.assertEqual(row["tracked"], 1)
            # a picture is shown later than its tick, by the time that drawing takes
            self.assertGreater(row["shown_s"], row["tick"] * 1e-3)
        self.quit()
        said = self.messages.read_text().splitlines() if self.messages.exists() else []
        # newer validation layers also report their start and end
        self.assertEqual([line for line in said if "VALID_DEBUG" not in line], [])

    def test_that_goes_away_pauses_the_session(self):
        self.put_on()
        self.start()
        size = lambda: pathlib.Path(self.recording() + "raw.log").stat().st_size
        (self.pictures / "end").touch()
        time.sleep(2)
        self.screenshot("headset-gone")
        before = size()
        time.sleep(1.5)
        self.assertEqual(size(), before)
        self.assertIn("state: running", pathlib.Path(self.recording() + "session.yaml").read_text())
        self.key("F6")
        with self.ended("complete"):
            pass
        self.quit()

    @soak.alone
    def test_that_is_not_there_leaves_the_window_as_it_is(self):
        self.environment["XR_RUNTIME_JSON"] = "/nowhere/manifest.json"
        self.open(self.experiment("visuomotor-rotation", self.in_a_headset))
        self.key("alt+v", "s")
        time.sleep(2)
        self.screenshot("headset-none")
        self.quit()


if __name__ == "__main__":
    unittest.main()
