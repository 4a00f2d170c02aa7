#!/usr/bin/env python3
"""Writes two scenes, a table and a room, each as glTF, OBJ, pbrt-v4 and Mitsuba files with the same surfaces.

    examples/scenes/make_table.py       writes table.* and room.* beside itself

On the table, which has the wood of terrace_wood.png, stand a tray of water, a glass and a ring of gold. The room has a
lamp below its ceiling, and a window to the sky. OBJ and glTF files have no sky, and OBJ files no camera: they are drawn
with --environment room_sky.hdr and --camera-from room.pbrt.
"""
import json
import math
import os
import struct

FOLDER = os.path.dirname(os.path.abspath(__file__))
WOOD = 'terrace_wood.png'


def single(values):
    """The values in single precision, which all formats keep."""
    return tuple(struct.unpack('<f', struct.pack('<f', v))[0] for v in values)


class Surface:
    """Vertices (position, normal or None, texture coordinates with v upwards, or None) and triangles."""

    def __init__(self, name, material):
        self.name, self.material = name, material
        self.positions, self.normals, self.coordinates, self.triangles = [], [], [], []

    def add(self, position, normal=None, coordinates=None):
        self.positions.append(single(position))
        if normal:
            length = math.sqrt(sum(c * c for c in normal))
            self.normals.append(single(c / length for c in normal))
        if coordinates:
            self.coordinates.append(single(coordinates))
        return len(self.positions) - 1

    def quad(self, corner, u, v, textured=False):
        """Counterclockwise as seen from the side of u x v."""
        places = [(0, 0), (1, 0), (1, 1), (0, 1)]
        first = [self.add([corner[i] + s * u[i] + t * v[i] for i in range(3)], None, (s, t) if textured else None)
                 for s, t in places][0]
        self.triangles += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
        return self

    def block(self, low, high, textured=False):
        x, y, z = [high[i] - low[i] for i in range(3)]
        self.quad((low[0], high[1], high[2]), (x, 0, 0), (0, 0, -z), textured)                   # top
        self.quad(low, (x, 0, 0), (0, 0, z), textured)                                           # bottom
        self.quad((low[0], low[1], high[2]), (x, 0, 0), (0, y, 0), textured)                     # front
        self.quad((high[0], low[1], low[2]), (-x, 0, 0), (0, y, 0), textured)                    # back
        self.quad((high[0], low[1], high[2]), (0, 0, -z), (0, y, 0), textured)                   # right
        self.quad(low, (0, 0, z), (0, y, 0), textured)                                           # left
        return self

    def turned(self, profile, center, segments):
        """A profile of (radius, height, normal's radius, normal's height), closed, turned about the vertical."""
        for s in range(segments):
            angle = 2 * math.pi * s / segments
            c, n = math.cos(angle), math.sin(angle)
            for radius, height, along, up in profile:
                self.add((center[0] + radius * c, center[1] + height, center[2] - radius * n),
                         (along * c, up, -along * n))
        count = len(profile)
        for s in range(segments):
            for p in range(count):
                a, b = s * count + p, s * count + (p + 1) % count
                c, d = (s + 1) % segments * count + p, (s + 1) % segments * count + (p + 1) % count
                for t in ((a, c, d), (a, d, b)):
                    if len({self.positions[v] for v in t}) == 3:
                        self.triangles.append(t)
        return self


def rounded(points, radius, steps=3):
    """A closed profile of straight lines, with round corners and normals to its right-hand side."""
    profile = []
    for i, (x, y) in enumerate(points):
        before, after = points[i - 1], points[(i + 1) % len(points)]
        to_before, to_after = (before[0] - x, before[1] - y), (after[0] - x, after[1] - y)
        a, b = math.hypot(*to_before), math.hypot(*to_after)
        u, v = (to_before[0] / a, to_before[1] / a), (to_after[0] / b, to_after[1] / b)
        n, m = (-u[1], u[0]), (v[1], -v[0])  # of the lines before and after
        if x == 0 and before[0] == 0:  # the axis has no normal but up or down
            profile.append((x, y, 0, m[1]))
            continue
        if x == 0:
            profile.append((x, y, 0, n[1]))
            continue
        for s in range(steps + 1):
            t = s / steps
            start, end = (x + radius * u[0], y + radius * u[1]), (x + radius * v[0], y + radius * v[1])
            place = [(1 - t) ** 2 * start[k] + 2 * t * (1 - t) * (x, y)[k] + t * t * end[k] for k in range(2)]
            profile.append((place[0], place[1], (1 - t) * n[0] + t * m[0], (1 - t) * n[1] + t * m[1]))
    return profile


