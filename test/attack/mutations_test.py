"""Files of each kind with bytes and words changed, cut, doubled or exchanged: each is read, or refused by its name.

Usage: attack/mutations_test.py PROGRAM, from the project's folder. The soak tries 10,000 of each kind.
"""
import glob
import os
import pathlib
import random
import re
import shutil
import subprocess
import struct
import sys
import tempfile
import unittest
import wave

sys.path.append("test/cli")
from program import PROGRAM, dihaptic, patient
import soak  # program.py adds its folder to the path

EACH = soak.of(40, 10_000)
EACH_SESSION = soak.of(10, 2_000)
BATCH = 50
#: Processor time that reading a file may take [s].
LONGEST = patient(2)
#: What the program prints about a file begins with its name.
LINE = re.compile(r"^(?P<file>/[^:]+):(?P<line>\d+:)? ", re.MULTILINE)


def spent():
    """Processor time of all programs that have ended [s]."""
    return sum(os.times()[2:4])


def mutated(chosen, content):
    """One to three changes of bytes, or of words of a text."""
    out = bytearray(content)
    for _ in range(chosen.randrange(1, 4)):
        at, end = sorted(chosen.randrange(len(out) + 1) for _ in range(2))
        end = min(end, at + chosen.choice([1, 4, 30, 300]))
        other = chosen.randrange(len(out) + 1)
        piece = out[other:other + chosen.choice([1, 4, 30])]
        change = chosen.randrange(6)
        if change == 0:
            out[at:end] = b""
        elif change == 1:
            out[at:at] = piece
        elif change == 2:
            out[at:end] = piece
        elif change == 3:
            out[at:at + 1] = bytes([chosen.randrange(256)])
        elif change == 4:
            out[at:at] = chosen.choice([b"-1", b"1e308", b"nan", b"{", b"[", b"&a", b"*a", b": ", b"\n", b"\"", b",,,", b"\0"])
        else:
            out = out[:max(1, at)]
    return bytes(out) or b"\n"


def task_of(more, state=""):
    """An experiment with a task that needs no hand."""
    return (f"{more}task:\n  states: [{{{{ name: go, {state} exits: [{{{{ when: time, after_s: 0.1, outcome: done }}}}] }}}}]\n"
            "  blocks: [{{ name: all, kind: baseline, repeats: 1 }}]\n")


