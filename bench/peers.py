#!/usr/bin/env python3
"""Compares cmgen and domelight on the same job in one run: the CPU time of each, and the error of each against the truth.

    bench/peers.py [SOURCE.hdr ...] [--size 256] [--runs 3] [--samples 1024] [--texels 100] [--json FILE]

The job: a lat-long .hdr in; out a specular cube chain at cmgen's roughness of each level (perceptual 1 - sqrt(1 - l / M)), its skybox and spherical
harmonics, as Filament loads them (KTX1, R11F_G11F_B10F). Time is user and system CPU seconds of the whole process, the best of several runs for
domelight and of one or more for cmgen. The error is that of a second pair of runs that stores floats (domelight) and halves (cmgen's EXR), so that the filters are
compared and not the encoding. Without SOURCE: the five photographs of bench/photographs.py, their median and their worst, and beside them the built-in sky.

cmgen comes with Debian's libfilament-tools; the programs come from `cmake --build --preset dev --target benchmarks`.
"""

import argparse
import json
import math
import os
import pathlib
import platform
import resource
import shutil
import subprocess
import sys
import tempfile
import time

from photographs import cpu_name, make_sky, photographs, summary

ROOT = pathlib.Path(__file__).resolve().parents[1]
DOMELIGHT = os.environ.get("DOMELIGHT_PROGRAM", str(ROOT / "build/dev/cli/domelight"))
PEER_ERROR = ROOT / "build/dev/bench/peer_error"


def cpu_seconds(command):
    """(CPU, wall) seconds of one run of a command."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    done = subprocess.run([str(c) for c in command], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    wall, after = time.monotonic() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        sys.exit(f"error: {' '.join(map(str, command))}\n{done.stderr}")
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime, wall


def best(command, runs):
    return min(cpu_seconds(command) for _ in range(runs))


def error_of(source, roughness, chain, texels):
    command = [PEER_ERROR, source, ",".join(map(repr, roughness)), chain, texels]
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"error: {done.stderr}")
    return json.loads(done.stdout)


def compare(source, options, work):
    """Runs both programs on one source and prints what came out."""
    levels = int(math.log2(options.size)) - 3  # cmgen goes down to 16^2
    roughness = [1 - math.sqrt(1 - l / (levels - 1)) for l in range(levels)]
    cmgen = ["cmgen", "--quiet", f"--size={options.size}", f"--ibl-samples={options.samples}"]
    peer = cpu_seconds([*cmgen, "--format=ktx", f"--deploy={work / 'cmgen'}", source])
    if peer[0] < 5:
        peer = min(peer, best([*cmgen, "--format=ktx", f"--deploy={work / 'cmgen'}", source], options.runs - 1))
    bake = [DOMELIGHT, "bake", source, "--size", str(options.size), "--levels", str(levels), "--quiet", "--threads", "1"]
    ours = best([*bake, "--for", "filament", "-o", work / "ours"], options.runs)
    bare = best([*bake, "--for", "filament", "--no-preview", "--no-hashes", "-o", work / "bare"], options.runs)

    report = {
        "source": source.name, "levels": levels,
        "cmgen": {"cpu_seconds": peer[0], "wall_seconds": peer[1]},
        "domelight": {"cpu_seconds": ours[0], "wall_seconds": ours[1], "cpu_seconds_without_preview_and_hashes": bare[0]},
        "cpu_ratio": peer[0] / ours[0], "cpu_ratio_without_preview_and_hashes": peer[0] / bare[0],
    }
    print(f"{source.name} to {options.size}^2, {levels} levels")
    print(f"  cmgen      {peer[0]:9.2f} s CPU {peer[1]:9.2f} s wall")
    print(f"  domelight  {ours[0]:9.3f} s CPU {ours[1]:9.3f} s wall   {report['cpu_ratio']:.0f} x less CPU")
    print(f"    without preview and hashes {bare[0]:.3f} s CPU           {report['cpu_ratio_without_preview_and_hashes']:.0f} x less CPU")
    if not options.texels:
        return report

    cpu_seconds([*cmgen, "--format=exr", f"--ibl-ld={work / 'faces'}", source])
    faces = next((work / "faces").rglob("m1_px.exr")).parent
    cpu_seconds([*bake, "--roughness", ",".join(f"{r:.17g}" for r in roughness), "--encoding", "rgba32f", "--texels", "centre", "-o", work / "exact"])
    for name, chain in (("cmgen", faces), ("domelight", work / "exact" / "specular.ktx2")):
        report[name]["error"] = error_of(source, roughness, chain, options.texels)
    print("  error against the truth (relative RMS, largest)\n    level roughness          cmgen               domelight")
    for a, b in zip(report["cmgen"]["error"]["levels"], report["domelight"]["error"]["levels"]):
        print(f"    {a['level']:5d} {a['roughness']:9.3f}   {a['rms']:8.1e} {a['max']:8.1e}   {b['rms']:8.1e} {b['max']:8.1e}   "
              f"{a['rms'] / b['rms']:6.0f} x less")
    worst = [max(l["rms"] for l in report[n]["error"]["levels"]) for n in ("cmgen", "domelight")]
    report["error_ratio"] = worst[0] / worst[1]
    print(f"    worst level: {worst[0]:.1e} and {worst[1]:.1e}, {report['error_ratio']:.0f} x less")
    print(f"    light lies in cmgen's cube as {report['cmgen']['error']['orientation']}, in ours as {report['domelight']['error']['orientation']}")
    return report


def main():
    parser = argparse.ArgumentParser(description="cmgen beside domelight: CPU time and error")
    parser.add_argument("source", nargs="*", type=pathlib.Path)
    parser.add_argument("--size", type=int, default=256)
    parser.add_argument("--runs", type=int, default=3, help="of domelight; cmgen runs once beyond 5 s")
    parser.add_argument("--samples", type=int, default=1024, help="cmgen's samples a texel (its default)")
    parser.add_argument("--texels", type=int, default=100, help="at which the error of a level is measured; 0: times only")
    parser.add_argument("--json", type=pathlib.Path, help="write the figures here too")
    options = parser.parse_args()
    if not shutil.which("cmgen"):
        sys.exit("error: cmgen is not installed. Type: sudo apt-get install libfilament-tools")

    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        named = {source.stem: source for source in options.source} or photographs()
        report = {"size": options.size, "samples": options.samples,
                  "machine": {"cpu": cpu_name(), "cores": os.cpu_count(), "system": platform.platform()}, "sources": {}}
        sky = [] if options.source else [("sky", make_sky(DOMELIGHT, 512, folder / "sky.hdr"))]
        for kind, source in [*named.items(), *sky]:
            work = folder / kind.replace(" ", "_")
            work.mkdir()
            report["sources"][kind] = compare(source, options, work)
        if len(named) > 1:
            print(f"\nof {len(named)} photographs, median and worst:")
            for key, text in (("cpu_ratio_without_preview_and_hashes", "times less CPU, without preview and hashes"), ("cpu_ratio", "times less CPU"),
                              ("error_ratio", "times less error")):
                if key in report["sources"][next(iter(named))]:
                    report[key] = summary({kind: report["sources"][kind][key] for kind in named}, worst=min)
                    print(f"  {report[key]['median']:6.0f} {report[key]['worst']:6.0f} ({report[key]['worst_kind']})  {text}")
        if options.json:
            options.json.write_text(json.dumps(report, indent=1) + "\n")


if __name__ == "__main__":
    main()
