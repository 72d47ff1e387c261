"""Renders: formats, cameras, backgrounds, shadows, turntables, studies."""

import json
import math
import os
import re
import signal
import struct
import subprocess
import time

from program import PROGRAM, TINY, files_of, launch, make_glb, make_square, png_of, run


def test_a_render_of_every_direction_is_an_environment(folder):
    """Far away from the scene there is only the environment, which comes back through a cube and through a lat-long map."""
    (folder / "helmet.glb").write_bytes(make_glb())
    run("sky", "--axes", "-o", "axes.hdr", "--height", "64", folder=folder)
    view = ["helmet.glb", "--env", "axes.hdr", "--camera-position", "1e6,0,0", "--spp", "16", "--quiet"]
    run("render", *view, "--camera", "cube", "--width", "32", "-o", "cube.exr", folder=folder)
    assert "32 x 192" in run("info", "cube.exr", folder=folder).stdout
    run("convert", "cube.exr", "--to", "latlong", "--size", "64", "-o", "back.exr", folder=folder)
    run("render", *view, "--camera", "latlong", "--height", "64", "-o", "latlong.exr", folder=folder)
    for file, most in [("back.exr", 0.25), ("latlong.exr", 0.2)]:  # labels turned or mirrored: over 0.5
        told = json.loads(run("compare", file, "axes.hdr", "--json", folder=folder).stdout)
        error = told["errors"]["relative_rmse"]
        assert error < most, (file, error)
    for words, what in [(["--camera", "cube", "--height", "64"], "--height: has no meaning with --camera cube"),
                        (["--camera", "latlong", "--width", "64", "--height", "64"], "--height: is not half of --width"),
                        (["--camera", "cube", "--frames", "4"], "--frames: has no meaning with --camera cube"),
                        (["--camera", "latlong", "--fov-deg", "40"], "--fov-deg: has no meaning")]:
        assert what in run("render", "helmet.glb", *words, "-o", "x.exr", folder=folder, code=2).stderr, words


def test_render_writes_each_format_and_tells(folder):
    said = json.loads(run("render", "ball", "-o", "a.exr,a.png", "-o", "a.hdr", *TINY, "--json", folder=folder).stdout)
    assert said["files"] == ["a.exr", "a.png", "a.hdr"] and (said["width"], said["height"]) == (16, 12)
    assert said["samples"] == 4 and said["shading"] == "reference" and said["rays"] > 0 and 0 < said["noise"] < 1 and said["warnings"] == []
    assert png_of(folder / "a.png")[:3] == (16, 12, 3)
    for threads in [1, 3]:
        run("render", "ball", "-o", f"b{threads}.exr,b{threads}.png", *TINY, "--shadow-catcher", "--threads", threads, folder=folder)
    for extension in ["exr", "png"]:
        assert (folder / f"b1.{extension}").read_bytes() == (folder / f"b3.{extension}").read_bytes()


def test_render_weighs_the_diffuse_layer_as_asked(folder):
    pictures = {}
    for name, words in {"default": [], "energy": ["--diffuse-weight", "energy"], "fresnel": ["--diffuse-weight", "fresnel"]}.items():
        run("render", "spheres", "-o", f"{name}.png", *TINY, "--shading", "split-sum", *words, folder=folder)
        pictures[name] = (folder / f"{name}.png").read_bytes()
    assert pictures["default"] == pictures["energy"] != pictures["fresnel"]


def test_render_takes_the_camera_that_is_asked_for(folder):
    (folder / "two.glb").write_bytes(make_glb())
    sizes = {}
    for camera in ["1", "2", "front", "wide"]:
        said = json.loads(run("render", "two.glb", "-o", f"{camera}.png", "--width", 24, "--spp", 1, "--camera", camera, "--json", folder=folder).stdout)
        sizes[camera] = (said["width"], said["height"])
    assert sizes == {"1": (24, 24), "front": (24, 24), "2": (24, 12), "wide": (24, 12)}, sizes
    assert (folder / "1.png").read_bytes() == (folder / "front.png").read_bytes() and (folder / "2.png").read_bytes() == (folder / "wide.png").read_bytes()
    said = json.loads(run("render", "two.glb", "-o", "h.png", "--height", 10, "--spp", 1, "--camera", "wide", "--json", folder=folder).stdout)
    assert (said["width"], said["height"]) == (20, 10)
    error = run("render", "two.glb", "-o", "o.png", "--camera", "3", folder=folder, code=2).stderr
    assert '1 "front", 2 "wide"' in error


