"""Classic experiments with objects: each is rehearsed, and does what its paper, or mechanics, says.

Usage: paradigms_of_objects_test.py PROGRAM, from the project's folder.
"""
import csv
import pathlib
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np

PROGRAM = sys.argv.pop(1) if len(sys.argv) > 1 else "build/release/dihaptic"
G = 9.81  # gravity in the scenes [m/s^2]


class Person:
    """What a simulated person did: the rows of trials.csv, and what each tick recorded."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        with open(self.folder / "trials.csv", newline="") as file:
            self.trials = list(csv.DictReader(file))
        with open(self.folder / "phases.csv", newline="") as file:
            names = [row["phase"] for row in csv.DictReader(file)]
        with h5py.File(self.folder / "session.nwb", "r") as nwb:
            self.series = {name: (one["data"][:], one["timestamps"][:] if "timestamps" in one else None)
                           for name, one in nwb["acquisition"].items() if "data" in one}
            self.series |= {name: (np.column_stack([one[column][:] for column in one.attrs["colnames"][1:]]), one["time"][:])
                            for name, one in nwb["acquisition"].items() if "colnames" in one.attrs}
        self.trial, self.phase = self["trial"].astype(int), self["phase"].astype(int)
        self.attempt = self["attempt"].astype(int)
        self.time = np.arange(len(self.trial)) * 1e-3
        self.states = list(dict.fromkeys(names))

    def __getitem__(self, name):
        return self.series[name][0].astype(float)

    def ticks(self, row, phase=None):
        """Which ticks belong to an attempt, and to its state with that number, from 1."""
        out = (self.trial == int(row["trial_num"])) & (self.attempt == int(row["attempt"])) & (self.phase > 0)
        return np.nonzero(out if phase is None else out & (self.phase == phase))[0]

    def rows(self, name, tick):
        """Items of a list that were recorded in a tick."""
        data, times = self.series[name]
        first, last = np.searchsorted(times, [self.time[tick] - 5e-4, self.time[tick] + 5e-4])
        return data[first:last].astype(float)

    def load_on(self, body, ticks):
        """Sum of the task's forces on a body, or a handle, in each of the ticks."""
        if "task_loads" not in self.series:
            return np.zeros((len(ticks), 3))
        data, times = self.series["task_loads"]
        out = np.zeros((len(self.time), 3))
        own = data[:, 0] == body
        np.add.at(out, np.round(times[own] * 1e3).astype(int), data[own, 1:4])
        return out[ticks]


