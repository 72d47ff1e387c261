"""Small valid scenes to mutate: glTF with every kind of storage, .obj, .ply, and WebP textures.

The packed pieces hold a grid of 3 x 3 quads; they were written by the encoders of the same libraries that read them.
"""

import base64
import json
import struct

DRACO_SEQUENTIAL = bytes.fromhex(
    "445241434f02020100000012100100010200020301040501050204060704070503020803080902050a020a0805070b050b0a09080c090c0d080a0e08"
    "0e0c0a0b0f0a0f0e010100090300000200010101038002fd1bfff7ad02ad029fad06010c0104ad02ff475505114c8003cf2851982c44395f396f8bd8"
    "328900000000ff0000000000000000000000000000000000803f08")
DRACO_EDGEBREAKER = bytes.fromhex(
    "445241434f0202010100000010120012030006dfd3a75a7d0aff011101ff00000100090300000201010101028002ad2afff7550501049fad025501ad"
    "02ff4b55050dc5dd1beca25094e4002fa13e8200000000ff0000000000000000000000000000000000803f08")
MESHOPT_VERTICES = bytes.fromhex(
    "a00133333333a9aaa9aaa9aaa9aa0133333333abacabacabacabac0300abffacffabffacffabffacffabffac0138f8f8f87c7d7c7d7c7d7c0100c000"
    "c0a9aa0100c000c0abac0100c0c0c0abffac0100c080007c000001003c0f00ffffffff01003b37007c7d7e7b00000000000000000000000000000000"
    "00000000000000000000000000000000")
MESHOPT_TRIANGLES = bytes.fromhex(
    "e0fe0ffe13fe12bf0faf029f019f0f9f029f010f0a01f304f2020401040204010402007687566778a9866589689801690000")
MESHOPT_NORMALS = bytes.fromhex(
    "a0000000000000000000000000000000000000000000000000000000000000000036007f00")
WEBP = bytes.fromhex(
    "5249464630000000574542505650384c240000002f04c00010cd6444ffc340906d4373e323dee50acd6c4f894020510e66c441222b61fc00")
WEBP_LOSSY = bytes.fromhex(
    "524946467600000057454250565038580a00000010000000040000030000414c50481500000001998ce87f8020db06793245bccb152226200a300f00"
    "565038203a000000b001009d012a0500040002c04c25a8027400f487fa5c00e201513e313b7abb7c2f242297849b4b8e5c9207ac68b152ef6a34eeb1"
    "43b31e000000")
PNG = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8DwHwAFBQIAX8jx0gAAAABJRU5ErkJggg==")
SIZES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
CODES = {"b": 5120, "B": 5121, "h": 5122, "H": 5123, "I": 5125, "f": 5126}


class Sample:
    """A glTF document under construction, with one buffer."""

    def __init__(self, **members):
        self.json, self.data = {"asset": {"version": "2.0"}, **members}, b""

    def add(self, array, element):
        self.json.setdefault(array, []).append(element)
        return len(self.json[array]) - 1

    def view(self, data, **members):
        self.data += bytes(-len(self.data) % 4)
        self.data += data
        return self.add("bufferViews", {"buffer": 0, "byteOffset": len(self.data) - len(data), "byteLength": len(data), **members})

    def accessor(self, kind, code, *values, **members):
        view = self.view(struct.pack(f"<{len(values)}{code}", *values))
        count = len(values) // SIZES[kind]
        return self.add("accessors", {"bufferView": view, "componentType": CODES[code], "count": count, "type": kind, **members})

    def triangle(self):
        return {"attributes": {"POSITION": self.accessor("VEC3", "f", 0, 0, 0, 1, 0, 0, 0, 1, 0)}}

    def show(self, primitive, **node):
        return self.add("nodes", {"mesh": self.add("meshes", {"primitives": [primitive]}), **node})

    def glb(self):
        self.json["buffers"] = [{"byteLength": len(self.data)}] + self.json.get("buffers", [])[1:]
        text = json.dumps(self.json).encode()
        text += b" " * (-len(text) % 4)
        data = self.data + bytes(-len(self.data) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks

    def gltf(self):
        uri = "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()
        return json.dumps({**self.json, "buffers": [{"byteLength": len(self.data), "uri": uri}]}).encode()


def animated():
    """A skin, morph targets and sparse zeros."""
    s = Sample()
    p = s.triangle()
    p["attributes"]["NORMAL"] = s.accessor("VEC3", "f", *(0, 0, 1) * 3)
    p["attributes"]["JOINTS_0"] = s.accessor("VEC4", "B", 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0)
    p["attributes"]["WEIGHTS_0"] = s.accessor("VEC4", "f", 1, 0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0)
    sparse = {"count": 1, "indices": {"bufferView": s.view(b"\2\0"), "componentType": 5123},
              "values": {"bufferView": s.view(struct.pack("<3f", 0, 1, 0))}}
    p["targets"] = [{"POSITION": s.add("accessors", {"componentType": 5126, "count": 3, "type": "VEC3", "sparse": sparse})}]
    bind = s.accessor("MAT4", "f", *(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1) * 2)
    s.add("nodes", {"translation": [0, 10, 0], "children": [1]})
    s.add("nodes", {"rotation": [0, 0.7, 0, 0.7]})
    s.add("skins", {"joints": [0, 1], "inverseBindMatrices": bind})
    s.show(p, skin=0, weights=[0.5])
    return s


def textured():
    """Strips, quantised numbers, textures of three kinds, a camera, a light and instances."""
    s = Sample(extensionsUsed=["KHR_mesh_quantization"])
    for image, kind in ((PNG, "png"), (WEBP, "webp"), (WEBP_LOSSY, "webp")):
        s.add("images", {"bufferView": s.view(image), "mimeType": "image/" + kind})
    s.add("samplers", {"wrapS": 33071, "magFilter": 9728})
    for source in range(3):
        s.add("textures", {"sampler": 0, "extensions": {"EXT_texture_webp": {"source": source}}})
    transform = {"KHR_texture_transform": {"offset": [0.5, 0], "rotation": 1, "scale": [2, 3]}}
    s.add("materials", {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "extensions": transform}}, "normalTexture": {"index": 1},
                        "emissiveTexture": {"index": 2}, "alphaMode": "MASK", "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1}}})
    points = (0, 0, 0, 100, 0, 0, 0, 100, 0, 100, 100, 50)
    p = {"attributes": {"POSITION": s.accessor("VEC3", "h", *points, normalized=True),
                        "TEXCOORD_0": s.accessor("VEC2", "H", 0, 0, 65535, 0, 0, 65535, 9, 9, normalized=True),
                        "COLOR_0": s.accessor("VEC4", "B", *range(16), normalized=True)},
         "indices": s.accessor("SCALAR", "H", 0, 1, 2, 3), "mode": 5, "material": 0}
    places = s.accessor("VEC3", "f", 0, 0, 0, 5, 0, 0)
    s.show(p, extensions={"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": places}}})
    s.json["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "spot", "spot": {}}]}}
    s.add("cameras", {"type": "perspective", "perspective": {"yfov": 0.7, "znear": 1}})
    s.add("nodes", {"camera": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}})
    return s


