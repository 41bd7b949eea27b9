"""YAML 1.2 that this program writes means the same to readers of YAML 1.1 (PyYAML, R's yaml). docs/outside.md has the sources.

Usage: outside/yaml_test.py PROGRAM, from the project's folder.
"""
import datetime
import math
import os
import pathlib
import random
import struct
import sys
import tempfile
import unittest

import yaml

sys.path.append("test/cli")
from program import PROGRAM, dihaptic, session_of

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(PROGRAM)), "python"))
from dihaptic import _native  # noqa: E402

WORDS = ("yes Yes YES no on Off true FALSE y Y n N null Null ~ NULL = << - ? : | > & * ! % @ ` 010 0o17 0x1F 0b1 1_000 1e2 1e-5 "
         "1.0e+5 .5 5. -.5 +7 -0 0 7 1:30 12:30:45 1:30.5 190:20:30 2026-11-27 2026-11-27T10:00:00Z .inf -.INF .nan NaN inf nan NA "
         ".na 12e03 00 08 0. 1,5 {} [] [a {a a: :a a# #a 'a \"a a' \\ --- ... %YAML").split() + [
             "", " ", " a", "a ", "a: b", "a #b", "- a", "a\nb", "a\n", "\na", "\ta", "a\tb", "2001-12-14 21:59:43.10 -5",
             "a\u2028b", "a\u2029b", "\u00a0", "🙂", "ä:", "日本", "a" * 3000, "yes: 1", "[010, 020]"]
#: The loader of libyaml, which R's yaml also uses; where it is missing, Python's own.
FAST = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
SIGNS = " \t\n\"'\\:,#-?|>&*!%@`[]{}~=<.0123456789eEnNyYxo_+$;aäЖ日🙂\u2028"


class Yaml(unittest.TestCase):
    def assert_alike(self, ours, theirs, where):
        """`ours`: texts alone, as this program reads them before it knows what a key is."""
        if isinstance(ours, dict):
            self.assertIsInstance(theirs, dict, where)
            self.assertEqual(list(ours), list(theirs), where)
            for key in ours:
                self.assert_alike(ours[key], theirs[key], f"{where}.{key}")
        elif isinstance(ours, list):
            self.assertEqual(len(ours), len(theirs), where)
            for i, (a, b) in enumerate(zip(ours, theirs)):
                self.assert_alike(a, b, f"{where}[{i}]")
        elif isinstance(theirs, bool):
            self.assertEqual(ours.lower() in ("yes", "true", "on"), theirs, where)
        elif isinstance(theirs, (int, float)):
            self.assertEqual(float(ours), theirs, where)
            self.assertRegex(ours, r"^-?(0|[1-9]\d*)(\.\d+)?(e[-+]\d+)?$", where)
        else:
            self.assertEqual(ours, theirs, where)

    def test_texts_are_the_same(self):
        chance = random.Random(20261127)
        texts = WORDS + ["".join(chance.choices(SIGNS, k=chance.randrange(1, 12))) for _ in range(3000)]
        texts += ["".join(chance.choices("0123456789:._-+exo", k=chance.randrange(1, 9))) for _ in range(2000)]
        for nested in (lambda text: [text], lambda text: {"key": text}, lambda text: {text: 0}, lambda text: {text: [text, text]}):
            for text in WORDS:
                with self.subTest(text):
                    self.assertEqual(yaml.safe_load(_native.write_yaml(nested(text))), nested(text))
            for i in range(0, len(texts), 200):
                value = [nested(text) for text in texts[i:i + 200]]
                self.assertEqual(yaml.load(_native.write_yaml(value), FAST), value)

    def test_numbers_and_truths_are_the_same(self):
        chance = random.Random(20261127)
        numbers = [0.0, 1e-5, 1e5, 1e22, 5e-324, 1.7976931348623157e308, 0.1, -2.5]
        numbers += [x for x in (struct.unpack("<d", chance.randbytes(8))[0] for _ in range(5000)) if math.isfinite(x)]
        values = [*numbers, 0, -7, 10**15, True, False]
        read = yaml.load(_native.write_yaml(values), FAST)
        self.assertEqual(read, values)
        for one, value in zip(read, values):
            self.assertEqual(isinstance(one, bool), isinstance(value, bool))
            self.assertIsInstance(one, (int, float))

    def run_experiment(self, folder, title="Levels", factor="light", levels="[on, off]", more=()):
        """The folder of a session with these words."""
        file = pathlib.Path(folder, "levels.yaml")
        file.write_text(f"""title: {title}
scene: {os.getcwd()}/scenes/block-on-table.yaml
task:
  cross: [{{ factor: {factor}, levels: {levels} }}]
  states:
    - name: wait
      exits: [{{ when: time, after_s: 0.05, outcome: "yes" }}]
  blocks: [{{ name: "no", kind: baseline, repeats: 1 }}]
""")
        result = dihaptic("run", str(file), "--out", folder + "/out", *more)
        self.assertEqual(result.returncode, 0, result.stderr)
        return pathlib.Path(session_of(folder + "/out"))

    def test_files_of_a_session_are_the_same(self):
        for participant in ("010", "yes", "null", "0x1F", "1_000", "1e2", "2026-11-27", "7", "y", "0o17"):
            for more in ((), ("--simulate",)):
                with self.subTest(participant, more=more), tempfile.TemporaryDirectory() as folder:
                    session = self.run_experiment(folder, "2026-11-27", more=("--participant", participant, *more))
                    files = sorted(session.glob("*.yaml"))
                    self.assertGreater(len(files), 3)
                    for path in files:
                        self.assert_alike(_native.read_yaml(str(path)), yaml.safe_load(path.read_text()), path.name)
                    info = yaml.safe_load((session / "session.yaml").read_text())
                    self.assertEqual(info["participant"]["id"], "sim-" * bool(more) + participant)
                    self.assertEqual(info["title"], "2026-11-27")
                    self.assertIsInstance(info["seed"], int)

    def test_levels_and_names_of_a_task_are_the_same(self):
        for name, listed, wanted in (("light", "[on, off]", ["on", "off"]), ("answer", "[yes, no]", ["yes", "no"]),
                                     ("code", "[010, 020]", ["010", "020"]), ("clock", "['1:30', '2:30']", ["1:30", "2:30"]),
                                     ("mass_g", "[100, 200.5]", [100, 200.5])):
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                session = self.run_experiment(folder, factor=name, levels=listed)
                task = yaml.safe_load((session / "task.yaml").read_text())
                self.assertEqual([condition["factors"][name] for condition in task["conditions"]] if "conditions" in task
                                 else task["cross"][0]["levels"], wanted)
                self.assertEqual(task["blocks"][0]["name"], "no")
                self.assertEqual(task["states"][0]["exits"][0]["outcome"], "yes")

    def test_days_are_texts(self):
        """PyYAML makes a date of 2026-11-27, which nobody asked for."""
        self.assertEqual(yaml.safe_load(_native.write_yaml({"day": "2026-11-27"})), {"day": "2026-11-27"})
        self.assertEqual(yaml.safe_load("day: 2026-11-27"), {"day": datetime.date(2026, 11, 27)})


if __name__ == "__main__":
    unittest.main(verbosity=1)
