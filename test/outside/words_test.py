"""Words on the command line that are not UTF-8, for every command. docs/outside.md has the sources.

Usage: outside/words_test.py PROGRAM, from the project's folder.
"""
import os
import re
import subprocess
import sys
import tempfile
import unittest

sys.path.append("test/cli")
from program import PROGRAM, dihaptic, patient

PROGRAM = os.path.abspath(PROGRAM)
#: A name in Latin-1, half of a surrogate pair, an overlong encoding, a byte that cannot begin a character.
WORDS = (b"M\xfcller", b"a\xed\xa0\x80", b"\xc0\xaf", b"\xff", b"end\xe2\x82")


def commands():
    """Every command with its options, as the help lists them."""
    listed = dihaptic("--help").stdout.split("Subcommands:")[1]
    for name in re.findall(r"^  (\w[\w-]*) ", listed, re.M):
        options = re.findall(r"(--[a-z][\w-]*) [A-Z]", dihaptic(name, "--help").stdout)
        yield name, options


class Words(unittest.TestCase):
    def test_that_are_not_utf_8_are_refused_by_every_command_and_option(self):
        found = list(commands())
        self.assertGreater(len(found), 15)
        self.assertGreater(sum(len(options) for _, options in found), 40)
        with tempfile.TemporaryDirectory() as folder:
            for i, (command, options) in enumerate(found):
                for j, typed in enumerate([[], *([option] for option in options)]):
                    word = WORDS[(i + j) % len(WORDS)]
                    with self.subTest(command=command, option=typed, word=word):
                        result = subprocess.run([PROGRAM, command, *typed, word], cwd=folder, capture_output=True, timeout=patient(60))
                        self.assertEqual(result.returncode, 2, result.stderr)
                        self.assertIn("is not UTF-8 text", result.stderr.decode())
            self.assertEqual(os.listdir(folder), [])


if __name__ == "__main__":
    unittest.main(verbosity=1)
