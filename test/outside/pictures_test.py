"""Pictures that are heights, in every form of PNG, are felt as they are stored. docs/outside.md has the sources.

Usage: outside/pictures_test.py PROGRAM, from the project's folder.
"""
import io
import os
import pathlib
import struct
import sys
import tempfile
import unittest
import zlib

import matplotlib.image

sys.path.append("test/cli")
from program import PROGRAM, dihaptic

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(PROGRAM)), "python"))
import dihaptic as dh  # noqa: E402

EDGE = 8
HEIGHT_MM = 0.3
#: Width and height of the seven passes of an interlaced picture of 8 x 8.
ADAM7 = ((1, 1), (1, 1), (2, 1), (2, 2), (4, 2), (4, 4), (8, 4))
GREY, RGB, PALETTE, GREY_ALPHA, RGB_ALPHA = 0, 2, 3, 4, 6
GAMMA_LINEAR, GAMMA_SRGB = (("gAMA", struct.pack(">I", gamma)) for gamma in (100000, 45455))
SRGB = ("sRGB", b"\0")


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind.encode() + data + struct.pack(">I", zlib.crc32(kind.encode() + data))


def even(bits, colour, *samples, chunks=(), interlaced=False):
    """A picture of 8 x 8 equal pixels."""
    digits = "".join(format(sample, f"0{bits}b") for sample in samples)
    rows = b""
    for width, height in ADAM7 if interlaced else ((EDGE, EDGE),):
        row = digits * width
        row += "0" * (-len(row) % 8)
        rows += (b"\0" + int(row, 2).to_bytes(len(row) // 8, "big")) * height
    head = struct.pack(">2I5B", EDGE, EDGE, bits, colour, 0, 0, int(interlaced))
    return (b"\x89PNG\r\n\x1a\n" + chunk("IHDR", head) + b"".join(chunk(*one) for one in chunks)
            + chunk("IDAT", zlib.compress(rows)) + chunk("IEND", b""))


def palette(*greys):
    return ("PLTE", bytes(grey for grey in greys for _ in range(3)))


#: Each variant of PNG, with the brightness that it stores, as a fraction of white.
FORMS = {
    **{f"{bits} bits, {value}": (even(bits, GREY, value), value / (2**bits - 1))
       for bits, values in ((1, (0, 1)), (2, (0, 1, 2, 3)), (4, (1, 8, 15)), (8, (64, 128, 191)),
                            (16, (64 * 257, 128 * 257, 191 * 257, 4660))) for value in values},
    **{f"16 bits, {name}": (even(16, GREY, 16448, chunks=[one]), 16448 / 65535)
       for name, one in (("gamma 1", GAMMA_LINEAR), ("gamma 0.45", GAMMA_SRGB), ("sRGB", SRGB))},
    **{f"8 bits, {name}": (even(8, GREY, 64, chunks=[one]), 64 / 255)
       for name, one in (("gamma 1", GAMMA_LINEAR), ("gamma 0.45", GAMMA_SRGB), ("sRGB", SRGB))},
    "8 bits, interlaced": (even(8, GREY, 64, interlaced=True), 64 / 255),
    "16 bits, interlaced": (even(16, GREY, 9000, interlaced=True), 9000 / 65535),
    "1 bit, interlaced": (even(1, GREY, 1, interlaced=True), 1),
    "8 bits of each colour": (even(8, RGB, 10, 60, 200), 270 / 765),
    "16 bits of each colour": (even(16, RGB, 10000, 5000, 45000), 60000 / 196605),
    "16 bits of each colour, gamma 1": (even(16, RGB, 10000, 5000, 45000, chunks=[GAMMA_LINEAR]), 60000 / 196605),
    "opaque": (even(8, RGB_ALPHA, 64, 64, 64, 255), 64 / 255),
    "opaque, 16 bits": (even(16, GREY_ALPHA, 9000, 65535), 9000 / 65535),
    "palette": (even(8, PALETTE, 1, chunks=[palette(0, 64)]), 64 / 255),
    "palette of 1 bit": (even(1, PALETTE, 1, chunks=[palette(0, 64)]), 64 / 255),
    "palette, gamma 1": (even(8, PALETTE, 1, chunks=[GAMMA_LINEAR, palette(0, 64)]), 64 / 255),
    "palette with tRNS, opaque": (even(4, PALETTE, 1, chunks=[palette(0, 128), ("tRNS", b"\0\xff")]), 128 / 255),
    "tRNS of another grey": (even(8, GREY, 64, chunks=[("tRNS", struct.pack(">H", 9))]), 64 / 255),
}
#: Pictures of heights that are partly transparent.
TRANSPARENT = {
    "grey with alpha": even(8, GREY_ALPHA, 64, 128),
    "colours with alpha": even(8, RGB_ALPHA, 64, 64, 64, 254),
    "16 bits with alpha": even(16, RGB_ALPHA, 9000, 9000, 9000, 65534),
    "palette with tRNS": even(8, PALETTE, 1, chunks=[palette(0, 64), ("tRNS", b"\xff\x80")]),
    "tRNS of this grey": even(8, GREY, 64, chunks=[("tRNS", struct.pack(">H", 64))]),
}


def pixels(picture):
    """Of a picture that the program drew."""
    image = matplotlib.image.imread(io.BytesIO(picture))
    return (255 * image[..., :3]).round().astype(int).ravel().tolist()


class Pictures(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = pathlib.Path(folder.name, "height.png")

    def scene(self):
        texture = dh.Part(kind="picture", file=str(self.file), wavelength_mm=20, height_mm=HEIGHT_MM, along=[1, 0, 0])
        table = dh.Part(name="table", shape="box", size_mm=[100, 100, 50], position_mm=[0, 0, -25], fixed=True,
                        friction=0.5, surface=dh.Part(texture=texture))
        cube = dh.Part(name="cube", shape="box", size_mm=[10, 10, 10], mass_g=50, position_mm=[0, 0, 5.5], moves="z", turns="none")
        hand = dh.Part(centre_mm=[0, 0, 2000], aperture_mm=400, script=[dh.Part(name="wait", duration_s=1)])
        return dh.Scene(title="relief", bodies=[table, cube], object="cube", hand=hand)

    def test_are_felt_as_they_are_stored(self):
        for name, (picture, share) in FORMS.items():
            with self.subTest(name):
                self.file.write_bytes(picture)
                world = dh.World(self.scene())
                world.step(800)
                height = 1e3 * world.bodies["cube"].position[2] - 5
                self.assertAlmostEqual(height / HEIGHT_MM, share, delta=5e-4)

    def test_that_can_be_seen_through_are_refused(self):
        for name, picture in TRANSPARENT.items():
            with self.subTest(name):
                self.file.write_bytes(picture)
                with self.assertRaisesRegex(dh.Error, "pixel 1 of row 1 is not opaque.*without transparency"):
                    dh.World(self.scene())

    def test_that_are_no_png_files_are_refused(self):
        for start in (b"\xff\xd8\xff\xe0JFIF", b"GIF89a", b"BM", b""):
            with self.subTest(start):
                self.file.write_bytes(start + bytes(200))
                with self.assertRaisesRegex(dh.Error, "height.png: (cannot be read|is empty)"):
                    dh.World(self.scene())

    def test_that_are_seen_are_read_as_seen(self):
        """A grey of 16 bits looks as the same grey of 8 bits, and linear light as what it looks like."""
        pictures = {}
        for name, picture in {"8": even(8, GREY, 128), "16": even(16, GREY, 128 * 257),
                              "linear": even(16, GREY, 14147, chunks=[GAMMA_LINEAR])}.items():
            self.file.write_bytes(picture)
            scene = self.file.with_name(f"{name}.yaml")
            scene.write_text(f"""bodies:
  - {{ name: table, shape: box, size_mm: [900, 900, 20], position_mm: [0, 0, -10], fixed: yes, picture: {{ file: {self.file}, width_mm: 900 }} }}
hand: {{ centre_mm: [0, 0, 2000], aperture_mm: 400, script: [{{ name: wait, duration_s: 1 }}] }}
""")
            out = scene.with_suffix(".png")
            result = dihaptic("picture", str(scene), "--camera", "above", "--size", "64x64", "-o", str(out))
            self.assertEqual(result.returncode, 0, result.stderr)
            pictures[name] = pixels(out.read_bytes())
        self.assertEqual(pictures["16"], pictures["8"])
        # linear light is quantised in different steps
        self.assertLessEqual(max(abs(a - b) for a, b in zip(pictures["linear"], pictures["8"])), 2)


if __name__ == "__main__":
    unittest.main(verbosity=1)
