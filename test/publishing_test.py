"""What GitHub and Zenodo read of the project is well formed and true, and a release is refused where something is missing.

Usage: publishing_test.py, from the project's folder.
"""
import json
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

import yaml

WORKFLOWS = sorted(pathlib.Path(".github/workflows").glob("*.yml"))
FORMS = sorted(pathlib.Path(".github/ISSUE_TEMPLATE").glob("*.yml"))


def read(path):
    return yaml.load(pathlib.Path(path).read_text(), Loader=yaml.BaseLoader)  # so that `on` is not read as a truth value


class Workflows(unittest.TestCase):
    def jobs(self):
        for path in WORKFLOWS:
            for name, job in read(path)["jobs"].items():
                yield f"{path.name}: {name}", job

    def test_do_nothing_that_dev_does_not(self):
        commands = subprocess.run(["./dev", "help"], check=True, capture_output=True, text=True).stdout
        presets = {preset["name"] for preset in json.loads(pathlib.Path("CMakePresets.json").read_text())["testPresets"]}
        tried = 0
        for name, job in self.jobs():
            git, fetch, *steps = job["steps"]
            self.assertRegex(git["run"], r"^apt-get update && apt-get install [a-z -]+ git$")
            self.assertRegex(fetch["uses"], "^actions/checkout@")
            for step in steps:
                self.assertEqual(set(step), {"run"}, name)
                for words in job["strategy"]["matrix"].get("command", [""]):
                    line = step["run"].replace("${{ matrix.command }}", words)
                    with self.subTest(name, line=line):
                        dev, command, *arguments = line.split()
                        self.assertEqual(dev, "./dev")
                        self.assertRegex(commands, rf"(?m)^\./dev {command}\b")
                        self.assertLessEqual(set(arguments), presets)
                    tried += 1
        self.assertGreaterEqual(tried, 4)

    def test_run_on_the_debians_of_the_page(self):
        page = re.search(r"(?m)^\| \| (.*) \|$", pathlib.Path("docs/platforms.md").read_text())[1]
        test = read(".github/workflows/test.yml")["jobs"]["test"]
        self.assertEqual([f"Debian {debian}" for debian in test["strategy"]["matrix"]["debian"]], page.split(" | "))
        for name, job in self.jobs():
            for debian in job["strategy"]["matrix"].get("debian", [""]):
                container = job["container"].replace("${{ matrix.debian }}", debian)
                self.assertIn(container.replace("debian:", "Debian "), page.split(" | "), name)


class Forms(unittest.TestCase):
    """By GitHub's syntax for issue forms."""

    ATTRIBUTES = {
        "markdown": {"value"},
        "input": {"label", "description", "placeholder", "value"},
        "textarea": {"label", "description", "placeholder", "value", "render"},
        "checkboxes": {"label", "description", "options"},
    }

    def test_are_well_formed(self):
        self.assertEqual(len(FORMS), 3)
        for path in FORMS:
            with self.subTest(path.name):
                form = read(path)
                self.assertEqual(set(form), {"name", "description", "body"})
                asked = [part for part in form["body"] if part["type"] != "markdown"]
                for part in form["body"]:
                    self.assertLessEqual(set(part), {"type", "id", "attributes", "validations"})
                    self.assertLessEqual(set(part["attributes"]), self.ATTRIBUTES[part["type"]])
                    self.assertLessEqual(set(part.get("validations", {})), {"required"})
                for key in [[part["id"] for part in asked], [part["attributes"]["label"] for part in asked]]:
                    self.assertEqual(len(set(key)), len(asked))
                self.assertTrue(any(part.get("validations") == {"required": "true"} for part in asked))

    def test_name_pages_that_are_there(self):
        for path in FORMS:
            for page in re.findall(r"\b[\w/]+\.md\b", path.read_text()):
                self.assertTrue(pathlib.Path(page).exists(), page)


class Zenodo(unittest.TestCase):
    def test_has_the_facts_of_the_citation(self):
        cited = read("CITATION.cff")
        self.assertEqual(json.loads(pathlib.Path(".zenodo.json").read_text()), {
            "upload_type": cited["type"],
            "title": cited["title"],
            "description": cited["abstract"],
            "creators": [{"name": author["name"]} for author in cited["authors"]],
            "license": cited["license"],
            "keywords": cited["keywords"],
        })


class Release(unittest.TestCase):
    """A project that has a version, a list of changes and the script alone."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.here = pathlib.Path(folder.name)
        (self.here / "packaging").mkdir()
        shutil.copy("packaging/release", self.here / "packaging")
        (self.here / "CMakeLists.txt").write_text("project(dihaptic VERSION 1.2.3 LANGUAGES CXX)\n")
        (self.here / ".gitignore").write_text("/build/\n")
        (self.here / "CHANGELOG.md").write_text("## 1.2.3 (2026-11-30)\n")
        self.git("init", "--quiet")
        self.commit()

    def git(self, *words):
        subprocess.run(["git", "-c", "user.name=Ada", "-c", "user.email=ada@dihaptic.invalid", *words], cwd=self.here, check=True,
                       stdout=subprocess.DEVNULL)

    def commit(self):
        self.git("add", "--all")
        self.git("commit", "--quiet", "--message", "Say something")

    def refused(self, by):
        done = subprocess.run(["packaging/release"], cwd=self.here, capture_output=True, text=True)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertRegex(done.stderr, f"^release: {by}")
        self.assertEqual(len(done.stderr.splitlines()), 1)
        self.assertEqual(list(self.here.glob("build/release.*")), [])

    def test_is_refused_with_files_that_were_changed(self):
        (self.here / "new.txt").touch()
        self.refused("files have been changed")

    def test_is_refused_without_its_changes(self):
        for changes in ("## 1.2.3 (unreleased)\n", "## 1.2.30 (2026-11-30)\n", "## 1x2.3 (2026-11-30)\n", ""):
            with self.subTest(changes):
                (self.here / "CHANGELOG.md").write_text(changes)
                self.commit()
                self.git("tag", "--force", "--annotate", "v1.2.3", "--message", "1.2.3")
                self.refused(r"CHANGELOG.md has no section of version 1\.2\.3")

    def test_is_refused_without_a_tag_of_the_commit(self):
        self.refused("this commit has no tag v1.2.3")
        self.git("tag", "v1.2.3")  # a lightweight tag, which git describe, and so the packages, ignore
        self.refused("this commit has no tag v1.2.3")
        self.git("tag", "--force", "--annotate", "v1.2.3", "--message", "1.2.3")
        (self.here / "new.txt").touch()
        self.commit()
        self.refused("this commit has no tag v1.2.3")

    def test_is_not_made_over_another(self):
        self.git("tag", "--annotate", "v1.2.3", "--message", "1.2.3")
        (self.here / "build/releases/1.2.3").mkdir(parents=True)
        self.refused("build/releases/1.2.3 is there already")


if __name__ == "__main__":
    unittest.main()
