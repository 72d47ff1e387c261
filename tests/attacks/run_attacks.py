#!/usr/bin/env python3
"""What a hostile folder, a hostile terminal or a hostile file system may do to the program: it says so and goes on or ends, and never crashes, hangs,
or reads and writes what it was not told to. Broken files are in ../malformed. DOMELIGHT_PROGRAM names the program.

Each function test_... gets a folder of its own, in which studio.hdr lies ready.

    run_attacks.py [WORD ...]     only tests whose name has one of the words in it
"""

import hashlib
import json
import os
import resource
import shutil
import signal
import struct
import subprocess
import sys
import threading
import time
import zlib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "tests/malformed")]
import hostile  # noqa: E402
from folder_tests import run_folder_tests  # noqa: E402

SANITIZED = bool(os.environ.get("DOMELIGHT_SANITIZED"))  # AddressSanitizer reserves terabytes of addresses
PROGRAM = os.environ.get("DOMELIGHT_PROGRAM", str(ROOT / "build/dev/cli/domelight"))
SECONDS = 600 if SANITIZED else 60
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
        fed(folder, "pipe", texture, *words)  # it is read once, into memory
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


def resident(*words, folder):
    """Runs it; its exit status, and its largest resident size in bytes."""
    process = subprocess.Popen([PROGRAM, *map(str, words)], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    return process.returncode, usage.ru_maxrss * 1024


def flat_exr(width, height, blocks):
    """An OpenEXR file of black texels, compressed by ZIP, of whose blocks of 16 rows only some are there."""
    head = hostile.exr(width - 1, height - 1, compression=3)
    block = zlib.compress(bytes(16 * width * 6), 9)
    count = (height + 15) // 16
    offsets = [len(head) + 8 * count + i * (8 + len(block)) for i in range(count)]
    return head + struct.pack(f"<{count}Q", *offsets) + b"".join(struct.pack("<iI", 16 * i, len(block)) + block for i in range(blocks))


def old_run_lengths(width, height):
    """A Radiance file of one colour, whose rows take twelve bytes each."""
    row, left, shift = b"\x20\x20\x20\x80", width - 1, 0
    while left >> shift:
        row += b"\x01\x01\x01" + bytes([left >> shift & 255])
        shift += 8
    return hostile.radiance(f"-Y {height} +X {width}", row * height)


def test_memory_is_bounded_by_the_bytes_in_the_file(folder):
    pixel = struct.pack("<QiI3e", 331, 0, 6, 1, 1, 1)
    (folder / "display.exr").write_bytes(hostile.exr(0, 0, data=pixel, display=(0, 0, 4999, 2499)))
    (folder / "cut.exr").write_bytes(flat_exr(13312, 6656, 3))
    (folder / "long.hdr").write_bytes(hostile.radiance("-Y 8192 +X 16384", hostile.run_length_row(16384) * 3))
    for name in ["display.exr", "cut.exr", "long.hdr"]:
        for words in [["info", name], ["sample", name, "-n", "2"], ["lights", name, "-o", "l"], ["convert", name, "-o", "c.hdr"], ["convert", name, "-o", "c.png"],
                      ["convert", name, "-o", "c.exr", "--picture"], ["compare", name, "studio.hdr"], ["compare", "studio.hdr", name],
                      ["render", "ball", "--env", name, "-o", "r.png", *TINY], ["bake", name, "-o", "b", *SMALL]]:
            status, most = resident(*words, folder=folder)
            assert status == 1 and (most < 60 << 20 or SANITIZED), f"{words}: exit {status}, {most >> 20} MiB"
    # Truly compressed: 200 kB for half a gigapixel. Whoever needs all of it in memory says what the limit is.
    (folder / "flat.hdr").write_bytes(old_run_lengths(32768, 16384))
    for words in [["sample", "flat.hdr", "-n", "2"], ["lights", "flat.hdr", "-o", "l"], ["render", "ball", "--env", "flat.hdr", "-o", "r.png", *TINY]]:
        refused(*words, folder=folder, what="more than the limit of 2147483648")


# --- rays ---


def test_no_ray_is_too_long_for_the_ray_tracer(folder):
    def scene(node=None, camera=None, **members):
        nodes = [{"mesh": 0, **(node or {})}] + ([{"camera": 0}] if camera else [])
        cameras = {"cameras": [camera]} if camera else {}
        return hostile.gltf(nodes=nodes, scenes=[{"nodes": list(range(len(nodes)))}], scene=0, **cameras, **members)

    for size in [1e19, 1e300]:
        for data in [scene(camera={"type": "orthographic", "orthographic": {"xmag": size, "ymag": size, "znear": 0, "zfar": 1}}),
                     scene(camera={"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": size, "zfar": 2 * size}}),
                     scene(camera={"type": "perspective", "perspective": {"yfov": 1, "znear": size, "zfar": 2 * size}}),
                     scene(node={"translation": [size, size, size]}), scene(node={"scale": [size, 1, 1]}), scene(node={"scale": [size] * 3})]:
            (folder / "a.gltf").write_bytes(data)
            result = subprocess.run([PROGRAM, "render", "a.gltf", "-o", "r.png", *TINY], cwd=folder, capture_output=True, timeout=SECONDS)
            assert result.returncode in (0, 1), (data, result)
    for word in ["1e19", "nan"]:
        (folder / "a.obj").write_text(f"v {word} 0 0\nv 0 {word} 0\nv 0 0 {word}\nf 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 4 5 6\n")
        for more in [[], ["--shadow-catcher"]]:
            run("render", "a.obj", "-o", "r.png", *TINY, *more, folder=folder)
        refused("render", "a.obj", "-o", "r.png", "--camera-position", f"{word},0,0", folder=folder, what="--camera-position", code=2)
        refused("render", "a.obj", "-o", "r.png", "--camera-position", "1,0,0", "--camera-target", f"{word},0,0", folder=folder, what="--camera-target", code=2)


