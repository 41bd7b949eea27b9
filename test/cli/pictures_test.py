"""Pictures and videos of scenes and sessions.

Usage: pictures_test.py PROGRAM, from the project's folder.
"""
import os
import pathlib
import re
import shutil
import signal
import subprocess
import tempfile
import unittest

from program import PROGRAM, dihaptic, patient, session_of


class Commands(unittest.TestCase):
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

    def test_a_session_keeps_what_its_bodies_look_like(self):
        with tempfile.TemporaryDirectory() as folder:
            file = folder + "/looks.png"
            small = ["--size", "96x64", "-o", file]
            for name in ("scenes", "textures", "meshes"):
                os.mkdir(f"{folder}/{name}")
            for name in ("scenes/looks.yaml", "textures/wood.png", "textures/checker.png", "meshes/apple.ply"):
                shutil.copy(name, f"{folder}/{name}")
            self.assertEqual(dihaptic("picture", folder + "/scenes/looks.yaml", *small).returncode, 0)
            looks = pathlib.Path(file).read_bytes()
            self.assertEqual(dihaptic("run", folder + "/scenes/looks.yaml", "--out", folder + "/out").returncode, 0)
            for name in ("scenes", "textures", "meshes"):
                shutil.rmtree(f"{folder}/{name}")
            session = session_of(folder + "/out")
            result = dihaptic("picture", session, "--time", "0", *small)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(pathlib.Path(file).read_bytes(), looks)
            self.assertEqual(dihaptic("replay", session).returncode, 0)
            shutil.copy("textures/braille.png", session + "/picture-1-wood.png")
            self.assertIn("picture-1-wood.png", dihaptic("replay", session).stderr)

    def test_a_path_is_the_fingers_where_there_is_no_object(self):
        with tempfile.TemporaryDirectory() as folder:
            file = folder + "/reach.png"
            reach = ["picture", "scenes/reach-in-space.yaml", "--time", "0.5", "--size", "192x128", "-o", file]
            self.assertEqual(dihaptic(*reach).returncode, 0)
            bare = pathlib.Path(file).read_bytes()
            self.assertEqual(dihaptic(*reach, "--show", "path").returncode, 0)
            self.assertNotEqual(pathlib.Path(file).read_bytes(), bare)

    def test_pictures_that_cannot_be_say_why_and_leave_nothing(self):
        scene = "scenes/block-on-table.yaml"
        with tempfile.TemporaryDirectory() as folder:
            file = folder + "/x.png"
            for arguments, told in [(["--camera", "below"], "there is no camera 'below'. Available cameras: close, front, above, side"),
                                    (["--time", "99"], "--time: error: 99 s is beyond the end, which is at 3"),
                                    (["--size", "99"], "'99' is not a valid picture size. Give width and height in pixels"),
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
            self.assertIn("a video cannot have the size 65x48. Give an even width and height", result.stderr)
            result = dihaptic("video", "scenes/block-on-table.yaml", "--size", "64x48", "-o", folder + "/none/x.mp4")
            self.assertEqual(result.returncode, 2)
            self.assertIn("/none/x.mp4: error: cannot be written: No such file or directory", result.stderr)
            for signal_ in (signal.SIGINT, signal.SIGTERM):
                process = subprocess.Popen([PROGRAM, *command], stderr=subprocess.PIPE, text=True)
                process.stderr.readline()  # waits until it has begun
                process.send_signal(signal_)
                self.assertIn("interrupted: nothing more was written", process.communicate(timeout=patient(60))[1])
                self.assertEqual(process.returncode, 1)
            self.assertEqual(os.listdir(folder), [])


if __name__ == "__main__":
    unittest.main(verbosity=2)
