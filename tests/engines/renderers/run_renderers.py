#!/usr/bin/env python3
"""Mitsuba and Blender look up what `bake --for mitsuba` and `--for blender` wrote of the six-axis environment, and Blender takes the lights of `lights`.

Every direction must show the light that the environment has there: six square views, 90 degrees wide, along the axes. A matte ball under the remainder
and the lights of an environment must be as bright as under the whole. Needs PyPI's mitsuba in the Python that runs this, and a program `blender` or PyPI's
bpy; a missing program is skipped, and the output says so. With DOMELIGHT_BROWSER_ENGINES=all (`./test --engines`) both are fetched from PyPI into build/renderers, which takes
1 GB. DOMELIGHT_PICTURES names a folder to keep a mirror ball in.
"""

import importlib.util
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

PROGRAM = os.environ["DOMELIGHT_PROGRAM"]
HERE = pathlib.Path(__file__).resolve().parent
SIZE, SUBDIVISIONS = 32, 4

# forward, right, up in the world of glTF
VIEWS = [((1, 0, 0), (0, 0, 1), (0, 1, 0)), ((-1, 0, 0), (0, 0, -1), (0, 1, 0)), ((0, 1, 0), (0, 0, 1), (-1, 0, 0)),
         ((0, -1, 0), (0, 0, 1), (1, 0, 0)), ((0, 0, 1), (-1, 0, 0), (0, 1, 0)), ((0, 0, -1), (1, 0, 0), (0, 1, 0))]

passed = failed = skipped = 0


def check(name, good, detail):
    global passed, failed
    if good:
        passed += 1
    else:
        failed += 1
        print(f"FAILED {name}: {detail}")


def skip(name, reason):
    global skipped
    skipped += 1
    print(f"skipped: {name}: {reason}")


def run(*words):
    subprocess.run([PROGRAM, *map(str, words)], check=True, stdout=subprocess.DEVNULL)


def read_hdr(file):
    """Rows of (r, g, b) of a Radiance file of new run lengths: this reader is independent, so that the program's reader is not used to test itself."""
    data = file.read_bytes()
    at = data.index(b"\n\n") + 2
    end = data.index(b"\n", at)
    words, at = data[at:end].split(), end + 1
    height, width = int(words[1]), int(words[3])
    rows = []
    for _ in range(height):
        assert data[at] == 2 and data[at + 1] == 2
        at += 4
        channels = []
        for _ in range(4):
            row = bytearray()
            while len(row) < width:
                count = data[at]
                if count > 128:
                    row += data[at + 1:at + 2] * (count - 128)
                    at += 2
                else:
                    row += data[at + 1:at + 1 + count]
                    at += 1 + count
            channels.append(row)
        rows.append([tuple(math.ldexp(channels[c][x], channels[3][x] - 136) for c in range(3)) for x in range(width)])
    return rows


def look_up(rows, d):
    """The default convention: centre +X, right +Z, top +Y."""
    u = 0.5 + math.atan2(d[2], d[0]) / (2 * math.pi)
    v = math.atan2(math.hypot(d[0], d[2]), d[1]) / math.pi
    return rows[min(int(v * len(rows)), len(rows) - 1)][int(u * len(rows[0])) % len(rows[0])]


def view_directions(view, subdivisions):
    """For each pixel of a view, row by row, the directions of the middles of its parts."""
    forward, right, up = VIEWS[view]
    parts = [(i + 0.5) / subdivisions for i in range(subdivisions)]
    for y in range(SIZE):
        for x in range(SIZE):
            directions = []
            for j in parts:
                for i in parts:
                    s, t = 2 * (x + i) / SIZE - 1, 1 - 2 * (y + j) / SIZE
                    d = [f + s * r + t * u for f, r, u in zip(forward, right, up)]
                    n = math.sqrt(sum(c * c for c in d))
                    directions.append(tuple(c / n for c in d))
            yield directions


def mean(colours):
    colours = list(colours)
    return [sum(c[k] for c in colours) / len(colours) for k in range(3)]


def compare(name, environment, views):
    """`views`: six lists of SIZE * SIZE colours, each the mean over its pixel, top row first."""
    for view, colours in enumerate(views):
        errors, sums, truths = [], 0, 0
        for directions, colour in zip(view_directions(view, 2 * SUBDIVISIONS), colours):
            truth = mean(look_up(environment, d) for d in directions)
            errors.append(max(abs(a - b) for a, b in zip(truth, colour)))
            sums += sum(colour)
            truths += sum(truth)
        # A label in a wrong place or mirrored changes a tenth of a view; the edges of right ones differ a little.
        close = sum(e < 0.1 for e in errors) / len(errors)
        check(f"{name}, view {view}", close > 0.95, f"only {100 * close:.1f} % of the view is right")
        check(f"{name}, brightness of view {view}", abs(sums / truths - 1) < 0.01, f"{sums / truths:.4f} times the truth")
        if "DOMELIGHT_VERBOSE" in os.environ:
            print(f"{name}, view {view}: {100 * close:.2f} % right, {sums / truths:.4f} times as bright, worst {max(errors):.3f}")


