#!/usr/bin/env python3
"""Tests of `domelight batch`: plans, runs, what happens when they are killed. DOMELIGHT_PROGRAM names the program; closes with the line that ./test
adds up.

Each function test_... gets a folder of its own with a folder `hdris` of six small environments.
"""

import contextlib
import hashlib
import json
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))
from folder_tests import Skipped, run_folder_tests  # noqa: E402

PROGRAM = os.environ.get("DOMELIGHT_PROGRAM", str(ROOT / "build/dev/cli/domelight"))
SMALL = ["size=16", "irradiance_size=4", "brdf_size=16", "preview=false"]
SETTINGS = [word for setting in SMALL for word in ("--set", setting)]
NAMES = ["dawn", "evening", "night/high", "night/low", "noon", "studio"]
SCHEDULERS = ("SLURM_", "AWS_BATCH_", "JOB_COMPLETION_")
ENVIRONMENT = {key: value for key, value in os.environ.items() if not key.startswith(SCHEDULERS)}


def run(*words, folder, code=0, env=None, **options):
    """Runs `domelight WORDS` in `folder`; the exit status must be `code`."""
    result = subprocess.run([PROGRAM, *map(str, words)], cwd=folder, capture_output=True, text=True, timeout=300, env={**ENVIRONMENT, **(env or {})},
                            **options)
    assert result.returncode == code, f"{words}: exit {result.returncode}, not {code}\n{result.stdout}{result.stderr}"
    return result


def files_of(folder):
    """Relative name -> SHA-256 of every file below, links as what they lead to."""
    found = [Path(base) / name for base, _, names in os.walk(folder, followlinks=True) for name in names]
    return {str(p.relative_to(folder)): hashlib.sha256(p.read_bytes()).hexdigest() for p in sorted(found)}


def results_of(plan):
    """The bytes that a batch has made: not its logs and locks, which tell of times and machines."""
    return files_of(Path(plan) / "results")


def jobs_of(plan):
    lines = (Path(plan) / "plan.jsonl").read_text().splitlines()
    return [json.loads(line) for line in lines[1:]]


def plan(folder, *words, source="hdris", out="batch"):
    run("batch", "plan", source, "-o", out, *SETTINGS, *words, folder=folder)
    return folder / out


def statuses(folder, *words, code=0, **options):
    """{output: status} of a run."""
    told = json.loads(run("batch", "run", "batch", "--json", *words, folder=folder, code=code, **options).stdout)
    return {job["output"]: job["status"] for job in told["jobs"]}, told


def manifest(folder, *jobs, name="jobs.jsonl"):
    (folder / name).write_text("".join(json.dumps(job) + "\n" for job in jobs))
    return name


# --- plans ---


def test_a_plan_can_be_read_and_compared(folder):
    batch = plan(folder, "--for", "three", "--for", "babylon")
    jobs = jobs_of(batch)
    assert [job["output"] for job in jobs] == NAMES
    first = jobs[0]
    assert first["kind"] == "bake" and first["options"]["for"] == ["three", "babylon"] and first["options"]["size"] == 16
    assert first["inputs"] == [{"as": "environment", "file": "dawn.hdr", "bytes": (folder / "hdris/dawn.hdr").stat().st_size,
                                "sha256": hashlib.sha256((folder / "hdris/dawn.hdr").read_bytes()).hexdigest()}]
    assert first["cost"]["seconds"] > 0 and first["cost"]["memory"] > 0
    before = files_of(batch)
    plan(folder, "--for", "three", "--for", "babylon", "--threads", "1")
    assert files_of(batch) == before, "equal plans differ"
    (folder / "hdris/dawn.hdr").write_bytes((folder / "hdris/noon.hdr").read_bytes())
    plan(folder, "--for", "three", "--for", "babylon")
    changed = [a["output"] for a, b in zip(jobs, jobs_of(batch)) if a != b]
    assert changed == ["dawn"], changed


def test_commands_are_plain_lines_that_do_all_the_jobs(folder):
    batch = plan(folder, "--shards", "4")
    lines = (batch / "commands.txt").read_text().splitlines()
    assert len(lines) == 4 and all(line.startswith(f"domelight batch run {batch} --shard ") for line in lines), lines
    for line in lines:
        subprocess.run(["sh", "-c", line.replace("domelight", PROGRAM, 1)], check=True, capture_output=True, env=ENVIRONMENT)
    assert set(statuses(folder)[0].values()) == {"kept"}


