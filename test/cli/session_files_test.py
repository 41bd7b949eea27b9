"""What stands in the place of a session's file, and what killed commands leave.

Usage: session_files_test.py PROGRAM, from the project's folder.
"""
import glob
import os
import pathlib
import random
import re
import shutil
import subprocess
import tempfile
import time
import unittest

from program import PROGRAM, dihaptic, patient, session_of
import soak  # program.py adds its folder to the path


class SessionFiles(unittest.TestCase):
    """What stands in the place of a session's file: each command says file and remedy, and ends."""

    REACHES = """title: Two reaches
scene: scene.yaml
hand: { centre_mm: [0, 0, 120] }
task:
  regions:
    - { name: start, position_mm: [0, 0, 120], radius_mm: 6 }
    - { name: target, position_mm: [50, 0, 120], radius_mm: 6 }
  states:
    - name: home
      show: [start]
      exits: [{ when: inside, region: start, hold_s: 0.1, to: reach }]
      simulated_hand: [{ duration_s: 0.2, reach: start }]
    - name: reach
      show: [target]
      exits: [{ when: inside, region: target, outcome: reached }]
      simulated_hand: [{ duration_s: 0.2, reach: target }]
  reach: { from: start, to: target, during: reach, distance_mm: 30, axis: [0, 0, 1] }
  blocks: [{ name: all, kind: baseline, repeats: 2 }]
"""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.out = folder.name
        pathlib.Path(folder.name + "/scene.yaml").write_text(
            "bodies:\n  - { name: floor, shape: plane, fixed: yes }\n"
            "fingers:\n  - { name: index, shape: sphere, radius_mm: 6, mass_g: 1 }\n")
        pathlib.Path(folder.name + "/reaches.yaml").write_text(cls.REACHES)
        result = dihaptic("run", folder.name + "/reaches.yaml", "--participant", "S07", "--out", folder.name + "/out")
        assert result.returncode == 0, result.stderr
        cls.made = session_of(folder.name + "/out").rstrip("/")
    def copy(self):
        copy = self.out + "/copy"
        shutil.rmtree(copy, ignore_errors=True)
        shutil.rmtree(self.out + "/study", ignore_errors=True)
        return shutil.copytree(self.made, copy)

    def replace(self, file, kind):
        text = b""
        if os.path.exists(file):
            text = pathlib.Path(file).read_bytes()
            os.remove(file)
        if kind == "pipe":
            os.mkfifo(file)
        elif kind == "device":
            os.symlink("/dev/zero", file)
        elif kind == "folder":
            os.mkdir(file)
        elif kind == "loop":
            os.symlink(os.path.basename(file), file)
        elif kind == "empty":
            pathlib.Path(file).write_text("")
        elif kind == "large":
            pathlib.Path(file).touch()
            os.truncate(file, 600_000_000)
        elif kind == "cut":
            pathlib.Path(file).write_bytes(text[:len(text) * 6 // 10])

    def commands(self, session):
        return [["recover", session], ["resume", session, "--out", self.out + "/resumed"], ["replay", session],
                ["report", session], ["export", session, "--bids", self.out + "/study"]]

    def test_no_command_hangs_or_crashes_on_what_is_no_file(self):
        # for each file, the commands that require it
        needed = {"raw.log": ["recover", "resume", "replay", "report", "export"],
                  "session.yaml": ["report", "export"],
                  "scene.yaml": ["replay", "resume"], "settings.yaml": ["replay", "resume"],
                  "task.yaml": ["resume"], "trial-list.csv": ["recover", "resume"], "trials.csv": ["resume", "report"],
                  "session.nwb": [], "settings.csv": ["report"], "events.csv": ["export"], "shown.csv": ["recover"]}
        kinds = ["pipe", "device", "folder", "loop", "large", "empty", "gone", "cut"]
        for i, (file, commands) in enumerate(needed.items()):
            for kind in soak.of([kinds[i % len(kinds)]], kinds):
                if (file, kind) in [("shown.csv", "cut"), ("raw.log", "large"), ("session.nwb", "large")]:
                    continue
                for name in soak.of(commands[:1], commands) or ["recover"]:
                    session = self.copy()
                    self.replace(session + "/" + file, kind)
                    (command,) = [command for command in self.commands(session) if command[0] == name]
                    where = f"{name} with {file}: {kind}"
                    result = subprocess.run([PROGRAM, *command], capture_output=True, text=True, timeout=patient(60))
                    self.assertIn(result.returncode, [0, 1, 2], where + result.stderr)
                    self.assertNotIn("report this", result.stderr, where)
                    if commands and kind in ["pipe", "device", "folder", "loop", "large"]:
                        self.assertEqual(result.returncode, 2, where + result.stdout + result.stderr)
                        self.assertRegex(result.stderr, rf"{file}[^\n]*: error: [^\n]*[a-z)]\. [A-Z]", where)

    def test_an_empty_list_or_table_is_an_error_with_a_remedy(self):
        session = self.copy()
        self.replace(session + "/trial-list.csv", "empty")
        result = dihaptic("recover", session)
        self.assertEqual(result.returncode, 2, result.stdout)
        self.assertIn("trial-list.csv: error: is empty", result.stderr)
        session = self.copy()
        self.replace(session + "/trials.csv", "empty")
        result = dihaptic("resume", session)
        self.assertEqual(result.returncode, 2, result.stdout)
        self.assertRegex(result.stderr, r"trials.csv: error: has 0 rows; it had \d+ rows .*: dihaptic recover")
        self.assertEqual(dihaptic("recover", session).returncode, 0)
        self.assertIn("is complete: all its trials are done", dihaptic("resume", session).stderr)
        session = self.copy()
        info = pathlib.Path(session + "/session.yaml")
        info.write_text(re.sub(r"seed: \S+", "seed: many", info.read_text()))
        result = dihaptic("resume", session)
        self.assertEqual(result.returncode, 2, result.stdout)
        self.assertIn("session.yaml: error: seal: does not match", result.stderr)
        self.assertEqual(dihaptic("recover", session).returncode, 0)
        self.assertIn("is complete: all its trials are done", dihaptic("resume", session).stderr)
        self.assertNotIn("many", info.read_text())

    @soak.alone
    def test_pictures_and_collections_take_files_only(self):
        for file in ["raw.log", "scene.yaml", "rig.yaml"]:
            for kind in ["pipe", "device", "folder", "loop", "empty", "gone"]:
                session = self.copy()
                self.replace(session + "/" + file, kind)
                for command in [["picture", session, "-o", self.out + "/x.png"], ["video", session, "-o", self.out + "/x.mp4"]]:
                    result = subprocess.run([PROGRAM, *command, "--size", "64x48"], capture_output=True, text=True, timeout=patient(60))
                    self.assertEqual(result.returncode, 2, f"{command} {file} {kind} " + result.stderr)
                    self.assertNotIn("report this", result.stderr)
        os.makedirs(self.out + "/people/sim-001", exist_ok=True)
        pathlib.Path(self.out + "/people/rehearsal.yaml").write_text("program: any\nexperiment: any\nseed: 1\n")
        for kind in ["pipe", "device", "folder", "loop", "empty", "gone"]:
            for file in ["trials.csv", "person.yaml"]:
                for name in ["trials.csv", "person.yaml"]:
                    there = self.out + "/people/sim-001/" + name
                    shutil.rmtree(there) if os.path.isdir(there) else os.path.lexists(there) and os.remove(there)
                    pathlib.Path(there).write_text("id: S07\n" if name == "person.yaml" else "outcome\nreached\n")
                self.replace(self.out + "/people/sim-001/" + file, kind)
                result = subprocess.run([PROGRAM, "collect", self.out + "/people"], capture_output=True, text=True, timeout=patient(60))
                # without person.yaml, or with an empty one, it is not a session of a simulated person
                none = "no session is complete" in result.stdout
                self.assertEqual(result.returncode, 1 if none else 2, file + kind + result.stderr)
                self.assertRegex(result.stdout + result.stderr, f"{file}|session.yaml|no session is complete")
                self.assertNotIn("report this", result.stderr)

    @soak.alone
    def test_a_killed_export_leaves_no_run_that_looks_whole(self):
        random.seed(3)
        start = time.monotonic()
        self.assertEqual(dihaptic("export", self.made, "--bids", self.out + "/whole").returncode, 0)
        duration = time.monotonic() - start
        motion = glob.glob(self.out + "/whole/sub-S07/motion/*run-01_motion.tsv")[0]
        size = os.path.getsize(motion)
        study = self.out + "/killed"
        for _ in range(soak.of(12, 200)):
            process = subprocess.Popen([PROGRAM, "export", self.made, "--bids", study], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(random.uniform(0, duration))
            process.kill()
            process.wait()
            for file in glob.glob(study + "/sub-S07/motion/*"):
                self.assertEqual(os.path.getsize(file), os.path.getsize(file.replace(study, self.out + "/whole").replace(
                    re.search(r"run-\d+", file).group(0), "run-01")), file)
            if glob.glob(study + "/sub-S07/motion/*run-01_motion.tsv"):
                shutil.rmtree(study)
        self.assertEqual(dihaptic("export", self.made, "--bids", study).returncode, 0)
        names = os.listdir(study + "/sub-S07/motion")
        self.assertEqual(sorted(names), sorted(os.listdir(self.out + "/whole/sub-S07/motion")))
        self.assertEqual(sorted(os.listdir(study + "/sub-S07")), sorted(os.listdir(self.out + "/whole/sub-S07")))
        self.assertEqual(os.path.getsize(motion.replace(self.out + "/whole", study)), size)
        self.assertEqual([name for name in os.listdir(study + "/sub-S07/motion") + os.listdir(study) if "part" in name and not name.startswith("participants.")
                          or name.startswith(".")], [])

    def test_what_a_killed_video_leaves_is_gone_after_the_next(self):
        scene = pathlib.Path(self.out + "/block.yaml")
        scene.write_text(pathlib.Path("scenes/block-on-table.yaml").read_text().replace("duration_s: 1", "duration_s: 0.4"))
        with tempfile.TemporaryDirectory() as folder:
            command = [PROGRAM, "video", str(scene), "--size", "64x48", "-o", folder + "/v.mp4"]
            process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
            process.stderr.readline()  # waits until it has begun
            while not os.listdir(folder):
                time.sleep(0.01)
            process.kill()
            process.communicate()
            (left,) = os.listdir(folder)
            self.assertTrue(left.endswith(".part"), left)
            other = pathlib.Path(folder + "/v.mp4.1.part")  # belongs to a running program
            other.write_text("")
            self.assertEqual(subprocess.run(command, capture_output=True).returncode, 0)
            self.assertEqual(sorted(os.listdir(folder)), ["v.mp4", "v.mp4.1.part"])


if __name__ == "__main__":
    unittest.main(verbosity=2)
