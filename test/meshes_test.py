"""The shipped meshes and textures are what their generators write."""
import filecmp
import glob
import os
import subprocess
import sys
import tempfile
import unittest
import zlib


class Meshes(unittest.TestCase):
    def test_they_are_what_the_generator_writes(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, "meshes/make_meshes.py", folder], check=True)
            shipped = sorted(os.path.basename(name) for name in glob.glob("meshes/*.obj") + glob.glob("meshes/*.ply"))
            self.assertEqual(sorted(os.listdir(folder)), shipped)
            for name in shipped:
                self.assertTrue(filecmp.cmp(f"{folder}/{name}", f"meshes/{name}", shallow=False), name)

    def test_and_so_is_the_word_in_braille(self):
        with tempfile.TemporaryDirectory() as folder:
            file = folder + "/braille.png"
            subprocess.run([sys.executable, "textures/make_braille.py", "dihaptic", file], check=True)
            # another zlib may pack the same rows otherwise
            self.assertEqual(rows(file), rows("textures/braille.png"))

    def test_and_so_are_the_pictures_that_bodies_wear(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in ("wood", "checker"):
                file = f"{folder}/{name}.png"
                subprocess.run([sys.executable, "textures/make_looks.py", name, file], check=True)
                self.assertEqual(rows(file), rows(f"textures/{name}.png"))


def rows(file):
    """The content of the only IDAT chunk of a PNG file."""
    with open(file, "rb") as png:
        data = png.read()
    at = data.index(b"IDAT")
    return zlib.decompress(data[at + 4:at + 4 + int.from_bytes(data[at - 4:at], "big")])


if __name__ == "__main__":
    unittest.main()
