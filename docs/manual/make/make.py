"""Makes the manual: combines its pages with those of docs/ and the program's own help, and runs Sphinx.

Usage: make.py PROGRAM OUT [RAN]; the pages are then in OUT/html. Pictures are made by the pages' own commands, which
are run first, unless they were already run in the folder RAN. It needs the package on PYTHONPATH.
"""
import concurrent.futures
import inspect
import os
import pathlib
import re
import shutil
import subprocess
import sys

import dihaptic as dh

import pages
from pages import MANUAL, PROJECT

# Pages from elsewhere, with their places in the manual.
ELSEWHERE = {
    **{f"docs/{name}.md": f"reference/{name}" for name in (
        "conventions", "experiments", "figures", "files", "licences", "limits", "measures", "measures-of-behaviour", "promises",
        "python", "quantities", "tables", "window")},
    **{f"docs/files/{path.name}": f"reference/files/{path.stem}" for path in PROJECT.glob("docs/files/*.md")},
    "docs/reference.md": "reference/keys",
    "docs/safety.md": "how-to/safety",
    "src/README.md": "explanation/rooms/rooms",
    **{str(path.relative_to(PROJECT)): "explanation/rooms/" + "-".join(path.parent.relative_to(PROJECT / "src").parts)
       for path in PROJECT.glob("src/*/**/README.md")},
}
LINK = re.compile(r"(!?)\[([^\]]*)\]\(([^)#:\s]*)(#[^)\s]*)?\)")
NAMED = re.compile(r"(?<!\[)`((?:docs|src)/[\w./-]+\.md)`")


class Source:
    """The input of Sphinx."""

    def __init__(self, folder, ran):
        self.folder, self.ran = folder, ran
        self.places = {**{f"docs/manual/{page}.md": page for page in pages.all_pages()}, **ELSEWHERE}

    def add(self, path):
        """A page of the repository, with links within the manual."""
        place = self.places[path]
        text = (PROJECT / path).read_text()
        outside = re.split(r"(^```(?:[a-z]|\{code|\{toc).*?^```$)", text, flags=re.DOTALL | re.MULTILINE)
        outside[::2] = [self.linked(part, path, place) for part in outside[::2]]
        self.write(place + ".md", "".join(outside))

    def linked(self, text, path, place):
        """Text whose links, and pages named in it, lead to the manual's own pages."""
        text = LINK.sub(lambda link: self.link(link, path, place), text)
        return NAMED.sub(lambda name: f"[]({self.way(name[1], place)})" if name[1] in self.places else name[0], text)

    def way(self, file, place):
        return os.path.relpath(self.places[file], os.path.dirname(place)) + ".md"

    def link(self, link, path, place):
        image, text, target, anchor = link.groups()
        if not target:
            return link[0]
        if image:
            return f"![{text}](/{self.picture(path, place, target)})"
        file = os.path.normpath(os.path.join(os.path.dirname(path), target))
        if file in self.places:
            return f"[{text}]({self.way(file, place)}{anchor or ''})"
        return f"{text} (`{file}`)" if text not in file else f"`{file}`"

    def picture(self, path, place, target):
        if path.startswith("docs/manual/"):
            file = self.ran / place / target
        else:
            file = PROJECT / os.path.dirname(path) / target
        copy = self.folder / "pictures" / place / file.name
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(file, copy)
        return copy.relative_to(self.folder)

    def write(self, name, text):
        file = self.folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)


def said(program, *arguments):
    text = subprocess.run([program, *arguments, "--help"], capture_output=True, text=True, check=True).stdout
    return text.replace(str(program), "dihaptic").strip()


def subcommands(text):
    """The table of subcommands in the output of --help."""
    table = re.search(r"^Subcommands:\n((?:  .*\n)+)", text + "\n", re.MULTILINE)
    return re.findall(r"^  ([a-z_]+) +", table[1], re.MULTILINE) if table else []


def commands_page(program):
    """The --help of each command."""
    whole = said(program)
    parts = ["# Commands\n\nWhat each command says with `--help`. All of them return 0 when all went well, 1 when "
             "something ran but its result must not be used as it is, and 2 when the input, the command line or the "
             "disk was at fault.\n",
             f"```text\n{whole}\n```\n"]
    for command in subcommands(whole):
        text = said(program, command)
        parts.append(f"## {command}\n\n```text\n{text}\n```\n")
        parts += [f"### {command} {sub}\n\n```text\n{said(program, command, sub)}\n```\n" for sub in subcommands(text)]
    return "\n".join(parts)


def refuse_unknown_commands(program):
    """Commands in blocks are run; those in sentences must at least exist."""
    known = subcommands(said(program))
    for page in pages.all_pages():
        for command in re.findall(r"`dihaptic\s+([a-z]\w*)", (MANUAL / f"{page}.md").read_text()):
            if command not in known:
                sys.exit(f"docs/manual/{page}.md: there is no command {command}")


def notebook_page(file):
    """A tutorial of docs/tutorials, which is a notebook in text."""
    cells = re.split(r"^# %%( \[markdown\])?\n", file.read_text(), flags=re.MULTILINE)[1:]
    parts = []
    for prose, cell in zip(cells[::2], cells[1::2]):
        parts.append(re.sub(r"^# ?", "", cell, flags=re.MULTILINE) if prose else f"```python\n{cell.strip()}\n```\n")
    return "\n".join(parts)


def functions_page():
    """Docstrings of the Python package."""
    parts = ["# Functions of the Python package\n\nWhat `help(dh)` says, name by name.\n"]
    for name in sorted(dh.__all__, key=str.lower):
        thing = getattr(dh, name)
        plain = inspect.isfunction(thing) or inspect.isclass(thing) and not issubclass(thing, Exception)
        head = name + str(inspect.signature(thing)) if plain else name
        parts.append(f"## {name}\n\n```text\n{head}\n\n{inspect.getdoc(thing)}\n```\n")
    return "\n".join(parts)


def run_pages(program, out):
    """Runs all pages, as many at a time as there are processors."""
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as some:
        runs = {page: some.submit(pages.run, program, page, out) for page in pages.all_pages()}
        failed = [f"docs/manual/{page}.md: {runs[page].exception()}" for page in runs if runs[page].exception()]
    if failed:
        sys.exit("\n".join(failed))


def main(program, out, ran=None):
    program, out = pathlib.Path(program).resolve(), pathlib.Path(out)
    pages.needs.program("sphinx-build", "python3-sphinx")
    for page in pages.all_pages():  # without one, its pictures are missing
        pages.skip_where_tools_are_missing(page)
    if ran is None:
        ran = out / "ran"
        run_pages(program, ran)
    folder = out / "source"
    shutil.rmtree(folder, ignore_errors=True)
    source = Source(folder, pathlib.Path(ran))
    for path in source.places:
        source.add(path)
    refuse_unknown_commands(program)
    source.write("reference/commands.md", commands_page(program))
    source.write("reference/python-functions.md", functions_page())
    for file in (PROJECT / "docs/tutorials").glob("*.py"):
        source.write(f"reference/notebooks/{file.stem}.md", notebook_page(file))
    shutil.rmtree(out / "html", ignore_errors=True)
    return subprocess.run(["sphinx-build", "-q", "-W", "--keep-going", "-c", str(MANUAL), "-d", str(out / "doctrees"),
                           "-b", "html", str(folder), str(out / "html")]).returncode


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:4]))