def test_render_backgrounds(folder):
    (folder / "model.glb").write_bytes(make_glb())

    def picture(name, *words):
        run("render", "model.glb", "-o", f"{name}.png", *TINY, *words, folder=folder)
        return png_of(folder / f"{name}.png")

    # The colour is shown as it was given, independent of the exposure and the tone map of the scene.
    for name, words in {"hex": ["--background-color", "#336699"], "float": ["--background-color", "0.0331047666,0.13286832,0.318546778"],
                        "word": ["--background", "color", "--background-colour", "#336699", "--tonemap", "aces", "--ev", "3"]}.items():
        width, _, channels, pixels = picture(name, *words)
        assert channels == 3 and tuple(pixels[:3]) == (0x33, 0x66, 0x99), (name, tuple(pixels[:3]))
    assert tuple(picture("white", "--background", "colour")[3][:3]) == (255, 255, 255)
    _, _, channels, clear = picture("clear", "--background", "transparent")
    assert channels == 4 and clear[3] == 0 and clear[4 * (6 * 16 + 8) + 3] == 255
    sharp, blurred = picture("sharp", "--tonemap", "gamma22")[3], picture("blurred", "--background", "blurred", "--tonemap", "gamma22")[3]
    middle = 3 * (6 * 16 + 8)
    assert sharp[:3] != blurred[:3]
    # The exposure depends on the surfaces only: the ball looks the same before any background.
    ball = slice(3 * (6 * 16 + 7), 3 * (6 * 16 + 9))
    white, hexed = picture("w2", "--background", "colour")[3][ball], picture("h2", "--background-color", "#000000")[3][ball]
    assert white == hexed
    seen, cut = picture("seen", "--background", "environment")[3], clear
    for c in range(3):
        # (Pixels at the edge contain some of the background.)
        assert abs(seen[middle + c] - cut[4 * (6 * 16 + 8) + c]) <= 6, (tuple(seen[middle:middle + 3]), tuple(cut[4 * (6 * 16 + 8):][:3]))
    looks = {name: bytes(picture(name, "--tonemap", name)[3]) for name in ["agx", "agx-punchy", "neutral", "aces", "reinhard", "gamma22", "none"]}
    assert len(set(looks.values())) == len(looks)


def test_render_catches_the_shadow(folder):
    view = ["--camera-position", "0,6,8", "--width", "32", "--height", "24", "--spp", "16"]
    run("render", "furnace", "-o", "bare.png", *view, "--background", "transparent", folder=folder)
    run("render", "furnace", "-o", "shadow.png", *view, "--background", "transparent", "--shadow-catcher", folder=folder)
    (_, _, _, bare), (_, _, _, shadow) = png_of(folder / "bare.png"), png_of(folder / "shadow.png")
    darker = 0
    for i in range(0, len(bare), 4):
        assert shadow[i + 3] >= bare[i + 3]
        if bare[i + 3] == 255:
            assert shadow[i:i + 4] == bare[i:i + 4]
        elif bare[i + 3] == 0 and shadow[i + 3]:
            assert tuple(shadow[i:i + 3]) == (0, 0, 0)
            darker += shadow[i + 3] > 100
    assert darker > 10
    run("render", "furnace", "-o", "white.png", *view, "--background", "colour", "--shadow-catcher", folder=folder)
    white = png_of(folder / "white.png")[3]
    assert tuple(white[:3]) == (255, 255, 255) and sum(white[i] < 200 for i in range(0, len(white), 3)) > 30


