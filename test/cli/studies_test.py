"""Studies: participants are added, allocated, run through their sessions, and withdrawn.

Usage: studies_test.py PROGRAM, from the project's folder.
"""
import csv
import glob
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import tempfile
import unittest

from program import PROGRAM, dihaptic, wait_for_log

import soak  # program.py adds its folder to the path

STUDY = """title: Two days
groups: [{ name: gradual, people: 2 }, { name: abrupt, people: 2 }]
facts: [{ name: vision, values: [normal, corrected] }]
include: [{ fact: age, at_least: 18 }, { fact: handedness, is: [right] }]
conditions: [light, heavy]
sessions:
  - { name: familiar, experiment: "short.yaml" }
  - { name: day1, experiment: "{condition}.yaml", least_gap_h: 20, most_gap_h: 28 }
  - { name: day2, experiment: "{condition}.yaml", needs: [{ column: outcome, is: held, at_least: 0.5 }] }
"""
FACTS = ["--age", "24", "--handedness", "right", "--fact", "vision=normal"]


class Studies(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        text = pathlib.Path("experiments/first-trials.yaml").read_text().replace("../", os.getcwd() + "/")
        text = re.sub(r"repeats: \d+", "repeats: 1", text)
        for name in ["short", "light", "heavy"]:
            pathlib.Path(self.folder, name + ".yaml").write_text(re.sub("^title: .*", f"title: {name}", text, flags=re.M))
        self.study = self.write(STUDY)

    def write(self, text):
        file = pathlib.Path(self.folder, "study.yaml")
        file.write_text(text)
        return str(file)

    def participant(self, action, *arguments):
        return dihaptic("participant", action, self.study, *arguments)

    def add(self, id, *facts):
        result = self.participant("add", id, *(facts or FACTS))
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def simulate(self, id, *arguments):
        return dihaptic("run", self.study, "--participant", id, "--simulate", *arguments)

    def refused(self, result, *words):
        self.assertEqual(result.returncode, 2, result.stdout)
        for word in words:
            self.assertIn(word, result.stderr + result.stdout)

    def log(self):
        with open(self.folder + "/log.csv") as file:
            return [(row["action"], row["participant"]) for row in csv.DictReader(file)]

    def test_participants_are_allocated_in_turn_and_the_first_one_freezes_the_files(self):
        said = self.add("S01")
        self.assertIn("frozen as version 1", said)
        self.assertIn("S01 added, group gradual, number 1: 1 of 4 participants", said)
        self.assertIn("S02 added, group abrupt, number 1", self.add("S02"))
        listed = self.participant("list").stdout
        self.assertRegex(listed, r"S02 +abrupt +next: familiar\n")
        self.assertRegex(listed, r"group gradual +1 of 2\n")
        self.assertEqual(self.log(), [("version", "S01"), ("add", "S01"), ("add", "S02")])
        self.add("S03"), self.add("S04")
        self.refused(self.participant("add", "S05", *FACTS), "all 4 places are taken", "raise 'people'")

    def test_who_does_not_meet_the_criteria_is_not_added(self):
        result = self.participant("add", "S01", "--age", "17", "--handedness", "left", "--fact", "vision=normal")
        self.assertEqual(result.returncode, 1)
        self.assertIn("age is 17; at least 18 is required; handedness is left, not right", result.stdout)
        self.assertEqual(self.log(), [("not included", "S01")])
        self.assertNotIn("S01", self.participant("list").stdout)

    def test_names_are_kept_in_a_file_of_their_own_that_only_its_owner_reads(self):
        with tempfile.TemporaryDirectory() as elsewhere:
            key = elsewhere + "/names.csv"
            named = ["--name", "Ada, Countess", "--contact", "ada@example.org", "--key", key]
            self.add("S01", *FACTS, *named)
            self.assertEqual(os.stat(key).st_mode & 0o777, 0o600)
            self.add("S02", *FACTS, "--name", "Mary", "--key", key)
            self.assertEqual(os.stat(key).st_mode & 0o777, 0o600)
            shown = self.participant("show", "S01", "--key", key).stdout
            self.assertRegex(shown, r"name +Ada, Countess\n +contact +ada@example.org\n")
            self.assertNotIn("Ada", self.participant("show", "S01").stdout)
            for file in pathlib.Path(self.folder).rglob("*"):
                self.assertNotIn("Ada", file.read_text() if file.is_file() else "")
            with open(key, "a") as table:
                table.write("S03,Eve,\n")
            self.refused(self.participant("add", "S03", *FACTS, *named), "already belongs to a name")
            pathlib.Path(key).write_text(pathlib.Path(key).read_text().replace("S03,Eve,\n", ""))
            os.chmod(key, 0o644)
            self.refused(self.participant("show", "S01", "--key", key), "others can read it", "chmod 600")
            os.chmod(key, 0o600)
            said = self.participant("withdraw", "S01", "--keep-data", "--key", key)
            self.assertEqual(said.returncode, 0, said.stderr)
            self.assertIn("the name is deleted", said.stdout)
            self.assertEqual(pathlib.Path(key).read_text(), "participant,name,contact\nS02,Mary,\n")
            other = pathlib.Path(elsewhere, "other.csv")
            other.write_text("a,b\n1,2\n")
            other.chmod(0o600)
            self.refused(self.participant("show", "S01", "--key", str(other)), "not a key file")
        within = self.folder + "/names.csv"
        self.refused(self.participant("add", "S03", *FACTS, "--name", "Eve", "--key", within), "in the study's folder")
        self.assertNotIn("S03", self.participant("list").stdout)
        self.assertNotEqual(self.participant("add", "S03", *FACTS, "--name", "Eve").returncode, 0)

    def test_a_name_a_missing_fact_and_an_unknown_one_are_refused(self):
        self.refused(self.participant("add", "Anna", *FACTS), "may be a person's name")
        self.refused(self.participant("add", "S01", "--age", "24"), "lacks 'vision'", "--fact vision=VALUE")
        self.refused(self.participant("add", "S01", *FACTS, "--fact", "shoe=43"), "not a fact that the study asks for")
        self.refused(self.participant("add", "S01", *FACTS[:-1], "vision=poor"), "Known: normal, corrected")
        self.add("S01")
        self.refused(self.participant("add", "S01", *FACTS), "added already")

    def test_sessions_follow_each_other_in_the_participants_own_order(self):
        for id, order in {"S01": ["light", "heavy"], "S02": ["light", "heavy"], "S03": ["heavy", "light"]}.items():
            self.add(id)
            for session, title in zip(["familiar", "day1", "day2"], ["short", *order]):
                result = self.simulate(id)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertIn(f": {session}\n{title}\n", result.stdout)
            self.refused(self.simulate(id), "has completed all 3 sessions")
        (folder,) = glob.glob(self.folder + "/rehearsal/sessions/S03/day1/*/")
        text = pathlib.Path(folder, "session.yaml").read_text()
        for line in ["study: Two days", "version: 1", "group: gradual", "number: 2", "session: day1", "condition: heavy"]:
            self.assertIn(line, text)
        self.assertRegex(self.participant("list").stdout, r"S03 +gradual +next: familiar\n")  # simulated sessions are ignored

    @soak.alone
    def test_every_participant_and_session_has_a_seed_of_its_own(self):
        seeds = set()
        for id in ["S01", "S02"]:
            self.add(id)
            for _ in range(2):
                self.assertEqual(self.simulate(id).returncode, 0)
        for file in glob.glob(self.folder + "/rehearsal/sessions/*/*/*/session.yaml"):
            seeds.add(re.search(r"^seed: (\d+)", pathlib.Path(file).read_text(), flags=re.M)[1])
        self.assertEqual(len(seeds), 4)

    def test_a_changed_file_is_refused_until_it_is_accepted(self):
        self.add("S01")
        file = pathlib.Path(self.folder, "short.yaml")
        file.write_text("# a comment changes nothing\n" + file.read_text())
        self.assertEqual(self.simulate("S01").returncode, 0)
        light = pathlib.Path(self.folder, "light.yaml")
        light.write_text(light.read_text().replace("repeats: 1", "repeats: 2"))
        self.refused(self.simulate("S01"), "has changed since version 1", "light.yaml", "repeats: 1 there, 2 now",
                     "participant accept")
        self.refused(self.participant("add", "S02", *FACTS), "has changed since version 1")
        accepted = self.participant("accept", "--why", "more trials")
        self.assertEqual(accepted.returncode, 0, accepted.stderr)
        self.assertIn("version 2", accepted.stdout)
        self.assertEqual(self.simulate("S01").returncode, 0)
        self.refused(self.participant("accept", "--why", "again"), "has not changed")
        self.write(STUDY.replace("at_least: 18", "at_least: 21"))
        self.refused(self.participant("add", "S02", *FACTS), "the study's file", "18 there, 21 now")

    def test_a_session_whose_needs_are_not_met_begins_only_despite_them(self):
        self.write(STUDY.replace("is: held, at_least: 0.5", "is: flown, at_least: 0.5"))
        self.add("S01")
        for _ in range(2):
            self.assertEqual(self.simulate("S01").returncode, 0)
        self.refused(self.simulate("S01"), "may not begin day2", "share of outcome = flown is 0 in", "--despite REASON")
        result = self.simulate("S01", "--despite", "pilot")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("WARNING: day2 begins despite", result.stderr)
        self.assertIn(("simulate despite", "S01"), self.log())

    @soak.alone
    def test_without_devices_nobody_takes_part(self):
        self.add("S01")
        self.refused(dihaptic("run", self.study, "--participant", "S01"), "no person can take part", "--simulate")
        self.refused(dihaptic("run", self.study, "--simulate"), "Add e.g. --participant S07")
        self.refused(self.simulate("S09"), "has not been added", "participant add")

    def test_who_withdraws_leaves_the_place_to_the_next(self):
        self.add("S01"), self.add("S02"), self.add("S03")
        recording = pathlib.Path(self.folder, "sessions", "S01", "familiar", "one")
        recording.mkdir(parents=True)
        missing = self.participant("withdraw", "S01")
        self.assertNotEqual(missing.returncode, 0)
        self.assertIn("--keep-data", missing.stderr)
        result = self.participant("withdraw", "S01", "--delete-data", "--reason", "moved away")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertFalse(recording.exists())
        self.assertIn("S04 added, group gradual, number 1", self.add("S04"))
        self.assertRegex(self.participant("list").stdout, r"S01 +gradual +withdrew \d{4}-\d\d-\d\d, data deleted\n")
        self.assertIn("moved away", self.participant("show", "S01").stdout)
        self.refused(self.simulate("S01"), "withdrew on")
        self.refused(self.participant("withdraw", "S01", "--keep-data"), "withdrew on")

    def test_concealed_groups_are_in_no_answer_and_no_file(self):
        self.write(STUDY + "allocation: { method: blocks, seed: 3, concealed: yes }\n")
        said = "".join(self.add(id) for id in ["S01", "S02", "S03", "S04"])
        said += self.participant("list").stdout + self.participant("show", "S02").stdout + self.simulate("S01").stdout
        for name in ["participants.yaml", "log.csv"]:
            said += pathlib.Path(self.folder, name).read_text()
        (folder,) = glob.glob(self.folder + "/rehearsal/sessions/S01/familiar/*/")
        said += pathlib.Path(folder, "session.yaml").read_text()
        self.assertNotRegex(said, "gradual|abrupt")
        self.assertEqual(len(re.findall(r"group: arm [0-9a-f]{4}\n", said)), 5)

    def rows(self, name, folder="rehearsal/tables"):
        with open(f"{self.folder}/{folder}/{name}") as file:
            return list(csv.DictReader(file))

    def test_a_rehearsal_fills_the_groups_and_its_tables_have_every_session(self):
        result = dihaptic("rehearse", self.study, "--jobs", "2")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("4 people in 2 groups, 4 to do", result.stdout)
        collected = dihaptic("collect", self.study, "--rehearsed", self.folder + "/rehearsal")
        self.assertEqual(collected.returncode, 0, collected.stderr)
        self.assertIn("12 sessions of 4 people", collected.stdout)
        people = self.rows("participants.csv")
        self.assertEqual(sorted(row["group"] for row in people), ["abrupt", "abrupt", "gradual", "gradual"])
        self.assertTrue(all(int(row["age"]) >= 18 and row["handedness"] == "right" for row in people), people)
        trials = self.rows("trials.csv")
        sessions = {(row["id"], row["study_session"], row["study_condition"]) for row in trials}
        orders = {"1": ["light", "heavy"], "2": ["heavy", "light"]}
        for row in people:
            for session, condition in zip(["familiar", "day1", "day2"], ["", *orders[row["number"]]]):
                self.assertIn((row["id"], session, condition), sessions)
        self.assertEqual(len(sessions), 12)
        # an interrupted rehearsal can be continued: the missing session is made again, identical to the byte
        lost = self.folder + "/rehearsal/sessions/sim-002/day2/rehearsed"
        was = pathlib.Path(lost, "trials.csv").read_bytes()
        shutil.rmtree(lost)
        short = dihaptic("collect", self.study, "--rehearsed", self.folder + "/rehearsal")
        self.assertIn("missing: day2 of sim-002", short.stdout)
        self.assertIn("4 people in 2 groups, 1 to do", dihaptic("rehearse", self.study).stdout)
        self.assertEqual(pathlib.Path(lost, "trials.csv").read_bytes(), was)
        self.refused(dihaptic("rehearse", self.study, "--seed", "2"), "has another rehearsal", "1 there, 2 now")
        self.refused(dihaptic("rehearse", self.study, "--people", "5", "--out", self.folder + "/more"),
                     "all 4 places are taken")
        self.refused(dihaptic("rehearse", self.study, "--slurm", "2"), "not possible for a study")

    def test_who_does_not_meet_the_needs_stops_in_a_rehearsal_too(self):
        self.write("title: Two days\ngroups: [{ name: all, people: 2 }]\nsessions:\n"
                   "  - { name: day1, experiment: short.yaml }\n"
                   "  - { name: day2, experiment: heavy.yaml, needs: [{ column: outcome, is: declined, at_least: 1 }] }\n"
                   "  - { name: day3, experiment: heavy.yaml }\n")
        result = dihaptic("rehearse", self.study)
        self.assertEqual(result.returncode, 0, result.stderr)
        why = r"the share of outcome = declined is 0 in \d+ trials; at least 1 is required"
        self.assertRegex(result.stdout, f"sim-002 stops before day2: {why}\ncomplete: ")
        self.assertIn("0 to do", dihaptic("rehearse", self.study).stdout)
        collected = dihaptic("collect", self.study, "--rehearsed", self.folder + "/rehearsal").stdout
        self.assertRegex(collected, f"missing: day2 of sim-001, who may not begin it: {why}\nmissing: day3 of sim-001\n")

    @soak.alone
    def test_a_study_is_exported_as_a_whole(self):
        self.write("title: Lifts\nabout: How people lift.\ngroups: [{ name: a, people: 1 }, { name: b, people: 1 }]\n"
                   "facts: [{ name: vision, values: [normal, corrected] }, { name: program }]\n"
                   "sessions: [{ name: day1, experiment: short.yaml }, { name: day2, experiment: heavy.yaml }]\n")
        result = dihaptic("rehearse", self.study, "--jobs", "2")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        rehearsed = ["--rehearsed", self.folder + "/rehearsal"]
        self.refused(dihaptic("report", self.study), "has no session yet", "--rehearsed")
        said = dihaptic("report", self.study, *rehearsed)
        self.assertIn("rehearsal/sessions/report.html", said.stdout)
        self.assertIn("of 4 sessions", said.stdout)
        data = self.folder + "/bids"
        # the recordings of a rehearsal are not kept, but its tables are
        self.refused(dihaptic("export", self.study, "--bids", data, *rehearsed), "raw.log")
        tables = self.folder + "/share/tables"
        said = dihaptic("export", self.study, "--psych-ds", tables + "/", *rehearsed)
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertIn("4 sessions of 2 people", said.stdout)
        self.check_psych_ds(pathlib.Path(tables))
        self.refused(dihaptic("export", self.study, "--psych-ds", tables, *rehearsed), "exists")
        self.refused(dihaptic("export", self.study, "--psych-ds", self.folder + "/none"), "would contain no data")
        self.refused(dihaptic("export", self.study, "--csv", "grip_force"), "curves of one session")
        # only a participant's new sessions are added
        result = dihaptic("rehearse", self.study, "--jobs", "2", "--keep-recordings", "--out", self.folder + "/kept")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        for session, added in [(None, 4), (None, 0)]:
            said = dihaptic("export", self.study, "--bids", data, "--rehearsed", self.folder + "/kept")
            self.assertEqual(said.returncode, 0, said.stderr)
            self.assertRegex(said.stdout, rf"{added} recordings added to .*; the study has 4 sessions of 2 people")
        self.assertEqual(len(glob.glob(data + "/sub-*/ses-*/motion/*_events.tsv")), 4)
        with open(data + "/participants.tsv", newline="") as file:
            people = list(csv.DictReader(file, delimiter="\t"))
        dihaptic("collect", self.study, "--rehearsed", self.folder + "/kept")
        own = {row["id"]: row["vision"] for row in self.rows("participants.csv", "kept/tables")}
        self.assertEqual({p["participant"]: p["vision"] for p in people}, own)
        self.assertEqual({p["fact_program"].isdigit() for p in people}, {True})  # `program` is a column of BIDS
        described = json.loads(pathlib.Path(data, "participants.json").read_text())
        self.assertEqual(set(people[0]) - set(described), set())
        session = glob.glob(self.folder + "/kept/sessions/*/day1/*")[0]
        self.refused(dihaptic("export", session, "--psych-ds", self.folder + "/none"), "not a study's file")

    def check_psych_ds(self, folder):
        """The rules of Psych-DS: names of files, and that every column is described and every description has a column."""
        description = json.loads((folder / "dataset_description.json").read_text())
        self.assertEqual((description["@type"], description["@context"]), ("Dataset", "https://schema.org/"))
        self.assertEqual(description["name"], "Simulation: Lifts")
        self.assertEqual(description["description"], "How people lift.")
        for name in ["README.md", "CHANGES.md"]:
            self.assertTrue((folder / name).is_file())
        files = sorted((folder / "data").glob("*.csv"))
        self.assertIn("study-study_description-trials_data.csv", [file.name for file in files])
        everywhere = set()
        for file in files:
            self.assertRegex(file.name, r"^([a-z]+-[a-zA-Z0-9]+)(_[a-z]+-[a-zA-Z0-9]+)*_data\.csv$")
            with file.open(newline="") as table:
                rows = list(csv.reader(table))
            self.assertEqual({len(row) for row in rows}, {len(rows[0])}, file.name)
            self.assertEqual(len(set(rows[0])), len(rows[0]), file.name)
            variables = json.loads(file.with_suffix(".json").read_text())["variableMeasured"]
            self.assertEqual([v["name"] for v in variables], rows[0])
            for variable in variables:
                self.assertEqual(variable["@type"], "PropertyValue")
                self.assertTrue(variable.get("description"), f"{file.name}: {variable['name']}")
            everywhere |= set(rows[0])
        self.assertEqual({v["name"] for v in description["variableMeasured"]}, everywhere)

    @soak.alone
    def test_a_resumed_session_is_exported_with_all_its_parts(self):
        self.write("title: Lifts\ngroups: [{ name: a, people: 1 }]\nsessions: [{ name: day1, experiment: long.yaml }]\n")
        text = pathlib.Path("experiments/grip-and-lift.yaml").read_text().replace("../", os.getcwd() + "/")
        pathlib.Path(self.folder, "long.yaml").write_text(text)
        self.assertEqual(self.participant("add", "S01", "--age", "30").returncode, 0)
        arguments = ["run", self.study, "--participant", "S01", "--simulate"]
        with subprocess.Popen([PROGRAM, *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as running:
            wait_for_log(self.folder + "/rehearsal/sessions/S01/day1", 3_000_000)
            running.send_signal(signal.SIGINT)
            running.communicate(timeout=120)
        result = dihaptic(*arguments)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        parts = sorted(glob.glob(self.folder + "/rehearsal/sessions/S01/day1/*"))
        self.assertEqual(len(parts), 2)
        shutil.copy(self.folder + "/participants.yaml", self.folder + "/rehearsal")
        data = self.folder + "/data"
        said = dihaptic("export", self.study, "--bids", data, "--rehearsed", self.folder + "/rehearsal")
        self.assertIn("2 recordings added", said.stdout, said.stderr)
        self.assertEqual(dihaptic("collect", self.study, "--rehearsed", self.folder + "/rehearsal").returncode, 0)
        tables = {}
        for name in ["trials", "lifts"]:
            with open(f"{self.folder}/rehearsal/tables/{name}.csv") as file:
                tables[name] = sorted((int(r["trial_num"]), int(r["attempt"])) for r in csv.DictReader(file))
        self.assertEqual(tables["lifts"], tables["trials"])
        # an attempt that was interrupted and repeated is taken from the second part
        grips = []
        for lifts in [f"{self.folder}/rehearsal/tables/lifts.csv", parts[1] + "/lifts.csv"]:
            with open(lifts) as file:
                grips.append({(r["trial_num"], r["attempt"]): r["peak_grip_N"] for r in csv.DictReader(file)})
        self.assertGreater(len(grips[1]), 0)
        self.assertLessEqual(grips[1].items(), grips[0].items())
        exported = 0
        for file in glob.glob(data + "/sub-*/ses-*/motion/*events.tsv"):
            with open(file) as events:
                exported += sum(1 for e in csv.DictReader(events, delimiter="\t") if e["trial_type"] == "trial")
        self.assertGreaterEqual(exported, len(tables["trials"]))

    @soak.alone
    def test_what_was_learned_slowly_is_there_on_the_next_day(self):
        text = pathlib.Path("experiments/rotation-reversal.yaml").read_text().replace("../", os.getcwd() + "/")
        for name, repeats in {"long": ["4", "60", "1", "2"], "brief": ["2", "6", "1", "2"]}.items():
            for old, new in zip(["64", "160", "16", "48"], repeats):
                self.assertIn(f"repeats: {old} ", text)
            numbers = dict(zip(["64", "160", "16", "48"], repeats))
            pathlib.Path(self.folder, name + ".yaml").write_text(
                re.sub(r"repeats: (\d+)", lambda found: "repeats: " + numbers[found[1]], text))
        self.write("title: Retention\ngroups: [{ name: all, people: 4 }]\nsessions:\n"
                   "  - { name: day1, experiment: long.yaml }\n  - { name: day2, experiment: brief.yaml }\n")
        self.assertEqual(dihaptic("rehearse", self.study, "--keep-recordings").returncode, 0)
        for session in sorted(glob.glob(self.folder + "/rehearsal/sessions/sim-001/*/rehearsed")):
            exported = dihaptic("export", session, "--bids", self.folder + "/set")  # the same person on both days
            self.assertEqual(exported.returncode, 0, exported.stderr)
        self.assertEqual(dihaptic("collect", self.study, "--rehearsed", self.folder + "/rehearsal").returncode, 0)
        first = {"day1": [], "day2": []}
        for row in self.rows("adaptation.csv"):
            if row["trial_num"] == "1":
                first[row["study_session"]].append(float(row["compensation"]))
        self.assertEqual([len(values) for values in first.values()], [4, 4])
        # without memory, both days would begin at 0, within the noise of a movement (about 4 degrees)
        self.assertLess(abs(sum(first["day1"]) / 4), 6)
        self.assertGreater(sum(first["day2"]) / 4, 10)

    @soak.alone
    def test_groups_may_be_a_fact_of_the_person(self):
        self.write(STUDY.replace("values: [normal, corrected]", "values: [gradual, abrupt]") +
                   "allocation: { method: fact, fact: vision }\n")
        facts = FACTS[:-1]
        self.assertIn("group abrupt, number 1", self.add("S01", *facts, "vision=abrupt"))
        self.assertIn("group abrupt, number 2", self.add("S02", *facts, "vision=abrupt"))
        self.refused(self.participant("add", "S03", *facts, "vision=abrupt"), "all 2 places of the group abrupt are taken")
        self.write(STUDY + "allocation: { method: fact, fact: vision }\n")
        self.refused(dihaptic("check", self.study), "are not the names of the groups",
                     "values: [gradual, abrupt]")

    def test_a_fact_that_tells_a_concealed_group_is_in_no_recording(self):
        self.write(STUDY.replace("values: [normal, corrected] }", "values: [gradual, abrupt] }, { name: lens }") +
                   "allocation: { method: fact, fact: vision, concealed: yes }\n")
        self.add("S01", *FACTS[:-1], "vision=abrupt", "--fact", "lens=2")
        self.assertEqual(self.simulate("S01").returncode, 0)
        (folder,) = glob.glob(self.folder + "/rehearsal/sessions/S01/familiar/*/")
        session = pathlib.Path(folder, "session.yaml").read_text()
        self.assertIn("name: lens", session)
        self.assertNotIn("abrupt", session)

    def test_a_recording_that_cannot_be_read_is_not_passed_over(self):
        self.add("S01"), self.add("S02")
        self.assertEqual(self.simulate("S01").returncode, 0)
        (folder,) = glob.glob(self.folder + "/rehearsal/sessions/S01/familiar/*/")
        info = pathlib.Path(folder, "session.yaml")
        whole = info.read_text()
        for old, new, said in [("state: complete", "state: [", "session.yaml"), ("id: sim-S01", "id: S02", "is 'S02', not S01"),
                               ("started: ", "started: long ago #", "is not a time")]:
            self.assertIn(old, whole)
            info.write_text(whole.replace(old, new, 1))
            self.refused(self.simulate("S01"), said)
        info.unlink()
        self.refused(self.simulate("S01"), folder.rstrip("/"))
        info.write_text(whole)
        self.assertIn(": day1\n", self.simulate("S01").stdout)

    def test_a_session_that_was_killed_is_resumed_and_one_that_runs_is_left_alone(self):
        self.write(STUDY.replace("short.yaml", "slow.yaml"))
        text = pathlib.Path(self.folder, "short.yaml").read_text()
        pathlib.Path(self.folder, "slow.yaml").write_text(text.replace("repeats: 1", "repeats: 12"))
        self.add("S01")
        command = [PROGRAM, "run", self.study, "--participant", "S01", "--simulate"]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        wait_for_log(self.folder + "/rehearsal/sessions/S01/familiar", 500_000)
        self.refused(self.simulate("S01"), "may not begin familiar", "is running now")
        process.kill()
        process.wait()
        result = self.simulate("S01")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("was killed: it is recovered", result.stdout)
        self.assertIn("familiar is resumed", result.stdout)
        self.assertIn(": day1\n", self.simulate("S01").stdout)

    def test_nothing_is_deleted_through_a_link_or_by_a_changed_roster(self):
        self.add("S01")
        roster = pathlib.Path(self.folder, "participants.yaml")
        whole = roster.read_text()
        for old, new, said in [("id: S01", "id: ..", "is not an identifier"), ("study: Two days", "study: Other", "is 'Other'"),
                               ("participants:\n", "participants:\n" + whole[whole.index("  - id"):], "is listed twice")]:
            roster.write_text(whole.replace(old, new, 1))
            self.refused(self.participant("withdraw", new.split()[-1] if "id:" in new[:4] else "S01", "--delete-data"), said)
        roster.write_text(whole)
        os.makedirs(self.folder + "/elsewhere/familiar")
        os.mkdir(self.folder + "/sessions")
        os.symlink(self.folder + "/elsewhere", self.folder + "/sessions/S01")
        self.refused(self.participant("withdraw", "S01", "--delete-data"), "is a link")
        self.assertTrue(os.path.isdir(self.folder + "/elsewhere/familiar"))
        self.assertEqual(roster.read_text(), whole)

    def test_nothing_is_done_that_the_log_cannot_tell(self):
        self.add("S01")
        log = pathlib.Path(self.folder, "log.csv")
        log.write_bytes(log.read_bytes().rstrip(b"\n"))  # as an editor may leave the last line
        self.add("S02")
        self.assertEqual(self.log(), [("version", "S01"), ("add", "S01"), ("add", "S02")])
        log.unlink()
        log.mkdir()
        self.refused(self.participant("add", "S03", *FACTS), "log.csv")
        self.assertNotIn("S03", self.participant("list").stdout)

    @soak.alone
    def test_lost_versions_and_options_that_change_a_session_are_told(self):
        self.add("S01")
        for option in [["--set", "coupling.stiffness_N_m=100"], ["--seed", "5"], ["--age", "99"], ["--out", "x"]]:
            self.refused(self.simulate("S01", *option), option[0], "not possible for a study")
        os.remove(self.folder + "/versions.yaml")
        self.refused(self.simulate("S01"), "has no version, though there are participants")
        self.refused(self.participant("add", "S02", *FACTS), "has no version, though there are participants")
        self.refused(self.participant("accept", "--why", "lost"), "has no version, though there are participants")

    @soak.alone
    def test_twenty_people_who_are_added_at_once_have_twenty_places(self):
        self.write(STUDY.replace("people: 2", "people: 10"))
        self.add("S00")
        added = [subprocess.Popen([PROGRAM, "participant", "add", self.study, f"S{n:02}", *FACTS], stdout=subprocess.DEVNULL)
                 for n in range(1, 20)]
        self.assertEqual([process.wait() for process in added], [0] * 19)
        self.assertIn("20 of 20 participants", self.participant("list").stdout)
        self.assertEqual(len(self.log()), 21)

    def test_a_broken_study_names_each_fault(self):
        for old, new, words in [
            ("name: gradual", "name: abrupt", "'abrupt' is listed twice"),
            ("people: 2 }, ", "people: 0 }, ", "people"),
            ("name: day1", "name: day 1", "'day 1' is not a name"),
            ("least_gap_h: 20", "least_gap_h: 30", "is greater than most_gap_h"),
            ("conditions: [light, heavy]", "conditions: [light]", "but 2 sessions name {condition}"),
            ("short.yaml", "long.yaml", "long.yaml does not exist"),
            ("short.yaml", "{day}.yaml", "a placeholder that is not known"),
            ("fact: age", "fact: shoe", "'shoe' is not a fact of this study. Known: age, sex, handedness, vision"),
            ("handedness, is: [right]", "handedness, at_least: 3", "'handedness' is not a number"),
            ("facts:", "allocation: { method: minimisation }\nfacts:", "over: is missing"),
            ("facts:", "allocation: { method: minimisation, over: [age] }\nfacts:", "'age' is a number"),
            ("at_least: 18", "at_least: 18, at_most: 17", "is greater than at_most"),
            ("is: [right]", "is: [straight]", "'straight' is not a value of handedness. Known: right, left, both"),
            ("is: held, at_least", "at_least", "an outcome is a text"),
            ("at_least: 0.5", "at_least: 50", "is a share of trials"),
            ("facts:", "allocation: { method: blocks, block: 3 }\nfacts:", "Use a multiple of 2"),
            ("facts: [{ name: vision", "facts: [{ name: group, values: [a, b] }, { name: vision",
             "'group' is another column of participants.csv"),
        ]:
            with self.subTest(new):
                self.assertIn(old, STUDY)
                self.write(STUDY.replace(old, new, 1))
                self.refused(dihaptic("check", self.study), "study.yaml:", words)
        self.write(STUDY)
        result = dihaptic("check", self.study)
        self.assertEqual(result.returncode, 0, result.stderr)


if __name__ == "__main__":
    unittest.main()
