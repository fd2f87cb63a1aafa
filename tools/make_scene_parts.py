#!/usr/bin/env python3
"""Writes scenes/parts/: the meshes, the lists of instances and the pictures that the scenes share. They are committed; this says where they come
from. Needs nothing but Python 3. The same Python gives the same bytes.

    python3 tools/make_scene_parts.py
"""

import math
import pathlib
import random

import lamps
import plants
from pictures import png
from ply import Mesh, lathe, normalize, spline

PARTS = pathlib.Path(__file__).resolve().parent.parent / "scenes" / "parts"


def goblet():
    """A wine glass, 2.4 high, wall 0.03 thick: one closed surface around the glass."""
    outside = spline([(0.0, 0.0), (0.35, 0.0), (0.68, 0.0), (0.71, 0.03)], 4)
    outside += spline([(0.68, 0.06), (0.4, 0.1), (0.13, 0.2), (0.075, 0.5), (0.075, 0.85), (0.13, 1.03), (0.36, 1.16)], 5)[:-1]
    outside += spline([(0.36, 1.16), (0.62, 1.42), (0.68, 1.7), (0.62, 2.05), (0.53, 2.385)], 6)
    inside = spline([(0.515, 2.4), (0.5, 2.385), (0.588, 2.05), (0.647, 1.7), (0.59, 1.43), (0.34, 1.2), (0.12, 1.12), (0.0, 1.1)], 5)
    return lathe(outside + inside, 64)


def pawn():
    """A chess pawn, 1.5 high."""
    points = [
        (0.0, 0.0), (0.3, 0.0), (0.46, 0.0), (0.5, 0.06), (0.48, 0.16), (0.4, 0.22), (0.4, 0.26), (0.36, 0.34), (0.25, 0.46),
        (0.18, 0.66), (0.15, 0.86), (0.17, 0.93), (0.27, 0.96), (0.28, 1.0), (0.24, 1.03), (0.16, 1.05),
    ]
    neck = math.asin(0.13 / 0.26)
    head = [(0.26 * math.sin(a), 1.27 - 0.26 * math.cos(a)) for a in (neck + (math.pi - neck) * k / 14 for k in range(15))]
    return lathe(spline(points, 3) + head[:-1] + [(0.0, 1.53)], 48)


def gem():
    """A brilliant: an octagonal table, a crown of triangles, a girdle and a pavilion that ends in a point. Flat faces, around the
    y axis, girdle of radius 1 at y = 0."""
    mesh = Mesh()

    def ring(radius, height, turn):
        first = len(mesh.points)
        for k in range(8):
            angle = math.pi / 4 * (k + turn)
            mesh.points.append((radius * math.cos(angle), height, -radius * math.sin(angle)))
        return [first + k for k in range(8)]

    def band(low, high):
        """Triangles between two rings; the higher one is half a step ahead."""
        for k in range(8):
            n = (k + 1) % 8
            mesh.triangles.append((low[k], low[n], high[k]))
            mesh.triangles.append((low[n], high[n], high[k]))

    table, crown = ring(0.56, 0.34, 0.5), ring(0.8, 0.19, 0.0)
    girdle_high, girdle_low = ring(1.0, 0.02, 0.5), ring(1.0, -0.02, 0.5)
    mesh.points.append((0.0, -0.86, 0.0))
    tip = len(mesh.points) - 1
    band(crown, table)
    mesh.triangles += [(table[0], table[k], table[k + 1]) for k in range(1, 7)]
    for k in range(8):
        n, before = (k + 1) % 8, (k - 1) % 8
        mesh.triangles.append((girdle_high[before], girdle_high[k], crown[k]))
        mesh.triangles.append((girdle_high[k], crown[n], crown[k]))
        mesh.triangles.append((girdle_low[k], girdle_low[n], girdle_high[n]))
        mesh.triangles.append((girdle_low[k], girdle_high[n], girdle_high[k]))
        mesh.triangles.append((tip, girdle_low[n], girdle_low[k]))
    return mesh


