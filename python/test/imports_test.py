"""The package is imported from anywhere, says in a line what it cannot do there and why, and is typed."""

import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import venv

sys.path.append("test")
import needs  # noqa: E402

PACKAGE = pathlib.Path(os.environ["PYTHONPATH"]).absolute()
HERE = pathlib.Path(__file__).resolve().parent.parent


def python(code, package, folder="/", interpreter=sys.executable):
    environment = {**os.environ, "PYTHONPATH": str(package)}
    done = subprocess.run([interpreter, "-c", code], cwd=folder, env=environment, capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


class Imports(unittest.TestCase):
    def copy(self, folder, *without):
        copied = pathlib.Path(folder) / "dihaptic"
        shutil.copytree(PACKAGE / "dihaptic", copied, ignore=shutil.ignore_patterns(*without))
        return copied.parent

    def last_line(self, said):
        return said.strip().splitlines()[-1]

    def test_from_a_folder_that_is_not_the_checkout(self):
        code, said = python("import dihaptic; print(dihaptic.__version__, dihaptic.check)", PACKAGE)
        self.assertEqual(code, 0, said)
        code, said = python("import dihaptic.program as p; print(p.program())", PACKAGE)
        self.assertEqual(said.strip(), str((PACKAGE.parent / "dihaptic").resolve()))

    def test_that_was_not_built(self):
        with tempfile.TemporaryDirectory() as folder:
            code, said = python("import dihaptic", self.copy(folder, "_native*.so", "facts.json"))
        self.assertEqual(code, 1)
        self.assertRegex(self.last_line(said), r"^ImportError: dihaptic has not been built here. Run \./dev build")

    def test_without_the_module_reads_and_says_of_all_else_what_it_takes(self):
        with tempfile.TemporaryDirectory() as folder:
            package = self.copy(folder, "_native*.so")
            code, said = python("import dihaptic; print(dihaptic.__all__); dihaptic.run", package)
            self.assertEqual(code, 1)
            self.assertIn("'load'", said)
            self.assertNotIn("'run'", said)
            self.assertRegex(self.last_line(said), "^ImportError: dihaptic.run needs the module _native, .* Run ./dev build.$")
            code, said = python("from dihaptic import load, World", package)
            self.assertRegex(self.last_line(said), "^ImportError: dihaptic.World needs the module _native")
            code, said = python("import dihaptic; dihaptic.runn", package)
            self.assertEqual(self.last_line(said), "AttributeError: module 'dihaptic' has no attribute 'runn'")

    def test_by_another_python(self):
        with tempfile.TemporaryDirectory() as folder:
            package = self.copy(folder, "_native*.so")
            (package / "dihaptic/_native.cpython-311-x86_64-linux-gnu.so").touch()
            code, said = python("import sys; sys.version_info = (3, 12, 1); import dihaptic; dihaptic.run", package)
        self.assertEqual(code, 1)
        self.assertIn("is built for Python 3.11, and this is 3.12, where dihaptic only reads. Use Debian's", self.last_line(said))

    def test_without_a_library(self):
        for name in ("numpy", "pandas", "h5py", "yaml"):
            with self.subTest(name):
                code, said = python(f"import sys; sys.modules['{name}'] = None; import dihaptic", PACKAGE)
                self.assertEqual(code, 1)
                self.assertEqual(self.last_line(said), f"ImportError: dihaptic needs {name}: sudo apt install python3-{name}.")

    def test_in_an_environment_that_does_not_see_debians_libraries(self):
        with tempfile.TemporaryDirectory() as folder:
            venv.create(folder)
            interpreter = f"{folder}/bin/python3"
            code, said = python("import dihaptic", PACKAGE, interpreter=interpreter)
        self.assertEqual(code, 1)
        what = f"dihaptic needs numpy: this Python, {interpreter}, lacks it. Use Debian's: /usr/bin/python3."
        self.assertEqual(self.last_line(said), f"ImportError: {what}")

    def test_figures_without_a_library(self):
        for name in ("matplotlib", "scipy"):
            with self.subTest(name):
                code, said = python(f"import sys; sys.modules['{name}'] = None; import dihaptic.figures", PACKAGE)
                self.assertEqual(code, 1)
                self.assertEqual(self.last_line(said), f"ImportError: dihaptic needs {name}: sudo apt install python3-{name}.")

    def test_types_are_strict(self):
        if importlib.util.find_spec("mypy") is None:
            needs.skip("mypy is not installed; it is in the Debian package mypy")
        done = subprocess.run(
            [sys.executable, "-m", "mypy", "--config-file", HERE / "mypy.ini", "--cache-dir", os.devnull, HERE / "dihaptic"],
            capture_output=True,
            text=True,
        )
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertTrue((PACKAGE / "dihaptic/py.typed").is_file())


if __name__ == "__main__":
    unittest.main()
