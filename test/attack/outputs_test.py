"""Names of outputs that would replace recordings, tables or inputs are refused, and nothing is lost.

Usage: attack/outputs_test.py PROGRAM, from the project's folder.
"""
import os
import pathlib
import shutil
import sys
import tempfile
import unittest

sys.path.append("test/cli")
from program import dihaptic

SCENE = "scenes/block-on-table.yaml"


class Outputs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        said = dihaptic("run", "experiments/lift-block.yaml", "--simulate", "--participant", "S01", "--out", folder.name)
        cls.session = pathlib.Path(said.stdout.splitlines()[-1].removeprefix("session: "))
        cls.other = cls.folder / "other"
        shutil.copytree(cls.session, cls.other)
        for name in ("scene.yaml", "people.csv", "notes.txt"):
            (cls.folder / name).write_text("one,two\n1,2\n")

    def targets(self):
        files = [folder / name for folder in (self.session, self.other)
                 for name in ("raw.log", "session.nwb", "session.yaml", "trials.csv", "task.yaml")]
        return [file for file in [*files, *(self.folder / name for name in ("scene.yaml", "people.csv", "notes.txt"))] if file.exists()]

    def test_no_recording_table_or_input_is_replaced(self):
        session = str(self.session)
        commands = [
            ("export", session, "--csv", "grip_force"), ("picture", session, "--size", "64x48"), ("picture", SCENE, "--size", "64x48"),
            ("video", SCENE, "--size", "64x48"), ("workspace", "rigs/premium-pair.yaml"),
        ]
        before = {file: file.read_bytes() for file in self.targets()}
        self.assertGreater(len(before), 10)
        for command in commands:
            for file in before:
                with self.subTest(command=command[0], file=file.name):
                    said = dihaptic(*command, "--out", str(file))
                    self.assertEqual(said.returncode, 2, said.stdout)
                    self.assertIn("Name another file", said.stderr)
        self.assertEqual({file: file.read_bytes() for file in before}, before)

    def test_what_the_commands_have_written_is_replaced(self):
        curves, picture = str(self.folder / "curves.csv"), str(self.session / "block.png")
        for _ in range(2):
            self.assertEqual(dihaptic("export", str(self.session), "--csv", "grip_force", "--out", curves).returncode, 0)
            self.assertEqual(dihaptic("picture", str(self.session), "--size", "64x48", "--out", picture).returncode, 0)
        os.remove(picture)


unittest.main(argv=sys.argv[:1])
