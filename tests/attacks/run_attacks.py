#!/usr/bin/env python3
"""What a hostile folder, a hostile terminal or a hostile file system may do to the program: it says so and goes on or ends, and never crashes, hangs,
or reads and writes what it was not told to. Broken files are in ../malformed. DOMELIGHT_PROGRAM names the program.

Each function test_... gets a folder of its own, in which studio.hdr lies ready.

    run_attacks.py [WORD ...]     only tests whose name has one of the words in it
"""

import hashlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import traceback
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("DOMELIGHT_PROGRAM", str(ROOT / "build/dev/cli/domelight"))
SECONDS = 600 if os.environ.get("DOMELIGHT_SANITIZED") else 60
SMALL = ["--size", "16", "--levels", "2", "--irradiance-size", "4", "--brdf-size", "16", "--no-preview"]
TINY = ["--width", "8", "--height", "8", "--spp", "1"]


def run(*words, folder, code=0, **options):
    """Runs `domelight WORDS` in `folder`; the exit status must be `code`. A crash is a negative one."""
    options = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **options}
    result = subprocess.run([PROGRAM, *map(str, words)], cwd=folder, timeout=SECONDS, text=True, **options)
    assert result.returncode == code, f"{words}: exit {result.returncode}, not {code}\n{result.stdout}{result.stderr}"
    return result


def refused(*words, folder, what, code=1):
    """Runs it, and looks for exactly one error, in which `what` stands."""
    said = run(*words, folder=folder, code=code).stderr
    errors = [line for line in said.splitlines() if line.startswith("error:")]
    assert len(errors) == 1 and what in said, f"{words}: {said}"


def names_in(folder):
    return sorted(str(p.relative_to(folder)) for p in Path(folder).rglob("*"))


# --- streams ---


def closing(*streams):
    return {"preexec_fn": lambda: [os.close(stream) for stream in streams]}


def test_stderr_that_cannot_be_written_changes_nothing(folder):
    commands = [(["info", "none.hdr"], 1), (["bogus"], 2), ([], 2), (["bake", "studio.hdr", "-o", "b", *SMALL], 0), (["lights", "studio.hdr", "-o", "l"], 0),
                (["convert", "studio.hdr", "-o", "c.png"], 0), (["sample", "studio.hdr", "-n", "2"], 0), (["render", "none.gltf", "-o", "r.png"], 1),
                (["compare", "studio.hdr", "none.hdr"], 1), (["brdf", "-o", "none/b.ktx2"], 1), (["sky", "-o", "s.png", "--height", "16"], 0)]
    for words, code in commands:
        with open("/dev/full", "w") as full:
            run(*words, folder=folder, code=code, stderr=full)
        run(*words, folder=folder, code=code, **closing(2))


def test_no_file_takes_the_place_of_a_closed_stream(folder):
    for streams in [(0,), (1,), (0, 1), (0, 1, 2)]:
        (folder / "out.hdr").unlink(missing_ok=True)
        # What cannot be printed is an error, but it does not go into the file.
        run("sky", "-o", "out.hdr", "--height", "16", folder=folder, code=1 if 1 in streams else 0, **closing(*streams))
        assert (folder / "out.hdr").read_bytes().startswith(b"#?RADIANCE")
        assert run("info", "out.hdr", folder=folder).stdout.startswith("out.hdr: Radiance HDR, 32 x 16")
        run("sky", "-o", "out.hdr", "--height", "16", "--quiet", folder=folder, **closing(*streams))


# --- pipes ---


def fed(folder, name, data, *words, code=0):
    """Runs `domelight WORDS` while somebody writes `data` once into the named pipe `name`."""
    os.mkfifo(folder / name)

    def feed():
        try:
            with open(folder / name, "wb") as pipe:
                pipe.write(data)
        except BrokenPipeError:
            pass

    writer = threading.Thread(target=feed, daemon=True)
    writer.start()
    try:
        return run(*words, folder=folder, code=code)
    finally:
        try:  # lets a writer whose reader never came go
            os.close(os.open(folder / name, os.O_RDONLY | os.O_NONBLOCK))
        except OSError:
            pass
        writer.join(5)
        os.unlink(folder / name)


