#!/usr/bin/env python3
"""Writes src/image/font_glyphs.h: the glyph bitmaps that the contact sheet and the axes environment are lettered with.

    python3 docs/figures/make_font.py /usr/share/fonts/truetype/dejavu src/image/font_glyphs.h

Needs Pillow; the build does not need this script, its output is committed.
"""
import math
import sys

from PIL import Image, ImageDraw, ImageFont

TEXT = [chr(c) for c in range(32, 127)] + list("°²·×απ–−…→↓\ufffd")
FACES = [("small", "DejaVuSans.ttf", 15), ("large", "DejaVuSans-Bold.ttf", 24)]
SDF_TEXT, SDF_SIZE, SDF_RANGE = "+-XYZ", 36, 5  # distances of +-5 px at a nominal size of 36 px

HEAD = """#pragma once
// Made by docs/figures/make_font.py from DejaVu Sans 2.37; do not edit.
//
// The outlines are DejaVu's (https://dejavu-fonts.github.io): Bitstream Vera is Copyright (c) 2003 by Bitstream, Inc.;
// DejaVu changes are in public domain. The licence permits use, copying, merging, embedding and distribution of the
// font and of documents made with it.

#include <cstdint>

namespace domelight::font_data {

/// A glyph's box relative to the pen: `left` to the right, `top` above the baseline. `bits`: one hexadecimal digit a
/// pixel (0 none, f full).
struct Glyph {
    std::uint16_t code;
    std::int8_t left, top;
    std::uint8_t width, height, advance;
    const char* bits;
};

"""


def glyph(font, char):
    ascent, _ = font.getmetrics()
    box = font.getbbox(char)
    left, top, right, bottom = box if box[2] > box[0] else (0, 0, 0, 0)
    image = Image.new("L", (max(1, right - left), max(1, bottom - top)), 0)
    ImageDraw.Draw(image).text((-left, -top), char, font=font, fill=255)
    width, height = right - left, bottom - top
    bits = "".join(f"{round(v / 17):x}" for v in image.tobytes()) if width and height else ""
    return left, ascent - top, width, height, round(font.getlength(char)), bits


def distance_field(path, char):
    """Signed distances to the outline, positive inside, on a grid at SDF_SIZE px, from a rendering 8 times as large."""
    scale = 8
    font = ImageFont.truetype(path, SDF_SIZE * scale)
    pad = SDF_RANGE
    left, top, right, bottom = font.getbbox(char)
    ascent, _ = font.getmetrics()
    x0, y0 = math.floor(left / scale) - pad, math.floor(top / scale) - pad
    width, height = math.ceil(right / scale) + pad - x0, math.ceil(bottom / scale) + pad - y0
    big = Image.new("L", (width * scale, height * scale), 0)
    ImageDraw.Draw(big).text((-x0 * scale, -y0 * scale), char, font=font, fill=255)
    inside = [[big.getpixel((x, y)) > 127 for x in range(width * scale)] for y in range(height * scale)]
    edge = [(x, y) for y in range(1, height * scale - 1) for x in range(1, width * scale - 1)
            if inside[y][x] and not (inside[y][x - 1] and inside[y][x + 1] and inside[y - 1][x] and inside[y + 1][x])]
    bits = ""
    for y in range(height):
        for x in range(width):
            cx, cy = (x + 0.5) * scale - 0.5, (y + 0.5) * scale - 0.5
            d = math.sqrt(min((cx - ex) ** 2 + (cy - ey) ** 2 for ex, ey in edge)) / scale
            d = d if inside[int(cy)][int(cx)] else -d
            bits += f"{max(0, min(255, round(127.5 + 127.5 * d / SDF_RANGE))):02x}"
    return x0, ascent / scale - y0, width, height, font.getlength(char) / scale, bits


def main():
    folder, target = sys.argv[1:]
    out = [HEAD]
    for name, file, size in FACES:
        font = ImageFont.truetype(f"{folder}/{file}", size)
        ascent, descent = font.getmetrics()
        out.append(f"inline constexpr int k_{name}_ascent = {ascent}, k_{name}_descent = {descent};\n")
        out.append(f"inline constexpr Glyph k_{name}[] = {{\n")
        for char in sorted(TEXT, key=ord):
            left, top, width, height, advance, bits = glyph(font, char)
            out.append(f'    {{{ord(char)}, {left}, {top}, {width}, {height}, {advance}, "{bits}"}},\n')
        out.append("};\n\n")
    out.append("/// A glyph as signed distances to its outline, positive inside: two hexadecimal digits a sample, 127.5 on the outline.\n")
    out.append("struct FieldGlyph {\n    char code;\n    float left, top;\n    std::uint8_t width, height;\n    float advance;\n    const char* field;\n};\n\n")
    out.append(f"inline constexpr float k_field_size = {SDF_SIZE}, k_field_range = {SDF_RANGE};\n")
    out.append("inline constexpr FieldGlyph k_field[] = {\n")
    for char in SDF_TEXT:
        # The minus sign, as wide as the plus, in place of the hyphen.
        left, top, width, height, advance, bits = distance_field(f"{folder}/DejaVuSans-Bold.ttf", char.replace("-", "−"))
        out.append(f"    {{'{char}', {left}, {top}, {width}, {height}, {advance}, \"{bits}\"}},\n")
    out.append("};\n\n}  // namespace domelight::font_data\n")
    open(target, "w").write("".join(out))


main()