class Attack(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.chosen = random.Random(int(os.environ.get("DIHAPTIC_SEED", 20261126)))
        self.environment = {**os.environ, "XDG_CACHE_HOME": self.folder + "/cache", "XDG_CONFIG_HOME": self.folder + "/config"}
        os.makedirs(self.folder + "/cache")

    def do(self, *arguments):
        """Runs a command; returns what it said and how it ended."""
        result = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, errors="replace",
                                timeout=patient(600), env=self.environment)
        told = result.stdout + result.stderr
        self.assertIn(result.returncode, (0, 1, 2), told[-2000:])
        self.assertNotIn("Please report", told)
        return told, result.returncode

    def check(self, files, longest=LONGEST):
        """Checks files; returns what was said. `longest`: the time that one may take [s]."""
        before = spent()
        told, _ = self.do("check", *files)
        if spent() - before > longest and len(files) > 1:
            for file in files:
                self.check([file], longest)
        elif len(files) == 1:
            self.assertLess(spent() - before, longest, pathlib.Path(files[0]).read_bytes()[:5000])
        return told

    def write(self, name, content):
        path = pathlib.Path(self.folder, name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return str(path)


class Mutations(Attack):

    def try_all(self, kinds, name, scene_of=None, has_checksums=False, longest=LONGEST, each=EACH):
        """`kinds`: files to begin with. `scene_of`: what names such a file; it is checked in the file's place."""
        here = os.getcwd().encode() + b"/"
        contents = [pathlib.Path(file).read_bytes() for file in kinds]
        if name.endswith(".yaml"):
            contents = [content.replace(b"../", here).replace(b"based_on: ", b"based_on: " + here + b"populations/")
                        for content in contents]
        refused = 0
        for batch in range(0, each, BATCH):
            place = pathlib.Path(tempfile.mkdtemp(dir=self.folder))
            files = []
            for n in range(min(BATCH, each - batch)):
                content = mutated(self.chosen, self.chosen.choice(contents))
                file = place / name.replace("*", str(n))
                file.write_bytes(content)
                if scene_of is not None:
                    scene = place / f"of-{n}.yaml"
                    scene.write_text(scene_of(file.name))
                    file = scene
                files.append(str(file))
            told = self.check(files, longest)
            for file in files:
                number = re.search(r"(\d+)\.\w+$", file)[1]
                about = [line for line in told.splitlines() if line.startswith(file) or f"/{name.replace('*', number)}" in line]
                self.assertTrue(about, f"nothing was said of {file}: {told[-500:]}")
                refused += any(": error: " in line for line in about)
            shutil.rmtree(place)
        self.assertGreater(refused, each // 20)
        if not has_checksums:
            self.assertLess(refused, each, "no file was read: the first ones are wrong")
        print(f"{name}: {each}, {refused} refused")

    def test_yaml(self):
        for kind in ("scenes", "experiments", "rigs", "populations"):
            with self.subTest(kind):
                files = glob.glob(kind + "/*.yaml")
                self.try_all(files, kind + "-*.yaml")

    def test_movements(self):
        self.try_all(glob.glob("movements/*.csv")[:4], "movement-*.csv")

    def test_meshes(self):
        scene = "bodies: [{{name: floor, shape: plane, fixed: yes}}, {{name: b, shape: mesh, file: {}, unit: mm, mass_g: 10}}]\n"
        corners = [(0, 0, 0), (40, 0, 0), (0, 40, 0), (0, 0, 40)]
        faces = [[corners[i] for i in face] for face in ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))]
        binary = bytes(80) + struct.pack("<I", len(faces))
        text = "solid block\n"
        for face in faces:
            binary += struct.pack("<12fH", 0, 0, 0, *(x for corner in face for x in corner), 0)
            text += "facet normal 0 0 0\nouter loop\n" + "".join("vertex {} {} {}\n".format(*c) for c in face) + "endloop\nendfacet\n"
        stl = [self.write("binary.stl", binary), self.write("text.stl", text + "endsolid block\n")]
        off = [self.write("block.off", "OFF\n4 4 6\n0 0 0\n40 0 0\n0 40 0\n0 0 40\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n")]
        for files in (["meshes/pad.obj"], ["meshes/apple.ply"], stl[:1], stl[1:], off):
            with self.subTest(files=files):
                # the reader of meshes has its own limit of 2 s; a mesh whose header claims millions of faces reaches it
                self.try_all(files, "mesh-*" + os.path.splitext(files[0])[1], scene.format, longest=patient(4), each=soak.of(10, EACH))

    def test_sounds(self):
        """Ogg has a checksum of each page, FLAC of each frame: few files of these can be read."""
        experiment = task_of(f"scene: {os.path.abspath('scenes/reach-in-space.yaml')}\n", "sounds: s,").replace(
            "task:\n", "task:\n  sounds: [{{ name: s, file: {} }}]\n")
        with wave.open(self.folder + "/s.wav", "wb") as file:
            file.setnchannels(1)
            file.setsampwidth(2)
            file.setframerate(8000)
            file.writeframes(struct.pack("<400h", *(self.chosen.randrange(-9000, 9000) for _ in range(400))))
        for kind in ("wav", "flac", "ogg"):
            name = f"{self.folder}/s.{kind}"
            if kind != "wav":
                subprocess.run(["ffmpeg", "-v", "error", "-i", self.folder + "/s.wav", *(["-c:a", "libvorbis"] if kind == "ogg" else []),
                                name], check=True)
            with self.subTest(kind):
                self.try_all([name], "sound-*." + kind, experiment.format, has_checksums=kind != "wav")

    def test_tables_of_paths(self):
        scene = self.write("scene.yaml", "bodies: [{name: p, shape: box, size_mm: [9, 9, 9], driven: yes}]\n"
                                         "fingers: [{name: index, shape: sphere, radius_mm: 6, mass_g: 1}]\n")
        table = "time_s,z_mm,y_mm\n" + "".join(f"{i / 10},{i * i / 7:.3f},{30 - i}\n" for i in range(30))
        self.try_all([self.write("path.csv", table)], "path-*.csv",
                     task_of(f"scene: {scene}\n", "drive: [{{ body: p, path: {{ file: {} }} }}],").format)

    def test_calibrations(self):
        rig = pathlib.Path("rigs/premium-misplaced.yaml").read_text()
        told, code = self.do("calibrate", self.write("rig.yaml", rig), "--out", self.folder + "/made.yaml")
        self.assertEqual(code, 0, told)
        braces = rig.replace("{", "{{").replace("}", "}}")
        self.try_all([self.folder + "/made.yaml"], "calibration-*.yaml", ("calibration: {}\n" + braces).format)

    def test_allowed_libraries(self):
        """Each is read for the rig that an experiment names, which somebody else wrote."""
        library = self.write("libours.so", b"no library")
        other = self.write("libtheirs.so", b"no library")
        self.write("rig.yaml", pathlib.Path("rigs/ideal-pair.yaml").read_text() + "outlets:\n" +
                   "".join(f"  - {{ kind: lsl, options: {{ library: {name} }} }}\n" for name in (library, other)))
        experiment = self.write("e.yaml", f"scene: {os.path.abspath('scenes/block-on-table.yaml')}\nrig: rig.yaml\n")
        mine = f"- /usr/lib/libours.so\n- {library}\n- \"{other}\"\n"
        taken = 0
        for _ in range(EACH):
            self.write("config/dihaptic/libraries.yaml", mutated(self.chosen, mine.encode()))
            told = self.check([experiment])
            self.assertRegex(told, r"/(libraries|rig|e)\.yaml(:\d+)?: ")
            taken += "warning: " not in told
        self.assertGreater(taken, 0)
        print(f"libraries.yaml: {EACH}, {EACH - taken} refused")

    def test_pictures(self):
        scene = ("bodies: [{{name: floor, shape: plane, fixed: yes}}, {{name: b, shape: box, size_mm: [9, 9, 9], mass_g: 10, "
                 "picture: {{file: {}, width_mm: 20}}}}]\n")
        self.try_all(glob.glob("textures/*.png")[:3], "picture-*.png", scene.format, has_checksums=True)

