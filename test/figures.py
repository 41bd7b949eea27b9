"""The figures that docs/figures.md states, their one home and how they are checked.

docs/figures.json has a row for each: what it is, the figure as the page prints it, the command that prints it, and checks:
which values of the command's JSON it stands for, and between which bounds they lie. A value is a path, with [] for every item
of a list and [key=value] for those that have it; "over" divides by another. "pattern" is sought in the command's text instead.
"quiet" rows are times: they want a machine that does nothing else. "peers" rows want the program of ./dev bench --peers.
"arguments" are what is run, where it is not the command with --json; {tmp} in them is a folder that is deleted afterwards.
A command that begins with dihaptic-bench is run by that program, which lies beside PROGRAM.

    figures.py PROGRAM             runs all but the quiet rows and compares
    figures.py PROGRAM --quiet     runs the quiet rows as well
    figures.py PROGRAM --peers     runs those of other simulators as well
    figures.py PROGRAM --only grasp    those whose command has this word
    figures.py --table             prints the page's table
    figures.py --words             prints README's sentences, "in_words" of some rows

It returns 1 when a figure differs, and names it; 2 when a command failed.
"""

import argparse
import json
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
HEAD = ["| what | figure | command |", "|---|---|---|"]


def load(path=ROOT / "docs" / "figures.json"):
    rows = json.loads(path.read_text())
    for row in rows:
        for check in row["checks"]:
            if not check["least"] <= check["most"]:
                raise ValueError(f"{row['what']}: least is above most")
    return rows


def table(rows):
    return HEAD + [f"| {row['what']} | {row['figure']} | `{row['command']}` |" for row in rows]


def sentences(rows):
    return [row["in_words"] for row in rows if "in_words" in row]


def stated_table(text):
    """The lines of the table of figures in a page."""
    lines = text.splitlines()
    begin = lines.index(HEAD[0])
    end = begin
    while end < len(lines) and lines[end].startswith("|"):
        end += 1
    return lines[begin:end]


def values(data, path):
    """All numbers that a path leads to."""
    found = [data]
    for part in re.findall(r"[^.\[\]]+|\[[^\]]*\]", path):
        if part == "[]":
            found = [item for of in found for item in of]
        elif part.startswith("["):
            key, value = part[1:-1].split("=")
            found = [item for of in found for item in of if str(item.get(key)) == value]
        else:
            found = [of[part] for of in found]
    return [float("nan") if value is None else float(value) for value in found]


def over(a, b):
    """None over none is none, and some over none is beyond any bound."""
    if b == 0:
        return 0.0 if a == 0 else float("inf")
    return a / b


def measured(check, output):
    if "pattern" in check:
        return [float(number) for number in re.findall(check["pattern"], output)]
    data = json.loads(output)
    of = values(data, check["value"])
    if "over" in check:
        of = [over(a, b) for a, b in zip(of, values(data, check["over"]), strict=True)]
    return of


def differences(row, output):
    """What a row's checks say of a command's output; nothing when the figure is as stated."""
    out = []
    for check in row["checks"]:
        name = check.get("value") or check["pattern"]
        if "over" in check:
            name += " / " + check["over"]
        found = measured(check, output)
        if not found:
            out.append(f"{name}: nothing found")
        wrong = [value for value in found if not check["least"] <= value <= check["most"]]
        if wrong:
            out.append(f"{name}: {min(wrong):g} to {max(wrong):g} where {check['least']:g} to {check['most']:g} is stated")
    return out


def run(program, row):
    with tempfile.TemporaryDirectory() as folder:
        arguments = row.get("arguments", row["command"] + " --json").replace("{tmp}", folder)
        words = shlex.split(arguments)
        of = [program + "-bench", *words[1:]] if words[0] == "dihaptic-bench" else [program, *words]
        result = subprocess.run(of, cwd=ROOT, capture_output=True, text=True)
    if result.returncode != 0:
        raise RuntimeError(f"{arguments}: returned {result.returncode}\n{result.stderr}")
    return result.stdout + result.stderr if any("pattern" in c for c in row["checks"]) else result.stdout


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", nargs="?")
    parser.add_argument("--quiet", action="store_true")
    parser.add_argument("--peers", action="store_true")
    parser.add_argument("--only", default="")
    parser.add_argument("--table", action="store_true")
    parser.add_argument("--words", action="store_true")
    options = parser.parse_args()
    rows = load()
    if options.table or options.words:
        print("\n".join(table(rows) if options.table else sentences(rows)))
        return 0
    if not options.program:
        parser.error("which program?")
    outputs = {}
    differing = []
    left_out = 0
    for row in rows:
        if (row.get("quiet") and not options.quiet) or (row.get("peers") and not options.peers) or options.only not in row["command"]:
            left_out += 1
            continue
        key = row.get("arguments", row["command"] + " --json")
        if key not in outputs:
            print(f"running {row['command']}", file=sys.stderr)
            try:
                outputs[key] = run(options.program, row)
            except RuntimeError as error:
                print(error, file=sys.stderr)
                return 2
        wrong = differences(row, outputs[key])
        print(f"{'differs' if wrong else 'as stated':10s} {row['what']}: {row['figure']}")
        for text in wrong:
            print(f"           {text}")
        if wrong:
            differing.append(row["what"])
    run_of_them = len(rows) - left_out
    print(f"{len(differing)} of {run_of_them} figures differ" if differing else f"all of {run_of_them} figures are as stated")
    if left_out:
        print(f"{left_out} were not run (--quiet, --peers, --only)")
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main())
