"""A rehearsal as an array of a real Slurm: its daemons, on this machine alone, with all files in a temporary folder.

Usage: cli/slurm_test.py PROGRAM, from the project's folder.
"""
import glob
import os
import pathlib
import re
import shutil
import socket
import subprocess
import tempfile
import time
import unittest

from clusters_test import collect, tables, times_of, write_experiment
from program import dihaptic, patient

PATH = os.environ["PATH"] + ":/usr/sbin:/sbin"
NEEDED = ["munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel", "sinfo"]
MISSING = [name for name in NEEDED if not shutil.which(name, path=PATH)]
CONFIGURATION = """ClusterName=one
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MailProg=/bin/true
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
NodeName={host} NodeAddr=127.0.0.1 CPUs=8
PartitionName=main Nodes=ALL Default=YES
"""


def free_ports(n):
    sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(n)]
    ports = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return ports


@unittest.skipIf(MISSING, f"no {', '.join(MISSING)}: apt-get install slurm-wlm, or ./dev soak long")
class Slurm(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="slurm ")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        daemons = tempfile.TemporaryDirectory(prefix="slurm-")
        self.addCleanup(daemons.cleanup)
        self.daemons = daemons.name
        os.chmod(self.daemons, 0o711)  # munge requires its socket, but not its key, to be accessible to all
        self.start_slurm()

    def start_slurm(self):
        file = lambda name: f"{self.daemons}/{name}"
        os.mkdir(file("state"))
        os.mkdir(file("spool"))
        key = pathlib.Path(file("munge.key"))
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        host = socket.gethostname().partition(".")[0]
        user = subprocess.run(["id", "-un"], capture_output=True, text=True, check=True).stdout.strip()
        pathlib.Path(file("slurm.conf")).write_text(
            CONFIGURATION.format(host=host, user=user, folder=self.daemons, ports=free_ports(2)))
        self.environment = dict(os.environ, PATH=PATH, SLURM_CONF=file("slurm.conf"))
        self.start("munged", "--foreground", "--key-file", key, "--socket", file("munge.socket"), "--pid-file",
                   file("munged.pid"), "--log-file", file("munged.log"), "--seed-file", file("munge.seed"))
        self.wait_until("munge's socket is there", lambda: os.path.exists(file("munge.socket")))
        self.start("slurmctld", "-D")
        self.start("slurmd", "-D", "-N", host)
        self.wait_until("the node is idle", lambda: "idle" in self.slurm("sinfo", "--noheader", "--format=%T"))
        self.addCleanup(self.wait_for_jobs)
        self.addCleanup(self.slurm, "scancel", "--signal=KILL", "--full", "--name=dihaptic")

    def start(self, name, *arguments):
        log = open(f"{self.daemons}/{name}.out", "w")
        self.addCleanup(log.close)
        process = subprocess.Popen([shutil.which(name, path=PATH), *arguments], env=self.environment,
                                   stdin=subprocess.DEVNULL, stdout=log, stderr=log)
        self.addCleanup(process.wait)
        self.addCleanup(process.terminate)

    def slurm(self, *command):
        return subprocess.run(command, env=self.environment, capture_output=True, text=True).stdout

    def wait_until(self, what, happened, seconds=60):
        deadline = time.monotonic() + patient(seconds)
        while not happened():
            if time.monotonic() > deadline:
                logs = "".join(pathlib.Path(log).read_text()[-3000:] for log in glob.glob(f"{self.daemons}/*.*"))
                self.fail(f"in vain until {what}\n{logs}")
            time.sleep(0.01)

    def wait_for_jobs(self):
        self.wait_until("all jobs have ended", lambda: not self.slurm("squeue", "--noheader"), 300)

    def test_a_killed_shard_is_done_again_and_the_tables_are_those_of_no_shards(self):
        experiment = self.folder + "/short.yaml"
        write_experiment(experiment, 20)
        whole, out = self.folder + "/whole", self.folder + "/100%a out"
        self.assertEqual(dihaptic("rehearse", experiment, "--people", "24", "--out", whole).returncode, 0)
        self.assertEqual(collect(whole).returncode, 0)
        result = dihaptic("rehearse", experiment, "--people", "24", "--out", out, "--slurm", "8", env=self.environment)
        self.assertEqual(result.returncode, 0, result.stderr)
        (job,) = re.findall(r"submitted: job (\d+), an array of 8 shards", result.stdout)
        # sim-003 is complete by then, and sim-019 has not begun
        self.wait_until("the shard is half done", lambda: glob.glob(glob.escape(out) + "/unfinished-sim-011/*/"), 300)
        self.slurm("scancel", "--signal=KILL", "--full", job + "_3")
        self.wait_for_jobs()
        result = collect(out, env=self.environment)
        self.assertEqual(result.returncode, 1)
        self.assertEqual(re.findall("missing: .*", result.stdout), ["missing: shard 3/8: sim-011 (not ended), sim-019"])
        self.assertIn("22 sessions, ", result.stdout)
        (again,) = re.findall("once no other process is working on them: (.*)", result.stdout)
        self.assertEqual(again, f"sbatch --array=3 '{out}/slurm.sh'")
        before = times_of(out)
        subprocess.run(again, shell=True, env=self.environment, check=True, stdout=subprocess.DEVNULL)
        self.wait_for_jobs()
        self.assertIn("2 to do, 1 done before", pathlib.Path(out, "slurm/3.log").read_text())
        self.assertEqual(collect(out).returncode, 0)
        self.assertEqual(tables(out), tables(whole))
        self.assertEqual(before.items() - times_of(out).items(), set())


if __name__ == "__main__":
    unittest.main(verbosity=2)