# --- places ---


def test_a_place_that_cannot_be_written_is_told_before_the_work(folder):
    (folder / "dir.png").mkdir()
    (folder / "file").write_text("")
    # The inputs do not exist: whoever looked at them first would say so.
    for place, what in [("none/x", "No such file or directory"), ("file/x", "Not a directory"), ("dir", "is a folder")]:
        for words, endings in [(["convert", "none.hdr", "-o"], [".hdr", ".png"]), (["render", "none.gltf", "-o"], [".png", ".exr"]),
                               (["compare", "none.hdr", "none.hdr", "--heat"], [".png"]), (["compare", "none.hdr", "none.hdr", "--sheet"], [".png"]),
                               (["sample", "none.hdr", "--picture"], [".png"]), (["sample", "none.hdr", "--heat"], [".png"]),
                               (["sample", "none.hdr", "-o"], [".json"]), (["sky", "--height", "4096", "-o"], [".png", ".exr"]), (["brdf", "-o"], [".ktx2"])]:
            for ending in endings:
                (folder / f"dir{ending}").mkdir(exist_ok=True)
                refused(*words, place + ending, folder=folder, what=what)
    for words in [["bake", "studio.hdr", "-o"], ["lights", "none.hdr", "-o"], ["sample", "none.hdr", "--tables"]]:
        refused(*words, "file", folder=folder, what="is a file, not a folder")
        refused(*words, "file/x", folder=folder, what="Not a directory")
    if os.geteuid() != 0:
        (folder / "closed").mkdir(mode=0o500)
        refused("sky", "-o", "closed/x.hdr", folder=folder, what="Permission denied")
        refused("bake", "studio.hdr", "-o", "closed/x", folder=folder, what="Permission denied")


def test_outputs_are_no_inputs_and_none_twice(folder):
    before = (folder / "studio.hdr").read_bytes()
    os.link(folder / "studio.hdr", folder / "hard.hdr")
    (folder / "soft.hdr").symlink_to("studio.hdr")
    run("convert", "studio.hdr", "-o", "a.png", folder=folder)
    picture = (folder / "a.png").read_bytes()
    os.link(folder / "a.png", folder / "hard.png")
    for name in ["studio.hdr", "hard.hdr", "soft.hdr", "./studio.hdr"]:
        refused("render", "ball", "--env", "studio.hdr", "-o", name, *TINY, folder=folder, what="is read here")
    refused("compare", "a.png", "a.png", "--heat", "hard.png", folder=folder, what="is read here")
    refused("compare", "a.png", "a.png", "--heat", "h.png", "--sheet", "./h.png", folder=folder, what="named for two outputs")
    refused("render", "ball", "-o", "r.png,r.png", *TINY, folder=folder, what="named for two outputs")
    refused("sample", "a.png", "--picture", "a.png", folder=folder, what="is read here")
    shutil.copy(folder / "studio.hdr", folder / "t_0002.hdr")
    refused("render", "ball", "--env", "t_0002.hdr", "-o", "t.hdr", "--frames", "2", *TINY, folder=folder, what="is read here")
    run("bake", "studio.hdr", "-o", ".", *SMALL, folder=folder)
    run("lights", "studio.hdr", "-o", ".", folder=folder)
    assert (folder / "studio.hdr").read_bytes() == before and (folder / "a.png").read_bytes() == picture


