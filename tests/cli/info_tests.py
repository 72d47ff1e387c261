"""What info tells of files, and what the sky command writes."""

import base64
import json
import os
import re
import struct
from pathlib import Path

from folder_tests import Skipped
from program import SMALL, TINY, make_exr, manifest_of, run


def test_info_of_an_environment(folder):
    run("sky", "--axes", "-o", "axes.exr", "--exr", "float", "--height", "64", folder=folder)
    run("sky", "-o", "sun.exr", "--exr", "float", "--height", "256", "--sun-elevation-deg", "40", "--sun-azimuth-deg", "-70", folder=folder)
    info = json.loads(run("info", "sun.exr", "--json", folder=folder).stdout)
    light = info["lights"][0]
    assert abs(light["elevation_deg"] - 40) < 0.5 and abs(light["azimuth_deg"] + 70) < 0.5 and 0.2 < light["share"] < 1, light
    assert info["range"][1] > 1e5 and info["irradiance"]["+Y"][1] > info["irradiance"]["-Y"][1] > 0
    # Turning the light turns the sun from +X towards +Z; E from above stays.
    turned = json.loads(run("info", "sun.exr", "--rotate-y-deg", "50", "--json", folder=folder).stdout)
    assert abs(turned["lights"][0]["azimuth_deg"] + 20) < 0.5
    assert abs(turned["irradiance"]["+Y"][1] / info["irradiance"]["+Y"][1] - 1) < 1e-3
    brighter = json.loads(run("info", "sun.exr", "--exposure", "1", "--json", folder=folder).stdout)
    assert abs(brighter["mean_radiance"][0] / info["mean_radiance"][0] - 2) < 1e-6
    assert "bad texels       none" in run("info", "axes.exr", folder=folder).stdout


def test_info_of_a_bake_sees_changes(folder):
    run("bake", "studio.hdr", "-o", "out", *SMALL, folder=folder)
    assert "unchanged" in run("info", "out", folder=folder).stdout
    document = json.loads(run("info", "out/manifest.json", "--json", folder=folder).stdout)
    assert document["kind"] == "bake" and all(f["state"] == "unchanged" for f in document["files"])
    with open(folder / "out/brdf.ktx2", "ab") as file:
        file.write(b"x")
    (folder / "out/sh.json").unlink()
    states = {f["file"]: f["state"] for f in json.loads(run("info", "out", "--json", folder=folder, code=1).stdout)["files"]}
    assert states["brdf.ktx2"] == "changed" and states["sh.json"] == "missing"


def test_info_of_other_tools_textures(folder):
    data = os.environ.get("DOMELIGHT_DATA")
    if not data:
        raise Skipped("DOMELIGHT_DATA is not set")
    texture = Path(data) / "reference/symmetrical_garden/symmetrical_garden_ibl.ktx"
    info = json.loads(run("info", texture, "--json", folder=folder).stdout)
    assert info["faces"] == 6 and info["levels"] == 5 and info["width"] == 256 and "sh" in info["metadata"]


def test_sky_formats_and_axes(folder):
    for name in ["a.hdr", "a.exr", "a.png"]:
        run("sky", "-o", name, "--height", "16", folder=folder)
        assert (folder / name).stat().st_size > 100
    run("sky", "--axes", "-o", "axes.png", "--height", "64", folder=folder)
    assert json.loads(run("info", "axes.png", "--json", folder=folder).stdout)["width"] == 128


