#!/usr/bin/env python3
"""Writes the files that somebody who has never seen the program might try first, in every format that it opens.

    tests/first_scenes/make_first_scenes.py       writes them beside itself

The shapes are simple, but made as people make them: a vase turned on a lathe, a chair of boards, a scan far from 0.
"""
import base64
import json
import math
import os
import random
import struct
import zlib

FOLDER = os.path.dirname(os.path.abspath(__file__))


def write(name, content):
    with open(os.path.join(FOLDER, name), 'wb' if isinstance(content, bytes) else 'w') as out:
        out.write(content)


# --- surfaces ---

class Mesh:
    """Points, and faces of three or four corners counterclockwise from outside; perhaps more for each point."""

    def __init__(self, points=(), faces=(), uvs=None):
        self.points, self.faces, self.uvs = list(points), list(faces), uvs
        self.normals = self.colours = None

    def __add__(self, other):
        n = len(self.points)
        return Mesh(self.points + other.points, self.faces + [tuple(v + n for v in f) for f in other.faces],
                    self.uvs + other.uvs if self.uvs and other.uvs else None)

    def each(self, change):
        self.points = [change(*p) for p in self.points]
        return self

    def moved(self, x, y, z):
        return self.each(lambda a, b, c: (a + x, b + y, c + z))

    def scaled(self, s):
        return self.each(lambda *p: tuple(s * c for c in p))

    def z_up(self):
        return self.each(lambda x, y, z: (x, -z, y))

    def flipped(self):
        self.faces = [f[::-1] for f in self.faces]
        return self

    def welded(self):
        """One point in each place, and no face of fewer than three corners."""
        places, number = {}, []
        for p in self.points:
            number.append(places.setdefault(tuple(round(c, 7) + 0.0 for c in p), len(places)))
        faces = []
        for f in self.faces:
            f = tuple(dict.fromkeys(number[v] for v in f))
            faces += [f] if len(f) > 2 else []
        return Mesh(places, faces)

    def triangles(self):
        return [(f[0], f[i], f[i + 1]) for f in self.faces for i in range(1, len(f) - 1)]

    def outward(self):
        """Turns a closed surface that is inside out."""
        volume = 0
        for t in self.triangles():
            a, b, c = (self.points[v] for v in t)
            volume += dot(a, cross(b, c))
        return self.flipped() if volume < 0 else self

    def smooth(self):
        """Normals of points: means of those of the faces round them."""
        sums = {p: [0, 0, 0] for p in self.points}
        for t in self.triangles():
            a, b, c = (self.points[v] for v in t)
            n = cross(minus(b, a), minus(c, a))
            for p in (a, b, c):
                sums[p] = [s + m for s, m in zip(sums[p], n)]
        self.normals = [unit(sums[p]) for p in self.points]
        return self


def minus(a, b):
    return tuple(x - y for x, y in zip(a, b))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def unit(a):
    length = math.sqrt(dot(a, a)) or 1
    return tuple(c / length for c in a)


def grid(place, columns, rows):
    """place(u, v) for u and v from 0 to 1."""
    uvs = [(i / columns, j / rows) for j in range(rows + 1) for i in range(columns + 1)]
    at = lambda i, j: j * (columns + 1) + i
    faces = [(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)) for j in range(rows) for i in range(columns)]
    return Mesh([place(*uv) for uv in uvs], faces, uvs)


def quad(corner, u, v):
    """It faces along u x v."""
    return grid(lambda s, t: tuple(c + s * a + t * b for c, a, b in zip(corner, u, v)), 1, 1)


def box(low, high):
    (x, y, z), (w, h, d) = low, minus(high, low)
    return (quad((x, y, z + d), (w, 0, 0), (0, h, 0)) + quad((x + w, y, z), (-w, 0, 0), (0, h, 0))
            + quad((x + w, y, z + d), (0, 0, -d), (0, h, 0)) + quad((x, y, z), (0, 0, d), (0, h, 0))
            + quad((x, y + h, z + d), (w, 0, 0), (0, 0, -d)) + quad((x, y, z), (w, 0, 0), (0, 0, d)))


def lathe(profile, segments, textured=False):
    """A profile of (radius, height), upwards on the outside, turned about the vertical."""
    def place(u, v):
        r, h = profile[round(v * (len(profile) - 1))]
        return r * math.cos(2 * math.pi * u), h, -r * math.sin(2 * math.pi * u)
    made = grid(place, segments, len(profile) - 1)
    return made if textured else made.welded()


def ball(center, radii, columns=16, rows=8):
    half = lambda v: (math.cos(math.pi * (v - 0.5)), math.sin(math.pi * (v - 0.5)))
    made = lathe([half(j / rows) for j in range(rows + 1)], columns)
    return made.each(lambda *p: tuple(c + r * q for c, r, q in zip(center, radii, p)))


def torus(columns=28, rows=12, large=1, small=0.4):
    ring = lambda v: (large - small * math.cos(2 * math.pi * v), -small * math.sin(2 * math.pi * v))
    return lathe([ring(j / rows) for j in range(rows + 1)], columns).outward()


