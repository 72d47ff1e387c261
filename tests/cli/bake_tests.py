"""What a bake and a BRDF table write, again and again, whole or not at all."""

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
import time

from program import SMALL, files_of, launch, make_exr, manifest_of, png_of, run


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
