"""The program as its user meets it: commands, messages, interruptions, kills, full disks.

Usage: cli_test.py PROGRAM, from the project's folder.
"""
import csv
import fcntl
import glob
import json
import os
import pathlib
import pty
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import termios
import time
import unittest

PROGRAM = sys.argv.pop(1) if len(sys.argv) > 1 else "build/release/dihaptic"
REAL_CLOCK = ["--clock", "real"]
# the makers' fakes pass for real devices: a busy machine that leaves hands without an answer shall not end the session
PATIENT = "max_pause_ms: 1000, hand_damping_Ns_m: 100"


def dihaptic(*arguments, **options):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=300, **options)


def session_of(out):
    """The only session's folder in `out`."""
    (folder,) = glob.glob(out + "/*/")
    return folder


def whole_chunks(log):
    """Chunks of 50 frames that stand complete in a log (src/recording/chunk.h)."""
    data, at, count = pathlib.Path(log).read_bytes(), len("DIHAPTIC LOG 3\n"), 0
    while at + 24 <= len(data):
        kind, size = data[at:at + 4], int.from_bytes(data[at + 4:at + 8], "little")
        at += 24 + size
        count += kind == b"PACK" and at <= len(data)
    return count


def wait_for_log(out, size):
    """Until the only session's raw log in `out` is longer; returns how long it is."""
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline:
        logs = glob.glob(out + "/*/raw.log")
        if logs and os.path.getsize(logs[0]) > size:
            return os.path.getsize(logs[0])
        time.sleep(0.001)
    raise AssertionError("no log of that length in " + out)


