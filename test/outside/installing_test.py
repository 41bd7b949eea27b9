"""Building and installing where others do: a clone of Windows, an Anaconda, root's umask, an archive, a path with blanks.

docs/outside.md has the sources. Usage: outside/installing_test.py PROGRAM, from the project's folder.
"""
import os
import pathlib
import re
import shutil
import stat
import subprocess
import sys
import tempfile
import unittest

sys.path.append("test")
import needs
import soak

BUILD = pathlib.Path(sys.argv.pop(1)).resolve().parent
SOURCE = pathlib.Path.cwd()
#: Test inputs whose line ends must stay as they are.
OWN_LINE_ENDS = re.compile(r"src/[^/]+/fuzz/[^/]+_corpus/")


def run(*words, **options):
    return subprocess.run(words, check=True, capture_output=True, text=True, **options).stdout


def is_clone():
    return subprocess.run(["git", "rev-parse", "--is-inside-work-tree"], capture_output=True).returncode == 0


class Installing(unittest.TestCase):
    def setUp(self):
        self.here = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def test_a_clone_by_git_for_windows_has_the_line_ends_of_linux(self):
        if not is_clone():
            needs.skip("a folder that is not a clone cannot be cloned")
        # the defaults of Git for Windows
        run("git", "-c", "core.autocrlf=true", "-c", "core.eol=crlf", "clone", "--quiet", SOURCE, self.here / "clone")
        names = run("git", "ls-files", "-z", cwd=self.here / "clone").split("\0")[:-1]
        self.assertGreater(len(names), 1000)
        foreign = []
        for name in names:
            data = (self.here / "clone" / name).read_bytes()
            if b"\r\n" in data and b"\0" not in data and not OWN_LINE_ENDS.match(name):
                foreign.append(name)
        self.assertEqual(foreign, [])
        self.assertIn("./dev demo", run(self.here / "clone/dev", "help"))

    def test_an_archive_in_a_folder_with_blanks_takes_its_libraries_from_debian_whatever_the_path_says(self):
        if not is_clone():
            needs.skip("a folder that is not a clone cannot be archived")
        source = self.here / "Renée Müller (2)"
        source.mkdir()
        archive = subprocess.run(["git", "archive", "HEAD"], check=True, capture_output=True).stdout
        subprocess.run(["tar", "x", "-C", source], input=archive, check=True)
        # an Anaconda with its own libraries, and with a pkg-config that finds only these
        conda = self.here / "conda"
        for name in ("fmt", "yaml-cpp"):
            config = conda / f"lib/cmake/{name}/{name}-config.cmake"
            config.parent.mkdir(parents=True)
            config.write_text(f'message(FATAL_ERROR "the {name} of Anaconda")\n')
        (conda / "bin").mkdir()
        for name in ("pkg-config", "h5cc", "qmake6", "python3"):
            (conda / "bin" / name).write_text("#!/bin/sh\nexit 1\n")
            (conda / "bin" / name).chmod(0o755)
        with_conda = {"cwd": source, "env": dict(os.environ, PATH=f"{conda}/bin:{os.environ['PATH']}")}
        done = subprocess.run(["cmake", "--preset", "release", "-DDIHAPTIC_PARTS="], capture_output=True, text=True, **with_conda)
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)
        self.assertNotIn(str(conda), (source / "build/release/CMakeCache.txt").read_text())
        if soak.EVERYTHING:
            run("cmake", "--build", "--preset", "release", "--target", "dihaptic_base", **with_conda)
        skipped = subprocess.run([source / "test/format_test.sh"], cwd=source, capture_output=True, text=True)
        self.assertEqual(skipped.returncode, 77, skipped.stdout + skipped.stderr)

    def of_dev(self, command, path=""):
        """What a function of ./dev prints."""
        return subprocess.run(["bash", "-c", f"source ./dev help >/dev/null; {command}"], capture_output=True, text=True,
                              env=dict(os.environ, PATH=f"{path}:{os.environ['PATH']}"))

    def test_a_package_that_another_one_provides_is_installed(self):
        self.assertEqual(self.of_dev("is_installed awk").returncode, 0)  # mawk, gawk and busybox provide it
        self.assertEqual(self.of_dev("is_installed dpkg").returncode, 0)
        for name in ("no-such-package", "aw", "wk", "libfm", "a.k"):
            self.assertEqual(self.of_dev(f"is_installed {name}").returncode, 1, name)

    def test_a_part_that_is_not_built_is_named_with_the_package_that_it_lacks(self):
        dpkg = self.here / "dpkg-query"
        dpkg.write_text("#!/bin/sh\ncase $* in *qt6-svg-dev*) exit 1;; *Provides*) exit 0;; *) echo install ok installed;; esac\n")
        dpkg.chmod(0o755)
        parts = self.of_dev("parts", self.here)
        self.assertEqual(parts.stdout, "meshes;python;benches;tests;")
        self.assertEqual(parts.stderr, "not built: window, because qt6-svg-dev is not installed\n")
        # the demo does not need the window, so it does not mention it
        self.assertEqual(self.of_dev("targets=dihaptic parts", self.here).stderr, "")

    def test_a_part_that_does_not_exist_is_refused(self):
        done = subprocess.run(["cmake", "-S", SOURCE, "-B", self.here, "-DDIHAPTIC_PARTS=tests;windwo"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn("'windwo' is not a part", " ".join(done.stderr.split()))

    def test_a_sanitizer_that_does_not_exist_is_refused(self):
        done = subprocess.run(["cmake", "-S", SOURCE, "-B", self.here, "-DDIHAPTIC_SANITIZE=adress"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn("'adress' is not a list such as address,undefined", " ".join(done.stderr.split()))

    def test_what_other_software_puts_into_the_environment_is_left_out_and_named(self):
        env = dict(os.environ, CMAKE_PREFIX_PATH="/opt/ros/humble", CXXFLAGS="-I/opt/conda/include", CPATH="")
        done = subprocess.run(["bash", "-c", "source ./dev help >/dev/null; echo ${CMAKE_PREFIX_PATH-none} ${CXXFLAGS-none}"],
                              capture_output=True, text=True, env=env)
        self.assertEqual(done.stdout, "none none\n")
        self.assertEqual(len(done.stderr.splitlines()), 2, done.stderr)
        self.assertIn("without CMAKE_PREFIX_PATH=/opt/ros/humble, which the environment has", done.stderr)

    def test_a_preset_is_one_with_which_one_can_build(self):
        presets = self.of_dev("presets").stdout.split()
        self.assertEqual(presets[0], "release")
        for name in presets:
            self.assertEqual(self.of_dev(f"check_preset {name}").returncode, 0, name)
        for name in ("base", "clang", "soak", "release-fast", "relaese", "", "."):
            done = self.of_dev(f"check_preset '{name}'")
            self.assertEqual(done.returncode, 2, name)
            self.assertIn(f"there is no preset '{name}', but: release peers dev", done.stderr)

    def on_path(self, **programs):
        """A folder with these programs, each a line of shell, and with what ./dev needs itself."""
        folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        for name in ("awk", "bash", "cat", "dirname", "grep", "nproc", "paste", "sed"):
            (folder / name).symlink_to(shutil.which(name))
        for name, line in programs.items():
            program = folder / name.replace("_", "-")
            program.write_text(f"#!/bin/sh\n{line}\n")
            program.chmod(0o755)
        return folder

    def install(self, **programs):
        return subprocess.run(["bash", "-c", "source ./dev help >/dev/null; install_packages libfoo-dev"], capture_output=True,
                              text=True, env=dict(os.environ, PATH=str(self.on_path(**programs))))

    def test_packages_that_cannot_be_installed_are_named_with_a_remedy(self):
        other = self.install()
        self.assertEqual(other.returncode, 1)
        self.assertIn("this is not a Debian", other.stderr)
        by_hand = "apt-get install --no-install-recommends libfoo-dev"
        for programs, why in ((dict(dpkg_query="exit 1"), "there is no "),
                              (dict(dpkg_query="exit 1", sudo="exec \"$@\"", apt_get="exit 100"), "could not be installed")):
            done = self.install(**programs)
            self.assertEqual(done.returncode, 1, programs)
            self.assertIn(why, done.stderr)
            self.assertIn(by_hand, done.stderr)
        self.assertEqual(self.install(dpkg_query="echo install ok installed").stderr, "")

    @unittest.skipIf(os.geteuid(), "root alone can be somebody else")
    def test_who_has_no_sudo_is_told_so(self):
        here = self.here / "dev"
        shutil.copy("dev", here)
        self.here.chmod(0o755)
        tools = self.on_path(dpkg_query="exit 1", apt_get="exit 0")
        tools.chmod(0o755)
        done = subprocess.run([shutil.which("bash"), "-c", "source ./dev help >/dev/null; install_packages libfoo-dev"], cwd=self.here,
                              capture_output=True, text=True, env=dict(os.environ, PATH=str(tools)), user=65534, group=65534)
        self.assertEqual(done.returncode, 1)
        self.assertIn("there is no sudo. Let the computer's administrator type\n    apt-get install", done.stderr)

    def test_tests_of_a_part_that_was_not_built_are_skipped_and_say_so(self):
        for parts, code in (("meshes;tests", 77), ("window;tests", 0)):
            (self.here / "CMakeCache.txt").write_text(f"DIHAPTIC_PARTS:STRING={parts}\n")
            done = subprocess.run([sys.executable, "-c", "import needs, sys; needs.part('window', sys.argv[1])", self.here / "dihaptic"],
                                  cwd="test", capture_output=True, text=True)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertEqual(done.stdout != "", code == 77)

    def test_a_umask_that_closes_the_installed_folders_to_others_is_told(self):
        def installed(mask):
            folder = self.here / f"usr-{mask:o}"
            done = subprocess.run(["cmake", "--install", BUILD, "--prefix", folder], check=True, capture_output=True, text=True,
                                  preexec_fn=lambda: os.umask(mask))
            closed = [p for p in folder.rglob("*") if (stat.S_IMODE(p.stat().st_mode) & (0o055 if p.is_dir() else 0o044)) not in (0o055, 0o044)]
            return done.stderr, closed

        for mask in (0o022, 0o002):
            self.assertEqual(installed(mask), ("", []))
        for mask in (0o077, 0o027):
            said, closed = installed(mask)
            self.assertRegex(" ".join(said.split()), f"The umask is 00{mask:o}: nobody else .* after `umask 022`")
            self.assertTrue(closed and all(path.is_dir() for path in closed), closed)


if __name__ == "__main__":
    unittest.main(verbosity=1)
