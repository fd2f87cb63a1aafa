#!/usr/bin/env python3
"""Writes a wavy square of many triangles as binary PLY: what loading is measured with.

    tools/make_large_ply.py 10000000 /tmp/large.ply

The number of triangles is rounded to that of a square grid. Needs numpy.
"""

import sys

import numpy as np


def main(triangles: int, path: str) -> None:
    side = round((triangles / 2) ** 0.5)
    at = np.linspace(-1, 1, side + 1, dtype=np.float32)
    x, z = np.meshgrid(at, at)
    y = (0.1 * np.sin(9 * x) * np.cos(7 * z) + 0.01 * np.sin(90 * x * z)).astype("<f4")
    vertices = np.stack([x.astype("<f4"), y, z.astype("<f4")], axis=-1).reshape(-1, 3)
    first = (np.arange(side)[:, None] * (side + 1) + np.arange(side)[None, :]).reshape(-1)
    corners = np.stack([first, first + side + 1, first + 1, first + 1, first + side + 1, first + side + 2], axis=-1)
    faces = np.zeros(2 * side * side, dtype=[("count", "u1"), ("corners", "<i4", 3)])
    faces["count"] = 3
    faces["corners"] = corners.reshape(-1, 3)
    header = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(vertices)}\nproperty float x\nproperty float y\nproperty float z\n"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    with open(path, "wb") as file:
        file.write(header.encode())
        vertices.tofile(file)
        faces.tofile(file)
    print(f"{path}: {len(vertices)} vertices, {len(faces)} triangles")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(int(sys.argv[1]), sys.argv[2])