def test_outputs_of_one_command_appear_all_or_none(folder):
    (folder / "c_ny.hdr").mkdir()
    refused("convert", "studio.hdr", "-o", "c.hdr", "--to", "cube", "--layout", "faces", "--size", "8", folder=folder, what="c_ny.hdr: is a folder")
    assert names_in(folder) == ["c_ny.hdr", "studio.hdr"]

    def small_disk():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))

    said = run("render", "ball", "-o", "a.png,b.exr", "--width", "32", "--height", "32", "--spp", "1", folder=folder, code=1, preexec_fn=small_disk, restore_signals=False)
    assert "b.exr: cannot write" in said.stderr, said.stderr
    assert names_in(folder) == ["c_ny.hdr", "studio.hdr"]
    run("render", "ball", "-o", "a.png,b.exr,/dev/null", *TINY, folder=folder, code=2)
    run("render", "ball", "-o", "a.png,b.exr", *TINY, folder=folder)
    assert names_in(folder) == ["a.png", "b.exr", "c_ny.hdr", "studio.hdr"]


def test_what_a_killed_run_left_is_removed_by_the_next_one(folder):
    out = folder / "out"
    out.mkdir()
    process = subprocess.Popen([PROGRAM, "bake", "studio.hdr", "-o", "out", "--size", "1024", "--encoding", "bc6h"], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    end = time.monotonic() + SECONDS
    while not any(".domelight-" in name for name in os.listdir(out)) and process.poll() is None and time.monotonic() < end:
        time.sleep(0.01)
    process.kill()
    process.wait()
    left = [name for name in os.listdir(out) if ".domelight-" in name]
    assert left, "it was not killed while it wrote"
    mark, owner, rest = left[0].split(".domelight-")[1].split("-", 2)
    # Not of this machine, of a process that lives, of nobody, or not a file: they stay.
    others = [f".a.domelight-{'0' * 8 if mark != '0' * 8 else '1' * 8}-{owner}-0.tmp", f".a.domelight-{mark}-{os.getpid()}-0.tmp", ".a.domelight-mine.tmp",
              f".a.domelight-{mark}-{owner}-0.txt", f"a.domelight-{mark}-{owner}-0.tmp"]
    for name in others:
        (out / name).write_text("")
    (out / f".folder.domelight-{mark}-{owner}-0.tmp").mkdir()
    (out / f".link.domelight-{mark}-{owner}-0.tmp").symlink_to("../studio.hdr")
    (out / f".b.domelight-{mark}-{owner}-7.tmp.png").write_text("")
    run("sky", "-o", "out/sky.hdr", "--height", "16", folder=folder)
    assert names_in(out) == sorted(["sky.hdr", *others, f".folder.domelight-{mark}-{owner}-0.tmp", f".link.domelight-{mark}-{owner}-0.tmp"])


def test_a_lack_of_memory_is_an_error_wherever_it_happens(folder):
    if SANITIZED:
        return
    run("sky", "-o", "large.hdr", "--height", "512", folder=folder)
    for words, sizes in [(["bake", "large.hdr", "-o", "b", "--size", "64"], range(76, 140, 4)), (["render", "ball", "--env", "large.hdr", "-o", "r.png", *TINY], range(176, 248, 8))]:
        codes = set()
        for size in sizes:
            limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (size << 20, size << 20))  # noqa: E731, B023
            result = subprocess.run([PROGRAM, *words, "--threads", "4", "--quiet"], cwd=folder, capture_output=True, text=True, timeout=SECONDS, preexec_fn=limit)
            # 127: the dynamic linker had not enough either.
            assert result.returncode in (0, 1, 127), (words, size, result)
            codes.add(result.returncode)
        assert 1 in codes, (words, codes)
    assert not [name for name in names_in(folder) if ".domelight-" in name]


# --- options ---