def test_mitsuba(environment, folder):
    try:
        import mitsuba as mi
    except ImportError:
        return skip("mitsuba", "no Python module mitsuba (pip install mitsuba)")
    mi.set_variant("scalar_rgb")
    run("bake", folder / "axes.hdr", "-o", folder / "mitsuba", "--for", "mitsuba", "--size", "512", "--no-preview")
    file = str(folder / "mitsuba/axes.exr")
    emitter = mi.load_dict({"type": "envmap", "filename": file})
    views, si = [], mi.SurfaceInteraction3f()
    for view in range(6):
        colours = []
        for directions in view_directions(view, SUBDIVISIONS):
            seen = []
            for d in directions:
                si.wi = mi.Vector3f(-d[0], -d[1], -d[2])
                seen.append(emitter.eval(si))
            colours.append(mean(seen))
        views.append(colours)
    compare(f"mitsuba {mi.__version__}", environment, views)
    if "DOMELIGHT_PICTURES" in os.environ:
        scene = mi.load_dict({
            "type": "scene", "light": {"type": "envmap", "filename": file}, "integrator": {"type": "path"},
            "ball": {"type": "sphere", "bsdf": {"type": "conductor", "material": "none"}},
            "camera": {"type": "orthographic", "to_world": mi.ScalarTransform4f().look_at([0, 0, 5], [0, 0, 0], [0, 1, 0]),
                       "film": {"type": "hdrfilm", "width": 256, "height": 256, "pixel_format": "rgb"}, "sampler": {"type": "independent", "sample_count": 16}}})
        mi.util.write_bitmap(str(pathlib.Path(os.environ["DOMELIGHT_PICTURES"], "mitsuba-ball.png")), mi.render(scene))


def blender_command(script):
    """The words that run a script in Blender: the program, or PyPI's module in this Python; None without either."""
    if blender := shutil.which("blender"):
        return [blender, "-b", "--factory-startup", "--python-exit-code", "1", "--python", HERE / script]
    return [sys.executable, HERE / script] if importlib.util.find_spec("bpy") else None


def run_in_blender(script, numbers, *words):
    """The numbers that a script wrote into the file; None if it failed, which is counted."""
    process = subprocess.run([str(w) for w in [*blender_command(script), "--", *words]], capture_output=True, text=True, timeout=600)
    if process.returncode or not numbers.exists():
        return check(f"blender, {script}", False, (process.stdout + process.stderr)[-1500:])
    return [float(w) for w in numbers.read_text().split()]


def test_blender(environment, folder):
    if not blender_command("blender_views.py"):
        return skip("blender", "there is neither the program nor Python's module bpy (pip install bpy)")
    run("bake", folder / "axes.hdr", "-o", folder / "blender", "--for", "blender", "--size", "512", "--no-preview")
    numbers = run_in_blender("blender_views.py", folder / "views.txt", folder / "blender/axes.exr", folder / "views.txt", SIZE, os.environ.get("DOMELIGHT_PICTURES", ""))
    if not numbers:
        return
    colours = [numbers[i:i + 3] for i in range(0, len(numbers), 3)]
    compare("blender (Cycles)", environment, [colours[v * SIZE * SIZE:(v + 1) * SIZE * SIZE] for v in range(6)])


def sunny_environments(folder):
    """Photographs with a sun, where there are any; else the built-in sky."""
    photographs = pathlib.Path(os.environ.get("DOMELIGHT_DATA", "none"), "env_latlong")
    found = [photographs / f"{name}.hdr" for name in ("noon_grass_1k", "spiaggia_di_mondello_1k", "kloppenheim_05_1k")]
    found = [file for file in found if file.exists()]
    if not found:
        found = [folder / "sunny.hdr"]
        run("sky", "--height", "512", "-o", found[0])
    return found


def test_lights_in_blender(folder):
    if not blender_command("blender_lights.py"):
        return  # said by test_blender()
    for file in sunny_environments(folder):
        parts = folder / f"parts-{file.stem}"
        run("lights", file, "-o", parts, "--no-preview")
        remainder = next(parts.glob("remainder.*"))
        for environment in (file, remainder):
            run("bake", environment, "-o", parts / "baked", "--for", "blender", "--no-preview")
        numbers = run_in_blender("blender_lights.py", parts / "numbers.txt", parts / "numbers.txt", parts / f"baked/{file.stem}.exr", parts / "baked/remainder.exr",
                                 parts / "lights.gltf")
        if numbers:
            off = max(abs(b / a - 1) for a, b in zip(numbers[:3], numbers[3:]))
            check(f"blender: lights and remainder light a matte ball as the whole of {file.stem} does", off < 0.005, f"{100 * off:.2f} % off: {numbers}")
            print(f"blender: lights and remainder of {file.stem} are {100 * off:.2f} % off the whole")


def install_renderers():
    """Runs this once more in a Python of its own that has the renderers, if they are asked for."""
    place = pathlib.Path(os.environ.get("DOMELIGHT_BUILD", HERE.parents[2] / "build/dev")).parent / "renderers"
    python = place / "bin/python"
    if os.environ.get("DOMELIGHT_BROWSER_ENGINES") != "all" or sys.prefix == str(place):
        return
    try:
        if not python.exists():
            subprocess.run([sys.executable, "-m", "venv", place], check=True)
        subprocess.run([python, "-m", "pip", "install", "--quiet", "numpy", "mitsuba", "bpy==4.2.0"], check=True)
    except subprocess.CalledProcessError as error:
        return print(f"the renderers cannot be installed: {error}")
    os.execv(python, [str(python), __file__])


def main():
    install_renderers()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run("sky", "--axes", "--height", "512", "-o", folder / "axes.hdr")
        environment = read_hdr(folder / "axes.hdr")
        test_mitsuba(environment, folder)
        test_blender(environment, folder)
        test_lights_in_blender(folder)
    print(f"engines: {passed} passed, {failed} failed, {skipped} skipped")
    return 1 if failed else 0


sys.exit(main())
