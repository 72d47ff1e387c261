"""Progress callbacks."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Protocol, runtime_checkable

#: ``progress(stage, done)``: the name of a stage and the part of it that is done, 0 to 1. Returning False cancels.
ProgressCallback = Callable[[str, float], Any]


@runtime_checkable
class ProgressBar(Protocol):
    """What is used of a tqdm bar."""

    n: float
    total: float | None

    def set_description(self, desc: str, refresh: bool = ...) -> Any: ...
    def refresh(self) -> Any: ...


Progress = ProgressCallback | ProgressBar | bool | None


def _on_bar(bar: ProgressBar) -> ProgressCallback:
    if bar.total is None:
        bar.total = 1

    def show(stage: str, done: float) -> None:
        bar.set_description(stage, refresh=False)
        bar.n = round(done * (bar.total or 1), 3)
        bar.refresh()

    return show


class _Line:
    """A line of text in place of a tqdm bar, where tqdm is not installed."""

    def __init__(self) -> None:
        self.n: float = 0
        self.total: float | None = 1
        self._stage = ""

    def set_description(self, desc: str, refresh: bool = True) -> None:
        self._stage = desc
        if refresh:
            self.refresh()

    def refresh(self) -> None:
        print(f"\r{self._stage:<8} {100 * self.n:3.0f} %", end="", file=sys.stderr, flush=True)

    def close(self) -> None:
        self.refresh()
        print(file=sys.stderr, flush=True)


def _new_bar() -> Any:
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return _Line()
    return tqdm(total=1, bar_format="{desc} {percentage:3.0f}%|{bar}| {elapsed}")


@contextmanager
def reporting(progress: Progress) -> Iterator[ProgressCallback | None]:
    """A callback from what users pass: a function, a tqdm bar, or True for a new bar, which is full where the work is done,
    and closed in any case."""
    if progress is None or progress is False:
        yield None
    elif progress is True:
        bar = _new_bar()
        try:
            yield _on_bar(bar)
            bar.n = 1
        finally:
            bar.close()
    elif isinstance(progress, ProgressBar):
        yield _on_bar(progress)
    else:
        if not callable(progress):
            from ._errors import wrong_type

            wrong_type("progress", progress, "a function of (stage, done), a tqdm bar or True")
        yield progress