def test_render_turntable(folder):
    words = ["render", "ball", "-o", "t.png,t.exr", "--width", "16", "--height", "16", "--spp", "1", "--frames", "4", "--fps", "8"]
    said = json.loads(run(*words, "--json", folder=folder).stdout)
    names = [f"t_{i:04}" for i in range(1, 5)]
    assert said["frames"] == [[f"{n}.png", f"{n}.exr"] for n in names] and said["animations"] == ["t.webp"] and said["drawn"] == 4
    assert {p.name for p in folder.glob("t*")} == {f"{n}.{e}" for n in names for e in ["png", "exr"]} | {"t.webp"}
    assert webp_frames((folder / "t.webp").read_bytes()) == (16, 16, [125] * 4)
    whole = files_of(folder)
    assert len({whole[f"{n}.png"] for n in names}) == 4
    # Missing frames are drawn again with the same bytes; frames that exist are not changed.
    (folder / "t_0003.png").unlink()
    (folder / "t.webp").unlink()
    said = json.loads(run(*words, "--resume", "--json", folder=folder).stdout)
    assert said["drawn"] == 1 and said["kept"] == 3
    assert files_of(folder) == whole
    # Frame 1 equals the single picture, and turning the light changes the frames.
    run("render", "ball", "-o", "one.exr", "--width", "16", "--height", "16", "--spp", "1", folder=folder)
    assert (folder / "one.exr").read_bytes() == (folder / "t_0001.exr").read_bytes()
    run(*[w.replace("t.png,t.exr", "e.exr") for w in words], "--turn", "environment", folder=folder)
    assert (folder / "e_0001.exr").read_bytes() == (folder / "t_0001.exr").read_bytes() != (folder / "e_0002.exr").read_bytes()
    assert not (folder / "e.webp").exists()
    error = run(*[w.replace("t.png,t.exr", "no/t.png") for w in words], folder=folder, code=1).stderr
    assert "no/t_0001.png" in error


def test_an_interrupted_render_leaves_the_last_complete_file(folder):
    run("render", "ball", "-o", "o.png", *TINY, folder=folder)
    before = (folder / "o.png").read_bytes()

    def interrupted(*words, until, number=signal.SIGINT):
        process = launch("render", "ball", *words, "--spp", "1000000", folder=folder, stderr=subprocess.PIPE, text=True)
        deadline = time.monotonic() + 60
        while not until() and time.monotonic() < deadline:
            time.sleep(0.05)
        process.send_signal(number)
        error = process.communicate(timeout=60)[1]
        assert process.returncode == -number and error.startswith("interrupted: "), (process.returncode, error)
        return error

    start = time.monotonic()
    later = lambda: time.monotonic() > start + 1.5
    small = ["--width", "16", "--height", "16"]
    assert "nothing was written to o.png" in interrupted("-o", "o.png", *small, until=later)
    assert (folder / "o.png").read_bytes() == before
    start = time.monotonic()
    interrupted("-o", "o.png", *small, until=later, number=signal.SIGTERM)
    assert (folder / "o.png").read_bytes() == before
    assert "new.png holds the picture of" in interrupted("-o", "new.png", *small, "--save-every", "0.2", until=(folder / "new.png").exists)
    assert png_of(folder / "new.png")[:3] == (16, 16, 3)
    # Frames that are complete are named.
    process = launch("render", "ball", "-o", "f.png", *small, "--frames", "2000", "--spp", "64", folder=folder, stderr=subprocess.PIPE, text=True)
    while not (folder / "f_0002.png").exists():
        time.sleep(0.02)
    process.send_signal(signal.SIGINT)
    error = process.communicate(timeout=60)[1]
    last = len(list(folder.glob("f_*.png")))
    assert process.returncode == -signal.SIGINT and f"frames 1-{last} of 2000 exist; --resume" in error, error
    assert not [p for p in folder.iterdir() if p.name.startswith(".")]


def test_render_shows_samples_noise_and_time_left_on_a_terminal(folder):
    import pty

    ours, theirs = pty.openpty()
    process = subprocess.Popen([PROGRAM, "render", "ball", "-o", "o.png", "--width", "48", "--time", "2.5"], cwd=folder,
                               stdout=subprocess.DEVNULL, stderr=theirs)
    os.close(theirs)
    text = b""
    try:
        while piece := os.read(ours, 4096):
            text += piece
    except OSError:
        pass  # its end, on Linux
    os.close(ours)
    assert process.wait(60) == 0
    text = text.decode()
    assert re.search(r"ball +render +\[#*\.*\] +\d+ %  \d+ samples, noise 0\.\d+  0:0\d left", text), text[-400:]
    assert text.endswith("\r\x1b[K"), "the bar is not taken back"


