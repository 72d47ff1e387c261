#!/usr/bin/python3
"""Fits src/render/shading/stretched_fit.cpp: where nine lookups of the prefiltered chain must lie to look like the true lobe.

    stretched_fit.py [--steps N] [--from-scratch] [--out FILE]

docs/math/split-sum.md says what is minimised. Goes on from the coefficients that are there unless told otherwise; half an hour on one core from scratch.
Needs Debian's python3-numpy.
"""

import argparse
import pathlib
import re

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parents[1] / "src/render/shading/stretched_fit.cpp"
TAPS, COSINES, ROUGHNESSES = 9, 4, 5
LEVELS, DEGREE = 7, 700  # of the generic chain: GGX of roughness l / 6; harmonics
F0 = (0.04, 1.0)
NDOTV = np.array([.03, .08, .15, .22, .3, .38, .5, .65, .8, .92, 1.0])
ROUGHNESS = np.array([.08, .1, .13, .167, .2, .23, .27, .31, .36, .42, .5, .6, .72, .85, 1.0])
X, R = np.tile(NDOTV, len(ROUGHNESS)), np.repeat(ROUGHNESS, len(NDOTV))  # one cell each
degrees = np.arange(DEGREE + 1)


def lobe_nodes(cosine, alpha, count, shift):
    """Light directions (z the normal, v in the plane y = 0 on the side of -x) by visible normals, half of them (y > 0), with weights that sum to the
    split sum's A and B. Dupuy and Benyoub 2023."""
    i = np.arange(count)
    u, phi = (i + .5) / count, np.pi * np.mod(i * 0.6180339887498949 + shift, 1)
    sine = np.sqrt(1 - cosine * cosine)
    axis = np.array([-alpha * sine, cosine]) / np.hypot(alpha * sine, cosine)
    z = 1 - u * (1 + axis[1])
    s = np.sqrt(np.maximum(0, 1 - z * z))
    h = np.stack([alpha * (axis[0] + s * np.cos(phi)), alpha * s * np.sin(phi), axis[1] + z], -1)
    h /= np.linalg.norm(h, axis=-1, keepdims=True)
    v = np.array([-sine, 0, cosine])
    v_h = h @ v
    l = 2 * v_h[:, None] * h - v
    c = l[:, 2]
    root = lambda c: np.sqrt(alpha ** 2 + (1 - alpha ** 2) * c * c)
    w = np.where(c > 0, (cosine + root(cosine)) * c / (cosine * root(c) + c * root(cosine)), 0) / count  # G2 / G1
    f = (1 - np.clip(v_h, 0, 1)) ** 5
    keep = c > 0
    return l[keep], (w * (1 - f))[keep], (w * f)[keep]


def prefilter_lobe(alpha, nodes=2400):
    """1 - cos, the lobe max(c, 0) / (alpha^2 (1 + c) + 1 - c)^2 and weights dc, crowded at the peak."""
    x, w = np.polynomial.legendre.leggauss(nodes)
    if alpha < .999:
        b = 2 * alpha / np.sqrt(1 - alpha * alpha)
        most = np.arcsinh(np.sqrt(2) / b)
        s, ds = b * np.sinh((x + 1) / 2 * most), b * np.cosh((x + 1) / 2 * most) * most / 2 * w
    else:
        s, ds = (x + 1) / 2 * np.sqrt(2), w * np.sqrt(2) / 2
    c = 1 - s * s / 2
    return c, np.maximum(c, 0) / (alpha ** 2 * (1 + c) + 1 - c) ** 2, s * ds


def spectrum(alpha):
    c, k, w = prefilter_lobe(alpha)
    before, p, out = np.ones_like(c), c.copy(), [np.sum(k * w), np.sum(k * w * c)]
    for l in range(1, DEGREE):
        before, p = p, ((2 * l + 1) * c * p - l * before) / (l + 1)
        out.append(np.sum(k * w * p))
    return np.array(out) / out[0]


def level_mix(levels):
    j = np.clip(levels.astype(int), 0, LEVELS - 2)
    return j, levels - j


