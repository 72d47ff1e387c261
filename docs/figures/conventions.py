#!/usr/bin/python3
"""Draws the figures of docs/conventions.md from the six-axis environment (`domelight sky --axes`).

The conventions are written here a second time, from their published definitions and not from the library's code, so that a mistake in either shows.
"""

import numpy as np

from pictures import FAINT, INK, Sheet, made_by_domelight, srgb

AXES = {"+X": (1, 0, 0), "-X": (-1, 0, 0), "+Y": (0, 1, 0), "-Y": (0, -1, 0), "+Z": (0, 0, 1), "-Z": (0, 0, -1)}
COLOURS = {"X": (200, 45, 45), "Y": (40, 140, 60), "Z": (50, 80, 200)}
TAU = 2 * np.pi


def look_up(environment, d):
    """Radiance (..., 3) of a lat-long image in the default convention from directions (..., 3), bilinearly."""
    height, width, _ = environment.shape
    u = 0.5 + np.arctan2(d[..., 2], d[..., 0]) / TAU
    v = np.arctan2(np.hypot(d[..., 0], d[..., 2]), d[..., 1]) / np.pi
    x, y = u * width - 0.5, np.clip(v * height - 0.5, 0, height - 1)
    x0, y0 = np.floor(x).astype(int), np.minimum(np.floor(y).astype(int), height - 2)
    fx, fy = (x - x0)[..., None], (y - y0)[..., None]
    def at(i, j): return environment[j, i % width]
    return ((at(x0, y0) * (1 - fx) + at(x0 + 1, y0) * fx) * (1 - fy) + (at(x0, y0 + 1) * (1 - fx) + at(x0 + 1, y0 + 1) * fx) * fy)


def latlong_directions(width, height, centre, right, up="+Y", columns="centres", rows="centres"):
    """World directions (H, W, 3) of a lat-long image, said by what its centre, its right and its top look along."""
    i, j = np.arange(width), np.arange(height)
    phi = ((i / (width - 1) if columns == "ends" else (i + 0.5) / width) - 0.5) * TAU
    theta = (j / (height - 1) if rows == "ends" else (j + 0.5) / height) * np.pi
    c, r, t = (np.array(AXES[a], float) for a in (centre, right, up))
    around = np.cos(phi)[:, None] * c + np.sin(phi)[:, None] * r
    return np.sin(theta)[:, None, None] * around + np.cos(theta)[:, None, None] * t


def pbrt_directions(size):
    """World directions of pbrt-v4's equal-area octahedral square (Clarberg 2008). Its z up becomes +Y, its y becomes -Z."""
    p = (np.arange(size) + 0.5) / size * 2 - 1
    u, v = np.meshgrid(p, p)
    signed = 1 - np.abs(u) - np.abs(v)
    r = 1 - np.abs(signed)
    phi = (np.where(r == 0, 1, (np.abs(v) - np.abs(u)) / np.maximum(r, 1e-12)) + 1) * np.pi / 4
    z = np.copysign(1 - r * r, signed)
    s = r * np.sqrt(2 - r * r)
    x, y = np.copysign(np.cos(phi), u) * s, np.copysign(np.sin(phi), v) * s
    return np.stack([x, z, -y], axis=-1)


def cube_directions(face, size):
    """World directions of an OpenGL cube face (core specification, table 8.19, solved for the direction)."""
    p = (np.arange(size) + 0.5) / size * 2 - 1
    s, t = np.meshgrid(p, p)
    one = np.ones_like(s)
    d = [(one, -t, -s), (-one, -t, s), (s, one, t), (s, -one, -t), (s, -t, one), (-s, -t, -one)][face]
    return np.stack(d, axis=-1)


def axis_colour(axis):
    return COLOURS[axis[1]]


