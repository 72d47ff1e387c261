#!/usr/bin/python3
"""Draws the figures of docs/math/prefilter.md: the lobes, their spectra, and what n = v = r drops.

The formulas are written here a second time, from the page and not from the library's code.
"""

import numpy as np

from pictures import FAINT, INK, Sheet

COLOURS = [(200, 45, 45), (222, 126, 30), (40, 140, 60), (50, 80, 200), (130, 60, 170)]
NODES, WEIGHTS = np.polynomial.legendre.leggauss(1600)


class Plot:
    """Axes on a sheet; either may be logarithmic."""

    def __init__(self, sheet, x, y, width, height, xs, ys, title, xlabel, xlog=False, ylog=False):
        self.sheet, self.place, self.xs, self.ys, self.xlog, self.ylog = sheet, (x, y, width, height), xs, ys, xlog, ylog
        sheet.box(x, y, width, height)
        sheet.text(x, y - 24, title, 13, bold=True)
        sheet.text(x + width / 2, y + height + 22, xlabel, 12, FAINT, "ma")

    @staticmethod
    def _part(value, span, log):
        if log:
            value, span = np.log(np.maximum(value, 1e-300)), np.log(span)
        return (value - span[0]) / (span[1] - span[0])

    def at(self, x, y):
        left, top, width, height = self.place
        return left + width * self._part(x, self.xs, self.xlog), top + height * (1 - self._part(y, self.ys, self.ylog))

    def ticks(self, xs=(), ys=(), yformat="{:g}"):
        left, top, width, height = self.place
        for x in xs:
            px, _ = self.at(x, self.ys[1])
            self.sheet.line([(px, top + height), (px, top + height + 4)], FAINT, 1)
            self.sheet.text(px, top + height + 6, f"{x:g}", 11, FAINT, "ma")
        for y in ys:
            _, py = self.at(self.xs[1], y)
            self.sheet.line([(left - 4, py), (left, py)], FAINT, 1)
            self.sheet.text(left - 7, py, yformat.format(y), 11, FAINT, "rm")

    def curve(self, x, y, colour, width=1.8):
        keep = (y >= self.ys[0]) & (y <= self.ys[1] * 1.0001)
        run = []
        for inside, px, py in zip(keep, *self.at(x, y)):
            if inside:
                run.append((px, py))
            elif len(run) > 1:
                self.sheet.line(run, colour, width)
            if not inside:
                run = []
        if len(run) > 1:
            self.sheet.line(run, colour, width)


def ggx(alpha, c):
    k = np.maximum(c, 0) / (alpha ** 2 * (1 + c) + 1 - c) ** 2
    return k


def charlie(alpha, c):
    return np.maximum(c, 0) * (1 - c) ** (0.5 / alpha)


def phong(n, c):
    return np.maximum(c, 0) ** (n + 1)


def normalised(lobe, width):
    """Density per steradian as a function of the angle."""
    x, w = NODES, WEIGHTS
    s = np.sqrt(2) * ((x + 1) / 2) ** 3  # |a - b|, nodes gathered at the peak
    ds = np.sqrt(2) * 3 * ((x + 1) / 2) ** 2 * w / 2
    total = 2 * np.pi * np.sum(lobe(width, 1 - s * s / 2) * s * ds)
    return lambda theta: lobe(width, np.cos(theta)) / total


def spectrum(lobe, width, degrees):
    x, w = NODES, WEIGHTS
    s, ds = np.sqrt(2) * ((x + 1) / 2) ** 3, np.sqrt(2) * 3 * ((x + 1) / 2) ** 2 * w / 2
    c, f = 1 - s * s / 2, lobe(width, 1 - s * s / 2) * s * ds
    before, p, out = np.ones_like(c), c.copy(), [np.sum(f), np.sum(f * c)]
    for l in range(1, degrees):
        before, p = p, ((2 * l + 1) * c * p - l * before) / (l + 1)
        out.append(np.sum(f * p))
    return np.array(out) / out[0]


def true_lobe(theta_v, alpha, l):
    """f NdotL = D G2 / (4 NdotV) of light directions l (..., 3), z the normal and v in the plane y = 0, on the side of -x."""
    v = np.array([-np.sin(theta_v), 0, np.cos(theta_v)])
    h = l + v
    c_h = h[..., 2] / np.linalg.norm(h, axis=-1)
    c_v, c_l = v[2], np.maximum(l[..., 2], 0)
    d = c_h ** 2 * (alpha ** 2 - 1) + 1
    root = lambda c: np.sqrt(alpha ** 2 + (1 - alpha ** 2) * c * c)
    return alpha ** 2 / (np.pi * d * d) * 0.5 / (c_v * root(c_l) + c_l * root(c_v)) * c_l