class Spectral:
    """The expected squared error, for environments whose harmonics have power (l + 1/2)^-p: a quadratic form of the shares, made of tables by angle."""

    def __init__(self, p):
        k = np.array([np.exp(-degrees * (degrees + 1) * .0035 ** 2 / 2)] + [spectrum((j / 6) ** 2) for j in range(1, LEVELS)])
        power = (degrees + .5) ** -p * (2 * degrees + 1) / (4 * np.pi)
        power[0] = 0  # an even sky is exact
        angle = np.linspace(0, np.pi, 4001)
        c = np.cos(angle)
        legendre = np.empty((DEGREE + 1, len(c)))
        legendre[0], legendre[1] = 1, c
        for l in range(1, DEGREE):
            legendre[l + 1] = ((2 * l + 1) * c * legendre[l] - l * legendre[l - 1]) / (l + 1)
        self.two = ((power * k[:, None] * k[None]).reshape(LEVELS * LEVELS, -1) @ legendre).reshape(LEVELS, LEVELS, -1)
        one, none = (power * k) @ legendre, power @ legendre
        by_chord = np.interp(2 * np.arcsin(np.linspace(0, 2, 4001) / 2), angle, none).astype(np.float32)
        n, self.count = len(X), 241
        self.first, self.step, self.own = np.empty(n), np.empty(n), np.empty((n, len(F0)))
        self.cross_a, self.cross_b, self.a, self.b = np.empty((n, LEVELS, self.count)), np.empty((n, LEVELS, self.count)), np.empty(n), np.empty(n)
        for i, (x, r) in enumerate(zip(X, R)):
            theta, reach = np.arccos(x), min(1.75, 14 * r * r + .02)
            l, wa, wb = lobe_nodes(x, r * r, 4096, .1)
            few, few_a, few_b = lobe_nodes(x, r * r, 384, .37)
            self.a[i], self.b[i] = wa.sum(), wb.sum()
            tilt = np.linspace(-reach, reach, self.count)
            self.first[i], self.step[i] = tilt[0], tilt[1] - tilt[0]
            at = np.arccos(np.clip(l[:, [0, 2]] @ np.stack([np.sin(theta - tilt), np.cos(theta - tilt)]), -1, 1)) * (4000 / np.pi)
            for j in range(LEVELS):
                value = np.interp(at, np.arange(4001), one[j])
                self.cross_a[i, j], self.cross_b[i, j] = wa @ value / self.a[i], wb @ value / self.b[i]
            # The lobe with itself: two sets of nodes, so that no node meets itself.
            pairs = 0
            for side in (1, -1):
                chord = np.sqrt(np.sum((few[:, None] - (l * [1, side, 1])[None]) ** 2, -1))
                pairs = pairs + np.interp(chord * 2000, np.arange(4001), by_chord) / 2
            for q, f in enumerate(F0):
                u, v = f * few_a + few_b, f * wa + wb
                self.own[i, q] = (u / u.sum()) @ (pairs @ (v / v.sum()))
        self.share = np.stack([f * self.a / (f * self.a + self.b) for f in F0], 1)
        self.split = self.errors(*split_sum())[0]
        # Split-sum is exact at a few places: errors are counted relative to it, and to 2 % of the light.
        self.floor = 4e-4 * self.own + np.maximum(0, -1.5 * self.split)

    def cross(self, table, tilt, levels):
        j, f = level_mix(levels)
        at = (tilt - self.first[:, None]) / self.step[:, None]
        a = np.clip(at.astype(int), 0, self.count - 2)
        cell = np.arange(len(tilt))[:, None]
        lower = [table[cell, j + k, a] for k in (0, 1)]
        slope = [table[cell, j + k, a + 1] - lower[k] for k in (0, 1)]
        value = [lower[k] + slope[k] * (at - a) for k in (0, 1)]
        return value[0] + (value[1] - value[0]) * f, (slope[0] * (1 - f) + slope[1] * f) / self.step[:, None], value[1] - value[0]

    def errors(self, tilt, levels, share_a, share_b):
        """Squared error of each cell and F0, and its derivatives by the four arguments."""
        j, f = level_mix(levels)
        apart = tilt[:, :, None] - tilt[:, None, :]
        at = np.abs(apart) * (4000 / np.pi)
        a = np.clip(at.astype(int), 0, 3999)
        both = by_tilt = by_level = 0
        for p in (0, 1):
            for q in (0, 1):
                w, v = (f if p else 1 - f)[:, :, None], (f if q else 1 - f)[:, None, :]
                lower, upper = (self.two[(j + p)[:, :, None], (j + q)[:, None, :], a + k] for k in (0, 1))
                value = lower + (upper - lower) * (at - a)
                both, by_tilt, by_level = both + w * v * value, by_tilt + w * v * (upper - lower), by_level + (2 * p - 1) * v * value
        by_tilt = by_tilt * np.sign(apart) * (4000 / np.pi)
        ta, tb = self.cross(self.cross_a, tilt, levels), self.cross(self.cross_b, tilt, levels)
        out = [[] for _ in range(5)]
        for q in range(len(F0)):
            h = self.share[:, q:q + 1]
            w, t = h * share_a + (1 - h) * share_b, [h * u + (1 - h) * v for u, v in zip(ta, tb)]
            row = np.einsum("nij,nj->ni", both, w)
            by_share = 2 * (row - t[0])
            for k, value in enumerate(((w * row).sum(1) - 2 * (w * t[0]).sum(1) + self.own[:, q], 2 * w * (np.einsum("nij,nj->ni", by_tilt, w) - t[1]),
                                       2 * w * (np.einsum("nij,nj->ni", by_level, w) - t[2]), by_share * h, by_share * (1 - h))):
                out[k].append(value)
        return [np.stack(v, 1) for v in out]

    def relative(self, *taps):
        out = self.errors(*taps)
        out[0] = (out[0] + self.floor) / (self.split + self.floor)
        return out, 1 / (self.split + self.floor)


