"""The examples in the package's docstrings do what they say, and each public name has one."""

import doctest
import importlib
import inspect
import pathlib
import pkgutil
import tempfile
import unittest

import matplotlib

matplotlib.use("Agg")

import small_study  # noqa: E402

import dihaptic  # noqa: E402
import dihaptic.figures  # noqa: E402


def modules():
    names = [name for _, name, _ in pkgutil.walk_packages(dihaptic.__path__, "dihaptic.") if "._" not in name]
    return [importlib.import_module(name) for name in names]


class Examples(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        session = dihaptic.run("experiments/lift-block.yaml", out=cls.folder.name, progress=False)
        small_study.rehearse(cls.folder.name)
        cls.given = {"folder": cls.folder.name, "lift_session": str(session.folder)}

    def test_all_run(self):
        for module in modules():
            with self.subTest(module.__name__):
                flags = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
                done = doctest.testmod(module, extraglobs=self.given, optionflags=flags, verbose=False)
                self.assertEqual(done.failed, 0)

    def test_the_page_s_run(self):
        flags = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
        page = str(pathlib.Path("docs/python.md").absolute())
        done = doctest.testfile(page, module_relative=False, globs=dict(self.given), optionflags=flags)
        self.assertEqual(done.failed, 0)
        self.assertGreater(done.attempted, 20)

    def test_each_public_name_has_one(self):
        for name in dihaptic.__all__:
            thing = getattr(dihaptic, name)
            with self.subTest(name):
                self.assertIn(">>>", inspect.getdoc(thing) or "")
        for name in dihaptic.figures.__all__:  # some show what a session of one lift does not have
            with self.subTest(name):
                self.assertTrue(inspect.getdoc(getattr(dihaptic.figures, name)))

    def test_each_public_method_says_what_it_does(self):
        for name in dihaptic.__all__:
            for member, value in vars(getattr(dihaptic, name)).items() if inspect.isclass(getattr(dihaptic, name)) else ():
                if not member.startswith("_") and (callable(value) or isinstance(value, property)):
                    with self.subTest(f"{name}.{member}"):
                        self.assertTrue(inspect.getdoc(value))

    def test_the_list_of_public_names_is_in_order(self):
        self.assertEqual(sorted(dihaptic.__all__), dihaptic.__all__)


if __name__ == "__main__":
    unittest.main()