def water(name, material, low, high, level, cells):
    """A body of water with waves on it; its sides and its bottom are inside of a tray."""
    s = Surface(name, material)
    waves = [(0.0045, (38, 15), 0.3), (0.004, (-24, 43), 1.9), (0.0016, (70, -49), 4.0)]

    def top(x, z):
        h, dx, dz = level, 0, 0
        for size, (kx, kz), phase in waves:
            angle = kx * x + kz * z + phase
            h += size * math.sin(angle)
            dx += size * kx * math.cos(angle)
            dz += size * kz * math.cos(angle)
        return h, (-dx, 1, -dz)

    across, along = cells
    for j in range(along + 1):
        for i in range(across + 1):
            x, z = low[0] + (high[0] - low[0]) * i / across, low[2] + (high[2] - low[2]) * j / along
            h, normal = top(x, z)
            s.add((x, h, z), normal)
    at = lambda i, j: j * (across + 1) + i
    for j in range(along):
        for i in range(across):
            a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
            s.triangles += [(a, d, c), (a, c, b)]
    edge = ([at(i, along) for i in range(across)] + [at(across, j) for j in range(along, 0, -1)]
            + [at(i, 0) for i in range(across, 0, -1)] + [at(0, j) for j in range(along)])
    outward = ([(0, 0, 1)] * across + [(1, 0, 0)] * along + [(0, 0, -1)] * across + [(-1, 0, 0)] * along)
    middle = s.add(((low[0] + high[0]) / 2, low[1], (low[2] + high[2]) / 2), (0, -1, 0))
    for n, v in enumerate(edge):
        w = edge[(n + 1) % len(edge)]
        (x, h, z), (x2, h2, z2) = s.positions[v], s.positions[w]
        a, b = s.add((x, low[1], z), outward[n]), s.add((x2, low[1], z2), outward[n])
        c, d = s.add((x2, h2, z2), outward[n]), s.add((x, h, z), outward[n])
        s.triangles += [(a, b, c), (a, c, d)]
        e, f = s.add((x, low[1], z), (0, -1, 0)), s.add((x2, low[1], z2), (0, -1, 0))
        s.triangles.append((middle, f, e))
    return s


