# Scenes for the programs that bench/time_to_error.py measures: Tungsten, pbrt-v3 and SmallVCM.
#   peer_scenes.py tungsten|pbrt|smallvcm SCENE.json FOLDER SIZE
# SCENE.json is one of photongrid's (`photongrid convert` makes one of others); the folder gets the scene for a square
# picture. Lengths become metres, so that W and W/(m^2 sr) are the other programs' units, too. What a program cannot
# draw as it is here is an error, so that no picture of another scene is compared.
import json
import math
import os
import struct
import sys


class Unsupported(Exception):
    pass


def add(a, b):
    return [x + y for x, y in zip(a, b)]


def sub(a, b):
    return [x - y for x, y in zip(a, b)]


def scaled(a, s):
    return [x * s for x in a]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def length(a):
    return math.sqrt(dot(a, a))


def unit(a):
    return scaled(a, 1 / length(a))


def frame(axis):
    """Two unit vectors that are perpendicular to the axis and to each other, right-handed with it."""
    x = unit(cross([0, 1, 0] if abs(axis[0]) > abs(axis[1]) else [1, 0, 0], axis))
    return x, cross(axis, x)


class Mesh:
    def __init__(self, positions, triangles, normals=None):
        self.positions, self.triangles, self.normals = positions, triangles, normals

    def is_flat(self):
        """Whether its normals are those of its triangles, on either side."""
        p = self.positions
        for a, b, c in self.triangles:
            normal = cross(sub(p[b], p[a]), sub(p[c], p[a]))
            if any(abs(dot(normal, self.normals[i])) < 0.9999 * length(normal) for i in (a, b, c)):
                return False
        return True

    def area(self):
        p = self.positions
        return sum(length(cross(sub(p[b], p[a]), sub(p[c], p[a]))) / 2 for a, b, c in self.triangles)


def read_ply(path):
    """Positions, normals and triangles of a binary little-endian PLY file."""
    with open(path, "rb") as f:
        data = f.read()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    elements = []
    for line in data[:end].decode().splitlines():
        words = line.split()
        if words[0] == "format" and words[1] != "binary_little_endian":
            raise Unsupported(f"{path}: format {words[1]}")
        if words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        elif words[0] == "property":
            elements[-1][2].append(words[1:])
    codes = {"char": "b", "int8": "b", "uchar": "B", "uint8": "B", "short": "h", "int16": "h", "ushort": "H",
             "uint16": "H", "int": "i", "int32": "i", "uint": "I", "uint32": "I", "float": "f", "float32": "f",
             "double": "d", "float64": "d"}
    mesh, at = Mesh([], [], []), end
    for name, count, properties in elements:
        if name == "vertex":
            names = [p[1] for p in properties]
            record = struct.Struct("<" + "".join(codes[p[0]] for p in properties))
            for i in range(count):
                v = dict(zip(names, record.unpack_from(data, at + i * record.size)))
                mesh.positions.append([v["x"], v["y"], v["z"]])
                if "nx" in v:
                    mesh.normals.append([v["nx"], v["ny"], v["nz"]])
            at += count * record.size
        elif name == "face":
            for _ in range(count):
                for p in properties:
                    if p[0] != "list":
                        at += struct.calcsize(codes[p[0]])
                        continue
                    n = struct.unpack_from("<" + codes[p[1]], data, at)[0]
                    at += struct.calcsize(codes[p[1]])
                    corners = struct.unpack_from(f"<{n}{codes[p[2]]}", data, at)
                    at += struct.calcsize(codes[p[2]]) * n
                    mesh.triangles += [[corners[0], corners[j], corners[j + 1]] for j in range(1, n - 1)]
        else:
            raise Unsupported(f"{path}: element {name}")
    return mesh