def backdrop():
    """A photographer's paper sweep: floor y = 0 from z = -12, a quarter circle, a wall at z = 6 up to y = 12."""
    profile = [(-12.0, 0.0, 0.0)] + [
        (2.5 + 3.5 * math.sin(a), 3.5 - 3.5 * math.cos(a), a) for a in (math.pi / 2 * k / 24 for k in range(25))
    ] + [(6.0, 12.0, math.pi / 2)]
    mesh = Mesh()
    for z, y, angle in profile:
        for x in (-16.0, 16.0):
            mesh.points.append((x, y, z))
            mesh.normals.append((0.0, math.cos(angle), -math.sin(angle)))
    for row in range(len(profile) - 1):
        a = 2 * row
        mesh.triangles += [(a, a + 2, a + 3), (a, a + 3, a + 1)]
    return mesh


def ring():
    """A ring of outer radius 1.06 and inner radius 1, 0.36 high, its edges rounded, around the y axis; it stands on y = 0."""
    edge = 0.03
    outer, inner = 1.03, 1.03

    def quarter(height, first):
        return [
            (outer + edge * math.cos(a), height + edge * math.sin(a)) for a in (math.radians(first + 22.5 * k) for k in range(5))
        ]

    low, high = edge, 0.36 - edge
    profile = quarter(low, -90) + quarter(high, 0) + quarter(high, 90)[1:] + quarter(low, 180)
    return lathe(profile, 192)


def waves():
    """The surface of a pool, y near 0, -1.62 to 1.62 in x and z: waves that run in many directions, with their true normals."""
    mesh = Mesh()
    count, half = 96, 1.62
    trains = []
    for k in range(9):
        angle = 2.4 * k + 0.5
        number = 3.4 + 1.15 * k
        trains.append((number * math.cos(angle), number * math.sin(angle), 0.32 / number**1.75, 1.7 * k * k))
    for i in range(count + 1):
        for j in range(count + 1):
            x, z = half * (2 * i / count - 1), half * (2 * j / count - 1)
            y, slope_x, slope_z = 0.0, 0.0, 0.0
            for kx, kz, height, phase in trains:
                y += height * math.sin(kx * x + kz * z + phase)
                slope = height * math.cos(kx * x + kz * z + phase)
                slope_x, slope_z = slope_x + kx * slope, slope_z + kz * slope
            mesh.points.append((x, y, z))
            mesh.normals.append(normalize((-slope_x, 1.0, -slope_z)))
    for i in range(count):
        for j in range(count):
            a = i * (count + 1) + j
            b = a + count + 1
            mesh.triangles += [(a, a + 1, b + 1), (a, b + 1, b)]
    return mesh


def board(parity):
    """Every second square of a board in the plane y = 0; squares of side 1.2."""
    mesh = Mesh()
    for i in range(-7, 12):
        for j in range(-5, 12):
            if (i + j) % 2 == parity:
                corners = [(1.2 * x, 0.0, 1.2 * z) for x, z in ((i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j))]
                mesh.add(corners, [(0, 1, 2), (0, 2, 3)])
    return mesh


def vane():
    """One curled sheet of a pinwheel in the plane z = 0, the hub at the origin, radius 1; 45 degrees wide."""
    mesh = Mesh()
    rows, columns = 12, 10
    for i in range(rows + 1):
        radius = 0.06 + 0.94 * i / rows
        for j in range(columns + 1):
            t = j / columns
            angle = math.radians(52) * t * (0.35 + 0.65 * radius)
            reach = radius * (1 - 0.28 * t * t)
            lift = -0.34 * radius * math.sin(math.pi / 2 * t) ** 2 * (1.25 - 0.5 * radius)
            mesh.points.append((reach * math.cos(angle), reach * math.sin(angle), lift))
    for i in range(rows):
        for j in range(columns):
            a = i * (columns + 1) + j
            b = a + columns + 1
            mesh.triangles += [(a, b, b + 1), (a, b + 1, a + 1)]
    return mesh


