"""Projections, and files."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core, conventions
from ._environment import ArrayLike, Environment, EnvironmentLike, FloatArray, PathLike, light_of
from ._errors import Error
from ._filtering import Levels
from ._progress import Progress, reporting

_TEXTURES = (".ktx2", ".ktx", ".dds")


def convert(
    environment: EnvironmentLike,
    to: str = "latlong",
    *,
    size: int | None = None,
    sharp: bool = False,
    turn: ArrayLike | None = None,
    threads: int = 0,
    progress: Progress = None,
) -> FloatArray:
    """The environment in another projection or convention. Light is kept: texels are averaged by solid angle.

    Parameters
    ----------
    to
        "latlong", "cube", "mirror-ball", "sphere-map", "angular", "octahedral", "equal-area-octahedral", "paraboloid",
        "dual-paraboloid", "hemisphere", each with its convention: "latlong/usd", "cube/openexr",
        "latlong/centre=+Z,right=-X"; or one of `domelight.conventions`: "nvdiffrec", "stanford-orb", ...
    size
        Height in texels, of a cube's face where there are faces; 1 to 32768. None: as fine as the source.
    sharp
        From lat-long to cube or lat-long: keeps more of the finest detail, and takes ten times as long.
    turn
        A 3 x 3 orthogonal matrix M: what came from direction d then comes from M d. It may mirror.

    Returns
    -------
    float32 of shape (height, width, 3); (6, size, size, 3) of a cube; (2, size, size, 3) of a dual paraboloid.
    """
    name, turned_deg = conventions.resolve(to)
    matrix = _matrix(turn)
    if turned_deg == 180:  # the picture of the light turned by half a turn about +Y
        matrix = np.diag([-1.0, 1.0, -1.0]) @ matrix
    options = {"size": size, "sharp": sharp, "turn": matrix.tolist(), "threads": threads}
    with light_of(environment) as light, reporting(progress) as tell:
        array: FloatArray = _core.convert(light, name, options, tell)["array"]
    return array


def _matrix(turn: ArrayLike | None) -> npt.NDArray[np.float64]:
    if turn is None:
        return np.eye(3)
    matrix = np.asarray(turn, np.float64)
    if matrix.shape != (3, 3) or not np.allclose(matrix @ matrix.T, np.eye(3), atol=1e-6):
        raise Error("expected an orthogonal 3 x 3 matrix", "turn", "", "turn")
    return matrix


def write(
    file: PathLike,
    image: EnvironmentLike | Levels | Sequence[ArrayLike],
    *,
    half: bool | None = None,
    compression: str = "zip",
    encoding: str = "rgba16f",
    encoding_quality: str = "default",
    zstd: bool = False,
    tonemap: str = "agx",
    ev: float | None = None,
    threads: int = 0,
) -> None:
    """Writes an image, an environment or a chain of levels, in the format that the file's name ends in. The file appears
    whole or not at all.

    Parameters
    ----------
    file
        .hdr or .exr (radiance), .png or .jpg (tone mapped, or bytes as they are), .ktx2, .ktx or .dds (a texture).
    image
        An `Environment` (as a lat-long map in the default convention); `Levels` or a sequence of arrays, each half as
        large as the one before (a texture); an array of shape (height, width, 3), of .exr also with 1 to 4 channels; one
        of shape (6, size, size, 3), the faces of a cube (in .hdr, .exr, .png and .jpg one below the other).
    half, compression
        .exr: half floats (None: where they hold every value), and "zip", "piz", "dwaa", "none", ...
    encoding, encoding_quality, zstd
        Textures: "rgba16f", "rgba32f", "rgb9e5", "r11g11b10f", "bc6h", ...; the effort of block encodings; .ktx2:
        compressed without loss.
    tonemap, ev
        .png and .jpg: "agx", "neutral", "aces", "reinhard", "gamma22" or "none"; exposure in stops (None: automatic).
    """
    name = os.fspath(file)
    texture = name.lower().endswith(_TEXTURES)
    if texture:
        options = {"encoding": encoding, "encoding_quality": encoding_quality, "zstd": zstd, "threads": threads}
        _core.write_texture(name, _levels(image), {**options, "metadata": _metadata(image)})
        return
    if isinstance(image, (Levels, list, tuple)):
        raise Error("a chain of levels goes into .ktx2, .ktx or .dds", "file", "Write its levels one by one.", "file")
    _core.write_image(
        name,
        _strip(image.latlong(threads=threads) if isinstance(image, Environment) else image),
        {"half": half, "compression": compression, "tonemap": tonemap, "ev": ev, "threads": threads},
    )


def _strip(image: Any) -> Any:
    """The faces of a cube one below the other; any other array as it is."""
    shape = np.shape(image)
    return image.reshape(6 * shape[1], shape[2], shape[3]) if len(shape) == 4 and shape[0] == 6 else image


def _levels(image: Any) -> list[Any]:
    if isinstance(image, Environment):
        return [image.latlong()]
    if isinstance(image, (Levels, list, tuple)):
        return list(image)
    return [image]


def _metadata(image: Any) -> dict[str, str]:
    """The keys that `domelight bake` writes, by which others recognise the chain."""
    if not isinstance(image, Levels):
        return {}
    keys = {"domelight.lobe": image.lobe, "domelight.texels": image.texels}
    if image.lobe.startswith("phong"):
        keys["domelight.exponent"] = " ".join(f"{value:.9g}" for value in image.exponents)
    else:
        keys["domelight.roughness"] = " ".join(f"{value:.9g}" for value in image.roughness)
    return keys


def read_levels(file: PathLike) -> Levels:
    """Reads the levels of a texture (.ktx2, .ktx, .dds): of a cube, or of a lat-long map in the file's convention.

    Roughness or exponents, lobe and kind of texels are those that the file states, as `bake` and `write` write them; the
    lists are empty where it does not.
    """
    told = _core.read_levels(os.fspath(file))
    keys: dict[str, str] = told.pop("metadata")
    lobe = keys.get("domelight.lobe", "ggx")
    numbers = {name: _numbers(keys.get(f"domelight.{name}", "")) for name in ("roughness", "exponent")}
    widths = numbers["exponent"] if lobe.startswith("phong") else numbers["roughness"]
    sharp = math.inf if lobe.startswith("phong") else 0
    return Levels(
        {
            **told,
            "roughness": numbers["roughness"],
            "exponents": numbers["exponent"],
            "mirror": [width == sharp for width in widths],
            "lobe": lobe,
            "texels": keys.get("domelight.texels", "centre"),
            "mean": (math.nan,) * 3,
        }
    )


def _numbers(text: str) -> list[float]:
    return [float(word) for word in text.replace(",", " ").split()]
