"""What commands write and delete, with links, pipes and folders at every name that they use.

Each arrangement is a fresh folder as a stranger may hand it over: it has what a command works on, and a trap at one
of the names that the command would write to or delete. What the trap leads to must stay as it is, and the command
must end, and say so if it could not do what it was asked.

Usage: attack/links_test.py PROGRAM, from the project's folder. The soak tries all arrangements, not a
sample.
"""
import datetime
import itertools
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.append("test/cli")
from program import PROGRAM, dihaptic, patient
import soak  # program.py adds its folder to the path

PROGRAM = os.path.abspath(PROGRAM)
SAMPLE = 4
TRAPS = ["link to a file", "link to a folder", "link to nothing", "link to itself", "second name of a file", "pipe",
         "folder", "link to a device"]


def write_experiment(file):
    """Sessions of a tenth of a second of processor time."""
    text = pathlib.Path("experiments/rotation-reversal.yaml").read_text().replace("../", os.getcwd() + "/")
    pathlib.Path(file).write_text(re.sub(r"repeats: (64|160|16|48)\b", "repeats: 1", text))


def everything(folder):
    """What is in a folder: each name, with what it is, its size, its time and its bytes."""
    out = {}
    for path in sorted(pathlib.Path(folder).rglob("*")):
        about = path.lstat()
        out[str(path)] = (about.st_mode, about.st_size, about.st_mtime_ns, path.is_file() and path.read_bytes())
    return out


def set_trap(kind, name, foreign):
    """Puts a trap at a name, in place of what is there."""
    if name.is_symlink() or name.is_file():
        name.unlink()
    elif name.is_dir():
        shutil.rmtree(name)
    name.parent.mkdir(parents=True, exist_ok=True)
    if kind == "link to a file":
        name.symlink_to(foreign / "file")
    elif kind == "link to a folder":
        name.symlink_to(foreign / "folder")
    elif kind == "link to nothing":
        name.symlink_to(foreign / "new")
    elif kind == "link to itself":
        name.symlink_to(name)
    elif kind == "second name of a file":
        os.link(foreign / "file", name)
    elif kind == "pipe":
        os.mkfifo(name)
    elif kind == "link to a device":
        name.symlink_to("/dev/full")
    else:
        name.mkdir()
        (name / "theirs").write_text("theirs")


