"""Synthetic hostile files: headers with wrong sizes, cut-off data, and files that are not images. All are small, and all must be refused."""

import base64
import json
import struct
import zlib

HUGE = 100_000


def radiance(resolution, data=b"", header=b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n"):
    return header + resolution.encode() + b"\n" + data


def run_length_row(width, byte=128):
    """A new-style row of `width` equal texels."""
    row = b"\x02\x02" + struct.pack(">H", width)
    for _ in range(4):
        left = width
        while left:
            count = min(left, 127)
            row += bytes([128 + count, byte])
            left -= count
    return row


def exr(x_max, y_max, x_min=0, y_min=0, data=b"", version=2, channels=b"BGR", compression=0, display=None):
    def attribute(name, kind, value):
        return name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value

    box = struct.pack("<4i", x_min, y_min, x_max, y_max)
    channel_list = b"".join(bytes([c]) + b"\0" + struct.pack("<iB3xii", 1, 0, 1, 1) for c in channels) + b"\0"
    return (struct.pack("<II", 20000630, version)
            + attribute(b"channels", b"chlist", channel_list)
            + attribute(b"compression", b"compression", bytes([compression]))
            + attribute(b"dataWindow", b"box2i", box)
            + attribute(b"displayWindow", b"box2i", struct.pack("<4i", *display) if display else box)
            + attribute(b"lineOrder", b"lineOrder", b"\0")
            + attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1))
            + attribute(b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0))
            + attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1))
            + b"\0" + data)


def png(width, height, data=b"", bits=8, colour=2):
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, bits, colour, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(data)) + chunk(b"IEND", b""))


def jpeg(width, height):
    return (b"\xff\xd8\xff\xe0\x00\x10JFIF\0\x01\x01\0\0\x01\0\x01\0\0"
            + b"\xff\xc0\x00\x11\x08" + struct.pack(">HH", height, width) + b"\x03\x01\x22\0\x02\x11\1\x03\x11\1" + b"\xff\xd9")


def ktx2(width, height, faces=6, levels=1, vk_format=97, supercompression=0, level=(80 + 24, 8, 8), extra=b""):
    return (b"\xabKTX 20\xbb\r\n\x1a\n" + struct.pack("<9I", vk_format, 2, width, height, 0, 0, faces, levels, supercompression)
            + struct.pack("<4I2Q", 0, 0, 0, 0, 0, 0) + struct.pack("<3Q", *level) + extra)


def ktx1(width, height, faces=6, levels=1, key_values=0, image_size=0):
    return (b"\xabKTX 11\xbb\r\n\x1a\n"
            + struct.pack("<13I", 0x04030201, 0x140B, 2, 0x1908, 0x881A, 0x1908, width, height, 0, 0, faces, levels, key_values)
            + struct.pack("<I", image_size))


def dds(width, height, levels=1, dxgi=10, misc=4, array=1):
    head = struct.pack("<4s7I44x", b"DDS ", 124, 0x2100F, height, width, 0, 0, levels)
    pixel_format = struct.pack("<2I4s5I", 32, 4, b"DX10", 0, 0, 0, 0, 0)
    return head + pixel_format + struct.pack("<5I", 0x401008, 0xFE00, 0, 0, 0) + struct.pack("<5I", dxgi, 3, misc, array, 0)


def env(width, pictures, data=b"", version=2):
    """A Babylon .env of (position, length) pairs."""
    document = {"version": version, "width": width, "specular": {"mipmaps": [{"position": p, "length": n} for p, n in pictures]}}
    return b"\x86\x16\x87\x96\xf6\xd6\x96\x36" + json.dumps(document).encode() + b"\0" + data


def image_light(size, picture, levels=1):
    """A glTF file with EXT_lights_image_based, whose faces are all the same picture."""
    light = {"irradianceCoefficients": [[0, 0, 0]] * 9, "specularImageSize": size, "specularImages": [[0] * 6] * levels}
    return json.dumps({"asset": {"version": "2.0"}, "extensions": {"EXT_lights_image_based": {"lights": [light]}},
                       "images": [{"uri": "data:image/png;base64," + base64.b64encode(picture).decode()}]}).encode()


def gltf(data=b"", **members):
    """A .gltf of one triangle, some members replaced."""
    data = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0) + data
    document = {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0}]}
    return json.dumps({**document, **members}).encode()