class Sun:
    """The squared error of L / (1 + L) under an even sky with one small sun, over all places of the sun: it sees the lobe's tails."""

    def __init__(self, powers=(.02, .3, 5.0), sky=.3, radii=26, azimuths=20):
        self.powers, self.sky = powers, sky
        self.alpha = np.array([max((j / 6) ** 2, .008) for j in range(LEVELS)])  # the mirror level: as wide as sun and texel
        self.norm = np.array([2 * np.pi * np.sum(k * w) for _, k, w in (prefilter_lobe(a, 400) for a in self.alpha)])
        n, grid = len(X), radii * azimuths
        self.place, self.area, self.truth, self.ab = np.empty((n, grid, 2), np.float32), np.empty((n, grid)), np.empty((n, grid, 2)), np.empty((n, 2))
        for i, (x, r) in enumerate(zip(X, R)):
            alpha, sine = r * r, np.sqrt(1 - x * x)
            self.ab[i] = [w.sum() for w in lobe_nodes(x, alpha, 4096, .1)[1:]]
            # Polar about the mirror direction, crowded there and along the plane of incidence.
            narrow, wide = max(alpha * min(1, 2 * x + .05), .004), max(.15 * np.sqrt(x) + .3 * x, .03)
            u, du = np.arcsinh(2.2 / narrow), np.arcsinh(2.2 / narrow) / radii / 2
            middle = (np.arange(radii) + .5) / radii * u
            t, ring = narrow * np.sinh(middle), np.cos(narrow * np.sinh(middle - du)) - np.cos(narrow * np.sinh(middle + du))
            v, half = np.arcsinh(np.pi / 2 / wide), azimuths // 2
            middle, dv = (np.arange(half) + .5) / half * v, v / half / 2
            p, sector = wide * np.sinh(middle), wide * (np.sinh(middle + dv) - np.sinh(middle - dv))
            p, sector = np.concatenate([p, np.pi - p[::-1]]), np.concatenate([sector, sector[::-1]])
            t, p = np.meshgrid(t, p, indexing="ij")
            ahead, up, aside = np.cos(t).ravel(), (np.sin(t) * np.cos(p)).ravel(), (np.sin(t) * np.sin(p)).ravel()
            self.place[i, :, 0], self.place[i, :, 1], self.area[i] = ahead, up, (2 * ring[:, None] * sector[None]).ravel()
            l = np.stack([ahead * sine - up * x, aside, ahead * x + up * sine], -1)
            h = l + np.array([-sine, 0, x])
            across, along, c = h[:, 0] ** 2 + h[:, 1] ** 2, h[:, 2] ** 2, np.maximum(l[:, 2], 0)
            root = lambda c: np.sqrt(alpha ** 2 + (1 - alpha ** 2) * c * c)
            d = alpha ** 2 / np.pi * ((across + along) / (across + alpha ** 2 * along)) ** 2
            light, f = d * .5 / (x * root(c) + c * root(x) + 1e-9) * c, (1 - np.clip(np.sqrt(across + along) / 2, 0, 1)) ** 5
            self.truth[i, :, 0], self.truth[i, :, 1] = light * (1 - f), light * f
        self.weight = None
        self.weight = 1 / np.array(self.errors(*split_sum()))  # [F0][power][cell]

    def kernel(self, j, c):
        a2, norm = (self.alpha[j] ** 2)[:, None].astype(np.float32), self.norm[j][:, None].astype(np.float32)
        inverse = 1 / (a2 * (1 + c) + 1 - c)
        k = np.maximum(c, 0) * inverse * inverse / norm
        return k, np.where(c > 0, inverse * inverse / norm - 2 * k * inverse * (a2 - 1), 0)

    def errors(self, tilt, levels, share_a, share_b):
        j, f = level_mix(levels)
        f = f[:, None].astype(np.float32)
        cos, sin = np.cos(tilt)[:, None].astype(np.float32), np.sin(tilt)[:, None].astype(np.float32)
        ahead, up = self.place[:, :, :1], self.place[:, :, 1:]
        (k0, d0), (k1, d1) = (self.kernel(j + q, ahead * cos + up * sin) for q in (0, 1))
        k, by_tilt, by_level = k0 + (k1 - k0) * f, (d0 + (d1 - d0) * f) * (up * cos - ahead * sin), k1 - k0
        plain, out = [], [[] for _ in range(5)]
        for q, f0 in enumerate(F0):
            a, b = f0 * self.ab[:, :1], self.ab[:, 1:]
            w = a * share_a + b * share_b
            truth, mine, sky = f0 * self.truth[:, :, 0] + self.truth[:, :, 1], np.einsum("ngt,nt->ng", k, w), self.sky * (a + b)
            sums, total, slope = [], 0, 0
            for s, power in enumerate(self.powers):
                shown = sky + power * mine
                difference = shown / (1 + shown) - (sky + power * truth) / (1 + sky + power * truth)
                sums.append((difference ** 2 * self.area).sum(1))
                if self.weight is not None:
                    scale = self.weight[q, s] / len(self.powers)
                    total, slope = total + sums[-1] * scale, slope + 2 * difference * self.area * power / (1 + shown) ** 2 * scale[:, None]
            plain.append(sums)
            if self.weight is not None:
                by_share = np.einsum("ngt,ng->nt", k, slope)
                for m, value in enumerate((total, w * np.einsum("ngt,ng->nt", by_tilt, slope), w * np.einsum("ngt,ng->nt", by_level, slope), by_share * a, by_share * b)):
                    out[m].append(value)
        return plain if self.weight is None else [np.stack(v, 1) for v in out]

    def relative(self, *taps):
        return self.errors(*taps), np.ones((len(X), len(F0)))


