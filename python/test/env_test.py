"""Environments keep the interface that learners use, and can be solved."""

import unittest

import numpy as np

import dihaptic as dh


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

    def test_bad_input_is_told(self):
        with self.assertRaisesRegex(dh.Error, "task: is 'juggle'. There are: lift, turn, hand_over"):
            dh.env.Grasp("juggle")
        for n, ticks in ((0, 10), (1, 0)):
            with self.assertRaisesRegex(dh.Error, "no world"):
                dh.env.Grasps("lift", n, ticks=ticks)
        with self.assertRaisesRegex(dh.Error, r"Call reset\(\) first"):
            dh.env.Grasp("lift").step(np.zeros(6))
        many = dh.env.Grasps("lift", 2)
        many.reset()
        with self.assertRaises(ValueError):
            many.step(np.zeros(5))
        with self.assertRaisesRegex(dh.Error, "no number"):
            many.step(np.full((2, 6), np.nan))
        many.step(np.zeros((2, 6)))  # it is as if that had not been
        for which in ([0.7], [5], [-1], [True], "x"):
            with self.subTest(which), self.assertRaisesRegex(dh.Error, "which: is"):
                many.reset(which)


if __name__ == "__main__":
    unittest.main()
