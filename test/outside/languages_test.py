"""Python's world, in a program that speaks a language with decimal commas. docs/outside.md has the sources.

Usage: outside/languages_test.py PROGRAM, from the project's folder.
"""
import os
import subprocess
import sys
import tempfile
import unittest

sys.path += ["test", "test/cli"]
import needs
from locales import COMMAS, with_language
from program import PROGRAM, patient

PYTHON = os.path.join(os.path.dirname(os.path.abspath(PROGRAM)), "python")
#: Reads meshes of each format, textures, draws and a movement: everything that contains numbers as text.
SCRIPT = """
import locale, pathlib, sys
sys.path.insert(0, sys.argv[1])
if sys.argv[2] != "C":
    locale.setlocale(locale.LC_ALL, sys.argv[2] + ".UTF-8")
    assert locale.localeconv()["decimal_point"] == ","
import dihaptic as dh
folder = pathlib.Path(sys.argv[3])
corners = [(x, y, z) for x in (-0.5, 12.25) for y in (-0.5, 9.75) for z in (-0.5, 7.125)]
faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
lines = [" ".join(map(str, corner)) for corner in corners]
(folder / "box.obj").write_text("mtllib box.mtl\\nusemtl red\\n" + "".join(f"v {line}\\n" for line in lines)
                                + "".join("f " + " ".join(str(i + 1) for i in face) + "\\n" for face in faces))
(folder / "box.mtl").write_text("newmtl red\\nKd 0.75 0.25 0.125\\n")
(folder / "box.off").write_text("OFF\\n8 6 12\\n" + "".join(line + "\\n" for line in lines)
                                + "".join("4 " + " ".join(map(str, face)) + "\\n" for face in faces))
(folder / "box.ply").write_text("ply\\nformat ascii 1.0\\nelement vertex 8\\nproperty double x\\nproperty double y\\nproperty double z\\n"
                                "element face 6\\nproperty list uchar int vertex_indices\\nend_header\\n" + "".join(line + "\\n" for line in lines)
                                + "".join("4 " + " ".join(map(str, face)) + "\\n" for face in faces))
(folder / "box.stl").write_text("solid box\\n" + "".join(
    "facet normal 0 0 0\\nouter loop\\n" + "".join(f"vertex {lines[i]}\\n" for i in three) + "endloop\\nendfacet\\n"
    for a, b, c, d in faces for three in ((a, b, c), (a, c, d))) + "endsolid box\\n")
for name in ("box.obj", "box.off", "box.ply", "box.stl"):
    for concave in (False, True):
        box = dh.Part(name="box", shape="mesh", file=str(folder / name), unit="mm", mass_g=1.5, concave=concave, position_mm=[0, 0, 2.5])
        hand = dh.Part(centre_mm=[0, 0, 2000], aperture_mm=400, script=[dh.Part(name="wait", duration_s=1)])
        floor = dh.Part(name="floor", shape="plane", fixed=True)
        world = dh.World(dh.Scene(title="boxes", bodies=[floor, box], object="box", hand=hand))
        world.step(200)
        print(name, concave, [repr(float(x)) for x in world.bodies["box"].position])
scene = dh.Scene.load("scenes/block-on-table.yaml")
scene.bodies[1].mass_g = 100.5
print(scene)
print(dh.read_table("movements/reach-to-grasp.csv").iloc[7].to_dict())
for file in ("movements/reach-to-grasp.csv", "experiments/first-trials.yaml", "experiments/curl-field.yaml"):
    print([problem.text() for problem in dh.check(file)])
"""


class Languages(unittest.TestCase):
    def said(self, name, environment):
        with tempfile.TemporaryDirectory() as folder:
            result = subprocess.run(["/usr/bin/python3", "-c", SCRIPT, PYTHON, name, folder], env=environment, capture_output=True,
                                    text=True, timeout=patient(300))
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def test_python_reads_and_computes_the_same(self):
        usual = self.said("C", dict(os.environ))
        self.assertIn("mass_g: 100.5", usual)
        for name in COMMAS:
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                environment = with_language(name, folder)
                if environment is None:
                    needs.skip(f"the language {name} cannot be made: localedef and its sources are in the Debian package locales")
                self.assertEqual(self.said(name, environment), usual)


if __name__ == "__main__":
    unittest.main(verbosity=1)
