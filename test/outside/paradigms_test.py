"""Published paradigms whose first version, written from the documents, gave wrong numbers without a word. docs/outside.md has
the sources.

Usage: outside/paradigms_test.py PROGRAM, from the project's folder.
"""
import os
import pathlib
import sys
import tempfile
import unittest

import numpy as np

sys.path.append("test/cli")
from program import PROGRAM, dihaptic

import soak  # program.py adds its folder to the path

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(PROGRAM)), "python"))
import dihaptic as dh

SPACE = f"scene: {os.path.abspath('scenes/reach-in-space.yaml')}\nhand: {{ centre_mm: [0, 0, 120] }}\n"
REGIONS = """  regions:
    - { name: start, position_mm: [0, 0, 120], radius_mm: 8 }
    - { name: target, position_mm: [0, 80, 120], radius_mm: 10 }
    - { name: shell, position_mm: [0, 0, 120], radius_mm: 80 }
"""
BACK = """    - name: back
      show: [start]
      perturbed: no
      exits:
        - { when: inside, region: start, hold_s: 0.3, to: reach }
        - { when: time, after_s: 20, outcome: no start, redo: yes }
      simulated_hand: [{ duration_s: 0.6, reach: start }]
"""
FARTHEST = "  custom_measures: [{ name: farthest_mm, of: \"distance(index, start)\", take: max }]\n"


def minimum_jerk(share):
    x = min(max(share, 0), 1)
    return x**3 * (10 - 15 * x + 6 * x * x)


class ThroughVia(dh.Person):
    """Two strokes that overlap: the hand does not stop at the via point."""

    def __init__(self):
        self.state = ""

    def act(self, seen):
        if seen.state != self.state and seen.state in ("back", "lead in"):
            self.began, self.origin = seen.t, np.array(seen.fingers["index"])
        self.state = seen.state
        if self.state not in ("back", "lead in", "reach"):
            return
        t, via = seen.t - self.began, np.array([0, 0, 0.12])
        if self.state == "back":
            self.lead("index", self.origin + (np.array([0.06, -0.06, 0.12]) - self.origin) * minimum_jerk(t / 0.6))
            return
        self.lead("index", self.origin + (via - self.origin) * minimum_jerk(t / 0.4)
                  + np.array([0, 0.12, 0]) * minimum_jerk((t - 0.22) / 0.45))