def test_a_pipe_is_read_once_and_its_hash_is_of_what_was_read(folder):
    data = (folder / "studio.hdr").read_bytes()
    digest = hashlib.sha256(data).hexdigest()
    for name, words in [("manifest.json", ["bake", "pipe", "-o", "b", *SMALL]), ("lights.json", ["lights", "pipe", "-o", "b"])]:
        fed(folder, "pipe", data, *words)
        assert json.loads((folder / "b" / name).read_text())["source"]["sha256"] == digest
    (folder / "b/lights.json").unlink()
    with open(folder / "studio.hdr", "rb") as file:
        cat = subprocess.Popen(["cat"], stdin=file, stdout=subprocess.PIPE)
        run("bake", "/dev/stdin", "-o", "b", *SMALL, folder=folder, stdin=cat.stdout)
        cat.wait()
    assert json.loads((folder / "b/manifest.json").read_text())["source"]["sha256"] == digest
    for words in [["info", "pipe"], ["convert", "pipe", "-o", "c.hdr"], ["convert", "pipe", "-o", "c.png"], ["sample", "pipe", "-n", "2"],
                  ["compare", "pipe", "studio.hdr"], ["compare", "studio.hdr", "pipe"], ["render", "ball", "--env", "pipe", "-o", "r.png", *TINY],
                  ["bake", "pipe", "studio.hdr", "-o", "several", *SMALL], ["compare", "--bake", "b/specular.ktx2", "--env", "pipe"]]:
        fed(folder, "pipe", data, *words)


