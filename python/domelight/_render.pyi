"""The path tracer."""

from collections.abc import Callable
from typing import Any

from ._core import Environment

def render(
    scene: str, environment: Environment, options: dict[str, Any], progress: Callable[[str, float], Any] | None = None
) -> dict[str, Any]: ...
def built_in_scenes() -> list[str]: ...
