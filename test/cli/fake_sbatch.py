#!/usr/bin/python3
"""Stands in for Slurm's sbatch: tasks run a copy of the script, in the submission's folder and environment, all at the
same time, and it ends when they have. The shard FAKE_KILL is killed as soon as FAKE_KILL_AT is there.
"""
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time

spool = tempfile.mkdtemp(dir=os.environ["FAKE_SLURM"])
options = {}
words = sys.argv[1:]
script = words.pop()
if not open(script).readline().startswith("#!"):
    sys.exit("sbatch: error: This does not look like a batch script.")
for line in open(script):
    if line.startswith("#SBATCH "):
        words = shlex.split(line[len("#SBATCH "):], comments=True) + words
for word in words:
    key, _, value = word.partition("=")
    options[key] = value
with open(os.environ["FAKE_SLURM"] + "/submitted", "a") as file:
    file.write(options["--array"] + "\n")
if "--parsable" not in options:
    sys.exit("the fake only knows --parsable")
if os.environ.get("FAKE_REFUSE"):
    sys.exit("sbatch: error: Batch job submission failed: Invalid account")
copy = shutil.copy(script, spool + "/slurm_script")
os.chmod(copy, 0o700)
tasks = []
for part in options["--array"].split(","):
    first, _, last = part.partition("-")
    tasks += range(int(first), int(last or first) + 1)
running = {}
for task in tasks:
    log = re.sub("%([%a])", lambda found: str(task) if found[1] == "a" else "%", options["--output"])
    running[task] = subprocess.Popen([copy], env=dict(os.environ, SLURM_ARRAY_TASK_ID=str(task)), stdout=open(log, "w"),
                                     stderr=subprocess.STDOUT, start_new_session=True)
killed = int(os.environ.get("FAKE_KILL", 0))
if killed in running:
    while not os.path.isdir(os.environ["FAKE_KILL_AT"]) and running[killed].poll() is None:
        time.sleep(0.001)
    os.killpg(running[killed].pid, signal.SIGKILL)
for process in running.values():
    process.wait()
print("4711;cluster")