class Scene:
    def __init__(self, name, eye, target, fov, materials, surfaces, sky=None):
        self.name, self.eye, self.target, self.fov = name, eye, target, fov
        self.materials, self.surfaces, self.sky = materials, surfaces, sky

    # --- files ---
    def write(self, ending, content):
        with open(os.path.join(FOLDER, self.name + ending), 'wb' if isinstance(content, bytes) else 'w') as out:
            out.write(content)

    def write_all(self):
        for write in (self.write_surfaces, self.write_pbrt, self.write_mitsuba, self.write_gltf, self.write_obj):
            write()

    def write_surfaces(self):
        """PLY files for pbrt and Mitsuba. Those with texture coordinates, whose v both see the other way round, are
        for pbrt; Mitsuba has OBJ files of these."""
        for s in self.surfaces:
            values = ['x', 'y', 'z'] + (['nx', 'ny', 'nz'] if s.normals else []) + (['u', 'v'] if s.coordinates else [])
            data = bytearray()
            for n, p in enumerate(s.positions):
                data += struct.pack('<3f', *p)
                data += struct.pack('<3f', *s.normals[n]) if s.normals else b''
                data += struct.pack('<2f', *s.coordinates[n]) if s.coordinates else b''
            for t in s.triangles:
                data += struct.pack('<B3H', 3, *t)
            header = ('ply\nformat binary_little_endian 1.0\ncomment made by make_table.py\n'
                      f'element vertex {len(s.positions)}\n' + ''.join(f'property float {v}\n' for v in values)
                      + f'element face {len(s.triangles)}\nproperty list uchar ushort vertex_indices\nend_header\n')
            self.write(f'_{s.name}.ply', header.encode() + bytes(data))
            if s.coordinates:
                self.write(f'_{s.name}.obj', self.obj_of([s]))

    def write_pbrt(self):
        text = '# made by make_table.py\nFilm "rgb" "integer xresolution" 640 "integer yresolution" 480\nScale -1 1 1\n'
        text += 'LookAt %s  %s  0 1 0\n' % (numbers(self.eye), numbers(self.target))
        text += f'Camera "perspective" "float fov" {self.fov}\nWorldBegin\n'  # of the smaller side, the vertical one
        if self.sky:
            text += f'LightSource "infinite" "rgb L" [ {numbers(self.sky)} ]\n'
        text += f'Texture "wood" "spectrum" "imagemap" "string filename" "{WOOD}"\n'
        for s in self.surfaces:
            m = self.materials[s.material]
            text += 'AttributeBegin\n'
            if m['is'] == 'matte':
                text += f'Material "diffuse" "rgb reflectance" [ {numbers(m["colour"])} ]\n'
            elif m['is'] == 'wood':
                text += 'Material "diffuse" "texture reflectance" "wood"\n'
            elif m['is'] == 'glass':
                text += f'Material "dielectric" "float eta" {m["index"]}\n'
            elif m['is'] == 'metal':
                text += (f'Material "conductor" "rgb reflectance" [ {numbers(m["colour"])} ] '
                         f'"float roughness" {m["roughness"] ** 2!r} "bool remaproughness" false\n')
            else:
                text += ('Material "diffuse" "rgb reflectance" [ 0 0 0 ]\n'
                         f'AreaLightSource "diffuse" "rgb L" [ {numbers(m["radiance"])} ]\n')
            text += f'Shape "plymesh" "string filename" "{self.name}_{s.name}.ply"\nAttributeEnd\n'
        self.write('.pbrt', text)

    def write_mitsuba(self):
        text = '<!-- made by make_table.py -->\n<scene version="3.0.0">\n<sensor type="perspective">\n'
        text += f'<string name="fov_axis" value="y"/><float name="fov" value="{self.fov}"/>\n'
        text += '<transform name="to_world">'
        text += '<lookat origin="%s" target="%s" up="0, 1, 0"/></transform>\n' % (numbers(self.eye, ', '),
                                                                               numbers(self.target, ', '))
        text += '<film type="hdrfilm"><integer name="width" value="640"/><integer name="height" value="480"/></film>\n'
        text += '</sensor>\n'
        if self.sky:
            text += f'<emitter type="constant"><rgb name="radiance" value="{numbers(self.sky, ", ")}"/></emitter>\n'
        for s in self.surfaces:
            m = self.materials[s.material]
            rgb = lambda name, value: f'<rgb name="{name}" value="{numbers(value, ", ")}"/>'
            lamp = ''
            if m['is'] == 'matte':
                bsdf = f'<bsdf type="diffuse">{rgb("reflectance", m["colour"])}</bsdf>'
            elif m['is'] == 'wood':
                bsdf = ('<bsdf type="diffuse"><texture name="reflectance" type="bitmap">'
                        f'<string name="filename" value="{WOOD}"/></texture></bsdf>')
            elif m['is'] == 'glass':
                bsdf = (f'<bsdf type="dielectric"><float name="int_ior" value="{m["index"]}"/>'
                        '<float name="ext_ior" value="1"/></bsdf>')
            elif m['is'] == 'metal':
                bsdf = ('<bsdf type="roughconductor"><string name="material" value="none"/>'
                        '<string name="distribution" value="ggx"/>'
                        f'<float name="alpha" value="{m["roughness"] ** 2!r}"/>'
                        f'{rgb("specular_reflectance", m["colour"])}</bsdf>')
            else:
                bsdf = f'<bsdf type="diffuse">{rgb("reflectance", (0, 0, 0))}</bsdf>'
                lamp = f'<emitter type="area">{rgb("radiance", m["radiance"])}</emitter>'
            kind = 'obj' if s.coordinates else 'ply'
            flat = '' if s.normals else '<boolean name="face_normals" value="true"/>'
            text += (f'<shape type="{kind}"><string name="filename" value="{self.name}_{s.name}.{kind}"/>{flat}'
                     f'{bsdf}{lamp}</shape>\n')
        self.write('.xml', text + '</scene>\n')

    def write_gltf(self):
        data, views, accessors, meshes, nodes = bytearray(), [], [], [], []

        def add(kind, component, values, form):
            offset = len(data)
            for v in values:
                data.extend(struct.pack('<' + form, *v))
            views.append({'buffer': 0, 'byteOffset': offset, 'byteLength': len(data) - offset})
            data.extend(b'\0' * (-len(data) % 4))
            made = {'bufferView': len(views) - 1, 'componentType': component, 'type': kind,
                    'count': len(values) * (3 if kind == 'SCALAR' else 1)}
            accessors.append(made)
            return len(accessors) - 1

        names = list(self.materials)
        for s in self.surfaces:
            position = add('VEC3', 5126, s.positions, '3f')
            accessors[position]['min'] = [min(p[c] for p in s.positions) for c in range(3)]
            accessors[position]['max'] = [max(p[c] for p in s.positions) for c in range(3)]
            attributes = {'POSITION': position}
            if s.normals:
                attributes['NORMAL'] = add('VEC3', 5126, s.normals, '3f')
            if s.coordinates:
                attributes['TEXCOORD_0'] = add('VEC2', 5126, [(u, 1 - v) for u, v in s.coordinates], '2f')
            meshes.append({'name': s.name, 'primitives': [{'attributes': attributes,
                                                           'indices': add('SCALAR', 5123, s.triangles, '3H'),
                                                           'material': names.index(s.material)}]})
            nodes.append({'name': s.name, 'mesh': len(meshes) - 1})
        materials = []
        for name, m in self.materials.items():
            base = {'metallicFactor': 0, 'roughnessFactor': 1}
            made = {'name': name, 'pbrMetallicRoughness': base}
            matte = {'KHR_materials_specular': {'specularFactor': 0}}
            if m['is'] == 'matte':
                base['baseColorFactor'] = list(m['colour']) + [1]
                made['extensions'] = matte
            elif m['is'] == 'wood':
                base['baseColorTexture'] = {'index': 0}
                made['extensions'] = matte
            elif m['is'] == 'glass':
                base['roughnessFactor'] = 0
                made['extensions'] = {'KHR_materials_transmission': {'transmissionFactor': 1},
                                      'KHR_materials_volume': {'thicknessFactor': 0.1},
                                      'KHR_materials_ior': {'ior': m['index']}}
            elif m['is'] == 'metal':
                base.update(metallicFactor=1, roughnessFactor=m['roughness'],
                            baseColorFactor=list(m['colour']) + [1])
            else:
                base['baseColorFactor'] = [0, 0, 0, 1]
                most = max(m['radiance'])
                made['emissiveFactor'] = [c / most for c in m['radiance']]
                made['extensions'] = {**matte, 'KHR_materials_emissive_strength': {'emissiveStrength': most * 683}}
            materials.append(made)
        nodes.append({'name': 'camera', 'camera': 0, 'matrix': self.camera_matrix()})
        used = sorted({e for m in materials for e in m.get('extensions', {})})
        text = {'asset': {'version': '2.0', 'generator': 'make_table.py'}, 'extensionsUsed': used, 'scene': 0,
                'scenes': [{'nodes': list(range(len(nodes)))}], 'nodes': nodes,
                'cameras': [{'type': 'perspective',
                             'perspective': {'aspectRatio': 4 / 3, 'yfov': math.radians(self.fov), 'znear': 0.01}}],
                'meshes': meshes, 'materials': materials, 'textures': [{'source': 0}], 'images': [{'uri': WOOD}],
                'accessors': accessors, 'bufferViews': views,
                'buffers': [{'uri': self.name + '.bin', 'byteLength': len(data)}]}
        self.write('.bin', bytes(data))
        self.write('.gltf', json.dumps(text, indent=1) + '\n')

    def camera_matrix(self):
        back = [a - b for a, b in zip(self.eye, self.target)]
        length = math.sqrt(sum(c * c for c in back))
        back = [c / length for c in back]
        right = [back[2], 0, -back[0]]  # up x back
        length = math.hypot(right[0], right[2])
        right = [c / length for c in right]
        up = [back[1] * right[2] - back[2] * right[1], back[2] * right[0] - back[0] * right[2],
              back[0] * right[1] - back[1] * right[0]]
        return right + [0] + up + [0] + back + [0] + list(self.eye) + [1]

    def write_obj(self):
        text = ''
        for name, m in self.materials.items():
            text += f'newmtl {name}\n'
            if m['is'] == 'matte':
                text += f'Kd {numbers(m["colour"])}\n'
            elif m['is'] == 'wood':
                text += f'Kd 1 1 1\nmap_Kd {WOOD}\n'
            elif m['is'] == 'glass':
                text += f'Kd 0 0 0\nTf 1 1 1\nNi {m["index"]}\nillum 7\n'
            elif m['is'] == 'metal':
                text += f'Kd {numbers(m["colour"])}\nPm 1\nPr {m["roughness"]}\n'
            else:
                text += f'Kd 0 0 0\nKe {numbers(m["radiance"])}\n'
        self.write('.mtl', text)
        self.write('.obj', f'mtllib {self.name}.mtl\n' + self.obj_of(self.surfaces, True))

    @staticmethod
    def obj_of(surfaces, with_materials=False):
        text, places, normals, coordinates = '', 1, 1, 1
        exact = lambda values: ' '.join('%.9g' % v for v in values)
        for s in surfaces:
            text += f'o {s.name}\n' + (f'usemtl {s.material}\n' if with_materials else '')
            text += ''.join(f'v {exact(p)}\n' for p in s.positions)
            text += ''.join(f'vt {exact(t)}\n' for t in s.coordinates)
            text += ''.join(f'vn {exact(n)}\n' for n in s.normals)
            for t in s.triangles:
                corners = (f'{places + v}/{coordinates + v if s.coordinates else ""}/{normals + v if s.normals else ""}'
                           .rstrip('/') for v in t)
                text += 'f ' + ' '.join(corners) + '\n'
            places += len(s.positions)
            normals += len(s.normals)
            coordinates += len(s.coordinates)
        return text


