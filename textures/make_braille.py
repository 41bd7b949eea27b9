"""Draws a word in braille as a relief: a PNG file for `texture: { kind: picture }`.

    make_braille.py WORD FILE.png

The picture is 160 x 30 mm with 4 pixels a millimetre. Cells are twice as large as on paper (12 mm apart, dots 5 mm), so
that the finger of a device feels them one by one; a dot is a cosine 3 mm wide.
"""
import math
import sys

from png_file import png

WIDTH, HEIGHT, PER_MM = 640, 120, 4
CELL, DOT, RADIUS = 12, 5, 1.5  # [mm]
DOTS = {"a": "1", "b": "12", "c": "14", "d": "145", "e": "15", "f": "124", "g": "1245", "h": "125", "i": "24",
        "j": "245", "k": "13", "l": "123", "m": "134", "n": "1345", "o": "135", "p": "1234", "q": "12345", "r": "1235",
        "s": "234", "t": "2345", "u": "136", "v": "1236", "w": "2456", "x": "1346", "y": "13456", "z": "1356"}


def rows(word):
    """Grey of each row's pixels, from 0 to 255."""
    left = (WIDTH / PER_MM - (len(word) - 1) * CELL - DOT) / 2
    centres = [(left + n * CELL + (0 if dot in "123" else DOT), HEIGHT / PER_MM / 2 + DOT * ((int(dot) - 1) % 3 - 1))
               for n, letter in enumerate(word) for dot in DOTS[letter]]
    out = [bytearray(WIDTH) for _ in range(HEIGHT)]
    for x, y in centres:
        for row in range(int((y - RADIUS) * PER_MM), int((y + RADIUS) * PER_MM) + 1):
            for column in range(int((x - RADIUS) * PER_MM), int((x + RADIUS) * PER_MM) + 1):
                r = math.hypot((column + 0.5) / PER_MM - x, (row + 0.5) / PER_MM - y)
                if r < RADIUS:
                    out[row][column] = round(255 * (1 + math.cos(math.pi * r / RADIUS)) / 2)
    return out


if __name__ == "__main__":
    with open(sys.argv[2], "wb") as file:
        file.write(png(rows(sys.argv[1])))
