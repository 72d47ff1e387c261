"""Comparisons of pictures, and audits of bakes."""

import json
import os
import shutil
import subprocess
import sys

from folder_tests import Skipped
from program import SMALL, make_exr, run


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


def test_compare_knows_the_filter_of_files_without_keys(folder):
    """DDS and .env cannot say how they were filtered; the manifest beside them does. Without it, faces of one texel do not decide."""
    for engine, name in [("unreal", "studio.dds"), ("babylon", "studio.env")]:
        run("bake", "studio.hdr", "-o", engine, "--for", engine, "--size", "64", "--no-preview", folder=folder)
        found = json.loads(run("compare", "--bake", f"{engine}/{name}", "--env", "studio.hdr", "--json", folder=folder).stdout)
        assert found["roughness_stated_by"] == "the manifest beside it" and found["of_source"], found
        assert found["orientation"]["as_engine_reads"] is True, found["orientation"]
        assert all(level["stated_error"] < 5e-3 for level in found["levels"] if level["size"] <= 2), found["levels"]
        run("bake", "studio.hdr", "-o", "other", "--for", engine, "--size", "64", "--exposure", "1", "--no-preview", folder=folder)
        shutil.copy(folder / engine / name, folder / "other" / name)
        alone = json.loads(run("compare", "--bake", f"other/{name}", "--env", "studio.hdr", "--json", folder=folder).stdout)
        assert alone["of_source"] and not alone["roughness_stated_by"], alone


def test_compare_says_whether_a_cube_lies_as_an_engine_reads_it(folder):
    run("bake", "studio.hdr", "-o", "o", *SMALL, folder=folder)
    audit = ["compare", "--bake", "o/specular.ktx2", "--env", "studio.hdr"]
    assert "NOT as three reads it" in run(*audit, "--for", "three", folder=folder).stdout
    assert "  as filament reads it" in run(*audit, "--for", "filament", folder=folder).stdout
    turned = json.loads(run(*audit, "--for", "filament", "--latlong", "usd", "--json", folder=folder).stdout)
    assert "as_engine_reads" not in turned["orientation"], turned
    run("bake", "studio.hdr", "-o", "p", "--for", "playcanvas", "--no-preview", folder=folder)
    assert "atlas cannot be audited" in run("compare", "--bake", "p/studio-env-atlas.png", "--env", "studio.hdr", folder=folder, code=1).stderr


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
