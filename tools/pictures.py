"""PNG files of the small pictures that scenes use as textures: 8 bits, written without any library but zlib."""

import struct
import zlib


def png(width, height, pixel):
    """The bytes of a PNG file, r, g, b (or grey, or r, g, b, a) by `pixel(x, y)` as integers of 0 to 255."""
    rows = []
    channels = 1
    for y in range(height):
        row = bytearray(b"\0")
        for x in range(width):
            value = pixel(x, y)
            channels = len(value)
            row += bytes(value)
        rows.append(bytes(row))
    colour_type = {1: 0, 3: 2, 4: 6}[channels]

    def chunk(kind, content):
        checksum = zlib.crc32(kind + content)
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", checksum)

    header = struct.pack(">IIBBBBB", width, height, 8, colour_type, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(b"".join(rows), 9)) + chunk(b"IEND", b"")
