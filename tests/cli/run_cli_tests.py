#!/usr/bin/env python3
"""Tests of the program: what it writes, what it says, how it ends. DOMELIGHT_PROGRAM names it; closes with the line that ./test adds up.

Each function test_... gets a folder of its own, in which small environments lie ready (studio.hdr, evening.hdr).
"""

import base64
import hashlib
import json
import math
import os
import re
import resource
import shutil
import signal
import struct
import subprocess
import sys
import time
import zlib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))
from folder_tests import Skipped, run_folder_tests  # noqa: E402

PROGRAM = os.environ.get("DOMELIGHT_PROGRAM", str(ROOT / "build/dev/cli/domelight"))
SMALL = ["--size", "16", "--irradiance-size", "4", "--brdf-size", "16", "--no-preview"]


def run(*words, folder, code=0, env=None, **options):
    """Runs `domelight WORDS` in `folder`; the exit status must be `code`."""
    result = subprocess.run([PROGRAM, *map(str, words)], cwd=folder, capture_output=True, text=True, timeout=300,
                            env={**os.environ, **(env or {})}, **options)
    assert result.returncode == code, f"{words}: exit {result.returncode}, not {code}\n{result.stdout}{result.stderr}"
    return result


def launch(*words, folder, **options):
    """Starts `domelight WORDS`, which SIGINT ends even where this program itself was started with that signal ignored, as in the background of a script."""
    return subprocess.Popen([PROGRAM, *words], cwd=folder, stdout=subprocess.DEVNULL, preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL), **options)


def files_of(folder):
    """Relative name -> SHA-256 of every file below."""
    return {str(p.relative_to(folder)): hashlib.sha256(p.read_bytes()).hexdigest() for p in sorted(Path(folder).rglob("*")) if p.is_file()}


def manifest_of(folder):
    return json.loads((Path(folder) / "manifest.json").read_text())


