"""Draws pictures for bodies to wear: PNG files for `picture: { file: FILE, width_mm: ... }`. They repeat without a seam.

    make_looks.py wood FILE.png       boards of oak, 600 x 400 mm
    make_looks.py checker FILE.png    two by two squares, light and dark: 20 x 20 mm for squares of 10 mm
"""
import math
import random
import sys

from png_file import png

WIDTH, HEIGHT, BOARDS = 768, 512, 4  # of the wood [pixels]; 0.78 mm each
LIGHT, DARK = (203, 164, 118), (128, 84, 50)
TONES = 40
SQUARE = 40  # of the checker [pixels]


class Noise:
    """Smooth and random, from -1 to 1, of period 1 in x and y, with so many waves along each."""

    def __init__(self, seed, across, down):
        self.across, self.down = across, down
        draw = random.Random(seed)
        self.at_corners = [[draw.uniform(-1, 1) for _ in range(across)] for _ in range(down)]

    def __call__(self, x, y):
        x, y = x * self.across, y * self.down
        i, j = math.floor(x), math.floor(y)
        s, t = (3 * f * f - 2 * f * f * f for f in (x - i, y - j))

        def along(row):
            corners = self.at_corners[row % self.down]
            return corners[i % self.across] * (1 - s) + corners[(i + 1) % self.across] * s

        return along(j) * (1 - t) + along(j + 1) * t


def board(number):
    """A board's darkness, from 0 to 1, by the share of its length and of its width: rings that are cut at a low angle
    make long waves, and pores short streaks."""
    seed = 10 * number
    wave, bend, tone = Noise(seed, 2, 1), Noise(seed + 1, 5, 4), Noise(seed + 2, 3, 2)
    fibre, pore = Noise(seed + 3, 12, 90), Noise(seed + 4, 40, 128)
    shade = 0.12 * math.sin(2.4 * number)

    def at(x, y):
        ring = 7 * (y + 0.35 * wave(x, 0)) + 0.5 * bend(x, y)
        late = (0.5 + 0.5 * math.sin(2 * math.pi * ring)) ** 3  # dark wood, grown late in the year
        return 0.33 + shade + 0.28 * late + 0.08 * tone(x, y) + 0.13 * fibre(x, y) - 0.15 * min(pore(x, y) + 0.5, 0)

    return at


def wood():
    tall = HEIGHT // BOARDS
    rows = []
    for number in range(BOARDS):
        darkness, shift = board(number), 0.37 * number
        for j in range(tall):
            gap = 0.25 if j == 0 else 0
            y = (j + 0.5) / tall
            rows.append(bytes(round((TONES - 1) * min(max(darkness((i + 0.5) / WIDTH + shift, y) + gap, 0), 1))
                              for i in range(WIDTH)))
    palette = [tuple(round(a + (b - a) * k / (TONES - 1)) for a, b in zip(LIGHT, DARK)) for k in range(TONES)]
    return png(rows, palette)


def checker():
    rows = [bytes(230 if (i // SQUARE + j // SQUARE) % 2 else 30 for i in range(2 * SQUARE)) for j in range(2 * SQUARE)]
    return png(rows)


if __name__ == "__main__":
    with open(sys.argv[2], "wb") as file:
        file.write({"wood": wood, "checker": checker}[sys.argv[1]]())
