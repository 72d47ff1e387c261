#!/usr/bin/env python3
"""What Python costs beside the C++ call: dl.prefilter on a 4k array, and Sampler.sample at a million points, in paired runs.

    PYTHONPATH=build/python/site build/python/venv/bin/python bench/python_bench.py [--runs N] [PEER]

PEER is the program python_peer of the same build (build/dev/bench/python_peer). Prints one JSON object: medians of wall-clock and CPU
seconds, and the median of the runs' ratios. The peer and Python take turns, so that what else the machine does meets both.
"""

import argparse
import json
import pathlib
import resource
import statistics
import subprocess
import tempfile
import time

import numpy as np

import domelight as dl

HERE = pathlib.Path(__file__).resolve().parent


def measured(work):
    cpu, begin = time.process_time(), time.perf_counter()
    work()
    return time.perf_counter() - begin, time.process_time() - cpu


def peer_call(peer, words):
    peer.stdin.write(words + "\n")
    peer.stdin.flush()
    wall, cpu = peer.stdout.readline().split()
    return float(wall), float(cpu)


def compare(peer, words, work, runs):
    """Medians of both, and of the ratios Python / C++."""
    work()
    peer_call(peer, words)
    pairs = [(peer_call(peer, words), measured(work)) for _ in range(runs)]
    told = {}
    for i, kind in enumerate(("wall", "cpu")):
        told[f"cpp_{kind}_ms"] = round(1e3 * statistics.median(c[i] for c, _ in pairs), 3)
        told[f"python_{kind}_ms"] = round(1e3 * statistics.median(p[i] for _, p in pairs), 3)
        told[f"{kind}_ratio"] = round(statistics.median(p[i] / c[i] for c, p in pairs), 4)
        told[f"worst_{kind}_ratio"] = round(max(p[i] / c[i] for c, p in pairs), 4)
    return told


def largest_bytes():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("peer", nargs="?", default=str(HERE.parent / "build" / "dev" / "bench" / "python_peer"))
    words.add_argument("--runs", type=int, default=15)
    asked = words.parse_args()
    environment = np.ascontiguousarray(dl.sky(2048).latlong())
    count = 1_000_000
    with tempfile.TemporaryDirectory() as folder:
        pixels = pathlib.Path(folder) / "pixels.f32"
        environment.tofile(pixels)
        with subprocess.Popen([asked.peer, pixels, "4096", "2048"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as peer:
            levels = dict(size=256, roughness=[0, 0.25, 0.5, 0.75, 1], texels="centre")
            prefilter = compare(peer, "prefilter", lambda: dl.prefilter(environment, **levels), asked.runs)
            sampler = dl.Sampler(environment)
            points, out = dl.unit_points(count), np.empty((9, count), np.float32)
            calls = {
                "sample_into_out": lambda: sampler.sample(points, out=out, threads=1),
                "sample_new_memory": lambda: sampler.sample(points, threads=1),
                "sample_float32_points": lambda p=(points * 2.0**-32).astype(np.float32): sampler.sample(p, out=out, threads=1),
                "sample_all_threads": lambda: sampler.sample(points, out=out),
            }
            sample = {name: compare(peer, f"sample {count}", call, asked.runs) for name, call in calls.items()}
            peer.stdin.close()
    before = largest_bytes()
    dl.prefilter(environment, **levels)
    print(json.dumps({"version": dl.__version__, "runs": asked.runs, "prefilter_4k": prefilter, **sample,
                      "bytes_that_the_last_prefilter_added_to_the_peak": largest_bytes() - before}, indent=2))


if __name__ == "__main__":
    main()
