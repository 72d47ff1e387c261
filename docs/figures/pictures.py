"""What the figure scripts share: reading the program's .hdr and .exr outputs, tone mapping, and drawing with text.

Needs Debian's python3-numpy, python3-pil and fonts-dejavu-core. The scripts are run by hand when a figure must change; the pictures are committed.
"""

import os
import pathlib
import struct
import subprocess
import tempfile
import zlib

import numpy as np
from PIL import Image, ImageDraw, ImageFont

HERE = pathlib.Path(__file__).resolve().parent
PROGRAM = os.environ.get("DOMELIGHT_PROGRAM", str(HERE.parents[1] / "build/release/cli/domelight"))

INK, FAINT, PAPER = (30, 34, 40), (150, 156, 164), (255, 255, 255)


def made_by_domelight(*arguments, ending=".hdr"):
    """The image (H, W, 3) float32 that `domelight ARGUMENTS -o FILE` writes."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "image" + ending)
        subprocess.run([PROGRAM, *arguments, "-o", file], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return read_hdr(file) if ending == ".hdr" else read_exr(file)


def read_hdr_rgbe(file):
    """The bytes (H, W, 4) of a Radiance picture: flat or with the new run-length encoding, top row first."""
    data = pathlib.Path(file).read_bytes()
    at = data.index(b"\n\n") + 2
    end = data.index(b"\n", at)
    _, height, _, width = data[at:end].split()
    height, width, at = int(height), int(width), end + 1
    if len(data) - at == height * width * 4:
        return np.frombuffer(data, np.uint8, offset=at).reshape(height, width, 4)
    rgbe = np.zeros((height, 4, width), np.uint8)
    for row in rgbe:
        at += 4
        for channel in row:
            x = 0
            while x < width:
                count = data[at]
                if count > 128:
                    channel[x:x + count - 128] = data[at + 1]
                    x, at = x + count - 128, at + 2
                else:
                    channel[x:x + count] = np.frombuffer(data, np.uint8, count, at + 1)
                    x, at = x + count, at + 1 + count
    return rgbe.transpose(0, 2, 1)


def read_hdr(file):
    rgbe = read_hdr_rgbe(file)
    return (rgbe[..., :3] * np.exp2(rgbe[..., 3:].astype(np.float32) - 136)).astype(np.float32)


def read_exr(file):
    """RGB (H, W, 3) float32 of a scanline OpenEXR image of half or float channels, uncompressed or ZIP."""
    data = pathlib.Path(file).read_bytes()
    at, header = 8, {}
    while data[at]:
        name, kind = (data[at:].split(b"\0", 2) + [b""])[:2]
        at += len(name) + len(kind) + 2
        size, = struct.unpack_from("<i", data, at)
        header[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    x0, y0, x1, y1 = struct.unpack("<4i", header[b"dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    channels, listed = [], header[b"channels"]
    while listed[0]:
        name, rest = listed.split(b"\0", 1)
        channels.append((name.decode(), {1: np.float16, 2: np.float32}[struct.unpack_from("<i", rest)[0]]))
        listed = rest[16:]
    block = {0: 1, 2: 1, 3: 16}[header[b"compression"][0]]
    offsets = struct.unpack_from(f"<{-(-height // block)}Q", data, at + 1)
    row_bytes = sum(np.dtype(kind).itemsize for _, kind in channels) * width
    out = {name: np.zeros((height, width), np.float32) for name, _ in channels}
    for offset in offsets:
        y, size = struct.unpack_from("<ii", data, offset)
        raw, rows = data[offset + 8:offset + 8 + size], min(block, height - (y - y0))
        if size < rows * row_bytes:
            delta = np.frombuffer(zlib.decompress(raw), np.uint8).astype(np.int64)
            delta[1:] -= 128
            halves = np.cumsum(delta).astype(np.uint8)
            raw = np.empty_like(halves)
            middle = (len(raw) + 1) // 2
            raw[0::2], raw[1::2] = halves[:middle], halves[middle:]
            raw = raw.tobytes()
        for row in range(rows):
            start = row * row_bytes
            for name, kind in channels:
                out[name][y - y0 + row] = np.frombuffer(raw, kind, width, start)
                start += np.dtype(kind).itemsize * width
    return np.stack([out[c] for c in "RGB"], axis=-1)


def srgb(linear):
    """Linear radiance to 8-bit sRGB, clipped at 1."""
    x = np.clip(linear, 0, 1)
    return (255 * np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.maximum(x, 1e-8) ** (1 / 2.4) - 0.055) + 0.5).astype(np.uint8)


def font(size, bold=False):
    return ImageFont.truetype("DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf", size)


class Sheet:
    """A white page to draw on, at twice the size for smooth lines. Coordinates are those of the finished picture."""

    SCALE = 2

    def __init__(self, width, height):
        self.image = Image.new("RGB", (width * self.SCALE, height * self.SCALE), PAPER)
        self.draw = ImageDraw.Draw(self.image)

    def _up(self, points):
        return [(x * self.SCALE, y * self.SCALE) for x, y in points]

    def text(self, x, y, text, size=13, colour=INK, anchor="la", bold=False):
        self.draw.text((x * self.SCALE, y * self.SCALE), text, colour, font(size * self.SCALE, bold), anchor)

    def line(self, points, colour=INK, width=1.5):
        self.draw.line(self._up(points), colour, round(width * self.SCALE), joint="curve")

    def arrow(self, tail, head, colour=INK, width=1.5, size=7):
        self.line([tail, head], colour, width)
        d = np.subtract(head, tail) / np.hypot(*np.subtract(head, tail))
        side = np.array([-d[1], d[0]])
        tip = [head, np.array(head) - size * d + size * 0.45 * side, np.array(head) - size * d - size * 0.45 * side]
        self.draw.polygon(self._up(tip), colour)

    def dot(self, x, y, radius=3, colour=INK):
        s = self.SCALE
        self.draw.ellipse([(x - radius) * s, (y - radius) * s, (x + radius) * s, (y + radius) * s], colour)

    def box(self, x, y, width, height, colour=FAINT, line=1, fill=None):
        s = self.SCALE
        self.draw.rectangle([x * s, y * s, (x + width) * s, (y + height) * s], fill, colour, round(line * s))

    def picture(self, x, y, pixels, width, height, smooth=True):
        """8-bit pixels (H, W, 3) at a place; `smooth` False shows the texels."""
        how = Image.Resampling.LANCZOS if smooth else Image.Resampling.NEAREST
        resized = Image.fromarray(pixels).resize((round(width * self.SCALE), round(height * self.SCALE)), how)
        self.image.paste(resized, (round(x * self.SCALE), round(y * self.SCALE)))

    def _finished(self):
        return self.image.resize((self.image.width // self.SCALE, self.image.height // self.SCALE), Image.Resampling.LANCZOS)

    def save_jpeg(self, name, quality=88):
        """Writes NAME into this script's folder, for sheets of photographs and of smooth gradients, which a palette would turn into bands."""
        self._finished().save(HERE / name, quality=quality, optimize=True)

    def save(self, name, colours=256):
        """Writes NAME into this script's folder, as a palette picture (a third of the bytes)."""
        small = self._finished()
        if colours:
            small = small.quantize(colours, dither=Image.Dither.NONE)
        small.save(HERE / name, optimize=True)
