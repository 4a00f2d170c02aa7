# Draws a glTF file with Blender's path tracer, Cycles; pictures_of_others.sh runs it inside Blender:
#   blender -b --factory-startup -P cycles.py -- SCENE.gltf PICTURE.exr WIDTH HEIGHT SAMPLES
# What Blender's reader (3.4) makes of a file is made what the file says:
# - Its Principled BSDF has Burley's diffuse reflection, which glTF does not have, and a gloss where
#   KHR_materials_specular has the factor 0: such materials become a Diffuse BSDF, which is Lambert's.
# - Surfaces that are not double-sided emit from their front alone.
# - 683 lm of emission are 1 W.
import json
import sys

import numpy

for name in ("bool", "int", "float", "object"):  # which Blender's reader takes from an older numpy
    if not hasattr(numpy, name):
        setattr(numpy, name, getattr(__import__("builtins"), name))

import bpy

source, picture, width, height, samples = sys.argv[sys.argv.index("--") + 1:]
with open(source) as f:
    described = {m["name"]: m for m in json.load(f)["materials"]}
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=source)

for material in bpy.data.materials:
    if not material.use_nodes or material.name not in described:
        continue
    tree = material.node_tree
    principled = next(n for n in tree.nodes if n.type == "BSDF_PRINCIPLED")
    output = next(n for n in tree.nodes if n.type == "OUTPUT_MATERIAL")
    file = described[material.name]
    extensions = file.get("extensions", {})
    emission = principled.inputs["Emission Strength"].default_value / 683
    surface = principled
    if extensions.get("KHR_materials_specular", {}).get("specularFactor") == 0:
        principled.inputs["Specular"].default_value = 0
        if "emissiveFactor" not in file:
            surface = tree.nodes.new("ShaderNodeBsdfDiffuse")
            base = principled.inputs["Base Color"]
            surface.inputs["Color"].default_value = base.default_value
            for link in base.links:
                tree.links.new(link.from_socket, surface.inputs["Color"])
            tree.links.new(surface.outputs[0], output.inputs["Surface"])
    if surface == principled:
        principled.inputs["Emission Strength"].default_value = emission
        if not file.get("doubleSided") and "emissiveFactor" in file:
            seen = tree.nodes.new("ShaderNodeNewGeometry")
            front = tree.nodes.new("ShaderNodeMath")
            front.operation = "MULTIPLY_ADD"  # emission - emission backfacing
            tree.links.new(seen.outputs["Backfacing"], front.inputs[0])
            front.inputs[1].default_value = -emission
            front.inputs[2].default_value = emission
            tree.links.new(front.outputs[0], principled.inputs["Emission Strength"])

scene = bpy.context.scene
scene.camera = next(o for o in bpy.data.objects if o.type == "CAMERA")
if scene.world is None:
    scene.world = bpy.data.worlds.new("none")
scene.world.use_nodes = True
scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0
render = scene.render
render.engine = "CYCLES"
render.resolution_x, render.resolution_y, render.resolution_percentage = int(width), int(height), 100
render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
render.filepath = picture
cycles = scene.cycles
cycles.device, cycles.samples = "CPU", int(samples)
cycles.use_adaptive_sampling = cycles.use_denoising = False
cycles.pixel_filter_type, cycles.blur_glossy, cycles.sample_clamp_indirect = "BOX", 0, 0
cycles.caustics_reflective = cycles.caustics_refractive = True
for bounces in ("max_bounces", "diffuse_bounces", "glossy_bounces", "transmission_bounces"):
    setattr(cycles, bounces, 64)
bpy.ops.render.render(write_still=True)
