"""A BIDS data set, judged by BIDS' own validator and read as a stranger would: without the sessions that it was made of.

Usage: bids_test.py PROGRAM BUILD, from the project's folder. The validator (npm, test/bids_validator.json) is installed into BUILD
once; where that is not possible the test that needs it says so.
"""
import base64
import csv
import glob
import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import unittest

import soak
from patience import patient

BUILD = sys.argv.pop(2) if len(sys.argv) > 2 else "build/release"
PROGRAM = sys.argv.pop(1) if len(sys.argv) > 1 else "build/release/dihaptic"

REACHES = """title: Reaches, turned
scene: scene.yaml
hand: { centre_mm: [0, 0, 120] }
study: { experimenters: ["Doe, J.", "Roe, R."], institution: University, keywords: [reaching] }
task:
  regions:
    - { name: start, position_mm: [0, 0, 120], radius_mm: 6 }
    - { name: target, position_mm: [50, 0, 120], radius_mm: 6 }
  perturbations:
    - name: rotation
      hed: "Experimental-stimulus, Unexpected"
      visual: { moves: [proxies], about: start, axis: [0, 0, 1], angle_deg: 30 }
  states:
    - name: home
      show: [start]
      perturbed: no
      exits: [{ when: inside, region: start, hold_s: 0.1, to: reach }, { when: time, after_s: 6, outcome: lost, redo: yes }]
      simulated_hand: [{ duration_s: 0.2, reach: start }]
    - name: reach
      show: [target]
      hed: "Sensory-event, Visual-presentation, Go-signal"
      exits:
        - { when: inside, region: target, outcome: reached, hed: "Agent-action, Correct-action" }
        - { when: time, after_s: 3, outcome: too slow }
      simulated_hand: [{ duration_s: 0.2, reach: target }]
  reach: { from: start, to: target, during: reach, distance_mm: 30, axis: [0, 0, 1] }
  conditions: [{ name: near }, { name: far, regions: [{ name: target, position_mm: [60, 0, 120], radius_mm: 6 }],
      perturbations: [{ name: rotation, hed: Distractor, visual: { moves: [proxies], about: start, axis: [0, 0, 1], angle_deg: 30 } }] }]
  blocks:
    - { name: before, kind: baseline, repeats: 1 }
    - { name: turned, kind: perturbed, perturb: rotation, repeats: 2 }
"""
SCENE = """bodies:
  - { name: floor, shape: plane, fixed: yes }
  - { name: block, shape: box, size_mm: [40, 40, 40], mass_g: 100, position_mm: [0, 200, 20] }
fingers:
  - { name: index, shape: sphere, radius_mm: 6, mass_g: 1 }
"""


def dihaptic(*arguments, code=0):
    result = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=patient(300))
    assert result.returncode == code, result.stdout + result.stderr
    return result.stdout + result.stderr


def table(path):
    with open(path) as file:
        return list(csv.DictReader(file, delimiter="\t"))


def validator():
    """The validator's script, installed if need be. Raises SkipTest where it cannot be had.

    Only the package itself: what it needs is bundled in it, and its 900 dependencies are those of its own development.
    """
    folder = pathlib.Path(BUILD, "bids_validator").resolve()
    script = folder / "node_modules/bids-validator/bin/bids-validator"
    if script.exists():
        return str(script)
    lock = json.loads(pathlib.Path("test/bids_validator.json").read_text())
    for program in ["node", "npm"]:
        if shutil.which(program) is None:
            raise unittest.SkipTest(program + " is absent: nobody but our own tests has looked at the data set")
    folder.mkdir(parents=True, exist_ok=True)
    try:
        packed = subprocess.run(["npm", "pack", f"{lock['package']}@{lock['version']}", "--json"], cwd=folder, capture_output=True,
                                text=True, timeout=600)
    except subprocess.TimeoutExpired:
        raise unittest.SkipTest("npm gave no answer in ten minutes: nobody but our own tests has looked at the data set")
    if packed.returncode != 0:
        raise unittest.SkipTest("npm could not get bids-validator: " + packed.stderr[-300:])
    archive = folder / json.loads(packed.stdout)[0]["filename"]
    found = "sha512-" + base64.b64encode(hashlib.sha512(archive.read_bytes()).digest()).decode()
    assert found == lock["integrity"], f"{archive} is not what test/bids_validator.json names"
    with tarfile.open(archive) as tar:
        tar.extractall(folder / "unpacked")
    archive.unlink()
    (folder / "node_modules").mkdir(exist_ok=True)
    (folder / "unpacked/package").rename(folder / "node_modules/bids-validator")
    return str(script)


