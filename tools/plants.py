"""The little planet of scenes/instances.pbrt: its ground, its trees, and where they stand."""

import math
import random

from ply import Mesh, add, cross, dot, normalize, perpendicular, scale, smooth_normals, sub

RADIUS = 6.0
TREES = 1100


def tube(mesh, start, end, radius_start, radius_end, sides):
    """A branch, open at both ends."""
    x, y = perpendicular(normalize(sub(end, start)))
    points = []
    for centre, radius in ((start, radius_start), (end, radius_end)):
        for k in range(sides):
            angle = 2 * math.pi * k / sides
            points.append(add(centre, add(scale(x, radius * math.cos(angle)), scale(y, radius * math.sin(angle)))))
    triangles = []
    for k in range(sides):
        n = (k + 1) % sides
        triangles += [(k, n, sides + n), (k, sides + n, sides + k)]
    mesh.add(points, triangles)


def leaf(mesh, at, along, normal, length, width):
    """A rhombus, bent along its middle."""
    side = normalize(cross(normal, along))
    middle = add(at, scale(along, 0.45 * length))
    bend = scale(normal, 0.12 * length)
    points = [
        at,
        add(add(middle, scale(side, width / 2)), bend),
        add(at, scale(along, length)),
        add(add(middle, scale(side, -width / 2)), bend),
    ]
    mesh.add(points, [(0, 2, 1), (0, 3, 2)])


def random_direction(rng):
    z = rng.uniform(-1, 1)
    angle = rng.uniform(0, 2 * math.pi)
    r = math.sqrt(1 - z * z)
    return (r * math.cos(angle), r * math.sin(angle), z)


def broadleaf():
    """Wood and leaves of a tree about 1.6 high, grown by forking."""
    rng = random.Random(7)
    wood, leaves = Mesh(), Mesh()

    def grow(at, direction, length, radius, level):
        end = add(at, scale(direction, length))
        tube(wood, at, end, radius, 0.72 * radius, 6 if level < 2 else 4)
        if level >= 3:
            for k in range(4 if level == 3 else 8):
                spot = add(add(at, scale(direction, length * rng.uniform(0.3, 1.1))), scale(random_direction(rng), 0.05))
                along = normalize(add(random_direction(rng), scale(direction, 0.7)))
                normal, _ = perpendicular(along)
                normal = normalize(add(normal, scale(random_direction(rng), 0.8)))
                normal = normalize(sub(normal, scale(along, dot(normal, along))))
                leaf(leaves, spot, along, normal, rng.uniform(0.1, 0.15), 0.085)
        if level == 4:
            return
        x, y = perpendicular(direction)
        forks = 4 if level else 5
        turn = rng.uniform(0, 2 * math.pi)
        for k in range(forks):
            angle = turn + 2 * math.pi * (k + rng.uniform(-0.2, 0.2)) / forks
            tilt = rng.uniform(0.55, 0.95) if level else rng.uniform(0.5, 0.85)
            aside = add(scale(x, math.cos(angle)), scale(y, math.sin(angle)))
            child = add(scale(direction, math.cos(tilt)), scale(aside, math.sin(tilt)))
            child = normalize(add(child, (0.0, 0.12, 0.0)))
            grow(end, child, length * rng.uniform(0.58, 0.72), radius * 0.56, level + 1)

    grow((0.0, -0.1, 0.0), (0.0, 1.0, 0.0), 0.6, 0.06, 0)
    return wood, leaves


