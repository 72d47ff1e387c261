#!/usr/bin/python3
"""Draws the figure of docs/hdr.md and prints its table: one sky, with its sun, stored as PNG, RGBE, half and float."""

import numpy as np

from pictures import FAINT, INK, PROGRAM, Sheet, made_by_domelight, srgb

SKY = ["sky", "--height", "512", "--sun-elevation-deg", "35", "--turbidity", "3"]
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def stored_as_png(sky, exposure):
    """8-bit sRGB and back: what a photograph's file keeps of `sky`, exposed so that the sky fits."""
    code = srgb(sky * exposure).astype(float) / 255
    return np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4) / exposure


def stored_as_half(sky):
    return np.minimum(sky, 65504).astype(np.float16).astype(np.float32)


def solid_angles(height, width):
    edges = np.cos(np.arange(height + 1) / height * np.pi)
    return np.repeat((edges[:-1] - edges[1:])[:, None] * 2 * np.pi / width, width, axis=1)


def irradiance_up(image):
    """E (3) of a level surface that faces up: the sum over the texels of the upper half."""
    height, width, _ = image.shape
    cosine = np.maximum(np.cos((np.arange(height) + 0.5) / height * np.pi), 0)
    return ((solid_angles(height, width) * cosine[:, None])[..., None] * image).sum(axis=(0, 1))


def main():
    sky = made_by_domelight(*SKY, "--exr", "float", ending=".exr")
    rgbe = made_by_domelight(*SKY)
    height, width, _ = sky.shape
    brightness = sky @ LUMINANCE
    exposure = 0.3 / np.median(brightness[: height // 2])
    stored = {"PNG, 8 bit": stored_as_png(sky, exposure), "RGBE (.hdr)": rgbe, "half": stored_as_half(sky), "float": sky}

    j, i = np.unravel_index(np.argmax(brightness), brightness.shape)
    around_sun = (slice(max(j - 12, 0), j + 12), slice(max(i - 24, 0), i + 24))
    # A smooth piece of sky away from the sun.
    far = (i + width // 2) % width
    calm = (slice(height // 6, height // 6 + 40), slice(far - 40 if far > 80 else far, (far - 40 if far > 80 else far) + 80))

    wide, high, left, top = 224, 112, 110, 46
    sheet = Sheet(left + 4 * (wide + 10) + 6, top + 4 * (high + 14))
    rows = ["as seen", "the sun,\n14 stops\ndarker", "calm sky,\ncontrast\n× 60", "error,\nblack 0 to\nwhite 1 %"]
    for n, text in enumerate(rows):
        sheet.text(12, top + n * (high + 14) + 6, text, 12)
    calm_mean = sky[calm].mean(axis=(0, 1))
    print(f"{'':12} {'largest':>10} {'most error, sky':>16} {'E kept':>9}")
    brightest = sky.max(axis=-1) * exposure
    in_range = (brightest < 1) & (brightest > 0.02)
    for n, (name, image) in enumerate(stored.items()):
        x = left + n * (wide + 10)
        sheet.text(x, top - 24, name, 14, INK, bold=True)
        error = np.abs(image - sky).max(axis=-1) / np.maximum(sky.max(axis=-1), 1e-20)
        # The planes carry a little of the slope out, so that steps show.
        slope = np.linalg.lstsq(np.stack([np.ones(3200), *np.mgrid[0:40, 0:80].reshape(2, -1)], 1), sky[calm].reshape(-1, 3), rcond=None)[0]
        plane = (np.stack([np.ones(3200), *np.mgrid[0:40, 0:80].reshape(2, -1)], 1) @ slope).reshape(40, 80, 3)
        contrast = 0.5 + 60 * (image[calm] - plane) / calm_mean * 0.5
        pictures = [srgb(image * exposure), srgb(image[around_sun] * exposure * 2.0**-14), np.clip(255 * contrast, 0, 255).astype(np.uint8),
                    np.repeat(np.clip(25500 * error[..., None], 0, 255).astype(np.uint8), 3, axis=-1)]
        for row, picture in enumerate(pictures):
            y = top + row * (high + 14)
            sheet.picture(x, y, picture, wide, high, smooth=row == 0)
            sheet.box(x, y, wide, high, FAINT)
        kept = (irradiance_up(image) @ LUMINANCE) / (irradiance_up(sky) @ LUMINANCE)
        print(f"{name:12} {image.max():10.4g} {error[in_range].max():16.2g} {kept:9.4f}")
    sheet.save("hdr.png", colours=0)  # a palette would add bands of its own
    print(f"the sun is {brightness.max() / np.median(brightness[: height // 2]):.3g} times the median of the sky; program: {PROGRAM}")


if __name__ == "__main__":
    main()