class Paradigms(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.write("bodies: [{ name: ball, shape: sphere, radius_mm: 8, driven: yes, position_mm: [-60, 80, 120] }]\n"
                   "fingers: [{ name: index, shape: sphere, radius_mm: 6, mass_g: 1 }]\n", "ball.yaml")

    def write(self, text, name="task.yaml"):
        file = self.folder / name
        file.write_text(text)
        return str(file)

    def run_task(self, text, **options):
        return dh.run(self.write(text), out=str(self.folder / "out"), progress=False, **(options or {"simulate": True}))

    def perturbed_reaches(self, factor, perturbation, *measures):
        """The trials of reaches of 2 s, three at each level of the factor, all with this perturbation."""
        return self.run_task("title: Perturbed\n" + SPACE + "task:\n" + REGIONS + f"""
  cross: [{factor}]
  perturbations: [{{ name: perturbed, during: [reach], {perturbation} }}]
  states:
{BACK}
    - name: reach
      show: [target]
      exits: [{{ when: time, after_s: 2, outcome: reached }}]
      simulated_hand: [{{ duration_s: 0.5, reach: target }}]
  custom_measures: [{', '.join(measures)}]
  blocks: [{{ name: all, kind: perturbed, perturb: perturbed, repeats: 3 }}]
""").trials

    def test_the_end_of_a_reach_may_be_shown_later(self):
        """Terminal feedback through a prism, up to 2 s late (Kitazawa, Kohno and Uka 1995)."""
        session = self.run_task("title: Late feedback\n" + SPACE + "task:\n" + REGIONS + """
  cross: [{ factor: late_s, levels: [0, 0.5, 2] }]
  perturbations:
    - { name: prism, visual: { moves: [proxies], shift_mm: [30, 0, 0] } }
  states:
""" + BACK + """
    - name: reach
      show: { targets: [target], cursor: no }
      exits:
        - { when: outside, region: shell, to: wait }
        - { when: time, after_s: 2, outcome: too slow, redo: yes }
      simulated_hand: [{ duration_s: 0.5, reach: target, move_mm: [0, 20, 0] }]
    - name: wait
      show: { targets: [target], cursor: no }
      exits: [{ when: time, after_s: late, to: feedback }]
      simulated_hand: [{ duration_s: 0.4, reach: start }]
    - name: feedback
      show: { targets: [target], cursor: held, held_from: reach }
      exits: [{ when: time, after_s: 0.4, outcome: reached }]
  custom_measures:
    - { name: end_x_mm, of: index.x, take: last, during: [reach] }
    - { name: end_y_mm, of: index.y, take: last, during: [reach] }
    - { name: seen_x_mm, of: index.shown.x, take: first, during: [feedback] }
    - { name: seen_y_mm, of: index.shown.y, take: last, during: [feedback] }
  blocks: [{ name: all, kind: perturbed, perturb: prism, repeats: 3 }]
""")
        trials = session.trials
        np.testing.assert_allclose(trials.seen_x_mm, trials.end_x_mm + 30, atol=0.2)
        np.testing.assert_allclose(trials.seen_y_mm, trials.end_y_mm, atol=1)
        self.assertEqual(set(trials.late_s), {0, 0.5, 2})
        said = dihaptic("check", self.write("title: x\n" + SPACE + "task:\n" + REGIONS + """
  states: [{ name: a, show: { held_from: b }, exits: [{ when: time, after_s: 1, outcome: x }] }]
  blocks: [{ name: a, repeats: 1 }]
""")).stdout
        self.assertIn("held_from: 'b' is not a state", said)
        self.assertIn("held_from: is used only with 'cursor: held'", said)

    def test_what_is_seen_may_jump_early_or_late_in_a_reach(self):
        """Jumps at three times of a movement, and corrections that depend on them (Liu and Todorov 2007)."""
        trials = self.perturbed_reaches(
            "{ factor: jump_ms, levels: [100, 200, 300] }",
            "profile: { delay_ms: jump, rise_ms: jump / 4 }, visual: { moves: [proxies], shift_mm: [20, 0, 0] }",
            "{ name: began_ms, of: time_in_state, take: first, during: [reach], when: index.shown.x - index.x > 0.01 mm }",
            "{ name: half_ms, of: time_in_state, take: first, during: [reach], when: index.shown.x - index.x > 10 mm }",
        )
        self.assertEqual(sorted(trials.jump_ms), [100] * 3 + [200] * 3 + [300] * 3)
        np.testing.assert_allclose(trials.began_ms, trials.jump_ms, atol=1.5)
        np.testing.assert_allclose(trials.half_ms, 1.125 * trials.jump_ms, atol=1.5)

    def test_a_cursor_may_be_as_uncertain_as_the_trial_says(self):
        """Sensory noise that differs from trial to trial (Koerding and Wolpert 2004; van Beers 2012)."""
        trials = self.perturbed_reaches(
            "{ factor: blur_mm, levels: [0, 4, 16] }",
            "visual: { moves: [proxies], noise_mm: [blur, blur / 2, 0] }",
            "{ name: x_mm, of: index.shown.x - index.x, take: sd, during: [reach] }",
            "{ name: y_mm, of: index.shown.y - index.y, take: sd, during: [reach] }",
        )
        means = trials.groupby("blur_mm")[["x_mm", "y_mm"]].mean()
        for blur, of in means.iterrows():
            with self.subTest(blur=blur):
                self.assertAlmostEqual(of.x_mm, blur, delta=0.2 * blur + 1e-9)
                self.assertAlmostEqual(of.y_mm, blur / 2, delta=0.1 * blur + 1e-9)

    def test_the_weight_felt_and_the_friction_rubbed_are_those_of_the_trial(self):
        """Weights and surfaces that change without a sign (Johansson and Westling 1984, 1988)."""
        lifted = dh.run("experiments/first-trials.yaml", simulate=True, out=str(self.folder / "lifts"), progress=False)
        felt = lifted.table("phases").weight_felt.dropna()
        self.assertGreater(len(felt), 3)
        np.testing.assert_allclose(felt, 0.99, atol=0.02)
        for times, density in ((0.25, 1), (0.5, 2), (2, 1)):
            with self.subTest(times=times, density=density):
                pushed = self.run_task("title: Pushes\nscene: " + os.path.abspath("scenes/block-on-table.yaml") + f"""
hand: {{ centre_mm: [0, 0, 20], aperture_mm: 110 }}
task:
  perturbations: [{{ name: other, body: {{ body: block, friction_scale: {times}, density_scale: {density} }} }}]
  states:
    - name: push
      exits: [{{ when: time, after_s: 2, outcome: done }}]
      simulated_hand: [{{ duration_s: 1.5, move_mm: [70, 0, 0] }}]
  blocks: [{{ name: all, kind: perturbed, perturb: other }}]
""", simulate=False)
                rubbed = pushed.table("episodes").friction_ratio.dropna()
                self.assertGreater(len(rubbed), 0)
                np.testing.assert_allclose(rubbed, 1, atol=1e-3)

    def test_a_window_of_time_has_the_same_ticks_in_each_trial(self):
        """Corrections in fixed windows after a jump (Saunders and Knill 2003), after a drawn time of waiting."""
        trials = self.run_task("title: Windows\n" + SPACE + """task:
  draws: [{ name: wait_s, uniform: { from: 0.1, to: 0.3 } }]
  states:
    - { name: wait, exits: [{ when: time, after_s: wait, to: window }] }
    - { name: window, exits: [{ when: time, after_s: 0.5, outcome: done }] }
  custom_measures:
    - { name: first_s, of: time_in_state, take: min, during: [window], when: 150 ms <= time_in_state < 300 ms }
    - { name: last_s, of: time_in_state, take: max, during: [window], when: 150 ms <= time_in_state < 300 ms }
  blocks: [{ name: all, repeats: 20 }]
""").trials
        self.assertEqual((set(trials.first_s), set(trials.last_s)), ({0.15}, {0.299}))

    def test_a_person_who_sees_only_the_end_of_a_reach_stays_in_the_room_and_its_error_counts(self):
        """The reach is cut off at the target's distance, as in most studies of end-point feedback."""
        session = self.run_task("title: End points\n" + SPACE + "task:\n" + REGIONS + """
  perturbations:
    - { name: turned, visual: { moves: [proxies], about: start, axis: [0, 0, 1], angle_deg: 30 } }
  states:
""" + BACK + """
    - name: reach
      show: { targets: [target], cursor: no }
      exits:
        - { when: outside, region: shell, to: end point }
        - { when: time, after_s: 2, outcome: too slow, redo: yes }
      simulated_hand: [{ duration_s: 0.5, reach: target, move_mm: [0, 20, 0] }]
    - name: end point
      show: { targets: [target], cursor: held }
      exits: [{ when: time, after_s: 0.5, outcome: reached }]
  reach: { from: start, to: target, during: reach, distance_mm: 70 }
""" + FARTHEST + """
  blocks:
    - { name: before, kind: baseline, repeats: 8 }
    - { name: learn, kind: perturbed, perturb: turned, repeats: 40 }
    - { name: after, kind: washout, repeats: 8 }
""")
        self.assertLess(session.trials.farthest_mm.max(), 200)
        self.assertEqual(dihaptic("report", str(session.folder), *soak.TABLES).returncode, 0)
        curve = dh.load(session.folder).table("adaptation")
        learn = curve[curve.block == "learn"]
        self.assertEqual(set(learn.error_seen), {"yes"})
        np.testing.assert_allclose(np.abs(learn.perturbation), 30, atol=1)
        self.assertGreater(abs(learn.compensation.tail(8).mean()), 5)

    def test_a_large_turn_does_not_throw_a_person_out_of_the_room(self):
        """Random turns by up to 90 degrees (Braun, Aertsen, Wolpert and Mehring 2009)."""
        session = self.run_task("title: Turned by 86\n" + SPACE + "task:\n" + REGIONS + """
  perturbations:
    - { name: turned, during: [reach], visual: { moves: [proxies], about: start, axis: [0, 0, 1], angle_deg: 86 } }
  states:
""" + BACK + """
    - name: reach
      show: [target]
      exits:
        - { when: inside, region: target, shown: yes, outcome: reached }
        - { when: time, after_s: 2.5, outcome: missed }
      simulated_hand: [{ duration_s: 0.5, reach: target }]
""" + FARTHEST + """
  blocks: [{ name: turned, kind: perturbed, perturb: turned, repeats: 12 }]
""")
        self.assertLess(session.trials.farthest_mm.max(), 400)

    def test_turns_to_both_sides_have_no_mean(self):
        """Random turns, after which the washout still has one."""
        session = self.run_task("title: Random turns\n" + SPACE + "task:\n" + REGIONS + """
  draws: [{ name: side, permutation: [-1, 1] }]
  perturbations:
    - { name: turned, visual: { moves: [proxies], about: start, axis: [0, 0, 1], angle_deg: 20 * side } }
  states:
""" + BACK + """
    - name: reach
      show: [target]
      exits:
        - { when: inside, region: target, shown: yes, hold_s: 0.1, outcome: reached }
        - { when: time, after_s: 3, outcome: missed }
      simulated_hand: [{ duration_s: 0.5, reach: target }]
  reach: { from: start, to: target, during: reach, distance_mm: 50 }
  blocks:
    - { name: before, kind: baseline, repeats: 4 }
    - { name: random, kind: perturbed, perturb: turned, repeats: 12 }
    - { name: after, kind: washout, repeats: 4 }
""")
        self.assertEqual(dihaptic("report", str(session.folder), *soak.TABLES).returncode, 0)
        (fits,) = dh.load(session.folder).table("fits").to_dict("records")
        for window in ["early", "late", "catch", "savings", "rebound"]:
            self.assertTrue(np.isnan(fits[window]), window)
        self.assertEqual(fits["note"], "no early, late, catch, savings or rebound: the perturbation has both signs in random")
        self.assertTrue(np.isfinite(fits["baseline"]) and np.isfinite(fits["washout_first"]), fits)

    def test_forces_are_compared_only_while_the_channel_acts(self):
        """A lead-in to a via point without a channel, then a reach in one (Howard, Ingram and Wolpert 2012)."""
        task = "title: Lead-in\n" + SPACE.replace("[0, 0, 120]", "[0, 0, 120], impedance: { stiffness_N_m: 150, damping_Ns_m: 15 }") + """
task:
  regions:
    - { name: start, position_mm: [60, -60, 120], radius_mm: 10 }
    - { name: via, position_mm: [0, 0, 120], radius_mm: 12 }
    - { name: target, position_mm: [0, 120, 120], radius_mm: 12 }
  perturbations:
    - { name: curl, during: [reach], loads: [{ kind: curl, on: index, axis: [0, 0, 1], damping_Ns_m: 6 }] }
    - name: channel
      during: [reach]
      loads: [{ kind: channel, on: index, from: via, to: target, free: [0, 0, 1], stiffness_N_m: 2000, damping_Ns_m: 20 }]
  states:
""" + BACK.replace("to: reach }", "to: lead in }") + """
    - name: lead in
      show: [via, target]
      exits: [{ when: inside, region: via, to: reach }, { when: time, after_s: 2, outcome: too slow, redo: yes }]
      simulated_hand: [{ duration_s: 0.4, reach: via }]
    - name: reach
      show: [target]
      exits:
        - { when: "inside(hand, target) and still(hand, 20 mm/s)", hold_s: 0.1, outcome: reached }
        - { when: time, after_s: 2, outcome: too slow, redo: yes }
      simulated_hand: [{ duration_s: 0.4, reach: target }]
  measures: [adaptation_index, channel_force, reaction_time]
  movement: { of: index, from: via, to: target, during: [DURING], CONTINUES axis: [0, 0, 1], ideal: curl }
  blocks:
    - { name: field, kind: perturbed, perturb: curl, repeats: 12, insert: [{ kind: force_channel, perturb: channel, count: 4, gap: 1 }] }
"""
        whole = self.run_task(task.replace("DURING", "lead in, reach").replace("CONTINUES", ""), person=ThroughVia())
        self.compare_index(whole)
        # only the part from the via point on, where the hand is already moving
        moving = self.run_task(task.replace("DURING", "reach").replace("CONTINUES", "continues: yes,"), person=ThroughVia())
        self.compare_index(moving)
        self.assertTrue(moving.trials.reaction_time_s.isna().all())
        # no channel acts in the states of the way home, and not_measured says so for the movement found there
        home = self.run_task(task.replace("DURING", "back, lead in, reach").replace("CONTINUES", ""))
        channels = home.trials[home.trials.kind == "force_channel"]
        told = channels.not_measured.str.contains("no channel acted during the movement")
        self.assertTrue((told | channels.adaptation_index.isna() | (channels.adaptation_index != 0)).all())

    def compare_index(self, session):
        """Against a regression over the ticks of the state in which the channel acts."""
        channels = session.trials[session.trials.kind == "force_channel"]
        measured = channels[channels.adaptation_index.notna()]
        self.assertGreaterEqual(len(measured), 2, channels.not_measured.tolist())
        phase, trial, attempt = session["phase"], session["trial"], session["attempt"]
        velocity, force = session["index.handle_velocity"], session["index.force_sent"]
        for _, row in measured.iterrows():
            ticks = np.flatnonzero((trial == row.trial_num) & (attempt == row.attempt) & (phase == 3))
            v, f = velocity[ticks].astype(float), -force[ticks].astype(float)
            left = np.array([-1.0, 0, 0])
            ideal = -(6 * np.cross([0, 0, 1], v)) @ left
            # from the entry into the channel to where the movement ends: below 5 % of its peak
            speed = np.abs(v[:, 1])
            peak = speed[: np.argmax(speed) + 1].max()
            slow = np.flatnonzero((np.arange(len(speed)) > np.argmax(speed)) & (speed < 0.05 * peak))
            end = slow[0] if len(slow) else len(speed) - 1
            index = (f[: end + 1] @ left) @ ideal[: end + 1] / (ideal[: end + 1] @ ideal[: end + 1])
            self.assertAlmostEqual(row.adaptation_index, index, delta=0.03)

    def test_a_driven_body_that_jumps_is_told(self):
        """A pursuit target whose path goes on over three states, written over the time in the trial."""
        said = dihaptic("run", self.write("title: Pursuit\nscene: ball.yaml\ntask:\n  states:\n" + "".join(f"""
    - name: {name}
      drive: [{{ body: ball, along: ["100 mm/s * {clock}", "0 mm", "0 mm"] }}]
      exits: [{{ when: time, after_s: 0.5, {exit} }}]
""" for name, clock, exit in [("one", "time_in_state", "to: two"), ("two", "time_in_trial", "outcome: done")]) + """
  blocks: [{ name: all, repeats: 1 }]
"""), "--simulate", "--out", str(self.folder / "out"))
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertRegex(said.stdout, r"WARNING: 'ball' jumped by 50 mm in one tick at 0\.50\d s")

    def test_a_rule_sees_the_measure_that_the_table_has(self):
        """A moving target is rewarded by the distance at which it was hit (Brenner and Smeets 1996)."""
        session = self.run_task("title: Interception\nscene: ball.yaml\nhand: { centre_mm: [0, 0, 120] }\ntask:\n" + REGIONS + """
  cross: [{ factor: speed_mm_s, levels: [100, 300] }]
  variables: [{ name: miss_mm }, { name: when_s }, { name: rate_mm_s }]
  states:
""" + BACK.replace("show: [start]", "show: [start]\n      place: [{ body: ball, position_mm: [-60, 80, 120] }]") + """
    - name: reach
      drive: [{ body: ball, along: ["speed * time_in_state", "0 mm", "0 mm"] }]
      exits: [{ when: index.y > 60 mm, outcome: hit }, { when: time, after_s: 1.5, outcome: late }]
      simulated_hand: [{ duration_s: 0.35, reach: target }]
  custom_measures:
    - { name: error_mm, of: index.x - ball.x, take: last, during: [reach] }
    - { name: hit_time_s, of: time_in_state, take: last, during: [reach] }
    - { name: speed_y_mm_s, of: rate(index.y), take: last, during: [reach] }
  after_trial:
    - { set: miss_mm, to: measure.error }
    - { set: when_s, to: measure.hit_time }
    - { set: rate_mm_s, to: measure.speed_y }
  blocks: [{ name: hits, repeats: 5 }]
""")
        trials = session.trials
        for column, rule in [("error_mm", "next_miss_mm"), ("hit_time_s", "next_when_s"), ("speed_y_mm_s", "next_rate_mm_s")]:
            np.testing.assert_allclose(trials[rule], trials[column], rtol=1e-6, atol=1e-6, err_msg=column)

    def test_a_person_of_ones_own_reports_an_aim_to_the_left(self):
        """Aims are numbers on both sides of the target (Taylor, Krakauer and Ivry 2014)."""

        class Person(dh.Person):
            def __init__(self, keys):
                self.keys = keys

            def act(self, seen):
                if self.keys:
                    self.press(self.keys.pop(0))

        for keys, answer in [(["-", "5", "Enter"], -5), (["-", "1", "2"], -12), (["1", "2"], 12), (["1", "Backspace", "7", "Enter"], 7)]:
            session = self.run_task("title: Aim\n" + SPACE + """task:
  states:
    - name: aim
      ask: { name: aim, scale: numbers, from: -30, to: 30 }
      exits: [{ when: answered, outcome: told }, { when: time, after_s: 3, outcome: silent }]
  blocks: [{ name: aims, repeats: 1 }]
""", person=Person(list(keys)))
            self.assertEqual(session.trials.aim.tolist(), [answer], keys)


if __name__ == "__main__":
    unittest.main(verbosity=2)