def test_render_study(folder):
    small = ["--study", "--width", "12", "--spp", "2", "--env", "evening.hdr"]
    said = json.loads(run("render", *small, "-o", "study", "--json", folder=folder).stdout)
    assert said["files"] == ["study/strategies.png", "study/noise.png", "study/split-sum.png", "study/study.json"]
    assert all((folder / f).is_file() for f in said["files"]) and said["environment"] == "evening"
    stored = json.loads((folder / "study/study.json").read_text())
    for key in ["strategies", "noise", "split_sum"]:
        assert stored[key] == said[key], key
    cells = stored["strategies"]["cells"]
    assert len(cells) == 2 * 4 * 5 * 3
    error = {(c["occlusion"], c["roughness"], c["light_deg"], c["strategy"]): c["tone_mapped_rmse"] for c in cells}
    for occlusion in [False, True]:
        # As in Veach's figure, each of the two strategies is poor where the other is good, and MIS is close to the better one everywhere.
        assert error[occlusion, 0.8, 2, "env"] < 0.3 * error[occlusion, 0.8, 2, "brdf"]
        assert error[occlusion, 0.05, 90, "brdf"] < 0.3 * error[occlusion, 0.05, 90, "env"]
    lines = stored["noise"]["lines"]
    assert {(l["occlusion"], l["strategy"]) for l in lines} == {(o, s) for o in [False, True] for s in ["env", "brdf", "mis"]}
    assert all(l["slope"] < -0.4 for l in lines if l["strategy"] == "mis")
    parts = stored["split_sum"]["parts"]
    assert [p["occlusion"] for p in parts] == [False, True] and all(len(p["error"]) == 11 and len(p["error"][0]) == 10 for p in parts)
    assert parts[0]["tone_mapped_rmse"] < parts[1]["tone_mapped_rmse"]
    run("render", "spheres", *small, "-o", "sheet.png", "--spp", "1", "--width", "4", folder=folder)
    assert png_of(folder / "sheet.png")[0] > 800
    assert not (folder / "sheet").exists()
    (folder / "file").write_text("mine")
    run("render", *small, "-o", "file", folder=folder, code=1)


def write_even(file, mantissa, exponent):
    """An even environment as Radiance HDR: every texel has these RGBE bytes, so the radiance mantissa 2^(exponent - 136)."""
    file.write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n" + bytes([mantissa] * 3 + [exponent]) * 32)


