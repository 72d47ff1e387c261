#!/usr/bin/python3
"""Draws the README's comparison with cmgen: two levels of one photograph about its sun, as cmgen bakes them with its default options and as Domelight does.

    peer.py ENVIRONMENT.hdr    the committed one is Poly Haven's "Spruit Sunrise" (CC0), 1024 x 512

Needs cmgen (Debian's libfilament-tools). Both tools bake the same 256² chain at cmgen's roughness of each level; both store floats or halves, so that the
filters are compared and not an encoding. Every texel is then shown where it looks, in a lat-long picture.
"""

import math
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from pictures import FAINT, INK, PROGRAM, Sheet, read_exr, srgb  # noqa: E402

LEVELS, SHOWN, HEIGHT, ACROSS, DOWN = 5, (2, 3), 512, 180, 90
FACES = ("px", "nx", "py", "ny", "pz", "nz")
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
RED, BLUE = np.array([200, 45, 45]), np.array([50, 80, 200])


def run(*words):
    subprocess.run([str(word) for word in words], check=True, stdout=subprocess.DEVNULL)


def lat_long(work, *cube):
    picture = work / "lat_long.exr"
    run(PROGRAM, "convert", *cube, picture, "--to", "latlong", "--size", HEIGHT, "--quiet")
    return read_exr(picture)


def baked(work, environment):
    """The shown levels as lat-long pictures, cmgen's and Domelight's."""
    run("cmgen", "--quiet", "--size=256", "--format=exr", "--compression=ZIP", f"--ibl-ld={work / 'cmgen'}", environment)
    roughness = ",".join(repr(1 - math.sqrt(1 - level / (LEVELS - 1))) for level in range(LEVELS))
    run(PROGRAM, "bake", environment, "--latlong", "usd", "--size", 256, "--levels", LEVELS, "--roughness", roughness, "--encoding", "rgba32f",
        "--format", "exr", "-o", work / "ours", "--quiet")  # cmgen sees +Z at the centre of a lat-long picture, as USD does
    folder = next((work / "cmgen").rglob("m1_px.exr")).parent
    theirs = [lat_long(work, *(folder / f"m{level}_{face}.exr" for face in FACES)) for level in SHOWN]
    ours = [lat_long(work, work / "ours" / f"specular_{level}.exr") for level in SHOWN]
    return theirs, ours


def window(picture, middle):
    """The part about a texel, ACROSS degrees wide and DOWN high; the picture is continued across its seam."""
    rows = np.clip(np.arange(HEIGHT * DOWN // 180) + middle[0] - HEIGHT * DOWN // 360, 0, HEIGHT - 1)
    columns = (np.arange(HEIGHT * ACROSS // 180) + middle[1] - HEIGHT * ACROSS // 360) % (2 * HEIGHT)
    return picture[np.ix_(rows, columns)]


def tone_mapped(radiance):
    return srgb(radiance / (1 + radiance))


def signed(relative, full):
    """White where equal, red where the first is brighter, blue where it is darker; `full` is the difference of the full colour."""
    t = np.clip(relative / full, -1, 1)[..., None]
    return (255 + np.where(t > 0, t * (RED - 255), -t * (BLUE - 255)) + 0.5).astype(np.uint8)


def main(environment):
    with tempfile.TemporaryDirectory() as folder:
        theirs, ours = baked(pathlib.Path(folder), environment)
    luminance = [picture @ LUMINANCE for picture in ours]
    middle = np.unravel_index(np.argmax(luminance[0]), luminance[0].shape)
    width, height, gap, top, left, full = 360, 180, 8, 36, 204, 0.5
    sheet = Sheet(left + 2 * width + gap, top + 3 * (height + gap))
    titles = (("cmgen", "1024 samples, its default"), ("Domelight", "the integral itself"), ("how far cmgen is off", "blue darker, red brighter, to 50 %"))
    for row, (title, remark) in enumerate(titles):
        y = top + row * (height + gap) + height / 2
        sheet.text(left - 12, y - 10, title, 13, INK, "rm", bold=True)
        sheet.text(left - 12, y + 10, remark, 11, FAINT, "rm")
    for column, (level, a, b) in enumerate(zip(SHOWN, theirs, ours)):
        a, b, x = window(a, middle), window(b, middle), left + column * (width + gap)
        difference = signed((a @ LUMINANCE) / (b @ LUMINANCE) - 1, full)
        sheet.text(x + width / 2, top / 2, f"level {level}: {256 >> level}², roughness {1 - math.sqrt(1 - level / (LEVELS - 1)):.2f}", 13, INK, "mm")
        for row, pixels in enumerate((tone_mapped(a), tone_mapped(b), difference)):
            sheet.picture(x, top + row * (height + gap), pixels, width, height)
    sheet.save_jpeg("readme/peer.jpg")


if __name__ == "__main__":
    main(sys.argv[1])