class Sessions(Attack):
    """Recorded sessions with one mutated file, and what each command says about them."""

    def setUp(self):
        super().setUp()
        text = pathlib.Path("experiments/rotation-reversal.yaml").read_text().replace("../", os.getcwd() + "/")
        experiment = self.write("short.yaml", re.sub(r"repeats: (64|160|16|48)\b", "repeats: 1", text))
        self.assertEqual(self.do("run", experiment, "--simulate", "--participant", "S01", "--out", self.folder + "/out")[1], 0)
        (self.session,) = pathlib.Path(self.folder, "out").iterdir()
        self.assertEqual(self.do("rehearse", experiment, "--people", "2", "--out", self.folder + "/r")[1], 0)

    def try_all(self, whole, names, commands):
        """Mutates one of the files `names` of the folder `whole`, and gives it to `commands`, which end in time."""
        refused = {}
        for _ in range(EACH_SESSION):
            name = self.chosen.choice(names)
            copy = pathlib.Path(self.folder, "copy")
            shutil.copytree(whole, copy)
            (copy / name).write_bytes(mutated(self.chosen, (whole / name).read_bytes()))
            for command in commands:
                before = spent()
                told, code = self.do(*command.split(), copy)
                about = f"{command}, {name}: {told[:3000]}"
                self.assertLess(spent() - before, LONGEST, about)
                if code == 2:
                    self.assertIn(os.path.basename(name), told, about)
                refused[command] = refused.get(command, 0) + (code != 0)
            shutil.rmtree(copy)
        print(f"{EACH_SESSION} sessions, of these not as they were by", refused)

    def test_sessions(self):
        names = ["session.yaml", "raw.log", "trials.csv"] * 4 + [path.name for path in self.session.iterdir()]
        self.try_all(self.session, [name for name in names if name != "session.nwb"], ["replay", "report --tables", "recover"])

    def test_rehearsals(self):
        folder = pathlib.Path(self.folder, "r")
        names = [str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()]
        names = [name for name in names if "session.nwb" not in name]
        self.try_all(folder, names + ["rehearsal.yaml", "sim-001/trials.csv", "sim-001/session.yaml"] * 4, ["collect", "report --tables"])


if __name__ == "__main__":
    unittest.main()
