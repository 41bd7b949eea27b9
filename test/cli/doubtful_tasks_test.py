"""Experiments and scenes that can be run, but cannot do what they were written for: each part has a warning.

Usage: cli/doubtful_tasks_test.py PROGRAM, from the project's folder.
"""
import os
import pathlib
import re
import sys
import tempfile
import unittest

sys.path.append("test/cli")
from program import dihaptic

TASK = f"""title: Reach
scene: {os.getcwd()}/scenes/reach-in-space.yaml
hand: {{ centre_mm: [0, 0, 120] }}
task:
  regions:
    - {{ name: start, position_mm: [0, 0, 120], radius_mm: 8 }}
    - {{ name: target, position_mm: [60, 0, 120], radius_mm: 10 }}
  states:
    - name: wait
      show: [start]
      exits:
        - {{ when: inside, region: start, hold_s: 0.2, to: reach }}
        - {{ when: time, after_s: 20, outcome: no start, redo: yes }}
      simulated_hand: [{{ duration_s: 0.6, reach: start }}]
    - name: reach
      show: [target]
      exits:
        - {{ when: inside, region: target, hold_s: 0.1, outcome: reached }}
        - {{ when: time, after_s: 2, outcome: too slow, redo: yes }}
      simulated_hand: [{{ duration_s: 0.5, reach: target }}]
  feedback_s: 0
  blocks:
    - {{ name: all, kind: baseline, repeats: 2 }}
"""
FIELD = "field: { kind: curl, on: index, damping_Ns_m: 10, axis: [0, 0, 1] }"


def perturbed(profile):
    """The task with a perturbation of this profile."""
    text = TASK.replace("  feedback_s: 0", f"  perturbations: [{{ name: p, profile: {profile}, {FIELD} }}]")
    return text.replace("kind: baseline, repeats", "kind: perturbed, perturb: p, repeats")


