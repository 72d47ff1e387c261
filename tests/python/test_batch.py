"""domelight.batch: the plans and results of the program, from Python and from Dask."""

import filecmp
import os
import pickle
import subprocess
import warnings

import pytest

import domelight as dl
from domelight import batch

SMALL = {"size": 16, "irradiance_size": 4, "brdf_size": 16, "preview": False}


@pytest.fixture
def hdris(tmp_path):
    for index in range(4):
        (tmp_path / "hdris").mkdir(exist_ok=True)
        dl.write(tmp_path / f"hdris/sky{index}.hdr", dl.sky(16, sun_elevation_deg=10 * index + 5))
    return tmp_path / "hdris"


def same(a, b):
    compared = filecmp.dircmp(a, b)
    return not (compared.left_only or compared.right_only or compared.diff_files) and all(same(a / d, b / d) for d in compared.common_dirs)


def test_plan_and_results_are_the_programs(hdris, tmp_path):
    program = os.environ.get("DOMELIGHT_PROGRAM")
    if not program:
        pytest.skip("DOMELIGHT_PROGRAM is not set")
    plan = batch.plan(hdris, tmp_path / "ours", {"for": ["three"], **SMALL})
    settings = [word for setting in ["size=16", "irradiance_size=4", "brdf_size=16", "preview=false"] for word in ("--set", setting)]
    for action in [["plan", "hdris", "-o", "theirs", "--for", "three", *settings], ["run", "theirs"]]:
        subprocess.run([program, "batch", *action], cwd=tmp_path, check=True, capture_output=True)
    assert (tmp_path / "ours/plan.jsonl").read_bytes() == (tmp_path / "theirs/plan.jsonl").read_bytes()
    assert [plan[i].output for i in range(4)] == ["sky0", "sky1", "sky2", "sky3"] and plan[-1].options["for"] == ["three"]
    assert sorted(sum(plan.shards(3), [])) == [0, 1, 2, 3]
    outcomes = [batch.run_job(plan.folder, i) for i in range(len(plan))]
    assert [o.status for o in outcomes] == ["done"] * 4
    assert {batch.run_job(plan.folder, i, threads=2).status for i in range(4)} == {"kept"}
    assert plan.merge() == tmp_path / "ours/out"
    assert same(tmp_path / "ours/results", tmp_path / "theirs/results") and plan.verify() == []
    assert (tmp_path / "ours/index.jsonl").read_bytes() == (tmp_path / "theirs/index.jsonl").read_bytes()
    assert plan.report().exists() and len(batch.open_plan(plan.folder)) == 4
    assert list(pickle.loads(pickle.dumps(plan))) == list(plan)  # schedulers send it to their workers


def test_what_fails_is_told(hdris, tmp_path):
    plan = batch.plan(hdris, tmp_path / "batch", SMALL)
    (hdris / "sky1.hdr").write_bytes(b"x")
    outcomes = [batch.run_job(plan.folder, i) for i in range(4)]
    assert [o.done for o in outcomes] == [True, False, True, True] and "has changed since the plan" in outcomes[1].reason
    with pytest.raises(dl.Error, match="1 of 4 outputs are missing: sky1"):
        plan.merge()
    assert plan.verify() == [("sky1", "has no result")]
    for job in [4, -1]:
        with pytest.raises(dl.Error, match="is not a job"):
            batch.run_job(plan.folder, job)
    with pytest.raises(dl.Error, match="sise"):
        batch.plan(hdris, tmp_path / "other", {"sise": 16})
    with pytest.raises(dl.FileError, match="no plan"):
        batch.run_job(tmp_path, 0)
    with pytest.raises(dl.Error, match="is not"):
        plan.merge("teleport")


def test_dask_runs_a_plan(hdris, tmp_path):
    distributed = pytest.importorskip("dask.distributed")
    plan = batch.plan(hdris, tmp_path / "batch", SMALL)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, local_directory=str(tmp_path)) as cluster, distributed.Client(cluster) as client:
            outcomes = client.gather(client.map(batch.run_job, [plan.folder] * len(plan), range(len(plan)), pure=False))
    assert [o.status for o in outcomes] == ["done"] * 4 and [o.job for o in outcomes] == [0, 1, 2, 3]
    by_dask = plan.merge()
    alone = batch.plan(hdris, tmp_path / "alone", SMALL)
    for i in range(len(alone)):
        batch.run_job(alone.folder, i)
    assert same(by_dask, alone.merge())
