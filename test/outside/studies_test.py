"""Studies and questionnaires as other programs had trouble with them. docs/outside.md has the sources.

Usage: outside/studies_test.py PROGRAM, from the project's folder.
"""
import csv
import glob
import os
import pathlib
import re
import sys
import tempfile
import unittest

sys.path.append("test/cli")
from program import dihaptic

STUDY = """title: Two groups
groups: [{ name: a, people: 3 }, { name: b, people: 3 }]
sessions: [{ name: only, experiment: short.yaml }]
"""
#: A rating whose scale is reversed, one whose scale is not, and one that nobody has time to give.
FORM = """title: Mood
version: "7"
items:
  - { name: calm, question: Calm, scale: likert, labels: [no, a little, rather, yes], simulated_answer: 4 }
  - { name: tense, question: Tense, scale: likert, labels: [no, a little, rather, yes], simulated_answer: 2 }
  - { name: tired, question: Tired, scale: vas, simulated_answer: 30 }
scores:
  - { name: strain, of: 5 - calm + tense }
  - { name: all_of_it, of: 5 - calm + tense + tired }
"""
ASKED = """title: Asked twice
scene: SCENE
task:
  states:
    - name: ask
      form: { file: mood.yaml }
      exits:
        - { when: answered, outcome: filled }
        - { when: time, after_s: limit, outcome: out of time }
  cross: [{ factor: limit_s, levels: [30, 1.4] }]
  blocks: [{ name: asked, order: sequential, repeats: 2 }]
"""


class Groups(unittest.TestCase):
    """Reports of studies whose groups have names, and files, of their own."""

    def rehearse(self, titles, people="6"):
        folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        text = pathlib.Path("experiments/first-trials.yaml").read_text().replace("../", os.getcwd() + "/")
        text = re.sub(r"repeats: \d+", "repeats: 1", text)
        for group, title in titles.items():
            (folder / f"{group}.yaml").write_text(re.sub("^title:.*$", f"title: {title}", text, count=1, flags=re.MULTILINE))
        names = ", ".join(f"{{ name: {group}, people: 10 }}" for group in titles)
        (folder / "study.yaml").write_text(
            f'title: Groups\ngroups: [{names}]\nallocation: {{ method: in_turn, seed: 3 }}\n'
            'sessions: [{ name: only, experiment: "{group}.yaml" }]\n'
        )
        said = dihaptic("rehearse", str(folder / "study.yaml"), "--people", people)
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertNotIn("between sessions", said.stdout)
        report = dihaptic("report", str(folder / "study.yaml"), "--rehearsed", str(folder / "rehearsal"))
        self.assertEqual(report.returncode, 0, report.stderr)
        return folder, report, (folder / "rehearsal/sessions/report.html").read_text()

    def test_groups_are_in_the_order_of_the_file_everywhere(self):
        _, report, page = self.rehearse({"west": "Lifts", "east": "Lifts"})
        self.assertIn("in 2 groups (west, east)", page)
        self.assertIn("east minus west", page)
        self.assertNotIn("are not compared", page + report.stderr)

    def test_groups_that_cannot_be_compared_are_told(self):
        folder, report, page = self.rehearse({"west": "Lifts of the west", "east": "Lifts of the east"}, "2")
        for text in (page, report.stderr):
            self.assertIn("are not compared, because their experiments have different titles", text)
        said = dihaptic("power", str(folder / "rehearsal"), "--effect", "mean(static_grip_N, group=west) - mean(static_grip_N, group=east)")
        self.assertEqual(said.returncode, 2)
        self.assertIn("contains sessions of 2 experiments: Lifts of the east; Lifts of the west", said.stderr)
        self.assertIn("give these files the same title", said.stderr)

    def test_a_study_is_no_pool(self):
        folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        (folder / "study.yaml").write_text(STUDY)
        said = dihaptic("power", str(folder / "study.yaml"), "--effect", "mean(static_grip_N)", "--out", str(folder / "power"))
        self.assertEqual((said.returncode, sorted(os.listdir(folder))), (2, ["study.yaml"]))
        self.assertIn("is a study, whose people are not rehearsed here. Rehearse it (dihaptic rehearse", said.stderr)

    def test_orders_that_do_not_come_up_equally_often_are_told(self):
        folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        scene = os.path.abspath("scenes/reach-in-space.yaml")
        for people, order, repeats, orders in ((12, "counterbalanced", 1, 24), (48, "counterbalanced", 1, 0), (6, "latin_square", 1, 4),
                                               (6, "latin_square", 4, 0), (7, "shuffled", 1, 0)):  # fmt: skip
            with self.subTest(people=people, order=order, repeats=repeats):
                (folder / "four.yaml").write_text(f"""title: Four
scene: {scene}
task:
  conditions: [{{ name: A }}, {{ name: B }}, {{ name: C }}, {{ name: D }}]
  states: [{{ name: go, exits: [{{ when: time, after_s: 0.05, outcome: done }}] }}]
  blocks: [{{ name: all, order: {order}, repeats: {repeats} }}]
""")
                (folder / "study.yaml").write_text(
                    f"title: S\ngroups: [{{ name: a, people: {people} }}]\nsessions: [{{ name: only, experiment: four.yaml }}]\n")
                said = dihaptic("check", str(folder / "study.yaml"))
                self.assertEqual(said.returncode, 0, said.stdout)
                told = f"is {people}: the conditions of block all in four.yaml have {orders} orders"
                self.assertEqual(told in said.stdout + said.stderr, orders > 0, said.stdout + said.stderr)
                self.assertEqual("orders" in said.stdout + said.stderr, orders > 0)


