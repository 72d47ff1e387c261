"""The exact filters."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, overload

import numpy as np
import numpy.typing as npt

from . import _core
from ._environment import ArrayLike, EnvironmentLike, FloatArray, light_of
from ._progress import Progress, reporting


class Levels(Sequence[FloatArray]):
    """A filtered chain: a sequence of arrays, the sharpest first.

    Each level of a cube has the shape (6, size, size, 3): faces +X -X +Y -Y +Z -Z in OpenGL's orientation. Each level of
    a lat-long chain has the shape (height, 2 height, 3), in the default convention. In single directions: (n, 3).

    Attributes
    ----------
    roughness, exponents : list of float
        Of each level: glTF's perceptual roughness (GGX and Charlie), or the Phong exponent.
    mirror : list of bool
        Whether a level is the environment itself.
    lobe, layout, texels : str
        As they were asked for; the layout "directions" where single directions were.
    mean : tuple of float
        Mean radiance over the sphere.
    """

    def __init__(self, result: dict[str, Any]) -> None:
        self._maps: list[FloatArray] = result["maps"]
        self.roughness: list[float] = result["roughness"]
        self.exponents: list[float] = result["exponents"]
        self.mirror: list[bool] = result["mirror"]
        self.lobe: str = result["lobe"]
        self.layout: str = result["layout"]
        self.texels: str = result["texels"]
        self.mean: tuple[float, float, float] = result["mean"]

    @overload
    def __getitem__(self, index: int) -> FloatArray: ...
    @overload
    def __getitem__(self, index: slice) -> list[FloatArray]: ...
    def __getitem__(self, index: int | slice) -> FloatArray | list[FloatArray]:
        return self._maps[index]

    def __len__(self) -> int:
        return len(self._maps)

    def __iter__(self) -> Iterator[FloatArray]:
        return iter(self._maps)

    def _repr_png_(self) -> bytes | None:
        if self.layout == "directions":
            return None
        words = {"roughness": self.roughness, "exponents": self.exponents, "title": "domelight.prefilter"}
        return _core.levels_picture(self._maps, {**words, "subtitle": f"{self.lobe} · {self.layout}"})

    def __repr__(self) -> str:
        sizes = ", ".join(str(level.shape[-3 if level.ndim > 2 else 0]) for level in self._maps)
        return f"<domelight.Levels {self.lobe}, {self.layout}: {sizes}>"


def prefilter(
    environment: EnvironmentLike,
    *,
    size: int | None = None,
    levels: int | None = None,
    roughness: Sequence[float] | None = None,
    lobe: str | None = None,
    exponents: Sequence[float] | None = None,
    layout: str | None = None,
    texels: str | None = None,
    directions: ArrayLike | None = None,
    threads: int = 0,
    progress: Progress = None,
) -> Levels:
    """Filters an environment with a specular lobe, exactly: the texels that ``domelight bake`` computes with the same
    words for the generic engine.

    Parameters
    ----------
    environment
        An `Environment`, an array (see there), or the name of a file.
    size
        Face size of level 0, or height of a lat-long level 0; 1 to 16384 (512, lat-long 1024).
    levels
        Each half as large as the one before.
    roughness
        Of each level, 0 to 1; 0 is the environment itself. By default 0 and then 0.6 ** (levels - 1 - level).
    lobe
        "ggx", "charlie" (sheen), "phong" or "phong-plain".
    exponents
        Phong: of each level; ``math.inf`` is the environment itself.
    layout
        "cube" or "latlong".
    texels
        "read" (of cubes the default): values whose interpolation between texels is nearest to the filtered light, for
        shaders; "centre": the filtered light in the direction of each texel's centre, for comparisons.
    directions
        Instead of maps: the filtered light in these world directions, shape (n, 3), of any length but 0.
    threads
        0: all cores. The bytes do not depend on it.
    progress
        A function of (stage, done), a tqdm bar, or True.

    Returns
    -------
    `Levels`; with `directions`, each level has the shape (n, 3).
    """
    options = {
        "size": size,
        "levels": levels,
        "roughness": roughness,
        "lobe": lobe,
        "exponents": exponents,
        "layout": layout,
        "texels": texels,
        "directions": directions,
        "threads": threads,
    }
    with light_of(environment) as light, reporting(progress) as tell:
        return Levels(_core.prefilter(light, options, tell))


def irradiance(
    environment: EnvironmentLike,
    *,
    size: int = 64,
    layout: str = "cube",
    over_pi: bool = False,
    directions: ArrayLike | None = None,
    threads: int = 0,
    progress: Progress = None,
) -> FloatArray:
    """The cosine integral E over the hemisphere about each direction.

    Parameters
    ----------
    size
        Face size, or height of a lat-long map, 1 to 4096.
    layout
        "cube" or "latlong".
    over_pi
        E / π, the radiance of a white diffuse surface, instead of E.
    directions
        Instead of a map: E on surfaces with these normals, shape (n, 3).

    Returns
    -------
    float32 of shape (6, size, size, 3), (size, 2 size, 3) or (n, 3). Under constant radiance 1, E is π.
    """
    options = {
        "size": size,
        "layout": layout,
        "over_pi": over_pi,
        "directions": directions,
        "threads": threads,
    }
    with light_of(environment) as light, reporting(progress) as tell:
        return _core.irradiance(light, options, tell)


def spherical_harmonics(
    environment: EnvironmentLike,
    sh_bands: int = 3,
    *,
    sh_window: str = "none",
    irradiance: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> npt.NDArray[np.float64]:
    """Spherical-harmonic coefficients of the radiance, exact for the bilinear image.

    The basis is real and orthonormal without the Condon–Shortley sign, in world space with the polar axis +Z, in the
    order l² + l + m: Y₁ = √(3/4π) (y, z, x). docs/conventions.md lists the polynomials.

    Parameters
    ----------
    sh_bands
        1 to 64.
    sh_window
        Against ringing: "none", "hann" or "lanczos".
    irradiance
        The coefficients of the irradiance E instead.

    Returns
    -------
    float64 of shape (sh_bands ** 2, 3).
    """
    options = {"sh_bands": sh_bands, "sh_window": sh_window, "irradiance": irradiance, "threads": threads}
    with light_of(environment) as light, reporting(progress) as tell:
        return _core.spherical_harmonics(light, options, tell)


def brdf_table(
    size: int = 128,
    *,
    g: str = "correlated",
    form: str = "scale-bias",
    method: str = "exact",
    samples: int = 1024,
    sequence: str = "hammersley",
    seed: int = 0,
    threads: int = 0,
) -> FloatArray:
    """The split sum's BRDF table: ``table[row, column]`` with the column at NdotV and the row at roughness, both at
    texel centres (i + ½) / size; row 0 is the smoothest.

    Parameters
    ----------
    size
        1 to 4096.
    g
        The masking function: "correlated", "smith" or "karis".
    form
        "scale-bias": specular reflectance is F0 scale + bias; "multiscatter": (bias, scale + bias); "scale-bias-charlie":
        the albedo of sheen as a third channel.
    method
        "exact" (quadrature, to 1e-5) or "montecarlo", with `samples`, `sequence` and `seed`.

    Returns
    -------
    float32 of shape (size, size, 2 or 3).
    """
    options = {
        "size": size,
        "g": g,
        "form": form,
        "method": method,
        "samples": samples,
        "sequence": sequence,
        "seed": seed,
        "threads": threads,
    }
    return _core.brdf_table(options)
