#!/usr/bin/env python3
"""Two rooms with windows and a door between them, as a glTF file: the scene of docs/probes.md and of bench/probe_error.py.

    docs/figures/probes/rooms.py FILE.glb

Metres, +Y up. The rooms lie side by side along x, with the windows in the wall towards +z; their walls are 0.2 m thick.
"""

import json
import math
import pathlib
import struct
import sys

PLASTER, RED, GREEN, WOOD, METAL, PAINT = range(6)
MATERIALS = [("plaster", (0.8, 0.78, 0.74), 0, 0.9), ("red wall", (0.7, 0.12, 0.09), 0, 0.8), ("green wall", (0.16, 0.45, 0.14), 0, 0.8),
             ("floor", (0.45, 0.28, 0.16), 0, 0.35), ("brass", (0.95, 0.8, 0.5), 1, 0.15), ("blue paint", (0.1, 0.2, 0.6), 0, 0.3)]
CAMERA = ("0.5,1.7,3.4", "6,0.9,1.0", 65)  # eye, target, vertical field of view in degrees


class Room:
    """Triangles by material."""

    def __init__(self):
        self.positions, self.normals = [[] for _ in MATERIALS], [[] for _ in MATERIALS]

    def quad(self, material, corners, normal):
        for i in (0, 1, 2, 0, 2, 3):
            self.positions[material].append(corners[i])
            self.normals[material].append(normal)

    def box(self, material, low, high):
        """A closed box, seen from outside. `material`: of all sides, or a dictionary {(axis, side): material} with the others under None."""
        for axis in range(3):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            for side in (0, 1):
                corners = []
                for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)) if side else ((0, 0), (0, 1), (1, 1), (1, 0)):
                    p = [0.0] * 3
                    p[axis], p[u], p[v] = (low, high)[side][axis], (low, high)[a][u], (low, high)[b][v]
                    corners.append(tuple(p))
                normal = [0.0] * 3
                normal[axis] = 1.0 if side else -1.0
                chosen = material.get((axis, side), material[None]) if isinstance(material, dict) else material
                self.quad(chosen, corners, tuple(normal))

    def wall(self, material, low, high, along, openings):
        """A box with openings (from, to, bottom, top) along an axis, in order."""
        at = low[along]

        def part(start, end, bottom, top):
            if end > start and top > bottom:
                a, b = list(low), list(high)
                a[along], b[along], a[1], b[1] = start, end, bottom, top
                self.box(material, a, b)

        for start, end, bottom, top in openings:
            part(at, start, low[1], high[1])
            part(start, end, low[1], bottom)
            part(start, end, top, high[1])
            at = end
        part(at, high[along], low[1], high[1])

    def sphere(self, material, centre, radius, rings=24):
        def point(i, j):
            theta, phi = math.pi * i / rings, math.pi * j / rings
            return (math.sin(theta) * math.cos(phi), math.cos(theta), math.sin(theta) * math.sin(phi))

        for i in range(rings):
            for j in range(2 * rings):
                a, b, c, d = point(i, j), point(i, j + 1), point(i + 1, j + 1), point(i + 1, j)
                for n in ((a, c, d) if i == 0 else (a, b, c) if i == rings - 1 else (a, b, c, a, c, d)):
                    self.normals[material].append(n)
                    self.positions[material].append(tuple(centre[k] + radius * n[k] for k in range(3)))

    def glb(self):
        buffer, views, accessors, primitives = b"", [], [], []
        for material, positions in enumerate(self.positions):
            if not positions:
                continue
            for values in (positions, self.normals[material]):
                data = b"".join(struct.pack("<3f", *v) for v in values)
                views.append({"buffer": 0, "byteOffset": len(buffer), "byteLength": len(data)})
                accessors.append({"bufferView": len(views) - 1, "componentType": 5126, "count": len(values), "type": "VEC3",
                                  "min": [min(v[k] for v in values) for k in range(3)], "max": [max(v[k] for v in values) for k in range(3)]})
                buffer += data
            primitives.append({"attributes": {"POSITION": len(accessors) - 2, "NORMAL": len(accessors) - 1}, "material": material})
        document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "name": "rooms"}], "meshes": [{"primitives": primitives}],
                    "materials": [{"name": name, "pbrMetallicRoughness": {"baseColorFactor": [*colour, 1], "metallicFactor": metal, "roughnessFactor": roughness}}
                                  for name, colour, metal, roughness in MATERIALS],
                    "buffers": [{"byteLength": len(buffer)}], "bufferViews": views, "accessors": accessors}
        text = json.dumps(document).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(buffer), 0x004E4942) + buffer
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def two_rooms(closed=False):
    """The bytes of the scene: 5 x 2.8 x 4 m with two windows, a door of 0.9 x 2.1 m, and 3.8 x 2.8 x 4 m with one small window. `closed`: without the door and that window."""
    room = Room()
    room.box({None: PLASTER, (1, 1): WOOD}, (-0.2, -0.2, -0.2), (9.2, 0, 4.2))
    room.box(PLASTER, (-0.2, 2.8, -0.2), (9.2, 3, 4.2))
    room.box({None: PLASTER, (0, 1): RED}, (-0.2, 0, -0.2), (0, 2.8, 4.2))
    room.box({None: PLASTER, (0, 0): GREEN}, (9, 0, -0.2), (9.2, 2.8, 4.2))
    room.box(PLASTER, (0, 0, -0.2), (9, 2.8, 0))
    room.wall(PLASTER, (0, 0, 4), (9, 2.8, 4.2), 0, [(1, 2.2, 0.9, 2.1), (3, 4.2, 0.9, 2.1)] + ([] if closed else [(6.6, 7.4, 1.2, 2)]))
    room.wall(PLASTER, (5, 0, 0), (5.2, 2.8, 4), 2, [] if closed else [(1, 1.9, 0, 2.1)])
    room.box(PAINT, (2.2, 0, 0.3), (3.6, 0.75, 1.1))
    room.sphere(METAL, (2.9, 1.05, 0.7), 0.3)
    room.box(PLASTER, (7.2, 0, 1.6), (7.9, 0.9, 2.3))
    room.sphere(PLASTER, (7.55, 1.2, 1.95), 0.3)
    return room.glb()


if __name__ == "__main__":
    pathlib.Path(sys.argv[1]).write_bytes(two_rooms())
