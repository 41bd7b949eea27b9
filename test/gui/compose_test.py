"""The open file's text beside the scene: checked and shown as one types, and saved when one wants it."""
import glob
import pathlib
import time
import unittest

from window import SCENE, Window, patient


class Compose(Window):
    def type(self, text):
        self.xdotool("type", "--delay", "30", text)

    def text(self):
        return pathlib.Path(self.scene).read_text()

    def drafts(self):
        return glob.glob(self.folder.name + "/.*.draft.yaml")

    def test_shows_what_is_typed_and_leaves_the_file_until_it_is_saved(self):
        self.open()
        title = lambda: self.xdotool("getwindowname", self.name).strip()
        before = title()
        self.key("ctrl+e", "ctrl+Home", "Down", "End")
        self.type(", typed")  # at the end of its title
        self.wait("the title", lambda: title() == before.replace(" - Dihaptic", ", typed - Dihaptic"))
        self.screenshot("compose-typed")
        self.assertEqual(self.text(), SCENE)
        self.assertTrue(self.drafts())
        self.key("ctrl+s")
        self.wait("the file", lambda: ", typed\n" in self.text())
        self.assertEqual(self.drafts(), [])
        self.key("ctrl+z")  # undo goes on behind what was saved
        self.wait("the title as it was", lambda: title() == before or ", typed" not in title())
        self.assertIn(", typed\n", self.text())
        self.key("ctrl+q")
        question = self.wait("the question", lambda: self.xdotool("search", "--onlyvisible", "--name", "^Save"))
        self.xdotool("windowfocus", question.split()[-1])  # there is no window manager that would
        time.sleep(0.5)
        self.screenshot("compose-question")
        self.key("Tab", "space")  # discard
        self.assertEqual(self.window.wait(patient(60)), 0)
        self.assertIn(", typed\n", self.text())
        self.assertEqual(self.drafts(), [])

    def test_marks_the_line_of_a_mistake_and_starts_what_was_saved(self):
        self.open()
        self.key("ctrl+e", "ctrl+End", "Return")
        self.type("bodis: []")
        self.key("F5")  # before the pause after which the text is checked
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

    def test_offers_words_and_shows_where_what_is_clicked_was_written(self):
        self.open()
        self.key("ctrl+e", "ctrl+Home")
        # behind the line that names the block
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


if __name__ == "__main__":
    unittest.main()
