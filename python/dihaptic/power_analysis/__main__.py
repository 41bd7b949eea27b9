"""`python3 -m dihaptic.power_analysis FILE|FOLDER --effect ...`: what `dihaptic power` calls."""

from __future__ import annotations

import argparse
import hashlib
import os
import re
import sys
from pathlib import Path

from ..errors import Error, interruptible, shorten_warnings, tell
from . import power


def main(words: list[str]) -> int:
    """Computes the power and writes its page. Returns the exit code: 0, 2 for a wrong input, 130 if it was interrupted."""
    parser = argparse.ArgumentParser(prog="python3 -m dihaptic.power_analysis", allow_abbrev=False)
    parser.add_argument("path")
    parser.add_argument("--effect", required=True)
    parser.add_argument("--n", type=int, nargs="+", default=[8, 12, 16, 24])
    for name, default in (("people", 200), ("draws", 500), ("seed", 1), ("jobs", os.cpu_count() or 1)):
        parser.add_argument(f"--{name}", type=int, default=default)
    parser.add_argument("--laboratories", type=int, default=0)
    parser.add_argument("--sequential", action="store_true")
    for name, share in (("alpha", 0.05), ("ratio", 1.0), ("attrition", 0.0), ("bayes-factor", 10.0)):
        parser.add_argument(f"--{name}", type=float, default=share)
    parser.add_argument("--smallest-effect", type=float)
    parser.add_argument("--alternative", default="two-sided")
    for name in ("test", "population", "out"):
        parser.add_argument(f"--{name}", default="")
    asked = parser.parse_args(words)
    from .page import warnings_of  # needs matplotlib

    shorten_warnings()

    path = Path(asked.path).absolute()
    name = path.parent.name if path.name == "pool" else f"{path.stem}_{asked.seed}"
    out = Path(asked.out or f"power/{name}")
    try:
        with interruptible():
            result = power(
                asked.path, asked.effect, asked.n, people=asked.people, draws=asked.draws, test=asked.test, alpha=asked.alpha,
                ratio=asked.ratio, attrition=asked.attrition, smallest_effect=asked.smallest_effect, population=asked.population,
                laboratories=asked.laboratories, seed=asked.seed, jobs=asked.jobs, out=out, bayes_factor=asked.bayes_factor,
                sequential=asked.sequential, alternative=asked.alternative,
            )  # fmt: skip
            of = "" if asked.smallest_effect is None else f" of {asked.smallest_effect:g}".replace("-", "minus ")
            of += f" by {asked.test}" * bool(asked.test) + " sequential" * asked.sequential
            of += f" {asked.alternative}" * (asked.alternative != "two-sided")
            page = result.save(out / _in_a_name(asked.effect + of))
    except KeyboardInterrupt:
        print("interrupted: the people who have finished are kept, and the same command continues", file=sys.stderr)
        return 130
    except Error as why:
        tell(why)
        return 2
    except OSError as why:
        print(f"{out}: error: cannot be written: {why.strerror}. Name another folder with --out.", file=sys.stderr)
        return 2
    columns = ["n", "power", "low", "high", "for_none", "wrong_sign", "exaggeration", "half_width", "laboratory_50", "laboratory_10"]
    tables = [result.table[[name for name in columns if name in result.table]]]
    for table in tables if result.looks is None else [result.looks, *tables]:
        print(table.to_string(index=False, float_format=lambda value: f"{value:.3g}", na_rep="-"))
    print(result.in_words())
    for text in warnings_of(result):
        print(f"warning: {text}", file=sys.stderr)
    print(page)
    return 0


#: Effects that differ where their names would not: with signs, brackets or letters beyond these, or longer.
_PLAIN = re.compile(r'[\w.]+(\([\w=, ."]*\))?( [-+*/] [\w.]+(\([\w=, ."]*\))?)*[\w .]*')
_LONGEST = 120


def _in_a_name(effect: str) -> str:
    """The name of the folder for an effect, which keeps another effect from replacing its page.

    >>> from dihaptic.power_analysis.__main__ import _in_a_name
    >>> _in_a_name("mean(late) - mean(early)")
    'mean-late-minus-mean-early'
    >>> _in_a_name("-mean(late)")
    'mean-late-ec76'
    """
    name = effect
    for sign, word in ((" - ", " minus "), (" + ", " plus "), (" * ", " times "), (" / ", " over ")):
        name = name.replace(sign, word)
    name = re.sub(r"\W+", "-", name).strip("-")
    if _PLAIN.fullmatch(effect) and len(name) <= _LONGEST:
        return name
    return f"{name[:_LONGEST]}-{hashlib.sha256(effect.encode()).hexdigest()[:4]}"


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
