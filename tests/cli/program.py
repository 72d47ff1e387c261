"""Runs the program, which DOMELIGHT_PROGRAM names, and makes files for the tests of it."""

import base64
import hashlib
import json
import math
import os
import signal
import struct
import subprocess
import zlib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("DOMELIGHT_PROGRAM", str(ROOT / "build/dev/cli/domelight"))
SMALL = ["--size", "16", "--irradiance-size", "4", "--brdf-size", "16", "--no-preview"]
TINY = ["--width", "16", "--height", "12", "--spp", "4"]


def run(*words, folder, code=0, env=None, **options):
    """Runs `domelight WORDS` in `folder`; the exit status must be `code`."""
    result = subprocess.run([PROGRAM, *map(str, words)], cwd=folder, capture_output=True, text=True, timeout=300,
                            env={**os.environ, **(env or {})}, **options)
    assert result.returncode == code, f"{words}: exit {result.returncode}, not {code}\n{result.stdout}{result.stderr}"
    return result


def launch(*words, folder, **options):
    """Starts `domelight WORDS`, which SIGINT ends even where this program itself was started with that signal ignored, as in the background of a script."""
    return subprocess.Popen([PROGRAM, *words], cwd=folder, stdout=subprocess.DEVNULL, preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL), **options)


def files_of(folder):
    """Relative name -> SHA-256 of every file below."""
    return {str(p.relative_to(folder)): hashlib.sha256(p.read_bytes()).hexdigest() for p in sorted(Path(folder).rglob("*")) if p.is_file()}


def manifest_of(folder):
    return json.loads((Path(folder) / "manifest.json").read_text())


def make_glb():
    """A tetrahedron with two cameras: "front", square, and "wide", twice as wide as high."""
    corners = [(0, 1, 0), (-1, -1, 1), (1, -1, 1), (0, -1, -1)]
    faces = [0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2]
    buffer = b"".join(struct.pack("<3f", *c) for c in corners) + struct.pack("<12H", *faces)
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
        "nodes": [{"mesh": 0, "name": "tetrahedron"}, {"camera": 0, "translation": [0, 0, 5], "name": "front"},
                  {"camera": 1, "translation": [0.5, 0, 6], "name": "wide"}],
        "cameras": [{"type": "perspective", "name": name, "perspective": {"yfov": 0.8, "aspectRatio": aspect, "znear": 0.1}}
                    for name, aspect in [("front", 1), ("wide", 2)]],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "buffers": [{"byteLength": len(buffer)}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, -1, -1], "max": [1, 1, 1]},
                      {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(buffer), 0x004E4942) + buffer
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def make_square(tilt):
    """A glTF document of a matte square of side 20 about the origin that looks up, tilted about X towards +Z by `tilt` radians. Its albedo is 0.8."""
    corners = [(-10, 0, 10), (10, 0, 10), (10, 0, -10), (-10, 0, -10)]
    buffer = b"".join(struct.pack("<3f", *c) for c in corners) + struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    return {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "rotation": [math.sin(tilt / 2), 0, 0, math.cos(tilt / 2)]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.8, 0.8, 1]}, "extras": {"lambert": True}}],
        "buffers": [{"byteLength": len(buffer), "uri": "data:application/octet-stream;base64," + base64.b64encode(buffer).decode()}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-10, 0, -10], "max": [10, 0, 10]},
                      {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
    }


def png_of(file):
    """(width, height, channels, bytes) of an 8-bit PNG."""
    data, at, packed = file.read_bytes(), 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", body[:10])
        packed += body if kind == b"IDAT" else b""
        at += 12 + size
    channels = {0: 1, 2: 3, 6: 4}[colour]
    raw, stride, rows, above = zlib.decompress(packed), channels * width, bytearray(), bytearray(channels * width)
    for y in range(height):
        kind, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            a, b, c = line[i - channels] if i >= channels else 0, above[i], above[i - channels] if i >= channels else 0
            p = a + b - c
            paeth = a if abs(p - a) <= min(abs(p - b), abs(p - c)) else b if abs(p - b) <= abs(p - c) else c
            line[i] = (line[i] + [0, a, b, (a + b) // 2, paeth][kind]) & 255
        rows += line
        above = line
    assert depth == 8
    return width, height, channels, bytes(rows)


def make_exr(width, height, special):
    """A scanline EXR without compression, float RGB of 0.5, `special` values in the red channel by texel number."""
    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value

    channels = b"".join(c.encode() + b"\0" + struct.pack("<iiii", 2, 0, 1, 1) for c in "BGR") + b"\0"
    window = struct.pack("<iiii", 0, 0, width - 1, height - 1)
    header = struct.pack("<ii", 20000630, 2) + attribute("channels", "chlist", channels) + attribute("compression", "compression", b"\0")
    header += attribute("dataWindow", "box2i", window) + attribute("displayWindow", "box2i", window) + attribute("lineOrder", "lineOrder", b"\0")
    header += attribute("pixelAspectRatio", "float", struct.pack("<f", 1)) + attribute("screenWindowCenter", "v2f", struct.pack("<ff", 0, 0))
    header += attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0"
    line = 8 + 12 * width
    table = b"".join(struct.pack("<Q", len(header) + 8 * height + y * line) for y in range(height))
    rows = b""
    for y in range(height):
        red = [special.get(y * width + x, 0.5) for x in range(width)]
        rows += struct.pack("<ii", y, 12 * width) + struct.pack(f"<{width}f", *[0.5] * width) * 2 + struct.pack(f"<{width}f", *red)
    return header + table + rows
