#!/usr/bin/env python3
"""Three interiors with openings, lit by one environment and by probes, each against the path-traced truth.

    bench/probe_error.py [--scenes rooms,cornell,zdm2] [--width 96] [--spp 1024] [--probe-spp 16] [--whole] [--folder DIR] [--json FILE]

    rooms     two rooms with windows and a door between them (docs/figures/probes/rooms.py), noon sky
    cornell   CornellBox.glb of $DOMELIGHT_DATA, whose open side lets the environment in, with its lamp
    zdm2      zdm2.glb of $DOMELIGHT_DATA, a hall with four openings. The file states no material; it is given plaster

The figure is the RMSE of L / (1 + L), as `domelight compare` prints it, with the environment brightened so that the truth has about the exposure of a display. "one environment" is
split-sum with the maps of the whole environment and no shadows; "probes" the same shader with `--probes`; the other columns leave out one part each. As in an engine, the sun is a
light of its own that casts shadows (`domelight lights`), and the probes have its reflected light; with --whole it is in the probes alone, which blur its patches on the floor. The truth
has its own noise, which all columns include. --folder keeps the pictures and the truth, which a second run does not compute again. About ten minutes of processor time.
"""

import argparse
import json
import os
import pathlib
import struct
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "docs/figures/probes"))
import rooms  # noqa: E402

PROGRAM = os.environ.get("DOMELIGHT_PROGRAM", str(ROOT / "build/release/cli/domelight"))
DATA = pathlib.Path(os.environ.get("DOMELIGHT_DATA", "."))
NOON, FIELD = "env_latlong/noon_grass_1k.hdr", "env_latlong/kloppenheim_05_1k.hdr"

VARIANTS = {"one environment": ["--occlusion", "off"], "probes": ["--probes", "PROBES"], "no visibility": ["--probes", "PROBES", "--probe-visibility", "off"],
            "no parallax": ["--probes", "PROBES", "--parallax", "off"], "2 blended": ["--probes", "PROBES", "--probe-blend", "2"],
            "harmonics": ["--probes", "PROBES", "--irradiance", "sh"]}


def with_plaster(source, target):
    """Copies a .glb, with one material for everything."""
    data = source.read_bytes()
    length = struct.unpack("<I", data[12:16])[0]
    document, rest = json.loads(data[20:20 + length]), data[20 + length:]
    document["materials"] = [{"name": "plaster", "pbrMetallicRoughness": {"baseColorFactor": [0.75, 0.72, 0.68, 1], "metallicFactor": 0, "roughnessFactor": 0.8}}]
    for mesh in document["meshes"]:
        for primitive in mesh["primitives"]:
            primitive["material"] = 0
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + rest
    target.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)


def scene_file(name, folder):
    if name == "cornell":
        return DATA / "models/CornellBox.glb"
    file = folder / f"{name}.glb"
    if name == "rooms":
        file.write_bytes(rooms.two_rooms())
    else:
        with_plaster(DATA / "models/zdm2.glb", file)
    return file


# How each scene is lit, seen, and filled with probes. spp: times that of the others, for a lamp that paths only meet by chance.
SCENES = {
    "rooms": {"env": DATA / NOON, "exposure": 4.5, "camera": rooms.CAMERA, "probes": ["--grid", "9,3,4", "--region", "0,0,0,9,2.8,4"]},
    "cornell": {"env": DATA / NOON, "exposure": 0, "spp": 4, "camera": ("-278,273,560", "-278,273,-280", 50), "probes": ["--grid", "5,5,5", "--size", 32]},
    "zdm2": {"env": DATA / FIELD, "exposure": 1.5, "camera": ("2.5,2.2,2.5", "-3,1.2,-3", 75), "probes": ["--grid", "8,3,8", "--region", "-6,0,-6,6,4,6", "--size", 32]},
}


def domelight(*words):
    done = subprocess.run([PROGRAM, *map(str, words), "--json"], check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    return json.loads(done.stdout)


def sun_and_rest(environment, folder):
    """The options for an environment whose sun is a light of its own."""
    out = folder / environment.stem
    if not out.exists():
        domelight("lights", environment, "-o", out, "--no-preview")
    return ["--env", out / "remainder.hdr", "--lights", out / "lights.gltf"]


def measure(name, arguments, folder):
    scene, how = scene_file(name, folder), SCENES[name]
    eye, target, fov = how["camera"]
    view = [f"--camera-position={eye}", f"--camera-target={target}", "--fov-deg", fov, "--width", arguments.width, "--height", arguments.width * 2 // 3]
    whole = ["--env", how["env"], "--exposure", how["exposure"]]
    light = whole if arguments.whole else sun_and_rest(how["env"], folder) + whole[2:]
    truth = folder / f"{name}_truth.exr"
    if not truth.exists():
        domelight("render", scene, *whole, *view, "--spp", arguments.spp * how.get("spp", 1), "--bounces", 8, "-o", truth)
    probes = folder / f"{name}_probes{'_whole' if arguments.whole else ''}"
    made = {"probes": None}
    if not (probes / "probes.json").exists():
        made = domelight("probes", scene, *light, *how["probes"], "--spp", arguments.probe_spp, "--bounces", 8, "-o", probes)
    row = {"scene": name, "probes": len(json.loads((probes / "probes.json").read_text())["probes"]), "capture": made, "error": {}}
    for variant, options in VARIANTS.items():
        picture = folder / f"{name}_{variant.replace(' ', '_')}.exr"
        domelight("render", scene, *(light if "--probes" in options else whole), *view, "--spp", 16, "--shading", "split-sum", *[probes if o == "PROBES" else o for o in options], "-o", picture)
        row["error"][variant] = domelight("compare", picture, truth, "--no-flip")["errors"]["tone_mapped_rmse"]
    row["ratio"] = row["error"]["probes"] / row["error"]["one environment"]
    return row


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", default="rooms,cornell,zdm2")
    parser.add_argument("--width", type=int, default=96)
    parser.add_argument("--spp", type=int, default=1024)
    parser.add_argument("--probe-spp", type=int, default=16)
    parser.add_argument("--whole", action="store_true")
    parser.add_argument("--folder", type=pathlib.Path)
    parser.add_argument("--json", type=pathlib.Path)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = arguments.folder or pathlib.Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        rows = []
        for name in arguments.scenes.split(","):
            rows.append(measure(name, arguments, folder))
            row = rows[-1]
            print(f"{name:8} {row['probes']:4} probes  " + "  ".join(f"{v} {e:.4f}" for v, e in row["error"].items()) + f"  probes / one environment {row['ratio']:.3f}", flush=True)
        if arguments.json:
            arguments.json.write_text(json.dumps(rows, indent=1))


if __name__ == "__main__":
    main()