class DataSets(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.out = folder.name
        pathlib.Path(cls.out, "scene.yaml").write_text(SCENE)
        cls.reaches = cls.out + "/reach-turned.yaml"
        pathlib.Path(cls.reaches).write_text(REACHES)
        # simulated people who do trials, and a script that lifts a block
        cls.sessions = [cls.run_session(cls.reaches, "--simulate", "--participant", person) for person in ["sim-001", "sim-002"]]
        cls.sessions.append(cls.run_session("experiments/lift-block.yaml", "--participant", "sim-001"))
        cls.set = cls.out + "/study"
        for session in cls.sessions:
            dihaptic("export", session, "--bids", cls.set)

    @classmethod
    def run_session(cls, *arguments):
        said = dihaptic("run", *arguments, "--out", cls.out + "/sessions")
        return said.split("session: ")[1].split("\n")[0]

    def events(self):
        return table(glob.glob(self.set + "/sub-sim001/motion/*reachturned*events.tsv")[0])

    def test_the_validator_finds_no_error(self):
        checked = subprocess.run(["node", validator(), self.set, "--json"], capture_output=True, text=True, timeout=300)
        issues = json.loads(checked.stdout)["issues"]
        self.assertEqual([(i["key"], [f["evidence"] for f in i["files"]][:3]) for i in issues["errors"]], [])
        # one of these people also did another task; and the validator takes the first line of motion.tsv for a header,
        # although by BIDS this file has none
        self.assertLessEqual({i["key"] for i in issues["warnings"]}, {"INCONSISTENT_SUBJECTS", "CUSTOM_COLUMN_WITHOUT_DESCRIPTION"})

    def test_it_says_that_it_is_a_simulation(self):
        description = json.loads(pathlib.Path(self.set, "dataset_description.json").read_text())
        self.assertTrue(description["Simulated"])
        self.assertEqual(description["Name"], "Simulation: Reaches, turned")
        self.assertEqual(description["Authors"], ["Doe, J.", "Roe, R."])
        self.assertIn("THIS DATA SET IS A SIMULATION", pathlib.Path(self.set, "README").read_text())
        people = table(self.set + "/participants.tsv")
        self.assertEqual([p["participant_id"] for p in people], ["sub-sim001", "sub-sim002"])
        self.assertEqual({p["simulated"] for p in people}, {"yes"})
        self.assertEqual(people[0]["moved_by"], "simulated_person,script")
        self.assertEqual(people[1]["moved_by"], "simulated_person")
        self.assertEqual(people[1]["seed"], "1")
        self.assertTrue(people[1]["program"].startswith("dihaptic"))
        self.assertEqual({e["simulated"] for e in self.events()}, {"yes"})
        for file in glob.glob(self.set + "/sub-*/motion/*motion.json"):
            self.assertIn(". Simulated: ", json.loads(pathlib.Path(file).read_text())["TaskDescription"])
        for file in glob.glob(self.set + "/sub-*/*scans.tsv"):
            self.assertEqual({row["simulated"] for row in table(file)}, {"yes"})

    def test_trials_can_be_analysed_from_it_alone(self):
        events = self.events()
        trials = [e for e in events if e["trial_type"] == "trial"]
        self.assertEqual([t["block"] for t in trials], ["before"] * 2 + ["turned"] * 4)
        self.assertEqual({t["perturbation"] for t in trials if t["block"] == "turned"}, {"rotation"})
        self.assertEqual({t["condition"] for t in trials}, {"near", "far"})
        turned = [t for t in trials if t["block"] == "turned" and t["hand_angle_deg"] != "n/a"]
        self.assertGreater(len(turned), 1)
        for t in turned:
            self.assertAlmostEqual(float(t["shown_angle_deg"]) - float(t["hand_angle_deg"]), 30, delta=0.5)
            self.assertGreater(float(t["duration"]), 0.3)
        self.assertTrue(all(t["outcome"] in ["reached", "too slow"] for t in trials))
        # the same as in the session
        with open(self.sessions[0] + "/trials.csv") as file:
            own = list(csv.DictReader(file))
        self.assertEqual([t["hand_angle_deg"] for t in trials], [t["hand_angle_deg"] or "n/a" for t in own])
        phases = [e for e in events if e["trial_type"] == "phase" and e["value"] == "reach"]
        self.assertEqual([p["block"] for p in phases], [t["block"] for t in trials])
        onsets = [float(e["onset"]) for e in events]
        self.assertEqual(onsets, sorted(onsets))
        columns = json.loads(pathlib.Path(glob.glob(self.set + "/sub-sim001/motion/*reachturned*events.json")[0]).read_text())
        self.assertEqual(sorted(columns), sorted(set(events[0]) - {"HED"}))
        self.assertEqual(columns["hand_angle_deg"]["Units"], "deg")

    def test_events_have_the_tags_of_their_kind_and_of_the_task(self):
        self.assertEqual(json.loads(pathlib.Path(self.set, "dataset_description.json").read_text())["HEDVersion"], "8.3.0")
        events = self.events()
        tags = {("phase", "reach"): "reach, (Sensory-event, Visual-presentation, Go-signal)",
                ("phase", "home"): "home",
                ("outcome", "reached"): "reached, (Agent-action, Correct-action)",
                ("outcome", "too slow"): "too-slow"}
        begun = {"near": "on, (Experimental-stimulus, Unexpected)", "far": "on, (Distractor)"}
        seen = set()
        for event in events:
            about = (event["trial_type"], event["value"])
            if about in tags:
                self.assertRegex(event["HED"], r"^Label/\d+-" + re.escape(tags[about]) + "$")
            if about == ("perturbation", "on"):
                self.assertRegex(event["HED"], r"^Label/\d+-" + re.escape(begun[event["condition"]]) + "$")
                seen.add(event["condition"])
            seen.add(about)
        self.assertLessEqual(set(begun), seen)
        tags.pop(("outcome", "too slow"))
        self.assertLessEqual(set(tags), seen)
        columns = json.loads(pathlib.Path(glob.glob(self.set + "/sub-sim001/motion/*reachturned*events.json")[0]).read_text())
        self.assertLessEqual({e["trial_type"] for e in events}, set(columns["trial_type"]["HED"]))
        self.assertEqual(set(columns["trial_type"]["HED"]), set(columns["trial_type"]["Levels"]))

    def test_the_validator_knows_the_tags(self):
        wrong = self.out + "/wrong"
        shutil.copytree(self.set, wrong)
        for file in glob.glob(wrong + "/sub-*/motion/*reachturned*events.tsv"):
            text = pathlib.Path(file).read_text()
            pathlib.Path(file).write_text(text.replace("Correct-action", "Corect-action"))
        checked = subprocess.run(["node", validator(), wrong, "--json"], capture_output=True, text=True, timeout=300)
        errors = json.loads(checked.stdout)["issues"]["errors"]
        self.assertTrue(errors and all(i["key"].startswith("HED") for i in errors), [i["key"] for i in errors])

    def test_a_lift_and_the_object_are_in_it(self):
        (events,) = glob.glob(self.set + "/sub-sim001/motion/*liftblock*events.tsv")
        (trial,) = [e for e in table(events) if e["trial_type"] == "trial"]
        self.assertEqual(trial["lift"], "complete")
        self.assertGreater(float(trial["lift_static_grip_N"]), 0.5)
        (motion,) = glob.glob(self.set + "/sub-sim001/motion/*liftblock_tracksys-objects_run-01_motion.tsv")
        channels = table(motion.replace("motion.tsv", "channels.tsv"))
        self.assertEqual({c["tracked_point"] for c in channels}, {"block", "n/a"})
        with open(motion) as file:
            rows = [[float(x) for x in line.split("\t")] for line in file]
        names = [c["name"] for c in channels]
        z = names.index("block_position_z")
        self.assertGreater(max(row[z] for row in rows) - rows[0][z], 0.09)
        self.assertEqual([c["component"] for c in channels if c["type"] == "ORNT"], ["quat_x", "quat_y", "quat_z", "quat_w"])
        self.assertAlmostEqual(rows[0][names.index("block_orientation_w")], 1)

    def test_a_session_is_added_once(self):
        said = dihaptic("export", self.sessions[0], "--bids", self.set, code=2)
        self.assertIn("is in the data set: motion/sub-sim001_task-reachturned", said)

    def test_simulations_and_persons_have_data_sets_of_their_own(self):
        persons = self.out + "/persons"
        shutil.copytree(self.set, persons)
        file = pathlib.Path(persons, "dataset_description.json")
        file.write_text(file.read_text().replace('"Simulated": true', '"Simulated": false'))
        other = self.run_session(self.reaches, "--simulate", "--participant", "sim-003")
        said = dihaptic("export", other, "--bids", persons, code=2)
        self.assertIn("does not state that the data set is a simulation, but this session is one", said)
        self.assertIn("Name another folder", said)

    def test_tables_of_others_are_kept_and_looked_at(self):
        study = self.out + "/theirs"
        shutil.copytree(self.set, study)
        people = pathlib.Path(study, "participants.tsv")
        rows = [line.split("\t") for line in people.read_text().splitlines()]
        # adds a column of theirs directly after the key
        people.write_text("".join("\t".join([row[0], "group" if i == 0 else "old", *row[1:]]) + "\n" for i, row in enumerate(rows)))
        other = self.run_session(self.reaches, "--simulate", "--participant", "sim-004")
        dihaptic("export", other, "--bids", study)
        rows = table(people)
        self.assertEqual([r["group"] for r in rows], ["old", "old", "n/a"])
        self.assertEqual([r["seed"] for r in rows], ["1", "1", "1"])
        self.assertEqual(rows[2]["participant"], "sim-004")
        # the same label for somebody else
        same = self.run_session(self.reaches, "--simulate", "--participant", "sim-0 04")
        self.assertIn("is participant sim-004 in the data set, but sim-0 04 in this session",
                      dihaptic("export", same, "--bids", study, code=2))
        seed = self.run_session(self.reaches, "--simulate", "--participant", "sim-004", "--seed", "2")
        self.assertIn("is of seed 1 in the data set, but 2 in this session", dihaptic("export", seed, "--bids", study, code=2))
        shutil.copy(self.reaches, self.out + "/reach_turned.yaml")
        task = self.run_session(self.out + "/reach_turned.yaml", "--simulate", "--participant", "sim-004")
        self.assertIn("TaskName: is reach-turned, but reach_turned would have the same label",
                      dihaptic("export", task, "--bids", study, code=2))
        people.write_text(people.read_text().replace("participant_id", "id", 1))
        task = self.run_session(self.reaches, "--simulate", "--participant", "sim-005")
        said = dihaptic("export", task, "--bids", study, code=2)
        self.assertIn("participants.tsv:1: error: id: is its first column, but BIDS expects participant_id", said)


@soak.alone
class EveryExperiment(unittest.TestCase):
    """The design and the measures of each shipped experiment, in short, are in the export alone."""

    def test_has_its_design_and_measures_in_the_export(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        data = folder.name + "/data"
        experiments = sorted(pathlib.Path("experiments").glob("*.yaml"))
        for experiment in experiments:
            with self.subTest(experiment.stem):
                text = experiment.read_text().replace("../", os.getcwd() + "/")
                for key, most in [("repeats", 3 if "insert" in text else 1), ("trials", 4), ("count", 1), ("gap", 1)]:
                    text = re.sub(rf"\b{key}: (\d+)", lambda m, most=most, key=key: f"{key}: {min(int(m[1]), most)}", text)
                short = pathlib.Path(folder.name, experiment.name)
                short.write_text(text)
                said = subprocess.run([PROGRAM, "run", str(short), "--simulate", "--out", folder.name + "/" + experiment.stem],
                                      capture_output=True, text=True, timeout=patient(600))
                self.assertIn("session: ", said.stdout, said.stdout + said.stderr)
                session = said.stdout.split("session: ")[1].split("\n")[0]
                dihaptic("export", session, "--bids", data)
                self.check(session, data, experiment.stem)
        checked = subprocess.run(["node", validator(), data, "--json"], capture_output=True, text=True, timeout=1800)
        errors = json.loads(checked.stdout)["issues"]["errors"]
        self.assertEqual([(i["key"], [f["evidence"] for f in i["files"]][:3]) for i in errors], [])

    def check(self, session, data, name):
        label = "".join(c for c in name if c.isalnum())
        (file,) = glob.glob(f"{data}/sub-*/motion/*task-{label}_run-01_events.tsv")
        exported = [e for e in table(file) if e["trial_type"] == "trial"]
        described = json.loads(pathlib.Path(file.replace(".tsv", ".json")).read_text())
        self.assertLessEqual(set(exported[0]) - {"HED"} if exported else set(), set(described))
        with open(session + "/trials.csv") as own:
            rows = list(csv.DictReader(own))
        self.assertEqual(len(exported), len(rows))
        known = {"start_time", "stop_time", "experiment", "ppid", "session_num"}  # these are in onset, duration, sub- and task-
        for column in set(rows[0]) - known if rows else ():
            self.assertIn(column, exported[0])
            self.assertEqual([e[column] for e in exported], [row[column] or "n/a" for row in rows], column)


if __name__ == "__main__":
    unittest.main(verbosity=2)
