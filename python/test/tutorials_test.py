"""The tutorials of docs/tutorials run, and make their pictures."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

sys.path.append("test")
import soak  # noqa: E402

TUTORIALS = sorted(pathlib.Path("docs/tutorials").absolute().glob("*.py"))


class Tutorials(unittest.TestCase):
    @soak.alone
    def test_each_runs_from_an_empty_folder(self):
        self.assertGreaterEqual(len(TUTORIALS), 4)
        for file in TUTORIALS:
            with self.subTest(file.name), tempfile.TemporaryDirectory() as folder:
                environment = {**os.environ, "MPLBACKEND": "Agg"}
                done = subprocess.run([sys.executable, file], cwd=folder, env=environment, capture_output=True, text=True)
                self.assertEqual(done.returncode, 0, done.stderr[-2000:])
                for picture in re.findall(r'savefig\("(.+?)"\)', file.read_text()):
                    self.assertGreater((pathlib.Path(folder) / picture).stat().st_size, 10_000, picture)

    def test_each_is_a_notebook_in_text(self):
        for file in TUTORIALS:
            with self.subTest(file.name):
                text = file.read_text()
                self.assertTrue(text.startswith("# %% [markdown]\n# # "))
                self.assertGreaterEqual(text.count("\n# %%\n"), 2)


if __name__ == "__main__":
    unittest.main()