def numbers(values, between=' '):
    return between.join(repr(v) for v in values)


def table():
    materials = {'wood': {'is': 'wood'}, 'floor': {'is': 'matte', 'colour': (0.3, 0.32, 0.36)},
                 'tray': {'is': 'matte', 'colour': (0.3, 0.42, 0.45)}, 'water': {'is': 'glass', 'index': 1.33},
                 'crystal': {'is': 'glass', 'index': 1.5},
                 'gold': {'is': 'metal', 'colour': (1.0, 0.78, 0.34), 'roughness': 0.2},
                 'lamp': {'is': 'lamp', 'radiance': (420.0, 370.0, 310.0)}}
    tray = Surface('tray', 'tray')
    low, high, wall = (-0.42, 0, -0.28), (0.1, 0.07, 0.12), 0.015
    tray.block(low, (high[0], 0.012, high[2]))
    for a, b in (((low[0], 0.012, low[2]), (low[0] + wall, high[1], high[2])),
                 ((high[0] - wall, 0.012, low[2]), high),
                 ((low[0] + wall, 0.012, low[2]), (high[0] - wall, high[1], low[2] + wall)),
                 ((low[0] + wall, 0.012, high[2] - wall), (high[0] - wall, high[1], high[2]))):
        tray.block(a, b)
    sunk = wall / 2  # into the walls and the floor of the tray
    tumbler = rounded([(0, 0.001), (0.036, 0.001), (0.042, 0.11), (0.038, 0.11), (0.0325, 0.014), (0, 0.014)], 0.0015)
    band = rounded([(0.062, 0.001), (0.066, 0.001), (0.066, 0.03), (0.062, 0.03)], 0.001)
    return Scene('table', (0.06, 0.66, 0.62), (0.0, 0.0, -0.01), 42, materials, [
        Surface('top', 'wood').block((-0.7, -0.05, -0.45), (0.7, 0, 0.45), True),
        Surface('floor', 'floor').quad((-4, -0.75, 4), (8, 0, 0), (0, 0, -8)),
        tray,
        water('water', 'water', (low[0] + sunk, 0.006, low[2] + sunk), (high[0] - sunk, 0, high[2] - sunk), 0.05,
              (28, 22)),
        Surface('glass', 'crystal').turned(tumbler, (0.3, 0, -0.06), 36),
        Surface('ring', 'gold').turned(band, (0.28, 0, 0.2), 56),
        Surface('lamp', 'lamp').quad((-0.7, 1.0, -0.5), (0.08, 0, -0.1), (0.06, 0.0656, 0.048))])


