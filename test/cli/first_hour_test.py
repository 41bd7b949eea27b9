"""The first hour: what to type next; a study of one's own, whose README.md is followed to the letter; what the machine lacks.

Usage: first_hour_test.py PROGRAM, from the project's folder.
"""
import csv
import os
import pathlib
import re
import shlex
import signal
import subprocess
import tempfile
import time
import unittest

from program import PROGRAM, dihaptic, patient, with_largest_file

import needs  # program.py adds its folder to the path
import soak

HERE = pathlib.Path(PROGRAM).resolve()
MADE_FROM = pathlib.Path("app/cli/new_study").resolve()
FILES = ["README.md", "experiment.yaml", "rig.yaml", "scene.yaml"]


class FirstHour(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def new(self, *arguments, **options):
        return dihaptic("new", "study", *arguments, program=str(HERE), cwd=self.folder, **options)


class WithoutArguments(FirstHour):
    def test_says_what_to_do_next_and_each_line_can_be_typed(self):
        for cwd in [".", self.folder]:
            result = dihaptic(program=str(HERE), cwd=cwd)
            self.assertEqual(result.returncode, 2)  # a script whose command is empty has not succeeded
            self.assertEqual(result.stdout, "")
            self.assertLess(result.stderr.count("\n"), 12)
            commands = [shlex.split(words) for words in re.findall(r"^  (\S.+?)   ", result.stderr, re.MULTILINE)]
            self.assertEqual([words[0] for words in commands], [str(HERE)] * len(commands))
            arguments = [words[1:] for words in commands]
            self.assertEqual([words[0] for words in arguments], ["run", "gui", "new", "doctor", "--help"])
            for words in arguments:
                known = [word for word in words if not word.endswith(".yaml") and word != "NAME"]
                self.assertEqual(dihaptic(*known, "--help").returncode, 0, words)
            demo = arguments[0][1]
            result = dihaptic("run", demo, "--out", str(self.folder / "sessions"), program=str(HERE), cwd=cwd)
            self.assertEqual(result.returncode, 0, result.stderr)


class NewStudy(FirstHour):
    def test_makes_the_files_that_the_project_has(self):
        result = self.new("wrist")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(sorted(os.listdir(self.folder / "wrist")), FILES)
        self.assertEqual(sorted(os.listdir(MADE_FROM)), FILES)
        for name in FILES:
            text = (self.folder / "wrist" / name).read_text()
            line, rest = re.fullmatch(r"(?s)(# yaml-language-server: \S+\n)?(.*)", text).groups()
            self.assertEqual(rest, (MADE_FROM / name).read_text())
            self.assertEqual(line is not None, name != "README.md")
            self.assertNotIn("../", text, "of no file outside the folder")
            self.assertIn(name, result.stdout)
            if name != "README.md":
                self.assertIn(f"| `{name}` |", (MADE_FROM / "README.md").read_text())
        self.assertIn("next: cd wrist", result.stdout)

    def test_says_how_the_shell_finds_the_program(self):
        folder = str(HERE.parent)
        quoted = shlex.quote(folder)
        command = f'export PATH="{folder}:$PATH"' if quoted == folder else f'export PATH={quoted}:"$PATH"'
        self.assertIn(command, self.new("one", env=dict(os.environ, PATH="/usr/bin")).stdout)
        self.assertIn(command, self.new("two", env={}).stdout)
        found = dict(os.environ, PATH=f"/usr/bin:{HERE.parent}")
        self.assertNotIn("PATH", self.new("three", env=found).stdout)
        another = self.folder / "bin" / "dihaptic"
        another.parent.mkdir()
        another.touch(0o755)
        self.assertIn(command, self.new("four", env=dict(os.environ, PATH=f"{another.parent}:{HERE.parent}")).stdout)

    def test_goes_where_it_is_told(self):
        (self.folder / "studies").mkdir()
        for path in ["studies/wrist", "./arm", str(self.folder / "studies/grip_2.b/")]:
            self.assertEqual(self.new(path).returncode, 0)
            self.assertEqual(sorted(os.listdir(self.folder / path)), FILES)

    def test_touches_nothing_that_is_there(self):
        (self.folder / "file").write_text("mine")
        (self.folder / "empty").mkdir()
        (self.folder / "link").symlink_to("/nowhere")
        for name in ["file", "empty", "link", "empty/"]:
            result = self.new(name)
            self.assertEqual(result.returncode, 2)
            self.assertIn(f"{name.rstrip('/')}: error: already exists. Choose another name.", result.stderr)
        self.assertEqual((self.folder / "file").read_text(), "mine")
        self.assertEqual(os.listdir(self.folder / "empty"), [])
        self.assertEqual(sorted(os.listdir(self.folder)), ["empty", "file", "link"])

    def test_makes_a_scene_or_an_experiment_alone(self):
        def new(*words):
            return dihaptic("new", *words, program=str(HERE), cwd=self.folder)

        self.assertEqual(new("scene", "mine.yaml").returncode, 0)
        self.assertEqual(os.listdir(self.folder), ["mine.yaml"])
        (self.folder / "scene.yaml").write_text("mine")
        self.assertEqual(new("experiment", "reach.yaml").returncode, 0)
        self.assertEqual(sorted(os.listdir(self.folder)), ["mine.yaml", "reach.yaml", "rig.yaml", "scene.yaml"])
        self.assertEqual((self.folder / "scene.yaml").read_text(), "mine")  # the study's own is used
        (self.folder / "scene.yaml").write_text((self.folder / "mine.yaml").read_text())
        check = dihaptic("check", "mine.yaml", "reach.yaml", "rig.yaml", program=str(HERE), cwd=self.folder)
        self.assertEqual(check.returncode, 0, check.stderr)
        for words, told in [(["scene", "mine.yaml"], "already exists"), (["scene", "other"], "dihaptic new scene other.yaml"),
                            (["experiment", "my reach.yaml"], "dihaptic new experiment my-reach.yaml"),
                            (["experiment", "sub/rig.yaml"], "Make it first"),
                            (["experiment", "sub2/rig.yaml"], "Choose another name")]:
            (self.folder / "sub2").mkdir(exist_ok=True)
            result = new(*words)
            self.assertEqual(result.returncode, 2, words)
            self.assertIn(told, result.stderr)
        self.assertEqual(os.listdir(self.folder / "sub2"), [])

    def test_refuses_names_that_a_shell_takes_otherwise(self):
        for name, better in [("my study", "my-study"), ("a;b", "a-b"), ("$HOME", "HOME"), (".hidden", "hidden"),
                             ("", "my-study"), ("..", "my-study"), ("../my study", "my-study")]:
            result = self.new(name)
            self.assertEqual(result.returncode, 2, name)
            self.assertIn(f"Use letters, digits, '-' and '_': dihaptic new study {better}.\n", result.stderr)
            self.assertEqual(self.new(better).returncode, 0, better)
            subprocess.run(["rm", "-r", better], cwd=self.folder, check=True)
        self.assertEqual(os.listdir(self.folder), [])

    def test_says_what_is_wrong_with_the_folder_that_it_is_to_be_in(self):
        (self.folder / "file").touch()
        for path, message in [("none/wrist", "none: error: does not exist. Make it first: mkdir -p 'none'."),
                              ("file/wrist", "file: error: is not a folder."),
                              ("/proc/wrist", "/proc/wrist: error: cannot be made: "),
                              ("w" * 300, "cannot be made: File name too long")]:
            result = self.new(path)
            self.assertEqual(result.returncode, 2, path)
            self.assertIn(message, result.stderr)
        self.assertEqual(os.listdir(self.folder), ["file"])

    def test_leaves_nothing_half_made(self):
        result = self.new("wrist", preexec_fn=with_largest_file(2000))
        self.assertEqual(result.returncode, 2, result.stdout)
        self.assertIn("cannot be written", result.stderr)
        self.assertEqual(os.listdir(self.folder), [])


class Readme(FirstHour):
    """README.md of a study, as a student follows it: from top to bottom, in its folder."""

    def setUp(self):
        super().setUp()
        self.assertEqual(self.new("wrist").returncode, 0)
        self.study = self.folder / "wrist"
        self.readme = (self.study / "README.md").read_text()
        self.environment = dict(os.environ, PATH=f"{HERE.parent}:{os.environ['PATH']}", HOME=str(self.folder),
                                XDG_RUNTIME_DIR=str(self.folder))

    def typed(self, command):
        return subprocess.run(command, shell=True, cwd=self.study, env=self.environment, stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, timeout=patient(300))

    def open_a_display(self):
        needs.for_this_test("Xvfb", "xvfb")
        needs.for_this_test("xdotool", "xdotool")
        read, write = os.pipe()
        display = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-noreset"], pass_fds=[write],
                                   stderr=subprocess.DEVNULL)
        self.addCleanup(display.wait)
        self.addCleanup(display.kill)
        os.close(write)
        with os.fdopen(read) as pipe:
            self.environment["DISPLAY"] = ":" + pipe.readline().strip()

    def look_at_window(self, command):
        """The window shows the study, and is closed."""
        needs.part_for_this_test("window", PROGRAM)
        self.open_a_display()
        with open(self.folder / "log", "w+") as log:
            window = subprocess.Popen(command.split(), cwd=self.study, env=self.environment, stdout=log, stderr=log)
            self.addCleanup(window.wait)
            self.addCleanup(window.kill)
            look = ["xdotool", "search", "--onlyvisible", "--name", " - Dihaptic$"]
            end = time.monotonic() + patient(60)
            while not (found := subprocess.run(look, env=self.environment, capture_output=True, text=True).stdout):
                log.seek(0)
                self.assertIsNone(window.poll(), log.read())
                self.assertLess(time.monotonic(), end)
                time.sleep(0.1)
            # there is no window manager to give the window the keyboard
            subprocess.run(["xdotool", "windowfocus", "--sync", found.split()[-1], "key", "ctrl+q"],
                           env=self.environment, timeout=patient(60))
            self.assertEqual(window.wait(patient(60)), 0)

    def test_every_command_of_it_does_what_it_says(self):
        commands = re.findall(r"^    (.+)$", self.readme, re.MULTILINE)
        self.assertEqual([command.split()[1] for command in commands],
                         ["check", "picture", "rehearse", "report", "collect", "rehearse", "gui", "run", "run", "report"])
        for command in commands:
            with self.subTest(command):
                self.assertTrue(command.startswith("dihaptic "))
                if command.split()[1] == "gui":
                    self.look_at_window(command)
                    continue
                self.assertEqual(command.count("--people 20"), command.split()[1] == "rehearse")
                result = self.typed(command.replace("--people 20", soak.of("--people 8", "--people 20")))
                self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
                self.assertNotIn("warning", result.stdout + result.stderr)
                self.assertNotIn("note:", result.stdout + result.stderr)
        for made in re.findall(r"`((?:rehearsals|sessions)\S*)`", self.readme) + ["scene.png", "sessions/report.html"]:
            self.assertTrue((self.study / made).exists(), made)
        self.people_learn(self.study / "rehearsals/experiment_1/trials.csv")

    def people_learn(self, trials):
        """What experiment.yaml says is to come out."""
        with open(trials) as file:
            rows = [row for row in csv.DictReader(file) if row["outcome"] == "reached"]

        def mean(column, block, first, last):
            values = [float(row[column]) for row in rows
                      if row["block"] == block and first <= int(row["trial_num_in_block"]) <= last]
            return sum(values) / len(values)

        self.assertAlmostEqual(mean("shown_angle_deg", "baseline", 1, 16), 0, delta=2)
        self.assertAlmostEqual(mean("shown_angle_deg", "rotation", 1, 1), 30, delta=5)
        self.assertLess(mean("shown_angle_deg", "rotation", 41, 48), 20)
        self.assertLess(mean("hand_angle_deg", "clamp", 1, 4), -5)
        self.assertLess(mean("shown_angle_deg", "washout", 1, 2), -2)
        self.assertGreater(mean("shown_angle_deg", "washout", 17, 24), mean("shown_angle_deg", "washout", 1, 2))

    def test_commands_within_its_sentences_are_there(self):
        named = re.findall(r"`dihaptic (\w+)`", self.readme)
        self.assertEqual(sorted(named), ["devices", "doctor"])
        for command in named:
            self.assertEqual(dihaptic(command, "--help").returncode, 0, command)
        for page in re.findall(r"\bdocs/\S+\.md", self.readme):
            self.assertTrue(pathlib.Path(page).exists(), page)

    def test_what_the_comments_propose_can_be_done(self):
        scene = self.study / "scene.yaml"
        text = scene.read_text()
        block = re.search(r"^  # (- \{ name: block,.*\})$", text, re.MULTILINE)
        scene.write_text(text.replace(block[0], "  " + block[1]))
        self.assertEqual(self.typed("dihaptic check experiment.yaml").returncode, 0)
        rig = self.study / "rig.yaml"
        text = rig.read_text()
        presets = re.search(r"# The preset plant .* Try (\w+), (\w+) or (\w+),", text).groups()
        for preset in presets:
            changed = text.replace("preset: plant", "preset: " + preset)
            self.assertNotEqual(changed, text)
            rig.write_text(changed)
            result = self.typed("dihaptic check experiment.yaml")
            self.assertEqual(result.returncode, 0, result.stdout)