def flag_text():
    """A pennant that flutters: the vertices at the start and at the end of the motion, as text, for they are "P" and "P1"."""
    rows, columns = 8, 28

    def points(phase):
        numbers = []
        for i in range(rows + 1):
            for j in range(columns + 1):
                x = j / columns
                height = (i / rows - 0.5) * (1 - 0.93 * x)
                wave = 0.2 * math.sqrt(x) * math.sin(7.5 * x - phase)
                drop = -0.1 * x * x
                numbers.append(f"{1.9 * x:.3f} {height + drop + 0.8 * wave:.3f} {wave:.3f}")
        return "\n        ".join("  ".join(numbers[k:k + 6]) for k in range(0, len(numbers), 6))

    indices = []
    for i in range(rows):
        for j in range(columns):
            a = i * (columns + 1) + j
            b = a + columns + 1
            indices.append(f"{a} {a + 1} {b + 1}  {a} {b + 1} {b}")
    indices = "\n        ".join("   ".join(indices[k:k + 5]) for k in range(0, len(indices), 5))
    return (
        "# By tools/make_scene_parts.py. A pennant at a pole along y; it moves from P to P1.\n"
        'Shape "trianglemesh"\n'
        f'    "integer indices" [\n        {indices}\n    ]\n'
        f'    "point3 P" [\n        {points(0.0)}\n    ]\n'
        f'    "point3 P1" [\n        {points(1.1)}\n    ]\n'
    )


def lock_text():
    """A lock of wavy hair that hangs along y, from 1.2 to -1.2, about 0.5 thick."""
    numbers = random.Random(7)
    lines = ["# By tools/make_scene_parts.py. A lock of hair."]
    for _ in range(260):
        angle, radius = 2 * math.pi * numbers.random(), 0.22 * math.sqrt(numbers.random())
        phase, length = 0.7 * numbers.random(), 2.2 + 0.25 * numbers.random()
        x0, z0 = radius * math.cos(angle), radius * math.sin(angle)
        points = []
        for k in range(-1, 11):
            t = k / 9
            spread = 1 - 0.35 * t
            x = spread * x0 + 0.1 * math.sin(4.5 * t + phase)
            z = spread * z0 + 0.1 * math.cos(4.5 * t + phase)
            points.append(f"{x:.3f} {1.2 - length * t:.3f} {z:.3f}")
        lines.append(
            'Shape "curve" "string type" "cylinder" "string basis" "bspline" "float width0" 0.009 "float width1" 0.004'
            f' "point3 P" [{"  ".join(points)}]'
        )
    return "\n".join(lines) + "\n"


def brick(x, y):
    """Where a pixel of the 64 x 64 picture of bricks is: which brick, and its distances from the joints, in pixels."""
    row = y // 16
    along = (x + (row % 2) * 16) % 64
    column, dx, dy = along // 32, along % 32, y % 16
    return row * 2 + column, min(dx, 31 - dx), min(dy, 15 - dy)


def brick_colour(x, y):
    """Eight bricks of eight colours, and mortar."""
    index, dx, dy = brick(x, y)
    if min(dx, dy) < 1:
        return (150, 144, 132)
    shade = (math.sin(index * 12.9898) * 43758.5453) % 1.0
    grain = (math.sin(x * 78.233 + y * 37.719) * 12543.123) % 1.0
    light = 0.75 + 0.35 * shade + 0.12 * (grain - 0.5)
    return tuple(min(255, round(light * c)) for c in (176, 88, 62))


