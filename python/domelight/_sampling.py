"""Light directions in proportion to radiance."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from . import _core
from ._environment import ArrayLike, EnvironmentLike, FloatArray, light_of


class Samples:
    """Light samples: arrays that share one block of memory.

    Attributes
    ----------
    u, v : float32 of shape (n,)
        Position on the sampler's lat-long image, 0 to below 1.
    direction : float32 of shape (n, 3)
        In the world, of unit length, towards the light.
    radiance : float32 of shape (n, 3)
        Arriving from there.
    pdf_solid_angle : float32 of shape (n,)
        Density per steradian with which the sample was drawn.
    array : float32 of shape (9, n)
        All of them: rows u, v, x, y, z, r, g, b, pdf_solid_angle.
    """

    __slots__ = ("_sampler", "array")

    def __init__(self, array: FloatArray, sampler: Sampler) -> None:
        self.array = array
        self._sampler = sampler

    @property
    def u(self) -> FloatArray:
        u: FloatArray = self.array[0]
        return u

    @property
    def v(self) -> FloatArray:
        v: FloatArray = self.array[1]
        return v

    @property
    def direction(self) -> FloatArray:
        return self.array[2:5].T

    @property
    def radiance(self) -> FloatArray:
        return self.array[5:8].T

    @property
    def pdf_solid_angle(self) -> FloatArray:
        pdf: FloatArray = self.array[8]
        return pdf

    def __len__(self) -> int:
        return int(self.array.shape[1])

    def _repr_png_(self) -> bytes:
        words = {"title": "domelight.Sampler", "subtitle": f"{len(self)} samples · {self._sampler.method}"}
        return _core.samples_picture(self._sampler._sampler, self.array, words)

    def __repr__(self) -> str:
        return f"<domelight.Samples: {len(self)} of {self._sampler!r}>"


class Sampler:
    """Draws light directions from an environment in proportion to its radiance.

    Parameters
    ----------
    environment
        An `Environment`, an array, or the name of a file. It is read once and kept.
    method
        "bilinear" (continuous density, the default), "guided", "binary", "alias", "hierarchical", "linear", "walk" or
        "bilinear-plain".
    weight
        "radiant-power" (luminance times solid angle) or "grayscale".
    compensate
        MIS compensation (Karlik et al. 2019): leaves the dim part to BRDF sampling.
    uniform_share
        Part of the samples that is drawn uniformly over the sphere, 0 to 1.

    >>> import numpy, domelight as dl
    >>> sampler = dl.Sampler(numpy.ones((16, 32, 3), numpy.float32))
    >>> s = sampler.sample(1024)
    >>> round(float((s.radiance / s.pdf_solid_angle[:, None]).mean()) / numpy.pi, 2)  # ∫ L dω = 4π
    4.0
    """

    __slots__ = ("_sampler", "method")

    def __init__(
        self,
        environment: EnvironmentLike,
        *,
        method: str = "bilinear",
        weight: str = "radiant-power",
        compensate: bool = False,
        uniform_share: float = 0,
        threads: int = 0,
    ) -> None:
        options = {
            "method": method,
            "weight": weight,
            "compensate": compensate,
            "uniform_share": uniform_share,
            "threads": threads,
        }
        with light_of(environment) as light:
            self._sampler = _core.build_sampler(light, options)
        self.method = method

    @property
    def memory_bytes(self) -> int:
        """Bytes of the tables, without the pixels."""
        return self._sampler.memory_bytes

    def sample(
        self,
        points: int | ArrayLike,
        *,
        sequence: str = "sobol",
        seed: int = 1,
        out: FloatArray | None = None,
        threads: int = 0,
    ) -> Samples:
        """Draws samples.

        Parameters
        ----------
        points
            How many, at the points of `sequence`; or the points themselves, of shape (n, 2): numbers from 0 to below 1, or
            uint32, which is read as a multiple of 2⁻³² and in place.
        sequence
            "random", "stratified", "hammersley", "halton", "sobol" or "r2".
        seed
            Another randomisation; 0: none for hammersley, halton, sobol and r2.
        out
            Memory to write to: float32 of shape (9, n), contiguous.
        threads
            0: all cores. The result does not depend on it.
        """
        if isinstance(points, (int, np.integer)) and not isinstance(points, bool):
            if points < 0:
                from ._errors import Error

                raise Error(f"{points} is negative", "points", "", "points")
            room = _core.sample_room(int(points)) if out is None else out
            self._sampler.sample_sequence(int(points), {"sequence": sequence, "seed": seed}, room, threads)
        else:
            if isinstance(points, (list, tuple)):
                points = np.asarray(points, np.float64)
            shape = np.shape(points)
            if not shape:
                from ._errors import wrong_type

                wrong_type("points", points, "a whole number or an array of shape (n, 2)")
            room = _core.sample_room(shape[0]) if out is None else out
            self._sampler.sample_points(points, room, threads)
        return Samples(room, self)

    def _look_up(self, directions: ArrayLike, threads: int) -> tuple[FloatArray, tuple[int, ...]]:
        flat = np.asarray(directions, np.float32)
        shape = flat.shape
        if not shape or shape[-1] != 3:
            from ._errors import Error

            raise Error(f"shape is {shape}, expected (..., 3)", "directions", "", "directions")
        count = int(np.prod(shape[:-1]))
        rows: FloatArray = _core.sample_room(count)
        if count:
            self._sampler.look_up(flat.reshape(1, count, 3), rows, threads)
        return rows, shape[:-1]

    def pdf(self, directions: ArrayLike, *, threads: int = 0) -> FloatArray:
        """Density per steradian with which directions are drawn.

        Parameters
        ----------
        directions
            float32 of shape (..., 3), of any length but 0.

        Returns
        -------
        float32 of shape (...), 0 where a direction is never drawn.
        """
        rows, shape = self._look_up(directions, threads)
        pdf: FloatArray = rows[8].reshape(shape)
        return pdf

    def radiance(self, directions: ArrayLike, *, threads: int = 0) -> FloatArray:
        """Radiance from directions, by the lookup that goes with the method.

        Returns
        -------
        float32 of shape (..., 3).
        """
        rows, shape = self._look_up(directions, threads)
        return rows[5:8].T.reshape((*shape, 3))

    def _repr_png_(self) -> bytes:
        return _core.density_picture(self._sampler, {"title": "density per steradian", "subtitle": self.method})

    def __repr__(self) -> str:
        height, width = self._sampler.size
        return f"<domelight.Sampler {self.method}, {width} x {height}>"


def unit_points(n: int, sequence: str = "sobol", seed: int = 1) -> npt.NDArray[np.uint32]:
    """The first n points of a sequence in the unit square.

    Returns
    -------
    uint32 of shape (n, 2): multiply by 2⁻³² for numbers from 0 to below 1.
    """
    return _core.unit_points(n, {"sequence": sequence, "seed": seed})