def test_manifests(folder):
    run("sky", "-o", "a.hdr", "--height", "16", folder=folder)
    manifest(folder, {"environment": "a.hdr", "output": "x/one"}, {"environment": "hdris/noon.hdr", "output": "x/two", "options": {"size": 8}})
    batch = plan(folder, source="jobs.jsonl")
    assert [(j["output"], j["options"]["size"]) for j in jobs_of(batch)] == [("x/one", 16), ("x/two", 8)]
    (folder / "jobs.json").write_text(json.dumps({"defaults": {"options": {"levels": 2}}, "jobs": [{"environment": "a.hdr", "output": "x"}]}))
    assert jobs_of(plan(folder, source="jobs.json"))[0]["options"]["levels"] == 2
    # The six faces of a cube, in a folder or by their names.
    run("convert", "a.hdr", "-o", "faces/sky.hdr", "--to", "cube", "--layout", "faces", "--size", "8", folder=(folder / "faces").mkdir() or folder)
    faces = [f"faces/sky_{face}.hdr" for face in ["px", "nx", "py", "ny", "pz", "nz"]]
    manifest(folder, {"environment": "faces", "output": "folder"}, {"environment": faces, "output": "names"})
    by_folder, by_names = jobs_of(plan(folder, source="jobs.jsonl"))
    assert by_folder["inputs"] == by_names["inputs"] and [i["file"] for i in by_names["inputs"]] == faces
    shutil.move(folder / "faces", folder / "hdris/faces")
    assert "faces" in [job["output"] for job in jobs_of(plan(folder))]


def test_bad_plans_are_refused(folder):
    run("sky", "-o", "a.hdr", "--height", "16", folder=folder)
    good = {"environment": "a.hdr", "output": "a"}
    for jobs, says in [
        ([{**good, "enviroment": "a.hdr"}], "\"enviroment\" is not a key of a job of kind bake"),
        ([good, {**good, "kind": "boil"}], "jobs.jsonl line 2: \"boil\" is not a kind of job"),
        ([{"environment": "a.hdr"}], "has no \"output\""),
        ([{"output": "a"}], "has no \"environment\""),
        ([{**good, "environment": 3}], "not a file's name"),
        ([{**good, "environment": []}], "not a file's name"),
        ([good, good], "line 1 and jobs.jsonl line 2 would both go to \"a\""),
        ([{**good, "output": "a-b"}, {**good, "output": "a/b"}, good], "lies in that of"),
        ([{**good, "output": "../a"}], "does not lie in the batch's folder"),
        ([{**good, "output": "/a"}], "does not lie in the batch's folder"),
        ([{**good, "options": {"sise": 8}}], "--sise: is not an option"),
        ([{**good, "options": {"size": "big"}}], "\"big\" is not a whole number"),
        ([{**good, "options": {"lobe": "blinn"}}], "ggx, charlie"),
        ([{**good, "options": {"for": "quake"}}], "playcanvas"),
        ([{**good, "environment": "missing.hdr"}], "missing.hdr"),
        ([], "there is no job in it"),
    ]:
        manifest(folder, *jobs)
        said = run("batch", "plan", "jobs.jsonl", "-o", "batch", folder=folder, code=1).stderr
        assert says in said, (says, said)
        assert not (folder / "batch").exists()
    (folder / "jobs.jsonl").write_text("{\n")
    assert "jobs.jsonl line 1" in run("batch", "plan", "jobs.jsonl", "-o", "batch", folder=folder, code=1).stderr
    (folder / "hdris/noon.exr").write_bytes(b"x")
    assert "would both go to \"noon\"" in run("batch", "plan", "hdris", "-o", "batch", folder=folder, code=1).stderr
    for words, says in [(["plan", "hdris"], "--output"), (["plan"], "MANIFEST|FOLDER"), (["ruin", "x"], "Did you mean run?"), ([], "plan, run"),
                        (["plan", "hdris", "-o", "b", "--set", "size"], "NAME=VALUE")]:
        assert says in run("batch", *words, folder=folder, code=2).stderr, words


