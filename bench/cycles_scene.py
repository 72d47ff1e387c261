"""Blender's side of bench/cycles.py: renders one of the comparison scenes in Cycles. Run inside Blender:

    blender -b --factory-startup -P cycles_scene.py -- MODEL.glb ENV.exr OUT_%d_%d.exr --material metal:0.3
            --samples 1,4,16,64 --seeds 0 [--bounces N] [--size 96]

Writes OUT for each sample count and seed; prints "CYCLES {json}" with the CPU seconds of each. No clamping, no denoising, no adaptive sampling, no
roulette, box filter. Materials: metal:R is a GGX conductor with F = 1 and alpha = R^2, lambert:A a diffuse one; the object "floor" is lambert:0.5.
"""

import argparse
import json
import math
import resource
import sys

import bpy
import mathutils
import numpy

if not hasattr(numpy, "bool"):
    numpy.bool = bool  # Blender 3.4's glTF reader uses this name, which NumPy 1.24 has removed


def material_of(spec):
    kind, value = spec.split(":")
    material = bpy.data.materials.new(spec)
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    if kind == "metal":
        shader = nodes.new("ShaderNodeBsdfGlossy")
        shader.distribution = "GGX"
        shader.inputs["Color"].default_value = (1, 1, 1, 1)
        shader.inputs["Roughness"].default_value = float(value)
    else:
        shader = nodes.new("ShaderNodeBsdfDiffuse")
        shader.inputs["Color"].default_value = (float(value),) * 3 + (1,)
        shader.inputs["Roughness"].default_value = 0
    output = nodes.new("ShaderNodeOutputMaterial")
    material.node_tree.links.new(shader.outputs[0], output.inputs["Surface"])
    return material


def set_environment(file):
    world = bpy.data.worlds.new("environment")
    bpy.context.scene.world = world
    world.use_nodes = True
    nodes, link = world.node_tree.nodes, world.node_tree.links.new
    nodes.clear()
    output, background = nodes.new("ShaderNodeOutputWorld"), nodes.new("ShaderNodeBackground")
    texture = nodes.new("ShaderNodeTexEnvironment")
    texture.image = bpy.data.images.load(file)
    texture.image.colorspace_settings.name = "Linear"
    texture.interpolation = "Linear"
    link(texture.outputs["Color"], background.inputs["Color"])
    link(background.outputs[0], output.inputs["Surface"])
    # Lat-long in Cycles is the default convention once glTF's up axis has become z.
    world.cycles.sampling_method = "AUTOMATIC"
    world.cycles.max_bounces = 1024


def set_camera(eye, target):
    eye, target, up = mathutils.Vector(eye), mathutils.Vector(target), mathutils.Vector((0, 1, 0))
    z = (eye - target).normalized()
    x = up.cross(z).normalized()
    y = z.cross(x)
    to_z_up = mathutils.Matrix(((1, 0, 0, 0), (0, 0, -1, 0), (0, 1, 0, 0), (0, 0, 0, 1)))
    frame = mathutils.Matrix(((x.x, y.x, z.x, eye.x), (x.y, y.y, z.y, eye.y), (x.z, y.z, z.z, eye.z), (0, 0, 0, 1)))
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit, camera.angle = "VERTICAL", math.radians(35)
    camera.clip_start, camera.clip_end = 1e-3, 1e4
    object_ = bpy.data.objects.new("camera", camera)
    bpy.context.scene.collection.objects.link(object_)
    object_.matrix_world = to_z_up @ frame
    bpy.context.scene.camera = object_


def set_renderer(size, bounces):
    render, cycles = bpy.context.scene.render, bpy.context.scene.cycles
    render.engine, cycles.device = "CYCLES", "CPU"
    render.resolution_x = render.resolution_y = size
    render.resolution_percentage = 100
    render.threads_mode, render.threads = "FIXED", 1
    cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_auto_tile = cycles.use_fast_gi = False
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = bounces
    cycles.min_light_bounces = bounces + 1
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = cycles.light_sampling_threshold = 0
    cycles.pixel_filter_type, cycles.filter_width, cycles.time_limit = "BOX", 1, 0
    cycles.caustics_reflective = True
    render.use_persistent_data, render.use_file_extension, render.dither_intensity = True, False, 0
    render.use_compositing = render.use_sequencer = False
    settings = render.image_settings
    settings.file_format, settings.color_depth, settings.exr_codec, settings.color_mode = "OPEN_EXR", "32", "ZIP", "RGB"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("model")
    parser.add_argument("environment")
    parser.add_argument("out")
    parser.add_argument("--material", required=True)
    parser.add_argument("--samples", required=True)
    parser.add_argument("--seeds", default="0")
    parser.add_argument("--bounces", type=int, default=0)
    parser.add_argument("--size", type=int, default=96)
    words = parser.parse_args(sys.argv[sys.argv.index("--") + 1 :])
    bpy.ops.wm.read_factory_settings(use_empty=True)
    import addon_utils

    for name in ("cycles", "io_scene_gltf2"):
        addon_utils.enable(name)
    bpy.ops.import_scene.gltf(filepath=words.model)
    for thing in list(bpy.context.scene.objects):
        if thing.type in ("CAMERA", "LIGHT"):
            bpy.data.objects.remove(thing)
        elif thing.type == "MESH":
            thing.data.materials.clear()
            thing.data.materials.append(material_of("lambert:0.5" if thing.name == "floor" else words.material))
    set_environment(words.environment)
    set_camera((0, 0.8, 4.2), (0, 0, 0))
    set_renderer(words.size, words.bounces)
    for samples in map(int, words.samples.split(",")):
        for seed in map(int, words.seeds.split(",")):
            scene = bpy.context.scene
            scene.cycles.samples, scene.cycles.seed, scene.render.filepath = samples, seed, words.out % (samples, seed)
            before = sum(resource.getrusage(resource.RUSAGE_SELF)[:2])
            bpy.ops.render.render(write_still=True)
            cpu = sum(resource.getrusage(resource.RUSAGE_SELF)[:2]) - before
            print("CYCLES", json.dumps({"samples": samples, "seed": seed, "cpu_seconds": cpu}), flush=True)


main()
