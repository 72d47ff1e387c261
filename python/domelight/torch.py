"""The filters as differentiable functions of PyTorch, for inverse rendering.

Each is linear in the environment, so its gradient is exact: the transpose of the filter (prefilter_transpose.h),
applied to the gradient of the maps. Second derivatives work too. Tensors on another device are copied to the CPU and the
results back.

>>> import torch, domelight.torch                                              # doctest: +SKIP
>>> environment = torch.rand(128, 256, 3, requires_grad=True)                  # doctest: +SKIP
>>> levels = domelight.torch.prefilter(environment, [0.25, 0.5, 1], 32)        # doctest: +SKIP
>>> sum(level.square().mean() for level in levels).backward()                  # doctest: +SKIP
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import torch

from . import _core
from ._errors import Error, a_or_an, from_library
from .conventions import CONVENTIONS, resolve

__all__ = ["irradiance", "prefilter", "spherical_harmonics"]


@dataclass(frozen=True)
class _Layout:
    """How an environment lies.

    Attributes
    ----------
    world_to_source
        From world directions to those of the default lat-long convention.
    rows_on_poles, columns_on_edges
        Whether the first and the last row (column) show the poles (the edges), and not the centres of texels there.
    """

    world_to_source: list[list[float]]
    rows_on_poles: bool
    columns_on_edges: bool


def _layout(convention: str) -> _Layout:
    projection, turned_deg = resolve(convention)
    name = projection.removeprefix("latlong/")
    known = _core.latlong_conventions()
    if name == "latlong":
        name = "default"
    if name not in known:
        accepted = ", ".join(dict.fromkeys([*known, *CONVENTIONS]))
        raise Error(f'"{convention}" is not a convention', "convention", f"Accepted: {accepted}.", "convention")
    matrix, rows_on_poles, columns_on_edges = known[name]
    sign = -1.0 if turned_deg == 180 else 1.0
    return _Layout([[sign * x, y, sign * z] for x, y, z in matrix], rows_on_poles, columns_on_edges)


def _between(length: int) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor]:
    """For texel centres: the samples before and after, at i / (length - 1), and the weight of the one after."""
    place = (torch.arange(length, dtype=torch.float64) + 0.5) / length * (length - 1)
    before = place.floor().clamp(max=max(length - 2, 0)).long()
    return before, (before + 1).clamp(max=length - 1), place - before


def _to_centres(environment: torch.Tensor, layout: _Layout) -> torch.Tensor:
    """The same light at texel centres, where the convention has its samples elsewhere."""
    for axis, elsewhere in ((0, layout.rows_on_poles), (1, layout.columns_on_edges)):
        if elsewhere:
            before, after, weight = (each.to(environment.device) for each in _between(environment.shape[axis]))
            weight = weight.to(environment.dtype).reshape(-1, *[1] * (2 - axis))
            environment = torch.lerp(
                environment.index_select(axis, before), environment.index_select(axis, after), weight
            )
    return environment


def _checked(environment: torch.Tensor) -> torch.Tensor:
    if not isinstance(environment, torch.Tensor):
        raise from_library(f"{a_or_an(type(environment).__name__)} is no torch.Tensor", "`environment`", "")
    if environment.ndim != 3 or environment.shape[2] != 3:
        shape = tuple(environment.shape)
        raise from_library(f"shape is {shape}, expected (height, width, 3)", "`environment`", "")
    if not environment.is_floating_point():
        raise from_library(f"dtype is {environment.dtype}, expected float32", "`environment`", "")
    return environment


def _numpy(tensor: torch.Tensor) -> np.ndarray[Any, Any]:
    array: np.ndarray[Any, Any] = tensor.detach().to("cpu", torch.float32).contiguous().numpy()
    return array


class _Filter(torch.autograd.Function):
    """environment, options -> maps, flattened."""

    @staticmethod
    def forward(ctx: Any, environment: torch.Tensor, options: dict[str, Any]) -> tuple[torch.Tensor, ...]:
        ctx.options, ctx.shape = options, environment.shape
        specular, irradiance, sh = _core.linear_filter(_numpy(environment), options)
        maps = [*specular, *([] if irradiance is None else [irradiance])]
        if sh:
            maps.append(np.array(sh))
        return tuple(torch.as_tensor(each).to(environment.device, environment.dtype) for each in maps)

    @staticmethod
    def backward(ctx: Any, *gradients: torch.Tensor) -> tuple[torch.Tensor, None]:
        return _Transpose.apply(ctx.shape, ctx.options, *gradients), None


class _Transpose(torch.autograd.Function):
    """The transpose of _Filter."""

    @staticmethod
    def forward(ctx: Any, shape: Sequence[int], options: dict[str, Any], *maps: torch.Tensor) -> torch.Tensor:
        ctx.options = options
        given: list[Any] = list(maps)
        sh = _numpy(given.pop()).astype(np.float64).tolist() if options.get("sh_bands") else []
        arrays = [_numpy(each) for each in given]
        if "directions" in options:
            arrays = [each[None] for each in arrays]
        irradiance = arrays.pop() if options.get("irradiance_size") else None
        result = _core.linear_transpose(shape[1], shape[0], (arrays, irradiance, sh), options)
        return torch.as_tensor(result).to(maps[0].device, maps[0].dtype)

    @staticmethod
    def backward(ctx: Any, gradient: torch.Tensor) -> tuple[Any, ...]:
        return None, None, *_Filter.apply(gradient, ctx.options)


def _run(environment: torch.Tensor, convention: str, options: dict[str, Any]) -> tuple[torch.Tensor, ...]:
    layout = _layout(convention)
    options = {key: value for key, value in options.items() if value is not None}
    centred = _to_centres(_checked(environment), layout)
    maps: tuple[torch.Tensor, ...] = _Filter.apply(centred, {**options, "world_to_source": layout.world_to_source})
    return maps


def prefilter(
    environment: torch.Tensor,
    roughness: Sequence[float] | None = None,
    size: int | Sequence[int] = 32,
    *,
    exponents: Sequence[float] | None = None,
    lobe: str = "ggx",
    layout: str = "cube",
    directions: Any = None,
    convention: str = "default",
    threads: int = 0,
) -> list[torch.Tensor]:
    """Filters an environment with a specular lobe; differentiable in the environment.

    Parameters
    ----------
    environment
        Radiance of shape (height, width, 3), a lat-long map of any sign.
    roughness
        Of each level, above 0 and at most 1.
    size
        Of each level, or one for all: of a cube's face, or the height of a lat-long map.
    exponents
        Of each level, with `lobe` "phong" or "phong-plain".
    lobe
        "ggx", "charlie", "phong", "phong-plain".
    layout
        "cube" or "latlong" (in the default convention).
    directions
        Instead of maps: world directions of shape (n, 3).
    convention
        How the environment lies: "default", "usd", "mitsuba", "openexr", "materialx", "mod", or that of a project:
        "nvdiffrec", "gaussianshader", "stanford-orb". Cubes have OpenGL's orientation in the same world: what nvdiffrast's
        ``texture(..., boundary_mode="cube")`` reads.

    Returns
    -------
    For each level a tensor of shape (6, size, size, 3), (size, 2 size, 3) or (n, 3).
    """
    widths = exponents if exponents is not None else roughness
    if widths is None:
        raise Error("is missing", "roughness", "", "roughness")
    sizes = [size] * len(widths) if isinstance(size, int) else list(size)
    if len(sizes) != len(widths):
        raise Error(f"{len(sizes)} sizes for {len(widths)} levels", "size", "", "size")
    options = {
        "lobe": lobe,
        "widths": [float(width) for width in widths],
        "sizes": sizes,
        "layout": layout,
        "directions": directions,
        "threads": threads,
    }
    return list(_run(environment, convention, options))


def irradiance(
    environment: torch.Tensor,
    size: int = 16,
    *,
    layout: str = "cube",
    over_pi: bool = False,
    directions: Any = None,
    convention: str = "default",
    threads: int = 0,
) -> torch.Tensor:
    """The cosine integral E over the hemisphere about each direction; differentiable in the environment.

    The parameters are those of `prefilter` and of `domelight.irradiance`. nvdiffrec's diffuse cube is E / π:
    ``over_pi=True``.

    Returns
    -------
    Shape (6, size, size, 3), (size, 2 size, 3) or (n, 3).
    """
    options = {"irradiance_size": size, "layout": layout, "directions": directions, "threads": threads}
    (result,) = _run(environment, convention, options)
    return result if over_pi else result * math.pi


def spherical_harmonics(
    environment: torch.Tensor,
    sh_bands: int = 3,
    *,
    irradiance: bool = False,
    convention: str = "default",
    threads: int = 0,
) -> torch.Tensor:
    """Spherical-harmonic coefficients of the radiance; differentiable in the environment.

    The basis is that of `domelight.spherical_harmonics`. With `irradiance`, the coefficients of E.

    Returns
    -------
    Shape (sh_bands ** 2, 3).
    """
    (result,) = _run(environment, convention, {"sh_bands": sh_bands, "threads": threads})
    if not irradiance:
        return result
    factors = torch.tensor([_cosine_factor(l) for l in range(sh_bands) for _ in range(2 * l + 1)])
    return result * factors.to(result)[:, None]


def _cosine_factor(l: int) -> float:
    """A_l of Ramamoorthi and Hanrahan 2001, eq. 8."""
    if l == 1:
        return 2 * math.pi / 3
    if l % 2:
        return 0
    sign = -1 if l // 2 % 2 == 0 else 1
    return 2 * math.pi * sign / ((l + 2) * (l - 1)) * math.factorial(l) / (2**l * math.factorial(l // 2) ** 2)
