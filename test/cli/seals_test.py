"""Tables that were cut, exchanged or taken from elsewhere: collect refuses them, report tells.

Usage: seals_test.py PROGRAM, from the project's folder.
"""
import csv
import glob
import os
import pathlib
import random
import re
import shlex
import shutil
import tempfile
import unittest

from program import dihaptic
import soak  # program.py adds its folder to the path

MISCHIEFS = soak.of(16, 200)
PEOPLE = ["sim-001", "sim-002", "sim-003"]
#: Files of a session that report reads.
READ = ["trials.csv"]


def rewritten(path, change):
    """Replaces a text by what a function makes of it, which must differ."""
    path = pathlib.Path(path)
    before = path.read_text()
    after = change(before)
    assert after != before, f"{path} is the same"
    path.write_text(after, newline="")


def with_rows(change):
    """Changes the rows of a table in place; the header stays."""
    def changed(text):
        lines = text.splitlines(keepends=True)
        rows = lines[1:]
        change(rows)
        return lines[0] + "".join(rows)
    return changed


def table_of(folder, draw):
    tables = re.findall(r"file: (\S+\.csv)\n +rows: [1-9]", (folder / "session.yaml").read_text())
    return folder / draw.choice(sorted(tables))


def cut(folder, other, draw):
    table = table_of(folder, draw)
    text = table.read_bytes()
    table.write_bytes(text[:draw.randrange(len(text))])
    return table.name


def edit_a_cell(folder, other, draw):
    table = table_of(folder, draw)
    text = table.read_text()
    digits = [at for at, letter in enumerate(text) if letter.isdigit()]
    at = draw.choice(digits)
    table.write_text(text[:at] + str((int(text[at]) + draw.randrange(1, 10)) % 10) + text[at + 1:])
    return table.name


def remove_a_row(folder, other, draw):
    table = table_of(folder, draw)
    rewritten(table, with_rows(lambda rows: rows.pop(draw.randrange(len(rows)))))
    return table.name


def double_a_row(folder, other, draw):
    table = table_of(folder, draw)
    rewritten(table, with_rows(lambda rows: rows.append(draw.choice(rows))))
    return table.name


def save_as_a_spreadsheet_does(folder, other, draw):
    table = table_of(folder, draw)
    rewritten(table, lambda text: text.replace(*draw.choice([(",", ";"), ("\n", "\r\n"), (".", ",")])))
    return table.name


def remove_a_table(folder, other, draw):
    table = table_of(folder, draw)
    table.unlink()
    return table.name


def take_anothers_table(folder, other, draw):
    for name in draw.sample(["trials.csv", "phases.csv", "events.csv", "trial-list.csv"], 4):
        if (folder / name).read_bytes() != (other / name).read_bytes():
            shutil.copy(other / name, folder / name)
            return name
    raise AssertionError("both people did the same")


def add_a_table(folder, other, draw):
    for name in ("fault.csv", "heard.csv", "trials-before.csv"):
        if not (folder / name).exists():
            shutil.copy(folder / "trials.csv", folder / name)
            return name
    raise AssertionError("has all tables")


def edit_session(folder, other, draw):
    what, by = draw.choice([(r"seed: .*", "seed: 77"), (r"state: complete", "state: interrupted"),
                            (r"ticks: .*", "ticks: 12"), (r"id: sim-.*", "id: sim-042"),
                            (r"program: .*", "program: dihaptic 0.0.1"), (r"identity: .*", "identity: abc"),
                            (r"rows: .*", "rows: 9999"), (r"checksum: .*", "checksum: 12345678"),
                            (r"seal: .*", "seal: 12345678")])
    rewritten(folder / "session.yaml", lambda text: re.sub(what, by, text, count=1))
    return "session.yaml"


def remove_session(folder, other, draw):
    (folder / "session.yaml").unlink()
    return folder.name


def empty_the_person(folder, other, draw):
    (folder / "person.yaml").write_text(draw.choice(["", "{}\n"]))
    return "person.yaml"


def take_anothers_person(folder, other, draw):
    shutil.copy(other / "person.yaml", folder / "person.yaml")
    return "person.yaml"


def change_an_input(folder, other, draw):
    name = draw.choice(["task.yaml", "scene.yaml", "settings.yaml", "rig.yaml"])
    rewritten(folder / name, lambda text: re.sub(r"\d", lambda digit: str((int(digit[0]) + 1) % 10), text, count=1))
    return name


def copy_under_another_name(folder, other, draw):
    name = f"sim-{draw.randrange(4, 999):03}"
    shutil.copytree(folder, folder.parent / name)
    return name


