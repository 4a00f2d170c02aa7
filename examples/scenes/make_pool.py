#!/usr/bin/env python3
"""Writes pool.ply, the surface of the water in pool.json: a sheet of triangles with normals.

    examples/scenes/make_pool.py        writes pool.ply beside itself
"""
import array
import math
import os
import struct

CELLS = 112  # along each side
HALF = 1.02  # m; the sheet goes a little into the walls of the pool
LEVEL = 0.6  # m

# Waves: height in m, wave vector in 1/m, phase.
WAVES = [(0.011, (7.0, 2.5), 0.3), (0.009, (-4.5, 8.0), 1.9), (0.006, (13.0, -9.0), 4.0), (0.004, (-17.0, -12.0), 2.2),
         (0.0025, (24.0, 19.0), 5.1), (0.002, (-31.0, 11.0), 0.8)]


def height_and_normal(x, z):
    h, dx, dz = LEVEL, 0.0, 0.0
    for size, (kx, kz), phase in WAVES:
        angle = kx * x + kz * z + phase
        h += size * math.sin(angle)
        dx += size * kx * math.cos(angle)
        dz += size * kz * math.cos(angle)
    length = math.sqrt(1 + dx * dx + dz * dz)
    return h, (-dx / length, 1 / length, -dz / length)


vertices = array.array('f')
for j in range(CELLS + 1):
    for i in range(CELLS + 1):
        x, z = (2 * i / CELLS - 1) * HALF, (2 * j / CELLS - 1) * HALF
        h, normal = height_and_normal(x, z)
        vertices.extend((x, h, z) + normal)
faces = bytearray()
for j in range(CELLS):
    for i in range(CELLS):
        a = j * (CELLS + 1) + i
        b, c, d = a + 1, a + CELLS + 2, a + CELLS + 1
        faces += struct.pack('<BHHHBHHH', 3, a, c, b, 3, a, d, c)  # counterclockwise from above
if struct.pack('=H', 1) != struct.pack('<H', 1):
    vertices.byteswap()
with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), 'pool.ply'), 'wb') as out:
    out.write(('ply\nformat binary_little_endian 1.0\ncomment made by make_pool.py\n'
               f'element vertex {(CELLS + 1) ** 2}\nproperty float x\nproperty float y\nproperty float z\n'
               'property float nx\nproperty float ny\nproperty float nz\n'
               f'element face {2 * CELLS ** 2}\nproperty list uchar ushort vertex_indices\nend_header\n').encode())
    out.write(vertices.tobytes())
    out.write(faces)