class Scene:
    """A scene of photongrid in metres: shapes as (kind, what, material), lights as (kind, what, colour)."""

    def __init__(self, path):
        with open(path) as f:
            s = json.load(f)
        self.folder = os.path.dirname(path)
        self.metres = {"mm": 1e-3, "cm": 1e-2, "m": 1}[s["units"]["length"]]
        camera = s["camera"]
        self.position, self.look_at = self.point(camera["position"]), self.point(camera["look_at"])
        self.up, self.fov = camera["up"], camera["vertical_fov"]
        self.photon_depth = s["render"].get("photon_depth", 32)
        self.materials = s["materials"]
        self.shapes, self.lights = [], []
        for shape in s["shapes"]:
            self.add_shape(shape)
        for light in s["lights"]:
            self.add_light(light)

    def point(self, p):
        return scaled(p, self.metres)

    def mesh(self, shape):
        if "file" in shape:
            mesh = read_ply(os.path.join(self.folder, shape["file"]))
        else:
            mesh = Mesh(shape["positions"], shape["triangles"], shape.get("normals"))
        rows = shape.get("matrix")
        if not rows and any(key in shape for key in ("scale", "rotate", "translate")):
            raise Unsupported("a mesh placed by scale, rotate or translate")
        if rows:
            columns = [[row[i] for row in rows] for i in range(3)]
            # Normals turn with the cofactors of the matrix.
            turned = [cross(columns[1], columns[2]), cross(columns[2], columns[0]), cross(columns[0], columns[1])]
            mesh.positions = [[dot(row[:3], p) + row[3] for row in rows] for p in mesh.positions]
            if mesh.normals:
                mesh.normals = [unit([sum(turned[j][i] * n[j] for j in range(3)) for i in range(3)])
                                for n in mesh.normals]
        mesh.positions = [self.point(p) for p in mesh.positions]
        if mesh.normals and mesh.is_flat():
            mesh.normals = None
        return mesh

    def add_shape(self, shape):
        kind, material = shape["type"], shape["material"]
        if kind in ("polygon", "triangle"):
            corners = [self.point(v) for v in shape["vertices"]]
            fan = [[0, i, i + 1] for i in range(1, len(corners) - 1)]
            self.shapes.append(("mesh", Mesh(corners, fan), material))
        elif kind == "mesh":
            self.shapes.append(("mesh", self.mesh(shape), material))
        elif kind == "sphere":
            self.shapes.append((kind, (self.point(shape["center"]), shape["radius"] * self.metres), material))
        elif kind == "cylinder":
            ends = (self.point(shape["base"]), self.point(shape["top"]), shape["radius"] * self.metres)
            self.shapes.append((kind, ends, material))
        else:
            raise Unsupported(f"shape {kind}")

    def add_light(self, light):
        kind, power = light["type"], light["power"]
        if kind == "rectangle":
            corner, u, v = (self.point(light[key]) for key in ("corner", "edge_u", "edge_v"))
            radiance = scaled(power, 1 / (math.pi * length(cross(u, v))))
            self.lights.append((kind, (corner, u, v), radiance))
        elif kind == "mesh_light":
            mesh = self.mesh(light)
            p = mesh.positions
            if len(p) != 4 or len(mesh.triangles) != 2:
                raise Unsupported("a mesh that emits and is no rectangle")
            a, b, c = mesh.triangles[0]
            corner = next(i for i in (a, b, c) if self.is_right_angle(p, (a, b, c), i))
            order = [a, b, c]
            while order[0] != corner:
                order = order[1:] + order[:1]
            u, v = sub(p[order[1]], p[corner]), sub(p[order[2]], p[corner])
            self.lights.append(("rectangle", (p[corner], u, v), scaled(power, 1 / (math.pi * mesh.area()))))
        elif kind == "point":
            self.lights.append((kind, self.point(light["position"]), scaled(power, 1 / (4 * math.pi))))
        else:
            raise Unsupported(f"light {kind}")

    @staticmethod
    def is_right_angle(p, corners, i):
        u, v = (sub(p[j], p[i]) for j in corners if j != i)
        return abs(dot(u, v)) < 1e-3 * length(u) * length(v)

    def material(self, name, rough=False):
        """Its kind (matte, mirror, glass), colour and index of refraction; if rough ones are allowed, also satin metal
        and plastic, which have GGX's alpha in place of the index."""
        m = self.materials[name]
        known = {"type", "comment", "reflectance", "transmittance", "index_of_refraction"}
        usual = {"roughness": 0, "opacity": 1}
        if rough and m["type"] == "plastic":
            return "plastic", m["reflectance"], m.get("roughness", 0)**2
        if rough and m["type"] == "metal" and m.get("energy") == "single" and m.get("roughness", 0) > 0:
            return "satin", m["reflectance"], m["roughness"]**2
        other = sorted(key for key in m if key not in known and (key not in usual or m[key] != usual[key]))
        if other:
            raise Unsupported(f"material {name}: {', '.join(other)}")
        white = [1, 1, 1]
        if m["type"] == "lambertian":
            return "matte", m["reflectance"], None
        if m["type"] in ("mirror", "metal"):
            return "mirror", m.get("reflectance", white), None
        if m["type"] == "glass":
            return "glass", m.get("transmittance", white), m["index_of_refraction"]
        raise Unsupported(f"material {name}: {m['type']}")


def corners_of_light(where):
    corner, u, v = where
    return [corner, add(corner, u), add(add(corner, u), v), add(corner, v)]


