#!/usr/bin/env python3
"""Writes terrace_wood.png, the boards of a table, and terrace_sky.hdr, a sky with a low sun, beside this file."""
import math
import pathlib
import struct
import zlib

folder = pathlib.Path(__file__).parent


def noise(x, y):
    """Smooth noise from -1 to 1 by a hash of the integer lattice."""

    def corner(i, j):
        h = (i * 374761393 + j * 668265263) & 0xFFFFFFFF
        h = ((h ^ (h >> 13)) * 1274126177) & 0xFFFFFFFF
        return ((h ^ (h >> 16)) & 0xFFFF) / 32767.5 - 1

    i, j = math.floor(x), math.floor(y)
    u, v = x - i, y - j
    u, v = u * u * (3 - 2 * u), v * v * (3 - 2 * v)
    top = corner(i, j) * (1 - u) + corner(i + 1, j) * u
    bottom = corner(i, j + 1) * (1 - u) + corner(i + 1, j + 1) * u
    return top * (1 - v) + bottom * v


def wood(x, y, size):
    """sRGB of a board at a pixel: four boards across, each with a grain along y of its own."""
    board, across = divmod(x * 4 / size, 1)
    grain = noise(across * 9 + board * 31, y / size * 1.5 + board * 17)
    fine = noise(across * 60 + board * 7, y / size * 6)
    rings = math.sin(14 * (across + 0.35 * grain) + 3 * grain)
    tone = 0.62 + 0.07 * noise(board * 5, 2) + 0.10 * rings + 0.05 * fine
    if across < 0.012 or across > 0.988:
        tone = 0.18
    return [round(255 * min(1, max(0, tone * c))) for c in (1.0, 0.72, 0.46)]


def write_png(path, size):
    rows = b"".join(
        b"\0" + bytes(c for x in range(size) for c in wood(x, y, size)) for y in range(size))

    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data
                + struct.pack(">I", zlib.crc32(kind + data)))

    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", size, size, 8, 2, 0, 0, 0))
                     + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def sky(x, y, width, height):
    """Radiance of a pixel: blue above, warm at the horizon, earth below; the sun is one pixel."""
    up = math.cos(math.pi * (y + 0.5) / height)
    if (x, y) == (width * 5 // 16, height * 5 // 16):
        return [52000.0, 43000.0, 29000.0]
    if up < 0:
        return [2.0, 1.6, 1.2]
    haze = math.exp(-6 * up)
    return [8 + 16 * haze, 14 + 10 * haze, 30 + 0 * haze]


def write_hdr(path, width, height):
    def rgbe(color):
        mantissa, exponent = math.frexp(max(color))
        return bytes(int(c / max(color) * mantissa * 256) for c in color) + bytes([exponent + 128])

    pixels = b"".join(rgbe(sky(x, y, width, height)) for y in range(height) for x in range(width))
    # Without run lengths, which rows of 8 to 32767 pixels would be taken to have if they began with 2, 2.
    path.write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (height, width) + pixels)


if __name__ == "__main__":
    write_png(folder / "terrace_wood.png", 256)
    write_hdr(folder / "terrace_sky.hdr", 128, 64)