def gltf_files():
    many = 1 << 31
    packing = {"buffer": 0, "byteOffset": 36, "byteLength": 64, "byteStride": 12, "count": many, "mode": "ATTRIBUTES"}
    packed = {"buffer": 0, "byteLength": 12 * many, "extensions": {"EXT_meshopt_compression": packing}}
    # A Draco header of version 2.2 (sequential; no metadata) that claims 2^31 faces, as a variable-length number.
    draco = b"DRACO\2\2\1\0\0\0" + b"\x80\x80\x80\x80\x08\x03" + bytes(40)
    compressed = {"KHR_draco_mesh_compression": {"bufferView": 1, "attributes": {"POSITION": 0}}}
    views = [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": len(draco)}]
    image = "data:image/png;base64," + base64.b64encode(png(60000, 60000)).decode()
    material = {"emissiveTexture": {"index": 0}}
    accessor = {"componentType": 5126, "type": "VEC3"}
    return {
        "accessor-huge.gltf": gltf(accessors=[{**accessor, "bufferView": 0, "count": many}]),
        "accessor-of-nothing.gltf": gltf(accessors=[{**accessor, "count": 1 << 40}]),
        "meshopt-huge.gltf": gltf(b"\xa0" * 64, bufferViews=[packed], accessors=[{**accessor, "bufferView": 0, "count": many}]),
        "draco-huge.gltf": gltf(draco, bufferViews=views, accessors=[{**accessor, "count": 3}],
                                meshes=[{"primitives": [{"attributes": {"POSITION": 0}, "extensions": compressed}]}]),
        "texture-huge.gltf": gltf(images=[{"uri": image}], textures=[{"source": 0}], materials=[material]),
        "nodes-cyclic.gltf": gltf(nodes=[{"mesh": 0}, {"children": [2]}, {"children": [1]}]),
        "camera-huge.gltf": gltf(cameras=[{"type": "orthographic", "orthographic": {"xmag": 1e19, "ymag": 1e19, "znear": 0, "zfar": 1}}],
                                 nodes=[{"mesh": 0}, {"camera": 0}]),
        "nested.gltf": b"[" * 200_000,
        "leaves-folder.gltf": gltf(buffers=[{"byteLength": 36, "uri": "../../../../../../etc/passwd"}]),
        "faces-huge.ply": b"ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\n"
                          b"property float z\nend_header\n" + bytes(64),
        "faces-of-no-bytes.ply": b"ply\nformat ascii 1.0\nelement face 9999999999999\nend_header\n",
        "elements-of-no-bytes.ply": b"ply\nformat binary_little_endian 1.0\nelement other 9999999999999\nend_header\n",
        "index-huge.obj": b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4000000000\n",
    }


# Scenes that load without what is hostile in them, with a warning.
LEFT_OUT = {"texture-huge.gltf"}


def hostile_files():
    """(name, bytes) of each."""
    whole = radiance("-Y 4 +X 8", run_length_row(8) * 4)
    files = {
        "empty.hdr": b"", "empty.exr": b"", "empty.png": b"", "empty.jpg": b"", "empty.ktx2": b"",
        "text.hdr": b"this is no image\n" * 10, "zeros.exr": bytes(4096), "noise.bin": bytes((i * 197 + 13) % 251 for i in range(5000)),

        "hdr-0x0.hdr": radiance("-Y 0 +X 0"),
        "hdr-0-wide.hdr": radiance("-Y 8 +X 0"),
        "hdr-huge.hdr": radiance(f"-Y {HUGE} +X {HUGE}"),
        "hdr-huge-2to1.hdr": radiance(f"-Y {HUGE} +X {2 * HUGE}"),
        "hdr-huge-flat.hdr": radiance("-Y 1 +X 2000000000"),
        "hdr-negative.hdr": radiance("-Y -8 +X 16"),
        "hdr-overflow.hdr": radiance("-Y 4294967298 +X 4294967300"),
        "hdr-overflow64.hdr": radiance("-Y 18446744073709551617 +X 18446744073709551618"),
        "hdr-words.hdr": radiance("-Y eight +X sixteen"),
        "hdr-no-resolution.hdr": b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n",
        "hdr-no-end-of-header.hdr": b"#?RADIANCE\n" + b"COMMENT=x\n" * 3000,
        "hdr-endless-line.hdr": b"#?RADIANCE\n" + b"x" * 3_000_000,
        "hdr-no-data.hdr": radiance("-Y 4 +X 8"),
        "hdr-cut.hdr": whole[:-7],
        "hdr-cut-in-a-run.hdr": radiance("-Y 4 +X 8", run_length_row(8)[:5]),
        "hdr-run-over-the-row.hdr": radiance("-Y 4 +X 8", b"\x02\x02\x00\x08" + b"\xff\x01" * 16),
        "hdr-run-of-nothing.hdr": radiance("-Y 4 +X 8", b"\x02\x02\x00\x08" + b"\x00" * 64),
        "hdr-other-width-in-row.hdr": radiance("-Y 4 +X 8", run_length_row(16) * 4),
        "hdr-old-run-first.hdr": radiance("-Y 2 +X 4", b"\x01\x01\x01\xff" * 8),
        "hdr-old-run-of-billions.hdr": radiance("-Y 2 +X 4", b"\x05\x05\x05\x80" + b"\x01\x01\x01\xff" * 5),
        "hdr-format-unknown.hdr": radiance("-Y 4 +X 8", run_length_row(8) * 4, b"#?RADIANCE\nFORMAT=64-bit_float\n\n"),

        "exr-magic-only.exr": struct.pack("<I", 20000630),
        "exr-huge.exr": exr(2 * HUGE - 1, HUGE - 1),
        "exr-huge-zip.exr": exr(HUGE - 1, HUGE - 1, compression=3),
        "exr-huge-tall.exr": exr(0, 2_000_000_000),
        "exr-window-inside-out.exr": exr(-5, -5),
        "exr-window-overflow.exr": exr(2147483647, 2147483647, -2147483648, -2147483648),
        "exr-no-data.exr": exr(15, 7),
        "exr-offsets-beyond.exr": exr(15, 7, data=struct.pack("<8Q", *[1 << 40] * 8)),
        "exr-offsets-zero.exr": exr(15, 7, data=bytes(64)),
        "exr-no-colours.exr": exr(15, 7, channels=b"Q", data=bytes(64)),
        "exr-version-255.exr": exr(15, 7, version=255),
        "exr-display-huge.exr": exr(0, 0, data=struct.pack("<QiI3f", 331, 0, 12, 1, 1, 1), display=(0, 0, 65535, 32767)),
        "exr-cut-in-header.exr": exr(15, 7)[:60],
        "exr-attribute-of-gigabytes.exr": struct.pack("<II", 20000630, 2) + b"channels\0chlist\0" + struct.pack("<i", 0x7FFFFFF0),

        "png-0x0.png": png(0, 0),
        "png-huge.png": png(2 * HUGE, HUGE, bits=16),
        "png-bomb.png": png(30000, 15000, bytes(3_000_000)),
        "png-no-data.png": png(16, 8),
        "png-cut.png": png(16, 8, bytes((1 + 48) * 8))[:60],
        "jpg-0x0.jpg": jpeg(0, 0),
        "jpg-huge.jpg": jpeg(65500, 65500),
        "jpg-no-data.jpg": jpeg(16, 8),

        "ktx2-0x0.ktx2": ktx2(0, 0),
        "ktx2-huge.ktx2": ktx2(HUGE, HUGE),
        "ktx2-255-levels.ktx2": ktx2(8, 8, levels=255),
        "ktx2-level-beyond.ktx2": ktx2(8, 8, level=(1 << 62, 1 << 62, 1 << 62)),
        "ktx2-zstd-bomb.ktx2": ktx2(16384, 16384, supercompression=2, level=(104, 9, 1 << 40), extra=b"\x28\xb5\x2f\xfd" + bytes(5)),
        "ktx2-cut.ktx2": ktx2(8, 8)[:50],
        "ktx1-huge.ktx": ktx1(HUGE, HUGE),
        "ktx1-key-values-beyond.ktx": ktx1(8, 8, key_values=0xFFFFFFFC),
        "ktx1-image-size-beyond.ktx": ktx1(8, 8, image_size=0xFFFFFFF0),
        "env-0.env": env(0, [(0, 0)] * 6),
        "env-huge.env": env(1 << 30, [(0, 0)] * 6),
        "env-cut.env": env(4, [(0, 9)] * 18)[:40],
        "env-beyond.env": env(1, [(1 << 63, 1 << 62)] * 6),
        "env-negative.env": env(1, [(-1, 5)] * 6),
        "env-many-levels.env": env(4, [(0, 1)] * 600),
        "env-version-9.env": env(1, [(0, 0)] * 6, version=9),
        "env-picture-huge.env": env(16384, [(0, 60)] * 6, png(16384, 16384, colour=6)),
        "env-picture-bomb.env": env(16384, [(0, len(png(16384, 16384, bytes(200_000), colour=6)))] * 6, png(16384, 16384, bytes(200_000), colour=6)),
        "env-picture-of-other-size.env": env(2, [(0, len(png(4, 4, bytes(68), colour=6)))] * 12, png(4, 4, bytes(68), colour=6)),
        "env-nested.env": b"\x86\x16\x87\x96\xf6\xd6\x96\x36" + b"[" * 200_000 + b"\0",
        "env-endless.env": b"\x86\x16\x87\x96\xf6\xd6\x96\x36" + b" " * 2_000_000,
        "light-huge.image-light": image_light(16384, png(16384, 16384, colour=6)),
        "light-of-other-size.image-light": image_light(8, png(4, 4, bytes(68), colour=6)),
        "light-many-levels.image-light": image_light(8, png(8, 8, bytes(264), colour=6), levels=9),
        "dds-0x0.dds": dds(0, 0),
        "dds-huge.dds": dds(HUGE, HUGE),
        "dds-levels.dds": dds(8, 8, levels=0xFFFFFFFF),
        "dds-array.dds": dds(8, 8, array=0xFFFFFFFF),
        "dds-cut.dds": dds(8, 8)[:100],
    }
    files.update(gltf_files())
    return sorted(files.items())