def test_names_from_files_do_not_write_on_the_terminal(folder):
    """Escape sequences, line ends and marks of direction in a file reach neither stdout nor stderr raw; JSON holds them all the same."""
    evil = "\x1b]0;owned\x07\x1b[31mred\r\nerror: \x9b\u202egood é"
    shown = "\\x1b]0;owned\\x07\\x1b[31mred\\r\\nerror: \\u009b\\u202egood é"
    raw = re.compile("[\x00-\x09\x0b-\x1f\x7f-\x9f\u202e]")

    def said(*words, code=0):
        result = run(*words, folder=folder, code=code)
        assert not raw.search(result.stdout + result.stderr), ascii(result.stdout + result.stderr)
        return result

    triangle = base64.b64encode(struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)).decode()
    scene = {"asset": {"version": "2.0"}, "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64," + triangle}],
             "bufferViews": [{"buffer": 0, "byteLength": 36}], "extensionsUsed": [evil],
             "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
             "meshes": [{"name": evil, "primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0, "name": evil}, {"camera": 0, "translation": [0.3, 0.3, 2]}],
             "cameras": [{"type": "perspective", "name": evil, "perspective": {"yfov": 1, "znear": 0.1}}]}
    (folder / "a.gltf").write_text(json.dumps(scene))
    small = ["--width", "8", "--height", "8", "--spp", "1"]
    assert f"warning: a.gltf: {shown} is not supported" in said("render", "a.gltf", "-o", "a.exr", *small).stderr
    assert shown in said("render", "a.gltf", "-o", "a.png", "--camera", "none", *small, code=2).stderr
    warned = json.loads(said("render", "a.gltf", "-o", "a.png", "--json", "--quiet", *small).stdout)["warnings"]
    assert any(shown in w for w in warned), warned
    run("render", "a.gltf", "-o", "b.exr", "--seed", "2", *small, folder=folder)
    names = [o["name"] for o in json.loads(said("compare", "a.exr", "b.exr", "--json").stdout)["objects"]]
    assert shown in names, names
    scene["asset"]["version"] = evil
    (folder / "a.gltf").write_text(json.dumps(scene))
    assert 'asset.version: is "\\x1b]0;' in said("render", "a.gltf", "-o", "a.png", *small, code=1).stderr

    run("bake", "-o", "out", "--size", "16", "--levels", "2", folder=folder)
    manifest = manifest_of(folder / "out")
    manifest["source"]["file"] = evil
    (folder / "out/manifest.json").write_text(json.dumps(manifest))
    assert f" from {shown} (" in said("info", "out").stdout
    assert json.loads(said("info", "out", "--json").stdout)["manifest"]["source"]["file"] == evil
    assert shown in said("info", evil.replace("/", ""), code=1).stderr
    assert 'unknown command \\x1b[2J' in said("\x1b[2J", code=2).stderr


def test_info_tells_of_any_picture(folder):
    run("render", "ball", "-o", "r.exr", *TINY, folder=folder)
    said = json.loads(run("info", "r.exr", "--json", folder=folder).stdout)
    assert (said["kind"], said["width"], said["height"], said["format"]) == ("picture", 16, 12, "OpenEXR"), said
    assert {"", "direct", "albedo"} <= set(said["layers"]) and 0 < said["opacity"]["coverage"] < 1, said
    assert said["range"][0] >= 0 and said["bad"] == {"not_a_number": 0, "infinite": 0, "negative": 0}
    text = run("info", "r.exr", folder=folder).stdout
    assert "16 x 12, a picture" in text and "layers" in text and "covered" in text, text
    layer = json.loads(run("info", "r.exr", "--layer", "albedo", "--json", folder=folder).stdout)
    assert layer["range"][1] <= 1
    run("render", "ball", "-o", "cube.exr", "--camera", "cube", "--width", "4", "--spp", "1", folder=folder)
    assert "--projection cube describes its light" in run("info", "cube.exr", folder=folder).stdout
    run("convert", "studio.hdr", "-o", "cube.ktx2", "--to", "cube", "--size", "8", folder=folder)
    assert "--projection cube describes its light" in run("info", "cube.ktx2", folder=folder).stdout
    assert "irradiance +X" in run("info", "cube.ktx2", "--projection", "cube", folder=folder).stdout
    (folder / "odd.exr").write_bytes(make_exr(7, 5, {3: float("nan")}))
    odd = run("info", "odd.exr", folder=folder).stdout
    assert "7 x 5, a picture" in odd and "1 not a number" in odd, odd
    assert "not twice as wide as high" in run("info", "odd.exr", "--projection", "latlong", folder=folder).stderr
    environment = json.loads(run("info", "studio.hdr", "--json", folder=folder).stdout)
    picture = json.loads(run("info", "studio.hdr", "--picture", "--json", folder=folder).stdout)
    assert environment.get("kind") != "picture" and picture["kind"] == "picture"


def test_info_describes_a_scene(folder):
    text = run("info", "spheres", folder=folder).stdout
    assert "a scene of" in text and "box " in text and "cameras " in text, text
    (folder / "square.obj").write_text("v 0 0 0\nv 2 0 0\nv 2 3 0\nf 1 2 3\n")
    said = json.loads(run("info", "square.obj", "--json", folder=folder).stdout)
    assert (said["kind"], said["triangles"], said["objects"], said["lights"]) == ("scene", 1, 1, []), said
    assert said["box"] == {"low": [0, 0, 0], "high": [2, 3, 0]}, said["box"]
    (folder / "empty.obj").write_text("v 0 0 0\n")
    assert "no triangles" in run("info", "empty.obj", folder=folder, code=1).stderr
    run("bake", "studio.hdr", "-o", "g", "--for", "gltf", "--no-preview", folder=folder)
    light = json.loads(run("info", "g/studio.gltf", "--json", folder=folder).stdout)
    assert light["kind"] == "environment", light
