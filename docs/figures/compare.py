#!/usr/bin/env python3
"""Draws docs/figures/compare.png: the sheet of `domelight compare` for split-sum shading against the path-traced truth, on the built-in scene and sky."""

import os
import pathlib
import subprocess
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
PROGRAM = os.environ.get("DOMELIGHT_PROGRAM", str(HERE.parents[1] / "build/release/cli/domelight"))

with tempfile.TemporaryDirectory() as folder:

    def domelight(*words):
        subprocess.run([PROGRAM, *map(str, words)], cwd=folder, check=True)

    view = ["--width", 480, "--height", 270, "--quiet"]
    domelight("sky", "-o", "evening.hdr", "--height", 256, "--sun-elevation-deg", 12, "--quiet")
    domelight("render", "spheres", "--env", "evening.hdr", *view, "--spp", 256, "-o", "truth.exr")
    domelight("render", "spheres", "--env", "evening.hdr", *view, "--spp", 64, "--shading", "split-sum", "-o", "split-sum.exr")
    domelight("compare", "split-sum.exr", "truth.exr", "--sheet", HERE / "compare.png")
