#!/usr/bin/env python3
"""Fills a folder with small inputs for a fuzz target.

    seeds.py TARGET FOLDER

They are files that the program (DOMELIGHT_PROGRAM) writes, the made-up hostile ones of tests/malformed, and the malformed ones of
DOMELIGHT_DATA. The first word of TARGET is a format (exr_reader_fuzz): files of that format, told by their first bytes, since most malformed
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

LARGEST = 256 << 10  # a mutation of a large file costs as much and finds no more

MAGIC = {
    "hdr": [b"#?"],
    "exr": [b"\x76\x2f\x31\x01"],
    "png": [b"\x89PNG"],
    "jpeg": [b"\xff\xd8"],
    "jpg": [b"\xff\xd8"],
    "ktx2": [b"\xabKTX 20"],
    "ktx1": [b"\xabKTX 11"],
    "ktx": [b"\xabKTX"],
    "dds": [b"DDS "],
}


def made_by(program, folder):
    """Small valid files of every kind the program writes."""
    def run(*arguments):
        subprocess.run([program, *map(str, arguments)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=60, check=False)

    run("sky", "--height", "16", "-o", folder / "sky.hdr")
    run("sky", "--height", "16", "-o", folder / "sky.exr")
    for encoding in ("rgba16f", "rgba32f", "rgb9e5", "r11g11b10f"):
        run("bake", folder / "sky.hdr", "-o", folder / encoding, "--size", "8", "--levels", "2", "--encoding", encoding)
    for target in ("filament", "babylon", "three", "bevy", "khronos"):
        run("bake", folder / "sky.hdr", "-o", folder / target, "--for", target, "--size", "16")


def main():
    target, out = sys.argv[1].split("_")[0], pathlib.Path(sys.argv[2])
    out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        made = pathlib.Path(folder)
        for name, data in hostile_files():
            (made / f"hostile-{name}").write_bytes(data)
        program = os.environ.get("DOMELIGHT_PROGRAM")
        if program and os.access(program, os.X_OK):
            made_by(program, made)
        places = [made, *(pathlib.Path(d, "malformed") for d in [os.environ.get("DOMELIGHT_DATA")] if d)]
        for number, file in enumerate(f for place in places for f in sorted(place.rglob("*")) if f.is_file()):
            with open(file, "rb") as opened:
                head = opened.read(16)
            fits = target not in MAGIC or any(head.startswith(m) for m in MAGIC[target])
            if fits and file.stat().st_size <= LARGEST:
                shutil.copy(file, out / f"{number:04d}-{file.name}"[-200:])


main()
