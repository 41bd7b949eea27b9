"""The tables of every shipped experiment, done by one simulated person, are those that were kept, to the byte: the session's
own, those of its report, the list of its trials, the task as it was understood, and what session.nwb has. So are the tables of
a small population.

Usage: tables_test.py PROGRAM, from the project's folder. A few experiments that have all kinds of tables between them, or all,
in the soak. When a table is meant to differ, renew tables.txt in the same commit, and say why:

    DIHAPTIC_RENEW_TABLES=1 DIHAPTIC_SOAK=1 /usr/bin/python3 test/tables_test.py build/release/dihaptic
"""
import hashlib
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import h5py

import soak

PROGRAM = os.path.abspath(sys.argv.pop(1) if len(sys.argv) > 1 else "build/release/dihaptic")
KEPT = pathlib.Path("test/tables.txt")
RENEWS = "DIHAPTIC_RENEW_TABLES" in os.environ
# without trials; with phases and adaptation; lifts; procedures and thresholds; a sequence of loads
A_FEW = ["lift-block", "rotation-reversal", "first-trials", "friction-discrimination", "load-steps"]
EVERY = sorted(path.stem for path in pathlib.Path("experiments").glob("*.yaml"))
#: Files that contain times or the version of the program, besides results.
NOT_COMPARED = {"session.yaml", "rehearsal.yaml", "report.html", "raw.log"}


def dihaptic(*arguments, cwd=None):
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, cwd=cwd)
    if done.returncode:
        raise AssertionError(f"dihaptic {' '.join(map(str, arguments))}: {done.stderr}")


def data_sets(path):
    """The names, types and widths of all data sets of a file, a line each."""
    lines = []

    def visit(name, item):
        if isinstance(item, h5py.Dataset):
            lines.append(f"{name} {item.dtype} {item.shape[1:]}")

    with h5py.File(path) as nwb:
        nwb.visititems(visit)
    return "\n".join(sorted(lines)).encode()


def hashes_of(folder, named):
    """Of each file below `folder` that was computed, by NAMED/FILE."""
    out = {}
    for path in sorted(folder.rglob("*")):
        if path.is_dir() or path.name in NOT_COMPARED:
            continue
        content = data_sets(path) if path.suffix == ".nwb" else path.read_bytes()
        out[f"{named}/{path.relative_to(folder)}"] = hashlib.sha256(content).hexdigest()[:16]
    return out


def tables_of(experiment):
    with tempfile.TemporaryDirectory() as folder:
        file = f"experiments/{experiment}.yaml"
        has_trials = "\ntask:" in pathlib.Path(file).read_text()
        person = ["--simulate", "--participant", "sim-001"] if has_trials else []
        dihaptic("run", file, *person, "--out", folder)
        (session,) = pathlib.Path(folder).iterdir()
        dihaptic("report", session, "--tables")
        return hashes_of(session, experiment)


def tables_of_population():
    """Of three people who adapt, and forget, in fewer trials than are shipped."""
    with tempfile.TemporaryDirectory() as folder:
        text = pathlib.Path("experiments/rotation-reversal.yaml").read_text().replace("../", os.getcwd() + "/")
        for repeats in ["64", "160", "16", "48"]:
            text = text.replace(f"repeats: {repeats}", "repeats: 3")
        pathlib.Path(folder, "short.yaml").write_text(text)
        dihaptic("rehearse", "short.yaml", "--people", "3", "--out", "people", cwd=folder)
        dihaptic("collect", "people", cwd=folder)
        dihaptic("report", "people", "--tables", cwd=folder)
        return hashes_of(pathlib.Path(folder, "people"), "population")


@unittest.skipUnless(" fma " in pathlib.Path("/proc/cpuinfo").read_text(),
                     "without FMA the C library's sines differ in their last bit")
class Tables(unittest.TestCase):
    def test_are_those_that_were_kept(self):
        kept = dict(line.split() for line in KEPT.read_text().splitlines()) if KEPT.exists() else {}
        now = {}
        experiments = soak.of(A_FEW, EVERY)
        for experiment in experiments:
            print(experiment, flush=True)
            now.update(tables_of(experiment))
        now.update(tables_of_population())
        if RENEWS:
            KEPT.write_text("".join(f"{name} {now[name]}\n" for name in sorted(now)))
            return
        asked = {name: text for name, text in kept.items() if name.split("/")[0] in [*experiments, "population"]}
        differ = sorted(name for name in asked.keys() | now.keys() if asked.get(name) != now.get(name))
        self.assertEqual(differ, [], "These are not as they were kept, or not kept: test/tables_test.py says how to renew them.")


if __name__ == "__main__":
    unittest.main()
