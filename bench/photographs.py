"""The five photographs that the benchmarks measure, one of each kind, and how their figures are summed up.

The files are in $DOMELIGHT_DATA/env_latlong, 1024 x 512. The built-in sky, whose sun is the only bright place, stands beside them.
"""

import os
import pathlib
import platform
import statistics
import subprocess

PHOTOGRAPHS = {
    "sun": "noon_grass_1k.hdr",
    "studio": "blocky_photo_studio_1k.hdr",
    "night with lamps": "dikhololo_night_1k.hdr",
    "interior": "leadenhall_market_1k.hdr",
    "overcast": "kloppenheim_05_1k.hdr",
}


def photographs():
    """{kind: path} of those that are there."""
    folder = pathlib.Path(os.environ.get("DOMELIGHT_DATA", "")) / "env_latlong"
    return {kind: folder / name for kind, name in PHOTOGRAPHS.items() if (folder / name).is_file()}


def make_sky(program, height, path):
    subprocess.run([str(program), "sky", "--height", str(height), "-o", str(path), "--quiet"], check=True)
    return path


def summary(values, worst=max):
    """The median and the worst of {kind: value}, with the kind of the worst."""
    kind = worst(values, key=values.get)
    return {"median": statistics.median(values.values()), "worst": values[kind], "worst_kind": kind}


def cpu_name():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.machine()
