"""Environments in any projection, layout and file: reading and converting them."""

import json
import math
import re
import shutil
import struct

from program import ROOT, SMALL, files_of, make_exr, manifest_of, run


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
