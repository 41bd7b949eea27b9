"""A hand that is moved by mouse and keys. It moves on with each picture, so each test waits until the recording has what
it did, however long the machine takes to draw."""
import os
import pathlib
import time
import unittest

import numpy as np

from window import Window

import soak


class Mouse(Window):
    OPEN, CLOSE = "4", "5"  # X's buttons for the wheel

    def wheel(self, way, notches):
        for _ in range(notches):
            self.xdotool("click", way)
            time.sleep(0.02)

    def height(self, file):
        return self.series(file, "block_position")[:, 2]

    def yaw(self, file):
        w, x, y, z = self.series(file, "block_orientation")[-1]
        return 2 * np.arctan2(z, w)

    def rests(self, file):
        """Whether the block has been where it is for half a second, to a tenth of a millimetre."""
        position = self.series(file, "block_position")[-500:]
        return len(position) == 500 and np.ptp(position, axis=0).max() < 1e-4

    def grip(self, notches=19):
        self.wheel(self.CLOSE, notches)
        self.recorded("a grip", lambda file: self.series(file, "grip_force")[-1] > 1.5)

    def lift(self, steps):
        """The block of the scene, which is open; so many steps of 4 pixels up. It rests there."""
        self.start()
        self.grip()
        self.raise_by(steps)

    def raise_by(self, steps):
        self.move(0, -4, steps)
        self.recorded("a lifted block that rests", lambda file: self.height(file)[-1] > 0.03 and self.rests(file))

    @soak.alone
    def test_grips_and_lifts_while_the_solver_changes(self):
        self.open()
        self.screenshot("opened")
        self.lift(40)
        self.screenshot("lifted")
        self.key("ctrl+t")  # the drawer of Tuning
        self.key("alt+i", "ctrl+a")
        self.xdotool("type", "1.5")  # friction
        self.key("Return")
        self.key("alt+n", "ctrl+a")
        self.xdotool("type", "2000")
        self.key("Return")
        self.recorded("the stiffness", lambda file: self.series(file, "stiffness")[-1] == 2000)
        self.key("alt+x", "End")  # the point takes effect only when the block is let go, so not in this session
        self.key("alt+c", "End")  # directly to the last, since the dual spring shakes at this stiffness
        self.recorded("the coupling", lambda file: self.series(file, "coupling")[-1] == 2)
        for solver in (2, 1, 0):  # through all
            self.key("alt+l", "Up")
            self.recorded("the solver", lambda file: self.series(file, "solver")[-1] == solver)
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
            self.assertGreater(self.height(file)[changed:].min(), 0.05)
        self.replay()
        self.quit()

    def test_holds_while_the_workspace_follows_the_camera(self):
        self.open()
        self.lift(30)
        self.key("F9")  # the scene's own camera is at -0.59 rad
        self.recorded("the turn to the scene's camera", lambda file: self.series(file, "workspace_turn")[-1] < -0.58)
        self.xdotool("mousedown", "3")
        self.move(-5, 0, 52)  # by 1.56 rad
        self.xdotool("mouseup", "3")
        self.recorded("the turn", lambda file: self.series(file, "workspace_turn")[-1] > 0.96 and self.rests(file))
        self.move(4, 0, 20)  # to the right of the picture
        turned = self.way_right
        self.recorded("the way", lambda file: np.linalg.norm(turned(file)) > 0.02 and self.rests(file))
        self.screenshot("followed")
        self.key("F7")
        with self.ended("complete") as file:
            turn = self.series(file, "workspace_turn")
            self.assertAlmostEqual(turn[-1], 0.97, delta=0.01)
            self.assertLess(turn.min(), -0.1)
            self.assertLessEqual(np.abs(self.series(file, "workspace_rate")).max(), 1)
            turned = self.height(file)[np.flatnonzero(turn)[0]:]
            self.assertGreater(turned.min(), 0.05)
            right = np.array([np.cos(0.97), np.sin(0.97)])
            way = self.way_right(file)
            self.assertGreater(way @ right, 0.02)
            self.assertLess(np.linalg.norm(way - way @ right * right), 0.003)
            self.assertAlmostEqual(self.yaw(file), 0.97, delta=0.1)
        self.replay()
        self.quit()
        self.assertIn("follow_camera=true", (pathlib.Path(self.folder.name) / ".config/dihaptic/dihaptic.conf").read_text())

    def way_right(self, file):
        """What the block has moved on the table's plane since the workspace came to rest [m]."""
        turn = self.series(file, "workspace_turn")
        position = self.series(file, "block_position")
        arrived = np.flatnonzero(np.abs(turn - turn[-1]) > 0.005)[-1]
        return position[-1, :2] - position[arrived, :2]

    def test_squeezes_by_a_key_and_lets_go(self):
        self.open()
        self.start()
        distance = lambda file: np.linalg.norm(  # between the fingertips
            self.series(file, "thumb_handle_position")[-1] - self.series(file, "index_handle_position")[-1])
        before = []
        self.recorded("the hand", lambda file: before.append(distance(file)) or True)
        self.hold("space", 0.5)
        self.recorded("the squeeze", lambda file: distance(file) < before[0] - 0.01)
        self.grip(18)  # 54 mm
        self.raise_by(30)
        self.wheel(self.OPEN, 18)
        self.recorded("the block on the table", lambda file: self.height(file)[-1] < 0.025 and self.rests(file))
        self.key("F7")
        with self.ended("complete") as file:
            height = self.height(file)
            self.assertGreater(height.max(), 0.04)
            self.assertAlmostEqual(height[-1], 0.02, delta=0.001)

    @soak.alone
    def test_turns_by_a_drag(self):
        self.open()
        self.lift(20)
        self.xdotool("mousedown", "1")
        self.move(4, 0, 20)
        self.xdotool("mouseup", "1")
        self.recorded("the turn", lambda file: self.yaw(file) > 0.3 and self.rests(file))
        self.screenshot("turned")
        self.key("F7")
        with self.ended("complete") as file:
            self.assertAlmostEqual(self.yaw(file), 0.64, delta=0.15)  # 80 pixels

    @soak.alone
    def test_stays_while_the_pointer_goes_elsewhere_and_is_reported(self):
        self.open()
        self.lift(30)
        self.key("h")
        held = []
        self.recorded("where it is held", lambda file: held.append(self.series(file, "block_position")[-1]) or True)
        self.move(5, 3, 40)
        time.sleep(0.5)
        self.key("h")
        time.sleep(1)
        self.key("F7")
        with self.ended("complete") as file:
            position = self.series(file, "block_position")
            self.assertGreater(position[-1, 2], 0.03)
            self.assertLess(np.abs(position[-500:] - held[0]).max(), 0.002)
        self.settle()
        self.screenshot("recorded")
        self.key("ctrl+r")
        self.wait("the report", self.opened)
        self.assertIn("report.html", self.opened()[0])
        self.assertTrue(os.path.exists(self.recording() + "report.html"))
        self.quit()


if __name__ == "__main__":
    unittest.main()