def named_files(value):
    """Every {"file", "sha256"} in a manifest but the source."""
    if isinstance(value, dict):
        if "file" in value and "sha256" in value:
            yield value["file"], value["sha256"]
        for key, inner in value.items():
            if key != "source":
                yield from named_files(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from named_files(inner)


# --- help, version, wrong usage ---


def test_examples_in_every_help_run(folder):
    shutil.copy(folder / "evening.hdr", folder / "sunset.hdr")
    (folder / "helmet.glb").write_bytes(make_glb())
    smaller = {"render": ["--width", "8", "--height", "8", "--spp", "1", "--quiet"],
               "probes": ["--size", "8", "--spp", "1", "--bounces", "0", "--distance-size", "8"]}  # if an option is repeated, the last one counts
    (folder / "hdris").mkdir()
    shutil.copy(folder / "studio.hdr", folder / "hdris")
    for command in ["bake", "batch", "brdf", "compare", "convert", "info", "lights", "probes", "render", "sample", "sky"]:
        text = run(command, "--help", folder=folder).stdout
        assert text.startswith("Examples:\n"), f"{command} --help does not open with examples"
        examples = [line.strip() for line in text.split("\n\n")[0].splitlines()[1:]]
        assert len(examples) >= 2
        for example in examples:
            words = example.split()
            assert words[:2] == ["domelight", command], example
            run(*words[1:], *smaller.get(command, []), *(["--frames", "2"] if "--frames" in words else []), folder=folder)
    overview = run("--help", folder=folder).stdout
    for line in overview.split("\n\n")[0].splitlines()[1:]:
        run(*line.split()[1:], "--quiet", folder=folder)


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


PROBES = ["--size", "8", "--spp", "2", "--bounces", "1"]


def test_probes_are_written_whole_and_described(folder):
    told = run("probes", "spheres", "-o", "set", "--grid", "2,1,1", *PROBES, folder=folder).stdout
    assert told.startswith("set: 2 probes of 8 x 8 texels a face, "), told
    assert sorted(p.name for p in (folder / "set").iterdir()) == ["distance.ktx2", "irradiance.ktx2", "probes.json", "specular.ktx2"]
    assert run("probes", "spheres", "--check", "set", folder=folder).stdout == "set: whole, and of this scene\n"
    changed = run("probes", "ball", "--check", "set", "--json", folder=folder, code=1)
    assert len(json.loads(changed.stdout)["changes"]) == 1 and "the scene is not the one that was captured: spheres" in changed.stderr, changed.stderr
    described = run("info", "set/specular.ktx2", folder=folder).stdout
    assert "8 x 8, 6 faces, 2 layers, 2 levels" in described and "domelight.roughness" in described, described
    record = json.loads((folder / "set/probes.json").read_text())
    assert record["grid"]["counts"] == [2, 1, 1] and len(record["probes"]) == 2
    for name in ("specular", "irradiance", "distance"):
        data = (folder / "set" / record[name]["file"]).read_bytes()
        assert record[name]["sha256"] == hashlib.sha256(data).hexdigest(), name
    report = json.loads(run("probes", "spheres", "-o", "at", "--at", "0,0,4", "--at", "9,0,0", "--json", *PROBES, "--threads", "1", folder=folder).stdout)
    assert report["probes"] == 2 and report["rays"] > 0 and report["invalid"] == 0, report
    again = run("probes", "spheres", "-o", "at2", "--at", "0,0,4", "--at", "9,0,0", "--quiet", *PROBES, "--threads", "2", folder=folder)
    assert again.stdout == ""
    (folder / "at2/distance.ktx2").write_bytes((folder / "at2/distance.ktx2").read_bytes()[:-1] + b"x")
    assert "distance.ktx2 is not the file" in run("probes", "spheres", "--check", "at2", folder=folder, code=1).stderr
    (folder / "at2/distance.ktx2").write_bytes((folder / "at/distance.ktx2").read_bytes())
    for name in ("specular.ktx2", "irradiance.ktx2", "distance.ktx2", "probes.json"):
        assert (folder / "at" / name).read_bytes() == (folder / "at2" / name).read_bytes(), name


def test_a_render_is_lit_by_probes(folder):
    run("probes", "spheres", "-o", "set", "--grid", "2,2,2", *PROBES, folder=folder)
    view = ["spheres", "--width", "16", "--height", "8", "--spp", "1", "--background", "transparent", "--shading", "split-sum", "--quiet"]
    pictures = []
    for options in [[], ["--parallax", "off"], ["--probe-blend", "1"], ["--probe-visibility", "off"], ["--probe-visibility", "off", "--probe-offset", "0.5"],
                    ["--irradiance", "sh"], ["--shading", "stretched"], ["--shading", "phong"]]:
        shown = run("render", *view, "--probes", "set", *options, "-o", "lit.hdr", folder=folder)
        assert shown.stderr == "", shown.stderr
        pictures.append((folder / "lit.hdr").read_bytes())
    assert len(set(pictures)) >= len(pictures) - 1  # parallax needs proxies
    (folder / "sun.hdr").write_bytes((folder / "evening.hdr").read_bytes())
    run("lights", "sun.hdr", "-o", "sun", "--no-preview", folder=folder)
    split = ["--env", "sun/" + next(p.name for p in (folder / "sun").iterdir() if p.stem == "remainder"), "--lights", "sun/lights.gltf"]
    run("probes", "spheres", "-o", "sunny", "--grid", "2,1,1", *split, *PROBES, folder=folder)
    run("probes", "spheres", "-o", "dull", "--grid", "2,1,1", *split[:2], *PROBES, folder=folder)
    harmonics = [json.loads((folder / name / "probes.json").read_text())["probes"][0]["harmonics"][0][1] for name in ["sunny", "dull"]]
    assert harmonics[0] > harmonics[1] > 0, "the spheres reflect the light of --lights into the probes"
    changed = run("render", "ball", *view[1:-1], "--probes", "set", "-o", "lit.hdr", folder=folder)
    assert "captured in another scene, or in spheres before it was changed" in changed.stderr, changed.stderr

    def refused(*words, code=2):
        return run("render", *view, *words, "-o", "refused.hdr", folder=folder, code=code).stderr

    assert "--probes: goes with --shading split-sum" in refused("--probes", "set", "--shading", "mirror")
    assert "--parallax: goes with --probes only" in refused("--parallax", "off")
    assert "--probe-blend" in refused("--probes", "set", "--probe-blend", "9")
    assert "--maps: is the light of one environment" in refused("--probes", "set", "--maps", "set")
    assert "none/probes.json" in refused("--probes", "none", code=1)
    (folder / "set/irradiance.ktx2").write_bytes(b"damaged")
    assert "irradiance.ktx2" in refused("--probes", "set", code=1)


def test_probes_are_placed_automatically_with_their_boxes(folder):
    report = json.loads(run("probes", "spheres", "-o", "auto", "--auto", "12", "--region", "-1,0,-1,1,2,1", "--json", *PROBES, folder=folder).stdout)
    record = json.loads((folder / "auto/probes.json").read_text())
    assert 8 <= report["probes"] == len(record["probes"]) <= 12 and record["tetrahedra"] and record["grid"] is None
    assert all(p["valid"] for p in record["probes"])
    run("probes", "spheres", "-o", "boxes", "--at", "0,1,4", "--proxy", "-5,0,-5,5,3,5", "--influence", "room", *PROBES, folder=folder)
    probe = json.loads((folder / "boxes/probes.json").read_text())["probes"][0]
    assert probe["proxy"] == {"low": [-5, 0, -5], "high": [5, 3, 5]}
    assert probe["influence"]["shape"] == "box" and abs(probe["influence"]["fade"] - 0.3) < 1e-6
    run("probes", "spheres", "-o", "round", "--at", "0,1,4", "--proxy", "none", "--influence", "2.5", *PROBES, folder=folder)
    report = json.loads(run("probes", "spheres", "-o", "fits", "--at", "0,1,4", "--at", "0,2,4", "--budget", "0.2", "--spp", "1", "--json", folder=folder).stdout)
    assert report["size"] == 32 and 150_000 < report["bytes"] <= 200_000, report
    probe = json.loads((folder / "round/probes.json").read_text())["probes"][0]
    assert "proxy" not in probe and probe["influence"]["radius"] == 2.5, probe


def test_probes_refuse_what_cannot_work(folder):
    def refused(*words, code, says, scene="spheres"):
        error = run("probes", scene, "-o", "set", *PROBES, *words, folder=folder, code=code).stderr
        assert says in error, error
        assert not (folder / "set").exists(), words

    refused(code=2, says="--grid, --density, --at, --auto: is missing")
    refused("--grid", "1,1,1", "--at", "0,0,0", code=2, says="are given together")
    refused("--grid", "0,1,1", code=2, says="--grid: 0 is not a number of places")
    refused("--grid", "2,2", code=2, says="--grid: needs three numbers")
    refused("--density", "1e6", code=2, says="to the square metre would do")
    refused("--density", "nan", code=2, says="--density")
    refused("--at", "0,nan,0", code=2, says="--at: nan is not finite")
    refused("--at", "0,0", code=2, says="--at: \"0,0\" is not three numbers")
    refused("--grid", "1,1,1", "--region", "0,0,0,0,0,0", code=2, says="--region: from (0, 0, 0) to (0, 0, 0) has no volume")
    refused("--grid", "1,1,1", "--region", "1,0,0,0,1,1", code=2, says="--region")
    refused("--auto", "7", code=2, says="--auto")
    refused("--auto", "9", "--nearest", "1", code=2, says="--nearest: has no meaning with --auto")
    refused("--auto", "9", "--region", "0,0,0,1,0,1", code=2, says="--region")
    refused("--grid", "1,1,1", "--proxy", "0,0,0,1,0,1", code=2, says="--proxy: \"0,0,0,1,0,1\" is a box without volume")
    refused("--grid", "1,1,1", "--proxy", "wall", code=2, says="--proxy: \"wall\" is none of them")
    refused("--grid", "1,1,1", "--influence", "0", code=2, says="--influence: \"0\" is none of them")
    refused("--grid", "1,1,1", "--influence", "room", "--proxy", "none", code=2, says="--influence")
    assert "--budget: 0.002 MB are too few" in run("probes", "spheres", "-o", "set", "--grid", "1,1,1", "--budget", "0.002", folder=folder, code=2).stderr
    refused("--grid", "1,1,1", "--check", "set", code=2, says="has no meaning with --check")
    assert "--size: is chosen by --budget" in run("probes", "spheres", "-o", "set", "--grid", "1,1,1", "--size", "8", "--budget", "1", folder=folder, code=2).stderr
    refused("--grid", "1,1,1", "--size", "4", code=2, says="--size")
    refused("--grid", "1,1,1", "--levels", "9", code=2, says="--levels: 9 levels are more than faces of 8 texels have")
    refused("--grid", "1,1,1", code=1, says="nothing.glb", scene="nothing.glb")
    refused("--at", "0,0,0", code=1, says="all probes lie inside bodies", scene="furnace")
    (folder / "black.hdr").write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n" + bytes(4 * 8 * 4))
    refused("--at", "0,0,4", "--env", "black.hdr", code=1, says="the environment is black")
    (folder / "empty.obj").write_text("v 0 0 0\n")
    refused("--at", "0,0,4", code=1, says="no triangles", scene="empty.obj")
    (folder / "a-file").write_text("")
    assert "a-file" in run("probes", "spheres", "-o", "a-file", "--at", "0,0,4", *PROBES, folder=folder, code=1).stderr


def test_probes_are_written_for_engines(folder):
    told = run("probes", "spheres", "-o", "set", "--grid", "2,1,1", *PROBES, "--for", "three", "--for", "babylon", folder=folder).stdout
    assert "set/three: 2 files for three" in told and "set/babylon: 3 files for babylon" in told, told
    assert "VK_FORMAT_R16G16B16A16_SFLOAT, 2 x 1 x 21" in run("info", "set/three/light-probe-grid.ktx2", folder=folder).stdout
    report = json.loads(run("probes", "set", "--for", "bevy", "-o", "volume", "--json", folder=folder).stdout)
    assert report["engines"][0]["files"] == ["irradiance-volume.ktx2", "irradiance-volume.json"], report
    run("probes", "spheres", "-o", "at", "--at", "0,0,4", *PROBES, "--quiet", folder=folder)
    for words, code, says in [(["set", "-o", "x"], 2, "--for: is missing"),
                              (["set", "-o", "x", "--for", "tree"], 2, "is not an engine"),
                              (["set", "-o", "x", "--for", "three", "--spp", "4"], 2, "--spp: is for capturing a scene"),
                              (["at", "-o", "x", "--for", "three"], 2, "the probes of this set are not in one")]:
        assert says in run("probes", *words, folder=folder, code=code).stderr, words
        assert not (folder / "x").exists(), words


def test_help_of_a_command(folder):
    overview = run("help", folder=folder).stdout
    assert overview == run("--help", folder=folder).stdout and "domelight help COMMAND" in overview
    for command in ["bake", "batch", "brdf", "compare", "convert", "info", "lights", "render", "sample", "sky", "view"]:
        text = run("help", command, folder=folder).stdout
        assert text == run(command, "--help", folder=folder).stdout
        assert text.count("is the default") == 1, command
    assert "Did you mean bake?" in run("help", "bkae", folder=folder, code=2).stderr


def test_what_was_meant_is_suggested(folder):
    for words, meant in [
        (["convrt"], "convert"), (["infos"], "info"), (["skey"], "sky"), (["ren"], "render"), (["--versoin"], "--version"),
        (["bake", "--rougness", "0,1"], "--roughness"), (["bake", "-o", "o", "--out", "o"], "--output"),
        (["bake", "--irradiance_size=8"], "--irradiance-size"), (["render", "ball", "-size", "8"], None),
        (["convert", "a.hdr", "--form", "cube"], "--from"), (["sky", "--sun-elevation", "4"], "--sun-elevation-deg"),
        (["bake", "-o", "o", "--encoding", "rgb9e"], "rgb9e5"), (["bake", "-o", "o", "--nonsense"], None), (["nonsense"], None),
    ]:
        said = run(*words, folder=folder, code=2).stderr
        assert (f"Did you mean {meant}?" in said) if meant else ("Did you mean" not in said), (words, said)


def test_version(folder):
    assert re.fullmatch(r"domelight \d+\.\d+\.\d+\n", run("--version", folder=folder).stdout)


def test_completions_name_every_command_and_option(folder):
    scripts = {shell: run("completion", shell, folder=folder).stdout for shell in ["bash", "zsh", "fish"]}
    for words in ["bake", "irradiance-size", "phong-plain", "completion"]:
        for shell, script in scripts.items():
            assert words in script, (shell, words)
    (folder / "script").write_text(scripts["bash"])
    assert subprocess.run(["bash", "-n", folder / "script"]).returncode == 0
    for words in [["completion"], ["completion", "csh"], ["completion", "bash", "zsh"]]:
        assert "bash, zsh, fish" in run(*words, folder=folder, code=2).stderr
    (folder / "pages").mkdir()
    run("manual", "pages", folder=folder)
    assert ".SH NAME\ndomelight\\-sky" in (folder / "pages/domelight-sky.1").read_text()


def test_wrong_usage_exits_2_and_lists_what_is_accepted(folder):
    cases = [
        (["nonsense"], "bake, batch, brdf, compare, convert, info, probes, render, lights, sample, sky"),
        (["--nonsense"], "bake, batch, brdf, compare, convert, info, probes, render, lights, sample, sky"),
        (["bake", "-o", "o", "--nonsense"], "--lobe"),
        (["bake"], "-o DIR"),
        (["bake", "-o", "o", "--lobe", "blinn"], "ggx, charlie, phong, phong-plain"),
        (["bake", "-o", "o", "--for", "quake"], "playcanvas, gltf, godot, unity, unreal, blender, mitsuba, pbrt, usd, materialx"),
        (["bake", "-o", "o", "--encoding", "rgb8"], "rgba16f, rgba32f, rgb9e5, r11g11b10f"),
        (["bake", "-o", "o", "--format", "tga"], "ktx2, ktx1, dds, dds9, exr, exr-mip, hdr"),
        (["bake", "-o", "o", "--method", "guess"], "exact, bruteforce, riemann, montecarlo"),
        (["bake", "-o", "o", "--layout", "dome"], "cube, latlong"),
        (["bake", "-o", "o", "--brdf-g", "ashikhmin"], "correlated, smith, karis"),
        (["bake", "-o", "o", "--sh-window", "blackman"], "none, hann, lanczos"),
        (["bake", "-o", "o", "--levels"], "--levels"),
        (["bake", "-o", "o", "--levels", "many"], "whole number"),
        (["bake", "-o", "o", "--levels", "40"], "from 1 to 10"),
        (["bake", "-o", "o", "--size", "0"], "from 1 to"),
        (["bake", "-o", "o", "--size", "-8"], "from 1 to"),
        (["bake", "-o", "o", "--size", "99999999999999999999"], "whole number"),
        (["bake", "-o", "o", "--roughness", "0,1.5"], "from 0 to 1"),
        (["bake", "-o", "o", "--roughness", "0,,1"], "number"),
        (["bake", "-o", "o", "--roughness", "0,nan"], "from 0 to 1"),
        (["bake", "-o", "o", "--levels", "3", "--roughness", "0,1"], "3 levels"),
        (["bake", "-o", "o", "--exponents", "5"], "--lobe phong"),
        (["bake", "-o", "o", "--lobe", "phong", "--roughness", "1"], "--exponents"),
        (["bake", "-o", "o", "--format", "hdr", "--encoding", "rgba16f"], "RGBE"),
        (["bake", "-o", "o", "--format", "exr", "--encoding", "rgb9e5"], "rgba16f"),
        (["bake", "-o", "o", "--format", "dds", "--zstd"], "ktx2"),
        (["bake", "-o", "o", "--zstd", "--no-zstd"], "--zstd"),
        (["bake", "-o", "o", "--riemann-steps", "12"], "KxJ"),
        (["bake", "-o", "o", "--sh-bands", "0"], "1 to 64"),
        (["bake", "-o", "o", "--threads", "-1"], "0 to 1024"),
        (["bake", "-o", "o", "--exposure", "much"], "number"),
        (["bake", "-o", "o", "--for", "three-latlong", "--levels", "5"], "error: --levels: does not apply to --for three-latlong"),
        (["bake", "-o", "o", "--for", "three-latlong", "--layout", "cube"], "error: --layout: cube does not apply to --for three-latlong"),
        (["bake", "-o", "o", "--irradiance-size", "0"], "error: --irradiance-size: 0 is not from 1 to 4096"),
        (["bake", "-o", "o", "--riemann-steps", "0x1"], "error: --riemann-steps: 0 is not from 1 to 65536"),
        (["bake", "studio.hdr", "-o", "o", "--projection", "cube/sideways"], "error: --projection: "),
        (["bake", "studio.hdr", "-o", "o", "--projection", "latlong/usd", "--latlong", "mod"], "error: --latlong: mod contradicts --projection latlong/usd"),
        (["bake", "-o", "o", "--for", "babylon", "--size", "100"], "power of two"),
        (["bake", "-o", "o", "--for", "playcanvas", "--size", "64"], "one size"),
        (["bake", "-o", "o", "--for", "gltf", "--encoding", "rgb9e5"], "rgbd only"),
        (["bake", "-o", "o", "--format", "exr-mip", "--encoding", "bc6h"], "rgba16f"),
        (["bake", "-o", "o", "--for", "generic", "--for", "generic"], "twice"),
        (["bake", "studio.hdr", "-o", "o", "--latlong", "sideways"], "materialx"),
        (["bake", "studio.hdr", "-o", "o", "--projection", "fisheye"], "cube-cross"),
        (["bake", "studio.hdr", "-o", "o", "--up", "w"], "--up"),
        (["convert"], "IN -o OUT"),
        (["convert", "studio.hdr", "-o", "out.hdr", "--to", "mirrorball"], "Did you mean mirror-ball?"),
        (["info", "studio.hdr", "--latlong", "usdd"], "Did you mean usd?"),
        (["info", "studio.hdr", "--latlong", "usdd"], "pbrt"),
        (["bake", "--env", "studio.hdr", "-o", "o"], "domelight bake ENV"),
        (["render", "spheres", "-o", "o.png", "--width", "99999999"], "99999999 is not from 1 to 16384"),
        (["render", "spheres", "-o", "o.png", "--spp", "0"], "1 to 1048576"),
        (["convert", "studio.hdr", "-o", "out.png", "--picture", "--to", "cube"], "does not go with --to"),
        (["convert", "studio.hdr", "-o", "out.ktx2", "--picture"], ".hdr, .exr, .png, .jpg, .jpeg"),
        (["convert", "studio.hdr", "-o", "out.png", "--tonemap", "film"], "agx, agx-punchy, neutral"),
        (["convert", "studio.hdr", "-o", "out.png", "--ev", "200"], "from -100 to 100"),
        (["info", "studio.hdr", "evening.hdr", "--picture"], "one picture"),
        (["convert", "studio.hdr", "out.tga"], ".hdr, .exr, .png, .jpg, .jpeg, .ktx2"),
        (["convert", "studio.hdr", "out.hdr", "--to", "mercator"], "sphere-map, mirror-ball, angular"),
        (["convert", "studio.hdr", "out.hdr", "--to", "latlong/sideways"], "materialx"),
        (["convert", "studio.hdr", "out.hdr", "--to", "angular/centre=+X,right=-X"], "three different axes"),
        (["convert", "studio.hdr", "out.hdr", "--from", "fisheye"], "dual-paraboloid"),
        (["convert", "studio.hdr", "out.hdr", "--size", "0"], "1 to 32768"),
        (["convert", "studio.hdr", "out.hdr", "--rotate", "0,0,0,30"], "X,Y,Z,DEGREES"),
        (["convert", "studio.hdr", "out.hdr", "--rotate", "0,1,30"], "X,Y,Z,DEGREES"),
        (["convert", "studio.hdr", "out.hdr", "--mirror", "w"], "x, y, z"),
        (["convert", "studio.hdr", "out.hdr", "--to", "cube", "--layout", "dome"], "cross, vertical-cross, strip, vertical-strip, faces"),
        (["convert", "studio.hdr", "out.hdr", "--layout", "cross"], "picture"),
        (["convert", "studio.hdr", "out.hdr", "--encoding", "half"], "rgbe"),
        (["convert", "studio.hdr", "out.hdr", "--to", "cube/openexr"], ".exr"),
        (["convert", "studio.hdr", "out.hdr", "--exposure", "nan"], "--exposure"),
        (["compare", "studio.hdr"], "two pictures"),
        (["compare", "studio.hdr", "evening.hdr", "--fail-above", "rmse"], "METRIC=VALUE"),
        (["compare", "studio.hdr", "evening.hdr", "--fail-above", "colour=1"], "rmse, relative, tone-mapped"),
        (["compare", "studio.hdr", "evening.hdr", "--fail-above", "chi2=1"], "variance"),
        (["bake", "-o", "o", "--irradiance", "pi"], "e, over-pi"),
        (["bake", "-o", "o", "--for", "babylon", "--irradiance", "e"], "No map of irradiance"),
        (["bake", "-o", "o", "--for", "babylon", "--irradiance", "e"], "--irradiance: does not apply to --for babylon"),
        (["brdf"], "-o brdf.ktx2"),
        (["brdf", "-o", "o.jpg"], ".ktx2, .ktx, .dds, .exr, .hdr, .png"),
        (["brdf", "-o", "o.png", "--size", "0"], "from 1 to 4096"),
        (["brdf", "-o", "o.png", "--form", "none"], "scale-bias, multiscatter, scale-bias-charlie"),
        (["brdf", "-o", "o.png", "--for", "three"], "--form scale-bias"),
        (["brdf", "-o", "o.png", "--g", "ashikhmin"], "correlated, smith, karis"),
        (["brdf", "-o", "o.png", "--samples", "9"], "--method montecarlo"),
        (["brdf", "-o", "o.png", "--method", "montecarlo", "--samples", "0"], "from 1 to"),
        (["compare", "studio.hdr", "evening.hdr", "--heat-of", "warmth"], "hdr-flip, flip, difference"),
        (["compare", "studio.hdr", "evening.hdr", "--heat", "h.gif"], ".png, .jpg"),
        (["compare", "studio.hdr", "evening.hdr", "--view-exposure", "bright"], "auto"),
        (["compare", "studio.hdr", "--bake", "a.ktx2"], "--env"),
        (["bake", "-o", "o", "--latlong-out", "usd"], "--layout latlong"),
        (["bake", "-o", "o", "--layout", "latlong", "--latlong-out", "sideways"], "materialx"),
        (["bake", "-o", "o", "--for", "pbrt", "--latlong-out", "usd"], "--latlong-out: does not apply to --for pbrt: its image is a fixed one, equal-area-octahedral"),
        (["bake", "-o", "o", "--for", "playcanvas", "--latlong-out", "usd"], "--latlong-out: does not apply to --for playcanvas: its file has a fixed convention, usd"),
        (["compare", "--bake", "a.ktx2", "--texels", "3"], "--texels"),
        (["sky"], "-o sky.hdr"),
        (["sky", "-o", "sky.tiff"], ".hdr, .exr, .png, .jpg"),
        (["sky", "-o", "sky.hdr", "--turbidity", "50"], "1 to 10"),
        (["info", "a.hdr", "b.hdr"], "one at a time"),
        (["lights", "studio.hdr"], "-o DIR"),
        (["lights", "studio.hdr", "-o", "o", "--nonsense"], "--max-lights"),
        (["lights", "studio.hdr", "-o", "o", "--format", "png"], "auto, hdr, exr"),
        (["lights", "studio.hdr", "-o", "o", "--max-lights", "-1"], "from 0 to 1024"),
        (["lights", "studio.hdr", "-o", "o", "--max-lights", "few"], "whole number"),
        (["lights", "studio.hdr", "-o", "o", "--least-share", "2"], "from 0 to 1"),
        (["lights", "studio.hdr", "-o", "o", "--least-share", "nan"], "from 0 to 1"),
        (["lights", "studio.hdr", "-o", "o", "--least-contrast", "1"], "from 1.5"),
        (["lights", "studio.hdr", "-o", "o", "--largest-diameter-deg", "90"], "to 30"),
        (["lights", "studio.hdr", "-o", "o", "--lux-per-unit", "0"], "above 0"),
        (["lights", "studio.hdr", "evening.hdr", "-o", "o"], "one at a time"),
        (["lights", "studio.hdr", "-o", "o", "--latlong", "sideways"], "materialx"),
        (["sample", "--method", "magic"], "linear, walk, binary, guided, alias, hierarchical, bilinear, bilinear-plain"),
        (["sample", "--weight", "area"], "radiant-power, grayscale"),
        (["sample", "--sequence", "blue"], "random, stratified, hammersley, halton, sobol, r2"),
        (["sample", "-n", "0"], "from 1 to"),
        (["sample", "-n", "some"], "whole number"),
        (["sample", "--seed", "-3"], "whole number"),
        (["sample", "--uniform-share", "1.5"], "from 0 to 1"),
        (["sample", "--uniform-share", "nan"], "from 0 to 1"),
        (["sample", "-o", "o.txt"], ".csv, .json"),
        (["sample", "--picture", "o.gif"], ".png, .jpg"),
        (["sample", "--picture-width", "7"], "from 256 to 8192"),
        (["sample", "--heat-measure", "uv"], "--heat"),
        (["sample", "--tables-format", "exr"], "--tables"),
        (["sample", "--explain", "0.5"], "0.25,0.5"),
        (["sample", "--explain", "0.5,1"], "[0, 1)"),
        (["sample", "--explain", "0.5,0.5", "--method", "alias"], "binary"),
        (["sample", "--explain-picture", "o.png"], "--explain"),
        (["sample", "--roughness", "0.5"], "--estimate"),
        (["sample", "--plot", "o.png"], "--estimate"),
        (["sample", "--estimate", "--brdf", "blinn"], "lambert, phong, ggx, charlie"),
        (["sample", "--estimate", "--strategy", "luck"], "riemann, uniform, cosine"),
        (["sample", "--estimate", "--roughness", "0.5"], "--brdf ggx and charlie"),
        (["sample", "--estimate", "--brdf", "ggx", "--roughness", "2"], "from 0 to 1"),
        (["sample", "--estimate", "--normal", "0,1"], "0,1,0"),
        (["sample", "--estimate", "--normal", "0,0,0"], "0,1,0"),
        (["sample", "--estimate", "--view", "0,-1,0"], "below the surface"),
        (["sample", "--estimate", "--compensate"], "with and without"),
        (["sample", "a.hdr", "b.hdr"], "one environment at a time"),
        (["render", "-o", "o.png"], "spheres, ball, furnace"),
        (["render", "spheres"], "-o picture.png"),
        (["render", "spheres", "-o", "o.gif"], ".hdr, .exr, .png, .jpg"),
        (["render", "spheres", "-o", "o.jpg", "--background", "transparent"], "JPEG holds no opacity"),
        (["render", "spheres", "-o", "o.png", "--nonsense"], "--shading"),
        (["render", "spheres", "-o", "o.png", "--width", "0"], "from 1 to 16384"),
        (["render", "spheres", "-o", "o.png", "--tonemap", "film"], "agx, agx-punchy, neutral, aces, reinhard, gamma22, none"),
        (["render", "spheres", "-o", "o.png", "--ev", "lots"], "number"),
        (["render", "spheres", "-o", "o.png", "--background", "black"], "environment, blurred, colour, color, transparent"),
        (["render", "spheres", "-o", "o.png", "--background-color", "red"], "#rrggbb"),
        (["render", "spheres", "-o", "o.png", "--background-color", "#12345"], "#rrggbb"),
        (["render", "spheres", "-o", "o.png", "--background-color", "1,2"], "R,G,B"),
        (["render", "spheres", "-o", "o.png", "--background-color", "1,2,-3"], "R,G,B"),
        (["render", "spheres", "-o", "o.png", "--background", "blurred", "--background-color", "1,1,1"], "--background colour"),
        (["render", "spheres", "-o", "o.png", "--background-roughness", "0.5"], "--background blurred"),
        (["render", "spheres", "-o", "o.png", "--background", "blurred", "--background-roughness", "2"], "from 0 to 1"),
        (["render", "spheres", "-o", "o.png", "--camera-target", "0,1,0"], "--camera-position"),
        (["render", "spheres", "-o", "o.png", "--camera-position", "0,1"], "x,y,z"),
        (["render", "spheres", "-o", "o.png", "--camera-position", "0,1,inf"], "finite"),
        (["render", "spheres", "-o", "o.png", "--camera", "1", "--camera-position", "0,1,5"], "--camera-position"),
        (["render", "spheres", "-o", "o.png", "--camera", "side"], "1 \"camera\""),
        (["render", "spheres", "-o", "o.png", "--frames", "1"], "from 2 to 9999"),
        (["render", "spheres", "-o", "o.png", "--fps", "10"], "--frames"),
        (["render", "spheres", "-o", "o.png", "--turn", "environment"], "--frames"),
        (["render", "spheres", "-o", "o.png", "--frames", "2", "--turn", "scene"], "camera, environment"),
        (["render", "spheres", "-o", "o.png", "--frames", "2", "--fps", "0"], "from 1 to 1000"),
        (["render", "spheres", "-o", "o.png", "--frames", "2", "--turn", "environment", "--maps", "baked", "--shading", "split-sum"], "--maps"),
        (["render", "spheres", "-o", "o.png", "--resume"], "--frames"),
        (["render", "spheres", "-o", "o.png", "--save-every", "5", "--shading", "split-sum"], "--shading reference"),
        (["render", "spheres", "-o", "o.png", "--save-every", "-1"], "from 0"),
        (["render", "spheres", "-o", "o.png", "--diffuse-weight", "fresnel"], "--shading split-sum or stretched"),
        (["render", "spheres", "-o", "o.png", "--shading", "split-sum", "--diffuse-weight", "max"], "energy, fresnel"),
        (["render", "--study", "-o", "o.exr"], "a folder nor a .png"),
        (["render", "--study", "-o", "o", "--frames", "3"], "--study"),
        (["render", "--study", "-o", "o", "--shading", "phong"], "--study"),
        (["render", "--study"], "-o picture.png"),
    ]
    for words, text in cases:
        result = run(*words, folder=folder, code=2)
        assert result.stderr.startswith("error: "), (words, result.stderr)
        assert text in result.stderr, (words, result.stderr)
        assert result.stdout == "", words
    assert not (folder / "o").exists()


def test_failures_exit_1_name_the_file_and_leave_nothing(folder):
    (folder / "broken.hdr").write_bytes((folder / "studio.hdr").read_bytes()[:700])
    (folder / "text.exr").write_text("no picture at all")
    cases = [["missing.hdr"], ["broken.hdr"], ["text.exr"]]
    for words in cases:
        for command in [["bake", *words, "-o", "out"], ["info", *words], ["lights", *words, "-o", "out"], ["sample", *words, "--picture", "out.png"]]:
            result = run(*command, folder=folder, code=1)
            assert result.stderr.startswith("error: " + words[0] + ": "), result.stderr
        assert not (folder / "out").exists(), words


def test_output_that_is_a_file_is_refused(folder):
    (folder / "out").write_text("mine")
    run("bake", "studio.hdr", "-o", "out", *SMALL, folder=folder, code=1)
    run("lights", "studio.hdr", "-o", "out", folder=folder, code=1)
    assert (folder / "out").read_text() == "mine"


# --- what a bake writes ---


def test_bake_writes_what_its_manifest_says(folder):
    run("bake", "studio.hdr", "-o", "out", "--size", "32", "--levels", "3", folder=folder)
    manifest = manifest_of(folder / "out")
    files = files_of(folder / "out")
    assert set(files) == {"specular.ktx2", "irradiance.ktx2", "sh.json", "brdf.ktx2", "preview.png", "manifest.json"}
    named = dict(named_files(manifest))
    assert set(named) == set(files) - {"manifest.json"}
    for name, digest in named.items():
        assert files[name] == digest, name
    source = manifest["source"]
    assert source["file"] == "studio.hdr" and (source["width"], source["height"]) == (64, 32) and source["projection"] == "latlong"
    assert source["sha256"] == hashlib.sha256((folder / "studio.hdr").read_bytes()).hexdigest()
    assert set(source["repaired"]) >= {"not_a_number", "infinite", "negative"}
    levels = manifest["specular"]["levels"]
    assert [l["size"] for l in levels] == [32, 16, 8] and [l["roughness"] for l in levels] == [0, 0.6, 1] and [l["alpha"] for l in levels] == [0, 0.36, 1]
    assert all("clipped_energy" in l for l in levels)
    assert manifest["specular"]["level_for_roughness"].startswith("r <= r1 ? r / r1")
    assert manifest["specular"]["lobe"] == "ggx" and manifest["specular"]["encoding"] == "rgba16f"
    assert manifest["specular"]["quantity"] == "radiance" and manifest["irradiance"]["quantity"] == "irradiance"
    assert manifest["options"]["size"] == 32 and "version" in manifest
    assert "second" not in json.dumps(manifest), "a manifest holds no times"


def test_sh_json_holds_the_convention_and_the_error(folder):
    run("bake", "studio.hdr", "-o", "out", *SMALL, "--sh-bands", "4", folder=folder)
    sh = json.loads((folder / "out/sh.json").read_text())
    assert sh["bands"] == 4 and len(sh["radiance"]) == 16 and len(sh["irradiance"]) == 16
    # Band 0 of E is pi times that of the radiance, band 1 two thirds of pi (Ramamoorthi and Hanrahan 2001).
    for i, factor in [(0, 3.14159265358979), (1, 2.0943951023932), (2, 2.0943951023932), (9, 0)]:
        for c in range(3):
            assert abs(sh["irradiance"][i][c] - factor * sh["radiance"][i][c]) < 1e-9 * abs(sh["radiance"][0][c])
    assert 0 <= sh["irradiance_error"]["rms"] <= sh["irradiance_error"]["max"]


def test_roughness_and_alpha_stand_in_the_texture(folder):
    run("bake", "studio.hdr", "-o", "out", *SMALL, "--roughness", "0,0.5", folder=folder)
    info = json.loads(run("info", "out/specular.ktx2", "--json", folder=folder).stdout)
    assert info["faces"] == 6 and info["levels"] == 2 and (info["width"], info["height"]) == (16, 16)
    keys = info["metadata"]
    assert keys["domelight.roughness"] == "0 0.5" and keys["domelight.alpha"] == "0 0.25"
    assert keys["domelight.lobe"] == "ggx" and keys["domelight.quantity"] == "radiance"


def test_encodings_report_their_errors_and_are_read_again(folder):
    psnr = {}
    for name, words in {"bc6h": [], "fast": ["--encoding-quality", "fast"], "dds": ["--format", "dds"], "ktx1": ["--format", "ktx1"],
                        "zstd": ["--zstd"]}.items():
        run("bake", "studio.hdr", "-o", name, "--size", "32", "--levels", "4", "--encoding", "bc6h", *words, folder=folder)
        manifest = manifest_of(folder / name)
        psnr[name] = [level["encoding_log_psnr"] for level in manifest["specular"]["levels"]]
        assert manifest["options"]["encoding_quality"] == ("fast" if name == "fast" else "default")
        file = manifest["specular"]["file"]
        info = json.loads(run("info", f"{name}/{file}", "--json", folder=folder).stdout)
        assert info["decodable"] and info["levels"] == 4 and ("BC6H" in info["format"] or "BPTC" in info["format"])
    assert psnr["bc6h"] == psnr["dds"] == psnr["ktx1"] == psnr["zstd"] and psnr["fast"][0] < psnr["bc6h"][0]
    assert all(p > 30 for p in psnr["bc6h"]), psnr
    audit = json.loads(run("compare", "--bake", "bc6h/specular.ktx2", "--env", "studio.hdr", "--json", folder=folder).stdout)
    assert audit["orientation"]["words"] == "as ours" and all(abs(level["scale"] - 1) < 0.01 for level in audit["levels"])
    for name in ("rgbm", "rgbd", "rgbp"):
        run("bake", "studio.hdr", "-o", name, *SMALL, "--encoding", name, folder=folder)
        levels = manifest_of(folder / name)["specular"]["levels"]
        assert all(l["encoding_log_psnr"] is None or l["encoding_log_psnr"] > 40 for l in levels)
        info = json.loads(run("info", f"{name}/specular.ktx2", "--json", folder=folder).stdout)
        assert info["decodable"] and info["format"].endswith(", " + name)
    run("bake", "studio.hdr", "-o", "no", *SMALL, "--encoding", "rgbd", "--format", "dds", folder=folder, code=2)
    run("bake", "studio.hdr", "-o", "no", *SMALL, "--encoding-quality", "best", folder=folder, code=2)
    run("bake", "studio.hdr", "-o", "picture", *SMALL, "--format", "hdr", folder=folder)
    assert all(l["encoding_rms_error"] > 0 for l in manifest_of(folder / "picture")["specular"]["levels"])


def test_a_bake_is_measured_as_a_shader_reads_it(folder):
    run("bake", "studio.hdr", "-o", "out", "--size", "32", "--levels", "4", "--for", "khronos", "--no-preview", folder=folder)
    words = ["compare", "--bake", "out/ggx/specular.ktx2", "--env", "studio.hdr", "--as-read"]
    audit = json.loads(run(*words, "--json", folder=folder).stdout)
    levels, between = audit["as_read"]["levels"], audit["as_read"]["between"]
    assert [l["level"] for l in levels] == [1, 2, 3] and abs(levels[2]["roughness"] - 1) < 1e-9
    assert len(between) == 24 and all(0.1 <= b["roughness"] <= 1 and abs(b["level"] - 3 * b["roughness"]) < 1e-6 for b in between)
    assert all(l["relative_rmse"] < audit["as_read"]["relative_rmse"] < 1 for l in levels)
    text = run(*words, "--for", "filament", folder=folder).stdout  # it is not filament's curve
    assert all(abs(l["error"]) < 1e-3 and l["relative_rmse"] < 1e-3 for l in audit["levels"])  # texels made in the same way
    run("bake", "studio.hdr", "-o", "centre", *SMALL, "--texels", "centre", "--as-read", folder=folder)
    run("bake", "studio.hdr", "-o", "read", *SMALL, "--as-read", folder=folder)
    by = {name: manifest_of(folder / name) for name in ("centre", "read")}
    assert all(by[name]["options"]["texels"] == name for name in by)
    errors = {name: [l["relative_rmse"] for l in by[name]["specular"]["as_read"]["levels"]] for name in by}
    assert all(r < 0.8 * c for r, c in zip(errors["read"], errors["centre"])), errors
    run("bake", "studio.hdr", "-o", "no", *SMALL, "--texels", "read", "--layout", "latlong", folder=folder, code=2)
    run("bake", "studio.hdr", "-o", "no", *SMALL, "--texels", "read", "--method", "riemann", folder=folder, code=2)
    assert "as a shader reads it" in text and "0.1 to 1" in text


def test_phong_records_exponents(folder):
    run("bake", "studio.hdr", "-o", "out", *SMALL, "--lobe", "phong", "--exponents", "inf,64,8", folder=folder)
    manifest = manifest_of(folder / "out")
    assert [l["exponent"] for l in manifest["specular"]["levels"]] == ["inf", 64, 8]
    assert manifest["specular"]["lobe"] == "phong"
    info = json.loads(run("info", "out/specular.ktx2", "--json", folder=folder).stdout)
    assert info["metadata"]["domelight.exponent"] == "inf 64 8"


def test_phong_tells_how_exponents_between_levels_are_read(folder):
    said = run("bake", "studio.hdr", "-o", "out", *SMALL[2:], "--size", "64", "--lobe", "phong", folder=folder).stdout
    assert re.search(r"exponents between levels: error [0-9.e-]+ % median \(at [0-9.]+\), [0-9.e-]+ % worst", said), said
    gaps = manifest_of(folder / "out")["specular"]["between_levels"]
    exponents = [l["exponent"] for l in manifest_of(folder / "out")["specular"]["levels"][1:]]
    assert exponents[:2] == [2048, 512] and len(gaps) == len(exponents) - 1
    for gap, above, below in zip(gaps, exponents, exponents[1:]):
        assert below < gap["exponent"] < above and 0 <= gap["median_error"] <= gap["worst_error"]
    assert max(g["worst_error"] for g in gaps) > 0.05  # under a sun
    # Closer exponents are interpolated better, and measuring this does not change the levels themselves.
    run("bake", "studio.hdr", "-o", "two", *SMALL[2:], "--size", "64", "--lobe", "phong", "--exponents", "inf,64,32,16", folder=folder)
    run("bake", "studio.hdr", "-o", "four", *SMALL[2:], "--size", "64", "--lobe", "phong", "--exponents", "inf,64,16", folder=folder)
    two, four = (manifest_of(folder / f)["specular"]["between_levels"] for f in ("two", "four"))
    assert max(g["worst_error"] for g in two) < max(g["worst_error"] for g in four)
    assert max(g["median_error"] for g in two) < max(g["median_error"] for g in four)
    assert "between_levels" not in manifest_of(folder / "out")["irradiance"]
    run("bake", "studio.hdr", "-o", "ggx", *SMALL, folder=folder)
    assert "between_levels" not in manifest_of(folder / "ggx")["specular"]


def test_charlie_states_its_least_roughness(folder):
    run("bake", "studio.hdr", "-o", "out", *SMALL, "--lobe", "charlie", "--levels", "2", folder=folder)
    specular = manifest_of(folder / "out")["specular"]
    least = specular["least_roughness"]
    assert [l["roughness"] for l in specular["levels"]] == [least, 1] and not specular["levels"][0]["environment_itself"]


def test_every_engine_writes_what_it_says(folder):
    files = {
        "generic": {"specular.ktx2", "irradiance.ktx2", "brdf.ktx2"}, "khronos": {"ggx/specular.ktx2"}, "filament": {"studio_ibl.ktx"}, "bevy": {"studio_specular.ktx2"},
        "babylon": {"studio.env"}, "playcanvas": {"studio-env-atlas.png"}, "gltf": {"studio.gltf"}, "unity": {"studio.dds", "studio_latlong.exr"},
        "unreal": {"studio.dds", "studio_latlong.exr"}, "materialx": {"studio.exr", "studio_irradiance.exr"}, "godot": {"studio.exr"},
        "blender": {"studio.exr"}, "mitsuba": {"studio.exr"}, "pbrt": {"studio.exr"}, "usd": {"studio.exr"}}
    for engine, expected in files.items():
        size = [] if engine == "playcanvas" else ["--size", "32"]
        irradiance = [] if engine == "playcanvas" else ["--irradiance-size", "8"]
        run("bake", "studio.hdr", "-o", engine, "--for", engine, *size, *irradiance, "--brdf-size", "8", "--no-preview", folder=folder)
        assert set(files_of(folder / engine)) >= expected | {"manifest.json", "sh.json"}, engine
        manifest = manifest_of(folder / engine)
        assert manifest["engine"]["name"] == engine and manifest["convention"]
        for role in ("specular", "environment"):
            for level in manifest.get(role, {}).get("levels", []):
                assert 0 <= level["roughness"] <= 1 and 0 <= level["clipped_energy"] < 1, (engine, level)
    # RGBD ends at 255, and the sun is brighter; half floats can hold it.
    assert manifest_of(folder / "babylon")["specular"]["levels"][0]["clipped_texels"] > 0
    assert manifest_of(folder / "unity")["specular"]["levels"][0]["clipped_texels"] == 0
    # The program can open its own files.
    for file in ["babylon/studio.env", "gltf/studio.gltf", "unity/studio.dds", "pbrt/studio.exr", "mitsuba/studio.exr", "materialx/studio.exr"]:
        words = {"pbrt": ["--latlong", "pbrt"], "mitsuba": ["--latlong", "mitsuba"], "materialx": ["--latlong", "materialx"]}.get(file.split("/")[0], [])
        info = json.loads(run("info", file, "--json", *words, folder=folder).stdout)
        assert info["kind"] == "environment" or info["faces"] == 6, file
    for file in ("babylon/studio.env", "gltf/studio.gltf", "unity/studio.dds"):
        run("bake", file, "-o", "again", *SMALL, folder=folder)
    assert manifest_of(folder / "playcanvas")["specular"]["encoding"] == "rgbp"
    assert manifest_of(folder / "pbrt")["environment"]["layout"] == "equal-area-octahedral"
    assert "centre +Z, right -X" in manifest_of(folder / "usd")["convention"]


def test_engines_share_a_reading_and_get_folders(folder):
    run("bake", "studio.hdr", "-o", "all", *SMALL, *[w for t in ["generic", "khronos", "filament", "babylon", "bevy", "three", "three-latlong"] for w in ("--for", t)],
        folder=folder)
    files = set(files_of(folder / "all"))
    assert files >= {"khronos/ggx/specular.ktx2", "khronos/charlie/sheen.ktx2", "khronos/lambertian/diffuse.ktx2", "filament/studio_ibl.ktx",
                     "filament/studio_skybox.ktx", "filament/sh.txt", "babylon/studio.env", "bevy/studio_specular.ktx2", "bevy/studio_diffuse.ktx2",
                     "three/studio.pmrem.ktx2", "three-latlong/studio.exr", "generic/specular.ktx2"}, files
    # The same bytes as if each had been baked alone.
    for engine in ["khronos", "bevy", "three", "three-latlong"]:
        run("bake", "studio.hdr", "-o", engine, *SMALL, "--for", engine, folder=folder)
        assert files_of(folder / engine) == files_of(folder / "all" / engine), engine
    assert manifest_of(folder / "khronos")["irradiance"]["quantity"] == "irradiance_over_pi"
    lines = (folder / "all/filament/sh.txt").read_text().splitlines()
    assert len(lines) == 9 and lines[0].endswith("// L00, irradiance, pre-scaled base")


def test_pictures_hold_one_level_a_file(folder):
    for extension in ["exr", "hdr"]:
        run("bake", "studio.hdr", "-o", extension, *SMALL, "--levels", "2", "--format", extension, folder=folder)
        assert {f"specular_0.{extension}", f"specular_1.{extension}", f"irradiance.{extension}"} <= set(files_of(folder / extension))
    run("bake", "studio.hdr", "-o", "six", *SMALL, "--levels", "1", "--format", "exr", "--cube-picture", "faces", folder=folder)
    faces = [f"six/specular_{f}.exr" for f in ["px", "nx", "py", "ny", "pz", "nz"]]
    mean = json.loads(run("info", *faces, "--json", folder=folder).stdout)["mean_radiance"]
    assert all(abs(a - b) <= 2e-3 * b for a, b in zip(mean, manifest_of(folder / "six")["source"]["mean_radiance"]))


def test_latlong_layout(folder):
    run("bake", "studio.hdr", "-o", "out", *SMALL, "--layout", "latlong", folder=folder)
    info = json.loads(run("info", "out/specular.ktx2", "--json", folder=folder).stdout)
    assert info["faces"] == 1 and (info["width"], info["height"]) == (32, 16)


def test_plain_methods_agree_with_the_exact_one(folder):
    run("sky", "-o", "dull.exr", "--exr", "float", "--height", "16", "--no-sun-disc", folder=folder)
    for method in ["exact", "bruteforce", "riemann", "montecarlo"]:
        run("bake", "dull.exr", "-o", method, *SMALL, "--levels", "2", "--method", method, folder=folder)
        mean = manifest_of(folder / method)["source"]["mean_radiance"]
        if method == "exact":
            expected = mean
        assert all(abs(a - b) <= 2e-2 * abs(b) for a, b in zip(mean, expected)), (method, mean, expected)


def test_irradiance_as_e_or_over_pi(folder):
    def texels(name, *more):
        run("bake", "studio.hdr", "-o", name, *SMALL, "--levels", "1", "--encoding", "rgba32f", *more, folder=folder)
        return struct.unpack(f"<{6 * 4 * 4 * 4}f", (folder / name / "irradiance.ktx2").read_bytes()[-6 * 4 * 4 * 16:])

    e, over_pi = texels("e"), texels("over", "--irradiance", "over-pi")
    assert all(abs(a / math.pi - b) < 1e-6 * a for i, (a, b) in enumerate(zip(e, over_pi)) if i % 4 < 3)
    assert texels("again", "--irradiance", "e") == e
    assert manifest_of(folder / "e")["irradiance"]["quantity"] == "irradiance" and "irradiance" not in manifest_of(folder / "e")["options"]
    over = manifest_of(folder / "over")
    assert over["irradiance"]["quantity"] == "irradiance_over_pi" and over["options"]["irradiance"] == "irradiance_over_pi"
    metadata = json.loads(run("info", "over/irradiance.ktx2", "--json", folder=folder).stdout)["metadata"]
    assert metadata["domelight.quantity"] == "irradiance_over_pi"
    # An engine that loads E / pi by default gets E if that is asked for.
    run("bake", "studio.hdr", "-o", "k", *SMALL, "--for", "khronos", "--irradiance", "e", folder=folder)
    assert manifest_of(folder / "k")["irradiance"]["quantity"] == "irradiance"


def test_brdf_alone(folder):
    # The file of a bake, whatever the environment.
    for engine, words in [("generic", []), ("filament", ["--for", "filament"]), ("khronos", ["--for", "khronos"])]:
        run("bake", "studio.hdr", "-o", engine, *SMALL, *words, folder=folder)
        document = json.loads(run("brdf", "-o", f"{engine}.ktx2", "--size", "16", *words, "--json", folder=folder).stdout)
        brdf = manifest_of(folder / engine)["brdf"]
        assert (folder / f"{engine}.ktx2").read_bytes() == (folder / engine / brdf["file"]).read_bytes(), engine
        assert (document["form"], document["masking"], document["axes"]) == (brdf["form"], brdf["masking"], brdf["axes"])
    # 8 bits without a curve: 255 times the value. At normal incidence a mirror reflects F0 = 1 as it is.
    run("brdf", "-o", "a.ktx2", "--size", "32", "--float", "--form", "scale-bias-charlie", folder=folder)
    values = struct.unpack(f"<{32 * 32 * 4}f", (folder / "a.ktx2").read_bytes()[-32 * 32 * 16:])
    run("brdf", "-o", "a.png", "--size", "32", "--form", "scale-bias-charlie", folder=folder)
    width, height, channels, pixels = png_of(folder / "a.png")
    assert (width, height, channels) == (32, 32, 3)
    for i in range(32 * 32):
        for c in range(3):
            assert abs(pixels[3 * i + c] - 255 * min(values[4 * i + c], 1)) <= 0.501, (i, c)
    assert abs(values[4 * 31] + values[4 * 31 + 1] - 1) < 2e-3
    for name in ["a.exr", "a.hdr", "a.dds", "a.ktx"]:
        run("brdf", "-o", name, "--size", "8", folder=folder)
        assert (folder / name).stat().st_size > 100, name
    assert b"brdf scale-bias" in (folder / "a.exr").read_bytes()
    # The courses' sum of samples comes close to it.
    run("brdf", "-o", "m.ktx2", "--size", "32", "--float", "--form", "scale-bias-charlie", "--method", "montecarlo", "--sequence", "sobol", "--samples", "4096", folder=folder)
    other = struct.unpack(f"<{32 * 32 * 4}f", (folder / "m.ktx2").read_bytes()[-32 * 32 * 16:])
    assert 0 < max(abs(a - b) for i, (a, b) in enumerate(zip(values, other)) if i % 4 < 2) < 0.02
    assert json.loads(run("brdf", "-o", "m.ktx2", "--size", "4", "--method", "montecarlo", "--json", folder=folder).stdout)["sequence"] == "hammersley"


def test_montecarlo_takes_every_sequence(folder):
    run("sky", "-o", "dull.exr", "--exr", "float", "--height", "16", "--no-sun-disc", folder=folder)
    words = ["bake", "dull.exr", *SMALL, "--levels", "2", "--encoding", "rgba32f"]

    def texels(name, *more):
        run(*words, "-o", name, *more, folder=folder)
        data = (folder / name / "specular.ktx2").read_bytes()
        return struct.unpack(f"<{6 * 8 * 8 * 4}f", data[-6 * 16 * 16 * 16 - 6 * 8 * 8 * 16:-6 * 16 * 16 * 16])  # KTX2 keeps the smallest level first

    exact = texels("exact", "--texels", "centre")
    found = {}
    for sequence in ["random", "stratified", "hammersley", "halton", "sobol", "r2"]:
        for seed in ["0", "7"]:
            found[sequence, seed] = texels("out", "--method", "montecarlo", "--samples", "1024", "--sequence", sequence, "--seed", seed)
            options = manifest_of(folder / "out")["options"]
            assert (options["samples"], options["sequence"], options["seed"]) == (1024, sequence, int(seed))
            worst = max(abs(a - b) / b for i, (a, b) in enumerate(zip(found[sequence, seed], exact)) if i % 4 < 3)
            assert worst < (0.2 if sequence == "random" else 0.05), (sequence, seed, worst)
    assert len({values for values in found.values()}) == 12
    assert texels("out", "--method", "montecarlo") == found["hammersley", "0"]
    assert "--method montecarlo" in run(*words, "-o", "no", "--sequence", "sobol", folder=folder, code=2).stderr
    assert "--method montecarlo" in run(*words, "-o", "no", "--seed", "1", folder=folder, code=2).stderr
    assert "whole number" in run(*words, "-o", "no", "--method", "montecarlo", "--seed", "-1", folder=folder, code=2).stderr


def test_riemann_sum_of_the_lecture(folder):
    """Constant light of radiance 1: K steps of phi by J of theta give (pi^2 / 2J) / sin(pi / 2J), 3.224 for J = 4, whatever K is."""
    (folder / "half.exr").write_bytes(make_exr(16, 8, {}))  # 0.5 everywhere
    constant = ["bake", "half.exr", *SMALL, "--exposure", "1", "--levels", "1", "--method", "riemann", "--encoding", "rgba32f"]
    for steps, words, expected in [("6x4", ["--riemann-sum", "plain"], 3.2238), ("4x16", ["--riemann-sum", "plain"], 3.1466), ("6x4", [], math.pi)]:
        run(*constant, "-o", "out", "--riemann-steps", steps, *words, folder=folder)
        red = struct.unpack("<f", (folder / "out/irradiance.ktx2").read_bytes()[-16:-12])[0]
        assert abs(red - expected) < 1e-4, (steps, words, red)
        options = manifest_of(folder / "out")["options"]
        assert options["riemann_steps"] == dict(zip(["phi", "theta"], map(int, steps.split("x"))))
        assert options["riemann_sum"] == ("plain" if words else "normalised")


def test_same_bytes_on_any_number_of_threads(folder):
    expected = None
    engines = [w for t in ["generic", "khronos", "filament", "babylon", "bevy", "three", "three-latlong"] for w in ("--for", t)]
    for threads in [1, 2, 3, 8]:
        run("bake", "studio.hdr", "-o", f"t{threads}", *engines, "--size", "32", "--irradiance-size", "8", "--threads", threads, folder=folder)
        files = files_of(folder / f"t{threads}")
        expected = expected or files
        assert files == expected, [name for name in files if files[name] != expected.get(name)]


def test_bytes_do_not_depend_on_where_files_lie(folder):
    (folder / "elsewhere").mkdir()
    shutil.copy(folder / "studio.hdr", folder / "elsewhere/studio.hdr")
    run("bake", "studio.hdr", "-o", "a", *SMALL, folder=folder)
    run("bake", folder / "elsewhere/studio.hdr", "-o", folder / "elsewhere/b", *SMALL, folder="/")
    assert files_of(folder / "a") == files_of(folder / "elsewhere/b")


def test_built_in_sky_where_no_environment_is_named(folder):
    run("bake", "-o", "out", *SMALL, folder=folder)
    source = manifest_of(folder / "out")["source"]
    assert source["file"] == "built-in sky" and re.fullmatch("[0-9a-f]{64}", source["sha256"])
    run("bake", "-o", "turned", *SMALL, "--rotate-y-deg", "90", folder=folder)
    assert files_of(folder / "turned")["specular.ktx2"] != files_of(folder / "out")["specular.ktx2"]


def test_json_is_one_document(folder):
    result = run("bake", "studio.hdr", "-o", "out", *SMALL, "--json", folder=folder)
    document = json.loads(result.stdout)
    bake = document["bakes"][0]
    assert bake["status"] == "baked" and bake["engines"][0]["manifest"] == manifest_of(folder / "out")
    assert {"filter", "encode", "write"} <= {stage["stage"] for stage in bake["stages"]}
    document = json.loads(run("bake", "missing.hdr", "-o", "out2", "--json", folder=folder, code=1).stdout)
    assert document["bakes"][0]["status"] == "failed" and "missing.hdr" in document["bakes"][0]["error"]
    assert json.loads(run("sky", "-o", "s.hdr", "--height", "8", "--json", folder=folder).stdout)["width"] == 16


def test_quiet_says_nothing(folder):
    result = run("bake", "studio.hdr", "-o", "out", *SMALL, "--quiet", folder=folder)
    assert result.stdout == "" and result.stderr == ""


# --- several, and again ---


def test_several_are_skipped_when_up_to_date(folder):
    def statuses(*more, code=0):
        words = ["bake", "studio.hdr", "evening.hdr", "-o", "lights", *SMALL, "--json", *more]
        return [b["status"] for b in json.loads(run(*words, folder=folder, code=code).stdout)["bakes"]]

    assert statuses() == ["baked", "baked"]
    before = files_of(folder / "lights")
    assert set(n.split("/")[0] for n in before) == {"studio", "evening"}
    assert statuses() == ["up to date", "up to date"]
    assert statuses("--force") == ["baked", "baked"] and files_of(folder / "lights") == before
    assert statuses("--levels", "1") == ["baked", "baked"]
    assert statuses() == ["baked", "baked"]
    (folder / "lights/studio/specular.ktx2").unlink()
    assert statuses() == ["baked", "up to date"]
    with open(folder / "lights/evening/brdf.ktx2", "ab") as file:
        file.write(b"x")
    assert statuses() == ["up to date", "baked"]
    shutil.copy(folder / "evening.hdr", folder / "studio.hdr")
    assert statuses() == ["baked", "up to date"]
    (folder / "lights/studio/manifest.json").write_text("[" * 100000)
    assert statuses() == ["baked", "up to date"]
    assert statuses("--no-hashes") == ["baked", "baked"] and statuses("--no-hashes") == ["baked", "baked"]


def test_one_bad_environment_does_not_stop_the_others(folder):
    result = run("bake", "missing.hdr", "studio.hdr", "-o", "lights", *SMALL, folder=folder, code=1)
    assert "missing.hdr" in result.stderr and (folder / "lights/studio/manifest.json").exists() and not (folder / "lights/missing").exists()


def test_equal_names_are_refused(folder):
    (folder / "b").mkdir()
    shutil.copy(folder / "studio.hdr", folder / "b/studio.hdr")
    assert "both go to" in run("bake", "studio.hdr", "b/studio.hdr", "-o", "lights", *SMALL, folder=folder, code=2).stderr


# --- whole or not at all ---


def test_a_full_disk_leaves_the_old_bake(folder):
    run("bake", "studio.hdr", "-o", "out", *SMALL, folder=folder)
    before = files_of(folder / "out")
    limit = 30000  # bytes a file: less than the chain of 32^2

    def small_files():
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    result = run("bake", "evening.hdr", "-o", "out", "--size", "64", "--no-preview", folder=folder, code=1, preexec_fn=small_files)
    assert result.stderr.startswith("error: "), result.stderr
    assert files_of(folder / "out") == before
    run("bake", "evening.hdr", "-o", "new", "--size", "64", "--no-preview", folder=folder, code=1, preexec_fn=small_files)
    assert not (folder / "new").exists()


def test_interruption_leaves_the_old_bake(folder):
    run("bake", "studio.hdr", "-o", "out", *SMALL, folder=folder)
    before = files_of(folder / "out")
    for number in [signal.SIGINT, signal.SIGTERM]:
        for delay in [0.02, 0.1, 0.3]:
            process = launch("bake", "studio.hdr", "-o", "out", "--method", "bruteforce", "--size", "256", folder=folder, stderr=subprocess.DEVNULL)
            time.sleep(delay)
            process.send_signal(number)
            assert process.wait(60) == -number
            assert files_of(folder / "out") == before


def test_a_folder_that_cannot_be_written_is_an_error(folder):
    if os.geteuid() == 0:
        run("bake", "studio.hdr", "-o", "/proc/nowhere", *SMALL, folder=folder, code=1)
        return
    (folder / "closed").mkdir(mode=0o500)
    run("bake", "studio.hdr", "-o", "closed/out", *SMALL, folder=folder, code=1)


def test_stdout_that_is_full_is_an_error(folder):
    with open("/dev/full", "w") as full:
        result = subprocess.run([PROGRAM, "info", "studio.hdr"], cwd=folder, stdout=full, stderr=subprocess.PIPE, text=True)
    assert result.returncode == 1 and "stdout" in result.stderr


# --- info and sky ---


def test_info_of_an_environment(folder):
    run("sky", "--axes", "-o", "axes.exr", "--exr", "float", "--height", "64", folder=folder)
    run("sky", "-o", "sun.exr", "--exr", "float", "--height", "256", "--sun-elevation-deg", "40", "--sun-azimuth-deg", "-70", folder=folder)
    info = json.loads(run("info", "sun.exr", "--json", folder=folder).stdout)
    light = info["lights"][0]
    assert abs(light["elevation_deg"] - 40) < 0.5 and abs(light["azimuth_deg"] + 70) < 0.5 and 0.2 < light["share"] < 1, light
    assert info["range"][1] > 1e5 and info["irradiance"]["+Y"][1] > info["irradiance"]["-Y"][1] > 0
    # Turning the light turns the sun from +X towards +Z; E from above stays.
    turned = json.loads(run("info", "sun.exr", "--rotate-y-deg", "50", "--json", folder=folder).stdout)
    assert abs(turned["lights"][0]["azimuth_deg"] + 20) < 0.5
    assert abs(turned["irradiance"]["+Y"][1] / info["irradiance"]["+Y"][1] - 1) < 1e-3
    brighter = json.loads(run("info", "sun.exr", "--exposure", "1", "--json", folder=folder).stdout)
    assert abs(brighter["mean_radiance"][0] / info["mean_radiance"][0] - 2) < 1e-6
    assert "bad texels       none" in run("info", "axes.exr", folder=folder).stdout


def test_info_of_a_bake_sees_changes(folder):
    run("bake", "studio.hdr", "-o", "out", *SMALL, folder=folder)
    assert "unchanged" in run("info", "out", folder=folder).stdout
    document = json.loads(run("info", "out/manifest.json", "--json", folder=folder).stdout)
    assert document["kind"] == "bake" and all(f["state"] == "unchanged" for f in document["files"])
    with open(folder / "out/brdf.ktx2", "ab") as file:
        file.write(b"x")
    (folder / "out/sh.json").unlink()
    states = {f["file"]: f["state"] for f in json.loads(run("info", "out", "--json", folder=folder, code=1).stdout)["files"]}
    assert states["brdf.ktx2"] == "changed" and states["sh.json"] == "missing"


def test_info_of_other_tools_textures(folder):
    data = os.environ.get("DOMELIGHT_DATA")
    if not data:
        raise Skipped("DOMELIGHT_DATA is not set")
    texture = Path(data) / "reference/symmetrical_garden/symmetrical_garden_ibl.ktx"
    info = json.loads(run("info", texture, "--json", folder=folder).stdout)
    assert info["faces"] == 6 and info["levels"] == 5 and info["width"] == 256 and "sh" in info["metadata"]


# --- sample ---


def csv_of(text):
    lines = text.splitlines()
    assert lines[0] == "u,v,x,y,z,r,g,b,pdf_solid_angle"
    return [[float(v) for v in line.split(",")] for line in lines[1:]]


def test_sample_draws_directions_with_their_density(folder):
    csv = csv_of(run("sample", "studio.hdr", "-n", "500", folder=folder).stdout)
    assert len(csv) == 500
    for u, v, x, y, z, r, g, b, pdf in csv:
        # The default convention: u = 1/2 + atan2(z, x) / 2 pi, v = theta / pi.
        assert abs(x * x + y * y + z * z - 1) < 1e-5 and pdf > 0 and min(r, g, b) >= 0
        assert abs(math.cos(math.pi * v) - y) < 1e-5 and abs((u - 0.5 - math.atan2(z, x) / (2 * math.pi) + 0.5) % 1 - 0.5) < 1e-5
    # The same numbers in a file, in JSON and in a file of JSON; another seed gives others.
    run("sample", "studio.hdr", "-n", "500", "-o", "s.csv", folder=folder)
    assert csv_of((folder / "s.csv").read_text()) == csv
    document = json.loads(run("sample", "studio.hdr", "-n", "500", "--json", folder=folder).stdout)
    run("sample", "studio.hdr", "-n", "500", "-o", "s.json", folder=folder)
    assert document == json.loads((folder / "s.json").read_text())
    assert document["count"] == 500 and document["method"] == "bilinear" and document["seed"] == 1
    assert [[s["u"], s["v"], *s["direction"], *s["radiance"], s["pdf_solid_angle"]] for s in document["samples"]] == csv
    assert csv_of(run("sample", "studio.hdr", "-n", "500", "--seed", "2", folder=folder).stdout) != csv
    # The mean of radiance / density is the sphere's integral, for every method, weight and sequence.
    mean = json.loads(run("info", "studio.hdr", "--json", folder=folder).stdout)["mean_radiance"][1]
    for options in [["--method", m] for m in ["linear", "walk", "binary", "guided", "alias", "hierarchical", "bilinear", "bilinear-plain"]] + \
                   [["--sequence", s] for s in ["random", "stratified", "hammersley", "halton", "r2"]] + \
                   [["--weight", "grayscale"], ["--uniform-share", "0.3"], ["--seed", "0"], ["--rotate-y-deg", "40"]]:
        csv = csv_of(run("sample", "studio.hdr", "-n", "20000", *options, folder=folder).stdout)
        integral = sum(row[6] / row[8] for row in csv) / len(csv)
        assert abs(integral / (4 * math.pi * mean) - 1) < 0.02, (options, integral, 4 * math.pi * mean)
    assert "lower bits" in run("sample", "studio.hdr", "-n", "1", "--method", "alias", "--sequence", "hammersley", folder=folder).stderr
    assert "compensated" in run("sample", "studio.hdr", "-n", "1", "--compensate", folder=folder).stderr


def test_sample_writes_pictures_and_tables(folder):
    result = run("sample", "studio.hdr", "--picture", "a.png", "--heat", "b.png", "--tables", "shader", "--picture-width", "300", folder=folder)
    assert result.stdout.splitlines() == ["a.png", "b.png", "shader/rows.ktx2", "shader/columns.ktx2", "shader/row_averages.ktx2"]
    for name in ["a.png", "b.png"]:
        assert (folder / name).read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    document = json.loads(run("sample", "studio.hdr", "--heat", "c.png", "--heat-measure", "uv", "--tables", "t", "--tables-format", "exr", "--json", folder=folder).stdout)
    assert document["files"] == ["c.png", "t/rows.exr", "t/columns.exr", "t/row_averages.exr"] and document["width"] == 64

    # Reading the tables as a shader does (docs/math/importance.md) gives the samples of the program.
    def table(name, width, height):
        info = json.loads(run("info", name, "--json", folder=folder).stdout)
        assert (info["width"], info["height"], info["levels"]) == (width, height, 1) and "R32G32" in info["format"], info
        assert info["metadata"]["domelight.weight"] == "radiant-power"
        values = struct.unpack(f"<{2 * width * height}f", (folder / name).read_bytes()[-8 * width * height:])
        return values[0::2], values[1::2]

    rows, row_pdf = table("shader/rows.ktx2", 1, 32)
    columns, column_pdf = table("shader/columns.ktx2", 64, 32)
    assert rows[-1] == 1 and all(columns[64 * j + 63] == 1 for j in range(32))
    samples = json.loads(run("sample", "studio.hdr", "-n", "64", "--sequence", "hammersley", "--seed", "0", "--method", "linear", "--json", folder=folder).stdout)["samples"]
    for i, sample in list(enumerate(samples))[1:]:  # the first lies at the pole itself
        x, y = i / 64, int(f"{i:06b}"[::-1], 2) / 64
        j = next(j for j in range(32) if rows[j] > y)
        k = next(k for k in range(64) if columns[64 * j + k] > x)
        v = (j + 1 - (rows[j] - y) * 32 / row_pdf[j]) / 32
        u = (k + 1 - (columns[64 * j + k] - x) * 64 / column_pdf[64 * j + k]) / 64
        assert abs(u - sample["u"]) < 1e-5 and abs(v - sample["v"]) < 1e-5, (u, v, sample)
        assert abs(row_pdf[j] * column_pdf[64 * j + k] / (2 * math.pi**2 * math.sin(math.pi * v)) / sample["pdf_solid_angle"] - 1) < 1e-4


def test_row_averages_draw_as_the_lecture_does(folder):
    """The lecture's loop over running row averages, then along the row of the image itself, has the density of the distribution."""
    width, height = 16, 8
    red = [20 * abs(math.sin(7 * i)) ** 4 for i in range(width * height)]
    red[37] = 900.0
    (folder / "known.exr").write_bytes(make_exr(width, height, dict(enumerate(red))))
    document = json.loads(run("sample", "known.exr", "--tables", "t", "--json", folder=folder).stdout)
    total = document["tables"]["total_average"]

    def table(name, columns, channels):
        info = json.loads(run("info", f"t/{name}.ktx2", "--json", folder=folder).stdout)
        assert (info["width"], info["height"], info["levels"]) == (columns, height, 1), info
        assert abs(float(info["metadata"]["domelight.total_average"]) / total - 1) < 1e-8
        values = struct.unpack(f"<{channels * columns * height}f", (folder / f"t/{name}.ktx2").read_bytes()[-4 * channels * columns * height:])
        return info["format"], values

    name, averages = table("row_averages", 1, 1)
    assert "R32_SFLOAT" in name, name
    light = [[(0.2126 * red[width * j + i] + 0.7874 * 0.5) * math.sin(math.pi * (j + 0.5) / height) for i in range(width)] for j in range(height)]
    for j in range(height):
        assert abs(averages[j] - sum(light[j]) / width) <= 1e-6 * total, j
    assert abs(sum(averages) / height / total - 1) < 1e-6

    def first_beyond(goal, values):
        running = 0
        for i, value in enumerate(values):
            running += value
            if running > goal:
                return i
        return len(values) - 1  # rounding at the very end

    rows, columns = table("rows", 1, 2)[1], table("columns", width, 2)[1]
    found = [[0] * width for _ in range(height)]
    n = 256
    for a in range(n):
        j = first_beyond((a + 0.5) / n * total * height, averages)
        assert j == next(j for j in range(height) if rows[2 * j] > (a + 0.5) / n)
        for b in range(n):
            i = first_beyond((b + 0.5) / n * averages[j] * width, light[j])
            assert i == next(i for i in range(width) if columns[2 * (width * j + i)] > (b + 0.5) / n)
            found[j][i] += 1
            assert b or abs(light[j][i] / total / (rows[2 * j + 1] * columns[2 * (width * j + i) + 1]) - 1) < 1e-5
    # How often a texel is found, compared with its share of the light: with the points of a grid, a strip gets at most one too many or too few.
    for j in range(height):
        row = sum(light[j]) / (total * width * height)
        for i in range(width):
            share = light[j][i] / (total * width * height)
            assert abs(found[j][i] / n**2 - share) <= (row + light[j][i] / sum(light[j])) / n + 1 / n**2, (j, i)
    # The EXR holds the same.
    run("sample", "known.exr", "--tables", "e", "--tables-format", "exr", folder=folder)
    assert b"average_weight" in (folder / "e/row_averages.exr").read_bytes()


def test_sample_explains_what_it_does(folder):
    for method in ["linear", "walk", "binary", "guided", "bilinear", "bilinear-plain"]:
        for point in [(0, 0), (0.25, 0.5), (0.999999, 0.3), (0.5, 0.97), (0.61, 0.13)]:
            words = ["sample", "studio.hdr", "--explain", f"{point[0]},{point[1]}", "--method", method]
            e = json.loads(run(*words, "--json", folder=folder).stdout)["explanation"]
            row, column, sample = e["row"], e["column"], e["sample"]
            assert row["begin"] <= row["xi"] <= row["end"] and column["begin"] <= column["xi"] <= column["end"]
            # The arithmetic of the explanation ends at the sampler's own result; rows of floats have 24 bits, which limits it under the sun.
            assert abs(row["v"] - sample["v"]) < 2e-6 and abs((column["u"] - sample["u"] + 0.5) % 1 - 0.5) < 2e-5, (method, point, e)
            assert point[1] == 0 or abs(e["pdf_solid_angle"] / sample["pdf_solid_angle"] - 1) < 2e-3, (method, point, e)
            assert abs(e["jacobian"] - 2 * math.pi**2 * math.sin(math.pi * row["v"])) < 1e-6
    text = run("sample", "studio.hdr", "--explain", "0.25,0.5", "--method", "guided", "--explain-picture", "e.png", folder=folder).stdout
    assert "<- xi is in here" in text and "2 pi^2 sin(theta)" in text and "guide table" in text and (folder / "e.png").exists()


def test_sample_estimates_agree_and_tell_the_strategies_apart(folder):
    run("sky", "-o", "dull.exr", "--exr", "float", "--height", "16", "--no-sun-disc", folder=folder)
    for surface in [["lambert"], ["phong", "--exponent", "20"], ["ggx", "--roughness", "0.5", "--metal-f0", "1,0.7,0.3"], ["charlie", "--roughness", "0.6"]]:
        for sequence in ["random", "sobol"]:
            document = json.loads(run("sample", "dull.exr", "--estimate", "--brdf", *surface, "--view", "1,1,0", "--normal", "0.2,1,-0.1", "-n", "1024",
                                      "--sequence", sequence, "--json", folder=folder).stdout)["estimate"]
            reference = document["reference"]["radiance"]
            found = {s["strategy"]: s for s in document["strategies"]}
            assert set(found) == {"riemann", "uniform", "cosine", "brdf", "environment", "mis-balance", "mis-power", "mis-balance-compensated", "product"}
            for name, s in found.items():
                for c in range(3):
                    error = abs(s["radiance"][c] - reference[c])
                    assert error < 5 * s["standard_error"][c] + 0.01 * reference[c], (surface, name, s, reference)
                assert s["convergence"][-1]["error"] == s["error"] and s["cpu_seconds"] > 0
                if s["variance"] is not None and sequence == "random":
                    # Measured over 64 runs, against the integral: within 4 standard errors of the RMS of 64 values.
                    assert abs(s["error"] / (s["variance"] / s["samples"]) ** 0.5 - 1) < 0.4, (surface, name, s)
            if sequence == "random":
                assert all(-0.75 < found[n]["slope"] < -0.3 for n in found if n != "riemann"), {n: found[n]["slope"] for n in found}
                assert abs(found["environment"]["efficiency"] - 1) < 1e-9
            else:
                assert found["cosine"]["error"] < 0.01
    few = json.loads(run("sample", "dull.exr", "--estimate", "-n", "64", "--strategy", "product,mis-power", "--json", folder=folder).stdout)["estimate"]
    assert [s["strategy"] for s in few["strategies"]] == ["environment", "mis-power", "product"] and few["gains"]["mis_compensation"] is None
    text = run("sample", "dull.exr", "--estimate", "-n", "64", "--plot", "p.png", folder=folder).stdout
    assert "MIS compensation" in text and "product by resampling" in text and "exact" in text and (folder / "p.png").exists()


def test_sample_of_constant_and_black_environments(folder):
    (folder / "flat.exr").write_bytes(make_exr(8, 4, {}))
    document = json.loads(run("sample", "flat.exr", "--estimate", "-n", "16", "--json", folder=folder).stdout)["estimate"]
    assert all(abs(v - 0.5) < 1e-6 for v in document["reference"]["radiance"])
    assert [s for s in document["strategies"] if s["strategy"] == "cosine"][0]["error"] < 1e-6
    black = make_exr(8, 4, {i: 0.0 for i in range(32)}).replace(struct.pack("<f", 0.5), struct.pack("<f", 0.0))
    (folder / "black.exr").write_bytes(black)
    for row in csv_of(run("sample", "black.exr", "-n", "50", "--heat", "h.png", "-o", "b.csv", folder=folder) and (folder / "b.csv").read_text()):
        assert all(math.isfinite(v) for v in row) and row[5:8] == [0, 0, 0] and row[8] > 0
    assert "no light" in run("sample", "black.exr", "--estimate", folder=folder, code=1).stderr


def test_sample_files_appear_whole_or_not_at_all(folder):
    (folder / "s.csv").write_text("old")

    def small_files():
        resource.setrlimit(resource.RLIMIT_FSIZE, (10000, 10000))

    for words in [["-o", "s.csv", "-n", "5000"], ["--tables", "new"], ["--picture", "new.png"]]:
        result = run("sample", "studio.hdr", *words, folder=folder, code=1, preexec_fn=small_files)
        assert result.stderr.startswith("error: "), result.stderr
    assert (folder / "s.csv").read_text() == "old" and not (folder / "new").exists() and not (folder / "new.png").exists()
    expected = None
    for threads in [1, 3]:
        run("sample", "studio.hdr", "-n", "999", "-o", "s.csv", "--picture", "p.png", "--heat", "h.png", "--tables", "t", "--explain", "0.3,0.4",
            "--explain-picture", "e.png", "--threads", threads, folder=folder)
        files = files_of(folder)
        expected = expected or files
        assert files == expected


def test_sky_formats_and_axes(folder):
    for name in ["a.hdr", "a.exr", "a.png"]:
        run("sky", "-o", name, "--height", "16", folder=folder)
        assert (folder / name).stat().st_size > 100
    run("sky", "--axes", "-o", "axes.png", "--height", "64", folder=folder)
    assert json.loads(run("info", "axes.png", "--json", folder=folder).stdout)["width"] == 128


def test_names_from_files_do_not_write_on_the_terminal(folder):
    """Escape sequences, line ends and marks of direction in a file reach neither stdout nor stderr raw; JSON holds them all the same."""
    evil = "\x1b]0;owned\x07\x1b[31mred\r\nerror: \x9b\u202egood é"
    shown = "\\x1b]0;owned\\x07\\x1b[31mred\\r\\nerror: \\u009b\\u202egood é"
    raw = re.compile("[\x00-\x09\x0b-\x1f\x7f-\x9f\u202e]")

    def said(*words, code=0):
        result = run(*words, folder=folder, code=code)
        assert not raw.search(result.stdout + result.stderr), ascii(result.stdout + result.stderr)
        return result

    triangle = base64.b64encode(struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)).decode()
    scene = {"asset": {"version": "2.0"}, "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64," + triangle}],
             "bufferViews": [{"buffer": 0, "byteLength": 36}], "extensionsUsed": [evil],
             "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
             "meshes": [{"name": evil, "primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0, "name": evil}, {"camera": 0, "translation": [0.3, 0.3, 2]}],
             "cameras": [{"type": "perspective", "name": evil, "perspective": {"yfov": 1, "znear": 0.1}}]}
    (folder / "a.gltf").write_text(json.dumps(scene))
    small = ["--width", "8", "--height", "8", "--spp", "1"]
    assert f"warning: a.gltf: {shown} is not supported" in said("render", "a.gltf", "-o", "a.exr", *small).stderr
    assert shown in said("render", "a.gltf", "-o", "a.png", "--camera", "none", *small, code=2).stderr
    warned = json.loads(said("render", "a.gltf", "-o", "a.png", "--json", "--quiet", *small).stdout)["warnings"]
    assert any(shown in w for w in warned), warned
    run("render", "a.gltf", "-o", "b.exr", "--seed", "2", *small, folder=folder)
    names = [o["name"] for o in json.loads(said("compare", "a.exr", "b.exr", "--json").stdout)["objects"]]
    assert shown in names, names
    scene["asset"]["version"] = evil
    (folder / "a.gltf").write_text(json.dumps(scene))
    assert 'asset.version: is "\\x1b]0;' in said("render", "a.gltf", "-o", "a.png", *small, code=1).stderr

    run("bake", "-o", "out", "--size", "16", "--levels", "2", folder=folder)
    manifest = manifest_of(folder / "out")
    manifest["source"]["file"] = evil
    (folder / "out/manifest.json").write_text(json.dumps(manifest))
    assert f" from {shown} (" in said("info", "out").stdout
    assert json.loads(said("info", "out", "--json").stdout)["manifest"]["source"]["file"] == evil
    assert shown in said("info", evil.replace("/", ""), code=1).stderr
    assert 'unknown command \\x1b[2J' in said("\x1b[2J", code=2).stderr


def test_exr_channels_hold_the_sun(folder):
    """Half floats end at 65504: where they would clip, 32-bit floats are written, and a line says so."""
    brightest = lambda name: json.loads(run("info", name, "--json", folder=folder).stdout)["range"][1]
    for words in [["sky", "-o", "a.exr", "--height", "64"], ["convert", "a.exr", "-o", "b.exr", "--size", "64"]]:
        said = run(*words, folder=folder)
        assert "32-bit float channels: halves would clip at 65504" in said.stdout and not said.stderr, said
    assert brightest("a.exr") > 2e5 and brightest("b.exr") == brightest("a.exr")
    assert converted(folder, "a.exr", "-o", "b.exr")["encoding"] == "float"
    assert "rgba32f (halves would clip at 65504)" in run("bake", "a.exr", "-o", "out", "--for", "blender", "--size", "64", folder=folder).stdout
    assert brightest("out/a.exr") > 65504 and manifest_of(folder / "out")["environment"]["encoding"] == "rgba32f"

    said = run("convert", "a.exr", "-o", "b.exr", "--encoding", "half", folder=folder)
    assert "warning: b.exr: half clips" in said.stderr and "clips" not in said.stdout, said
    assert "half floats clip" in run("convert", "a.exr", "-o", "p.exr", "--picture", "--encoding", "half", folder=folder).stderr
    assert not run("convert", "a.exr", "-o", "p.exr", "--picture", folder=folder).stderr and brightest("p.exr") == brightest("a.exr")
    assert "half floats clip the sun" in run("sky", "-o", "c.exr", "--exr", "half", "--height", "64", folder=folder).stderr
    assert brightest("b.exr") == brightest("c.exr") == 65504
    assert "float" not in run("sky", "-o", "c.exr", "--no-sun-disc", "--height", "64", folder=folder).stdout
    assert converted(folder, "c.exr", "-o", "b.exr")["encoding"] == "half"


def converted(folder, *words):
    return json.loads(run("convert", *words, "--json", folder=folder).stdout)


def test_no_command_destroys_what_it_reads(folder):
    for name in ["photo.hdr", "kept.hdr"]:
        shutil.copy(folder / "studio.hdr", folder / name)
    kept = (folder / "photo.hdr").read_bytes()
    for words in [["photo.hdr"], ["photo.hdr", "--to", "cube"]]:
        said = run("convert", *words, folder=folder, code=2).stderr
        assert "--output: is missing" in said and "domelight convert photo.hdr -o OUT" in said
    # An output by its place is a new file: six faces without -o would lose the last one.
    assert "exists already" in run("convert", "kept.hdr", "photo.hdr", folder=folder, code=2).stderr
    run("convert", "kept.hdr", "new.hdr", folder=folder)
    assert (folder / "photo.hdr").read_bytes() == kept
    # Nor do names that are made up for outputs replace what is read.
    run("lights", "photo.hdr", "-o", "lights", folder=folder)
    remainder = (folder / "lights/remainder.hdr").read_bytes()
    assert "remainder.hdr: is read here" in run("lights", "lights/remainder.hdr", "-o", "lights", folder=folder, code=1).stderr
    (folder / "link.hdr").symlink_to("lights/remainder.hdr")
    assert "is read here" in run("lights", "link.hdr", "-o", "lights", folder=folder, code=1).stderr
    assert (folder / "lights/remainder.hdr").read_bytes() == remainder
    run("convert", "photo.hdr", "-o", "c.hdr", "--to", "cube", "--layout", "faces", "--size", "8", folder=folder)
    faces = [f"c_{face}.hdr" for face in ["px", "nx", "py", "ny", "pz", "nz"]]
    before = [(folder / face).read_bytes() for face in faces]
    said = run("convert", *faces, "-o", "c.hdr", "--to", "cube", "--layout", "faces", folder=folder, code=1).stderr
    assert "c_px.hdr: is read here" in said and before == [(folder / face).read_bytes() for face in faces]
    run("bake", "photo.hdr", "-o", "b", "--layout", "latlong", "--format", "exr", "--size", "16", "--no-preview", folder=folder)
    level = next((folder / "b").glob("*_0.exr"))
    again = run("bake", level, "-o", "b", "--layout", "latlong", "--format", "exr", "--size", "16", "--no-preview", folder=folder, code=1)
    assert "is read here" in again.stderr
    # Told so, it does.
    run("convert", "photo.hdr", "-o", "photo.hdr", "--exposure", "1", folder=folder)
    assert (folder / "photo.hdr").read_bytes() != kept


def test_options_that_do_nothing_are_refused(folder):
    for words, what in [
        (["convert", "studio.hdr", "-o", "x.hdr", "--tonemap", "agx"], "--tonemap: is of a .png or .jpg"),
        (["sky", "-o", "x.exr", "--ev", "1"], "--ev: is of a .png or .jpg"),
        (["bake", "studio.hdr", "-o", "out.ktx2"], "Name a folder: --output out."),
        (["lights", "studio.hdr", "-o", "sun.json"], "Name a folder: --output sun."),
        (["render", "ball", "-o", "x.png", "--width", "99999999"], "99999999 is not from 1 to 16384"),
    ]:
        said = run(*words, folder=folder, code=2).stderr
        assert what in said, said
    run("lights", "studio.hdr", "-o", "suns", folder=folder)
    assert "holds the lights of an environment" in run("info", "suns", folder=folder, code=1).stderr
    run("bake", "studio.hdr", "-o", "baked", "--size", "16", "--no-preview", folder=folder)
    assert "It holds a bake" in run("convert", "baked", "-o", "x.hdr", folder=folder, code=1).stderr


def test_convert_reports_power_and_files(folder):
    faces = converted(folder, "studio.hdr", "-o", "cube.exr", "--to", "cube", "--layout", "faces", "--size", "24")
    assert faces["files"] == [f"cube_{f}.exr" for f in ["px", "nx", "py", "ny", "pz", "nz"]] and faces["method"] == "exact"
    assert all((folder / name).is_file() for name in faces["files"])
    assert abs(faces["power"]["relative_change"]) < 5e-3  # the sun is one texel of a row of 64
    back = converted(folder, *faces["files"], "back.exr", "--size", "32", "--encoding", "float")
    assert back["source"]["projection"] == "cube" and back["method"] == "conservative"
    assert all(abs(a / b - 1) < 1e-2 for a, b in zip(back["power"]["after"], faces["power"]["before"]))
    assert "radiant power" in run("convert", "studio.hdr", "-o", "x.hdr", "--to", "angular", folder=folder).stdout
    assert run("convert", "studio.hdr", "-o", "x.hdr", "--to", "octahedral", "--quiet", folder=folder).stdout == ""


def write_exr_layers(file, width, height, channels):
    """An uncompressed OpenEXR file of 32-bit floats: channels {name: value of every pixel}."""
    names = sorted(channels)
    chlist = b"".join(n.encode() + b"\0" + struct.pack("<iiii", 2, 0, 1, 1) for n in names) + b"\0"
    window = struct.pack("<iiii", 0, 0, width - 1, height - 1)
    attributes = [("channels", "chlist", chlist), ("compression", "compression", b"\0"), ("dataWindow", "box2i", window), ("displayWindow", "box2i", window),
                  ("lineOrder", "lineOrder", b"\0"), ("pixelAspectRatio", "float", struct.pack("<f", 1)), ("screenWindowCenter", "v2f", struct.pack("<ff", 0, 0)),
                  ("screenWindowWidth", "float", struct.pack("<f", 1))]
    head = struct.pack("<II", 20000630, 2) + b"".join(n.encode() + b"\0" + t.encode() + b"\0" + struct.pack("<i", len(v)) + v for n, t, v in attributes) + b"\0"
    row = b"".join(struct.pack(f"<{width}f", *[channels[n]] * width) for n in names)
    first = len(head) + 8 * height
    offsets = b"".join(struct.pack("<Q", first + y * (8 + len(row))) for y in range(height))
    file.write_bytes(head + offsets + b"".join(struct.pack("<ii", y, len(row)) + row for y in range(height)))


def test_every_command_reads_the_layer_that_is_the_picture_or_the_one_named(folder):
    layers = {f"View Layer.{layer}.{c}": value for layer, value in [("AO", 0.25), ("Combined", 2.0)] for c in "RGB"}
    write_exr_layers(folder / "r.exr", 16, 8, {**layers, "View Layer.Depth.Z": 9.0})
    for words, layer, value in [([], "View Layer.Combined", 2.0), (["--layer", "ao"], "View Layer.AO", 0.25)]:
        said = json.loads(run("info", "r.exr", *words, "--projection", "latlong", "--json", folder=folder).stdout)
        assert said["layer"] == layer and abs(said["range"][1] - value) < 1e-6, said
        run("bake", "r.exr", *words, "-o", "b", *SMALL, folder=folder)
        source = manifest_of(folder / "b")["source"]
        assert source["layer"] == layer and abs(source["mean_radiance"][0] - value) < 1e-4, source
        sample = json.loads(run("sample", "r.exr", *words, "-n", "1", "--json", folder=folder).stdout)["samples"][0]
        assert abs(sample["radiance"][0] - value) < 1e-6, sample
        assert converted(folder, "r.exr", *words, "-o", "l.hdr", "--size", "4")["source"]["layer"] == layer
        assert converted(folder, "r.exr", *words, "-o", "p.exr")["source"]["layer"] == layer
        assert abs(json.loads(run("info", "p.exr", "--json", folder=folder).stdout)["range"][1] - value) < 1e-6
        run("lights", "r.exr", *words, "-o", "l", "--no-preview", folder=folder)
        run("render", "spheres", "--env", "r.exr", *words, "-o", "s.exr", "--width", "8", "--height", "8", "--spp", "1", "--quiet", folder=folder)
        assert abs(json.loads(run("compare", "r.exr", "r.exr", *words, "--json", folder=folder).stdout)["errors"]["rmse"]) == 0
    assert "is read" not in run("info", "r.exr", "--layer", "AO", folder=folder).stderr
    assert "the layer View Layer.Combined is read" in run("info", "r.exr", folder=folder).stderr
    write_exr_layers(folder / "u.exr", 16, 8, {f"{layer}.{c}": 1.0 for layer in ["sky", "sun"] for c in "RGB"})
    for words in [["info"], ["bake", "-o", "x"], ["sample", "-n", "1"], ["convert", "-o", "x.ktx2"], ["lights", "-o", "x"]]:
        error = run(*words, "u.exr", folder=folder, code=1).stderr
        assert "u.exr" in error and "sky, sun" in error and "--layer" in error, error
    assert "--layer" in run("info", "studio.hdr", "--layer", "sky", folder=folder, code=1).stderr


def test_lat_long_of_another_shape_is_read_where_one_says_so(folder):
    for width, height in [(66, 32), (128, 32), (20, 20)]:
        write_exr_layers(folder / "s.exr", width, height, {"R": 0.5, "G": 0.5, "B": 0.5})
        refused = run("bake", "s.exr", "-o", "b", *SMALL, folder=folder, code=1).stderr
        assert "twice as wide as high" in refused and "cube-cross" not in refused and "--projection" in refused, refused
        for words in [["info"], ["sample", "-n", "2", "--quiet"], ["convert", "-o", "l.exr", "--size", "16"], ["convert", "-o", "c.ktx2", "--size", "8"],
                      ["lights", "-o", "l", "--no-preview"], ["bake", "-o", "b", *SMALL]]:
            said = run(*words, "s.exr", "--projection", "latlong", folder=folder)
            assert "not twice as wide as high" in said.stderr or "--quiet" in words, said.stderr
        assert abs(manifest_of(folder / "b")["source"]["mean_radiance"][1] - 0.5) < 1e-6
        power = converted(folder, "s.exr", "--projection", "latlong", "-o", "l.exr", "--size", "16")["power"]
        assert abs(power["after"][0] / (2 * math.pi) - 1) < 1e-3 and abs(power["relative_change"]) < 1e-4, power


def test_faces_of_a_cube_by_any_names_in_any_order(folder):
    run("convert", "studio.hdr", "-o", "px.exr", "--to", "cube", "--layout", "faces", "--size", "16", "--encoding", "float", folder=folder)
    source = [f"px_{f}.exr" for f in ["px", "nx", "py", "ny", "pz", "nz"]]
    expected = None
    for names in [["rt", "lf", "up", "dn", "ft", "bk"], ["l", "r", "u", "d", "f", "b"], ["0", "1", "2", "3", "4", "5"], ["+X", "-X", "+Y", "-Y", "+Z", "-Z"]]:
        wanted = dict(zip(["r", "l", "u", "d", "f", "b"] if "l" in names else names, source))
        for name, file in wanted.items():
            shutil.copy(folder / file, folder / f"sky_{name}.exr")
        files = [f"sky_{name}.exr" for name in sorted(wanted)]
        for words in [["info"], ["sample", "-n", "1", "--quiet"], ["convert", "-o", "l.exr", "--size", "16"], ["lights", "-o", "l", "--no-preview"],
                      ["bake", "-o", "b", *SMALL]]:
            said = run(*words, *files, folder=folder)
            assert ("say no convention" in said.stderr) == (names[0] != "+X" and "--quiet" not in words), said.stderr
        expected = expected or manifest_of(folder / "b")["specular"]["sha256"]
        assert manifest_of(folder / "b")["specular"]["sha256"] == expected, names
        asked = run("info", *files, "--face-orientation", "opengl", folder=folder)
        assert not asked.stderr, asked.stderr
        for file in files:
            (folder / file).unlink()
    # Names that say nothing, in an order that the user says.
    order = [3, 0, 5, 1, 2, 4]
    files = [f"image{chr(97 + i)}.exr" for i in range(6)]
    for file, f in zip(files, order):
        shutil.copy(folder / source[f], folder / file)
    assert "--faces" in run("info", *files, folder=folder, code=2).stderr
    run("bake", *files, "-o", "b", *SMALL, "--faces", "dn,rt,bk,lf,up,ft", folder=folder)
    manifest = manifest_of(folder / "b")
    assert manifest["specular"]["sha256"] == expected and manifest["options"]["environment"]["faces"] == "dn,rt,bk,lf,up,ft", manifest["options"]
    mirrored = run("bake", *files, "-o", "b", *SMALL, "--faces", "dn,rt,bk,lf,up,ft", "--face-orientation", "directx", folder=folder)
    assert manifest_of(folder / "b")["specular"]["sha256"] != expected, mirrored


def test_endings_mean_the_same_in_any_case(folder):
    """An output's format, and what is made of it, follow from its ending whether that is written in small letters or capitals."""
    for ending in [".ktx2", ".ktx", ".dds", ".hdr", ".exr", ".png", ".jpg"]:
        small = converted(folder, "studio.hdr", "-o", f"out{ending}", "--size", "16")
        large = converted(folder, "studio.hdr", "-o", f"OUT{ending.upper()}", "--size", "16")
        assert small["projection"] == large["projection"], (ending, small["projection"], large["projection"])
        assert (folder / f"out{ending}").read_bytes() == (folder / f"OUT{ending.upper()}").read_bytes(), ending
        described = [json.loads(run("info", name, "--json", folder=folder).stdout)["kind"] for name in [f"out{ending}", f"OUT{ending.upper()}"]]
        assert described[0] == described[1], (ending, described)
    for ending in [".ktx2", ".exr", ".png"]:
        run("brdf", "-o", f"brdf{ending}", "--size", "16", folder=folder)
        run("brdf", "-o", f"BRDF{ending.upper()}", "--size", "16", folder=folder)
        assert (folder / f"brdf{ending}").read_bytes() == (folder / f"BRDF{ending.upper()}").read_bytes(), ending
    for ending in [".json", ".csv"]:
        run("sample", "studio.hdr", "-n", "4", "-o", f"s{ending}", folder=folder)
        run("sample", "studio.hdr", "-n", "4", "-o", f"S{ending.upper()}", folder=folder)
        assert (folder / f"s{ending}").read_bytes() == (folder / f"S{ending.upper()}").read_bytes(), ending


def test_convert_every_projection_there_and_back(folder):
    before = None
    for name in ["latlong/usd", "latlong/materialx", "latlong/mitsuba", "latlong/openexr", "sphere-map", "mirror-ball/fov=30", "angular",
                 "dual-paraboloid", "octahedral", "equal-area-octahedral"]:
        there = converted(folder, "evening.hdr", "-o", "there.exr", "--to", name, "--size", "64", "--encoding", "float")
        words = ["--latlong", name.split("/")[1]] if name.startswith("latlong") else ["--projection", name]
        info = json.loads(run("info", "there.exr", *words, "--json", folder=folder).stdout)
        assert info["projection"] == name.split("/")[0], info
        mean = info["mean_radiance"]
        before = before or mean
        # A mirror ball hides a cone behind it, and 64 texels resolve the sun only coarsely.
        tolerance = 0.25 if "ball" in name else 0.05
        assert all(abs(a / b - 1) < tolerance for a, b in zip(mean, before)), (name, mean, before)
    for name, share in [("hemisphere", 50), ("paraboloid", 50), ("paraboloid-opposite", 50)]:
        result = run("convert", "evening.hdr", "-o", "half.hdr", "--to", name, "--size", "32", folder=folder)
        assert f"shows {share} % of all directions" in result.stderr
        again = run("convert", "half.hdr", "-o", "again.hdr", "--from", name, folder=folder)
        assert "the rest is black" in again.stderr
    halves = converted(folder, "evening.hdr", "-o", "dp.hdr", "--to", "dual-paraboloid", "--layout", "files", "--size", "32")
    assert halves["files"] == ["dp_front.hdr", "dp_back.hdr"]
    again = converted(folder, "dp_front.hdr", "dp_back.hdr", "-o", "again.hdr", "--from", "dual-paraboloid")
    assert abs(again["power"]["relative_change"]) < 1e-2


def test_convert_reads_every_projection_by_the_name_that_wrote_it(folder):
    """The names of projections are those of docs/projections.md."""
    table = re.findall(r"^\| (`[^|]*) \|", (ROOT / "docs/projections.md").read_text(), re.MULTILINE)
    names = [name.replace("=F", "=30") for cell in table for name in re.findall("`([^`]*)`", cell)]
    assert "cube" in names and len(names) == 12, names
    for name in [*names, "latlong/usd", "cube/openexr", "cube/centre=+Z,right=-X"]:
        converted(folder, "evening.hdr", "-o", "there.exr", "--to", name, "--size", "32")
        back = converted(folder, "there.exr", "-o", "back.exr", "--from", name, "--to", "latlong")
        assert back["source"]["projection"] == {"pbrt": "equal-area-octahedral"}.get(name, name.split("/")[0]), (name, back)
    converted(folder, "evening.hdr", "-o", "face.exr", "--to", "cube", "--layout", "faces", "--size", "16")
    converted(folder, *[f"face_{f}.exr" for f in ["px", "nx", "py", "ny", "pz", "nz"]], "-o", "back.exr", "--from", "cube")
    converted(folder, "evening.hdr", "-o", "cube.ktx2", "--size", "16")
    converted(folder, "cube.ktx2", "-o", "back.exr", "--from", "cube")
    assert "a cube must be a cross" in run("convert", "evening.hdr", "-o", "x.hdr", "--from", "cube", folder=folder, code=1).stderr


def test_cube_faces_are_known_by_every_name(folder):
    """In the order of the command line or in a folder, the bytes of a bake are the same."""
    converted(folder, "evening.hdr", "-o", "face.exr", "--to", "cube", "--layout", "faces", "--size", "16")
    ours = [f"face_{f}.exr" for f in ["px", "nx", "py", "ny", "pz", "nz"]]
    run("bake", *ours, "-o", "ours", *SMALL, folder=folder)
    for number, names in enumerate([["sky_px", "sky_mx", "sky_py", "sky_my", "sky_pz", "sky_mz"],
                                    ["f_+X", "f_-X", "f_+Y", "f_-Y", "f_+Z", "f_-Z"],
                                    ["px_sky", "nx_sky", "py_sky", "ny_sky", "pz_sky", "nz_sky"],
                                    ["sky_right", "sky_left", "sky_up", "sky_down", "sky_front", "sky_back"]]):
        faces = folder / f"faces{number}"
        faces.mkdir()
        for name, own in zip(names, ours):
            shutil.copy(folder / own, faces / f"{name}.exr")
        run("bake", faces.name, "-o", f"a{number}", *SMALL, folder=folder)
        run("bake", *[f"{faces.name}/{name}.exr" for name in reversed(names)], "-o", f"b{number}", *SMALL, folder=folder)
        for other in [f"a{number}", f"b{number}"]:
            assert files_of(folder / other)["specular.ktx2"] == files_of(folder / "ours")["specular.ktx2"], names
            assert manifest_of(folder / other)["source"]["sha256"] == manifest_of(folder / "ours")["source"]["sha256"], names
    (folder / "empty").mkdir()
    assert "0 files named as faces" in run("info", "empty", folder=folder, code=1).stderr


def test_a_mirror_ball_goes_through_every_command(folder):
    run("sky", "--axes", "--height", "64", "-o", "axes.hdr", folder=folder)
    run("convert", "axes.hdr", "-o", "ball.hdr", "--to", "sphere-map", "--size", "96", folder=folder)
    run("bake", "ball.hdr", "-o", "out", "--projection", "sphere-map", *SMALL, folder=folder)
    assert manifest_of(folder / "out")["source"]["projection"] == "sphere-map"
    run("sample", "ball.hdr", "-n", "10", "--projection", "sphere-map", folder=folder)
    refused = run("bake", "ball.hdr", "-o", "none", folder=folder, code=1).stderr
    assert "--projection sphere-map" in refused
    assert "--projection sphere-map" in run("info", "ball.hdr", folder=folder).stdout
    assert "must be square" in run("info", "axes.hdr", "--projection", "angular", folder=folder, code=1).stderr


def test_convert_textures_envmap_and_threads(folder):
    run("convert", "studio.hdr", "-o", "cube.ktx2", "--size", "16", "--encoding", "rgb9e5", folder=folder)
    run("convert", "cube.ktx2", "-o", "cross.hdr", "--to", "cube", "--mirror", "x", folder=folder)
    for ending in ["ktx", "dds"]:
        run("convert", "cube.ktx2", "-o", f"again.{ending}", folder=folder)
    run("convert", "studio.hdr", "-o", "env.exr", "--to", "cube/openexr", "--size", "16", folder=folder)
    assert json.loads(run("info", "env.exr", "--json", folder=folder).stdout)["projection"] == "cube"
    for words in [["--to", "cube"], ["--to", "angular"], ["--rotate", "1,2,3,40"]]:
        outputs = []
        for threads in ["1", "3"]:
            run("convert", "studio.hdr", "-o", "t.hdr", *words, "--threads", threads, folder=folder)
            outputs.append((folder / "t.hdr").read_bytes())
        assert outputs[0] == outputs[1], words
    # Twice a quarter turn is half a turn, and four of them are none.
    run("convert", "studio.hdr", "-o", "half.hdr", "--rotate-y-deg", "180", folder=folder)
    run("convert", "studio.hdr", "-o", "quarters.hdr", "--rotate", "0,1,0,90", "--rotate", "0,2,0,90", folder=folder)
    assert (folder / "half.hdr").read_bytes() == (folder / "quarters.hdr").read_bytes()


def test_bad_texels_are_reported(folder):
    # Radiance files cannot hold these values, so an uncompressed float EXR is written here.
    (folder / "bad.exr").write_bytes(make_exr(8, 4, {5: float("nan"), 9: float("inf"), 11: -3.0}))
    info = json.loads(run("info", "bad.exr", "--json", folder=folder).stdout)
    added = info["repaired"].pop("light_added")
    assert len(added) == 3
    assert info["repaired"] == {"not_a_number": 1, "infinite": 1, "negative": 1, "most_negative": -3.0}
    result = run("bake", "bad.exr", "-o", "out", *SMALL, folder=folder)
    assert "repaired" in result.stderr
    assert manifest_of(folder / "out")["source"]["repaired"]["negative"] == 1


# --- lights ---


def lights_of(folder):
    return json.loads((Path(folder) / "lights.json").read_text())


def near(a, b, tolerance):
    return all(abs(x - y) <= tolerance for x, y in zip(a, b))


def test_lights_writes_lights_and_remainder_that_add_up(folder):
    run("sky", "-o", "sky.exr", "--exr", "float", "--height", "256", "--sun-elevation-deg", "30", "--sun-azimuth-deg", "30", folder=folder)
    said = json.loads(run("lights", "sky.exr", "-o", "out", "--json", folder=folder).stdout)
    found = lights_of(folder / "out")
    assert said == found
    files = files_of(folder / "out")
    assert set(files) == {"lights.json", "lights.gltf", "remainder.exr", "preview.png"}
    assert found["remainder"]["sha256"] == files["remainder.exr"] and found["source"]["sha256"] == hashlib.sha256((folder / "sky.exr").read_bytes()).hexdigest()
    sun, = found["lights"]
    assert abs(sun["azimuth_deg"] - 30) < 0.15 and abs(sun["elevation_deg"] - 30) < 0.15 and sun["share"] > 0.4  # texels of 0.7 degrees
    # info reads the remainder independently: the mean radiance of its bilinear reconstruction, times 4 pi, is the power.
    before = json.loads(run("info", "sky.exr", "--json", folder=folder).stdout)["mean_radiance"]
    after = json.loads(run("info", "out/remainder.exr", "--json", folder=folder).stdout)
    assert all(light["share"] < 0.1 for light in after["lights"]), "what is left is the glow around"
    for c in range(3):
        power = 4 * 3.14159265358979 * before[c]
        assert abs(4 * 3.14159265358979 * after["mean_radiance"][c] + sun["irradiance"][c] - power) < 1e-3 * power
        parts = found["power"]["lights"][c] + found["power"]["remainder"][c]
        assert abs(parts - found["power"]["original"][c]) <= 1e-5 * found["power"]["original"][c]
    again = run("lights", "out/remainder.exr", "-o", "again", folder=folder)
    assert "no light stands out" in again.stdout


def test_lights_gltf_points_from_the_sun(folder):
    run("sky", "-o", "sky.exr", "--exr", "float", "--height", "128", "--sun-azimuth-deg", "-70", folder=folder)
    run("lights", "sky.exr", "-o", "out", "--lux-per-unit", "179", folder=folder)
    sun, = lights_of(folder / "out")["lights"]
    gltf = json.loads((folder / "out/lights.gltf").read_text())
    light, = gltf["extensions"]["KHR_lights_punctual"]["lights"]
    node, = gltf["nodes"]
    x, y, z, w = node["rotation"]
    travels = [-2 * (x * z + w * y), -2 * (y * z - w * x), -(1 - 2 * (x * x + y * y))]  # the rotation's third column, negated
    assert near(travels, [-c for c in sun["direction"]], 1e-6)
    assert light["type"] == "directional" and max(light["color"]) == 1
    assert all(abs(light["intensity"] * light["color"][c] - 179 * sun["irradiance"][c]) < 1e-4 * light["intensity"] for c in range(3))
    assert gltf["asset"]["extras"]["lux_per_unit"] == 179


def test_lights_directions_are_the_worlds(folder):
    run("sky", "-o", "sky.exr", "--exr", "float", "--height", "128", "--sun-azimuth-deg", "30", "--sun-elevation-deg", "40", folder=folder)
    plain, = json.loads(run("lights", "sky.exr", "-o", "plain", "--no-preview", "--json", folder=folder).stdout)["lights"]
    turned, = json.loads(run("lights", "sky.exr", "-o", "turned", "--no-preview", "--rotate-y-deg", "90", "--json", folder=folder).stdout)["lights"]
    x, y, z = plain["direction"]
    assert near(turned["direction"], [-z, y, x], 1e-9)
    usd, = json.loads(run("lights", "sky.exr", "-o", "usd", "--no-preview", "--latlong", "usd", "--json", folder=folder).stdout)["lights"]
    assert near(usd["direction"], [-z, y, x], 1e-9)  # centre +Z, right -X: what the default shows at +X and +Z
    brighter, = json.loads(run("lights", "sky.exr", "-o", "brighter", "--no-preview", "--exposure", "1", "--json", folder=folder).stdout)["lights"]
    assert near([2 * c for c in plain["irradiance"]], brighter["irradiance"], 1e-6 * max(brighter["irradiance"]))
    # The remainder has the form of the source, and no texel away from the light changes.
    files = [files_of(folder / name)["remainder.exr"] for name in ("plain", "turned", "usd")]
    assert files[0] == files[1] == files[2]


def test_lights_takes_a_cube_and_is_the_same_on_any_number_of_threads(folder):
    run("bake", "studio.hdr", "-o", "cube", "--size", "64", "--levels", "1", "--irradiance-size", "4", "--brdf-size", "16", "--no-preview",
        "--encoding", "rgba32f", folder=folder)
    found = json.loads(run("lights", "cube/specular.ktx2", "-o", "out", "--threads", "1", "--json", folder=folder).stdout)
    assert (found["remainder"]["width"], found["remainder"]["height"]) == (256, 128) and found["source"]["projection"] == "cube"
    run("lights", "cube/specular.ktx2", "-o", "more", "--threads", "5", folder=folder)
    assert files_of(folder / "out") == files_of(folder / "more")


def matte_light(scene, *words, folder):
    """The radiance of a matte square about the origin, seen from above, without light reflected by other surfaces."""
    view = ["--width", "32", "--height", "16", "--spp", "256", "--bounces", "0", "--camera-position", "0,1,0.001", "--fov-deg", "1"]
    run("render", scene, "-o", "matte.exr", *view, *words, "--quiet", folder=folder)
    return json.loads(run("info", "matte.exr", "--projection", "latlong", "--json", folder=folder).stdout)["mean_radiance"]


def same_light(a, b, tolerance=0.01):
    """1 %: what docs/lights.md states of lights and remainder, and far above the noise of 131072 samples."""
    assert all(abs(x - y) <= tolerance * max(x, y) for x, y in zip(a, b)), (a, b)


def test_render_of_remainder_and_lights_is_that_of_the_environment(folder):
    # Matte squares that look up, and up at a slant: their light is 0.8 E / pi.
    for name, tilt in [("up", 0), ("slanted", math.radians(50))]:
        (folder / f"{name}.gltf").write_text(json.dumps(make_square(tilt)))
    run("sky", "-o", "sky.exr", "--exr", "float", "--height", "256", "--sun-elevation-deg", "40", "--sun-azimuth-deg", "30", folder=folder)
    run("lights", "sky.exr", "-o", "out", "--no-preview", folder=folder)

    def light_of(scene, *words):
        return matte_light(scene, *words, folder=folder)

    same, lights = same_light, ["--lights", "out/lights.gltf"]
    for scene in ["up.gltf", "slanted.gltf"]:
        whole = light_of(scene, "--env", "sky.exr")
        assert light_of(scene, "--env", "out/remainder.exr")[0] < 0.8 * whole[0], "without the lights much is missing"
        same(whole, light_of(scene, "--env", "out/remainder.exr", *lights))
    # --rotate-y-deg and --exposure apply to the lights and to the remainder alike.
    words = ["--rotate-y-deg", "80", "--exposure", "1"]
    turned = light_of("slanted.gltf", "--env", "sky.exr", *words)
    assert abs(turned[0] / whole[0] - 2) > 0.2
    same(turned, light_of("slanted.gltf", "--env", "out/remainder.exr", *lights, *words))
    # Lights taken out of the turned environment, in another unit, and out of a cube, whose remainder is written turned.
    run("lights", "sky.exr", "-o", "out", "--no-preview", "--rotate-y-deg", "80", "--lux-per-unit", "179", folder=folder)
    same(whole, light_of("slanted.gltf", "--env", "out/remainder.exr", *lights))
    same(turned, light_of("slanted.gltf", "--env", "out/remainder.exr", *lights, *words))
    run("bake", "sky.exr", "-o", "cube", "--size", "128", "--levels", "1", "--irradiance-size", "4", "--brdf-size", "16", "--no-preview", "--encoding", "rgba32f",
        folder=folder)
    run("lights", "cube/specular.ktx2", "-o", "out", "--no-preview", "--rotate-y-deg", "80", folder=folder)
    same(turned, light_of("slanted.gltf", "--env", "out/remainder.exr", *lights, "--exposure", "1"))
    # Lights of the user's own scene keep their unit.
    scene, taken = make_square(math.radians(50)), json.loads((folder / "out/lights.gltf").read_text())
    scene["extensions"], scene["extensionsUsed"] = taken["extensions"], taken["extensionsUsed"]
    scene["nodes"] += taken["nodes"]
    scene["scenes"] = [{"nodes": list(range(len(scene["nodes"])))}]
    (folder / "lit.gltf").write_text(json.dumps(scene))
    same(light_of("slanted.gltf", "--env", "out/remainder.exr", *lights), light_of("lit.gltf", "--env", "out/remainder.exr"))
    # The shadings of engines draw the lights too; a file that holds no lights is an error.
    same(light_of("slanted.gltf", "--env", "out/remainder.exr", *lights), light_of("slanted.gltf", "--env", "out/remainder.exr", *lights, "--shading", "split-sum"))
    assert "is not a glTF file" in run("render", "up.gltf", "--lights", "out/lights.json", "-o", "no.exr", folder=folder, code=1).stderr
    assert "no light" in run("render", "up.gltf", "--lights", "up.gltf", "-o", "p.exr", *TINY, folder=folder).stderr


def test_lights_of_an_openexr_latlong_are_read_where_they_were(folder):
    run("sky", "-o", "sky.exr", "--exr", "float", "--height", "64", "--sun-elevation-deg", "40", "--sun-azimuth-deg", "30", folder=folder)
    run("convert", "sky.exr", "-o", "stated.exr", "--to", "latlong/openexr", folder=folder)
    said = run("lights", "stated.exr", "-o", "out", "--no-preview", folder=folder)
    assert "warning" not in said.stderr
    sun, = lights_of(folder / "out")["lights"]
    assert abs(sun["azimuth_deg"] - 30) < 1 and abs(sun["elevation_deg"] - 40) < 1
    # The remainder states OpenEXR's convention as well: the glow that is left is where the sun was.
    (folder / "slanted.gltf").write_text(json.dumps(make_square(math.radians(50))))
    same_light(matte_light("slanted.gltf", "--env", "stated.exr", folder=folder),
               matte_light("slanted.gltf", "--env", "out/remainder.exr", "--lights", "out/lights.gltf", folder=folder))
    assert matte_light("slanted.gltf", "--env", "out/remainder.exr", folder=folder) != matte_light(
        "slanted.gltf", "--env", "out/remainder.exr", "--latlong", "default", folder=folder)
    said = run("lights", "stated.exr", "-o", "out", "--no-preview", "--format", "hdr", folder=folder)
    assert "read it with --latlong openexr" in said.stderr


def test_lights_without_a_light(folder):
    run("sky", "-o", "grey.hdr", "--no-sun-disc", "--height", "64", folder=folder)
    result = run("lights", "grey.hdr", "-o", "out", folder=folder)
    assert "no light stands out" in result.stdout
    assert lights_of(folder / "out")["lights"] == [] and "nodes" not in json.loads((folder / "out/lights.gltf").read_text())
    run("sky", "-o", "coarse.hdr", "--height", "16", folder=folder)
    assert "too coarse" in run("lights", "coarse.hdr", "-o", "coarse", folder=folder).stderr


# --- compare ---


TINY = ["--width", "16", "--height", "12", "--spp", "4"]


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


def make_glb():
    """A tetrahedron with two cameras: "front", square, and "wide", twice as wide as high."""
    corners = [(0, 1, 0), (-1, -1, 1), (1, -1, 1), (0, -1, -1)]
    faces = [0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2]
    buffer = b"".join(struct.pack("<3f", *c) for c in corners) + struct.pack("<12H", *faces)
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
        "nodes": [{"mesh": 0, "name": "tetrahedron"}, {"camera": 0, "translation": [0, 0, 5], "name": "front"},
                  {"camera": 1, "translation": [0.5, 0, 6], "name": "wide"}],
        "cameras": [{"type": "perspective", "name": name, "perspective": {"yfov": 0.8, "aspectRatio": aspect, "znear": 0.1}}
                    for name, aspect in [("front", 1), ("wide", 2)]],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "buffers": [{"byteLength": len(buffer)}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, -1, -1], "max": [1, 1, 1]},
                      {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(buffer), 0x004E4942) + buffer
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def make_square(tilt):
    """A glTF document of a matte square of side 20 about the origin that looks up, tilted about X towards +Z by `tilt` radians. Its albedo is 0.8."""
    corners = [(-10, 0, 10), (10, 0, 10), (10, 0, -10), (-10, 0, -10)]
    buffer = b"".join(struct.pack("<3f", *c) for c in corners) + struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    return {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "rotation": [math.sin(tilt / 2), 0, 0, math.cos(tilt / 2)]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.8, 0.8, 1]}, "extras": {"lambert": True}}],
        "buffers": [{"byteLength": len(buffer), "uri": "data:application/octet-stream;base64," + base64.b64encode(buffer).decode()}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-10, 0, -10], "max": [10, 0, 10]},
                      {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
    }


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


