#!/usr/bin/env python3
"""Tests of `domelight batch`: plans, runs, what happens when they are killed. DOMELIGHT_PROGRAM names the program; closes with the line that ./test
adds up.

Each function test_... gets a folder of its own with a folder `hdris` of six small environments.
"""

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
    return {str(p.relative_to(folder)): hashlib.sha256(p.read_bytes()).hexdigest() for p in sorted(Path(folder).rglob("*")) if p.is_file()}


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
    for variables, words in [({"SLURM_ARRAY_TASK_ID": "2", "SLURM_ARRAY_TASK_MIN": "1", "SLURM_ARRAY_TASK_COUNT": "1"}, ["--shards", "3"]),
                             ({"SLURM_ARRAY_TASK_ID": "1", "SLURM_ARRAY_TASK_MIN": "0"}, ["--shards", "3"]),
                             ({"AWS_BATCH_JOB_ARRAY_INDEX": "1", "AWS_BATCH_JOB_ARRAY_SIZE": "3"}, []),
                             ({"JOB_COMPLETION_INDEX": "1"}, ["--shards", "3"])]:
        assert statuses(folder, *words, env=variables)[1]["shard"] == "2/3", variables
    for words, variables, says in [(["--shard", "4/3"], {}, "is not a shard"), (["--shard", "0/3"], {}, "is not a shard"), (["--shard", "x"], {}, "is not a shard"),
                                   (["--shards", "3"], {}, "not which one this is"), ([], {"JOB_COMPLETION_INDEX": "1"}, "of how many shards"),
                                   (["--memory", "lots"], {}, "number of bytes"), (["--workers", "0"], {}, "--workers")]:
        assert says in run("batch", "run", "batch", *words, folder=folder, code=2, env=variables).stderr, words
    assert "is not a shard" in run("batch", "run", "batch", "--shards", "3", folder=folder, code=2, env={"JOB_COMPLETION_INDEX": "3"}).stderr


def test_same_bytes_for_any_number_of_workers_and_any_memory(folder):
    batch = plan(folder)
    whole = None
    for words in [["--workers", "1", "--threads", "1"], ["--workers", "3", "--threads", "2"], ["--memory", "1"]]:
        shutil.rmtree(batch / "results", ignore_errors=True)
        statuses(folder, *words)
        assert whole in (None, results_of(batch))
        whole = results_of(batch)


def prepare(folder):
    for index, name in enumerate(NAMES):
        file = folder / "hdris" / f"{name}.hdr"
        file.parent.mkdir(parents=True, exist_ok=True)
        run("sky", "-o", file, "--height", "16", "--sun-elevation-deg", 10 * index + 1, folder=folder)


if __name__ == "__main__":
    sys.exit(run_folder_tests("batch", dict(globals()), sys.argv[1:], prepare))