def cylinder_mesh(base, top, radius, parts=2048):
    axis = unit(sub(top, base))
    x, y = frame(axis)
    positions, normals, triangles = [], [], []
    for i in range(parts):
        angle = 2 * math.pi * i / parts
        normal = add(scaled(x, math.cos(angle)), scaled(y, math.sin(angle)))
        for end in (base, top):
            positions.append(add(end, scaled(normal, radius)))
            normals.append(normal)
        a, b = 2 * i, 2 * ((i + 1) % parts)
        triangles += [[a, b, b + 1], [a, b + 1, a + 1]]
    return Mesh(positions, triangles, normals)


def numbers(*values):
    flat = []
    for v in values:
        flat += v if isinstance(v, (list, tuple)) else [v]
    return " ".join(f"{x:.9g}" for x in flat)


def write_obj(path, mesh):
    with open(path, "w") as f:
        f.writelines(f"v {numbers(p)}\n" for p in mesh.positions)
        f.writelines(f"vn {numbers(n)}\n" for n in mesh.normals or [])
        for t in mesh.triangles:
            f.write("f " + " ".join(f"{i + 1}//{i + 1}" if mesh.normals else f"{i + 1}" for i in t) + "\n")


def to_tungsten(scene, folder, size):
    bsdfs, primitives = [], []
    for name in scene.materials:
        kind, colour, index = scene.material(name)
        bsdf = {"name": name, "albedo": colour, "type": {"matte": "lambert", "glass": "dielectric"}.get(kind, kind)}
        if index:
            bsdf["ior"] = index
        bsdfs.append(bsdf)
    bsdfs.append({"name": "lamp", "albedo": 1, "type": "null"})
    for number, (kind, what, material) in enumerate(scene.shapes):
        if kind == "sphere":
            primitives.append({"type": "sphere", "bsdf": material,
                               "transform": {"position": what[0], "scale": what[1]}})
            continue
        mesh = what if kind == "mesh" else cylinder_mesh(*what)
        file = f"{number}.obj"
        write_obj(os.path.join(folder, file), mesh)
        primitives.append({"type": "mesh", "file": file, "smooth": bool(mesh.normals), "bsdf": material})
    for kind, where, colour in scene.lights:
        if kind == "point":
            primitives.append({"type": "point", "emission": colour, "transform": {"position": where}})
        else:
            corner, u, v = where
            middle = add(corner, scaled(add(u, v), 0.5))
            columns = [v, unit(cross(u, v)), u, middle]  # its normal is the third cross the first
            matrix = [c[row] for row in range(3) for c in columns] + [0, 0, 0, 1]
            primitives.append({"type": "quad", "emission": colour, "bsdf": "lamp", "transform": matrix})
    camera = {"type": "pinhole", "fov": scene.fov, "resolution": [size, size], "reconstruction_filter": "box",
              "tonemap": "linear",
              "transform": {"position": scene.position, "look_at": scene.look_at, "up": scene.up}}
    return {"media": [], "bsdfs": bsdfs, "primitives": primitives, "camera": camera}


def pbrt_mesh(mesh):
    text = f'Shape "trianglemesh" "integer indices" [ {" ".join(str(i) for t in mesh.triangles for i in t)} ]\n'
    text += f'"point P" [ {" ".join(numbers(p) for p in mesh.positions)} ]\n'
    if mesh.normals:
        text += f'"normal N" [ {" ".join(numbers(n) for n in mesh.normals)} ]\n'
    return text


def pbrt_film(size, picture):
    return (f'Film "image" "integer xresolution" [ {size} ] "integer yresolution" [ {size} ] "string filename" '
            f'"{os.path.abspath(picture)}"\nPixelFilter "box"\n')


