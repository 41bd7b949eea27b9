"""The packages of the last commit: two builds, bare Debian systems that install them, a container, and a machine that boots them.

Usage: packages_test.py [TEST ...], from the project's folder; half an hour each.
"""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

SPACE = 12e9  # disk space for making a live system [bytes]


def shell(*words):
    return subprocess.run(words, check=True)


def built():
    if not list(pathlib.Path("build/package").glob("*.deb")):
        shell("./dev", "package")


class Packages(unittest.TestCase):
    def test_of_two_builds_are_the_same_to_the_byte(self):
        sums = []
        for _ in range(2):
            shell("./dev", "package")
            sums.append(pathlib.Path("build/package/SHA256SUMS").read_text())
        self.assertEqual(sums[0], sums[1])

    @unittest.skipUnless(os.geteuid() == 0 and shutil.which("debootstrap"),
                         "wants root, and debootstrap: sudo apt install debootstrap")
    def test_on_a_bare_debian_run_and_leave_nothing_behind(self):
        built()
        shell("packaging/chroot-test")

    @unittest.skipUnless(os.geteuid() == 0 and shutil.which("debootstrap"),
                         "wants root, and debootstrap: sudo apt install debootstrap")
    def test_the_wheel_reads_in_debians_with_other_pythons(self):
        built()
        with tempfile.TemporaryDirectory() as folder:
            shell("build/release/dihaptic", "run", "experiments/first-trials.yaml", "--simulate", "--participant", "sim-001",
                  "--out", folder)
            shell("packaging/reader/chroot-test", next(pathlib.Path(folder).iterdir()))

    @unittest.skipUnless(os.geteuid() == 0, "wants root")
    def test_of_an_oci_image_run_in_a_container(self):
        built()
        shell("./dev", "oci")
        shell("packaging/oci/try")

    @unittest.skipUnless(os.geteuid() == 0 and shutil.which("lb") and shutil.which("qemu-system-x86_64"),
                         "wants root, live-build and qemu: sudo apt install live-build qemu-system-x86")
    @unittest.skipUnless(shutil.disk_usage(".").free > SPACE, "wants 12 GB of the disk")
    def test_of_a_live_system_run_in_a_machine_that_boots_it(self):
        built()
        shell("./dev", "image")
        shell("packaging/image/boot-test")


if __name__ == "__main__":
    unittest.main(verbosity=2)
