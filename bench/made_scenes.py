#!/usr/bin/env python3
"""Writes scenes that are too long to keep: what a lathe and a saw make, as triangles.

  bench/made_scenes.py NAME FOLDER      FOLDER/NAME.json, in photongrid's format

  satin_ring       a band of satin metal and one of brushed metal on a table, below a lamp
  coffee_maker     varnished and plastic housing, chrome, a pot of glass with coffee in it
  glass_of_water   a glass, water that overlaps it by 0.2 mm, two cubes of ice, as a modeller leaves them: nested bodies
                   with priorities. glass_of_water.pbrt beside it is the same for pbrt-v3, which knows interfaces alone
"""
import json
import math
import os
import sys

from peer_scenes import Mesh, numbers, pbrt_mesh, to_pbrt, Scene

AROUND = 96  # points
RENDER = {"size": [512, 512], "photons": 60000, "k": 100, "grid": [64, 64, 64], "max_radius": 1, "light_samples": 1,
          "spp": 1, "passes": 16, "depth": 64, "photon_depth": 64, "seed": 1, "map": "sort", "slots": 4, "exposure": 0}


def turned(profile, around=AROUND):
    """Turns points (radius, height), which go up outside, about the y axis."""
    positions, triangles, rings = [], [], []
    for radius, height in profile:
        count = around if radius > 0 else 1
        rings.append(range(len(positions), len(positions) + count))
        for i in range(count):
            angle = 2 * math.pi * i / around
            positions.append([radius * math.cos(angle), height, -radius * math.sin(angle)])
    for low, high in zip(rings, rings[1:]):
        for i in range(around):
            a, b = low[i % len(low)], low[(i + 1) % len(low)]
            c, d = high[i % len(high)], high[(i + 1) % len(high)]
            triangles += [[a, b, d]] if len(low) > 1 else []
            triangles += [[a, d, c]] if len(high) > 1 else []
    return Mesh(positions, triangles)


def moved(mesh, x, y, z):
    mesh.positions = [[p[0] + x, p[1] + y, p[2] + z] for p in mesh.positions]
    return mesh


def box(low, high):
    corners = [[(low, high)[i >> a & 1][a] for a in range(3)] for i in range(8)]
    quads = ((0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6))
    return Mesh(corners, [t for a, b, c, d in quads for t in ([a, b, c], [a, c, d])])


def tilted(mesh, about_x, about_y):
    """Turned about the x axis, then about the y axis."""
    def turn(p):
        x, y, z = p
        y, z = y * math.cos(about_x) - z * math.sin(about_x), y * math.sin(about_x) + z * math.cos(about_x)
        return [x * math.cos(about_y) + z * math.sin(about_y), y, z * math.cos(about_y) - x * math.sin(about_y)]
    mesh.positions = [turn(p) for p in mesh.positions]
    return mesh


def shape(mesh, material):
    return {"type": "mesh", "positions": mesh.positions, "triangles": mesh.triangles, "material": material}


def wall(material, corner, u, v):
    other = [a + b for a, b in zip(corner, u)]
    far = [a + b for a, b in zip(other, v)]
    return {"type": "polygon", "vertices": [corner, other, far, [a + b for a, b in zip(corner, v)]],
            "material": material}


def lamp(corner, u, v, power):
    return {"type": "rectangle", "corner": corner, "edge_u": u, "edge_v": v, "power": power}


def room(wide, high, floor, walls):
    """Open in front, z = wide."""
    w = wide
    return [wall(floor, [-w, 0, -w], [0, 0, 2 * w], [2 * w, 0, 0]),
            wall(walls, [-w, 0, -w], [2 * w, 0, 0], [0, high, 0]),
            wall(walls, [-w, 0, w], [0, 0, -2 * w], [0, high, 0]),
            wall(walls, [w, 0, -w], [0, 0, 2 * w], [0, high, 0]),
            wall(walls, [-w, high, -w], [2 * w, 0, 0], [0, 0, 2 * w])]


def scene(name, position, look_at, fov, materials, shapes, lights, **render):
    return {"photongrid": 1, "name": name, "units": {"length": "m", "power": "W"},
            "camera": {"position": position, "look_at": look_at, "up": [0, 1, 0], "vertical_fov": fov},
            "materials": materials, "shapes": shapes, "lights": lights, "render": {**RENDER, **render}}


def matte(*reflectance):
    return {"type": "lambertian", "reflectance": list(reflectance)}


def metal(roughness, *reflectance):
    return {"type": "metal", "reflectance": list(reflectance), "roughness": roughness, "energy": "single"}


