"""Rehearsals in shards: by Slurm, whose sbatch is a fake here (slurm_test.py has a real one), and by GNU parallel.

Usage: cli/clusters_test.py PROGRAM, from the project's folder.
"""
import glob
import os
import pathlib
import re
import shlex
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

from program import PROGRAM, dihaptic, patient

import needs  # program.py adds its folder to the path
import soak

TABLES = ["trials.csv", "people.csv", "adaptation.csv", "fits.csv"]


def write_experiment(file, repeats):
    """A session of about half a second, with 20 repeats."""
    text = pathlib.Path("experiments/rotation-reversal.yaml").read_text().replace("../", os.getcwd() + "/")
    pathlib.Path(file).write_text(re.sub(r"repeats: (64|160|16|48)\b", f"repeats: {repeats}", text))


def collect(folder, **options):
    return dihaptic("collect", folder, **options)


def tables(folder):
    return [pathlib.Path(folder, name).read_bytes() for name in TABLES]


def times_of(folder):
    return {path: os.path.getmtime(path) for path in glob.glob(glob.escape(folder) + "/*/trials.csv")}


class InShards(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="50%a of ")  # characters that shells and Slurm interpret
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.experiment = self.folder + "/it's short.yaml"
        self.out = self.folder + "/out"
        write_experiment(self.experiment, 2)

    def rehearse(self, *arguments, **options):
        people = [] if "--people" in arguments else ["--people", "12"]
        return dihaptic("rehearse", self.experiment, *people, "--out", self.out, *arguments, **options)

    def unsharded_tables(self, experiment, people):
        whole = self.folder + "/whole"
        self.assertEqual(dihaptic("rehearse", experiment, "--people", str(people), "--out", whole).returncode, 0)
        self.assertEqual(collect(whole).returncode, 0)
        return tables(whole)


