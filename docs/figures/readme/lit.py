#!/usr/bin/python3
"""Draws the README's first picture: a model under a photograph, path traced, and as a real-time engine draws it from the baked maps.

    lit.py MODEL.gltf ENVIRONMENT.hdr    the committed one is the Khronos "Flight Helmet" (CC0) under Poly Haven's "Spruit Sunrise" (CC0), 1024 x 512
"""

import pathlib
import subprocess
import sys
import tempfile

from PIL import Image

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from pictures import INK, PROGRAM, Sheet  # noqa: E402

WIDTH, HEIGHT, GAP, CAPTION = 420, 480, 8, 30
VIEW = ["--width", 2 * WIDTH, "--height", 2 * HEIGHT, "--camera-position", "0.66,0.50,1.26", "--camera-target", "0,0.325,0", "--fov-deg", 33,
        "--rotate-y-deg", 136, "--background", "blurred", "--background-roughness", 0.15, "--tonemap", "agx-punchy", "--ev", 1.2, "--quiet"]


def drawn(folder, model, environment, *options):
    file = pathlib.Path(folder, "picture.png")
    subprocess.run([str(word) for word in (PROGRAM, "render", model, "--env", environment, "-o", file, *VIEW, *options)], check=True)
    return Image.open(file).convert("RGB").resize((WIDTH * Sheet.SCALE, HEIGHT * Sheet.SCALE), Image.Resampling.LANCZOS)


def main(model, environment):
    sheet = Sheet(2 * WIDTH + GAP, HEIGHT + CAPTION)
    with tempfile.TemporaryDirectory() as folder:
        pictures = (("the truth, by path tracing", ["--spp", 128]), ("as a real-time engine draws it from the baked maps", ["--shading", "split-sum", "--spp", 32]))
        for column, (caption, options) in enumerate(pictures):
            left = column * (WIDTH + GAP)
            sheet.image.paste(drawn(folder, model, environment, *options), (left * Sheet.SCALE, 0))
            sheet.text(left + WIDTH / 2, HEIGHT + CAPTION / 2, caption, 14, INK, "mm")
    sheet.save_jpeg("readme/lit.jpg")


if __name__ == "__main__":
    main(*sys.argv[1:3])
