"""Environments: the light that arrives from every direction."""

from __future__ import annotations

import contextlib
import os
import warnings
from collections.abc import Iterator, Sequence
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from . import _core, conventions
from ._errors import IN_MEMORY

#: An array of numbers: of NumPy, PyTorch, JAX, Dr.Jit, or anything else with a buffer or with ``__dlpack__``.
ArrayLike = Any
FloatArray = npt.NDArray[np.float32]
PathLike = Union[str, "os.PathLike[str]"]


class DomelightWarning(UserWarning):
    """Something that was repaired or assumed when a file was read."""


class Environment:
    """The light that arrives from every direction, from a file (`read`), an array, or the built-in sky (`sky`).

    Parameters
    ----------
    array
        float32 of shape (height, width, 3), radiance in linear Rec. 709, finite and not negative; or (6, size, size, 3)
        for the faces +X -X +Y -Y +Z -Z of a cube. It is borrowed without a copy where it is a lat-long map: do not
        change it while the environment is in use. float16 and float64 are converted row by row.
    projection
        "auto" (by the shape: lat-long or cube), "latlong", "latlong/usd", "cube", "mirror-ball", "octahedral", ... with
        its convention, as `domelight convert --to` takes it; or one of `domelight.conventions`: "nvdiffrec",
        "gaussianshader", "stanford-orb", "mitsuba".
    rotate_y_deg
        Turns the light about +Y: +X moves towards +Z.

    ``numpy.asarray(environment)`` is the light as a lat-long map in the default convention (docs/conventions.md): the
    centre of the picture shows +X, to the right of it lies +Z, and +Y is at the top.

    >>> import numpy, domelight as dl
    >>> dl.Environment(numpy.ones((64, 128, 3), numpy.float32)).shape
    (64, 128, 3)
    """

    __slots__ = ("_environment", "_latlong", "_reading", "_told")

    def __init__(
        self, array: ArrayLike, projection: str = "auto", *, rotate_y_deg: float = 0, threads: int = 0
    ) -> None:
        name, turn = conventions.resolve(projection)
        words = {"projection": name, "rotate_y_deg": rotate_y_deg + turn, "threads": threads}
        self._environment = _core.environment_from_array(array, words, "array")
        self._latlong: FloatArray | None = None
        self._reading: dict[str, Any] = {}
        self._told: list[str] = []

    @classmethod
    def _wrap(cls, environment: _core.Environment, reading: dict[str, Any] | None = None) -> Environment:
        wrapped = cls.__new__(cls)
        wrapped._environment = environment
        wrapped._latlong = None
        wrapped._reading = reading or {}
        wrapped._told = []
        return wrapped

    def _tell(self, level: int) -> None:
        """Warns of what has been repaired in the file since the last time. A lat-long file is read row by row, and only
        where its light is asked for."""
        from ._errors import _with_keywords

        for line in self._environment.report()["lines"]:
            if line not in self._told:
                self._told.append(line)
                warnings.warn(_with_keywords(line), DomelightWarning, stacklevel=level)

    @property
    def file(self) -> str:
        """The first of its files; "" where it was made in memory."""
        file = str(self._environment.file)
        return "" if file == "." else file

    @property
    def format(self) -> str:
        """ "Radiance HDR", "OpenEXR", "array", "sky", ..."""
        return self._environment.format

    @property
    def projection(self) -> str:
        """ "latlong", "cube", or the name of another projection."""
        return self._environment.projection

    @property
    def convention(self) -> str:
        """The convention of a lat-long file: "default", "usd", ..."""
        return self._environment.convention

    @property
    def width(self) -> int:
        """Texels of the image as it is stored."""
        return self._environment.width

    @property
    def height(self) -> int:
        """Texels of the image as it is stored."""
        return self._environment.height

    @property
    def shape(self) -> tuple[int, int, int]:
        """The shape of `latlong()`: (height, width, 3)."""
        height = self._environment.latlong_height
        return (height, self._environment.width if self._environment.is_default else 2 * height, 3)

    @property
    def report(self) -> dict[str, Any]:
        """What was repaired in the file: counts of texels, the light that this added, and ``lines`` of text. The counts
        are complete once the image has been read."""
        return self._environment.report()

    def latlong(self, height: int | None = None, *, threads: int = 0) -> FloatArray:
        """The light as a lat-long map in the default convention.

        Parameters
        ----------
        height
            Rows; None: as fine as the source. Light is averaged over the texels, so none is lost.

        Returns
        -------
        float32 of shape (height, 2 height, 3), radiance. Read-only and without a copy where the environment is stored
        like this; else computed once.
        """
        if height is None:
            if self._latlong is None:
                environment = self._environment
                self._latlong = (
                    environment.source_latlong()
                    if environment.is_default
                    else environment.world_latlong(environment.latlong_height, threads)
                )
                self._tell(3)
            return self._latlong
        from ._errors import Error

        if not 1 <= height <= 32768:
            raise Error(f"{height} is not from 1 to 32768", "height", "", "height")
        return self._environment.world_latlong(height, threads)

    def radiance(self, directions: ArrayLike) -> FloatArray:
        """Radiance from world directions, bilinear between texels.

        Parameters
        ----------
        directions
            shape (..., 3), of any length but 0; right-handed, +Y up.

        Returns
        -------
        float32 of the same shape.
        """
        return self._environment.radiance(directions).reshape(np.shape(directions))

    def __array__(self, dtype: npt.DTypeLike | None = None, copy: bool | None = None) -> npt.NDArray[Any]:
        array = self.latlong()
        if dtype is not None and np.dtype(dtype) != array.dtype:
            return array.astype(dtype)
        return array.copy() if copy else array

    def __dlpack__(self, **arguments: Any) -> Any:
        array = self.latlong()
        return (array if array.flags.writeable else array.copy()).__dlpack__(**arguments)

    def __dlpack_device__(self) -> tuple[int, int]:
        return (1, 0)

    def _repr_png_(self) -> bytes:
        return _core.environment_picture(self._environment, 256)

    def __repr__(self) -> str:
        name = os.path.basename(self.file) if self.file else self.format
        return f"<domelight.Environment {name}: {self.projection}, {self.width} x {self.height}>"


