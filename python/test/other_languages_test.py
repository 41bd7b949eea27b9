"""What the manual shows of R and MATLAB reads what Python reads, and so do Octave's functions; MATLAB's is run in Octave."""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import dihaptic as dh
from dihaptic.program import program

sys.path.append("test")
import needs  # noqa: E402
import soak  # noqa: E402

FUNCTIONS = pathlib.Path(os.environ["PYTHONPATH"]).absolute().parent / "octave"
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
        needs.for_this_test("Rscript", "r-cran-hdf5r")
        script = blocks("read-in-r", "r")
        keep = {"grip": "grip", "z": "position[3, ]", "time": "time", "mean": "rowMeans(aligned)"}
        script += [f'write(format({what}, digits = 9), "{name}.txt", ncolumns = 1)' for name, what in keep.items()]
        script += ["stopifnot(nrow(contacts) > 1000, ncol(contacts) == 15, diff(contacts$time) >= 0, nchar(meaning) > 20)"]
        self.compare(self.run_in(["Rscript"], "\n".join(script), "R"))

    def test_matlab_s_in_octave(self):
        needs.for_this_test("octave", "octave")
        script = blocks("read-in-matlab", "matlab")
        keep = {"grip": "grip", "z": "position(3, :)'", "time": "time", "mean": "mean(aligned, 2)"}
        script += [f"fid = fopen('{name}.txt', 'w'); fprintf(fid, '%.9g\\n', {what}); fclose(fid);"
                   for name, what in keep.items()]
        self.compare(self.run_in(["octave", "--no-gui", "--quiet", "--path", str(OCTAVE)], "\n".join(script), "m"))

    def octave(self, script, code=0):
        needs.for_this_test("octave", "octave")
        here = pathlib.Path(self.folder.name)
        (here / "read.m").write_text(script)
        environment = {**os.environ, "PATH": f"{pathlib.Path(program()).parent}:{os.environ['PATH']}"}
        done = subprocess.run(["octave", "--no-gui", "--quiet", "--path", FUNCTIONS, "read.m"], cwd=here, env=environment,
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def test_octave_s_curves_are_python_s(self):
        every = [name for name in self.session if name not in dh.vocabulary.lists()]
        names = soak.of(every[::6], every)
        said = self.octave(f"""
            names = {{{", ".join(f"'{name}'" for name in names)}}};
            s = dihaptic_load('lifts', names{{:}});
            for n = 1:numel(names)
                field = strrep(names{{n}}, '.', '_');
                save('-ascii', '-double', [names{{n}} '.txt'], '-struct', 's', field);
                disp([names{{n}} '=' s.units.(field)]);
            end
            t = s.t; save -ascii -double t.txt t""")
        self.assertEqual(dict(re.findall(r"^(\S+)=(\S+)$", said, re.M)), {name: self.session.unit(name) for name in names})
        here = pathlib.Path(self.folder.name)
        np.testing.assert_allclose(np.loadtxt(here / "t.txt"), self.session.t, atol=1e-9)
        for name in names:
            np.testing.assert_allclose(np.loadtxt(here / f"{name}.txt"), self.session[name], rtol=1e-6, atol=1e-7, err_msg=name)

    @soak.alone
    def test_octave_s_tables_are_python_s(self):
        said = self.octave("s = dihaptic_load('lifts'); disp(jsonencode({s.tables, s.table_units}))")
        tables, units = json.loads(next(line for line in said.splitlines() if line.startswith("[")))
        self.assertEqual({name.replace("-", "_") for name in self.session.tables}, set(tables))
        for name in ("trials", "lifts", "phases", "events", "episodes"):
            table = self.session.table(name)
            self.assertEqual(list(tables[name]), list(table.columns))
            self.assertEqual(units[name], table.attrs["units"])
            for column in table.select_dtypes("number"):
                found = np.array(tables[name][column], dtype=float)
                np.testing.assert_allclose(np.atleast_1d(found), table[column], err_msg=column)
        self.assertEqual(tables["trials"]["outcome"], list(self.session.trials.outcome))

    @soak.alone
    def test_octave_s_tables_may_have_any_text(self):
        (pathlib.Path(self.folder.name) / "any.csv").write_text('id,what,x_mm\n007,"a ""b"", c\nd",1.5\n8,,\n')
        said = self.octave("[t, u] = dihaptic_table('any.csv'); disp(jsonencode({t, u}))")
        self.assertIn(json.dumps([{"id": ["007", "8"], "what": ['a "b", c\nd', ""], "x_mm": [1.5, None]}, {"x_mm": "mm"}],
                                 separators=(",", ":")), said)

    def test_octave_says_what_is_wrong(self):
        self.assertIn("Did you mean grip_force?", self.octave("dihaptic_load('lifts', 'gripforce')", code=1))
        self.assertIn("is not a session: it has no session.yaml.", self.octave("dihaptic_load('.')", code=1))
        self.assertIn("none.csv is not there.", self.octave("dihaptic_table('none.csv')", code=1))


if __name__ == "__main__":
    unittest.main()
