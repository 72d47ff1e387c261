#!/usr/bin/env python3
"""`domelight convert` of a 4096 x 2048 lat-long map to 1024^2 faces beside a lower bound: decoding its source and writing its files.

    bench/convert.py [SOURCE_4K.hdr] [--runs 9] [--threads 1] [--json FILE]

One round after the other, CPU seconds (user and system), medians: `convert SOURCE cube.hdr --to cube --layout faces --size 1024` as a whole process, and
bench/decode_and_write.cpp: the library's reader over the source, then the same faces encoded and written by the library's own writer, measured inside that
process; to these the start of a process that does nothing (`domelight --version`) is added, which convert's figure holds as well. Without SOURCE:
spruit_sunrise_4k_from_ultrahdr.hdr of $DOMELIGHT_DATA where it is there, else `domelight sky`.
"""

import argparse
import json
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile

import command
from command import DECODE_AND_WRITE, DOMELIGHT, cpu_name, run


def main():
    parser = argparse.ArgumentParser(description="convert beside decoding and writing alone")
    parser.add_argument("source_4k", nargs="?", type=pathlib.Path)
    parser.add_argument("source_2k", nargs="?", type=pathlib.Path, help=argparse.SUPPRESS)
    parser.add_argument("--runs", type=int, default=9)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--json", type=pathlib.Path)
    options = parser.parse_args()
    work = pathlib.Path(tempfile.mkdtemp(prefix="domelight-convert-"))
    try:
        source, _ = command.sources(options, work)
        faces, scratch = work / "faces", work / "scratch"
        faces.mkdir(), scratch.mkdir()
        figures = {"convert": [], "decode": [], "write": [], "start": []}
        for round_ in range(options.runs + 1):
            _, _, cpu = run([DOMELIGHT, "convert", source, faces / "cube.hdr", "--to", "cube", "--layout", "faces", "--size", 1024, "--threads",
                             options.threads, "--quiet"])
            least = json.loads(run([DECODE_AND_WRITE, source, faces, scratch, options.threads, "encode"])[0])
            _, _, start = run([DOMELIGHT, "--version"])
            if round_ > 0:
                figures["start"].append(start)
                figures["convert"].append(cpu)
                figures["decode"].append(least["decode"]["cpu_seconds"])
                figures["write"].append(least["write"]["cpu_seconds"])
        report = {name: statistics.median(values) for name, values in figures.items()}
        report["ratio"] = statistics.median(c / (d + w + s) for c, d, w, s in zip(*figures.values()))
        report |= {"cpu": cpu_name(), "runs": options.runs, "threads": options.threads, "source": source.name}
        print(f"{source.name} to 1024^2 faces, {options.threads} threads, CPU seconds: decode {report['decode']:.3f}, write {report['write']:.3f}, "
              f"start {report['start']:.3f}, convert {report['convert']:.3f}: {report['ratio']:.2f} times the first three (median of the rounds' ratios)")
        if options.json:
            options.json.write_text(json.dumps(report, indent=1) + "\n")
    finally:
        shutil.rmtree(work, ignore_errors=True)


if __name__ == "__main__":
    sys.exit(main())
