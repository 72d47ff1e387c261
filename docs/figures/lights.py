#!/usr/bin/python3
"""Draws docs/figures/lights.png: what `domelight lights` takes out of an environment, and the luminance across the sun before and after.

    lights.py ENVIRONMENT.hdr     the committed one is of Poly Haven's "Spruit Sunrise" (CC0), 1024 x 512
"""

import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from PIL import Image

from pictures import FAINT, INK, PROGRAM, Sheet, read_hdr

BEFORE, AFTER = (222, 126, 30), (50, 80, 200)

with tempfile.TemporaryDirectory() as folder:
    subprocess.run([PROGRAM, "lights", sys.argv[1], "-o", folder, "--quiet"], check=True)
    preview = np.asarray(Image.open(pathlib.Path(folder, "preview.png")).convert("RGB"))
    light = json.loads(pathlib.Path(folder, "lights.json").read_text())["lights"][0]
    before, after = (read_hdr(f) @ [0.2126, 0.7152, 0.0722] for f in (sys.argv[1], pathlib.Path(folder, "remainder.hdr")))

width = 1000
height = round(preview.shape[0] * width / preview.shape[1])
sheet = Sheet(width, height + 260)
sheet.picture(0, 0, preview, width, height)

left, top, across, down, reach = 90, height + 50, 860, 160, 8  # degrees to each side
y, middle = int(light["v"] * before.shape[0]), light["u"] * before.shape[1] - 0.5
low, high = np.log10(after[y].min()), np.log10(before[y].max())
sheet.box(left, top, across, down)
sheet.text(left, top - 24, "luminance along the sun's row", 13, bold=True)
degrees = (np.arange(before.shape[1]) - middle) * 360 / before.shape[1] * np.sin((y + 0.5) / before.shape[0] * np.pi)
seen = np.abs(degrees) <= reach
low = np.floor(np.log10(after[y][seen].min()))
high = np.ceil(high)
for power in range(int(low), int(high) + 1):
    py = top + down * (high - power) / (high - low)
    sheet.line([(left - 4, py), (left, py)], FAINT, 1)
    sheet.text(left - 8, py, f"{10.0 ** power:g}", 11, FAINT, "rm")
for d in range(-reach, reach + 1, 2):
    px = left + across * (d + reach) / (2 * reach)
    sheet.line([(px, top + down), (px, top + down + 4)], FAINT, 1)
    sheet.text(px, top + down + 7, f"{d}°", 11, FAINT, "ma")
for row, colour, thick in ((before[y], BEFORE, 2), (after[y], AFTER, 2)):
    sheet.line([(left + across * (d + reach) / (2 * reach), top + down * (high - np.log10(v)) / (high - low))
                for d, v in zip(degrees[seen], row[seen])], colour, thick)
for i, (name, colour) in enumerate((("environment", BEFORE), ("remainder", AFTER))):
    sheet.line([(left + 620 + 120 * i, top - 16), (left + 640 + 120 * i, top - 16)], colour, 3)
    sheet.text(left + 646 + 120 * i, top - 16, name, 12, INK, "lm")
sheet.save("lights.png", colours=0)
