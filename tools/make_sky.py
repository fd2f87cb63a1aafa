#!/usr/bin/env python3
"""Writes scenes/parts/sky.exr: an evening sky by latitude and longitude, +z up, with a low sun, clouds and dark ground. It is committed;
this says where it comes from. Needs nothing but Python 3.

    python3 tools/make_sky.py
"""

import math
import pathlib
import struct
import zlib

WIDTH, HEIGHT = 256, 128
SUN = (0.62, math.radians(9))  # Azimuth in turns, elevation.
OUT = pathlib.Path(__file__).resolve().parent.parent / "scenes" / "parts" / "sky.exr"


def noise(x, y, z):
    """Smooth value noise on the integer lattice, in [0, 1]."""
    def corner(i, j, k):
        n = (i * 374761393 + j * 668265263 + k * 2147483647) & 0xFFFFFFFF
        n = ((n ^ (n >> 13)) * 1274126177) & 0xFFFFFFFF
        return ((n ^ (n >> 16)) & 0xFFFF) / 0xFFFF

    i, j, k = math.floor(x), math.floor(y), math.floor(z)
    f = [t * t * (3 - 2 * t) for t in (x - i, y - j, z - k)]
    total = 0.0
    for a in (0, 1):
        for b in (0, 1):
            for c in (0, 1):
                weight = (f[0] if a else 1 - f[0]) * (f[1] if b else 1 - f[1]) * (f[2] if c else 1 - f[2])
                total += weight * corner(i + a, j + b, k + c)
    return total


def mix(a, b, t):
    return tuple(x + (y - x) * t for x, y in zip(a, b))


def radiance(w):
    """Linear sRGB in the direction w."""
    azimuth = 2 * math.pi * SUN[0]
    sun = (math.cos(SUN[1]) * math.cos(azimuth), math.cos(SUN[1]) * math.sin(azimuth), math.sin(SUN[1]))
    cos = sum(a * b for a, b in zip(w, sun))
    if w[2] < 0:
        return mix((0.10, 0.08, 0.07), (0.05, 0.045, 0.04), min(1.0, -3 * w[2]))
    height = w[2] ** 0.45
    near = max(0.0, 0.5 + 0.5 * cos) ** 3
    sky = mix(mix((0.42, 0.38, 0.48), (1.5, 0.72, 0.32), near), (0.10, 0.19, 0.42), height)
    glow = 2.5 * math.exp(-(1 - cos) / 0.01) + 0.6 * math.exp(-(1 - cos) / 0.08)
    sky = tuple(s + glow * g for s, g in zip(sky, (1.0, 0.62, 0.3)))
    # Clouds on a plane overhead, seen in perspective; the sun lights their edges.
    x, y = w[0] / (w[2] + 0.08), w[1] / (w[2] + 0.08)
    density = sum(noise(x * 2 ** k * 0.8, y * 2 ** k * 1.7, 3.1 * k) / 2 ** k for k in range(4)) / 1.875
    cover = min(1.0, max(0.0, (density - 0.48) * 6)) * min(1.0, w[2] * 8)
    cloud = mix((0.30, 0.27, 0.33), (1.7, 0.85, 0.45), near * (1.2 - density))
    sky = mix(sky, cloud, 0.8 * cover)
    if cos > math.cos(math.radians(2)):
        sky = tuple(s + c for s, c in zip(sky, (900.0, 560.0, 250.0)))
    return sky


def rows():
    for y in range(HEIGHT):
        theta = math.pi * (y + 0.5) / HEIGHT
        row = []
        for x in range(WIDTH):
            phi = 2 * math.pi * (x + 0.5) / WIDTH
            row.append(radiance((math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta))))
        yield row


def attribute(name, kind, value):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value


def exr(pixels):
    """An OpenEXR file of half floats, blocks of 16 rows by ZIP."""
    box = struct.pack("<4i", 0, 0, WIDTH - 1, HEIGHT - 1)
    channels = b"".join(name + b"\0" + struct.pack("<iB3xii", 1, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    header = b"\x76\x2f\x31\x01" + struct.pack("<i", 2)
    header += attribute("channels", "chlist", channels)
    header += attribute("compression", "compression", b"\x03")
    header += attribute("dataWindow", "box2i", box) + attribute("displayWindow", "box2i", box)
    header += attribute("lineOrder", "lineOrder", b"\0")
    header += attribute("pixelAspectRatio", "float", struct.pack("<f", 1.0))
    header += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
    header += attribute("screenWindowWidth", "float", struct.pack("<f", 1.0)) + b"\0"
    blocks = []
    for first in range(0, HEIGHT, 16):
        data = b"".join(
            struct.pack(f"<{WIDTH}e", *(pixel[channel] for pixel in row))
            for row in pixels[first:first + 16]
            for channel in (2, 1, 0)
        )
        # Even bytes before odd ones, then differences.
        data = data[0::2] + data[1::2]
        data = bytes([data[0]]) + bytes((b - a + 128) & 0xFF for a, b in zip(data, data[1:]))
        packed = zlib.compress(data, 9)
        blocks.append(struct.pack("<2i", first, len(packed)) + packed)
    offset = len(header) + 8 * len(blocks)
    table = b""
    for block in blocks:
        table += struct.pack("<Q", offset)
        offset += len(block)
    return header + table + b"".join(blocks)


OUT.write_bytes(exr(list(rows())))
print(f"{OUT.name}: {OUT.stat().st_size} bytes")
