"""dihaptic-read, the wheel of what reads, reads like the whole package: in a Python of its own, without the program."""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy
import small_study

import dihaptic as dh
from dihaptic import _native, _remedy

sys.path += ["test", "docs/manual/make"]
import needs  # noqa: E402
import soak  # noqa: E402
from pages import MANUAL, blocks, unlike  # noqa: E402

PACKAGE = pathlib.Path(os.environ["PYTHONPATH"]).absolute() / "dihaptic"
PROJECT = pathlib.Path.cwd()
#: Modules that exist only on Unix.
OF_UNIX = ["fcntl", "grp", "pwd", "resource", "syslog", "termios"]
EXAMPLES = """
import doctest, importlib, sys
flags = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
for name in ("charts", "errors", "session", "study", "tables", "vocabulary"):
    module = importlib.import_module(f"dihaptic.{name}")
    for test in doctest.DocTestFinder(exclude_empty=True).find(module, extraglobs={"lift_session": "lifts", "folder": "."}):
        if test.examples and test.name != "dihaptic.session.Session.exact":
            failed, tried = doctest.DocTestRunner(optionflags=flags).run(test)
            assert tried and not failed, test.name
"""


class Reader(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.here = pathlib.Path(cls.folder.name)
        cls.made = cls.here / "made"
        subprocess.run([PROJECT / "packaging/reader/build", PACKAGE, cls.made, "1.2.3"], check=True)
        subprocess.run([sys.executable, "-m", "venv", "--system-site-packages", cls.here / "python"], check=True)
        cls.python = cls.here / "python/bin/python3"
        cls.environment = {"PATH": "/nowhere", "HOME": cls.folder.name, "LANG": "C.UTF-8", "MPLBACKEND": "Agg"}
        cls.pip(cls, "install", "--no-index", "--no-deps", *cls.made.glob("*.whl"))

    def pip(self, *words):
        done = subprocess.run([self.python, "-m", "pip", "--quiet", *words], cwd=self.here,
                              env=self.environment, capture_output=True, text=True)
        if done.returncode:
            raise AssertionError(done.stdout + done.stderr)

    def read(self, script, folder, code=0):
        """What a script prints that is run by the Python that has the wheel."""
        file = pathlib.Path(folder) / "script.py"
        file.write_text(script, encoding="utf-8")
        done = subprocess.run([self.python, file.name], cwd=folder, env=self.environment, capture_output=True, text=True)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def recorded(self, experiment, name, **options):
        """A folder with a session of that name in it."""
        folder = self.here / f"{experiment}-{name}"
        folder.mkdir()
        session = dh.run(f"experiments/{experiment}.yaml", out=folder, progress=False, **options)
        return folder, session.folder.rename(folder / name)

    def test_does_what_the_manual_says_of_reading(self):
        folder, _ = self.recorded("first-trials", "lifts", simulate=True, participant="sim-001")
        page = blocks((MANUAL / "tutorials/read-in-python.md").read_text(encoding="utf-8"))
        said = self.read("".join(block.text for block in page if block.kind == "python"), folder)
        shown = [block.text for block in page if block.kind == "text"]
        self.assertEqual(len(shown), 1)
        self.assertIsNone(unlike(said, shown[0]))
        for picture in ("session.png", "aligned.png"):
            self.assertGreater((folder / picture).stat().st_size, 10_000)

    def test_has_the_examples_of_its_functions(self):
        folder, _ = self.recorded("lift-block", "lifts")
        small_study.rehearse(folder)
        (folder / "studies").symlink_to(PROJECT / "studies")
        self.read(EXAMPLES, folder)

    def test_reads_a_rehearsal(self):
        dh.rehearse("experiments/first-trials.yaml", 2, out=self.here / "study", progress=False)
        said = self.read("import dihaptic as dh; print(dh.Rehearsal('study').trials.ppid.nunique())", self.here)
        self.assertEqual(said, "2\n")

    def test_draws_figures_of_a_rehearsal(self):
        dh.rehearse("experiments/fitts-law.yaml", 2, out=self.here / "fitts", progress=False)
        said = self.read("from dihaptic import figures; print(len(figures.draw('fitts')) > 0)", self.here)
        self.assertEqual(said, "True\n")
        self.assertTrue(list((self.here / "fitts/figures").glob("*.pdf")))

    def test_says_of_all_else_what_it_takes(self):
        said = self.read("import dihaptic as dh; print(dh.__version__, dh.__file__); dh.run('lift.yaml')", self.here, code=1)
        self.assertIn(str(self.here / "python/lib"), said)
        self.assertEqual(said.strip().splitlines()[-1], "ImportError: dihaptic.run needs the program, and this is "
                         "dihaptic-read, which only reads. Install Dihaptic on Debian 12 or 13, as its README shows.")
        folder, session = self.recorded("lift-block", "exact")
        said = self.read("import dihaptic as dh; dh.load('exact').exact('grip_force')", folder, code=1)
        self.assertIn("ImportError: dihaptic.Session.exact needs the program", said)

    def test_needs_nothing_that_unix_alone_has(self):
        said = self.read(f"""
import os, sys, h5py, numpy, pandas, yaml, matplotlib.pyplot
for name in {OF_UNIX}:
    sys.modules[name] = None
del os.fork
import dihaptic as dh
print(dh.load)
""", self.here)
        self.assertIn("<function load", said)

    def test_is_made_of_its_sources_to_the_byte(self):
        again = self.here / "again"
        shutil.unpack_archive(next(self.made.glob("*.tar.gz")), again)
        script = "import sys, flit_core.buildapi as flit; flit.build_wheel(sys.argv[1])"
        wheel = next(self.made.glob("*.whl"))
        dates = {**os.environ, "SOURCE_DATE_EPOCH": "1700000000"}
        subprocess.run([PROJECT / "packaging/reader/build", PACKAGE, self.here / "dated", "1.2.3"], env=dates, check=True)
        subprocess.run([sys.executable, "-c", script, again], cwd=next(again.iterdir()), env=dates, check=True)
        self.assertEqual((again / wheel.name).read_bytes(), (self.here / "dated" / wheel.name).read_bytes())

    def test_says_how_to_have_the_whole_where_the_program_is(self):
        whole, _remedy._FOLDER = _remedy._FOLDER, self.here
        path = os.environ["PATH"]
        (self.here / "dihaptic").touch(mode=0o755)
        try:
            os.environ["PATH"] = str(self.here)
            self.assertIn("Type pip uninstall dihaptic-read", _remedy.needs_program("run", None))
        finally:
            _remedy._FOLDER, os.environ["PATH"] = whole, path

    @soak.alone
    def test_is_typed_for_the_oldest_python_that_it_is_for(self):
        try:
            import mypy  # noqa: F401
        except ImportError:
            needs.skip("mypy is not installed; it is in the Debian package mypy")
        if int(numpy.__version__.split(".")[0]) > 1:
            needs.skip("the types of numpy 2 are written for a newer Python than 3.9; Debian 12 has numpy 1")
        done = subprocess.run([sys.executable, "-m", "mypy", "--python-version", "3.9", "--config-file", "python/mypy.ini",
                               "--cache-dir", os.devnull, "python/dihaptic"], capture_output=True, text=True)
        read = {path.name for path in (self.here / "python").glob("lib/*/site-packages/dihaptic/*.py")}
        self.assertGreater(len(read), 9)
        wrong = [line for line in done.stdout.splitlines() if pathlib.Path(line.split(":")[0]).name in read]
        self.assertEqual(wrong, [])


class Facts(unittest.TestCase):
    def test_are_the_program_s(self):
        self.assertEqual(json.loads((PACKAGE / "facts.json").read_text(encoding="utf-8")),
                         json.loads(json.dumps(_native.facts())))

    def test_have_every_unit(self):
        units = set(re.findall(r'Unit\{"(\w+)",', (PROJECT / "src/base/unit.cpp").read_text(encoding="utf-8")))
        self.assertGreater(len(units), 30)
        self.assertLessEqual(units, set(_native.facts()["units"]))
        self.assertLessEqual(set(dh.quantities().unit) - {"1"}, set(_native.facts()["units"].values()))


if __name__ == "__main__":
    unittest.main()