def blob(columns=24, rows=12):
    def bump(x, y, z):
        s = 1 + 0.18 * math.sin(3 * x + 1) * math.sin(4 * y) + 0.12 * math.sin(5 * z + 2 * x)
        return s * x, s * y, s * z
    return ball((0, 0, 0), (1, 1, 1), columns, rows).each(bump)


def bunny(columns=14, rows=8):
    """A rabbit of balls, 1.5 high, on the ground, looking along x."""
    parts = [((0, 0.5, 0), (0.6, 0.5, 0.45)), ((0.5, 0.95, 0), (0.3, 0.28, 0.26)),
             ((0.38, 1.28, 0.13), (0.1, 0.3, 0.06)), ((0.38, 1.28, -0.13), (0.1, 0.3, 0.06)),
             ((-0.6, 0.45, 0), (0.15, 0.15, 0.15)),
             ((0.4, 0.13, 0.25), (0.25, 0.13, 0.12)), ((0.4, 0.13, -0.25), (0.25, 0.13, 0.12))]
    made = Mesh()
    for center, radii in parts:
        made += ball(center, radii, columns, rows)
    return made


VASE = [(0, 0), (0.09, 0), (0.1, 0.01), (0.13, 0.08), (0.15, 0.16), (0.13, 0.25), (0.08, 0.33), (0.06, 0.37),
        (0.07, 0.4), (0.09, 0.42), (0.085, 0.42), (0.065, 0.4), (0.055, 0.37), (0.075, 0.33), (0.125, 0.25),
        (0.145, 0.16), (0.125, 0.08), (0.09, 0.02), (0, 0.015)]
GEM = [(0, -0.6), (0.9, 0.1), (1, 0.2), (0.6, 0.5), (0, 0.5)]
BOWL = [(0, 0), (0.05, 0), (0.09, 0.015), (0.12, 0.04), (0.14, 0.07), (0.15, 0.1)]


def chair():
    legs = [box((x, 0, z), (x + 0.04, 0.44, z + 0.04)) for x in (0, 0.38) for z in (0, 0.38)]
    made = box((-0.01, 0.44, -0.01), (0.43, 0.47, 0.43)) + box((0, 0.47, 0), (0.04, 0.9, 0.04))
    made += box((0.38, 0.47, 0), (0.42, 0.9, 0.04)) + box((0.04, 0.62, 0.01), (0.38, 0.68, 0.03))
    made += box((0.04, 0.78, 0.01), (0.38, 0.88, 0.03))
    for leg in legs:
        made += leg
    return made


def dented_cube(n=8):
    sides = [((-1, -1, 1), (2, 0, 0), (0, 2, 0)), ((1, -1, -1), (-2, 0, 0), (0, 2, 0)),
             ((1, -1, 1), (0, 0, -2), (0, 2, 0)), ((-1, -1, -1), (0, 0, 2), (0, 2, 0)),
             ((-1, 1, 1), (2, 0, 0), (0, 0, -2)), ((-1, -1, -1), (2, 0, 0), (0, 0, 2))]
    made = Mesh()
    for corner, u, v in sides:
        made += grid(lambda s, t: tuple(c + s * a + t * b for c, a, b in zip(corner, u, v)), n, n)

    def dent(*p):
        deep = 0.5 * math.exp(-3 * sum((c - d) ** 2 for c, d in zip(p, (0.9, 0.9, 0.9))))
        return tuple(c * (1 - deep) for c in p)
    return made.welded().each(dent)


def hills(size, height, n, seed=4):
    """A square of ground with y up."""
    rng = random.Random(seed)
    waves = [(height / 2 ** k, [rng.uniform(-3, 3) * 1.8 ** k for _ in range(2)], rng.uniform(0, 6)) for k in range(5)]

    def place(u, v):
        h = sum(a * (1 - abs(math.sin(kx * u + kz * v + phase))) for a, (kx, kz), phase in waves)
        return size * (u - 0.5), h, size * (0.5 - v)
    return grid(place, n, n)


def room(w, h, d, front=True):
    """Walls that face inwards: floor, ceiling, back, left, right, and front."""
    made = (quad((0, 0, d), (w, 0, 0), (0, 0, -d)) + quad((0, h, 0), (w, 0, 0), (0, 0, d))
            + quad((0, 0, 0), (w, 0, 0), (0, h, 0)) + quad((0, 0, d), (0, 0, -d), (0, h, 0))
            + quad((w, 0, 0), (0, 0, d), (0, h, 0)))
    return made + quad((w, 0, d), (-w, 0, 0), (0, h, 0)) if front else made


def room_with_window(w, h, d):
    """The right wall has a window from (w, 0.9, 1) to (w, 2.1, 2.6)."""
    made = Mesh()
    for z, y, to_z, to_y in ((0, 0, d, 0.9), (0, 2.1, d, h), (0, 0.9, 1, 2.1), (2.6, 0.9, d, 2.1)):
        made += box((w, y, z), (w + 0.2, to_y, to_z))
    for low, high in (((-0.2, -0.2, 0), (w + 0.2, 0, d)), ((-0.2, h, 0), (w + 0.2, h + 0.2, d)),
                      ((-0.2, 0, 0), (0, h, d)), ((-0.2, -0.2, -0.2), (w + 0.2, h + 0.2, 0)),
                      ((-0.2, -0.2, d), (w + 0.2, h + 0.2, d + 0.2))):
        made += box(low, high)
    return made


