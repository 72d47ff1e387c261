"""The light at many points of a scene."""

from __future__ import annotations

import os
import pathlib
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ._environment import ArrayLike, EnvironmentLike, FloatArray, PathLike, light_of
from ._errors import Error
from ._progress import Progress, reporting

if TYPE_CHECKING:
    from . import _probes


def _vectors(array: ArrayLike, keyword: str) -> FloatArray:
    """Vectors as the extension takes them: float32, one a row."""
    vectors = np.ascontiguousarray(array, dtype=np.float32)
    if vectors.ndim == 0 or vectors.shape[-1] != 3:
        raise Error(f"an array of shape {vectors.shape}, expected (..., 3)", keyword, field=keyword)
    return vectors.reshape(-1, 3)


class ProbeSet:
    """Probes and their light: ``len(probes)`` of them, made by :func:`probes` or read by ``ProbeSet(folder)``.

    Attributes
    ----------
    positions : float32 of shape (n, 3)
        Where they captured, metres.
    valid, moved : bool of shape (n,)
        Whether their light may be used; whether they were moved away from surfaces.
    harmonics : float32 of shape (n, 9, 3)
        Coefficients of the radiance, in the order and basis of docs/conventions.md.
    roughness : list of float
        Of the levels of the specular chain.
    grid : (int, int, int) or None
        Probe x + nx (y + ny z) is the place in column x, layer y, row z.
    """

    def __init__(self, folder: PathLike) -> None:
        from . import _probes  # loads Embree

        self._take(_probes.load(pathlib.Path(os.fspath(folder))))

    @classmethod
    def _of(cls, found: _probes.ProbeSet) -> ProbeSet:
        made = cls.__new__(cls)
        made._take(found)
        return made

    def _take(self, found: _probes.ProbeSet) -> None:
        self._set = found
        self.positions: FloatArray = found.positions()
        self.harmonics: FloatArray = found.harmonics().reshape(-1, 9, 3)
        self.valid: npt.NDArray[np.bool_] = np.array(found.valid(), dtype=bool)
        self.moved: npt.NDArray[np.bool_] = np.array(found.moved(), dtype=bool)
        self.roughness: list[float] = found.roughness
        self.grid: tuple[int, int, int] | None = found.grid
        self.scene: str = found.scene

    def __len__(self) -> int:
        return self._set.count

    def __repr__(self) -> str:
        return f"<domelight.ProbeSet: {len(self)} of {self._set.size} x {self._set.size} texels a face>"

    def radiance(self, probe: int, directions: ArrayLike, roughness: float = 0) -> FloatArray:
        """The prefiltered radiance that arrives at a probe from world directions: (..., 3) gives (..., 3)."""
        vectors = _vectors(directions, "directions")
        return self._set.radiance(probe, vectors, roughness).reshape(np.shape(directions))

    def irradiance_over_pi(self, probe: int, normals: ArrayLike) -> FloatArray:
        """The irradiance over pi at a probe, on surfaces with these normals."""
        return self._set.irradiance(probe, _vectors(normals, "normals")).reshape(np.shape(normals))

    def irradiance_over_pi_at(self, points: ArrayLike, normals: ArrayLike, *, visibility: bool = True) -> FloatArray:
        """The irradiance over pi at points of the scene, blended from the probes around each.

        Without `visibility`, probes behind walls contribute too.
        """
        places = _vectors(points, "points")
        vectors = _vectors(np.broadcast_to(np.asarray(normals, np.float32), np.shape(points)), "normals")
        return self._set.blended_irradiance(places, vectors, visibility).reshape(np.shape(points))


def probes(
    scene: PathLike,
    environment: EnvironmentLike,
    folder: PathLike | None = None,
    *,
    grid: Sequence[int] | None = None,
    density: float | None = None,
    at: ArrayLike | None = None,
    auto: int | None = None,
    region: Sequence[float] | None = None,
    size: int = 64,
    spp: int = 32,
    noise: float = 0,
    bounces: int = 3,
    walls: bool = True,
    proxy: Sequence[float] | None = None,
    encoding: str = "rgb9e5",
    seed: int = 0,
    threads: int = 0,
    progress: Progress = None,
) -> ProbeSet:
    """Captures the light at many points of a scene by path tracing, and filters each: what ``domelight probes`` does.

    Parameters
    ----------
    scene
        A model (.glb, .gltf, .obj, .ply), or "spheres", "ball" or "furnace".
    folder
        Where the set is written (docs/probes.md); without it, it is in memory only.
    grid, density, at, auto
        One of them: (nx, ny, nz) places; probes to the square metre; places of shape (n, 3); up to so many where the
        light changes.
    region
        x0, y0, z0, x1, y1, z1 of the box that they fill; the box around the scene by default.
    size, spp, noise, bounces
        Texels along a face; samples of each; if above 0, more where their error is above it; of indirect light.
    walls, proxy
        Whether each probe finds the box of the walls around it; or that box, for all of them.
    encoding
        Of the light on disk: "rgb9e5", "rgba16f" or "rgba32f".
    seed
        The same seed gives the same bytes on any number of threads.
    """
    from . import _probes  # loads Embree

    options = {
        "grid": None if grid is None else [float(n) for n in grid],
        "density": density,
        "at": None if at is None else [float(v) for v in _vectors(at, "at").ravel()],
        "auto": auto,
        "region": None if region is None else [float(v) for v in region],
        "size": size,
        "spp": spp,
        "noise": noise,
        "bounces": bounces,
        "walls": walls,
        "proxy": None if proxy is None else [float(v) for v in proxy],
        "encoding": encoding,
        "seed": seed,
        "threads": threads,
    }
    place = None if folder is None else pathlib.Path(os.fspath(folder))
    with light_of(environment) as light, reporting(progress) as tell:
        return ProbeSet._of(_probes.probes(os.fspath(scene), light, place, options, tell))
