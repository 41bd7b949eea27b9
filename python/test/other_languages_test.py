"""What docs/matlab-and-r.md shows is run, in R and in Octave, and reads what Python reads."""

import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

import numpy as np

import dihaptic as dh

PAGE = pathlib.Path("docs/matlab-and-r.md")

# Octave 7 has none of these; MATLAB's have the fastest index first, as here
STAND_INS = {
    "h5read": """function out = h5read(file, name)
    out = load_array(sprintf('f["%s"][...]', name), file);
end""",
    "h5readatt": """function out = h5readatt(file, name, key)
    out = single(load_array(sprintf('f["%s"].attrs["%s"]', name, key), file));
end""",
    "load_array": """function out = load_array(what, file)
    text = tempname();
    code = sprintf('import h5py, numpy as np; f = h5py.File("%s"); a = np.atleast_1d(f_(f)); ', file);
    code = strrep(code, 'f_(f)', what);
    code = [code 'np.savetxt("' text '", a.reshape(len(a), -1))'];
    assert(system(['/usr/bin/python3 -c ''' code '''']), 0);
    out = load('-ascii', text)';
    if rows(out) == 1, out = out'; end
end""",
    "readtable": """function out = readtable(file)
    lines = strsplit(strtrim(fileread(file)), "\\n");
    names = strsplit(lines{1}, ',');
    for c = 1:numel(names)
        column = zeros(numel(lines) - 1, 1);
        for r = 2:numel(lines)
            cells = strsplit(lines{r}, ',', 'CollapseDelimiters', false);
            column(r - 1) = str2double(cells{c});
        end
        out.(names{c}) = column;
    end
end""",
    "height": "function out = height(t)\n    out = numel(t.trial_num);\nend",
}


def blocks(language):
    return re.findall(rf"```{language}\n(.*?)```", PAGE.read_text(), re.DOTALL)


class OtherLanguages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        session = dh.run("experiments/grip-and-lift.yaml", out=cls.folder.name, simulate=True, progress=False)
        at = (session.lifts.lift_off_s.dropna().to_numpy() / session.tick).round().astype(int)
        cls.session = session
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
        script = [f'folder <- "{self.session.folder}"', 'pdf("plot.pdf")', *blocks("r")]
        keep = {"grip": "grip", "z": "position[3, ]", "time": "time", "mean": "rowMeans(aligned)"}
        script += [f'write(format({what}, digits = 9), "{name}.txt", ncolumns = 1)' for name, what in keep.items()]
        script += ["stopifnot(ncol(contacts) == length(contact_time), nchar(meaning) > 100)"]
        self.compare(self.run_in(["Rscript"], "\n".join(script), "R"))

    def test_matlab_s_in_octave(self):
        if shutil.which("octave") is None:
            self.skipTest("Octave is not installed")
        for name, text in STAND_INS.items():
            (pathlib.Path(self.folder.name) / f"{name}.m").write_text(text)
        script = [f"folder = '{self.session.folder}';", "plot = @(varargin) 0; xlabel = plot; ylabel = plot;"]
        script += blocks("matlab")
        keep = {"grip": "grip", "z": "position(3, :)'", "time": "time", "mean": "mean(aligned, 2)"}
        script += [f"fid = fopen('{name}.txt', 'w'); fprintf(fid, '%.9g\\n', {what}); fclose(fid);" for name, what in keep.items()]
        self.compare(self.run_in(["octave", "--no-gui", "--quiet"], "\n".join(script), "m"))


if __name__ == "__main__":
    unittest.main()
