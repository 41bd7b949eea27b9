#!/usr/bin/env python3
"""Writes the meshes of this folder: tools that fingers may have, and things to handle. Millimetres.

    python3 meshes/make_meshes.py [FOLDER]      default: the folder of this script

Tests compare the meshes with what this writes. Flat faces are exactly flat, closed and outward, so that
concave ones can be cut into few convex pieces.
"""
import math
import os
import sys


def lathe(profile, sides):
    """Turns a profile [(radius, height)], bottom to top on the outside, about z. Ends that are not on the
    axis are closed flat."""
    vertices, rings = [], []
    for radius, height in profile:
        if radius == 0:
            rings.append([len(vertices)] * sides)
            vertices.append((0, 0, height))
            continue
        rings.append(list(range(len(vertices), len(vertices) + sides)))
        for i in range(sides):
            angle = 2 * math.pi * (i + 0.5) / sides
            vertices.append((radius * math.cos(angle), radius * math.sin(angle), height))
    faces = []
    if profile[0][0] > 0:
        faces.append(rings[0][::-1])
    for low, high in zip(rings, rings[1:]):
        for i in range(sides):
            j = (i + 1) % sides
            face = [low[i], low[j], high[j], high[i]]
            faces.append([v for k, v in enumerate(face) if v != face[k - 1]])
    if profile[-1][0] > 0:
        faces.append(rings[-1])
    return vertices, faces


def prism(outline, triangles, width):
    """An outline [(x, z)], counter-clockwise seen against y, as wide as `width` along y."""
    n = len(outline)
    vertices = [(x, -width / 2, z) for x, z in outline] + [(x, width / 2, z) for x, z in outline]
    faces = [list(t) for t in triangles] + [[v + n for v in t[::-1]] for t in triangles]
    for i in range(n):
        j = (i + 1) % n
        faces.append([j, i, i + n, j + n])
    return vertices, faces


def strip(count):
    """Triangles of an outline whose second half runs back along the first: a bent bar."""
    last = 2 * count - 1
    out = []
    for i in range(count - 1):
        out += [(i, i + 1, last - i - 1), (i, last - i - 1, last - i)]
    return out


def bar(path, thickness):
    """Outline of a bar of constant thickness along a path [(x, z)], on the path's left."""
    left = []
    for i, (x, z) in enumerate(path):
        before = path[max(i - 1, 0)]
        after = path[min(i + 1, len(path) - 1)]
        normals = []
        for (ax, az), (bx, bz) in ((before, (x, z)), ((x, z), after)):
            length = math.hypot(bx - ax, bz - az)
            if length > 0:
                normals.append((-(bz - az) / length, (bx - ax) / length))
        nx = sum(n[0] for n in normals) / len(normals)
        nz = sum(n[1] for n in normals) / len(normals)
        stretch = thickness / (nx * nx + nz * nz)
        left.append((x + nx * stretch, z + nz * stretch))
    return path + left[::-1], strip(len(path))


def hook():
    """A stem along z whose lower end bends round to +x and up; the inside of the bend is at z = 0."""
    bend = [(16 - 20 * math.cos(a), 16 - 20 * math.sin(a)) for a in (math.pi * k / 6 for k in range(7))]
    outline, triangles = bar([(-4, 90)] + bend + [(36, 26)], 4)
    return prism(outline, triangles, 6)


def bowl():
    """A trough along y, open upward, whose inside is tangent to a circle of 110 mm about the origin: 60 faces of 2 degrees
    each, up to 60 degrees on either side."""
    step = math.radians(2)
    ends = [step * (k - 30) for k in range(61)]
    outside = [(114 * math.sin(a), -114 * math.cos(a)) for a in ends]
    inside = [(110 / math.cos(step / 2) * math.sin(a), -110 / math.cos(step / 2) * math.cos(a)) for a in ends]
    return prism(outside + inside[::-1], strip(len(ends)), 40)


