"""The shipped meshes are what their generator writes."""
import filecmp
import glob
import os
import subprocess
import sys
import tempfile
import unittest


class Meshes(unittest.TestCase):
    def test_they_are_what_the_generator_writes(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, "meshes/make_meshes.py", folder], check=True)
            shipped = sorted(os.path.basename(name) for name in glob.glob("meshes/*.obj"))
            self.assertEqual(sorted(os.listdir(folder)), shipped)
            for name in shipped:
                self.assertTrue(filecmp.cmp(f"{folder}/{name}", f"meshes/{name}", shallow=False), name)


if __name__ == "__main__":
    unittest.main()
