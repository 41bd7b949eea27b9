"""Files of each kind with bytes and words changed, cut, doubled or exchanged: each is read, or refused by its name.

Usage: attack/mutations_test.py PROGRAM, from the project's folder. DIHAPTIC_ATTACKS=all tries 10,000 of each kind.
"""
import glob
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.append("test/cli")
from program import PROGRAM, patient

EACH = 10_000 if os.environ.get("DIHAPTIC_ATTACKS") == "all" else 60
BATCH = 50
#: What the program says of every file: its name comes first.
LINE = re.compile(r"^(?P<file>/[^:]+):(?P<line>\d+:)? ", re.MULTILINE)


def mutated(chosen, content):
    """One to three changes of bytes, or of words of a text."""
    out = bytearray(content)
    for _ in range(chosen.randrange(1, 4)):
        at, end = sorted(chosen.randrange(len(out) + 1) for _ in range(2))
        end = min(end, at + chosen.choice([1, 4, 30, 300]))
        other = chosen.randrange(len(out) + 1)
        piece = out[other:other + chosen.choice([1, 4, 30])]
        change = chosen.randrange(6)
        if change == 0:
            out[at:end] = b""
        elif change == 1:
            out[at:at] = piece
        elif change == 2:
            out[at:end] = piece
        elif change == 3:
            out[at:at + 1] = bytes([chosen.randrange(256)])
        elif change == 4:
            out[at:at] = chosen.choice([b"-1", b"1e308", b"nan", b"{", b"[", b"&a", b"*a", b": ", b"\n", b"\"", b",,,", b"\0"])
        else:
            out = out[:max(1, at)]
    return bytes(out) or b"\n"


class Mutations(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.chosen = random.Random(20261126)
        os.makedirs(self.folder + "/cache")

    def check(self, files):
        """Checks files; returns what was said."""
        result = subprocess.run([PROGRAM, "check", *files], capture_output=True, text=True, timeout=patient(600),
                                env={**os.environ, "XDG_CACHE_HOME": self.folder + "/cache"})
        told = result.stdout + result.stderr
        self.assertIn(result.returncode, (0, 1, 2), told[-2000:])
        self.assertNotIn("Please report", told)
        return told

    def try_all(self, kinds, name, scene_of=None, has_checksums=False):
        """`kinds`: files to begin with. `scene_of`: what names such a file; it is checked in the file's place."""
        here = os.getcwd().encode() + b"/"
        contents = [pathlib.Path(file).read_bytes() for file in kinds]
        if name.endswith(".yaml"):
            contents = [content.replace(b"../", here) for content in contents]
        refused = 0
        for batch in range(0, EACH, BATCH):
            place = pathlib.Path(self.folder, "batch")
            place.mkdir()
            files = []
            for n in range(min(BATCH, EACH - batch)):
                content = mutated(self.chosen, self.chosen.choice(contents))
                file = place / name.replace("*", str(n))
                file.write_bytes(content)
                if scene_of is not None:
                    scene = place / f"of-{n}.yaml"
                    scene.write_text(scene_of(file.name))
                    file = scene
                files.append(str(file))
            told = self.check(files)
            for file in files:
                number = re.search(r"(\d+)\.\w+$", file)[1]
                about = [line for line in told.splitlines() if line.startswith(file) or f"/{name.replace('*', number)}" in line]
                self.assertTrue(about, f"nothing was said of {file}: {told[-500:]}")
                refused += any(": error: " in line for line in about)
            shutil.rmtree(place)
        self.assertGreater(refused, EACH // 20)
        if not has_checksums:
            self.assertLess(refused, EACH, "no file was read: the first ones are wrong")
        print(f"{name}: {EACH}, {refused} refused")

    def test_yaml(self):
        for kind in ("scenes", "experiments", "rigs", "populations"):
            with self.subTest(kind):
                files = glob.glob(kind + "/*.yaml")
                self.try_all(files, kind + "-*.yaml")

    def test_movements(self):
        self.try_all(glob.glob("movements/*.csv")[:4], "movement-*.csv")

    def test_meshes(self):
        scene = "bodies: [{{name: floor, shape: plane, fixed: yes}}, {{name: b, shape: mesh, file: {}, unit: mm, mass_g: 10}}]\n"
        for file in ("meshes/pad.obj", "meshes/apple.ply"):
            with self.subTest(file):
                self.try_all([file], "mesh-*" + os.path.splitext(file)[1], scene.format)

    def test_pictures(self):
        scene = ("bodies: [{{name: floor, shape: plane, fixed: yes}}, {{name: b, shape: box, size_mm: [9, 9, 9], mass_g: 10, "
                 "picture: {{file: {}, width_mm: 20}}}}]\n")
        self.try_all(glob.glob("textures/*.png")[:3], "picture-*.png", scene.format, has_checksums=True)


if __name__ == "__main__":
    unittest.main()
