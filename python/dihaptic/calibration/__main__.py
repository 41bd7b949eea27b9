"""`python3 -m dihaptic.calibration FILE...`: what `dihaptic calibrate-population` calls."""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

from ..errors import Error, error, interruptible, tell
from . import LIMITS, STRUCTURES, Calibration, calibrate_population, hierarchy, leave_one_out


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
        with interruptible():
            _check_place(asked.out)
            found = calibrate_population(asked.files, _show)
            for group in found.groups:
                print(f"{group.name}: {group.people} people, {group.rotation.shape[1]} trials")
            for what in [*found.left_out, *([found.warning] if found.warning else [])]:
                print(f"warning: {what}", file=sys.stderr)
            print(found.table.to_string(index=False, float_format=lambda value: f"{value:.4g}"))
            _save(found, asked.out)
            if asked.compare:
                _compare(found)
    except KeyboardInterrupt:
        print("interrupted: nothing more was written", file=sys.stderr)
        return 130
    except Error as why:
        tell(why)
        return 2
    return 0


def _check_place(out: str) -> None:
    """Before minutes of work: raises Error if the file cannot be written."""
    path = Path(out)
    if out.endswith("/") or path.is_dir():
        raise error("is a folder", "Name a file in it, e.g. --out population.yaml.", file=out, key="--out")
    if os.path.lexists(path):
        raise error("exists already", "Move it away, or name another file with --out.", file=out)
    if not path.parent.is_dir():
        raise error("is in a folder that does not exist", "Make the folder, or name another file with --out.", file=out)
    if not os.access(path.parent, os.W_OK):
        raise error("is in a folder that cannot be written", "Name another file with --out.", file=out)


def _save(found: Calibration, out: str) -> None:
    try:
        print(found.save(out))
    except Error as why:
        if why.problems[0].file:  # the place is at fault, not the rates
            print(f"what {out} would contain:\n{found.population()}")
        raise


def _compare(found: Calibration) -> None:
    """Prints how well other structures fit, and how well each group is predicted by a fit to the others."""
    for name, limits in STRUCTURES.items():
        fit = found.fit if limits == LIMITS else hierarchy.fit(found.groups, limits, _show)
        print(f"log likelihood, {name}: {fit.likelihood:.1f}", flush=True)
    if len(found.groups) < 3:
        print("No group was predicted by the others, because this needs three groups.")
        return
    table = leave_one_out(found.groups, progress=_show)
    print(table.to_string(index=False, float_format=lambda value: f"{value:.1f}"))
    for share in (50, 90):
        inside = ((table.real >= table[f"low_{share}"]) & (table.real <= table[f"high_{share}"])).mean()
        print(f"bands of {share} % of laboratories contain {inside:.0%} of these means")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
