"""People of one's own, and rules between their trials, make rehearsals like the program's."""

import contextlib
import enum
import fcntl
import gc
import io
import math
import pathlib
import tempfile
import unittest
import weakref

import numpy as np

import dihaptic as dh

TRIALS = 4


def experiment():
    """Trials of a tenth of a second, that end early when a key is pressed."""
    return dh.Experiment(
        title="Yes or no",
        scene=str(pathlib.Path("scenes/block-on-table.yaml").absolute()),
        hand={"centre_mm": [0, 0, 60], "aperture_mm": 85},
        task={
            "states": [
                {
                    "name": "look",
                    "exits": [
                        {"when": "key", "key": "y", "outcome": "yes"},
                        {"when": "time", "after_s": 0.1, "outcome": "none"},
                    ],
                }
            ],
            "blocks": [{"name": "all", "kind": "baseline", "repeats": TRIALS}],
        },
    )


class Every(dh.Person):
    """Says yes in every second or third trial."""

    hand = "right"

    def __init__(self, number):
        self.group = ["even", "odd"][number % 2]
        self.every_so_many = number + 1
        self._hidden = 1

    def act(self, seen):
        if seen.trial % self.every_so_many == 0:
            self.press("y")


class Breaks(Every):
    def act(self, seen):
        if self.every_so_many == 3 and seen.t > 0.05:
            raise ZeroDivisionError("by person 2")


class LastFirst(dh.BetweenTrials):
    """The last trial comes first."""

    messages = ["The last first"]

    def decide(self, last):
        return dh.Next(trial_num=TRIALS, message=self.messages[0]) if last.trial_num == 0 else None