def room():
    materials = {'wood': {'is': 'wood'}, 'wall': {'is': 'matte', 'colour': (0.75, 0.72, 0.66)},
                 'chest': {'is': 'matte', 'colour': (0.25, 0.35, 0.45)},
                 'brass': {'is': 'metal', 'colour': (0.9, 0.75, 0.45), 'roughness': 0.3},
                 'lamp': {'is': 'lamp', 'radiance': (14.0, 10.0, 6.5)}}
    w, h, d = 4, 2.6, 5
    walls = Surface('walls', 'wall')
    walls.quad((0, h, 0), (w, 0, 0), (0, 0, d))           # ceiling
    walls.quad((0, 0, 0), (w, 0, 0), (0, h, 0))           # back
    walls.quad((0, 0, d), (0, 0, -d), (0, h, 0))          # left
    walls.quad((w, 0, d), (-w, 0, 0), (0, h, 0))          # behind the camera
    for z0, z1, y0, y1 in ((0, 1.2, 0, h), (2.8, d, 0, h), (1.2, 2.8, 0, 0.9), (1.2, 2.8, 2.1, h)):
        walls.quad((w, y0, z0), (0, 0, z1 - z0), (0, y1 - y0, 0))  # right, around the window
    vase = rounded([(0, 0.801), (0.09, 0.801), (0.13, 0.95), (0.05, 1.12), (0.04, 1.12), (0.12, 0.95), (0.08, 0.811),
                    (0, 0.811)], 0.004)
    return Scene('room', (1.6, 1.5, 4.7), (2.1, 1.05, 0), 52, materials, [
        Surface('floor', 'wood').quad((0, 0, d), (w, 0, 0), (0, 0, -d), True),
        walls,
        Surface('chest', 'chest').block((0.5, 0, 0.3), (1.9, 0.8, 0.9)),
        Surface('vase', 'brass').turned(vase, (1.0, 0, 0.6), 36),
        Surface('lamp', 'lamp').quad((0.8, 2.59, 1.5), (0.5, 0, 0), (0, 0, 0.5))], sky=(3.0, 4.0, 5.5))


if __name__ == '__main__':
    table().write_all()
    made = room()
    made.write_all()
    # Radiance's format: 3, 4, 5.5 are 96, 128, 176 times 2^-5, whose exponent is 3.
    made.write('_sky.hdr', b'#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n'
               + 2 * bytes([int(c * 32) for c in made.sky] + [128 + 3]))