def to_pbrt(scene):
    """The world, from WorldBegin on, and the camera."""
    # pbrt's camera is left-handed; the scale keeps the scene's axes.
    camera = f"Scale -1 1 1\nLookAt {numbers(scene.position, scene.look_at, scene.up)}\n"
    camera += f'Camera "perspective" "float fov" [ {scene.fov} ]\n'
    world = "WorldBegin\n"
    for name in scene.materials:
        kind, colour, index = scene.material(name, rough=True)
        values = {"matte": f'"rgb Kd" [ {numbers(colour)} ] "float sigma" [ 0 ]',
                  "mirror": f'"rgb Kr" [ {numbers(colour)} ]',
                  "glass": f'"rgb Kr" [ {numbers(colour)} ] "rgb Kt" [ {numbers(colour)} ] "float index" [ {index} ]',
                  # The metal reflects all; the other half of the mix nothing. Our coat is another than pbrt's.
                  "satin": f'"rgb amount" [ {numbers(colour)} ] "string namedmaterial1" [ "{name} all" ] '
                           f'"string namedmaterial2" [ "none" ]',
                  "plastic": f'"rgb Kd" [ {numbers(colour)} ] "rgb Ks" [ 1 1 1 ] "float roughness" [ '
                             f'{max(index or 0, 1e-4)} ] "bool remaproughness" [ "false" ]'}
        if kind == "satin":
            world += (f'MakeNamedMaterial "{name} all" "string type" [ "metal" ] "rgb eta" [ 1 1 1 ] "rgb k" '
                      f'[ 1e4 1e4 1e4 ] "float roughness" [ {index} ] "bool remaproughness" [ "false" ]\n'
                      'MakeNamedMaterial "none" "string type" [ "matte" ] "rgb Kd" [ 0 0 0 ]\n')
        world += f'MakeNamedMaterial "{name}" "string type" [ "{kind.replace("satin", "mix")}" ] {values[kind]}\n'
    for kind, what, material in scene.shapes:
        world += f'AttributeBegin\nNamedMaterial "{material}"\n'
        if kind == "mesh":
            world += pbrt_mesh(what)
        elif kind == "sphere":
            world += f'Translate {numbers(what[0])}\nShape "sphere" "float radius" [ {what[1]:.9g} ]\n'
        else:
            base, top, radius = what
            axis = unit(sub(top, base))
            x, y = frame(axis)
            world += f"ConcatTransform [ {numbers(x, 0, y, 0, axis, 0, base, 1)} ]\n"
            world += f'Shape "cylinder" "float radius" [ {radius:.9g} ] "float zmin" [ 0 ] '
            world += f'"float zmax" [ {length(sub(top, base)):.9g} ]\n'
        world += "AttributeEnd\n"
    for kind, where, colour in scene.lights:
        if kind == "point":
            world += f'LightSource "point" "rgb I" [ {numbers(colour)} ] "point from" [ {numbers(where)} ]\n'
        else:
            world += f'AttributeBegin\nMaterial "matte" "rgb Kd" [ 0 0 0 ]\nAreaLightSource "diffuse" "rgb L" [ '
            world += f"{numbers(colour)} ]\n{pbrt_mesh(Mesh(corners_of_light(where), [[0, 1, 2], [0, 2, 3]]))}"
            world += "AttributeEnd\n"
    return camera, world + "WorldEnd\n"


def to_smallvcm(scene):
    """A line for the camera, and for each material, triangle, ball and light. SmallVCM's scenes are built in: the
    executable smallvcm is one that reads this file, which $PHOTONGRID_SCENE names, and its size, depth, radius and
    alpha from $PHOTONGRID_SIZE, $PHOTONGRID_DEPTH, $PHOTONGRID_RADIUS and $PHOTONGRID_ALPHA. Its matte triangles must
    have two sides, as photongrid's have."""
    lines = [f"camera {numbers(scene.position, sub(scene.look_at, scene.position), scene.up, scene.fov)}"]
    names = list(scene.materials)
    for name in names:
        kind, colour, index = scene.material(name)
        if kind == "glass" and colour != [1, 1, 1]:
            raise Unsupported("glass that absorbs")
        black = [0, 0, 0]
        lines.append("material " + numbers(colour if kind == "matte" else black,
                                           black if kind == "matte" else colour, index or -1))
    for kind, what, material in scene.shapes:
        if kind == "sphere":
            lines.append(f"ball {numbers(what[0], what[1])} {names.index(material)}")
        elif kind == "mesh" and not what.normals and len(what.triangles) < 100:
            for t in what.triangles:
                lines.append("triangle " + numbers(*(what.positions[i] for i in t)) + f" {names.index(material)}")
        else:
            raise Unsupported("shapes that are no balls and no few flat triangles")
    for kind, where, colour in scene.lights:
        if kind == "point":
            lines.append(f"point {numbers(where, colour)}")
        else:
            c = corners_of_light(where)
            for t in ((0, 1, 2), (0, 2, 3)):
                lines.append("lamp " + numbers(*(c[i] for i in t), colour))
    return "\n".join(lines) + "\n"


def export(program, path, folder, size):
    scene = Scene(path)
    os.makedirs(folder, exist_ok=True)
    if program == "tungsten":
        with open(os.path.join(folder, "scene.json"), "w") as f:
            json.dump(to_tungsten(scene, folder, size), f, indent=1)
    elif program == "pbrt":
        camera, world = to_pbrt(scene)
        for name, text in (("camera.pbrt", camera), ("world.pbrt", world)):
            with open(os.path.join(folder, name), "w") as f:
                f.write(text)
    else:
        with open(os.path.join(folder, "scene.txt"), "w") as f:
            f.write(to_smallvcm(scene))


if __name__ == "__main__":
    try:
        export(sys.argv[1], sys.argv[2], sys.argv[3], int(sys.argv[4]))
    except Unsupported as e:
        sys.exit(f"peer_scenes.py: {sys.argv[2]}: {sys.argv[1]} does not draw {e}")
