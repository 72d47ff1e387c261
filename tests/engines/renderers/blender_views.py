"""Inside Blender: six views of a world's Environment Texture along glTF's axes, as numbers.

    blender -b --python blender_views.py -- IMAGE NUMBERS SIZE [PICTURES]
"""

import math
import os
import sys

import bpy
import mathutils

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from blender_scene import empty_scene, new_camera, render, show, world_texture

image, numbers, size, pictures = sys.argv[sys.argv.index("--") + 1:][:4]
size = int(size)
VIEWS = [((1, 0, 0), (0, 0, 1), (0, 1, 0)), ((-1, 0, 0), (0, 0, -1), (0, 1, 0)), ((0, 1, 0), (0, 0, 1), (-1, 0, 0)),
         ((0, -1, 0), (0, 0, 1), (1, 0, 0)), ((0, 0, 1), (-1, 0, 0), (0, 1, 0)), ((0, 0, -1), (1, 0, 0), (0, 1, 0))]


def to_blender(v):
    """glTF's world (+Y up) to Blender's (+Z up)."""
    return mathutils.Vector((v[0], -v[2], v[1]))


scene = empty_scene(size, samples=64)
scene.cycles.pixel_filter_type = "BOX"
show(world_texture(scene), image)
camera = new_camera(scene)
camera.data.angle = math.pi / 2

with open(numbers, "w") as out:
    for view, axes in enumerate(VIEWS):
        forward, right, up = map(to_blender, axes)
        rotation = mathutils.Matrix((right, up, -forward)).transposed()
        camera.matrix_world = rotation.to_4x4()
        pixels, channels = render(scene, f"{numbers}-{view}.exr")
        for y in reversed(range(size)):  # Blender's first row is at the bottom
            for x in range(size):
                at = (y * size + x) * channels
                out.write("%.6g %.6g %.6g\n" % tuple(pixels[at:at + 3]))

if pictures:
    bpy.ops.mesh.primitive_uv_sphere_add(segments=256, ring_count=128)
    bpy.ops.object.shade_smooth()
    material = bpy.data.materials.new("mirror")
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Metallic"].default_value, shader.inputs["Roughness"].default_value = 1, 0
    shader.inputs["Base Color"].default_value = (1, 1, 1, 1)
    bpy.context.object.data.materials.append(material)
    camera.data.type, camera.data.ortho_scale = "ORTHO", 2
    camera.matrix_world = mathutils.Matrix.Translation(to_blender((0, 0, 5))) @ mathutils.Matrix.Rotation(math.pi / 2, 4, "X")
    scene.render.resolution_x = scene.render.resolution_y = 256
    scene.render.image_settings.file_format = "PNG"
    scene.view_settings.view_transform = "Standard"
    scene.render.filepath = pictures + "/blender-ball.png"
    bpy.ops.render.render(write_still=True)
