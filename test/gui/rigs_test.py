"""Rigs: calibrated in the window, moved since, or unable to start."""
import glob
import pathlib
import time
import unittest

from window import PROGRAM, Window

import soak


class Rigs(Window):
    def with_rig(self, text):
        pathlib.Path(self.folder.name + "/rig.yaml").write_text(text)
        file = self.folder.name + "/experiment.yaml"
        pathlib.Path(file).write_text("scene: block.yaml\nrig: rig.yaml\n")
        self.open(file)

    def dialog(self, name):
        found = self.wait(f"the dialog '{name}'", lambda: self.xdotool("search", "--onlyvisible", "--name", name)).split()[-1]
        time.sleep(0.5)
        self.xdotool("windowfocus", found)
        time.sleep(0.3)
        return found

    def gone(self, name):
        self.wait(f"the end of '{name}'", lambda: not self.xdotool("search", "--onlyvisible", "--name", name))
        self.xdotool("windowfocus", self.name)
        time.sleep(0.5)

    def test_are_calibrated_in_the_window(self):
        self.with_rig(pathlib.Path("rigs/premium-misplaced.yaml").read_text())
        mine = pathlib.Path(self.folder.name + "/rig-calibration.yaml")
        for answer in ["Escape", "Return"]:
            self.key("alt+s", "c")
            self.dialog("^Result of the calibration")
            self.screenshot("calibration")
            self.key(answer)
            self.gone("^Result of the calibration")
            self.assertEqual(mine.exists(), answer == "Return")
        self.assertIn("agreement_rms_m", mine.read_text())
        self.assertIn("<svg", mine.with_suffix(".svg").read_text())
        self.assertIn("\ncalibration: rig-calibration.yaml\n", pathlib.Path(self.folder.name + "/rig.yaml").read_text())
        self.quit()

    @soak.alone
    def test_have_displays_that_are_registered_in_the_window(self):
        self.with_rig(pathlib.Path("rigs/mirror-rig.yaml").read_text())
        mine = pathlib.Path(self.folder.name + "/rig-mirror-registration.yaml")
        for answer in ["Escape", "Return"]:
            self.key("alt+s", "g")
            self.dialog("^Result of the registration")
            self.screenshot("registration")
            self.key(answer)
            self.gone("^Result of the registration")
            self.assertEqual(mine.exists(), answer == "Return")
        self.assertIn("rms_m", mine.read_text())
        self.quit()

    def on_fakes(self, together, more=""):
        """Two devices that nobody moves, and how far apart they are said to have been; `more`: of the rig."""
        self.real_rig = True
        library = pathlib.Path(PROGRAM).resolve().parent / "src/devices/libfake_hd.so"
        self.allow(library)
        pathlib.Path(self.folder.name + "/mine.yaml").write_text(
            f"date: {time.strftime('%Y-%m-%d')}\ndevices: [{{finger: thumb}}, {{finger: index, together_mm: {together}}}]\n")
        self.with_rig("title: Two fakes\ncalibration: mine.yaml\ndevices:\n" + "".join(
            f"  - {{finger: {finger}, backend: openhaptics, options: {{library: {library}, name: PHANToM {i}}}}}\n"
            for i, finger in [(1, "thumb"), (2, "index")]) + more)

    @soak.alone
    def test_lead_a_person_through_a_calibration_who_gives_up(self):
        self.on_fakes(0)
        self.key("alt+s", "c")
        self.dialog("^Calibration: Two fakes")
        self.key("Return")  # reset
        self.key("Return")  # link
        time.sleep(1)
        self.key("Return")  # refused, since nobody has moved the endpoints
        time.sleep(1)
        self.screenshot("guide")
        self.key("Escape")
        self.gone("^Calibration: Two fakes")
        self.assertEqual(list(pathlib.Path(self.folder.name).glob("rig-calibration*")), [])
        self.quit()

    @soak.alone
    def test_that_were_moved_since_their_calibration_are_warned_of(self):
        self.on_fakes(12)
        for answer, notes in [("Return", True), ("alt+s", False)]:
            before = len(glob.glob(self.out + "/*/raw.log"))
            self.ask_to_start()
            self.dialog("^Is the calibration still valid")
            self.screenshot("together")
            self.key(answer)
            self.gone("^Is the calibration still valid")
            self.wait("the start", lambda: len(glob.glob(self.out + "/*/raw.log")) > before)
            time.sleep(0.5)
            self.key("F7")
            with self.ended("complete"):
                pass
            self.settle()
            info = pathlib.Path(self.recording() + "session.yaml").read_text()
            self.assertEqual("12.0 mm apart when the rig was calibrated" in info, notes, info)
        self.quit()

    def test_that_cannot_start_ask_for_nothing_more(self):
        self.on_fakes(0, "outlets: [{ kind: serial, options: { port: /dev/no-such-line } }]\n")
        self.ask_to_start()
        time.sleep(2)
        self.settle()
        self.assertEqual(self.xdotool("search", "--onlyvisible", "--name", "^Is the calibration still valid"), "")
        self.assertEqual(glob.glob(self.out + "/*"), [])
        self.xdotool("windowfocus", self.name)
        self.quit()


if __name__ == "__main__":
    unittest.main()