class Slurm(InShards):
    def setUp(self):
        super().setUp()
        self.slurm = self.folder + "/fake"
        os.mkdir(self.slurm)
        sbatch = pathlib.Path(self.slurm, "sbatch")
        shutil.copy("test/cli/fake_sbatch.py", sbatch)
        sbatch.chmod(0o755)
        self.environment = dict(os.environ, PATH=self.slurm + ":" + os.environ["PATH"], FAKE_SLURM=self.slurm)

    def by_slurm(self, *arguments, **environment):
        return self.rehearse("--slurm", "8", *arguments, env=dict(self.environment, **environment))

    def tools(self):
        """A folder for PATH in which there is no sbatch."""
        tools = self.folder + "/tools"
        os.mkdir(tools)
        for name in ("sh", "env"):
            os.symlink(shutil.which(name), f"{tools}/{name}")
        return tools

    def submitted(self):
        file = pathlib.Path(self.slurm, "submitted")
        return file.read_text().split() if file.exists() else []

    def test_a_killed_shard_is_named_and_done_again(self):
        write_experiment(self.experiment, 20)
        result = self.by_slurm(FAKE_KILL="3", FAKE_KILL_AT=self.out + "/unfinished-sim-011")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("submitted: job 4711, an array of 8 shards", result.stdout)
        self.assertIn("squeue --job 4711;", result.stdout)
        self.assertIn(f"dihaptic collect '{self.out}'\n", result.stdout)
        self.assertEqual(self.submitted(), ["1-8"])
        said = pathlib.Path(self.out, "slurm/2.log").read_text()
        self.assertIn(f"complete: {self.out}, shard 2/8\nnext, when the other shards are complete: dihaptic collect", said)
        result = collect(self.out)
        self.assertEqual(result.returncode, 1)
        self.assertEqual(re.findall("missing: .*", result.stdout), ["missing: shard 3/8: sim-011 (not ended)"])
        self.assertIn("11 sessions, ", result.stdout)
        (again,) = re.findall("once no other process is working on them: (.*)", result.stdout)
        self.assertEqual(again, f"sbatch --array=3 '{self.out}/slurm.sh'")
        before = times_of(self.out)
        command = again.replace("sbatch", "sbatch --parsable", 1)
        subprocess.run(command, shell=True, env=self.environment, check=True, stdout=subprocess.DEVNULL)
        self.assertEqual(self.submitted(), ["1-8", "3"])
        result = collect(self.out)
        self.assertEqual(result.returncode, 0, result.stdout)
        self.assertNotIn("missing", result.stdout)
        self.assertEqual(tables(self.out), self.unsharded_tables(self.experiment, 12))
        self.assertEqual(before.items() - times_of(self.out).items(), set())
        self.assertEqual([name for name in os.listdir(self.out) if name.startswith("unfinished")], [])

    @soak.alone
    def test_the_same_command_submits_the_missing_shards_only(self):
        self.assertEqual(self.by_slurm().returncode, 0)
        script = pathlib.Path(self.out, "slurm.sh")
        script.write_text(script.read_text().replace("#SBATCH", "#SBATCH --account=lab\n#SBATCH", 1))
        for person in ("002", "005", "010"):
            shutil.rmtree(f"{self.out}/sim-{person}")
        result = self.by_slurm()
        self.assertIn("3 to do, 9 done before", result.stdout)
        self.assertEqual(self.submitted(), ["1-8", "2,5"])
        self.assertIn("--account=lab", script.read_text())
        result = self.by_slurm()
        self.assertEqual(result.returncode, 0)
        self.assertIn("complete: " + self.out, result.stdout)
        self.assertEqual(self.submitted(), ["1-8", "2,5"])
        self.assertEqual(collect(self.out).returncode, 0)
        shutil.rmtree(f"{self.out}/sim-004")
        self.assertEqual(self.rehearse("--slurm", "4", env=self.environment).returncode, 0)
        self.assertIn("/4\"\n", script.read_text())  # the script is for another number of shards
        self.assertEqual(self.submitted()[2:], ["4"])

    @soak.alone
    def test_collect_names_all_while_none_has_ended(self):
        self.assertEqual(self.by_slurm(FAKE_REFUSE="1").returncode, 2)
        result = collect(self.out)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("missing: shard 4/8: sim-004, sim-012\n", result.stdout)
        self.assertIn(f"working on them: sbatch '{self.out}/slurm.sh'\n", result.stdout)
        self.assertIn("nothing to collect", result.stdout)

    def test_what_sbatch_refuses_is_told(self):
        result = self.by_slurm(FAKE_REFUSE="1")
        self.assertEqual(result.returncode, 2)
        self.assertIn("Invalid account", result.stderr)
        self.assertIn("error: is refused by sbatch, whose reason is printed above. Solve this problem, "
                      "then type the command below.\n"
                      f"sbatch '{self.out}/slurm.sh'\n", result.stderr)

    def test_without_sbatch_the_script_is_written_and_parallel_named(self):
        needs.for_this_test("parallel", "parallel")
        result = self.rehearse("--slurm", "3", "--people", "5", env=dict(os.environ, PATH=self.tools()))
        self.assertEqual(result.returncode, 2)
        self.assertIn('--shard "$SLURM_ARRAY_TASK_ID/3"', pathlib.Path(self.out, "slurm.sh").read_text())
        why, sbatch, _, parallel, after = result.stderr.splitlines()[-5:]
        self.assertEqual(why, "not submitted: this machine has no sbatch. On one that has it, type")
        self.assertEqual(sbatch, f"sbatch '{self.out}/slurm.sh'")
        self.assertEqual(after, f"next, when it has ended: dihaptic collect '{self.out}'")
        result = subprocess.run(parallel, shell=True, capture_output=True, text=True, cwd="/")
        self.assertEqual(result.returncode, 0, result.stderr)
        result = collect(self.out)
        self.assertEqual(result.returncode, 0, result.stdout)
        self.assertIn("5 sessions, ", result.stdout)

    def test_nothing_is_submitted_before_all_is_checked(self):
        text = pathlib.Path(self.experiment).read_text()
        pathlib.Path(self.experiment).write_text(text.replace("task:", "tusk:"))
        result = self.by_slurm()
        self.assertEqual(result.returncode, 2)
        self.assertIn("tusk: is not known here", result.stderr)
        self.assertFalse(os.path.exists(self.out))
        self.assertEqual(self.submitted(), [])

    def with_container(self):
        """An apptainer that knows one file, and runs what follows outside of it; `dihaptic` is found in that alone."""
        container = self.folder + "/50%a $(of) it's.sif"
        pathlib.Path(container).touch()
        os.mkdir(self.slurm + "/inside")
        os.symlink(os.path.abspath(PROGRAM), self.slurm + "/inside/dihaptic")
        apptainer = pathlib.Path(self.slurm, "apptainer")
        apptainer.write_text(f"""#!/bin/sh
[ "$1" = exec ] && [ "$2" = {shlex.quote(container)} ] || exit 9
shift 2
echo "$@" >>{shlex.quote(self.slurm)}/contained
PATH={shlex.quote(self.slurm)}/inside:$PATH APPTAINER_CONTAINER={shlex.quote(container)} exec "$@"
""")
        apptainer.chmod(0o755)
        return container

    @soak.alone
    def test_a_container_does_the_shards(self):
        container = self.with_container()
        result = self.by_slurm("--container", os.path.relpath(container))
        self.assertEqual(result.returncode, 0, result.stderr)
        contained = pathlib.Path(self.slurm, "contained").read_text().splitlines()
        self.assertEqual(sorted(line.rpartition(" ")[2] for line in contained), [f"{n}/8" for n in range(1, 9)])
        self.assertTrue(all(line.startswith("dihaptic rehearse /") for line in contained), contained)
        self.assertEqual(collect(self.out).returncode, 0)
        self.assertEqual(tables(self.out), self.unsharded_tables(self.experiment, 12))
        script = pathlib.Path(self.out, "slurm.sh")
        script.write_text(script.read_text().replace("#SBATCH", "#SBATCH --account=lab\n#SBATCH", 1))
        shutil.rmtree(f"{self.out}/sim-004")
        # the folder, and the container that it names, may be a stranger's: the command shown names the user's own program
        self.assertIn(".sif", pathlib.Path(self.out, "rehearsal.yaml").read_text())
        self.assertRegex(collect(self.out).stdout, r"working on them: /\S*/dihaptic rehearse .* --shard 4/8\n")
        unpacked = collect(self.out, env=dict(os.environ, APPTAINER_CONTAINER=self.slurm))
        self.assertNotIn("apptainer", unpacked.stdout)
        inside = collect(self.out, env=dict(os.environ, APPTAINER_CONTAINER=PROGRAM))
        self.assertIn(f"working on them: apptainer exec {PROGRAM} dihaptic rehearse ", inside.stdout)
        inside = collect(self.out, env=dict(os.environ, APPTAINER_CONTAINER=container))
        self.assertIn(f"working on them: sbatch --array=4 '{self.out}/slurm.sh'\n", inside.stdout)
        self.assertEqual(self.by_slurm("--container", container).returncode, 0)
        self.assertEqual(self.submitted(), ["1-8", "4"])
        self.assertIn("--account=lab", script.read_text())
        self.assertEqual(collect(self.out).returncode, 0)
        shutil.rmtree(f"{self.out}/sim-004")
        self.assertEqual(self.by_slurm().returncode, 0)
        self.assertNotIn("apptainer", script.read_text())  # no container was asked for this time

    @soak.alone
    def test_without_sbatch_a_container_is_named_for_parallel(self):
        needs.for_this_test("parallel", "parallel")
        container = self.with_container()
        result = self.rehearse("--slurm", "3", "--people", "5", "--container", container,
                               env=dict(self.environment, PATH=self.tools()))
        self.assertEqual(result.returncode, 2)
        parallel = result.stderr.splitlines()[-1]
        result = subprocess.run(parallel, shell=True, capture_output=True, text=True, cwd="/", env=self.environment)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(len(pathlib.Path(self.slurm, "contained").read_text().splitlines()), 3)
        self.assertEqual(collect(self.out).returncode, 0)

    def test_refuses_what_cannot_be(self):
        for arguments, message in [
                (["--slurm", "0"], "--slurm"),
                (["--slurm", "13"], "requests 13 shards for 12 people. Request at most as many shards as there are people"),
                (["--slurm", "4", "--shard", "1/4"], "cannot be combined with --shard or --jobs. Leave them out"),
                (["--slurm", "4", "--jobs", "2"], "cannot be combined with --shard or --jobs. Leave them out"),
                (["--slurm", "4", "--container", self.folder + "/no.sif"],
                 "no.sif: is not a file. Make one with: apptainer build dihaptic.sif oci-archive:"),
                (["--slurm", "4", "--container", self.folder], "is not a file"),
                (["--slurm", "4", "--container", ""], "--container: error: is not a file"),
                (["--container", self.experiment], "--container: error: is valid only with --slurm. Add --slurm, or put"),
                (["--slurm", "4", "--out", self.folder + '/a "b"'], "Choose a folder without \", \\ and control")]:
            with self.subTest(arguments):
                out = [] if "--out" in arguments else ["--out", self.out]
                result = dihaptic("rehearse", self.experiment, "--people", "12", *out, *arguments, env=self.environment)
                self.assertEqual(result.returncode, 2)
                self.assertIn(message, result.stderr)
                self.assertFalse(os.path.exists(self.out))
        self.assertEqual(self.submitted(), [])