def conifer():
    """Wood and twigs of a tree about 1.9 high: whorls of drooping branches."""
    rng = random.Random(11)
    wood, twigs = Mesh(), Mesh()
    tube(wood, (0.0, -0.1, 0.0), (0.0, 1.85, 0.0), 0.055, 0.004, 6)
    whorls = 20
    for w in range(whorls):
        t = w / (whorls - 1)
        height = 0.26 + 1.54 * t
        reach = 0.5 * (1 - t) ** 0.85 + 0.04
        count = 7 + round(9 * (1 - t))
        turn = rng.uniform(0, 2 * math.pi)
        for k in range(count):
            angle = turn + 2 * math.pi * (k + rng.uniform(-0.25, 0.25)) / count
            length = reach * rng.uniform(0.8, 1.1)
            out = (math.cos(angle), 0.0, math.sin(angle))
            along = normalize(add(out, (0.0, rng.uniform(-0.5, -0.25), 0.0)))
            base = (0.0, height, 0.0)
            side = cross((0.0, 1.0, 0.0), out)
            for s in range(6):
                spot = add(base, scale(along, length * (0.12 + 0.15 * s)))
                for hand in (-1, 1):
                    twig = normalize(add(along, add(scale(side, hand * 0.9), (0.0, -0.15, 0.0))))
                    up = normalize(cross(side, along) if cross(side, along)[1] > 0 else cross(along, side))
                    normal = normalize(sub(up, scale(twig, dot(up, twig))))
                    leaf(twigs, spot, twig, normal, 0.1 + 0.28 * length * (1 - 0.12 * s), 0.035 + 0.05 * length)
    return wood, twigs


def height(direction):
    """The ground above the mean, in scene units, towards a unit vector: waves that run in scattered directions."""
    rng = random.Random(7)
    total = 0.0
    for frequency, amplitude in ((2.1, 0.30), (2.9, 0.24), (4.3, 0.15), (6.1, 0.09), (9.7, 0.045), (14.0, 0.03)):
        for _ in range(2):
            wave = random_direction(rng)
            total += amplitude * math.sin(frequency * dot(wave, direction) + rng.uniform(0, 2 * math.pi))
    return total


def ground():
    """The planet's land: an icosahedron divided four times, lifted by `height`."""
    g = (1 + math.sqrt(5)) / 2
    points = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g)]
    points += [(0, -1, -g), (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    points = [normalize(p) for p in points]
    triangles = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6), (7, 1, 8)]
    triangles += [(3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    for _ in range(4):
        middles, finer = {}, []

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                middles[key] = len(points)
                points.append(normalize(add(points[a], points[b])))
            return middles[key]

        for a, b, c in triangles:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        triangles = finer
    mesh = Mesh()
    mesh.points = [scale(p, RADIUS + height(p)) for p in points]
    mesh.triangles = triangles
    mesh.normals = smooth_normals(mesh)
    return mesh


def meshes():
    """All of them by name."""
    (maple_wood, maple_leaves), (fir_wood, fir_twigs) = broadleaf(), conifer()
    return {
        "maple-wood": maple_wood,
        "maple-leaves": maple_leaves,
        "fir-wood": fir_wood,
        "fir-twigs": fir_twigs,
        "planet": ground(),
    }


def forest_text():
    """The trees: a spiral over the sphere, where there is land. Broadleaf trees grow low, firs high."""
    rng = random.Random(5)
    golden = math.pi * (3 - math.sqrt(5))
    lines = ["# By tools/make_scene_parts.py: the trees of the planet."]
    for i in range(TREES):
        y = 1 - 2 * (i + 0.5) / TREES
        r = math.sqrt(1 - y * y)
        direction = normalize(add((r * math.cos(golden * i), y, r * math.sin(golden * i)), scale(random_direction(rng), 0.05)))
        spin, size, choice = rng.uniform(0, 360), rng.uniform(0.75, 1.2), rng.random()
        lift = height(direction)
        if lift < 0.08:
            continue
        if lift + 0.3 * (choice - 0.5) > 0.36:
            name = "fir"
        else:
            name = rng.choice(["maple green", "maple green", "maple gold", "maple red"])
        # From the y axis to the direction, around their common normal.
        angle = math.degrees(math.acos(direction[1]))
        lines.append(
            f"AttributeBegin Rotate {angle:.2f} {direction[2]:.4f} 0 {-direction[0]:.4f} Translate 0 {RADIUS + lift - 0.02:.3f} 0 "
            f'Rotate {spin:.0f} 0 1 0 Scale {size:.2f} {size:.2f} {size:.2f} ObjectInstance "{name}" AttributeEnd'
        )
    return "\n".join(lines) + "\n"
