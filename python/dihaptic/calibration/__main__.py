"""`python3 -m dihaptic.calibration FILE...`: what `dihaptic calibrate-population` calls."""

from __future__ import annotations

import argparse
import sys

from ..errors import Error
from . import STRUCTURES, calibrate_population, hierarchy, leave_one_out


def _show(share: float) -> None:
    if sys.stderr.isatty():
        print(f"\rcalibrating {share:5.0%} ", end="\n" if share == 1 else "", file=sys.stderr, flush=True)


def main(words: list[str]) -> int:
    """Fits, prints and writes. Returns the exit code: 0, 2 for a wrong input, 130 if it was interrupted."""
    parser = argparse.ArgumentParser(prog="python3 -m dihaptic.calibration", allow_abbrev=False)
    parser.add_argument("files", nargs="+")
    parser.add_argument("--out", required=True)
    parser.add_argument("--compare", action="store_true")
    asked = parser.parse_args(words)
    try:
        found = calibrate_population(asked.files, _show)
        for group in found.groups:
            print(f"{group.name}: {group.people} people, {group.rotation.shape[1]} trials")
        print(found.table.to_string(index=False, float_format=lambda value: f"{value:.4g}"))
        print(found.save(asked.out))
        if asked.compare:
            _compare(found.groups)
    except KeyboardInterrupt:
        print("interrupted: nothing more was written", file=sys.stderr)
        return 130
    except Error as why:
        print("\n".join(problem.text() for problem in why.problems), file=sys.stderr)
        return 2
    return 0


def _compare(groups: list) -> None:  # type: ignore[type-arg]
    """Prints how well other structures fit, and how well each group is predicted by a fit to the others."""
    for name, limits in STRUCTURES.items():
        print(f"log likelihood, {name}: {hierarchy.fit(groups, limits, _show).likelihood:.1f}", flush=True)
    if len(groups) < 3:
        print("each group was not predicted by the others, because this needs three groups")
        return
    table = leave_one_out(groups)
    print(table.to_string(index=False, float_format=lambda value: f"{value:.1f}"))
    for share in (50, 90):
        inside = ((table.real >= table[f"low_{share}"]) & (table.real <= table[f"high_{share}"])).mean()
        print(f"bands of {share} % of laboratories contain {inside:.0%} of these means")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