def test_a_pipe_that_cannot_be_read_again_is_refused(folder):
    run("bake", "studio.hdr", "-o", "b", *SMALL, folder=folder)
    texture = (folder / "b/specular.ktx2").read_bytes()
    for words in [["bake", "pipe", "-o", "b"], ["convert", "pipe", "-o", "c.hdr"]]:
        said = fed(folder, "pipe", texture, *words, code=1).stderr
        assert "pipe: is a pipe with a texture" in said
    # Names that files state lead to regular files only: nobody writes into these pipes.
    os.mkfifo(folder / "a.bin")
    (folder / "a.gltf").write_text(json.dumps({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 36, "uri": "a.bin"}]}))
    refused("render", "a.gltf", "-o", "r.png", folder=folder, what="a.bin: is not a regular file")
    os.mkfifo(folder / "a.mtl")
    (folder / "a.obj").write_text("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    assert "a.mtl: is not a regular file" in run("render", "a.obj", "-o", "r.png", *TINY, folder=folder).stderr
    faces = [f"{face}.hdr" for face in ["px", "nx", "py", "ny", "pz", "nz"]]
    for face in faces:
        os.mkfifo(folder / face)
    refused("info", *faces, folder=folder, what="is not a regular file")


# --- a folder that claims to be a bake ---


def bake_of(folder, **members):
    folder.mkdir()
    (folder / "manifest.json").write_text(json.dumps({"version": "0", "source": {"file": "a", "sha256": "0"}, "options": {}, **members}))
    return folder


def test_info_follows_no_name_out_of_a_bake(folder):
    (folder / "secret").write_text("secret")
    digest = hashlib.sha256(b"secret").hexdigest()
    bake = bake_of(folder / "b")
    (bake / "link").symlink_to("../secret")
    (bake / "null").symlink_to("/dev/null")
    (bake / "inner").symlink_to("manifest.json")
    os.mkfifo(bake / "pipe")
    states = {str(folder / "secret"): "not in the folder, not read", "../secret": "not in the folder, not read", "/dev/zero": "not in the folder, not read",
              "/dev/stdin": "not in the folder, not read", "../nothing": "not in the folder, not read", "link": "not in the folder, not read",
              "null": "not in the folder, not read", "pipe": "not a file", ".": "not a file", "none": "missing", "inner": "changed"}
    for name, state in states.items():
        shutil.rmtree(folder / "c", ignore_errors=True)
        manifest = {"version": "0", "source": {"file": "a", "sha256": "0"}, "options": {}, "map": {"file": name, "sha256": digest}}
        (bake / "manifest.json").write_text(json.dumps(manifest))
        said = json.loads(run("info", "b", "--json", folder=folder, code=1).stdout)
        assert said["files"] == [{"file": name, "state": state}], said["files"]


def test_info_of_manifests_that_are_none(folder):
    bake = folder / "b"
    bake.mkdir()
    manifest = bake / "manifest.json"
    for text in ["[" * 300_000, '{"source":{},"options":' + '{"a":' * 300_000, '{"source":{},"options":' + "[" * 300 + "]" * 300 + "}"]:
        manifest.write_text(text)
        refused("info", "b", folder=folder, what="nested more than 256 deep")
    manifest.unlink()
    manifest.symlink_to("/dev/zero")
    refused("info", "b", folder=folder, what="is not a regular file")
    manifest.unlink()
    os.mkfifo(manifest)
    refused("info", "b", folder=folder, what="is not a regular file")
    # Neither does a bake over such a folder wait for it.
    shutil.copy(folder / "studio.hdr", folder / "b.hdr")
    run("bake", "studio.hdr", "b.hdr", "-o", ".", *SMALL, folder=folder)
    (folder / "huge").mkdir()
    with open(folder / "huge/manifest.json", "wb") as file:
        file.truncate(1 << 40)
    refused("info", "huge", folder=folder, what="is larger than 256 MiB")


def test_a_scene_by_its_bare_name_is_one_by_its_path(folder):
    (folder / "a.obj").write_text("mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    (folder / "a.gltf").write_text(json.dumps({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 36, "uri": "none.bin"}]}))
    for name in ["a.obj", "./a.obj", str(folder / "a.obj"), "b/../a.obj"]:
        (folder / "b").mkdir(exist_ok=True)
        assert "none.mtl: no such file" in run("render", name, "-o", "r.png", *TINY, folder=folder).stderr
    for name in ["a.gltf", "./a.gltf"]:
        refused("render", name, "-o", "r.png", *TINY, folder=folder, what="none.bin: no such file")


# --- files ---


def test_a_file_that_shrinks_while_it_is_read_is_no_crash(folder):
    data = (folder / "studio.hdr").read_bytes()
    for name in ["a.hdr", "a.obj", "a.ply"]:
        stop = threading.Event()

        def shrink(path=folder / name, stop=stop):
            while not stop.is_set():
                path.write_bytes(data)
                os.truncate(path, 100)

        thread = threading.Thread(target=shrink)
        thread.start()
        try:
            end = time.monotonic() + 0.3
            while time.monotonic() < end:
                words = ["bake", name, "-o", "b", *SMALL] if name.endswith(".hdr") else ["render", name, "-o", "r.png", *TINY]
                result = subprocess.run([PROGRAM, *words], cwd=folder, capture_output=True, timeout=SECONDS)
                assert result.returncode in (0, 1), result.returncode
        finally:
            stop.set()
            thread.join()


def main():
    chosen = sys.argv[1:]
    tests = [(name, test) for name, test in globals().items() if name.startswith("test_") and (not chosen or any(c in name for c in chosen))]
    passed = failed = 0
    with tempfile.TemporaryDirectory(prefix="domelight-attacks-") as base:
        seed = Path(base) / "studio.hdr"
        run("sky", "-o", seed, "--height", "32", folder=base)
        for name, test in tests:
            folder = Path(base) / name
            folder.mkdir()
            shutil.copy(seed, folder)
            start = time.monotonic()
            try:
                test(folder)
                passed += 1
                print(f"passed: {name} ({time.monotonic() - start:.1f} s)", flush=True)
            except Exception:
                failed += 1
                print(f"FAILED: {name}", flush=True)
                traceback.print_exc(file=sys.stdout)
            shutil.rmtree(folder, ignore_errors=True)
    print(f"attacks: {passed} passed, {failed} failed, 0 skipped")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
