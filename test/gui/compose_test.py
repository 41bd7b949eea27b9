"""The open file's text beside the scene: checked and shown while the user types, and saved on request."""
import glob
import pathlib
import re
import time
import unittest

import numpy as np

from window import SCENE, Window, patient

import soak


class Compose(Window):
    def text(self):
        return pathlib.Path(self.scene).read_text()

    def test_shows_what_is_typed_and_leaves_the_file_until_it_is_saved(self):
        self.open()
        title = lambda: self.xdotool("getwindowname", self.name).strip()
        before = title()
        self.key("ctrl+e", "ctrl+Home", "Down", "End")
        self.type(", typed")  # at the end of its title
        self.wait("the title", lambda: title() == before.replace(" - Dihaptic", ", typed* - Dihaptic"))
        self.screenshot("compose-typed")
        self.assertEqual(self.text(), SCENE)
        self.assertTrue(self.drafts())
        self.key("ctrl+s")
        self.wait("the file", lambda: ", typed\n" in self.text())
        self.assertEqual(self.drafts(), [])
        self.key("ctrl+z")  # undo goes back beyond the saved state
        self.wait("the title as it was", lambda: title() == before or ", typed" not in title())
        self.assertIn(", typed\n", self.text())
        self.key("ctrl+q")
        question = self.wait("the question", lambda: self.xdotool("search", "--onlyvisible", "--name", "^Save"))
        self.xdotool("windowfocus", question.split()[-1])  # there is no window manager to do so
        time.sleep(0.5)
        self.screenshot("compose-question")
        self.key("Tab", "space")  # discard
        self.assertEqual(self.window.wait(patient(60)), 0)
        self.assertIn(", typed\n", self.text())
        self.assertEqual(self.drafts(), [])

    @soak.alone
    def test_marks_the_line_of_a_mistake_and_starts_what_was_saved(self):
        self.open()
        self.key("ctrl+e", "ctrl+End", "Return")
        self.type("bodis: []")
        self.key("F5")  # before the text is checked, which happens only after a pause
        time.sleep(2)
        self.key("F5")
        time.sleep(0.5)
        self.assertEqual(glob.glob(self.out + "/*"), [])
        self.screenshot("compose-mistake")
        self.assertEqual(self.text(), SCENE)
        for _ in range(9):
            self.key("BackSpace")
        self.type("# mine")
        time.sleep(1.5)
        self.screenshot("compose-mended")
        self.start()  # saves first
        self.assertIn("# mine", self.text())
        self.quit()

    @soak.alone
    def test_saves_under_another_name_and_goes_on_with_that(self):
        self.open()
        self.key("ctrl+e", "ctrl+Home", "Down", "End")
        self.type(", mine")
        self.key("ctrl+shift+s")
        dialog = self.wait("the dialog", lambda: self.xdotool("search", "--onlyvisible", "--name", "^Save as$"))
        self.xdotool("windowfocus", dialog.split()[-1])
        time.sleep(0.5)
        self.key("ctrl+a")
        mine = pathlib.Path(self.folder.name, "mine.yaml")
        self.type(str(mine))
        self.key("Return")
        self.wait("the file", mine.exists)
        self.wait("the title", lambda: ", mine - Dihaptic" in self.xdotool("getwindowname", self.name))
        self.assertIn(", mine\n", mine.read_text())
        self.assertEqual(self.text(), SCENE)
        self.assertEqual(self.drafts(), [])
        self.xdotool("windowfocus", self.name)
        self.settle()
        self.screenshot("saved-as")
        self.quit()

    @soak.alone
    def test_offers_words_and_shows_where_what_is_clicked_was_written(self):
        self.open()
        self.key("ctrl+e", "ctrl+Home")
        # goes to the end of the line that names the block
        lines = SCENE.splitlines()
        line = next(i for i, text in enumerate(lines) if "name: block" in text)
        self.key(*["Down"] * line, "End", "Return")
        self.type("rota")
        time.sleep(2)
        self.screenshot("compose-words")
        self.key("Down", "Return")  # rotation_rad, then rotation_deg
        self.type("[0, 0, 5]")
        time.sleep(0.5)
        self.key("ctrl+s")
        self.wait("the word", lambda: "    rotation_deg: [0, 0, 5]\n" in self.text())
        self.xdotool("mousemove", "715", "490", "click", "1")
        time.sleep(1)
        self.screenshot("compose-picked")
        self.key("End")
        self.type(" # picked")
        self.key("ctrl+s")
        self.wait("the line", lambda: " # picked" in self.text())
        self.assertIn(" # picked", next(text for text in self.text().splitlines() if "name: block" in text))
        self.quit()

    @soak.alone
    def test_offers_the_names_that_the_file_gives(self):
        self.open()
        self.key("ctrl+e", "ctrl+End")
        self.type("pairs:")
        self.key("Return")
        self.type("- between: [bl")
        self.key("ctrl+space")
        time.sleep(1)
        self.screenshot("compose-names")
        self.key("Return")
        self.type(", tab")
        self.key("ctrl+space")
        time.sleep(1)
        self.key("Return")
        self.type("]")
        self.key("Return")
        self.type("friction: 0.5")
        self.key("ctrl+s")
        self.wait("the names", lambda: self.text() == SCENE + "pairs:\n  - between: [block, table]\n    friction: 0.5")
        self.quit()

    def position(self):
        """Of the block, as its file has it, all else of which must be as it was [mm]."""
        now, before = self.text().splitlines(), SCENE.splitlines()
        self.assertEqual(len(now), len(before))
        changed = [i for i in range(len(now)) if now[i] != before[i]]
        block = next(i for i, text in enumerate(before) if "name: block" in text)
        line = next(i for i in range(block, len(before)) if "position_mm" in before[i])
        self.assertLessEqual(set(changed), {line})
        return [float(x) for x in re.fullmatch(r"    position_mm: \[(.*), (.*), (.*)\]", now[line]).groups()]

    def saved(self, what, condition):
        self.key("ctrl+s")
        self.wait(what, lambda: condition(self.position()))
        self.settle()
        return self.position()

    def drag(self, start, end, key=None):
        self.xdotool("mousemove", *map(str, start), "mousedown", "1")
        if key:
            self.xdotool("keydown", key)
        for i in range(1, 11):
            self.xdotool("mousemove", *(str(round(a + (b - a) * i / 10)) for a, b in zip(start, end)))
            time.sleep(0.03)
        self.screenshot("compose-dragged-" + (key or "plain"))
        self.xdotool("mouseup", "1")
        if key:
            self.xdotool("keyup", key)
        time.sleep(0.2)

    def test_a_body_is_moved_by_mouse_and_keys_and_its_numbers_are_written(self):
        self.open()
        self.key("ctrl+e")
        self.settle()
        held = [715, 490]
        self.xdotool("mousemove", *map(str, held), "click", "1")
        time.sleep(0.5)
        self.screenshot("compose-marked")
        self.drag(held, [815, 470])
        x, y, z = self.saved("the drag", lambda p: p[0] > 20)
        self.assertEqual(z, 20)
        self.key("Right", "shift+Down")  # since the drag, the scene has the keyboard
        self.assertEqual(self.saved("steps", lambda p: p[1] < y - 5), [round(x + 1, 1), round(y - 10, 1), 20])
        self.key("ctrl+z", "ctrl+z")
        self.saved("what was before the steps", lambda p: p == [x, y, z])
        self.key("ctrl+z")
        self.saved("what was before the drag", lambda p: p == [0, 0, 20])
        self.drag(held, [715, 400], "shift")
        x, y, z = self.saved("the drag upward", lambda p: p[2] > 30)
        self.assertEqual([x, y], [0, 0])
        self.key("ctrl+e", "alt+shift+Prior", "alt+Left")
        self.assertEqual(self.saved("steps from the text", lambda p: p[0] == -1), [-1, 0, round(z + 10, 1)])
        self.screenshot("compose-moved")
        self.drag([715, 410], [765, 410], "ctrl")
        self.key("ctrl+s")
        self.wait("the turn", lambda: "  - name: block\n    rotation_deg: [0, 0, 22.9]\n" in self.text())  # 0.4 rad
        self.quit()

    def test_undoing_a_drag_moves_the_body_back_in_the_picture(self):
        self.open()
        self.key("ctrl+e")
        self.settle()
        scene = lambda: self.pixels(500, 100, 500, 600).astype(int)
        self.xdotool("mousemove", "715", "490", "click", "1")
        time.sleep(0.5)
        self.settle()
        before = scene()
        self.drag([715, 490], [815, 470])
        time.sleep(1)
        self.settle()
        self.xdotool("mousemove", "715", "490")
        self.assertGreater(np.abs(scene() - before).mean(), 0.5)
        self.key("ctrl+z")
        time.sleep(1)  # a pause, after which the text is shown
        self.settle()
        self.screenshot("compose-undone")
        self.assertLess(np.abs(scene() - before).mean(), 0.1)
        self.assertEqual(self.text(), SCENE)
        self.quit()

    @soak.alone
    def test_what_it_cannot_move_is_said(self):
        text = SCENE.replace("bodies:\n", "bodies:\n  - { name: cap, shape: box, size_mm: [40, 40, 10], mass_g: 20, "
                             "position_mm: &top [0, 0, 45] }\n")
        pathlib.Path(self.scene).write_text(text)
        self.open()
        self.key("ctrl+e")
        self.settle()
        self.xdotool("mousemove", "715", "415", "click", "1")
        time.sleep(0.5)
        self.screenshot("compose-fixed-picked")
        self.drag([715, 415], [800, 415])
        self.key("ctrl+s")
        time.sleep(1)
        self.screenshot("compose-fixed")
        self.assertEqual(self.text(), text)
        self.quit()

    @soak.alone
    def test_what_is_in_another_file_is_not_moved(self):
        text = pathlib.Path("experiments/first-trials.yaml").read_text().replace("../", str(pathlib.Path.cwd()) + "/")
        pathlib.Path(self.scene).write_text(text)
        self.open()
        self.key("ctrl+e")
        self.settle()
        self.xdotool("mousemove", "715", "490", "click", "1")
        time.sleep(0.5)
        self.screenshot("compose-elsewhere")
        self.drag([715, 490], [800, 490])
        self.key("ctrl+s")
        time.sleep(1)
        self.assertEqual(self.text(), text)
        self.quit()

    @soak.alone
    def test_a_file_keeps_its_line_ends(self):
        content = b"\xef\xbb\xbf" + SCENE.replace("a table", "a\u00a0table").replace("\n", "\r\n").encode()
        pathlib.Path(self.scene).write_bytes(content)
        self.open()
        self.key("ctrl+e", "ctrl+End", "space", "BackSpace", "ctrl+Home")
        self.type("# ")
        self.key("ctrl+s")
        self.wait("the file", lambda: pathlib.Path(self.scene).read_bytes() == content[:3] + b"# " + content[3:])
        self.quit()


if __name__ == "__main__":
    unittest.main()
