"""What is typed wrongly, or only asked about: help, version, options, files that are not there; and fits of tables.

Usage: commands_test.py PROGRAM, from the project's folder.
"""
import json
import os
import pathlib
import re
import tempfile
import unittest

from program import PROGRAM, dihaptic

import needs  # program.py adds its folder to the path


def commands(of=()):
    """All commands, as their own help lists them: the program itself, then each subcommand with its own."""
    yield list(of)
    help = dihaptic(*of, "--help").stdout
    listed = re.search(r"^Subcommands:\n((?:  .*\n)+)", help, re.MULTILINE)
    for name in re.findall(r"^  (\w+)", listed[1], re.MULTILINE) if listed else []:
        yield from commands((*of, name))


class Commands(unittest.TestCase):
    def test_every_command_has_help_with_an_example(self):
        found = list(commands())
        for command in [[], ["run"], ["bench", "grasp"], ["fit", "psychometric"], ["new", "study"]]:
            self.assertIn(command, found)
        for command in found:
            result = dihaptic(*command, "--help")
            self.assertEqual(result.returncode, 0, command)
            self.assertIn("Example", result.stdout, command)
            self.assertIn("dihaptic", result.stdout, command)

    def test_version(self):
        self.assertRegex(dihaptic("--version").stdout, r"^dihaptic \d+\.\d+\.\d+\n$")

    def test_wrong_use_fails_and_says_how(self):
        for arguments in [["fly"], ["rnu"], ["run"], ["run", "scenes/block-on-table.yaml", "--clock", "sundial"], []]:
            result = dihaptic(*arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertIn("--help", result.stderr, arguments)

    def test_an_unknown_command_is_named(self):
        self.assertIn("error: 'launch' is not a command. Commands are run, replay", dihaptic("launch").stderr)
        self.assertIn("Did you mean check? See dihaptic --help.", dihaptic("chekc", "x").stderr)

    def test_numbers_of_options_have_ranges(self):
        for rate in ["nan", "0", "-1", "1e9", "fast"]:
            for command in [["run", "scenes/block-on-table.yaml"], ["bench", "grasp"]]:
                result = dihaptic(*command, f"--rate={rate}")
                self.assertEqual(result.returncode, 2, rate)
                self.assertIn(f"--rate: must be a number from 100 to 10000, is '{rate}'", result.stderr)
        for seed in ["-1", "1.5", "99999999999999999999999"]:
            result = dihaptic("run", "scenes/block-on-table.yaml", "--seed", seed)
            self.assertEqual(result.returncode, 2, seed)
            self.assertIn(f"--seed: must be a whole number from 0 to 18446744073709551615, is '{seed}'", result.stderr)

    def test_bad_input_fails_with_file_and_remedy(self):
        for arguments in [["run", "gone.yaml"], ["run", "README.md"], ["replay", "/tmp"], ["recover", "/nowhere"],
                          ["run", "scenes/block-on-table.yaml", "--rig", "gone.yaml"],
                          ["run", "scenes/block-on-table.yaml", "--solver", "magic"],
                          ["run", "scenes/block-on-table.yaml", "--out", "/proc/nowhere"],
                          ["run", "scenes/block-on-table.yaml", "--out", ""],
                          ["run", "scenes/block-on-table.yaml", "--participant", "S" * 300]]:
            result = dihaptic(*arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertIn("error:", result.stderr, arguments)
            self.assertNotIn("report this", result.stderr, arguments)

    def test_a_window_needs_a_screen(self):
        needs.part_for_this_test("window", PROGRAM)
        nowhere = {name: value for name, value in os.environ.items()
                   if name not in ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM")}
        result = dihaptic("gui", env=nowhere)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("there is no screen for a window", result.stderr)

    def test_fit_two_rate_gives_back_the_rates_that_made_a_table(self):
        truth = {"retention_fast": 0.59, "learning_fast": 0.21, "retention_slow": 0.992, "learning_slow": 0.02}
        trials = [(0, 0)] * 32 + [(30, 0)] * 80 + [(-30, 0)] * 10 + [("", 1)] * 30
        fast = slow = 0
        lines = ["perturbation,clamp,compensation"]
        for i, (perturbation, clamp) in enumerate(trials):
            lines.append(f"{perturbation},{clamp},{'' if i % 7 == 3 else repr(fast + slow)}")
            error = 0 if clamp else perturbation - fast - slow
            fast = truth["retention_fast"] * fast + truth["learning_fast"] * error
            slow = truth["retention_slow"] * slow + truth["learning_slow"] * error
        with tempfile.TemporaryDirectory() as folder:
            file = folder + "/person.csv"
            pathlib.Path(file).write_text("\n".join(lines) + "\n")
            result = dihaptic("fit", "two_rate", file, "--json")
            self.assertEqual(result.returncode, 0, result.stderr)
            fit = json.loads(result.stdout)
            self.assertEqual(sorted(fit), sorted([*truth, "intervals_95", "n", "note", "sse"]))
            for name, value in truth.items():
                self.assertAlmostEqual(fit[name], value, places=4)
            self.assertLess(fit["sse"], 1e-8)
            self.assertEqual(fit["n"], len(trials) - len([i for i in range(len(trials)) if i % 7 == 3]))
            self.assertIn("95 %", dihaptic("fit", "two_rate", file).stdout)
            for line, bad, key in [(3, "0,2,1", "clamp"), (3, "much,0,1", "perturbation"), (3, "0,0,x", "compensation"),
                                   (1, "perturbation,compensation", "clamp")]:
                wrong = lines.copy()
                wrong[line - 1] = bad
                pathlib.Path(file).write_text("\n".join(wrong) + "\n")
                result = dihaptic("fit", "two_rate", file, "--json")
                self.assertEqual(result.returncode, 2)
                self.assertIn(f"{file}:{line}: error: {key}: ", result.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
