"""Help, version, wrong usage, suggestions, completions, and how commands end."""

import json
import re
import shutil
import subprocess

from program import PROGRAM, SMALL, make_glb, manifest_of, run


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
            captures = command != "probes" or "--for" not in words
            run(*words[1:], *(smaller.get(command, []) if captures else []), *(["--frames", "2"] if "--frames" in words else []), folder=folder)
    overview = run("--help", folder=folder).stdout
    for line in overview.split("\n\n")[0].splitlines()[1:]:
        run(*line.split()[1:], "--quiet", folder=folder)


def test_help_of_a_command(folder):
    overview = run("help", folder=folder).stdout
    assert overview == run("--help", folder=folder).stdout and "domelight help COMMAND" in overview
    for command in ["bake", "batch", "brdf", "compare", "convert", "info", "lights", "probes", "render", "sample", "sky", "view"]:
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


def test_stdout_that_is_full_is_an_error(folder):
    for words in [["info", "studio.hdr"], ["sample", "studio.hdr", "-n", "100000"]]:
        with open("/dev/full", "w") as full:
            result = subprocess.run([PROGRAM, *words], cwd=folder, stdout=full, stderr=subprocess.PIPE, text=True)
        assert result.returncode == 1 and result.stderr == "error: stdout: results cannot be written\n", result


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
