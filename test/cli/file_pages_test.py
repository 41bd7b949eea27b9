"""The pages of docs/files: their examples are done as a reader would, and their fragments have keys that exist.

A block of yaml whose first line is a comment with its name is a whole file; it is written, and the commands below it are run.
Blocks of `sh` and `text` are what they are in the manual (docs/manual/make/pages.py). Any other block of yaml is a part of a
file: an editor that has the program's schemas would find no mistake in it, apart from keys that it leaves out.

Usage: file_pages_test.py PROGRAM, from the project's folder.
"""
import concurrent.futures
import copy
import json
import os
import pathlib
import re
import sys
import tempfile
import unittest

sys.path.append("test")
import needs  # noqa: E402
import soak  # noqa: E402

needs.module("jsonschema", "python3-jsonschema")
import jsonschema  # noqa: E402
import yaml  # noqa: E402

from program import dihaptic, PROGRAM
from schemas_test import FOLDERS, Yaml12

sys.path.append("docs/manual/make")
from pages import run_text

PAGES = sorted(pathlib.Path("docs/files").glob("*.md"))
YAML = re.compile(r"^```yaml\n(?:# (\S+\.yaml)\n)?(.*?)^```\n", re.DOTALL | re.MULTILINE)


def runnable(page):
    """The page with its whole files as the manual has them, and without its fragments."""
    return YAML.sub(lambda block: f"```{{code-block}} yaml\n:caption: {block[1]}\n\n{block[2]}```\n" if block[1] else "",
                    page)


def fragments(page):
    return [block[2] for block in YAML.finditer(page) if not block[1]]


def without_required(schema):
    """A schema that does not mind what is left out."""
    if isinstance(schema, list):
        return [without_required(part) for part in schema]
    if not isinstance(schema, dict):
        return schema
    out = {}
    for key, part in schema.items():
        if key == "required" and isinstance(part, list):
            continue
        out[key] = copy.deepcopy(part) if key == "if" else without_required(part)
    return out


class Keys:
    """What the schemas say of each key, wherever it stands."""

    def __init__(self):
        self.wholes = [without_required(json.loads(dihaptic("schema", kind).stdout)) for kind in FOLDERS]

    def schemas(self, key):
        for whole in self.wholes:
            validator = jsonschema.Draft7Validator(whole)
            todo = [whole]
            while todo:
                part = todo.pop()
                if isinstance(part, list):
                    todo += part
                elif isinstance(part, dict):
                    todo += part.values()
                    properties = part.get("properties")
                    if isinstance(properties, dict) and isinstance(properties.get(key), dict):
                        yield validator.evolve(schema=properties[key])

    def problem(self, key, value):
        """What is wrong with this part of a file, or None."""
        found = []
        for validator in self.schemas(key):
            wrong = [f"{key}.{'.'.join(map(str, error.absolute_path))}: {error.message[:200]}"
                     for error in validator.iter_errors(value)]
            if not wrong:
                return None
            found.append(wrong)
        return min(found, key=len)[0] if found else f"{key}: no file has this key"


class Fragments(unittest.TestCase):
    def test_have_keys_that_exist(self):
        keys, found = Keys(), 0
        for page in PAGES:
            for fragment in fragments(page.read_text()):
                value = yaml.load(fragment, Loader=Yaml12)
                if not isinstance(value, dict):
                    continue  # a list of a lab's own file: docs/files/rig.md
                for key, part in value.items():
                    found += 1
                    with self.subTest(page=page.name, key=key):
                        self.assertIsNone(keys.problem(key, part))
        self.assertGreater(found, 50)

    def test_of_mistakes_are_found(self):
        keys = Keys()
        self.assertIn("no file has this key", keys.problem("stats", []))
        self.assertIsNotNone(keys.problem("states", [{"name": "reach", "exit": []}]))
        self.assertIsNotNone(keys.problem("bodies", [{"name": "block", "shape": "box", "friction": "high"}]))
        self.assertIsNone(keys.problem("bodies", [{"name": "block", "shape": "box", "friction": 0.5}]))


class Pages(unittest.TestCase):
    def test_begin_with_an_example(self):
        for page in PAGES:
            with self.subTest(page.name):
                self.assertRegex(page.read_text().split("\n## ")[0], r"(?m)^```sh\n")

    def test_are_listed(self):
        index = pathlib.Path("docs/files.md").read_text()
        manual = pathlib.Path("docs/manual/index.md").read_text()
        for page in PAGES:
            with self.subTest(page.name):
                self.assertIn(f"(files/{page.name})", index)
                self.assertIn(f"\nreference/files/{page.stem}\n", manual)

    def test_links_lead_to_headings(self):
        for page in [*pathlib.Path("docs").glob("*.md"), *PAGES]:
            for path, heading in re.findall(r"\]\(([^)#:\s]*)#([^)\s]+)\)", page.read_text()):
                target = page.parent / path if path else page
                headings = re.findall(r"(?m)^#+ (.*)$", target.read_text())
                known = [re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", "-") for text in headings]
                with self.subTest(page=page.name, link=f"{path}#{heading}"):
                    self.assertIn(heading, known)

    def test_do_what_they_say(self):
        with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as some:
            runs = {page: some.submit(run_text, pathlib.Path(PROGRAM).resolve(), runnable(page.read_text()),
                                     pathlib.Path(folder, page.stem))
                    for page in soak.of(PAGES[::5], PAGES)}
            for page, done in runs.items():
                with self.subTest(page.name):
                    self.assertIsNone(done.exception())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
