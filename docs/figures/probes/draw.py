#!/usr/bin/env python3
"""Draws docs/figures/probes/*.jpg: two rooms (rooms.py) under the built-in sky, lit by one environment, by probes, and by the truth, with the error of each.

    docs/figures/probes/draw.py [FOLDER]     FOLDER keeps the pictures, and what is in it is not computed again

About three minutes of processor time.
"""

import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from PIL import Image

import rooms

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from pictures import FAINT, INK, PROGRAM, Sheet, read_exr  # noqa: E402

EV = -4.4  # stops from the sky's radiances to a display
LIGHT = ["--env", "sky/remainder.exr", "--lights", "sky/lights.gltf"]
PROBES = ["--shading", "split-sum", "--spp", 16]
ONE_ENVIRONMENT = ["--shading", "split-sum", "--occlusion", "off", "--spp", 16, "--env", "sky.exr"]
TRUTH = ["--bounces", 8, *LIGHT]
VIEWS = {  # scene, eye, target, vertical field of view, width, height, samples of the truth
    "rooms": ("rooms", *rooms.CAMERA, 240, 160, 400),
    "dark": ("closed", "8.7,1.6,0.4", "5.2,1.1,3.2", 60, 180, 120, 16),
    "ball": ("rooms", "2.2,1.5,2.6", "2.9,1.0,0.7", 24, 180, 120, 200),
}


class Pictures:
    """Renders of the views, kept in a folder."""

    def __init__(self, folder):
        self.folder = folder
        for scene in ("rooms", "closed"):
            (folder / f"{scene}.glb").write_bytes(rooms.two_rooms(scene == "closed"))
        if not (folder / "sky/lights.gltf").exists():
            self.domelight("sky", "-o", "sky.exr", "--exr", "float", "--height", 256, "--sun-elevation-deg", 32, "--sun-azimuth-deg", 70)
            self.domelight("lights", "sky.exr", "-o", "sky", "--no-preview")
            for scene in ("rooms", "closed"):
                self.domelight("probes", f"{scene}.glb", *LIGHT, "--grid", "9,3,4", "--region", "0,0,0,9,2.8,4", "--bounces", 8, "--size", 32, "--spp", 32, "-o", scene)

    def domelight(self, *words):
        subprocess.run([PROGRAM, *map(str, words), "--quiet"], cwd=self.folder, check=True)

    def draw(self, view, name, options):
        """The picture for a display, 8-bit (H, W, 3), and its radiance scaled to that of a display."""
        scene, eye, target, fov, width, height, spp = VIEWS[view]
        file = f"{view}_{name}"
        if not (self.folder / f"{file}.png").exists():
            spp_words = [] if "--spp" in options else ["--spp", spp]
            environment = [] if "--env" in options or "--bounces" in options else LIGHT
            probes = ["--probes", scene] if options[:len(PROBES)] == PROBES else []
            self.domelight("render", f"{scene}.glb", *options, *probes, *spp_words, *environment, "--camera-position", eye, "--camera-target", target, "--fov-deg", fov,
                           "--width", width, "--height", height, "--ev", EV, "-o", f"{file}.exr", "-o", f"{file}.png")
        return np.asarray(Image.open(self.folder / f"{file}.png").convert("RGB")), read_exr(self.folder / f"{file}.exr") * 2**EV


def tone(radiance):
    return radiance / (1 + radiance)


def error_picture(radiance, truth):
    """The difference of L / (1 + L), black to white at 0.25, and its RMSE."""
    difference = np.abs(tone(radiance) - tone(truth))
    return (255 * np.clip(difference.mean(axis=-1, keepdims=True) * 4, 0, 1)).astype(np.uint8).repeat(3, axis=-1), float(np.sqrt(np.mean((tone(radiance) - tone(truth))**2)))


def row_of(pictures, view, columns, name, caption):
    """A sheet of pictures side by side, with the error of each below it; the last is the truth."""
    width, height = VIEWS[view][4:6]
    gap, top = 12, 26
    sheet = Sheet(len(columns) * (width + gap) + gap, top + 2 * height + 40)
    drawn = [pictures.draw(view, key, options) for key, _, options in columns]
    for i, ((_, label, _), (shown, radiance)) in enumerate(zip(columns, drawn)):
        x = gap + i * (width + gap)
        sheet.text(x, 6, label, bold=i == len(columns) - 1)
        sheet.picture(x, top, shown, width, height, smooth=False)
        if i + 1 < len(columns):
            shown, error = error_picture(radiance, drawn[-1][1])
            sheet.picture(x, top + height + 6, shown, width, height, smooth=False)
            sheet.text(x, top + 2 * height + 12, f"RMSE {error:.3f}", colour=INK)
            print(f"{view}: {label}: {error:.4f}")
    sheet.text(gap + (len(columns) - 1) * (width + gap), top + height + 12, caption, size=11, colour=FAINT)
    sheet.save_jpeg(f"probes/{name}.jpg")


def draw_all(folder):
    pictures = Pictures(folder)
    row_of(pictures, "rooms", [("one", "One environment", ONE_ENVIRONMENT), ("probes", "108 probes", PROBES), ("truth", "Truth", TRUTH)], "rooms",
           "Left: the error of L/(1+L),\nwhite is 0.25 or more")
    row_of(pictures, "dark", [("leak", "Without visibility", [*PROBES, "--probe-visibility", "off"]), ("probes", "With visibility", PROBES), ("truth", "Truth", TRUTH)], "dark",
           "The second room, walled up:\nnothing lights it")
    row_of(pictures, "ball", [("flat", "Without parallax", [*PROBES, "--parallax", "off"]), ("probes", "With parallax", PROBES), ("truth", "Truth", TRUTH)], "ball",
           "A brass ball, roughness 0.15")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        pathlib.Path(sys.argv[1]).mkdir(parents=True, exist_ok=True)
        draw_all(pathlib.Path(sys.argv[1]).resolve())
    else:
        with tempfile.TemporaryDirectory() as temporary:
            draw_all(pathlib.Path(temporary))