class Doctor(FirstHour):
    HEADINGS = ["real time", "devices", "graphics", "sound", "disk", "parts of Dihaptic"]
    FINDING = r"^  (ok|lacks|note) +(?<=^.{9})(\S.{13}) (.*(?:\n {24}\S.*)*)\n((?: {28}.*\n)*)"

    def doctor(self, **options):
        """How it ended, and what it found: (verdict, what, text, commands) of each."""
        options = {"cwd": self.folder, **options}
        result = dihaptic("doctor", program=str(HERE), **options)
        self.assertEqual(result.stderr, "")
        self.assertEqual(re.findall(r"^\w.*$", result.stdout, re.MULTILINE)[:-1], self.HEADINGS)
        found = [(verdict, what.strip(), re.sub(r"\s+", " ", text), commands)
                 for verdict, what, text, commands in re.findall(self.FINDING, result.stdout, re.MULTILINE)]
        self.assertEqual(len(found), len(re.findall("^  (?:ok|lacks|note)", result.stdout, re.MULTILINE)))
        return result, found

    def verdict(self, found, what):
        (verdict,) = {verdict for verdict, name, _, _ in found if name == what}
        return verdict

    def test_has_a_command_for_whatever_lacks_and_leaves_nothing(self):
        result, found = self.doctor()
        self.assertEqual(result.returncode, 0, result.stdout)
        self.assertIn("Sessions on simulated devices can be run here.", result.stdout)
        for verdict, what, _, commands in found:
            if verdict == "lacks":
                self.assertTrue(commands, what)
        for what in ["room", "writing", "mesh", "decompose", "host", "gui", "Python", "ffmpeg", "shipped files"]:
            self.assertEqual(self.verdict(found, what), "ok", what)
        self.assertEqual(os.listdir(self.folder), [])

    def test_knows_every_program_that_is_built(self):
        programs = {name for file in pathlib.Path("app").glob("*/CMakeLists.txt")
                    for name in re.findall(r"add_executable\(dihaptic-(\w+)", file.read_text())}
        self.assertGreaterEqual(programs, {"gui", "host", "mesh", "decompose"})
        _, found = self.doctor()
        for name in programs - {"bench"}:  # the benches are optional for labs
            self.assertEqual(self.verdict(found, name), "ok", name)

    def test_says_when_sessions_cannot_be_recorded(self):
        for options in [{"cwd": "/proc"}, {"preexec_fn": with_largest_file(1_000_000)}]:
            result, found = self.doctor(**options)
            self.assertEqual(result.returncode, 1, result.stdout)
            self.assertIn("Sessions on simulated devices cannot run here yet.", result.stdout)
            self.assertEqual(self.verdict(found, "writing"), "lacks")
        (self.folder / "sessions").symlink_to("/proc")
        self.assertEqual(self.doctor()[0].returncode, 1)

    def library(self, name, does):
        """A maker's library whose only deed is done when it is loaded."""
        source = self.folder / "library.c"
        source.write_text("#include <stdlib.h>\n#include <stdio.h>\n#include <unistd.h>\n"
                          "__attribute__((constructor)) static void begin(void) { " + does + " }\n")
        subprocess.run(["cc", "-shared", "-fPIC", "-o", self.folder / name, source], check=True)

    @soak.alone
    def test_goes_on_after_libraries_that_crash_hang_and_chatter(self):
        self.library("libdhd.so.3", "abort();")
        self.library("libHD.so", "for (;;) pause();")
        self.library("libHD.so.3.4", "")
        result, found = self.doctor(env=dict(os.environ, LD_LIBRARY_PATH=str(self.folder)))
        self.assertEqual(result.returncode, 0, result.stdout)
        texts = {what: text for _, what, text, _ in found}
        self.assertIn("crashed", texts["forcedimension"])
        self.assertIn("took more than", texts["openhaptics"])
        self.assertEqual(self.verdict(found, "openhaptics"), "note")
        self.library("libdhd.so.3", 'puts("[1] looking for devices"); fflush(stdout);')
        self.library("libHD.so", "")
        texts = {what: text for _, what, text, _ in self.doctor(env=dict(os.environ, LD_LIBRARY_PATH=str(self.folder)))[1]}
        self.assertIn("libdhd.so.3 has no dhd", texts["forcedimension"])
        self.assertIn("libHD.so has no hd", texts["openhaptics"])

    def test_ends_at_once_by_ctrl_c(self):
        self.library("libHD.so", "for (;;) pause();")
        doctor = subprocess.Popen([HERE, "doctor"], cwd=self.folder, start_new_session=True, stdout=subprocess.PIPE,
                                  env=dict(os.environ, LD_LIBRARY_PATH=str(self.folder)), text=True)
        self.addCleanup(doctor.stdout.close)
        for line in doctor.stdout:
            if " haply " in line:  # the line on OpenHaptics is next
                break
        time.sleep(1)
        asked = time.monotonic()
        os.killpg(doctor.pid, signal.SIGINT)
        self.assertEqual(doctor.wait(patient(60)), 1)
        self.assertLess(time.monotonic() - asked, patient(5))


if __name__ == "__main__":
    unittest.main(verbosity=2)
