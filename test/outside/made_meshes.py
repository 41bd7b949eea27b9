"""Meshes as people bring them, made at random, each with the volume that follows from how it was made.

A mesh is a list of faces, each a list of corners, counter-clockwise seen from outside [mm].
"""
import math
import random
import struct

CORNERS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
SIDES = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]


def box(low, high):
    points = [tuple(low[i] + c[i] * (high[i] - low[i]) for i in range(3)) for c in CORNERS]
    return [[points[i] for i in side] for side in SIDES]


def turned(faces):
    return [face[::-1] for face in faces]


def prism(outline, height):
    """Over a simple polygon, counter-clockwise, with its two ends as one face each."""
    bottom = [(x, y, 0) for x, y in outline]
    top = [(x, y, height) for x, y in outline]
    n = len(outline)
    return [bottom[::-1], top] + [[bottom[i], bottom[(i + 1) % n], top[(i + 1) % n], top[i]] for i in range(n)]


def ring(sides, inner, outer, height):
    """A pipe whose section is a regular polygon without a smaller one."""
    def circle(r, z):
        return [(r * math.cos(2 * math.pi * i / sides), r * math.sin(2 * math.pi * i / sides), z) for i in range(sides)]

    faces = []
    rings = [circle(outer, 0), circle(outer, height), circle(inner, height), circle(inner, 0)]
    for a, b in zip(rings, rings[1:] + rings[:1]):
        faces += [[a[i], a[(i + 1) % sides], b[(i + 1) % sides], b[i]] for i in range(sides)]
    return faces


def torus(radius, thickness, around, across):
    def corner(i, j):
        a, b = 2 * math.pi * (i % around) / around, 2 * math.pi * (j % across) / across
        r = radius + thickness * math.cos(b)
        return r * math.cos(a), r * math.sin(a), thickness * math.sin(b)

    return [[corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]
            for i in range(around) for j in range(across)]


def area(outline):
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(outline, outline[1:] + outline[:1])) / 2


def size(low, high):
    return math.prod(max(0, b - a) for a, b in zip(low, high))


def triangles(faces):
    return [[f[0], f[i], f[i + 1]] for f in faces for i in range(1, len(f) - 1)]


def enclosed(faces):
    """The volume within triangles."""
    def six(a, b, c):
        return sum(a[i] * (b[(i + 1) % 3] * c[(i + 2) % 3] - b[(i + 2) % 3] * c[(i + 1) % 3]) for i in range(3))

    return sum(six(*face) for face in faces) / 6


def voxels(cells):
    """The surface of cubes of 10 mm, which may share an edge or a corner only."""
    neighbours = [(0, 0, -1), (0, 0, 1), (0, -1, 0), (1, 0, 0), (0, 1, 0), (-1, 0, 0)]
    return [[tuple(10 * (cell[i] + CORNERS[corner][i]) for i in range(3)) for corner in side]
            for cell in cells for side, way in zip(SIDES, neighbours)
            if tuple(a + b for a, b in zip(cell, way)) not in cells]


def a_box(draw, low=-30, high=30):
    edges = [sorted((draw.uniform(low, high), draw.uniform(low, high))) for _ in range(3)]
    return [a for a, _ in edges], [max(b, a + 4) for a, b in edges]


def shrunk(draw, low, high):
    inner = [(a + draw.uniform(0.1, 0.3) * (b - a), b - draw.uniform(0.1, 0.3) * (b - a)) for a, b in zip(low, high)]
    return [a for a, _ in inner], [b for _, b in inner]


def cavity(draw):
    outer = a_box(draw)
    inner = shrunk(draw, *outer)
    faces = box(*outer) + turned(box(*inner))
    if draw.random() < 0.3:
        faces = turned(faces)
    return faces, size(*outer) - size(*inner)


def cavity_that_faces_outward(draw):
    outer = a_box(draw)
    return box(*outer) + box(*shrunk(draw, *outer)), size(*outer)


def nested(draw):
    outer = a_box(draw)
    inner = shrunk(draw, *outer)
    island = shrunk(draw, *inner)
    within = shrunk(draw, *island)
    faces = box(*outer) + turned(box(*inner)) + box(*island) + turned(box(*within))
    return faces, size(*outer) - size(*inner) + size(*island) - size(*within)


def overlapping(draw):
    first, second = a_box(draw), a_box(draw)
    shared = [max(a, b) for a, b in zip(first[0], second[0])], [min(a, b) for a, b in zip(first[1], second[1])]
    return box(*first) + box(*second), size(*first) + size(*second) - size(*shared)


def touching(draw):
    low, high = a_box(draw)
    faces, volume = box(low, high), size(low, high)
    for axis in draw.sample(range(3), draw.choice([1, 2])):
        begin, end = shrunk(draw, low, high)
        if draw.random() < 0.3:
            begin, end = list(low), list(high)  # the full face of the box
        begin[axis], end[axis] = high[axis], high[axis] + draw.uniform(2, 20)
        faces += box(begin, end)
        volume += size(begin, end)
    return faces, volume


