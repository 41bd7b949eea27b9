"""What is typed and not saved, beside other programs that change, remove and replace the file, and beside strangers."""
import os
import pathlib
import time
import unittest

from window import SCENE, Window

import soak


class Drafts(Window):
    def edit(self, text="# mine "):
        """Types at the start of the file."""
        self.key("ctrl+e", "ctrl+Home")
        self.type(text)
        self.wait("the draft", self.drafts)

    def scene_text(self):
        return pathlib.Path(self.scene).read_text()

    def logged(self):
        self.log.seek(0)
        return self.log.read()

    def crash(self):
        self.window.kill()
        self.window.wait()

    def second(self):
        """Another window on the same file."""
        first, name = self.window, self.name
        self.open()
        self.name = self.xdotool("search", "--onlyvisible", "--all", "--pid", str(self.window.pid), "--name",
                                 " - Dihaptic$").split()[-1]
        self.xdotool("windowraise", self.name, "windowfocus", self.name)
        return first, name

    @soak.alone
    def test_nothing_beside_the_file_is_touched(self):
        theirs = pathlib.Path(self.folder.name, "theirs")
        theirs.write_text("theirs")
        for name in ".block.draft.yaml", ".block.words-1.yaml", ".block.words-2.yaml":
            os.symlink(theirs, pathlib.Path(self.folder.name, name))
        before = set(os.listdir(self.folder.name))
        self.open()
        self.edit("bod")  # words are offered too
        time.sleep(1.5)
        self.assertLessEqual(set(os.listdir(self.folder.name)) - before, {"state", "log", ".cache", ".config", ".local"})
        self.assertEqual(theirs.read_text(), "theirs")
        self.assertTrue(os.path.islink(self.folder.name + "/.block.draft.yaml"))
        self.assertEqual(self.scene_text(), SCENE)
        self.assertIn(self.scene, pathlib.Path(self.drafts()[0]).read_text())

    def test_of_a_window_that_crashed_is_offered_and_gone_on_with(self):
        self.open()
        self.edit()
        self.crash()
        self.assertEqual(self.scene_text(), SCENE)
        self.open()
        self.answer("^Unsaved text$", "Return")
        self.key("ctrl+s")
        self.wait("the text", lambda: self.scene_text() == "# mine " + SCENE)
        self.wait("the draft's end", lambda: not self.drafts())
        self.quit()

    @soak.alone
    def test_of_a_window_that_crashed_is_there_until_it_is_decided_about(self):
        self.open()
        self.edit()
        kept = pathlib.Path(self.drafts()[0])
        self.crash()
        before = kept.read_text()
        self.open()
        self.wait("the offer", lambda: self.dialogs("^Unsaved text$"))
        self.type("# other ")  # this goes to the window behind the dialog, which accepts no input
        time.sleep(1)
        self.assertEqual(kept.read_text(), before)
        self.crash()
        self.open()
        self.answer("^Unsaved text$", "alt+d")
        self.assertEqual(self.drafts(), [])
        self.assertEqual(self.scene_text(), SCENE)
        self.quit()

    @soak.alone
    def test_of_a_window_that_a_signal_ended_is_offered(self):
        self.open()
        self.edit()
        self.window.terminate()
        self.assertEqual(self.window.wait(), 1)
        self.assertIn("is offered when the file is opened", self.logged())
        self.assertEqual(len(self.drafts()), 1)

    def test_what_another_program_wrote_is_not_overwritten_unasked(self):
        self.open()
        self.edit()
        pathlib.Path(self.scene).write_text(SCENE + "# theirs\n")
        time.sleep(1)
        self.screenshot("changed-by-another")
        self.key("ctrl+s")
        self.answer("^Overwrite", "Escape")
        self.assertEqual(self.scene_text(), SCENE + "# theirs\n")
        self.screenshot("not-saved")
        self.key("ctrl+s")
        self.answer("^Overwrite", "alt+o")
        self.wait("the text", lambda: self.scene_text() == "# mine " + SCENE)
        self.quit()

    def test_a_text_that_conflicts_with_another_program_is_saved_under_another_name(self):
        self.open()
        self.edit()
        pathlib.Path(self.scene).write_text(SCENE + "# theirs\n")
        time.sleep(1)
        self.key("ctrl+s")
        self.answer("^Overwrite", "alt+a")
        mine = pathlib.Path(self.folder.name, "mine.yaml")
        self.answer_with_path("^Save as", str(mine))
        self.wait("the text", lambda: mine.exists() and mine.read_text() == "# mine " + SCENE)
        self.assertEqual(self.scene_text(), SCENE + "# theirs\n")
        self.quit()

    @soak.alone
    def test_a_file_that_is_gone_keeps_its_text(self):
        self.open()
        self.key("ctrl+e")
        os.remove(self.scene)
        time.sleep(1.5)
        self.screenshot("gone")
        self.key("ctrl+e")  # hides the text, which edit() shows
        self.edit()
        self.key("ctrl+s")
        self.wait("the file", lambda: os.path.exists(self.scene) and self.scene_text() == "# mine " + SCENE)
        os.remove(self.scene)
        time.sleep(1)
        pathlib.Path(self.scene).write_text(SCENE)  # as a checkout does; the user has not changed the text since
        time.sleep(1.5)
        self.key("ctrl+Home")
        self.type("# again ")
        self.key("ctrl+s")
        self.wait("the file", lambda: self.scene_text() == "# again " + SCENE)
        self.quit()

    @soak.alone
    def test_a_link_that_takes_the_files_place_is_not_followed(self):
        theirs = pathlib.Path(self.folder.name, "theirs")
        theirs.write_text("theirs")
        self.open()
        self.edit()
        os.remove(self.scene)
        os.symlink(theirs, self.scene)
        self.key("ctrl+s")
        time.sleep(1)
        self.screenshot("became-a-link")
        self.assertEqual(theirs.read_text(), "theirs")
        self.assertEqual(len(self.drafts()), 1)

    @soak.alone
    def test_a_linked_file_is_written_where_it_is(self):
        os.mkdir(self.folder.name + "/real")
        real = pathlib.Path(self.folder.name, "real", "block.yaml")
        os.rename(self.scene, real)
        real.chmod(0o640)
        os.symlink(real, self.scene)
        self.open()
        self.edit()
        self.screenshot("linked")
        self.key("ctrl+s")
        self.wait("the text", lambda: real.read_text() == "# mine " + SCENE)
        self.assertTrue(os.path.islink(self.scene))
        self.assertEqual(real.stat().st_mode & 0o777, 0o640)
        self.quit()

    def test_two_windows_know_of_each_other(self):
        self.open()
        self.edit()
        before = pathlib.Path(self.drafts()[0]).read_text()
        first, name = self.second()
        self.key("ctrl+e")
        time.sleep(0.5)
        self.screenshot("second-window")
        self.assertFalse(self.dialogs("^Unsaved text$"))
        self.key("ctrl+Home")
        self.type("# second ")
        time.sleep(1)
        self.assertEqual(pathlib.Path(self.drafts()[0]).read_text(), before)
        self.key("ctrl+s")
        self.wait("the text", lambda: self.scene_text() == "# second " + SCENE)
        self.quit()
        self.name, self.window = name, first
        self.xdotool("windowfocus", name)
        self.key("ctrl+s")
        self.answer("^Overwrite", "Escape")
        self.assertEqual(self.scene_text(), "# second " + SCENE)

    @soak.alone
    def test_pasting_what_is_not_there_does_nothing(self):
        """As after the start of an X server."""
        self.open()
        self.key("ctrl+e", "ctrl+Home", "ctrl+v", "shift+Insert")
        self.xdotool("mousemove", "250", "300", "click", "2")
        time.sleep(0.5)
        self.assertIsNone(self.window.poll())
        self.type("# mine ")
        self.key("ctrl+s")
        self.wait("the text", lambda: "# mine" in self.scene_text())
        self.quit()

    def test_a_window_that_another_program_destroys_ends_its_session(self):
        self.open()
        self.edit()
        self.key("ctrl+s")
        self.start()
        time.sleep(1)
        self.xdotool("windowclose", self.name)
        self.assertEqual(self.window.wait(60), 0)
        with self.ended("complete") as file:
            self.assertGreater(len(self.series(file, "solver")), 300)

    @soak.alone
    def test_a_window_that_another_program_destroys_leaves_its_draft(self):
        self.open()
        self.edit()
        self.xdotool("windowclose", self.name)
        self.assertEqual(self.window.wait(60), 0)
        self.assertEqual(len(self.drafts()), 1)
        self.assertEqual(self.scene_text(), SCENE)


if __name__ == "__main__":
    unittest.main()