class Rehearsals(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def rehearse(self, people=2, out="study", **options):
        return dh.rehearse(experiment(), people, out=self.folder / out, progress=False, **options)

    def test_people_of_one_s_own_are_collected_like_others(self):
        study = self.rehearse(3, person=Every)
        self.assertEqual([path.name for path in study.sessions], ["sim-001", "sim-002", "sim-003"])
        self.assertEqual(study.people.columns.tolist(), [
            "seed", "group", "id", "class", "hand", "every_so_many", "simulated", "moved_by",
        ])  # fmt: skip
        self.assertEqual(study.people.group.tolist(), ["odd", "even", "odd"])
        yes = study.trials[study.trials.outcome == "yes"]
        self.assertEqual(yes.groupby("id").trial_num.apply(list).to_dict(), {"sim-001": [2, 4], "sim-002": [3], "sim-003": [4]})
        self.assertTrue(study.trials.simulated.all())
        self.assertFalse(list(study.folder.glob("*/raw.log")) + list(study.folder.glob("*/session.nwb")))

    def test_what_is_no_rehearsal_is_not_opened(self):
        for folder, said in (
            (self.folder / "none", "none: error: cannot be read: No such file or directory. Name the folder"),
            (__file__, "cannot be read: Not a directory"),
            (self.folder, "is not a rehearsal: it has neither rehearsal.yaml nor people. Name the folder"),
        ):
            with self.subTest(said), self.assertRaisesRegex(dh.Error, said):
                dh.Rehearsal(folder)
        study = self.rehearse(2, person=Every)
        (study.folder / "rehearsal.yaml").unlink()
        (study.folder / "sim-002/person.yaml").unlink()
        self.assertEqual([path.name for path in dh.Rehearsal(study.folder).sessions], ["sim-001", "sim-002"])

    def test_a_person_s_session_says_that_it_has_tables_alone(self):
        for person in (None, Every):
            session = dh.load(self.rehearse(1, out=f"of {person}", person=person).sessions[0])
            self.assertGreater(len(session.trials), 0)
            with self.assertRaisesRegex(dh.Error, "only tables: a rehearsal keeps no recordings. With --keep-recordings"):
                session["grip_force"]
        session = dh.load(self.rehearse(1, out="kept", person=Every, keep_recordings=True).sessions[0])
        self.assertEqual(len(session["grip_force"]), len(session.t))

    def test_tables_are_the_same_however_many_work_at_them(self):
        one = self.rehearse(4, out="one", person=Every)
        many = self.rehearse(4, out="many", person=Every, jobs=3)
        for name in one.tables:
            self.assertEqual((one.folder / f"{name}.csv").read_bytes(), (many.folder / f"{name}.csv").read_bytes(), name)

    def test_who_is_there_is_not_done_again(self):
        self.rehearse(1, person=Every)
        before = (self.folder / "study/sim-001/session.yaml").stat().st_mtime_ns
        self.assertEqual(len(self.rehearse(2, person=Every).sessions), 2)
        self.assertEqual((self.folder / "study/sim-001/session.yaml").stat().st_mtime_ns, before)

    def test_a_person_who_breaks_ends_it_and_those_before_stay(self):
        for jobs in (1, 2):
            with self.subTest(jobs=jobs), self.assertRaisesRegex(ZeroDivisionError, "by person 2") as told:
                self.rehearse(3, out=f"jobs{jobs}", person=Breaks, jobs=jobs)
            self.assertTrue((self.folder / f"jobs{jobs}/sim-001/trials.csv").is_file())
            self.assertFalse((self.folder / f"jobs{jobs}/sim-002").exists())
            self.assertIn("unfinished-sim-002", told.exception.__notes__[0])

    def test_whatever_a_person_raises_comes_out(self):
        class Two(Exception):  # cannot be unpickled
            def __init__(self, a, b):
                super().__init__(f"{a} {b}")

        def wrong_finger(person):
            person.lead("pinky", (0, 0, 0))

        def raise_it(why):
            raise why

        for name, act, kind, text in (
            ("stop", lambda person: raise_it(StopIteration("enough")), StopIteration, "enough"),
            ("two", lambda person: raise_it(Two("a", "b")), Exception, "a b"),
            ("pinky", wrong_finger, dh.NotThere, "pinky"),
        ):
            class Person(Every):
                def act(self, seen):
                    act(self)

            for jobs in (1, 2):
                with self.subTest(name, jobs=jobs), self.assertRaisesRegex(kind, text) as told:
                    self.rehearse(3, out=f"{name}{jobs}", person=Person, jobs=jobs)
                self.assertIn("The session until then", "".join(told.exception.__notes__))

    def test_what_is_drawn_is_a_person_s_own_whatever_jobs(self):
        class Drawn(Every):
            def __init__(self, number):
                super().__init__(number)
                self.gain = np.random.normal()

        gains = [self.rehearse(4, out=f"jobs{jobs}", person=Drawn, jobs=jobs).people.gain.tolist() for jobs in (1, 3)]
        self.assertEqual(gains[0], gains[1])
        self.assertEqual(len(set(gains[0])), 4)
        np.random.seed(1)
        expected = np.random.normal()
        np.random.seed(1)
        self.rehearse(1, out="between", person=Drawn)
        self.assertEqual(np.random.normal(), expected, "the caller's own numbers")

    def test_people_may_have_different_attributes_of_any_kind(self):
        class Side(enum.IntEnum):
            LEFT = 1

        class Odd(Every):
            def __init__(self, number):
                super().__init__(number)
                self.null = 'a: "b" # c\n d'
                self.side = Side.LEFT
                self.gain = math.nan if number == 2 else np.float32(0.5)
                self.limp = None
                setattr(self, "größe", "🙂")
                if number == 2:
                    self.lesion = " left"

        people = self.rehearse(2, person=lambda number: (Odd if number < 3 else Every)(number)).people
        self.assertEqual(people["null"].tolist(), ['a: "b" # c\n d'] * 2)
        self.assertEqual(people["größe"].tolist(), ["🙂"] * 2)
        self.assertEqual(people.side.tolist(), [1, 1])
        self.assertEqual(people.gain.fillna(-1).tolist(), [0.5, -1])
        self.assertEqual(people.lesion.fillna("").tolist(), ["", " left"])
        self.assertTrue(people.limp.isna().all())
        for name in ("id", "class", "seed", "simulated", "moved_by"):
            named = type("Named", (Every,), {name: "me"})
            with self.subTest(name), self.assertRaisesRegex(dh.Error, f"{name}: is already a column"):
                self.rehearse(1, out=name, person=named)

    def test_one_does_a_person_s_session_at_a_time(self):
        place = self.folder / "study/unfinished-sim-001"
        place.mkdir(parents=True)
        with (place / "messages.txt").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            with self.assertRaisesRegex(dh.Error, "sim-001: another program is doing this session"):
                self.rehearse(1, person=Every)
        self.assertEqual(len(self.rehearse(1, person=Every).sessions), 1)
        self.assertFalse(place.exists())

    def test_rules_decide_between_trials_of_one_s_own_people_and_of_the_program_s(self):
        for name, person in (("own", Every), ("program's", None)):
            with self.subTest(name):
                study = self.rehearse(2, out=name, jobs=2, person=person, between=lambda number: LastFirst())
                for _, trials in study.trials.groupby("id"):
                    self.assertEqual(trials.trial_num.iloc[0], TRIALS)
                events = dh.read_table(study.sessions[0] / "events.csv")
                self.assertTrue(events.detail.str.contains("The last first").any())

    def test_a_decision_that_is_wrong_ends_it(self):
        def deciding(decide):
            return lambda number: type("Rules", (dh.BetweenTrials,), {"decide": lambda self, last: decide()})()

        for name, decide, why in (
            ("raises", lambda: 1 / 0, "division by zero"),
            ("chooses", lambda: dh.Next(trial_num=99), "trial 99"),
            ("sets", lambda: dh.Next(variables={"gain": 2}), "gain"),
            ("leaves", lambda: exit(), "decides between trials"),
        ):
            for person in (Every, None):
                with self.subTest(name, person=person), self.assertRaisesRegex(dh.Error, f"(?s)sim-001: .*{why}"):
                    self.rehearse(1, out=f"{name}{person}", person=person, between=deciding(decide))

    def test_rules_that_decide_nothing_change_nothing(self):
        class Silent(dh.BetweenTrials):
            def decide(self, last):
                return None

        plain = self.rehearse(2, out="plain")
        ruled = self.rehearse(2, out="ruled", between=lambda number: Silent())
        self.assertEqual(plain.tables, ruled.tables)
        for name in plain.tables:
            self.assertEqual((plain.folder / f"{name}.csv").read_bytes(), (ruled.folder / f"{name}.csv").read_bytes(), name)

    def test_a_folder_holds_one_kind_of_people_and_of_rules(self):
        self.rehearse(1, person=Every, between=lambda number: LastFirst())
        for given, why in (
            ({"person": Every}, "between: LastFirst there, nothing now"),
            ({"person": Breaks, "between": lambda number: LastFirst()}, "Python's Every there, Python's Breaks now"),
            ({}, "population"),
            ({"person": Every, "between": lambda number: LastFirst(), "seed": 2}, "seed: 1 there, 2 now"),
        ):
            with self.subTest(why), self.assertRaisesRegex(dh.Error, why):
                self.rehearse(1, **given)

    def test_what_is_wrong_is_told_before_anybody_begins(self):
        for given, why in (
            ({"person": lambda number: 3}, "Person: 3 is not a Person"),
            ({"between": lambda number: Every(1)}, "BetweenTrials: .* is not a BetweenTrials"),
            ({"person": Every, "population": "populations/adults.yaml"}, "given twice"),
            ({"person": Every, "jobs": 0}, "jobs: is 0"),
            ({"person": Every, "people": 10000}, "people: is 10000"),
            ({"person": Every, "seed": -1}, "seed: is -1"),
            ({"person": lambda number, one=Every(1): one}, "person: is one object"),
        ):
            with self.subTest(why), self.assertRaisesRegex(dh.Error, why):
                self.rehearse(**given)
            self.assertFalse((self.folder / "study").exists())

    def test_progress_is_shown(self):
        said = io.StringIO()
        with contextlib.redirect_stderr(said):
            dh.rehearse(experiment(), 2, out=self.folder / "study", person=Every)
        self.assertIn("rehearsing 2 of 2", said.getvalue())


class Sessions(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def test_a_person_of_one_s_own_goes_with_rules(self):
        session = dh.run(experiment(), person=Every(1), between=LastFirst(), out=self.folder)
        self.assertEqual(session.trials.trial_num.tolist(), [4, 1, 2, 3])
        self.assertEqual(session.trials.outcome.tolist(), ["yes", "none", "yes", "none"])

    def test_a_person_is_freed_afterwards(self):
        person = Every(1)
        dh.run(experiment(), person=person, out=self.folder)
        with self.assertRaises(ZeroDivisionError):
            dh.run(experiment(), person=Breaks(2), out=self.folder)
        gone = weakref.ref(person)
        del person
        gc.collect()
        self.assertIsNone(gone())

    def test_a_person_does_one_session_at_a_time(self):
        class Nested(Every):
            def act(self, seen):
                dh.run(experiment(), person=self, out=self.out)

        person = Nested(1)
        person.out = str(self.folder)
        with self.assertRaisesRegex(dh.Error, "Nested: is doing another session now"):
            dh.run(experiment(), person=person, out=self.folder)

    def test_a_session_that_a_person_ended_is_named_and_complete_as_far_as_it_goes(self):
        class Leaves(Every):
            def act(self, seen):
                if seen.trial == 3:
                    raise StopIteration("home")

        with self.assertRaises(StopIteration) as told:
            dh.run(experiment(), person=Leaves(1), out=self.folder)
        (folder,) = self.folder.iterdir()
        self.assertEqual(told.exception.__notes__, [f"The session until then: {folder}"])
        session = dh.load(folder)
        self.assertEqual(session.info["state"], "interrupted")
        self.assertEqual(session.trials.trial_num.tolist(), [1, 2, 3])
        self.assertGreater(len(session["grip_force"]), 150)
        with self.assertRaisesRegex(dh.Error, "names a person written in Python"):
            dh.resume(session)


if __name__ == "__main__":
    unittest.main()
