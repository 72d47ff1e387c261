"""Differences of pictures, and audits of bakes."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from . import _core
from ._converting import read_levels
from ._environment import ArrayLike, EnvironmentLike, FloatArray, PathLike, light_of
from ._filtering import Levels
from ._progress import Progress, reporting


class Comparison:
    """The difference of a picture from a reference, in figures and maps.

    ``comparison["rmse"]`` and the like: "rmse", "relative" (RMS over that of the reference), "tone-mapped" (of
    L / (1 + L)), "largest", "psnr", "ssim", "flip", "hdr-flip", "mean" (|ratio of the means - 1|), "mean-ratio"; with
    variances also "above-2", "chi2" and "total-z".
    """

    def __init__(self, comparison: _core.Comparison) -> None:
        self._comparison = comparison
        self.figures: dict[str, float] = comparison.figures()

    def __getitem__(self, name: str) -> float:
        return self.figures[name]

    def map(self, name: str = "auto") -> FloatArray:
        """A difference for each pixel: "hdr-flip", "flip", "difference" (signed), "tone-mapped", "relative", "ssim", "z",
        or "auto".

        Returns
        -------
        float32 of shape (height, width).
        """
        return self._comparison.map(name)

    def _repr_png_(self) -> bytes:
        return self._comparison.sheet()

    def __repr__(self) -> str:
        return "<domelight.Comparison " + ", ".join(f"{k} {v:.4g}" for k, v in self.figures.items()) + ">"


def _picture(source: ArrayLike | PathLike) -> Any:
    return os.fspath(source) if isinstance(source, os.PathLike) else source


def compare(
    test: ArrayLike | PathLike,
    reference: ArrayLike | PathLike,
    *,
    mask: ArrayLike | None = None,
    flip: bool = True,
    pixels_per_degree: float = 67.0206,
    view_exposure: float | None = None,
    test_variance: ArrayLike | None = None,
    reference_variance: ArrayLike | None = None,
    skip_bad: bool = False,
    layer: str | None = None,
    level: int = 0,
    threads: int = 0,
    progress: Progress = None,
) -> Comparison:
    """Compares two pictures.

    Parameters
    ----------
    test, reference
        Arrays of float32 of shape (height, width, 3), linear radiance; uint8, which is decoded from sRGB; or names of
        files.
    mask
        (height, width), above 0 where a pixel counts.
    flip
        Also FLIP and, of radiance, HDR-FLIP, which take most of the time.
    pixels_per_degree
        FLIP: of the viewer's field of view.
    view_exposure
        Stops for FLIP; None: from the reference.
    test_variance, reference_variance
        Of the pixels' values (squared standard errors), same shape: says whether noise explains the difference.
    skip_bad
        Leaves out NaN and infinite pixels, which are an error otherwise.
    layer, level
        Of files: the OpenEXR layer, the texture's level.
    """
    options = {
        "mask": mask,
        "flip": flip,
        "pixels_per_degree": pixels_per_degree,
        "view_exposure": view_exposure,
        "test_variance": test_variance,
        "reference_variance": reference_variance,
        "skip_bad": skip_bad,
        "layer": layer,
        "level": level,
        "threads": threads,
    }
    with reporting(progress) as tell:
        return Comparison(_core.compare(_picture(test), _picture(reference), options, tell))


def flip(
    test: ArrayLike | PathLike,
    reference: ArrayLike | PathLike,
    *,
    hdr: bool = True,
    pixels_per_degree: float = 67.0206,
    threads: int = 0,
) -> FloatArray:
    """FLIP: the perceived difference of each pixel (Andersson et al. 2020 and 2021). Its mean is the usual figure.

    Parameters
    ----------
    test, reference
        float32 of shape (height, width, 3). With `hdr` linear radiance; else sRGB-encoded, 0 to 1.
    hdr
        HDR-FLIP: the largest error over the exposures that the reference asks for.

    Returns
    -------
    float32 of shape (height, width), 0 to 1.
    """
    options = {"hdr": hdr, "pixels_per_degree": pixels_per_degree, "threads": threads}
    return _core.flip(_picture(test), _picture(reference), options)


@dataclass(frozen=True)
class LevelAudit:
    """What an audit found of a level: docs of `BakeAudit` in the C++ library have each field."""

    size: int
    roughness: float | None
    exponent: float | None
    roughness_within: float
    scale: float
    energy: float
    error: float
    relative_rmse: float
    largest: float
    stated_roughness: float | None
    stated_error: float
    stated_relative_rmse: float


@dataclass(frozen=True)
class Audit:
    """Whether a chain is a bake of an environment, how it lies, and how good it is.

    Attributes
    ----------
    verdict
        In words.
    orientation
        Of the cube, in words: "as ours", "mirrored in x", ...
    ours_from_theirs
        The same as a 3 x 3 matrix: texture(theirs, d) = texture(ours, M d).
    of_source
        Whether it is a bake of this environment.
    levels
        Roughness, scale and error of each level.
    """

    verdict: str
    orientation: str
    orientation_certain: bool
    ours_from_theirs: tuple[tuple[float, float, float], ...]
    of_source: bool
    within: bool
    levels: list[LevelAudit]
    notes: list[str]


def audit(
    levels: Levels | Sequence[ArrayLike] | PathLike,
    environment: EnvironmentLike,
    *,
    roughness: Sequence[float] | None = None,
    exponents: Sequence[float] | None = None,
    lobe: str | None = None,
    texels: str | None = None,
    within: float | None = None,
    threads: int = 0,
    progress: Progress = None,
) -> Audit:
    """Compares a specular cube that any tool baked with the exact filter of its source.

    Parameters
    ----------
    levels
        Cubes of shape (6, size, size, 3), the sharpest first; or the name of a texture's file.
    environment
        What they were baked from.
    roughness, exponents
        That the levels are meant to have; None: unknown, or those of `Levels`.
    lobe, texels
        "ggx", ...; "centre" or "read".
    within
        The largest error that passes.
    """
    if isinstance(levels, (str, os.PathLike)):
        levels = read_levels(levels)
    if isinstance(levels, Levels):
        phong = levels.lobe.startswith("phong")
        lobe, texels = lobe or levels.lobe, texels or levels.texels
        if roughness is None and exponents is None:
            roughness, exponents = (None, levels.exponents) if phong else (levels.roughness, None)
    options = {
        "roughness": roughness,
        "exponents": exponents,
        "lobe": lobe,
        "texels": texels,
        "within": within,
        "threads": threads,
    }
    with light_of(environment) as light, reporting(progress) as tell:
        told = _core.audit(list(levels), light, options, tell)
    told["levels"] = [LevelAudit(**level) for level in told["levels"]]
    return Audit(**told)
