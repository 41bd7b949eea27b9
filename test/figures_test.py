"""The table of figures has one home, and what compares it with the program sees what differs."""

import json
import pathlib
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import figures  # noqa: E402


class Figures(unittest.TestCase):
    def test_the_pages_have_the_files_rows(self):
        stated = figures.stated_table((figures.ROOT / "docs/figures.md").read_text())
        self.assertEqual(stated, figures.table(figures.load()))
        readme = " ".join((figures.ROOT / "README.md").read_text().split())
        self.assertEqual(len(figures.sentences(figures.load())), 3)
        for sentence in figures.sentences(figures.load()):
            self.assertIn(sentence, readme)

    def test_every_row_is_checked(self):
        for row in figures.load():
            self.assertTrue(row["checks"], row["what"])

    def test_bounds_are_no_wider_than_the_figure(self):
        """A figure of one number is not stated to more digits than its check proves, but for times."""
        for row in figures.load():
            if row.get("quiet"):
                continue
            for check in row["checks"]:
                self.assertLess(check["most"] - check["least"], 0.1 * max(abs(check["most"]), 1e-2), row["what"])

    def test_sees_what_differs(self):
        output = json.dumps({"hold": [{"k": 1, "slip": 0.5}, {"k": 2, "slip": 3}], "none": None, "yes": True})
        row = {"what": "slip", "checks": [{"value": "hold[].slip", "least": 0, "most": 1}]}
        self.assertEqual(figures.differences(row, output), ["hold[].slip: 3 to 3 where 0 to 1 is stated"])
        row["checks"][0]["value"] = "hold[k=1].slip"
        self.assertEqual(figures.differences(row, output), [])
        row["checks"][0]["value"] = "hold[k=3].slip"
        self.assertEqual(figures.differences(row, output), ["hold[k=3].slip: nothing found"])
        row["checks"][0]["value"] = "none"
        self.assertEqual(len(figures.differences(row, output)), 1)
        row["checks"][0] = {"value": "yes", "least": 1, "most": 1}
        self.assertEqual(figures.differences(row, output), [])
        row["checks"][0] = {"value": "hold[k=2].slip", "over": "hold[k=1].slip", "least": 6, "most": 6}
        self.assertEqual(figures.differences(row, output), [])
        row["checks"][0] = {"pattern": r"(\d+) times", "least": 20, "most": 40}
        self.assertEqual(figures.differences(row, "31 times real time"), [])
        self.assertEqual(len(figures.differences(row, "3 times real time")), 1)

    def test_a_command_that_fails_is_no_success(self):
        result = subprocess.run([sys.executable, figures.__file__, "/bin/false", "--only", "grasp"],
                                capture_output=True, text=True)
        self.assertEqual(result.returncode, 2)
        self.assertIn("bench grasp", result.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