class Made:
    """What the commands work on, made once."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.experiment = self.folder / "short.yaml"
        write_experiment(self.experiment)
        self.do("run", self.experiment, "--simulate", "--participant", "S01", "--out", self.folder / "out")
        (self.session,) = (self.folder / "out").iterdir()
        self.do("rehearse", self.experiment, "--people", "2", "--out", self.folder / "two")
        self.unfinished = shutil.copytree(self.session, self.folder / "unfinished")
        self.cut()

    def cut(self):
        """Makes a session whose second half is lost, as after a kill."""
        for name in ("session.nwb", "trials.csv", "phases.csv", "episodes.csv", "lifts.csv", "events.csv"):
            (self.unfinished / name).unlink(missing_ok=True)
        os.truncate(self.unfinished / "raw.log", (self.unfinished / "raw.log").stat().st_size // 2)
        info = (self.unfinished / "session.yaml").read_text()
        (self.unfinished / "session.yaml").write_text(info.replace("state: complete", "state: running"))

    def do(self, *arguments):
        result = dihaptic(*map(str, arguments))
        assert result.returncode == 0, result.stderr


def names_in(folder):
    return [str(path.relative_to(folder)) for path in pathlib.Path(folder).rglob("*")]


def commands(made):
    """Of each command: its name, what prepares its folder, its arguments in there, and names that it uses for a while."""
    session = lambda place: shutil.copytree(made.session, place / "session")
    killed = lambda place: shutil.copytree(made.unfinished, place / "session")
    interrupted = lambda place: (session(place), (place / "session/session.yaml").unlink())

    def missing(place):
        shutil.copytree(made.folder / "two", place / "r")
        shutil.rmtree(place / "r/sim-002")

    def left(place):
        missing(place)
        (place / "r/unfinished-sim-002").mkdir()
        (place / "r/unfinished-sim-002/messages.txt").write_text("")

    again = ["rehearse", made.experiment, "--people", "2", "--out", "r"]
    unfinished = ["r/unfinished-sim-002", "r/unfinished-sim-002/messages.txt"]
    soon = [f"s/{datetime.datetime.now() + datetime.timedelta(seconds=s):%Y-%m-%d_%H%M%S}_short_S01" for s in range(3)]
    return [
        ("rehearse", missing, again, unfinished),
        ("rehearse again", left, again, unfinished),
        ("collect", missing, ["collect", "r"], []),
        ("run", lambda place: None, ["run", made.experiment, "--simulate", "--participant", "S01", "--out", "s"], soon),
        ("recover", interrupted, ["recover", "session"], []),
        ("report", session, ["report", "session"], []),
        ("report of a rehearsal", missing, ["report", "r"], []),
        ("export", session, ["export", "session", "--bids", "data"], []),
        ("resume", session, ["resume", "session"], []),
        ("resume the rest", killed, ["resume", "session"], ["session/resumed-as"]),
        ("replay", session, ["replay", "session"], []),
        ("picture", session, ["picture", "session", "-o", "p.png"], []),
        ("workspace", lambda place: None, ["workspace", os.path.abspath("rigs/premium-arms.yaml"), "-o", "w.svg"], []),
        ("new study", lambda place: None, ["new", "study", "mine"], []),
    ]


class Links(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.made = Made(folder.name)

    def arrangements(self):
        """Each command with a trap at each name that it makes, changes or deletes."""
        out = []
        for name, prepare, arguments, more in commands(self.made):
            with tempfile.TemporaryDirectory() as folder:
                place = pathlib.Path(folder)
                prepare(place)
                before = everything(place)
                self.do(arguments, place)
                after = everything(place)
                used = [path for path in {*before, *after} if before.get(path) != after.get(path)]
                names = sorted({str(pathlib.Path(path).relative_to(place)) for path in used} | set(more))
            # a path that the user gives may be the user's own link; a session's folder has another name each time
            names = [trap for trap in names if trap not in arguments or "." in trap]
            names = [trap for trap in names if not re.match(r"(s|\.)/\d{4}-|\d{4}-", trap) or trap in more]
            # only one of a report's figures, since all are written in the same way
            names = [trap for trap in names if "/figures/" not in trap or "/outcomes." in trap]
            out += [(name, kind, trap) for trap, kind in itertools.product(names, TRAPS)]
        return out

    def do(self, arguments, place):
        return subprocess.run([PROGRAM, *map(str, arguments)], cwd=place, capture_output=True, text=True,
                              timeout=patient(60), stdin=subprocess.DEVNULL)

    def test_nothing_outside_changes(self):
        arrangements = self.arrangements()
        self.assertGreater(len(arrangements), 400)
        chosen = soak.of(random.Random(1).sample(arrangements, SAMPLE), arrangements)
        silent = 0
        for name, kind, trap in chosen:
            with self.subTest(command=name, trap=trap, kind=kind):
                silent += self.spring(name, kind, trap)
        print(f"{len(chosen)} of {len(arrangements)} arrangements; in {silent} the command did what it was asked")

    def spring(self, name, kind, trap):
        with tempfile.TemporaryDirectory() as folder:
            place, foreign = pathlib.Path(folder, "place"), pathlib.Path(folder, "foreign")
            (foreign / "folder/inner").mkdir(parents=True)
            for file in ("file", "folder/a", "folder/inner/b", "folder/messages.txt"):
                (foreign / file).write_text("theirs")
            place.mkdir()
            _, prepare, arguments, _ = next(row for row in commands(self.made) if row[0] == name)
            prepare(place)
            set_trap(kind, place / trap, foreign)
            before = everything(foreign)
            began = time.monotonic()
            result = self.do(arguments, place)
            self.assertEqual(everything(foreign), before, result.stderr)
            self.assertNotIn("Please report", result.stderr)
            self.assertGreaterEqual(result.returncode, 0, result.stderr)
            if kind == "folder" and (place / trap).is_dir():
                self.assertTrue((place / trap / "theirs").exists() or result.returncode != 0, result.stderr)
            if result.returncode != 0:
                self.assertTrue(result.stderr.strip() + result.stdout.strip(), f"nothing was said in {time.monotonic() - began:.1f} s")
            return result.returncode == 0


class Kept(unittest.TestCase):
    """What is in an output folder and is not the program's own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        write_experiment(self.folder / "short.yaml")

    def rehearse(self, people=1):
        return dihaptic("rehearse", str(self.folder / "short.yaml"), "--people", str(people), "--out", str(self.folder / "r"))

    def test_folders_that_only_look_like_sessions_are_kept_and_named(self):
        for name in ("my-thesis_sim-001", "2026-01-01_101010_short_sim-001", "notes"):
            with self.subTest(name):
                mine = self.folder / "r/unfinished-sim-001" / name
                mine.mkdir(parents=True)
                (mine / "thesis.txt").write_text("precious")
                result = self.rehearse()
                self.assertEqual(result.returncode, 1, result.stderr)
                self.assertIn(name, result.stderr)
                self.assertEqual((mine / "thesis.txt").read_text(), "precious")
                shutil.rmtree(self.folder / "r")

    def test_what_has_a_person_s_name_and_is_no_session_is_named(self):
        for make in (lambda path: os.mkfifo(path), lambda path: path.mkdir(), lambda path: path.write_text("")):
            (self.folder / "r").mkdir()
            make(self.folder / "r/sim-001")
            result = self.rehearse()
            self.assertNotEqual(result.returncode, 0)
            self.assertIn("r/sim-001: error: is in the way", result.stderr)
            shutil.rmtree(self.folder / "r")

    def test_a_person_that_is_a_link_is_no_session(self):
        self.assertEqual(self.rehearse().returncode, 0)
        person = self.folder / "r/sim-001/person.yaml"
        person.rename(self.folder / "theirs.yaml")
        person.symlink_to(self.folder / "theirs.yaml")
        result = self.rehearse()
        self.assertEqual(result.returncode, 2, result.stdout)
        self.assertIn("r/sim-001: error: is in the way", result.stderr)

    def test_recover_keeps_what_it_makes_anew(self):
        result = dihaptic("run", str(self.folder / "short.yaml"), "--simulate", "--participant", "S7", "--out", str(self.folder / "s"))
        self.assertEqual(result.returncode, 0, result.stderr)
        (session,) = (self.folder / "s").iterdir()
        info = (session / "session.yaml").read_text()
        (session / "session.yaml.before").write_text("precious")
        damaged = info.replace("\n", "\n\ttab: 1\n", 1)
        (session / "session.yaml").write_text(damaged)
        result = dihaptic("recover", str(session))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual((session / "session.yaml.before").read_text(), "precious")
        self.assertEqual((session / "session.yaml.before-2").read_text(), damaged)
        self.assertEqual(result.stderr.count("session.yaml: warning: "), 1, result.stderr)
        self.assertIn("session.yaml.before-2 is the old file", result.stderr)
        self.assertIn("id: sim-S7", (session / "session.yaml").read_text())

    def test_no_output_replaces_what_it_shows(self):
        scene = shutil.copy("scenes/block-on-table.yaml", self.folder)
        text = pathlib.Path(scene).read_text()
        result = dihaptic("picture", scene, "-o", scene)
        self.assertEqual(result.returncode, 2)
        self.assertEqual(pathlib.Path(scene).read_text(), text)


if __name__ == "__main__":
    unittest.main()
