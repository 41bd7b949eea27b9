"""People of one's own, and rules between their trials, make rehearsals like the program's."""

import contextlib
import io
import pathlib
import tempfile
import unittest

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
            if jobs == 1:
                self.assertIn("unfinished-sim-002", told.exception.__notes__[0])

    def test_rules_decide_between_trials_of_one_s_own_people_and_of_the_program_s(self):
        for name, person in (("own", Every), ("program's", None)):
            with self.subTest(name):
                study = self.rehearse(2, out=name, jobs=2, person=person, between=lambda number: LastFirst())
                for _, trials in study.trials.groupby("id"):
                    self.assertEqual(trials.trial_num.iloc[0], TRIALS)
                events = dh.read_table(study.sessions[0] / "events.csv")
                self.assertTrue(events.detail.str.contains("The last first").any())

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
            ({"person": lambda number: 3}, "Person: 3 is none"),
            ({"between": lambda number: Every(1)}, "BetweenTrials: .* is none"),
            ({"person": Every, "population": "populations/adults.yaml"}, "given twice"),
            ({"person": Every, "jobs": 0}, "jobs: is 0"),
            ({"person": Every, "people": 10000}, "people: is 10000"),
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
        with self.assertRaisesRegex(dh.Error, "whom Python moved"):
            dh.resume(session)


if __name__ == "__main__":
    unittest.main()