def lobes_and_spectra():
    sheet = Sheet(980, 356)
    angles = np.linspace(0, np.pi / 2, 600)
    left = Plot(sheet, 60, 44, 390, 250, (0, 90), (1e-4, 100), "Density per steradian", "angle from the axis (degrees)", ylog=True)
    left.ticks((0, 30, 60, 90), (1e-4, 1e-2, 1, 100), "{:.0e}")
    right = Plot(sheet, 550, 44, 390, 250, (1, 1000), (1e-6, 1), "Spectrum |k_l|", "degree l", xlog=True, ylog=True)
    right.ticks((1, 10, 100, 1000), (1e-6, 1e-4, 1e-2, 1), "{:.0e}")
    shown = [("GGX r = 0.1", ggx, 0.01), ("GGX r = 0.3", ggx, 0.09), ("GGX r = 1, the clamped cosine", ggx, 1), ("Charlie r = 0.5", charlie, 0.25),
             ("Phong n = 64", phong, 64)]
    for (name, lobe, width), colour in zip(shown, COLOURS):
        density = normalised(lobe, width)(angles)
        left.curve(np.degrees(angles), density, colour)
        k = np.abs(spectrum(lobe, width, 1000))
        l = np.arange(1, 1000)
        if lobe is not ggx or width == 1:  # draw what the eye follows where the signs alternate and every other one is 0
            k = np.maximum(k, np.append(k[1:], 0))
        right.curve(l, k[1:1000], colour)
    x = 60
    for (name, _, _), colour in zip(shown, COLOURS):
        sheet.line([(x, 342), (x + 18, 342)], colour, 2.5)
        sheet.text(x + 23, 342, name, 12, INK, "lm")
        x += 46 + 7 * len(name)
    sheet.save("lobes.png")


def outline(inside, thickness):
    """The pixels within `thickness` of the edge of a mask."""
    near = np.zeros_like(inside)
    for dy in range(-thickness, thickness + 1):
        for dx in range(-thickness, thickness + 1):
            if dx * dx + dy * dy <= thickness * thickness:
                near |= np.roll(inside, (dy, dx), (0, 1)) != inside
    return near


def dropped():
    """The hemisphere of light directions seen from above: where half and a tenth of the lobe's peak are."""
    sheet = Sheet(980, 372)
    alpha, size = 0.16, 1040
    x, y = np.meshgrid(np.linspace(-1.02, 1.02, size), np.linspace(1.02, -1.02, size))
    above = x * x + y * y < 1
    l = np.stack([x, y, np.sqrt(np.maximum(0, 1 - x * x - y * y))], axis=-1)
    for i, degrees in enumerate((0, 45, 75)):
        theta = np.radians(degrees)
        r = np.array([np.sin(theta), 0, np.cos(theta)])
        picture = np.full((size, size, 3), 255, np.uint8)
        picture[outline(above, 2)] = FAINT
        truth, kernel = np.where(above, true_lobe(theta, alpha, l), 0), np.where(above, ggx(alpha, l @ r), 0)
        for level, thickness in ((0.5, 4), (0.1, 2)):
            for lobe, colour in ((kernel, COLOURS[3]), (truth, COLOURS[0])):
                picture[outline(lobe > level * lobe.max(), thickness)] = colour
        left = 35 + 315 * i
        sheet.picture(left, 40, picture, 280, 280)
        sheet.text(left + 140, 12, f"v at {degrees}° from the normal", 13, bold=True, anchor="ma")
        sheet.dot(left + 140 + 140 * r[0] / 1.02, 180, 2.5)
    for x, colour, text in ((50, COLOURS[0], "what reaches the eye, f n·l"), (330, COLOURS[3], "the prefilter's lobe about r"), (610, INK, "r, the mirror direction")):
        if colour == INK:
            sheet.dot(x + 9, 352, 2.5)
        else:
            sheet.line([(x, 352), (x + 18, 352)], colour, 2.5)
        sheet.text(x + 23, 352, text, 12, INK, "lm")
    sheet.save("nvr.png")


if __name__ == "__main__":
    lobes_and_spectra()
    dropped()