def test_info_tells_of_any_picture(folder):
    run("render", "ball", "-o", "r.exr", *TINY, folder=folder)
    said = json.loads(run("info", "r.exr", "--json", folder=folder).stdout)
    assert (said["kind"], said["width"], said["height"], said["format"]) == ("picture", 16, 12, "OpenEXR"), said
    assert {"", "direct", "albedo"} <= set(said["layers"]) and 0 < said["opacity"]["coverage"] < 1, said
    assert said["range"][0] >= 0 and said["bad"] == {"not_a_number": 0, "infinite": 0, "negative": 0}
    text = run("info", "r.exr", folder=folder).stdout
    assert "16 x 12, a picture" in text and "layers" in text and "covered" in text, text
    layer = json.loads(run("info", "r.exr", "--layer", "albedo", "--json", folder=folder).stdout)
    assert layer["range"][1] <= 1
    (folder / "odd.exr").write_bytes(make_exr(7, 5, {3: float("nan")}))
    odd = run("info", "odd.exr", folder=folder).stdout
    assert "7 x 5, a picture" in odd and "1 not a number" in odd, odd
    assert "not twice as wide as high" in run("info", "odd.exr", "--projection", "latlong", folder=folder).stderr
    environment = json.loads(run("info", "studio.hdr", "--json", folder=folder).stdout)
    picture = json.loads(run("info", "studio.hdr", "--picture", "--json", folder=folder).stdout)
    assert environment.get("kind") != "picture" and picture["kind"] == "picture"


