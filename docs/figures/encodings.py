#!/usr/bin/python3
"""Prints the table of docs/encodings.md: environments baked in every encoding, from the manifests of the bakes.

    DOMELIGHT_DATA=... encodings.py [FILE.hdr ...]
"""

import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

from pictures import PROGRAM

ENCODINGS = [("rgba32f", []), ("rgba16f", []), ("RGBE (.hdr)", ["--format", "hdr"]), ("rgb9e5", []), ("r11g11b10f", []),
             ("rgbd", []), ("rgbm", []), ("rgbp", []), ("bc6h", ["--encoding-quality", "high"]), ("bc6h", []),
             ("bc6h", ["--encoding-quality", "fast"])]
OPTIONS = ["--size", "256", "--levels", "6", "--irradiance-size", "8", "--brdf-size", "8", "--no-preview", "--no-hashes"]
NAMES = ["studio_small_03", "noon_grass", "aristea_wreck_puresky"]
ROUGH_LEVEL = 2


def bake(environment, options):
    """Levels of the specular map, and the bytes of its files."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([PROGRAM, "bake", environment, "-o", folder, *OPTIONS, *options], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        map_of = json.loads(pathlib.Path(folder, "manifest.json").read_text())["specular"]
        files = [map_of["file"]] if "file" in map_of else [level["file"] for level in map_of["levels"]]
        return map_of["levels"], sum(pathlib.Path(folder, f).stat().st_size for f in files)


def decibels(levels, number):
    psnr = levels[number]["encoding_log_psnr"]
    return "∞" if psnr is None else f"{psnr:.1f}"


def main():
    environments = sys.argv[1:] or [f"{os.environ['DOMELIGHT_DATA']}/env_latlong/{name}_1k.hdr" for name in NAMES]
    print("| encoding | KiB, zstd | " + " | ".join(pathlib.Path(e).stem for e in environments) + " | clipped energy |")
    print("|---|---|" + "---|" * (len(environments) + 1))
    for name, options in ENCODINGS:
        is_picture = "hdr" in options
        choice = [] if is_picture else ["--encoding", name]
        cells, sizes, clipped = [], [], 0
        for environment in environments:
            levels, size = bake(environment, choice + options)
            zstd = None if is_picture else bake(environment, choice + options + ["--zstd"])[1]
            sizes.append((size, zstd))
            cells.append(f"{decibels(levels, 0)}, {decibels(levels, ROUGH_LEVEL)} ({100 * levels[0]['encoding_rms_error']:.2g} %)")
            clipped = max(clipped, levels[0]["clipped_energy"])
        size = round(sum(s for s, _ in sizes) / len(sizes) / 1024)
        packed = "" if is_picture else f", {round(sum(z for _, z in sizes) / len(sizes) / 1024)}"
        label = name + (f", {options[1]}" if "--encoding-quality" in options else ", default" if name == "bc6h" else "")
        lost = "0" if clipped == 0 else f"{100 * clipped:.2g} %"
        print(f"| {label} | {size}{packed} | " + " | ".join(cells) + f" | {lost} |", flush=True)


if __name__ == "__main__":
    main()