def split_sum():
    one = np.ones((len(X), 1))
    return 0 * one, 6 * R[:, None], one, one


FEATURES = np.stack([np.sqrt(X) ** i * R ** j for i in range(COSINES) for j in range(ROUGHNESSES)], -1)


def taps_of(p):
    """What stretched_taps() makes of the coefficients (terms, TAPS, 4), and the derivatives of tilt and level by theirs."""
    raw = (FEATURES @ p.reshape(len(FEATURES[0]), -1)).reshape(len(X), TAPS, 4)
    wide, most = (2 * R ** 2 * np.sqrt(1 - X ** 2))[:, None], np.minimum(1.7, 14 * R ** 2 + .015)[:, None]
    tilt, least = wide * raw[..., 0], np.clip(10 * R - 1, 0, 1)[:, None]
    above = 6 * R[:, None] * raw[..., 1] - least
    root = np.sqrt(above ** 2 + (.05 * least) ** 2 + 1e-9)
    level = least + .5 * (above + root)
    shares = np.exp(raw[..., 2:] - raw[..., 2:].max(1, keepdims=True))
    shares /= shares.sum(1, keepdims=True)
    return (np.clip(tilt, -most, most), np.clip(level, 0, 6), shares[..., 0], shares[..., 1]), wide * (np.abs(tilt) < most), 3 * R[:, None] * (level < 6) * (1 + above / root)


