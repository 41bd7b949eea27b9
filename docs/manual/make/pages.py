"""Follows a page of the manual like its reader: writes its files and runs its commands, in order.

A block of `sh` is run. A block of `text` is the output of the commands before it, or a part of it: "..." stands for
anything between. Every other block is a file, named in its caption; a second block with the same name continues it. All
blocks are run; there is no way to leave one out.

Usage: pages.py PROGRAM PAGE OUT, where OUT is the folder in which each page gets a folder of its own.
"""
import dataclasses
import os
import pathlib
import re
import shutil
import subprocess
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[3] / "test"))
import needs  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
MANUAL = HERE.parent
#: The start of a page's command, the additional program that it needs, and that program's package.
TOOLS = [("octave", "octave", "octave"), ("matlab", "octave", "octave"),  # which stands in for it
         ("Rscript", "Rscript", "r-cran-hdf5r"), ("dihaptic gui", "Xvfb", "xvfb"),
         ("dihaptic gui", "xdotool", "xdotool")]
PROJECT = MANUAL.parent.parent
DIRECTIVES = {"note", "warning", "tip", "toctree"}  # blocks that are prose
FAKES = {"libfake_hd.so": ["libHD.so"], "libfake_dhd.so": ["libdhd.so.3", "libdrd.so.3"]}
MARK = "@@ line "


@dataclasses.dataclass
class Block:
    line: int
    kind: str  # sh, text, or the language of a file
    name: str  # of the file
    text: str


def blocks(page):
    """The blocks of a page, in order. Raises ValueError for one that could not be run."""
    found, lines = [], iter(enumerate(page.splitlines(), 1))
    for number, line in lines:
        if not re.match(r"\s*(```|~~~)", line):
            continue
        opening = re.fullmatch(r"```(?:([a-z]+)|\{([a-z-]+)\}(?: +(\S+))?.*)", line)
        if not opening:
            raise ValueError(f"line {number}: a block begins in the first column, with ``` and its language")
        language, directive, argument = opening.groups()
        inside = []
        for _, line in lines:
            if line == "```":
                break
            inside.append(line)
        if directive in DIRECTIVES:
            continue
        if directive not in (None, "code-block"):
            raise ValueError(f"line {number}: {directive} is no kind of block")
        name = ""
        if inside and (caption := re.fullmatch(r":caption: (\S+)", inside[0])):
            name = caption[1]
            inside = inside[2:]  # an empty line follows
        kind = language or argument
        if (kind in ("sh", "text")) == bool(name):
            raise ValueError(f"line {number}: a block is of sh or text, or has a caption that names its file")
        found.append(Block(number, kind, name, "\n".join(inside) + "\n"))
    return found


def script(page):
    """The page as a program for bash."""
    parts, begun = ["set -eo pipefail\nexec 2>&1"], set()
    for block in blocks(page):
        if block.kind == "sh":
            parts.append(f"echo; echo '{MARK}{block.line}'\n{block.text}")
        elif block.name:
            more = ">>" if block.name in begun else ">"
            begun.add(block.name)
            parts.append(f"mkdir -p '{os.path.dirname(block.name) or '.'}'\n"
                         f"cat {more} '{block.name}' <<'END OF THE FILE'\n{block.text}END OF THE FILE")
    return "\n".join(parts) + "\n"


def unlike(said, shown):
    """The first line of `shown` that is missing at its position in `said`, or None."""
    rest = iter(said.splitlines())
    for line in shown.splitlines():
        pattern = ".*".join(re.escape(part) for part in line.rstrip().split("..."))
        if line.strip() not in ("", "...") and not any(re.fullmatch(pattern, other.rstrip()) for other in rest):
            return line
    return None


def faults(page, output):
    """The promises of a page that its run did not fulfil."""
    found, said, commands = [], {}, ""
    for part in output.split("\n" + MARK)[1:]:
        number, _, text = part.partition("\n")
        said[int(number)] = text
    last = 0
    for block in reversed(blocks(page)):
        files = "".join(other.text for other in blocks(page) if other.name not in ("", block.name))
        if block.name and block.name.removesuffix(".m") not in commands + files:  # MATLAB leaves it out
            found.append(f"line {block.line}: no command below and no other file uses {block.name}")
        if block.kind == "sh":
            commands += block.text
    for block in blocks(page):
        if block.kind == "sh":
            last = block.line
        elif block.kind == "text" and (line := unlike(said.get(last, ""), block.text)) is not None:
            found.append(f"line {block.line}: the commands above do not print: {line}")
    return found


def prepare(folder, program):
    """An empty working folder like a new user's, and beside it stand-ins for the user and the devices."""
    shutil.rmtree(folder, ignore_errors=True)
    tools = folder.with_name(folder.name + ".tools")
    shutil.rmtree(tools, ignore_errors=True)
    folder.mkdir(parents=True)
    (tools / "bin").mkdir(parents=True)
    for name in ("dihaptic", "matlab"):
        (tools / "bin" / name).symlink_to(HERE / "hands.py")
    (tools / "bin" / "python3").symlink_to("/usr/bin/python3")
    (tools / "bin" / "sbatch").symlink_to(PROJECT / "test/cli/fake_sbatch.py")
    (tools / "home/dihaptic/build").mkdir(parents=True)
    (tools / "home/dihaptic/build/release").symlink_to(program.parent)
    (tools / "lib").mkdir()
    for fake, names in FAKES.items():
        for name in names:
            (tools / "lib" / name).symlink_to(program.parent / "src/devices" / fake)
    environment = {**os.environ, "DIHAPTIC_PROGRAM": str(program), "MPLBACKEND": "Agg",
                   "HOME": str(tools / "home"), "FAKE_SLURM": str(tools),
                   "PATH": f"{tools}/bin:{os.environ['PATH']}", "PYTHONPATH": str(program.parent / "python"),
                   "LD_LIBRARY_PATH": str(tools / "lib"), "LP_NUM_THREADS": "1"}
    return environment


def run(program, page, out):
    """Runs a page in its own folder in `out`; returns that folder. Raises ValueError for unfulfilled promises."""
    return run_text(pathlib.Path(program).resolve(), (MANUAL / f"{page}.md").read_text(), pathlib.Path(out).resolve() / page)


def run_text(program, text, folder):
    """Runs the text of a page in this folder, which it returns."""
    environment = prepare(folder, program)
    commands = folder.with_name(folder.name + ".sh")
    commands.write_text(script(text))
    done = subprocess.run(["bash", str(commands)], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, text=True)
    folder.with_name(folder.name + ".log").write_text(done.stdout)
    if done.returncode != 0:
        raise ValueError(f"a command ended with {done.returncode}: {folder}.log\n{done.stdout[-2000:]}")
    if wrong := faults(text, done.stdout):
        raise ValueError("\n".join(wrong) + f"\nwhat was printed is in {folder}.log")
    return folder


def all_pages():
    return sorted(str(path.relative_to(MANUAL).with_suffix("")) for path in MANUAL.rglob("*.md"))


def skip_where_tools_are_missing(page):
    """Ends a test of a page whose commands need a program that is not installed."""
    text = (MANUAL / (page + ".md")).read_text()
    for command, program, package in TOOLS:
        if re.search(rf"^{command} ", text, re.MULTILINE):
            needs.program(program, package)


if __name__ == "__main__":
    skip_where_tools_are_missing(sys.argv[2])
    try:
        run(*sys.argv[1:4])
    except ValueError as error:
        sys.exit(f"docs/manual/{sys.argv[2]}.md: {error}")