# --- OBJ and PLY ---

def numbers(values, form='%.4g'):
    return ' '.join(form % (v + 0.0) for v in values)


def obj(name, parts, materials=None, form='%.4g'):
    """parts: of (object's name, material's name or None, mesh)."""
    text, n, m, k = '# ' + name + '\n', 1, 1, 1
    if materials:
        text += f'mtllib {name}.mtl\n'
        write(name + '.mtl', ''.join(f'newmtl {key}\n{value}\n' for key, value in materials.items()))
    for part, material, mesh in parts:
        text += f'o {part}\n' + ''.join(f'v {numbers(p, form)}\n' for p in mesh.points)
        uvs = mesh.uvs if materials and 'map_' in materials.get(material, '') else ()
        text += ''.join(f'vt {numbers(c)}\n' for c in uvs)
        text += ''.join(f'vn {numbers(c, "%.3g")}\n' for c in mesh.normals or ())
        text += f'usemtl {material}\n' if material else ''
        for f in mesh.faces:
            corner = lambda v: (f'{v + n}/{v + m if uvs else ""}/{v + k}' if mesh.normals
                                else f'{v + n}/{v + m}' if uvs else str(v + n))
            text += 'f ' + ' '.join(corner(v) for v in f) + '\n'
        n, m, k = n + len(mesh.points), m + len(uvs), k + len(mesh.normals or ())
    write(name + '.obj', text)


def ply(name, mesh, binary, kind='float'):
    header = (f'ply\nformat {"binary_little_endian" if binary else "ascii"} 1.0\nelement vertex {len(mesh.points)}\n'
              + ''.join(f'property {kind} {c}\n' for c in 'xyz')
              + ''.join(f'property float n{c}\n' for c in 'xyz' if mesh.normals)
              + ''.join(f'property uchar {c}\n' for c in ('red', 'green', 'blue') if mesh.colours)
              + (f'element face {len(mesh.faces)}\nproperty list uchar int vertex_indices\n' if mesh.faces else '')
              + 'end_header\n')
    data = b''
    for i, p in enumerate(mesh.points):
        normal, colour = mesh.normals[i] if mesh.normals else (), mesh.colours[i] if mesh.colours else ()
        if binary:
            data += struct.pack('<3' + kind[0], *p) + struct.pack(f'<{len(normal)}f', *normal) + bytes(colour)
        else:
            data += ' '.join(filter(None, (numbers(p), numbers(normal), numbers(colour)))).encode() + b'\n'
    for f in mesh.faces:
        data += (struct.pack(f'<B{len(f)}i', len(f), *f) if binary else f'{len(f)} {numbers(f, "%d")}\n'.encode())
    write(name + '.ply', header.encode() + data)


# --- glTF ---

