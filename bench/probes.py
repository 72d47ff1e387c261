#!/usr/bin/env python3
"""What a set of probes costs beside its rays and its filter, and how that grows with their number.

    bench/probes.py [--spp 16] [--many 2000] [--env FILE.hdr] [--json FILE]

The scene is a furnished hall of 100 000 triangles with windows and thick walls, which this script makes. Three things are measured, in CPU seconds (user and system) on
one thread:

    total       `domelight probes` with 200 probes of 64^2 at 3 bounces, whole process
    rays        what `domelight render --camera cube` needs more for 2 x spp than for spp samples, at twelve of those probes; times 200 / 12. Nothing but tracing differs
    bake        of the command's own report: filtering alone

and, at one sample a texel, the whole for 200 and for --many probes: seconds by number, and the largest resident memory.
"""

import argparse
import json
import math
import os
import pathlib
import statistics
import struct
import subprocess
import sys
import tempfile

from photographs import cpu_name

ROOT = pathlib.Path(__file__).resolve().parents[1]
DOMELIGHT = os.environ.get("DOMELIGHT_PROGRAM", str(ROOT / "build/dev/cli/domelight"))


class Model:
    """Triangles of a few materials, written as GLB."""

    def __init__(self):
        self.meshes = {}

    def add(self, material, positions, triangles):
        points, indices = self.meshes.setdefault(material, ([], []))
        first = len(points)
        points += positions
        indices += [first + i for t in triangles for i in t]

    def box(self, material, low, high):
        corners = [tuple((high if i >> a & 1 else low)[a] for a in range(3)) for i in range(8)]
        sides = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
        self.add(material, corners, [t for a, b, c, d in sides for t in ((a, b, c), (a, c, d))])

    def sphere(self, material, centre, radius, rows, squash=1):
        columns = 2 * rows
        points, triangles = [], []
        for j in range(rows + 1):
            for i in range(columns + 1):
                t, p = math.pi * j / rows, 2 * math.pi * i / columns
                points.append((centre[0] + radius * math.sin(t) * math.cos(p), centre[1] + squash * radius * math.cos(t),
                               centre[2] + radius * math.sin(t) * math.sin(p)))
        for j in range(rows):
            for i in range(columns):
                a = j * (columns + 1) + i
                b, c, d = a + 1, a + columns + 1, a + columns + 2
                if j > 0:
                    triangles.append((a, b, d))
                if j < rows - 1:
                    triangles.append((a, d, c))
        self.add(material, points, triangles)

    def triangles(self):
        return sum(len(indices) // 3 for _, indices in self.meshes.values())

    def write(self, file):
        data, views, accessors, meshes, materials, nodes = b"", [], [], [], [], []
        for (colour, metal, roughness), (points, indices) in self.meshes.items():
            packed = [struct.pack(f"<{3 * len(points)}f", *(v for p in points for v in p)), struct.pack(f"<{len(indices)}I", *indices)]
            for i, block in enumerate(packed):
                views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(block)})
                data += block
                accessors.append({"bufferView": len(views) - 1, "componentType": 5126, "count": len(points), "type": "VEC3",
                                  "min": [min(p[a] for p in points) for a in range(3)], "max": [max(p[a] for p in points) for a in range(3)]}
                                 if i == 0 else {"bufferView": len(views) - 1, "componentType": 5125, "count": len(indices), "type": "SCALAR"})
            materials.append({"pbrMetallicRoughness": {"baseColorFactor": [*colour, 1], "metallicFactor": metal, "roughnessFactor": roughness}})
            meshes.append({"primitives": [{"attributes": {"POSITION": len(accessors) - 2}, "indices": len(accessors) - 1, "material": len(materials) - 1}]})
            nodes.append({"mesh": len(meshes) - 1})
        head = json.dumps({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes, "meshes": meshes,
                           "materials": materials, "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(data)}]}).encode()
        head += b" " * (-len(head) % 4)
        pathlib.Path(file).write_bytes(struct.pack("<4sII", b"glTF", 2, 28 + len(head) + len(data)) + struct.pack("<I4s", len(head), b"JSON") + head
                                       + struct.pack("<I4s", len(data), b"BIN\0") + data)


def hall():
    """12 x 4 x 8 metres inside, walls of 0.3 m, three windows to +Z and a door to -X, columns, vases and a carpet."""
    model = Model()
    plaster, wood, red, brass = ((0.75, 0.73, 0.7), 0, 0.9), ((0.35, 0.2, 0.1), 0, 0.5), ((0.6, 0.08, 0.06), 0, 0.95), ((0.9, 0.7, 0.3), 1, 0.3)
    model.box(wood, (-0.3, -0.3, -0.3), (12.3, 0, 8.3))
    model.box(plaster, (-0.3, 4, -0.3), (12.3, 4.3, 8.3))
    model.box(plaster, (-0.3, 0, -0.3), (12.3, 4, 0))
    model.box(plaster, (12, 0, 0), (12.3, 4, 8))
    model.box(plaster, (-0.3, 0, 0), (0, 4, 3))
    model.box(plaster, (-0.3, 0, 4.2), (0, 4, 8))
    model.box(plaster, (-0.3, 2.2, 3), (0, 4, 4.2))
    model.box(plaster, (-0.3, 0, 8), (12.3, 1, 8.3))
    model.box(plaster, (-0.3, 3, 8), (12.3, 4, 8.3))
    for low, high in ((-0.3, 1.5), (3.5, 5), (7, 8.5), (10.5, 12.3)):
        model.box(plaster, (low, 1, 8), (high, 3, 8.3))
    model.box(red, (3, 0, 2), (9, 0.02, 6))
    for x in (3, 6, 9):
        for z in (2.5, 5.5):
            model.sphere(plaster, (x, 2, z), 0.25, 60, squash=7.9)
    i = 0
    while model.triangles() < 100_000:
        x, z = 0.8 + 1.15 * (i % 10), 0.8 + 6.4 * (i // 10 % 2)
        model.sphere(brass if i % 3 == 0 else red, (x, 0.35 + 0.7 * (i // 20), z), 0.3, 40, squash=1.15)
        i += 1
    return model


def run(*words):
    """Output, CPU seconds, and the largest resident memory in bytes of one process on one thread."""
    process = subprocess.Popen([str(w) for w in (DOMELIGHT, *words, "--threads", "1", "--json")], stdout=subprocess.PIPE, text=True)
    output = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    if os.waitstatus_to_exitcode(status) != 0:
        sys.exit(f"error: {' '.join(map(str, words))} failed")
    return json.loads(output), usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--spp", type=int, default=16)
    parser.add_argument("--many", type=int, default=2000)
    parser.add_argument("--env")
    parser.add_argument("--json")
    options = parser.parse_args()
    light = ["--env", options.env] if options.env else []
    with tempfile.TemporaryDirectory() as name:
        work = pathlib.Path(name)
        model = hall()
        model.write(work / "hall.glb")
        region = ["--region", "0,0,0,12,4,8"]
        scene = ["probes", work / "hall.glb", *light, *region, "--bounces", "3", "--size", "64"]

        # 10 x 4 x 5 = 200 probes.
        report, total, memory = run(*scene, "--grid", "10,4,5", "--spp", options.spp, "-o", work / "set")
        record = json.loads((work / "set/probes.json").read_text())
        places = [p["position"] for p in record["probes"] if p["valid"]][::17][:12]
        rays = []
        for place in places:
            once, twice = (run("render", work / "hall.glb", *light, "--camera", "cube", "--camera-position", ",".join(map(str, place)), "--width", 64,
                               "--bounces", "3", "--spp", spp, "-o", work / "cube.hdr")[1] for spp in (options.spp, 2 * options.spp))
            rays.append(twice - once)
        captured = 200 - report["invalid"]
        ray_seconds, bake_seconds = captured * statistics.mean(rays), report["filter_cpu_seconds"]

        few, few_seconds, few_memory = run(*scene, "--grid", "10,4,5", "--spp", 1, "-o", work / "few")
        nx, ny, nz = 10, 4, 5
        nx = max(1, options.many // (ny * nz))
        many, many_seconds, many_memory = run(*scene, "--grid", f"{nx},{ny},{nz}", "--spp", 1, "-o", work / "many")
        result = {"cpu": cpu_name(), "triangles": model.triangles(), "spp": options.spp, "captured": captured, "total_seconds": total, "ray_seconds": ray_seconds,
                  "bake_seconds": bake_seconds, "ratio": total / (ray_seconds + bake_seconds), "own_ray_seconds": report["capture_cpu_seconds"],
                  "bake_ms_a_probe": 1000 * bake_seconds / captured, "memory": memory,
                  "few": {"probes": few["probes"], "seconds_a_probe": few_seconds / few["probes"], "memory": few_memory,
                          "bake_ms_a_probe": 1000 * few["filter_cpu_seconds"] / (few["probes"] - few["invalid"])},
                  "many": {"probes": many["probes"], "seconds_a_probe": many_seconds / many["probes"], "memory": many_memory,
                           "bake_ms_a_probe": 1000 * many["filter_cpu_seconds"] / (many["probes"] - many["invalid"])}}
    print(f"{result['triangles']} triangles, {captured} probes of 64^2 captured, {options.spp} samples, 3 bounces, on {result['cpu']}")
    print(f"total {total:.1f} s; rays {ray_seconds:.1f} s, bake {bake_seconds:.2f} s: {result['ratio']:.3f} times their sum; {result['bake_ms_a_probe']:.2f} ms of bake a probe")
    for part in ("few", "many"):
        r = result[part]
        print(f"{r['probes']} probes at one sample: {1000 * r['seconds_a_probe']:.1f} ms a probe, {r['bake_ms_a_probe']:.2f} ms of it bake, {r['memory'] / 1e6:.0f} MB")
    if options.json:
        pathlib.Path(options.json).write_text(json.dumps(result, indent=2) + "\n")


if __name__ == "__main__":
    main()
