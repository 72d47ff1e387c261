#!/usr/bin/env python3
"""The layers of the code, read from its includes.

code_map.py            writes docs/code-map.md's drawing and table anew
code_map.py --check    prints one line for each rule that is broken, and exits 1 if there is any

A room is a folder of src/ together with the folder of the same name in include/domelight/. The rooms are listed below from the lowest to the
highest; a file may include only its own room and those before it.
"""
import collections
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs/code-map.md"
MOST_FILES = 40

# name, what is in it. A room inside another one stands on its own where its layer differs from that of the room around it.
ROOMS = [
    ("base", "results, threads, progress, vectors, quadrature, random numbers, hashes, instruction sets"),
    ("image", "images, views, colour, repair of bad texels, layouts of cubes, lettering"),
    ("projection", "direction to image position and back, for every projection"),
    ("filtering/resample", "area resampling, and reprojection from any projection to any other"),
    ("environment", "what every consumer of light reads: rows, texels or directions; the built-in sky"),
    ("sampling", "sequences, lobes to draw from, the environment sampler, extraction of lights, estimates of reflection"),
    ("filtering", "the exact prefilter: kernels, harmonics, the BRDF table, and the plain references"),
    ("texture", "what a texture holds: texels, blocks, and how a chain of levels is encoded"),
    ("io", "bytes in, files that appear whole or not at all; OpenEXR, Radiance HDR, PNG, JPEG, WebP"),
    ("texture/container", "KTX1, KTX2, DDS, .env, atlases"),
    ("scene", "scenes, cameras and lights; glTF and meshes"),
    ("io/environment", "opening an environment from any file and projection; converting it"),
    ("probe", "the light of many points of a scene: sets of probes, their grids and lookups"),
    ("preview", "tone mapping, plots, contact sheets"),
    ("engines", "one small file for each engine: what it loads, and in which convention"),
    ("render", "path tracing, surfaces, and the shading that engines draw"),
    ("convert", "a converted environment as files of any format"),
    ("compare", "differences of images, FLIP, audit of a bake"),
    ("bake", "plan, filter, write, manifest"),
    ("capture", "probes of a scene: where they are placed, what they capture, and their files"),
    ("view", "the page of `domelight view`, served to a browser on this machine"),
    ("study", "the figures and tables that teach: estimates, explanations, surveys"),
    ("batch", "many jobs: planned, shared out, done once each, merged, verified and reported"),
    ("c", "the C interface: domelight_c.h"),
]
C_INTERFACE = "domelight/domelight_c.h"
ORDER = {name: i for i, (name, _) in enumerate(ROOMS)}


def sources():
    """The files of the library, each with the path by which it is included."""
    for top in ("include", "src"):
        for path in sorted((ROOT / top).rglob("*")):
            # CMake makes version.h from version.h.in.
            if path.suffix in (".h", ".cpp", ".in"):
                yield path, path.relative_to(ROOT / top).as_posix().removesuffix(".in")


def room_of(included):
    """The room that holds a file, by the longest name that fits; None for domelight.h, which stands above them all."""
    if included == C_INTERFACE:
        return "c"
    parts = included.removeprefix("domelight/").split("/")[:-1]
    while parts:
        name = "/".join(parts)
        if name in ORDER:
            return name
        parts.pop()
    return None


def read():
    """edges[room, room] = the includes between them; files[room] = how many; complaints."""
    known = {included for _, included in sources()}
    edges, files, complaints = collections.defaultdict(list), collections.Counter(), []
    for path, included in sources():
        room = room_of(included)
        place = path.relative_to(ROOT).as_posix()
        if room is None and included != "domelight/domelight.h":
            complaints.append(f"{place} is in no room of scripts/code_map.py")
            continue
        files[room] += 1
        for line, text in enumerate(path.read_text().splitlines(), 1):
            found = re.match(r'\s*#\s*include "([^"]+)"', text)
            if not found:
                continue
            if found[1] not in known:
                complaints.append(f"{place}:{line}: no file {found[1]}")
                continue
            target = room_of(found[1])
            if room is None or target == room:
                continue
            edges[room, target].append(f"{place}:{line}")
            if target is None or ORDER[target] > ORDER[room]:
                complaints.append(f"{place}:{line}: {room} includes {found[1]}, which is a layer above it")
    # What no binding could reach: the programs use the public headers alone.
    for folder in ("src", "include", "cli", "tests", "tests/engines/browser", "docs"):
        for inner in [ROOT / folder, *(p for p in (ROOT / folder).rglob("*") if p.is_dir() and "node_modules" not in p.parts)]:
            count = sum(p.is_file() for p in inner.iterdir()) if inner.is_dir() else 0
            if count > MOST_FILES:
                complaints.append(f"{inner.relative_to(ROOT)} holds {count} files; at most {MOST_FILES} can be looked through")
    return edges, files, sorted(set(complaints))


def drawing(edges):
    """A Mermaid graph: an arrow from a room to each room that it includes, unless a longer way says the same."""
    uses = collections.defaultdict(set)
    for a, b in edges:
        uses[a].add(b)

    def reach(room, skip=None):
        seen, todo = set(), [r for r in uses[room] if r != skip]
        while todo:
            r = todo.pop()
            if r not in seen:
                seen.add(r)
                todo += uses[r]
        return seen

    lines = ["```mermaid", "graph BT"]
    for a, _ in ROOMS:
        for b in sorted(uses[a], key=ORDER.get):
            if b not in reach(a, skip=b):
                lines.append(f"    {a.replace('/', '_')}[{a}] --> {b.replace('/', '_')}[{b}]")
    return "\n".join(lines + ["```"])


def page(edges, files):
    rows = ["| room | files | what is in it |", "|---|---|---|"]
    rows += [f"| `{name}` | {files[name]} | {what} |" for name, what in ROOMS]
    return f"{drawing(edges)}\n\n" + "\n".join(rows) + "\n"


def main():
    edges, files, complaints = read()
    begin, end = "<!-- made by scripts/code_map.py -->\n", "<!-- end -->"
    text = PAGE.read_text()
    before, rest = text.split(begin)
    made = before + begin + page(edges, files) + end + rest.split(end, 1)[1]
    if "--check" in sys.argv:
        if made != text:
            complaints.append("docs/code-map.md is not what the includes say: run scripts/code_map.py")
        print("\n".join(complaints), end="\n" if complaints else "")
        return 1 if complaints else 0
    PAGE.write_text(made)
    return 0


if __name__ == "__main__":
    sys.exit(main())