def stone():
    """Nothing that hands know, yet convex: a turned shape, stretched and sheared. It lies on z = 0."""
    vertices, faces = lathe([(16, 0), (24, 14), (20, 30), (8, 40)], 7)
    return [(1.1 * x + 0.15 * z, 0.85 * y - 0.1 * z, z) for x, y, z in vertices], faces


def apple():
    """For the eye alone, about the origin, as large as a sphere of 36 mm that a finger feels in its place: vertices,
    faces and the vertices' colours."""
    bottom, top = (-28, 0.12), (22, 0.3)  # height of the dimple and its width
    sides, rings = 40, 26
    profile = [(0, bottom[0])]
    for k in range(1, rings):
        angle = math.pi * k / rings  # from the bottom
        height = -34 * math.cos(angle) - 1
        for end, (depth, width) in ((angle, bottom), (math.pi - angle, top)):
            height += (depth - math.copysign(35, depth) + 1) * math.exp(-(end / (2 * width)) ** 2)
        profile.append((36 * math.sin(angle) ** 0.9 * (1 + 0.06 * math.cos(math.pi - angle)), height))
    profile.append((0, top[0]))
    vertices, faces = lathe(profile, sides)
    colours = []
    for x, y, z in vertices:
        angle, r = math.atan2(y, x), math.hypot(x, y)
        sun = 0.5 + 0.5 * math.cos(angle + 1) + 0.18 * math.sin(9 * angle + z / 9) + 0.1 * math.sin(23 * angle)
        red = min(max(sun + z / 90, 0), 1) * min(r / 14, 1)
        colours.append(tuple(round(a + (b - a) * red) for a, b in zip((186, 190, 84), (178, 32, 38))))
    stem, stem_faces = lathe([(1.4, 18), (1.2, 28), (1.9, 40)], 8)
    faces += [[v + len(vertices) for v in face] for face in stem_faces]
    vertices = vertices + [(x + 0.004 * (z - 18) ** 2, y, z) for x, y, z in stem]
    return vertices, faces, colours + [(92, 66, 40)] * len(stem)


MESHES = {
    # convex
    "pad": prism([(-2.5, -10), (2.5, -10), (2.5, 10), (-2.5, 10)], [(0, 1, 2), (0, 2, 3)], 20),
    "fingertip": lathe([(7, -8), (8, -2), (6, 4), (0, 6)], 8),
    "stylus": lathe([(0, 0), (4, 12), (4, 120)], 8),
    "stone": stone(),
    # concave
    "spatula": prism([(0, 0), (60, 0), (60, 1), (2, 2), (2, 60), (0, 60)],
                     [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)], 30),
    "cup": lathe([(32, 0), (32, 80), (28, 80), (28, 4)], 12),
    "hook": hook(),
    "bowl": bowl(),
}


def number(value):
    return f"{value:.6f}".rstrip("0").rstrip(".") if abs(value) >= 5e-7 else "0"


def ply(vertices, faces, colours):
    """A mesh with colours, as text."""
    head = ["ply", "format ascii 1.0", "comment in millimetres; written by make_meshes.py",
            f"element vertex {len(vertices)}", *(f"property float {axis}" for axis in "xyz"),
            *(f"property uchar {colour}" for colour in ("red", "green", "blue")),
            f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    corners = [" ".join([f"{x:.2f}" for x in vertex] + [str(c) for c in colour])
               for vertex, colour in zip(vertices, colours)]
    return "\n".join(head + corners + [" ".join(map(str, [len(face), *face])) for face in faces]) + "\n"


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(os.path.abspath(__file__))
    for name, (vertices, faces) in MESHES.items():
        with open(os.path.join(folder, name + ".obj"), "w", encoding="ascii") as file:
            file.write(f"# {name}, in millimetres; written by make_meshes.py\n")
            for vertex in vertices:
                file.write("v " + " ".join(map(number, vertex)) + "\n")
            for face in faces:
                file.write("f " + " ".join(str(v + 1) for v in face) + "\n")
    with open(os.path.join(folder, "apple.ply"), "w", encoding="ascii") as file:
        file.write(ply(*apple()))


if __name__ == "__main__":
    main()