def test_render_exposes_a_dark_picture_for_what_is_lit(folder):
    # A spot that lights a part of a large square in the dark.
    write_even(folder / "black.hdr", 0, 0)
    scene = make_square(math.pi / 2)
    scene["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "spot", "intensity": 683, "spot": {"innerConeAngle": 0.29, "outerConeAngle": 0.3}}]}}
    scene["nodes"].append({"translation": [0, 0, 5], "extensions": {"KHR_lights_punctual": {"light": 0}}})
    scene["scenes"] = [{"nodes": [0, 1]}]
    (folder / "spot.gltf").write_text(json.dumps(scene))
    words = ["render", "spot.gltf", "--env", "black.hdr", "--width", "64", "--height", "64", "--camera-position", "0,0,8", "--spp", "4"]
    brightest = 0.8 / math.pi / 25  # E = 1 / 5^2 in the middle of the spot
    for shading in ["reference", "split-sum"]:
        said = json.loads(run(*words, "--shading", shading, "-o", "p.png", "--json", folder=folder).stdout)
        assert 0.18 < brightest * 2 ** said["ev"] <= 4.1, said["ev"]
    assert f"exposure {said['ev']:+.2f} EV" in run(*words, "--shading", "split-sum", "-o", "p.png", folder=folder).stdout
    assert "exposure" not in run(*words, "-o", "p.exr", folder=folder).stdout
    # In a turntable, the views of the dark back do not overexpose the front. An even light of 2^-14 alone would need twelve stops.
    write_even(folder / "dim.hdr", 128, 115)
    turn = ["--frames", "2", "--width", "32", "--height", "32", "-o", "t.png", "--camera-position", "0,0,8", "--spp", "4"]
    said = json.loads(run("render", "spot.gltf", "--env", "dim.hdr", *turn, "--json", folder=folder).stdout)
    assert 0.18 < brightest * 2 ** said["ev"] < 5, said["ev"]


def test_render_tells_of_samples_that_are_not_finite(folder):
    scene = make_square(0)
    scene["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 1e15, "color": [1e30, 1, 1]}]}}
    scene["nodes"].append({"rotation": [-math.sqrt(0.5), 0, 0, math.sqrt(0.5)], "extensions": {"KHR_lights_punctual": {"light": 0}}})
    scene["scenes"] = [{"nodes": [0, 1]}]
    (folder / "glare.gltf").write_text(json.dumps(scene))
    for words in [[], ["--shading", "split-sum"], ["--frames", "2"]]:
        result = run("render", "glare.gltf", "-o", "p.exr", *TINY, "--camera-position", "0,1,0.001", "--json", *words, folder=folder)
        samples = 16 * 12 * 4 * (2 if "--frames" in words else 1)
        assert json.loads(result.stdout)["non_finite_samples"] == samples
        assert f"{samples} samples were infinite or not a number" in result.stderr
    (folder / "square.gltf").write_text(json.dumps(make_square(0)))
    result = run("render", "square.gltf", "-o", "p.exr", *TINY, "--json", folder=folder)
    assert json.loads(result.stdout)["non_finite_samples"] == 0 and "infinite" not in result.stderr


def test_pictures_for_a_screen_may_be_jpeg(folder):
    run("render", "ball", "-o", "r.jpg,r.png", *TINY, "--frames", "2", folder=folder)
    run("sky", "--axes", "-o", "axes.jpeg", "--height", "32", folder=folder)
    run("sample", "studio.hdr", "--picture", "p.jpg", "--heat", "h.JPG", folder=folder)
    run("compare", "studio.hdr", "evening.hdr", "--heat", "d.jpg", "--sheet", "s.jpg", "--no-flip", folder=folder)
    run("convert", "studio.hdr", "-o", "c.jpg", folder=folder)
    for name in ["r_0001.jpg", "r_0002.jpg", "axes.jpeg", "p.jpg", "h.JPG", "d.jpg", "s.jpg", "c.jpg"]:
        data = (folder / name).read_bytes()
        assert data.startswith(b"\xff\xd8\xff") and data.endswith(b"\xff\xd9"), name
    assert (folder / "r.webp").exists()
    said = json.loads(run("info", "axes.jpeg", "--json", folder=folder).stdout)
    assert (said["format"], said["width"], said["height"]) == ("JPEG", 64, 32)


def test_convert_shows_a_render_as_render_does(folder):
    run("render", "ball", "-o", "r.exr,r.png", *TINY, "--background", "transparent", folder=folder)
    run("convert", "r.exr", "-o", "c.png", folder=folder)
    width, height, channels, shown = png_of(folder / "c.png")
    assert (width, height, channels) == (16, 12, 4)
    assert max(abs(a - b) for a, b in zip(shown, png_of(folder / "r.png")[3])) <= 1
    run("convert", "r.exr", "-o", "darker.png", "--tonemap", "neutral", "--ev", "-20", folder=folder)
    assert max(png_of(folder / "darker.png")[3][0::4]) == 0
    said = run("convert", "r.exr", "-o", "c.jpg", folder=folder)
    assert "JPEG holds no opacity" in said.stderr and "16 x 12" in said.stdout, said
    assert (folder / "c.jpg").read_bytes().startswith(b"\xff\xd8\xff")
    layer = json.loads(run("convert", "r.exr", "-o", "l.png", "--layer", "direct", "--json", folder=folder).stdout)
    assert (layer["source"]["layer"], layer["tonemap"], layer["projection"]) == ("direct", "agx", None), layer
    assert "direct" in run("convert", "r.exr", "-o", "l.png", "--layer", "gloss", folder=folder, code=1).stderr
    # A picture made for a screen is not changed, whatever its shape.
    run("convert", "r.png", "-o", "again.png", folder=folder)
    assert max(abs(a - b) for a, b in zip(png_of(folder / "again.png")[3], png_of(folder / "r.png")[3]) if b) <= 1
    # An environment is shown as it is stored, and is converted to other projections as before.
    run("convert", "studio.hdr", "-o", "studio.jpg", folder=folder)
    assert json.loads(run("convert", "studio.hdr", "-o", "s.png", "--to", "angular", "--json", folder=folder).stdout)["projection"]


def webp_frames(data):
    """(width, height, milliseconds of each frame) of an animated WebP."""
    assert data[:4] == b"RIFF" and data[8:12] == b"WEBP" and struct.unpack("<I", data[4:8])[0] + 8 == len(data)
    at, durations, size = 12, [], None
    while at < len(data):
        kind, length = struct.unpack("<4sI", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        number = lambda offset: int.from_bytes(body[offset:offset + 3], "little")
        if kind == b"VP8X":
            size = (number(4) + 1, number(7) + 1)
        if kind == b"ANMF":
            durations.append(number(12))
        at += 8 + length + (length & 1)
    return *size, durations


def test_render_says_whose_maps_it_cannot_read(folder):
    run("bake", "studio.hdr", "-o", "o", "--for", "three", "--size", "16", "--no-preview", folder=folder)
    said = run("render", "ball", "-o", "x.exr", "--shading", "split-sum", "--maps", "o", *TINY, folder=folder, code=1).stderr
    assert "is a bake for three" in said and "Bake for generic" in said, said