class Studies(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def write(self, name, text):
        file = pathlib.Path(self.folder, name)
        file.write_text(text)
        return str(file)

    def study(self):
        text = pathlib.Path("experiments/first-trials.yaml").read_text().replace("../", os.getcwd() + "/")
        self.write("short.yaml", re.sub(r"repeats: \d+", "repeats: 1", text))
        return self.write("study.yaml", STUDY)

    def groups(self, study, people):
        for id in people:
            self.assertEqual(dihaptic("participant", "add", study, id).returncode, 0)
        listed = dihaptic("participant", "list", study).stdout
        return [re.search(rf"{id} +([ab]) ", listed)[1] for id in people]

    def test_a_trial_run_takes_nobodys_place(self):
        """psiTurk 295: participants of test runs were counted when the next one was assigned a condition."""
        study = self.study()
        self.assertEqual(self.groups(study, ["S01"]), ["a"])
        self.assertEqual(dihaptic("run", study, "--participant", "S01", "--simulate").returncode, 0)
        self.assertRegex(dihaptic("participant", "list", study).stdout, r"S01 +a +next: only")
        self.assertEqual(self.groups(study, ["S02", "S03"]), ["b", "a"])

    def test_who_drops_out_leaves_the_groups_balanced(self):
        """Bride of Frankensystem 16: after dropouts, 20 and 20 participants had become 24 and 16."""
        study = self.study()
        self.groups(study, ["S01", "S02", "S03", "S04", "S05"])
        for id in ("S01", "S03", "S05"):  # all of one group
            withdrawn = dihaptic("participant", "withdraw", study, id, "--keep-data")
            self.assertEqual(withdrawn.returncode, 0, withdrawn.stderr)
        self.groups(study, ["S06", "S07", "S08", "S09"])
        listed = dihaptic("participant", "list", study).stdout
        self.assertRegex(listed, r"group a +3 of 3\ngroup b +3 of 3\n")

    def asked(self):
        self.write("mood.yaml", FORM)
        file = self.write("asked.yaml", ASKED.replace("SCENE", os.getcwd() + "/scenes/reach-in-space.yaml"))
        result = dihaptic("run", file, "--simulate", "--participant", "S01", "--out", self.folder + "/out")
        self.assertEqual(result.returncode, 0, result.stderr)
        session, = glob.glob(self.folder + "/out/*")
        with open(session + "/trials.csv") as table:
            return session, list(csv.DictReader(table))

    def test_a_form_that_is_asked_again_is_blank_again(self):
        """PsychoPy 4631: a form in a loop kept the answers of the time before."""
        session, rows = self.asked()
        events = pathlib.Path(session, "events.csv").read_text()
        self.assertEqual(events.count("answer,\"calm 4; Mood, version 7\""), 4, events)
        self.assertEqual([row["tired"] for row in rows], ["30", "", "30", ""])

    def test_items_without_an_answer_are_blank_cells_with_a_reason(self):
        """experimentum 41: items without an answer had no row; oli-torus 4966: the report failed."""
        session, rows = self.asked()
        self.assertEqual([row["outcome"] for row in rows], ["filled", "out of time"] * 2)
        self.assertEqual([row["all_of_it"] for row in rows], ["33", "", "33", ""])
        self.assertIn("all_of_it", rows[1]["not_measured"])
        self.assertEqual([row["strain"] for row in rows], ["3"] * 4)
        self.assertEqual(dihaptic("report", session).returncode, 0)

    def test_a_score_leaves_the_answers_as_they_were(self):
        """umx 129: scoring a questionnaire reversed the items in the data themselves."""
        _, rows = self.asked()
        self.assertEqual([(row["calm"], row["tense"]) for row in rows], [("4", "2")] * 4)


if __name__ == "__main__":
    unittest.main(verbosity=1)
