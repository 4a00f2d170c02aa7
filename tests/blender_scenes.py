# Scenes that Blender makes, exports as glTF and draws with Cycles; pictures_of_others.sh runs this inside Blender:
#   blender -b --factory-startup -P blender_scenes.py -- SCENE FOLDER SIZE SAMPLES
# writes FOLDER/SCENE.glb, FOLDER/SCENE.hdr if it has a sky, and FOLDER/SCENE-cycles.pfm; and compares, outside of it:
#   python3 blender_scenes.py OURS.pfm THEIRS.pfm         the largest difference of means over 16 x 16 pixels, a part
#                                                       of theirs plus a tenth of the picture's mean
import math
import os
import sys

import numpy


def read_pfm(path):
    with open(path, "rb") as f:
        assert f.readline().strip() == b"PF"
        width, height = map(int, f.readline().split())
        order = "<" if float(f.readline()) < 0 else ">"
        return numpy.frombuffer(f.read(), dtype=order + "f4").reshape(height, width, 3)[::-1].astype(float)


def blocks_of(picture, side=16):
    height, width, _ = picture.shape
    return picture.reshape(height // side, side, width // side, side, 3).mean(axis=(1, 3))


if len(sys.argv) == 3:
    ours, theirs = (blocks_of(read_pfm(path)) for path in sys.argv[1:])
    difference = (ours - theirs) / (theirs + 0.1 * theirs.mean())  # what is nearly black does not decide
    at = numpy.unravel_index(numpy.abs(difference).argmax(), difference.shape)
    print(f"{abs(difference[at]):.4f} {ours.mean() / theirs.mean() - 1:+.4f} ({at[1]}, {at[0]}, {'rgb'[at[2]]}) "
          f"{ours[at]:.4g} {theirs[at]:.4g}")
    sys.exit()

for name in ("bool", "int", "float", "object"):  # which Blender's exporter takes from an older numpy
    if not hasattr(numpy, name):
        setattr(numpy, name, getattr(__import__("builtins"), name))

import bpy

scene_name, folder, size, samples = sys.argv[sys.argv.index("--") + 1:]
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene


def material(name, **inputs):
    m = bpy.data.materials.new(name)
    m.use_nodes = True
    shader = m.node_tree.nodes["Principled BSDF"]
    shader.distribution = "MULTI_GGX"  # which keeps the light that one facet sends to another, as photongrid does
    shader.inputs["Specular"].default_value = 0
    for key, value in inputs.items():
        shader.inputs[key.replace("_", " ")].default_value = value
    return m


def picture(name, width, height, pixels, depth):
    image = bpy.data.images.new(name, width, height, float_buffer=depth != 8)
    image.pixels = [c for p in pixels for c in (*p, 1.0)]
    path = os.path.join(folder, name)
    scene.render.image_settings.file_format = "HDR" if name.endswith(".hdr") else "PNG"
    scene.render.image_settings.color_depth = str(depth) if depth != 32 else "32"
    if name.endswith(".hdr"):
        image.file_format = "HDR"
        image.filepath_raw = path
        image.save()
    else:
        scene.view_settings.view_transform = "Standard"
        image.save_render(path, scene=scene)
    return bpy.data.images.load(path)


def textured(name, image, **inputs):
    m = material(name, **inputs)
    node = m.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    node.interpolation = "Linear"
    m.node_tree.links.new(node.outputs["Color"], m.node_tree.nodes["Principled BSDF"].inputs["Base Color"])
    return m


def add(operator, of, location=(0, 0, 0), smooth=False, **options):
    operator(location=location, **options)
    o = bpy.context.object
    o.data.materials.append(of)
    if smooth:
        bpy.ops.object.shade_smooth()
    return o


def as_lambert():
    """Principled surfaces reflect as Burley's, which glTF does not have: without gloss they become Lambert's."""
    for m in bpy.data.materials:
        nodes, links = m.node_tree.nodes, m.node_tree.links
        shader = nodes["Principled BSDF"]
        if any(shader.inputs[i].default_value > 0 for i in ("Specular", "Metallic", "Transmission", "Emission Strength")
               if i != "Emission Strength" or sum(shader.inputs["Emission"].default_value[:3]) > 0):
            continue
        matt = nodes.new("ShaderNodeBsdfDiffuse")
        colour = shader.inputs["Base Color"]
        matt.inputs["Color"].default_value = colour.default_value
        for link in colour.links:
            links.new(link.from_socket, matt.inputs["Color"])
        links.new(matt.outputs[0], nodes["Material Output"].inputs["Surface"])


mesh = bpy.ops.mesh
WHITE = (0.7, 0.7, 0.7, 1)


def floor(of=None):
    add(mesh.primitive_plane_add, of or material("floor", Base_Color=WHITE, Roughness=1), size=6)


def ball(of, location, radius=0.6):
    add(mesh.primitive_uv_sphere_add, of, location, True, radius=radius, segments=64, ring_count=32)


def sky(image):
    world = bpy.data.worlds.new("sky")
    scene.world = world
    world.use_nodes = True
    node = world.node_tree.nodes.new("ShaderNodeTexEnvironment")
    node.image = image
    world.node_tree.links.new(node.outputs["Color"], world.node_tree.nodes["Background"].inputs["Color"])


def sun():
    floor()
    ball(material("red", Base_Color=(0.8, 0.1, 0.05, 1), Roughness=1), (0, 0, 0.6))
    bpy.ops.object.light_add(type="SUN", rotation=(0.7, 0.3, 0))
    bpy.context.object.data.energy = 3
    bpy.context.object.data.angle = 0


def lamps():
    floor()
    add(mesh.primitive_plane_add, material("wall", Base_Color=(0.2, 0.5, 0.7, 1), Roughness=1), (0, 2, 1.5), size=6,
        rotation=(math.pi / 2, 0, 0))
    ball(material("gold", Base_Color=(1, 0.6, 0.2, 1), Metallic=1, Roughness=0.25), (-0.6, 0, 0.6))
    bpy.ops.object.light_add(type="POINT", location=(1.5, -1, 2.5))
    bpy.context.object.data.energy = 80
    bpy.context.object.data.shadow_soft_size = 0
    bpy.ops.object.light_add(type="SPOT", location=(1.2, -1, 3))
    spot = bpy.context.object.data
    # Narrow: before Blender 4 its intensity falls with the cosine from the axis.
    spot.energy, spot.spot_size, spot.spot_blend, spot.shadow_soft_size = 200, 0.3, 0, 0


def emission():
    floor()
    lit = add(mesh.primitive_plane_add, material("lamp", Emission=(1, 0.9, 0.8, 1), Emission_Strength=12,
              Base_Color=(0, 0, 0, 1)), (0, 0.5, 4), size=1.5)
    lit.data.materials[0].use_backface_culling = False
    first = add(mesh.primitive_cube_add, material("green", Base_Color=(0.1, 0.6, 0.2, 1), Roughness=1), (-1.2, 0, 0.4),
                size=0.8)
    for x in (0, 1.2):  # instances: one mesh
        other = bpy.data.objects.new("again", first.data)
        other.location = (x, 0.3 * x, 0.4)
        other.rotation_euler = (0, 0, x)
        scene.collection.objects.link(other)


def plastic():
    floor()
    ball(material("plastic", Base_Color=(0.8, 0.1, 0.05, 1), Roughness=0.4, Specular=0.5), (0, 0, 0.6))
    add(mesh.primitive_plane_add, material("lamp", Emission=(1, 1, 1, 1), Emission_Strength=4,
        Base_Color=(0, 0, 0, 1)), (0.5, 0.5, 4), size=3)


def textures():
    # Large pictures: Cycles interpolates encoded colours, glTF linear ones.
    checks = [(0.8, 0.2, 0.1) if (x // 128 + y // 128) % 2 else (0.1, 0.3, 0.7) for y in range(1024)
              for x in range(1024)]
    greys = [(0.05 + 0.9 * x / 1023,) * 3 for y in range(4) for x in range(1024)]
    floor(textured("checks", picture("checks.png", 1024, 1024, checks, 8), Roughness=1))
    wall = add(mesh.primitive_plane_add, textured("ramp", picture("ramp16.png", 1024, 4, greys, 16), Roughness=1),
               (0, 2, 1.5), size=6, rotation=(math.pi / 2, 0, 0))
    wall.data.update()
    ball(material("mirror", Base_Color=(0.9, 0.9, 0.9, 1), Metallic=1, Roughness=0), (0.3, 0, 0.6))
    pixels = [((4, 0.4, 0.3), (0.3, 1, 0.4), (0.2, 0.3, 2), (1, 1, 1))[x // 64] for y in range(128) for x in range(256)]
    image = picture("textures.hdr", 256, 128, pixels, 32)
    sky(image)


def glass():
    floor()
    ball(material("glass", Base_Color=(1, 1, 1, 1), Transmission=1, Roughness=0, IOR=1.45, Specular=0.5), (0, 0, 0.7))
    add(mesh.primitive_plane_add, material("lamp", Emission=(1, 1, 1, 1), Emission_Strength=4,
        Base_Color=(0, 0, 0, 1)), (0.5, 0.5, 4), size=3)


{"sun": sun, "lamps": lamps, "emission": emission, "textures": textures, "glass": glass,
 "plastic": plastic}[scene_name]()

bpy.ops.object.camera_add(location=(0, -5, 2.4), rotation=(math.radians(70), 0, 0))
scene.camera = bpy.context.object
scene.camera.data.angle = math.radians(45)
scene.render.resolution_x = scene.render.resolution_y = int(size)
scene.render.resolution_percentage = 100
if scene.world is None:
    scene.world = bpy.data.worlds.new("dark")
    scene.world.color = (0, 0, 0)
bpy.ops.export_scene.gltf(filepath=os.path.join(folder, scene_name + ".glb"), export_lights=True, export_cameras=True)

as_lambert()
scene.render.engine = "CYCLES"
scene.cycles.device = "CPU"
scene.cycles.samples = int(samples)
scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
scene.cycles.pixel_filter_type = "BOX"
scene.cycles.light_sampling_threshold = 0
scene.cycles.sample_clamp_indirect = scene.cycles.sample_clamp_direct = 0
scene.cycles.blur_glossy = 0
for bounces in ("max_bounces", "diffuse_bounces", "glossy_bounces", "transmission_bounces"):
    setattr(scene.cycles, bounces, 32)
scene.render.image_settings.file_format = "OPEN_EXR"
scene.render.image_settings.color_depth = "32"
scene.render.filepath = os.path.join(folder, scene_name + "-cycles.exr")
bpy.ops.render.render(write_still=True)
drawn = bpy.data.images.load(scene.render.filepath)
pixels = numpy.empty(drawn.size[0] * drawn.size[1] * 4, dtype="f4")
drawn.pixels.foreach_get(pixels)
with open(os.path.join(folder, scene_name + "-cycles.pfm"), "wb") as f:
    f.write(f"PF\n{drawn.size[0]} {drawn.size[1]}\n-1.0\n".encode())
    f.write(pixels.reshape(-1, 4)[:, :3].astype("<f4").tobytes())
