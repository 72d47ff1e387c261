"""Bakes: folders of files for an engine."""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from . import _core
from ._environment import DomelightWarning, Environment, EnvironmentLike, PathLike, light_of, read
from ._errors import _with_keywords
from ._progress import Progress, reporting


class Bake:
    """What `bake` wrote for one engine.

    Attributes
    ----------
    engine : str
    folder : pathlib.Path
    manifest : dict
        The contents of manifest.json: every file with its hash, its levels, and every option.
    """

    def __init__(self, told: dict[str, Any]) -> None:
        self.engine: str = told["name"]
        self.folder = Path(told["folder"])
        self.manifest: dict[str, Any] = json.loads(told["manifest"])
        self._preview: str | None = told["preview"]

    @property
    def files(self) -> list[Path]:
        """All files in the folder."""
        return sorted(path for path in self.folder.iterdir() if path.is_file())

    def _repr_png_(self) -> bytes | None:
        return (self.folder / self._preview).read_bytes() if self._preview else None

    def __repr__(self) -> str:
        return f"<domelight.Bake for {self.engine}: {self.folder}>"


class Bakes(Sequence[Bake]):
    """What `bake` wrote, an engine after the other.

    Attributes
    ----------
    stages : list of (str, float, float)
        Name, wall-clock seconds and CPU seconds of each stage.
    """

    def __init__(self, told: dict[str, Any]) -> None:
        self._bakes = [Bake(engine) for engine in told["engines"]]
        self.stages: list[tuple[str, float, float]] = told["stages"]

    def __getitem__(self, index: Any) -> Any:
        return self._bakes[index]

    def __len__(self) -> int:
        return len(self._bakes)

    def _repr_png_(self) -> bytes | None:
        return self._bakes[0]._repr_png_()

    def __repr__(self) -> str:
        return repr(self._bakes)


def engines() -> dict[str, str]:
    """The engines that `bake` knows, and what is baked for each."""
    return _core.engines()


def bake(
    environment: EnvironmentLike,
    folder: PathLike,
    engines: str | Sequence[str] = "generic",
    *,
    layout: str | None = None,
    size: int | None = None,
    levels: int | None = None,
    roughness: Sequence[float] | None = None,
    lobe: str | None = None,
    exponents: Sequence[float] | None = None,
    texels: str | None = None,
    method: str = "exact",
    samples: int | None = None,
    sequence: str | None = None,
    seed: int | None = None,
    riemann_steps: tuple[int, int] | None = None,
    riemann_normalised: bool = True,
    irradiance: str | None = None,
    irradiance_size: int | None = None,
    sh_bands: int = 3,
    sh_window: str = "none",
    brdf_g: str = "correlated",
    brdf_form: str | None = None,
    brdf_size: int | None = None,
    brdf_float: bool = False,
    encoding: str | None = None,
    encoding_quality: str = "default",
    format: str | None = None,
    cube_picture: str = "cross",
    latlong_out: str | None = None,
    zstd: bool | None = None,
    as_read: bool = False,
    preview: bool = True,
    hashes: bool = True,
    threads: int = 0,
    progress: Progress = None,
) -> Bakes:
    """Bakes an environment into a folder: specular levels, irradiance, spherical harmonics, the BRDF table, a picture and
    a manifest. The files have the bytes that ``domelight bake ENV -o folder`` writes with the same words.

    Parameters
    ----------
    engines
        The engine to bake for ("generic", "three", "filament", ...: `engines()` lists them), or several, each of which
        gets a folder of its own in `folder`. On the command line this is ``--for``.
    layout, size, levels, roughness, lobe, exponents, texels
        As in `prefilter`; by default the engine's.
    method
        "exact", or a plain method: "bruteforce", "riemann" (with `riemann_steps` (K, J)), "montecarlo" (with `samples`,
        `sequence` and `seed`).
    irradiance
        "e" or "over-pi" (the engine's).
    encoding
        "rgba16f", "rgba32f", "rgb9e5", "r11g11b10f", "bc6h", "uastc-hdr", "astc4x4-hdr", ... (the engine's).
    format
        "ktx2", "ktx1", "dds", "dds9", "exr", "exr-mip" or "hdr" (the engine's).
    latlong_out
        The convention of lat-long images that are written.
    as_read
        Measures what a shader reads from the chain, for the manifest.

    The other keywords are those of ``domelight bake --help``, with underscores.

    Raises
    ------
    Error
        Before anything is read or written, where keywords are wrong or contradict each other.
    FileError
        The folder cannot be written. Nothing is changed in it then.
    """
    options = {
        "engines": [engines] if isinstance(engines, str) else list(engines),
        "layout": layout,
        "size": size,
        "levels": levels,
        "roughness": roughness,
        "lobe": lobe,
        "exponents": exponents,
        "texels": texels,
        "method": method,
        "samples": samples,
        "sequence": sequence,
        "seed": seed,
        "riemann_steps": riemann_steps,
        "riemann_normalised": riemann_normalised,
        "irradiance": irradiance,
        "irradiance_size": irradiance_size,
        "sh_bands": sh_bands,
        "sh_window": sh_window,
        "brdf_g": brdf_g,
        "brdf_form": brdf_form,
        "brdf_size": brdf_size,
        "brdf_float": brdf_float,
        "encoding": encoding,
        "encoding_quality": encoding_quality,
        "format": format,
        "cube_picture": cube_picture,
        "latlong_out": latlong_out,
        "zstd": zstd,
        "as_read": as_read,
        "preview": preview,
        "hashes": hashes,
        "threads": threads,
    }
    if isinstance(environment, (str, os.PathLike)):
        environment = read(environment)
    reading = environment._reading if isinstance(environment, Environment) else {}
    with light_of(environment) as light, reporting(progress) as tell:
        told = _core.bake(light, os.fspath(folder), options, reading, tell)
    repairs = environment._told if isinstance(environment, Environment) else []
    for line in told["warnings"]:
        if line not in repairs:
            warnings.warn(_with_keywords(line), DomelightWarning, stacklevel=2)
    return Bakes(told)
