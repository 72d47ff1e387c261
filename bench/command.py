#!/usr/bin/env python3
"""The time of the whole bake command beside a lower bound: decoding its source and writing its files.

    bench/command.py [SOURCE_4K.hdr] [--runs 9] [--threads 2] [--folder DIR] [--json FILE]

Two jobs: 4096 x 2048 to 1024^2 with 11 levels (RGBA16F), and each of the five photographs of bench/photographs.py, 1024 x 512, to 256^2 as bench/peers.py gives
it to cmgen. For each, one round after the other, so that other work of the machine affects all alike:

    decode + write   the library's reader over the source, and its atomic writer over the bytes of the finished bake (bench/decode_and_write.cpp)
    bare             `domelight bake ... --no-preview --no-hashes`
    whole            `domelight bake ...`

Figures are medians: seconds by the clock, and user and system CPU seconds of the whole process. All write to one folder (--folder, or a temporary one), over the files of the round before. A first round that is not counted fills the page cache with the sources. Without
SOURCE_4K: spruit_sunrise_4k_from_ultrahdr.hdr of $DOMELIGHT_DATA where it is there, else `domelight sky`; the sky stands for the photographs too where they are missing.
"""

import argparse
import json
import os
import pathlib
import platform
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

from photographs import cpu_name, make_sky, photographs, summary

ROOT = pathlib.Path(__file__).resolve().parents[1]
DOMELIGHT = os.environ.get("DOMELIGHT_PROGRAM", str(ROOT / "build/dev/cli/domelight"))
DECODE_AND_WRITE = ROOT / "build/dev/bench/decode_and_write"


def run(command):
    """Output, seconds by the clock and CPU seconds of one process."""
    words = [str(word) for word in command]
    start = time.monotonic()
    process = subprocess.Popen(words, stdout=subprocess.PIPE, text=True)
    output = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    wall = time.monotonic() - start
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"error: {' '.join(words)}: exit status {process.returncode}")
    return output, wall, usage.ru_utime + usage.ru_stime


def large_source(options, work):
    shared = pathlib.Path(os.environ.get("DOMELIGHT_DATA", "")) / "env_highres/spruit_sunrise_4k_from_ultrahdr.hdr"
    if options.source_4k or shared.is_file():
        return options.source_4k or shared
    return make_sky(DOMELIGHT, 2048, work / "sky_4k.hdr")


def measure(source, arguments, folder, options):
    """Medians of interleaved runs of one job."""
    bake = [DOMELIGHT, "bake", source, *arguments, "--threads", options.threads, "--quiet"]
    baked, bare, scratch = folder / "whole", folder / "bare", folder / "scratch"
    scratch.mkdir(parents=True, exist_ok=True)
    runs = {"decode": [], "write": [], "bare": [], "whole": []}
    for round_ in range(options.runs + 1):
        figures = {}
        _, *figures["bare"] = run([*bake, "--no-preview", "--no-hashes", "-o", bare])
        least = json.loads(run([DECODE_AND_WRITE, source, bare, scratch, options.threads])[0])
        _, *figures["whole"] = run([*bake, "-o", baked])
        for step in ("decode", "write"):
            figures[step] = [least[step]["wall_seconds"], least[step]["cpu_seconds"]]
        if round_ > 0:
            for name, pair in figures.items():
                runs[name].append(pair)
    report = {name: {"wall_seconds": statistics.median(w for w, _ in pairs), "cpu_seconds": statistics.median(c for _, c in pairs),
                     "wall_spread": [min(w for w, _ in pairs), max(w for w, _ in pairs)]} for name, pairs in runs.items()}
    together = [d[0] + w[0] for d, w in zip(runs["decode"], runs["write"])]
    report["decode_and_write_wall_seconds"] = statistics.median(together)
    report["bytes_written"] = least["bytes"]
    report["bare_over_decode_and_write"] = statistics.median(b[0] / t for b, t in zip(runs["bare"], together))
    report["whole_over_decode_and_write"] = statistics.median(w[0] / t for w, t in zip(runs["whole"], together))
    return report


def show(title, report):
    print(title)
    for name in ("decode", "write", "bare", "whole"):
        r = report[name]
        print(f"  {name:7} {r['wall_seconds'] * 1e3:8.1f} ms ({r['wall_spread'][0] * 1e3:.1f} to {r['wall_spread'][1] * 1e3:.1f})  {r['cpu_seconds'] * 1e3:8.1f} ms CPU")
    print(f"  decode + write {report['decode_and_write_wall_seconds'] * 1e3:.1f} ms: bare takes {report['bare_over_decode_and_write']:.1f} times as long, "
          f"whole {report['whole_over_decode_and_write']:.1f} times (medians of each round's ratio)")


def file_system(folder):
    done = subprocess.run(["stat", "-f", "-c", "%T", str(folder)], capture_output=True, text=True)
    return done.stdout.strip() or "unknown"


def main():
    parser = argparse.ArgumentParser(description="the bake command beside decoding and writing alone")
    parser.add_argument("source_4k", nargs="?", type=pathlib.Path)
    parser.add_argument("--runs", type=int, default=9)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--folder", type=pathlib.Path, help="where to write; a folder of ours is made in it and removed")
    parser.add_argument("--json", type=pathlib.Path, help="write the figures here too")
    options = parser.parse_args()
    if options.runs < 1:
        parser.error("--runs must be at least 1")
    work = pathlib.Path(tempfile.mkdtemp(prefix="domelight-command-", dir=options.folder))
    try:
        first = large_source(options, work)
        report = {"machine": {"cpu": cpu_name(), "cores": os.cpu_count(), "system": platform.platform(), "file_system": file_system(work)},
                  "runs": options.runs, "threads": options.threads}
        report["1024 from 4k"] = measure(first, ["--size", 1024, "--levels", 11, "--encoding", "rgba16f"], work / "large", options)
        show(f"{first.name} to 1024^2, 11 levels, rgba16f ({report['machine']['file_system']}, {options.threads} threads)", report["1024 from 4k"])
        shutil.rmtree(work / "large")
        small = photographs() or {"sky": make_sky(DOMELIGHT, 512, work / "sky_1k.hdr")}
        report["256 from 1k"] = {}
        for kind, source in small.items():
            one = report["256 from 1k"][kind] = measure(source, ["--size", 256, "--levels", 5, "--for", "filament"], work / "small", options)
            show(f"{source.name} to 256^2, 5 levels, for filament", one)
        for name in ("bare", "whole"):
            ratio = summary({kind: r[f"{name}_over_decode_and_write"] for kind, r in report["256 from 1k"].items()})
            cpu = summary({kind: r[name]["cpu_seconds"] for kind, r in report["256 from 1k"].items()})
            print(f"256^2 from 1k, {name}: median {cpu['median'] * 1e3:.0f} ms CPU, worst {cpu['worst'] * 1e3:.0f} ms ({cpu['worst_kind']}); "
                  f"{ratio['median']:.1f} and {ratio['worst']:.1f} times decode + write")
        if options.json:
            options.json.write_text(json.dumps(report, indent=1) + "\n")
    finally:
        shutil.rmtree(work, ignore_errors=True)


if __name__ == "__main__":
    main()
