"""Inside Blender: what a matte white ball sends back, under a whole environment and under its remainder with its lights.

    blender -b --python blender_lights.py -- NUMBERS WHOLE REMAINDER LIGHTS.gltf

The lights are read by Blender's own glTF importer, with "Raw (Blender Strengths with Nits)": an intensity of the file is then an irradiance. Writes two lines
of three numbers, the mean of the ball's picture from +Z of glTF: under the whole, and under both parts.
"""

import math
import os
import sys

import bpy
import mathutils

numbers, whole, remainder, lights = sys.argv[sys.argv.index("--") + 1:][:4]
SIZE = 24

scene = bpy.context.scene
for thing in list(bpy.data.objects):
    bpy.data.objects.remove(thing)
scene.render.engine = "CYCLES"
scene.cycles.device = "CPU"
scene.cycles.samples = 512
scene.cycles.use_denoising = False
scene.cycles.use_adaptive_sampling = False
scene.cycles.sample_clamp_direct = scene.cycles.sample_clamp_indirect = 0
scene.render.resolution_x = scene.render.resolution_y = SIZE
scene.render.resolution_percentage = 100
scene.render.threads_mode, scene.render.threads = "FIXED", 2
scene.render.film_transparent = True
scene.render.image_settings.file_format = "OPEN_EXR"
scene.render.image_settings.color_mode = "RGBA"
scene.render.image_settings.color_depth = "32"

bpy.ops.mesh.primitive_uv_sphere_add(segments=128, ring_count=64)
bpy.ops.object.shade_smooth()
ball = bpy.context.object
ball.visible_diffuse = False  # the camera sees the ball, and the ball does not light itself
material = bpy.data.materials.new("matte")
material.use_nodes = True
nodes, links = material.node_tree.nodes, material.node_tree.links
diffuse = nodes.new("ShaderNodeBsdfDiffuse")
diffuse.inputs["Color"].default_value = (1, 1, 1, 1)
links.new(diffuse.outputs["BSDF"], nodes["Material Output"].inputs["Surface"])
ball.data.materials.append(material)

camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
scene.collection.objects.link(camera)
scene.camera = camera
camera.data.type, camera.data.ortho_scale = "ORTHO", 2
# At +Z of glTF, which is -Y here.
camera.matrix_world = mathutils.Matrix.Translation((0, -5, 0)) @ mathutils.Matrix.Rotation(math.pi / 2, 4, "X")

world = scene.world = bpy.data.worlds.new("world")
world.use_nodes = True
texture = world.node_tree.nodes.new("ShaderNodeTexEnvironment")
world.node_tree.links.new(texture.outputs["Color"], world.node_tree.nodes["Background"].inputs["Color"])


def picture_under(image):
    texture.image = bpy.data.images.load(image)
    texture.image.colorspace_settings.name = "Linear" if bpy.app.version < (4, 0) else "Linear Rec.709"
    scene.render.filepath = f"{numbers}.exr"
    bpy.ops.render.render(write_still=True)
    picture = bpy.data.images.load(scene.render.filepath, check_existing=False)
    pixels = list(picture.pixels)
    bpy.data.images.remove(picture)
    return [sum(pixels[c::4]) / (SIZE * SIZE) for c in range(3)]


with open(numbers, "w") as out:
    out.write("%.7g %.7g %.7g\n" % tuple(picture_under(whole)))
    bpy.ops.import_scene.gltf(filepath=lights, export_import_convert_lighting_mode="RAW")
    out.write("%.7g %.7g %.7g\n" % tuple(picture_under(remainder)))

# The module bpy can crash while Python ends, when all is written.
sys.stdout.flush()
os._exit(0)
