"""The manual (docs/manual): what its makers would otherwise have to look for. Its pages are run by tests of their own
(docs/manual/make/pages.py).

Usage: manual_test.py, from the project's folder.
"""
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

import needs

MANUAL = pathlib.Path("docs/manual")
sys.path.append(str(MANUAL / "make"))
from pages import all_pages, blocks, faults, script, unlike

PAGE = """# Title

```{code-block} yaml
:caption: scene.yaml

title: A scene
```

```sh
cat scene.yaml
```

```text
title: A ...
```
"""
SAID = "\n@@ line 9\ntitle: A scene\n"


def prose(page):
    """A page without its blocks, its code and the addresses of its links."""
    text = (MANUAL / f"{page}.md").read_text()
    text = re.sub(r"^```\{(?:note|warning|tip)\}\n(.*?)^```$", r"\1", text, flags=re.DOTALL | re.MULTILINE)
    text = re.sub(r"^```.*?^```$", "", text, flags=re.DOTALL | re.MULTILINE)
    return re.sub(r"\{doc\}`[^`]*`|`[^`]*`|\]\([^)]*\)", " ", text)


def named(page):
    """What stands in backquotes in its text."""
    text = re.sub(r"^```.*?^```$", "", (MANUAL / f"{page}.md").read_text(), flags=re.DOTALL | re.MULTILINE)
    return [re.sub(r"\s+", " ", code) for code in re.findall(r"(?<!\})`([^`]+)`", text)]


class Words(unittest.TestCase):
    """Plain English, in British spelling; the words that no dictionary has are in words.txt."""

    def test_are_spelled_as_a_dictionary_or_the_list_has_them(self):
        words = (MANUAL / "words.txt").read_text().split()
        self.assertEqual(words, sorted(set(words), key=lambda word: (word.lower(), word)))
        needs.for_this_test("hunspell", "hunspell-en-gb")
        unknown = {}
        for page in all_pages():
            said = subprocess.run(["hunspell", "-d", "en_GB", "-i", "utf-8", "-l"], input=prose(page), text=True,
                                  capture_output=True, check=True).stdout
            for word in said.split():
                unknown.setdefault(word.removesuffix("'s"), page)
        wrong = {word: page for word, page in unknown.items() if word not in words}
        self.assertEqual(wrong, {}, "correct them, or add them to docs/manual/words.txt")
        # the dictionaries of other Debian versions contain some of them
        told = set(re.findall(r"[^\W\d_]+", " ".join(prose(page) for page in all_pages())))
        unused = [word for word in words if word not in unknown and not told.issuperset(re.findall(r"[^\W\d_]+", word))]
        self.assertEqual(unused, [], "no page needs these words of the list")

    def test_files_that_are_named_are_there(self):
        shipped = re.search(r"install\(DIRECTORY (\w[\w ]*)\n", pathlib.Path("cmake/install.cmake").read_text())
        folders = "|".join(shipped[1].split())
        found = 0
        for page in all_pages():
            for code in named(page):
                for path in re.findall(rf"(?:^| )((?:{folders})/\S+)", code):
                    found += 1
                    with self.subTest(page=page, path=path):
                        self.assertTrue(pathlib.Path(path).exists())
        self.assertGreater(found, 5)


class Pages(unittest.TestCase):
    """No block of a page can be left out, and none may say what is not so."""

    def test_blocks_are_files_commands_and_what_is_printed(self):
        found = [(block.line, block.kind, block.name) for block in blocks(PAGE)]
        self.assertEqual(found, [(3, "yaml", "scene.yaml"), (9, "sh", ""), (13, "text", "")])
        self.assertIn("cat > 'scene.yaml' <<'END OF THE FILE'\ntitle: A scene\nEND OF THE FILE\n", script(PAGE))

    def test_a_second_block_continues_a_file(self):
        self.assertIn("cat >> 'scene.yaml'", script(PAGE + PAGE))

    def test_blocks_that_would_not_be_run_are_refused(self):
        for text in ("  ```sh\n  ls\n  ```\n", "~~~sh\nls\n~~~\n", "````sh\nls\n````\n", "```\nls\n```\n",
                     "```yaml\na: 1\n```\n", "```python\nprint(1)\n```\n", "```{literalinclude} some.py\n```\n",
                     "```sh skip\nls\n```\n", "```{code-block} sh\n:caption: some.sh\n\nls\n```\n"):
            with self.subTest(text), self.assertRaises(ValueError):
                blocks(text)

    def test_what_is_printed_is_what_the_page_shows(self):
        self.assertEqual(faults(PAGE, SAID), [])
        wrong = faults(PAGE, SAID.replace("A", "B"))
        self.assertRegex(wrong[0], "line 13: the commands above do not print: title: A")
        self.assertIsNone(unlike("a\nb 1 c\nd", "a\n...\nb ... c"))
        self.assertEqual(unlike("a\nb", "b\na"), "a")  # the order matters

    def test_a_file_that_no_command_uses_is_a_fault(self):
        self.assertRegex(faults(PAGE.replace("cat scene", "cat other"), SAID)[0], "uses scene.yaml")

    def test_pages_are_short(self):
        for page in all_pages():
            with self.subTest(page):
                self.assertLessEqual(len(prose(page).splitlines()), 120)


if __name__ == "__main__":
    unittest.main()
