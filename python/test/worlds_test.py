"""A world that Python steps is the program's own, to the bit."""

import copy
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy as np

import dihaptic as dh

BLOCK = "scenes/block-on-table.yaml"


STATE = ("grip_force", "block.position", "block.orientation", "thumb.force_sent")


def states(world):
    return np.concatenate([np.ravel(world[name]) for name in STATE])


class Worlds(unittest.TestCase):
    def test_its_ticks_are_those_of_a_session(self):
        """With a director that does nothing, in every other tick."""
        with tempfile.TemporaryDirectory() as folder:
            session = dh.run(BLOCK, out=folder, progress=False)
            world = dh.World(BLOCK)
            recorded = np.column_stack([session.exact(name) for name in STATE])
            self.assertEqual(round(world.duration, 9), round(float(session.t[-1]), 9))
        for i, row in enumerate(recorded):
            world.step(1, None if i % 2 or i == 0 else lambda w: w.t)
            np.testing.assert_array_equal(states(world), row, err_msg=f"tick {i}")

    def test_it_begins_anew_as_it_began(self):
        world = dh.World(BLOCK)
        world.step(1500)
        first = states(world)
        world.fingers[0].lead((0, 0, 0.2))
        world.bodies["block"].push((1, 0, 0))
        world.step(50)
        world.reset()
        world.step(1500)
        np.testing.assert_array_equal(states(world), first)

    def test_many_side_by_side_are_as_one_alone(self):
        worlds = [dh.World(BLOCK, seed=seed) for seed in (1, 1, 2, 3)]
        dh.step_all(worlds, 1500)
        alone = dh.World(BLOCK)
        alone.step(1500)
        np.testing.assert_array_equal(states(worlds[0]), states(alone))
        np.testing.assert_array_equal(states(worlds[1]), states(alone))

    def test_a_push_accelerates_by_newton_s_law(self):
        world = dh.World(BLOCK)
        block = world.bodies["block"]
        world.step()
        block.place((0, 0, 0.5))
        block.push((0.1, 0, 0.981))  # the block weighs 100 g
        world.step(200)
        np.testing.assert_allclose(block.velocity, (0.2, 0, 0), atol=2e-3)
        block.scale(mass=2)
        block.push((0.2, 0, 0.981))
        before = block.velocity
        world.step(100)
        np.testing.assert_allclose(block.velocity - before, (0.1, 0, 0), atol=2e-3)
        block.push()
        block.scale()
        before = block.velocity
        world.step(100)
        np.testing.assert_allclose(block.velocity - before, (0, 0, -0.981), atol=2e-3)

    def test_led_fingers_lift_the_block(self):
        world = dh.World(BLOCK)
        thumb, index = world.fingers
        block = world.bodies["block"]
        world.step()
        for x, z in [(0.018, 0.02)] * 40 + [(0.018, z) for z in np.linspace(0.02, 0.07, 60)] + [(0.018, 0.07)] * 40:
            thumb.lead((-x, 0, z))
            index.lead((x, 0, z))
            world.step(25)
        np.testing.assert_allclose(block.position, (0, 0, 0.068), atol=2e-3)
        self.assertGreater(world["grip_force"], 0.3)
        self.assertEqual({int(b) for b in world["contacts"].body_b} - {0, 1}, {2, 3})

    def test_what_a_director_raises_ends_the_step(self):
        world = dh.World(BLOCK)
        world.step()

        def fail(w):
            if w.t > 0.0045:
                raise RuntimeError("enough")

        with self.assertRaisesRegex(RuntimeError, "enough"):
            world.step(100, fail)
        self.assertAlmostEqual(world.t, 0.006)
        world.step(3)  # it goes on
        self.assertAlmostEqual(world.t, 0.009)

    def test_bad_input_is_told(self):
        with self.assertRaisesRegex(dh.Error, "nothing.yaml: error: cannot be read"):
            dh.World("nothing.yaml")
        with self.assertRaisesRegex(dh.Error, "has trials"):
            dh.World("experiments/first-trials.yaml")
        with self.assertRaisesRegex(dh.Error, "are real"):
            dh.World(BLOCK, "rigs/omega-pair.yaml")
        with self.assertRaisesRegex(dh.Error, "stifness"):
            dh.World(BLOCK, settings={"coupling.stifness_N_m": 600})
        world = dh.World(BLOCK)
        with self.assertRaisesRegex(dh.Error, "Step the world first"):
            world.bodies["block"].position
        with self.assertRaisesRegex(dh.Error, "not a unit quaternion"):
            world.bodies["block"].place((0, 0, 1), (0, 0, 0, 0))
        world.step()
        with self.assertRaisesRegex(dh.NotThere, "cup.position"):
            world["cup.position"]
        for call in (world.fingers[0].lead, world.bodies["block"].place, world.bodies["block"].push):
            for wrong in (("a", "b", "c"), (1, 2), (np.nan, 0, 0), (np.inf, 0, 0)):
                with self.subTest(f"{call}{wrong}"), self.assertRaises((TypeError, dh.Error)):
                    call(wrong)
        for wrong in ({"mass": -1}, {"mass": 1e-300}, {"friction": 1e12}, {"weight": float("nan")}):
            with self.subTest(wrong), self.assertRaisesRegex(dh.Error, f"{next(iter(wrong))}: is "):
                world.bodies["block"].scale(**wrong)
        with self.assertRaisesRegex(dh.Error, "too strong"):
            world.bodies["block"].push((1e300, 0, 0))
        with self.assertRaisesRegex(dh.Error, "are negative"):
            world.step(-1)

    def test_a_world_is_stepped_by_one_at_a_time(self):
        world = dh.World(BLOCK)
        world.step()
        with self.assertRaisesRegex(dh.Error, "is being stepped"):
            world.step(10, lambda w: w.reset())
        with self.assertRaisesRegex(dh.Error, "is being stepped"):
            world.step(10, lambda w: w.step())
        with self.assertRaisesRegex(dh.Error, "step_all\\(\\) accepts each world once"):
            dh.step_all([world, world])
        refused = []

        def disturb():
            for call in (world.step, world.reset, lambda: world["grip_force"], lambda: world.bodies["block"].push()):
                try:
                    call()
                except dh.Error as why:
                    refused.append(str(why))

        step = threading.Thread(target=lambda: world.step(100_000))
        step.start()
        time.sleep(0.05)
        disturb()
        step.join()
        self.assertGreaterEqual(len(refused), 3, "the thread had ended")
        world.reset()
        world.step()

    def test_a_long_step_can_be_interrupted(self):
        code = f"import dihaptic as dh; dh.World('{BLOCK}').step(10**9)"
        with subprocess.Popen([sys.executable, "-c", code], stderr=subprocess.PIPE, text=True) as process:
            time.sleep(2)
            process.send_signal(signal.SIGINT)
            self.assertIn("KeyboardInterrupt", process.communicate(timeout=30)[1])

    def test_it_stops_when_force_goes_off(self):
        world = dh.World(BLOCK)
        world.step(200)
        world.fingers[0].lead((-0.4, 0, 0.4))
        with self.assertRaisesRegex(dh.Error, "the world has stopped: .*Start again"):
            world.step(1000)
        self.assertLess(world.t, 0.3)
        self.assertEqual(dh.step_all([world]), [False])
        world.reset()
        world.step(1000)

    def test_it_cannot_be_copied(self):
        for make in (copy.copy, copy.deepcopy, pickle.dumps):
            with self.assertRaisesRegex(TypeError, "cannot be copied"):
                make(dh.World(BLOCK))

    def test_a_component_is_read_as_of_a_session(self):
        world = dh.World(BLOCK)
        world.step()
        self.assertEqual(world["block.position.z"], world["block.position"][2])

    def test_a_finger_whose_device_alone_turns_is_found(self):
        rig = dh.Rig.load("rigs/ideal-pair.yaml")
        rig.devices[1].options = {"orientation": True}
        world = dh.World(BLOCK, rig)
        world.step(5)
        np.testing.assert_array_equal(world["index.handle_orientation"], (1, 0, 0, 0))
        with self.assertRaises(dh.NotThere):
            world["thumb.handle_orientation"]
        with tempfile.TemporaryDirectory() as folder:
            session = dh.run(BLOCK, rig=rig, out=folder, progress=False)
            exact = session.exact("index.torque_sent")
            np.testing.assert_array_equal(exact.astype("f4"), session["index.torque_sent"])
            self.assertNotIn("thumb.torque_sent", session)

    def test_settings_are_those_of_the_program(self):
        world = dh.World(BLOCK, settings={"coupling.stiffness_N_m": 600})
        world.step()
        self.assertEqual(world["stiffness"], 600)


if __name__ == "__main__":
    unittest.main()
