"""What an installation has, tried from a folder of its own: programs, files, Python, and another C++ project."""
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

import needs
from patience import patient

BUILD = pathlib.Path(sys.argv.pop(1)).resolve().parent
SOURCE = pathlib.Path.cwd()


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        # as in a person's home folder, every path contains blanks and letters beyond ASCII
        cls.folder = tempfile.TemporaryDirectory(prefix="Renée Müller ")
        cls.prefix = pathlib.Path(cls.folder.name, "usr")
        cls.work = pathlib.Path(cls.folder.name, "work")
        cls.work.mkdir()
        subprocess.run(["cmake", "--install", BUILD, "--prefix", cls.prefix], check=True, stdout=subprocess.DEVNULL)
        cls.environment = dict(os.environ, HOME=cls.folder.name, PATH=f"{cls.prefix}/bin:{os.environ['PATH']}",
                               PYTHONPATH=f"{cls.prefix}/lib/python3/dist-packages")
        cls.environment.pop("XDG_DATA_HOME", None)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def run_here(self, *words, code=0):
        done = subprocess.run(words, cwd=self.work, env=self.environment, capture_output=True, text=True)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout

    def test_the_demo_runs_from_any_folder(self):
        said = self.run_here("dihaptic", "run", "experiments/lift-block.yaml")
        self.assertIn("hold", said)
        session = next(self.work.glob("sessions/*_lift-block*"))
        self.run_here("dihaptic", "picture", str(session), "--time", "5", "-o", "lifted.png")
        self.assertGreater((self.work / "lifted.png").stat().st_size, 10_000)

    def test_what_needs_a_companion_or_a_file_beside_a_file_finds_it(self):
        self.run_here("dihaptic", "check", "scenes/looks.yaml", "scenes/tools.yaml", "experiments/visuomotor-rotation.yaml")

    def test_a_file_of_ones_own_may_name_what_is_shipped_and_comes_first(self):
        own = self.work / "mine.yaml"
        own.write_text("scene: scenes/block-on-table.yaml\nrig: rigs/premium-pair.yaml\n")
        self.run_here("dihaptic", "check", "mine.yaml")
        (self.work / "scenes").mkdir()
        (self.work / "scenes/block-on-table.yaml").write_text("bodies: nonsense\n")
        done = subprocess.run(["dihaptic", "check", "mine.yaml"], cwd=self.work, env=self.environment, capture_output=True,
                              text=True)
        self.assertIn("scenes/block-on-table.yaml:1", done.stderr + done.stdout)
        self.assertEqual(done.returncode, 2)
        (self.work / "scenes/block-on-table.yaml").unlink()
        (self.work / "scenes").rmdir()

    def test_a_copy_of_a_shipped_file_finds_what_it_names(self):
        for name in ("scenes/looks.yaml", "experiments/visuomotor-rotation.yaml", "experiments/reach-at-tone.yaml"):
            copy = self.work / ("copy-of-" + name.replace("/", "-"))
            copy.write_text((SOURCE / name).read_text())
            self.run_here("dihaptic", "check", copy.name)

    def test_a_file_that_is_nowhere_is_an_error_that_names_it_as_given(self):
        done = subprocess.run(["dihaptic", "run", "experiments/none.yaml"], cwd=self.work, env=self.environment,
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("experiments/none.yaml", done.stderr)
        self.assertNotIn(str(self.prefix), done.stderr)

    def test_python_reads_runs_and_finds(self):
        said = self.run_here("/usr/bin/python3", "-c", """
import dihaptic as dh
from dihaptic.program import program
print(program())
print(dh.shipped("scenes/block-on-table.yaml"))
print(len(dh.run("experiments/lift-block.yaml", out="by-python").lifts))
""")
        self.assertEqual(said.splitlines(), [f"{self.prefix}/bin/dihaptic", f"{self.prefix}/share/dihaptic/scenes/block-on-table.yaml",
                                        "1"])

    def test_the_window_finds_the_program_that_draws_its_pictures(self):
        needs.for_this_test("Xvfb", "xvfb")
        read, write = os.pipe()
        display = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-noreset"], pass_fds=[write], stderr=subprocess.DEVNULL)
        self.addCleanup(display.wait)
        self.addCleanup(display.terminate)
        os.close(write)
        with os.fdopen(read) as pipe:
            number = pipe.readline().strip()
        environment = dict(self.environment, DISPLAY=":" + number, XDG_CACHE_HOME=str(self.work / "cache"))
        window = subprocess.Popen(["dihaptic", "gui"], cwd=self.work, env=environment, stderr=subprocess.DEVNULL)
        self.addCleanup(window.wait)
        self.addCleanup(window.kill)
        end = time.monotonic() + patient(60)
        while not list((self.work / "cache").rglob("*.png")):
            self.assertLess(time.monotonic(), end, "the start page has no picture")
            self.assertIsNone(window.poll())
            time.sleep(0.2)

    def test_octave_reads_a_session(self):
        needs.for_this_test("octave", "octave")
        self.run_here("dihaptic", "run", "experiments/lift-block.yaml", "--out", "for-octave")
        session = next((self.work / "for-octave").iterdir())
        said = self.run_here("octave", "--no-gui", "--quiet", "--path", f"{self.prefix}/share/dihaptic/octave", "--eval",
                             f"s = dihaptic_load('{session}', 'grip_force'); disp(s.units.grip_force)")
        self.assertEqual(said.split(), ["N"])

    def test_bash_completes_commands_options_and_files(self):
        for words, some in [(["re"], {"replay", "recover", "report"}), (["run", "--s"], {"--simulate", "--solver", "--seed"}),
                            (["run", "mine"], {"mine-too.yaml"})]:
            (self.work / "mine-too.yaml").touch()
            said = self.run_here("bash", "-ec", f"source {shlex.quote(str(SOURCE))}/packaging/completion/dihaptic; COMP_WORDS=(dihaptic $*); "
                                 "COMP_CWORD=$#; _dihaptic; printf '%s\\n' ${COMPREPLY[@]}", "bash", *words)
            self.assertLessEqual(some, set(said.split()))
            self.assertTrue(all(word.startswith(words[-1]) for word in said.split()))
        (self.work / "mine-too.yaml").unlink()

    def test_files_of_a_new_study_name_the_schemas_that_are_installed(self):
        self.run_here("dihaptic", "new", "study", "mine")
        for name in ("scene", "rig", "experiment"):
            first = (self.work / f"mine/{name}.yaml").read_text().splitlines()[0]
            schema = self.prefix / f"share/dihaptic/schema/{name}.json"
            self.assertEqual(first, f"# yaml-language-server: $schema={schema.as_uri()}")
            self.assertEqual(schema.read_text(), self.run_here("dihaptic", "schema", name))
            self.run_here("dihaptic", "check", f"mine/{name}.yaml")

    def test_another_project_builds_against_the_library_and_lifts_a_block(self):
        source = SOURCE / "packaging/example"
        self.assertLessEqual(len((source / "lift.cpp").read_text().splitlines()), 60)
        self.run_here("cmake", "-S", source, "-B", "built", f"-DCMAKE_PREFIX_PATH={self.prefix}")
        self.run_here("cmake", "--build", "built")
        self.environment["XDG_DATA_HOME"] = f"{self.prefix}/share"  # needed because it is not installed in /usr
        self.assertIn("The block is lifted.", self.run_here("built/lift"))
        self.environment.pop("XDG_DATA_HOME")


def packages():
    """Names of the packages of packages.txt, whatever they are for."""
    lines = (line.split("#")[0].strip() for line in (SOURCE / "packages.txt").read_text().splitlines())
    return [line for line in lines if line and not line.startswith("[")]


class Packages(unittest.TestCase):
    def test_are_built_with_packages_that_every_build_is_made_with(self):
        control = (SOURCE / "packaging/debian/control").read_text()
        needed = set(re.findall(r"^ ([a-z0-9.+-]+)", control.split("Build-Depends:")[1].split("\nStandards")[0], re.M))
        known = set(packages())
        self.assertEqual(needed - known, {"debhelper-compat", "dh-python", "help2man"})

    def test_have_a_licence_each_in_the_table_of_licences(self):
        rows = (SOURCE / "docs/licences.md").read_text().split("|---|---|---|")[1]
        told = re.findall(r"`([a-z0-9.+-]+-?[a-z0-9]*)`", "\n".join(line.split("|")[1] for line in rows.splitlines() if "|" in line))
        used = packages()
        self.assertEqual(sorted(told), sorted(used))

    def test_let_members_of_the_group_use_what_the_doctor_looks_for(self):
        doctor = (SOURCE / "app/cli/doctor/ports.cpp").read_text()
        rules = (SOURCE / "packaging/debian/dihaptic.udev").read_text()
        stream = (SOURCE / "packaging/org.dihaptic.Dihaptic.metainfo.xml").read_text().lower()
        known = re.findall(r'Known\{"[^"]+", "(\w+)", "(\w*)"\}', doctor)
        self.assertEqual(len(known), 2)
        for vendor, product in known:
            self.assertRegex(rules, f'"{vendor}".*{product}.*GROUP="haptics"')
            self.assertIn(f"usb:v{vendor}p{product}", stream)

    def test_are_cited_in_the_version_that_they_have(self):
        version = re.search(r"project\(dihaptic VERSION ([0-9.]+)", (SOURCE / "CMakeLists.txt").read_text())[1]
        self.assertIn(f"\nversion: {version}\n", (SOURCE / "CITATION.cff").read_text())


if __name__ == "__main__":
    unittest.main(verbosity=1)
