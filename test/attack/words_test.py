"""Words that cannot be read again, at every door: files, the command line, the terminal's questions, Python.

What gets in has to come out as it was, of every file that the program wrote; all else is refused before a session
begins.

Usage: attack/words_test.py PROGRAM, from the project's folder. DIHAPTIC_ATTACKS=all tries far more of them.
"""
import csv
import os
import pathlib
import pty
import random
import subprocess
import sys
import tempfile
import unittest

sys.path.append("test/cli")
from program import PROGRAM, dihaptic, patient

ALL = os.environ.get("DIHAPTIC_ATTACKS") == "all"
ESCAPES = ["\\e", "\\x01", "\\0", "\\x7f", "\\a", "\\b", "\\r", "\\x85", "\\x9b", "\\uFEFF", "\\uFFFE"]


def run(*arguments):
    """As dihaptic(), with arguments that may be any bytes."""
    return subprocess.run([PROGRAM.encode(), *[a if isinstance(a, bytes) else a.encode() for a in arguments]],
                          capture_output=True, timeout=patient(300))


class Words(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.out = self.folder / "out"

    def assert_refused(self, result, *words):
        told = result.stderr.decode(errors="replace")
        self.assertEqual(result.returncode, 2, told)
        for word in words:
            self.assertIn(word, told)
        self.assertFalse(self.out.exists() and any(self.out.iterdir()), "a session was begun")

    def test_the_command_line(self):
        for word in (b"S\x1b1", b"J\xfcrgen1", b"\xed\xa0\x801", b"S\x7f1", b"S\n1", b"S\xc2\x9b1", b"S\xef\xbf\xbe1"):
            for arguments in ([b"--participant", word], [b"--age", word], [b"--out", bytes(self.out) + word]):
                with self.subTest(arguments=arguments):
                    self.assert_refused(run("run", "experiments/lift-block.yaml", "--out", str(self.out), *arguments),
                                        "command line, word ")
        self.assert_refused(run("rehearse", "experiments/first-trials.yaml", "--out", b"re\xfc"), "byte 3 is 0xfc")

    def test_a_folder_whose_name_is_no_text(self):
        place = bytes(self.folder) + b"/M\xfcller"
        os.mkdir(place)
        result = subprocess.run([os.path.abspath(PROGRAM), "run", os.path.abspath("experiments/lift-block.yaml")], cwd=place,
                                capture_output=True, timeout=patient(60))
        self.assert_refused(result, "the folder that you are in", "is not UTF-8 text")

    def test_the_terminal_s_questions(self):
        """They are asked before a real device is looked for, which is not there."""
        here, there = pty.openpty()
        with subprocess.Popen([PROGRAM, "run", "experiments/first-trials.yaml", "--rig", "rigs/phantom-pair-openhaptics.yaml", "--out", str(self.out)],
                              stdin=there, stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as program:
            os.write(here, b"S1\x1b[D\nS07\n30\nF\nright\n")
            told = program.communicate(timeout=patient(300))[0].decode()
        self.assertIn("has a control character (ESC, which arrow keys send too)", told)
        self.assertEqual(told.count("participant, e.g. S07: "), 2)
        self.assertEqual(told.count("age in years: "), 1)

    def test_escapes_in_each_text_of_an_experiment(self):
        text = pathlib.Path("experiments/first-trials.yaml").read_text().replace("../", os.getcwd() + "/")
        in_comment = lambda i: "#" in text[text.rfind("\n", 0, i) + 1:i]
        places = [i for i in range(len(text)) if text.startswith(": ", i) and text[i + 2].isalpha() and not in_comment(i)]
        chosen = random.Random(1)
        file = self.folder / "escapes.yaml"
        for n in range(200 if ALL else 15):
            at = chosen.choice(places) + 2
            end = min(text.index(c, at) for c in ",}]\n" if c in text[at:])
            escape = chosen.choice(ESCAPES)
            file.write_text(f'{text[:at]}"{text[at:end]}{escape}"{text[end:]}')
            with self.subTest(n=n, line=text.count("\n", 0, at) + 1, escape=escape):
                line = text.count("\n", 0, at) + 1
                self.assert_refused(run("run", str(file), "--simulate", "--participant", "S1", "--out", str(self.out)),
                                    f"escapes.yaml:{line}: ")

    def random_word(self, chosen):
        letters = "aZ09 _-.,;:'\"#%&*!|>?@`[]{}\\/~<=$äßéñ€中文🙂\u00a0\u200b\u2028\u0301"
        return "".join(chosen.choice(letters) for _ in range(chosen.randrange(1, 12))).strip(" ") or "x"

    def test_what_gets_in_comes_out(self):
        """A participant of any words: of session.yaml, trials.csv, reports and resumed sessions."""
        chosen = random.Random(2)
        for n in range(60 if ALL else 6):
            word = self.random_word(chosen) + "1"
            with self.subTest(n=n, word=word), tempfile.TemporaryDirectory() as out:
                result = dihaptic("run", "experiments/first-trials.yaml", "--simulate", f"--participant={word}", "--out", out)
                if result.returncode == 2:
                    self.assertEqual(os.listdir(out), [], result.stderr)
                    continue
                self.assertEqual(result.returncode, 0, result.stderr)
                (session,) = pathlib.Path(out).iterdir()
                with open(session / "trials.csv", newline="", encoding="utf-8") as file:
                    self.assertEqual({row["ppid"] for row in csv.DictReader(file)}, {"sim-" + word})
                for command in ("report", "replay", "recover"):
                    result = dihaptic(command, str(session))
                    self.assertEqual(result.returncode, 0, command + ": " + result.stderr)


class OlderSessions(unittest.TestCase):
    """Versions before 0.3 let control characters in: what they left is mended by recover."""

    def test_a_session_that_cannot_be_resumed_for_a_name(self):
        with tempfile.TemporaryDirectory() as folder:
            text = pathlib.Path("experiments/first-trials.yaml").read_text().replace("../", os.getcwd() + "/")
            experiment = pathlib.Path(folder, "e.yaml")
            experiment.write_text(text)
            out = folder + "/out"
            self.assertEqual(dihaptic("run", str(experiment), "--simulate", "--participant", "S1", "--out", out).returncode, 0)
            (session,) = pathlib.Path(out).iterdir()
            info = (session / "session.yaml").read_bytes()
            (session / "session.yaml").write_bytes(info.replace(b"id: sim-S1", b'id: "sim-S\\e1"').replace(b"first-trials", b"f\xfcrst"))
            trials = (session / "trial-list.csv").read_bytes()
            (session / "trial-list.csv").write_bytes(trials.replace(b"\n", b"\x1b\n", 3).replace(b"\x1b\n", b"\n", 1))
            for command in ("report", "resume"):
                self.assertEqual(dihaptic(command, str(session)).returncode, 2)
            mended = dihaptic("recover", str(session))
            self.assertEqual(mended.returncode, 0, mended.stderr)
            self.assertIn("session.yaml.before is the file as it was", mended.stderr + mended.stdout)
            self.assertEqual((session / "session.yaml.before").read_bytes(), info.replace(b"id: sim-S1", b'id: "sim-S\\e1"').replace(b"first-trials", b"f\xfcrst"))
            self.assertIn("id: sim-S\ufffd1", (session / "session.yaml").read_text().replace('"', ""))
            self.assertEqual(dihaptic("report", str(session)).returncode, 0)


if __name__ == "__main__":
    unittest.main()
