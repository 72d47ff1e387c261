#!/usr/bin/env python3
"""Compares our encoders and decoders with others: the Basis Universal transcoder that three.js ships, its encoder (npm's ktx2-encoder) and
ktx-parse. Closes with the line that ./test adds up; what cannot be installed here is skipped, and the reason is printed.

The packages come from DOMELIGHT_ORACLES, a folder with node_modules, or else are installed into build/oracles.
"""

import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import traceback
from math import log2, sqrt
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
BUILD = Path(os.environ.get("DOMELIGHT_BUILD", ROOT / "build/dev"))
PROGRAM = os.environ.get("DOMELIGHT_PROGRAM", str(BUILD / "cli/domelight"))
ASTC_4X4_SFLOAT, UASTC_HDR, ZSTD, BT709, LINEAR = 1000066000, 167, 2, 1, 1


class Skipped(Exception):
    pass


def run(*words, **options):
    result = subprocess.run([str(w) for w in words], capture_output=True, text=True, timeout=600, **options)
    assert result.returncode == 0, f"{words}: exit {result.returncode}\n{result.stdout[-2000:]}{result.stderr[-2000:]}"
    return result.stdout


def node_modules():
    """The folder with the packages of package.json; installs them if npm exists and can reach its registry."""
    if "DOMELIGHT_ORACLES" in os.environ:
        return Path(os.environ["DOMELIGHT_ORACLES"]) / "node_modules"
    if not shutil.which("node"):
        raise Skipped("node is not installed")
    folder = ROOT / "build/oracles"
    if not (folder / "node_modules/ktx2-encoder").is_dir():
        if not shutil.which("npm"):
            raise Skipped("npm is not installed, and DOMELIGHT_ORACLES names no folder with its packages")
        folder.mkdir(parents=True, exist_ok=True)
        shutil.copy(HERE / "package.json", folder)
        try:
            subprocess.run(["npm", "install", "--no-audit", "--no-fund"], cwd=folder, check=True, capture_output=True, timeout=180)
        except (subprocess.CalledProcessError, subprocess.TimeoutExpired):
            raise Skipped("npm cannot install ktx2-encoder, ktx-parse and three") from None
    return folder / "node_modules"


def basis(*words):
    return json.loads(run("node", HERE / "basis.mjs", node_modules(), *words).splitlines()[-1])


def halves(file):
    data = Path(file).read_bytes()
    return struct.unpack(f"<{len(data) // 2}e", data)


def test_reference_transcoder_reads_every_mode_as_we_do(folder):
    run(BUILD / "tests/uastc_samples", "samples.ktx2", "ours.halves", cwd=folder)
    found = basis("decode", folder / "samples.ktx2", folder / "theirs.halves")
    assert found["valid"] and not found["failed"], found
    ours, theirs = (folder / "ours.halves").read_bytes(), (folder / "theirs.halves").read_bytes()
    texels = len(ours) // 6
    assert len(theirs) == texels * 8
    different = [i for i in range(texels) if ours[6 * i:6 * i + 6] != theirs[8 * i:8 * i + 6]]
    assert not different, f"{len(different)} of {texels} texels differ"


def test_three_js_gets_what_its_loader_wants(folder):
    bake = [PROGRAM, "bake", "-o", "out", "--size", 64, "--no-preview", "--force"]
    run(*bake, "--for", "three", cwd=folder)
    file = next((folder / "out").glob("*.pmrem.ktx2"))
    found = basis("decode", file, folder / "theirs.halves")
    wanted = {"vkFormat": ASTC_4X4_SFLOAT, "model": UASTC_HDR, "scheme": ZSTD, "width": 64, "height": 64, "faces": 6, "levels": 4,
              "primaries": BT709, "transfer": LINEAR}
    assert {k: found[k] for k in wanted} == wanted, found
    assert found["valid"] and not found["failed"], found
    # Against the same light as floats, texel by texel: level-major, faces +X -X +Y -Y +Z -Z in both.
    run(*bake, "--for", "three", "--encoding", "rgba32f", "--no-zstd", cwd=folder)
    data = next((folder / "out").glob("*.pmrem.ktx2")).read_bytes()
    floats = []
    for level in range(4):
        offset, size, _ = struct.unpack_from("<3Q", data, 80 + 24 * level)
        floats += struct.unpack_from(f"<{size // 4}f", data, offset)
    theirs = halves(folder / "theirs.halves")
    assert len(theirs) == len(floats)
    at = 0
    for size in [64, 32, 16, 8]:
        count = 6 * size * size * 4
        off = [log2(max(theirs[i], 1e-4) / min(max(floats[i], 1e-4), 65216)) for i in range(at, at + count) if i % 4 < 3]
        rms = sqrt(sum(o * o for o in off) / len(off))
        # A wrong or turned face would differ by octaves.
        assert rms < 0.08, f"{rms} octaves at {size}^2"
        at += count


def compare_encoders(folder, picture):
    """Log-radiance PSNR of ours and of the reference encoder's default on one picture."""
    run(BUILD / "bench/texture_error", "--encode", "uastc-hdr", "default", picture, folder / "ours.ktx2")
    basis("encode", picture, folder / "theirs.ktx2", 1)
    return json.loads(run(BUILD / "bench/texture_error", picture, folder / "ours.ktx2", folder / "theirs.ktx2"))


def test_within_a_decibel_of_the_reference_encoder(folder):
    run(PROGRAM, "sky", "-o", "sky.hdr", "--height", 128, cwd=folder)
    pictures = [folder / "sky.hdr"]
    data = os.environ.get("DOMELIGHT_DATA")
    if data:
        pictures += [p for p in [Path(data) / "reference/materialx_irradiance/san_giuseppe_bridge.hdr"] if p.exists()]
    for picture in pictures:
        ours, theirs = compare_encoders(folder, picture)
        for figure in ["log_psnr", "log_psnr_luminance"]:
            assert ours[figure] > theirs[figure] - 1, (picture.name, figure, ours, theirs)


def main():
    counts = {"passed": 0, "failed": 0, "skipped": 0}
    for name, test in [(n, t) for n, t in globals().items() if n.startswith("test_")]:
        with tempfile.TemporaryDirectory(prefix="domelight-oracles-") as folder:
            try:
                test(Path(folder))
                counts["passed"] += 1
            except Skipped as why:
                counts["skipped"] += 1
                print(f"skipped: {why}")
            except Exception:
                counts["failed"] += 1
                print(f"FAILED: {name}")
                traceback.print_exc(file=sys.stdout)
    print("oracles: {passed} passed, {failed} failed, {skipped} skipped".format(**counts))
    return 1 if counts["failed"] else 0


if __name__ == "__main__":
    sys.exit(main())
