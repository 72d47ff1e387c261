#!/usr/bin/python3
"""Draws docs/projections.md's figure: the six-axis environment in every projection, as `domelight convert` writes it.

Each projection is written here a second time, from its published definition and not from the library's code; the program's picture must agree with it.
"""

import pathlib
import subprocess
import sys
import tempfile

import numpy as np

from conventions import cube_directions, latlong_directions, look_up, pbrt_directions
from pictures import FAINT, INK, PROGRAM, Sheet, read_hdr, srgb

SIZE = 256


def disc(size):
    """x to the right, y up, of a square picture of a disc, and where it is inside."""
    p = (np.arange(size) + 0.5) / size * 2 - 1
    x, y = np.meshgrid(p, -p)
    return x, y, x * x + y * y


def sphere_map(size):
    x, y, q = disc(size)
    hz = np.sqrt(np.maximum(0, 1 - q))
    return np.stack([2 * hz * x, 2 * hz * y, 2 * hz * hz - 1], -1), q <= 1


def hemisphere(size):
    x, y, q = disc(size)
    return np.stack([x, y, np.sqrt(np.maximum(0, 1 - q))], -1), q <= 1


def mirror_ball(size, fov_deg=60):
    """A ray from a camera on +Z through each texel, mirrored by the unit ball at the origin."""
    x, y, q = disc(size)
    half = np.radians(fov_deg) / 2
    ray = np.stack([x * np.tan(half), y * np.tan(half), -np.ones_like(x)], -1)
    ray /= np.linalg.norm(ray, axis=-1, keepdims=True)
    camera = np.array([0, 0, 1 / np.sin(half)])
    b = ray @ camera
    t = -b - np.sqrt(np.maximum(0, b * b - camera @ camera + 1))
    n = camera + ray * t[..., None]
    return ray - 2 * np.sum(ray * n, -1, keepdims=True) * n, q <= 1


def angular(size):
    """Debevec: (0, 0, -1) turned by phi = pi r about y, then by theta about -z."""
    x, y, q = disc(size)
    phi, theta = np.pi * np.sqrt(q), np.arctan2(y, x)
    return np.stack([np.sin(phi) * np.cos(theta), np.sin(phi) * np.sin(theta), -np.cos(phi)], -1), q <= 1


def paraboloid(size, sign=1):
    x, y, q = disc(size)
    return np.stack([2 * x, 2 * y, sign * (1 - q)], -1) / (1 + q)[..., None], q <= 1


def paraboloid_opposite(size):
    d, inside = paraboloid(size)
    return -d, inside


def dual_paraboloid(size):
    front, inside = paraboloid(size)
    back, _ = paraboloid(size, -1)
    return np.concatenate([front, back], 1), np.concatenate([inside, inside], 1)


def octahedral(size):
    p = (np.arange(size) + 0.5) / size * 2 - 1
    x, v = np.meshgrid(p, p)
    z = 1 - np.abs(x) - np.abs(v)
    fx, fv = np.where(z < 0, (1 - np.abs(v)) * np.copysign(1, x), x), np.where(z < 0, (1 - np.abs(x)) * np.copysign(1, v), v)
    d = np.stack([fx, z, -fv], -1)  # z up becomes +Y, the picture's y downwards -Z
    return d / np.linalg.norm(d, axis=-1, keepdims=True), np.ones_like(z, bool)


def cross(size):
    face = size // 3
    d, inside = np.zeros((3 * face, 4 * face, 3)), np.zeros((3 * face, 4 * face), bool)
    for f, (column, row) in enumerate([(2, 1), (0, 1), (1, 0), (1, 2), (1, 1), (3, 1)]):
        part = np.s_[row * face:(row + 1) * face, column * face:(column + 1) * face]
        d[part], inside[part] = cube_directions(f, face), True
    return d, inside


def all_of(d):
    return d, np.ones(d.shape[:2], bool)


PANELS = [
    ("latlong", "latlong", lambda n: all_of(latlong_directions(2 * n, n, "+X", "+Z")), 2, "u = 1/2 + atan2(z, x) / 2π,  v = θ / π"),
    ("cube", "cube (cross)", cross, 4 / 3, "faces in OpenGL's orientation"),
    ("sphere-map", "sphere-map", sphere_map, 1, "h = normalize(d + z)"),
    ("mirror-ball/fov=60", "mirror-ball/fov=60", mirror_ball, 1, "seen from two radii away"),
    ("angular", "angular", angular, 1, "r = angle / π"),
    ("hemisphere", "hemisphere", hemisphere, 1, "only +Z"),
    ("dual-paraboloid", "dual-paraboloid (side by side)", dual_paraboloid, 2, "front xy / (1 + z), back xy / (1 − z)"),
    ("paraboloid-opposite", "paraboloid-opposite", paraboloid_opposite, 1, "xy / (z − 1)"),
    ("octahedral", "octahedral", octahedral, 1, "|x| + |y| + |z| = 1"),
    ("equal-area-octahedral", "equal-area-octahedral", lambda n: all_of(pbrt_directions(n)), 1, "pbrt-v4"),
]


def main():
    with tempfile.TemporaryDirectory() as folder:
        axes = pathlib.Path(folder, "axes.hdr")
        subprocess.run([PROGRAM, "sky", "--axes", "--height", "1024", "-o", axes, "--quiet"], check=True)
        environment = read_hdr(axes)
        pictures = []
        for name, title, directions, aspect, note in PANELS:
            height = SIZE - SIZE % 3 if name == "cube" else SIZE
            file = pathlib.Path(folder, "out.hdr")
            subprocess.run([PROGRAM, "convert", axes, file, "--to", name, "--size", str(height // 3 if name == "cube" else height), "--quiet"], check=True)
            made = read_hdr(file)
            # Texels average: so do 4 x 4 points of the formula. A turn or mirror would differ by far more than the rest, a texel at the discs' rims.
            d, inside = directions(4 * height)
            def mean(a): return a.reshape(a.shape[0] // 4, 4, a.shape[1] // 4, 4, -1).mean((1, 3))
            weight = mean(inside[..., None].astype(float))
            truth = mean(np.where(inside[..., None], look_up(environment, d), 0)) / np.maximum(weight, 1e-9)
            inside = weight[..., 0] > 0
            difference = np.abs(made - truth)[inside].mean() / truth[inside].mean()
            print(f"{name}: {made.shape[1]} x {made.shape[0]}, mean difference {100 * difference:.1f} %")
            if made.shape != truth.shape or difference > 0.03:
                sys.exit(f"{name}: the program's picture is not the formula's")
            pictures.append((title, note, np.where((made.sum(-1) > 0)[..., None], srgb(made), 255).astype(np.uint8), aspect))
    high, gap, left = 190, 26, 20
    rows = [pictures[0:2], pictures[2:6], pictures[6:10]]
    width = max(sum(int(high * a) + gap for *_, a in row) for row in rows) + left
    sheet = Sheet(width, len(rows) * (high + 64) + 8)
    for r, row in enumerate(rows):
        x, y = left, 34 + r * (high + 64)
        for title, note, picture, aspect in row:
            wide = int(high * aspect)
            sheet.text(x, y - 24, title, 14, INK, bold=True)
            sheet.picture(x, y, picture, wide, high)
            sheet.text(x, y + high + 4, note, 11, FAINT)
            x += wide + gap
    sheet.save("projections.png", 128)


if __name__ == "__main__":
    main()