def brick_normal(x, y):
    """The normals of bricks with round edges, (1 + n) / 2 by colour: x to the right, y up."""
    def height(x, y):
        _, dx, dy = brick(x % 64, y % 64)
        return 1.6 * min(1.0, min(dx, dy) / 3.0) ** 0.5
    n = ((height(x - 1, y) - height(x + 1, y)) / 2, (height(x, y + 1) - height(x, y - 1)) / 2, 1.0)
    length = math.sqrt(sum(c * c for c in n))
    return tuple(round(127.5 * (1 + c / length)) for c in n)


def tile_colour(x, y):
    """Tiles of 12 pixels with joints of one, 10 by 10, of blues that differ a little."""
    column, row = x // 13, y // 13
    if x % 13 == 12 or y % 13 == 12:
        return (188, 200, 200)
    shade = (math.sin(column * 12.9898 + row * 78.233) * 43758.5453) % 1.0
    light = 0.86 + 0.14 * shade
    return tuple(round(light * c) for c in (96, 182, 208))


def plank_colour(x, y):
    """Boards of 64 pixels along y, of light wood: grain that wanders, and a dark joint between boards."""
    board, across = x // 64, x % 64
    seed = (math.sin(board * 12.9898 + 4.0) * 43758.5453) % 1.0
    turn = 2 * math.pi * y / 256
    wander = 5 * math.sin(turn + 9 * seed) + 2 * math.sin(3 * turn + 17 * seed) + 0.8 * math.sin(7 * turn + 5 * seed)
    u = across + wander + 40 * seed
    grain = 0.5 + 0.25 * math.sin(0.55 * u) + 0.15 * math.sin(1.31 * u + 0.5 * math.sin(2 * turn)) + 0.1 * math.sin(2.9 * u)
    light = (0.86 + 0.14 * grain) * (0.94 + 0.06 * seed)
    if across == 0:
        light *= 0.72
    return tuple(round(light * c) for c in (226, 196, 158))


def leaf_alpha(x, y):
    """A leaf of five lobes, white on black, smooth at its edge."""
    u, v = (x - 63.5) / 64, (63.5 - y) / 64
    angle = math.atan2(u, v + 0.25)
    radius = math.hypot(u, v + 0.25)
    edge = 0.72 * (0.55 + 0.45 * abs(math.cos(2.5 * angle)) ** 0.6) * (1.0 - 0.3 * abs(angle) / math.pi)
    stem = abs(u) < 0.03 and -0.95 < v < 0
    inside = max((edge - radius) * 24, 1.0 if stem else -1.0)
    return (round(255 * max(0.0, min(1.0, 0.5 + inside))),)


def main():
    PARTS.mkdir(exist_ok=True)
    pictures = {
        "bricks": png(64, 64, brick_colour),
        "bricks-normal": png(64, 64, brick_normal),
        "leaf": png(128, 128, leaf_alpha),
        "planks": png(256, 256, plank_colour),
        "tiles": png(130, 130, tile_colour),
    }
    for name, content in pictures.items():
        path = PARTS / f"{name}.png"
        path.write_bytes(content)
        print(f"{path.name}: {len(content)} bytes")
    meshes = {
        "backdrop": backdrop(),
        "board-dark": board(1),
        "board-light": board(0),
        "gem": gem(),
        "goblet": goblet(),
        "pawn": pawn(),
        "ring": ring(),
        "vane": vane(),
        "waves": waves(),
        **lamps.meshes(),
        **plants.meshes(),
    }
    for name, mesh in meshes.items():
        path = PARTS / f"{name}.ply.gz"
        mesh.write(path)
        print(f"{path.name}: {len(mesh.triangles)} triangles, {path.stat().st_size} bytes")
    for name, text in {
        "forest": plants.forest_text(),
        "lock": lock_text(),
        "pennant": flag_text(),
        "poles": lamps.pole_text(),
    }.items():
        path = PARTS / f"{name}.pbrt"
        path.write_text(text)
        print(f"{path.name}: {len(text)} bytes")


main()
