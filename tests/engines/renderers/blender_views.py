"""Inside Blender: six views of a world's Environment Texture along glTF's axes, as numbers.

    blender -b --python blender_views.py -- IMAGE NUMBERS SIZE [PICTURES]
"""

import math
import sys

import bpy
import mathutils

image, numbers, size, pictures = sys.argv[sys.argv.index("--") + 1:][:4]
size = int(size)
VIEWS = [((1, 0, 0), (0, 0, 1), (0, 1, 0)), ((-1, 0, 0), (0, 0, -1), (0, 1, 0)), ((0, 1, 0), (0, 0, 1), (-1, 0, 0)),
         ((0, -1, 0), (0, 0, 1), (1, 0, 0)), ((0, 0, 1), (-1, 0, 0), (0, 1, 0)), ((0, 0, -1), (1, 0, 0), (0, 1, 0))]


def to_blender(v):
    """glTF's world (+Y up) to Blender's (+Z up)."""
    return mathutils.Vector((v[0], -v[2], v[1]))


scene = bpy.context.scene
for thing in list(bpy.data.objects):
    bpy.data.objects.remove(thing)
scene.render.engine = "CYCLES"
scene.cycles.device = "CPU"
scene.cycles.samples = 64
scene.cycles.pixel_filter_type = "BOX"
scene.cycles.use_denoising = False
scene.cycles.use_adaptive_sampling = False
scene.render.resolution_x = scene.render.resolution_y = size
scene.render.resolution_percentage = 100
scene.render.threads_mode, scene.render.threads = "FIXED", 2
scene.render.image_settings.file_format = "OPEN_EXR"
scene.render.image_settings.color_depth = "32"

world = scene.world = bpy.data.worlds.new("world")
world.use_nodes = True
nodes, links = world.node_tree.nodes, world.node_tree.links
texture = nodes.new("ShaderNodeTexEnvironment")
texture.image = bpy.data.images.load(image)
texture.image.colorspace_settings.name = "Linear" if bpy.app.version < (4, 0) else "Linear Rec.709"
links.new(texture.outputs["Color"], nodes["Background"].inputs["Color"])

camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
scene.collection.objects.link(camera)
scene.camera = camera
camera.data.angle = math.pi / 2


def render(path):
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)
    picture = bpy.data.images.load(path, check_existing=False)
    return list(picture.pixels), picture.channels


with open(numbers, "w") as out:
    for view, axes in enumerate(VIEWS):
        forward, right, up = map(to_blender, axes)
        rotation = mathutils.Matrix((right, up, -forward)).transposed()
        camera.matrix_world = rotation.to_4x4()
        pixels, channels = render(f"{numbers}-{view}.exr")
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
