#!/usr/bin/env python3
"""Fills a folder with small inputs for a fuzz target.

    seeds.py TARGET FOLDER

They are files that the program (DOMELIGHT_PROGRAM) writes, the made-up hostile ones of tests/malformed, small scenes, and the
malformed ones of DOMELIGHT_DATA. The first word of TARGET is a format (exr_reader_fuzz): files of that format, told by their first bytes, since most malformed
ones have no usual name. A target of another name gets all.
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "tests" / "malformed"))
from hostile import hostile_files  # noqa: E402
from scene_samples import scene_files  # noqa: E402

LARGEST = 256 << 10  # a mutation of a large file costs as much and finds no more

MAGIC = {
    "hdr": [b"#?"],
    "exr": [b"\x76\x2f\x31\x01"],
    "png": [b"\x89PNG"],
    "jpeg": [b"\xff\xd8"],
    "ldr": [b"\x89PNG", b"\xff\xd8"],
    "jpg": [b"\xff\xd8"],
    "ktx2": [b"\xabKTX 20"],
    "ktx1": [b"\xabKTX 11"],
    "ktx": [b"\xabKTX"],
    "dds": [b"DDS "],
    "env": [b"\x86\x16\x87\x96\xf6\xd6\x96\x36"],
    "atlas": [b"\x89PNG"],
    "imagelight": [b"glTF", b"{"],
    "gltf": [b"glTF", b"{"],
    "obj": [b"# obj"],
    "ply": [b"ply"],
    "texture": [b"\x89PNG", b"\xff\xd8", b"RIFF"],
}


def make(program, folder):
    """Small valid files of every kind the program writes. What this program cannot write yet is left out."""
    def run(*arguments):
        subprocess.run([program, *map(str, arguments)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)

    def bake(name, *options):
        run("bake", folder / "sky.hdr", "-o", folder / name, "--no-preview", "--no-hashes", "--brdf-size", "8", "--irradiance-size", "8", *options)

    run("sky", "--height", "16", "-o", folder / "sky.hdr")
    for kind in ("half", "float"):
        run("sky", "--height", "16", "--exr", kind, "-o", folder / f"sky-{kind}.exr")
    run("sky", "--axes", "--height", "16", "-o", folder / "axes.png")
    for encoding in ("rgba16f", "rgba32f", "rgb9e5", "r11g11b10f", "bc6h", "rgbm"):
        bake(encoding, "--size", "8", "--levels", "2", "--encoding", encoding)
    for engine in ("babylon", "gltf", "playcanvas"):
        run("bake", folder / "sky.hdr", "-o", folder / engine, "--for", engine, "--no-preview", "--no-hashes", *([] if engine == "playcanvas" else ["--size", "8"]))
    for container in ("ktx1", "dds", "dds9", "exr", "exr-mip", "hdr"):
        bake(container, "--size", "8", "--levels", "2", "--format", container)
    for container in ("ktx1", "dds"):
        bake(f"bc6h-{container}", "--size", "8", "--levels", "2", "--format", container, "--encoding", "bc6h")
    bake("zstd", "--size", "8", "--levels", "2", "--zstd")


def made_by(program):
    """The folder of the files that `program` makes, made once for each build of it."""
    folder = HERE.parent / "build" / "seeds"
    stamp, state = folder / "stamp", f"{program} {os.stat(program).st_mtime_ns}"
    if not stamp.exists() or stamp.read_text() != state:
        shutil.rmtree(folder, ignore_errors=True)
        (folder / "made").mkdir(parents=True)
        make(program, folder / "made")
        stamp.write_text(state)
    return folder / "made"


def main():
    target, out = sys.argv[1].split("_")[0], pathlib.Path(sys.argv[2])
    out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        places = [pathlib.Path(folder)]
        for name, data in hostile_files():
            (places[0] / f"hostile-{name}").write_bytes(data)
        for name, data in scene_files():
            (places[0] / f"scene-{name}").write_bytes(data)
        if "DOMELIGHT_PROGRAM" in os.environ:
            places.append(made_by(os.environ["DOMELIGHT_PROGRAM"]))
        if "DOMELIGHT_DATA" in os.environ:
            places.append(pathlib.Path(os.environ["DOMELIGHT_DATA"], "malformed"))
        for number, file in enumerate(f for place in places for f in sorted(place.rglob("*")) if f.is_file()):
            with open(file, "rb") as opened:
                head = opened.read(16)
            fits = target not in MAGIC or any(head.startswith(m) for m in MAGIC[target])
            if fits and file.stat().st_size <= LARGEST:
                shutil.copy(file, out / f"{number:04d}-{file.name}"[-200:])


main()