def satin_ring():
    def band(radius, height, thick):
        return turned([(radius, 0), (radius + thick, 0), (radius + thick, height), (radius, height), (radius, 0)])
    materials = {"table": matte(0.7, 0.62, 0.52), "walls": matte(0.6, 0.6, 0.65),
                 "satin": metal(0.45, 0.94, 0.82, 0.56),
                 "brushed": metal(0.25, 0.8, 0.8, 0.82)}
    shapes = room(0.6, 0.8, "table", "walls") + [shape(moved(band(0.2, 0.1, 0.01), -0.1, 1e-4, 0), "satin"),
                                                shape(moved(band(0.1, 0.16, 0.01), 0.27, 1e-4, 0.16), "brushed")]
    return scene("satin ring", [0, 0.62, 0.95], [0.03, 0.05, 0.02], 40, materials, shapes,
                 [lamp([0.2, 0.79, -0.1], [0.1, 0, 0], [0, 0, 0.1], [2.6, 2.5, 2.3])])


def coffee_maker():
    materials = {"counter": {"type": "plastic", "reflectance": [0.45, 0.3, 0.2]}, "walls": matte(0.7, 0.7, 0.66),
                 "housing": {"type": "plastic", "reflectance": [0.12, 0.12, 0.14]},
                 "red": {"type": "plastic", "reflectance": [0.6, 0.06, 0.05], "roughness": 0.35},
                 "chrome": metal(0.2, 0.75, 0.76, 0.78), "plate": metal(0.45, 0.5, 0.5, 0.5),
                 "glass": {"type": "glass", "index_of_refraction": 1.5}}
    glass = turned([(0, 0.05), (0.07, 0.05), (0.085, 0.09), (0.085, 0.14), (0.06, 0.19), (0.06, 0.2), (0.057, 0.2),
                    (0.057, 0.19), (0.082, 0.14), (0.082, 0.091), (0.068, 0.053), (0, 0.053)])
    coffee = turned([(0, 0.054), (0.0675, 0.054), (0.0815, 0.0915), (0.0815, 0.12), (0, 0.12)])
    materials["coffee"] = matte(0.08, 0.03, 0.01)
    shapes = room(0.6, 0.9, "counter", "walls") + [
        shape(box([-0.12, 0.001, -0.2], [0.12, 0.4, -0.1]), "housing"),
        shape(box([-0.12, 0.3, -0.0999], [0.12, 0.4, 0.1]), "red"),
        shape(box([-0.12, 0.001, -0.0999], [0.12, 0.04, 0.12]), "housing"),
        shape(turned([(0, 0.0401), (0.09, 0.0401), (0.09, 0.0495), (0, 0.0495)]), "plate"),
        shape(turned([(0, 0.23), (0.02, 0.23), (0.06, 0.2995), (0, 0.2995)]), "chrome"),
        shape(moved(turned([(0, 0.001), (0.035, 0.001), (0.045, 0.1), (0.042, 0.1), (0.033, 0.006), (0, 0.006)]),
                    0.24, 0, 0.12), "chrome"),
        shape(moved(turned([(0, 0.001), (0.035, 0.001), (0.045, 0.09), (0.041, 0.09), (0.032, 0.006), (0, 0.006)]),
                    -0.25, 0, 0.15), "red"),
        shape(glass, "glass"), shape(coffee, "coffee")]
    return scene("coffee maker", [0.25, 0.42, 0.95], [0, 0.17, 0], 36, materials, shapes,
                 [lamp([-0.3, 0.89, 0.1], [0.2, 0, 0], [0, 0, 0.2], [11, 10.4, 9.8]),
                  lamp([0.35, 0.89, -0.2], [0.08, 0, 0], [0, 0, 0.08], [4, 4.3, 4.6])])


GLASS, WATER, ICE = 1.5, 1.333, 1.31
INSIDE, OUTSIDE, FOOT, BOTTOM, RIM, LEVEL = 0.032, 0.035, 0.001, 0.009, 0.12, 0.085  # of the glass, m


def floating():
    return tilted(box([-0.011, LEVEL - 0.02, -0.011], [0.011, LEVEL + 0.004, 0.011]), 0, 0.5)


def sunk():
    return moved(tilted(box([-0.009] * 3, [0.009] * 3), 0.6, 0.9), 0.012, 0.035, 0.004)