class Commands(unittest.TestCase):
    def test_every_command_has_help_with_an_example(self):
        commands = [[], ["run"], ["replay"], ["recover"], ["check"], ["bench"], ["bench", "grasp"], ["bench", "friction"],
                    ["bench", "scale"], ["bench", "contact"], ["bench", "solvers"],
                    ["bench", "jitter"], ["bench", "view"], ["tune"], ["picture"], ["video"], ["gui"],
                    ["report"], ["fit", "two_rate"], ["resume"], ["export"], ["rehearse"], ["collect"], ["workspace"], ["calibrate"], ["devices"]]
        for command in commands:
            result = dihaptic(*command, "--help")
            self.assertEqual(result.returncode, 0, command)
            self.assertIn("Example", result.stdout, command)
            self.assertIn("dihaptic", result.stdout, command)

    def test_fit_two_rate_gives_back_the_rates_that_made_a_table(self):
        truth = {"retention_fast": 0.59, "learning_fast": 0.21, "retention_slow": 0.992, "learning_slow": 0.02}
        trials = [(0, 0)] * 32 + [(30, 0)] * 80 + [(-30, 0)] * 10 + [("", 1)] * 30
        fast = slow = 0
        lines = ["perturbation,clamp,compensation"]
        for i, (perturbation, clamp) in enumerate(trials):
            lines.append(f"{perturbation},{clamp},{'' if i % 7 == 3 else repr(fast + slow)}")
            error = 0 if clamp else perturbation - fast - slow
            fast = truth["retention_fast"] * fast + truth["learning_fast"] * error
            slow = truth["retention_slow"] * slow + truth["learning_slow"] * error
        with tempfile.TemporaryDirectory() as folder:
            file = folder + "/person.csv"
            pathlib.Path(file).write_text("\n".join(lines) + "\n")
            result = dihaptic("fit", "two_rate", file, "--json")
            self.assertEqual(result.returncode, 0, result.stderr)
            fit = json.loads(result.stdout)
            self.assertEqual(sorted(fit), sorted([*truth, "sse", "n"]))
            for name, value in truth.items():
                self.assertAlmostEqual(fit[name], value, places=4)
            self.assertLess(fit["sse"], 1e-8)
            self.assertEqual(fit["n"], len(trials) - len([i for i in range(len(trials)) if i % 7 == 3]))
            self.assertIn("95 %", dihaptic("fit", "two_rate", file).stdout)
            for line, bad, key in [(3, "0,2,1", "clamp"), (3, "much,0,1", "perturbation"), (3, "0,0,x", "compensation"),
                                   (1, "perturbation,compensation", "clamp")]:
                wrong = lines.copy()
                wrong[line - 1] = bad
                pathlib.Path(file).write_text("\n".join(wrong) + "\n")
                result = dihaptic("fit", "two_rate", file, "--json")
                self.assertEqual(result.returncode, 2)
                self.assertIn(f"{file}:{line}: error: {key}: ", result.stderr)

    def test_tune_refuses_a_rig_that_is_not_simulated_and_a_map_that_cannot_be(self):
        with tempfile.TemporaryDirectory() as folder:
            rig = folder + "/rig.yaml"
            pathlib.Path(rig).write_text("devices:\n  - { finger: thumb, backend: replay }\n"
                                         "  - { finger: index, backend: replay }\n")
            result = dihaptic("tune", "scenes/block-on-table.yaml", "--rig", rig)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(rig + ":2: error: backend: devices of the backend 'replay' need a recording. Use", result.stderr)
            pathlib.Path(rig).write_text("devices:\n  - { finger: toe, backend: simulated }\n")
            result = dihaptic("tune", "scenes/block-on-table.yaml", "--rig", rig)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn("no device is held by the scene's finger 'thumb'", result.stderr)
            result = dihaptic("tune", "scenes/block-on-table.yaml", "--map", folder + "/none/map.svg")
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn("map.svg: error: cannot be written. Name another file by --map", result.stderr)

    def test_workspace_measures_and_draws(self):
        with tempfile.TemporaryDirectory() as folder:
            picture = folder + "/workspace.svg"
            result = dihaptic("workspace", "rigs/premium-arms.yaml", "-o", picture)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertRegex(result.stdout, r"shared +\d+\.\d\d litres")
            self.assertIn("largest sphere in it", pathlib.Path(picture).read_text())
            # what it proposes is what a rig file may say, and then says so
            rig = folder + "/rig.yaml"
            proposed = "".join(re.findall(r"^(?:origin_mm|wall): .*\n", result.stdout, re.MULTILINE))
            pathlib.Path(rig).write_text(pathlib.Path("rigs/premium-arms.yaml").read_text() + proposed)
            again = dihaptic("workspace", rig, "-o", picture)
            self.assertEqual(again.returncode, 0, again.stderr)
            self.assertIn("keeps hands where all devices reach", again.stdout)
            self.assertIn(proposed, again.stdout.replace(" }\n\n", " }\n"))
            pathlib.Path(rig).write_text(pathlib.Path("rigs/premium-arms.yaml").read_text()
                                         + "wall: { centre_mm: [0, 0, 70], size_mm: [600, 600, 600] }\n")
            result = dihaptic("workspace", rig, "-o", picture)
            self.assertEqual(result.returncode, 1, result.stderr)
            self.assertRegex(result.stdout, r"not all devices reach: \d\d\.\d % of it")
            result = dihaptic("workspace", "rigs/ideal-pair.yaml", "-o", picture)
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertIn("rigs/ideal-pair.yaml:5: error: options: the thumb's device does not say where its reach ends."
                          " Give it workspace_mm", result.stderr)

    def test_calibrate_finds_what_is_misplaced_and_sessions_use_it(self):
        with tempfile.TemporaryDirectory() as folder:
            rig = folder + "/rig.yaml"
            text = pathlib.Path("rigs/premium-misplaced.yaml").read_text()
            pathlib.Path(rig).write_text(text.replace("jig:", "calibration: mine.yaml\njig:"))
            result = dihaptic("check", rig)
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertIn("rig.yaml:", result.stdout)
            self.assertIn("calibration: mine.yaml cannot be used. Calibrate the rig", result.stdout)
            result = dihaptic("calibrate", rig)
            self.assertEqual(result.returncode, 0, result.stderr)
            agree = re.search(r"agree to ([\d.]+) mm rms", result.stdout)
            self.assertLess(float(agree[1]), 0.1, result.stdout)
            before = re.search(r"before +([\d.]+) mm rms", result.stdout)
            self.assertGreater(float(before[1]), 1, result.stdout)
            self.assertTrue(pathlib.Path(folder + "/mine.svg").exists())
            result = dihaptic("check", rig)
            self.assertEqual(result.returncode, 0, result.stdout)
            # an old one is warned of, and a session keeps the one that it was made with
            mine = pathlib.Path(folder + "/mine.yaml")
            mine.write_text(re.sub(r"date: .*", "date: 2020-01-01", mine.read_text()))
            result = dihaptic("run", "experiments/lift-block.yaml", "--rig", rig, "--out", folder + "/sessions")
            self.assertIn("Calibrate it again: dihaptic calibrate", result.stderr)
            mine.unlink()
            session = session_of(folder + "/sessions")
            self.assertTrue(pathlib.Path(session + "/calibration.yaml").exists())
            result = dihaptic("replay", session)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_calibrate_writes_over_no_input_and_says_at_once_where_it_cannot(self):
        with tempfile.TemporaryDirectory() as folder:
            rig = folder + "/rig.yaml"
            text = pathlib.Path("rigs/premium-misplaced.yaml").read_text()
            pathlib.Path(rig).write_text(text)
            os.mkdir(folder + "/taken.svg")
            for out, message in [(rig, "is the rig file itself"), (folder + "/c.svg", "is a name for the picture"),
                                 (folder + "/none/c.yaml", "cannot be written: No such file or directory"),
                                 (folder + "/taken.yaml", "cannot be written: it is a folder")]:
                began = time.monotonic()
                result = dihaptic("calibrate", rig, "-o", out)
                self.assertEqual(result.returncode, 2, out)
                self.assertIn(message, result.stderr)
                self.assertLess(time.monotonic() - began, 2)
            result = dihaptic("workspace", rig, "-o", rig)
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertEqual(pathlib.Path(rig).read_text(), text)
            self.assertEqual(sorted(os.listdir(folder)), ["rig.yaml", "taken.svg"])
            pathlib.Path(rig).write_text(text[:text.index("jig:")] + "jig: [{name: post, position_mm: [0, 0, 100]}]\n")
            result = dihaptic("calibrate", rig)
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertRegex(result.stderr, r"rig.yaml:\d+: error: jig: its points are on a line")

    def test_a_window_needs_a_screen(self):
        nowhere = {name: value for name, value in os.environ.items()
                   if name not in ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM")}
        result = dihaptic("gui", env=nowhere)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("there is no screen to open a window on", result.stderr)

    def test_version(self):
        self.assertRegex(dihaptic("--version").stdout, r"^dihaptic \d+\.\d+\.\d+\n$")

    def test_wrong_use_fails_and_says_how(self):
        for arguments in [["fly"], ["rnu"], ["run"], ["run", "scenes/block-on-table.yaml", "--clock", "sundial"], []]:
            result = dihaptic(*arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertIn("--help", result.stderr, arguments)

    def test_an_unknown_command_is_named(self):
        self.assertIn("error: 'launch' is no command. There are run, replay", dihaptic("launch").stderr)
        self.assertIn("Did you mean check? See dihaptic --help.", dihaptic("chekc", "x").stderr)

    def test_numbers_of_options_have_ranges(self):
        for rate in ["nan", "0", "-1", "1e9", "fast"]:
            for command in [["run", "scenes/block-on-table.yaml"], ["bench", "grasp"]]:
                result = dihaptic(*command, f"--rate={rate}")
                self.assertEqual(result.returncode, 2, rate)
                self.assertIn(f"--rate: must be a number from 100 to 10000, is '{rate}'", result.stderr)
        for seed in ["-1", "1.5", "99999999999999999999999"]:
            result = dihaptic("run", "scenes/block-on-table.yaml", "--seed", seed)
            self.assertEqual(result.returncode, 2, seed)
            self.assertIn(f"--seed: must be a whole number from 0 to 18446744073709551615, is '{seed}'", result.stderr)

    def test_a_simulation_that_diverges_is_told_and_fails(self):
        with tempfile.TemporaryDirectory() as out:
            result = dihaptic("run", "scenes/block-on-table.yaml", "--out", out, "--coupling", "dual_spring",
                              "--set", "coupling.stiffness_N_m=1e5", "--set", "coupling.body_mass_g=0.1")
            self.assertEqual(result.returncode, 1, result.stdout)
            self.assertRegex(result.stdout, r"WARNING: in \d+ of \d+ ticks the simulation diverged")
            self.assertIn("diverged", pathlib.Path(session_of(out) + "trials.csv").read_text())

    def test_a_fault_is_told_and_kept_and_replayed(self):
        with tempfile.TemporaryDirectory() as out:
            result = dihaptic("run", "scenes/block-on-table.yaml", "--out", out, "--set", "safety.max_speed_m_s=0.01")
            self.assertEqual(result.returncode, 1, result.stdout)
            told = (r"force is off since 0\.\d+ s: the (thumb|index)'s device \(simulated plant\) moved at 0\.01\d* m/s, "
                    r"and 0\.01 m/s are allowed\. .* raise settings: safety: max_speed_m_s")
            self.assertRegex(result.stdout, "WARNING: " + told)
            folder = session_of(out)
            self.assertIn("force is off since", pathlib.Path(folder + "session.yaml").read_text())
            self.assertIn("force off", pathlib.Path(folder + "trials.csv").read_text())
            self.assertIn("The second before it is in fault.csv.", result.stdout)
            with open(folder + "fault.csv") as file:
                rows = list(csv.DictReader(file))
            self.assertIn("moved faster than allowed", rows[-1]["status"])
            self.assertIn(f"force is off since {float(rows[-1]['time_s']):.3f} s", result.stdout)
            self.assertLessEqual(float(rows[-1]["time_s"]) - float(rows[0]["time_s"]), 1)
            fault = pathlib.Path(folder + "fault.csv").read_text()
            os.remove(folder + "fault.csv")
            self.assertEqual(dihaptic("recover", folder).returncode, 0)
            self.assertEqual(pathlib.Path(folder + "fault.csv").read_text(), fault)
            replay = dihaptic("replay", folder)
            self.assertEqual(replay.returncode, 0, replay.stdout + replay.stderr)

    def test_run_prints_figures_and_the_folder_and_leaves_all_files(self):
        with tempfile.TemporaryDirectory() as out:
            result = dihaptic("run", "scenes/block-on-table.yaml", "--out", out, "--participant", "S07", "--seed", "3")
            self.assertEqual(result.returncode, 0, result.stderr)
            for word in ["hold", "grip", "load", "slip", "weight", "tick", "times real time"]:
                self.assertIn(word, result.stdout)
            folder = session_of(out)
            self.assertIn(folder.rstrip("/"), result.stdout)
            self.assertIn("S07", folder)
            for name in ["session.yaml", "scene.yaml", "rig.yaml", "settings.yaml", "settings.csv", "raw.log", "session.nwb",
                         "trials.csv", "phases.csv", "episodes.csv", "lifts.csv", "events.csv"]:
                self.assertTrue(os.path.exists(folder + name), name)
            self.assertIn("S07", pathlib.Path(folder + "trials.csv").read_text())
            self.assertFalse(glob.glob(folder + "*.part"))

    def test_replay_finds_nothing_different(self):
        with tempfile.TemporaryDirectory() as out:
            dihaptic("run", "scenes/push-block.yaml", "--out", out)
            result = dihaptic("replay", session_of(out))
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("identical to the bit", result.stdout)

    def test_a_folder_of_movements_runs_as_a_batch(self):
        with tempfile.TemporaryDirectory() as folder:
            text = pathlib.Path("movements/reach-to-grasp.csv").read_text()
            lines = text.splitlines()
            # b: the index was seen in one line of twelve
            thin = [line if i % 12 < 2 else ",".join(line.split(",")[:4] + [""] * 3 + ["0"]) for i, line in enumerate(lines)]
            late = lines[:-1] + ["1e303" + lines[-1][lines[-1].index(","):]]
            for name, content in [("a", text), ("b", "\n".join(thin)), ("broken", text.replace("0.000,", "x,", 1)),
                                  ("late", "\n".join(late))]:
                pathlib.Path(f"{folder}/{name}.csv").write_text(content)
            out = folder + "/out"
            result = dihaptic("run", "experiments/reach-to-grasp.yaml", "--movement", folder, "--out", out)
            self.assertEqual(result.returncode, 1)
            self.assertIn("broken.csv:2: error: time_ms: 'x' is not a number", result.stderr)
            self.assertRegex(result.stderr, r"late.csv:\d+: error: time_ms: time jumps from")
            self.assertIn("4 movements, 2 refused", result.stdout)
            self.assertRegex(result.stdout, r"b.csv +[\d.]+ +[\d.]+ %! ")
            with open(out + "/summary.csv") as file:
                rows = list(csv.DictReader(file))
            self.assertEqual([row["outcome"] for row in rows], ["done", "done", "refused", "refused"])
            self.assertEqual([row["mostly_bridged"] for row in rows], ["no", "yes", "", ""])
            with open(rows[0]["session"] + "/phases.csv") as file:
                (grasp,) = [row for row in csv.DictReader(file) if row["phase"] == "grasp"]
            self.assertEqual(rows[0]["grasp_mean_grip_N"], grasp["mean_grip_N"])
            self.assertEqual(rows[0]["grasp_peak_grip_N"], grasp["peak_grip_N"])

    def test_a_batch_that_is_killed_keeps_the_rows_of_what_was_done(self):
        with tempfile.TemporaryDirectory() as folder:
            for i in range(40):
                shutil.copy("movements/reach-to-grasp.csv", f"{folder}/{i:02d}.csv")
            out = folder + "/out"
            process = subprocess.Popen([PROGRAM, "run", "experiments/reach-to-grasp.yaml", "--movement", folder, "--out", out],
                                       stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            for _ in range(3):
                process.stdout.readline()  # the head, and two movements
            process.kill()
            process.communicate()
            self.assertGreaterEqual(len(pathlib.Path(out + "/summary.csv").read_text().splitlines()), 2)

    def test_picture_of_a_scene_and_of_a_session(self):
        with tempfile.TemporaryDirectory() as folder:
            file = folder + "/block.png"
            small = ["--size", "96x64", "-o", file]
            self.assertEqual(dihaptic("picture", "scenes/block-on-table.yaml", *small).returncode, 0)
            start = pathlib.Path(file).read_bytes()
            self.assertEqual(start[:8], b"\x89PNG\r\n\x1a\n")
            self.assertEqual(dihaptic("run", "scenes/block-on-table.yaml", "--out", folder).returncode, 0)
            lifted = dihaptic("picture", session_of(folder), "--time", "2.5", "--camera", "front", "--show", "path,forces", *small)
            self.assertIn("A 100 g block on a table at 2.500 s", lifted.stdout)
            self.assertNotEqual(pathlib.Path(file).read_bytes(), start)
            # the same moment, simulated anew
            self.assertEqual(dihaptic("picture", session_of(folder), "--time", "2.5", *small).returncode, 0)
            recorded = pathlib.Path(file).read_bytes()
            self.assertEqual(dihaptic("picture", "scenes/block-on-table.yaml", "--time", "2.5", *small).returncode, 0)
            self.assertEqual(pathlib.Path(file).read_bytes(), recorded)

    def test_pictures_that_cannot_be_say_why_and_leave_nothing(self):
        scene = "scenes/block-on-table.yaml"
        with tempfile.TemporaryDirectory() as folder:
            file = folder + "/x.png"
            for arguments, told in [(["--camera", "below"], "there is no camera 'below'. There are close, front, above, side"),
                                    (["--time", "99"], "--time: error: 99 s is beyond the end, which is at 3"),
                                    (["--size", "99"], "'99' is no size of a picture. Give width and height in pixels"),
                                    (["--show", "ghosts"], "ghosts not in {path,forces"),
                                    (["-o", folder + "/none/x.png"], "cannot be written")]:
                result = dihaptic("picture", scene, "-o", file, *arguments) if arguments[0] != "-o" else dihaptic("picture", scene, *arguments)
                self.assertEqual(result.returncode, 2, arguments)
                self.assertIn(told, result.stderr, arguments)
            self.assertEqual(os.listdir(folder), [])

    def test_video(self):
        with tempfile.TemporaryDirectory() as folder:
            file = folder + "/block.mp4"
            result = dihaptic("video", "scenes/frictionless-plane.yaml", "--size", "64x48", "-o", file)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("100 %", result.stderr)
            seconds, pictures = re.search(r", ([0-9.]+) s, (\d+) pictures", result.stdout).groups()
            probe = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-show_entries",
                                    "stream=nb_read_frames,duration,width,height", "-of", "csv=p=0", file],
                                   capture_output=True, text=True)
            width, height, duration, frames = probe.stdout.strip().split(",")
            self.assertEqual((width, height, frames), ("64", "48", pictures))
            self.assertAlmostEqual(float(duration), float(seconds), delta=0.02)
            self.assertEqual(os.listdir(folder), ["block.mp4"])

    def test_videos_that_cannot_be_say_why_and_leave_nothing(self):
        with tempfile.TemporaryDirectory() as folder:
            command = ["video", "scenes/block-on-table.yaml", "--size", "64x48", "-o", folder + "/x.mp4"]
            result = dihaptic(*command, env={**os.environ, "PATH": "/nowhere"})
            self.assertEqual(result.returncode, 2)
            self.assertIn("ffmpeg, which makes videos, is missing. Install it: sudo apt-get install ffmpeg", result.stderr)
            result = dihaptic("video", "scenes/block-on-table.yaml", "--size", "65x48", "-o", folder + "/x.mp4")
            self.assertIn("a video cannot be 65x48. Give an even width and height", result.stderr)
            result = dihaptic("video", "scenes/block-on-table.yaml", "--size", "64x48", "-o", folder + "/none/x.mp4")
            self.assertEqual(result.returncode, 2)
            self.assertIn("ffmpeg could not make it", result.stderr)
            for signal_ in (signal.SIGINT, signal.SIGTERM):
                process = subprocess.Popen([PROGRAM, *command], stderr=subprocess.PIPE, text=True)
                process.stderr.readline()  # it has begun
                process.send_signal(signal_)
                self.assertIn("interrupted: there is no video", process.communicate(timeout=60)[1])
                self.assertEqual(process.returncode, 1)
            self.assertEqual(os.listdir(folder), [])

    def test_check(self):
        files = glob.glob("scenes/*.yaml") + glob.glob("rigs/*.yaml") + glob.glob("experiments/*.yaml")
        result = dihaptic("check", *files)
        self.assertEqual(result.returncode, 0, result.stderr)
        with tempfile.TemporaryDirectory() as folder:
            bad = folder + "/bad.yaml"
            pathlib.Path(bad).write_text("bodies:\n  - {name: b, shape: box, size_mm: [1, 1, 1], mass_g: -5}\n")
            result = dihaptic("check", bad, files[0])
            self.assertEqual(result.returncode, 2)
            self.assertIn("bad.yaml:2: error: mass_g: must be positive", result.stdout)
            self.assertIn("not usable", result.stdout)
            self.assertLess(result.stdout.index("mass_g"), result.stdout.index("not usable"))
            self.assertEqual(result.stderr, "")

    def test_check_names_a_line_once_and_shows_no_raw_bytes(self):
        result = dihaptic("check", "movements/reach-to-grasp.csv")
        self.assertRegex(result.stdout, r"reach-to-grasp.csv:\d+: warning: [\d.]+ to")
        self.assertNotIn("(line", result.stdout)
        with tempfile.TemporaryDirectory() as folder:
            junk = folder + "/junk.csv"
            pathlib.Path(junk).write_bytes(bytes(range(256)))
            result = dihaptic("check", junk, folder)
            self.assertEqual(result.returncode, 2)
            self.assertIn("junk.csv: error: is not a text file", result.stdout)
            self.assertIn(folder + ": error: is a folder. Name a file in it.", result.stdout)
            self.assertTrue(result.stdout.replace("\n", "").isprintable())

    def test_a_damaged_mesh_ends_in_a_message(self):
        head = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        faces = "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
        good = head + faces + "0 0 0\n40 0 0\n0 40 0\n0 0 40\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"
        damaged = {"index.ply": good.replace("3 1 2 3", "3 1 2 300000000"), "cut.ply": good[:150],
                   "counts.ply": good.replace("vertex 4\n", "vertex 4000000000\n"),
                   "listed.ply": good.replace("property float z", "property list uchar float z"),
                   "binary.ply": good.replace("ascii", "binary_little_endian"),
                   "empty.stl": "", "promises.stl": "\0" * 80 + "\x7f" * 4 + "\0" * 50, "empty.off": "OFF\n4 4 0\n"}
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder, "scene.yaml")
            for name, text in {"good.ply": good, **damaged}.items():
                pathlib.Path(folder, name).write_text(text)
                scene.write_text(SHORT.replace("block.obj", name))
                result = dihaptic("check", str(scene))
                if name == "good.ply":
                    self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
                    continue
                self.assertEqual(result.returncode, 2, name + result.stdout + result.stderr)
                self.assertRegex(result.stdout, r"scene.yaml:3: error: file: .*" + name)
            os.mkfifo(folder + "/pipe.obj")
            scene.write_text(SHORT.replace("block.obj", "pipe.obj"))
            self.assertIn("is no file, but a pipe, a socket or a device", dihaptic("check", str(scene)).stdout)

    def test_bad_input_fails_with_file_and_remedy(self):
        for arguments in [["run", "gone.yaml"], ["run", "README.md"], ["replay", "/tmp"], ["recover", "/nowhere"],
                          ["run", "scenes/block-on-table.yaml", "--rig", "gone.yaml"],
                          ["run", "scenes/block-on-table.yaml", "--solver", "magic"],
                          ["run", "scenes/block-on-table.yaml", "--out", "/proc/nowhere"],
                          ["run", "scenes/block-on-table.yaml", "--out", ""],
                          ["run", "scenes/block-on-table.yaml", "--participant", "S" * 300]]:
            result = dihaptic(*arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertIn("error:", result.stderr, arguments)
            self.assertNotIn("report this", result.stderr, arguments)

    def test_bench_json_is_one_object_and_nothing_else(self):
        result = dihaptic("bench", "scale", "--extra", "0", "--json")
        figures = json.loads(result.stdout)
        self.assertEqual(set(figures["tick"][0]), {"extra", "awake", "asleep", "bullet_us", "most_us", "within_bar"})
        self.assertEqual(set(figures["tick"][0]["awake"]), {"median_us", "p99_us", "max_us"})

    def test_bench_jitter_measures_the_servo_beside_cyclictest(self):
        with tempfile.TemporaryDirectory() as folder:
            def jitter(cyclictest, *options):
                path = pathlib.Path(folder) / "cyclictest"
                path.unlink(missing_ok=True)
                if cyclictest:
                    path.write_text("#!/bin/sh\n" + cyclictest)
                    path.chmod(0o755)
                return dihaptic("bench", "jitter", "--time", "1", *options, env={**os.environ, "PATH": folder})

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
            result = dihaptic("bench", "jitter", "--time", wrong)
            self.assertEqual(result.returncode, 2, wrong)
            self.assertIn(f"--time: must be a number from 1 to 3600, is '{wrong}'", result.stderr)

    def test_bench_contact_measures_what_it_can_and_names_the_rest(self):
        problems = "../shared/data/contact-problems"
        if not os.path.exists(problems):
            self.skipTest(problems + " is absent")
        with tempfile.TemporaryDirectory() as folder:
            bad = folder + "/bad.hdf5"
            pathlib.Path(bad).write_text("no")
            result = dihaptic("bench", "contact", bad, problems + "/Rover1039.hdf5", "--json", "--solver", "stewart_trinkle",
                              "--directions", "16", "--direction-frame", "fixed")
        self.assertEqual(result.returncode, 2)
        self.assertIn("bad.hdf5: error: is not an HDF5 file", result.stderr)
        (row,) = json.loads(result.stdout)["problems"]
        self.assertEqual(set(row), {"file", "contacts", "solver", "residual", "us", "iterations", "fallback", "lcp_residual", "route"})
        self.assertEqual((row["contacts"], row["solver"], row["fallback"]), (4, "stewart_trinkle", False))
        self.assertLess(row["lcp_residual"], 1e-8)
        for wrong in [["--solver", "sequential_impulse"], ["--solver", "magic"], ["--directions", "3"],
                      ["--direction-frame", "round"]]:
            result = dihaptic("bench", "contact", problems, *wrong)
            self.assertEqual(result.returncode, 2, wrong)
            self.assertIn(wrong[0], result.stderr)


def with_largest_file(size):
    """For preexec_fn: no file gets larger, as on a disk that gets full."""
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


SHORT = """bodies:
  - {name: floor, shape: plane, fixed: yes}
  - {name: thing, shape: mesh, file: block.obj, unit: mm, mass_g: 50}
hand: {centre_mm: [0, 0, 100], script: [{name: wait, duration_s: 0.1}, {name: rest, duration_s: 0.1}]}
"""
BLOCK = "v 0 0 0\nv 40 0 0\nv 0 40 0\nv 0 0 40\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
TICKS = 201
MADE = ["session.nwb", "trials.csv", "phases.csv", "episodes.csv", "lifts.csv", "events.csv"]


class RealDevices(unittest.TestCase):
    """On fakes of the makers' libraries, which stand where the machine seeks the real ones."""

    HD = ["libHD.so", "libHD.so.3.4", "libHD.so.3.0"]
    DHD = ["libdhd.so.3", "libdrd.so.3", "libdhd.so", "libdrd.so"]

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.env = {**os.environ, "LD_LIBRARY_PATH": self.folder.name}

    def put(self, names, fake=None):
        for name in names:
            file = pathlib.Path(self.folder.name, name)
            file.unlink(missing_ok=True)
            if fake:
                file.symlink_to(pathlib.Path(PROGRAM).resolve().parent / "src/devices" / fake)
            else:
                file.write_text("no library at all")

    def rig(self, shipped, safety=PATIENT):
        """A copy of a shipped rig, with limits of its own."""
        rig = pathlib.Path(self.folder.name, "rig.yaml")
        rig.write_text(pathlib.Path(shipped).read_text() + f"settings: {{safety: {{{safety}}}}}\n")
        return str(rig)

    def test_devices_says_what_is_missing_and_what_mends_it(self):
        self.put(self.HD + self.DHD)
        result = dihaptic("devices", env=self.env)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stdout, r"openhaptics\n    OpenHaptics cannot be loaded; tried libHD.so \(.*file too short\), "
                                        r"libHD.so.3.4 \(.*\), libHD.so.3.0 \(.*\). Install OpenHaptics 3.4")
        self.assertRegex(result.stdout, r"forcedimension\n    Force Dimension's SDK cannot be loaded; tried libdhd.so.3 \(.*"
                                        r"Install the Force Dimension SDK 3")
        self.put(self.HD, "libfake_dhd.so")
        self.assertIn("has no hdInitDevice. It is of a version", dihaptic("devices", env=self.env).stdout)

    def test_devices_lists_what_is_there(self):
        self.put(self.HD, "libfake_hd.so")
        self.put(self.DHD, "libfake_dhd.so")
        told = dihaptic("devices", env=self.env).stdout
        self.assertIn("openhaptics\n    PHANToM Premium 1.0, serial 40123: ", told)
        self.assertIn("forcedimension\n    omega.3, serial 101: ready\n    omega.3, serial 102: ready\n", told)

    def test_real_devices_keep_real_time(self):
        for rig in ["rigs/omega-pair.yaml", "rigs/phantom-pair-openhaptics.yaml"]:
            result = dihaptic("run", "scenes/block-on-table.yaml", "--rig", rig, "--clock", "virtual", env=self.env)
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertIn("--clock: error: real devices keep real time. Leave out --clock", result.stderr)
            result = dihaptic("tune", "scenes/block-on-table.yaml", "--rig", rig, env=self.env)
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertIn("has real devices, and tune shakes its own", result.stderr)

    def test_a_session_on_devices_that_are_not_there_says_so_before_it_begins(self):
        self.put(self.HD + self.DHD)
        with tempfile.TemporaryDirectory() as out:
            result = dihaptic("run", "scenes/block-on-table.yaml", "--rig", "rigs/omega-pair.yaml", "--out", out,
                              env=self.env)
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertRegex(result.stderr, r"omega-pair.yaml:\d+: error: library: Force Dimension's SDK cannot be loaded")
            self.assertEqual(os.listdir(out), [])

    def test_calibrate_ends_in_the_middle_of_a_line(self):
        self.put(self.HD, "libfake_hd.so")
        process = subprocess.Popen([PROGRAM, "calibrate", "rigs/phantom-pair-openhaptics.yaml", "-o", self.folder.name + "/c.yaml"],
                                   stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=self.env)
        process.stdin.write(b"\n\nabc")  # two steps at once, and no end of line
        process.stdin.flush()
        lines = iter(process.stdout.readline, b"")
        next(line for line in lines if b"3 of 4" in line)
        process.send_signal(signal.SIGINT)
        _, stderr = process.communicate(timeout=20)
        self.assertEqual(process.returncode, 1)
        self.assertIn(b"nothing was stored", stderr)

    def test_calibrate_leads_a_person_who_may_give_up(self):
        self.put(self.HD, "libfake_hd.so")
        rig = self.folder.name + "/rig.yaml"
        pathlib.Path(rig).write_text(pathlib.Path("rigs/phantom-pair-openhaptics.yaml").read_text())
        result = dihaptic("calibrate", rig, input="\n\n", env=self.env)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertRegex(result.stdout, r"1 of 4\. Hold each arm in the standard configuration: .*\n   Then press Enter\.\n"
                                        r"2 of 4\. Join the endpoints of thumb and index by the link")
        self.assertIn("3 of 4. Move the link through all of the workspace", result.stdout)
        self.assertIn("interrupted: nothing was stored", result.stderr)
        self.assertEqual(os.listdir(self.folder.name).count("rig-calibration.yaml"), 0)

    def test_a_session_asks_for_endpoints_held_together_and_tells_when_they_disagree(self):
        self.put(self.HD, "libfake_hd.so")
        rig = self.folder.name + "/rig.yaml"
        text = pathlib.Path(self.rig("rigs/phantom-pair-openhaptics.yaml")).read_text()
        pathlib.Path(rig).write_text("calibration: mine.yaml\n" + text)
        pathlib.Path(self.folder.name + "/mine.yaml").write_text(
            f"date: {time.strftime('%Y-%m-%d')}\ndevices: [{{finger: thumb}}, {{finger: index, together_mm: 12}}]\n")
        for answer, notes in [(b"\n", True), (b"s", False)]:
            with tempfile.TemporaryDirectory() as out:
                master, slave = pty.openpty()
                process = subprocess.Popen([PROGRAM, "run", "scenes/block-on-table.yaml", "--rig", rig, "--out", out],
                                           stdin=slave,
                                           stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=self.env,
                                           start_new_session=True, preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0))
                lines = iter(process.stdout.readline, "")
                next(line for line in lines if "Hold the endpoints of thumb and index together" in line)
                os.write(master, answer)
                wait_for_log(out, 100000)
                process.send_signal(signal.SIGINT)
                stdout, stderr = process.communicate(timeout=60)
                os.close(master)
                os.close(slave)
                told = "held together, are 0.0 mm apart, and were 12.0 mm apart when the rig was calibrated"
                self.assertEqual(told in stdout, notes, stdout + stderr)
                session = pathlib.Path(session_of(out) + "session.yaml").read_text()
                self.assertEqual(told in session, notes, session)

    def test_a_session_goes_on_until_it_is_ended(self):
        self.put(self.HD, "libfake_hd.so")
        self.put(self.DHD, "libfake_dhd.so")
        for rig in ["rigs/omega-pair.yaml", "rigs/phantom-pair-openhaptics.yaml"]:
            with tempfile.TemporaryDirectory() as out:
                process = subprocess.Popen([PROGRAM, "run", "scenes/block-on-table.yaml", "--rig", self.rig(rig),
                                            "--out", out],
                                           stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=self.env)
                wait_for_log(out, 100000)
                process.send_signal(signal.SIGINT)
                stdout, stderr = process.communicate(timeout=60)
                self.assertIn("Escape or Ctrl-C switches force off", stdout, stderr)
                session = pathlib.Path(session_of(out) + "session.yaml").read_text()
                self.assertIn("clock: real", session)
                self.assertRegex(session, r"serial (101|40123)")
                self.assertEqual(dihaptic("replay", session_of(out)).returncode, 0)