def exchange_folders(folder, other, draw):
    aside = folder.parent / "aside"
    folder.rename(aside)
    other.rename(folder)
    aside.rename(other)
    return folder.name


class Seals(unittest.TestCase):
    """What has no raw.log is known by its seals."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        text = pathlib.Path("experiments/rotation-reversal.yaml").read_text().replace("../", os.getcwd() + "/")
        for repeats in ["64", "160", "16", "48"]:
            text = text.replace("repeats: " + repeats, "repeats: 1")
        cls.experiment = cls.folder / "short.yaml"
        cls.experiment.write_text(text)
        cls.made = cls.folder / "made"
        cls.rehearse(cls.made, "--people", "3")
        cls.other = cls.folder / "other"
        cls.rehearse(cls.other, "--people", "3", "--seed", "9")
        edited = cls.folder / "edited.yaml"
        edited.write_text(text.replace("angle_deg: 30", "angle_deg: 60"))
        cls.foreign = cls.folder / "foreign"
        result = dihaptic("rehearse", str(edited), "--people", "3", "--out", str(cls.foreign))
        assert result.returncode == 0, result.stderr

    @classmethod
    def rehearse(cls, out, *arguments):
        result = dihaptic("rehearse", str(cls.experiment), "--out", str(out), "--jobs", "2", *arguments)
        assert result.returncode == 0, result.stderr

    def copy(self):
        """Path of a copy of the rehearsal, and of a folder for the tables collected from it."""
        place = tempfile.TemporaryDirectory(dir=self.folder)
        self.addCleanup(place.cleanup)
        study = pathlib.Path(place.name, "study")
        shutil.copytree(self.made, study)
        return study, pathlib.Path(place.name, "out")

    def collect(self, study, out):
        return dihaptic("collect", str(study), "--out", str(out))

    def expect_refused(self, study, out, *words):
        result = self.collect(study, out)
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)
        self.assertFalse(out.exists(), "tables were written")
        return result.stderr

    def test_what_is_as_it_was_made_is_collected(self):
        study, out = self.copy()
        result = self.collect(study, out)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("seal", result.stdout)
        self.assertEqual(result.stderr.count("warning"), 0, result.stderr)

    def test_each_mischief_is_told(self):
        mischiefs = [cut, edit_a_cell, remove_a_row, double_a_row, save_as_a_spreadsheet_does, remove_a_table,
                     take_anothers_table, add_a_table, edit_session, remove_session, empty_the_person,
                     take_anothers_person, change_an_input, copy_under_another_name, exchange_folders]
        for number in range(MISCHIEFS):
            mischief = mischiefs[number % len(mischiefs)]
            with self.subTest(mischief=mischief.__name__, number=number):
                draw = random.Random(number)
                study, out = self.copy()
                one, two = draw.sample(PEOPLE, 2)
                name = mischief(study / one, study / two, draw)
                said = self.expect_refused(study, out, name)
                self.assertRegex(said, r"error: .*\. [A-Z]")  # the message gives the fault and the remedy
                if name in READ and mischief is not exchange_folders:
                    self.expect_report_tells(study / one, name)

    def expect_report_tells(self, session, name):
        result = dihaptic("report", str(session))
        said = result.stderr
        self.assertRegex(said, name + r": (warning|error): .*the session ended")
        if result.returncode == 0:
            self.assertIn("Changed since the session ended", (session / "report.html").read_text())

    def test_sessions_of_other_rehearsals_are_told(self):
        for source, words in [(self.other, ["seed: is 9; in the rehearsal it is 1"]),
                              (self.foreign, ["task.yaml: error: differs from this rehearsal's"])]:
            study, out = self.copy()
            shutil.rmtree(study / "sim-002")
            shutil.copytree(source / "sim-002", study / "sim-002")
            self.expect_refused(study, out, "sim-002", *words)

    def test_all_folders_are_named_at_once(self):
        study, out = self.copy()
        for one in PEOPLE:
            (study / one / "trials.csv").unlink()
        said = self.expect_refused(study, out, *PEOPLE)
        self.assertRegex(said, r"sim-003/trials.csv: error: is gone: it had \d+ rows when the session ended\. Restore it")

    def test_sessions_without_seals_are_collected_and_told_of(self):
        study, out = self.copy()
        def unseal(one):
            rewritten(study / one / "session.yaml", lambda text: re.sub(r"(?s)\ntables:.*?(?=\n\.\.\.)", "", text))
        unseal("sim-001")
        self.expect_refused(study, out, "sim-001/session.yaml: error: seal: is missing")
        for one in PEOPLE[1:]:
            unseal(one)
        result = self.collect(study, out)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stdout.count("these sessions have no seal"), 1, result.stdout)
        shutil.rmtree(out)
        # changes that are noticed without seals
        rewritten(study / "sim-002/trials.csv", lambda text: text[:-30])
        self.expect_refused(study, out, "sim-002/trials.csv:", "cell")
        shutil.copy(self.made / "sim-002/trials.csv", study / "sim-002/trials.csv")
        rewritten(study / "sim-002/trials.csv", with_rows(lambda rows: rows.pop()))
        self.expect_refused(study, out, "sim-002/trials.csv: error: has unfinished trials")

    def test_recover_seals_a_recording_anew(self):
        out = self.folder / "recorded"
        self.rehearse(out, "--people", "1", "--keep-recordings")
        session = out / "sim-001"
        before = (session / "trials.csv").read_bytes()
        rewritten(session / "trials.csv", with_rows(lambda rows: rows.pop()))
        self.expect_refused(out, self.folder / "none", f"Rebuild it from raw.log: dihaptic recover {session}")
        replay = dihaptic("replay", str(session))
        self.assertEqual((replay.returncode, replay.stderr.count("warning")), (0, 0), replay.stderr)
        export = dihaptic("export", str(session), "--bids", str(self.folder / "bids"))
        self.assertIn("trials.csv: warning: has ", export.stderr)
        self.assertEqual(dihaptic("recover", str(session)).returncode, 0)
        self.assertEqual((session / "trials.csv").read_bytes(), before)
        result = self.collect(out, self.folder / "whole")
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_a_table_that_nothing_makes_anew_stays_told(self):
        out = self.folder / "again"
        self.rehearse(out, "--people", "1", "--keep-recordings")
        session = out / "sim-001"
        rewritten(session / "session.yaml", lambda text: text.replace("seed: 1\n", "seed: 2\n"))
        replay = dihaptic("replay", str(session))
        self.assertIn("session.yaml: warning: seal: does not match", replay.stderr)

    def test_what_is_to_be_typed_is_never_a_strangers(self):
        strange = ["touch PWNED", "/bin/dihaptic rehearse /a.yaml; touch PWNED", "/bin/dihaptic rehearse /a.yaml $(touch PWNED)",
                   "/bin/dihaptic rehearse /a.yaml\ntouch PWNED", "/bin/evil run /a.yaml", "rm -rf /", "",
                   "/bin/dihaptic rehearse /a.yaml --people 3 `touch PWNED`", "/bin/dihaptic rehearse --out /a.yaml",
                   "/bin/dihaptic rehearse /a.yaml --shard 1/2", "/bin/dihaptic rehearse /a.yaml \\e[2J"]
        for command in strange:
            study, out = self.copy()
            shutil.rmtree(study / "sim-002")
            escaped = command.replace("\\e", "\\x1b").replace("\n", "\\n")
            rewritten(study / "rehearsal.yaml", lambda text: re.sub(
                r"command: .*", lambda _: f'command: "{escaped}"', text, count=1))
            result = self.collect(study, out)
            said = result.stdout + result.stderr
            self.assertIn(result.returncode, (1, 2), said)
            self.assertNotIn("PWNED", said)
            self.assertNotIn("\x1b", said)
            if result.returncode == 1:
                self.assertNotIn("/a.yaml", said)
                self.assertIn("was not written by dihaptic", said)

    def test_what_is_to_be_typed_names_this_program_and_this_folder(self):
        study, out = self.copy()
        moved = study.parent / "it's; touch PWNED"
        study.rename(moved)
        shutil.rmtree(moved / "sim-002")
        rewritten(moved / "rehearsal.yaml", lambda text: re.sub(r'command: ("?).*? rehearse ', r"command: \1/bin/evil rehearse ", text, count=1))
        result = self.collect(moved, out)
        self.assertEqual(result.returncode, 1, result.stderr)
        (typed,) = re.findall("working on them: (.*)", result.stdout)
        words = shlex.split(typed)
        self.assertEqual(os.path.basename(words[0]), "dihaptic")
        self.assertEqual(words[1:], ["rehearse", str(self.experiment), "--people", "3", "--seed", "1", "--out", str(moved),
                                     "--jobs", "2"])

    def test_whoever_is_no_rehearsed_person_is_told_of(self):
        study, out = self.copy()
        shutil.copytree(study / "sim-001", study / "mine")
        (study / "mine/person.yaml").unlink()
        result = self.collect(study, out)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(f"left out: {study}/mine: it does not belong to a rehearsed person", result.stdout)


if __name__ == "__main__":
    unittest.main(verbosity=2)
