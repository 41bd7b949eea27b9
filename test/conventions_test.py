"""docs/conventions.md names files and parts of the code: all of them are there, and pages link only to what is.

Usage: conventions_test.py, from the project's folder.
"""
import pathlib
import re
import unittest

PAGE = pathlib.Path("docs/conventions.md").read_text()
PATHS = [path for top in ("*", "app/**/*", "bench/**/*", "cmake/*", "docs/**/*", "experiments/*", "meshes/*", "python/**/*", "src/**/*", "test/**/*", "textures/*")
         for path in pathlib.Path(".").glob(top)]
CODE = "".join(path.read_text() for path in PATHS if path.suffix in (".h", ".cpp", ".cmake", ".py")
               or path.name == "CMakeLists.txt")


def named():
    """What stands in backquotes on the page, but for placeholders (NAME), commands and examples of notation."""
    for text in re.findall(r"`([^`\n]+)`", PAGE[PAGE.index("## Code"):]):
        if not re.search(r"[A-Z]{4}|[\s*]|^\./|^Upper|_case$|^trailing_$|^kName$", text):
            yield text


class Conventions(unittest.TestCase):
    def test_files_are_there(self):
        paths = [text for text in named() if "/" in text or re.search(r"\.(h|cpp|md|py|txt|json|yaml)$", text)]
        self.assertGreater(len(paths), 20)
        for path in paths:
            with self.subTest(path):
                there = any(("/" + str(found)).endswith("/" + path.rstrip("/")) for found in PATHS)
                self.assertTrue(there or f'"{path}"' in CODE)  # the names of a session's files are in the code

    def test_names_are_in_the_code(self):
        names = [text for text in named() if re.fullmatch(r"[A-Za-z_]\w*(::\w+)*(\(\))?", text)]
        self.assertGreater(len(names), 15)
        for name in names:
            with self.subTest(name):
                self.assertRegex(CODE, r"\b" + re.sub(r".*::|\(\)", "", name) + r"\b")

    def test_pages_link_to_what_is_there(self):
        for page in [path for path in PATHS if path.suffix == ".md"]:
            # pictures in the manual's pages are made together with the manual
            begin = r"(?<!!)\[[^\]]*" if page.is_relative_to("docs/manual") else ""
            for link in re.findall(begin + r"\]\(([^)#:]+)(?:#[^)]*)?\)", page.read_text()):
                with self.subTest(page=str(page), link=link):
                    self.assertTrue((page.parent / link).exists())

    def test_each_experiment_is_listed(self):
        listed = set(re.findall(r"`([\w-]+\.yaml)`", pathlib.Path("docs/experiments.md").read_text()))
        self.assertEqual(listed, {path.name for path in pathlib.Path("experiments").glob("*.yaml")})

    def test_an_addition_touches_three_files_beside_its_own(self):
        """Of one that exists of each kind: the files outside its own that know its name. Those of two kinds are more, which
        must not grow."""
        added = {  # kind: (name in the code, its own files, maximum number of other files)
            "a load": (r"LoadKind::curl\b", "src/task/effects/load/", 3),
            "a place of perturbation": (r"\bJointSpec\b|\bjoint_properties\b", "src/task/effects/joint/", 3),
            "a measure of behaviour": (r"\bspectral_arc_length\b", "src/analysis/measures/", 3),
            "a command": (r"\badd_export\b", "app/cli/export.cpp", 3),
            "a status bit": (r"\bkAbandoned\b", "src/base/status.h", 3),
            "a device backend": (r"\bhaply\b", "src/devices/haply/", 3),
            "a contact solver": (r"\bstaggered_projections\b", "src/contact/staggered_projections/", 7),
            "a kind of joint": (r"\buniversal\b|\babout_two_axes\b", "src/scene/joint", 3),
            "a joint's coordinate": (r"\bCoordinate::distance\b|\bis_distance\b|\bJointKind::distance\b", "src/scene/joint", 3)}
        sources = {path.as_posix(): re.sub(r"//.*", "", path.read_text()) for top in ("src", "app", "bench")
                   for path in pathlib.Path(top).rglob("*")
                   if path.suffix in (".h", ".cpp") and not {"test", "soak", "fuzz"} & set(path.parts)}
        for kind, (name, own, most) in added.items():
            with self.subTest(kind):
                others = [path for path, text in sources.items() if re.search(name, text) and not path.startswith(own)]
                self.assertTrue(any(re.search(name, text) for path, text in sources.items() if path.startswith(own)))
                self.assertLessEqual(len(others), most, others)

    def test_rooms_that_read_the_record_include_none_that_makes_it(self):
        """Neither themselves nor by their CMake file: docs/adr/0028-the-record-is-a-room.md."""
        makers = "devices|dynamics|haptics|host|rig|servo"
        for room in ["analysis", "frame", "headset", "person", "recording", "sound", "task", "view"]:
            for path in pathlib.Path("src", room).rglob("*"):
                if path.suffix not in (".h", ".cpp") or {"test", "soak", "fuzz"} & set(path.parts):
                    continue
                with self.subTest(str(path)):
                    self.assertEqual(re.findall(rf'#include "((?:{makers})/[^"]+)"', path.read_text()), [])
            with self.subTest(room):
                uses = re.search(r"\bUSES ((?:[a-z]+ *)+)", pathlib.Path("src", room, "CMakeLists.txt").read_text())[1]
                self.assertEqual(set(uses.split()) & set(makers.split("|")), set())

    def test_columns_are_looked_up_by_name_where_tables_are_read_alone(self):
        """A session's tables are read into the structs of src/rows; a table that a person hands in has no struct."""
        given = {"app/cli/fit.cpp", "src/task/file/sampled_path.h", "src/task/file/sampled_path.cpp"}
        for path in [*pathlib.Path("src").rglob("*"), *pathlib.Path("app").rglob("*")]:
            if path.suffix not in (".h", ".cpp") or {"test", "soak", "fuzz"} & set(path.parts):
                continue
            if path.is_relative_to("src/base") or path.is_relative_to("src/rows") or path.as_posix() in given:
                continue
            with self.subTest(path.as_posix()):
                self.assertNotIn("CsvFile", path.read_text())


if __name__ == "__main__":
    unittest.main()
