"""Inside Blender: an empty scene for Cycles under an environment. What blender_views.py and blender_lights.py have in common."""

import bpy


def empty_scene(size, samples):
    """The scene without any object: square pictures of `size` pixels in 32-bit OpenEXR, `samples` of each pixel, without denoising."""
    scene = bpy.context.scene
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = samples
    scene.cycles.use_denoising = False
    scene.cycles.use_adaptive_sampling = False
    scene.render.resolution_x = scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    scene.render.threads_mode, scene.render.threads = "FIXED", 2
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    return scene


def world_texture(scene):
    """The Environment Texture of a new world."""
    world = scene.world = bpy.data.worlds.new("world")
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    texture = nodes.new("ShaderNodeTexEnvironment")
    links.new(texture.outputs["Color"], nodes["Background"].inputs["Color"])
    return texture


def show(texture, image):
    """Loads the picture of an environment into the texture, as linear Rec. 709."""
    texture.image = bpy.data.images.load(image)
    texture.image.colorspace_settings.name = "Linear" if bpy.app.version < (4, 0) else "Linear Rec.709"


def new_camera(scene):
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(camera)
    scene.camera = camera
    return camera


def render(scene, file):
    """The numbers of the rendered picture, from the bottom row up, and how many each pixel has."""
    scene.render.filepath = file
    bpy.ops.render.render(write_still=True)
    picture = bpy.data.images.load(file, check_existing=False)
    pixels, channels = list(picture.pixels), picture.channels
    bpy.data.images.remove(picture)
    return pixels, channels