class Gltf:
    def __init__(self):
        self.data = bytearray()
        self.tree = {'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': []}], 'nodes': [], 'meshes': [],
                     'accessors': [], 'bufferViews': [], 'materials': []}

    def view(self, content):
        self.data += b'\0' * (-len(self.data) % 4)
        self.tree['bufferViews'].append({'buffer': 0, 'byteOffset': len(self.data), 'byteLength': len(content)})
        self.data += content
        return len(self.tree['bufferViews']) - 1

    def accessor(self, values, kind, component, form, **more):
        content = b''.join(struct.pack('<' + form, *v) for v in values)
        count = len(values) * (3 if kind == 'SCALAR' else 1)
        self.tree['accessors'].append({'bufferView': self.view(content), 'componentType': component, 'type': kind,
                                       'count': count, **more})
        return len(self.tree['accessors']) - 1

    def mesh(self, name, mesh, material=None):
        lows, highs = [[f(p[c] for p in mesh.points) for c in range(3)] for f in (min, max)]
        made = {'attributes': {'POSITION': self.accessor(mesh.points, 'VEC3', 5126, '3f', min=lows, max=highs)}}
        if mesh.normals:
            made['attributes']['NORMAL'] = self.accessor(mesh.normals, 'VEC3', 5126, '3f')
        if mesh.uvs and material and 'baseColorTexture' in material.get('pbrMetallicRoughness', {}):
            made['attributes']['TEXCOORD_0'] = self.accessor([(u, 1 - v) for u, v in mesh.uvs], 'VEC2', 5126, '2f')
        made['indices'] = self.accessor(mesh.triangles(), 'SCALAR', 5123, '3H')
        if material:
            self.tree['materials'].append({'name': name, **material})
            made['material'] = len(self.tree['materials']) - 1
        self.tree['meshes'].append({'name': name, 'primitives': [made]})
        return len(self.tree['meshes']) - 1

    def node(self, **keys):
        self.tree['nodes'].append(keys)
        self.tree['scenes'][0]['nodes'].append(len(self.tree['nodes']) - 1)
        return self

    def add(self, name, mesh, material=None, **placed):
        return self.node(name=name, mesh=self.mesh(name, mesh, material), **placed)

    def camera(self, eye, target, degrees=45):
        back = unit(minus(eye, target))
        right = unit(cross((0, 1, 0), back))
        self.tree['cameras'] = [{'type': 'perspective', 'perspective': {'yfov': math.radians(degrees), 'znear': 0.1,
                                                                        'aspectRatio': 1}}]
        return self.node(name='Camera', camera=0, matrix=[*right, 0, *cross(back, right), 0, *back, 0, *eye, 1])

    def light(self, direction=(0, 0, -1), at=(0, 0, 0), **keys):
        """The lamp, which shines along its node's -z."""
        back = unit([-c for c in direction])
        right = unit(cross((0, 1, 0.001), back))
        self.use('KHR_lights_punctual').tree['extensions'] = {'KHR_lights_punctual': {'lights': [keys]}}
        return self.node(name='Light', extensions={'KHR_lights_punctual': {'light': 0}},
                         matrix=[*right, 0, *cross(back, right), 0, *back, 0, *at, 1])

    def use(self, *names):
        self.tree['extensionsUsed'] = sorted({*self.tree.get('extensionsUsed', ()), *names})
        return self

    def texture(self, picture):
        self.tree['images'] = [{'bufferView': self.view(picture), 'mimeType': 'image/png'}]
        self.tree['textures'] = [{'source': 0}]

    def save(self, name, binary=False):
        self.tree['buffers'] = [{'byteLength': len(self.data)}]
        tree = {key: value for key, value in self.tree.items() if value or key == 'scene'}
        if not binary:
            tree['buffers'][0]['uri'] = 'data:application/octet-stream;base64,' + base64.b64encode(self.data).decode()
            write(name + '.gltf', json.dumps(tree) + '\n')
            return
        text = json.dumps(tree, separators=(',', ':')).encode()
        text += b' ' * (-len(text) % 4)
        data = bytes(self.data) + b'\0' * (-len(self.data) % 4)
        write(name + '.glb', struct.pack('<4sIII4s', b'glTF', 2, 28 + len(text) + len(data), len(text), b'JSON') + text
              + struct.pack('<I4s', len(data), b'BIN\0') + data)


def paint(r, g, b, metal=0, rough=0.6, **more):
    return {'pbrMetallicRoughness': {'baseColorFactor': [r, g, b, 1], 'metallicFactor': metal,
                                     'roughnessFactor': rough}, **more}


def png(width, height, colour):
    rows = b''.join(b'\0' + b''.join(bytes(colour(x, y)) for x in range(width)) for y in range(height))
    chunk = lambda kind, c: struct.pack('>I', len(c)) + kind + c + struct.pack('>I', zlib.crc32(kind + c))
    return (b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', width, height, 8, 2, 0, 0, 0))
            + chunk(b'IDAT', zlib.compress(rows, 9)) + chunk(b'IEND', b''))


