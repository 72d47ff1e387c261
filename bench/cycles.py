#!/usr/bin/env python3
"""Cycles beside domelight on the same scenes, in one run: whether they agree, and the CPU time of each to the same error.

    bench/cycles.py agree [--bounces 7] [--seeds 8] [--samples 128]
    bench/cycles.py speed

The scenes: a sphere, and a knot over a floor, each Lambert 0.8 and as a GGX metal (F = 1) of roughness 0.3 and 0.6, under a sun and a sky:
sphere_l.glb, knot_l.glb and sunsky_2048.exr of the folder $DOMELIGHT_DATA/bench (or --data). agree: several pictures with different seeds from both; the means of objects, and the differences of pixels relative to their standard errors. Cycles up to 3.4 multiplies Smith's masking and shadowing, where glTF and later
versions correlate them: at roughness 0.6 that is 0.2 % of the light, so a second line of each metal has the same model in both. speed: one thread, tone-mapped RMSE, each against its own converged
picture; scene and tables are built before the clock starts, on both sides.

Needs Debian's blender; the programs come from `cmake --build --preset dev --target benchmarks`.
"""

import argparse
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
BENCH = os.environ.get("DOMELIGHT_RENDER_BENCH", str(ROOT / "build/dev/bench/render_bench"))
SCENES = [(s, m) for s in ("sphere", "knot") for m in ("lambert:0.8", "metal:0.3", "metal:0.6")]


def run(command, **options):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, **options)
    if done.returncode != 0:
        sys.exit(f"error: {' '.join(map(str, command))}\n{done.stdout[-500:]}{done.stderr[-2000:]}")
    return done.stdout


def cycles(model, environment, out, material, samples, seeds, bounces):
    """CPU seconds by (samples, seed)."""
    # Debian's blender needs Debian's python and numpy, even if others come first on the path.
    system = dict(os.environ, PATH="/usr/bin:/bin")
    text = run(["blender", "-b", "--factory-startup", "-P", ROOT / "bench/cycles_scene.py", "--", model, environment, out, "--material", material, "--samples",
                ",".join(map(str, samples)), "--seeds", ",".join(map(str, seeds)), "--bounces", bounces], env=system)
    rows = [json.loads(line) for line in re.findall(r"^CYCLES (.*)$", text, re.M)]
    if len(rows) != len(samples) * len(seeds):
        sys.exit(f"error: Cycles made {len(rows)} pictures\n{text[-2000:]}")
    return {(r["samples"], r["seed"]): r["cpu_seconds"] for r in rows}


def ours(mode, model, environment, material, *more):
    text = run([BENCH, mode, "--scene", model, "--env", environment, "--material", material, *more])
    return [json.loads(line) for line in text.splitlines() if line.startswith("{")]


def agree(words, folder):
    print(f"{'scene':8} {'material':12} {'object':10} {'ours / Cycles':>14} {'+-':>8} {'mean z':>8} {'var z':>7} {'(exp.)':>7} {'|z| > 4':>8}")
    worst = 0
    for scene, material in SCENES:
        model = words.data / f"{scene}_l.glb"
        pattern = f"{folder}/{scene}_{material.replace(':', '')}_%d_%d.exr"
        seeds = range(words.seeds)
        cycles(model, words.data / "sunsky_2048.exr", pattern, material, [words.samples], seeds, words.bounces)
        files = [pattern % (words.samples, s) for s in seeds]
        more = ["--bounces", words.bounces, "--samples", words.samples, "--theirs", *files]
        rows = ours("agree", model, words.data / "sunsky_2048.exr", material, *more)
        if material.startswith("metal"):
            for row in ours("agree", model, words.data / "sunsky_2048.exr", material, "--separable-masking", *more):
                rows.append(row | {"object": row["object"] + " G1G1"})
        for row in rows:
            worst = max(worst, abs(row["mean_ratio"] - 1))
            print(f"{scene:8} {material:12} {row['object']:10} {row['mean_ratio']:14.5f} {row['ratio_error']:8.5f} {row['z_mean']:8.3f} "
                  f"{row['z_variance']:7.3f} {row['expected_variance']:7.3f} {row['beyond_4']:8.5f}", flush=True)
    print(f"largest difference of an object's mean: {100 * worst:.2f} %")


def to_error(rows, error):
    """CPU seconds at which the error is reached, interpolated by a power law between two sample counts."""
    for (t0, e0), (t1, e1) in zip(rows, rows[1:]):
        if e1 <= error <= e0:
            return t0 * (t1 / t0) ** (math.log(e0 / error) / math.log(e0 / e1))
    t, e = rows[-1] if rows[-1][1] > error else rows[0]
    return t * (e / error) ** 2


def cycles_error(picture, reference):
    compare = [os.environ.get("DOMELIGHT_PROGRAM", str(ROOT / "build/dev/cli/domelight")), "compare", picture, reference, "--json"]
    return json.loads(run(compare))["errors"]


def speed(words, folder):
    print(f"{'scene':8} {'material':12} {'domelight s':>12} {'Cycles s':>10} {'ratio':>7}   to a tone-mapped RMSE of {words.error}")
    for scene, material in SCENES:
        model, environment = words.data / f"{scene}_l.glb", words.data / "sunsky_2048.exr"
        pattern = f"{folder}/{scene}_{material.replace(':', '')}_%d_%d.exr"
        # The time of the first picture includes the set-up of the scene and is not counted; of the others, the median over three seeds.
        counts = [4, 8, 16, 32, 64]
        time = cycles(model, environment, pattern, material, [1] + counts, [0, 1, 2], 0)
        cycles(model, environment, pattern, material, [1024], [77], 0)
        theirs = []
        for n in counts:
            errors = [cycles_error(pattern % (n, s), pattern % (1024, 77)) for s in range(3)]
            rmse = math.sqrt(sum(e["tone_mapped_rmse"] ** 2 for e in errors) / 3)
            theirs.append((sorted(time[n, s] for s in range(3))[1], rmse))
        mine = [(r["cpu_seconds"], r["rmse"]) for r in ours("converge", model, environment, material)]
        a, b = to_error(mine, words.error), to_error(theirs, words.error)
        print(f"{scene:8} {material:12} {a:12.4f} {b:10.4f} {b / a:7.2f}", flush=True)


def main():
    parser = argparse.ArgumentParser(description="Cycles beside domelight: agreement and speed")
    parser.add_argument("mode", choices=["agree", "speed"])
    parser.add_argument("--data", type=pathlib.Path, default=pathlib.Path(os.environ.get("DOMELIGHT_DATA", ".")) / "bench")
    parser.add_argument("--bounces", type=int, default=0, help="of indirect light")
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("--samples", type=int, default=128)
    parser.add_argument("--error", type=float, default=0.01)
    words = parser.parse_args()
    if not (words.data / "sunsky_2048.exr").exists():
        sys.exit(f"error: {words.data} has no sunsky_2048.exr: set DOMELIGHT_DATA, or --data FOLDER")
    with tempfile.TemporaryDirectory() as folder:
        (agree if words.mode == "agree" else speed)(words, folder)


main()