def glass_of_water():
    glass = turned([(0, FOOT), (OUTSIDE, FOOT), (OUTSIDE, RIM), (INSIDE, RIM), (INSIDE, BOTTOM), (0, BOTTOM)])
    over = 2e-4
    water = turned([(0, BOTTOM - over), (INSIDE + over, BOTTOM - over), (INSIDE + over, LEVEL), (0, LEVEL)])

    def clear(index, priority):
        return {"type": "glass", "index_of_refraction": index, "priority": priority}
    materials = {"table": matte(0.6, 0.45, 0.3), "walls": matte(0.55, 0.6, 0.65), "glass": clear(GLASS, 3),
                 "water": clear(WATER, 1), "ice": clear(ICE, 2)}
    shapes = room(0.3, 0.5, "table", "walls") + [shape(glass, "glass"), shape(water, "water"),
                                                shape(floating(), "ice"), shape(sunk(), "ice")]
    return scene("glass of water", [0.05, 0.19, 0.28], [0, 0.055, 0], 34, materials, shapes,
                 [lamp([-0.15, 0.499, -0.1], [0.3, 0, 0], [0, 0, 0.3], [1.2, 1.2, 1.2])])


def interfaces():
    """The surfaces of the glass of water between two media each: a mesh, the index behind it over that before it."""
    glass_to_air = turned([(0, FOOT), (OUTSIDE, FOOT), (OUTSIDE, RIM), (INSIDE, RIM), (INSIDE, LEVEL)])
    glass_to_water = turned([(INSIDE, LEVEL), (INSIDE, BOTTOM), (0, BOTTOM)])
    cube = floating()
    hole = [[p[0], LEVEL, p[2]] for p in cube.positions[:2] + cube.positions[4:6]]
    hole = sorted(hole, key=lambda p: math.atan2(-p[2], p[0]) % (2 * math.pi))
    rim = [[INSIDE * math.cos(2 * math.pi * i / AROUND), LEVEL, -INSIDE * math.sin(2 * math.pi * i / AROUND)]
           for i in range(AROUND)]
    # Between the circle and the square: the next triangle goes on at the one whose next corner comes first.
    angles = [[math.atan2(-p[2], p[0]) % (2 * math.pi) for p in corners] for corners in (rim, hole)]
    triangles, at = [], [0, 0]
    while at[0] < len(rim) or at[1] < len(hole):
        ends = [angles[k][(at[k] + 1) % len(angles[k])] + 2 * math.pi * ((at[k] + 1) // len(angles[k])) for k in (0, 1)]
        goes = 0 if at[1] == len(hole) or (at[0] < len(rim) and ends[0] <= ends[1]) else 1
        outer, inner = at[0] % len(rim), len(rim) + at[1] % len(hole)
        next_one = (at[0] + 1) % len(rim) if goes == 0 else len(rim) + (at[1] + 1) % len(hole)
        triangles.append([outer, next_one, inner])
        at[goes] += 1
    surface = Mesh(rim + hole, triangles)
    above = Mesh([[p[0], max(p[1], LEVEL), p[2]] for p in cube.positions], cube.triangles)
    below = Mesh([[p[0], min(p[1], LEVEL), p[2]] for p in cube.positions], cube.triangles)

    def without_flat(mesh):  # the face that lies in the water's surface is none
        p = mesh.positions
        mesh.triangles = [t for t in mesh.triangles if any(abs(p[i][1] - LEVEL) > 1e-9 for i in t)]
        return mesh
    return [(glass_to_air, GLASS), (glass_to_water, GLASS / WATER), (surface, WATER), (without_flat(above), ICE),
            (without_flat(below), ICE / WATER), (sunk(), ICE / WATER)]


def write_interfaces(path):
    """For pbrt-v3: what is not glass from the scene beside it."""
    world = Scene(path)
    world.shapes = [s for s in world.shapes if s[2] in ("table", "walls")]
    world.materials = {name: world.materials[name] for name in ("table", "walls")}
    camera, text = to_pbrt(world)
    glass = ""
    for mesh, index in interfaces():
        glass += f'AttributeBegin\nMaterial "glass" "float index" [ {numbers(index)} ]\n{pbrt_mesh(mesh)}AttributeEnd\n'
    with open(path.replace(".json", ".pbrt"), "w") as f:
        f.write(camera + text.replace("WorldEnd\n", glass + "WorldEnd\n"))


SCENES = {"satin_ring": satin_ring, "coffee_maker": coffee_maker, "glass_of_water": glass_of_water}


def write_scene(name, folder):
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(folder, f"{name}.json")
    with open(path, "w") as f:
        json.dump(SCENES[name](), f)
    if name == "glass_of_water":
        write_interfaces(path)
    return path


if __name__ == "__main__":
    if len(sys.argv) != 3 or sys.argv[1] not in SCENES:
        sys.exit(__doc__)
    print(write_scene(*sys.argv[1:]))
