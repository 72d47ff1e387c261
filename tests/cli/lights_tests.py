"""Lights that are taken out of an environment."""

import hashlib
import json
import math
from pathlib import Path

from program import TINY, files_of, make_square, run


def lights_of(folder):
    return json.loads((Path(folder) / "lights.json").read_text())


def near(a, b, tolerance):
    return all(abs(x - y) <= tolerance for x, y in zip(a, b))


def test_lights_writes_lights_and_remainder_that_add_up(folder):
    run("sky", "-o", "sky.exr", "--exr", "float", "--height", "256", "--sun-elevation-deg", "30", "--sun-azimuth-deg", "30", folder=folder)
    said = json.loads(run("lights", "sky.exr", "-o", "out", "--json", folder=folder).stdout)
    found = lights_of(folder / "out")
    assert said == found
    files = files_of(folder / "out")
    assert set(files) == {"lights.json", "lights.gltf", "remainder.exr", "preview.png"}
    assert found["remainder"]["sha256"] == files["remainder.exr"] and found["source"]["sha256"] == hashlib.sha256((folder / "sky.exr").read_bytes()).hexdigest()
    sun, = found["lights"]
    assert abs(sun["azimuth_deg"] - 30) < 0.15 and abs(sun["elevation_deg"] - 30) < 0.15 and sun["share"] > 0.4  # texels of 0.7 degrees
    # info reads the remainder independently: the mean radiance of its bilinear reconstruction, times 4 pi, is the power.
    before = json.loads(run("info", "sky.exr", "--json", folder=folder).stdout)["mean_radiance"]
    after = json.loads(run("info", "out/remainder.exr", "--json", folder=folder).stdout)
    assert all(light["share"] < 0.1 for light in after["lights"]), "what is left is the glow around"
    for c in range(3):
        power = 4 * 3.14159265358979 * before[c]
        assert abs(4 * 3.14159265358979 * after["mean_radiance"][c] + sun["irradiance"][c] - power) < 1e-3 * power
        parts = found["power"]["lights"][c] + found["power"]["remainder"][c]
        assert abs(parts - found["power"]["original"][c]) <= 1e-5 * found["power"]["original"][c]
    again = run("lights", "out/remainder.exr", "-o", "again", folder=folder)
    assert "no light stands out" in again.stdout


def test_lights_gltf_points_from_the_sun(folder):
    run("sky", "-o", "sky.exr", "--exr", "float", "--height", "128", "--sun-azimuth-deg", "-70", folder=folder)
    run("lights", "sky.exr", "-o", "out", "--lux-per-unit", "179", folder=folder)
    sun, = lights_of(folder / "out")["lights"]
    gltf = json.loads((folder / "out/lights.gltf").read_text())
    light, = gltf["extensions"]["KHR_lights_punctual"]["lights"]
    node, = gltf["nodes"]
    x, y, z, w = node["rotation"]
    travels = [-2 * (x * z + w * y), -2 * (y * z - w * x), -(1 - 2 * (x * x + y * y))]  # the rotation's third column, negated
    assert near(travels, [-c for c in sun["direction"]], 1e-6)
    assert light["type"] == "directional" and max(light["color"]) == 1
    assert all(abs(light["intensity"] * light["color"][c] - 179 * sun["irradiance"][c]) < 1e-4 * light["intensity"] for c in range(3))
    assert gltf["asset"]["extras"]["lux_per_unit"] == 179