def test_pairs_of_format_and_encoding_are_checked_before_the_bake(folder):
    for encoding in ["uastc-hdr", "astc4x4-hdr", "astc6x6-hdr", "rgbm", "rgbd", "rgbp"]:
        refused("bake", "none.hdr", "-o", "b", "--format", "dds", "--encoding", encoding, folder=folder, what="--encoding:", code=2)
    for engine in ["unity", "unreal"]:
        refused("bake", "none.hdr", "-o", "b", "--for", engine, "--encoding", "uastc-hdr", folder=folder, what="--encoding:", code=2)
    assert names_in(folder) == ["studio.hdr"]


def test_options_that_do_nothing_are_named(folder):
    for words, options in [(["bake", "studio.hdr", "-o", "b", *SMALL], ["--riemann-steps=8x4", "--encoding-quality=high", "--cube-picture=faces", "--force"]),
                           (["bake", "studio.hdr", "-o", "b", "--for", "blender", "--size", "16"], ["--brdf-size=8", "--brdf-float", "--irradiance-size=8"]),
                           (["compare", "studio.hdr", "studio.hdr", "--no-flip"], ["--heat-of=relative", "--heat-max=1", "--pixels-per-degree=20", "--within=0.1"]),
                           (["sky", "-o", "s.hdr", "--axes", "--height", "32"], ["--turbidity=3", "--exr=half", "--no-sun-disc"]), (["brdf", "-o", "b.png", "--size", "8"], ["--float"]),
                           (["render", "ball", "-o", "r.exr", *TINY], ["--tonemap=aces", "--ev=1", "--fov-deg=20", "--maps=b", "--lookup=cube", "--bent-lookup"]),
                           (["render", "ball", "-o", "r.png", "--shading", "mirror", *TINY], ["--noise=0.1", "--bounces=2", "--strategy=env"]),
                           (["convert", "studio.hdr", "-o", "c.hdr", "--to", "angular"], ["--sharp"])]:
        said = run(*words, *options, folder=folder).stderr
        for option in options:
            assert f"warning: {option.split('=')[0]} has no effect here" in said, (option, said)

    words = ["sky", "-o", "s.hdr", "--height", "16"]
    assert "has no effect" not in run(*words, "--turbidity", "3", folder=folder).stderr
    assert run(*words, "--axes", "--turbidity", "3", "--quiet", folder=folder).stderr == ""


def test_numbers_that_are_none_are_refused(folder):
    for words in [["render", "ball", "-o", "r.png", "--ev"], ["render", "ball", "-o", "r.png", "--fov-deg"], ["render", "ball", "-o", "r.png", "--time"], ["sky", "-o", "s.hdr", "--turbidity"],
                  ["sky", "-o", "s.png", "--ev"], ["convert", "studio.hdr", "-o", "c.png", "--ev"], ["convert", "studio.hdr", "-o", "c.hdr", "--rotate-y-deg"],
                  ["lights", "studio.hdr", "-o", "l", "--least-contrast"], ["compare", "studio.hdr", "studio.hdr", "--heat", "h.png", "--heat-max"],
                  ["compare", "--bake", "b", "--within"], ["sample", "--uniform-share"], ["bake", "studio.hdr", "-o", "b", "--exposure"], ["bake", "studio.hdr", "-o", "b", "--roughness"]]:
        for value in ["nan", "inf", "-inf"]:
            refused(*words[:-1], f"{words[-1]}={value}", folder=folder, what=words[-1], code=2)
    refused("bake", "studio.hdr", "-o", "b", "--lobe", "phong", "--exponents", "nan,4", folder=folder, what="--exponents", code=2)


def test_names_of_environments_stay_in_the_folder_for_results(folder):
    for name in ["...hdr", ".hdr", "a..hdr"]:
        shutil.copy(folder / "studio.hdr", folder / name)
        run("bake", name, "studio.hdr", "-o", "out/x", *SMALL, folder=folder)
        assert os.listdir(folder / "out") == ["x"] and len(os.listdir(folder / "out/x")) == 2
        assert all((folder / "out/x" / d / "manifest.json").exists() for d in os.listdir(folder / "out/x"))
        run("bake", name, "-o", "out/x", "--for", "blender", "--for", "godot", "--size", "16", folder=folder)
        assert os.listdir(folder / "out") == ["x"]
        shutil.rmtree(folder / "out")


def prepare(folder):
    run("sky", "-o", "studio.hdr", "--height", "32", folder=folder)


if __name__ == "__main__":
    sys.exit(run_folder_tests("attacks", dict(globals()), sys.argv[1:], prepare))
