"""Sets of probes: what is written, and how a render is lit by them."""

import hashlib
import json

from program import run

PROBES = ["--size", "8", "--spp", "2", "--bounces", "1"]


def test_probes_are_written_whole_and_described(folder):
    told = run("probes", "spheres", "-o", "set", "--grid", "2,1,1", *PROBES, folder=folder).stdout
    assert told.startswith("set: 2 probes of 8 x 8 texels a face, "), told
    assert sorted(p.name for p in (folder / "set").iterdir()) == ["distance.ktx2", "irradiance.ktx2", "probes.json", "specular.ktx2"]
    told = run("info", "set", folder=folder).stdout
    assert told.startswith("set: 2 probes of spheres under the built-in sky, captured by domelight ") and "grid             2 x 1 x 1" in told, told
    assert json.loads(run("info", "set/probes.json", "--json", folder=folder).stdout)["kind"] == "probes"
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
    assert "distance.ktx2 is not the file" in run("info", "at2", folder=folder, code=1).stderr
    assert "distance.ktx2 is not the file" in run("probes", "spheres", "--check", "at2", folder=folder, code=1).stderr
    (folder / "at2/distance.ktx2").write_bytes((folder / "at/distance.ktx2").read_bytes())
    for name in ("specular.ktx2", "irradiance.ktx2", "distance.ktx2", "probes.json"):
        assert (folder / "at" / name).read_bytes() == (folder / "at2" / name).read_bytes(), name


def test_a_render_is_lit_by_probes(folder):
    run("probes", "spheres", "--env", "evening.hdr", "-o", "set", "--grid", "2,2,2", *PROBES, folder=folder)
    view = ["spheres", "--env", "evening.hdr", "--width", "16", "--height", "8", "--spp", "1", "--background", "transparent", "--shading", "split-sum", "--quiet"]
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
    def refused(*words, code, says, scene="ball"):
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