@soak.alone
class Parallel(InShards):
    def setUp(self):
        needs.for_this_test("parallel", "parallel")
        super().setUp()
        # a folder in which the example's paths exist, and in which it may make its folder rehearsals/
        for name in ("experiments", "scenes", "rigs", "movements", "meshes", "populations"):
            os.symlink(os.path.abspath(name), f"{self.folder}/{name}")
        wrapper = pathlib.Path(self.folder, "dihaptic")  # makes its process findable by the shard's name
        wrapper.write_text('#!/bin/sh\nfor last; do :; done\necho $$ >"$0-${last%/*}"\n'
                           f'exec {os.path.abspath(PROGRAM)} "$@"\n')
        wrapper.chmod(0o755)
        (self.example,) = re.findall("^ *(parallel dihaptic .*)$", dihaptic("rehearse", "--help").stdout, re.MULTILINE)
        self.example = self.example.replace("--people 40", "--people 4")
        self.environment = dict(os.environ, PATH=self.folder + ":" + os.environ["PATH"])

    def test_as_the_help_has_it_with_one_killed(self):
        out = self.folder + "/rehearsals/visuomotor-rotation_1"
        process = subprocess.Popen(self.example, shell=True, env=self.environment, cwd=self.folder, text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        deadline = time.monotonic() + patient(60)
        while not os.path.isdir(out + "/unfinished-sim-002") and time.monotonic() < deadline:
            time.sleep(0.001)
        shard = int(pathlib.Path(self.folder, "dihaptic-2").read_text())
        os.kill(shard, signal.SIGSTOP)
        for child in pathlib.Path(f"/proc/{shard}/task/{shard}/children").read_text().split():
            os.kill(int(child), signal.SIGKILL)
        os.kill(shard, signal.SIGKILL)
        said = process.communicate(timeout=patient(300))[0]
        self.assertEqual(process.returncode, 1, said)  # because one session has failed
        result = collect(out)
        self.assertEqual(result.returncode, 1)
        self.assertEqual(re.findall("missing: .*", result.stdout), ["missing: shard 2/4: sim-002 (not ended)"])
        (again,) = re.findall("once no other process is working on them: (.*)", result.stdout)
        self.assertRegex(again, "^/.* rehearse .*--shard 2/4$")
        before = times_of(out)
        subprocess.run(again, shell=True, cwd="/", check=True, capture_output=True)
        result = collect(out)
        self.assertEqual(result.returncode, 0, result.stdout)
        self.assertEqual(tables(out), self.unsharded_tables("experiments/visuomotor-rotation.yaml", 4))
        self.assertEqual(before.items() - times_of(out).items(), set())


class AtOnce(InShards):
    def test_nobody_is_done_by_two_programs(self):
        write_experiment(self.experiment, 20)
        command = [PROGRAM, "rehearse", self.experiment, "--people", "1", "--out", self.out]
        first = subprocess.Popen(command, start_new_session=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        deadline = time.monotonic() + patient(60)
        while not glob.glob(glob.escape(self.out) + "/unfinished-sim-001/*/") and time.monotonic() < deadline:
            time.sleep(0.001)
        os.killpg(first.pid, signal.SIGSTOP)
        try:
            second = self.rehearse("--people", "2")
        finally:
            os.killpg(first.pid, signal.SIGCONT)
        self.assertEqual(second.returncode, 1)
        self.assertIn("sim-001: failed. Another dihaptic is doing this session now", second.stderr)
        self.assertEqual(first.wait(timeout=patient(60)), 0)
        self.assertEqual(sorted(os.listdir(self.out)), ["rehearsal.yaml", "sim-001", "sim-002"])
        self.assertEqual(collect(self.out).returncode, 0)
        self.assertEqual(tables(self.out), self.unsharded_tables(self.experiment, 2))

    @soak.alone
    def test_two_that_share_the_people_say_that_all_are_done(self):
        """The program that ends last finds all people done, whichever program did them."""
        write_experiment(self.experiment, 20)
        command = [PROGRAM, "rehearse", self.experiment, "--people", "4", "--out", self.out]
        both = [subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) for _ in range(2)]
        ended = [(*program.communicate(timeout=patient(120)), program.returncode) for program in both]
        self.assertIn(0, [code for _, _, code in ended], ended)
        for stdout, stderr, code in ended:
            self.assertIn("complete: " if code == 0 else "Another dihaptic is doing this session now", stdout + stderr)
        self.assertEqual(collect(self.out).returncode, 0)


if __name__ == "__main__":
    unittest.main(verbosity=2)