def test_lights_directions_are_the_worlds(folder):
    run("sky", "-o", "sky.exr", "--exr", "float", "--height", "128", "--sun-azimuth-deg", "30", "--sun-elevation-deg", "40", folder=folder)
    plain, = json.loads(run("lights", "sky.exr", "-o", "plain", "--no-preview", "--json", folder=folder).stdout)["lights"]
    turned, = json.loads(run("lights", "sky.exr", "-o", "turned", "--no-preview", "--rotate-y-deg", "90", "--json", folder=folder).stdout)["lights"]
    x, y, z = plain["direction"]
    assert near(turned["direction"], [-z, y, x], 1e-9)
    usd, = json.loads(run("lights", "sky.exr", "-o", "usd", "--no-preview", "--latlong", "usd", "--json", folder=folder).stdout)["lights"]
    assert near(usd["direction"], [-z, y, x], 1e-9)  # centre +Z, right -X: what the default shows at +X and +Z
    brighter, = json.loads(run("lights", "sky.exr", "-o", "brighter", "--no-preview", "--exposure", "1", "--json", folder=folder).stdout)["lights"]
    assert near([2 * c for c in plain["irradiance"]], brighter["irradiance"], 1e-6 * max(brighter["irradiance"]))
    # The remainder has the form of the source, and no texel away from the light changes.
    files = [files_of(folder / name)["remainder.exr"] for name in ("plain", "turned", "usd")]
    assert files[0] == files[1] == files[2]


def test_lights_takes_a_cube_and_is_the_same_on_any_number_of_threads(folder):
    run("bake", "studio.hdr", "-o", "cube", "--size", "64", "--levels", "1", "--irradiance-size", "4", "--brdf-size", "16", "--no-preview",
        "--encoding", "rgba32f", folder=folder)
    found = json.loads(run("lights", "cube/specular.ktx2", "-o", "out", "--threads", "1", "--json", folder=folder).stdout)
    assert (found["remainder"]["width"], found["remainder"]["height"]) == (256, 128) and found["source"]["projection"] == "cube"
    run("lights", "cube/specular.ktx2", "-o", "more", "--threads", "5", folder=folder)
    assert files_of(folder / "out") == files_of(folder / "more")


def matte_light(scene, *words, folder):
    """The radiance of a matte square about the origin, seen from above, without light reflected by other surfaces."""
    view = ["--width", "32", "--height", "16", "--spp", "256", "--bounces", "0", "--camera-position", "0,1,0.001", "--fov-deg", "1"]
    run("render", scene, "-o", "matte.exr", *view, *words, "--quiet", folder=folder)
    return json.loads(run("info", "matte.exr", "--projection", "latlong", "--json", folder=folder).stdout)["mean_radiance"]


def same_light(a, b, tolerance=0.01):
    """1 %: what docs/lights.md states of lights and remainder, and far above the noise of 131072 samples."""
    assert all(abs(x - y) <= tolerance * max(x, y) for x, y in zip(a, b)), (a, b)


