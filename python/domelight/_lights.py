"""The sun and other small bright sources of an environment."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._environment import Environment, EnvironmentLike, light_of

Vector = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Light:
    """A directional or disc light.

    Attributes
    ----------
    direction
        Towards the light, in the world, of unit length.
    angular_diameter_deg
        Of a uniform disc; an upper bound, the width of a texel, where the source is not `resolved`.
    irradiance
        RGB on a surface that faces the light: radiance times steradian.
    mean_radiance
        RGB of the disc.
    colour
        Irradiance over its largest channel: linear Rec. 709, 0 to 1.
    share
        Of the environment's luminance, 0 to 1.
    contrast
        Peak luminance over the highest along the rim.
    texels
        How many it was taken from.
    """

    direction: Vector
    angular_diameter_deg: float
    resolved: bool
    irradiance: Vector
    mean_radiance: Vector
    colour: Vector
    share: float
    contrast: float
    texels: int


def _light(told: dict[str, Any]) -> Light:
    values: dict[str, Any] = {key: np.array(v) if isinstance(v, tuple) else v for key, v in told.items()}
    return Light(**values)


class Lights(Sequence[Light]):
    """The lights of an environment, the strongest first.

    Attributes
    ----------
    remainder : Environment
        The environment without them.
    unaccounted : float
        Power that is in neither or in both, relative: rounding.
    left_out : int
        Lights that stayed in the remainder because of their share or their number.
    """

    def __init__(self, told: dict[str, Any]) -> None:
        self._lights = [_light(light) for light in told["lights"]]
        self.remainder = Environment._wrap(told["remainder"])
        self.unaccounted: float = told["unaccounted"]
        self.left_out: int = told["left_out"]

    def __getitem__(self, index: Any) -> Any:
        return self._lights[index]

    def __len__(self) -> int:
        return len(self._lights)

    def __repr__(self) -> str:
        return f"<domelight.Lights: {self._lights!r}>"


def lights(
    environment: EnvironmentLike,
    *,
    max_lights: int = 8,
    least_share: float = 0.01,
    least_contrast: float = 4,
    largest_diameter_deg: float = 6,
    merge_deg: float = 1.5,
    threads: int = 0,
) -> Lights:
    """Splits an environment into small bright sources and the rest. No light is lost or counted twice.

    Parameters
    ----------
    max_lights
        0 to 1024; weaker ones stay in the remainder.
    least_share
        Of all luminance that a light must have, 0 to 1.
    least_contrast
        Peak luminance over that around it, 1.5 to 1e6.
    largest_diameter_deg
        Of a source that may become a light, 0.001 to 30.
    merge_deg
        Sources closer than this are one light, 0 to 30.
    """
    options = {
        "max_lights": max_lights,
        "least_share": least_share,
        "least_contrast": least_contrast,
        "largest_diameter_deg": largest_diameter_deg,
        "merge_deg": merge_deg,
        "threads": threads,
    }
    with light_of(environment) as light:
        return Lights(_core.lights(light, options))
