"""Meshes as lists of points and triangles, and the PLY files that Lucerna reads."""

import gzip
import math
import struct


class Mesh:
    """Vertices, their shading normals (or none) and triangles, counter-clockwise seen from outside."""

    def __init__(self):
        self.points = []
        self.normals = []
        self.triangles = []

    def add(self, points, triangles):
        """Appends another mesh without normals."""
        first = len(self.points)
        self.points.extend(points)
        self.triangles.extend(tuple(first + i for i in triangle) for triangle in triangles)

    def write(self, path):
        """Writes a compressed binary PLY file; the same mesh gives the same bytes. Rounding makes it smaller."""
        names = ["x", "y", "z"] + (["nx", "ny", "nz"] if self.normals else [])
        index = "ushort" if len(self.points) <= 0xFFFF else "uint"
        header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(self.points)}"]
        header += [f"property float {name}" for name in names]
        header += [f"element face {len(self.triangles)}", f"property list uchar {index} vertex_indices", "end_header", ""]
        data = bytearray("\n".join(header).encode())
        for i, point in enumerate(self.points):
            data += struct.pack("<3f", *rounded(point))
            if self.normals:
                data += struct.pack("<3f", *rounded(self.normals[i]))
        row = "<B3H" if index == "ushort" else "<B3I"
        for triangle in self.triangles:
            data += struct.pack(row, 3, *triangle)
        with open(path, "wb") as file:
            file.write(gzip.compress(bytes(data), 9, mtime=0))


def rounded(a):
    """To multiples of 2^-14."""
    return tuple(round(x * 16384) / 16384 for x in a)


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def scale(a, s):
    return tuple(x * s for x in a)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def normalize(a):
    return scale(a, 1 / math.sqrt(dot(a, a)))


def perpendicular(a):
    """Two unit vectors that make a right-handed frame with the unit vector `a` as the third."""
    helper = (1, 0, 0) if abs(a[0]) < 0.6 else (0, 1, 0)
    x = normalize(cross(helper, a))
    return x, cross(a, x)


def smooth_normals(mesh):
    """The area-weighted mean normal of the triangles around each vertex."""
    sums = [(0.0, 0.0, 0.0)] * len(mesh.points)
    for triangle in mesh.triangles:
        a, b, c = (mesh.points[i] for i in triangle)
        normal = cross(sub(b, a), sub(c, a))
        for i in triangle:
            sums[i] = add(sums[i], normal)
    return [normalize(total) for total in sums]


def lathe(profile, segments):
    """The surface that a profile of (radius, height) sweeps around the y axis, outside on its right as it goes up. Where the radius is
    0 it closes. Corners are smoothed: a profile repeats the points next to a sharp edge."""
    mesh = Mesh()
    for radius, height in profile:
        for k in range(segments):
            angle = 2 * math.pi * k / segments
            mesh.points.append((radius * math.cos(angle), height, -radius * math.sin(angle)))
    for row in range(len(profile) - 1):
        for k in range(segments):
            a, b = row * segments + k, row * segments + (k + 1) % segments
            c, d = a + segments, b + segments
            if profile[row][0] > 0:
                mesh.triangles.append((a, b, d))
            if profile[row + 1][0] > 0:
                mesh.triangles.append((a, d, c))
    # By the profile, so that neither poles nor uneven rows tilt them.
    for row, (radius, _) in enumerate(profile):
        before, after = profile[max(row - 1, 0)], profile[min(row + 1, len(profile) - 1)]
        along = (after[0] - before[0], after[1] - before[1])
        length = math.hypot(*along) or 1
        out, up = along[1] / length, -along[0] / length
        if radius == 0:
            out, up = 0.0, math.copysign(1, up)
        for k in range(segments):
            angle = 2 * math.pi * k / segments
            mesh.normals.append((out * math.cos(angle), up, -out * math.sin(angle)))
    return mesh


def spline(points, steps):
    """A Catmull-Rom curve through (radius, height) points, `steps` pieces between two of them. Radii stay at 0 or more."""
    curve = []
    for i in range(len(points) - 1):
        a, b, c, d = (points[min(max(k, 0), len(points) - 1)] for k in (i - 1, i, i + 1, i + 2))
        for step in range(steps):
            t = step / steps
            weights = (
                (-t + 2 * t**2 - t**3) / 2,
                (2 - 5 * t**2 + 3 * t**3) / 2,
                (t + 4 * t**2 - 3 * t**3) / 2,
                (-(t**2) + t**3) / 2,
            )
            curve.append(tuple(sum(w * p[axis] for w, p in zip(weights, (a, b, c, d))) for axis in (0, 1)))
    curve.append(points[-1])
    return [(max(radius, 0.0), height) for radius, height in curve]