def draw_latlong(environment):
    panels = [
        ("default", "+X", "+Z", "three.js, the Khronos viewer, Cycles, the first slides"),
        ("usd", "+Z", "-X", "USD; mitsuba and openexr look the same"),
        ("materialx", "-Z", "+X", "MaterialX"),
        ("mod", "-X", "-Z", "the slides' shader, s = 1 − mod(φ / 2π, 1)"),
    ]
    wide, high, gap = 440, 220, 24
    sheet = Sheet(2 * wide + 3 * gap, 2 * (high + 70) + 10)
    for n, (name, centre, right, note) in enumerate(panels):
        x, y = gap + (n % 2) * (wide + gap), 34 + (n // 2) * (high + 70)
        sheet.text(x, y - 24, name, 15, bold=True)
        sheet.text(x + wide, y - 22, note, 11, FAINT, "ra")
        sheet.picture(x, y, srgb(look_up(environment, latlong_directions(2 * wide, 2 * high, centre, right))), wide, high)
        sheet.box(x, y, wide, high)
        opposite = {"+": "-", "-": "+"}
        for u, axis in ((0.25, opposite[right[0]] + right[1]), (0.5, centre), (0.75, right)):
            sheet.line([(x + u * wide, y + high), (x + u * wide, y + high + 5)])
            label = {0.25: "", 0.5: "centre ", 0.75: "right "}[u] + axis
            sheet.text(x + u * wide, y + high + 8, label.replace("-", "−"), 12, axis_colour(axis), "ma")
    sheet.save("latlong.png", 128)


def draw_octahedral(environment):
    size, gap = 260, 20
    sheet = Sheet(size + 330, size + 2 * gap)
    sheet.picture(gap, gap, srgb(look_up(environment, pbrt_directions(2 * size))), size, size)
    sheet.box(gap, gap, size, size)
    for n, line in enumerate(["pbrt-v4's square", "", "equal-area octahedral, z up:", "the centre is up (+Y here),", "the corners are down.",
                              "Drawn with pbrt's x, y, z", "as our x, −z, y."]):
        sheet.text(size + 2 * gap + 10, gap + 20 + 20 * n, line, 15 if n == 0 else 13, bold=n == 0)
    sheet.save("octahedral.png", 128)


def draw_texels():
    """Where each convention puts 8 texels over a full turn (or 8 rows from pole to pole)."""
    sheet = Sheet(760, 200)
    left, right, count = 300, 690, 8
    rows = [("texel centres", "default, usd, materialx, mod; columns and rows", (np.arange(count) + 0.5) / count),
            ("0 … N − 1 over the range", "mitsuba: rows; openexr: columns and rows", np.arange(count) / (count - 1))]
    for n, (name, who, places) in enumerate(rows):
        y = 50 + 80 * n
        sheet.text(16, y - 16, name, 13, bold=True)
        sheet.text(16, y + 4, who, 10, FAINT)
        sheet.line([(left, y), (right, y)])
        for end in (left, right):
            sheet.line([(end, y - 12), (end, y + 12)])
        for place in places:
            sheet.dot(left + place * (right - left), y, 4, COLOURS["Z"])
    sheet.text(left, 165, "−180°, or the pole up", 11, FAINT, "ma")
    sheet.text(right, 165, "+180°, or down", 11, FAINT, "ma")
    sheet.save("texels.png", 32)


def draw_cube(environment):
    """The six faces as an unfolded cross, with the direction at each face's edges."""
    size, margin = 150, 40
    sheet = Sheet(4 * size + 2 * margin, 3 * size + 2 * margin)
    places = {"+Y": (1, 0), "-X": (0, 1), "+Z": (1, 1), "+X": (2, 1), "-Z": (3, 1), "-Y": (1, 2)}
    for face, name in enumerate(AXES):
        column, row = places[name]
        x, y = margin + column * size, margin + row * size
        sheet.picture(x, y, srgb(look_up(environment, cube_directions(face, 2 * size))), size, size)
        sheet.box(x, y, size, size, INK)
        sheet.text(x + 8, y + 5, f"face {face}", 11, bold=True)
    x, y = margin + 2.25 * size, margin + 2.2 * size
    sheet.arrow((x, y), (x + 60, y))
    sheet.arrow((x, y), (x, y + 60))
    sheet.text(x + 66, y - 8, "s: columns, left to right")
    sheet.text(x - 4, y + 64, "t: rows, top to bottom", anchor="la")
    sheet.save("cube.png", 128)


def project(p):
    """A picture's (x, y) for a world point, seen from a little above and to the side; the origin is at (0, 0)."""
    yaw, pitch = np.radians(-32), np.radians(22)
    x, y, z = p
    x, z = x * np.cos(yaw) + z * np.sin(yaw), -x * np.sin(yaw) + z * np.cos(yaw)
    return np.array([x, -(y * np.cos(pitch) - z * np.sin(pitch))])


def draw_world():
    """The world's axes with theta and phi of a direction."""
    sheet = Sheet(620, 400)
    origin, scale = np.array([220, 225]), 165
    def place(p): return tuple(origin + scale * project(np.array(p, float)))
    angles = np.linspace(0, TAU, 97)
    sheet.line([place((np.cos(a), 0, np.sin(a))) for a in angles], FAINT, 1)
    for axis in ("+X", "+Y", "+Z"):
        tip = np.array(AXES[axis]) * 1.12
        sheet.arrow(place((0, 0, 0)), place(tip), axis_colour(axis), 2.5, 10)
        sheet.text(*place(tip * 1.1), axis, 15, axis_colour(axis), "mm", True)
    theta, phi = np.radians(48), np.radians(22)
    def direction(t, f): return (np.sin(t) * np.cos(f), np.cos(t), np.sin(t) * np.sin(f))
    sheet.arrow(place((0, 0, 0)), place(direction(theta, phi)), INK, 2, 9)
    sheet.text(*(np.array(place(direction(theta, phi))) + (10, -6)), "direction", 13)
    foot = (np.sin(theta) * np.cos(phi), 0, np.sin(theta) * np.sin(phi))
    sheet.line([place(direction(theta, phi)), place(foot), place((0, 0, 0))], FAINT, 1)
    sheet.line([place(0.45 * np.array(direction(t, phi))) for t in np.linspace(0, theta, 33)], INK, 1.2)
    sheet.line([place(0.4 * np.array(direction(np.pi / 2, f))) for f in np.linspace(0, phi, 33)], INK, 1.2)
    sheet.text(*place(0.56 * np.array(direction(theta / 2, phi))), "θ", 15, anchor="mm")
    sheet.text(*place(0.52 * np.array(direction(np.pi / 2, phi / 2))), "φ", 15, anchor="mm")
    sheet.text(330, 330, "u = 1/2 + φ / 2π,   φ = atan2(z, x)", 12)
    sheet.text(330, 352, "v = θ / π,   θ = atan2(hypot(x, z), y)", 12)
    sheet.save("world.png", 64)


def draw_levels():
    """Which roughness is seen when a level chain of linear roughness is read at each of two levels, and the curves of other engines."""
    sheet = Sheet(900, 360)
    r = np.linspace(0, 1, 401)
    levels = 5
    last = levels - 1
    def frame(x, y, width, height, title, x_name, y_name, y_max):
        sheet.box(x, y, width, height, INK)
        sheet.text(x, y - 24, title, 13, bold=True)
        sheet.text(x + width / 2, y + height + 22, x_name, 12, anchor="ma")
        sheet.text(x - 6, y - 2, y_name, 11, anchor="rb")
        for k in range(6):
            sheet.text(x + width * k / 5, y + height + 6, f"{k / 5:g}", 10, FAINT, "ma")
        return lambda a, b: [(x + width * p, y + height * (1 - q / y_max)) for p, q in zip(a, b)]

    plot = frame(60, 50, 340, 250, "roughness seen: 5 levels, linear in roughness", "roughness asked for", "", 1)
    for k in range(6):
        sheet.text(54, 300 - 50 * k, f"{k / 5:g}", 10, FAINT, "rm")
    sheet.line(plot(r, r), COLOURS["Y"], 2.5)
    sheet.line(plot(r, np.minimum(levels * r, last) / last), COLOURS["X"], 2.5)
    sheet.text(250, 215, "(levels − 1) · roughness", 11, COLOURS["Y"], "la")
    sheet.text(120, 135, "levels · roughness", 11, COLOURS["X"], "la")

    plot = frame(500, 50, 250, 250, "level read, 9 levels from 256²", "roughness", "", 8)
    for k in range(9):
        sheet.text(494, 300 - 250 / 8 * k, str(k), 10, FAINT, "rm")
    alpha = r * r
    first = 0.08
    generic = np.where(r < first, r / first, 8 - 7 * np.log(np.maximum(r, first)) / np.log(first))
    curves = [("generic", generic, (90, 90, 90)), ("linear", 8 * r, COLOURS["Y"]), ("three, filament", 8 * r * (2 - r), COLOURS["X"]),
              ("babylon", np.clip(0.8 * np.log2(np.maximum(256 * alpha, 1)), 0, 8), COLOURS["Z"]),
              ("materialx", 8 * np.where(alpha < 0.25, r, 0.5 * alpha + 0.375), (150, 90, 170))]
    for n, (name, level, colour) in enumerate(curves):
        sheet.line(plot(r, level), colour, 2)
        sheet.line([(765, 70 + 24 * n), (790, 70 + 24 * n)], colour, 2.5)
        sheet.text(797, 70 + 24 * n, name, 12, anchor="lm")
    sheet.save("levels.png", 64)


def draw_harmonics():
    """The first nine basis functions, as lat-long pictures in the default convention."""
    high = 70
    d = latlong_directions(4 * high, 2 * high, "+X", "+Z")
    x, y, z = d[..., 0], d[..., 1], d[..., 2]
    c = np.sqrt(1 / np.pi)
    basis = [[("1", c / 2 + 0 * x)],
             [("y", np.sqrt(3) / 2 * c * y), ("z", np.sqrt(3) / 2 * c * z), ("x", np.sqrt(3) / 2 * c * x)],
             [("xy", np.sqrt(15) / 2 * c * x * y), ("yz", np.sqrt(15) / 2 * c * y * z), ("3z² − 1", np.sqrt(5) / 4 * c * (3 * z * z - 1)),
              ("zx", np.sqrt(15) / 2 * c * z * x), ("x² − y²", np.sqrt(15) / 4 * c * (x * x - y * y))]]
    sheet = Sheet(5 * (2 * high + 14) + 20, 3 * (high + 36) + 8)
    index = 0
    for band, functions in enumerate(basis):
        for n, (name, value) in enumerate(functions):
            left = 10 + (n + 2 - band) * (2 * high + 14)
            top = 26 + band * (high + 36)
            t = np.clip(value / 1.1, -1, 1)[..., None]
            colour = np.where(t > 0, 255 - t * (255 - np.array([200, 45, 45])), 255 + t * (255 - np.array([50, 80, 200])))
            sheet.picture(left, top, colour.astype(np.uint8), 2 * high, high)
            sheet.box(left, top, 2 * high, high)
            sheet.text(left, top - 19, f"{index}:  {name}", 12, bold=True)
            index += 1
    sheet.text(10, 30, "positive", 12, COLOURS["X"])
    sheet.text(10, 48, "negative", 12, COLOURS["Z"])
    sheet.save("harmonics.png", colours=0)


def main():
    environment = made_by_domelight("sky", "--axes", "--height", "512")
    draw_world()
    draw_latlong(environment)
    draw_octahedral(environment)
    draw_texels()
    draw_cube(environment)
    draw_levels()
    draw_harmonics()


if __name__ == "__main__":
    main()
