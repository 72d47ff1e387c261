#!/usr/bin/env python3
"""Runs the program over hostile files: synthetic ones, and those of DOMELIGHT_DATA/malformed.

Each run has a memory and a time limit. It may succeed (exit 0) or fail (exit 1); if it fails, it prints exactly one error, which names the file,
and leaves nothing in the output folder. It never crashes, hangs or takes memory beyond what is stated. The synthetic files must all be refused.

    run_malformed.py [WORD]     only files whose name has WORD in it
"""

import concurrent.futures
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import threading

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from hostile import LEFT_OUT, hostile_files  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("DOMELIGHT_PROGRAM", str(ROOT / "build/dev/cli/domelight"))

SECONDS = 60                      # one run; the slowest takes less than 2 s on an idle machine
ADDRESS_SPACE = 4 << 30           # a broken size that slips through fails here, not on the machine
RESIDENT_MADE_UP = 128 << 20      # a header alone must not make the program allocate the size that it states
RESIDENT = 1200 << 20             # the readers' cap of 1 GiB, and the program itself

SANITIZED = bool(os.environ.get("DOMELIGHT_SANITIZED"))  # AddressSanitizer reserves terabytes of addresses and keeps freed memory
if SANITIZED:
    SECONDS, RESIDENT_MADE_UP, RESIDENT = 10 * SECONDS, 4 * RESIDENT_MADE_UP, 2 * RESIDENT

# Not images, but files that a user may give to `info` by mistake. Baking each of them would test nothing.
SCENES = {".gltf", ".glb", ".obj", ".ply"}
NOT_IMAGES = SCENES | {".json", ".bin", ".rst", ".md"}


class Run:
    """One command: its exit status, outputs and largest resident size (bytes)."""

    def __init__(self, arguments):
        with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
            process = subprocess.Popen([PROGRAM, *map(str, arguments)], stdin=subprocess.DEVNULL, stdout=out, stderr=err)
            self.timed_out = False

            def stop():
                self.timed_out = True
                process.kill()

            timer = threading.Timer(SECONDS, stop)
            timer.start()
            _, status, usage = os.wait4(process.pid, 0)
            timer.cancel()
            process.returncode = self.status = os.waitstatus_to_exitcode(status)
            self.resident = usage.ru_maxrss * 1024
            self.cpu = usage.ru_utime + usage.ru_stime
            out.seek(0), err.seek(0)
            self.out, self.err = out.read().decode(errors="replace"), err.read().decode(errors="replace")


def complaints(run, file, must_fail, resident, out_folder=None):
    """What is wrong with how a run ended: a list of sentences."""
    if run.timed_out:
        return [f"still running after {SECONDS} s"]
    if run.status not in (0, 1):
        return [f"exit status {run.status}"]
    wrong = []
    if run.resident > resident:
        wrong.append(f"{run.resident >> 20} MiB of memory")
    if run.status == 0:
        return wrong + (["accepted"] if must_fail else [])
    errors = [line for line in run.err.splitlines() if line.startswith("error:")]
    if len(errors) != 1:
        wrong.append(f"{len(errors)} errors instead of one")
    elif file.name not in errors[0]:
        wrong.append("the error does not name the file")
    if out_folder and out_folder.exists() and any(out_folder.rglob("*")):
        wrong.append("left " + ", ".join(str(p.relative_to(out_folder)) for p in out_folder.rglob("*")))
    return wrong


def check(file, work, number, made_up):
    """Runs `info` and, for what may be an image, `bake` over a file, and `render` over scenes.

    Returns (failures, slowest CPU seconds, largest resident bytes).
    """
    failures, runs = [], []
    out_folder = work / f"out-{number}"
    commands = [(["info", "--threads", "1", file], None)]
    if file.suffix not in NOT_IMAGES:
        commands.append((["bake", "--threads", "1", file, "-o", out_folder, "--size", "16", "--levels", "2"], out_folder))
    if file.suffix in SCENES:
        out_folder.mkdir()
        size = ["--width", "8", "--height", "8", "--spp", "1"]
        commands.append((["render", "--threads", "1", file, "-o", out_folder / "picture.png", *size], out_folder))
    for arguments, folder in commands:
        run = Run(arguments)
        runs.append(run)
        # info may describe a texture of which only the header exists; a bake needs all of it
        must_fail = made_up and (folder is not None or file.suffix in (".hdr", ".exr", ".png", ".jpg"))
        for sentence in complaints(run, file, must_fail, RESIDENT_MADE_UP if made_up else RESIDENT, folder):
            failures.append(f"FAILED: {arguments[0]} {file}: {sentence}\n" + "".join("    " + l + "\n" for l in run.err.splitlines()[-8:]))
    subprocess.run(["rm", "-rf", str(out_folder)], check=False)
    return failures, max(r.cpu for r in runs), max(r.resident for r in runs)


def main():
    word = sys.argv[1] if len(sys.argv) > 1 else ""
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    if not SANITIZED:
        resource.setrlimit(resource.RLIMIT_AS, (ADDRESS_SPACE, ADDRESS_SPACE))
    skipped = 0
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        (work / "made").mkdir()
        jobs = []
        for name, data in hostile_files():
            (work / "made" / name).write_bytes(data)
            jobs.append((work / "made" / name, name not in LEFT_OUT))
        data = os.environ.get("DOMELIGHT_DATA")
        if data and pathlib.Path(data, "malformed").is_dir():
            jobs += [(f, False) for f in sorted(pathlib.Path(data, "malformed").rglob("*")) if f.is_file()]
        else:
            skipped += 1
            print("skipped: DOMELIGHT_DATA has no malformed")
        jobs = [job for job in jobs if word in str(job[0])]
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            results = list(pool.map(lambda j: check(j[1][0], work, j[0], j[1][1]), enumerate(jobs)))
    failed = 0
    for failures, _, _ in results:
        failed += bool(failures)
        print("".join(failures), end="")
    if results:
        print(f"{len(results)} files; most CPU {max(r[1] for r in results):.2f} s, most memory {max(r[2] for r in results) >> 20} MiB")
    print(f"malformed: {len(results) - failed} passed, {failed} failed, {skipped} skipped")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
