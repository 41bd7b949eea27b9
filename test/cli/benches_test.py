"""`dihaptic-bench`: what it prints, and what it measures beside.

Usage: benches_test.py PROGRAM, from the project's folder.
"""
import json
import os
import pathlib
import tempfile
import unittest

from program import PROGRAM, dihaptic


def bench(*arguments, **options):
    return dihaptic(*arguments, program=PROGRAM + "-bench", **options)


class Commands(unittest.TestCase):
    def test_bench_json_is_one_object_and_nothing_else(self):
        result = bench("scale", "--extra", "0", "--json")
        figures = json.loads(result.stdout)
        self.assertEqual(set(figures["tick"][0]), {"extra", "awake", "asleep", "bullet_us", "most_us", "within_bar"})
        self.assertEqual(set(figures["tick"][0]["awake"]), {"median_us", "p99_us", "max_us"})

    def test_bench_task_has_twenty_states_and_ten_loads(self):
        figures = json.loads(bench("task", "--pairs", "1", "--json").stdout)
        self.assertEqual((figures["states"], figures["loads"]), (20, 10))
        self.assertEqual(set(figures), {"states", "loads", "plain", "task", "more_us", "expressions_us", "within_bars"})
        self.assertGreater(figures["expressions_us"], 0)

    def test_every_bench_has_help_with_an_example(self):
        for command in [[], ["friction"], ["scale"], ["heap"], ["contact"], ["solvers"], ["jitter"], ["task"], ["view"]]:
            result = bench(*command, "--help")
            self.assertEqual(result.returncode, 0, command)
            self.assertIn("Example", result.stdout, command)
            self.assertIn("dihaptic-bench", result.stdout, command)

    def test_a_bench_that_moved_says_where_it_is(self):
        for arguments in [["scale"], ["scale", "--help"], ["contact", "file.hdf5", "--json"], ["jitter", "--time", "1"]]:
            result = dihaptic("bench", *arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertIn(f"Use dihaptic-bench {arguments[0]}.", result.stderr, arguments)
        self.assertNotIn("jitter", dihaptic("bench", "--help").stdout)

    def test_bench_jitter_measures_the_servo_beside_cyclictest(self):
        with tempfile.TemporaryDirectory() as folder:
            def jitter(cyclictest, *options):
                path = pathlib.Path(folder) / "cyclictest"
                path.unlink(missing_ok=True)
                if cyclictest:
                    path.write_text("#!/bin/sh\n" + cyclictest)
                    path.chmod(0o755)
                return bench("jitter", "--time", "1", *options, env={**os.environ, "PATH": folder})

            # a stand-in: 1000 wake-ups, one of them beyond its histogram
            thread = {"histogram": {"20": 980, "500": 19}, "cycles": 1000, "max": 2000000}
            script = f"""echo "$@" > {folder}/asked
                for option; do case $option in --json=*) file=${{option#--json=}};; esac; done
                echo '{json.dumps({"thread": {"0": thread}})}' > $file"""
            result = jitter(script, "--rate", "4000", "--extra", "2", "--json")
            self.assertEqual(result.returncode, 0, result.stderr)
            figures = json.loads(result.stdout)
            self.assertEqual(figures["cyclictest_us"], {"median": 20, "p99": 500, "p999": 500, "max": 2000000})
            late = sum(count for us, count in [(20, 980), (500, 19), (2000000, 1)] if us > figures["slack_us"])
            self.assertEqual(figures["cyclictest_late"], late)
            asked = (pathlib.Path(folder) / "asked").read_text().split()
            self.assertIn("--interval=250", asked)
            self.assertIn("--loops=4000", asked)
            self.assertEqual("--priority=80" in asked, "priority" not in (figures["refused"] or ""))
            self.assertEqual(set(figures["lateness_us"]), {"median", "p99", "p999", "max"})
            self.assertEqual(set(figures["tick_us"]), {"median", "p99", "p999", "max"})
            self.assertTrue(figures["held"])
            self.assertGreater(figures["ticks"], 0)
            self.assertLessEqual(figures["ticks"], 4000)
            self.assertEqual(figures["seconds"], 1)

            table = jitter(None).stdout
            self.assertIn("cyclictest is not installed (Debian package rt-tests)", table)
            self.assertRegex(table, r"overruns? in \d+ ticks")
            self.assertIsNone(json.loads(jitter("exit 1", "--json").stdout)["cyclictest_us"])
            self.assertIn("no peer: cyclictest failed", jitter("exit 1").stdout)
        for wrong in ["0", "nan", "1e9"]:
            result = bench("jitter", "--time", wrong)
            self.assertEqual(result.returncode, 2, wrong)
            self.assertIn(f"--time: must be a number from 1 to 3600, is '{wrong}'", result.stderr)

    def test_bench_contact_measures_what_it_can_and_names_the_rest(self):
        problems = "../shared/data/contact-problems"
        if not os.path.exists(problems):
            self.skipTest(problems + " is absent")
        with tempfile.TemporaryDirectory() as folder:
            bad = folder + "/bad.hdf5"
            pathlib.Path(bad).write_text("no")
            result = bench("contact", bad, problems + "/Rover1039.hdf5", "--json", "--solver", "stewart_trinkle",
                              "--directions", "16", "--direction-frame", "fixed")
        self.assertEqual(result.returncode, 2)
        self.assertIn("bad.hdf5: error: is not an HDF5 file", result.stderr)
        (row,) = json.loads(result.stdout)["problems"]
        self.assertEqual(set(row), {"file", "contacts", "solver", "residual", "us", "iterations", "fallback", "lcp_residual", "route"})
        self.assertEqual((row["contacts"], row["solver"], row["fallback"]), (4, "stewart_trinkle", False))
        self.assertLess(row["lcp_residual"], 1e-8)
        for wrong in [["--solver", "magic"], ["--directions", "3"], ["--direction-frame", "round"]]:
            result = bench("contact", problems, *wrong)
            self.assertEqual(result.returncode, 2, wrong)
            self.assertIn(wrong[0], result.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
