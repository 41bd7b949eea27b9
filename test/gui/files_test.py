"""Files that are opened, edited, or bad, while a session runs and while none does."""
import glob
import math
import pathlib
import subprocess
import time
import unittest

from window import PROGRAM, SCENE, Window

import soak


class Files(Window):
    def test_that_go_bad_leave_what_was_open_and_say_why(self):
        self.open()
        pathlib.Path(self.scene).write_text(SCENE.replace("mass_g: 100", "mas_g: 100"))
        time.sleep(1.5)
        self.screenshot("bad-file")
        self.key("F5")
        time.sleep(1)
        self.assertEqual(glob.glob(self.out + "/*"), [])
        pathlib.Path(self.scene).write_text(SCENE)
        time.sleep(1.5)
        self.start()
        self.quit()

    def test_that_are_no_text_are_not_opened(self):
        self.open()
        title = lambda: self.xdotool("getwindowname", self.name).strip()
        before = title()
        binary = pathlib.Path(self.folder.name, "binary.yaml")
        binary.write_bytes(bytes(range(256)))
        self.key("ctrl+o")
        dialog = self.wait("the dialog", lambda: self.dialogs("^Open a scene"))[-1]
        self.xdotool("windowfocus", dialog)
        time.sleep(0.5)
        self.key("ctrl+a")
        self.type(str(binary))
        self.key("Return")
        self.answer("^Open$", "Return")
        self.assertEqual(title(), before)
        self.start()
        self.quit()

    def test_that_is_named_and_does_not_exist_leads_to_the_start_page(self):
        missing = self.folder.name + "/none.yaml"
        with open(self.folder.name + "/log", "w+") as self.log:
            self.window = subprocess.Popen([PROGRAM, "gui", "--out", self.out, missing], env=self.environment,
                                           stdout=self.log, stderr=self.log)
            self.addCleanup(self.window.wait)
            self.addCleanup(self.window.kill)
            self.wait("the message", lambda: self.dialogs("^Open$"))
            self.name = self.wait("the window", lambda: self.dialogs("^Dihaptic$"))[-1]
            self.screenshot("no-such-file")
            self.answer("^Open$", "Return")
            self.quit()

    def test_that_are_edited_while_they_run_are_shown_after_it(self):
        self.open()
        title = lambda: self.xdotool("getwindowname", self.name).strip()
        before = title()
        self.start()
        pathlib.Path(self.scene).write_text(SCENE.replace("title: ", "title: Other, "))
        time.sleep(1)
        self.assertEqual(title(), before)
        self.key("F7")
        with self.ended("complete"):
            pass
        self.wait("the file as it is", lambda: "Other, " in title())

    @soak.alone
    def test_that_changed_a_moment_ago_are_shown_as_they_run(self):
        """An experiment's scene is not watched for changes."""
        file = self.folder.name + "/experiment.yaml"
        pathlib.Path(file).write_text("scene: block.yaml\n")
        super().open(file)
        pathlib.Path(self.scene).write_text(SCENE.replace("size_mm: [40, 40, 40]", "size_mm: [40, 40, 90]")
                                            .replace("[0, 0, 20]", "[0, 0, 45]"))
        self.start()
        time.sleep(1)
        self.screenshot("changed")
        self.key("F7")
        with self.ended("complete") as recording:
            self.assertAlmostEqual(self.series(recording, "block_position")[0, 2], 0.045, delta=0.001)

    @soak.alone
    def test_are_not_opened_while_a_session_runs(self):
        self.open()
        self.start()
        for keys in (["ctrl+o"], ["alt+f", "o"]):
            self.key(*keys)
            time.sleep(0.5)
            self.assertEqual(self.xdotool("search", "--onlyvisible", "--name", "^Open a scene"), "")
            self.key("Escape")  # the menu
        self.screenshot("menu-in-a-session")
        self.key("F7")
        with self.ended("complete"):
            pass
        # the window is notified only when the files are complete
        self.wait("the dialog", lambda: self.key("ctrl+o")
                  or self.xdotool("search", "--onlyvisible", "--name", "^Open a scene"))

    @soak.alone
    def test_that_take_long_can_be_cancelled(self):
        self.open()
        mesh = pathlib.Path(self.folder.name, "star.obj")
        mesh.write_text(star(teeth=2000))  # minutes
        slow = SCENE.replace("fingers:", f"  - {{ name: star, shape: mesh, file: {mesh}, unit: mm, concave: yes, "
                                         "mass_g: 10, position_mm: [100, 0, 30] }\nfingers:", 1)
        pathlib.Path(self.scene).write_text(slow)
        time.sleep(2)
        self.screenshot("opening")
        self.key("F7")
        time.sleep(1)
        pathlib.Path(self.scene).write_text(SCENE)
        time.sleep(1.5)
        self.start()
        self.quit()


def star(teeth):
    """A prism over a star, as OBJ: the more teeth, the longer it takes to cut."""
    n = 2 * teeth
    ring = [(1 + i % 2, math.pi * i / teeth) for i in range(n)]
    lines = [f"v {5 * r * math.cos(a):.6f} {5 * r * math.sin(a):.6f} {z}" for z in (0, 5) for r, a in ring]
    lines += ["f " + " ".join(str(n - i) for i in range(n)), "f " + " ".join(str(n + i + 1) for i in range(n))]
    lines += [f"f {i + 1} {(i + 1) % n + 1} {n + (i + 1) % n + 1} {n + i + 1}" for i in range(n)]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    unittest.main()
