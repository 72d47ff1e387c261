#!/usr/bin/env python3
"""Draws docs/figures/render_*.png: two figures of `domelight render --study`, and the built-in spheres with their shadow on a blurred sky."""

import os
import pathlib
import shutil
import subprocess
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
PROGRAM = os.environ.get("DOMELIGHT_PROGRAM", str(HERE.parents[1] / "build/release/cli/domelight"))

with tempfile.TemporaryDirectory() as folder:

    def domelight(*words):
        subprocess.run([PROGRAM, *map(str, words), "--quiet"], cwd=folder, check=True)

    domelight("render", "spheres", "-o", HERE / "render_shadow.png", "--width", 640, "--height", 260, "--spp", 128, "--background", "blurred",
              "--shadow-catcher", "--camera-position", "4,2.2,10", "--camera-target", "0,0.25,0", "--fov-deg", 22, "--rotate-y-deg", 150)
    domelight("render", "--study", "-o", "study", "--width", 56)
    for name in ["strategies", "split-sum"]:
        shutil.copy(pathlib.Path(folder) / f"study/{name}.png", HERE / f"render_{name}.png")
