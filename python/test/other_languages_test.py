"""What the manual shows of R and MATLAB reads what Python reads; MATLAB's is run in Octave."""

import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

import numpy as np

import dihaptic as dh

OCTAVE = pathlib.Path("python/test/octave").absolute()  # stands in for what Octave 7 has not


def blocks(page, language):
    text = pathlib.Path(f"docs/manual/tutorials/{page}.md").read_text()
    return re.findall(rf"```{{code-block}} {language}\n:caption: .*?\n\n(.*?)```", text, re.DOTALL)


class OtherLanguages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        session = dh.run("experiments/grip-and-lift.yaml", out=cls.folder.name, simulate=True, progress=False)
        at = (session.lifts.lift_off_s.dropna().to_numpy() / session.tick).round().astype(int)
        cls.session = session
        (pathlib.Path(cls.folder.name) / "lifts").symlink_to(session.folder)  # as the pages call it
        cls.aligned = np.array([session["grip_force"][i - 500 : i + 1001] for i in at]).mean(axis=0)

    def run_in(self, command, script, suffix):
        here = pathlib.Path(self.folder.name)
        file = here / f"read.{suffix}"
        file.write_text(script)
        done = subprocess.run([*command, file.name], cwd=here, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return {name: np.loadtxt(here / f"{name}.txt", ndmin=1) for name in ("grip", "z", "time", "mean")}

    def compare(self, found):
        np.testing.assert_allclose(found["grip"], self.session["grip_force"], rtol=1e-5, atol=1e-6)
        np.testing.assert_allclose(found["z"], self.session["block.position.z"], rtol=1e-5, atol=1e-6)
        np.testing.assert_allclose(found["time"], self.session.t, atol=1e-6)
        np.testing.assert_allclose(found["mean"], self.aligned, rtol=1e-4, atol=1e-5)

    def test_r(self):
        if shutil.which("Rscript") is None:
            self.skipTest("R is not installed: ./dev build installs it")
        script = blocks("read-in-r", "r")
        keep = {"grip": "grip", "z": "position[3, ]", "time": "time", "mean": "rowMeans(aligned)"}
        script += [f'write(format({what}, digits = 9), "{name}.txt", ncolumns = 1)' for name, what in keep.items()]
        script += ["stopifnot(nrow(contacts) > 1000, ncol(contacts) == 15, diff(contacts$time) >= 0, nchar(meaning) > 20)"]
        self.compare(self.run_in(["Rscript"], "\n".join(script), "R"))

    def test_matlab_s_in_octave(self):
        if shutil.which("octave") is None:
            self.skipTest("Octave is not installed")
        script = blocks("read-in-matlab", "matlab")
        keep = {"grip": "grip", "z": "position(3, :)'", "time": "time", "mean": "mean(aligned, 2)"}
        script += [f"fid = fopen('{name}.txt', 'w'); fprintf(fid, '%.9g\\n', {what}); fclose(fid);"
                   for name, what in keep.items()]
        self.compare(self.run_in(["octave", "--no-gui", "--quiet", "--path", str(OCTAVE)], "\n".join(script), "m"))


if __name__ == "__main__":
    unittest.main()