class DoubtfulTasks(unittest.TestCase):
    def setUp(self):
        self.folder = self.enterContext(tempfile.TemporaryDirectory())

    def check(self, text, suffix=""):
        file = pathlib.Path(self.folder, f"file{suffix}.yaml")
        file.write_text(text)
        return dihaptic("check", str(file))

    def test_the_task_itself_is_not_doubted(self):
        for text in (TASK, perturbed("{ delay_s: 21, rise_s: 0.1 }"), TASK.replace("hold_s: 0.1", "hold_s: 1.9")):
            said = self.check(text)
            self.assertEqual((said.returncode, said.stderr.count("warning"), said.stdout.count("warning")), (0, 0, 0), said)

    def test_each_doubt_is_told_with_its_line(self):
        factor = "  cross: [{ factor: load_g, levels: [100, 200] }]\n  feedback_s: 0"
        cases = [
            (TASK.replace("hold_s: 0.1", "hold_s: 5"), "is 5 s, but the state reach ends after 2 s"),
            (TASK.replace("hold_s: 0.1", "hold_s: 0.0001"), "hold: is 0.1 ms, less than a tick"),
            (TASK.replace("after_s: 2,", "after_s: 0.0002,"), "after: is 0.2 ms, less than a tick"),
            (TASK.replace("duration_s: 0.5", "duration_ms: 0.5"), "duration: is 0.5 ms, less than a tick"),
            (perturbed("{ delay_s: 30 }"), "is 30 s, but all states together last 22 s at most, so that p never acts"),
            (perturbed("{ plateau_s: 0.0001 }"), "plateau: is 0.1 ms, less than a tick"),
            (TASK.replace("[60, 0, 120]", "[60000, 0, 120]"), "target: lies 60 m from the origin, where no device reaches"),
            (TASK.replace("  feedback_s: 0", factor), "load_g: is a factor that nothing in this file uses"),
            (TASK.replace("  feedback_s: 0", factor.replace(", 200", "")), "load_g: is a factor with a single level"),
        ]
        for text, told in cases:
            with self.subTest(told):
                said = self.check(text)
                self.assertEqual(said.returncode, 0, said.stderr)
                self.assertRegex(said.stdout + said.stderr, r"file\.yaml:\d+: warning: .*" + re.escape(told))

    def test_a_factor_is_used_with_its_unit_or_without(self):
        for use in ("load", "load_g"):
            text = TASK.replace("  feedback_s: 0", "  cross: [{ factor: load_g, levels: [100, 200] }]\n  feedback_s: 0")
            text = text.replace("radius_mm: 10", f'radius_mm: "10 if {use} > 0.15 kg else 12"' if use == "load" else "radius_mm: 10")
            text += "" if use == "load" else "  custom_measures: [{ name: carried_g, of: load_g }]\n"
            said = self.check(text, use)
            self.assertNotIn("nothing in this file uses", said.stdout + said.stderr)

    def test_a_factor_whose_level_names_a_condition_is_used(self):
        text = TASK.replace("  regions:", "  cross: [{ factor: place, levels: [near, far] }]\n  conditions:\n"
                            "    - { name: far, regions: [{ name: target, position_mm: [0, 80, 120], radius_mm: 10 }] }\n  regions:", 1)
        self.assertNotIn("warning", self.check(text).stdout)

    def test_fields_that_oppose_each_other_are_doubted(self):
        text = perturbed("{}").replace("damping_Ns_m: 10", "damping_Ns_m: 10 * side").replace(" profile: {},", "").replace(
            "  regions:", "  conditions: [{ name: a, factors: { side: -1 } }, { name: b, factors: { side: 1 } }]\n"
            "  measures: [adaptation_index, channel_force]\n  movement: { of: index, from: start, to: target, during: [reach] }\n"
            "  regions:", 1).replace("  perturbations: [", "  perturbations: [{ name: wall, field: { kind: channel, on: index, "
            "from: start, to: target, stiffness_N_m: 1000, damping_Ns_m: 10 } }, ")
        self.assertIn("whose direction differs between trials", self.check(text).stdout)
        self.assertNotIn("direction differs", self.check(text.replace("10 * side", "10 * (side + 2)")).stdout)

    def test_a_push_at_the_go_signal_is_doubted(self):
        text = perturbed("{}").replace(FIELD, "during: [reach], field: { kind: constant, on: index, force_N: [1, 0, 0] }")
        text = text.replace(" profile: {},", "").replace("  regions:", "  measures: [reaction_time]\n"
                            "  movement: { of: index, from: start, to: target, during: [reach] }\n  regions:", 1)
        self.assertIn("pushes the hand from the moment at which 'reach' begins", self.check(text).stdout)
        for part in ("during: [wait, reach], field", "profile: { delay_s: 1 }, during: [reach], field"):
            self.assertNotIn("from the moment", self.check(text.replace("during: [reach], field", part)).stdout, part)

    def test_an_end_that_comes_after_the_states_is_doubted(self):
        text = TASK.replace("  regions:", "  measures: [movement_time]\n  movement: { of: index, from: start, to: target, "
                            "during: [reach], end_still_s: 0.2 }\n  regions:", 1)
        self.assertIn("may end 'reach' 0.1 s after the hand has become still, but the movement is over only after 0.2 s",
                      self.check(text).stdout)
        for old, new in (("hold_s: 0.1", "hold_s: 0.2"), ("end_still_s: 0.2", "end_still_s: 0.1")):
            self.assertNotIn("become still", self.check(text.replace(old, new)).stdout, new)

    def lift(self, of, joints="", task="", named=""):
        """The messages about a task in which one of two blocks is lifted."""
        scene = pathlib.Path("scenes/block-on-table.yaml").read_text().replace(
            "fingers:", "  - { name: lid, shape: box, size_mm: [40, 40, 10], mass_g: 20, position_mm: [0, 0, 46] }\n"
            + joints + "fingers:", 1)
        pathlib.Path(self.folder, "scene.yaml").write_text(scene.replace("object: block\n", named))
        return self.check(f"""scene: scene.yaml
hand: {{ centre_mm: [0, 0, 20], aperture_mm: 85 }}
task:
  states:
    - name: lift
      exits: [{{ when: lifted, body: {of}, outcome: lifted }}, {{ when: time, after_s: 9, outcome: late }}]
      simulated_hand: [{{ duration_s: 1, aperture_mm: 36 }}, {{ duration_s: 1, move_mm: [0, 0, 50] }}]
{task}  blocks: [{{ name: all, kind: baseline, repeats: 2 }}]
""").stdout

    def test_lifts_that_would_be_marked_no_touch_are_doubted(self):
        hinge = "joints: [{ name: hinge, kind: hinge, between: [block, lid], position_mm: [0, 20, 40], axis: [1, 0, 0] }]\n"
        self.assertNotIn("counts as touch", self.lift("block"))
        self.assertNotIn("no touch", self.lift("block"))
        self.assertIn("lid: is gripped or lifted in the task, but only lifts of block are measured", self.lift("lid"))
        self.assertNotIn("no touch", self.lift("lid", task="  conditions: [{ name: lid, object: lid }]\n"))
        self.assertIn("block: is joined to lid, but only contact with 'block' itself counts", self.lift("block", hinge))
        self.assertNotIn("counts", self.lift("block", hinge, named="object: block\n"))

    def test_numbers_without_a_value_are_refused(self):
        for condition, told in (("sqrt(0 - 1) > 1", "made of numbers alone, that is not a number"),
                                ("grip_force / 0 > 1", "is zero, by which nothing can be divided"),
                                ("grip_force / (2 N - 2 N) > 1", "is zero, by which nothing can be divided")):
            said = self.check(TASK.replace("when: inside, region: target, hold_s: 0.1", f"when: {condition}"))
            self.assertEqual(said.returncode, 2, condition)
            self.assertIn(told, said.stdout + said.stderr)

    def test_units_of_bodies_are_doubted(self):
        scene = pathlib.Path("scenes/block-on-table.yaml").read_text()
        for old, new, told in (("position_mm: [0, 0, 20]", "position_m: [0, 0, 20]", "begins 20 m from the origin"),
                               ("mass_g: 100", "mass_g: 0.001", "weighs 1e-06 kg. Check the unit"),
                               ("mass_g: 100", "mass_g: 100\n    rotation_rad: [0, 0, 45]", "is turned by 2578 degrees")):
            self.assertIn(old, scene)
            said = self.check(scene.replace(old, new))
            self.assertIn(told, said.stdout + said.stderr)

    def test_a_session_without_a_trial_that_counts_is_no_success(self):
        none = TASK.replace("repeats: 2 }", "repeats: 2, until: err < 1 }").replace("  feedback_s: 0", "  variables: [{ name: err }]")
        never = TASK.replace("when: inside, region: target, hold_s: 0.1", "when: index.z > 100000 mm")
        for text, told, name in ((none, "no trial was done", "none"), (never, "ended as a trial should: after too slow the", "never")):
            file = pathlib.Path(self.folder, f"{name}.yaml")
            file.write_text(text)
            said = dihaptic("run", str(file), "--simulate", "--participant", "sim-003", "--out", self.folder)
            self.assertIn(told, said.stdout)
            people = os.path.join(self.folder, name)
            dihaptic("rehearse", str(file), "--people", "2", "--out", people)
            self.assertIn(told, dihaptic("collect", people).stderr)


unittest.main(argv=sys.argv[:1])
