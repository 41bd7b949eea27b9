"""No function is long or tangled: at most 60 lines, and a cyclomatic complexity of at most 15. No class is hard to
survey: at most 250 lines, and 20 data members.

Those that read better whole are listed in functions_exceptions.txt, each with its reason. The complexity is
1 + the number of if, for, while, case, catch, &&, || and ?: in the function's text.

Usage: functions_test.py, from the project's folder.
"""
import collections
import json
import pathlib
import re
import subprocess
import unittest

import needs

needs.program("ctags", "universal-ctags")

MOST_LINES = 60
MOST_COMPLEX = 15
# limits that even an exception may not exceed
MOST_LINES_EVER = 80
MOST_COMPLEX_EVER = 20

MOST_CLASS_LINES = 250
MOST_MEMBERS = 20

EXCEPTIONS = pathlib.Path(__file__).with_name("functions_exceptions.txt")


def tags_of(kinds):
    """The tags of these kinds in the product's C++, as ctags gives them."""
    files = [str(file) for folder in ("src", "app", "bench", "python") for file in pathlib.Path(folder).rglob("*")
             if file.suffix in (".h", ".cpp") and not {"test", "soak", "fuzz"} & set(file.parts)]
    tags = subprocess.run(["ctags", "--output-format=json", "--fields=+ne", f"--kinds-C++={kinds}", "--language-force=C++", "-f", "-", "-L", "-"],
                          input="\n".join(files), capture_output=True, text=True, check=True).stdout
    return map(json.loads, tags.splitlines())


def name_of(tag, *more):
    """The name of a tag with its scope, without anonymous namespaces."""
    scope = [part for part in tag.get("scope", "").split("::") if part and not part.startswith("__anon")]
    return "::".join([part for part in scope if part != "dihaptic"] + list(more))


def classes():
    """Lines of each class or struct of the product, and the number of data members of those that have any (whose names
    end in _)."""
    lines, members = {}, collections.Counter()
    for tag in tags_of("csm"):
        if tag["kind"] in ("class", "struct"):
            name = name_of(tag, tag["name"])
            lines[name] = max(lines.get(name, 0), tag.get("end", tag["line"]) - tag["line"] + 1)
        elif tag["name"].endswith("_"):
            members[name_of(tag)] += 1
    return lines, members


def functions():
    """(file, name, lines, complexity) of each function of the product."""
    for tag in tags_of("f"):
        if "end" not in tag:
            continue
        body = "\n".join(pathlib.Path(tag["path"]).read_text().split("\n")[tag["line"] - 1:tag["end"]])
        body = re.sub(r"//.*|\"(\\.|[^\"\\])*\"|'(\\.|[^'\\])'", "", body)
        branches = re.findall(r"\b(?:if|for|while|case|catch)\b|&&|\|\||\?", body)
        yield tag["path"], name_of(tag, tag["name"]), tag["end"] - tag["line"] + 1, 1 + len(branches)


class Functions(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.all = list(functions())
        cls.excepted = {}
        for line in EXCEPTIONS.read_text().splitlines():
            if line and not line.startswith("#"):
                file, name, reason = line.split(None, 2)
                cls.excepted[file, name] = reason

    def test_are_found(self):
        self.assertGreater(len(self.all), 3000)

    def test_are_short_and_plain(self):
        for file, name, lines, complexity in self.all:
            if (file, name) in self.excepted:
                continue
            with self.subTest(f"{file}: {name}"):
                self.assertLessEqual(lines, MOST_LINES, "lines: split it, or give the reason in functions_exceptions.txt")
                self.assertLessEqual(complexity, MOST_COMPLEX, "complexity: split it, or give the reason there")

    def test_exceptions_are_needed_and_bounded(self):
        for file, name in self.excepted:
            with self.subTest(f"{file}: {name}"):
                found = [(lines, complexity) for f, n, lines, complexity in self.all if (f, n) == (file, name)]
                self.assertTrue(found, "is listed, and not there")
                lines, complexity = map(max, zip(*found))
                self.assertTrue(lines > MOST_LINES or complexity > MOST_COMPLEX, "needs no exception any more")
                self.assertLessEqual(lines, MOST_LINES_EVER)
                self.assertLessEqual(complexity, MOST_COMPLEX_EVER)


class Classes(unittest.TestCase):
    def test_can_be_surveyed(self):
        lines, members = classes()
        self.assertGreater(len(members), 200)
        for name, number in lines.items():
            with self.subTest(name):
                self.assertLessEqual(number, MOST_CLASS_LINES, "lines: take out what can be understood alone")
        for name, number in members.items():
            with self.subTest(name):
                self.assertLessEqual(number, MOST_MEMBERS, "data members: take out what belongs together")


if __name__ == "__main__":
    unittest.main(verbosity=1)
