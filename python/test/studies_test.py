"""A study is read as a whole: its people, recordings and tables, as `dihaptic participant` and `collect` see them."""

import os
import pathlib
import pickle
import re
import shlex
import shutil
import tempfile
import unittest
import unittest.mock

import pandas as pd
from small_study import TRIALS, dihaptic, write

import dihaptic as dh
from dihaptic import figures

FACTS = ["--age", "24", "--fact", "vision=normal", "--fact", "years=3"]
CONCEALED = "allocation: { method: in_turn, seed: 3, concealed: yes }\n"


class Presses(dh.Person):
    """Presses a key in each attempt, and leaves in the one after; a space is none."""

    hand = "right"

    def __init__(self, keys):
        self._keys = iter(keys)
        self._key = " "
        self._at = (0, 0)

    def act(self, seen):
        if seen.trial > 0 and self._at != (seen.trial, seen.attempt):
            self._at = (seen.trial, seen.attempt)
            self._key = next(self._keys)  # StopIteration ends the session
        if self._key != " ":
            self.press(self._key)


def edit(file, old, new):
    """Replaces a text that is in a file."""
    text = pathlib.Path(file).read_text()
    assert old in text, f"no {old} in {file}"
    pathlib.Path(file).write_text(text.replace(old, new, 1))


class Case(unittest.TestCase):
    more = ""  # lines of the study's file
    days = (2, 1, 1, 0)  # that S01, S02, ... have done

    @classmethod
    def setUpClass(cls):
        made = tempfile.TemporaryDirectory()
        cls.addClassCleanup(made.cleanup)
        cls.made = pathlib.Path(made.name) / "study"
        cls.made.mkdir()
        file = write(cls.made, cls.more)
        for number, days in enumerate(cls.days, 1):
            dihaptic("participant", "add", file, f"S0{number}", *FACTS)
            for _ in range(days):
                dihaptic("run", file, "--participant", f"S0{number}", "--simulate")
        shutil.copytree(cls.made / "rehearsal/sessions", cls.made / "sessions")  # as if they had come themselves

    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory())) / "study"
        shutil.copytree(self.made, self.folder)
        self.file = self.folder / "two-days.yaml"
        self.study = dh.Study(self.file)

    def recording(self, participant, day):
        (folder,) = (self.folder / "sessions" / participant / day).iterdir()
        return folder

    def press(self, keys, participant="S04", day="day1"):
        """Records a session in which these keys are pressed and which then breaks off, unless all trials are done."""
        out = self.folder / "sessions" / participant / day
        try:
            recording = dh.run(self.folder / "slow.yaml", person=Presses(keys), participant=participant, out=out).folder
        except StopIteration:
            recording = max(out.iterdir())
        # as `dihaptic run STUDY` records it
        place = f"in_study:\n  study: Two days of lifting\n  version: 1\n  group: light\n  number: 1\n  session: {day}\n"
        edit(recording / "session.yaml", "identity:", place + "identity:")
        return recording

    def kill(self, recording):
        """Makes a recording of one whose program was killed after its last trial."""
        for name in ("trials.csv", "session.nwb"):
            (recording / name).unlink()
        edit(recording / "session.yaml", "state: complete", "state: running")

    def assert_refused(self, what, call, kind=dh.Error):
        with self.assertRaisesRegex(kind, what) as told:
            call()
        return str(told.exception)


