"""Meshes as people bring them: each is felt as it is drawn, or refused with the reason. docs/outside.md has the sources.

Usage: outside/meshes_test.py PROGRAM, from the project's folder.
"""
import glob
import math
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

import numpy
from scipy.spatial import ConvexHull

sys.path += ["test/cli", "test/outside"]
import made_meshes as made
from program import PROGRAM, patient
import soak  # program.py adds its folder to the path

PROGRAM = os.path.abspath(PROGRAM)
COUNT = soak.of(14, 300)  # number of made meshes
CUBE = made.box((-20, -20, -20), (20, 20, 20))


def scene(mesh, unit="mm", concave="yes"):
    return (f"bodies:\n  - {{ name: thing, shape: mesh, file: {mesh}, unit: {unit}, concave: {concave}, "
            "density_g_cm3: 1 }\n")


def pieces(file):
    """The vertices of each piece in a kept file [mm]."""
    out = []
    for line in pathlib.Path(file).read_text().splitlines():
        word, *rest = line.split()
        if word == "piece":
            out.append([])
        elif len(rest) == 2 and out:
            out[-1].append([1e3 * float(n) for n in (word, *rest)])
    return [numpy.array(piece) for piece in out]


class Meshes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def check(self, name, content, locale="C", **more):
        """Returns (messages, volume of the pieces or None if the mesh is refused)."""
        (self.folder / name).write_bytes(content)
        (self.folder / "scene.yaml").write_text(scene(name, **more))
        cache = tempfile.mkdtemp(dir=self.folder)
        result = subprocess.run([PROGRAM, "check", "scene.yaml"], cwd=self.folder, capture_output=True, text=True,
                                env=os.environ | {"XDG_CACHE_HOME": cache, "LC_ALL": locale}, timeout=patient(120))
        said = result.stdout + result.stderr
        self.assertIn(result.returncode, (0, 2), said)
        if result.returncode != 0:
            return said, None
        if more.get("concave") == "no":
            return said, math.nan
        (kept,) = glob.glob(cache + "/dihaptic/pieces/*")
        return said, sum(ConvexHull(piece).volume for piece in pieces(kept))

    def felt(self, name, content, volume, says=(), **more):
        said, filled = self.check(name, content, **more)
        self.assertIsNotNone(filled, said)
        self.assertLess(abs(filled / volume - 1), 1e-6, f"{filled} mm3, not {volume}: {said}")
        for text in says:
            self.assertIn(text, said)
        if not says:
            self.assertNotIn("warning", said)

    def refused(self, name, content, *says, **more):
        said, filled = self.check(name, content, **more)
        self.assertIsNone(filled, said)
        for text in says:
            self.assertIn(text, said)

    def test_white_space_and_marks_of_text(self):
        text = made.obj(CUBE)
        self.felt("tabs.obj", text.replace(b" ", b"\t"), 64000)
        for ends in (b"\r\n", b"\r"):
            self.felt("ends.obj", text.replace(b"\n", ends), 64000)
            self.felt("mark.obj", b"\xef\xbb\xbf" + text.replace(b"\n", ends), 64000)
        self.refused("wide.obj", text.decode().encode("utf-16"), "UTF-16")

    def ply(self, form, end=b"\n", mark=b""):
        faces = made.triangles(CUBE)
        head = ["ply", f"format {form} 1.0", f"element vertex {3 * len(faces)}", "property float x", "property float y",
                "property float z", f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
        corners = [p for f in faces for p in f]
        lists = [(3, i, i + 1, i + 2) for i in range(0, len(corners), 3)]
        if form == "ascii":
            rows = [*head, *("%g %g %g" % p for p in corners), *("%d %d %d %d" % f for f in lists), ""]
            return mark + end.join(row.encode() for row in rows)
        data = b"".join(struct.pack("<3f", *p) for p in corners) + b"".join(struct.pack("<B3i", *f) for f in lists)
        return mark + b"".join(row.encode() + end for row in head) + data

    @soak.alone
    def test_line_ends_and_marks_of_ply(self):
        for form in ("ascii", "binary_little_endian"):
            for end in (b"\n", b"\r\n", b"\r"):
                self.felt("cube.ply", self.ply(form, end), 64000)
                self.felt("mark.ply", self.ply(form, end, b"\xef\xbb\xbf"), 64000)

    def stl_text(self):
        out = "solid a cube\n"
        for face in made.triangles(CUBE):
            corners = "".join("vertex %+.6E %+.6E %+.6E\n" % p for p in face)
            out += f"facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n"
        return out + "endsolid a cube\n"

    @soak.alone
    def test_text_of_stl(self):
        text = self.stl_text()
        for name, changed in {"capitals": text.upper(), "old": text.replace("\n", "\r"), "padded": text + "\0" * 9,
                              "mark": "\ufeff" + text, "some": text.replace("facet", "Facet")}.items():
            with self.subTest(name):
                self.felt("cube.stl", changed.encode(), 64000)

    def test_binary_stl_whose_size_is_not_what_it_counts(self):
        whole = made.stl(made.triangles(CUBE))
        self.felt("spare.stl", whole + b"\1" * 7, 64000)
        self.felt("padded.stl", whole + b"\0" * 100, 64000)
        self.felt("solid.stl", b"solid x".ljust(80) + whole[80:] + b"\0" * 7, 64000)
        self.felt("none.stl", whole[:80] + b"\0\0\0\0" + whole[84:], 64000)
        self.refused("short.stl", whole[:-20], "ends after 11 of the 12 triangles")
        self.refused("fewer.stl", whole[:80] + struct.pack("<I", 5) + whole[84:], "announces 5 triangles", "enough for 12")

    @soak.alone
    def test_a_face_with_many_corners_some_of_them_in_line(self):
        outline = [(10, 0), (20, 0), (20, 10), (30, 10), (30, 20), (20, 20), (20, 30), (10, 30), (10, 20), (0, 20), (0, 10),
                   (10, 10)]
        for start in range(12):
            self.felt("plus.obj", made.obj(made.prism(outline[start:] + outline[:start], 20)), 10000)

    def test_a_cavity_is_hollow(self):
        inner = made.box((-10, -10, -10), (10, 10, 10))
        self.felt("hollow.obj", made.obj(CUBE + made.turned(inner)), 56000)
        self.felt("inside-out.obj", made.obj(made.turned(CUBE) + inner), 56000)
        self.felt("filled.obj", made.obj(CUBE + inner), 64000, ["overlapping parts", "72000 cubic mm", "64000 cubic mm"])
        island = made.box((-5, -5, -5), (5, 5, 5))
        self.felt("island.obj", made.obj(CUBE + made.turned(inner) + island), 57000)

    @soak.alone
    def test_parts_that_touch_or_overlap_are_one(self):
        self.felt("touching.obj", made.obj(CUBE + made.box((20, -5, -5), (40, 5, 5))), 66000)
        self.felt("face.obj", made.obj(CUBE + made.box((20, -20, -20), (40, 20, 20))), 96000)
        self.felt("edge.obj", made.obj(CUBE + made.box((20, 20, -20), (40, 40, 20))), 80000)
        overlap = made.obj(CUBE + made.box((10, -5, -5), (40, 5, 5)))
        self.felt("overlap.obj", overlap, 66000, ["overlap", "67000 cubic mm", "66000 cubic mm"])

    @soak.alone
    def test_a_part_that_faces_inward_is_turned_around(self):
        self.felt("two.obj", made.obj(CUBE + made.turned(made.box((30, 0, 0), (40, 10, 10)))), 65000, ["1 of 2 shells"])

    def test_what_winds_the_wrong_way_is_refused(self):
        faces = made.prism([(-20, -10), (20, 10), (20, -10), (-20, 10)], 10)
        self.refused("bow.obj", made.obj(faces), "the wrong way round", "cubic mm", "near (")

    @soak.alone
    def test_triangles_without_area(self):
        a, b, c, d = CUBE[0]
        middle = tuple((p + q) / 2 for p, q in zip(a, b))
        cut = [[a, middle, d], [middle, b, d], [b, c, d]]
        self.felt("sliver.stl", made.stl(made.triangles(cut + CUBE[1:]) + [[a, b, middle]]), 64000)
        self.felt("open.stl", made.stl(made.triangles(cut + CUBE[1:])), 64000)
        self.felt("zero.stl", made.stl(made.triangles(CUBE) + [[a, a, b]]), 64000)

    def test_a_corner_beside_an_edge_is_told(self):
        a, b, c, d = CUBE[0]
        middle = (a[0] + b[0]) / 2, (a[1] + b[1]) / 2, a[2] + 0.001
        cut = [[a, middle, d], [middle, b, d], [b, c, d]]
        self.refused("beside.stl", made.stl(made.triangles(cut + CUBE[1:])), "is 0.001 mm from another edge", "rounding")

    @soak.alone
    def test_corners_that_differ_by_rounding(self):
        draw = made.random.Random(1)
        self.felt("rounded.stl", made.stl(made.triangles(CUBE), draw), 64000, ["are merged"])
        faces = made.triangles(CUBE)
        faces[0] = [tuple(c + 0.004 for c in faces[0][0]), *faces[0][1:]]
        self.refused("gap.stl", made.stl(faces), "is not closed", "from another edge", "rounding", ") mm is 0.")

    @soak.alone
    def test_coordinates_with_few_decimals(self):
        inner = made.turned(made.box((-10, -10, -10), (10, 10, 10)))
        for number, faces in enumerate((CUBE, CUBE + inner, made.ring(20, 10, 20, 30))):
            turned = made.rotated(made.random.Random(number), faces)
            for digits in (4, 2):
                rounded = [[tuple(round(c, digits) for c in p) for p in face] for face in made.triangles(turned)]
                self.felt("rounded.obj", made.obj(rounded), made.enclosed(rounded))

    @soak.alone
    def test_cubes_that_share_an_edge(self):
        self.felt("edge.obj", made.obj(made.voxels({(0, 0, 0), (1, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1)})), 5000)

    def test_an_open_mesh_is_refused_with_a_place(self):
        faces = made.triangles(CUBE)
        self.refused("twice.stl", made.stl(faces + faces[:1]), "where 3 faces meet", "duplicate faces")
        self.refused("mixed.stl", made.stl(made.turned(faces[:1]) + faces[1:]), "where two faces face opposite ways")
        self.refused("hole.stl", made.stl(made.triangles(CUBE)[:-1]), "is not closed: 3 of its edges", "the first from (-20",
                     "where one face has no neighbour")

    @soak.alone
    def test_inches(self):
        faces = [[tuple(c / 25.4 for c in p) for p in face] for face in CUBE]
        self.felt("inch.obj", made.obj(faces), 64000, unit="inch")
        said, _ = self.check("inch.obj", made.obj(faces), unit="feet")
        self.assertIn("Use m, cm, mm or inch.", said)
        self.assertEqual(said.count("error:") + said.count("warning:"), 1, said)

    def test_far_from_the_origin(self):
        faces = [[(x + 50000, y + 30000, z + 20000) for x, y, z in face] for face in CUBE]
        self.felt("far.obj", made.obj(faces), 64000)

    @soak.alone
    def test_far_from_the_origin_with_all_digits(self):
        """As maps have them: 5400 m away a step of single precision is half a millimetre."""
        cube = made.box((0, 0, 0), (40.3, 40.3, 40.3))
        for away in ((5000.3, 3000.1, 200.7), (500000.3, 5400000.1, 100.2)):
            faces = made.triangles([[tuple(c + a for c, a in zip(p, away)) for p in face] for face in cube])
            corners = [p for face in faces for p in face]
            lists = "".join(f"3 {i} {i + 1} {i + 2}\n" for i in range(0, len(corners), 3))
            rows = "".join("%.12g %.12g %.12g\n" % p for p in corners)
            stl = "".join("facet normal 0 0 0\nouter loop\n" + "".join("vertex %.12g %.12g %.12g\n" % p for p in face)
                          + "endloop\nendfacet\n" for face in faces)
            head = (f"ply\nformat %s 1.0\nelement vertex {len(corners)}\nproperty double z\nproperty double y\nproperty double x\n"
                    f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
            obj = "".join(f"v {row}\n" for row in rows.splitlines()) + "".join(f"f {i} {i + 1} {i + 2}\n" for i in range(1, len(corners), 3))
            turned = "".join(" ".join(row.split()[::-1]) + "\n" for row in rows.splitlines())
            binary = {order: b"".join(struct.pack(f"{sign}3d", *p[::-1]) for p in corners)
                      + b"".join(struct.pack(f"{sign}B3i", 3, i, i + 1, i + 2) for i in range(0, len(corners), 3))
                      for order, sign in (("little", "<"), ("big", ">"))}
            for name, content in (("far.obj", obj.encode()), ("far.stl", f"solid\n{stl}endsolid\n".encode()),
                                  ("far.off", f"OFF\n{len(corners)} {len(faces)} 0\n{rows}{lists}".encode()),
                                  ("far.ply", (head % "ascii" + turned + lists).encode()),
                                  *((f"{order}.ply", (head % f"binary_{order}_endian").encode() + data) for order, data in binary.items())):
                with self.subTest(name, away=away):
                    self.felt(name, content, 40.3**3)

    def texts(self):
        """The cube as text of each kind, with one coordinate of each corner as {}."""
        corners = sorted({p for face in CUBE for p in face})
        faces = [[corners.index(p) for p in face] for face in CUBE]
        rows = "".join("{} %g %g\n" % p[1:] for p in corners)
        lists = "".join(f"4 {' '.join(map(str, face))}\n" for face in faces)
        numbers = ["%g" % p[0] for p in corners]
        stl = made.triangles(CUBE)
        return {
            "obj": ("".join(f"v {row}\n" for row in rows.splitlines())
                    + "".join("f " + " ".join(str(i + 1) for i in face) + "\n" for face in faces), numbers),
            "off": (f"OFF\n8 6 12\n{rows}{lists}", numbers),
            "ply": ("ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\nelement face 6\n"
                    f"property list uchar int vertex_indices\nend_header\n{rows}{lists}", numbers),
            "stl": ("solid\n" + "".join("facet normal 0 0 0\nouter loop\n" + "".join("vertex {} %g %g\n" % p[1:] for p in face)
                                        + "endloop\nendfacet\n" for face in stl) + "endsolid\n", ["%g" % p[0] for f in stl for p in f]),
        }

    def test_what_is_no_number_is_refused_with_its_line(self):
        for ending, (text, numbers) in self.texts().items():
            self.felt(f"cube.{ending}", text.format(*numbers).encode(), 64000)
            self.felt(f"cube.{ending}", text.format(*(f"{float(n):+.3E}" for n in numbers)).encode(), 64000)
            line = text[:text.index("{}")].count("\n") + 1
            for written in ("{:.2f}D+00", "{:.1f}mm", "0x{:.0f}", "{:.0f},5", "{:.0f},000", "1.#QNAN", "nan", "2_{:.0f}", "\u2212{:.0f}"):
                with self.subTest(ending, written=written):
                    words = [written.format(abs(float(n))) for n in numbers]
                    said = f"has a vertex that is not a number in line {line}: '{words[0].lower() if ending == 'stl' else words[0]}'"
                    self.refused(f"cube.{ending}", text.format(*words).encode(), said)
            self.refused(f"short.{ending}", text.format("", *numbers[1:]).encode(), f"has 2 of the 3 numbers of a vertex in line {line}")

    @soak.alone
    def test_comments_and_blank_lines(self):
        texts = {ending: text.format(*numbers) for ending, (text, numbers) in self.texts().items()}
        for comment in (" # corner 2", " #2", " # 1 2 3", "\t# a \\"):
            lines = texts["obj"].splitlines()
            self.felt("cube.obj", "".join(f"{line}{comment}\n" for line in lines).encode(), 64000)
            lines = texts["off"].splitlines()
            self.felt("cube.off", "".join(f"{line}{comment}\n\n# 4 0 1 2 3\n" for line in lines).encode(), 64000)
        self.felt("cube.obj", ("# 3 \\\nusemtl red#1\n" + texts["obj"].replace(" ", " \\\n", 1)).encode(), 64000)
        self.felt("glued.off", texts["off"].replace("OFF\n", "OFF").encode(), 64000)

    @soak.alone
    def test_decimal_commas_of_the_locale_change_nothing(self):
        self.felt("cube.obj", made.obj([[(x / 3, y / 3, z / 3) for x, y, z in f] for f in CUBE]), 64000 / 27,
                  locale="de_DE.UTF-8")

    def test_needles_are_pieces_too(self):
        wire = made.box((0, 0, 0), (200, 0.2, 0.2)) + made.box((0, 0.2, 0), (0.2, 100, 0.2))
        self.felt("wire.obj", made.obj(wire), 8 + 0.2 * 0.2 * 99.8)

    def test_made_meshes(self):
        refusals = 0
        for number in range(COUNT):
            kind, ending, content, volume = made.mesh(number)
            with self.subTest(f"{number}: {kind}, {ending}"):
                said, filled = self.check(f"mesh.{ending}", content)
                if volume is None:
                    self.assertIsNone(filled, said)
                if filled is None:
                    refusals += volume is not None
                    self.assertRegex(said, r"\(-?[0-9.]+.*\) mm", "no place is named")
                else:
                    self.assertLess(abs(filled / volume - 1), 1e-6, f"{filled} mm3, not {volume}: {said}")
        print(f"{COUNT} made meshes, {refusals} refused that have a volume")
        self.assertLessEqual(refusals, max(1, COUNT / 50))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