def boards(x, y):
    """A crate: a frame about six boards."""
    frame = x < 8 or x > 55 or y < 8 or y > 55
    shade = 0.75 if frame else 1 - 0.12 * (x // 8 % 3) - (0.4 if x % 8 == 0 else 0)
    grain = 0.94 + 0.06 * math.sin(y * 0.7 + 3 * math.sin(x * 0.9)) if not frame else 1
    return [int(c * shade * grain) for c in (190, 135, 80)]


def chequers(x, y):
    return (200, 60, 40) if (x // 8 + y // 8) % 2 else (235, 225, 200)


# --- the scenes ---

def obj_scenes():
    obj('torus', [('Torus', None, torus().smooth())], form='%.3f')
    obj('dented_cube', [('Cube', None, dented_cube())], form='%.3f')
    obj('blob_inside_out', [('Blob', None, blob(20, 10).flipped().smooth())], form='%.3f')
    obj('vase', [('Vase', 'Glaze', lathe(VASE, 24).smooth())],
        {'Glaze': 'Ns 250\nKa 1 1 1\nKd 0.1 0.25 0.5\nKs 0.5 0.5 0.5\nKe 0 0 0\nNi 1.45\nd 1\nillum 2'})
    write('crate.png', png(64, 64, boards))
    obj('crate', [('Crate', 'Wood', box((-0.5, 0, -0.5), (0.5, 1, 0.5)))],
        {'Wood': 'Kd 1 1 1\nillum 1\nmap_Kd crate.png'})
    obj('gem_glass', [('Gem', 'Diamond', lathe(GEM, 8).outward())],
        {'Diamond': 'Kd 0 0 0\nTf 1 1 1\nNi 2.4\nd 0.1\nillum 7'})
    obj('knob_chrome', [('Knob', 'Chrome', lathe(VASE, 20).smooth())],
        {'Chrome': 'Kd 0 0 0\nKs 0.9 0.9 0.9\nNs 1000\nillum 3'})
    piano = box((0, 0.6, 0), (1.5, 0.85, 0.6)) + box((0, 0.85, 0), (1.5, 1.25, 0.3))
    piano += box((0, 0, 0.05), (0.1, 0.6, 0.55)) + box((1.4, 0, 0.05), (1.5, 0.6, 0.55))
    obj('piano_black', [('Piano', 'Black', piano)], {'Black': 'Kd 0 0 0\nillum 1'})
    # A town as surveyors map it: z up, metres east and north of a far away origin.
    rng, town = random.Random(2), quad((-100, 0, 100), (200, 0, 0), (0, 0, -200))
    for x in range(-80, 80, 32):
        for z in range(-80, 80, 32):
            town += box((x, 0, z), (x + rng.uniform(12, 22), rng.uniform(6, 25), z + rng.uniform(12, 22)))
    obj('town_survey', [('Town', None, town.z_up().moved(500000, 5400000, 250))], form='%.2f')
    # A bracket in millimetres, from a program for machine parts: z up, 300 long.
    bracket = box((0, 0, 0), (300, 12, 80)) + box((0, 12, 0), (12, 180, 80)) + box((12, 12, 34), (80, 80, 46))
    obj('bracket_mm', [('Bracket', None, bracket.z_up())])
    screw = [(0, -2), (0.3, -1.9), (0.5, -1.6), (0.4, -1.5), (0.5, -1.3), (0.4, -1.2), (0.5, -1), (0.4, -0.9),
             (0.5, -0.7), (0.4, -0.6), (0.5, -0.4), (0.4, -0.3), (0.4, 0), (1, 0), (1, 0.3), (0.7, 0.5), (0, 0.55)]
    obj('screw_1mm', [('Screw', None, lathe(screw, 16).scaled(0.0004))], form='%.4e')
    cloth = grid(lambda u, v: (2 * u - 1, 0.15 * math.sin(7 * u) * math.cos(5 * v), 1 - 2 * v), 16, 16)
    obj('cloth', [('Cloth', 'Red', cloth.smooth())], {'Red': 'Kd 0.6 0.05 0.05'}, form='%.3f')
    obj('plane', [('Plane', None, quad((-1, 0, 1), (2, 0, 0), (0, 0, -2)))])
    island = hills(1e6, 4000, 18, 9)
    obj('island_1000km', [('Island', None, island.each(lambda x, y, z: (x, 12 * y, z)))], form='%.0f')
    obj('room_lamp', [('Walls', 'White', room(4, 2.6, 5)), ('Chair', 'Wood', chair().moved(2, 0, 2)),
                      ('Lamp', 'Lamp', quad((1.6, 2.58, 2), (0.8, 0, 0), (0, 0, 0.8)))],
        {'White': 'Kd 0.75 0.75 0.72', 'Wood': 'Kd 0.45 0.25 0.12', 'Lamp': 'Kd 0 0 0\nKe 12 11 9'})
    obj('bunny_table', [('Bunny', 'Grey', bunny(12, 6).scaled(0.2)),
                        ('Table', 'Wood', box((-0.5, -0.05, -0.4), (0.5, 0, 0.4)))],
        {'Grey': 'Kd 0.5 0.5 0.5\nKs 0 0 0', 'Wood': 'Kd 0.4 0.22 0.1\nKs 0.5 0.5 0.5\nNs 100\nillum 2'}, form='%.3f')


def ply_scenes():
    ply('bunny', bunny(12, 6), False)
    ply('statue_z_up', lathe(VASE, 20).scaled(10).z_up().smooth(), True)
    ply('bowl', lathe(BOWL, 20), False)
    ply('mountains_10km', hills(1e4, 900, 24), True)
    face = blob(24, 14)
    face.colours = [[int(127 + 120 * c) for c in (p[1], math.sin(3 * p[0]), -p[1])] for p in face.points]
    face.colours = [[max(0, min(255, c)) for c in colour] for colour in face.colours]
    ply('blob_colours', face, True)
    ply('poster', quad((-0.5, 0, 0), (1, 0, 0), (0, 1.4, 0)), False)
    ply('quarry_survey', hills(300, 40, 16, 6).z_up().moved(500000, 5400000, 420), True, 'double')
    rng = random.Random(1)
    ply('no_faces/scan_points', Mesh([unit([rng.gauss(0, 1) for _ in range(3)]) for _ in range(200)]), False)


GLASS = {'KHR_materials_transmission': {'transmissionFactor': 1}, 'KHR_materials_ior': {'ior': 1.5}}


def gltf_scenes():
    wood = paint(0.45, 0.22, 0.08)
    Gltf().add('Chair', chair(), wood).save('chair')
    lamp = paint(0, 0, 0, emissiveFactor=[1, 0.9, 0.8], extensions={'KHR_materials_emissive_strength': {
        'emissiveStrength': 8000}})
    (Gltf().add('Walls', room(4, 2.6, 5), paint(0.8, 0.8, 0.75, rough=1)).add('Chair', chair(), wood,
                                                                                  translation=[1.8, 0, 1.5])
     .add('Lamp', quad((1.5, 2.59, 1.5), (1, 0, 0), (0, 0, 1)), lamp).use('KHR_materials_emissive_strength')
     .camera((2, 1.5, 4.7), (2, 0.9, 0), 60).save('chair_room'))
    (Gltf().add('Walls', room(3, 2.5, 4), paint(0.7, 0.75, 0.8, rough=1))
     .add('Table', box((0.8, 0.7, 1), (2.2, 0.75, 2)), wood).add('Leg', box((1.4, 0, 1.4), (1.6, 0.7, 1.6)), wood)
     .add('Vase', lathe(VASE, 20).smooth(), paint(0.8, 0.3, 0.1), translation=[1.3, 0.75, 1.5])
     .light(at=(1.5, 2.2, 1.6), type='point', intensity=5435, color=[1, 0.85, 0.7])
     .camera((1.5, 1.5, 3.8), (1.5, 0.8, 0), 60).save('kitchen_point', True))
    (Gltf().add('Floor', quad((-4, 0, 4), (8, 0, 0), (0, 0, -8)), paint(0.3, 0.3, 0.35))
     .add('Bunny', bunny(12, 6), paint(0.8, 0.8, 0.8))
     .light((-0.5, -1, -0.4), (2, 4, 1.6), type='spot', intensity=20000,
            spot={'innerConeAngle': 0.25, 'outerConeAngle': 0.35})
     .camera((1.5, 2.2, 5), (0, 0.6, 0)).save('stage_spot'))
    sundial = lambda: (Gltf().add('Ground', quad((-5, 0, 5), (10, 0, 0), (0, 0, -10)), paint(0.4, 0.5, 0.3))
                       .add('Bunny', bunny(12, 6), paint(0.7, 0.6, 0.5))
                       .light((-0.5, -0.7, -0.3), type='directional', intensity=3 * 683))
    sundial().camera((2, 1.8, 4), (0, 0.6, 0)).save('bunny_sun')
    sundial().save('bunny_sun_no_camera')
    (Gltf().add('Plain', quad((-5000, 0, 5000), (10000, 0, 0), (0, 0, -10000)), paint(0.4, 0.5, 0.3))
     .add('Bunny', bunny(12, 6).scaled(0.2), paint(0.7, 0.6, 0.5))
     .light((-0.5, -0.7, -0.3), type='directional', intensity=2000)
     .camera((0.5, 0.3, 0.9), (0, 0.13, 0)).save('plain_10km', True))
    Gltf().add('Triangle', Mesh([(0, 0, 0), (1, 0, -0.5), (0.3, 1, -0.6)], [(0, 1, 2)])).save('triangle')
    (Gltf().add('Ball', ball((0, 0, 0), (0.1, 0.1, 0.1), 24, 12).smooth(), paint(1, 1, 1, rough=0, extensions={
        **GLASS, 'KHR_materials_volume': {'thicknessFactor': 0.2, 'attenuationColor': [0.5, 0.9, 0.7],
                                          'attenuationDistance': 0.2}}))
     .use(*GLASS, 'KHR_materials_volume').save('ball_glass', True))
    (Gltf().add('Tumbler', lathe([(0, 0), (0.03, 0), (0.04, 0.12)], 20).smooth(),
                   paint(1, 1, 1, rough=0, extensions=GLASS))
     .add('Table', box((-0.3, -0.03, -0.3), (0.3, -0.001, 0.3)), wood).use(*GLASS).save('tumbler', True))
    Gltf().add('Ring', torus(24, 12).smooth(), paint(1, 0.77, 0.34, 1, 0.35)).save('ring_gold', True)
    Gltf().add('Ring', torus(24, 12).smooth(), paint(0.9, 0.9, 0.9, 1, 0)).save('ring_mirror', True)
    Gltf().add('Sign', torus(24, 8, 1, 0.08).each(lambda x, y, z: (x, z, y)).outward().smooth(), paint(
        0, 0, 0, emissiveFactor=[1, 0.1, 0.4])).save('neon', True)
    Gltf().add('Head', ball((0, 0, 0), (0.8, 1, 0.8), 8, 4).smooth(), paint(0.8, 0.55, 0.45)).save('low_poly_smooth')
    forest = Gltf().add('Ground', hills(40, 1, 8), paint(0.2, 0.3, 0.1))
    tree = forest.mesh('Tree', lathe([(0.15, 0), (0.15, 0.7), (0.9, 0.7), (0.4, 1.7), (0.6, 1.7), (0, 3.2)], 9),
                       paint(0.1, 0.35, 0.12))
    rng = random.Random(3)
    for _ in range(150):
        s, turn = rng.uniform(0.6, 1.5), rng.uniform(0, math.pi)
        forest.node(mesh=tree, translation=[round(rng.uniform(-19, 19), 2), 1, round(rng.uniform(-19, 19), 2)], scale=[
            round(s, 2)] * 3, rotation=[0, round(math.sin(turn), 3), 0, round(math.cos(turn), 3)])
    forest.save('forest')
    Gltf().add('Pollen', blob(20, 10).scaled(1e-5).smooth(), paint(0.8, 0.6, 0.1)).save('pollen_10um', True)
    globe = Gltf()
    globe.texture(png(128, 64, chequers))
    half = lambda v: (math.cos(math.pi * (v - 0.5)), math.sin(math.pi * (v - 0.5)))
    globe.add('Globe', lathe([half(j / 12) for j in range(13)], 24, True).smooth(), {'pbrMetallicRoughness': {
        'baseColorTexture': {'index': 0}, 'metallicFactor': 0, 'roughnessFactor': 0.8}}).save('globe', True)


def pbrt_mesh(mesh):
    return (f'Shape "trianglemesh" "point3 P" [ {" ".join(numbers(p) for p in mesh.points)} ]\n'
            f'  "integer indices" [ {" ".join(numbers(t, "%d") for t in mesh.triangles())} ]\n')


def pbrt_scenes():
    camera = 'Scale -1 1 1\nLookAt 1 1.5 4.6  2.2 1 0  0 1 0\nCamera "perspective" "float fov" 65\nWorldBegin\n'
    sun = 'LightSource "distant" "rgb L" [ 8 7.5 6.5 ] "point3 from" [ 6 3.5 3.2 ] "point3 to" [ 0 0 0 ]\n'
    sky = 'LightSource "infinite" "rgb L" [ 0.5 0.7 1 ]\n'
    inside = ('Material "diffuse" "rgb reflectance" [ 0.75 0.72 0.68 ]\n' + pbrt_mesh(room_with_window(4, 2.6, 5))
              + 'Material "diffuse" "rgb reflectance" [ 0.45 0.2 0.1 ]\n' + pbrt_mesh(chair().moved(2.2, 0, 1.2)))
    pane = ('AttributeBegin\nMaterial "thindielectric" "float eta" 1.5\n'
            + pbrt_mesh(quad((4.1, 0.9, 2.6), (0, 0, -1.6), (0, 1.2, 0))) + 'AttributeEnd\n')
    write('window_open.pbrt', camera + sun + sky + inside)
    write('window_pane.pbrt', camera + sun + sky + pane + inside)
    write('studio.pbrt', 'LookAt 3 2.2 4  0 0.6 0  0 1 0\nCamera "perspective" "float fov" 35\nWorldBegin\n'
          'LightSource "infinite" "rgb L" [ 0.2 0.2 0.25 ]\nAttributeBegin\n'
          'AreaLightSource "diffuse" "rgb L" [ 12 12 11 ]\n'
          'Translate -1 3 2\nRotate 125 1 0 0\nShape "disk" "float radius" 0.7\nAttributeEnd\n'
          'Material "coateddiffuse" "rgb reflectance" [ 0.1 0.3 0.5 ] "float roughness" 0.05\n'
          'Shape "plymesh" "string filename" "bunny.ply"\nMaterial "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]\n'
          + pbrt_mesh(quad((-4, 0, 4), (8, 0, 0), (0, 0, -8))))
    write('kettle.pbrt', 'LookAt 0.4 0.6 0.9  0 0.17 0  0 1 0\nCamera "perspective" "float fov" 35\nWorldBegin\n'
          'LightSource "point" "rgb I" [ 2 2 2 ] "point3 from" [ 0.5 1 0.6 ]\n'
          'Material "conductor" "spectrum eta" "metal-Cu-eta" "spectrum k" "metal-Cu-k" "float roughness" 0.1\n'
          'Shape "plymesh" "string filename" "bowl.ply"\nTranslate 0 0.18 0\nShape "sphere" "float radius" 0.06\n'
          'Material "diffuse" "rgb reflectance" [ 0.6 0.6 0.6 ]\nTranslate 0 -0.18 0\n'
          + pbrt_mesh(quad((-1, 0, 1), (2, 0, 0), (0, 0, -2))))


def mitsuba_scenes():
    sensor = ('<scene version="3.0.0">\n<sensor type="perspective"><float name="fov" value="%s"/>'
              '<transform name="to_world"><lookat origin="%s" target="%s" up="0, 1, 0"/></transform>\n'
              '<film type="hdrfilm"><integer name="width" value="512"/>'
              '<integer name="height" value="512"/></film></sensor>\n')
    matte = lambda name, c: f'<bsdf type="diffuse" id="{name}"><rgb name="reflectance" value="{c}"/></bsdf>\n'
    placed = lambda kind, steps, bsdf, more='': (f'<shape type="{kind}">{more}<transform name="to_world">{steps}'
                                                 f'</transform>{bsdf}</shape>\n')
    ref = '<ref id="%s"/>'
    move, grow = '<translate value="%s"/>', '<scale value="%s"/>'
    write('window_glass.xml', sensor % (65, '1, 1.5, 4.6', '2.2, 1, 0') + matte('wall', '0.75, 0.72, 0.68')
          + '<bsdf type="dielectric" id="glass"/>\n<emitter type="directional"><vector name="direction" '
          'value="-6, -3.5, -3.2"/><rgb name="irradiance" value="8, 7.5, 6.5"/></emitter>\n'
          '<emitter type="constant"><rgb name="radiance" value="0.5, 0.7, 1"/></emitter>\n'
          + ''.join(placed('cube', grow % numbers([(b - a) / 2 for a, b in zip(low, high)]).replace(' ', ', ')
                           + move % numbers([(b + a) / 2 for a, b in zip(low, high)]).replace(' ', ', '), ref % bsdf)
                    for low, high, bsdf in (
                        ((-0.2, -0.2, -0.2), (4.2, 0, 5.2), 'wall'), ((-0.2, 2.6, -0.2), (4.2, 2.8, 5.2), 'wall'),
                        ((-0.2, 0, -0.2), (0, 2.6, 5.2), 'wall'), ((0, 0, -0.2), (4.2, 2.6, 0), 'wall'),
                        ((0, 0, 5), (4.2, 2.6, 5.2), 'wall'), ((4, 0, 0), (4.2, 0.9, 5), 'wall'),
                        ((4, 2.1, 0), (4.2, 2.6, 5), 'wall'), ((4, 0.9, 0), (4.2, 2.1, 1), 'wall'),
                        ((4, 0.9, 2.6), (4.2, 2.1, 5), 'wall'), ((4.09, 0.9, 1), (4.1, 2.1, 2.6), 'glass')))
          + placed('sphere', move % '2.4, 0.4, 1.6', ref % 'wall', '<float name="radius" value="0.4"/>') + '</scene>\n')
    side = lambda steps, bsdf: placed('rectangle', steps, ref % bsdf)
    turn = '<rotate %s="1" angle="%s"/>'
    write('box.xml', sensor % (39, '0, 0, 3.9', '0, 0, 0') + matte('white', '0.73, 0.73, 0.73')
          + matte('red', '0.6, 0.06, 0.05')
          + matte('green', '0.12, 0.45, 0.15') + side(turn % ('x', -90) + move % '0, -1, 0', 'white')
          + side(turn % ('x', 90) + move % '0, 1, 0', 'white') + side(move % '0, 0, -1', 'white')
          + side(turn % ('y', 90) + move % '-1, 0, 0', 'red') + side(turn % ('y', -90) + move % '1, 0, 0', 'green')
          + placed('rectangle', turn % ('x', 90) + grow % '0.3, 1, 0.3' + move % '0, 0.99, 0', ref % 'white',
                   '<emitter type="area"><rgb name="radiance" value="15, 12, 9"/></emitter>')
          + placed('sphere', move % '0.4, -0.65, 0.3', '<bsdf type="dielectric"/>',
                   '<float name="radius" value="0.35"/>')
          + placed('ply', grow % '0.5' + move % '-0.4, -1, -0.2', '<bsdf type="plastic"/>',
                   '<string name="filename" value="bunny.ply"/>') + '</scene>\n')
    write('ring_sky.xml', '<scene version="3.0.0">\n<emitter type="constant"/>\n<shape type="obj">'
          '<string name="filename" value="torus.obj"/><bsdf type="roughplastic">'
          '<rgb name="diffuse_reflectance" value="0.1, 0.4, 0.15"/></bsdf></shape>\n</scene>\n')


def own_scenes():
    def scene(name, camera, materials, shapes, lights, radius):
        write(name + '.json', json.dumps({
            'photongrid': 1, 'name': name, 'units': {'length': 'm', 'power': 'W'}, 'camera': camera,
            'materials': materials, 'shapes': shapes, 'lights': lights,
            'render': {'size': [256, 256], 'photons': 100000, 'k': 100, 'max_radius': radius}}, indent=1) + '\n')
    floor = {'type': 'polygon', 'vertices': [[-2, 0, -2], [-2, 0, 2], [2, 0, 2], [2, 0, -2]], 'material': 'grey'}
    grey = {'type': 'lambertian', 'reflectance': 0.6}
    scene('bunny_spot', {'position': [1.5, 2, 3.5], 'look_at': [0, 0.6, 0], 'vertical_fov': 40},
          {'grey': grey, 'red': {'type': 'plastic', 'reflectance': [0.6, 0.1, 0.05]}},
          [floor, {'type': 'mesh', 'file': 'bunny.ply', 'material': 'red'}],
          [{'type': 'spot', 'name': 'lamp', 'position': [1, 4, 2], 'direction': [-1, -3.5, -2], 'inner_angle': 12,
            'outer_angle': 20, 'power': 100}], 0.2)
    scene('bowl_sky', {'position': [0.2, 0.3, 0.5], 'look_at': [0, 0.05, 0], 'vertical_fov': 40},
          {'grey': grey, 'clay': {'type': 'lambertian', 'reflectance': [0.6, 0.35, 0.2]},
           'glass': {'type': 'glass', 'index_of_refraction': 1.5}},
          [floor, {'type': 'mesh', 'file': 'bowl.ply', 'material': 'clay'},
           {'type': 'sphere', 'center': [0, 0.07, 0], 'radius': 0.05, 'material': 'glass'}],
          [{'type': 'environment', 'name': 'sky', 'radiance': [0.6, 0.8, 1]},
           {'type': 'directional', 'name': 'sun', 'direction': [-1, -2, -1], 'irradiance': 4}], 0.1)


if __name__ == '__main__':
    os.makedirs(os.path.join(FOLDER, 'no_faces'), exist_ok=True)
    for write_some in (obj_scenes, ply_scenes, gltf_scenes, pbrt_scenes, mitsuba_scenes, own_scenes):
        write_some()
