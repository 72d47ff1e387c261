#!/usr/bin/env python3
"""What `domelight batch` costs: scaling, overhead, reruns, kills, large plans, and how even a thousand shards are.

    bench/batch.py [scaling] [rerun] [kills] [plan] [simulate] [--jobs N] [--from BATCH] [--json FILE]

Without words all of it, which takes some minutes. DOMELIGHT_DATA names the folder of real environments, DOMELIGHT_PROGRAM the program
(build/dev/cli/domelight). As root, the measured processes get a high priority, so that others on the machine matter less.
"""

import argparse
import hashlib
import heapq
import json
import os
import platform
import random
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PROGRAM = os.environ.get("DOMELIGHT_PROGRAM", str(ROOT / "build/dev/cli/domelight"))
DATA = Path(os.environ.get("DOMELIGHT_DATA", "data"))
ENGINES = ["generic", "three", "babylon", "filament", "khronos", "unity", "playcanvas", "blender"]


def prioritise():
    if os.geteuid() == 0:
        os.nice(-15)


def run(*words, cwd, check=True):
    """Wall-clock and CPU seconds of `domelight WORDS`, and its peak memory in bytes (of the largest process)."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    start = time.monotonic()
    done = subprocess.run(["/usr/bin/time", "-f", "%M", PROGRAM, *map(str, words)], cwd=cwd, capture_output=True, text=True, preexec_fn=prioritise)
    wall = time.monotonic() - start
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if check and done.returncode != 0:
        sys.exit(f"domelight {' '.join(map(str, words))}: {done.stdout}{done.stderr}")
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, int(done.stderr.split()[-1]) * 1024


def results_of(batch):
    return {str(p.relative_to(batch)): hashlib.sha256(p.read_bytes()).hexdigest() for p in sorted(batch.rglob("results/*/*/**/*")) if p.is_file()}


def environments(size="1k"):
    found = sorted(DATA.glob(f"env_latlong/*_{size}.hdr"))
    if not found:
        sys.exit(f"no environments in {DATA}/env_latlong: set DOMELIGHT_DATA")
    return found


def copies(folder, count):
    """`count` real environments of 1k; those that come again are turned by a few degrees, so that no two jobs are equal."""
    sources = environments()
    folder.mkdir(parents=True, exist_ok=True)
    for source in sources:
        shutil.copy(source, folder)
    return [{"environment": str(Path(folder.name) / sources[i % len(sources)].name), "output": f"e{i:04}", "options": {"rotate_y_deg": float(i // len(sources))}}
            for i in range(count)]


def plan(folder, jobs, *words):
    (folder / "jobs.jsonl").write_text("".join(json.dumps(job) + "\n" for job in jobs))
    run("batch", "plan", "jobs.jsonl", "-o", "batch", *words, cwd=folder)
    return folder / "batch"


def scaling(folder, count):
    """Bare bakes one after the other and in two loops side by side, then one worker and two workers of one thread, each three times in turn."""
    jobs = copies(folder / "env", count)
    batch = plan(folder, jobs)

    def loop(some):
        for job in some:
            subprocess.run([PROGRAM, "bake", job["environment"], "-o", f"bare/{job['output']}", "--rotate-y-deg", str(job["options"]["rotate_y_deg"]), "--threads", "1", "--quiet"],
                           cwd=folder, check=True)

    def bare(loops):
        shutil.rmtree(folder / "bare", ignore_errors=True)
        before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
        threads = [threading.Thread(target=loop, args=(jobs[i::loops],)) for i in range(loops)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return time.monotonic() - start, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    def workers(n):
        shutil.rmtree(batch / "results", ignore_errors=True)
        shutil.rmtree(batch / "out", ignore_errors=True)
        return run("batch", "run", "batch", "--workers", n, "--threads", n, "--quiet", cwd=folder)[:2]

    rounds = [{"bare": bare(1), "bare_two": bare(2), "one": workers(1), "two": workers(2)} for _ in range(3)]
    return {"jobs": count,
            "one_worker_seconds": round(statistics.median(r["one"][0] for r in rounds), 2),
            "speed_of_two_workers": [round(r["one"][0] / r["two"][0], 3) for r in rounds],
            "speed_of_two_bare_loops": [round(r["bare"][0] / r["bare_two"][0], 3) for r in rounds],
            "overhead_cpu_over_bare": [round(r["one"][1] / r["bare"][1] - 1, 4) for r in rounds],
            "overhead_wall_over_bare": [round(r["one"][0] / r["bare"][0] - 1, 4) for r in rounds]}


def rerun(folder, count=1000):
    jobs = copies(folder / "env", count)
    batch = plan(folder, jobs, "--set", "size=16", "--set", "irradiance_size=8", "--set", "brdf_size=16", "--set", "preview=false")
    run("batch", "run", "batch", cwd=folder)
    times = [run("batch", "run", "batch", cwd=folder)[0] for _ in range(5)]
    return {"jobs": count, "seconds": round(statistics.median(times), 3), "worst": round(max(times), 3), "files": sum(1 for _ in batch.glob("results/*/*/files/*"))}


def kills(folder, times=50):
    jobs = copies(folder / "env", 8)
    batch = plan(folder, jobs)
    start = time.monotonic()
    run("batch", "run", "batch", cwd=folder)
    lasts, whole = time.monotonic() - start, results_of(batch)
    moment = random.Random(1)
    done_before, same = [], 0
    for _ in range(times):
        shutil.rmtree(batch / "results")
        process = subprocess.Popen([PROGRAM, "batch", "run", "batch"], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(moment.uniform(0, lasts))
        process.kill()
        process.wait()
        done_before.append(len(list(batch.glob("results/*/*/done.json"))))
        run("batch", "run", "batch", cwd=folder)
        left = list(batch.glob("work/*")) + [p for p in batch.rglob("*.tmp*")]
        same += results_of(batch) == whole and not left
    return {"kills": times, "same_bytes_and_no_leftovers": same, "jobs_done_before_the_kill": sorted(set(done_before))}


def large_plan(folder, count=100000, sources=1000):
    jobs = copies(folder / "env", count)
    names = [job["environment"] for job in jobs[: len(environments())]]
    for i in range(sources):  # further names of the same files: each is hashed
        os.link(folder / names[i % len(names)], folder / f"env/n{i:04}.hdr")
    jobs = [{"environment": f"env/n{i % sources:04}.hdr", "output": f"s{i // sources}/n{i % sources:04}", "options": {"for": ["three"], "size": 64 + i // sources}}
            for i in range(count)]
    (folder / "jobs.jsonl").write_text("".join(json.dumps(job) + "\n" for job in jobs))
    wall, cpu, memory = run("batch", "plan", "jobs.jsonl", "-o", "batch", cwd=folder)
    return {"jobs": count, "files_hashed": sources, "gigabytes_hashed": round(sum((folder / f"env/n{i:04}.hdr").stat().st_size for i in range(sources)) / 1e9, 2),
            "seconds": round(wall, 2), "cpu_seconds": round(cpu, 2), "megabytes": round(memory / 1e6)}


def shards_of(estimates, count):
    """The rule of plan_shards(): the longest job first, each to the shard that has the least to do."""
    heap = [(0.0, shard) for shard in range(count)]
    shard_of = [0] * len(estimates)
    for job in sorted(range(len(estimates)), key=lambda j: -estimates[j]):
        load, shard = heap[0]
        heapq.heapreplace(heap, (load + estimates[job], shard))
        shard_of[job] = shard
    return shard_of


def measured_pairs(folder):
    """(estimated, measured CPU seconds, engine) of real environments from 512 to 4096 wide, baked for each engine."""
    env = folder / "env"
    env.mkdir(parents=True)
    for pattern in ["env_latlong/*.hdr", "env_latlong_blender/*.exr", "env_latlong_exr_dwab/*.exr", "env_highres/*.hdr", "env_highres/*.exr"]:
        for file in DATA.glob(pattern):
            shutil.copy(file, env)
    listed = [{"environment": f"env/{file.name}", "output": f"{engine}/{file.name}", "options": {"for": [engine]}} for file in sorted(env.iterdir()) for engine in ENGINES]
    batch = plan(folder, listed)
    run("batch", "run", "batch", "--quiet", cwd=folder)
    return pairs_of(batch)


def pairs_of(batch):
    measured = {}
    for log in batch.glob("log/*.jsonl"):
        for line in map(json.loads, log.read_text().splitlines()):
            measured[line["job"]] = line["cpu_seconds"]
    jobs = map(json.loads, (batch / "plan.jsonl").read_text().splitlines()[1:])
    return [(job["cost"]["seconds"], measured[job["job"]], job["output"].split("/")[0]) for job in jobs if job["job"] in measured]


def ends_of(drawn, shard_of, shards, helping):
    """When each shard ends if all begin at once, one job at a time, the longest by estimate first; `helping` then does what others have not begun, the
    shortest first, for as long again at most."""
    lists = [[] for _ in range(shards)]
    for job in sorted(range(len(drawn)), key=lambda j: -drawn[j][0]):
        lists[shard_of[job]].append(drawn[job][1])
    loads = [sum(jobs) for jobs in lists]
    if not helping:
        return loads
    next_of, clock = [0] * shards, [(0.0, shard) for shard in range(shards)]
    heapq.heapify(clock)
    ends, own_end = [0.0] * shards, [None] * shards
    while clock:
        now, shard = heapq.heappop(clock)
        if next_of[shard] < len(lists[shard]):
            seconds = lists[shard][next_of[shard]]
            next_of[shard] += 1
        else:
            own_end[shard] = now if own_end[shard] is None else own_end[shard]
            others = ((shard + s) % shards for s in range(1, shards))
            victim = next((other for other in others if next_of[other] < len(lists[other])), None) if now < 2 * own_end[shard] else None
            if victim is None:
                ends[shard] = now
                continue
            seconds = lists[victim].pop()
        heapq.heappush(clock, (now + seconds, shard))
    return ends


def simulate(folder, jobs=100000, shards=1000, batch=None):
    """Draws `jobs` jobs from the estimated and measured CPU times of real bakes."""
    pairs = pairs_of(Path(batch)) if batch else measured_pairs(folder)
    engines = sorted({name for _, _, name in pairs})
    told = {"jobs_measured": len(pairs), "cpu_seconds_median": round(statistics.median(p[1] for p in pairs), 3), "cpu_seconds_largest": round(max(p[1] for p in pairs), 2),
            "measured_over_estimated_by_engine": {e: round(sum(m for _, m, name in pairs if name == e) / sum(s for s, _, name in pairs if name == e), 2) for e in engines},
            "jobs": jobs, "shards": shards}
    light = [pair for pair in pairs if pair[2] not in ("khronos", "unreal")]
    for kind, sample in [("every engine", pairs), ("without khronos and unreal, whose time depends on the light most", light)]:
        draw = random.Random(1)
        drawn = [draw.choice(sample) for _ in range(jobs)]
        by_cost, by_number = shards_of([p[0] for p in drawn], shards), [i % shards for i in range(jobs)]
        mean = sum(p[1] for p in drawn) / shards
        told[kind] = {name: round(max(ends_of(drawn, shard_of, shards, helping)) / mean - 1, 4)
                      for name, shard_of, helping in [("by number", by_number, False), ("by cost", by_cost, False), ("by cost, helping others", by_cost, True)]}
    return told


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", nargs="*", choices=["scaling", "rerun", "kills", "plan", "simulate", []])
    parser.add_argument("--jobs", type=int, default=100, help="environments for scaling")
    parser.add_argument("--from", dest="batch", help="simulate: a batch that has run, instead of bakes for each engine")
    parser.add_argument("--json", help="file for the figures")
    words = parser.parse_args()
    parts = {"scaling": lambda f: scaling(f, words.jobs), "rerun": rerun, "kills": kills, "plan": large_plan, "simulate": lambda f: simulate(f, batch=words.batch)}
    figures = {"machine": platform.node(), "processors": os.cpu_count(), "version": subprocess.run([PROGRAM, "--version"], capture_output=True, text=True).stdout.strip()}
    for name in words.what or parts:
        with tempfile.TemporaryDirectory(prefix="domelight-bench-") as folder:
            figures[name] = parts[name](Path(folder))
            print(name, json.dumps(figures[name], indent=1), flush=True)
    if words.json:
        Path(words.json).write_text(json.dumps(figures, indent=1) + "\n")


if __name__ == "__main__":
    main()