class Paradigms(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.out = tempfile.TemporaryDirectory()

    @classmethod
    def tearDownClass(cls):
        cls.out.cleanup()

    def rehearse(self, name, outcomes, asks=False):
        """One person's session of the experiment, which has to end, to end as it should, and to have a report."""
        file, out = f"experiments/{name}.yaml", f"{self.out.name}/{name}"
        check = subprocess.run([PROGRAM, "check", file], capture_output=True, text=True)
        self.assertEqual(check.returncode, 0, check.stdout)
        warnings = [line for line in check.stdout.splitlines() if "warning:" in line]
        self.assertEqual(len(warnings), 1 if asks else 0, warnings)
        if asks:
            self.assertIn("their answers are arbitrary", warnings[0])
        subprocess.run([PROGRAM, "rehearse", file, "--people", "1", "--keep-recordings", "--out", out], check=True,
                       capture_output=True)
        person = Person(f"{out}/sim-001")
        self.assertLessEqual({row["outcome"] for row in person.trials}, set(outcomes))
        subprocess.run([PROGRAM, "report", str(person.folder)], check=True, capture_output=True)
        self.assertIn(">Quality of the data</h2>", (person.folder / "report.html").read_text())
        return person

    def assert_drawn_equally(self, trials, *columns):
        """Each combination of these columns' values comes equally often."""
        counts = {}
        for row in trials:
            key = tuple(row[column] for column in columns)
            counts[key] = counts.get(key, 0) + (row["attempt"] == "1")
        self.assertEqual(len(set(counts.values())), 1, counts)

    # 4. Ernst and Banks 2002

    def test_cue_integration(self):
        person = self.rehearse("cue-integration", {"left", "right", "not felt"}, asks=True)
        bars = ["standard", "bar_49", "bar_52", "bar_55", "bar_58", "bar_61"]
        self.assert_drawn_equally([row for row in person.trials if row["block"] == "clear"], "modality", "width_mm")
        felt = person["index_proxy_position"][:, 0] - person["thumb_proxy_position"][:, 0] - 5e-3  # less half of each pad
        for row in person.trials:
            if row["outcome"] == "not felt":
                continue
            at = person.ticks(row)[400]
            hidden = {bars[int(body) - 2] for body, hides, _, _ in person.rows("task_looks", at) if hides and body >= 2}
            self.assertEqual(hidden, set(bars))  # all are hidden until the trial's modality is known
            if row["modality"] == "vision":
                self.assertEqual(float(row["peak_force_N"]), 0)
                self.assertGreater(person["standard_position"][at][1], 0.05)
                continue
            states = (2, 3) if row["modality"] == "touch" else (5, 6)
            comparison = {-1: states[0], 1: states[1]}[int(row["side"])]
            for state in states:
                ticks = person.ticks(row, state)
                last = ticks[-1]
                width = float(row["width_mm"]) if state == comparison else 55
                self.assertAlmostEqual(1e3 * felt[last], width, delta=0.2, msg=row["condition"])
                looks = {int(body): (hides, scale) for body, hides, _, scale in person.rows("task_looks", last)}
                if row["modality"] == "touch":
                    self.assertEqual({body for body, (hides, _) in looks.items() if hides}, set(range(2, 8)))
                else:
                    self.assertEqual({body for body, (hides, _) in looks.items() if hides}, set())
                    self.assertAlmostEqual(55 * looks[2][1], 58, delta=0.01)  # seen 3 mm wider than felt
        trembling = [row["perturbation"] for row in person.trials if row["block"] == "shaken"]
        self.assertEqual(trembling, ["trembling"] * 5)

    # 5. Hasson, Shen and Sternad 2012

    def test_cup_of_coffee(self):
        person = self.rehearse("cup-of-coffee", {"carried", "spilled", "too slow"})
        self.assert_drawn_equally(person.trials, "angle_deg")
        length = 0.1 + 0.4 * 0.01**2 / 0.1  # with the ball's own inertia
        for row in person.trials:
            ticks = person.ticks(row, 2)
            angle = person["swing_angle"][ticks]
            self.assertAlmostEqual(np.degrees(angle[0]), float(row["angle_deg"]), delta=0.1)
            spilled = np.any(np.abs(np.degrees(angle)) > 50)
            self.assertEqual(row["outcome"] == "spilled", spilled)
            # velocities are those of the middle of a step, so their differences are rates at its end
            ticks, angle = ticks[:-1], angle[:-1]
            rates = person["swing_angular_velocity"][np.append(ticks, ticks[-1] + 1)]
            acceleration = np.diff(person["cup_velocity"][np.append(ticks, ticks[-1] + 1), 0]) / 1e-3
            asked = -(G * np.sin(angle) + acceleration * np.cos(angle)) / length
            self.assertLess(np.max(np.abs(np.diff(rates) / 1e-3 - asked)), 1e-2)  # accelerations reach 100 rad/s^2
            expected = pendulum(angle[0], rates[:2].mean(), acceleration, length)
            self.assertLess(np.max(np.degrees(np.abs(angle - expected))), 0.1)
            to_ball = person["ball_position"][ticks] - person["cup_position"][ticks]
            np.testing.assert_allclose(np.arctan2(to_ball[:, 0], -to_ball[:, 2]), angle, atol=1e-6)
            self.assertLess(np.max(np.abs(np.linalg.norm(to_ball, axis=1) - 0.1)), 1e-6)
            # the hinge's force bears the ball's weight and keeps the ball on the circle
            rate = (rates[1:] + rates[:-1]) / 2
            pull = 0.06 * (G * np.cos(angle) + 0.1 * rate**2 - acceleration * np.sin(angle))
            along = np.sum(person["swing_force"][ticks] * -to_ball / 0.1, axis=1)
            self.assertLess(np.max(np.abs(along - pull)[2:-2]), 0.02)

    # 6. Burdet et al. 2001

    def test_divergent_field(self):
        person = self.rehearse("divergent-field", {"reached", "driven off", "too slow"})
        handle = 1  # bodies come first: 0 is the table, 1 the index finger
        deviations = {"baseline": [], "perturbed": [], "catch": [], "washout": []}
        for row in person.trials:
            if row["lateral_deviation_mm"]:
                deviations[row["kind"]].append(float(row["lateral_deviation_mm"]))
            ticks = person.ticks(row)
            ticks = ticks[person.phase[ticks] >= 2][:-1]  # in the trial's last tick, no load acts any more
            pushed = person.load_on(handle, ticks)[:, 0]
            if row["kind"] != "perturbed":
                self.assertEqual(np.max(np.abs(pushed)), 0)
                continue
            x = person["index_handle_position"][ticks, 0]
            risen = np.arange(len(ticks)) >= 50  # the load's profile takes 50 ms
            inside, beyond = np.abs(x) < 0.025, np.abs(x) > 0.04
            np.testing.assert_allclose(pushed[risen & inside], 120 * x[risen & inside], atol=1e-5)
            self.assertLessEqual(np.max(np.abs(pushed), initial=0), 120 * 0.025 * 1.001)  # beyond 25 mm the force only fades
            np.testing.assert_array_equal(pushed[beyond], 0)
            # a trial ends with 'driven off' exactly if the hand was beyond 25 mm
            self.assertEqual(row["outcome"] == "driven off", bool(np.any(np.abs(x) > 0.025)))
        spread = {kind: np.sqrt(np.mean(np.square(values))) for kind, values in deviations.items()}
        self.assertGreater(spread["perturbed"], 1.2 * spread["baseline"])
        self.assertGreater(spread["perturbed"], 1.2 * spread["washout"])
        # deviations go to both sides
        self.assertGreater(np.max(deviations["perturbed"]), 10)
        self.assertLess(np.min(deviations["perturbed"]), -10)

    # 7. Nisky, Mussa-Ivaldi and Karniel 2008

    def test_delayed_stiffness(self):
        person = self.rehearse("delayed-stiffness", {"standard stiffer", "comparison stiffer"}, asks=True)
        self.assert_drawn_equally(person.trials, "k_N_m", "late_ms")
        self.assert_drawn_equally(person.trials, "first")
        handle, surface = 1, 0.122
        depth = np.maximum(0, surface - person["index_handle_position"][:, 2])
        for row in person.trials:
            standard, comparison = person.ticks(row, 2), person.ticks(row, 3)
            self.assertEqual(row["first"] == "standard", standard[0] < comparison[0])
            for ticks, stiffness, late in ((standard, 85, 0),
                                           (comparison, float(row["k_N_m"]), int(row["late_ms"]))):
                pushed = person.load_on(handle, ticks)[:, 2]
                np.testing.assert_allclose(pushed, stiffness * depth[ticks - late], atol=1e-5)
                self.assertGreater(np.max(pushed), 0.5)
                above = person["index_handle_position"][ticks, 2] > surface + 5e-3
                self.assertEqual(np.sum(~above[1:] & above[:-1]), 5)  # probes

    # 8. Tan, Durlach, Beauregard and Srinivasan 1995

    def test_squeeze_spring(self):
        person = self.rehearse("squeeze-spring", {"hard", "soft"}, asks=True)
        self.assert_drawn_equally(person.trials, "K_N_m")
        for row in person.trials:
            force, squeezed, k = (float(row[name]) for name in ("next_force_N", "next_squeezed_mm", "K_N_m"))
            self.assertAlmostEqual(force, k * squeezed * 1e-3, delta=0.02 * force)  # F = K x
            last = person.ticks(row)[-2]  # in the last tick, no load acts any more
            displacement = person["spring_displacement"][last]
            self.assertAlmostEqual(person["spring_force"][last, 0], -k * displacement, delta=0.01)

    # 11. Bracewell et al. 2003

    def test_bimanual_bar(self):
        person = self.rehearse("bimanual-bar", {"lifted", "not lifted", "tilted", "dropped"})
        lifted = [row for row in person.trials if row["outcome"] == "lifted"]
        self.assertEqual(len(lifted), 12)
        bar, weight = 0.120 * G, 0.080 * G
        tilts = {"left": [], "middle": [], "right": []}
        for row in lifted:
            last = person.ticks(row)[-1]
            left, right = (np.mean([person[f"{hand}_{finger}_proxy_position"][last, 0] for finger in
                                    ("thumb", "index")]) for hand in ("left", "right"))
            middle, aside = person["bar_position"][last, 0], person["weight_position"][last, 0]
            share = (bar * (middle - left) + weight * (aside - left)) / (right - left)  # moments about the left hand
            self.assertAlmostEqual(float(row["next_right_load_N"]), share, delta=0.02)
            self.assertAlmostEqual(float(row["next_left_load_N"]), bar + weight - share, delta=0.02)
            for hand in ("left", "right"):  # no hand lets it slip
                self.assertGreater(0.8 * 2 * float(row[f"next_{hand}_grip_N"]), float(row[f"next_{hand}_load_N"]))
            tilts[row["condition"].split()[-1]].append(float(row["next_tilt_deg"]))
        # both simulated hands yield equally, so that the side with the weight is lower
        self.assertGreater(np.mean(tilts["right"]), np.mean(tilts["middle"]))
        self.assertLess(np.mean(tilts["left"]), np.mean(tilts["middle"]))

    # 12. Johansson and Westling 1988

    def test_ball_into_cup(self):
        person = self.rehearse("ball-into-cup", {"held", "not lifted", "dropped", "lost", "not put down"})
        held = [row for row in person.trials if row["outcome"] == "held"]
        self.assertGreaterEqual(len(held), 18)
        answers = []
        for row in held:
            wait = person.ticks(row, 2)
            self.assertAlmostEqual(len(wait) * 1e-3, float(row["wait_s"]), delta=2e-3)
            hangs = person["ball_position"][wait, 2]
            np.testing.assert_allclose(hangs, 0.22, atol=1.1 * G * 1e-6)  # except for the fall in one tick
            drop = person.ticks(row, 3)
            self.assertEqual(len(drop) > 0, row["ball_falls"] == "yes")
            if row["ball_falls"] == "no":
                self.assertEqual(row["not_measured"], "grip_latency: no load step")
                self.assertGreater(np.min(person["ball_position"][person.ticks(row, 4), 2]), 0.219)
                continue
            height = person["ball_position"][drop[0], 2] - 0.010 - (person["cup_position"][drop[0], 2] + 0.020)
            fall = np.sqrt(2 * height / G)
            speed = person["ball_velocity"][drop, 2]
            landed = np.nonzero(np.diff(speed) > 0.1)[0][0] + 1
            self.assertAlmostEqual(landed * 1e-3, fall, delta=3e-3)
            self.assertAlmostEqual(speed[landed - 1], -G * fall, delta=0.03)
            answers.append(float(row["grip_latency_s"]) - fall)
        # Johansson and Westling found 60 to 100 ms after the impact; simulated people differ by up to 20 ms
        self.assertGreater(np.median(answers), 0.04)
        self.assertLess(np.median(answers), 0.12)
        self.assertGreater(len(answers), 10)

    # 13. Mason and MacKenzie 2005

    def test_pass_block(self):
        person = self.rehearse("pass-block", {"passed", "not lifted", "dropped", "not taken", "not let go",
                                              "not put down"})
        passed = [row for row in person.trials if row["outcome"] == "passed"]
        self.assertGreaterEqual(len(passed), 8)
        hands = {hand: [f"{hand}_{finger}" for finger in ("thumb", "index")] for hand in ("right", "left")}
        grips = {hand: np.min([person[f"{finger}_normal_force"] for finger in fingers], axis=0)
                 for hand, fingers in hands.items()}
        loads = {hand: -sum(person[f"{finger}_contact_force"][:, 2] for finger in fingers)
                 for hand, fingers in hands.items()}
        for row in passed:
            weight = float(row["mass_g"]) * 1e-3 * G
            offer, both, carry = (person.ticks(row, state) for state in (2, 3, 4))
            self.assertEqual(np.max(grips["left"][offer[:300]]), 0)  # the right hand holds it alone
            self.assertAlmostEqual(loads["right"][offer[0]], weight, delta=0.1 * weight)
            self.assertTrue(np.all(grips["left"][offer[-100:]] > 0) and np.all(grips["right"][offer[-100:]] > 0))
            shared = both[:100]
            np.testing.assert_allclose(np.mean((loads["left"] + loads["right"])[shared]), weight, rtol=0.03)
            self.assertEqual(np.max(grips["right"][both[-50:]]), 0)  # the left hand holds it alone
            self.assertAlmostEqual(loads["left"][both[-1]], weight, delta=0.1 * weight)
            self.assertGreater(np.min(person["block_position"][np.concatenate([offer, both]), 2]), 0.08)  # it never fell
            self.assertAlmostEqual(person["block_position"][carry[-1], 2], 0.02, delta=2e-3)
            self.assertGreater(float(row["reaction_time_s"]), 0.1)  # nobody lets go before the signal

    # 14. Johansson et al. 2001

    def test_carry_over_wall(self):
        person = self.rehearse("carry-over-wall", {"carried", "not lifted", "hit the wall", "dropped", "not there",
                                                   "beside the goal", "not put down"})
        self.assert_drawn_equally(person.trials, "height_mm")
        heights = {}
        walls = {"20": ("low_wall", 2), "50": ("high_wall", 3)}
        for row in person.trials:
            ticks = person.ticks(row)
            if row["height_mm"] in walls:
                wall, body = walls[row["height_mm"]]
                np.testing.assert_allclose(person[f"{wall}_position"][ticks[0]], [0, 0, float(row["height_mm"]) / 2e3],
                                           atol=1e-3)
                touches = self.touches(person, 1, body, ticks)
                self.assertEqual(row["outcome"] == "hit the wall", touches)
            if row["outcome"] != "carried":
                continue
            block = person["block_position"][ticks]
            over = np.abs(block[:, 0]) < 0.024  # part of the block is above the wall
            self.assertGreater(np.min(block[over, 2]) - 0.020, float(row["height_mm"]) * 1e-3)
            self.assertLess(np.linalg.norm(block[-1] - [0.07, 0, 0.02]), 0.02)  # it ends in the goal
            heights.setdefault(row["height_mm"], []).append(1e3 * np.max(block[over, 2]))
        means = [np.mean(heights[height]) for height in ("0", "20", "50")]
        # paths lead 30 mm above each wall; direction noise of 5 degrees over 140 mm makes a path vary by about 12 mm,
        # and a mean by 6
        self.assertAlmostEqual(means[1] - means[0], 20, delta=15)
        self.assertAlmostEqual(means[2] - means[0], 50, delta=15)

    @staticmethod
    def touches(person, a, b, ticks):
        """Whether two bodies pressed each other by more than 0.02 N."""
        data, times = person.series["contacts"]
        own = (times >= person.time[ticks[0]] - 5e-4) & (times <= person.time[ticks[-1]] + 5e-4)
        rows = data[own]
        pair = ((rows[:, 0] == a) & (rows[:, 1] == b)) | ((rows[:, 0] == b) & (rows[:, 1] == a))
        return bool(np.any(pair))


def pendulum(angle, speed, acceleration, length):
    """Angles of a pendulum whose pivot is accelerated sideways, by Runge and Kutta."""
    def rate(y, a):
        return np.array([y[1], -(G * np.sin(y[0]) + a * np.cos(y[0])) / length])

    out, h = [np.array([angle, speed])], 1e-3
    for a, b in zip(acceleration, acceleration[1:]):
        y, middle = out[-1], (a + b) / 2
        k1 = rate(y, a)
        k2 = rate(y + h / 2 * k1, middle)
        k3 = rate(y + h / 2 * k2, middle)
        out.append(y + h / 6 * (k1 + 2 * k2 + 2 * k3 + rate(y + h * k3, b)))
    return np.array(out)[:, 0]


if __name__ == "__main__":
    unittest.main()