#: What functions take for an environment: one, an array, or the name of a file.
EnvironmentLike = Union[Environment, ArrayLike, PathLike]


@contextlib.contextmanager
def light_of(environment: EnvironmentLike, keyword: str = "environment") -> Iterator[_core.Environment]:
    """The library's environment for what a user passed. Afterwards, warnings tell of repairs."""
    if isinstance(environment, (str, os.PathLike)):
        environment = read(environment)
    if isinstance(environment, Environment):
        yield environment._environment
        environment._tell(5)
    else:
        yield _core.environment_from_array(environment, {}, keyword)


def read(
    file: PathLike | Sequence[PathLike] | bytes | bytearray | memoryview,
    *,
    projection: str = "auto",
    latlong: str | None = None,
    layer: str | None = None,
    faces: str | None = None,
    face_orientation: str | None = None,
    decode: str = "auto",
    rotate_y_deg: float = 0,
    up: str = "+Y",
    exposure: float = 0,
    negatives: str = "balance",
    threads: int = 0,
) -> Environment:
    """Opens an environment: Radiance HDR, OpenEXR, PNG, JPEG, or a cube texture (KTX2, KTX, DDS, .env).

    Bad texels (NaN, infinite, negative) are repaired; a `DomelightWarning` tells of them.

    Parameters
    ----------
    file
        One file, the six faces of a cube in any order, a folder with these, or the two halves of a dual paraboloid; or the
        contents of one file as bytes.
    projection
        "auto" (by shape and attributes), "latlong", "latlong/usd", "cube", "mirror-ball/fov=20", ...; or one of
        `domelight.conventions`: "nvdiffrec", ...
    latlong
        The lat-long convention: "default", "usd", "mitsuba", "openexr", "materialx", "mod", or "centre=+X,right=+Z".
    layer
        OpenEXR: the layer, channel or part.
    faces, face_orientation
        The order of the faces, "px nx py ny pz nz", and how they lie: "opengl", "directx" or "openexr".
    decode
        What eight bits mean: "auto", "srgb", "gamma22", "linear"; of textures also "rgbm", "rgbd", "rgbp".
    rotate_y_deg
        Turns the light about +Y: +X moves towards +Z.
    up
        The axis at the top of the image.
    exposure
        Stops: radiance is multiplied by 2 ** exposure.
    negatives
        "balance" (0, and what that adds is taken from the texels round it) or "clamp" (0).
    threads
        0: all cores.

    Raises
    ------
    FileError
        No such file, or a broken one.
    Error
        A keyword out of its range.
    """
    name, turn = conventions.resolve(projection)
    options = {
        "projection": name,
        "latlong": latlong,
        "layer": layer,
        "faces": faces,
        "face_orientation": face_orientation,
        "decode": decode,
        "rotate_y_deg": rotate_y_deg + turn,
        "up": up,
        "exposure": exposure,
        "negatives": negatives,
        "threads": threads,
    }
    if isinstance(file, (bytes, bytearray, memoryview)):
        environment = _core.open_environment_bytes(bytes(file), IN_MEMORY, options)
    else:
        files = [file] if isinstance(file, (str, os.PathLike)) else list(file)
        environment = _core.open_environment([os.fspath(each) for each in files], options)
    opened = Environment._wrap(environment, options)
    opened._tell(3)
    return opened


def sky(
    height: int = 512,
    *,
    sun_elevation_deg: float = 30,
    sun_azimuth_deg: float = 30,
    turbidity: float = 3,
    ground_albedo: float = 0.2,
    sun_disc: bool = True,
    threads: int = 0,
) -> Environment:
    """A physically based clear or hazy sky with its sun; radiance in W / (m² sr), linear Rec. 709.

    Parameters
    ----------
    height
        Rows of the lat-long image, 1 to 32768; it is twice as wide.
    sun_elevation_deg, sun_azimuth_deg
        Of the sun: -18 to 90 over the horizon; from +X towards +Z.
    turbidity
        1 (pure air) to 10 (haze).
    ground_albedo
        0 to 1.
    sun_disc
        False: the sky without the sun's disc.
    """
    return Environment._wrap(
        _core.sky(
            {
                "height": height,
                "sun_elevation_deg": sun_elevation_deg,
                "sun_azimuth_deg": sun_azimuth_deg,
                "turbidity": turbidity,
                "ground_albedo": ground_albedo,
                "sun_disc": sun_disc,
                "threads": threads,
            }
        )
    )


def axes(height: int = 256) -> Environment:
    """The labelled six-axis environment, which reveals every mistake in orientation."""
    return Environment._wrap(_core.axes(height))
