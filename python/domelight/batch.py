"""Batches: a plan of jobs, made by `plan` or by ``domelight batch plan``, for any scheduler of Python.

    from dask.distributed import Client
    from domelight import batch

    plan = batch.plan("hdris", "lights", {"for": ["three", "babylon"]})
    client = Client("scheduler:8786")
    outcomes = client.gather(client.map(batch.run_job, [plan.folder] * len(plan), range(len(plan)), pure=False))
    print([outcome for outcome in outcomes if not outcome.done])
    plan.merge()

`run_job` takes and returns plain values, so that Ray and submitit call it in the same way. The folder must lie on a file
system that the workers share. docs/batch.md says what is in it.
"""

from __future__ import annotations

import functools
import json
import os
import warnings
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from . import _batch
from ._environment import DomelightWarning, PathLike
from ._errors import Error, _with_keywords
from ._progress import Progress, reporting

__all__ = ["Job", "Outcome", "Plan", "open_plan", "plan", "run_job"]


class Job(NamedTuple):
    """One job of a plan."""

    id: str  #: of the result, by all that decides its bytes
    kind: str  #: "bake", "convert", ...
    output: str  #: its name below the folder `out`
    options: dict[str, Any]
    inputs: list[tuple[str, str, str]]  #: role, file and SHA-256 of each
    seconds: float  #: estimated CPU time
    memory: int  #: estimated bytes


class Outcome(NamedTuple):
    """What became of a job."""

    job: int  #: its index in the plan
    output: str
    status: str  #: "done", "kept" (it was done before) or "failed"
    reason: str  #: why it failed
    seconds: float

    @property
    def done(self) -> bool:
        """Whether the result is there."""
        return self.status != "failed"


class Plan(Sequence[Job]):
    """The jobs of a batch, in the order of plan.jsonl.

    Attributes
    ----------
    folder : pathlib.Path
        Where the plan lies, and the results: absolute.
    """

    def __init__(self, folder: PathLike, plan: _batch.Plan) -> None:
        self.folder = Path(folder).absolute()
        self._plan = plan

    def __len__(self) -> int:
        return self._plan.count

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        told = self._plan.job(range(len(self))[index])
        return Job(**{**told, "options": json.loads(told["options"])})

    def __iter__(self) -> Iterator[Job]:
        return (self[i] for i in range(len(self)))

    def shards(self, count: int) -> list[list[int]]:
        """Indices of the jobs of each of `count` shards, which are about equal in estimated cost; the longest job of each
        comes first. The shards of ``domelight batch run --shard``."""
        if count < 1:
            raise Error(f"{count} is less than 1", "count", "", "count")
        return self._plan.shards(count)

    def merge(self, place: str = "link", *, progress: Progress = None) -> Path:
        """Puts the results under the names of their outputs, in the folder `out`, and returns that. `place`: "link", "hardlink"
        or "copy". Raises Error, which names the outputs, where any is missing."""
        with reporting(progress) as tell:
            missing, notes = _batch.merge(self._plan, self.folder, place, tell)
        for note in notes:
            warnings.warn(note, DomelightWarning, stacklevel=2)
        if missing:
            names = ", ".join(output for output, _ in missing[:10])
            more = f" and {len(missing) - 10} more" if len(missing) > 10 else ""
            raise Error(f"{len(missing)} of {len(self)} outputs are missing: {names}{more}", "", "Run their jobs again.")
        return self.folder / "out"

    def verify(self, *, threads: int = 0, progress: Progress = None) -> list[tuple[str, str]]:
        """Hashes every file of every result. Returns (output, what is wrong) of each problem."""
        with reporting(progress) as tell:
            return _batch.verify(self._plan, self.folder, threads, tell)

    def report(self, *, threads: int = 0, progress: Progress = None) -> Path:
        """Writes a page with a picture, the times, size, errors and repairs of each job, and returns its file."""
        with reporting(progress) as tell:
            return _batch.report(self._plan, self.folder, threads, tell)

    def __reduce__(self) -> tuple[Any, tuple[str]]:
        return open_plan, (str(self.folder),)

    def __repr__(self) -> str:
        return f"<domelight.batch.Plan of {len(self)} jobs: {self.folder}>"


def plan(
    source: PathLike,
    folder: PathLike,
    options: Mapping[str, Any] | None = None,
    *,
    kind: str = "bake",
    threads: int = 0,
    progress: Progress = None,
) -> Plan:
    """Plans a batch, and writes the plan to `folder`: the same bytes as ``domelight batch plan source -o folder``.

    Parameters
    ----------
    source
        A folder of environments, or a manifest: a .jsonl or .json file.
    options
        Options of every job, as in a manifest: ``{"for": ["three"], "size": 128}``.
    kind
        What is done to each environment of a folder.

    Raises
    ------
    Error
        An option, key or output that is wrong, which the message names.
    FileError
        An input that is missing.
    """
    words = [(name, json.dumps(value)) for name, value in (options or {}).items()]
    with reporting(progress) as tell:
        made = _batch.make_plan(os.fspath(source), os.fspath(folder), kind, words, threads, tell)
    for line in made.warnings:
        warnings.warn(_with_keywords(line), DomelightWarning, stacklevel=2)
    return Plan(folder, made)


def open_plan(folder: PathLike) -> Plan:
    """The plan that lies in a folder."""
    return Plan(folder, _batch.open_plan(os.fspath(folder)))


@functools.lru_cache(maxsize=4)
def _opened(folder: str, _changed: int) -> Plan:
    return open_plan(folder)


def run_job(folder: PathLike, job: int, threads: int = 1) -> Outcome:
    """Does job number `job` of the plan in `folder`, in this process, unless its result is there. An error of the job is in
    the outcome, not raised, so that a scheduler goes on with the others.

    Raises
    ------
    Error
        There is no plan, or no such job.
    """
    name = os.path.abspath(os.fspath(folder))
    file = os.path.join(name, "plan.jsonl")
    plan = _opened(name, os.stat(file).st_mtime_ns if os.path.exists(file) else 0)
    if not 0 <= job < len(plan):
        raise Error(f"{job} is not a job of a plan of {len(plan)}", "job", "", "job")
    output: str = plan[job].output
    try:
        told = _batch.run_job(plan._plan, name, job, threads)
    except Error as error:
        return Outcome(job, output, "failed", str(error), 0.0)
    return Outcome(job, output, told["status"], "", told["seconds"])