def touching_at_an_edge(draw):
    low, high = a_box(draw)
    end = [high[0] + draw.uniform(2, 9), high[1] + draw.uniform(2, 9), high[2] + draw.choice([0, 5])]
    begin = [high[0], high[1], low[2]]
    return box(low, high) + box(begin, end), size(low, high) + size(begin, end)


def steps(draw):
    """A prism over stairs: many corners in line, in one face."""
    outline = [(0, 0)]
    x = 0
    for _ in range(draw.randint(2, 6)):
        x += draw.choice([5, 10])
        outline.append((x, 0))
    heights = [draw.choice([10, 15, 20]) for _ in range(draw.randint(2, 5))]
    width = x / len(heights)
    for i, h in enumerate(heights):
        outline += [(x - i * width, h), (x - (i + 1) * width, h)]
    outline = [p for i, p in enumerate(outline) if p != outline[i - 1]]
    shift = draw.randrange(len(outline))
    return prism(outline[shift:] + outline[:shift], 7), 7 * area(outline)


def star(draw):
    n = 2 * draw.randint(3, 9)
    turn = draw.uniform(0, 1)
    outline = [((30 if i % 2 else 12) * math.cos(turn + 2 * math.pi * i / n),
                (30 if i % 2 else 12) * math.sin(turn + 2 * math.pi * i / n)) for i in range(n)]
    return prism(outline, 9), 9 * area(outline)


def plus(draw):
    a, b = draw.uniform(5, 12), draw.uniform(15, 30)
    outline = [(a, -a), (b, -a), (b, a), (a, a), (a, b), (-a, b), (-a, a), (-b, a), (-b, -a), (-a, -a), (-a, -b), (a, -b)]
    shift = draw.randrange(12)
    return prism(outline[shift:] + outline[:shift], 20), 20 * area(outline)


def pipe(draw):
    n, inner, outer, height = draw.randint(3, 24), draw.uniform(5, 15), draw.uniform(18, 30), draw.uniform(5, 50)
    return ring(n, inner, outer, height), n / 2 * math.sin(2 * math.pi / n) * (outer**2 - inner**2) * height


def of_cubes(draw):
    cells = {(x, y, z) for x in range(3) for y in range(3) for z in range(2) if draw.random() < 0.5} | {(0, 0, 0)}
    return voxels(cells), 1000 * len(cells)


def t_junction(draw):
    """A face that is cut where its neighbours are not, and the gap open or closed by triangles without area."""
    low, high = a_box(draw)
    faces = box(low, high)
    a, b, c, d = faces.pop(0)
    shares = sorted(draw.uniform(0.1, 0.9) for _ in range(draw.randint(1, 4)))
    on = [tuple(p + s * (q - p) for p, q in zip(a, b)) for s in shares]
    chain = [a, *on, b]
    faces += [[p, q, d] for p, q in zip(chain, chain[1:])] + [[b, c, d]]
    if draw.random() < 0.5:
        faces += [[a, q, p] for p, q in zip(chain[1:], chain[2:])]
    return faces, size(low, high)


def open_box(draw):
    faces = triangles(box(*a_box(draw)))
    del faces[draw.randrange(len(faces))]
    return faces, None


def bow_tie(draw):
    """Two wedges that share no edge where they cross: one of them is inside out."""
    a = draw.uniform(10, 20)
    return prism([(-a, -a), (a, a), (a, -a), (-a, a)], 10), None


KINDS = [cavity, cavity_that_faces_outward, nested, overlapping, touching, touching_at_an_edge, steps, star, plus, pipe,
         of_cubes, t_junction, open_box, bow_tie]


def rotated(draw, faces):
    """Turned about a random axis, so that no coordinate is a round number."""
    q = [draw.gauss(0, 1) for _ in range(4)]
    w, x, y, z = (c / math.sqrt(sum(c * c for c in q)) for c in q)
    rows = [(1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
            (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y))]
    return [[tuple(sum(r * c for r, c in zip(row, p)) for row in rows) for p in face] for face in faces]


def obj(faces):
    lines = []
    for face in faces:
        lines += ["v %.9g %.9g %.9g" % p for p in face] + ["f " + " ".join(str(i - len(face)) for i in range(len(face)))]
    return ("\n".join(lines) + "\n").encode()


def stl(faces, draw=None):
    """With `draw`, each triangle has its own rounding of its corners."""
    noise = (lambda: draw.uniform(-2e-6, 2e-6)) if draw else (lambda: 0)
    out = b"made".ljust(80) + struct.pack("<I", len(faces))
    for face in faces:
        out += struct.pack("<12fH", 0, 0, 0, *(c + noise() for p in face for c in p), 0)
    return out


def mesh(number):
    """(kind, ending of the name, bytes, volume in cubic millimetres; None: it has to be refused)."""
    draw = random.Random(number)
    kind = KINDS[number % len(KINDS)]
    faces, volume = kind(draw)
    if number // len(KINDS) % 3 == 2:
        faces = rotated(draw, faces)
    convex_faces = kind not in (steps, star, plus, bow_tie)  # a fan of triangles would not cover the others' faces
    if convex_faces and draw.random() < 0.5:
        return kind.__name__, "stl", stl(triangles(faces), draw if draw.random() < 0.4 else None), volume
    return kind.__name__, "obj", obj(faces), volume
