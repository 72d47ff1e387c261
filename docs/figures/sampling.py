#!/usr/bin/python3
"""Draws the figures of docs/math/sampling.md and importance.md, all from what `domelight sample` writes.

    sampling.py LEBOMBO NOON_GRASS     Poly Haven's environments of these names (CC0), 1024 x 512
"""

import pathlib
import subprocess
import sys
import tempfile

from PIL import Image

from pictures import HERE, PROGRAM


def made(environment, *options, out):
    """The picture that `domelight sample ENVIRONMENT OPTIONS OUT FILE` writes."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "picture.png")
        subprocess.run([PROGRAM, "sample", environment, *options, "--quiet", out, file], check=True, stdout=subprocess.DEVNULL)
        return Image.open(file).convert("RGB")


def save(name, rows, width):
    """A table of pictures, as wide as asked for."""
    w, h = max(p.width for row in rows for p in row), max(p.height for row in rows for p in row)
    sheet = Image.new("RGB", (w * max(map(len, rows)), h * len(rows)), rows[0][0].getpixel((0, 0)))
    for j, row in enumerate(rows):
        for i, picture in enumerate(row):
            sheet.paste(picture, (i * w, j * h))
    sheet = sheet.resize((width, round(sheet.height * width / sheet.width)), Image.Resampling.LANCZOS)
    sheet.quantize(256, kmeans=4, dither=Image.Dither.FLOYDSTEINBERG).save(HERE / name, optimize=True)


lebombo, noon = sys.argv[1:3]
small = ["--picture-width", "640"]
save("sampling_explain.png", [[made(lebombo, "--explain", "0.7,0.6", "--method", "binary", out="--explain-picture")]], 900)
save("sampling_methods.png",
     [[made(lebombo, "-n", "1024", "--method", m, *small, out="--picture") for m in row]
      for row in [["guided", "hierarchical"], ["bilinear", "alias"]]], 1000)
save("sampling_weights.png", [[made(lebombo, "-n", "2048", "--method", "guided", "--weight", w, *small, out=o) for o in ["--picture", "--heat"]]
                              for w in ["radiant-power", "grayscale"]], 1000)
save("importance_compensation.png", [[made(lebombo, *c, "-n", "2048", *small, out=o) for o in ["--picture", "--heat"]] for c in [[], ["--compensate"]]], 1000)
save("importance_convergence.png",
     [[made(noon, "--estimate", "-n", "4096", out="--plot"), made(lebombo, "--estimate", "-n", "4096", "--brdf", "ggx", "--view", "1,1,0", out="--plot")],
      [made(noon, "--estimate", "-n", "4096", "--sequence", "sobol", out="--plot"),
       made(lebombo, "--estimate", "-n", "4096", "--brdf", "ggx", "--view", "1,1,0", "--sequence", "sobol", out="--plot")]], 1400)
