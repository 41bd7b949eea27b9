"""Words that cannot be read again, at every door: files, the command line, the terminal's questions, Python.

What gets in has to come out as it was, of every file that the program wrote; all else is refused before a session
begins.

Usage: attack/words_test.py PROGRAM, from the project's folder. The soak tries far more of them.
"""
import csv
import itertools
import json
import os
import pathlib
import pty
import random
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.append("test/cli")
from program import PROGRAM, dihaptic, patient
import soak  # program.py adds its folder to the path

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(PROGRAM)), "python"))
import dihaptic as dihaptic_package

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
        self.assert_refused(result, "the current folder", "is not UTF-8 text")

    def test_the_terminal_s_questions(self):
        """They are asked before a real device, which does not exist, is looked for."""
        here, there = pty.openpty()
        with subprocess.Popen([PROGRAM, "run", "experiments/first-trials.yaml", "--rig", "rigs/phantom-pair-openhaptics.yaml", "--out", str(self.out)],
                              stdin=there, stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as program:
            os.write(here, b"S1\x1b[D\nS07\n30\nF\nright\n")
            told = program.communicate(timeout=patient(300))[0].decode()
        self.assertIn("has a control character (ESC, which arrow keys also send)", told)
        self.assertEqual(told.count("participant, e.g. S07: "), 2)
        self.assertEqual(told.count("age in years: "), 1)

    def test_escapes_in_each_text_of_an_experiment(self):
        text = pathlib.Path("experiments/first-trials.yaml").read_text().replace("../", os.getcwd() + "/")
        in_comment = lambda i: "#" in text[text.rfind("\n", 0, i) + 1:i]
        places = [i for i in range(len(text)) if text.startswith(": ", i) and text[i + 2].isalpha() and not in_comment(i)]
        chosen = random.Random(1)
        file = self.folder / "escapes.yaml"
        for n in range(soak.of(15, 200)):
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
        for n in range(soak.of(3, 60)):
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
                for command in (["report", "--tables"], ["replay"], ["recover"]):
                    result = dihaptic(*command, str(session))
                    self.assertEqual(result.returncode, 0, f"{command}: {result.stderr}")


WORDS = ["null", "~", "yes", "-", "---", "...", "1e3", "0x1F", "007", ".nan", "=1+1", "@a", "# a", "a: b", "- a", "!a", "&a", "*a", "|", ">",
         "'", '"', ",", "a,b", 'a"b', "\\n", "a\nb", "a\tb", "a\r", "%", "[a]", "{a}", "{{a}}", "\u2029", "\ufeffa", "\x1b[D", "\x00"]


def any_text(chosen, n):
    """A text that is one of a kind, but for the words that mean something to a format."""
    if chosen.random() < 0.15:
        return chosen.choice(WORDS)
    letters = "aZ09 _-.,;:'\"#%&*!|>?@`[]{}\\/~<=$äßéñ€中文🙂\u00a0\u200b\u2028\u0301"
    return "".join(chosen.choice(letters) for _ in range(chosen.randrange(1, 12))) + str(n)


#: Files in which each <name> stands for the text of that field.
FILES = {
    "scene.yaml": """title: <scene title>
object: <body>
bodies:
  - name: <body>
    shape: box
    size_mm: [40, 40, 40]
    mass_g: 100
    position_mm: [0, 0, 20]
    group: <group>
  - name: <floor>
    shape: plane
    fixed: yes
joints:
  - name: <joint>
    kind: slider
    position_mm: [0, 0, 0]
    axis: [0, 0, 1]
    between:
      - <body>
fingers:
  - name: <finger>
    shape: sphere
    radius_mm: 6
    mass_g: 1
cameras:
  - name: <camera>
    position_mm: [0, -300, 200]
    look_at_mm: [0, 0, 0]
""",
    "rig.yaml": """title: <rig title>
devices:
  - finger: <finger>
    backend: simulated
    options:
      serial: <serial>
jig:
  - name: <point>
    position_mm: [-30, -30, 40]
  - { name: b, position_mm: [30, -30, 40] }
  - { name: c, position_mm: [30, 30, 40] }
""",
    "population.yaml": """title: <population>
about: <about>
based_on: adults.yaml
""",
    "e.yaml": """title: <title>
scene: scene.yaml
rig: rig.yaml
hand:
  centre_mm: [0, 0, 150]
study:
  institution: <institution>
  lab: <lab>
  experimenters:
    - <experimenter>
  keywords:
    - <keyword>
task:
  draws:
    - name: cue
      choice:
        - <choice>
        - other
  regions:
    - name: <region>
      position_mm: [0, 0, 150]
      radius_mm: 20
  perturbations:
    - name: <perturbation>
      loads:
        - kind: constant
          force_N: [0, 0, -0.1]
          on: <body>
  sounds:
    - name: <sound>
      tone_Hz: 400
      duration_ms: 10
  states:
    - name: <state>
      message: <message>
      lines:
        - <line>
      sounds:
        - <sound>
      show:
        - <region>
      exits:
        - when: time
          after_s: 0.02
          to: <second state>
    - name: <second state>
      exits:
        - when: time
          after_s: 0.02
          outcome: <outcome>
          feedback: <feedback>
  feedback_s: 0.01
  conditions:
    - name: <condition>
  blocks:
    - name: <block>
      perturb: <perturbation>
      repeats: 1
      pages:
        - for_s: 0.01
          text: <page>
""",
}
#: A placeholder for the text of a field.
PLAIN = re.compile("<([a-z ]+)>")


class Fields(unittest.TestCase):
    """Random texts in each field that a session's files are made of: each comes out as it was, or none is written."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.out = self.folder / "out"
        shutil.copy("populations/adults.yaml", self.folder)

    def write(self, texts):
        """Writes the files with these texts; returns the fields of each line."""
        fields = {}
        for name, form in FILES.items():
            for number, line in enumerate(form.splitlines(), 1):
                fields[name, number] = PLAIN.findall(line)
            text = PLAIN.sub(lambda field: json.dumps(texts[field[1]], ensure_ascii=False), form)
            # JSON leaves these characters as they are, but YAML does not accept them within a line
            (self.folder / name).write_text(text.replace("\u2028", "\\u2028").replace("\u2029", "\\u2029").replace("\x7f", "\\x7f"))
        return fields

    def run_it(self, texts):
        result = run("run", str(self.folder / "e.yaml"), "--simulate", "--population", str(self.folder / "population.yaml"),
                     "--participant=" + texts["participant"], "--age=" + texts["age"], "--out", str(self.out))
        return result.returncode, result.stderr.decode(errors="replace")

    def refused_fields(self, told, fields):
        """The fields that errors are about, by file and line or by the option's name."""
        out = set()
        for name, line in re.findall(r"/([a-z]+\.yaml):(\d+): error: ", told):
            # for a field in a list, the error may be at the line of its key, just before
            out.update(fields[name, int(line)] or fields.get((name, int(line) + 1), ()))
        for option in ("participant", "age"):
            if re.search(rf"^({option}: error: |command line, word \d+: error: --{option}=)", told, re.MULTILINE):
                out.add(option)
        return out

    def test_come_out_as_they_were_or_are_refused(self):
        chosen = random.Random(int(os.environ.get("DIHAPTIC_SEED", 3)))
        names = sorted({field for form in FILES.values() for field in PLAIN.findall(form)} | {"participant", "age"})
        tried, refused, sessions = 0, 0, 0
        while tried < soak.of(150, 20_000):
            texts = {name: any_text(chosen, n) for n, name in enumerate(names)}
            for option in ("participant", "age"):
                texts[option] = texts[option].replace("\0", "\x01")  # a command line cannot contain NUL
            tried += len(texts)
            while True:
                fields = self.write(texts)
                code, told = self.run_it(texts)
                if code != 2:
                    break
                self.assertFalse(self.out.exists(), told)
                wrong = self.refused_fields(told, fields)
                wrong = {field for field in wrong if texts[field] != field.replace(" ", "_")}
                self.assertTrue(wrong, f"{told}\n{texts}")
                refused += len(wrong)
                texts.update({field: field.replace(" ", "_") for field in wrong})
            self.assertEqual(code, 0, f"{told}\n{texts}")
            self.assert_is_there(texts)
            sessions += 1
        print(f"{tried} texts in {len(names)} fields and {sessions} sessions, {refused} refused")

    def assert_is_there(self, texts):
        (session,) = self.out.iterdir()
        yaml = {name: set(scalars(dihaptic_package._native.read_yaml(str(session / name)))) for name in
                ("session.yaml", "scene.yaml", "rig.yaml", "task.yaml", "person.yaml")}
        with open(session / "trials.csv", newline="", encoding="utf-8") as file:
            cells = set(itertools.chain(*csv.reader(file)))
        where = {"scene.yaml": ["scene title", "body", "floor", "group", "joint", "finger", "camera"],
                 "rig.yaml": ["rig title", "finger", "serial", "point"],
                 "session.yaml": ["title", "institution", "lab", "experimenter", "keyword", "participant", "age", "body", "finger"],
                 "task.yaml": ["choice", "region", "perturbation", "sound", "state", "message", "line", "second state", "outcome",
                               "feedback", "condition", "block", "page"]}
        for name, fields in where.items():
            for field in fields:
                text = "sim-" + texts[field] if field == "participant" and not texts[field].startswith("sim-") else texts[field]
                self.assertIn(text, yaml[name], f"{field} in {name}")
        for field in ("outcome", "condition", "block"):
            self.assertIn(texts[field], cells, field)
        commands = ("report", "replay", "recover") if random.random() < 0.1 else ()
        for command in commands:
            result = dihaptic(command, str(session))
            self.assertEqual(result.returncode, 0, f"{command}: {result.stderr}\n{texts}")
        shutil.rmtree(self.out)


class Python(unittest.TestCase):
    def test_what_an_object_saves_it_loads_or_the_file_stays(self):
        chosen = random.Random(4)
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "scene.yaml")
            refused = 0
            for n in range(soak.of(100, 2_000)):
                text = any_text(chosen, n)
                before = file.read_bytes() if file.exists() else None
                scene = dihaptic_package.Scene(title=text, bodies=[{"name": text, "shape": "plane", "fixed": True}])
                try:
                    scene.save(file)
                except dihaptic_package.Error:
                    refused += 1
                    self.assertEqual(file.read_bytes() if file.exists() else None, before)
                else:
                    read = dihaptic_package.Scene.load(file)
                    for word in (read.title, read.bodies[0].name):  # a file does not tell 007 from "007"
                        self.assertTrue(word == text or float(text) == word, (word, text))
            self.assertGreater(refused, 0)


def scalars(value):
    """All texts and numbers in what was read of a YAML file."""
    if isinstance(value, dict):
        for item in value.values():
            yield from scalars(item)
    elif isinstance(value, list):
        for item in value:
            yield from scalars(item)
    else:
        yield str(value)


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
            self.assertIn("session.yaml.before is the old file", mended.stderr + mended.stdout)
            self.assertEqual((session / "session.yaml.before").read_bytes(), info.replace(b"id: sim-S1", b'id: "sim-S\\e1"').replace(b"first-trials", b"f\xfcrst"))
            self.assertIn("id: sim-S\ufffd1", (session / "session.yaml").read_text().replace('"', ""))
            self.assertEqual(dihaptic("report", str(session)).returncode, 0)


if __name__ == "__main__":
    unittest.main()