def test_render_of_remainder_and_lights_is_that_of_the_environment(folder):
    # Matte squares that look up, and up at a slant: their light is 0.8 E / pi.
    for name, tilt in [("up", 0), ("slanted", math.radians(50))]:
        (folder / f"{name}.gltf").write_text(json.dumps(make_square(tilt)))
    run("sky", "-o", "sky.exr", "--exr", "float", "--height", "256", "--sun-elevation-deg", "40", "--sun-azimuth-deg", "30", folder=folder)
    run("lights", "sky.exr", "-o", "out", "--no-preview", folder=folder)

    def light_of(scene, *words):
        return matte_light(scene, *words, folder=folder)

    same, lights = same_light, ["--lights", "out/lights.gltf"]
    for scene in ["up.gltf", "slanted.gltf"]:
        whole = light_of(scene, "--env", "sky.exr")
        assert light_of(scene, "--env", "out/remainder.exr")[0] < 0.8 * whole[0], "without the lights much is missing"
        same(whole, light_of(scene, "--env", "out/remainder.exr", *lights))
    # --rotate-y-deg and --exposure apply to the lights and to the remainder alike.
    words = ["--rotate-y-deg", "80", "--exposure", "1"]
    turned = light_of("slanted.gltf", "--env", "sky.exr", *words)
    assert abs(turned[0] / whole[0] - 2) > 0.2
    same(turned, light_of("slanted.gltf", "--env", "out/remainder.exr", *lights, *words))
    # Lights taken out of the turned environment, in another unit, and out of a cube, whose remainder is written turned.
    run("lights", "sky.exr", "-o", "out", "--no-preview", "--rotate-y-deg", "80", "--lux-per-unit", "179", folder=folder)
    same(whole, light_of("slanted.gltf", "--env", "out/remainder.exr", *lights))
    same(turned, light_of("slanted.gltf", "--env", "out/remainder.exr", *lights, *words))
    run("bake", "sky.exr", "-o", "cube", "--size", "128", "--levels", "1", "--irradiance-size", "4", "--brdf-size", "16", "--no-preview", "--encoding", "rgba32f",
        folder=folder)
    run("lights", "cube/specular.ktx2", "-o", "out", "--no-preview", "--rotate-y-deg", "80", folder=folder)
    same(turned, light_of("slanted.gltf", "--env", "out/remainder.exr", *lights, "--exposure", "1"))
    # Lights of the user's own scene keep their unit.
    scene, taken = make_square(math.radians(50)), json.loads((folder / "out/lights.gltf").read_text())
    scene["extensions"], scene["extensionsUsed"] = taken["extensions"], taken["extensionsUsed"]
    scene["nodes"] += taken["nodes"]
    scene["scenes"] = [{"nodes": list(range(len(scene["nodes"])))}]
    (folder / "lit.gltf").write_text(json.dumps(scene))
    same(light_of("slanted.gltf", "--env", "out/remainder.exr", *lights), light_of("lit.gltf", "--env", "out/remainder.exr"))
    # The shadings of engines draw the lights too; a file that holds no lights is an error.
    same(light_of("slanted.gltf", "--env", "out/remainder.exr", *lights), light_of("slanted.gltf", "--env", "out/remainder.exr", *lights, "--shading", "split-sum"))
    assert "is not a glTF file" in run("render", "up.gltf", "--lights", "out/lights.json", "-o", "no.exr", folder=folder, code=1).stderr
    assert "no light" in run("render", "up.gltf", "--lights", "up.gltf", "-o", "p.exr", *TINY, folder=folder).stderr


def test_lights_of_an_openexr_latlong_are_read_where_they_were(folder):
    run("sky", "-o", "sky.exr", "--exr", "float", "--height", "64", "--sun-elevation-deg", "40", "--sun-azimuth-deg", "30", folder=folder)
    run("convert", "sky.exr", "-o", "stated.exr", "--to", "latlong/openexr", folder=folder)
    said = run("lights", "stated.exr", "-o", "out", "--no-preview", folder=folder)
    assert "warning" not in said.stderr
    sun, = lights_of(folder / "out")["lights"]
    assert abs(sun["azimuth_deg"] - 30) < 1 and abs(sun["elevation_deg"] - 40) < 1
    # The remainder states OpenEXR's convention as well: the glow that is left is where the sun was.
    (folder / "slanted.gltf").write_text(json.dumps(make_square(math.radians(50))))
    same_light(matte_light("slanted.gltf", "--env", "stated.exr", folder=folder),
               matte_light("slanted.gltf", "--env", "out/remainder.exr", "--lights", "out/lights.gltf", folder=folder))
    assert matte_light("slanted.gltf", "--env", "out/remainder.exr", folder=folder) != matte_light(
        "slanted.gltf", "--env", "out/remainder.exr", "--latlong", "default", folder=folder)
    said = run("lights", "stated.exr", "-o", "out", "--no-preview", "--format", "hdr", folder=folder)
    assert "read it with --latlong openexr" in said.stderr


def test_lights_without_a_light(folder):
    run("sky", "-o", "grey.hdr", "--no-sun-disc", "--height", "64", folder=folder)
    result = run("lights", "grey.hdr", "-o", "out", folder=folder)
    assert "no light stands out" in result.stdout
    assert lights_of(folder / "out")["lights"] == [] and "nodes" not in json.loads((folder / "out/lights.gltf").read_text())
    run("sky", "-o", "coarse.hdr", "--height", "16", folder=folder)
    assert "too coarse" in run("lights", "coarse.hdr", "-o", "coarse", folder=folder).stderr
