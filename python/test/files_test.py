"""Scenes, rigs and experiments that are made of objects are the files that one would have written."""

import copy
import glob
import os
import pathlib
import pickle
import shutil
import sys
import tempfile
import unittest

import numpy as np

import dihaptic as dh
from dihaptic import Experiment, Part, Rig, Scene  # noqa: F401: what repr() is made of

sys.path.append("test")
import soak  # noqa: E402

PROJECT = pathlib.Path.cwd()
KINDS = {"scenes": Scene, "rigs": Rig, "experiments": Experiment}
# trials, formulas and joints, and neither
RUN = ["first-trials", "squeeze-spring", "lift-block"]
if soak.EVERYTHING:
    RUN = sorted(pathlib.Path(file).stem for file in glob.glob("experiments/*.yaml"))


def shipped():
    for folder, kind in KINDS.items():
        for file in sorted((PROJECT / folder).glob("*.yaml")):
            yield kind, file


def rebuilt(thing):
    """The same, of objects that remember nothing of a file."""
    return eval(repr(thing))


class Files(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.here = pathlib.Path(self.folder.name)

    def tree(self, name):
        tree = self.here / name
        for folder in ("experiments", "scenes", "rigs", "meshes", "textures", "movements", "populations"):
            shutil.copytree(PROJECT / folder, tree / folder)
        return tree

    def test_what_is_loaded_is_saved_to_the_letter(self):
        for kind, file in shipped():
            with self.subTest(file.name):
                loaded = kind.load(file)
                saved = kind.load(loaded.save(file.parent / f".saved-{os.getpid()}.yaml"))
                (file.parent / f".saved-{os.getpid()}.yaml").unlink()
                self.assertEqual(saved, loaded)
                self.assertEqual(str(saved), str(loaded))

    def test_of_new_objects_it_is_the_same(self):
        for kind, file in shipped():
            with self.subTest(file.name):
                loaded = kind.load(file)
                again = rebuilt(loaded)
                self.assertEqual(again, loaded)
                object.__setattr__(again, "_folder", file.parent)  # where its paths start
                found = again.check()
                self.assertEqual([p for p in found if p.severity == "error"], [])
                self.assertEqual(len(found), len(dh.check(file)))

    def test_a_session_of_new_objects_is_the_same_to_the_bit(self):
        """In two copies of the project's files, since a session's record has the name of its file."""
        records = []
        self.addCleanup(os.chdir, PROJECT)
        for name in ("own", "objects"):
            tree = self.tree(name)
            os.chdir(tree)
            records.append({})
            for kind in RUN:
                file = pathlib.Path(f"experiments/{kind}.yaml")
                experiment = Experiment.load(file)
                scene = Scene.load(file.parent / experiment.scene)
                if name == "objects":
                    rebuilt(scene).save(file.parent / experiment.scene)
                    rebuilt(experiment).save(file)
                person = {"simulate": True, "participant": "sim-001"} if "task" in experiment else {}
                session = dh.run(file, out="sessions", progress=False, **person)
                trials = session.folder / "trial-list.csv"
                records[-1][kind] = (session.folder / "raw.log").read_bytes(), trials.is_file() and trials.read_bytes()
        for kind in RUN:
            with self.subTest(kind):
                self.assertEqual(records[0][kind][1], records[1][kind][1])
                self.assertTrue(records[0][kind][0] == records[1][kind][0])

    def test_paths_are_kept_true_in_another_folder(self):
        for name in ("scenes/tools.yaml", "scenes/block-on-table.yaml"):
            scene = Scene.load(PROJECT / name)
            self.assertEqual(dh.check(scene.save(self.here / "moved.yaml")), dh.check(PROJECT / name))
        experiment = Experiment.load(PROJECT / "experiments/first-trials.yaml")
        self.assertEqual(dh.check(experiment.save(self.here / "moved.yaml")), [])

    def test_an_experiment_takes_its_scene_and_rig_along(self):
        experiment = Experiment.load(PROJECT / "experiments/first-trials.yaml")
        experiment.scene = Scene.load(PROJECT / "scenes/block-on-table.yaml")
        experiment.rig = Rig.load(PROJECT / "rigs/ideal-pair.yaml")
        experiment.scene.bodies[1].mass_g = 250
        file = experiment.save(self.here / "heavy.yaml")
        self.assertEqual(sorted(os.listdir(self.here)), ["heavy.rig.yaml", "heavy.scene.yaml", "heavy.yaml"])
        self.assertEqual(dh.check(file), [])
        again = Experiment.load(file)
        self.assertEqual((again.scene, again.rig), ("heavy.scene.yaml", "heavy.rig.yaml"))
        self.assertEqual(Scene.load(self.here / again.scene).bodies[1].mass_g, 250)

    def test_errors_name_the_object(self):
        scene = Scene.load(PROJECT / "scenes/block-on-table.yaml")
        scene.bodies[1].frictoin = 0.5
        problem = scene.check()[0]
        self.assertEqual((problem.file, problem.line, problem.key), ("Scene.bodies[1]", 0, "frictoin"))
        self.assertIn("friction", problem.remedy)
        with self.assertRaisesRegex(dh.Error, r"Scene\.bodies\[1\]: error: frictoin"):
            dh.World(scene)
        experiment = Experiment.load(PROJECT / "experiments/first-trials.yaml")
        experiment.scene = scene
        self.assertEqual(experiment.check()[0].file, "Experiment.Scene.bodies[1]")
        with self.assertRaisesRegex(dh.Error, r"Experiment\.Scene\.bodies\[1\]"):
            dh.run(experiment, out=self.here, progress=False)
        experiment.scene = "nowhere.yaml"
        self.assertIn("nowhere.yaml", experiment.check()[0].text())
        self.assertIn("Part", repr(Part()))
        with self.assertRaisesRegex(dh.Error, "^Scene: error: is neither a scene"):
            dh.World(Scene(title="empty"))

    def test_a_save_that_fails_leaves_what_was_there(self):
        file = self.here / "e.yaml"
        experiment = Experiment.load(PROJECT / "experiments/first-trials.yaml")
        experiment.scene = Scene.load(PROJECT / "scenes/block-on-table.yaml")
        experiment.save(file)
        before = {path.name: path.read_bytes() for path in self.here.iterdir()}
        experiment.scene.title = "another"
        experiment["a\ud800"] = 1  # which no file can have
        with self.assertRaises(ValueError):
            experiment.save(file)
        self.assertEqual({path.name: path.read_bytes() for path in self.here.iterdir() if path.suffix == ".yaml"}, before)

    def test_another_kind_of_file_is_refused(self):
        with self.assertRaisesRegex(dh.Error, "is not a valid scene: it has no bodies"):
            Scene.load(PROJECT / "experiments/first-trials.yaml")
        with self.assertRaisesRegex(dh.Error, "is not a valid rig"):
            Rig.load(PROJECT / "scenes/block-on-table.yaml")

    def test_a_file_that_is_unchanged_is_used_itself(self):
        scene = Scene.load(PROJECT / "scenes/block-on-table.yaml")
        session = dh.run(scene, out=self.here, progress=False)
        self.assertEqual(pathlib.Path(session.info["experiment"]), PROJECT / "scenes/block-on-table.yaml")

    def test_keys_are_completed_with_what_they_mean(self):
        experiment = Experiment.load(PROJECT / "experiments/first-trials.yaml")
        state = experiment.task.states[0]
        self.assertIn("show", state.known())
        self.assertIn("simulated_hand", dir(state))
        self.assertIn("redo", experiment.task.states[0].exits[0].known())
        self.assertEqual(Part(a=1).known(), {})
        self.assertNotIn("__no_key__", state)

    def test_a_copy_is_a_scene_of_its_own(self):
        scene = Scene.load(PROJECT / "scenes/block-on-table.yaml")
        for again in (copy.copy(scene), copy.deepcopy(scene), pickle.loads(pickle.dumps(scene))):
            self.assertEqual(again, scene)
            again.bodies[1].mass_g = 1
            self.assertEqual(scene.bodies[1].mass_g, 100)
            self.assertEqual(again.check(), [])

    def test_values_may_be_numpy_s(self):
        part = Part(size_mm=np.array([1.5, 2, 3]), mass_g=np.float64(2), fixed=np.bool_(True), file=pathlib.Path("a/b.obj"))
        self.assertEqual(part, Part(size_mm=[1.5, 2.0, 3.0], mass_g=2.0, fixed=True, file="a/b.obj"))
        part = Part(parts=[{"shape": "box"}])
        self.assertEqual(part.parts[0].shape, "box")
        with self.assertRaisesRegex(dh.Error, "cannot be written to a file"):
            Part(mass_g=object())

    def test_a_part_is_not_within_itself(self):
        part = Part(name="a")
        for value in (part, [part], Part(inner=[part])):
            with self.assertRaisesRegex(dh.Error, "inner: would be within itself"):
                part.inner = value

    def test_a_shipped_file_is_found_from_any_folder(self):
        before = os.getcwd()
        os.chdir(self.here)
        self.addCleanup(os.chdir, before)
        scene = Scene.load("scenes/block-on-table.yaml")
        world = dh.World("scenes/block-on-table.yaml", rig="rigs/ideal-pair.yaml")
        self.assertIn("block", world.bodies)

        class Ends(dh.Person):
            def act(self, seen):
                raise StopIteration("found")

        with self.assertRaisesRegex(StopIteration, "found"):
            dh.run("experiments/first-trials.yaml", out=self.here, person=Ends(), progress=False)
        self.assertEqual(dh.run(scene, out=self.here, progress=False).info["experiment"], str(dh.shipped("scenes/block-on-table.yaml")))

    def test_an_argument_that_the_program_refuses_is_named(self):
        with self.assertRaises(dh.Error) as refused:
            dh.run("experiments/lift-block.yaml", seed=-1)
        self.assertEqual(refused.exception.problems[0].key, "seed")
        self.assertNotIn("--help", str(refused.exception))

    def test_tables_that_are_not_there_yet_say_how_they_come(self):
        (self.here / "rehearsal.yaml").touch()
        study = dh.Rehearsal(self.here)
        with self.assertRaisesRegex(dh.Error, "has no tables yet. Type dihaptic collect"):
            study.trials
        (self.here / "trials.csv").write_text("id\nsim-001\n")
        with self.assertRaisesRegex(dh.NotThere, "Did you mean 'trials'"):
            study.table("trial")

    def test_texts_that_look_like_numbers_stay_texts(self):
        file = self.here / "a.yaml"
        file.write_text('title: 007\nbodies: []\nsettings: { a: 1e-3, b: "+5", c: .5, d: 10_000, e: yes, f: ~ }\n')
        scene = Scene.load(file)
        self.assertEqual(scene.title, "007")
        self.assertEqual((scene.settings.a, scene.settings.b, scene.settings.c), (1e-3, 5, 0.5))
        self.assertEqual((scene.settings.d, scene.settings.e, scene.settings.f), ("10_000", True, None))
        self.assertIn("1e-3", str(scene))
        scene.settings.a = 0.1 + 0.2
        self.assertIn("0.30000000000000004", str(scene))

    def test_what_is_no_file_of_ours_is_refused(self):
        for text, what in [("- a\n- b\n", "has no keys"), ("a: [\n", "is not YAML"), ("", "has no keys")]:
            file = self.here / "a.yaml"
            file.write_text(text)
            with self.subTest(text), self.assertRaisesRegex(dh.Error, what):
                Scene.load(file)
        with self.assertRaisesRegex(dh.Error, "cannot be read"):
            Scene.load(self.here / "none.yaml")
        with self.assertRaisesRegex(AttributeError, "title: is not given"):
            Scene().title
        with self.assertRaises(dh.NotThere):
            Scene()["title"]


if __name__ == "__main__":
    unittest.main()
