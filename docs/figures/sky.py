#!/usr/bin/env python3
"""Draws docs/figures/sky.png: the sky over the sun's elevation and the turbidity, each exposed to its own log-average luminance."""

import numpy as np
from PIL import Image

import pictures

ELEVATIONS, TURBIDITIES, HEIGHT = (60, 30, 10, 3, -4), (2, 3, 6), 160


def agx(rgb):
    """AgX with the punchy look, as src/preview/tonemap.cpp has it; 8 bits."""
    inset = np.array([[0.842479062, 0.0784336, 0.0792237451], [0.0423282422, 0.878468636, 0.0791661275], [0.0423756549, 0.0784336, 0.879142974]])
    outset = np.array([[1.196879005, -0.0980208811, -0.0990297441], [-0.0528968518, 1.15190313, -0.0989611768], [-0.0529716355, -0.0980434501, 1.15107367]])
    x = np.clip((np.log2(np.maximum(rgb @ inset.T, 1e-10)) + 12.47393) / (12.47393 + 4.026069), 0, 1)
    v = np.maximum(np.polyval([15.5, -40.14, 31.96, -6.868, 0.4298, 0.1191, -0.00232], x), 0) ** 1.35
    grey = (v @ [0.2126, 0.7152, 0.0722])[..., None]
    return pictures.srgb(np.clip((grey + 1.4 * (v - grey)) @ outset.T, 0, 1) ** 2.2)


def main():
    sheet = pictures.Sheet(len(TURBIDITIES) * (2 * HEIGHT + 8) + 8, len(ELEVATIONS) * (HEIGHT + 26) + 8)
    for i, elevation in enumerate(ELEVATIONS):
        for j, turbidity in enumerate(TURBIDITIES):
            sky = pictures.made_by_domelight("sky", "--height", str(2 * HEIGHT), "--sun-azimuth-deg", "0", "--sun-elevation-deg", str(elevation),
                                             "--turbidity", str(turbidity))
            luminance = np.maximum(sky @ [0.2126, 0.7152, 0.0722], 1e-12)
            weights = np.sin(np.pi * (np.arange(sky.shape[0]) + 0.5) / sky.shape[0])[:, None] * np.ones(sky.shape[1])
            average = np.exp(np.average(np.log(luminance), weights=weights))
            x, y = 8 + j * (2 * HEIGHT + 8), 8 + i * (HEIGHT + 26)
            sheet.picture(x, y, agx(sky * 0.18 / average), 2 * HEIGHT, HEIGHT)
            sheet.text(x, y + HEIGHT + 3, f"sun {elevation}°, turbidity {turbidity}")
    sheet.save("sky.png", colours=0)


main()
