"""Computers of clusters, containers and other labs: users without a name, narrow limits. docs/outside.md has the sources.

Usage: outside/machines_test.py PROGRAM, from the project's folder.
"""
import glob
import os
import resource
import subprocess
import sys
import tempfile
import unittest

sys.path.append("test/cli")
sys.path.append("test")
import needs
from program import PROGRAM, SHORT, patient, with_largest_file

PROGRAM = os.path.abspath(PROGRAM)
#: No user of any system has this number.
NOBODY = 48211


def dihaptic(*arguments, environment=None, **options):
    """The program with nothing in its environment but what is given: no HOME, no language, no screen."""
    # keeps the sanitizers' settings and the table of slowness
    kept = {k: v for k, v in os.environ.items() if k.endswith("_OPTIONS")}
    return subprocess.run([PROGRAM, *arguments], env=kept | {"PATH": "/usr/bin:/bin"} | (environment or {}), capture_output=True,
                          text=True, timeout=patient(300), **options)


class Machines(unittest.TestCase):
    def setUp(self):
        self.out = self.enterContext(tempfile.TemporaryDirectory())
        self.scene = os.path.join(self.out, "scene.yaml")
        with open(self.scene, "w") as file:
            file.write(SHORT.replace("shape: mesh, file: block.obj, unit: mm", "shape: box, size_mm: [40, 40, 40], position_mm: [0, 0, 20]"))

    def test_a_user_without_a_name_and_a_home_records_reports_and_draws(self):
        if os.geteuid() != 0:
            needs.skip("only root can start the program as a user without a name")
        os.chmod(self.out, 0o777)
        nobody = {"user": NOBODY, "group": NOBODY, "extra_groups": [], "cwd": self.out}
        try:
            dihaptic("--version", **nobody)
        except PermissionError:
            needs.skip("the folder of the build may be entered by its owner alone")
        for arguments in (["run", "scene.yaml"], ["picture", "scene.yaml", "--out", "picture.png"], ["doctor"]):
            result = dihaptic(*arguments, **nobody)
            self.assertEqual(result.returncode, 0, result.stderr)
        (session,) = glob.glob(self.out + "/sessions/*/")
        self.assertEqual(os.stat(session).st_uid, NOBODY)
        result = dihaptic("report", session, environment={"TMPDIR": "/nowhere", "HOME": "/nowhere"}, **nobody)
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_without_the_right_to_run_in_real_time_it_says_which_right_is_missing(self):
        if os.geteuid() != 0:
            needs.skip("only root can give up its right to run in real time")
        os.chmod(self.out, 0o777)

        def without_rights():
            resource.setrlimit(resource.RLIMIT_RTPRIO, (0, 0))
            resource.setrlimit(resource.RLIMIT_MEMLOCK, (0, 0))

        nobody = {"user": NOBODY, "group": NOBODY, "extra_groups": [], "cwd": self.out}
        try:
            result = dihaptic("run", "scene.yaml", "--clock", "real", preexec_fn=without_rights, **nobody)
        except PermissionError:
            needs.skip("the folder of the build may be entered by its owner alone")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stdout + result.stderr, "Linux refused priority 80 .*dihaptic doctor")

    def test_runs_of_the_same_second_share_no_folder(self):
        runs = [subprocess.Popen([PROGRAM, "run", self.scene, "--out", self.out + "/all"], stdout=subprocess.DEVNULL,
                                 stderr=subprocess.PIPE, text=True) for _ in range(6)]
        for run in runs:
            said = run.communicate(timeout=patient(300))[1]
            self.assertEqual(run.returncode, 0, said)
        sessions = glob.glob(self.out + "/all/*/")
        self.assertEqual(len(sessions), len(runs))
        for session in sessions:
            self.assertEqual(dihaptic("replay", session).returncode, 0)

    def test_a_disk_that_takes_no_larger_file_keeps_what_was_recorded_and_says_so(self):
        # like FAT, which refuses files from 4 GB on with the same errno
        result = dihaptic("run", self.scene, "--out", self.out, preexec_fn=with_largest_file(20_000))
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("raw.log: error: cannot be written: File too large", result.stderr)
        self.assertIn("files cannot become so large there (4 GB on a FAT stick", result.stderr)
        self.assertNotIn("free some space", result.stderr)

    def test_without_a_screen_the_window_says_so_and_the_rest_works(self):
        needs.part_for_this_test("window", PROGRAM)
        result = dihaptic("gui", self.scene)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("there is no screen", result.stderr)
        # with a screen that does not exist
        result = dihaptic("picture", self.scene, "--out", self.out + "/picture.png", environment={"DISPLAY": ":77"})
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertGreater(os.path.getsize(self.out + "/picture.png"), 10_000)


if __name__ == "__main__":
    unittest.main(verbosity=1)
