#!/usr/bin/env python3
"""An output appears whole or not at all: what is in the output folder after a full disk and after an interruption.

Each file must be the old one or the new one, whole; a new manifest must not stand beside old files; and nothing else may be left over (except
after SIGKILL, where no program can clean up).
"""

import hashlib
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("DOMELIGHT_PROGRAM", str(ROOT / "build/dev/cli/domelight"))

OLD = ["--size", "32", "--levels", "2"]
NEW = ["--size", "256", "--levels", "4", "--brdf-size", "64"]
MOMENTS = 8  # the number of moments of a run at which it is interrupted, for each signal

passed = failed = skipped = 0


def claim(what, wrong):
    """Counts a claim; `wrong` is a list of what contradicts it."""
    global passed, failed
    if wrong:
        failed += 1
        print(f"FAILED: {what}: " + "; ".join(wrong))
    else:
        passed += 1


def run(arguments, **keywords):
    return subprocess.run([PROGRAM, *map(str, arguments)], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120, **keywords)


def contents(folder):
    return {str(f.relative_to(folder)): hashlib.sha256(f.read_bytes()).hexdigest() for f in folder.rglob("*") if f.is_file()}


def mixture(now, old, new, leftovers_allowed):
    """What is wrong with a folder's contents after a run that may have been stopped anywhere."""
    wrong = []
    for name, digest in now.items():
        if digest not in (old.get(name), new.get(name)) and not (leftovers_allowed and name not in old | new):
            wrong.append(f"{name} is neither the old file nor the new one")
    wrong += [f"{name} is gone" for name in old if name not in now]
    if now.get("manifest.json") == new["manifest.json"]:
        wrong += [f"the manifest is new, but {name} is not" for name in new if now.get(name) != new[name]]
    return wrong


def small_disk(limit):
    """Files that grow beyond `limit` bytes fail to, as on a full disk. (Writing then returns an error; the signal that comes with it is ignored.)"""
    def apply():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
    return dict(preexec_fn=apply, restore_signals=False)


def failed_write(result, folder, before):
    wrong = []
    if result.returncode != 1:
        wrong.append(f"exit status {result.returncode}")
    errors = [l for l in result.stderr.splitlines() if l.startswith("error:")]
    if len(errors) != 1:
        wrong.append(f"{len(errors)} errors instead of one")
    if contents(folder) != before:
        wrong.append("the folder has changed: " + ", ".join(sorted(set(contents(folder).items()) ^ set(before.items()))[0]))
    return wrong


def test_full_disk(work, bakes):
    for limit in (0, 1000, 20_000, 200_000):
        folder = work / f"full-{limit}"
        shutil.copytree(bakes / "old", folder)
        result = run(["bake", "-o", folder, *NEW], **small_disk(limit))
        before = contents(bakes / "old")
        now, new = contents(folder), contents(bakes / "new")
        wrong = mixture(now, before, new, False)
        if result.returncode != 1:
            wrong.append(f"exit status {result.returncode}")
        if len([l for l in result.stderr.splitlines() if l.startswith("error:")]) != 1:
            wrong.append("not exactly one error: " + result.stderr.strip())
        claim(f"bake over an older one, no file may exceed {limit} bytes", wrong)
    for ending in (".hdr", ".exr"):
        folder = work / f"sky{ending}"
        folder.mkdir()
        assert run(["sky", "-o", folder / f"sky{ending}", "--height", "16"]).returncode == 0
        before = contents(folder)
        result = run(["sky", "-o", folder / f"sky{ending}", "--height", "256"], **small_disk(5000))
        claim(f"sky over an older {ending} on a full disk", failed_write(result, folder, before))


def test_real_full_disk(work):
    """A file system of 256 KiB, if one can be mounted."""
    global skipped
    disk = work / "disk"
    disk.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=256k", "none", disk], capture_output=True).returncode != 0:
        print("skipped: no file system can be mounted here")
        skipped += 1
        return
    try:
        assert run(["sky", "-o", disk / "sky.hdr", "--height", "32"]).returncode == 0
        before = contents(disk)
        result = run(["sky", "-o", disk / "sky.hdr", "--height", "512"])
        claim("sky on a file system that is full", failed_write(result, disk, before))
        result = run(["bake", "-o", disk / "bake", *NEW])
        wrong = failed_write(result, disk, before)
        claim("bake on a file system that is full", wrong)
    finally:
        subprocess.run(["umount", disk], check=False)


def test_no_place(work):
    (work / "file").write_text("in the way")
    before = contents(work)
    for what, place in (("under a file", work / "file" / "out"), ("on a file", work / "file")):
        claim(f"bake {what}", failed_write(run(["bake", "-o", place, *OLD]), work, before))
    claim("sky in a folder that is not there", failed_write(run(["sky", "-o", work / "none" / "sky.hdr", "--height", "16"]), work, before))


def test_interruption(work, bakes, seconds):
    old, new = contents(bakes / "old"), contents(bakes / "new")
    for sign in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
        for moment in range(MOMENTS):
            folder = work / f"{sign.name}-{moment}"
            shutil.copytree(bakes / "old", folder)
            process = subprocess.Popen([PROGRAM, "bake", "-o", folder, *NEW], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
            time.sleep(seconds * (moment + 0.5) / MOMENTS)
            process.send_signal(sign)
            start = time.monotonic()
            status = process.wait(timeout=60)
            wrong = mixture(contents(folder), old, new, sign == signal.SIGKILL)
            if time.monotonic() - start > 5:
                wrong.append(f"took {time.monotonic() - start:.1f} s to stop")
            if status == 0 and contents(folder) != new:
                wrong.append("exit status 0, but not everything is new")
            claim(f"{sign.name} after {seconds * (moment + 0.5) / MOMENTS:.2f} s", wrong)
            shutil.rmtree(folder)


def main():
    with tempfile.TemporaryDirectory() as temporary:
        work = pathlib.Path(temporary)
        bakes = work / "bakes"
        for name, options in (("old", OLD), ("new", NEW)):
            start = time.monotonic()
            result = run(["bake", "-o", bakes / name, *options])
            seconds = time.monotonic() - start
            claim(f"the {name} bake itself", [] if result.returncode == 0 and (bakes / name / "manifest.json").exists() else [result.stderr.strip()])
        if failed == 0:
            test_full_disk(work, bakes)
            test_real_full_disk(work)
            (work / "places").mkdir()
            test_no_place(work / "places")
            test_interruption(work, bakes, seconds)
    print(f"outputs: {passed} passed, {failed} failed, {skipped} skipped")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
