#!/usr/bin/python3
"""Draws the figures of docs/math/split-sum.md: the lobe at a slant and what stands for it, and a floor under a low sun.

The second one needs the folder of test data that DOMELIGHT_DATA names (a sunrise of Debian's blender-data, CC0), and the program (pictures.py).
"""

import base64
import json
import os
import pathlib
import struct
import subprocess
import tempfile

import numpy as np
from PIL import Image

import stretched_fit
from pictures import FAINT, INK, PROGRAM, Sheet
from prefilter import COLOURS, ggx, outline, true_lobe


def taps(cosine, roughness):
    """Tilt (radians, towards the normal), roughness and share of each lookup, F0 = 1 (where the shares of scale count)."""
    terms = np.array([np.sqrt(cosine) ** i * roughness ** j for i in range(stretched_fit.COSINES) for j in range(stretched_fit.ROUGHNESSES)])
    raw = np.einsum("k,ktc->tc", terms, stretched_fit.read())
    least = np.clip(10 * roughness - 1, 0, 1) / 6
    above = roughness * raw[:, 1] - least
    share = np.exp(raw[:, 2])
    return (np.clip(2 * roughness ** 2 * np.sqrt(1 - cosine ** 2) * raw[:, 0], -1.7, 1.7),
            np.minimum(1, least + .5 * (above + np.sqrt(above ** 2 + (.05 * least) ** 2))), share / share.sum())


def level(roughness, c):
    """The chain's lobe: its two levels next to the roughness, mixed."""
    j = min(int(6 * roughness), 5)
    f = 6 * roughness - j
    normalised = lambda a: ggx(a, c) / np.mean(ggx(a, np.linspace(-1, 1, 200001))) / (4 * np.pi)
    return (1 - f) * normalised(max((j / 6) ** 2, 1e-3)) + f * normalised(((j + 1) / 6) ** 2)


def lobes():
    """Directions about the mirror direction by angle, the plane of incidence upright."""
    sheet = Sheet(980, 392)
    size, reach = 1040, np.radians(50)
    x, y = np.meshgrid(np.linspace(-reach, reach, size), np.linspace(reach, -reach, size))
    angle = np.hypot(x, y)
    ahead, stretch = np.cos(angle), np.sin(angle) / np.maximum(angle, 1e-9)
    for i, (degrees, roughness) in enumerate(((60, .4), (75, .4), (84, .25))):
        theta = np.radians(degrees)
        r, up = np.array([np.sin(theta), 0, np.cos(theta)]), np.array([-np.cos(theta), 0, np.sin(theta)])
        l = ahead[..., None] * r + (stretch * y)[..., None] * up + (stretch * x)[..., None] * np.array([0, 1, 0])
        picture = np.full((size, size, 3), 255, np.uint8)
        picture[l[..., 2] < 0] = (232, 234, 238)
        row = taps(np.cos(theta), roughness)
        mine = sum(share * level(rough, l @ (r * np.cos(tilt) + up * np.sin(tilt))) for tilt, rough, share in zip(*row))
        for lobe, colour in ((level(roughness, l @ r), COLOURS[3]), (mine, COLOURS[2]), (true_lobe(theta, roughness ** 2, l), COLOURS[0])):
            for part, thickness in ((.5, 4), (.1, 2)):
                picture[outline(lobe > part * lobe.max(), thickness)] = colour
        left = 30 + 315 * i
        sheet.picture(left, 40, picture, 290, 290)
        sheet.box(left, 40, 290, 290)
        sheet.text(left + 145, 12, f"v at {degrees}°, roughness {roughness}", 13, bold=True, anchor="ma")
        for tilt, _, share in zip(*row):
            if abs(tilt) < reach:
                sheet.dot(left + 145, 185 - 145 * tilt / reach, 1 + 3 * np.sqrt(share))
    sheet.text(30, 334, "50° to each side of the mirror direction; grey: below the surface. Half and a tenth of each lobe's peak.", 12, FAINT)
    for x, colour, text in ((30, COLOURS[0], "what reaches the eye, f n·l"), (270, COLOURS[3], "split-sum's lobe"), (440, COLOURS[2], "stretched: nine lobes"),
                            (640, INK, "where they are looked up, larger for more weight")):
        if colour == INK:
            sheet.dot(x + 9, 372, 3)
        else:
            sheet.line([(x, 372), (x + 18, 372)], colour, 2.5)
        sheet.text(x + 23, 372, text, 12, INK, "lm")
    sheet.save("split_sum_lobes.png")


def floor(file, roughness):
    """A glTF model: strips of polished metal towards -Z, one for each roughness."""
    data, views, accessors, meshes, materials = b"", [], [], [], []

    def add(raw, component, count, kind, **more):
        nonlocal data
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(raw)})
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "count": count, "type": kind, **more})
        data += raw
        return len(accessors) - 1

    for i, r in enumerate(roughness):
        x0, x1 = -6 + 12 * i / len(roughness), -6 + 12 * (i + 1) / len(roughness) - .05
        corners = [(x0, 0, 3), (x1, 0, 3), (x1, 0, -40), (x0, 0, -40)]
        position = add(struct.pack("<12f", *sum(corners, ())), 5126, 4, "VEC3", min=[x0, 0, -40], max=[x1, 0, 3])
        normal = add(struct.pack("<12f", *(0, 1, 0) * 4), 5126, 4, "VEC3")
        indices = add(struct.pack("<6H", 0, 1, 2, 0, 2, 3), 5123, 6, "SCALAR")
        materials.append({"pbrMetallicRoughness": {"metallicFactor": 1, "roughnessFactor": r}})
        meshes.append({"primitives": [{"attributes": {"POSITION": position, "NORMAL": normal}, "indices": indices, "material": i}]})
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    file.write_text(json.dumps({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(meshes)))}],
                                "nodes": [{"mesh": i} for i in range(len(meshes))], "meshes": meshes, "materials": materials, "bufferViews": views,
                                "accessors": accessors, "buffers": [{"byteLength": len(data), "uri": uri}]}))


def floors():
    sheet = Sheet(980, 554)
    environment = pathlib.Path(os.environ["DOMELIGHT_DATA"], "env_latlong_blender/blender_sunrise.exr")
    roughness = (.1, .2, .3, .45, .6)
    with tempfile.TemporaryDirectory() as folder:
        floor(pathlib.Path(folder, "floor.gltf"), roughness)
        for column, (shading, title) in enumerate((("split-sum", "split-sum"), ("stretched", "stretched"), ("reference", "the integral"))):
            sheet.text(20 + 316 * column + 154, 8, title, 13, bold=True, anchor="ma")
            for row, (turn, ev) in enumerate(((-126, -3), (126, -1.5))):
                file = pathlib.Path(folder, "floor.png")
                subprocess.run([PROGRAM, "render", pathlib.Path(folder, "floor.gltf"), "--env", environment, "--rotate-y-deg", str(turn), "--shading", shading,
                                "--occlusion", "off", "--spp", "256" if shading == "reference" else "16", "--width", "616", "--height", "480", "--ev", str(ev),
                                "--camera-position", "0,1.6,5", "--camera-target", "0,0.6,-10", "--fov-deg", "40", "--quiet", "-o", file], check=True)
                sheet.picture(20 + 316 * column, 28 + 250 * row, np.asarray(Image.open(file).convert("RGB")), 308, 240)
    sheet.text(490, 532, "polished metal, roughness " + ", ".join(map(str, roughness)) + " from left to right; above towards the sun, below away from it", 12, INK, "ma")
    sheet.save("split_sum_floor.png", colours=0)


if __name__ == "__main__":
    lobes()
    floors()