def test_an_edited_plan_is_refused(folder):
    batch = plan(folder)
    file = batch / "plan.jsonl"
    text = file.read_text()
    for change, says in [(lambda t: t.replace('"size":16', '"size":32', 1), "not the one of its name"), (lambda t: t[: len(t) // 2], "plan.jsonl"),
                         (lambda t: "\n".join(t.splitlines()[:-1]) + "\n", "holds 5 jobs, but its first line says 6"),
                         (lambda t: t.replace('"version":"', '"version":"9'), "was made by version 9"), (lambda t: "", "holds 0 jobs")]:
        file.write_text(change(text))
        assert says in run("batch", "run", "batch", folder=folder, code=1).stderr, says
    assert "there is no plan in it" in run("batch", "run", "hdris", folder=folder, code=1).stderr


# --- runs ---


def test_a_run_writes_what_the_commands_write(folder):
    batch = plan(folder, "--for", "generic", "--for", "filament")
    assert set(statuses(folder)[0].values()) == {"done"}
    bare = ["--size", "16", "--irradiance-size", "4", "--brdf-size", "16", "--no-preview", "--for", "generic", "--for", "filament"]
    for job in jobs_of(batch):
        run("bake", f"hdris/{job['output']}.hdr", "-o", f"bare/{job['output']}", *bare, folder=folder)
        assert files_of(batch / "results" / job["job"][:2] / job["job"] / "files") == files_of(folder / "bare" / job["output"])
    assert not (batch / "work").exists()


def test_conversions_write_what_convert_writes(folder):
    cases = {"usd": ({"to": "latlong/usd", "format": "exr", "exposure": 1}, ["--to", "latlong/usd", "--exposure", "1"], "usd.exr"),
             "cube": ({"format": "ktx2", "size": 8, "rotate": [0, 0, 1, 90], "mirror": "x", "encoding": "rgb9e5"},
                      ["--size", "8", "--rotate", "0,0,1,90", "--mirror", "x", "--encoding", "rgb9e5"], "cube.ktx2"),
             "faces": ({"to": "cube", "layout": "faces", "format": "hdr", "rotate": [[0, 1, 0, 30], [1, 0, 0, 5]]},
                       ["--to", "cube", "--layout", "faces", "--rotate", "0,1,0,30", "--rotate", "1,0,0,5"], "faces.hdr"),
             "ball": ({"to": "mirror-ball/fov=20", "size": 16, "format": "hdr"}, ["--to", "mirror-ball/fov=20", "--size", "16"], "ball.hdr"),
             "eye": ({"format": "png", "tonemap": "neutral", "ev": -1}, ["--tonemap", "neutral", "--ev", "-1"], "eye.png"),
             "seen": ({"format": "jpg", "sharp": True, "size": 8}, ["--sharp", "--size", "8"], "seen.jpg")}
    manifest(folder, *[{"kind": "convert", "environment": "hdris/noon.hdr", "output": f"made/{name}", "options": options} for name, (options, _, _) in cases.items()])
    run("batch", "plan", "jobs.jsonl", "-o", "batch", folder=folder)
    run("batch", "run", "batch", folder=folder)
    (folder / "bare").mkdir()
    for _, words, file in cases.values():
        run("convert", "hdris/noon.hdr", "-o", f"bare/{file}", *words, "--quiet", folder=folder)
    made = files_of(folder / "batch/out/made")
    assert made == files_of(folder / "bare") and len(made) == 11, (made, files_of(folder / "bare"))
    run("batch", "report", "batch", folder=folder)
    assert len(list((folder / "batch/report/thumbs").iterdir())) == 6
    run("batch", "plan", "hdris", "-o", "all", "--kind", "convert", "--set", "format=hdr", "--set", "size=8", folder=folder)
    assert [job["output"] for job in jobs_of(folder / "all")] == [name + ".hdr" for name in NAMES]
    for options, says in [({"format": "tga"}, "--format"), ({"to": "cubist"}, "--to"), ({"rotate": [1, 2]}, "--rotate"), ({"mirror": "w"}, "--mirror"),
                          ({"format": "exr", "encoding": "bc6h"}, "--encoding"), ({"size": 0}, "--size"), ({"rotate": [0, 0, 0, 1]}, "--rotate")]:
        manifest(folder, {"kind": "convert", "environment": "hdris/noon.hdr", "output": "x", "options": options})
        assert says in run("batch", "plan", "jobs.jsonl", "-o", "bad", folder=folder, code=1).stderr, says


def test_audits_find_what_compare_finds(folder):
    run("bake", "hdris/noon.hdr", "-o", "theirs", "--size", "16", "--no-preview", folder=folder)
    job = {"kind": "audit", "bake": "theirs/specular.ktx2", "options": {"within": 0.5, "texels": 96}}
    manifest(folder, {**job, "environment": "hdris/noon.hdr", "output": "right"}, {**job, "environment": "hdris/dawn.hdr", "output": "wrong"})
    run("batch", "plan", "jobs.jsonl", "-o", "batch", folder=folder)
    run("batch", "run", "batch", folder=folder)
    shutil.copy(folder / "theirs/specular.ktx2", folder)
    for name, env, code in [("right", "noon", 0), ("wrong", "dawn", 1)]:
        shutil.copy(folder / f"hdris/{env}.hdr", folder)
        bare = run("compare", "--bake", "specular.ktx2", "--env", f"{env}.hdr", "--within", "0.5", "--texels", "96", "--json", folder=folder, code=code).stdout
        assert json.loads(bare) == json.loads((folder / f"batch/out/{name}.json").read_text()), name
    # A bake of another environment is told of in the report; the job itself is done.
    run("batch", "report", "batch", folder=folder)
    data = json.loads((folder / "batch/report/index.html").read_text().split('id="data">')[1].split("</script>")[0])
    right, wrong = data["jobs"]
    assert right["warnings"] == [] and right["error"] < 0.05 and "not passed" in wrong["warnings"][0]
    for options, says in [({"within": 2}, "--within"), ({"texels": 1}, "--texels"), ({"for": "quake"}, "--for"), ({"size": 8}, "--size")]:
        manifest(folder, {**job, "environment": "hdris/noon.hdr", "output": "x", "options": options})
        assert says in run("batch", "plan", "jobs.jsonl", "-o", "bad", folder=folder, code=1).stderr, says


def test_renders_are_those_of_render(folder):
    (folder / "scene.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n")
    common, words = {"width": 24, "spp": 4}, ["--width", "24", "--spp", "4"]
    cases = {"truth": ({"scene": "ball", "height": 16, "seed": 3, **common}, ["ball", "--height", "16", "--seed", "3"], "truth.exr"),
             "eye": ({"scene": "spheres", "format": "png", "tonemap": "neutral", "bounces": 0, **common}, ["spheres", "--tonemap", "neutral", "--bounces", "0"], "eye.png"),
             "engine": ({"scene": "ball", "format": "png", "shading": "split-sum", "irradiance": "sh", **common},
                        ["ball", "--shading", "split-sum", "--irradiance", "sh"], "engine.png"),
             "cut": ({"scene": "ball", "format": "png", "background": "transparent", "ev": 1, **common}, ["ball", "--background", "transparent", "--ev", "1"], "cut.png"),
             "file": ({"format": "hdr", "camera_position": [2, 2, 2], "fov_deg": 50, **common}, ["scene.obj", "--camera-position", "2,2,2", "--fov-deg", "50"], "file.hdr")}
    manifest(folder, *[{"kind": "render", "environment": "hdris/noon.hdr", "output": name, "options": options, **({"scene": "scene.obj"} if name == "file" else {})}
                       for name, (options, _, _) in cases.items()])
    run("batch", "plan", "jobs.jsonl", "-o", "batch", folder=folder)
    run("batch", "run", "batch", folder=folder)
    (folder / "bare").mkdir()
    for _, more, file in cases.values():
        run("render", *more, *words, "--env", "hdris/noon.hdr", "-o", f"bare/{file}", "--quiet", folder=folder)
    assert files_of(folder / "batch/out") == files_of(folder / "bare")
    run("batch", "report", "batch", folder=folder)
    assert len(list((folder / "batch/report/thumbs").iterdir())) == 5
    for options, says in [({"spp": 0}, "--spp"), ({"scene": "teapot"}, "--scene"), ({"shading": "guess"}, "split-sum"), ({"format": "tga"}, "--format"),
                          ({"camera_position": [1]}, "--camera-position"), ({"background": "colour"}, "--background")]:
        manifest(folder, {"kind": "render", "environment": "hdris/noon.hdr", "output": "x", "options": {"scene": "ball", **options}})
        assert says in run("batch", "plan", "jobs.jsonl", "-o", "bad", folder=folder, code=1).stderr, says
    for job in [{}, {"scene": "scene.obj", "options": {"scene": "ball"}}]:
        manifest(folder, {"kind": "render", "environment": "hdris/noon.hdr", "output": "x", **job})
        assert "needs one scene" in run("batch", "plan", "jobs.jsonl", "-o", "bad", folder=folder, code=1).stderr, job


def test_captures_are_those_of_probes(folder):
    words = ["--size", "8", "--spp", "2", "--bounces", "1", "--irradiance-size", "4", "--distance-size", "4"]
    options = {"scene": "spheres", "size": 8, "spp": 2, "bounces": 1, "irradiance_size": 4, "distance_size": 4}
    cases = {"grid": ({"grid": [2, 1, 2]}, ["--grid", "2,1,2"]), "at": ({"at": [0, 2, 0, 3, 1, 0], "encoding": "rgba16f", "seed": 2},
                                                                       ["--at", "0,2,0", "--at", "3,1,0", "--encoding", "rgba16f", "--seed", "2"])}
    manifest(folder, *[{"kind": "probes", "environment": "hdris/noon.hdr", "output": name, "options": {**options, **more}} for name, (more, _) in cases.items()])
    run("batch", "plan", "jobs.jsonl", "-o", "batch", folder=folder)
    run("batch", "run", "batch", folder=folder)
    for name, (_, more) in cases.items():
        run("probes", "spheres", "--env", "hdris/noon.hdr", "-o", f"bare/{name}", *words, *more, "--quiet", folder=folder)
    assert files_of(folder / "batch/out") == files_of(folder / "bare")
    for more, says in [({}, "--grid"), ({"grid": [1, 1, 1], "density": 1}, "--density"), ({"grid": [0, 1, 1]}, "--grid"), ({"at": [1, 2]}, "--at"), ({"auto": 2}, "--auto")]:
        manifest(folder, {"kind": "probes", "environment": "hdris/noon.hdr", "output": "x", "options": {**options, **more}})
        assert says in run("batch", "plan", "jobs.jsonl", "-o", "bad", folder=folder, code=1).stderr, says


def test_a_second_run_does_nothing_and_a_damaged_result_is_made_again(folder):
    batch = plan(folder)
    statuses(folder)
    before = results_of(batch)
    assert set(statuses(folder)[0].values()) == {"kept"}
    damaged = sorted(batch.glob("results/*/*/files/specular.ktx2"))
    damaged[0].unlink()
    damaged[1].write_bytes(damaged[1].read_bytes()[:-1])
    (damaged[2].parents[1] / "done.json").write_text("{")
    assert sorted(statuses(folder)[0].values()) == ["done"] * 3 + ["kept"] * 3
    assert results_of(batch) == before
    # A change that keeps the size is seen by --check alone.
    damaged[3].write_bytes(damaged[3].read_bytes()[:-1] + b"!")
    assert set(statuses(folder)[0].values()) == {"kept"}
    assert sorted(statuses(folder, "--check")[0].values()) == ["done"] + ["kept"] * 5
    assert results_of(batch) == before


def test_a_source_that_changed_is_an_error(folder):
    batch = plan(folder)
    (folder / "hdris/dawn.hdr").write_bytes((folder / "hdris/noon.hdr").read_bytes())
    (folder / "hdris/evening.hdr").unlink()
    told, document = statuses(folder, code=1)
    assert told == {**dict.fromkeys(NAMES, "done"), "dawn": "changed", "evening": "changed"}
    reasons = {job["output"]: job["reason"] for job in document["jobs"]}
    assert "has changed since the plan was made" in reasons["dawn"] and "No such file" in reasons["evening"]
    assert not document["complete"]
    # Results that are there stay right, but their source is gone: that is told, too.
    (folder / "hdris/noon.hdr").write_bytes(b"new")
    assert statuses(folder, code=1)[0]["noon"] == "changed"
    # Planned again, only what is new is done.
    run("sky", "-o", "hdris/noon.hdr", "--height", "16", "--turbidity", "9", folder=folder)
    plan(folder)
    told, _ = statuses(folder)
    assert told == {**dict.fromkeys(set(NAMES) - {"evening"}, "kept"), "dawn": "done", "noon": "done"}, told
    assert len(list(batch.glob("results/*/*"))) == 6


def test_a_job_that_fails_is_tried_again_and_the_others_go_on(folder):
    (folder / "hdris/broken.hdr").write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16 +X 32\n")
    plan(folder)
    told, document = statuses(folder, "--attempts", "3", code=1)
    assert told == {**dict.fromkeys(NAMES, "done"), "broken": "failed"}
    broken = next(job for job in document["jobs"] if job["output"] == "broken")
    assert broken["attempts"] == 3 and "broken.hdr" in broken["reason"]
    assert "broken: failed:" in run("batch", "run", "batch", folder=folder, code=1).stdout


def test_shards_share_the_jobs(folder):
    batch = plan(folder)
    statuses(folder)
    whole = results_of(batch)
    shutil.rmtree(batch / "results")
    seen = []
    for index in range(1, 4):
        seen += statuses(folder, "--shard", f"{index}/3")[0]
    assert sorted(seen) == NAMES and results_of(batch) == whole
    # The shard by a scheduler's variables.
    for variables, words in [({"SLURM_ARRAY_TASK_ID": "2", "SLURM_ARRAY_TASK_COUNT": "1"}, ["--shards", "3"]),
                             ({"AWS_BATCH_JOB_ARRAY_INDEX": "1", "AWS_BATCH_JOB_ARRAY_SIZE": "3"}, []),
                             ({"JOB_COMPLETION_INDEX": "1"}, ["--shards", "3"])]:
        assert statuses(folder, *words, env=variables)[1]["shard"] == "2/3", variables
    for words, variables, says in [(["--shard", "4/3"], {}, "is not a shard"), (["--shard", "0/3"], {}, "is not a shard"), (["--shard", "x"], {}, "is not a shard"),
                                   (["--shards", "3"], {}, "not which one this is"), ([], {"JOB_COMPLETION_INDEX": "1"}, "of how many shards"),
                                   (["--memory", "lots"], {}, "number of bytes"), (["--workers", "0"], {}, "--workers")]:
        assert says in run("batch", "run", "batch", *words, folder=folder, code=2, env=variables).stderr, words
    for variables in [{"JOB_COMPLETION_INDEX": "3"}, {"SLURM_ARRAY_TASK_ID": "0"}, {"SLURM_ARRAY_TASK_ID": "4"}]:
        assert "not one of 3 shards" in run("batch", "run", "batch", "--shards", "3", folder=folder, code=2, env=variables).stderr


def test_a_shard_that_is_done_helps_the_others(folder):
    batch = plan(folder)
    told, document = statuses(folder, "--shard", "1/3", "--help-others", "--threads", "1")
    assert len(told) == 2 and set(told.values()) == {"done"} and 1 <= document["helped"] <= 4, document["helped"]
    assert len(list(batch.glob("results/*/*/done.json"))) == 2 + document["helped"]
    told, document = statuses(folder, "--shard", "2/3", "--threads", "1")
    assert document["helped"] == 0 and len(told) == 2
    assert len(statuses(folder)[0]) == 6
    assert "all intact" in run("batch", "verify", "batch", folder=folder).stdout


def test_same_bytes_for_any_number_of_workers_and_any_memory(folder):
    batch = plan(folder)
    whole = None
    for words in [["--workers", "1", "--threads", "1"], ["--workers", "3", "--threads", "2"], ["--memory", "1"]]:
        shutil.rmtree(batch / "results", ignore_errors=True)
        statuses(folder, *words)
        assert whole in (None, results_of(batch))
        whole = results_of(batch)


# --- what goes wrong ---


def children_of(process):
    """The workers of a run."""
    path = Path(f"/proc/{process}/task/{process}/children")
    return [int(word) for word in path.read_text().split()] if path.exists() else []


def begin(folder, *words):
    return subprocess.Popen([PROGRAM, "batch", "run", "batch", *words], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=ENVIRONMENT)


def leftovers(batch):
    return [p for p in batch.rglob("*") if p.name.endswith(".tmp") or ".tmp" in p.name] + list(batch.glob("work/*"))


def kill_at_random(folder, times, seed=1):
    """Kills a run at random moments, runs the rest, and returns how many jobs were done before the last run, with the bytes of all."""
    batch = folder / "batch"
    random_moment = random.Random(seed)
    start = time.monotonic()
    run("batch", "run", "batch", "--threads", "2", folder=folder)
    lasts, whole = time.monotonic() - start, results_of(batch)
    partial = 0
    for _ in range(times):
        shutil.rmtree(batch / "results")
        process = begin(folder, "--threads", "2")
        time.sleep(random_moment.uniform(0, lasts))
        process.kill()
        process.wait()
        partial += 0 < len(list(batch.glob("results/*/*/done.json"))) < 6
        run("batch", "run", "batch", "--threads", "2", folder=folder)
        assert results_of(batch) == whole and not leftovers(batch), leftovers(batch)
    return partial


def test_killed_at_any_moment_and_run_again_it_is_the_same(folder):
    """bench/batch.py kills fifty times."""
    plan(folder, "--set", "size=128")
    kill_at_random(folder, 4)


def test_a_job_whose_worker_is_killed_is_tried_again(folder):
    batch = plan(folder, "--set", "size=512")
    process = begin(folder, "--threads", "1", "--workers", "1")
    killed = 0
    while process.poll() is None and killed < 2:
        if list(batch.glob("work/*/files")):  # a job is under way
            for child in children_of(process.pid):
                with contextlib.suppress(ProcessLookupError):
                    os.kill(child, signal.SIGSEGV)
                    killed += 1
            time.sleep(0.05)
    assert process.wait() == 0 and killed == 2
    lines = [json.loads(line) for log in batch.glob("log/*.jsonl") for line in log.read_text().splitlines()]
    ended = [line for line in lines if line["status"] == "failed"]
    assert len(ended) == 2 and all("signal 11" in line["reason"] for line in ended), ended
    assert set(statuses(folder)[0].values()) == {"kept"} and not leftovers(batch)
    # One that ends its worker every time fails by itself.
    shutil.rmtree(batch / "results")
    process = begin(folder, "--threads", "1", "--workers", "1")
    while process.poll() is None:
        for child in children_of(process.pid):
            with contextlib.suppress(ProcessLookupError):
                os.kill(child, signal.SIGKILL)
    assert process.wait() == 1


def test_an_interrupted_run_ends_in_order(folder):
    batch = plan(folder, "--set", "size=512")
    for number in [signal.SIGINT, signal.SIGTERM]:
        process = subprocess.Popen([PROGRAM, "batch", "run", "batch", "--threads", "1"], cwd=folder, stderr=subprocess.PIPE, text=True, env=ENVIRONMENT,
                                   preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
        while not list(batch.glob("work/*/files")) and process.poll() is None:
            time.sleep(0.005)
        process.send_signal(number)
        said = process.communicate(timeout=60)[1]
        assert process.returncode == -number and "the same command does the others" in said, (process.returncode, said)
        assert not leftovers(batch)
    assert len(statuses(folder)[0]) == 6


def test_runs_of_one_plan_at_once_share_the_work(folder):
    batch = plan(folder, "--set", "size=256")
    processes = [begin(folder, "--threads", "1") for _ in range(3)]
    assert [process.wait() for process in processes] == [0, 0, 0]
    lines = [json.loads(line) for log in batch.glob("log/*.jsonl") for line in log.read_text().splitlines()]
    assert sorted(line["output"] for line in lines) == NAMES, "a job was done twice"
    whole = results_of(batch)
    shutil.rmtree(batch / "results")
    run("batch", "run", "batch", folder=folder)
    assert results_of(batch) == whole and not leftovers(batch)


def test_a_full_disk_stops_the_run_and_leaves_whole_results(folder):
    plan(folder)
    batch = folder / "batch"
    disk = folder / "disk"
    disk.mkdir()
    if os.geteuid() != 0 or subprocess.run(["mount", "-t", "tmpfs", "-o", "size=160k", "tmpfs", disk], capture_output=True).returncode != 0:
        raise Skipped("needs to mount a small file system")
    try:
        for file in batch.iterdir():
            shutil.copy(file, disk)
        said = run("batch", "run", "disk", "--threads", "1", folder=folder, code=1)
        assert "the disk is full" in said.stderr, said
        assert "not tried" in said.stdout and not leftovers(disk)
        done = len(list(disk.glob("results/*/*/done.json")))
        assert 0 < done < 6, done
        subprocess.run(["mount", "-o", "remount,size=8m", disk], check=True)
        assert f"6 of 6 jobs done, {done} before" in run("batch", "run", "disk", folder=folder).stdout
        assert "all intact" in run("batch", "verify", "disk", folder=folder).stdout
    finally:
        subprocess.run(["umount", disk], check=True)


# --- results ---


def test_merge_puts_results_under_the_names_of_the_outputs(folder):
    batch = plan(folder)
    run("batch", "run", "batch", folder=folder)  # the whole set: it is merged at once
    assert sorted(str(p.relative_to(batch / "out")) for p in batch.glob("out/**/*") if p.is_symlink()) == NAMES
    index = [json.loads(line) for line in (batch / "index.jsonl").read_text().splitlines()]
    assert [entry["output"] for entry in index] == NAMES
    for entry in index:
        assert files_of(batch / "out" / entry["output"]) == {file["file"]: file["sha256"] for file in entry["files"]}
    whole, results = files_of(batch / "out"), results_of(batch)
    shutil.move(batch, folder / "elsewhere")  # relative links go with the folder
    assert files_of(folder / "elsewhere/out") == whole
    shutil.move(folder / "elsewhere", batch)
    # Copies, further names, and links again.
    for place in ["copy", "hardlink", "copy", "link"]:
        told = json.loads(run("batch", "merge", "batch", "--place", place, "--json", folder=folder).stdout)
        assert told["complete"] and (place == "copy" or told["placed"] == 6), (place, told)
        assert results_of(batch) == results, place
        links = [p for p in batch.glob("out/**/*") if p.is_symlink()]
        assert (len(links) == 6) == (place == "link") and files_of(batch / "out") == whole, place
    # An output that is no longer planned loses its link; a file that is not ours stays.
    (batch / "out/note.txt").write_text("mine")
    (folder / "hdris/noon.hdr").unlink()
    plan(folder)
    told = json.loads(run("batch", "merge", "batch", "--json", folder=folder).stdout)
    assert not (batch / "out/noon").exists() and (batch / "out/note.txt").exists() and len(told["notes"]) == 2, told["notes"]


def test_merge_tells_of_every_hole(folder):
    batch = plan(folder)
    run("batch", "run", "batch", "--shard", "1/2", folder=folder)
    told = json.loads(run("batch", "merge", "batch", "--json", folder=folder, code=1).stdout)
    done = {json.loads(p.read_text())["job"] for p in batch.glob("results/*/*/done.json")}
    holes = [job["output"] for job in jobs_of(batch) if job["job"] not in done]
    assert holes and [m["output"] for m in told["missing"]] == holes and not told["complete"]
    assert not (batch / "index.jsonl").exists()
    said = run("batch", "merge", "batch", folder=folder, code=1).stdout
    assert all(f"{hole}: has no result" in said for hole in holes) and f"{len(holes)} are missing" in said
    # What a worker on another machine has left is removed when the set is whole.
    (batch / "work" / f"{'0' * 32}-elsewhere-1").mkdir(parents=True)
    run("batch", "run", "batch", "--shard", "2/2", folder=folder)
    assert (batch / "work").exists()
    run("batch", "merge", "batch", folder=folder)
    assert not (batch / "work").exists()


def test_verify_finds_every_damage(folder):
    batch = plan(folder)
    run("batch", "run", "batch", folder=folder)
    assert "all intact" in run("batch", "verify", "batch", folder=folder).stdout
    run("batch", "merge", "batch", "--place", "copy", folder=folder)
    (batch / "out/studio/sh.json").write_text("{}")
    a, b, c = sorted(batch.glob("results/*/*/files/specular.ktx2"))[:3]
    a.write_bytes(a.read_bytes()[:-1] + b"!")
    b.unlink()
    shutil.rmtree(c.parents[1])
    problems = json.loads(run("batch", "verify", "batch", "--json", folder=folder, code=1).stdout)["problems"]
    assert len(problems) == 4, problems
    assert sorted(p["what"].split(": ")[-1] for p in problems) == ["has no result", "its contents are not those that were written",
                                                                   "its contents are not those that were written", "its result is not whole"]


def test_report_is_a_page_by_itself(folder):
    (folder / "hdris/<script>alert(1)<").mkdir()
    shutil.copy(folder / "hdris/noon.hdr", folder / "hdris/<script>alert(1)<" / "a b#.hdr")
    (folder / "hdris/broken.hdr").write_bytes(b"x")
    batch = plan(folder, "--set", "preview=true")
    run("batch", "run", "batch", folder=folder, code=1)
    run("batch", "report", "batch", folder=folder)
    page = (batch / "report/index.html").read_text()
    assert "http" not in page.replace("<!doctype html>", "") and "<script>alert" not in page
    data = json.loads(page.split('id="data">')[1].split("</script>")[0])
    assert len(data["jobs"]) == 8
    for job in data["jobs"]:
        if job["output"] == "broken":
            assert job["status"] == "failed" and "known format" in job["reason"]
            continue
        assert job["status"] == "done" and job["seconds"] > 0 and job["bytes"] > 0 and job["error"] >= 0
        for link in [job["thumb"], job["picture"], job["folder"]]:
            assert (batch / "report" / link).exists(), link
        assert (batch / "report" / job["thumb"]).read_bytes()[:2] == b"\xff\xd8"


def prepare(folder):
    for index, name in enumerate(NAMES):
        file = folder / "hdris" / f"{name}.hdr"
        file.parent.mkdir(parents=True, exist_ok=True)
        run("sky", "-o", file, "--height", "16", "--sun-elevation-deg", 10 * index + 1, folder=folder)


if __name__ == "__main__":
    sys.exit(run_folder_tests("batch", dict(globals()), sys.argv[1:], prepare))