def draco(packed):
    s = Sample(extensionsRequired=["KHR_draco_mesh_compression"])
    view = s.view(packed)
    s.add("accessors", {"componentType": 5126, "count": 16, "type": "VEC3"})
    s.add("accessors", {"componentType": 5125, "count": 54, "type": "SCALAR"})
    packing = {"bufferView": view, "attributes": {"POSITION": 0}}
    s.show({"attributes": {"POSITION": 0}, "indices": 1, "extensions": {"KHR_draco_mesh_compression": packing}})
    return s


def meshopt():
    s = Sample(extensionsRequired=["EXT_meshopt_compression"], buffers=[{}, {"byteLength": 1000}])

    def view(packed, mode, stride, count, kind="NONE"):
        v = s.view(packed)
        about = {**s.json["bufferViews"][v], "byteStride": stride, "count": count, "mode": mode, "filter": kind}
        s.json["bufferViews"][v] = {"buffer": 1, "byteLength": stride * count, "extensions": {"EXT_meshopt_compression": about}}
        return v

    positions = view(MESHOPT_VERTICES, "ATTRIBUTES", 12, 16)
    normals = view(MESHOPT_NORMALS, "ATTRIBUTES", 4, 16, "OCTAHEDRAL")
    s.json["bufferViews"][normals]["byteStride"] = 4
    s.add("accessors", {"bufferView": positions, "componentType": 5126, "count": 16, "type": "VEC3"})
    s.add("accessors", {"bufferView": normals, "componentType": 5120, "count": 16, "type": "VEC3", "normalized": True})
    triangles = view(MESHOPT_TRIANGLES, "TRIANGLES", 4, 54)
    s.add("accessors", {"bufferView": triangles, "componentType": 5125, "count": 54, "type": "SCALAR"})
    s.show({"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2})
    return s


OBJ = b"""# obj
v 0 2 0
v 0 0 0
v 2 0 0
v 2 1 0
v 1 1 0
v 1 2 0
vt 0 0
vt 1 1
vn 0 0 1
o L
s 1
f 3 4 5 6 1 2
g other
f -1/1/1 -2/2/1 -3//1
usemtl red
f 1//1 2//1 \\
3//1
"""
PLY_HEADER = ("ply\nformat {} 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
              "property uchar green\nproperty uchar blue\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n")
CORNERS = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0))


def ply(order):
    data = b"".join(struct.pack(order + "3f3B", *corner, 255, 0, 128) for corner in CORNERS)
    return data + struct.pack(order + "B4iB3i", 4, 0, 1, 2, 3, 3, 0, 1, 2)


def scene_files():
    """Pairs of name and bytes."""
    samples = {"animated": animated(), "textured": textured(), "draco-sequential": draco(DRACO_SEQUENTIAL),
               "draco-edgebreaker": draco(DRACO_EDGEBREAKER), "meshopt": meshopt()}
    files = [(name + ".glb", s.glb()) for name, s in samples.items()]
    files += [(name + ".gltf", samples[name].gltf()) for name in ("animated", "textured")]
    text = "".join("%g %g %g 255 0 128\n" % corner for corner in CORNERS) + "4 0 1 2 3\n3 0 1 2\n"
    files += [("a.obj", OBJ), ("ascii.ply", (PLY_HEADER.format("ascii") + text).encode()),
              ("little.ply", PLY_HEADER.format("binary_little_endian").encode() + ply("<")),
              ("big.ply", PLY_HEADER.format("binary_big_endian").encode() + ply(">")),
              ("texture.webp", WEBP), ("texture-lossy.webp", WEBP_LOSSY), ("texture.png", PNG)]
    return files
