#!/usr/bin/env python3
"""Writes a measured material in RGL's tensor format (Dupuy and Jakob 2018) from an analytic one: a metal with isotropic GGX facets.

    tools/make_measured_ggx.py scenes/parts/measured-ggx.bsdf

No database of measurements is needed to test the reader and the lobe: the values of this file are known in closed form.
"""

import bisect
import math
import struct
import sys

ALPHA = 0.4
# Wavelength in nm and reflectance head on (Schlick's approximation): a copper-like colour.
SPECTRUM = [(360.0, 0.3), (500.0, 0.4), (600.0, 0.9), (830.0, 0.95)]
THETAS = [math.radians(t) for t in (0, 10, 20, 30, 40, 50, 60, 68, 75, 81, 86, 89)]
VNDF = 32  # grid of normals, each way
GRID = 20  # grid of samples, each way


def smith_lambda(w):
    tan2 = (w[0] ** 2 + w[1] ** 2) / w[2] ** 2
    return 0.5 * (math.sqrt(1.0 + ALPHA**2 * tan2) - 1.0)


def ndf(m):
    e = (m[0] ** 2 + m[1] ** 2) / ALPHA**2 + m[2] ** 2
    return 1.0 / (math.pi * ALPHA**2 * e * e)


def direction(theta, phi):
    return (math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta))


def normal(u, v):
    """The unit square of normals: theta = u^2 pi / 2, phi = (2 v - 1) pi."""
    return direction(u * u * math.pi / 2, (2 * v - 1) * math.pi)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def visible_normals(wo):
    """Rows by v, columns by u: the density of visible normals over the unit square, up to a factor."""
    rows = []
    for j in range(VNDF):
        row = []
        for i in range(VNDF):
            u, v = i / (VNDF - 1), j / (VNDF - 1)
            m = normal(u, v)
            jacobian = u * math.sin(u * u * math.pi / 2)
            row.append(max(dot(wo, m), 0.0) * ndf(m) * jacobian)
        rows.append(row)
    return rows


def invert_linear(s, a, b):
    """x with s = the integral of a (1 - t) + b t from 0 to x."""
    denominator = a + math.sqrt(max(a * a + 2.0 * s * (b - a), 0.0))
    return 2.0 * s / denominator if denominator > 0.0 else 0.0


class Warp:
    """Samples of a bilinear density over the unit square: rows first, then columns."""

    def __init__(self, rows):
        self.rows = rows
        self.sums = []
        for row in rows:
            sums = [0.0]
            for a, b in zip(row, row[1:]):
                sums.append(sums[-1] + 0.5 * (a + b))
            self.sums.append(sums)
        self.marginal = [0.0]
        for a, b in zip(self.sums, self.sums[1:]):
            self.marginal.append(self.marginal[-1] + 0.5 * (a[-1] + b[-1]))

    def sample(self, x, y):
        y *= self.marginal[-1]
        j = min(bisect.bisect_right(self.marginal, y) - 1, len(self.rows) - 2)
        t = invert_linear(y - self.marginal[j], self.sums[j][-1], self.sums[j + 1][-1])
        t = min(max(t, 0.0), 1.0)
        mix = lambda a, b: a * (1.0 - t) + b * t
        sums = [mix(a, b) for a, b in zip(self.sums[j], self.sums[j + 1])]
        row = [mix(a, b) for a, b in zip(self.rows[j], self.rows[j + 1])]
        x *= sums[-1]
        i = min(bisect.bisect_right(sums, x) - 1, len(row) - 2)
        s = min(max(invert_linear(x - sums[i], row[i], row[i + 1]), 0.0), 1.0)
        return (i + s) / (len(row) - 1), (j + t) / (len(self.rows) - 1)


def reflected(wo, m, f0):
    """F G2 / G1: f is this times D / (4 sigma cos_i), where sigma = cos_o / G1."""
    cos = dot(wo, m)
    wi = tuple(2.0 * cos * a - b for a, b in zip(m, wo))
    # The table goes on smoothly to grazing directions, below which the lobe asks for nothing.
    wi = (wi[0], wi[1], max(wi[2], 1e-3))
    fresnel = f0 + (1.0 - f0) * (1.0 - max(cos, 0.0)) ** 5
    return fresnel * (1.0 + smith_lambda(wo)) / (1.0 + smith_lambda(wo) + smith_lambda(wi))


def tensors():
    vndf, luminance, spectra = [], [], []
    for theta in THETAS:
        wo = direction(theta, 0.0)
        rows = visible_normals(wo)
        vndf += [value for row in rows for value in row]
        warp = Warp(rows)
        points = [warp.sample(i / (GRID - 1), j / (GRID - 1)) for j in range(GRID) for i in range(GRID)]
        normals = [normal(u, v) for u, v in points]
        luminance += [reflected(wo, m, 0.6) for m in normals]
        for _, f0 in SPECTRUM:
            spectra += [reflected(wo, m, f0) for m in normals]
    table = [[0.0] * 128 for _ in range(2)]
    areas = [[0.0] * 128 for _ in range(2)]
    for i in range(128):
        w = normal(i / 127, 0.5)
        w = (w[0], w[1], max(w[2], 1e-6))
        for j in range(2):
            table[j][i] = ndf(w)
            areas[j][i] = w[2] * (1.0 + smith_lambda(w))
    flat = lambda rows: [value for row in rows for value in row]
    lines = len(SPECTRUM)
    return [
        ("description", 1, [len(TEXT)], TEXT),
        ("jacobian", 1, [1], b"\1"),
        ("phi_i", 10, [1], [0.0]),
        ("theta_i", 10, [len(THETAS)], THETAS),
        ("wavelengths", 10, [lines], [nm for nm, _ in SPECTRUM]),
        ("ndf", 10, [2, 128], flat(table)),
        ("sigma", 10, [2, 128], flat(areas)),
        ("vndf", 10, [1, len(THETAS), VNDF, VNDF], vndf),
        ("luminance", 10, [1, len(THETAS), GRID, GRID], luminance),
        ("spectra", 10, [1, len(THETAS), lines, GRID, GRID], spectra),
    ]


TEXT = f"analytic GGX, alpha {ALPHA}".encode()


def main():
    fields = [
        (name.encode(), kind, shape, data if isinstance(data, bytes) else struct.pack(f"<{len(data)}f", *data))
        for name, kind, shape, data in tensors()
    ]
    header = b"tensor_file\0" + bytes([1, 0]) + struct.pack("<I", len(fields))
    size = len(header) + sum(2 + len(n) + 2 + 1 + 8 + 8 * len(s) for n, _, s, _ in fields)
    entries, blob = b"", b""
    for name, kind, shape, data in fields:
        entries += struct.pack("<H", len(name)) + name + struct.pack("<HBQ", len(shape), kind, size + len(blob))
        entries += struct.pack(f"<{len(shape)}Q", *shape)
        blob += data
    with open(sys.argv[1], "wb") as file:
        file.write(header + entries + blob)


if __name__ == "__main__":
    main()
