#!/usr/bin/env python3
"""Writes, beside this file, leaves_leaf.png, a leaf with its outline in alpha, leaves_rust.png, rust with where it is
in alpha and how dull the bare metal is in green, and leaves_twigs.ply, the leaves of a few twigs as rectangles."""
import math
import pathlib
import random
import struct
import zlib

from make_terrace import noise

folder = pathlib.Path(__file__).parent


def write_png(path, size, pixel):
    rows = b"".join(b"\0" + bytes(round(255 * min(1, max(0, c))) for x in range(size)
                                  for c in pixel((x + 0.5) / size, (y + 0.5) / size)) for y in range(size))

    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data
                + struct.pack(">I", zlib.crc32(kind + data)))

    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", size, size, 8, 6, 0, 0, 0))
                     + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def leaf(x, y):
    """A leaf from its stalk at the bottom to its tip, with a rib and veins. sRGB and opacity."""
    along, across = 1 - y, abs(x - 0.5)
    stalk = 0.012 if along < 0.12 else 0
    t = (along - 0.1) / 0.88
    half = max(stalk, 0.36 * math.sin(math.pi * t ** 0.8) ** 0.9 if 0 < t < 1 else 0)
    if half > stalk:
        half += 0.012 * math.sin(60 * along)  # a toothed edge
    vein = min(across, abs((along - 0.9 * across) * 9 % 1 - 0.5) / 9 + 0.01)
    tone = 0.75 + 0.15 * noise(9 * x, 9 * y) + (0.25 if vein < 0.014 else 0)
    opacity = (half - across) * 256 / 1.5 + 0.5  # an edge of a texel and a half
    return [0.30 * tone, 0.55 * tone, 0.16 * tone, opacity]


def rust(x, y):
    """Colours of rust, but in green also how dull the metal is; in alpha where the rust is."""
    big = noise(9 * x + 3, 9 * y) + 0.5 * noise(24 * x, 24 * y + 7) + 0.25 * noise(60 * x, 60 * y)
    fine = 0.5 + 0.5 * noise(110 * x, 110 * y)
    return [0.45 + 0.25 * fine, 0.22 + 0.14 * fine, 0.10 + 0.06 * fine, (big + 0.05) * 5 + 0.5]


def twigs(count):
    """Rectangles of 9 cm x 9 cm about a few lines; in metres."""
    rng = random.Random(5)
    vertices, faces = [], []
    for _ in range(count):
        twig = rng.randrange(4)
        t = rng.random()
        middle = [-0.55 + 0.35 * twig + 0.25 * t + rng.uniform(-0.06, 0.06), 0.55 + 0.12 * twig % 0.3 - 0.25 * t * t
                  + rng.uniform(-0.05, 0.05), -0.35 + 0.9 * t - 0.1 * twig + rng.uniform(-0.06, 0.06)]
        turn, tilt, size = rng.uniform(0, 2 * math.pi), rng.uniform(-0.6, 0.6), rng.uniform(0.07, 0.12)
        u = [math.cos(turn) * size, 0.0, math.sin(turn) * size]
        v = [-math.sin(turn) * math.cos(tilt) * size, math.sin(tilt) * size, math.cos(turn) * math.cos(tilt) * size]
        first = len(vertices)
        for s, r in ((0, 0), (1, 0), (1, 1), (0, 1)):
            vertices.append([*(m + (s - 0.5) * a + (r - 0.5) * b for m, a, b in zip(middle, u, v)), s, r])
        faces += [[first, first + 1, first + 2], [first, first + 2, first + 3]]
    return vertices, faces


def write_ply(path, vertices, faces):
    lines = ["ply", "format ascii 1.0", f"element vertex {len(vertices)}",
             *(f"property float {p}" for p in ("x", "y", "z", "s", "t")),
             f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    lines += [" ".join(f"{c:.5g}" for c in v) for v in vertices]
    lines += ["3 " + " ".join(map(str, f)) for f in faces]
    path.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    write_png(folder / "leaves_leaf.png", 256, leaf)
    write_png(folder / "leaves_rust.png", 256, rust)
    write_ply(folder / "leaves_twigs.ply", *twigs(200))
