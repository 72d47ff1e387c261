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

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from blender_scene import empty_scene, new_camera, render, show, world_texture

numbers, whole, remainder, lights = sys.argv[sys.argv.index("--") + 1:][:4]
SIZE = 24

scene = empty_scene(SIZE, samples=512)
scene.cycles.sample_clamp_direct = scene.cycles.sample_clamp_indirect = 0
scene.render.film_transparent = True
scene.render.image_settings.color_mode = "RGBA"
texture = world_texture(scene)

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

camera = new_camera(scene)
camera.data.type, camera.data.ortho_scale = "ORTHO", 2
# At +Z of glTF, which is -Y here.
camera.matrix_world = mathutils.Matrix.Translation((0, -5, 0)) @ mathutils.Matrix.Rotation(math.pi / 2, 4, "X")


def mean_under(image):
    show(texture, image)
    pixels, channels = render(scene, f"{numbers}.exr")
    return tuple(sum(pixels[c::channels]) / (SIZE * SIZE) for c in range(3))


with open(numbers, "w") as out:
    out.write("%.7g %.7g %.7g\n" % mean_under(whole))
    bpy.ops.import_scene.gltf(filepath=lights, export_import_convert_lighting_mode="RAW")
    out.write("%.7g %.7g %.7g\n" % mean_under(remainder))

# The module bpy can crash while Python ends, when all is written.
sys.stdout.flush()
os._exit(0)