def png_of(file):
    """(width, height, channels, bytes) of an 8-bit PNG."""
    data, at, packed = file.read_bytes(), 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", body[:10])
        packed += body if kind == b"IDAT" else b""
        at += 12 + size
    channels = {0: 1, 2: 3, 6: 4}[colour]
    raw, stride, rows, above = zlib.decompress(packed), channels * width, bytearray(), bytearray(channels * width)
    for y in range(height):
        kind, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            a, b, c = line[i - channels] if i >= channels else 0, above[i], above[i - channels] if i >= channels else 0
            p = a + b - c
            paeth = a if abs(p - a) <= min(abs(p - b), abs(p - c)) else b if abs(p - b) <= abs(p - c) else c
            line[i] = (line[i] + [0, a, b, (a + b) // 2, paeth][kind]) & 255
        rows += line
        above = line
    assert depth == 8
    return width, height, channels, bytes(rows)


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


def test_compare_tells_and_fails_by_a_limit(folder):
    same = json.loads(run("compare", "studio.hdr", "studio.hdr", "--json", "--fail-above", "flip=0", "--fail-below", "ssim=1", folder=folder).stdout)
    assert same["errors"]["rmse"] == 0 and same["errors"]["hdr_flip"] == 0 and same["errors"]["mean_ratio"] == 1 and same["failures"] == []
    result = run("compare", "evening.hdr", "studio.hdr", "--json", "--fail-above", "relative=0.01", folder=folder, code=1)
    told = json.loads(result.stdout)
    assert told["errors"]["relative_rmse"] > 0.01 and len(told["failures"]) == 1, told
    assert "error: studio.hdr: relative is" in result.stderr, result.stderr
    text = run("compare", "evening.hdr", "studio.hdr", folder=folder).stdout
    for name in ["RMSE", "relative RMSE", "tone-mapped RMSE", "PSNR", "SSIM", "FLIP", "HDR-FLIP", "mean A / mean B"]:
        assert name in text, text
    again = run("compare", "evening.hdr", "studio.hdr", "--threads", "3", "--json", folder=folder).stdout
    assert again == run("compare", "evening.hdr", "studio.hdr", "--threads", "1", "--json", folder=folder).stdout


def test_compare_draws(folder):
    for name in ["hdr-flip", "flip", "difference", "tone-mapped", "relative", "ssim"]:
        run("compare", "evening.hdr", "studio.hdr", "--heat", f"{name}.png", "--heat-of", name, "--quiet", folder=folder)
        assert (folder / f"{name}.png").read_bytes().startswith(b"\x89PNG")
    run("compare", "evening.hdr", "studio.hdr", "--sheet", "a.png", "--threads", "1", folder=folder)
    run("compare", "evening.hdr", "studio.hdr", "--sheet", "b.png", "--threads", "3", folder=folder)
    assert (folder / "a.png").read_bytes() == (folder / "b.png").read_bytes()
    run("compare", "evening.hdr", "studio.hdr", "--heat", "h.png", "--no-flip", folder=folder)


def test_compare_refuses_what_cannot_be_compared(folder):
    run("sky", "-o", "small.hdr", "--height", "16", folder=folder)
    assert "32 x 16, but studio.hdr is 64 x 32" in run("compare", "small.hdr", "studio.hdr", folder=folder, code=1).stderr
    assert "missing.hdr" in run("compare", "missing.hdr", "studio.hdr", folder=folder, code=1).stderr
    (folder / "good.exr").write_bytes(make_exr(8, 4, {}))
    (folder / "bad.exr").write_bytes(make_exr(8, 4, {11: float("nan"), 12: float("inf"), 20: float("-inf")}))
    refused = run("compare", "bad.exr", "good.exr", folder=folder, code=1)
    assert "3 pixels are NaN or infinite, the first at (3, 1)" in refused.stderr and "--skip-bad" in refused.stderr, refused.stderr
    skipped = json.loads(run("compare", "bad.exr", "good.exr", "--skip-bad", "--json", folder=folder).stdout)
    assert skipped["skipped_pixels"] == 3 and skipped["errors"]["pixels"] == 29 and skipped["errors"]["rmse"] == 0, skipped
    (folder / "mask.exr").write_bytes(make_exr(8, 4, {i: 0.0 for i in range(32)}))
    assert "leaves no pixel" in run("compare", "good.exr", "good.exr", "--mask", "mask.exr", folder=folder, code=1).stderr
    assert "mask.exr" in run("compare", "studio.hdr", "studio.hdr", "--mask", "mask.exr", folder=folder, code=1).stderr
    assert "(unnamed)" in run("compare", "good.exr", "good.exr", "--layer", "diffuse", folder=folder, code=1).stderr
    assert "layers" in run("compare", "studio.hdr", "studio.hdr", "--layer", "diffuse", folder=folder, code=1).stderr


def test_compare_masks_and_tables_by_object(folder):
    (folder / "b.exr").write_bytes(make_exr(8, 4, {}))
    (folder / "a.exr").write_bytes(make_exr(8, 4, {i: 1.5 for i in range(8)}))  # the first row's red is 1 too bright
    (folder / "rows.exr").write_bytes(make_exr(8, 4, {i: float(i // 8) for i in range(32)}))
    told = json.loads(run("compare", "a.exr", "b.exr", "--objects", "rows.exr", "--json", folder=folder).stdout)
    assert [o["name"] for o in told["objects"]] == ["background", "object 1", "object 2", "object 3"]
    assert abs(told["objects"][0]["rmse"] - (1 / 3) ** 0.5) < 1e-6 and told["objects"][3]["rmse"] == 0, told["objects"]
    assert "object 2" in run("compare", "a.exr", "b.exr", "--objects", "rows.exr", folder=folder).stdout
    masked = json.loads(run("compare", "a.exr", "b.exr", "--mask", "rows.exr", "--json", folder=folder).stdout)
    assert masked["errors"]["pixels"] == 24 and masked["errors"]["rmse"] == 0, masked


def test_latlong_maps_in_a_convention(folder):
    words = ["bake", "studio.hdr", *SMALL, "--layout", "latlong", "--levels", "2", "--encoding", "rgba32f"]

    def rows(name, *more):
        run(*words, "-o", name, *more, folder=folder)
        level = list(struct.iter_unpack("<4f", (folder / name / "specular.ktx2").read_bytes()[-16 * 32 * 16:]))
        return [level[32 * y:32 * y + 32] for y in range(16)]

    default = rows("default")
    assert rows("again", "--latlong-out", "default") == default
    assert "latlong_out" not in manifest_of(folder / "default")["options"]
    # A convention whose centre lies a quarter, half or three quarters of a turn to the right begins that much later.
    for convention, quarters, axes in [("usd", 1, "centre +Z, right -X"), ("mod", 2, "centre -X, right -Z"), ("materialx", 3, "centre -Z, right +X"),
                                       ("latlong/centre=+Z,right=-X", 1, "centre +Z, right -X")]:
        assert rows("turned", "--latlong-out", convention) == [row[8 * quarters:] + row[:8 * quarters] for row in default], convention
        manifest = manifest_of(folder / "turned")
        assert manifest["options"]["latlong_out"] == convention
        assert axes in manifest["convention"] and axes in manifest["specular"]["convention"] and axes in manifest["irradiance"]["convention"]
        assert manifest["specular"]["projection"] == "latlong/" + convention.removeprefix("latlong/")
    # Read back with the same name, the light is where it was, in conventions that take resampling too.
    expected = json.loads(run("info", "studio.hdr", "--json", folder=folder).stdout)["irradiance"]
    for convention in ["usd", "mitsuba", "openexr", "centre=-Y,right=+X,up=+Z"]:
        for engine, name in [(["--for", "blender"], "one/studio.exr"), (["--layout", "latlong", "--format", "exr", "--levels", "1"], "one/specular.exr")]:
            run("bake", "studio.hdr", "-o", "one", *SMALL[2:], "--size", "64", *engine, "--latlong-out", convention, folder=folder)
            found = json.loads(run("info", name, "--latlong", convention, "--json", folder=folder).stdout)["irradiance"]
            for axis, light in expected.items():
                assert all(abs(a - b) < 0.03 * b for a, b in zip(found[axis], light)), (convention, engine, axis, found[axis], light)
    run("bake", "studio.hdr", "-o", "mip", *SMALL, "--layout", "latlong", "--format", "exr-mip", folder=folder)
    assert "samples from edge to edge" in manifest_of(folder / "mip")["specular"]["convention"]
    assert manifest_of(folder / "mip")["specular"]["projection"] == "latlong/openexr"


def test_compare_audits_lat_long_bakes_in_every_convention(folder):
    def audit(*bakes):
        return json.loads(run("compare", *[w for b in bakes for w in ("--bake", b)], "--env", "studio.hdr", "--json", folder=folder).stdout)

    for convention in [None, "usd", "mitsuba", "openexr", "mod", "centre=-Y,right=+X,up=+Z", "centre=+X,right=-Z"]:
        asked = ["--latlong-out", convention] if convention else []
        for format in ["ktx2", "dds", "exr-mip"]:
            run("bake", "studio.hdr", "-o", "o", *SMALL[2:], "--layout", "latlong", "--size", "64", "--levels", "3", "--format", format, *asked, folder=folder)
            found = audit("o/specular." + {"exr-mip": "exr"}.get(format, format))
            assert found["of_source"] and found["orientation"]["words"] == "as ours", (convention, format, found)
            assert all(level["broad_error"] < 0.03 for level in found["levels"]), (convention, format, found)
        run("bake", "studio.hdr", "-o", "o", *SMALL[2:], "--layout", "latlong", "--size", "64", "--levels", "3", "--format", "hdr", *asked, folder=folder)
        found = audit("o/specular_0.hdr", "o/specular_1.hdr", "o/specular_2.hdr")
        assert found["of_source"] and found["orientation"]["words"] == "as ours", (convention, found)
    # Without the manifest a texture's own key says it; a file that has neither is taken for the default convention.
    run("bake", "studio.hdr", "-o", "o", *SMALL[2:], "--layout", "latlong", "--size", "64", "--levels", "3", "--latlong-out", "usd", folder=folder)
    shutil.copy(folder / "o/specular.ktx2", folder / "alone.ktx2")
    assert audit("alone.ktx2")["orientation"]["words"] == "as ours"
    run("bake", "studio.hdr", "-o", "o", *SMALL[2:], "--layout", "latlong", "--size", "64", "--levels", "3", "--latlong-out", "usd", "--format", "dds", folder=folder)
    shutil.copy(folder / "o/specular.dds", folder / "alone.dds")
    assert audit("alone.dds")["orientation"]["words"] == "turned by 270 degrees about +Y"


def test_compare_audits_our_bakes(folder):
    run("bake", "studio.hdr", "-o", "o", *SMALL, folder=folder)
    audit = json.loads(run("compare", "--bake", "o/specular.ktx2", "--env", "studio.hdr", "--json", folder=folder).stdout)
    assert audit["orientation"]["words"] == "as ours", audit["orientation"]
    for level in audit["levels"]:
        assert level["error"] < 2e-3 and abs(level["scale"] - 1) < 1e-3 and level["stated_error"] < 2e-3, level
    text = run("compare", "--bake", "o/specular.ktx2", "--env", "studio.hdr", folder=folder).stdout
    assert "orientation   as ours" in text, text
    turned = run("compare", "--bake", "o/specular.ktx2", "--env", "studio.hdr", "--latlong", "usd", folder=folder).stdout
    assert "turned by" in turned and "--latlong default" in turned, turned
    run("bake", "studio.hdr", "-o", "f", "--size", "16", "--format", "exr", "--levels", "2", "--no-preview", folder=folder)
    pictures = [str(p.relative_to(folder)) for p in sorted((folder / "f").glob("specular*.exr"))]
    text = run("compare", *[w for p in pictures for w in ("--bake", p)], "--env", "studio.hdr", folder=folder).stdout
    assert "orientation   as ours" in text, text
    assert "not a cube" in run("compare", "--bake", "o/brdf.ktx2", "--env", "studio.hdr", folder=folder, code=1).stderr
    text = run("compare", "--bake", "studio.hdr", "--env", "studio.hdr", folder=folder).stdout
    assert "a bake of this environment, as ours" in text, text


def test_compare_passes_a_verdict_on_bakes(folder):
    def audit(*words, code=0):
        return json.loads(run("compare", "--bake", *words, "--json", folder=folder, code=code).stdout)

    run("sky", "-o", "axes.hdr", "--axes", "--height", "64", folder=folder)
    run("bake", "studio.hdr", "-o", "o", *SMALL, folder=folder)
    own = audit("o/specular.ktx2", "--env", "studio.hdr", "--within", "0.01")
    assert own["of_source"] and own["within"] and own["lobe"] == "ggx" and own["verdict"].startswith("a bake of this environment, as ours"), own
    assert not audit("o/specular.ktx2", "--env", "studio.hdr", "--within", "1e-9", code=1)["within"]
    other = audit("o/specular.ktx2", "--env", "axes.hdr", code=1)
    assert not other["of_source"] and other["verdict"].startswith("not a bake of this environment"), other
    text = run("compare", "--bake", "o/specular.ktx2", "--env", "axes.hdr", folder=folder, code=1).stdout
    assert "verdict       not a bake of this environment" in text and "cannot tell them apart" not in text, text
    assert "--within" in run("compare", "--bake", "o/specular.ktx2", "--env", "studio.hdr", "--within", "2", folder=folder, code=2).stderr
    for lobe, widths in [("phong", ["--exponents", "inf,64,8"]), ("charlie", ["--roughness", "0.4,0.8"])]:
        run("bake", "studio.hdr", "-o", lobe, *SMALL, "--lobe", lobe, *widths, folder=folder)
        found = audit(f"{lobe}/specular.ktx2", "--env", "studio.hdr")
        assert found["lobe"] == lobe and all(level["stated_error"] < 2e-3 for level in found["levels"]), found


def test_compare_agrees_with_flip_evaluator(folder):
    """PyPI's flip-evaluator itself, where the interpreter that FLIP_PYTHON names (else this one) has it."""
    python = os.environ.get("FLIP_PYTHON", sys.executable)
    if subprocess.run([python, "-c", "import flip_evaluator"], capture_output=True).returncode:
        raise Skipped("flip-evaluator is not installed (pip install flip-evaluator; FLIP_PYTHON names its interpreter)")

    def agrees(kind, a, b, key):
        code = f"from flip_evaluator import evaluate; print('mean', evaluate({b!r}, {a!r}, {kind!r}, applyMagma=False)[1])"
        theirs = float(subprocess.run([python, "-c", code], cwd=folder, capture_output=True, text=True, check=True).stdout.split("mean")[-1])
        ours = json.loads(run("compare", a, b, "--json", folder=folder).stdout)["errors"][key]
        print(f"  {kind} {a}: theirs {theirs:.6f}, ours {ours:.6f}")
        assert ours > 0.001 and abs(theirs - ours) < 1e-4, (kind, theirs, ours)

    for elevation in [40, 12, 5]:
        for letter, turbidity in [("a", 2), ("b", 4)]:
            run("sky", "-o", f"{letter}{elevation}.exr", "--exr", "float", "--height", "64", "--sun-elevation-deg", elevation, "--turbidity", turbidity, folder=folder)
        agrees("HDR", f"a{elevation}.exr", f"b{elevation}.exr", "hdr_flip")
    for name in ["difference", "tone-mapped", "relative"]:  # pictures for a screen that the tests have made already
        run("compare", "a12.exr", "b12.exr", "--heat", f"{name}.png", "--heat-of", name, "--quiet", folder=folder)
    agrees("LDR", "difference.png", "relative.png", "flip")
    agrees("LDR", "tone-mapped.png", "relative.png", "flip")


def make_exr(width, height, special):
    """A scanline EXR without compression, float RGB of 0.5, `special` values in the red channel by texel number."""
    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value

    channels = b"".join(c.encode() + b"\0" + struct.pack("<iiii", 2, 0, 1, 1) for c in "BGR") + b"\0"
    window = struct.pack("<iiii", 0, 0, width - 1, height - 1)
    header = struct.pack("<ii", 20000630, 2) + attribute("channels", "chlist", channels) + attribute("compression", "compression", b"\0")
    header += attribute("dataWindow", "box2i", window) + attribute("displayWindow", "box2i", window) + attribute("lineOrder", "lineOrder", b"\0")
    header += attribute("pixelAspectRatio", "float", struct.pack("<f", 1)) + attribute("screenWindowCenter", "v2f", struct.pack("<ff", 0, 0))
    header += attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0"
    line = 8 + 12 * width
    table = b"".join(struct.pack("<Q", len(header) + 8 * height + y * line) for y in range(height))
    rows = b""
    for y in range(height):
        red = [special.get(y * width + x, 0.5) for x in range(width)]
        rows += struct.pack("<ii", y, 12 * width) + struct.pack(f"<{width}f", *[0.5] * width) * 2 + struct.pack(f"<{width}f", *red)
    return header + table + rows


def prepare(folder):
    run("sky", "-o", "studio.hdr", "--height", "32", folder=folder)
    run("sky", "-o", "evening.hdr", "--height", "32", "--sun-elevation-deg", "5", folder=folder)


if __name__ == "__main__":
    sys.exit(run_folder_tests("cli-tests", dict(globals()), sys.argv[1:], prepare))
