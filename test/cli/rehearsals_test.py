"""Populations of simulated people: rehearse, collect, report.

Usage: rehearsals_test.py PROGRAM, from the project's folder.
"""
import csv
import glob
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

from program import dihaptic, with_largest_file

import soak  # program.py adds its folder to the path


class Rehearsals(unittest.TestCase):
    """Populations of simulated people, in parts and in parallel."""

    PEOPLE = ["sim-001", "sim-002", "sim-003", "sim-004"]

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        text = pathlib.Path("experiments/rotation-reversal.yaml").read_text().replace("../", os.getcwd() + "/")
        for repeats in ["64", "160", "16", "48"]:
            text = text.replace("repeats: " + repeats, "repeats: 2")
        self.experiment = self.folder + "/short.yaml"
        pathlib.Path(self.experiment).write_text(text)

    def rehearse(self, out, *arguments):
        people = [] if "--people" in arguments else ["--people", "4"]
        return dihaptic("rehearse", self.experiment, *people, "--out", out, *arguments)

    def tables(self, *folders):
        out = tempfile.mkdtemp(dir=self.folder)
        result = dihaptic("collect", *folders, "--out", out)
        self.assertEqual(result.returncode, 0, result.stderr)
        return [pathlib.Path(out + "/" + name).read_bytes() for name in ["trials.csv", "people.csv"]]

    def rows(self, folder, name):
        with open(folder + "/" + name) as file:
            return list(csv.DictReader(file))

    def test_a_session_that_a_fault_ended_is_in_no_mean(self):
        out = self.folder + "/out"
        run = lambda *arguments: dihaptic("run", self.experiment, "--simulate", "--out", out, *arguments)
        self.assertEqual(run("--participant", "sim-001").returncode, 0)
        self.assertEqual(run("--participant", "sim-002", "--set", "safety.max_speed_m_s=0.1").returncode, 1)
        (ended,) = glob.glob(out + "/*sim-002/")
        self.assertIn("state: interrupted", pathlib.Path(ended + "session.yaml").read_text())
        report = dihaptic("report", out, *soak.TABLES)
        self.assertEqual(report.returncode, 0, report.stderr)
        self.assertRegex(report.stdout, r"left out: .*sim-002: it ended before its trials were done; dihaptic resume continues it")
        self.assertEqual([row["ppid"] for row in self.rows(out, "population-people.csv")], ["sim-001"])

    def test_jobs_and_shards_give_the_same_tables_to_the_byte(self):
        whole = self.folder + "/whole"
        result = self.rehearse(whole)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("dihaptic collect " + whole, result.stdout)
        self.assertEqual(sorted(os.listdir(whole)), ["rehearsal.yaml", *self.PEOPLE])
        self.assertFalse(os.path.exists(whole + "/sim-001/raw.log"))
        parts = []
        for shard in ["1/3", "2/3", "3/3"]:
            parts.append(self.folder + "/part-" + shard[0])
            result = self.rehearse(parts[-1], "--shard", shard, "--jobs", "2")
            self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(sorted(os.listdir(parts[0])), ["rehearsal.yaml", "sim-001", "sim-004"])
        tables = self.tables(whole)
        self.assertEqual(tables, self.tables(*reversed(parts)))
        rows = list(csv.DictReader(tables[0].decode().splitlines()))
        self.assertEqual(sorted({row["ppid"] for row in rows}), self.PEOPLE)
        people = list(csv.DictReader(tables[1].decode().splitlines()))
        self.assertEqual([row["id"] for row in people], self.PEOPLE)
        self.assertEqual(len({row["slow_learning"] for row in people}), 4)

    def test_a_second_call_goes_on_with_those_that_are_missing(self):
        out = self.folder + "/out"
        self.assertEqual(self.rehearse(out).returncode, 0)
        before = self.tables(out)
        shutil.rmtree(out + "/sim-002")
        os.makedirs(out + "/unfinished-sim-003")  # as left by a killed process
        shutil.rmtree(out + "/sim-003")
        kept = os.path.getmtime(out + "/sim-001/trials.csv")
        result = self.rehearse(out)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("2 to do, 2 done before", result.stdout)
        self.assertEqual(sorted(os.listdir(out)), ["rehearsal.yaml", *self.PEOPLE])
        self.assertEqual(os.path.getmtime(out + "/sim-001/trials.csv"), kept)
        self.assertEqual(self.tables(out), before)

    def test_tells_of_sessions_that_failed(self):
        out = self.folder + "/out"
        result = dihaptic("rehearse", self.experiment, "--people", "2", "--out", out, "--keep-recordings",
                          preexec_fn=with_largest_file(500_000))
        self.assertEqual(result.returncode, 1)
        self.assertIn("sim-001: failed.", result.stderr)
        self.assertIn("cannot be written", result.stderr)
        self.assertIn("run the same command again to continue with them", result.stdout)
        self.assertEqual(self.rehearse(out).returncode, 0)

    def test_refuses_a_folder_of_another_experiment_seed_or_population(self):
        out = self.folder + "/out"
        self.assertEqual(self.rehearse(out, "--people", "1").returncode, 0)
        text = pathlib.Path(self.experiment).read_text()
        edited = self.folder + "/edited.yaml"
        pathlib.Path(edited).write_text(text.replace("angle_deg: 30", "angle_deg: 60"))
        changed = self.folder + "/population.yaml"
        pathlib.Path(changed).write_text(f"title: Others\nbased_on: {os.getcwd()}/populations/adults.yaml\n")
        for arguments, message in [
                ([edited], "another rehearsal: inputs, task.yaml, perturbations, 1, visual, angle_rad: 0.523"),
                ([self.experiment, "--seed", "9"], "another rehearsal: seed: 1 there, 9 now"),
                ([self.experiment, "--population", changed], "another rehearsal: population, title"),
                ([self.experiment, "--real-objects"], "another rehearsal: population, title")]:
            result = dihaptic("rehearse", *arguments, "--people", "2", "--out", out)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(message, result.stderr)
            self.assertEqual(sorted(os.listdir(out)), ["rehearsal.yaml", "sim-001"])
        # comments make no difference
        pathlib.Path(self.experiment).write_text("# the same\n" + text)
        self.assertEqual(self.rehearse(out, "--people", "2").returncode, 0)
        os.remove(out + "/rehearsal.yaml")
        result = self.rehearse(out)
        self.assertEqual(result.returncode, 2)
        self.assertIn("does not identify its rehearsal", result.stderr)

    def test_collect_joins_seeds_on_purpose_only(self):
        folders = [self.folder + "/one", self.folder + "/nine"]
        for folder, seed in zip(folders, ["1", "9"]):
            self.assertEqual(self.rehearse(folder, "--people", "2", "--seed", seed).returncode, 0)
        both = self.folder + "/both"
        result = dihaptic("collect", *folders, "--out", both)
        self.assertEqual(result.returncode, 2)
        self.assertIn("is a different rehearsal from " + folders[0] + ": seed: 1 there, 9 now", result.stderr)
        self.assertIn("--join-seeds", result.stderr)
        result = dihaptic("collect", *folders, "--join-seeds", "--out", both)
        self.assertEqual(result.returncode, 0, result.stderr)
        for name in ["trials.csv", "people.csv", "adaptation.csv"]:
            rows = self.rows(both, name)
            self.assertEqual({(row["seed"], row["id"]) for row in rows},
                             {(seed, person) for seed in "19" for person in self.PEOPLE[:2]}, name)
            self.assertEqual({(row["simulated"], row["moved_by"]) for row in rows}, {("yes", "simulated_person")}, name)
        pathlib.Path(self.experiment).write_text(
            pathlib.Path(self.experiment).read_text().replace("angle_deg: 30", "angle_deg: 60"))
        other = self.folder + "/other"
        self.assertEqual(self.rehearse(other, "--people", "1", "--seed", "5").returncode, 0)
        result = dihaptic("collect", folders[0], other, "--join-seeds", "--out", both)
        self.assertEqual(result.returncode, 2)
        self.assertIn("angle_rad", result.stderr)

    def test_people_are_drawn_from_a_file_of_groups(self):
        population = self.folder + "/groups.yaml"
        pathlib.Path(population).write_text(f"""title: Two groups
based_on: {os.getcwd()}/populations/adults.yaml
groups:
  - {{ name: control }}
  - name: patients
    traits:
      - {{ trait: slow_retention, median: 0.9, spread: 0, source: a guess }}
""")
        out = self.folder + "/out"
        self.assertEqual(self.rehearse(out, "--population", population).returncode, 0)
        self.assertEqual(dihaptic("collect", out).returncode, 0)
        people = self.rows(out, "people.csv")
        self.assertEqual([row["group"] for row in people], ["control", "patients"] * 2)
        self.assertEqual([round(float(row["slow_retention"]), 9) == 0.9 for row in people], [False, True] * 2)
        self.assertEqual({(row["id"], row["group"]) for row in self.rows(out, "trials.csv")},
                         {(row["id"], row["group"]) for row in people})
        # simulated alone, one of them is the same person, with the same order of trials
        result = dihaptic("run", self.experiment, "--simulate", "--participant", "sim-002", "--population", population,
                          "--out", self.folder + "/one")
        self.assertEqual(result.returncode, 0, result.stderr)
        (alone,) = glob.glob(self.folder + "/one/*/")
        for name in ["person.yaml", "trial-list.csv"]:
            self.assertEqual(pathlib.Path(alone + name).read_bytes(), pathlib.Path(out, "sim-002", name).read_bytes())
        result = dihaptic("run", self.experiment, "--population", population)
        self.assertEqual(result.returncode, 2)
        self.assertIn("--population requires --simulate", result.stderr)

    def test_people_come_from_laboratories_in_turn(self):
        out = self.folder + "/out"
        self.assertEqual(self.rehearse(out, "--laboratories", "2").returncode, 0)
        self.assertIn("--laboratories 2", pathlib.Path(out, "rehearsal.yaml").read_text())
        self.assertEqual(dihaptic("collect", out).returncode, 0)
        people = self.rows(out, "people.csv")
        self.assertEqual([row["laboratory"] for row in people], ["1", "2"] * 2)
        # without the option, the same people come from a median laboratory
        result = self.rehearse(out)
        self.assertEqual(result.returncode, 2)
        self.assertIn("laboratories: 2 there, 0 now", result.stderr)
        self.assertEqual(self.rehearse(self.folder + "/median").returncode, 0)
        self.assertEqual(dihaptic("collect", self.folder + "/median").returncode, 0)
        for here, median in zip(people, self.rows(self.folder + "/median", "people.csv")):
            self.assertNotEqual(here["fast_learning"], median["fast_learning"])
            self.assertEqual(here["tempo"], median["tempo"])
        result = self.rehearse(self.folder + "/many", "--laboratories", "3")
        self.assertEqual(result.returncode, 2)
        self.assertIn("4 people are too few for 3 laboratories. Rehearse at least two people of each: --people 6.", result.stderr)

    def test_collect_names_who_is_left_out(self):
        out = self.folder + "/out"
        self.assertEqual(self.rehearse(out, "--people", "1").returncode, 0)
        os.mkdir(out + "/unfinished-sim-002")
        result = dihaptic("collect", out)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(f"left out: {out}/unfinished-sim-002: its session has not ended", result.stdout)
        self.assertIn("1 session, ", result.stdout)

    def test_collect_names_who_is_missing_and_the_command(self):
        out = self.folder + "/out"
        self.assertEqual(self.rehearse(out, "--people", "3", "--seed", "7").returncode, 0)
        before = self.tables(out)
        shutil.rmtree(out + "/sim-001")
        shutil.rmtree(out + "/sim-003")
        os.mkdir(out + "/unfinished-sim-003")
        os.mkdir(out + "/unfinished-sim-009")  # nobody asked for this one
        result = dihaptic("collect", out)
        self.assertEqual(result.returncode, 1)
        lines = result.stdout.splitlines()
        self.assertEqual(lines[0], "missing: sim-001, sim-003 (not ended)")
        self.assertIn(f"rehearse {self.experiment} --people 3 --seed 7 --out {out}", lines[1])
        self.assertIn("left out: " + out + "/unfinished-sim-009", lines[2])
        self.assertIn("1 session, ", lines[3])
        subprocess.run(lines[1].partition("working on them: ")[2], shell=True, cwd="/", check=True, capture_output=True)
        self.assertEqual(self.tables(out), before)
        # the last rehearsal determines who is missing
        self.assertEqual(self.rehearse(out, "--people", "1", "--seed", "7").returncode, 0)
        shutil.rmtree(out + "/sim-002")
        self.assertEqual(dihaptic("collect", out).returncode, 0)

    def test_collect_brings_lifts_and_thresholds(self):
        text = pathlib.Path("experiments/visual-scaling.yaml").read_text().replace("../", os.getcwd() + "/")
        text = text.replace("trials: 25", "trials: 12").replace(
            "procedures: [more along x, less along x, more along y, less along y, more along z, less along z]",
            "procedures: [more along x]")
        file = self.folder + "/scaling.yaml"
        pathlib.Path(file).write_text(text)
        out = self.folder + "/out"
        result = dihaptic("rehearse", file, "--people", "1", "--out", out)
        self.assertEqual(result.returncode, 0, result.stderr)
        result = dihaptic("collect", out)
        self.assertEqual(result.returncode, 0, result.stderr)
        asked = [row["procedure"] for row in self.rows(out, "thresholds.csv") if row["trials"] != "0"]
        self.assertEqual(asked, ["more along x"])
        self.assertGreaterEqual(len(self.rows(out, "lifts.csv")), 12)

    def test_a_session_that_nothing_ends_says_so(self):
        text = pathlib.Path(self.experiment).read_text()
        text = text.replace("        - { when: time, after_s: 2, outcome: too slow, redo: yes, feedback: "
                            '"Too slow: reach faster" }\n', "")
        text = text.replace("radius_mm: 90 }", "radius_mm: 900 }")
        pathlib.Path(self.experiment).write_text(text)
        self.assertIn("reach: waits forever", dihaptic("check", self.experiment).stdout)
        result = dihaptic("rehearse", self.experiment, "--people", "1", "--out", self.folder + "/out")
        self.assertEqual(result.returncode, 1)
        self.assertIn("never ended 'reach' of trial 1", result.stderr)

    def test_refuses_what_cannot_be(self):
        for arguments, message in [(["rehearse", self.experiment, "--shard", "4/3"], "--shard: error: 4/3: is not a valid part"),
                                   (["rehearse", "experiments/lift-block.yaml"], "has no trials for people"),
                                   (["collect", self.folder], "is not the folder of a rehearsal"),
                                   (["run", self.experiment, "--real-objects"], "requires --simulate")]:
            result = dihaptic(*arguments)
            self.assertNotEqual(result.returncode, 0)
            self.assertIn(message, result.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
