"""A hand that is moved by mouse and keys. Needs the machine alone: the hand moves on with each picture, and where it is
when a session ends depends on how many were drawn."""
import os
import pathlib
import time
import unittest

import numpy as np

from window import Window


class Mouse(Window):
    OPEN, CLOSE = "4", "5"  # X's buttons for the wheel

    def wheel(self, way, notches):
        for _ in range(notches):
            self.xdotool("click", way)
            time.sleep(0.02)
        time.sleep(1.5)  # a busy machine takes its time

    def lift(self, steps):
        """The block of the scene, which is open; so many steps of 4 pixels up."""
        self.start()
        self.wheel(self.CLOSE, 19)
        self.move(0, -4, steps)

    def test_grips_and_lifts_while_the_solver_changes(self):
        self.open()
        self.screenshot("opened")
        self.lift(40)
        time.sleep(1.5)
        self.screenshot("lifted")
        self.key("alt+i", "ctrl+a")
        self.xdotool("type", "1.5\n")  # friction
        self.key("alt+n", "ctrl+a")
        self.xdotool("type", "2000\n")
        time.sleep(0.5)
        self.key("alt+x", "End")  # a point, once the block is let go: not in this session
        self.key("alt+c", "End")  # not through the dual spring, which shakes when it is so stiff
        time.sleep(0.4)
        for _ in range(3):  # through all solvers
            self.key("alt+l", "Up")
            time.sleep(0.4)
        self.key("F7")
        with self.ended("complete") as file:
            solver = self.series(file, "solver")
            self.assertEqual(sorted(set(solver)), [0, 1, 2, 3])
            self.assertEqual(sorted(set(self.series(file, "coupling"))), [0, 2])
            self.assertEqual(sorted(set(self.series(file, "friction_scale"))), [1, 1.5])
            self.assertEqual(sorted(set(self.series(file, "proxy"))), [0])
            stiffness = self.series(file, "stiffness")
            self.assertEqual((stiffness[0], stiffness[-1]), (1000, 2000))
            changed = np.flatnonzero(stiffness != stiffness[0])[0]
            height = self.series(file, "block_position")[:, 2]
            self.assertGreater(height[changed:].min(), 0.05)
        self.replay()
        self.quit()

    def test_holds_while_the_workspace_follows_the_camera(self):
        self.open()
        self.lift(30)
        time.sleep(1)
        self.key("F9")  # the scene's own camera is at -0.59 rad
        self.xdotool("mousedown", "3")
        self.move(-5, 0, 52)  # by 1.56 rad
        self.xdotool("mouseup", "3")
        time.sleep(3)
        self.move(4, 0, 20)  # to the right of the picture
        time.sleep(0.7)
        self.screenshot("followed")
        self.key("F7")
        with self.ended("complete") as file:
            turn = self.series(file, "workspace_turn")
            self.assertAlmostEqual(turn[-1], 0.97, delta=0.01)
            self.assertLess(turn.min(), -0.1)
            self.assertLessEqual(np.abs(self.series(file, "workspace_rate")).max(), 1)
            position = self.series(file, "block_position")
            turned = position[np.flatnonzero(turn)[0]:]
            self.assertGreater(turned[:, 2].min(), 0.05)
            right = np.array([np.cos(0.97), np.sin(0.97)])
            arrived = np.flatnonzero(np.abs(turn - turn[-1]) > 0.005)[-1]
            way = position[-1, :2] - position[arrived, :2]
            self.assertGreater(way @ right, 0.02)
            self.assertLess(np.linalg.norm(way - way @ right * right), 0.003)
            w, x, y, z = self.series(file, "block_orientation")[-1]
            self.assertAlmostEqual(2 * np.arctan2(z, w), 0.97, delta=0.1)
        self.replay()
        self.quit()
        self.assertIn("follow_camera=true", (pathlib.Path(self.folder.name) / ".config/dihaptic/dihaptic.conf").read_text())

    def test_squeezes_by_a_key_and_lets_go(self):
        self.open()
        self.start()
        self.hold("space", 0.5)
        self.wheel(self.CLOSE, 18)  # 54 mm
        self.move(0, -4, 30)
        time.sleep(0.3)
        self.wheel(self.OPEN, 18)
        time.sleep(0.6)
        self.key("F7")
        with self.ended("complete") as file:
            height = self.series(file, "block_position")[:, 2]
            self.assertGreater(height.max(), 0.04)
            self.assertAlmostEqual(height[-1], 0.02, delta=0.001)

    def test_turns_by_a_drag(self):
        self.open()
        self.lift(20)
        self.xdotool("mousedown", "1")
        self.move(4, 0, 20)
        self.xdotool("mouseup", "1")
        time.sleep(0.5)
        self.screenshot("turned")
        self.key("F7")
        with self.ended("complete") as file:
            w, x, y, z = self.series(file, "block_orientation")[-1]
            self.assertAlmostEqual(2 * np.arctan2(z, w), 0.64, delta=0.15)  # 80 pixels

    def test_stays_while_the_pointer_goes_elsewhere_and_is_reported(self):
        self.open()
        self.lift(30)
        time.sleep(0.7)
        self.key("h")
        self.move(5, 3, 40)
        time.sleep(0.5)
        self.key("h")
        time.sleep(1)
        self.key("F7")
        with self.ended("complete") as file:
            position = self.series(file, "block_position")
            self.assertGreater(position[-1, 2], 0.03)
            self.assertLess(np.abs(position[-500:] - position[-1500]).max(), 0.002)
        time.sleep(0.5)
        self.screenshot("recorded")
        self.key("ctrl+r")
        self.wait("the report", lambda: os.path.exists(self.recording() + "report.html"))
        self.quit()


if __name__ == "__main__":
    unittest.main()
