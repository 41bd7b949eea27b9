"""The pictures of the window in docs/pictures show the window as it is: each is drawn again, and compared."""
import pathlib
import re
import subprocess
import unittest

import numpy as np

import pictures
import soak
import window

KEPT = pathlib.Path("docs/pictures").absolute()
#: Mean difference of grey levels above which a picture is old. Two drawings of one window differ by 0.3, in times and
#: numbers; a window whose menus and plots had other names differed by 3.
MOST = 1.5


def grey(file):
    """Grey levels of a picture, in blocks of 4 x 4 pixels, so that the edges of letters do not count."""
    raw = subprocess.run(["ffmpeg", "-loglevel", "error", "-i", file, "-vf", "scale=350:225:flags=area", "-f", "rawvideo",
                          "-pix_fmt", "gray", "-"], check=True, capture_output=True).stdout
    return np.frombuffer(raw, np.uint8).astype(int)


class Kept(unittest.TestCase):
    def test_each_has_a_test_that_draws_it_and_a_page_that_shows_it(self):
        drawn = {name.removeprefix("test_") for name in dir(pictures.Pictures) if name.startswith("test_")}
        self.assertEqual({file.stem for file in KEPT.iterdir()}, drawn)
        pages = "".join(page.read_text() for page in [pathlib.Path("README.md"), *pathlib.Path("docs").glob("*.md")])
        self.assertEqual(set(re.findall(r"pictures/(\w+)\.png", pages)), drawn)


@soak.alone
@window.starts_programs
class Fresh(pictures.Pictures):
    def screenshot(self, name):
        super().screenshot(name)
        difference = np.abs(grey(f"{window.SCREENSHOTS}/{name}.png") - grey(KEPT / f"{name}.png")).mean()
        print(f"{name}: {difference:.2f} grey levels")
        self.assertLess(difference, MOST, f"docs/pictures/{name}.png is older than what it shows: ./dev pictures draws it again")


if __name__ == "__main__":
    unittest.main()