class Studies(Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        dihaptic("participant", "withdraw", cls.made / "two-days.yaml", "S02", "--keep-data")
        dihaptic("rehearse", cls.made / "two-days.yaml", "--people", 2)

    def setUp(self):
        super().setUp()
        self.rehearsal = self.folder / "rehearsal"
        self.rehearsed = dh.Study(self.file, rehearsed=self.rehearsal)

    def test_has_the_names_of_its_file(self):
        self.assertEqual(self.study.title, "Two days of lifting")
        self.assertEqual(self.study.groups, ["light", "heavy"])
        self.assertEqual(repr(self.study), "<Study two-days.yaml: Two days of lifting, 4 participants>")
        self.assertEqual(repr(self.rehearsed), "<Study two-days.yaml: Two days of lifting, 2 simulated people>")
        again = pickle.loads(pickle.dumps(self.rehearsed))
        pd.testing.assert_frame_equal(again.sessions, self.rehearsed.sessions)

    def test_participants_are_those_of_the_collected_table_with_who_withdrew(self):
        people = self.study.participants
        self.assertEqual(people.columns.tolist(), ["id", "group", "number", "age", "sex", "handedness", "vision", "years",
                                                   "added", "version", "withdrawn"])  # fmt: skip
        self.assertEqual(people.id.tolist(), ["S01", "S02", "S03", "S04"])
        self.assertEqual(people.group.tolist(), ["light", "heavy", "light", "heavy"])
        self.assertEqual(people.number.tolist(), [1, 1, 2, 2])
        self.assertEqual(people.age.tolist(), [24] * 4)
        self.assertEqual(people.vision.tolist(), ["normal"] * 4)
        self.assertTrue(people.sex.isna().all())
        self.assertEqual(people.id[people.withdrawn.notna()].tolist(), ["S02"])
        for study, of in ((self.study, []), (self.rehearsed, ["--rehearsed", self.rehearsal])):
            dihaptic("collect", self.file, *of)
            pd.testing.assert_frame_equal(study.participants, study.table("participants"))

    def test_sessions_are_in_the_order_of_people_and_days(self):
        table = self.study.sessions
        self.assertEqual(table.columns.tolist(), ["participant", "group", "study_session", "study_condition", "complete",
                                                  "folder"])  # fmt: skip
        self.assertEqual(table.iloc[:, :4].values.tolist(), [
            ["S01", "light", "day1", "slow"], ["S01", "light", "day2", "fast"],
            ["S02", "heavy", "day1", "slow"], ["S03", "light", "day1", "fast"],
        ])  # fmt: skip
        self.assertEqual(table.complete.tolist(), [True] * 4)
        self.assertEqual(table.folder[3], str(self.recording("S03", "day1")))
        self.assertEqual(dh.load(table.folder[3]).trials.ppid.unique().tolist(), ["sim-S03"])

    def test_a_rehearsal_has_its_own_people_and_no_stand_ins(self):
        table = self.rehearsed.sessions
        self.assertTrue((self.rehearsal / "sessions/S01/day1").is_dir())
        self.assertEqual(table.participant.tolist(), ["sim-001", "sim-001", "sim-002", "sim-002"])
        self.assertTrue(table.complete.all())
        self.assert_refused("S01: is not one of the simulated people", lambda: self.rehearsed.session("S01", "day1"))

    def test_before_the_first_participant_there_is_nobody_and_nothing(self):
        for name in ("participants.yaml", "log.csv", "sessions"):
            shutil.move(self.folder / name, self.folder / f"no {name}")
        self.assertEqual(self.study.participants.columns.tolist()[:2], ["id", "group"])
        self.assertEqual((len(self.study.participants), len(self.study.sessions)), (0, 0))
        self.assertEqual(self.study.sessions.complete.sum(), 0)

    def test_an_error_names_the_command_that_collects_the_tables(self):
        for study in (self.study, self.rehearsed):
            said = self.assert_refused("has no tables yet", lambda: study.trials)
            dihaptic(*shlex.split(re.search(r"Type dihaptic (.*)\.$", said)[1]))
            self.assertEqual(study.tables, ["lifts", "participants", "trials"])
            there = study.sessions[["participant", "group", "study_session", "study_condition"]]
            keys = study.trials[["id", "group", "study_session", "study_condition"]].drop_duplicates()
            self.assertEqual(keys.values.tolist(), there.values.tolist())
            self.assert_refused("trails: is not a table of this study. Did you mean 'trials'.* Study.tables lists them",
                                lambda: study.table("trails"), dh.NotThere)  # fmt: skip
            self.assertEqual(study.trials.attrs["units"]["peak_grip_N"], "N")

    def test_a_session_is_the_complete_recording(self):
        session = self.study.session("S01", "day2")
        self.assertEqual(session.folder, self.recording("S01", "day2"))
        self.assertEqual(session.info["in_study"]["condition"], "fast")
        self.assertEqual(len(session.trials), 2 * TRIALS)
        self.assertEqual(self.rehearsed.session("sim-002", "day1").info["participant"]["id"], "sim-002")

    def test_wrong_names_are_told_with_what_was_meant(self):
        for names, said in (
            (("S1", "day1"), "S1: is not a participant of this study. Did you mean 'S01'? Study.participants lists them."),
            (("S01", "dya1"), "dya1: is not a session of this study. Did you mean 'day1'? It has day1, day2."),
        ):
            self.assertEqual(self.assert_refused("", lambda: self.study.session(*names), dh.NotThere), said)

    def test_an_interrupted_session_is_there_and_is_not_complete(self):
        broken = self.press("yy")
        row = self.study.sessions.iloc[-1]
        self.assertEqual(row[["participant", "group", "complete", "folder"]].tolist(), ["S04", "heavy", False, str(broken)])
        self.assertTrue(pd.isna(row.study_condition), "it was not run by the study")
        said = self.assert_refused("S04: has no complete recording of day1: .*sessions/S04/day1/.* broke off",
                                   lambda: self.study.session("S04", "day1"))  # fmt: skip
        self.assertIn(f"dihaptic run {self.file} --participant S04 runs the next session.", said)
        # it began anew
        whole = self.folder / "sessions/S04/day1/0_earlier_by_name"
        shutil.copytree(self.recording("S01", "day1"), whole)
        edit(whole / "session.yaml", "id: sim-S01", "id: S04")
        edit(whole / "session.yaml", "started: \"20", "started: \"21")
        table = self.study.sessions.iloc[-2:]
        self.assertEqual(table.complete.tolist(), [False, True])
        self.assertEqual(table.folder.tolist(), [str(broken), str(whole)])
        self.assertEqual(self.study.session("S04", "day1").folder, whole)

    def test_an_error_says_why_there_is_no_session(self):
        self.assertEqual(
            self.assert_refused("", lambda: self.study.session("S03", "day2")),
            f"S03: has no recording of day2. dihaptic run {self.file} --participant S03 runs the next session.",
        )
        self.assert_refused(r"S02: has no recording of day2, and withdrew on \d{4}-",
                            lambda: self.study.session("S02", "day2"))  # fmt: skip
        self.kill(self.recording("S01", "day1"))
        self.assert_refused("is still running, or was killed", lambda: self.study.session("S01", "day1"))
        shutil.rmtree(self.rehearsal / "sessions/sim-002/day2/rehearsed")
        said = self.assert_refused("sim-002: has no recording of day2", lambda: self.rehearsed.session("sim-002", "day2"))
        self.assertIn("Repeat the command that rehearsed the study", said)
        dihaptic("rehearse", self.file, "--people", 2)
        self.assertEqual(self.rehearsed.session("sim-002", "day2").folder.name, "rehearsed")

    def test_deleted_data_are_gone(self):
        dihaptic("participant", "withdraw", self.file, "S01", "--delete-data")
        self.assertEqual(self.study.participants.withdrawn.notna().tolist(), [True, True, False, False])
        self.assertEqual(self.study.sessions.participant.unique().tolist(), ["S02", "S03"])

    def test_what_is_complete_is_what_the_program_calls_complete(self):
        made = {
            "broke off": self.press("yy"),
            "broke off in a second attempt": self.press("y y"),
            "ended by an outcome": self.press("ye"),
        }
        for name, keys in {"all": "yyy", "ended": "e", "missed twice": "y y "}.items():
            made[f"recovered: {name}"] = self.press(keys)
            self.kill(made[f"recovered: {name}"])
            dihaptic("recover", made[f"recovered: {name}"])
            self.assertEqual(dh.load(made[f"recovered: {name}"]).info["state"], "recovered")
        made["killed"] = self.press("yyy")
        self.kill(made["killed"])
        made["edited"] = shutil.copytree(made["recovered: all"], self.folder / "sessions/S04/day1/edited")
        edit(made["edited"] / "trials.csv", ",Look,", ",Leak,")
        shown = dihaptic("participant", "show", self.file, "S04")
        program = {folder: state for state, folder in re.findall(r"^ +day1 +(complete|\d of \d trials) (.*)$", shown, re.M)}
        here = self.study.sessions.query("participant == 'S04'").set_index("folder").complete
        self.assertEqual(sorted(here.index), sorted(program))
        for name, folder in made.items():
            with self.subTest(name):
                self.assertEqual(here[str(folder)], program[str(folder)] == "complete")
        self.assertEqual(here.value_counts().to_dict(), {True: 4, False: 4})

    def test_what_is_no_recording_is_passed_over_and_what_cannot_be_read_is_an_error(self):
        day = self.folder / "sessions/S01/day1"
        (day / ".DS_Store").touch()
        (day / "unfinished-S01").mkdir()
        (self.folder / "sessions/S01/day3").mkdir()
        self.assertEqual(len(self.study.sessions), 4)
        info = self.recording("S03", "day1") / "session.yaml"
        whole = info.read_text()
        for old, new, said in (
            ("id: sim-S03", "id: S02", "participant: is 'S02', not S03. Move the folder"),
            ("started: ", "started: long ago #", "started: 'long ago' is not a time"),
            ("started: ", "started: [1] #", "session.yaml: error: started: is not a single value. Restore the file"),
            ("in_study:", "in_study: 3\nolder:", "session.yaml: error: in_study: has no keys. Restore the file, or move"),
            ("participant:", "participant: 3\nolder:", "session.yaml: error: participant: has no keys"),
            ("state: complete", "state: [", "session.yaml: error: cannot be read"),
        ):
            with self.subTest(said):
                edit(info, old, new)
                self.assert_refused(re.escape(said), lambda: self.study.sessions)
                info.write_text(whole)
        info.unlink()
        self.assert_refused("is not a session: it has no session.yaml", lambda: self.study.sessions)
        self.assertEqual(self.study.session("S01", "day1").folder.parent, day)

    def test_a_damaged_list_of_participants_is_an_error(self):
        roster = self.folder / "participants.yaml"
        whole = roster.read_text()
        for old, new, said in (
            ("study: Two days of lifting", "study: Others", "study: is 'Others', not 'Two days of lifting'"),
            ("id: S01", "id: ..", "participants: has an item whose id is '..'"),
            ("group: light", "group: other", "S01: is in the group 'other', which the study does not have"),
            ("participants:", "participants: 3\nolder:", "participants: is not a list"),
            ("participants:", "participants: [", "cannot be read"),
            ("participants:", "participants: [3]\nolder:", "participants: is not a list of items with keys. Restore"),
            ("group: light", "group: [light]", "S01.group: is not a single value. Restore the file"),
            ("age: ", "age: [1] #", "S01.age: is not a single value"),
            ("facts:", "facts: 3\n    older:", "S01.facts: is not a list of items with keys"),
            ("facts:", "facts: [3]\n    older:", "S01.facts: is not a list of items with keys"),
            ("value: normal", "value: [normal]", "S01.vision.value: is not a single value"),
            ("id: S02", "id: S01", "S01: is listed twice. Restore the file: log.csv says who was added."),
            ("id: S02", "id: s01", "s01: is listed twice"),
            ("id: S02", "id: S09", "lacks S02, who had been added. Restore the file: log.csv says who was added."),
            ("data_deleted:", "data_there:", "S01.data_deleted: is missing: the file was cut off. Restore the file"),
        ):
            with self.subTest(said):
                edit(roster, old, new)
                self.assert_refused("participants.yaml: error: " + re.escape(said), lambda: self.study.participants)
                roster.write_text(whole)

    def test_a_list_of_participants_that_was_cut_or_removed_is_an_error(self):
        for study in (self.study, self.rehearsed):
            roster = study.folder / "participants.yaml"
            lines = roster.read_text().splitlines(keepends=True)
            for kept in range(len(lines)):
                roster.write_text("".join(lines[:kept]))
                with self.subTest(roster, kept=kept):
                    self.assert_refused("participants.yaml: error: ", lambda: study.participants)
            roster.unlink()
            said = "participants.yaml: error: is gone, and (S01, S02|sim-001, sim-002).* had been added. Restore the file"
            self.assert_refused(said, lambda: study.participants)
            self.assert_refused("is gone", lambda: study.sessions)

    def test_what_is_no_file_is_refused_at_once(self):
        for name in ("participants.yaml", "log.csv"):
            os.rename(self.folder / name, self.folder / "kept")
            os.mkfifo(self.folder / name)
            self.assert_refused(f"{name}: error: cannot be read: it is not a regular file", lambda: self.study.sessions)
            os.replace(self.folder / "kept", self.folder / name)
        os.mkfifo(self.folder / "pipe.yaml")
        self.assert_refused("pipe.yaml: error: cannot be read: it is not a regular file",
                            lambda: dh.Study(self.folder / "pipe.yaml"))  # fmt: skip
        recording = self.press("yy")
        for name in ("trial-list.csv", "trials.csv", "task.yaml"):
            os.unlink(recording / name)
            os.mkfifo(recording / name)
            self.assertFalse(self.study.sessions.complete.iloc[-1])

    def test_an_interrupted_session_counts_if_its_files_tell_enough_of_its_trials(self):
        broken = self.press("yy")
        edit(self.file, "title:", "resuming: { complete: 0.5 }\ntitle:")
        study = dh.Study(self.file)
        self.assertEqual(study.session("S04", "day1").folder, broken)
        # so it does in figures and reports, as if it was not a simulated person's
        with unittest.mock.patch("dihaptic.figures.sessions._stands_in", return_value=False):
            (session,) = figures.read(self.folder / "sessions/S04").sessions
            self.assertEqual(session.folder.resolve(), broken.resolve())
            edit(self.file, "complete: 0.5", "complete: 0.9")
            with self.assertRaisesRegex(dh.Error, "contains no completed sessions"):
                figures.read(self.folder / "sessions/S04")
            edit(self.file, "complete: 0.9", "complete: 0.5")
        # and in the program's tables over people
        edit(broken / "session.yaml", "id: sim-S04", "id: S04")
        for path in (self.file, self.folder / "sessions"):
            self.assertIn("of 1 session", dihaptic("report", path, "--tables"))
        edit(self.file, "complete: 0.5", "complete: 0.9")
        for path in (self.file, self.folder / "sessions"):
            self.assert_refused("S04: it ended before its trials were done",
                                lambda path=path: dihaptic("report", path, "--tables"))  # fmt: skip
        edit(self.file, "complete: 0.9", "complete: 0.5")
        task = broken / "task.yaml"
        whole = task.read_text()
        for old, new in (
            ("states:", "states: 3\nolder:"),
            ("states:", "states: [3]\nolder:"),
            ("states:", "states: [{ exits: 3 }]\nolder:"),
            ("most_attempts: 2", "most_attempts: x"),
            ("most_attempts: 2", "most_attempts: [2]"),
        ):
            with self.subTest(new):
                edit(task, old, new)
                self.assertFalse(study.sessions.complete.iloc[-1])
                self.assert_refused("S04: has no complete recording of day1", lambda: study.session("S04", "day1"))
                task.write_text(whole)

    def test_a_damaged_file_of_the_study_is_an_error(self):
        whole = self.file.read_text()
        number = "resuming.complete: must be a number from 0.01 to 1, but is "
        for more, said in (
            ("resuming: { complete: yes }", number + "'yes'. dihaptic check names the mistake."),
            ("resuming: { complete: .nan }", number + "'.nan'"),
            ("resuming: { complete: nan }", number + "'nan'"),
            ("resuming: { complete: 0 }", number + "'0'"),
            ("resuming: { complete: 1.5 }", number + "'1.5'"),
            ("resuming: { complete: [1] }", "resuming.complete: is not a single value"),
            ("resuming: [1]", "resuming: has no keys"),
            ("resuming: 1", "resuming: has no keys"),
            ("allocation: 3", "allocation: has no keys"),
            ("allocation: { concealed: [yes] }", "allocation.concealed: is not a single value"),
            ("allocation: { concealed: on }", "allocation.concealed: must be yes or no, but is 'on'"),
        ):
            with self.subTest(more):
                self.file.write_text(f"{whole}{more}\n")
                self.assert_refused("two-days.yaml: error: " + re.escape(said), lambda: dh.Study(self.file))
        edit(self.file, f"title: {self.study.title}", "title: [Two days]")
        self.assert_refused("two-days.yaml: error: title: is not a single value", lambda: dh.Study(self.file))

    def test_a_row_with_more_cells_than_the_header_is_an_error(self):
        table = self.folder / "tables/trials.csv"
        table.parent.mkdir()
        for text, line in (
            ("a,b\n1,2,3\n", 2),
            ("a,b\n1,2,\n", 2),
            ("a,b\n1,2,3,4\n5,6\n", 2),
            ("\na,b\n\n1,2,3\n", 4),
            ("a,b\n1,2\n3,4,5\n", 3),
        ):
            with self.subTest(text):
                table.write_text(text)
                said = self.assert_refused("", lambda: self.study.trials)
                remedy = "Correct this line, or make the table again."
                self.assertEqual(said, f"{table}:{line}: error: has more cells than the header. {remedy}")
        table.write_text("a,b\n1\n3,4\n")
        self.assertEqual(self.study.trials.fillna(0).values.tolist(), [[1, 0], [3, 4]])
        table.write_text("a,b\n")
        self.assertEqual(len(self.study.trials), 0)

    def test_only_a_study_is_opened(self):
        for file, rehearsed, said in (
            (self.folder / "slow.yaml", "", "slow.yaml: error: is not a study: it has no groups"),
            (self.folder / "none.yaml", "", "none.yaml: error: cannot be read"),
            (self.folder, "", "cannot be read"),
            (self.file, self.folder / "elsewhere", "elsewhere: error: is not a folder. .*dihaptic rehearse .*two-days.yaml"),
        ):
            with self.subTest(said):
                self.assert_refused(said, lambda: dh.Study(file, rehearsed=rehearsed))
        edit(self.file, "name: day1", "name: ../day1")
        self.assert_refused("two-days.yaml: error: sessions: has an item whose name is '../day1'", lambda: dh.Study(self.file))


class ConcealedGroups(Case):
    more = CONCEALED
    days = (1, 1)

    def test_have_codes_which_only_the_tables_reveal(self):
        codes = self.study.participants.group.tolist()
        for code in codes:
            self.assertRegex(code, "^arm [0-9a-f]{4}$")
        self.assertNotEqual(*codes)
        self.assertEqual(self.study.sessions.group.tolist(), codes)
        self.assertEqual(self.study.groups, ["light", "heavy"])
        dihaptic("collect", self.file)
        pd.testing.assert_frame_equal(self.study.participants, self.study.table("participants"))
        dihaptic("collect", self.file, "--reveal-groups")
        self.assertEqual(self.study.table("participants").group.tolist(), ["light", "heavy"])
        self.assertEqual(self.study.trials.group.unique().tolist(), ["light", "heavy"])
        self.assertEqual(self.study.participants.group.tolist(), codes)
        # the study is over
        edit(self.file, "concealed: yes", "concealed: no")
        self.assertEqual(dh.Study(self.file).participants.group.tolist(), ["light", "heavy"])

    def test_may_be_concealed_in_other_words(self):
        for word, hidden in (("true", True), ("false", False), ("no", False), ("yes", True)):
            text = (self.made / "two-days.yaml").read_text().replace("concealed: yes", f"concealed: {word}")
            self.file.write_text(text)
            self.assertEqual(dh.Study(self.file).participants.group[0].startswith("arm"), hidden, word)

    def test_have_them_even_if_the_file_has_names(self):
        code = self.study.participants.group[0]
        edit(self.folder / "participants.yaml", f"group: {code}", "group: light")
        self.assertEqual(self.study.participants.group[0], code)


class Files(unittest.TestCase):
    def test_a_study_that_nobody_has_begun_is_read(self):
        with tempfile.TemporaryDirectory() as folder:
            study = dh.Study(write(folder))
            self.assertEqual(len(study.sessions), 0)
            self.assertEqual(study.tables, [])

    def test_a_rehearsal_tells_how_it_is_collected(self):
        with tempfile.TemporaryDirectory(suffix=" of mine") as folder:
            with self.assertRaisesRegex(dh.Error, "is not a rehearsal: it has neither rehearsal.yaml nor people"):
                dh.Rehearsal(folder)
            pathlib.Path(folder, "rehearsal.yaml").touch()
            with self.assertRaises(dh.Error) as told:
                dh.Rehearsal(folder).people  # noqa: B018
            self.assertEqual(str(told.exception), f"{folder}: error: has no tables yet. Type dihaptic collect '{folder}'.")
            pathlib.Path(folder, "trials.csv").write_text("id,trial_num\nsim-001,1\n")
            self.assertEqual(len(dh.Rehearsal(folder).trials), 1)
            with self.assertRaisesRegex(dh.NotThere, "people: is not a table of this rehearsal. Rehearsal.tables lists them"):
                dh.Rehearsal(folder).people  # noqa: B018


if __name__ == "__main__":
    unittest.main()