class Damage(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        pathlib.Path(folder.name + "/block.obj").write_text(BLOCK)
        pathlib.Path(folder.name + "/short.yaml").write_text(SHORT)
        self.out = folder.name + "/out"
        result = dihaptic("run", folder.name + "/short.yaml", "--out", self.out, "--participant", "S07")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.folder = session_of(self.out)
        self.assertIn("state: complete", self.read("session.yaml"))

    def read(self, name):
        return pathlib.Path(self.folder + name).read_text()

    def flip(self, name, share):
        path = pathlib.Path(self.folder + name)
        data = bytearray(path.read_bytes())
        data[int(len(data) * share)] ^= 1
        path.write_bytes(data)

    def test_a_damaged_chunk_costs_its_ticks_alone_and_is_told(self):
        self.flip("raw.log", 0.6)
        was = {name: pathlib.Path(self.folder + name).read_bytes() for name in MADE}
        gap = "50 ticks missing from tick 100 on, between 0.099 s and 0.150 s"

        replayed = dihaptic("replay", self.folder)
        self.assertEqual(replayed.returncode, 1)
        self.assertIn(gap, replayed.stdout)
        self.assertIn("the first 100 ticks", replayed.stdout)

        refused = dihaptic("recover", self.folder)
        self.assertEqual(refused.returncode, 2)
        self.assertIn(f"session.nwb: error: has more than the log can give now: {TICKS} ticks", refused.stderr)
        self.assertIn("Move it away", refused.stderr)
        self.assertIn(gap, refused.stderr)
        self.assertEqual(was, {name: pathlib.Path(self.folder + name).read_bytes() for name in MADE})
        self.assertIn("state: complete", self.read("session.yaml"))

        os.rename(self.folder + "session.nwb", self.folder + "longer.nwb")
        recovered = dihaptic("recover", self.folder)
        self.assertEqual(recovered.returncode, 0, recovered.stderr)
        self.assertIn(f"{TICKS - 50} frames", recovered.stdout)
        self.assertIn(gap, recovered.stdout)
        self.assertIn("state: recovered", self.read("session.yaml"))
        self.assertIn("50 ticks missing", self.read("session.yaml"))
        self.assertEqual(dihaptic("replay", self.folder).returncode, 1)

    def test_a_log_that_was_cut_is_told_and_longer_tables_are_kept(self):
        os.truncate(self.folder + "raw.log", os.path.getsize(self.folder + "raw.log") * 6 // 10)
        lost = f"{TICKS - 100} ticks missing at the end, after 0.099 s: the session had {TICKS} ticks"
        replayed = dihaptic("replay", self.folder)
        self.assertEqual(replayed.returncode, 1)
        self.assertIn(lost, replayed.stdout)
        held = re.search(r"an unfinished chunk, of about (\d+) ticks", replayed.stdout)
        self.assertAlmostEqual(int(held[1]), 50, delta=10)
        os.remove(self.folder + "session.nwb")
        refused = dihaptic("recover", self.folder)
        self.assertEqual(refused.returncode, 2)
        for name in ["trials.csv", "phases.csv", "events.csv"]:
            self.assertIn(name + ": error: has more than the log can give now", refused.stderr)
            os.remove(self.folder + name)
        recovered = dihaptic("recover", self.folder)
        self.assertEqual(recovered.returncode, 0, recovered.stderr)
        self.assertIn(lost, recovered.stdout)
        self.assertIn("interrupted", self.read("trials.csv"))

    def test_only_the_log_is_needed_and_nothing_that_is_cut_crashes(self):
        random.seed(2)
        names = [name for name in os.listdir(self.folder)]
        self.assertEqual(len(names), 13, names)
        whole = {name: pathlib.Path(self.folder + name).read_bytes() for name in names}
        inputs = ["scene.yaml", "rig.yaml", "settings.yaml", "mesh-1-block.obj"]
        for name in names:
            size = len(whole[name])
            lengths = {0, 1, size - 1, *range(100, min(size, 151), 10), *(random.randrange(size) for _ in range(4))}
            for length in [None, *sorted(lengths)]:
                for other, data in whole.items():
                    pathlib.Path(self.folder + other).write_bytes(data)
                pathlib.Path(self.folder + name).unlink() if length is None else os.truncate(self.folder + name, length)
                where = f"{name} cut to {length}"
                replayed = dihaptic("replay", self.folder)
                for made in MADE:
                    if os.path.exists(self.folder + made) and name == "raw.log":
                        os.remove(self.folder + made)
                recovered = dihaptic("recover", self.folder)
                for result in [replayed, recovered]:
                    self.assertIn(result.returncode, [0, 1, 2], where + result.stderr)
                    self.assertNotIn("report this", result.stderr, where)
                if name == "raw.log":
                    self.assertNotEqual(replayed.returncode, 0, where)
                    continue
                self.assertEqual(replayed.returncode, 2 if name in inputs else 0, where + replayed.stderr)
                self.assertEqual(recovered.returncode, 0, where + recovered.stderr)
                self.assertIn(f"{TICKS} frames", recovered.stdout, where)
                self.assertIn("the log is complete", recovered.stdout, where)
                if name in inputs + ["session.yaml", "settings.csv"]:
                    self.assertIn(f"/{name}: warning:", recovered.stderr, where)
                for made in MADE:
                    self.assertGreater(os.path.getsize(self.folder + made), 0, where)
                self.assertTrue(self.read("session.yaml").endswith("...\n"), where)
                if name in ["session.yaml", "settings.csv"]:
                    again = dihaptic("recover", self.folder)  # it is mended now
                    self.assertEqual(again.stderr.count("warning"), 0, where + again.stderr)

    def test_changed_inputs_are_named(self):
        with open(self.folder + "rig.yaml", "a") as rig:
            rig.write("# moved a little\n")
        replayed = dihaptic("replay", self.folder)
        self.assertEqual(replayed.returncode, 2)
        self.assertIn("rig.yaml: error: is not what it was when the session was recorded", replayed.stderr)
        recovered = dihaptic("recover", self.folder)
        self.assertEqual(recovered.returncode, 0, recovered.stderr)
        self.assertIn("rig.yaml: warning: is not what it was", recovered.stderr)

    def test_a_session_is_complete_only_with_all_of_its_files(self):
        sizes = [os.path.getsize(self.folder + name) for name in ["raw.log", "session.nwb"]]
        self.assertLess(*sizes)  # so there is a limit that the log keeps
        out = self.out + "/full"
        result = dihaptic("run", self.out + "/../short.yaml", "--out", out, preexec_fn=with_largest_file(sum(sizes) // 2))
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("session.nwb: error: cannot be written", result.stderr)
        folder = session_of(out)
        self.assertIn("state: running", pathlib.Path(folder + "session.yaml").read_text())
        self.assertEqual(set(os.listdir(folder)), set(os.listdir(self.folder)) - set(MADE))
        recovered = dihaptic("recover", folder)
        self.assertEqual(recovered.returncode, 0, recovered.stderr)
        self.assertIn(f"{TICKS} frames", recovered.stdout)

    def test_replay_goes_to_100_percent(self):
        self.assertIn("100 %", dihaptic("replay", self.folder).stderr)


class Interruptions(unittest.TestCase):
    def start(self, out, *arguments, **options):
        return subprocess.Popen([PROGRAM, "run", "experiments/lift-block.yaml", "--out", out, *arguments],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options)

    def test_a_closed_terminal_ends_in_order(self):
        with tempfile.TemporaryDirectory() as out:
            master, slave = pty.openpty()
            process = subprocess.Popen([PROGRAM, "run", "experiments/lift-block.yaml", "--out", out, *REAL_CLOCK],
                                       stdin=slave, stdout=slave, stderr=slave, start_new_session=True,
                                       preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0))
            os.close(slave)
            wait_for_log(out, 300000)
            os.close(master)
            self.assertEqual(process.wait(timeout=60), 1)
            folder = session_of(out)
            self.assertTrue(os.path.exists(folder + "session.nwb"))
            self.assertIn("state: interrupted", pathlib.Path(folder + "session.yaml").read_text())

    def test_a_reader_that_goes_away_ends_in_order(self):
        with tempfile.TemporaryDirectory() as out:
            process = subprocess.Popen([PROGRAM, "run", "experiments/lift-block.yaml", "--out", out, *REAL_CLOCK],
                                       stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            wait_for_log(out, 300000)
            process.stdout.close()
            self.assertEqual(process.wait(timeout=60), 1)
            folder = session_of(out)
            self.assertTrue(os.path.exists(folder + "session.nwb"))
            self.assertIn("state: interrupted", pathlib.Path(folder + "session.yaml").read_text())

    def test_keys_of_a_terminal_switch_force_off(self):
        for name, key in [("Escape", b"\x1b"), ("Ctrl-C", b"\x03"), ("Ctrl-\\", b"\x1c"), ("Ctrl-Z", b"\x1a")]:
            with self.subTest(name), tempfile.TemporaryDirectory() as out:
                master, slave = pty.openpty()
                before = termios.tcgetattr(slave)
                process = subprocess.Popen([PROGRAM, "run", "experiments/lift-block.yaml", "--out", out, *REAL_CLOCK],
                                           stdin=slave, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
                                           start_new_session=True, preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0))
                wait_for_log(out, 300000)
                os.write(master, b"q")  # no other key does
                time.sleep(0.2)
                self.assertIsNone(process.poll())
                os.write(master, key)
                stdout, _ = process.communicate(timeout=60)
                self.assertEqual(process.returncode, 1)
                self.assertIn("Escape or Ctrl-C switches force off", stdout)
                self.assertRegex(stdout, r"force is off since [0-9.]+ s: ")
                folder = session_of(out)
                self.assertIn("state: interrupted", pathlib.Path(folder + "session.yaml").read_text())
                self.assertEqual(termios.tcgetattr(slave), before)
                os.close(slave)
                os.close(master)
                replay = dihaptic("replay", folder)
                self.assertEqual(replay.returncode, 0, replay.stdout)

    def test_a_running_session_is_not_recovered(self):
        with tempfile.TemporaryDirectory() as out:
            process = self.start(out, *REAL_CLOCK)
            wait_for_log(out, 100000)
            folder = session_of(out)
            before = set(os.listdir(folder))
            result = dihaptic("recover", folder)
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertIn("error: is in use", result.stderr)
            self.assertEqual(set(os.listdir(folder)), before)
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=60)
            self.assertEqual(dihaptic("recover", folder).returncode, 0)

    def test_ticks_that_overruns_left_out_are_told(self):
        with tempfile.TemporaryDirectory() as out:
            process = self.start(out, *REAL_CLOCK)
            wait_for_log(out, 100000)
            process.send_signal(signal.SIGSTOP)
            time.sleep(0.3)
            process.send_signal(signal.SIGCONT)
            time.sleep(0.2)
            process.send_signal(signal.SIGINT)
            stdout, _ = process.communicate(timeout=60)
            told = re.compile(r"(\d+) ticks \(([0-9.]+) ms\) never were")
            self.assertGreater(int(told.search(stdout).group(1)), 250, stdout)
            late = re.search(r"wake-ups late by (\d+) us median, \d+ us p99.9, (\d+) us at worst; \d+ overrun", stdout)
            self.assertIn(late.group(0).split(";")[0], pathlib.Path(session_of(out) + "session.yaml").read_text())
            recovered = dihaptic("recover", session_of(out)).stdout
            self.assertEqual(told.search(recovered).group(0), told.search(stdout).group(0))

    def frames_of(self, text):
        return int(text.split(" frames")[0].split()[-1])

    def test_ctrl_c_ends_in_order(self):
        with tempfile.TemporaryDirectory() as out:
            process = self.start(out, *REAL_CLOCK)
            wait_for_log(out, 300000)
            process.send_signal(signal.SIGINT)
            stdout, stderr = process.communicate(timeout=60)
            self.assertEqual(process.returncode, 1, stderr)
            self.assertIn("interrupted", stdout)
            folder = session_of(out)
            self.assertTrue(os.path.exists(folder + "session.nwb"))
            self.assertIn("state: interrupted", pathlib.Path(folder + "session.yaml").read_text())
            # a machine that stood still for too long has switched force off before
            self.assertRegex(pathlib.Path(folder + "trials.csv").read_text(), "interrupted|force off")

    def test_kill_loses_at_most_a_tenth_of_a_second(self):
        with tempfile.TemporaryDirectory() as out:
            process = self.start(out, *REAL_CLOCK)
            # the log as it stands, and when: from there on real time counts the frames
            wait_for_log(out, 100000)
            folder = session_of(out)
            snapshot = pathlib.Path(folder + "raw.log").read_bytes()
            seen_at = time.monotonic()
            time.sleep(1.5)
            process.kill()
            killed_at = time.monotonic()
            process.communicate()
            self.assertIn("state: running", pathlib.Path(folder + "session.yaml").read_text())

            earlier = shutil.copytree(folder, out + "/earlier")
            result = dihaptic("recover", folder)
            self.assertEqual(result.returncode, 0, result.stderr)
            recovered = self.frames_of(result.stdout)
            pathlib.Path(earlier + "/raw.log").write_bytes(snapshot)
            before = self.frames_of(dihaptic("recover", earlier).stdout)
            ticks = before + (killed_at - seen_at) * 1000
            self.assertGreater(recovered, ticks - 100 - 50)  # 50 ms for this script's own waits
            self.assertTrue(os.path.exists(folder + "session.nwb"))

    def test_killed_anywhere_it_recovers_and_replays(self):
        random.seed(1)
        with tempfile.TemporaryDirectory() as out:
            self.start(out).communicate(timeout=60)
            whole = os.path.getsize(session_of(out) + "raw.log")
        kills = 0
        while kills < int(os.environ.get("DIHAPTIC_KILLS", 8)):
            with tempfile.TemporaryDirectory() as out:
                process = self.start(out)
                size = wait_for_log(out, random.uniform(0.01, 0.99) * whole)
                process.kill()
                process.communicate()
                if process.returncode == 0:
                    continue  # it was faster
                kills += 1
                folder = session_of(out)
                self.assertIn("state: running", pathlib.Path(folder + "session.yaml").read_text())
                recovered = dihaptic("recover", folder)
                self.assertEqual(recovered.returncode, 0, recovered.stderr)
                self.assertGreaterEqual(self.frames_of(recovered.stdout), 50 * whole_chunks(folder + "raw.log") - 49)
                if size < 0.5 * whole:
                    self.assertIn("without its end mark", recovered.stdout)
                    self.assertIn("of 9.500 s planned", recovered.stdout)
                self.assertIn("state: recovered", pathlib.Path(folder + "session.yaml").read_text())
                replayed = dihaptic("replay", folder)
                self.assertEqual(replayed.returncode, 0, replayed.stdout)

    def test_a_full_disk_is_told_and_what_was_written_is_kept(self):
        with tempfile.TemporaryDirectory() as out:
            process = self.start(out, preexec_fn=with_largest_file(500_000))
            _, stderr = process.communicate(timeout=60)
            self.assertEqual(process.returncode, 2)
            self.assertIn("raw.log: error: cannot be written", stderr)
            self.assertIn("dihaptic recover", stderr)
            recovered = dihaptic("recover", session_of(out))
            self.assertEqual(recovered.returncode, 0, recovered.stderr)
            self.assertGreater(self.frames_of(recovered.stdout), 300)

    def test_a_disk_that_is_full_for_the_nwb_file_leaves_a_session_to_recover(self):
        with tempfile.TemporaryDirectory() as out:
            self.assertEqual(dihaptic("run", "scenes/block-on-table.yaml", "--out", out).returncode, 0)
            folder = session_of(out)
            whole = os.path.getsize(folder + "session.nwb")
            for share in [0, 0.001, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.97, 0.99, 0.999]:
                for name in MADE:
                    pathlib.Path(folder + name).unlink(missing_ok=True)
                limit = with_largest_file(int(whole * share))
                result = dihaptic("recover", folder, preexec_fn=limit)
                self.assertEqual(result.returncode, 2, f"{share} {result.returncode} {result.stderr}")
                self.assertIn("session.nwb: error: cannot be written: File too large", result.stderr)
                self.assertIn("'dihaptic recover " + folder.rstrip("/") + "'", result.stderr)
                self.assertFalse(glob.glob(folder + "session.nwb*"), share)
            recovered = dihaptic("recover", folder)
            self.assertEqual(recovered.returncode, 0, recovered.stderr)
            self.assertEqual(dihaptic("replay", folder).returncode, 0)


class Rehearsals(unittest.TestCase):
    """Populations of simulated people, in parts and in parallel."""

    PEOPLE = ["sim-001", "sim-002", "sim-003", "sim-004"]

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        text = pathlib.Path("experiments/rotation-reversal.yaml").read_text().replace("../", os.getcwd() + "/")
        for repeats in ["64", "160", "16", "48"]:
            text = text.replace("repeats: " + repeats, "repeats: 2")
        self.experiment = self.folder + "/short.yaml"
        pathlib.Path(self.experiment).write_text(text)

    def rehearse(self, out, *arguments):
        people = [] if "--people" in arguments else ["--people", "4"]
        return dihaptic("rehearse", self.experiment, *people, "--out", out, *arguments)

    def tables(self, *folders):
        out = tempfile.mkdtemp(dir=self.folder)
        result = dihaptic("collect", *folders, "--out", out)
        self.assertEqual(result.returncode, 0, result.stderr)
        return [pathlib.Path(out + "/" + name).read_bytes() for name in ["trials.csv", "people.csv"]]

    def rows(self, folder, name):
        with open(folder + "/" + name) as file:
            return list(csv.DictReader(file))

    def test_a_session_that_a_fault_ended_is_in_no_mean(self):
        out = self.folder + "/out"
        run = lambda *arguments: dihaptic("run", self.experiment, "--simulate", "--out", out, *arguments)
        self.assertEqual(run("--participant", "sim-001").returncode, 0)
        self.assertEqual(run("--participant", "sim-002", "--set", "safety.max_speed_m_s=0.1").returncode, 1)
        (ended,) = glob.glob(out + "/*sim-002/")
        self.assertIn("state: interrupted", pathlib.Path(ended + "session.yaml").read_text())
        report = dihaptic("report", out)
        self.assertEqual(report.returncode, 0, report.stderr)
        self.assertRegex(report.stdout, r"left out: .*sim-002: it ended before its trials were done; dihaptic resume goes on with it")
        self.assertEqual([row["ppid"] for row in self.rows(out, "population-people.csv")], ["sim-001"])

    def test_jobs_and_shards_give_the_same_tables_to_the_byte(self):
        whole = self.folder + "/whole"
        result = self.rehearse(whole)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("dihaptic collect " + whole, result.stdout)
        self.assertEqual(sorted(os.listdir(whole)), ["rehearsal.yaml", *self.PEOPLE])
        self.assertFalse(os.path.exists(whole + "/sim-001/raw.log"))
        parts = []
        for shard in ["1/3", "2/3", "3/3"]:
            parts.append(self.folder + "/part-" + shard[0])
            result = self.rehearse(parts[-1], "--shard", shard, "--jobs", "2")
            self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(sorted(os.listdir(parts[0])), ["rehearsal.yaml", "sim-001", "sim-004"])
        tables = self.tables(whole)
        self.assertEqual(tables, self.tables(*reversed(parts)))
        rows = list(csv.DictReader(tables[0].decode().splitlines()))
        self.assertEqual(sorted({row["ppid"] for row in rows}), self.PEOPLE)
        people = list(csv.DictReader(tables[1].decode().splitlines()))
        self.assertEqual([row["id"] for row in people], self.PEOPLE)
        self.assertEqual(len({row["slow_learning"] for row in people}), 4)

    def test_a_second_call_goes_on_with_those_that_are_missing(self):
        out = self.folder + "/out"
        self.assertEqual(self.rehearse(out).returncode, 0)
        before = self.tables(out)
        shutil.rmtree(out + "/sim-002")
        os.makedirs(out + "/unfinished-sim-003")  # as a kill leaves it
        shutil.rmtree(out + "/sim-003")
        kept = os.path.getmtime(out + "/sim-001/trials.csv")
        result = self.rehearse(out)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("2 to do, 2 done before", result.stdout)
        self.assertEqual(sorted(os.listdir(out)), ["rehearsal.yaml", *self.PEOPLE])
        self.assertEqual(os.path.getmtime(out + "/sim-001/trials.csv"), kept)
        self.assertEqual(self.tables(out), before)

    def test_tells_of_sessions_that_failed(self):
        out = self.folder + "/out"
        result = dihaptic("rehearse", self.experiment, "--people", "2", "--out", out, "--keep-recordings",
                          preexec_fn=with_largest_file(500_000))
        self.assertEqual(result.returncode, 1)
        self.assertIn("sim-001: failed.", result.stderr)
        self.assertIn("cannot be written", result.stderr)
        self.assertIn("the same command goes on with those", result.stdout)
        self.assertEqual(self.rehearse(out).returncode, 0)

    def test_refuses_a_folder_of_another_experiment_seed_or_population(self):
        out = self.folder + "/out"
        self.assertEqual(self.rehearse(out, "--people", "1").returncode, 0)
        text = pathlib.Path(self.experiment).read_text()
        edited = self.folder + "/edited.yaml"
        pathlib.Path(edited).write_text(text.replace("angle_deg: 30", "angle_deg: 60"))
        changed = self.folder + "/population.yaml"
        pathlib.Path(changed).write_text(f"title: Others\nbased_on: {os.getcwd()}/populations/adults.yaml\n")
        for arguments, message in [
                ([edited], "another rehearsal: inputs, task.yaml, perturbations, 1, visual, angle_rad: 0.523"),
                ([self.experiment, "--seed", "9"], "another rehearsal: seed: 1 there, 9 now"),
                ([self.experiment, "--population", changed], "another rehearsal: population, title"),
                ([self.experiment, "--real-objects"], "another rehearsal: population, title")]:
            result = dihaptic("rehearse", *arguments, "--people", "2", "--out", out)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(message, result.stderr)
            self.assertEqual(sorted(os.listdir(out)), ["rehearsal.yaml", "sim-001"])
        # comments make no difference
        pathlib.Path(self.experiment).write_text("# the same\n" + text)
        self.assertEqual(self.rehearse(out, "--people", "2").returncode, 0)
        os.remove(out + "/rehearsal.yaml")
        result = self.rehearse(out)
        self.assertEqual(result.returncode, 2)
        self.assertIn("does not say what it is a rehearsal of", result.stderr)

    def test_collect_joins_seeds_on_purpose_only(self):
        folders = [self.folder + "/one", self.folder + "/nine"]
        for folder, seed in zip(folders, ["1", "9"]):
            self.assertEqual(self.rehearse(folder, "--people", "2", "--seed", seed).returncode, 0)
        both = self.folder + "/both"
        result = dihaptic("collect", *folders, "--out", both)
        self.assertEqual(result.returncode, 2)
        self.assertIn("is another rehearsal than " + folders[0] + ": seed: 1 there, 9 now", result.stderr)
        self.assertIn("--join-seeds", result.stderr)
        result = dihaptic("collect", *folders, "--join-seeds", "--out", both)
        self.assertEqual(result.returncode, 0, result.stderr)
        for name in ["trials.csv", "people.csv", "adaptation.csv"]:
            rows = self.rows(both, name)
            self.assertEqual({(row["seed"], row["id"]) for row in rows},
                             {(seed, person) for seed in "19" for person in self.PEOPLE[:2]}, name)
            self.assertEqual({(row["simulated"], row["moved_by"]) for row in rows}, {("yes", "simulated_person")}, name)
        pathlib.Path(self.experiment).write_text(
            pathlib.Path(self.experiment).read_text().replace("angle_deg: 30", "angle_deg: 60"))
        other = self.folder + "/other"
        self.assertEqual(self.rehearse(other, "--people", "1", "--seed", "5").returncode, 0)
        result = dihaptic("collect", folders[0], other, "--join-seeds", "--out", both)
        self.assertEqual(result.returncode, 2)
        self.assertIn("angle_rad", result.stderr)

    def test_people_are_drawn_from_a_file_of_groups(self):
        population = self.folder + "/groups.yaml"
        pathlib.Path(population).write_text(f"""title: Two groups
based_on: {os.getcwd()}/populations/adults.yaml
groups:
  - {{ name: control }}
  - name: patients
    traits:
      - {{ trait: slow_retention, median: 0.9, spread: 0, source: a guess }}
""")
        out = self.folder + "/out"
        self.assertEqual(self.rehearse(out, "--population", population).returncode, 0)
        self.assertEqual(dihaptic("collect", out).returncode, 0)
        people = self.rows(out, "people.csv")
        self.assertEqual([row["group"] for row in people], ["control", "patients"] * 2)
        self.assertEqual([row["slow_retention"] == "0.9" for row in people], [False, True] * 2)
        self.assertEqual({(row["id"], row["group"]) for row in self.rows(out, "trials.csv")},
                         {(row["id"], row["group"]) for row in people})

    def test_collect_brings_lifts_and_thresholds(self):
        text = pathlib.Path("experiments/visual-scaling.yaml").read_text().replace("../", os.getcwd() + "/")
        text = text.replace("trials: 25", "trials: 12").replace(
            "procedures: [more along x, less along x, more along y, less along y, more along z, less along z]",
            "procedures: [more along x]")
        file = self.folder + "/scaling.yaml"
        pathlib.Path(file).write_text(text)
        out = self.folder + "/out"
        result = dihaptic("rehearse", file, "--people", "1", "--out", out)
        self.assertEqual(result.returncode, 0, result.stderr)
        result = dihaptic("collect", out)
        self.assertEqual(result.returncode, 0, result.stderr)
        asked = [row["procedure"] for row in self.rows(out, "thresholds.csv") if row["trials"] != "0"]
        self.assertEqual(asked, ["more along x"])
        self.assertGreaterEqual(len(self.rows(out, "lifts.csv")), 12)

    def test_a_session_that_nothing_ends_says_so(self):
        text = pathlib.Path(self.experiment).read_text()
        text = text.replace("        - { when: time, hold_s: 2, outcome: too slow, redo: yes, feedback: "
                            '"Too slow: reach faster" }\n', "")
        text = text.replace("radius_mm: 90 }", "radius_mm: 900 }")
        pathlib.Path(self.experiment).write_text(text)
        self.assertIn("reach: waits for ever", dihaptic("check", self.experiment).stdout)
        result = dihaptic("rehearse", self.experiment, "--people", "1", "--out", self.folder + "/out")
        self.assertEqual(result.returncode, 1)
        self.assertIn("never ended 'reach' of trial 1", result.stderr)

    def test_refuses_what_cannot_be(self):
        for arguments, message in [(["rehearse", self.experiment, "--shard", "4/3"], "--shard: error: 4/3: is no part"),
                                   (["rehearse", "experiments/lift-block.yaml"], "has no trials that people could do"),
                                   (["collect", self.folder], "has no complete session"),
                                   (["run", self.experiment, "--real-objects"], "requires --simulate")]:
            result = dihaptic(*arguments)
            self.assertNotEqual(result.returncode, 0)
            self.assertIn(message, result.stderr)


class SessionFiles(unittest.TestCase):
    """What stands in the place of a session's file: each command says file and remedy, and ends."""

    REACHES = """title: Two reaches
scene: scene.yaml
hand: { centre_mm: [0, 0, 120] }
task:
  regions:
    - { name: start, position_mm: [0, 0, 120], radius_mm: 6 }
    - { name: target, position_mm: [50, 0, 120], radius_mm: 6 }
  states:
    - name: home
      show: [start]
      exits: [{ when: inside, region: start, hold_s: 0.1, to: reach }]
      hand: [{ duration_s: 0.2, reach: start }]
    - name: reach
      show: [target]
      exits: [{ when: inside, region: target, outcome: reached }]
      hand: [{ duration_s: 0.2, reach: target }]
  reach: { from: start, to: target, during: reach, distance_mm: 30, axis: [0, 0, 1] }
  blocks: [{ name: all, kind: baseline, repeats: 2 }]
"""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.out = folder.name
        pathlib.Path(folder.name + "/scene.yaml").write_text(
            "bodies:\n  - { name: floor, shape: plane, fixed: yes }\n"
            "fingers:\n  - { name: index, shape: sphere, radius_mm: 6, mass_g: 1 }\n")
        pathlib.Path(folder.name + "/reaches.yaml").write_text(cls.REACHES)
        result = dihaptic("run", folder.name + "/reaches.yaml", "--participant", "S07", "--out", folder.name + "/out")
        assert result.returncode == 0, result.stderr
        cls.made = session_of(folder.name + "/out").rstrip("/")
    def copy(self):
        copy = self.out + "/copy"
        shutil.rmtree(copy, ignore_errors=True)
        shutil.rmtree(self.out + "/study", ignore_errors=True)
        return shutil.copytree(self.made, copy)

    def replace(self, file, kind):
        text = b""
        if os.path.exists(file):
            text = pathlib.Path(file).read_bytes()
            os.remove(file)
        if kind == "pipe":
            os.mkfifo(file)
        elif kind == "device":
            os.symlink("/dev/zero", file)
        elif kind == "folder":
            os.mkdir(file)
        elif kind == "loop":
            os.symlink(os.path.basename(file), file)
        elif kind == "empty":
            pathlib.Path(file).write_text("")
        elif kind == "large":
            pathlib.Path(file).touch()
            os.truncate(file, 600_000_000)
        elif kind == "cut":
            pathlib.Path(file).write_bytes(text[:len(text) * 6 // 10])

    def commands(self, session):
        return [["recover", session], ["resume", session, "--out", self.out + "/resumed"], ["replay", session],
                ["report", session], ["export", session, "--bids", self.out + "/study"]]

    def test_no_command_hangs_or_crashes_on_what_is_no_file(self):
        # by file: which commands cannot do without it
        needed = {"raw.log": ["recover", "resume", "replay", "report", "export"],
                  "session.yaml": ["report", "export"],
                  "scene.yaml": ["replay", "resume"], "settings.yaml": ["replay", "resume"],
                  "task.yaml": ["resume"], "trial-list.csv": ["recover", "resume"], "trials.csv": ["resume", "report"],
                  "session.nwb": [], "settings.csv": ["report"], "events.csv": ["export"], "shown.csv": ["recover"]}
        for file, commands in needed.items():
            for kind in ["pipe", "device", "folder", "loop", "large", "empty", "gone", "cut"]:
                if (file, kind) in [("shown.csv", "cut"), ("raw.log", "large"), ("session.nwb", "large")]:
                    continue
                for name in commands or ["recover"]:
                    session = self.copy()
                    self.replace(session + "/" + file, kind)
                    (command,) = [command for command in self.commands(session) if command[0] == name]
                    where = f"{name} with {file}: {kind}"
                    result = subprocess.run([PROGRAM, *command], capture_output=True, text=True, timeout=60)
                    self.assertIn(result.returncode, [0, 1, 2], where + result.stderr)
                    self.assertNotIn("report this", result.stderr, where)
                    if commands and kind in ["pipe", "device", "folder", "loop", "large"]:
                        self.assertEqual(result.returncode, 2, where + result.stdout + result.stderr)
                        self.assertRegex(result.stderr, rf"{file}[^\n]*: error: [^\n]*[a-z)]\. [A-Z]", where)

    def test_an_empty_list_or_table_is_an_error_with_a_remedy(self):
        session = self.copy()
        self.replace(session + "/trial-list.csv", "empty")
        result = dihaptic("recover", session)
        self.assertEqual(result.returncode, 2, result.stdout)
        self.assertIn("trial-list.csv: error: is empty", result.stderr)
        session = self.copy()
        self.replace(session + "/trials.csv", "empty")
        result = dihaptic("resume", session)
        self.assertEqual(result.returncode, 2, result.stdout)
        self.assertIn("trials.csv: error: is empty. Make it anew from raw.log: dihaptic recover", result.stderr)
        self.assertEqual(dihaptic("recover", session).returncode, 0)
        self.assertIn("is complete: every trial is done", dihaptic("resume", session).stderr)
        session = self.copy()
        info = pathlib.Path(session + "/session.yaml")
        info.write_text(re.sub(r"seed: \S+", "seed: many", info.read_text()))
        result = dihaptic("resume", session)
        self.assertEqual(result.returncode, 2, result.stdout)
        self.assertIn("session.yaml: error: seed: is no whole number", result.stderr)

    def test_pictures_and_collections_take_files_only(self):
        for file in ["raw.log", "scene.yaml", "rig.yaml"]:
            for kind in ["pipe", "device", "folder", "loop", "empty", "gone"]:
                session = self.copy()
                self.replace(session + "/" + file, kind)
                for command in [["picture", session, "-o", self.out + "/x.png"], ["video", session, "-o", self.out + "/x.mp4"]]:
                    result = subprocess.run([PROGRAM, *command, "--size", "64x48"], capture_output=True, text=True, timeout=60)
                    self.assertEqual(result.returncode, 2, f"{command} {file} {kind} " + result.stderr)
                    self.assertNotIn("report this", result.stderr)
        os.makedirs(self.out + "/people/sim-001", exist_ok=True)
        pathlib.Path(self.out + "/people/rehearsal.yaml").write_text("program: any\nexperiment: any\nseed: 1\n")
        for kind in ["pipe", "device", "folder", "loop", "empty", "gone"]:
            for file in ["trials.csv", "person.yaml"]:
                for name in ["trials.csv", "person.yaml"]:
                    there = self.out + "/people/sim-001/" + name
                    shutil.rmtree(there) if os.path.isdir(there) else os.path.lexists(there) and os.remove(there)
                    pathlib.Path(there).write_text("id: S07\n" if name == "person.yaml" else "outcome\nreached\n")
                self.replace(self.out + "/people/sim-001/" + file, kind)
                result = subprocess.run([PROGRAM, "collect", self.out + "/people"], capture_output=True, text=True, timeout=60)
                self.assertEqual(result.returncode, 2, file + kind + result.stderr)
                # without person.yaml, or with an empty one, it is no session of a simulated person
                self.assertRegex(result.stderr, f"{file}|session.yaml|no complete session")
                self.assertNotIn("report this", result.stderr)

    def test_a_killed_export_leaves_no_run_that_looks_whole(self):
        random.seed(3)
        start = time.monotonic()
        self.assertEqual(dihaptic("export", self.made, "--bids", self.out + "/whole").returncode, 0)
        duration = time.monotonic() - start
        motion = glob.glob(self.out + "/whole/sub-S07/motion/*run-01_motion.tsv")[0]
        size = os.path.getsize(motion)
        study = self.out + "/killed"
        for _ in range(int(os.environ.get("DIHAPTIC_KILLS", 12))):
            process = subprocess.Popen([PROGRAM, "export", self.made, "--bids", study], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(random.uniform(0, duration))
            process.kill()
            process.wait()
            for file in glob.glob(study + "/sub-S07/motion/*"):
                self.assertEqual(os.path.getsize(file), os.path.getsize(file.replace(study, self.out + "/whole").replace(
                    re.search(r"run-\d+", file).group(0), "run-01")), file)
            if glob.glob(study + "/sub-S07/motion/*run-01_motion.tsv"):
                shutil.rmtree(study)
        self.assertEqual(dihaptic("export", self.made, "--bids", study).returncode, 0)
        names = os.listdir(study + "/sub-S07/motion")
        self.assertEqual(sorted(names), sorted(os.listdir(self.out + "/whole/sub-S07/motion")))
        self.assertEqual(sorted(os.listdir(study + "/sub-S07")), sorted(os.listdir(self.out + "/whole/sub-S07")))
        self.assertEqual(os.path.getsize(motion.replace(self.out + "/whole", study)), size)
        self.assertEqual([name for name in os.listdir(study + "/sub-S07/motion") + os.listdir(study) if "part" in name and not name.startswith("participants.")
                          or name.startswith(".")], [])

    def test_what_a_killed_video_leaves_is_gone_after_the_next(self):
        with tempfile.TemporaryDirectory() as folder:
            command = [PROGRAM, "video", "scenes/block-on-table.yaml", "--size", "64x48", "-o", folder + "/v.mp4"]
            process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
            process.stderr.readline()  # it has begun
            while not os.listdir(folder):
                time.sleep(0.01)
            process.kill()
            process.communicate()
            (left,) = os.listdir(folder)
            self.assertTrue(left.endswith(".part"), left)
            other = pathlib.Path(folder + "/v.mp4.1.part")  # of a program that lives
            other.write_text("")
            self.assertEqual(subprocess.run(command, capture_output=True).returncode, 0)
            self.assertEqual(sorted(os.listdir(folder)), ["v.mp4", "v.mp4.1.part"])


if __name__ == "__main__":
    unittest.main(verbosity=2)
