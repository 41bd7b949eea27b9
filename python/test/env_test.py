"""Environments keep the interface that learners use, and can be solved."""

import importlib.util
import subprocess
import sys
import unittest
import warnings

import numpy as np

import dihaptic as dh

NO_GYMNASIUM = "python3-gymnasium is not installed, which Debian 12 and 13 do not have"
TASKS = {"lift": "Lift", "turn": "Turn", "hand_over": "HandOver"}


def toward(environment, places, seconds):
    """Steps with each finger's target moving to a place at up to 0.2 m/s; the last step's answer."""
    one = environment._one if isinstance(environment, dh.env.Grasp) else environment
    for _ in range(round(seconds / one.step_time)):
        gap = np.asarray(places) - one._targets[0, :, :3]
        speed = np.clip(gap / one.step_time, -0.2, 0.2) / 0.3
        answer = environment.step(speed.ravel())
        if answer[2]:
            break
    return answer


class Environments(unittest.TestCase):
    def test_spaces_hold_what_comes(self):
        for task, fingers in (("lift", 2), ("turn", 2), ("hand_over", 4)):
            with self.subTest(task):
                environment = dh.env.Grasp(task, seed=4, time=0.2)
                seen, info = environment.reset()
                self.assertEqual(environment.action_space.shape, (3 * fingers,))
                self.assertTrue(environment.observation_space.contains(seen))
                self.assertEqual(set(info), {"distance", "success"})
                for i in range(20):
                    seen, reward, terminated, truncated, info = environment.step(environment.action_space.sample())
                    self.assertTrue(environment.observation_space.contains(seen))
                    self.assertIsInstance(reward, float)
                    self.assertEqual((terminated, truncated), (False, i == 19))

    def test_the_same_seed_is_the_same_episode(self):
        def episode():
            environment = dh.env.Grasp("lift", seed=9)
            seen = [environment.reset()[0]]
            seen += [environment.step(environment.action_space.sample())[0] for _ in range(50)]
            return np.array(seen)

        np.testing.assert_array_equal(episode(), episode())

    def test_a_reset_is_a_beginning(self):
        environment = dh.env.Grasp("lift")
        first = environment.reset(seed=5)[0]
        for _ in range(30):
            environment.step(np.ones(6))
        np.testing.assert_array_equal(environment.reset(seed=5)[0], first)

    def test_what_is_seen_is_the_world(self):
        environment = dh.env.Grasp("lift")
        environment.reset()
        seen = environment.step(np.ones(6))[0]
        world = environment.world
        np.testing.assert_array_equal(seen[:3], world["thumb.handle_position"])
        np.testing.assert_array_equal(seen[13:16], world["index.handle_velocity"])
        np.testing.assert_array_equal(seen[20:23], world["block.position"])
        np.testing.assert_array_equal(seen[23:27], world["block.orientation"])

    def test_a_block_is_lifted_to_its_goal(self):
        environment = dh.env.Grasp("lift", seed=2)
        goal = environment.reset()[0][-1]
        near, far = 0.018, 0.05
        toward(environment, [(-far, 0, 0.02), (far, 0, 0.02)], 0.3)
        toward(environment, [(-near, 0, 0.02), (near, 0, 0.02)], 0.8)
        # the weight bends the hand by what the muscles give way
        up = 0.0215 + goal
        _, reward, terminated, _, info = toward(environment, [(-near, 0, up), (near, 0, up)], 2.5)
        self.assertTrue(terminated, info)
        self.assertEqual(reward, 1)
        self.assertTrue(info["success"])

    def test_a_block_changes_hands(self):
        environment = dh.env.Grasp("hand_over", seed=2)
        goal = environment.reset()[0][-1]
        start = environment._one._targets[0, :, :3].copy()
        close = 0.018
        closed = start.copy()
        closed[:2, 0] = np.sign(start[:2, 0]) * close
        toward(environment, closed, 1.0)
        lifted = closed.copy()
        lifted[:2, 2] += goal + 0.001
        toward(environment, lifted, 1.0)
        taken = lifted.copy()
        taken[2:, 2] = lifted[0, 2]
        toward(environment, taken, 1.0)
        taken[2:, 1] = np.sign(start[2:, 1]) * close
        toward(environment, taken, 1.0)
        let_go = taken.copy()
        let_go[:2, 0] = start[:2, 0]
        _, _, terminated, _, info = toward(environment, let_go, 1.5)
        self.assertTrue(terminated, info)

    def test_many_are_each_as_one_alone(self):
        many = dh.env.Grasps("lift", 3, seed=7)
        many.reset()
        actions = np.random.default_rng(1).uniform(-1, 1, (40, 3, 6))
        for a in actions:
            seen, reward, *_ = many.step(a)
        alone = dh.env.Grasps("lift", 1, seed=8)  # the second of them
        alone.reset()
        for a in actions:
            seen_alone, *_ = alone.step(a[1:2])
        np.testing.assert_array_equal(seen[1, :-1], seen_alone[0, :-1])
        self.assertEqual(reward.shape, (3,))

    def test_some_are_reset_alone(self):
        many = dh.env.Grasps("lift", 2)
        many.reset()
        for _ in range(10):
            seen, *_ = many.step(np.ones((2, 6)))
        after, _ = many.reset(np.array([False, True]))  # as terminated and truncated are
        np.testing.assert_array_equal(after[0, :-1], seen[0, :-1])
        self.assertFalse(np.array_equal(after[1, :-1], seen[1, :-1]))
        self.assertEqual(many.worlds[1].t, 0)
        again, _ = many.reset(options={"reset_mask": np.array([False, True])})
        np.testing.assert_array_equal(again[:, :-1], after[:, :-1])

    def test_bad_input_is_told(self):
        with self.assertRaisesRegex(dh.Error, "task: is 'juggle'. Tasks are: lift, turn, hand_over"):
            dh.env.Grasp("juggle")
        for n, ticks in ((0, 10), (1, 0)):
            with self.assertRaisesRegex(dh.Error, "is below 1"):
                dh.env.Grasps("lift", n, ticks=ticks)
        with self.assertRaisesRegex(dh.Error, r"Call reset\(\) first"):
            dh.env.Grasp("lift").step(np.zeros(6))
        many = dh.env.Grasps("lift", 2)
        many.reset()
        with self.assertRaises(ValueError):
            many.step(np.zeros(5))
        with self.assertRaisesRegex(dh.Error, "not a number"):
            many.step(np.full((2, 6), np.nan))
        with self.assertRaisesRegex(dh.Error, "options: has 'goal'. Allowed names: reset_mask"):
            many.reset(options={"goal": 0.1})
        with self.assertRaisesRegex(dh.Error, "options: has 'goal'. Leave it out"):
            dh.env.Grasp("lift").reset(options={"goal": 0.1})
        many.step(np.zeros((2, 6)))  # it is as if that had not been
        for which in ([0.7], [5], [-1], [True], "x"):
            with self.subTest(which), self.assertRaisesRegex(dh.Error, "which: is"):
                many.reset(which)

    def test_many_have_spaces_of_all_and_of_one(self):
        many = dh.env.Grasps("turn", 3)
        self.assertEqual(many.num_envs, 3)
        for all_of_them, one in ((many.action_space, many.single_action_space), (many.observation_space, many.single_observation_space)):
            self.assertEqual(all_of_them.shape, (3, *one.shape))
        seen, _ = many.reset()
        self.assertTrue(many.observation_space.contains(seen))
        seen, *_ = many.step(many.action_space.sample())
        self.assertTrue(many.single_observation_space.contains(seen[1]))

    def test_do_the_same_without_gymnasium(self):
        code = """
import sys
{}
import numpy as np
import dihaptic as dh
one, many = dh.env.Grasp("turn", seed=3), dh.env.Grasps("lift", 2, seed=3)
print([base.__module__ for base in (*type(one).__bases__, *type(many).__bases__)], file=sys.stderr)
print(one.render_mode, one.metadata["render_modes"], many.reset()[0].sum(), one.reset()[0].sum(), one.reset(seed=5)[0].sum())
for _ in range(20):
    seen = one.step(np.full(6, 0.5))[0]
print(seen.sum(), many.step(np.full((2, 6), 0.5))[0].sum())
one.close(), many.close()
"""
        said = []
        for hide in ("", "sys.modules['gymnasium'] = None"):
            done = subprocess.run([sys.executable, "-c", code.format(hide)], capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            said.append(done.stdout)
        self.assertIn("dihaptic.env", done.stderr)
        self.assertEqual(said[0], said[1])


@unittest.skipIf(importlib.util.find_spec("gymnasium") is None, NO_GYMNASIUM)
class OfGymnasium(unittest.TestCase):
    def test_pass_its_own_check(self):
        import gymnasium
        from gymnasium.utils.env_checker import check_env

        for task, name in TASKS.items():
            with self.subTest(task), warnings.catch_warnings(record=True) as warned:
                warnings.simplefilter("always")
                made = gymnasium.make(f"Dihaptic/{name}-v0", time=2.0)
                self.assertIsInstance(made.unwrapped, dh.env.Grasp)
                self.assertEqual(made.action_space.shape, (3 * len(made.unwrapped.world.fingers),))
                check_env(made.unwrapped)
                # where a hand and a block are has no bounds
                told = [str(one.message) for one in warned]
                self.assertEqual([text for text in told if "observation space m" not in text], [])
                self.assertEqual(len(told), 2)

    def test_many_are_made_by_one_call(self):
        import gymnasium

        with warnings.catch_warnings():
            warnings.simplefilter("error")
            many = gymnasium.make_vec("Dihaptic/Turn-v0", num_envs=3, seed=7, time=0.1)
            self.assertIsInstance(many, dh.env.Grasps)
            self.assertIsInstance(many, gymnasium.vector.VectorEnv)
            self.assertEqual(many.metadata["autoreset_mode"], gymnasium.vector.AutoresetMode.DISABLED)
            many = gymnasium.wrappers.vector.RecordEpisodeStatistics(many)
            many.reset(seed=3)
            for _ in range(10):
                seen, reward, terminated, truncated, info = many.step(many.action_space.sample())
            self.assertTrue(truncated.all())
            self.assertEqual(info["episode"]["l"].tolist(), [10, 10, 10])
            many.reset(options={"reset_mask": truncated})
            self.assertFalse(many.step(many.action_space.sample())[3].any())
            many.close()


if __name__ == "__main__":
    unittest.main()
