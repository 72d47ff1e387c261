#!/usr/bin/env python3
"""Compares block encoders on the same pictures in one run, one thread each: speed, and PSNR of log radiance by the same decoder.

    bench/encoders.py [PICTURE.hdr...]      (sides that are multiples of 4 texels; without any, those under DOMELIGHT_DATA)

Ours against npm's ktx2-encoder (Basis Universal's encoder as WebAssembly; DOMELIGHT_ORACLES names a folder with its node_modules, see
tests/oracles) at each of its levels, of which 1 is the default. Prints a table, and JSON with --json. The best of three runs after a warm-up.
"""

import importlib.util
import json
import os
import platform
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
spec = importlib.util.spec_from_file_location("oracles", ROOT / "tests/oracles/run_oracles.py")
oracles = importlib.util.module_from_spec(spec)
spec.loader.exec_module(oracles)
JUDGE = oracles.BUILD / "bench/texture_error"
OURS = [("uastc-hdr", "fast"), ("uastc-hdr", "default"), ("uastc-hdr", "high"), ("astc4x4-hdr", "fast"), ("astc4x4-hdr", "default"), ("astc6x6-hdr", "default")]
LEVELS = [0, 1, 2]


def measure(picture, folder):
    rows = []
    for encoding, quality in OURS:
        out = Path(folder) / f"{encoding}-{quality}.ktx2"
        found = json.loads(oracles.run(JUDGE, "--encode", encoding, quality, picture, out))
        rows.append({"encoder": f"{encoding} {quality}", "seconds": found["seconds"], "file": str(out)})
    for level in LEVELS:
        out = Path(folder) / f"reference-{level}.ktx2"
        found = oracles.basis("encode", picture, out, level)
        rows.append({"encoder": f"ktx2-encoder level {level}", "seconds": found["seconds"], "file": str(out)})
    for row, figures in zip(rows, json.loads(oracles.run(JUDGE, picture, *[r["file"] for r in rows]))):
        row.update({k: v for k, v in figures.items() if k != "file"})
    return rows


def main(words):
    as_json = "--json" in words
    pictures = [Path(w) for w in words if not w.startswith("-")]
    if not pictures:
        data = Path(os.environ["DOMELIGHT_DATA"])
        pictures = [data / "hdr_crops/hdr-rgb-bellparkpier.hdr", data / "hdr_crops/hdr-rgb-arboretum.hdr",
                    data / "reference/symmetrical_garden/symmetrical_garden_1k.hdr"]
    results = {}
    with tempfile.TemporaryDirectory(prefix="domelight-encoders-") as folder:
        for picture in pictures:
            results[picture.name] = measure(picture, folder)
    if as_json:
        print(json.dumps({"machine": platform.processor() or platform.machine(), "pictures": results}, indent=1))
        return
    for name, rows in results.items():
        print(f"{name}\n  {'':<24}{'CPU s':>8}{'log PSNR':>10}{'luminance':>11}{'linear RMS':>12}")
        for r in rows:
            print(f"  {r['encoder']:<24}{r['seconds']:>8.3f}{r['log_psnr']:>10.2f}{r['log_psnr_luminance']:>11.2f}{r['relative_rms']:>12.4f}")
        ours = next(r for r in rows if r["encoder"] == "uastc-hdr default")
        theirs = next(r for r in rows if r["encoder"] == "ktx2-encoder level 1")
        print(f"  uastc-hdr against their default: {theirs['seconds'] / ours['seconds']:.0f} times as fast, {ours['log_psnr'] - theirs['log_psnr']:+.2f} dB")


if __name__ == "__main__":
    main(sys.argv[1:])
