"""What the window shows when no file is named: pictures of what there is to begin with."""
import glob
import os
import pathlib
import time
import unittest

from window import Window, starts_programs
import soak


@starts_programs
class StartPage(Window):
    def title(self):
        return self.xdotool("getwindowname", self.name).strip()

    def pictures(self):
        return glob.glob(self.folder.name + "/.cache/**/*.png", recursive=True)

    def test_shows_what_there_is_and_opens_what_is_chosen(self):
        self.open_without_a_file()
        self.wait("pictures", lambda: len(self.pictures()) >= 4)
        time.sleep(1)
        self.screenshot("start-page")
        self.key("Return")  # opens the first scene
        self.wait("a scene", lambda: self.title().endswith(" - Dihaptic"))
        self.settle()
        self.screenshot("start-chosen")
        # back to the start page, and then to the open scene
        self.key("alt+f", "t")
        time.sleep(1)
        self.key("alt+n")
        time.sleep(1)
        self.screenshot("start-recent")
        self.quit()

    def test_finds_what_is_searched_by_words_of_its_description(self):
        self.open_without_a_file()
        self.key("ctrl+f")
        self.type("carried wall")
        self.screenshot("start-found")
        self.key("Return")
        self.wait("the experiment", lambda: self.title() == "A block is carried over a wall - Dihaptic")
        self.quit()

    def test_finds_a_name_before_descriptions(self):
        self.open_without_a_file()
        self.key("ctrl+f")
        self.type("reach")  # is in the titles of earlier files, too
        self.screenshot("start-named")
        self.key("Return")
        self.wait("the experiment", lambda: self.title() == "Reaching at a tone - Dihaptic")
        self.quit()

    @soak.alone
    def test_has_a_picture_of_every_shipped_file(self):
        shipped = glob.glob("scenes/*.yaml") + glob.glob("experiments/*.yaml")
        self.open_without_a_file()
        self.wait("pictures", lambda: len(self.pictures()) == len(shipped), 240)
        self.key("alt+x")
        time.sleep(1)
        self.screenshot("start-experiments")
        self.quit()

    def test_makes_a_study_and_opens_its_experiment(self):
        self.open_without_a_file()
        self.key("alt+w")
        self.answer_with_path("^New study", self.folder.name + "/my-study")
        self.wait("the experiment", lambda: self.title() == "Adaptation to a rotated display - Dihaptic")
        self.assertEqual(sorted(os.listdir(self.folder.name + "/my-study")),
                         ["README.md", "experiment.yaml", "rig.yaml", "scene.yaml"])
        self.screenshot("start-study")
        self.quit()

    def test_says_why_a_study_cannot_be_made(self):
        pathlib.Path(self.folder.name, "old").write_text("mine")
        self.open_without_a_file()
        self.key("alt+w")
        self.answer_with_path("^New study", self.folder.name + "/old")
        self.answer("^New$", "Return")
        self.assertEqual(pathlib.Path(self.folder.name, "old").read_text(), "mine")
        self.quit()

    def test_leaves_the_computer_to_a_session(self):
        self.open_without_a_file()
        self.wait("a picture", self.pictures)
        self.key("Return")
        self.wait("a scene", lambda: self.title().endswith(" - Dihaptic"))
        time.sleep(1)
        before = len(self.pictures())
        self.start()
        time.sleep(2)
        self.assertEqual(len(self.pictures()), before)
        self.quit()


if __name__ == "__main__":
    unittest.main()
