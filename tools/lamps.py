"""Garlands of lamps over a square: thousands of small triangles that emit."""

import math

from ply import Mesh

# A lamp's corners (an octahedron, taller than wide) and its faces, counter-clockwise seen from outside.
CORNERS = [(1, 0, 0), (0, 0, 1), (-1, 0, 0), (0, 0, -1), (0, 1.4, 0), (0, -1.4, 0)]
FACES = [(4, 1, 0), (4, 2, 1), (4, 3, 2), (4, 0, 3), (5, 0, 1), (5, 1, 2), (5, 2, 3), (5, 3, 0)]


def poles():
    """Where the poles stand: a grid of 5 x 6 over the square, (x, z)."""
    return [(-8 + 4 * i, -2 + 4 * j) for i in range(5) for j in range(6)]


def garlands():
    """Lines from pole to pole: pairs of points at the height of the poles' tips."""
    lines = []
    for i in range(5):
        for j in range(6):
            here = (-8 + 4 * i, -2 + 4 * j)
            if i < 4:
                lines.append((here, (here[0] + 4, here[1])))
            if j < 5:
                lines.append((here, (here[0], here[1] + 4)))
            if i < 4 and j < 5 and (i + j) % 2 == 0:
                lines.append((here, (here[0] + 4, here[1] + 4)))
    return lines


def meshes():
    """One mesh a colour."""
    colours = {name: Mesh() for name in ("red", "amber", "green", "blue")}
    count = 0
    for (x0, z0), (x1, z1) in garlands():
        lamps = round(5 * math.hypot(x1 - x0, z1 - z0))
        for k in range(1, lamps):
            t = k / lamps
            x, z = x0 + (x1 - x0) * t, z0 + (z1 - z0) * t
            y = 3.0 - 3.2 * t * (1 - t)
            size = 0.028 + 0.008 * math.sin(12.9 * count)
            mesh = colours[("amber", "red", "amber", "blue", "amber", "green")[(count * 7 + count // 11) % 6]]
            mesh.add([(x + size * a, y + size * b, z + size * c) for a, b, c in CORNERS], FACES)
            count += 1
    return {f"lamps-{name}": mesh for name, mesh in colours.items()}


def pole_text():
    """The poles as instances of the object `pole`."""
    lines = ["# By tools/make_scene_parts.py. Poles of the garlands."]
    for x, z in poles():
        lines.append(f'AttributeBegin Translate {x} 0 {z} ObjectInstance "pole" AttributeEnd')
    return "\n".join(lines) + "\n"