def loss(p, parts):
    """Mean over the cells of the error relative to split-sum's, with its fourth power against single bad ones; and the gradient."""
    taps, by_tilt, by_level = taps_of(p)
    cell = np.where(X < .4, 2, 1) * np.where((R >= .1) & (R <= .6), 2, .5) * np.where((R > .15) & (R < .3), 1.5, 1)
    cell = (cell / cell.sum())[:, None]
    total, gradient = 0, np.zeros((len(X), TAPS, 4))
    for part, weight in parts:
        (y, *slopes), scale = part.relative(*taps)
        total += weight * (cell * (y + .5 * y ** 4)).sum() / 2
        scale = (weight * cell * (1 + 2 * y ** 3) * scale / 2)[:, :, None]
        sums = [(scale * s).sum(1) for s in slopes]
        gradient[..., 0] += sums[0] * by_tilt
        gradient[..., 1] += sums[1] * by_level
        for k in (2, 3):
            gradient[..., k] += taps[k] * (sums[k] - (taps[k] * sums[k]).sum(1, keepdims=True))
    return total, (FEATURES.T @ gradient.reshape(len(X), -1)).reshape(p.shape)


def fan():
    """To start from: a fan of lobes along the plane of incidence."""
    at = np.linspace(-1, 1, TAPS)
    at = np.sign(at) * np.abs(at) ** 1.5 * np.where(at < 0, .8, 2)
    raw = np.empty((len(X), TAPS, 4))
    raw[..., 0] = at
    raw[..., 1] = (np.sqrt(X[:, None]) * .7 + .3) * (.7 + .3 * np.abs(at))
    raw[..., 2:] = (-2 * np.abs(np.linspace(-1, 1, TAPS)) ** 1.5)[None, :, None]
    return np.linalg.lstsq(FEATURES, raw.reshape(len(X), -1), rcond=None)[0].reshape(-1, TAPS, 4)


def read():
    numbers = re.search(r"= \{(.*)\};", SOURCE.read_text(), re.S).group(1)
    return np.array([float(v) for v in re.findall(r"-?\d[\d.e+-]*", numbers)]).reshape(TAPS, 4, -1).transpose(2, 0, 1)


def write(p, file):
    number = lambda v: (lambda s: s + "f" if "." in s or "e" in s else s + ".f")(f"{v:.5g}")
    taps = ",\n".join("    {" + ",\n     ".join("{" + ", ".join(number(v) for v in p[:, t, k]) + "}" for k in range(4)) + "}" for t in range(TAPS))
    file.write_text("// Written by docs/figures/stretched_fit.py: not to be edited by hand.\n\n#include \"render/shading/stretched_lobe.h\"\n\nnamespace domelight {\n\n// clang-format off\n"
                    "const float k_stretched_fit[k_stretched_taps][4][k_stretched_cosines * k_stretched_roughnesses] = {\n" + taps
                    + "};\n// clang-format on\n\n}  // namespace domelight\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--steps", type=int, default=500)
    parser.add_argument("--rate", type=float, default=.01)
    parser.add_argument("--from-scratch", action="store_true")
    parser.add_argument("--out", type=pathlib.Path, default=SOURCE)
    o = parser.parse_args()
    parts = [(Sun(), 1), (Spectral(2), .5), (Spectral(3), .5)]
    p = fan() if o.from_scratch else read()
    mean, square, least, best = 0, 0, np.inf, p
    for step in range(o.steps):  # Adam (Kingma and Ba 2015)
        value, gradient = loss(p, parts)
        if value < least:
            least, best = value, p
        mean, square = .9 * mean + .1 * gradient, .995 * square + .005 * gradient ** 2
        rate = o.rate * min(1, (step + 1) / 20) * .02 ** (step / o.steps)
        p = p - rate * mean / (1 - .9 ** (step + 1)) / (np.sqrt(square / (1 - .995 ** (step + 1))) + 1e-12)
        if step % 50 == 0:
            print(step, value, flush=True)
            write(best, o.out)
    write(best, o.out)


if __name__ == "__main__":
    main()
